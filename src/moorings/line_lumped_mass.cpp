// Dynamic lines: drag, inertia, snap loads, waves on the line. kernels/mooring/line_lumped_mass.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mooring/line_lumped_mass.hpp"

#include <algorithm>
#include <cmath>

#include "src/moorings/model.hpp"

namespace spindrift::moorings {

namespace {

LineLumpedMass nodes_of(const LineOptions& o, const LineEnvironment& environment) {
  LineLumpedMass line;
  line.length = o.rest_length_m, line.segments = o.segments, line.diameter = o.diameter_m, line.mass_per_m = o.mass_kg_m;
  line.axial_stiffness = *o.axial_stiffness_N, line.damping_ratio = o.damping_ratio;
  line.normal_drag = o.drag_coefficient, line.tangential_drag = o.axial_drag_coefficient;
  line.normal_added_mass = o.added_mass_coefficient, line.tangential_added_mass = o.axial_added_mass_coefficient;
  line.gravity = environment.gravity_m_s2, line.water_density = environment.water_density_kg_m3;
  line.bed = {.contact = o.bed_contact,
              .level = o.bed_level_m.value_or(std::min(o.anchor_m->z(), o.fairlead_m->z())),
              .shape = environment.bed,
              .stiffness = o.bed_stiffness_Pa_m,
              .damping = o.bed_damping_Pa_s_m,
              .friction = o.bed_friction};
  line.anchored = o.anchor_body == "earth";
  for (const ClumpOptions& c : o.clumps) {
    const int node = std::clamp(int(std::lround(c.distance_m / line.segment())), 1, line.segments - 1);
    line.clumps.push_back({node, c.mass_kg, c.volume_m3, c.drag_area_m2, c.added_mass_coefficient});
  }
  return line;
}

}  // namespace

extern const LineModel lumped_mass{
    .name = "lumped_mass",
    .help = "dynamic: point masses joined by springs, with weight, bed, drag and inertia of the water",
    .keys = {"rest_length_m", "axial_stiffness_N", "mass_kg_m", "diameter_m", "segments", "damping_ratio", "drag_coefficient",
             "axial_drag_coefficient", "added_mass_coefficient", "axial_added_mass_coefficient", "bed_contact", "bed_friction",
             "bed_stiffness_Pa_m", "bed_damping_Pa_s_m", "clumps"},
    .hangs = true,
    .make = [](const LineOptions& o, const LineEnvironment& e) { return static_line(nodes_of(o, e).catenary()); },
    .make_dynamic = nodes_of};

}  // namespace spindrift::moorings
