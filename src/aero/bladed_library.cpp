// SPDX-License-Identifier: Apache-2.0
#include "src/aero/bladed_library.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cfenv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <utility>

#include "kernels/base/failure.hpp"
#include "src/scene/error.hpp"

namespace spindrift::aero {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t swap_size = 4096, text_size = 1024;
constexpr int log_record = 165;  // where a library may leave values of its own, as Bladed from 4.3 on has it
constexpr std::size_t most_warnings = 20;

/// A library built with unsafe mathematics turns small numbers off for the thread that loads it, which would change our bits.
class KeptFloatingPoint {
 public:
  KeptFloatingPoint() { std::fegetenv(&environment_); }
  ~KeptFloatingPoint() { std::fesetenv(&environment_); }
  KeptFloatingPoint(const KeptFloatingPoint&) = delete;
  KeptFloatingPoint& operator=(const KeptFloatingPoint&) = delete;

 private:
  std::fenv_t environment_;
};

/// While a library runs: the program must not end with it, as by Fortran's STOP, with exit code 0 and without a word; and paths
/// that are not absolute must go on to mean the same.
class Calling {
 public:
  explicit Calling(const std::string& library) : folder_(fs::current_path(error_)) {
    static const int registered = std::atexit(refuse_end);
    static_cast<void>(registered);
    running_ = library.c_str();
  }
  ~Calling() {
    running_ = nullptr;
    if (!folder_.empty() && fs::current_path(error_) != folder_) fs::current_path(folder_, error_);
  }
  Calling(const Calling&) = delete;
  Calling& operator=(const Calling&) = delete;

 private:
  static void refuse_end() {
    if (!running_) return;
    constexpr int machine_failure = 4;  // docs/user/troubleshooting.md
    fmt::print(stderr, "error: control.library {} has ended the program (exit, or STOP of Fortran)\n", running_);
    std::fflush(stderr);
    _exit(machine_failure);
  }
  static inline std::atomic<const char*> running_{nullptr};
  std::error_code error_;
  fs::path folder_;
};

[[noreturn]] void refuse_library(const std::string& path, const std::string& what) {
  throw scene::SceneError({{path, 0, "", "", what}});
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) text.replace(at, from.size(), to);
  return text;
}

}  // namespace

/// One copy of the library with a state of its own: the loader gives the same file twice the same state, so each has its own
/// file.
class BladedLibrary::Loaded {
 public:
  using Procedure = void (*)(float* swap, int* fail, char* input, char* output, char* message);

  Loaded(const std::string& path, const std::string& procedure) {
    static std::atomic<int> number{0};
    const fs::path copy = fs::temp_directory_path() / fmt::format("spindrift_{}_{}.so", getpid(), number++);
    std::error_code error;
    if (!fs::copy_file(path, copy, fs::copy_options::overwrite_existing, error))
      refuse_library(path, fmt::format("cannot be copied to {}: {}", copy.parent_path().string(), error.message()));
    handle_ = dlopen(copy.c_str(), RTLD_NOW | RTLD_LOCAL);
    const char* problem = handle_ ? nullptr : dlerror();
    const std::string why = problem ? replaced(problem, copy.string(), path) : "";
    fs::remove(copy, error);
    if (!handle_) refuse_library(path, "is no library that can be loaded: " + why);
    call = std::bit_cast<Procedure>(dlsym(handle_, procedure.c_str()));
    if (!call) {
      dlclose(handle_);
      refuse_library(path, fmt::format("has no procedure {}", procedure));
    }
  }
  ~Loaded() { dlclose(handle_); }
  Loaded(const Loaded&) = delete;
  Loaded& operator=(const Loaded&) = delete;

  Procedure call = nullptr;

 private:
  void* handle_ = nullptr;
};

BladedLibrary::BladedLibrary(const ControlOptions& options, int blades) : options_(options), blades_(blades) { load(); }
BladedLibrary::~BladedLibrary() { end(); }

void BladedLibrary::load() {
  end();
  const KeptFloatingPoint kept;
  loaded_ = std::make_unique<Loaded>(options_.library, options_.procedure);
  calls_ = 0, stale_ = false;
  swap_.assign(swap_size, 0.0f);
  const auto set = [this](int record, double value) { swap_[std::size_t(record - 1)] = float(value); };
  for (const RecordOptions& r : options_.records) set(r.record, r.value);
  set(28, options_.individual_pitch ? 1.0 : 0.0);
  set(35, 1.0);  // the generator is on
  set(49, text_size), set(51, double(options_.output_name.size() + 1)), set(64, text_size);
  set(61, blades_), set(63, log_record);
}

