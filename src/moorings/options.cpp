// SPDX-License-Identifier: Apache-2.0
#include "src/moorings/options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/base/constants.hpp"
#include "kernels/mooring/bed.hpp"
#include "src/moorings/model.hpp"
#include "src/moorings/table_file.hpp"
#include "src/scene/document.hpp"

namespace spindrift::moorings {

namespace {

const scene::Section<ClumpOptions>& clump_section() {
  using scene::positive, scene::not_negative;
  static const auto section =
      scene::Section<ClumpOptions>("clumps", "A weight or a float on a line; of lumped_mass at the node nearest to its place.")
          .number("distance_m", &ClumpOptions::distance_m, "m", "From the anchor along the unstretched line.", positive())
          .required()
          .number("mass_kg", &ClumpOptions::mass_kg, "kg", "Mass, dry.", not_negative())
          .required()
          .number("volume_m3", &ClumpOptions::volume_m3, "m3", "Volume.", not_negative())
          .number("drag_area_m2", &ClumpOptions::drag_area_m2, "m2", "Drag coefficient times area; of dynamic lines.",
                  not_negative())
          .number("added_mass_coefficient", &ClumpOptions::added_mass_coefficient, "-",
                  "On the displaced mass, of dynamic lines; a sphere's by default.", not_negative());
  return section;
}

const scene::Section<SectionOptions>& part_section() {
  using scene::positive;
  static const auto section =
      scene::Section<SectionOptions>("sections", "A part of a line between two joints, or a joint and an end.")
          .number("rest_length_m", &SectionOptions::rest_length_m, "m", "Unstretched length.", positive())
          .required()
          .number("weight_N_m", &SectionOptions::weight_N_m, "N/m", "Weight in water per unstretched length.", positive())
          .required()
          .number("axial_stiffness_N", &SectionOptions::axial_stiffness_N, "N", "Axial stiffness EA.", positive())
          .required();
  return section;
}

/// What `check` can say of one line by itself.
void check_line(const LineOptions& o, const scene::Report& report) {
  for (const ClumpOptions& clump : o.clumps) {
    if (clump.distance_m >= o.length_m() && o.length_m() > 0.0)
      report("clumps", fmt::format("has one at {} m, where the line of {} m has ended", clump.distance_m, o.length_m()));
    if (clump.mass_kg == 0.0 && clump.volume_m3 == 0.0) report("clumps", "has one without mass and volume");
    if (const ClumpOptions none; !o.sections.empty() && (clump.drag_area_m2 != none.drag_area_m2 ||
                                                         clump.added_mass_coefficient != none.added_mass_coefficient))
      report("clumps", fmt::format("has one with drag_area_m2 or added_mass_coefficient, which have no effect on {}: the line is "
                                   "at rest at all times",
                                   o.model));
  }
  if (o.anchor_body == o.body) report("anchor_body", "is the body that carries the fairlead: a line ties two different things");
}

}  // namespace

const scene::Section<LineOptions>& line_section() {
  using scene::positive, scene::not_negative;
  static const auto section =
      scene::Section<LineOptions>("moorings", "A mooring line: its model, its two ends, its properties.")
          .named()
          .choice("model", &LineOptions::model, line_models().choices(), "Model of the line.")
          .text("body", &LineOptions::body, "Body that carries the fairlead, or junction of a dynamic line.")
          .required()
          .vector("fairlead_m", &LineOptions::fairlead_m, "m",
                  "Fairlead, initial earth coordinates; it moves with its body. Left out at a junction.")
          .text("anchor_body", &LineOptions::anchor_body,
                "What holds the other end: \"earth\", a body, or of a dynamic line a junction.")
          .vector("anchor_m", &LineOptions::anchor_m, "m",
                  "Anchor, initial earth coordinates; may lie outside the tank. Left out at a junction.")
          .number("rest_length_m", &LineOptions::rest_length_m, "m", "Unstretched length.", positive())
          .only_if("model", line_models().with("rest_length_m"))
          .required()
          .number("axial_stiffness_N", &LineOptions::axial_stiffness_N, "N",
                  "Axial stiffness EA; the spring's is EA over the rest length.", positive())
          .only_if("model", line_models().with("axial_stiffness_N"))
          .number("stiffness_N_m", &LineOptions::stiffness_N_m, "N/m", "Stiffness of the whole line: force per lengthening.",
                  positive())
          .only_if("model", line_models().with("stiffness_N_m"))
          .number("damping_N_s_m", &LineOptions::damping_N_s_m, "N s/m", "Force per rate of lengthening.", not_negative())
          .only_if("model", line_models().with("damping_N_s_m"))
          .flag("tension_only", &LineOptions::tension_only,
                "The line goes slack as a rope does; false: a spring that also pushes.")
          .only_if("model", line_models().with("tension_only"))
          .number("weight_N_m", &LineOptions::weight_N_m, "N/m", "Weight in water per unstretched length.", positive())
          .only_if("model", line_models().with("weight_N_m"))
          .required()
          .flag("bed_contact", &LineOptions::bed_contact,
                "The line may lie on the bed: flat at the level of its lower end (of a line that ends at junctions without an "
                "anchor, at the depth of the water), or under lumped_mass lines that of environment.bathymetry.")
          .only_if("model", line_models().with("bed_contact"))
          .number("bed_friction", &LineOptions::bed_friction, "-", "Friction coefficient between line and bed.", not_negative())
          .only_if("model", line_models().with("bed_friction"))
          .only_if("bed_contact", {"true"})
          .integer("segments", &LineOptions::segments, "-", "Equal segments, between point masses.", scene::between(2, 1000))
          .only_if("model", line_models().with("segments"))
          .number("diameter_m", &LineOptions::diameter_m, "m",
                  "Diameter of a cylinder of the line's volume: 1.8 times the bar of a studless chain.", positive())
          .only_if("model", line_models().with("diameter_m"))
          .required()
          .number("mass_kg_m", &LineOptions::mass_kg_m, "kg/m", "Mass per unstretched length, dry.", positive())
          .only_if("model", line_models().with("mass_kg_m"))
          .required()
          .number("damping_ratio", &LineOptions::damping_ratio, "-",
                  "Internal damping, as a share of the critical one of a segment between its two masses.",
                  scene::between(0.0, 1.0))
          .only_if("model", line_models().with("damping_ratio"))
          .number("drag_coefficient", &LineOptions::drag_coefficient, "-",
                  "Drag across the line, on its diameter; studless chain by default.", not_negative())
          .only_if("model", line_models().with("drag_coefficient"))
          .number("axial_drag_coefficient", &LineOptions::axial_drag_coefficient, "-",
                  "Drag along the line, on its circumference; studless chain by default.", not_negative())
          .only_if("model", line_models().with("axial_drag_coefficient"))
          .number("added_mass_coefficient", &LineOptions::added_mass_coefficient, "-",
                  "Added mass across the line, on the displaced one.", not_negative())
          .only_if("model", line_models().with("added_mass_coefficient"))
          .number("axial_added_mass_coefficient", &LineOptions::axial_added_mass_coefficient, "-",
                  "Added mass along the line, on the displaced one.", not_negative())
          .only_if("model", line_models().with("axial_added_mass_coefficient"))
          .number("bed_stiffness_Pa_m", &LineOptions::bed_stiffness_Pa_m, "Pa/m",
                  "Pressure of the bed under the line's diameter per depth of sinking in.", positive())
          .only_if("model", line_models().with("bed_stiffness_Pa_m"))
          .only_if("bed_contact", {"true"})
          .number("bed_damping_Pa_s_m", &LineOptions::bed_damping_Pa_s_m, "Pa s/m",
                  "Pressure of the bed under the line's diameter per speed of sinking in.", not_negative())
          .only_if("model", line_models().with("bed_damping_Pa_s_m"))
          .only_if("bed_contact", {"true"})
          .tables("sections", &LineOptions::sections, part_section(), "Parts of the line, from the anchor to the fairlead.")
          .only_if("model", line_models().with("sections"))
          .required()
          .size(1)
          .tables("clumps", &LineOptions::clumps, clump_section(), "Weights and floats on the line.")
          .only_if("model", line_models().with("clumps"))
          .path("table", &LineOptions::table,
                "CSV file with columns distance_m, tension_N: both increasing. Below the first row its tension holds, beyond the "
                "last the slope goes on, that of the last two rows at least.")
          .only_if("model", line_models().with("table"))
          .required()
          .one_of({"axial_stiffness_N", "stiffness_N_m"})
          .check(check_line);
  return section;
}

double LineOptions::length_m() const {
  double sum = rest_length_m;
  for (const SectionOptions& s : sections) sum += s.rest_length_m;
  return sum;
}

double LineOptions::series_stiffness_N_m() const {
  if (stiffness_N_m) return *stiffness_N_m;
  double compliance = axial_stiffness_N ? rest_length_m / *axial_stiffness_N : 0.0;
  for (const SectionOptions& s : sections) compliance += s.rest_length_m / s.axial_stiffness_N;
  return compliance > 0.0 ? 1.0 / compliance : 0.0;
}

double weight_in_water(const LineOptions& o, double water_density, double gravity) {
  if (o.mass_kg_m == 0.0) return o.weight_N_m;
  return gravity * (o.mass_kg_m - water_density * 0.25 * pi * o.diameter_m * o.diameter_m);
}

const scene::Section<JunctionOptions>& junction_section() {
  using scene::not_negative;
  static const auto section =
      scene::Section<JunctionOptions>("junctions",
                                      "A point free in the water at which dynamic lines end: a bridle's, a weight or a float "
                                      "between lines.")
          .named()
          .vector("position_m", &JunctionOptions::position_m, "m",
                  "About where it is at the start, earth coordinates: there the search for its rest begins.")
          .required()
          .number("mass_kg", &JunctionOptions::mass_kg, "kg", "Mass, dry, besides that of the lines.", not_negative())
          .number("volume_m3", &JunctionOptions::volume_m3, "m3", "Volume, besides that of the lines.", not_negative())
          .number("drag_area_m2", &JunctionOptions::drag_area_m2, "m2", "Drag coefficient times area.", not_negative())
          .number("added_mass_coefficient", &JunctionOptions::added_mass_coefficient, "-",
                  "On the displaced mass; a sphere's by default.", not_negative());
  return section;
}

void place_at_junctions(std::vector<scene::Named<LineOptions>>& lines,
                        const std::vector<scene::Named<JunctionOptions>>& junctions, double water_depth) {
  for (auto& [name, line] : lines) {
    const auto place = [&](const std::string& end, std::optional<Eigen::Vector3d>& at) {
      const auto found = std::ranges::find(junctions, end, &scene::Named<JunctionOptions>::name);
      if (found != junctions.end()) at = found->options.position_m;
      return found != junctions.end();
    };
    const bool above = place(line.body, line.fairlead_m), below = place(line.anchor_body, line.anchor_m);
    if (above || below) line.bed_level_m = line.anchor_body == "earth" ? line.anchor_m->z() : -water_depth;
  }
}

namespace {

/// Junctions that no line names, loose ends, and those that no row of lines ties to a body or the earth.
void check_held(scene::Document& doc, const std::vector<scene::Named<LineOptions>>& lines,
                const std::vector<scene::Named<JunctionOptions>>& points, std::span<const std::string> junctions) {
  std::vector<std::string> held;
  const auto has = [](std::span<const std::string> names, const std::string& name) {
    return std::ranges::find(names, name) != names.end();
  };
  const auto holds = [&](const std::string& end) { return !has(junctions, end) || has(held, end); };
  for (std::size_t before = held.size() + 1; before != held.size();) {
    before = held.size();
    for (const auto& [name, line] : lines)
      for (const auto& [one, other] : {std::pair{line.body, line.anchor_body}, std::pair{line.anchor_body, line.body}})
        if (!holds(one) && holds(other)) held.push_back(one);
  }
  for (const auto& [name, point] : points) {
    const auto ends = std::ranges::count(lines, name, [](const auto& l) { return l.options.body; }) +
                      std::ranges::count(lines, name, [](const auto& l) { return l.options.anchor_body; });
    if (ends == 0)
      doc.problem("junctions." + name, "is named by no end of a line (moorings.NAME.body or anchor_body)");
    else if (!has(held, name))
      doc.problem("junctions." + name, "is held by nothing: no row of lines leads from it to a body or to \"earth\"");
    else if (ends == 1 && point.mass_kg == 0.0 && point.volume_m3 == 0.0)
      doc.problem(
          "junctions." + name,
          "is the loose end of one line: name it at an end of another line, or give mass_kg or volume_m3 of what hangs there");
  }
}

}  // namespace

bool lies_on_bed(const LineOptions& line) { return line_models().named(line.model).make_dynamic && line.bed_contact; }

void check_bed(scene::Document& doc, const std::vector<scene::Named<LineOptions>>& lines, const Bed& bed) {
  for (const auto& [name, line] : lines) {
    const LineModel& model = line_models().named(line.model);
    if (!model.hangs || model.make_dynamic || !line.bed_contact || line.anchor_body != "earth" || !line.anchor_m ||
        !line.fairlead_m)
      continue;
    constexpr int steps = 100;
    constexpr double most = 0.02;  // of the height of the fairlead over the anchor
    double low = 0.0, high = -std::numeric_limits<double>::infinity();
    for (int n = 0; n <= steps; ++n) {
      const Eigen::Vector3d at = *line.anchor_m + n / double(steps) * line.span();
      const double z = bed.level(at.x(), at.y());
      low = std::min(low, z), high = std::max(high, z);
    }
    if (high - low > most * std::abs(line.span().z()))
      doc.problem(
          "moorings." + name + ".model",
          fmt::format("is {}, which lies on flat ground, but between anchor and fairlead the bed of environment.bathymetry is "
                      "{:.4g} to {:.4g} m deep: take lumped_mass, or bed_contact = false",
                      line.model, -high, -low));
  }
}

void check_lines(scene::Document& doc, const std::vector<scene::Named<LineOptions>>& lines,
                 const std::vector<scene::Named<JunctionOptions>>& junctions, std::span<const std::string> bodies,
                 double water_density) {
  std::vector<std::string> free;
  for (const auto& junction : junctions) free.push_back(junction.name);
  std::vector<std::string> known(bodies.begin(), bodies.end());
  known.insert(known.end(), free.begin(), free.end());
  const auto among = [](std::span<const std::string> names, const std::string& name) {
    return std::ranges::find(names, name) != names.end();
  };
  for (const auto& [name, line] : lines) {
    const std::string at = "moorings." + name;
    const auto check_end = [&](const char* key, const std::string& end, const char* place_key, bool placed) {
      if (among(free, end)) {
        if (placed) doc.problem(at + "." + place_key, fmt::format("must be left out: the end is at junction \"{}\"", end));
        if (!line_models().named(line.model).make_dynamic)
          doc.problem(at + "." + key,
                      fmt::format("names junction \"{}\": of the models of lines only lumped_mass has nodes that move "
                                  "with it, not {}; sections one after another are a composite_catenary",
                                  end, line.model));
        return;
      }
      if (!placed)
        doc.problem(
            at + "." + place_key,
            fmt::format(
                "is required: the place of the line's end on {}, [x, y, z] in m, earth frame at the start{}",
                end == "earth" ? "the earth" : fmt::format("body \"{}\"", end),
                line_models().named(line.model).make_dynamic ? fmt::format("; or name one of [junctions] in {}", key) : ""));
      if (end == "earth" && std::string(key) == "anchor_body") return;
      if (!among(bodies, end))
        doc.problem(at + "." + key, end == "earth" ? "the fairlead must be on a body; \"earth\" may hold the anchor"
                                                   : fmt::format("names body \"{}\", which is not in [bodies]{}; known: {}", end,
                                                                 free.empty() ? "" : " or [junctions]", fmt::join(known, ", ")));
    };
    check_end("body", line.body, "fairlead_m", line.fairlead_m.has_value());
    check_end("anchor_body", line.anchor_body, "anchor_m", line.anchor_m.has_value());
    if (line_models().named(line.model).hangs && line.bed_contact && among(bodies, line.body) && among(bodies, line.anchor_body))
      doc.problem(at + ".bed_contact",
                  "must be false for a line between two bodies: only an anchor on \"earth\" lies on the bed");
    if (line.fairlead_m && line.anchor_m && line.span().norm() == 0.0)
      doc.problem(at + ".anchor_m", "is where the fairlead is: the line has no direction");
    if (line.mass_kg_m > 0.0 && line.diameter_m > 0.0 && !(weight_in_water(line, water_density, 1.0) > 0.0))
      doc.problem(at + ".mass_kg_m", fmt::format("must be above the {:.4g} kg/m of the water that diameter_m = {} displaces: "
                                                 "the line would float",
                                                 line.mass_kg_m - weight_in_water(line, water_density, 1.0), line.diameter_m));
    if (!line.table.empty()) try {
        read_line_table(line.table);
      } catch (const scene::SceneError& e) { doc.problem(at + ".table", e.what()); }
  }
  check_held(doc, lines, junctions, free);
}

}  // namespace spindrift::moorings
