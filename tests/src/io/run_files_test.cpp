// The smaller files of a run: run_directory.hpp, atomic_file.hpp, summary.hpp, log.hpp, progress.hpp, collective.hpp.
// SPDX-License-Identifier: Apache-2.0
#include <spdlog/spdlog.h>

#include <catch2/catch.hpp>
#include <limits>
#include <nlohmann/json.hpp>

#include "runtime/mpi/stop_request.hpp"
#include "src/io/atomic_file.hpp"
#include "src/io/build_info.hpp"
#include "src/io/collective.hpp"
#include "src/io/log.hpp"
#include "src/io/machine_failure.hpp"
#include "src/io/progress.hpp"
#include "src/io/run_directory.hpp"
#include "src/io/summary.hpp"
#include "tests/src/io/scratch.hpp"

using namespace spindrift;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

TEST_CASE("a run directory with something in it is not touched unless told to", "[io][fast]") {
  const test::Scratch folder("run_directory");
  const fs::path path = folder / "deep/run";
  const fs::path scene = path / "scene.toml", checkpoints = path / "checkpoints";
  {
    const io::RunDirectory directory(MPI_COMM_SELF, path, io::Existing::refuse);
    CHECK_FALSE(directory.resumes());
    directory.write_scene(MPI_COMM_SELF, "[time]\n");
    CHECK(io::read_file(scene) == "[time]\n");
    for (const auto existing : {io::Existing::overwrite, io::Existing::resume, io::Existing::refuse})  // while it is at work
      CHECK_THROWS_AS(io::RunDirectory(MPI_COMM_SELF, path, existing), io::InputError);
    CHECK(io::read_file(scene) == "[time]\n");
  }
  io::write_atomically(path / "notes.txt", "mine");
  const auto make = [&](io::Existing existing) { return io::RunDirectory(MPI_COMM_SELF, path, existing).resumes(); };
  CHECK_THROWS_AS(make(io::Existing::refuse), io::InputError);
  CHECK_THROWS_WITH(make(io::Existing::refuse), Contains("--restart") && Contains("--overwrite") && Contains("--out"));
  fs::create_directories(checkpoints);
  io::write_atomically(checkpoints / "checkpoint_1.h5", "");
  CHECK(make(io::Existing::resume));
  CHECK(fs::exists(scene));
  io::write_atomically(path / "picture.png", "of that run");
  CHECK_FALSE(make(io::Existing::overwrite));
  CHECK_FALSE(fs::exists(scene));
  CHECK_FALSE(fs::exists(path / "picture.png"));
  CHECK_FALSE(fs::exists(checkpoints));
  CHECK(io::read_file(path / "notes.txt") == "mine");  // not the run's
}

TEST_CASE("a restart where no run came as far as a checkpoint begins anew and keeps the rows", "[io][faults][fast]") {
  const test::Scratch folder("run_directory");
  const auto resumes = [&](const fs::path& path) {
    return io::RunDirectory(MPI_COMM_SELF, path, io::Existing::resume).resumes();
  };
  CHECK_FALSE(resumes(folder / "unborn"));
  CHECK_FALSE(resumes(folder / "unborn"));  // now empty
  const fs::path killed = folder / "killed";
  fs::create_directories(killed / "checkpoints");
  io::write_atomically(killed / "history.csv", "time_s\n0\n");
  io::write_atomically(killed / "checkpoints/checkpoint_1.h5.tmp", "half");
  io::write_atomically(killed / "slurm-1.out", "the queue's");
  CHECK_FALSE(resumes(killed));
  CHECK(io::read_file(killed / "history_before_restart.csv") == "time_s\n0\n");
  CHECK_FALSE(fs::exists(killed / "history.csv"));
  CHECK_FALSE(fs::exists(killed / "checkpoints"));
  CHECK(fs::exists(killed / "slurm-1.out"));
  io::write_atomically(killed / "history.csv", "time_s\n1\n");  // killed once more
  CHECK_FALSE(resumes(killed));
  CHECK(io::read_file(killed / "history_before_restart.csv") == "time_s\n0\n");
  CHECK(io::read_file(killed / "history_before_restart_2.csv") == "time_s\n1\n");
  fs::create_directories(killed / "checkpoints");
  io::write_atomically(killed / "checkpoints/checkpoint_1.h5.damaged", "bits");
  CHECK_THROWS_WITH(resumes(killed), Contains("damaged") && Contains("--overwrite"));
}

