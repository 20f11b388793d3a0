// Chain, wire and rope in a row, with weights and floats, in slow motion: kernels/mooring/line_composite.hpp.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "src/moorings/composite.hpp"
#include "src/moorings/model.hpp"

namespace spindrift::moorings {

CompositeParts composite_parts(const LineOptions& o, double water_density, double gravity) {
  CompositeParts parts;
  std::vector<ClumpOptions> clumps = o.clumps;
  std::ranges::stable_sort(clumps, {}, &ClumpOptions::distance_m);
  const double least = 1e-9 * o.length_m();  // nearer to a joint a clump hangs there
  std::size_t next = 0;
  double begin = 0.0;
  for (const SectionOptions& section : o.sections) {
    const double end = begin + section.rest_length_m;
    const auto close = [&](double from, double to) {
      parts.sections.push_back({to - from, section.weight_N_m, section.axial_stiffness_N});
      parts.joints.push_back(to), parts.hung.push_back(0.0);
      for (; next < clumps.size() && clumps[next].distance_m < to + least; ++next)
        parts.hung.back() += gravity * (clumps[next].mass_kg - water_density * clumps[next].volume_m3);
    };
    double from = begin;
    while (next < clumps.size() && clumps[next].distance_m < end - least) {
      const double at = clumps[next].distance_m;
      close(from, at), from = at;
    }
    close(from, end), begin = end;
  }
  parts.hung.pop_back(), parts.joints.pop_back();  // the fairlead
  return parts;
}

LineComposite composite_line(const CompositeParts& parts, const LineOptions& o) {
  return LineComposite(parts.sections, parts.hung, o.bed_friction, o.bed_contact);
}

extern const LineModel composite_catenary{
    .name = "composite_catenary",
    .help = "static: sections of different weight and stiffness in a row, with weights and floats at any place",
    .keys = {"sections", "clumps", "bed_contact", "bed_friction"},
    .hangs = true,
    .make = [](const LineOptions& o, const LineEnvironment& e) {
      const CompositeParts parts = composite_parts(o, e.water_density_kg_m3, e.gravity_m_s2);
      double weight = 0.0;
      for (const CatenarySection& s : parts.sections) weight += s.weight_per_m * s.length;
      for (const double hung : parts.hung) weight += std::abs(hung);
      return static_line(composite_line(parts, o), taut_from_sag(o.length_m(), weight, o.series_stiffness_N_m()));
    }};

}  // namespace spindrift::moorings
