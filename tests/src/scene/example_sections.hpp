// Sections that resemble those of a real scene, one parameter of every kind: what the scene tests declare and read.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "src/scene/section.hpp"

namespace spindrift::scene::example {

enum class Integrator { rk4, euler };

struct TimeOptions {
  double end_s = 0.0;
  double window_s = 0.1;
  Integrator integrator = Integrator::rk4;
  int most_steps = 1000;
  std::optional<std::int64_t> seed;
};

inline const Section<TimeOptions>& time_section() {
  static const auto section =
      Section<TimeOptions>("time", "How long, in which steps.")
          .number("end_s", &TimeOptions::end_s, "s", "End of the run.", positive())
          .required()
          .number("window_s", &TimeOptions::window_s, "s", "Length of a coupling window.", above(0.0).up_to(1000.0))
          .choice("integrator", &TimeOptions::integrator,
                  {{"rk4", Integrator::rk4, "classical Runge-Kutta"}, {"euler", Integrator::euler, "explicit, first order"}},
                  "Time integration of the bodies.")
          .integer("most_steps", &TimeOptions::most_steps, "-", "Most steps in a window.", at_least(1))
          .integer("seed", &TimeOptions::seed, "-", "Seed of the random phases.")
          .check([](const TimeOptions& o, const Report& report) {
            if (o.window_s > o.end_s) report("window_s", "is longer than the run, time.end_s");
          });
  return section;
}

struct CylinderOptions {
  std::string name;
  Eigen::Vector3d start_m = {0, 0, 0}, end_m = {0, 0, -1};
  double diameter_m = 0.0;
};

inline const Section<CylinderOptions>& cylinder_section() {
  static const auto section = Section<CylinderOptions>("cylinders", "A cylinder of a body.")
                                  .text("name", &CylinderOptions::name, "What messages call it.")
                                  .vector("start_m", &CylinderOptions::start_m, "m", "Centre of one end.")
                                  .vector("end_m", &CylinderOptions::end_m, "m", "Centre of the other end.")
                                  .number("diameter_m", &CylinderOptions::diameter_m, "m", "Outer diameter.", positive())
                                  .required();
  return section;
}

struct BodyOptions {
  double mass_kg = 0.0;
  Eigen::Matrix3d inertia_kg_m2 = Eigen::Matrix3d::Identity();
  Eigen::Vector3d centre_m = {0, 0, 0};
  double pitch = 0.1;
  bool gyroscopic = true;
  std::vector<CylinderOptions> cylinders;
};

inline const Section<BodyOptions>& body_section() {
  static const auto section =
      Section<BodyOptions>("bodies", "A rigid body.")
          .named()
          .number("mass_kg", &BodyOptions::mass_kg, "kg", "Mass of the body.", positive())
          .required()
          .symmetric("inertia_kg_m2", &BodyOptions::inertia_kg_m2, "kg m2", "Inertia about the centre of mass, body axes.")
          .vector("centre_m", &BodyOptions::centre_m, "m", "Centre of mass at the start, earth frame.", between(-1e4, 1e4))
          .degrees("pitch_deg", &BodyOptions::pitch, "Pitch at the start.", between(-90, 90))
          .flag("gyroscopic", &BodyOptions::gyroscopic, "Whether gyroscopic terms act.")
          .tables("cylinders", &BodyOptions::cylinders, cylinder_section(), "Shapes that meet the water.");
  return section;
}

struct LineOptions {
  std::string body;
  std::optional<double> stiffness_N_m, axial_stiffness_N;
  std::optional<Eigen::Vector3d> anchor_m;
};

inline const Section<LineOptions>& line_section() {
  static const auto section =
      Section<LineOptions>("moorings", "A mooring line.")
          .named()
          .text("body", &LineOptions::body, "Body that the fairlead is on.")
          .required()
          .number("stiffness_N_m", &LineOptions::stiffness_N_m, "N/m", "Stiffness of the line.", positive())
          .number("axial_stiffness_N", &LineOptions::axial_stiffness_N, "N", "EA of the line.", positive())
          .one_of({"stiffness_N_m", "axial_stiffness_N"})
          .vector("anchor_m", &LineOptions::anchor_m, "m", "Anchor, earth frame.");
  return section;
}

struct GridOptions {
  int cells = 10;
  std::array<double, 2> size_m = {100.0, 20.0};
};

inline const Section<GridOptions>& grid_section() {
  static const auto section = Section<GridOptions>("grid", "Numerical tank.")
                                  .integer("cells", &GridOptions::cells, "-", "Cells along the tank.", between(1, 1e6))
                                  .vector("size_m", &GridOptions::size_m, "m", "Length and depth.", positive());
  return section;
}

struct SeaOptions {
  std::string model = "none";
  double drag_coefficient = 1.0;
  Eigen::Vector3d current_m_s = {0, 0, 0};
  std::vector<double> probes_m;
  std::vector<std::string> bodies;
  std::vector<std::array<double, 2>> profile_m = {{0.0, -20.0}};
  std::string table;
  std::optional<GridOptions> grid;
  double speed = 0.0;
};

inline const Section<SeaOptions>& sea_section() {
  static const auto section =
      Section<SeaOptions>("sea", "Hydrodynamic model of the sea.")
          .choice("model", &SeaOptions::model, {{"none", "no water"}, {"morison", "strips"}, {"sph", "particles"}},
                  "Which model.")
          .number("drag_coefficient", &SeaOptions::drag_coefficient, "-", "Transverse drag of a member.", between(0.0, 10.0))
          .only_if("model", {"morison"})
          .vector("current_m_s", &SeaOptions::current_m_s, "m/s", "Uniform current, earth frame.")
          .only_if("model", {"morison", "sph"})
          .numbers("probes_m", &SeaOptions::probes_m, "m", "Places of wave gauges along x.")
          .size(0, 4)
          .texts("bodies", &SeaOptions::bodies, "Bodies that meet the water.")
          .rows("profile_m", &SeaOptions::profile_m, "m", "Sea bed as pairs x, z.")
          .size(1)
          .path("table", &SeaOptions::table, "Tabulated forces.")
          .table("grid", &SeaOptions::grid, grid_section(), "Numerical tank.")
          .only_if("model", {"sph"})
          .rpm("paddle_speed_rpm", &SeaOptions::speed, "Speed of the paddle.", not_negative());
  return section;
}

inline std::vector<const SectionBase*> sections() { return {&time_section(), &sea_section(), &body_section(), &line_section()}; }

}  // namespace spindrift::scene::example
