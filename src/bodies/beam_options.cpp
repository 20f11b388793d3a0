// SPDX-License-Identifier: Apache-2.0
#include "src/bodies/beam_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "kernels/base/constants.hpp"
#include "src/scene/columns.hpp"
#include "src/scene/document.hpp"
#include "src/scene/error.hpp"

namespace spindrift::bodies {

namespace {

constexpr double length_tolerance = 1e-4;  // of the beam's length, by which the last distance of its file may differ

int body_index(const NamedBodies& bodies, const std::string& name) {
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (bodies[b].name == name) return int(b);
  return earth;
}

std::vector<double> values_of(const scene::Columns& file, const char* name) {
  for (std::size_t row = 0; row < file.rows(); ++row)
    if (!(file[name][row] > 0.0)) file.fail(int(row), fmt::format("{} = {} must be above zero", name, file[name][row]));
  return {file[name].begin(), file[name].end()};
}

/// Of a circular tube.
void add_tube(beam::Properties& p, const BeamOptions& o, const scene::Columns& file) {
  const std::vector<double> outer = values_of(file, "diameter_m"), wall = values_of(file, "thickness_m");
  for (std::size_t n = 0; n < outer.size(); ++n) {
    const double inner = outer[n] - 2.0 * wall[n];
    if (inner < 0.0) file.fail(int(n), fmt::format("a wall of {} m does not fit into a diameter of {} m", wall[n], outer[n]));
    const double area = 0.25 * pi * (outer[n] * outer[n] - inner * inner);
    const double inertia = pi / 64.0 * (std::pow(outer[n], 4) - std::pow(inner, 4));
    p.mass.push_back(o.density_kg_m3 * area);
    p.bending_x.push_back(o.youngs_modulus_Pa * inertia);
    p.axial.push_back(o.youngs_modulus_Pa * area);
    p.torsion.push_back(2.0 * o.shear_modulus_Pa * inertia);
  }
  p.bending_y = p.bending_x;
}

/// Given section by section. Extension and twist, where the file is silent, are those of a thin tube of the material.
void add_sections(beam::Properties& p, const BeamOptions& o, const scene::Columns& file) {
  p.mass = values_of(file, "mass_kg_m");
  p.bending_x = values_of(file, "stiffness_x_N_m2");
  p.bending_y = file.has("stiffness_y_N_m2") ? values_of(file, "stiffness_y_N_m2") : p.bending_x;
  if (file.has("axial_N")) p.axial = values_of(file, "axial_N");
  if (file.has("torsion_N_m2")) p.torsion = values_of(file, "torsion_N_m2");
  for (std::size_t n = 0; n < p.mass.size(); ++n) {
    if (!file.has("axial_N")) p.axial.push_back(o.youngs_modulus_Pa / o.density_kg_m3 * p.mass[n]);
    if (!file.has("torsion_N_m2"))
      p.torsion.push_back(o.shear_modulus_Pa / o.youngs_modulus_Pa * (p.bending_x[n] + p.bending_y[n]));
  }
}

}  // namespace

const scene::Section<BeamOptions>& beam_section() {
  static const auto section =
      scene::Section<BeamOptions>("beams",
                                  "A flexible beam between two bodies, such as a tower between platform and nacelle; it bends in "
                                  "two modes of each plane. Its mass is not that of a body.")
          .named()
          .texts("bodies", &BeamOptions::bodies, "Body at its start (\"earth\": clamped there), body at its end.")
          .required()
          .size(2, 2)
          .vector("start_m", &BeamOptions::start_m, "m", "Its start, initial earth coordinates.")
          .required()
          .vector("end_m", &BeamOptions::end_m, "m", "Its end, initial earth coordinates.")
          .required()
          .vector("across", &BeamOptions::across, "-",
                  "Direction of the beam's x, of a tower fore-aft, as far as it is square to the beam; its y follows.")
          .path(
              "properties", &BeamOptions::properties,
              "CSV file from start to end: distance_m (from the start, may repeat at a step), then diameter_m and thickness_m of "
              "a "
              "tube, or mass_kg_m, stiffness_x_N_m2 (bending along x), stiffness_y_N_m2, and where known axial_N, torsion_N_m2.")
          .required()
          .number("youngs_modulus_Pa", &BeamOptions::youngs_modulus_Pa, "Pa", "Of the wall.", scene::positive())
          .number("shear_modulus_Pa", &BeamOptions::shear_modulus_Pa, "Pa", "Of the wall.", scene::positive())
          .number("density_kg_m3", &BeamOptions::density_kg_m3, "kg/m3", "Of the wall, with what hangs on it.", scene::positive())
          .numbers("damping", &BeamOptions::damping, "-",
                   "Ratio to critical damping of the first and of the second modes; extension and twist take the second.",
                   scene::between(0.0, 0.5))
          .size(2, 2)
          .check([](const BeamOptions& o, const scene::Report& report) {
            const Eigen::Vector3d along = o.end_m - o.start_m;
            if (along.norm() == 0.0) return report("end_m", "is where start_m is: the beam has no length");
            if (o.across.cross(along).norm() <= 1e-9 * o.across.norm() * along.norm())
              report("across", "must not be zero or along the beam");
            if (o.bodies[0] == o.bodies[1]) report("bodies", "a beam ties two different bodies");
            if (o.bodies[1] == "earth") report("bodies", "\"earth\" can be at the start only: turn the beam round");
          });
  return section;
}

beam::Properties read_properties(const BeamOptions& o) {
  const scene::Columns file = scene::read_columns(o.properties);
  file.allow_only({"distance_m", "diameter_m", "thickness_m", "mass_kg_m", "stiffness_x_N_m2", "stiffness_y_N_m2", "axial_N",
                   "torsion_N_m2"});
  file.require_rows(2);
  beam::Properties p;
  p.position.assign(file["distance_m"].begin(), file["distance_m"].end());
  const double length = (o.end_m - o.start_m).norm();
  if (p.position[0] != 0.0) file.fail(0, fmt::format("distance_m = {} must be 0 at the beam's start", p.position[0]));
  for (std::size_t n = 1; n < p.position.size(); ++n) {
    if (p.position[n] < p.position[n - 1])
      file.fail(int(n), fmt::format("distance_m = {} is less than the one before: it goes from start to end", p.position[n]));
    if (n > 1 && p.position[n] == p.position[n - 2])
      file.fail(int(n), fmt::format("distance_m = {} stands three times: twice makes a step", p.position[n]));
  }
  if (p.position[1] == 0.0 || p.position[p.position.size() - 2] == p.position.back())
    file.fail(-1, "distance_m repeats at an end of the beam, where nothing steps");
  if (std::abs(p.position.back() - length) > length_tolerance * length)
    file.fail(int(p.position.size()) - 1,
              fmt::format("distance_m ends at {}, the beam is {:.6g} m long from start_m to end_m", p.position.back(), length));
  if (file.has("diameter_m") == file.has("mass_kg_m"))
    file.fail(-1, "must have either diameter_m and thickness_m, or mass_kg_m and stiffness_x_N_m2");
  if (file.has("diameter_m"))
    add_tube(p, o, file);
  else
    add_sections(p, o, file);
  return p;
}

void check_beams(scene::Document& document, const NamedBeams& beams, const NamedBodies& bodies) {
  std::vector<std::string> names;
  for (const auto& body : bodies) names.push_back(body.name);
  for (const auto& [name, beam] : beams) {
    for (const std::string& body : beam.bodies)
      if (body != "earth" && std::find(names.begin(), names.end(), body) == names.end())
        document.problem("beams." + name + ".bodies", fmt::format("names body \"{}\", which is not in [bodies]; known: {}, earth",
                                                                  body, fmt::join(names, ", ")));
    try {
      read_properties(beam);
    } catch (const scene::SceneError& e) { document.problem("beams." + name + ".properties", e.what()); }
  }
}

std::vector<Beam> make_beams(const NamedBeams& beams, const NamedBodies& named, std::span<const Body> bodies,
                             std::span<const Joint> joints) {
  std::vector<BeamPlan> plans;
  for (const auto& [name, o] : beams)
    plans.push_back({name,
                     body_index(named, o.bodies[0]),
                     body_index(named, o.bodies[1]),
                     o.start_m,
                     o.end_m,
                     o.across,
                     read_properties(o),
                     {o.damping[0], o.damping[1]}});
  return make_beams(plans, bodies, joints);
}

}  // namespace spindrift::bodies
