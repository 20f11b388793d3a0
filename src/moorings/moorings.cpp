// SPDX-License-Identifier: Apache-2.0
#include "src/moorings/moorings.hpp"

#include <algorithm>

#include "src/moorings/table_file.hpp"

namespace spindrift::moorings {

namespace {

struct Moving {
  Eigen::Vector3d position, velocity;
};

}  // namespace

Moorings::Moorings(std::span<const std::string> bodies, std::span<const Motion> start)
    : bodies_(bodies.begin(), bodies.end()), start_(start.begin(), start.end()) {
  SPINDRIFT_ASSERT(bodies_.size() == start_.size(), "one initial motion for each body");
}

Moorings::End Moorings::attach(const std::string& body, const Eigen::Vector3d& point) const {
  if (body == "earth") return {-1, point};
  const auto found = std::find(bodies_.begin(), bodies_.end(), body);
  SPINDRIFT_ASSERT(found != bodies_.end(), "line tied to an unknown body");
  const Motion& m = start_[found - bodies_.begin()];
  return {int(found - bodies_.begin()), m.attitude.conjugate() * (point - m.position)};
}

void Moorings::add(const std::string& name, const LineOptions& o) {
  Line line{name, attach(o.body, o.fairlead_m), attach(o.anchor_body, o.anchor_m), {}};
  if (o.model == "spring_damper") {
    const double k = o.stiffness_N_m ? *o.stiffness_N_m : *o.axial_stiffness_N / o.rest_length_m;
    line.model = LineSpringDamper{o.rest_length_m, k, o.damping_N_s_m, o.tension_only};
  } else if (o.model == "catenary") {
    line.model = LineCatenary{o.rest_length_m, o.weight_N_m, *o.axial_stiffness_N, o.bed_friction, o.bed_contact};
  } else {
    auto [distance, tension] = read_line_table(o.table);
    Table& table = tables_.emplace_back(std::move(distance), std::move(tension), std::vector<double>());
    table.slope.resize(table.distance.size());
    monotone_slopes(table.distance, table.tension, table.slope);
    line.model = LineTable{table.distance, table.tension, table.slope};
  }
  lines_.push_back(std::move(line));
}

LineForces Moorings::forces(const Line& line, std::span<const Motion> bodies) const {
  const auto moving = [&](const End& end) {
    if (end.body < 0) return Moving{end.point, Eigen::Vector3d::Zero()};
    return Moving{bodies[end.body].point(end.point), bodies[end.body].point_velocity(end.point)};
  };
  const Moving fairlead = moving(line.fairlead), anchor = moving(line.anchor);
  return std::visit(
      [&](const auto& model) { return model.forces(fairlead.position - anchor.position, fairlead.velocity - anchor.velocity); },
      line.model);
}

void Moorings::add_loads(double /*t*/, std::span<const Motion> bodies, std::span<Wrench> wrenches) const {
  for (const Line& line : lines_) {
    const LineForces f = forces(line, bodies);
    const auto pull = [&](const End& end, const Eigen::Vector3d& force) {
      if (end.body >= 0) wrenches[end.body].add_force(force, bodies[end.body].point(end.point));
    };
    pull(line.fairlead, f.on_fairlead);
    pull(line.anchor, f.on_anchor);
  }
}

namespace {
const LineSpringDamper* snapping(const std::variant<LineSpringDamper, LineCatenary, LineTable>& model) {
  const auto* spring = std::get_if<LineSpringDamper>(&model);
  return spring && spring->tension_only ? spring : nullptr;
}
}  // namespace

bool Moorings::can_snap() const {
  return std::any_of(lines_.begin(), lines_.end(), [](const Line& line) { return snapping(line.model) != nullptr; });
}

std::uint64_t Moorings::taut(std::span<const Motion> bodies) const {
  std::uint64_t bits = 0;
  int bit = 0;
  const auto at = [&](const End& end) { return end.body < 0 ? end.point : bodies[std::size_t(end.body)].point(end.point); };
  for (const Line& line : lines_)
    if (const LineSpringDamper* spring = snapping(line.model)) {
      if ((at(line.fairlead) - at(line.anchor)).norm() > spring->rest_length) bits |= std::uint64_t(1) << bit;
      bit = std::min(bit + 1, 63);
    }
  return bits;
}

LineTension Moorings::tension(std::size_t line, std::span<const Motion> bodies) const {
  const LineForces f = forces(lines_[line], bodies);
  return {f.fairlead_tension, f.anchor_tension};
}

}  // namespace spindrift::moorings
