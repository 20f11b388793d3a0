// SPDX-License-Identifier: Apache-2.0
#include "src/aero/options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "src/aero/blade_roots.hpp"
#include "src/aero/flexible_blades.hpp"
#include "src/aero/operation.hpp"
#include "src/aero/prescribed.hpp"
#include "src/aero/thrust_curve.hpp"
#include "src/aero/turbine.hpp"
#include "src/scene/columns.hpp"
#include "src/scene/document.hpp"

namespace spindrift::aero {

namespace {

const std::vector<std::string> prescribed{"prescribed"}, curves{"thrust_curve"}, tabulated{"prescribed", "thrust_curve"};

void check_aero(const AeroOptions& o, const scene::Report& report) {
  if (o.resolves_air() && !o.flow)
    report("flow", fmt::format("must be given: aero.model \"{}\" needs a grid and its boundaries", o.model));
  if (o.acts() && o.grid)
    report("grid", fmt::format("has no effect: aero.model \"{}\" has no blades in its grid; give [aero.flow.generate]", o.model));
  if (o.flow) {
    const bool file = !o.flow->grid.empty(), made = o.flow->generate.has_value();
    if (o.grid && (file || made))
      report(file ? "flow.grid" : "flow.generate", "is given beside [aero.grid], the grid of a rotor: one of the two");
    if (!o.grid && !file && !made) report("flow.grid", "must be given, or [aero.flow.generate], or for a rotor [aero.grid]");
  }
  constexpr double least = 2.0;  // half of it makes a grid within the limits of quality at any pitch
  if (o.flow && o.flow->coarse_steps.value_or(0) > 0 && o.grid && o.grid->resolution < least)
    report("grid.resolution", fmt::format("must be at least {} with flow.coarse_steps, whose grid has half of it; it is {}",
                                          least, o.grid->resolution));
  if (!o.resolves_air() && o.flow)
    report("flow", "has no effect: aero.model is none of \"blade_resolved\", \"actuator_disc\", \"actuator_line\"");
  if (o.dynamic_inflow == "free_vortex" && o.dynamic_stall == "beddoes_leishman")
    report("dynamic_stall",
           "must be \"none\" or \"oye\" with dynamic_inflow = \"free_vortex\": the lag of attached flow in "
           "\"beddoes_leishman\" is that of vortices which this wake has already");
  const bool series = !o.thrust_cosine_N.empty() || !o.thrust_sine_N.empty() || !o.torque_cosine_N_m.empty() ||
                      !o.torque_sine_N_m.empty() || o.torque_N_m != 0.0;
  if (!o.table.empty() && series) report("table", "takes the place of torque_N_m and of all harmonics: give the table or those");
  if (!o.curve.empty() && o.torque_coefficient != 0.0)
    report("torque_coefficient", "has no effect beside a curve, which has its own");
}

void check_axis(const RotorOptions& o, const scene::Report& report) {
  if (o.axis.norm() == 0.0) report("axis", "must not be zero");
}

void check_damping(const RotorOptions& o, const scene::Report& report) {
  if (o.blade_structure.empty() && o.blade_damping != RotorOptions().blade_damping)
    report("blade_damping", "has no effect without blade_structure: the blades are rigid");
}

}  // namespace

const scene::Section<AeroOptions>& aero_section() {
  static const auto section =
      scene::Section<AeroOptions>("aero", "The rotor's aerodynamics.")
          .choice("model", &AeroOptions::model,
                  {{"none", "no load"},
                   {"prescribed", "thrust and torque constant, in harmonics of azimuth, or from a table in time"},
                   {"thrust_curve", "thrust and torque from the wind that the hub meets"},
                   {"bem", "blade element momentum on the section tables of rotor.turbine, in quasi-steady balance"},
                   {"actuator_disc", "the air itself, with the blades' section forces spread over the rotor's disc"},
                   {"actuator_line", "the air itself, with those forces along blades that turn through its grid"},
                   {"blade_resolved", "the air itself, by finite volumes on the grid of aero.flow"}},
                  "Model, cheapest first.")
          .number("thrust_N", &AeroOptions::thrust_N, "N", "Thrust, or its mean over a turn.")
          .only_if("model", prescribed)
          .numbers("thrust_cosine_N", &AeroOptions::thrust_cosine_N, "N",
                   "Cosine coefficients of thrust in azimuth, harmonics 1, 2, ...")
          .only_if("model", prescribed)
          .numbers("thrust_sine_N", &AeroOptions::thrust_sine_N, "N",
                   "Sine coefficients of thrust in azimuth, harmonics 1, 2, ...")
          .only_if("model", prescribed)
          .number("torque_N_m", &AeroOptions::torque_N_m, "N m", "Torque, or its mean over a turn.")
          .only_if("model", prescribed)
          .numbers("torque_cosine_N_m", &AeroOptions::torque_cosine_N_m, "N m", "Cosine coefficients of torque in azimuth.")
          .only_if("model", prescribed)
          .numbers("torque_sine_N_m", &AeroOptions::torque_sine_N_m, "N m", "Sine coefficients of torque in azimuth.")
          .only_if("model", prescribed)
          .integer("harmonic_step", &AeroOptions::harmonic_step, "-",
                   "Harmonic k goes with k times this many azimuths: 3 for three equal blades passing a tower.",
                   scene::between(1, 100))
          .only_if("model", prescribed)
          .choice("thrust_frame", &AeroOptions::thrust_frame,
                  {{"rotor", "along the rotor axis as it tilts and yaws"}, {"earth", "along the rotor axis of the start"}},
                  "Direction of the thrust; torque stays about the axis.")
          .only_if("model", prescribed)
          .path("table", &AeroOptions::table,
                "CSV file with columns time_s, thrust_N and, if any, torque_N_m. Before the first and after the last row their "
                "values hold.")
          .only_if("model", prescribed)
          .number("thrust_coefficient", &AeroOptions::thrust_coefficient, "-",
                  "C_T of the analytic law, on disc area and relative wind.", scene::between(0.0, 10.0))
          .only_if("model", curves)
          .number("torque_coefficient", &AeroOptions::torque_coefficient, "-",
                  "C_Q of the analytic law (power coefficient over tip-speed ratio).", scene::between(0.0, 10.0))
          .only_if("model", curves)
          .path("curve", &AeroOptions::curve,
                "CSV file: wind_m_s with thrust_N or ct and, if any, torque_N_m, cq, or power_W or cp with speed_rpm; or "
                "tip_speed_ratio, if any blade_pitch_deg, with ct and, if any, cp or cq. Beyond its edges the coefficients hold.")
          .only_if("model", curves)
          .choice("interpolation", &AeroOptions::interpolation,
                  {{"linear", "straight lines between rows"},
                   {"cubic", "monotone cubics, smooth and without overshoot; tables over two variables stay bilinear"}},
                  "Between the rows of a table or curve.")
          .only_if("model", tabulated)
          .choice("induction", &AeroOptions::induction,
                  {{"madsen", "polynomial in thrust coefficient, as in HAWC2"},
                   {"buhl", "momentum theory, Buhl's parabola beyond 0.4"}},
                  "Induction from local loading.")
          .only_if("model", {"bem"})
          .flag("skew_momentum", &AeroOptions::skew_momentum,
                "Whether a rotor across the wind slows all the air that goes along its skewed wake, as wakes of filaments and "
                "resolved air show it; else only what goes straight through, as in OpenFAST by default: less power in yaw.")
          .only_if("model", {"bem"})
          .choice("dynamic_inflow", &AeroOptions::dynamic_inflow,
                  {{"none", "the wake follows the rotor at once"},
                   {"oye", "two filters in series behind the quasi-steady induction, after Oye"},
                   {"free_vortex",
                    "vortex filaments that leave the blades and drift with the wind and their own velocities; they take the "
                    "place of induction but in statics and modes"}},
                  "How the wake responds to a change of load or wind.")
          .only_if("model", {"bem"})
          .number("inflow_time_s", &AeroOptions::inflow_time_s, "s",
                  "Larger time constant of the wake; without it by wind and induction, 1.1 R / (U (1 - 1.3 a)).",
                  scene::positive())
          .only_if("model", {"bem"})
          .only_if("dynamic_inflow", {"oye"})
          .number("wake_turns", &AeroOptions::wake_turns, "-",
                  "Length of the wake of filaments, in turns of the rotor; a vortex cylinder goes on from there.",
                  scene::between(2.0, 50.0))
          .only_if("model", {"bem"})
          .only_if("dynamic_inflow", {"free_vortex"})
          .degrees("wake_step_deg", &AeroOptions::wake_step,
                   "Turn of the rotor in a step of that wake; velocities that it induces hold until the next one.",
                   scene::between(2.0, 30.0))
          .only_if("model", {"bem"})
          .only_if("dynamic_inflow", {"free_vortex"})
          .number("wake_core_chords", &AeroOptions::wake_core_chords, "-",
                  "Radius of the filaments' cores where they leave the blade, in chords; it grows with age.",
                  scene::between(0.01, 2.0))
          .only_if("model", {"bem"})
          .only_if("dynamic_inflow", {"free_vortex"})
          .choice("dynamic_stall", &AeroOptions::dynamic_stall,
                  {{"none", "the polars at every instant"},
                   {"oye", "separation lags by the passage of stall_lag_chords, after Oye"},
                   {"beddoes_leishman", "lags of wake, pressure and separation, and a vortex from the leading edge"}},
                  "How the blades' sections stall and recover.")
          .only_if("model", {"bem"})
          .number("stall_lag_chords", &AeroOptions::stall_lag_chords, "-",
                  "Chords that the air passes in the time constant of separation.", scene::between(0.1, 100.0))
          .only_if("model", {"bem"})
          .only_if("dynamic_stall", {"oye"})
          .number("speed_of_sound_m_s", &AeroOptions::speed_of_sound_m_s, "m/s",
                  "For Prandtl and Glauert's factor on the slope of attached flow.", scene::between(100.0, 2000.0))
          .only_if("model", {"bem"})
          .only_if("dynamic_stall", {"beddoes_leishman"})
          .number("kinematic_viscosity_m2_s", &AeroOptions::kinematic_viscosity_m2_s, "m2/s",
                  "Of the air, for polars at several Reynolds numbers; default 1.46e-5, air at 15 C.", scene::between(1e-7, 1.0))
          .only_if("model", {"bem"})
          .table("tower", &AeroOptions::tower, tower_section(), "The tower in the wind.")
          .only_if("model", {"thrust_curve", "bem"})
          .table("grid", &AeroOptions::grid, rotor_grid_section(), "The grid round the resolved rotor.")
          .table("actuator", &AeroOptions::actuator, actuator_section(), "How blades that the grid does not show act on the air.")
          .only_if("model", {"actuator_disc", "actuator_line"})
          .table("flow", &AeroOptions::flow, flow_section(), "The resolved air.")
          .one_of({"thrust_N", "table"})
          .one_of({"thrust_coefficient", "curve"})
          .check(check_aero);
  return section;
}

namespace {

scene::Section<RotorOptions> with_rotor_keys(scene::Section<RotorOptions> section) {
  const std::vector<std::string> no_joint{""};
  return section.text("body", &RotorOptions::body, "Body that takes the rotor's load.")
      .text("joint", &RotorOptions::joint, "Joint that is the bearing: its point is the hub, its axis the rotor's, downwind.")
      .vector("hub_m", &RotorOptions::hub_m, "m", "Hub, initial earth coordinates.")
      .only_if("joint", no_joint)
      .vector("axis", &RotorOptions::axis, "-", "Rotor axis, downwind, initial earth frame; any length.",
              scene::between(-1e6, 1e6))
      .only_if("joint", no_joint)
      .choice("operating_point", &RotorOptions::operating_point,
              {{"given", "speed_rpm, or the driver of the bearing, and blade_pitch_deg"},
               {"table",
                "the operating table's for the undisturbed wind at the hub; it takes the place of the bearing's "
                "speed_rpm"}},
              "Where rotor speed and blade pitch come from; with [control], those of the start.")
      .rpm("speed_rpm", &RotorOptions::speed, "Constant rotor speed where no body turns.", scene::between(-1e4, 1e4))
      .only_if("joint", no_joint)
      .only_if("operating_point", {"given"})
      .degrees("azimuth_deg", &RotorOptions::azimuth, "Azimuth of blade 1 at the start; zero is up.",
               scene::between(-360.0, 360.0))
      .degrees("blade_pitch_deg", &RotorOptions::blade_pitch, "Blade pitch, positive nose into the wind (towards feather).",
               scene::between(-180.0, 180.0))
      .only_if("operating_point", {"given"})
      .number("diameter_m", &RotorOptions::diameter_m, "m", "Rotor diameter.", scene::positive())
      .path("turbine", &RotorOptions::turbine, "Turbine file: blades as section tables (inputs/turbines).")
      .path("operation", &RotorOptions::operation,
            "CSV file with wind_m_s, speed_rpm and, if any, blade_pitch_deg and power_W: steady operation. Without it that of "
            "the turbine file, if it names one; else the rotor speed of the scene stands for every wind.")
      .path("blade_masses", &RotorOptions::blade_masses,
            "CSV file with span_m (from the rotor axis along the blade) and mass_kg_m: with it the loads at the blades' "
            "roots are "
            "written. The rotor's body has that mass already.")
      .path("blade_structure", &RotorOptions::blade_structure,
            "CSV file with span_m (from the rotor axis along the blade), mass_kg_m, flap_N_m2, edge_N_m2 (stiffness against "
            "bending square to the chord and along it) and twist_deg (of the chord, nose into the wind). With it the blades "
            "bend in three modes, and loads at their roots are written. The rotor's body has their mass already.")
      .numbers("blade_damping", &RotorOptions::blade_damping, "-",
               "Structural damping of the blades' modes, first flapwise, first edgewise, second flapwise: ratio to the "
               "critical one.",
               scene::between(0.0, 0.5))
      .size(3, 3)
      .check(check_axis)
      .check(check_damping);
}

}  // namespace

const scene::Section<RotorOptions>& rotor_section() {
  static const auto section =
      with_rotor_keys(scene::Section<RotorOptions>("rotor", "The rotor: what carries it, how it turns, how large it is."));
  return section;
}

const scene::Section<RotorOptions>& rotors_section() {
  static const auto section =
      with_rotor_keys(scene::Section<RotorOptions>(
                          "rotors",
                          "One of several rotors on the same bodies, in place of [rotor]; [aero], [wind] and [control] "
                          "are for all of them, and each has a controller of its own.")
                          .named())
          .choice("turns", &RotorOptions::turns,
                  {{"clockwise", Turning::clockwise, "about the axis"},
                   {"counter_clockwise", Turning::counter_clockwise,
                    "against it, with blades that are mirrored; a bearing that drives it has a negative speed_rpm"}},
                  "Which way the rotor turns, seen from upwind; speed, azimuth and torque are positive that way.")
          .vector(
              "tower_foot_m", &RotorOptions::tower_foot_m, "m",
              "Earth x and y of the axis of this rotor's own tower at the start, in place of aero.tower.foot_m; each of several "
              "rotors has it where there is [aero.tower].");
  return section;
}

void check_blade_keys(scene::Document& doc, const AeroOptions& aero, const RotorOptions& rotor, const std::string& section) {
  if (aero.model != "bem") {
    if (!rotor.blade_masses.empty())
      doc.problem(section + ".blade_masses", "has no effect: only aero.model = \"bem\" knows the loads along a blade",
                  "aero.model");
    if (!rotor.blade_structure.empty())
      doc.problem(section + ".blade_structure", "has no effect: only aero.model = \"bem\" has blades that bend", "aero.model");
  }
  if (!rotor.diameter_m || rotor.turbine.empty()) return;
  try {
    const double blades = 2.0 * read_turbine(rotor.turbine).planform.span.back();  // cone and bending make the disc smaller
    if (std::abs(*rotor.diameter_m / blades - 1.0) > 0.1)
      doc.problem(section + ".diameter_m", fmt::format("is {:.6g} m, but the blades of {} reach {:.6g} m: leave it out",
                                                       *rotor.diameter_m, rotor.turbine, blades));
  } catch (const scene::SceneError&) {  // the turbine's own keys tell
  }
}

void check_rotor(scene::Document& doc, const AeroOptions& aero, const RotorOptions& rotor, std::span<const std::string> bodies,
                 std::span<const std::string> joints, const std::string& section) {
  const auto own = [&](const char* key) { return section + "." + key; };
  const auto among = [](std::span<const std::string> names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  if (aero.model == "none" && rotor.body.empty()) return;
  if (rotor.body.empty())
    doc.problem(own("body"), "must name the body that takes the load of [aero]");
  else if (!among(bodies, rotor.body))
    doc.problem(own("body"),
                fmt::format("names body \"{}\", which is not in [bodies]; known: {}", rotor.body, fmt::join(bodies, ", ")));
  if (!rotor.joint.empty() && !among(joints, rotor.joint))
    doc.problem(own("joint"),
                fmt::format("names joint \"{}\", which is not in [joints]; known: {}", rotor.joint, fmt::join(joints, ", ")));
  if (aero.model == "thrust_curve" && !rotor.diameter_m) {
    doc.problem(own("diameter_m"), "must be given: aero.model \"thrust_curve\" needs the disc area");
    return;
  }
  const auto try_file = [&](const std::string& key, const std::string& path, auto read) {
    if (!path.empty()) try {
        read();
      } catch (const scene::SceneError& e) { doc.problem(key, e.what()); }
  };
  if (aero.model == "bem" && rotor.turbine.empty())
    doc.problem(own("turbine"), "must name a turbine file: aero.model \"bem\" needs the blades");
  try_file(own("turbine"), rotor.turbine, [&] {
    const bool depends = depends_on_reynolds(read_turbine(rotor.turbine));
    if (aero.kinematic_viscosity_m2_s && !depends)
      doc.problem("aero.kinematic_viscosity_m2_s",
                  fmt::format("has no effect: no section of {} has polars at several Reynolds numbers", rotor.turbine));
  });
  check_blade_keys(doc, aero, rotor, section);
  if (aero.model == "bem") {
    const auto try_blades = [&](const char* key, const std::string& path, auto read) {
      if (!rotor.turbine.empty()) try_file(own(key), path, [&] { read(read_turbine(rotor.turbine), path); });
    };
    try_blades("blade_masses", rotor.blade_masses, read_blade_masses);
    if (!rotor.blade_structure.empty() && !rotor.blade_masses.empty())
      doc.problem(own("blade_masses"), "is given beside rotor.blade_structure, which has masses too: one of the two");
    else
      try_blades("blade_structure", rotor.blade_structure, read_blade_structure);
  }
  try_file(own("operation"), rotor.operation, [&] { read_operation(rotor.operation); });
  try_file("aero.table", aero.table, [&] { Prescribed model(aero); });
  try_file("aero.curve", aero.curve, [&] { ThrustCurve model(aero, rotor, 1.0); });
}

}  // namespace spindrift::aero