TEST_CASE("files that no run left, and results whose checkpoints are gone, are not removed", "[io][faults][fast]") {
  const test::Scratch folder("run_directory");
  const auto make = [&](const fs::path& path, io::Existing existing) { io::RunDirectory(MPI_COMM_SELF, path, existing); };
  const fs::path mine = folder / "mine";
  fs::create_directories(mine / "fields");
  io::write_atomically(mine / "scene.toml", "mine");
  for (const auto existing : {io::Existing::resume, io::Existing::overwrite})
    CHECK_THROWS_WITH(make(mine, existing), Contains("scene.toml would be replaced, but no run left it there"));
  CHECK(io::read_file(mine / "scene.toml") == "mine");
  CHECK(fs::exists(mine / "fields"));

  const fs::path done = folder / "done";
  fs::create_directories(done);
  io::Summary summary;
  summary.exit_code = 0;
  io::write_summary(done / "summary.json", summary);
  io::write_atomically(done / "report.html", "results");
  CHECK_THROWS_WITH(make(done, io::Existing::resume), Contains("came to its end") && Contains("--overwrite"));
  CHECK(io::read_file(done / "report.html") == "results");
  make(done, io::Existing::overwrite);
  CHECK_FALSE(fs::exists(done / "report.html"));
}

TEST_CASE("a run directory that cannot be is refused in words", "[io][faults][fast]") {
  const test::Scratch folder("run_directory");
  io::write_atomically(folder / "file", "");
  const auto make = [&](const fs::path& path) { io::RunDirectory(MPI_COMM_SELF, path, io::Existing::refuse); };
  CHECK_THROWS_AS(make(folder / "file"), io::InputError);
  CHECK_THROWS_AS(make(folder / "file/below"), io::MachineFailure);
  CHECK_THROWS_WITH(make("/proc/spindrift"), Contains("/proc/spindrift"));
}

TEST_CASE("the default name is of the scene and the time, and not taken", "[io][fast]") {
  const auto path = io::RunDirectory::default_path(MPI_COMM_SELF, "inputs/leble_barakos/case1_demo.toml");
  CHECK_THAT(path.string(), Catch::Matchers::Matches("runs/case1_demo_\\d{4}-\\d\\d-\\d\\d_\\d\\d-\\d\\d-\\d\\d(_\\d+)?"));
}

TEST_CASE("an atomic write that fails leaves the old file and nothing else", "[io][faults][fast]") {
  const test::Scratch folder("atomic");
  io::write_atomically(folder / "a", "one");
  io::write_atomically(folder / "a", "two");
  CHECK(io::read_file(folder / "a") == "two");
  fs::create_directories(folder / "a.tmp");  // in the way
  CHECK_THROWS_AS(io::write_atomically(folder / "a", "three"), io::MachineFailure);
  CHECK(io::read_file(folder / "a") == "two");
  CHECK_THROWS_WITH(io::read_file(folder / "absent"), Contains("absent") && Contains("No such file"));
}

