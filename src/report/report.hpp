// report.html of a run, or of several side by side: starts the Python program of this folder on run directories.
// Called by `spindrift run` at its end and by `spindrift report`. A report that cannot be made never fails a run: the caller logs
// the reason. Tested in tests/src/report/wrapper_test.cpp; the page itself in tests/src/report/report_test.py.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace spindrift::report {

struct Request {
  std::vector<std::filesystem::path> directories;  ///< of runs; more than one: laid over each other
  std::optional<std::filesystem::path> out;        ///< default: report.html in the first, comparison.html for several
  std::optional<std::filesystem::path> png;        ///< also a picture of the first run
};

/// Empty when the report is written, else one sentence that says why not and what helps. On one rank; takes a few seconds.
std::optional<std::string> write(const Request& request);

/// This process becomes `program` ("spindrift_study.py") of this folder, with these words; after MPI is closed. Throws where
/// Python cannot be started.
[[noreturn]] void become(const std::string& program, const std::vector<std::string>& words);

}  // namespace spindrift::report
