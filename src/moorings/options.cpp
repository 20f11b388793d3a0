// SPDX-License-Identifier: Apache-2.0
#include "src/moorings/options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "src/moorings/table_file.hpp"
#include "src/scene/document.hpp"

namespace spindrift::moorings {

namespace {

const std::vector<std::string> springs{"spring_damper"}, catenaries{"catenary"}, elastic{"spring_damper", "catenary"},
    tables{"table"};

/// What `check` can say of one line by itself.
void check_line(const LineOptions& o, const scene::Report& report) {
  if (o.anchor_body == o.body) report("anchor_body", "is the body that carries the fairlead: a line ties two different things");
  if (o.model == "catenary" && o.bed_contact && o.anchor_body != "earth")
    report("bed_contact", "must be false for a line between two bodies: only an anchor on \"earth\" lies on the bed");
}

}  // namespace

const scene::Section<LineOptions>& line_section() {
  using scene::positive, scene::not_negative;
  static const auto section =
      scene::Section<LineOptions>("moorings", "A mooring line: its model, its two ends, its properties.")
          .named()
          .choice("model", &LineOptions::model,
                  {{"spring_damper", "linear spring and damper along the chord"},
                   {"catenary", "static elastic catenary, with or without contact on a flat bed"},
                   {"table", "tension from a table of the distance between the ends"}},
                  "Model of the line.")
          .text("body", &LineOptions::body, "Body that carries the fairlead.")
          .required()
          .vector("fairlead_m", &LineOptions::fairlead_m, "m", "Fairlead, initial earth coordinates; it moves with its body.")
          .required()
          .text("anchor_body", &LineOptions::anchor_body, "What holds the other end: \"earth\" or a body.")
          .vector("anchor_m", &LineOptions::anchor_m, "m", "Anchor, initial earth coordinates; may lie outside the tank.")
          .required()
          .number("rest_length_m", &LineOptions::rest_length_m, "m", "Unstretched length.", positive())
          .only_if("model", elastic)
          .required()
          .number("axial_stiffness_N", &LineOptions::axial_stiffness_N, "N",
                  "Axial stiffness EA; the spring's is EA over the rest length.", positive())
          .only_if("model", elastic)
          .number("stiffness_N_m", &LineOptions::stiffness_N_m, "N/m", "Stiffness of the whole line: force per lengthening.",
                  positive())
          .only_if("model", springs)
          .number("damping_N_s_m", &LineOptions::damping_N_s_m, "N s/m", "Force per rate of lengthening.", not_negative())
          .only_if("model", springs)
          .flag("tension_only", &LineOptions::tension_only, "The line goes slack instead of pushing.")
          .only_if("model", springs)
          .number("weight_N_m", &LineOptions::weight_N_m, "N/m", "Weight in water per unstretched length.", positive())
          .only_if("model", catenaries)
          .required()
          .flag("bed_contact", &LineOptions::bed_contact, "The line may lie on a flat bed at the level of its lower end.")
          .only_if("model", catenaries)
          .number("bed_friction", &LineOptions::bed_friction, "-", "Friction coefficient between line and bed.", not_negative())
          .only_if("model", catenaries)
          .only_if("bed_contact", {"true"})
          .path("table", &LineOptions::table,
                "CSV file with columns distance_m, tension_N: both increasing. Below the first row its tension holds, beyond the "
                "last "
                "the last slope goes on.")
          .only_if("model", tables)
          .required()
          .one_of({"axial_stiffness_N", "stiffness_N_m"})
          .check(check_line);
  return section;
}

void check_lines(scene::Document& doc, const std::vector<scene::Named<LineOptions>>& lines, std::span<const std::string> bodies) {
  const auto known = [&](const std::string& body) { return std::find(bodies.begin(), bodies.end(), body) != bodies.end(); };
  for (const auto& [name, line] : lines) {
    const std::string at = "moorings." + name;
    const auto unknown = [&](const std::string& body) {
      return fmt::format("names body \"{}\", which is not in [bodies]; known: {}", body, fmt::join(bodies, ", "));
    };
    if (!known(line.body))
      doc.problem(at + ".body",
                  line.body == "earth" ? "the fairlead must be on a body; \"earth\" may hold the anchor" : unknown(line.body));
    if (line.anchor_body != "earth" && !known(line.anchor_body)) doc.problem(at + ".anchor_body", unknown(line.anchor_body));
    if ((line.fairlead_m - line.anchor_m).norm() == 0.0)
      doc.problem(at + ".anchor_m", "is where the fairlead is: the line has no direction");
    if (line.model == "table" && !line.table.empty()) try {
        read_line_table(line.table);
      } catch (const scene::SceneError& e) { doc.problem(at + ".table", e.what()); }
  }
}

}  // namespace spindrift::moorings
