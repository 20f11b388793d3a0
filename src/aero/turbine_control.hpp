// The drive train with its controller: rotor speed from aerodynamic and generator torque, pitch of each blade by a servo, modes
// of operation by events in time. All that it remembers is a row of plain numbers that the caller keeps, so that windows repeat
// and runs go on from it. Laws: kernels/rotor/controller_dtu.hpp; docs/theory/rotor_engineering.md. Used by rotor_loads.cpp;
// tested in tests/src/aero/turbine_control_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "kernels/rotor/controller_dtu.hpp"
#include "src/aero/control_options.hpp"

namespace spindrift::aero {

class TurbineControl {
 public:
  /// What the rotor does as the controller leaves it; the first values of the memory.
  struct State {
    double time;              ///< [s]
    double azimuth, speed;    ///< of blade 1 [rad], [rad/s]
    double acceleration;      ///< before the last step, of which the next makes a second-order one [rad/s2]
    double generator_torque;  ///< from now on, on the shaft [N m]
    double shaft_torque;      ///< of the last step, on what carries the rotor, brake included [N m]
    double mode;              ///< one of Mode
    double asked;             ///< pitch that all blades are asked for [rad]
    ControllerDtuState controller;
  };
  enum class Mode { parked, starting, operating, stopping, tripped, braked };

  TurbineControl(const ControlOptions& options, const ControllerOptions& controller, const std::optional<Operation>& operation,
                 int blades, double start_azimuth, double start_speed, double start_pitch);

  std::size_t memory_size() const { return head + 3 * std::size_t(blades_); }
  std::size_t blades() const { return std::size_t(blades_); }
  const ControllerDtu& controller() const { return law_; }
  double inertia() const { return inertia_; }              ///< of rotor and generator about the shaft [kg m2]
  double rotor_inertia() const { return rotor_inertia_; }  ///< of what turns with the blades [kg m2]
  double efficiency() const { return efficiency_; }
  /// Speed and pitch with which a run begins.
  double start_speed() const { return start_speed_; }
  double start_pitch() const { return start_pitch_; }

  /// Settled at the start, under this torque of the air [N m] in this wind along the axis [m/s].
  void begin(double t, double aero_torque, double wind, std::span<double> memory) const;
  /// From t - h to t, at whose end the air puts this torque on the rotor (at the speed and pitch that the memory has).
  void advance(double t, double h, double aero_torque, double wind, std::span<double> memory) const;

  static State state(std::span<const double> memory);
  std::span<const double> pitch(std::span<const double> memory) const { return memory.subspan(head, std::size_t(blades_)); }

 private:
  static constexpr std::size_t head = sizeof(State) / sizeof(double);
  static void store(const State& s, std::span<double> memory);
  double least_pitch(double wind) const;
  void happen(double t, double h, State& s, std::span<double> stuck) const;
  double brake(const State& s) const;

  ControllerDtu law_;
  ControllerOptions options_;
  Operation below_rated_;  ///< least pitch against wind
  std::vector<EventOptions> events_;
  int blades_;
  double inertia_, rotor_inertia_, efficiency_, start_azimuth_, start_speed_, start_pitch_;
  bool starts_parked_;
};

}  // namespace spindrift::aero
