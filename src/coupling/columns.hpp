// The columns of history.csv that a floating system can have, each declared once: name, unit, sentence, value. Recorder, window
// and resolved air fill them; the air alone (src/run) shares those of the rotor and adds its own. Conventions:
// docs/user/conventions.md. Tested in tests/src/coupling/columns_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "kernels/rigid/wrench.hpp"
#include "src/aero/rotor_loads.hpp"
#include "src/bodies/beams.hpp"
#include "src/bodies/state.hpp"
#include "src/coupling/yaw_drive.hpp"
#include "src/io/column_group.hpp"
#include "src/moorings/moorings.hpp"
#include "src/sea/particle_sea.hpp"

namespace spindrift::aero {
struct MarchState;
struct MassBalance;
}  // namespace spindrift::aero

namespace spindrift::coupling {

struct WindowReport;

/// Motion of the reference point of a body and of the body round it, as it is written.
struct ReferenceMotion {
  Eigen::Vector3d displacement, velocity, acceleration;  ///< of the point, earth axes [m], [m/s], [m/s2]
  Eigen::Vector3d angles;                                ///< roll, pitch, yaw since the start [rad]
  Eigen::Vector3d omega, omega_rate;                     ///< earth axes [rad/s], [rad/s2]
};

struct RotorRow {
  aero::RotorLoad load;
  double azimuth_deg, rpm;
};

struct WaterRow {
  double lost, left;
  sea::ParticleSea::Extent extent;
};

/// Energy of all bodies together, and what made it so since the start of the run [J].
struct EnergyRow {
  double kinetic;
  std::span<const double> after_sources;  ///< by bodies::EnergyBalance
};

template <class Source>
using Table = std::span<const io::ColumnOf<Source>>;

Table<ReferenceMotion> motion_columns();         ///< BODY.
Table<Wrench> wrench_columns();                  ///< BODY.SOURCE., JOINT.
Table<bodies::BeamReading> beam_columns();       ///< BEAM.
Table<double> constraint_columns();              ///< joints.
Table<EnergyRow> energy_columns();               ///< energy.
Table<double> work_columns();                    ///< energy.SOURCE.
Table<RotorRow> rotor_columns();                 ///< rotor.
Table<aero::RotorState> hub_columns();           ///< rotor.
Table<Eigen::Vector3d> wind_columns();           ///< rotor.
Table<aero::RotorLoads::Drive> drive_columns();  ///< rotor., of a controlled one
Table<aero::RotorLoads::Drive> shaft_columns();  ///< rotor., of one whose shaft twists
Table<YawDrive::Reading> yaw_columns();          ///< rotor., of one with a yaw drive
Table<double> pitch_columns();                   ///< rotor.blade_N., likewise
Table<aero::BladeRootLoad> root_columns();
Table<Eigen::Vector2d> tip_columns();            ///< rotor.blade_N., where blade masses are given
Table<aero::RotorLoad> blade_columns();          ///< rotor.blade_N.
Table<moorings::LineTension> mooring_columns();  ///< MOORING.
Table<moorings::LineTension> anchor_columns();   ///< MOORING., of a dynamic line
Table<LineEnd> junction_columns();               ///< JUNCTION.
Table<double> wave_columns();                    ///< waves.
Table<WaterRow> water_columns();                 ///< sea.
Table<sph::Wavemaker::Stroke> paddle_columns();
Table<double> gauge_columns();
Table<sea::ParticleSea::Reading> probe_columns();
Table<double> run_up_columns();
Table<sph::PatchReading> sensor_columns();
Table<WindowReport> window_columns();     ///< coupling.
Table<WindowReport> strong_columns();     ///< coupling., of schemes that iterate
Table<aero::MarchState> march_columns();  ///< air.
Table<double> time_error_columns();       ///< air.
Table<aero::MassBalance> mass_columns();  ///< air., of the air alone flow.

/// All of them, for pages.
std::vector<io::ColumnSection> column_sections();

}  // namespace spindrift::coupling
