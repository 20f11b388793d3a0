// SPDX-License-Identifier: Apache-2.0
#include "src/aero/control_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "src/aero/bladed_library.hpp"
#include "src/aero/options.hpp"
#include "src/aero/thrust_curve.hpp"
#include "src/scene/document.hpp"

namespace spindrift::aero {

namespace {

const scene::Section<EventOptions>& event_section() {
  static const auto section =
      scene::Section<EventOptions>("events", "Something that happens to the turbine.")
          .choice(
              "what", &EventOptions::what,
              {{"start_up", ControlEvent::start_up, "blades come from feather, the generator joins at least speed"},
               {"shut_down", ControlEvent::shut_down, "blades go to feather at stop_pitch_rate, the generator helps to stop"},
               {"emergency_stop", ControlEvent::emergency_stop, "no generator, blades to feather as fast as they can, brake on"},
               {"grid_loss", ControlEvent::grid_loss, "no generator, blades to feather as fast as they can"},
               {"blade_stuck", ControlEvent::blade_stuck, "one blade stays at its pitch from then on"}},
              "Which.")
          .required()
          .number("time_s", &EventOptions::time_s, "s", "When.", scene::not_negative())
          .required()
          .integer("blade", &EventOptions::blade, "-", "Blade that is stuck.", scene::between(1, 12))
          .only_if("what", {"blade_stuck"})
          .text("rotor", &EventOptions::rotor, "Name of the one of [rotors] that it happens to; without it all of them.");
  return section;
}

scene::Section<PitchGainOptions> gain_section(const char* name, const char* help) {
  return scene::Section<PitchGainOptions>(name, help)
      .number("kp_s", &PitchGainOptions::kp_s, "s", "Pitch per excess of speed [rad/(rad/s)].", scene::not_negative())
      .required()
      .number("ki", &PitchGainOptions::ki, "-", "Pitch per excess of angle [rad/rad].", scene::not_negative())
      .required()
      .number("schedule_linear_deg", &PitchGainOptions::schedule_linear_deg, "deg",
              "KK1: gains fall by 1 / (1 + pitch/KK1 + pitch^2/KK2).", scene::positive())
      .number("schedule_quadratic_deg2", &PitchGainOptions::schedule_quadratic_deg2, "deg2", "KK2.", scene::positive())
      .number("doubling_speed", &PitchGainOptions::doubling_speed, "-",
              "Speed over rated speed at which both gains are doubled: above rated they grow by 1 + ((speed/rated - 1) / "
              "(doubling_speed - 1))^2.",
              scene::between(1.01, 1000.0))
      .flag("constant_power", &PitchGainOptions::constant_power, "Above rated; false: constant torque.");
}

/// Records that the program fills, or reads.
bool is_taken(int record) {
  constexpr std::array others{1, 28, 35, 36, 41, 42, 43, 44, 45, 46, 47, 48, 49, 50, 51, 55, 56, 61, 62, 63, 64, 65, 102, 107};
  return std::ranges::find(others, record) != others.end() ||
         std::ranges::find(BladedLibrary::records, record) != BladedLibrary::records.end();
}

const scene::Section<RecordOptions>& record_section() {
  static const auto section =
      scene::Section<RecordOptions>("records",
                                    "A number that a controller library is told once, besides what the program tells it.")
          .integer("record", &RecordOptions::record, "-", "Its place in the interface's array, counted from 1.",
                   scene::between(1, 3000))
          .required()
          .number("value", &RecordOptions::value, "-", "What stands there.")
          .required()
          .check([](const RecordOptions& o, const scene::Report& report) {
            if (is_taken(o.record)) report("record", "is filled by the program or by the library");
          });
  return section;
}

void check_shaft(const DriveTrainOptions& o, const scene::Report& report) {
  if (o.shaft_stiffness_N_m_rad && o.generator_inertia_kg_m2 <= 0.0)
    report("shaft_stiffness_N_m_rad", "needs a generator_inertia_kg_m2 above 0 at the shaft's other end");
  if (!o.shaft_stiffness_N_m_rad && o.shaft_damping_N_m_s_rad > 0.0)
    report("shaft_damping_N_m_s_rad", "has no effect without shaft_stiffness_N_m_rad");
}

/// A member of the drive train as one of the options that hold it.
template <class Options, class M>
M Options::*of(M DriveTrainOptions::*member) {
  return member;
}

/// Keys of a drive train, which a controller file and [control.drive_train] have alike.
template <class Options>
scene::Section<Options> with_drive_train(scene::Section<Options> section) {
  using scene::positive, scene::not_negative, scene::between;
  using Train = DriveTrainOptions;
  return section
      .number("rotor_inertia_kg_m2", of<Options>(&Train::rotor_inertia_kg_m2), "kg m2",
              "Blades and hub about the shaft; not in the inertia of the rotor's body.", positive())
      .required()
      .number("generator_inertia_kg_m2", of<Options>(&Train::generator_inertia_kg_m2), "kg m2",
              "Generator, referred to the low-speed shaft.", not_negative())
      .number("shaft_stiffness_N_m_rad", of<Options>(&Train::shaft_stiffness_N_m_rad), "N m/rad",
              "Against twist between rotor and generator, on the low-speed shaft; without it the shaft is rigid.", positive())
      .number("shaft_damping_N_m_s_rad", of<Options>(&Train::shaft_damping_N_m_s_rad), "N m s/rad", "Against its rate.",
              not_negative())
      .number("generator_efficiency", of<Options>(&Train::generator_efficiency), "-", "Electrical over shaft power.",
              between(0.1, 1.0))
      .number("brake_torque_N_m", of<Options>(&Train::brake_torque_N_m), "N m", "Of the brake, on the low-speed shaft.",
              not_negative())
      .degrees("feather_deg", of<Options>(&Train::feather), "Pitch of feathered blades.", between(45.0, 120.0))
      .degrees("max_pitch_rate_deg_s", of<Options>(&Train::max_pitch_rate), "Largest rate of the blades' pitch.",
               between(0.01, 100.0), "deg/s")
      .number("servo_frequency_Hz", of<Options>(&Train::servo_frequency_Hz), "Hz",
              "Of the pitch servo; where there is none, blades go where they are asked to as fast as they may.", positive())
      .number("servo_damping", of<Options>(&Train::servo_damping), "-", "Its damping ratio.", between(0.1, 2.0))
      .degrees("max_pitch_acceleration_deg_s2", of<Options>(&Train::max_pitch_acceleration), "Its largest acceleration.",
               between(0.01, 1000.0), "deg/s2");
}

const scene::Section<DriveTrainOptions>& drive_train_section() {
  static const auto section =
      with_drive_train(scene::Section<DriveTrainOptions>("drive_train", "What a controller library turns and pitches."))
          .number("gear_ratio", &DriveTrainOptions::gear_ratio, "-", "Generator speed over rotor speed.", scene::positive())
          .check(check_shaft);
  return section;
}

const scene::Section<YawOptions>& yaw_section() {
  using scene::positive, scene::not_negative, scene::between;
  static const auto section =
      scene::Section<YawOptions>("yaw", "A drive that turns the nacelle into the wind.")
          .text("joint", &YawOptions::joint,
                "The yaw bearing: a revolute joint about an upright axis, the nacelle its second body.")
          .required()
          .degrees("start_error_deg", &YawOptions::start_error,
                   "The drive starts once the filtered wind has been off the rotor's axis by more than this ...",
                   between(0.1, 180.0))
          .number("delay_s", &YawOptions::delay_s, "s", "... for so long.", not_negative())
          .degrees("stop_error_deg", &YawOptions::stop_error, "It stops where the filtered wind is off by no more than this.",
                   between(0.0, 90.0))
          .number("filter_time_s", &YawOptions::filter_time_s, "s",
                  "Time constant of the low-pass filter of the wind at the hub; 0: none.", not_negative())
          .degrees("rate_deg_s", &YawOptions::rate, "At which the nacelle turns.", between(0.001, 20.0), "deg/s")
          .number("stiffness_N_m_rad", &YawOptions::stiffness_N_m_rad, "N m/rad", "Of the drive about the angle asked for.",
                  positive())
          .required()
          .number("damping_N_m_s_rad", &YawOptions::damping_N_m_s_rad, "N m s/rad", "Of the drive about the rate asked for.",
                  not_negative())
          .required()
          .check([](const YawOptions& o, const scene::Report& report) {
            if (!(o.stop_error < o.start_error)) report("stop_error_deg", "must be below start_error_deg");
          });
  return section;
}

void check_controller(const ControllerOptions& o, const scene::Report& report) {
  check_shaft(o, report);
  if (!(o.min_speed < o.rated_speed)) report("min_speed_rpm", "must be below rated_speed_rpm");
  if (o.max_torque_N_m * o.rated_speed < o.rated_power_W / o.generator_efficiency)
    report("max_torque_N_m", fmt::format("times the rated speed is {:.4g} W, below the rated shaft power of {:.4g} W",
                                         o.max_torque_N_m * o.rated_speed, o.rated_power_W / o.generator_efficiency));
}

}  // namespace

const scene::Section<ControlOptions>& control_section() {
  static const auto section =
      scene::Section<ControlOptions>(
          "control",
          "Who turns the rotor and pitches its blades. Mass and inertia of `rotor.body` are those with "
          "the rotor, but its inertia about the shaft is the drive train's alone: the body has none of "
          "it, because the rotor does not follow the body about the shaft.")
          .choice("model", &ControlOptions::model,
                  {{"none", ControlModel::none, "rotor speed and pitch as [rotor] or its bearing has them"},
                   {"dtu", ControlModel::dtu, "generator torque and collective pitch by the Basic DTU controller"},
                   {"library", ControlModel::library,
                    "by a library with Bladed's interface (DISCON), called once after every accepted step"}},
                  "Control of the turbine.")
          .path("file", &ControlOptions::file, "Constants of the controller and the drive train; else those the turbine names.")
          .only_if("model", {"dtu"})
          .choice("tuning", &ControlOptions::tuning,
                  {{"fixed_foundation", Tuning::fixed_foundation, "gains of the turbine on a fixed foundation"},
                   {"floating", Tuning::floating, "the controller file's floating_gains"}},
                  "Which gains of pitch; those of a fixed foundation make a floater's pitch unstable above rated wind.")
          .only_if("model", {"dtu"})
          .choice("start", &ControlOptions::start,
                  {{"operating", ControlStart::operating, "at rotor speed and pitch of the operating point"},
                   {"parked", ControlStart::parked, "at rest, blades feathered"}},
                  "How the turbine stands at the start.")
          .only_if("model", {"dtu"})
          .tables("events", &ControlOptions::events, event_section(), "What happens when.")
          .only_if("model", {"dtu", "library"})
          .number("peak_shaving", &ControlOptions::peak_shaving, "-",
                  "Share of the rotor's largest steady thrust that is left: blades are pitched farther about rated wind, which "
                  "costs power there. Without it nothing is cut.",
                  scene::between(0.4, 1.0))
          .only_if("model", {"dtu"})
          .table("yaw", &ControlOptions::yaw, yaw_section(),
                 "A drive that turns the nacelle into the wind; without it no one does.")
          .path("library", &ControlOptions::library, "The library, a shared object of this computer.")
          .only_if("model", {"library"})
          .required()
          .path("input_file", &ControlOptions::input_file, "File whose name the library is given (DISCON.IN).")
          .only_if("model", {"library"})
          .text("procedure", &ControlOptions::procedure, "Name of the library's procedure.")
          .only_if("model", {"library"})
          .text("output_name", &ControlOptions::output_name, "Beginning of the names of files that the library may write.")
          .only_if("model", {"library"})
          .flag("individual_pitch", &ControlOptions::individual_pitch, "Blades are asked for pitch one by one.")
          .only_if("model", {"library"})
          .tables("records", &ControlOptions::records, record_section(), "Further numbers for the library.")
          .only_if("model", {"library"})
          .table("drive_train", &ControlOptions::drive_train, drive_train_section(), "What the library turns and pitches.")
          .only_if("model", {"library"})
          .required();
  return section;
}

const scene::Section<ControllerOptions>& controller_section() {
  using scene::positive, scene::not_negative, scene::between;
  static const auto fixed = gain_section("gains", "Pitch gains on a fixed foundation.");
  static const auto floating = gain_section("floating_gains", "Pitch gains on a floater.");
  static const auto section =
      with_drive_train(
          scene::Section<ControllerOptions>("controller", "A turbine's controller and drive train, on the low-speed shaft."))
          .number("rated_power_W", &ControllerOptions::rated_power_W, "W", "Electrical.", positive())
          .required()
          .rpm("min_speed_rpm", &ControllerOptions::min_speed, "Least speed of operation.", positive())
          .required()
          .rpm("rated_speed_rpm", &ControllerOptions::rated_speed, "Rated speed.", positive())
          .required()
          .number("max_torque_N_m", &ControllerOptions::max_torque_N_m, "N m", "Of the generator.", positive())
          .required()
          .number("torque_gain_N_m_s2", &ControllerOptions::torque_gain_N_m_s2, "N m s2",
                  "K of Q = K omega^2; where absent the one that holds the tip-speed ratio of rotor.operation.", positive())
          .number("torque_kp_N_m_s", &ControllerOptions::torque_kp_N_m_s, "N m s", "Torque per excess of speed.", not_negative())
          .number("torque_ki_N_m", &ControllerOptions::torque_ki_N_m, "N m", "Torque per excess of angle.", not_negative())
          .number("filter_frequency_Hz", &ControllerOptions::filter_frequency_Hz, "Hz", "Low-pass filter of the speed.",
                  positive())
          .number("filter_damping", &ControllerOptions::filter_damping, "-", "Its damping ratio.", between(0.1, 2.0))
          .degrees("max_pitch_deg", &ControllerOptions::max_pitch, "Largest pitch of operation.", between(1.0, 120.0))
          .degrees("switch_pitch_deg", &ControllerOptions::switch_pitch, "Full load begins this far above the least pitch.",
                   between(0.0, 10.0))
          .table("gains", &ControllerOptions::gains, fixed, "Pitch gains on a fixed foundation.")
          .table("floating_gains", &ControllerOptions::floating_gains, floating, "Pitch gains on a floater.")
          .degrees("stop_pitch_rate_deg_s", &ControllerOptions::stop_pitch_rate, "Rate of pitch in a shut-down and a start-up.",
                   between(0.01, 100.0), "deg/s")
          .check(check_controller);
  return section;
}

ControllerOptions read_controller(const std::string& path) {
  scene::Document doc = scene::load(path);
  const ControllerOptions options = doc.read(controller_section());
  doc.finish();
  return options;
}

namespace {

void check_library(scene::Document& doc, const ControlOptions& control, int blades) {
  if (blades > BladedLibrary::most_blades)
    doc.problem("control.model",
                fmt::format("\"library\" has places for {} blades, the rotor has {}", BladedLibrary::most_blades, blades));
  if (control.procedure.empty()) doc.problem("control.procedure", "must not be empty");
  for (std::size_t i = 0; i < control.events.size(); ++i)
    if (const ControlEvent what = control.events[i].what; what == ControlEvent::start_up || what == ControlEvent::shut_down)
      doc.problem(fmt::format("control.events[{}].what", i),
                  "is the library's business: give emergency_stop, grid_loss or blade_stuck");
  if (control.library.empty() || control.procedure.empty()) return;
  try {
    const BladedLibrary library(control, blades);
  } catch (const scene::SceneError& e) { doc.problem("control.library", e.what()); }
}

void check_controller_file(scene::Document& doc, const ControlOptions& control, const std::optional<Operation>& operation,
                           const std::string& section) {
  if (control.file.empty())
    return doc.problem("control.file", fmt::format("must be given: {}.turbine names no controller", section));
  try {
    const ControllerOptions c = read_controller(control.file);
    if (control.tuning == Tuning::floating && !c.floating_gains)
      doc.problem("control.tuning", fmt::format("is \"floating\", but {} has no [controller.floating_gains]", control.file));
    if (!c.torque_gain_N_m_s2 && !(operation && operation->torque_gain()))
      doc.problem("control.file", fmt::format("{} gives no torque_gain_N_m_s2, and {}", control.file,
                                              operation && !operation->power.empty()
                                                  ? "rotor.operation has no row between its least and its greatest speed, "
                                                    "which would say which tip-speed ratio to hold"
                                                  : "no rotor.operation with power_W says which tip-speed ratio to hold"));
    if (operation && operation->power.empty() && !operation->pitch.empty() && operation->below_rated().wind.empty())
      doc.problem(
          section + ".operation",
          "has neither power_W nor a speed that rises with the wind: which rows of blade_pitch_deg are below rated power?");
  } catch (const scene::SceneError& e) { doc.problem("control.file", e.what()); }
}

/// A rotor whose load neither its speed nor its pitch changes runs away above rated wind.
void check_load(scene::Document& doc, const AeroOptions& aero) try {
  const bool curve = aero.model == "thrust_curve";
  if (aero.model != "prescribed" && !(curve && (aero.curve.empty() || pitches_of(aero.curve).empty()))) return;
  doc.problem(curve ? aero.curve.empty() ? "aero.thrust_coefficient" : "aero.curve" : "aero.model",
              "is a load that neither rotor speed nor blade pitch change: take \"bem\", or a curve over tip_speed_ratio and "
              "blade_pitch_deg, or leave [control] out");
} catch (const scene::SceneError&) {  // told by check_rotor
}

}  // namespace

void check_control(scene::Document& doc, const ControlOptions& control, const AeroOptions& aero, const RotorOptions& rotor,
                   const std::optional<Operation>& operation, int blades, const std::string& section) {
  if (!rotor.joint.empty())
    doc.problem(section + ".joint",
                "must be left out with [control]: the drive train turns the rotor within rotor.body, whose mass "
                "and inertia are those with the rotor, but about the shaft, where rotor_inertia_kg_m2 is the rotor's");
  if (control.model == ControlModel::library)
    check_library(doc, control, blades);
  else
    check_controller_file(doc, control, operation, section);
  check_load(doc, aero);
  if (control.peak_shaving && aero.model != "bem")
    doc.problem("control.peak_shaving",
                fmt::format("needs aero.model = \"bem\": thrust by pitch is that of the blades' sections, not "
                            "of \"{}\"",
                            aero.model));
  if (control.peak_shaving && !operation)
    doc.problem("control.peak_shaving", "needs rotor.operation: its winds are those of the schedule, its pitch the least one");
  for (std::size_t i = 0; i < control.events.size(); ++i) {
    const EventOptions& event = control.events[i];
    if (i > 0 && event.time_s < control.events[i - 1].time_s)
      doc.problem(fmt::format("control.events[{}].time_s", i), "must not be before that of the event before it");
    if (event.what == ControlEvent::blade_stuck && event.blade > blades)
      doc.problem(fmt::format("control.events[{}].blade", i), fmt::format("the rotor has {} blades", blades));
  }
}

}  // namespace spindrift::aero
