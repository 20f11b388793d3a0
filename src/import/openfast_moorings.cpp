// [moorings] and [junctions] of a scene from MAP++ or MoorDyn.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <sstream>

#include "kernels/base/constants.hpp"
#include "src/import/openfast_sections.hpp"

namespace spindrift::decks {

std::string import_moorings(DeckImport& run, const ImportedEnvironment& environment, bool has_waves) {
  const int kind = run.main.integer({"CompMooring"}, 0);
  if (kind == 0) return "";
  if (kind != 1 && kind != 3) {
    run.leave_out(fmt::format("mooring lines of CompMooring {}", kind));
    return "";
  }
  const Deck file(run.main.path({"MooringFile"}));
  const auto [lines, junctions] =
      kind == 1 ? read_map(file, environment.depth, run.left_out) : read_moordyn(file, environment.depth, run.left_out);
  if (kind == 3 && file.integer({"WaveKin", "WaterKin"}, 0) == 0 && has_waves)
    run.leave_out("MoorDyn's still water round the lines (WaveKin 0): here they feel the scene's waves");
  std::ostringstream text;
  for (std::size_t n = 0; n < lines.size(); ++n) {
    const ImportedLine& l = lines[n];
    const double weight = environment.gravity * (l.mass_per_m - environment.water_density * 0.25 * pi * l.diameter * l.diameter);
    if (!(weight > 0.0) || !(l.axial_stiffness > 0.0)) {
      run.leave_out(fmt::format("line {}: it has no weight in water or no stiffness", n + 1));
      continue;
    }
    const bool meets = !l.at_anchor.empty() || !l.at_fairlead.empty();
    const bool on_bed = !l.at_anchor.empty() || l.anchor.z() <= -environment.depth + 1e-6 * environment.depth;
    text << fmt::format("\n[moorings.line_{}]\nmodel = \"{}\"\n", n + 1, meets || l.dynamics ? "lumped_mass" : "catenary")
         << (l.at_fairlead.empty() ? "body = \"platform\"\nfairlead_m = " + toml_vector(l.fairlead)
                                   : "body = \"" + l.at_fairlead + "\"")
         << (l.at_anchor.empty() ? "\nanchor_m = " + toml_vector(l.anchor) : "\nanchor_body = \"" + l.at_anchor + "\"")
         << fmt::format("\nrest_length_m = {:.9g}\naxial_stiffness_N = {:.9g}\n", l.length, l.axial_stiffness);
    if (const auto& d = l.dynamics) {
      text << fmt::format("mass_kg_m = {:.9g}\ndiameter_m = {:.9g}\nsegments = {}\ndamping_ratio = {:.9g}\n", l.mass_per_m,
                          l.diameter, d->segments, d->damping_ratio)
           << fmt::format("drag_coefficient = {:.9g}\naxial_drag_coefficient = {:.9g}\n", d->drag, d->axial_drag)
           << fmt::format("added_mass_coefficient = {:.9g}\naxial_added_mass_coefficient = {:.9g}\n", d->added_mass,
                          d->axial_added_mass);
      if (on_bed)
        text << fmt::format("bed_stiffness_Pa_m = {:.9g}\nbed_damping_Pa_s_m = {:.9g}\n", d->bed_stiffness, d->bed_damping);
    } else if (meets) {
      text << fmt::format("mass_kg_m = {:.9g}\ndiameter_m = {:.9g}\n", l.mass_per_m, l.diameter);
    } else {
      text << fmt::format("weight_N_m = {:.9g}\n", weight);
    }
    if (!on_bed)
      text << "bed_contact = false\n";
    else if (l.bed_friction > 0.0)
      text << fmt::format("bed_friction = {:.9g}\n", l.bed_friction);
  }
  for (const ImportedJunction& j : junctions)
    text << fmt::format("\n[junctions.{}]\nposition_m = {}\nmass_kg = {:.9g}\nvolume_m3 = {:.9g}\ndrag_area_m2 = {:.9g}\n",
                        j.name, toml_vector(j.at), j.mass, j.volume, j.drag_area)
         << fmt::format("added_mass_coefficient = {:.9g}\n", j.added_mass);
  run.carry(fmt::format("moorings: {} lines", lines.size()) +
            (junctions.empty() ? "" : fmt::format(", {} junctions", junctions.size())));
  return text.str();
}

}  // namespace spindrift::decks
