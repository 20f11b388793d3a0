// [moorings] and [junctions] of a scene from MAP++ or MoorDyn.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "kernels/base/constants.hpp"
#include "src/import/line_files.hpp"
#include "src/import/openfast_sections.hpp"

namespace spindrift::decks {

namespace {

/// Lines from the bed to the platform without a branch, and the points between them, as indices; a line alone is one.
struct ImportedRow {
  std::vector<std::size_t> lines, points;  ///< from the anchor up
};
/// In the order of their first lines. Lines that are in none meet at a point with others, or hang on the bed or the platform at
/// both ends.
std::vector<ImportedRow> rows_of(const ImportedMoorings& moorings) {
  const std::vector<ImportedLine>& lines = moorings.lines;
  const auto at = [&](std::size_t l, const std::string& name) {
    return lines[l].at_anchor == name || lines[l].at_fairlead == name;
  };
  std::vector<ImportedRow> found;
  for (std::size_t first = 0; first < lines.size(); ++first) {
    if (!lines[first].at_anchor.empty()) continue;
    ImportedRow row{{first}, {}};
    std::string end = lines[first].at_fairlead;
    while (!end.empty()) {
      std::vector<std::size_t> others;
      for (std::size_t l = 0; l < lines.size(); ++l)
        if (l != row.lines.back() && at(l, end)) others.push_back(l);
      if (others.size() != 1) break;
      const ImportedLine& next = lines[others[0]];
      const bool upwards = next.at_anchor == end;
      if (!upwards && next.at_anchor.empty()) break;  // down to the bed again
      for (std::size_t p = 0; p < moorings.junctions.size(); ++p)
        if (moorings.junctions[p].name == end) row.points.push_back(p);
      row.lines.push_back(others[0]);
      end = upwards ? next.at_fairlead : next.at_anchor;
    }
    if (end.empty()) found.push_back(row);
  }
  return found;
}

double weight_in_water(const ImportedLine& l, const ImportedEnvironment& e) {
  return e.gravity * (l.mass_per_m - e.water_density * 0.25 * pi * l.diameter * l.diameter);
}

bool hangs(const ImportedLine& l, const ImportedEnvironment& e) { return weight_in_water(l, e) > 0.0 && l.axial_stiffness > 0.0; }

std::string no_weight(std::size_t line) { return fmt::format("line {}: it has no weight in water or no stiffness", line + 1); }

std::string ends(const ImportedLine& lowest, const ImportedLine& highest) {
  return (highest.at_fairlead.empty() ? "body = \"platform\"\nfairlead_m = " + toml_vector(highest.fairlead)
                                      : "body = \"" + highest.at_fairlead + "\"") +
         (lowest.at_anchor.empty() ? "\nanchor_m = " + toml_vector(lowest.anchor)
                                   : "\nanchor_body = \"" + lowest.at_anchor + "\"") +
         "\n";
}

std::string bed_keys(const ImportedLine& l) {
  if (!l.meets_bed) return "bed_contact = false\n";
  return l.bed_friction > 0.0 ? fmt::format("bed_friction = {:.9g}\n", l.bed_friction) : "";
}

/// A line alone at rest at all times, or one of several that meet.
std::string single_line(std::size_t n, const ImportedLine& l, const ImportedEnvironment& e, bool catenary) {
  std::string text = fmt::format("\n[moorings.line_{}]\nmodel = \"{}\"\n", n + 1, catenary ? "catenary" : "lumped_mass") +
                     ends(l, l) +
                     fmt::format("rest_length_m = {:.9g}\naxial_stiffness_N = {:.9g}\n", l.length, l.axial_stiffness);
  if (catenary) {
    text += fmt::format("weight_N_m = {:.9g}\n", weight_in_water(l, e));
  } else if (const auto& d = l.dynamics) {
    text += fmt::format("mass_kg_m = {:.9g}\ndiameter_m = {:.9g}\nsegments = {}\ndamping_ratio = {:.9g}\n", l.mass_per_m,
                        l.diameter, d->segments, d->damping_ratio) +
            fmt::format("drag_coefficient = {:.9g}\naxial_drag_coefficient = {:.9g}\n", d->drag, d->axial_drag) +
            fmt::format("added_mass_coefficient = {:.9g}\naxial_added_mass_coefficient = {:.9g}\n", d->added_mass,
                        d->axial_added_mass);
    if (l.meets_bed)
      text += fmt::format("bed_stiffness_Pa_m = {:.9g}\nbed_damping_Pa_s_m = {:.9g}\n", d->bed_stiffness, d->bed_damping);
  } else {
    text += fmt::format("mass_kg_m = {:.9g}\ndiameter_m = {:.9g}\n", l.mass_per_m, l.diameter);
  }
  return text + bed_keys(l);
}

/// Lines one after another as one of sections, the points between them as its clumps.
std::string line_of_sections(DeckImport& run, const ImportedRow& row, const ImportedMoorings& all, const ImportedEnvironment& e) {
  const ImportedLine &lowest = all.lines[row.lines.front()], &highest = all.lines[row.lines.back()];
  std::string text = fmt::format("\n[moorings.line_{}]\nmodel = \"composite_catenary\"\n", row.lines.front() + 1) +
                     ends(lowest, highest) + bed_keys(lowest),
              clumps;
  double distance = 0.0;
  for (std::size_t k = 0; k < row.lines.size(); ++k) {
    const ImportedLine& l = all.lines[row.lines[k]];
    text +=
        fmt::format("[[moorings.line_{}.sections]]\nrest_length_m = {:.9g}\nweight_N_m = {:.9g}\naxial_stiffness_N = {:.9g}\n",
                    row.lines.front() + 1, l.length, weight_in_water(l, e), l.axial_stiffness);
    distance += l.length;
    if (k == row.points.size()) break;
    const ImportedJunction& point = all.junctions[row.points[k]];
    if (point.mass > 0.0 || point.volume > 0.0)
      clumps += fmt::format("[[moorings.line_{}.clumps]]\ndistance_m = {:.9g}\nmass_kg = {:.9g}\nvolume_m3 = {:.9g}\n",
                            row.lines.front() + 1, distance, point.mass, point.volume);
    if (all.lines[row.lines[k + 1]].bed_friction != lowest.bed_friction && lowest.meets_bed)
      run.leave_out(fmt::format("bed friction of line {}: all of line_{} has that of the section at the anchor",
                                row.lines[k + 1] + 1, row.lines.front() + 1));
  }
  return text + clumps;
}

/// Lines of a scene are in its waves and current; those of MoorDyn in still water, in the deck's water, or in that of a file.
void note_water(DeckImport& run, const Deck& moordyn) {
  const bool given = moordyn.find({"WaveKin", "WaterKin"}).has_value();
  const std::string water = given ? moordyn.text({"WaveKin", "WaterKin"}) : "0";
  if (water.empty() || water == "0")
    run.leave_out("MoorDyn's still water round the lines (WaterKin 0): here they are in the scene's waves and current");
  else if (!number_in(water) && water != "SEASTATE")
    run.leave_out(fmt::format("MoorDyn's water of {} round the lines: here they are in the scene's waves and current", water));
}

}  // namespace

std::string import_moorings(DeckImport& run, const ImportedEnvironment& environment, bool moving_water, ImportedLines choice) {
  const int kind = run.main.integer({"CompMooring"}, 0);
  if (kind == 0) return "";
  if (kind != 1 && kind != 3) {
    run.leave_out_part(fmt::format("mooring lines of CompMooring {}", kind));
    return "";
  }
  const Deck file(run.main.path({"MooringFile"}), kind == 1 ? "" : "!#%");  // in MAP++ "#" marks what it looks for
  const std::string file_name = file.file().filename().string();
  const ImportedMoorings all =
      kind == 1 ? read_map(file, environment.depth, run.left_out) : read_moordyn(file, environment.depth, run.left_out);
  const auto& [lines, junctions] = all;
  const bool at_rest = kind == 1 || choice == ImportedLines::quasi_static;
  const std::vector<ImportedRow> rows = at_rest ? rows_of(all) : std::vector<ImportedRow>();
  std::vector<const ImportedRow*> row_of(lines.size(), nullptr);
  std::vector<bool> between(junctions.size(), false);
  for (const ImportedRow& row : rows) {
    for (const std::size_t l : row.lines) row_of[l] = &row;
    for (const std::size_t p : row.points) between[p] = true;
  }
  const bool any_dynamic = std::ranges::find(row_of, nullptr) != row_of.end();
  if (kind == 1 && any_dynamic)
    run.leave_out(file_name +
                  ": lines that meet at a node with others are dynamic here, with the drag, added mass and damping of "
                  "chain by default");
  if (kind == 3 && at_rest && any_dynamic)
    run.leave_out(file_name + ": lines that meet at a point with others stay dynamic in spite of --quasi-static-lines");
  if (kind == 3 && any_dynamic && moving_water) note_water(run, file);

  std::string text;
  std::size_t written = 0;
  for (std::size_t n = 0; n < lines.size(); ++n) {
    const ImportedRow* row = row_of[n];
    if (row && row->lines.front() != n) continue;
    const std::vector<std::size_t> parts = row ? row->lines : std::vector{n};
    const auto weightless = std::ranges::find_if_not(parts, [&](std::size_t l) { return hangs(lines[l], environment); });
    if (weightless != parts.end()) {
      run.leave_out(no_weight(*weightless) + (parts.size() > 1 ? ", nor come the lines in a row with it" : ""));
      continue;
    }
    text +=
        parts.size() == 1 ? single_line(n, lines[n], environment, row != nullptr) : line_of_sections(run, *row, all, environment);
    ++written;
  }
  std::size_t points = 0;
  for (std::size_t p = 0; p < junctions.size(); ++p) {
    if (between[p]) continue;
    const ImportedJunction& j = junctions[p];
    text += fmt::format("\n[junctions.{}]\nposition_m = {}\nmass_kg = {:.9g}\nvolume_m3 = {:.9g}\ndrag_area_m2 = {:.9g}\n",
                        j.name, toml_vector(j.at), j.mass, j.volume, j.drag_area) +
            fmt::format("added_mass_coefficient = {:.9g}\n", j.added_mass);
    ++points;
  }
  run.carry(fmt::format("moorings: {} lines", written) + (points == 0 ? "" : fmt::format(", {} junctions", points)));
  return text;
}

}  // namespace spindrift::decks
