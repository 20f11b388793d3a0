// A controller in a library that somebody else built, called as GH Bladed calls one (the DISCON interface): one procedure with an
// array of numbers for both directions. It keeps its state to itself, so every call is kept here: a state of the run that saw
// another number of calls than the library has a fresh copy of the library told all of them again, up to its own. Numbers of the
// records: Bladed user manual, appendix A; the meaning of each is that of OpenFAST's ServoDyn (Jonkman & Buhl 2005; openfast.
// readthedocs.io). Used by turbine_control.cpp; tested in tests/src/aero/bladed_library_test.cpp. SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "src/aero/control_options.hpp"

namespace spindrift::aero {

class BladedLibrary {
 public:
  static constexpr int most_blades = 3;

  /// What a call is told, in the interface's single precision; speeds and torques of the generator on its own shaft. Names in the
  /// order of `records`.
  struct Told {
    float time = 0, step = 0;                     ///< [s]; step to the next call
    float pitch_1 = 0, asked_pitch = 0;           ///< [rad]
    float shaft_power = 0, electrical_power = 0;  ///< [W]
    float generator_speed = 0, rotor_speed = 0;   ///< [rad/s]
    float generator_torque = 0;                   ///< [N m]
    float yaw_error = 0, wind = 0;                ///< [rad], horizontal wind at the hub [m/s]
    float pitch_2 = 0, pitch_3 = 0;               ///< [rad]
    float fore_aft = 0, side_to_side = 0;         ///< acceleration of the hub [m/s2]
    float azimuth = 0;                            ///< of blade 1 [rad]
    float rolling = 0, nodding = 0, yawing = 0;   ///< angular acceleration of what carries the rotor [rad/s2]
    float shaft_torque = 0;                       ///< [N m]
  };
  static constexpr std::array<int, 20> records{2, 3, 4, 11, 14, 15, 20, 21, 23, 24, 27, 33, 34, 53, 54, 60, 82, 83, 84, 109};
  static_assert(sizeof(Told) == records.size() * sizeof(float));

  struct Asked {
    double generator_torque = 0.0;            ///< on the generator's shaft [N m]; 0 where its contactor is open
    std::array<double, most_blades> pitch{};  ///< [rad]
    bool brake = false;                       ///< whole torque of the brake
    double brake_torque = 0.0;                ///< on the generator's shaft, where the library names one [N m]
  };

  /// Throws scene::SceneError where the library or its procedure cannot be loaded.
  explicit BladedLibrary(const ControlOptions& options, int blades);
  ~BladedLibrary();
  BladedLibrary(const BladedLibrary&) = delete;
  BladedLibrary& operator=(const BladedLibrary&) = delete;

  /// Call number `before` (from 0) of a run. Throws NumericalFailure with the library's own words where it gives up or asks for
  /// what no turbine here has.
  Asked call(std::int64_t before, const Told& told);

  /// All that it was told; of a run that goes on: before its next call.
  std::span<const Told> log() const { return log_; }
  void set_log(std::span<const Told> log) { log_.assign(log.begin(), log.end()), stale_ = true; }
  /// Its warnings since they were last asked for.
  std::vector<std::string> take_warnings();
  /// What it says with a warning's code at its first call: who wrote it, as a rule.
  std::vector<std::string> take_greetings();

 private:
  class Loaded;
  void load();
  void end();
  Asked tell(const Told& told);

  ControlOptions options_;
  int blades_;
  std::unique_ptr<Loaded> loaded_;
  std::int64_t calls_ = 0;  ///< of the copy that is loaded
  bool stale_ = false;      ///< that copy gave up, or was told another log
  Told last_;
  std::vector<float> swap_;
  std::vector<Told> log_;
  std::vector<std::string> warnings_, greetings_;
};

}  // namespace spindrift::aero
