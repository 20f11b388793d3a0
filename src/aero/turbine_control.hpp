// The drive train with its controller: rotor speed from aerodynamic and generator torque, pitch of each blade by a servo, modes
// of operation by events in time. All that it remembers is a row of plain numbers that the caller keeps, so that windows repeat
// and runs go on from it; a controller library keeps more, which bladed_library.hpp brings to where the row stands. Laws:
// kernels/rotor/controller_dtu.hpp; docs/theory/rotor_engineering.md. Used by rotor_loads.cpp;
// tested in tests/src/aero/turbine_control_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "kernels/rotor/controller_dtu.hpp"
#include "src/aero/bladed_library.hpp"
#include "src/aero/control_options.hpp"
#include "src/aero/peak_shaving.hpp"

namespace spindrift::aero {

/// Our own controller; `operation` holds the tip-speed ratio where its file gives no gain.
ControllerDtu law_of(const ControlOptions& options, const ControllerOptions& controller,
                     const std::optional<Operation>& operation);

class TurbineControl {
 public:
  /// What the rotor does as the controller leaves it; the first values of the memory.
  struct State {
    double time;              ///< [s]
    double azimuth, speed;    ///< of blade 1 [rad], [rad/s]
    double acceleration;      ///< by the air, before the last step, of which the next makes a second-order one [rad/s2]
    double generator_torque;  ///< over the next step, on the shaft [N m]
    double shaft_torque;      ///< of the last step, on what carries the rotor, brake included [N m]
    double mode;              ///< one of Mode
    double asked;             ///< pitch that the blades are asked for, their mean [rad]
    double brake_torque;      ///< of the brake over the next step, at most [N m]
    double calls;             ///< that a library has had
    ControllerDtuState controller;
  };
  /// What is measured at the end of a step; what only libraries use may be left out.
  struct Measured {
    double torque = 0.0;                       ///< of the blades, at the speed and pitch that the memory has [N m]
    double wind = 0.0;                         ///< along the axis, that the hub meets [m/s]
    double wind_speed = 0.0, yaw_error = 0.0;  ///< horizontal, at the hub [m/s]; of it, from the axis [rad]
    /// Of the hub [m/s] and of what carries the rotor [rad/s]: downwind, to the left when facing downwind, and up.
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero(), turning = Eigen::Vector3d::Zero();
    double bending_inertia = 0.0;  ///< of the rotor, that bends instead of following the shaft [kg m2]
  };
  enum class Mode { parked, starting, operating, stopping, tripped, braked };

  /// With which a run begins.
  struct Start {
    double azimuth = 0.0, speed = 0.0, pitch = 0.0;  ///< of blade 1 [rad], [rad/s], [rad]
    bool parked = false;
  };

  TurbineControl(const ControlOptions& options, const ControllerOptions& controller, const std::optional<Operation>& operation,
                 int blades, const Start& start, const std::optional<PeakShaving>& shaving = {});
  /// Of options whose model is "library", called at steps of `step_s`.
  TurbineControl(const ControlOptions& options, int blades, const Start& start, double step_s);

  std::size_t memory_size() const {
    return head + 4 * std::size_t(blades_) + (library_ ? 6 : 0) + (has_elastic_shaft() ? shaft_size : 0);
  }
  /// What twists between rotor and generator, where it does.
  struct Shaft {
    double twist, generator_speed;  ///< of the rotor ahead of the generator [rad]; [rad/s]
    double torque;                  ///< in the last step, on the generator [N m]
  };
  bool has_elastic_shaft() const { return drive_train_.shaft_stiffness_N_m_rad.has_value(); }
  Shaft shaft(std::span<const double> memory) const;
  double generator_speed(std::span<const double> memory) const { return generator_speed(state(memory), memory); }
  std::size_t blades() const { return std::size_t(blades_); }
  const DriveTrainOptions& drive_train() const { return drive_train_; }
  /// Null where the controller is our own.
  BladedLibrary* library() const { return library_.get(); }
  const Start& start() const { return start_; }

  /// Settled at the start; a library's first call.
  void begin(double t, const Measured& measured, std::span<double> memory) const;
  /// From t - h to t.
  void advance(double t, double h, const Measured& measured, std::span<double> memory) const;

  static State state(std::span<const double> memory);
  std::span<const double> pitch(std::span<const double> memory) const { return memory.subspan(head, std::size_t(blades_)); }

 private:
  static constexpr std::size_t head = sizeof(State) / sizeof(double);
  static constexpr std::size_t shaft_size = sizeof(Shaft) / sizeof(double);  ///< at the memory's end
  static void store(const State& s, std::span<double> memory);
  void store(const Shaft& shaft, std::span<double> memory) const;
  double generator_speed(const State& s, std::span<const double> memory) const {
    return has_elastic_shaft() ? shaft(memory).generator_speed : s.speed;
  }
  /// Of each blade [rad], [rad/s], 1 where it is stuck, [rad]; of libraries, whose last step's motion is kept too.
  struct Rows {
    std::span<double> pitch, rate, stuck, asked, velocity, turning;
  };
  Rows rows(std::span<double> memory) const;
  /// Events later than `after` and not later than t; whether there was any.
  bool happen(double after, double t, State& s, std::span<double> stuck) const;
  double brake(const State& s) const;
  void lay_shaft(const Measured& measured, State& s, std::span<double> memory) const;
  double turned_inertia(const Measured& measured) const;
  void turn_rigid(double h, const Measured& measured, State& s) const;
  void turn_elastic(double h, const Measured& measured, State& s, std::span<double> memory) const;
  void ask_law(double h, const Measured& measured, double speed, State& s, const Rows& rows) const;
  void ask_library(double t, double h, const Measured& measured, double generator_speed, State& s, const Rows& rows) const;
  void feather(double h, double rate, State& s, const Rows& rows) const;
  void turn_blades(double h, const Rows& rows) const;

  DriveTrainOptions drive_train_;
  /// Our own controller.
  struct Law {
    ControllerDtu dtu;
    double stop_pitch_rate = 0.0;  ///< [rad/s]
    Operation below_rated;         ///< least pitch against wind
    double least_pitch(double wind) const;
  };
  Law law_;
  std::vector<EventOptions> events_;
  int blades_;
  Start start_;
  std::unique_ptr<BladedLibrary> library_;
  double step_ = 0.0;  ///< that a library is told of at its first call [s]
};

}  // namespace spindrift::aero
