// A controller library: what it is told and asks for go through the right records, a state in the past is reached by telling it
// again, two of them know nothing of each other, and what it does wrong is named. SPDX-License-Identifier: Apache-2.0
#include "src/aero/bladed_library.hpp"

#include <catch2/catch.hpp>

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "kernels/base/failure.hpp"
#include "src/scene/error.hpp"

using namespace spindrift;
using namespace spindrift::aero;

namespace {

struct InputFile {
  std::filesystem::path path = std::filesystem::temp_directory_path() / ("spindrift_library_" + std::to_string(getpid()) + ".in");
  explicit InputFile(const std::string& text) { std::ofstream(path) << text; }
  ~InputFile() { std::filesystem::remove(path); }
  ControlOptions options() const {
    return {.model = ControlModel::library,
            .library = SPINDRIFT_TEST_CONTROLLER,
            .input_file = path.string(),
            .drive_train = DriveTrainOptions{}};
  }
};

BladedLibrary::Told told(int n, double speed = 50.0) {
  BladedLibrary::Told t;
  t.time = 0.5f * float(n), t.step = 0.5f, t.generator_speed = float(speed + n * n);
  return t;
}

/// What a library says of a call at this time, having been asked what this file says.
std::string trouble(const std::string& text) {
  const InputFile file(text);
  BladedLibrary library(file.options(), 3);
  try {
    for (int n = 0; n < 5; ++n) library.call(n, told(n));
  } catch (const NumericalFailure& e) { return e.what(); }
  return "";
}

}  // namespace

TEST_CASE("every number that a library is told is in the record of its meaning", "[aero][fast]") {
  const InputFile file("echo 1");
  ControlOptions options = file.options();
  options.records = {{.record = 17, .value = 7.0}};
  BladedLibrary library(options, 3);
  const BladedLibrary::Told all{.time = 2,
                                .step = 3,
                                .pitch_1 = 4,
                                .asked_pitch = 11,
                                .shaft_power = 14,
                                .electrical_power = 15,
                                .generator_speed = 20,
                                .rotor_speed = 21,
                                .generator_torque = 23,
                                .yaw_error = 24,
                                .wind = 27,
                                .pitch_2 = 33,
                                .pitch_3 = 34,
                                .fore_aft = 53,
                                .side_to_side = 54,
                                .azimuth = 60,
                                .rolling = 82,
                                .nodding = 83,
                                .yawing = 84,
                                .shaft_torque = 109};
  double squares = 0.0;
  for (int record : BladedLibrary::records) squares += record * record;
  const BladedLibrary::Asked asked = library.call(0, all);
  CHECK(asked.generator_torque == squares);
  CHECK(asked.pitch[0] == 307.0);
  options.individual_pitch = true;
  CHECK(BladedLibrary(options, 3).call(0, all).pitch[1] == Approx(0.01));
}

TEST_CASE("a library asked from an earlier state answers as it did then", "[aero][fast]") {
  const InputFile file("gain 2.0");
  BladedLibrary library(file.options(), 3);
  std::vector<double> torque;
  for (int n = 0; n < 10; ++n) torque.push_back(library.call(n, told(n)).generator_torque);
  CHECK(torque[9] != torque[8]);
  CHECK(library.call(4, told(4)).generator_torque == torque[4]);
  CHECK(library.log().size() == 5);
  for (int n = 5; n < 10; ++n) CHECK(library.call(n, told(n)).generator_torque == torque[std::size_t(n)]);
  // Another run that goes on from the log alone.
  BladedLibrary other(file.options(), 3);
  other.call(0, told(0, 10.0));
  other.set_log(library.log().first(9));
  CHECK(other.call(9, told(9)).generator_torque == torque[9]);
  // Two know nothing of each other.
  CHECK(other.call(10, told(10)).generator_torque == library.call(10, told(10)).generator_torque);
  // What was never told cannot be told again.
  other.set_log({});
  CHECK_THROWS_WITH(other.call(3, told(3)), Catch::Contains("3 calls before this one are wanted"));
}

TEST_CASE("a library's last call comes once, when it is done with", "[aero][fast]") {
  const std::filesystem::path log =
      std::filesystem::temp_directory_path() / ("spindrift_library_" + std::to_string(getpid()) + ".log");
  std::filesystem::remove(log);
  const InputFile file("log " + log.string());
  {
    ControlOptions options = file.options();
    options.output_name = "turbine_7";
    BladedLibrary library(options, 3);
    for (int n = 0; n < 3; ++n) library.call(n, told(n));
  }
  std::ifstream in(log);
  std::string line, all;
  while (std::getline(in, line)) all += line + ";";
  CHECK(all == "0 0 turbine_7;1 0.5 turbine_7;1 1 turbine_7;-1 1 turbine_7;");
  std::filesystem::remove(log);
}

