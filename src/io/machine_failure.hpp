// The two kinds of failure that files bring: the machine's (disk, MPI: exit code 4) and the user's (a run directory in the way:
// exit code 2). Thrown by all of src/io, caught in src/app; the other kinds are in docs/developer/errors.md. Tested in
// tests/src/io. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace spindrift::io {

/// The disk or MPI failed; the message says what was being done, to which file, and the library's own words. Exit code 4.
class MachineFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What was asked for cannot be done with the files that are there; the message names the remedy. Exit code 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// "WHAT PATH: No space left on device", from an errno value.
[[noreturn]] void throw_errno(const std::string& what, const std::string& path, int error);

}  // namespace spindrift::io
