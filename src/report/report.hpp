// The Python programs of this folder, started on run directories: report.html of a run, a comparison of several, the page of a
// study; pictures and films. Called by `spindrift run`, `study`, `report`, `picture` and `film`. A report that cannot be made
// never fails a run: the caller logs the reason. Tested in tests/src/report/wrapper_test.cpp; the pages in
// tests/src/report/report_test.py. SPDX-License-Identifier: Apache-2.0
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
  bool says_verdict = false;                       ///< prints what a run came to, and what stands against it
};

/// What a program of this folder came to: its exit code (0 done, 2 bad input, 4 a package or the disk is missing), and one
/// sentence that says what is wrong and what helps.
struct Outcome {
  int exit_code = 0;
  std::string trouble;
  bool ok() const { return exit_code == 0; }
};

/// Where the page of a request is written.
std::filesystem::path page_of(const Request& request);

/// Writes the page. On one rank; takes seconds, and says on standard output what it does where it takes many.
Outcome write(const Request& request);

/// Starts `program` ("spindrift_picture.py") of this folder on `words`; what it prints goes to standard output.
Outcome start(const std::string& program, std::vector<std::string> words);

/// This process becomes `program` ("spindrift_study.py") of this folder, with these words; after MPI is closed. Throws where
/// Python cannot be started.
[[noreturn]] void become(const std::string& program, const std::vector<std::string>& words);

}  // namespace spindrift::report
