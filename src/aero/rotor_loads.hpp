// The rotor at engineering fidelity: where it is, how it turns, and the thrust and torque of its model on its body.
// Thrust acts at the hub along the rotor axis, torque about it; both follow the attitude of the rotor's body. Blade element
// momentum adds the forces and moments across the axis. Signs: docs/user/conventions.md. Equations:
// docs/theory/rotor_engineering.md. Built and called by src/coupling; tested in tests/src/aero/rotor_loads_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <variant>

#include "src/aero/blade_loads.hpp"
#include "src/aero/options.hpp"
#include "src/aero/prescribed.hpp"
#include "src/aero/rotor_bearing.hpp"
#include "src/aero/thrust_curve.hpp"
#include "src/aero/turbine_control.hpp"

namespace spindrift::aero {

struct RotorLoad {
  double thrust = 0.0;        ///< [N]
  double torque = 0.0;        ///< [N m]
  double power = 0.0;         ///< torque times rotor speed [W]
  double shaft_torque = 0.0;  ///< of the blades on the hub: of the air and, where they bend, their inertia [N m]
  /// Of the rotor, about the hub, earth frame; not of the tower's drag.
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();

  RotorLoad times(double factor) const {
    return {factor * thrust, factor * torque, factor * power, factor * shaft_torque, factor * force, factor * moment};
  }
};

/// Of the air on the blades, about the hub, earth frame [N], [N m].
struct HubLoad {
  Eigen::Vector3d force, moment;
};

/// Along the axis, relative to a hub that is there and moves so [m/s].
inline double relative_wind(const Wind& wind, double t, const Eigen::Vector3d& hub, const Eigen::Vector3d& hub_velocity,
                            const Eigen::Vector3d& axis) {
  return (wind.at(t, hub) - hub_velocity).dot(axis);
}

/// From [rotor], else from the blades; 0 where nothing says [m].
double rotor_diameter(const RotorOptions& rotor);

class RotorLoads {
 public:
  /// `start`: initial motions of all bodies, in the order of every later call; `step_s`: of the bodies. Data files have been
  /// checked (check_rotor); throws scene::SceneError where one cannot be read.
  RotorLoads(const AeroOptions& aero, const RotorOptions& rotor, Wind wind, double air_density_kg_m3,
             const RotorPlacement& placement, std::span<const Motion> start, const ControlOptions& control = {},
             double step_s = 0.0, const Eigen::Vector3d& gravity_m_s2 = Eigen::Vector3d::Zero());

  /// Adds the rotor's load, times `ramp`, to its body's wrench.
  void add_loads(double t, std::span<const Motion> bodies, std::span<Wrench> wrenches, double ramp = 1.0) const;

  /// The same under the mean wind (the scene's own at the start, without gusts and turbulence), as a mean over a turn of blade 1.
  void add_mean_loads(double t, std::span<const Motion> bodies, std::span<Wrench> wrenches) const;

  /// Adds the tower's drag, times `ramp`, to the wrench of what carries the rotor, whatever the rotor's own load is; and the same
  /// under the mean wind.
  void add_tower_drag(double t, std::span<const Motion> bodies, std::span<Wrench> wrenches, double ramp = 1.0) const;
  void add_mean_tower_drag(double t, std::span<const Motion> bodies, std::span<Wrench> wrenches) const;

  /// Blades that bend do not follow the rotor's body at once: adds what they take off its inertia, about its centre of mass,
  /// earth axes, [force; moment]. Rigid ones, and blades under mean loads, are masses of the body.
  void add_added_mass(double t, std::span<const Motion> bodies, std::span<Eigen::Matrix<double, 6, 6>> matrices) const;

  /// Adds a load of air computed elsewhere, times `ramp`; with a drive train the shaft's torque acts on the body, not the air's.
  void add_air_load(double t, std::span<const Motion> bodies, std::span<Wrench> wrenches, const HubLoad& air,
                    double ramp = 1.0) const;
  /// The drive train is turned by this moment of the air [N m] in time instead of that of the model, where it is given.
  using AirMoment = std::function<Eigen::Vector3d(double)>;
  void turn_by(AirMoment moment) { air_moment_ = std::move(moment); }

  RotorState state(double t, std::span<const Motion> bodies) const;
  const RotorBearing& bearing() const { return bearing_; }
  /// Index of what takes the tower's drag; none without drag, or where that is the earth.
  std::optional<std::size_t> body_of_tower_drag() const {
    return tower_ && tower_->has_drag() ? bearing_.carrier() : std::nullopt;
  }
  /// Undisturbed.
  const Wind& wind() const { return wind_; }
  RotorLoad load(double t, const RotorState& now, double ramp = 1.0) const;

