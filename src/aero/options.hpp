// Options of the rotor and its air at engineering fidelity: [aero], [rotor] or [rotors.NAME], and the rules between them.
// Declared in options.cpp; read by src/app; tested in tests/src/aero/options_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kernels/base/constants.hpp"
#include "src/aero/actuator_options.hpp"
#include "src/aero/flow_options.hpp"
#include "src/aero/rotor_grid/options.hpp"
#include "src/aero/tower.hpp"
#include "src/aero/turbine.hpp"
#include "src/aero/wind_options.hpp"

namespace spindrift::scene {
template <class Options>
class Section;
class Document;
}  // namespace spindrift::scene

namespace spindrift::aero {

struct AeroOptions {
  std::string model = "none";
  // prescribed
  std::optional<double> thrust_N;
  std::vector<double> thrust_cosine_N, thrust_sine_N;
  double torque_N_m = 0.0;
  std::vector<double> torque_cosine_N_m, torque_sine_N_m;
  int harmonic_step = 1;  ///< harmonic k turns with k * harmonic_step azimuths
  std::string table;      ///< path: load against time
  std::string thrust_frame = "rotor";
  // thrust_curve
  std::optional<double> thrust_coefficient;
  double torque_coefficient = 0.0;
  std::string curve;  ///< path: load against wind, or coefficients against tip-speed ratio
  std::string interpolation = "linear";
  // bem
  std::string induction = "madsen";
  bool skew_momentum = true;
  std::string dynamic_inflow = "none", dynamic_stall = "none";
  std::optional<double> inflow_time_s;                                                       ///< absent: by wind and induction
  double wake_turns = 12.0, wake_step = 15.0 * radians_per_degree, wake_core_chords = 0.25;  ///< free_vortex; step [rad]
  double stall_lag_chords = 4.0;                                                             ///< of dynamic stall after Oye
  double speed_of_sound_m_s = 340.0;               ///< of dynamic stall after Beddoes & Leishman
  std::optional<double> kinematic_viscosity_m2_s;  ///< for polars by Reynolds number; absent: air_kinematic_viscosity
  std::optional<TowerOptions> tower;
  std::optional<FlowOptions> flow;       ///< blade_resolved, actuators
  std::optional<RotorGridOptions> grid;  ///< resolved rotor
  std::optional<ActuatorOptions> actuator;

  /// Blades that act on the resolved air without being in its grid.
  bool acts() const { return model == "actuator_disc" || model == "actuator_line"; }
  bool resolves_air() const { return model == "blade_resolved" || acts(); }
  /// Of the air that blades meet [m2/s]; of resolved air its own.
  double kinematic_viscosity(double air_density_kg_m3) const {
    return flow ? flow->viscosity_Pa_s / air_density_kg_m3 : kinematic_viscosity_m2_s.value_or(air_kinematic_viscosity);
  }
};

/// Which way a rotor turns, seen from upwind.
enum class Turning { clockwise, counter_clockwise };

/// [rotor]; [rotors.NAME], which has the last two too.
struct RotorOptions {
  std::string body;                                 ///< takes the load
  std::string joint;                                ///< the bearing: gives hub, axis and rotation; empty: the next three
  Eigen::Vector3d hub_m = Eigen::Vector3d::Zero();  ///< initial earth coordinates
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
  double speed = 0.0;        ///< [rad/s]
  double azimuth = 0.0;      ///< at the start [rad]
  double blade_pitch = 0.0;  ///< [rad], positive nose into the wind
  std::optional<double> diameter_m;
  std::string turbine;                    ///< path: blades as data
  std::string operation;                  ///< path: rotor speed, pitch and power against wind
  std::string operating_point = "given";  ///< given, table
  std::string blade_masses;               ///< path: mass along the blades, for loads at their roots; empty: not written
  std::string blade_structure;            ///< path: mass and stiffness along blades that bend; empty: rigid
  std::vector<double> blade_damping{0.005, 0.005, 0.005};  ///< of their modes, share of the critical one
  Turning turns = Turning::clockwise;
  std::optional<std::array<double, 2>> tower_foot_m;  ///< of its own tower, in place of that of [aero.tower]

  /// About the axis; -1: against it.
  double sense() const { return turns == Turning::clockwise ? 1.0 : -1.0; }
};

const scene::Section<AeroOptions>& aero_section();
const scene::Section<RotorOptions>& rotor_section();
const scene::Section<RotorOptions>& rotors_section();

/// Rules between sections: the body and joint exist, the rotor has what its model needs, data files are readable. `section`:
/// the rotor's, "rotor" or "rotors.NAME".
/// Keys of blades that a model without them has no use for, and a diameter that the turbine's blades do not have.
void check_blade_keys(scene::Document& doc, const AeroOptions& aero, const RotorOptions& rotor, const std::string& section);
void check_rotor(scene::Document& doc, const AeroOptions& aero, const RotorOptions& rotor, std::span<const std::string> bodies,
                 std::span<const std::string> joints, const std::string& section = "rotor");

}  // namespace spindrift::aero