TEST_CASE("a summary holds what it was given, and null for what is not a number", "[io][fast]") {
  const test::Scratch folder("summary");
  io::Summary summary;
  summary.title = "Fall 1: \"ruhig\"";
  summary.exit_code = 3;
  summary.exit_reason = "diverged";
  summary.numerical_trouble = {"pitch beyond 85 deg at 12.3 s"};
  summary.start_time_s = 50;
  summary.end_time_s = 150;
  summary.wall_seconds = 4;
  summary.ranks = 2;
  summary.threads = 3;
  summary.counts = {{"windows", 1500}, {"steps", 3000}};
  summary.parts = {{"bodies", 1.5, 2.5, 12000}};
  summary.efficiency = {{"load balance", 0.93, "mean over max busy time"}};
  summary.columns = {{"time_s", "s", ""}, {"platform.x_m", "m", "surge"}};
  io::HistoryStatistics statistics;
  statistics.rows = 2;
  statistics.ranges = {{"last_20_s", 130, 150}};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  statistics.columns = {{"platform.x_m", 0.1, -1, 2, 10, 20, 1, {nan}}};
  summary.statistics = statistics;
  io::write_summary(folder / "summary.json", summary);
  const auto json = nlohmann::json::parse(io::read_file(folder / "summary.json"));
  CHECK(json["title"] == "Fall 1: \"ruhig\"");
  CHECK(json["exit_code"] == 3);
  CHECK(json["real_time_factor"] == 25.0);
  CHECK(json["core_seconds"] == 24.0);
  CHECK(json["counts"]["steps"] == 3000);
  CHECK(json["parts"][0]["core_seconds"] == 2.5);
  CHECK(json["efficiency"][0]["value"] == 0.93);
  CHECK(json["statistics"]["platform.x_m"]["final"] == 0.1);
  CHECK(json["statistics"]["platform.x_m"]["mean"]["last_20_s"].is_null());
  CHECK(json["statistics"]["platform.x_m"]["not_finite"] == 1);
  CHECK(json["ranges"]["last_20_s"]["from_s"] == 130);
  CHECK(json["columns"][1]["meaning"] == "surge");
  CHECK(json["machine"]["threads_per_rank"] == 3);
  CHECK(json["build"]["commit"] == io::build_info().commit);
}

TEST_CASE("a rank that fails alone says so in the summary, unless the first rank has", "[io][faults][fast]") {
  const test::Scratch folder("summary");
  const fs::path file = folder / "summary.json";
  const auto with_code = [](int code) {
    io::Summary summary;
    summary.exit_code = code;
    return summary;
  };
  const auto code = [&] { return nlohmann::json::parse(io::read_file(file))["exit_code"]; };
  io::SummaryOfOthers(file).write_instead(with_code(4), 3);
  CHECK_FALSE(fs::exists(file));  // another computer's disk
  std::ofstream(folder / "scene.toml") << "";
  io::SummaryOfOthers(file).write_instead(with_code(4), 3);  // of a first rank that came no further
  CHECK(code() == 4);
  fs::remove(folder / "scene.toml");

  io::write_summary_of_start(file, {});
  const io::SummaryOfOthers begun(file);
  begun.write_instead(with_code(4), 3);
  CHECK(code() == 4);

  io::write_summary_of_start(file, {});
  const io::SummaryOfOthers first_rank_knows(file);
  io::write_summary(file, with_code(3));
  first_rank_knows.write_instead(with_code(4), 3);
  CHECK(code() == 3);

  io::write_summary(file, with_code(5));  // of the run that this one goes on with
  const io::SummaryOfOthers restarted(file);
  restarted.write_instead(with_code(4), 3);
  CHECK(code() == 4);
  CHECK(std::distance(fs::directory_iterator(folder.path()), {}) == 1);
}

TEST_CASE("the build knows its commit, flags and libraries", "[io][fast]") {
  const io::BuildInfo& build = io::build_info();
  CHECK(build.commit.size() >= 7);
  CHECK_THAT(build.flags, Contains("-fno-math-errno"));
  for (const auto& [name, version] : build.libraries) CHECK_THAT(version, Catch::Matchers::Matches(".*\\d+\\.\\d+.*"));
}

TEST_CASE("the log file has every line, is appended to, and warnings are counted", "[io][fast]") {
  const test::Scratch folder("log");
  for (int run = 0; run < 2; ++run) {
    io::start_log(0, true);
    io::log_to_file(0, folder / "log.txt");
    spdlog::info("window {}", run);
    CHECK(io::warnings_logged() == 0);
  }
  io::start_log(1, true);
  io::log_to_file(1, folder / "other.txt");
  spdlog::warn("unseen: rank 1 prints errors only");
  CHECK(io::warnings_logged() == 1);
  CHECK_FALSE(fs::exists(folder / "other.txt"));
  const std::string text = io::read_file(folder / "log.txt");
  CHECK_THAT(text, Catch::Matchers::Matches("\\d{4}-\\d\\d-\\d\\d [0-9:.]+ info     window 0\\n.* info     window 1\\n"));
  CHECK_THROWS_AS(io::log_to_file(0, folder / "log.txt/below"), io::MachineFailure);
  io::start_log(0, false);
}