  /// Of blade elements; empty where no polar depends on it.
  std::optional<ReynoldsReach> reynolds(double t, const RotorState& now) const;

  // What the rotor remembers from step to step, as bodies::Memory has it: the drive train with its controller, then the blades.
  // Without values to recall it turns as at the start, in steady flow.
  std::size_t memory_size() const { return drive_size() + (blades() ? blades()->memory_size() : 0); }
  void begin(double t, std::span<const Motion> bodies, std::span<double> memory);
  void recall(std::span<const double> memory) { memory_.assign(memory.begin(), memory.end()), last_.known = false; }
  void remember(double t, double h, std::span<const Motion> bodies, std::span<double> memory) const;

  /// Loads at the blades' roots, one to a blade; none without their masses. Acceleration of the rotor's body: of its
  /// centre of mass and of its turning, earth frame. Of a rotor that no body turns, a change of its speed is left out.
  std::vector<BladeRootLoad> root_loads(double t, std::span<const Motion> bodies, const Eigen::Vector3d& acceleration,
                                        const Eigen::Vector3d& omega_rate, const Eigen::Vector3d& gravity_m_s2,
                                        double ramp = 1.0) const;

  /// Null where the model knows no sections.
  const BladeLoads* blades() const { return std::get_if<BladeLoads>(&model_); }
  /// Null where blades are rigid.
  const FlexibleBlades* flexible() const { return blades() ? blades()->flexible() : nullptr; }
  /// Bending of each blade's tip, downwind and ahead [m].
  std::vector<Eigen::Vector2d> tips(double t, std::span<const Motion> bodies) const;

  /// Null where nothing controls the rotor.
  const TurbineControl* control() const { return control_ ? &*control_ : nullptr; }
  /// Null where the peak of thrust is not cut.
  const PeakShaving* shaving() const { return shaving_ ? &*shaving_ : nullptr; }
  /// What the controller does; of the values recalled last, which must be there.
  struct Drive {
    double generator_torque, electrical_power, asked_pitch;  ///< [N m] on the shaft, [W], [rad]
    std::span<const double> pitch;                           ///< of each blade [rad]
    TurbineControl::Shaft shaft;                             ///< of an elastic one
  };
  Drive drive() const;

 private:
  BladesAt blades_at(const Wind& wind, double t, const RotorState& now, std::span<const double> memory) const;
  /// Of the memory; the rest is the blades'.
  std::size_t drive_size() const { return control_ ? control_->memory_size() : 0; }
  TurbineControl::Measured measured(double t, const RotorState& now) const;
  /// Of a drive train, by the memory; throws NumericalFailure.
  void require_slow_tips(double t, std::span<const double> memory) const;
  /// Under the scene's own wind. What was asked for last is not computed again: a row of history asks for what a step did.
  const BladeLoads::Load& blade_load(double t, const RotorState& now) const;
  /// Without what the drive train adds. `air`: of the blades; null for models without sections.
  RotorLoad load(const Wind& wind, double t, const RotorState& now, double ramp, const BladeLoads::Load* air) const;
  void add_tower_drag(const Wind& wind, double t, std::span<const Motion> bodies, std::span<Wrench> wrenches, double ramp) const;
  Wind mean_wind() const;
  void add_drive(const RotorState& now, double torque, double ramp, Eigen::Vector3d& moment) const;

  RotorBearing bearing_;
  std::optional<Eigen::Vector3d> thrust_direction_;  ///< earth frame, where the thrust does not follow the axis
  TurbineControl::Start start_;
  double tip_radius_ = 0.0;  ///< of a drive train's rotor [m]; 0 where it is not known
  Wind wind_;
  std::optional<PeakShaving> shaving_;
  std::optional<TurbineControl> control_;
  std::optional<Tower> tower_;
  Eigen::Vector3d gravity_;     ///< [m/s2]
  std::vector<double> memory_;  ///< recalled; empty: steady
  std::variant<std::monostate, Prescribed, ThrustCurve, BladeLoads> model_;
  AirMoment air_moment_;
  struct LastLoad {
    bool known = false;
    double t = 0.0;
    RotorState now;
    BladeLoads::Load load;
  };
  mutable LastLoad last_;
};

}  // namespace spindrift::aero