TEST_CASE("small numbers stay what they are whatever a library does to the processor", "[aero][fast]") {
  const InputFile file("gain 1.0");
  BladedLibrary library(file.options(), 3);
  library.call(0, told(0));
  volatile double small = 1e-300, smaller = small * 1e-10;
  CHECK(smaller > 0.0);
}

TEST_CASE("contactor and brake are followed", "[aero][fast]") {
  const auto asked = [](const std::string& text) {
    const InputFile file(text);
    return BladedLibrary(file.options(), 3).call(0, told(0));
  };
  CHECK(asked("gain 2.0").generator_torque == 5000.0);
  CHECK(asked("gain 2.0\ncontactor 0").generator_torque == 0.0);
  CHECK(asked("brake 1").brake);
  CHECK(!asked("brake 16\nbrake_torque 500").brake);
  CHECK(asked("brake 16\nbrake_torque 500").brake_torque == 500.0);
}

TEST_CASE("what a library does wrong is said with its time and record", "[aero][fast]") {
  const auto [text, said] = GENERATE(table<std::string, std::string>({
      {"fail_from 1.0", "t = 1 s: control.library"},
      {"fail_from 1.0", "pitch bearing is lost"},
      {"from 1.5 yaw_rate 0.1", "t = 1.5 s"},
      {"from 1.5 yaw_rate 0.1", "record 48 is 0.1"},
      {"pitch_override 1", "record 55"},
      {"torque_override 1", "record 56"},
      {"contactor 2", "contactor (record 35) to 2"},
      {"brake 3", "brake (record 36) to 3"},
      {"not_finite 1", "not a finite number"},
  }));
  CAPTURE(text);
  CHECK(trouble(text).find(said) != std::string::npos);
  CHECK(trouble("gain 1.0").empty());
}

TEST_CASE("a library that gave up may be asked again from before", "[aero][fast]") {
  const InputFile file("gain 2.0\nfail_from 2.0");
  BladedLibrary library(file.options(), 3);
  double last = 0.0;
  for (int n = 0; n < 4; ++n) last = library.call(n, told(n)).generator_torque;
  CHECK_THROWS_AS(library.call(4, told(4)), NumericalFailure);
  CHECK(library.call(3, told(3)).generator_torque == last);
}

TEST_CASE("what a library says with a warning's code at its first call alone is a greeting", "[aero][fast]") {
  const InputFile file("warn_from -1.0");  // at every call
  BladedLibrary library(file.options(), 3);
  library.call(0, told(0));
  CHECK(library.take_warnings().empty());
  CHECK(library.take_greetings().size() == 1);
  library.call(1, told(1));
  CHECK(library.take_warnings().size() == 1);
  CHECK(library.take_greetings().empty());
}

TEST_CASE("a library's warnings are kept once each", "[aero][fast]") {
  const InputFile file("warn_from 1.0");
  BladedLibrary library(file.options(), 3);
  for (int n = 0; n < 6; ++n) library.call(n, told(n));
  const std::vector<std::string> warnings = library.take_warnings();
  REQUIRE(warnings.size() == 1);
  CHECK(warnings[0].find("speed is high") != std::string::npos);
  CHECK(library.take_warnings().empty());
}

TEST_CASE("a file that is no library, and one without the procedure, are refused by name", "[aero][fast]") {
  const InputFile file("no library");
  ControlOptions options = file.options();
  options.procedure = "CONTROLLER";
  CHECK_THROWS_WITH(BladedLibrary(options, 3), Catch::Contains("has no procedure CONTROLLER"));
  options.library = file.path.string();
  CHECK_THROWS_WITH(BladedLibrary(options, 3),
                    Catch::Contains("is no library that can be loaded") && Catch::Contains(file.path.string()));
  options.library = "/nowhere.so";
  CHECK_THROWS_WITH(BladedLibrary(options, 3), Catch::Contains("/nowhere.so"));
}

TEST_CASE("a library that ends the program does not end it well", "[aero][fast]") {
  const InputFile file("exit_from 1.0");
  int said[2];
  REQUIRE(pipe(said) == 0);
  const pid_t child = fork();
  if (child == 0) {
    dup2(said[1], STDERR_FILENO);
    BladedLibrary library(file.options(), 3);
    for (int n = 0; n < 5; ++n) library.call(n, told(n));
    _exit(0);
  }
  close(said[1]);
  std::string text(4096, '\0');
  text.resize(std::size_t(std::max<ssize_t>(0, read(said[0], text.data(), text.size()))));
  close(said[0]);
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  CHECK(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 4);
  CHECK(text.find("has ended the program") != std::string::npos);
}

TEST_CASE("a library that goes to another folder leaves the program in its own", "[aero][fast]") {
  const std::filesystem::path here = std::filesystem::current_path();
  REQUIRE(here != "/");
  CHECK(trouble("leave_from 0.0").empty());
  CHECK(std::filesystem::current_path() == here);
}