TEST_CASE("progress in words: time, fraction, speed, time to go", "[io][fast]") {
  CHECK(io::progress_text(75, 0, 150, 200) == "t = 75.0 of 150.0 s    50 %   200 x real time   0:00 to go");
  CHECK(io::progress_text(0.5, 0, 5, 1e-3) == "t = 0.500 of 5.000 s    10 %   1e+03 wall s per simulated s   1:15:00 to go");
  CHECK(io::progress_text(0.5, 0, 5, 0.103) == "t = 0.500 of 5.000 s    10 %   9.71 wall s per simulated s   0:44 to go");
  CHECK(io::progress_text(149.99, 0, 150, 0) == "t = 150.0 of 150.0 s    99 %");  // 100 % only when done
  CHECK(io::progress_text(100, 100, 100, 1) == "t = 100.000 of 100.000 s   100 %   1 x real time   0:00 to go");
  CHECK(io::pseudo_steps_text(40, 0, 300, 2) == "pseudo-step 40 of at most 300   2 per second   at most 2:10 to go");
  CHECK(io::pseudo_steps_text(1, 0, 300, 0) == "pseudo-step 1 of at most 300");
  CHECK(io::duration_text(59.6) == "1:00");
  CHECK(io::duration_text(3 * 3600 + 309) == "3:05:09");
  CHECK(io::duration_text(100 * 3600) == "4 d 4 h");
  CHECK(io::duration_text(std::numeric_limits<double>::infinity()) == "?");
}

TEST_CASE("plain progress speaks now and then: not often in a short run, at least every two minutes in a long one",
          "[io][fast]") {
  const auto count_lines = [](double end_s, double wall_per_simulated) {
    const test::Scratch folder("progress");
    io::start_log(0, true);
    io::log_to_file(0, folder / "log.txt");
    double wall = 0;
    io::Progress progress(0, end_s, io::ProgressStyle::lines, [&] { return wall; });
    for (double t = 0.1; t < end_s + 0.05; t += 0.1, wall = t * wall_per_simulated) progress.update(t);
    io::start_log(0, false);
    const std::string text = io::read_file(folder / "log.txt");
    return std::count(text.begin(), text.end(), '\n');
  };
  CHECK(count_lines(150, 0.005) == 0);  // 0.75 s
  CHECK(count_lines(150, 2) == 19);     // 5 minutes: each 5 %, every 15 s
  CHECK(count_lines(150, 100) >= 110);  // 4 h: every 2 minutes
  CHECK(count_lines(150, 100) <= 150);
}

TEST_CASE("what fails on one rank fails on all, with its words", "[io][mpi2]") {
  const int rank = io::rank_of(MPI_COMM_WORLD);
  const auto fail_on = [&](int which) {
    io::together(MPI_COMM_WORLD, [&] {
      if (rank == which) throw io::MachineFailure("disk of rank " + std::to_string(which));
    });
  };
  CHECK_THROWS_WITH(fail_on(0), "disk of rank 0");
  CHECK_THROWS_WITH(fail_on(1), "disk of rank 1");
  CHECK_THROWS_AS(fail_on(1), io::MachineFailure);
  CHECK_NOTHROW(fail_on(2));
  CHECK_THROWS_AS(io::on_root(MPI_COMM_WORLD, [] { throw io::InputError("x"); }), io::InputError);
  CHECK_THROWS_AS(io::on_root(MPI_COMM_WORLD, [] { throw runtime::StopAsked(); }), runtime::StopAsked);
  CHECK_THROWS_WITH(io::together(MPI_COMM_WORLD, [] { throw std::logic_error("both"); }), "both");
  CHECK(io::from_root(MPI_COMM_WORLD, rank == 0 ? "root" : "other, longer") == "root");
}