/// The last call, in which it may close files.
void BladedLibrary::end() {
  if (!loaded_) return;
  if (calls_ > 0 && !stale_) try {
      swap_[0] = -1.0f;
      tell(last_);
    } catch (const NumericalFailure&) {}  // the run is over
  loaded_.reset();
}

BladedLibrary::Asked BladedLibrary::tell(const Told& told) {
  last_ = told;
  const auto values = std::bit_cast<std::array<float, records.size()>>(told);
  for (std::size_t i = 0; i < records.size(); ++i) swap_[std::size_t(records[i] - 1)] = values[i];
  // The library may write into its texts, so each call has its own.
  std::string input = options_.input_file.empty() ? "" : fs::absolute(options_.input_file).string();
  std::string output = options_.output_name.substr(0, text_size), message(text_size + 1, '\0');
  output.resize(text_size + 1);
  swap_[49] = float(input.size() + 1);

  int fail = 0;
  {
    const KeptFloatingPoint kept;
    const Calling calling(options_.library);
    loaded_->call(swap_.data(), &fail, input.data(), output.data(), message.data());
  }
  message.back() = '\0';
  std::string said(message.c_str());
  said.erase(said.find_last_not_of(" \n\r\t") + 1);
  const auto give_up = [&](const std::string& what) {
    stale_ = true;
    throw NumericalFailure(fmt::format("t = {:g} s: control.library {}: {}", told.time, options_.library, what), "control",
                           long(calls_), told.time);
  };
  if (fail < 0) give_up(said.empty() ? fmt::format("gave up with {}", fail) : said);
  if (std::vector<std::string>& said_so_far = calls_ == 0 ? greetings_ : warnings_;
      fail > 0 && !said.empty() && said_so_far.size() < most_warnings)
    if (const std::string message_of_it = fmt::format("control.library {}: {}", options_.library, said);
        std::find(said_so_far.begin(), said_so_far.end(), message_of_it) == said_so_far.end())
      said_so_far.push_back(message_of_it);

  const auto record = [this](int number) { return double(swap_[std::size_t(number - 1)]); };
  for (const auto& [number, meaning] : {std::pair{48, "a yaw rate of the nacelle"}, std::pair{55, "the pitch override"},
                                        std::pair{56, "the torque override"}, std::pair{102, "control of the yaw torque"}})
    if (record(number) != 0.0)
      give_up(fmt::format("asks for {} (record {} is {:g}), which no turbine here has", meaning, number, record(number)));
  Asked asked;
  const double contactor = std::round(record(35)), brake = std::round(record(36));
  if (contactor != 0.0 && contactor != 1.0)
    give_up(fmt::format("sets the generator's contactor (record 35) to {:g}, not 0 or 1", record(35)));
  if (brake != 0.0 && brake != 1.0 && brake != 16.0)
    give_up(fmt::format("sets the brake (record 36) to {:g}, not 0, 1 or 16", record(36)));
  if (contactor == 1.0) asked.generator_torque = record(47);
  asked.brake = brake == 1.0;
  if (brake == 16.0) asked.brake_torque = record(107);
  for (int b = 0; b < most_blades; ++b) asked.pitch[std::size_t(b)] = record(options_.individual_pitch ? 42 + b : 45);
  for (double value : {asked.generator_torque, asked.brake_torque, asked.pitch[0], asked.pitch[1], asked.pitch[2]})
    if (!std::isfinite(value)) give_up("asks for a pitch or torque that is not a finite number (records 42 to 47, 107)");
  return asked;
}

BladedLibrary::Asked BladedLibrary::call(std::int64_t before, const Told& told) {
  if (calls_ != before || stale_) {
    if (std::int64_t(log_.size()) < before)
      throw NumericalFailure(
          fmt::format("t = {:g} s: control.library {}: {} calls before this one are wanted to bring it here, {} are kept",
                      told.time, options_.library, before, log_.size()),
          "control", long(before), told.time);
    load();
    for (; calls_ < before; ++calls_) {
      swap_[0] = calls_ == 0 ? 0.0f : 1.0f;
      tell(log_[std::size_t(calls_)]);
    }
  }
  log_.resize(std::size_t(before));
  log_.push_back(told);
  swap_[0] = before == 0 ? 0.0f : 1.0f;
  const Asked asked = tell(told);
  ++calls_;
  return asked;
}

std::vector<std::string> BladedLibrary::take_warnings() { return std::exchange(warnings_, {}); }

std::vector<std::string> BladedLibrary::take_greetings() { return std::exchange(greetings_, {}); }

}  // namespace spindrift::aero
