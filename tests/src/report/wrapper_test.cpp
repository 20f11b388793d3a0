// src/report/report.hpp: the call of the Python program, what it says when that fails, and that a run's own MPI does not reach
// it. SPDX-License-Identifier: Apache-2.0
#include "src/report/report.hpp"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>

using namespace spindrift;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

/// A run directory of a few rows, removed at the end.
struct RunFolder {
  fs::path path = fs::path(SPINDRIFT_BINARY_DIR) / "test_scratch" / ("report_" + std::to_string(::getpid())) / "a run's folder";
  RunFolder() {
    fs::create_directories(path);
    std::ofstream history(path / "history.csv");
    history << "time_s,ball.z_m\n";
    for (int i = 0; i < 20; ++i) history << 0.1 * i << "," << i * i << "\n";
  }
  ~RunFolder() { fs::remove_all(path.parent_path()); }
};

/// SPINDRIFT_PYTHON for as long as it lives.
struct Interpreter {
  explicit Interpreter(const std::string& path) { ::setenv("SPINDRIFT_PYTHON", path.c_str(), 1); }
  ~Interpreter() { ::unsetenv("SPINDRIFT_PYTHON"); }
};

fs::path script(const fs::path& path, const std::string& text) {
  std::ofstream(path) << "#!/bin/sh\n" << text << "\n";
  fs::permissions(path, fs::perms::owner_all);
  return path;
}

}  // namespace

TEST_CASE("a report and a picture are written where asked", "[report][fast]") {
  const RunFolder run;
  CHECK(report::write({{run.path}, {}, run.path / "picture.png"}).trouble == "");
  CHECK(fs::file_size(run.path / "report.html") > 5000);
  CHECK(fs::file_size(run.path / "picture.png") > 5000);
  const fs::path second = run.path.parent_path() / "second";
  fs::copy(run.path, second);
  CHECK(report::write({{run.path, second}, run.path / "other.html", {}}).trouble == "");
  CHECK(fs::exists(run.path / "other.html"));
  CHECK_THAT(report::write({{run.path, run.path}, run.path / "none.html", {}}).trouble, Contains("given twice"));
}

TEST_CASE("why there is no report is said in one sentence", "[report][fast]") {
  const RunFolder run;
  CHECK(report::write({{run.path / "absent"}, {}, {}}).exit_code == 2);
  CHECK_THAT(report::write({{run.path / "absent"}, {}, {}}).trouble, Contains("absent is not a run directory"));
  CHECK_THAT(report::write({{run.path}, run.path / "no/such/folder.html", {}}).trouble, Contains("No such file or directory"));
  {
    const Interpreter none("/nowhere/python3");
    CHECK_THAT(report::write({{run.path}, {}, {}}).trouble, Contains("/nowhere/python3") && Contains("ci/setup"));
  }
  {
    const Interpreter dying(script(run.path / "dying", "kill -9 $$"));
    CHECK_THAT(report::write({{run.path}, {}, {}}).trouble, Contains("signal 9"));
  }
  {  // the distribution's Python that finds no packages: -S leaves site-packages out
    const Interpreter bare(script(run.path / "bare", "exec /usr/bin/python3 -S \"$@\""));
    CHECK_THAT(report::write({{run.path}, {}, {}}).trouble,
               Contains("no module") && Contains("python3-numpy") && Contains("ci/setup"));
  }
  CHECK_FALSE(fs::exists(run.path / "report.html"));
}

TEST_CASE("the child of an MPI program is not taken for one of its ranks", "[report][fast]") {
  const RunFolder run;
  ::setenv("OMPI_COMM_WORLD_SIZE", "4", 1);
  const Interpreter asked(script(run.path / "asked", "test -z \"$OMPI_COMM_WORLD_SIZE\""));
  CHECK(report::write({{run.path}, {}, {}}).ok());
  ::unsetenv("OMPI_COMM_WORLD_SIZE");
}
