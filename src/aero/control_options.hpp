// [control]: who turns the rotor and pitches its blades, with what happens when; and the file of a controller's constants.
// Declared in control_options.cpp; read by src/coupling; acted on by turbine_control.cpp; tested in
// tests/src/aero/turbine_control_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "src/aero/operation.hpp"

namespace spindrift::scene {
template <class Options>
class Section;
class Document;
}  // namespace spindrift::scene

namespace spindrift::aero {

struct AeroOptions;
struct RotorOptions;

enum class ControlModel { none, dtu, library };
enum class Tuning { fixed_foundation, floating };
enum class ControlStart { operating, parked };
enum class ControlEvent { start_up, shut_down, emergency_stop, grid_loss, blade_stuck };

/// [[control.events]]
struct EventOptions {
  ControlEvent what = ControlEvent::shut_down;
  double time_s = 0.0;
  int blade = 1;                     ///< of blade_stuck
  std::optional<std::string> rotor;  ///< the one of several that it happens to; absent: all
};

/// [control.drive_train]: what a controller library turns and pitches. Torques and inertias on the low-speed shaft, but for the
/// gear's ratio.
struct DriveTrainOptions {
  double rotor_inertia_kg_m2 = 0.0, generator_inertia_kg_m2 = 0.0;
  double gear_ratio = 1.0;
  double generator_efficiency = 1.0;
  double brake_torque_N_m = 0.0;
  double feather = 1.5707963267948966, max_pitch_rate = 0.17453292519943295;  ///< [rad], [rad/s]
  double max_pitch_acceleration = 0.2617993877991494;                         ///< of a servo [rad/s2]
  std::optional<double> servo_frequency_Hz;                                   ///< absent: blades are where they are asked to be
  double servo_damping = 0.7;
  std::optional<double> shaft_stiffness_N_m_rad;  ///< absent: the shaft is rigid
  double shaft_damping_N_m_s_rad = 0.0;
};

/// [[control.records]]
struct RecordOptions {
  int record = 1;
  double value = 0.0;
};

/// [control.yaw]
struct YawOptions {
  std::string joint;
  double start_error = 0.13962634015954636, stop_error = 0.017453292519943295;  ///< 8 and 1 degrees [rad]
  double filter_time_s = 10.0, delay_s = 60.0;
  double rate = 0.005235987755982988;  ///< 0.3 deg/s [rad/s]
  double stiffness_N_m_rad = 0.0, damping_N_m_s_rad = 0.0;
};

/// [control]
struct ControlOptions {
  ControlModel model = ControlModel::none;
  std::string file;  ///< path of the controller's constants; empty: as the turbine names it
  Tuning tuning = Tuning::fixed_foundation;
  ControlStart start = ControlStart::operating;
  std::vector<EventOptions> events;
  std::optional<YawOptions> yaw;
  std::optional<double> peak_shaving;  ///< share of the largest steady thrust that is left [-]
  // of "library"
  std::string library, input_file;  ///< paths
  std::string procedure = "DISCON", output_name = "controller";
  bool individual_pitch = false;
  std::vector<RecordOptions> records;
  std::optional<DriveTrainOptions> drive_train;
};

/// [pitch_gains] of a controller file.
struct PitchGainOptions {
  double kp_s = 0.0, ki = 0.0;
  std::optional<double> schedule_linear_deg, schedule_quadratic_deg2;
  double doubling_speed = 1.3;  ///< over rated
  bool constant_power = true;
};

/// [controller] of a controller file. Speeds and torques on the low-speed shaft.
struct ControllerOptions : DriveTrainOptions {
  ControllerOptions() { servo_frequency_Hz = 1.0; }

  double rated_power_W = 0.0;                 ///< electrical
  double min_speed = 0.0, rated_speed = 0.0;  ///< [rad/s]
  double max_torque_N_m = 0.0;
  std::optional<double> torque_gain_N_m_s2;
  double torque_kp_N_m_s = 0.0, torque_ki_N_m = 0.0;
  double filter_frequency_Hz = 0.4, filter_damping = 0.7;
  double max_pitch = 1.5707963267948966;
  double switch_pitch = 0.008726646259971648;
  PitchGainOptions gains;
  std::optional<PitchGainOptions> floating_gains;
  double stop_pitch_rate = 0.03490658503988659;  ///< [rad/s]
};

const scene::Section<ControlOptions>& control_section();
const scene::Section<ControllerOptions>& controller_section();

/// Throws scene::SceneError with all that is wrong with the file.
ControllerOptions read_controller(const std::string& path);

/// Rules with [aero], the rotor (of `section`) and the files; `operation` is empty where the scene has none.
void check_control(scene::Document& document, const ControlOptions& control, const AeroOptions& aero, const RotorOptions& rotor,
                   const std::optional<Operation>& operation, int blades, const std::string& section = "rotor");

}  // namespace spindrift::aero
