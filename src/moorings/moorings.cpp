// SPDX-License-Identifier: Apache-2.0
#include "src/moorings/moorings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kernels/base/failure.hpp"
#include "kernels/waves/morison.hpp"

namespace spindrift::moorings {

/// Time and ends of the last step's end, forces there and how they changed in the step, nodes: as they lie in the memory.
struct Moorings::Recalled {
  static constexpr std::size_t ends = 1, forces = 13, changes = 19, nodes = 25;
  std::span<const double> of;

  double time() const { return of[0]; }
  Eigen::Vector3d at(std::size_t first) const { return Eigen::Map<const Eigen::Vector3d>(of.data() + first); }
  LineEnds line_ends() const { return {{at(ends), at(ends + 3)}, {at(ends + 6), at(ends + 9)}}; }
  LineForces at_end() const {
    LineForces f{at(forces), at(forces + 3)};
    f.fairlead_tension = f.on_fairlead.norm(), f.anchor_tension = f.on_anchor.norm();
    return f;
  }

  static void write(double time, const LineEnds& e, const LineForces& f, const LineForces& rate, std::span<double> memory) {
    memory[0] = time;
    std::size_t k = ends;
    for (const Eigen::Vector3d& v : {e.anchor.position, e.anchor.velocity, e.fairlead.position, e.fairlead.velocity,
                                     f.on_fairlead, f.on_anchor, rate.on_fairlead, rate.on_anchor}) {
      Eigen::Map<Eigen::Vector3d>(memory.data() + k) = v;
      k += 3;
    }
  }
};

Moorings::Moorings(std::span<const std::string> bodies, std::span<const Motion> start, LineEnvironment environment)
    : bodies_(bodies.begin(), bodies.end()), start_(start.begin(), start.end()), environment_(std::move(environment)) {
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
  Line line{name, attach(o.body, o.fairlead_m), attach(o.anchor_body, o.anchor_m), {}, {}};
  const LineModel& model = line_models().named(o.model);
  line.model = model.make(o, environment_);
  if (model.make_dynamic) {
    const LineLumpedMass dynamic = model.make_dynamic(o, environment_);
    line.dynamic = Dynamic{dynamic, dynamic.scratch(), memory_size_};
    memory_size_ += Recalled::nodes + dynamic.state_size();
  }
  lines_.push_back(std::move(line));
}

LineEnd Moorings::moving(const End& end, std::span<const Motion> bodies) const {
  if (end.body < 0) return {end.point, Eigen::Vector3d::Zero()};
  return {bodies[end.body].point(end.point), bodies[end.body].point_velocity(end.point)};
}

LineEnds Moorings::ends(const Line& line, std::span<const Motion> bodies) const {
  return {moving(line.anchor, bodies), moving(line.fairlead, bodies)};
}

LineForces Moorings::forces(const Line& line, double t, std::span<const Motion> bodies) const {
  if (line.dynamic && !memory_.empty()) {
    const Recalled last{std::span(memory_).subspan(line.dynamic->first)};
    LineForces f = last.at_end();
    f.on_fairlead += (t - last.time()) * last.at(Recalled::changes),
        f.on_anchor += (t - last.time()) * last.at(Recalled::changes + 3);
    return f;
  }
  const auto [anchor, fairlead] = ends(line, bodies);
  if (line.dynamic && !line.dynamic->line.clumps.empty()) return resting(*line.dynamic, {anchor, fairlead});
  return line.model->forces(fairlead.position - anchor.position, fairlead.velocity - anchor.velocity);
}

/// No catenary has clumps.
LineForces Moorings::resting(const Dynamic& dynamic, LineEnds ends) {
  std::vector<double> state(dynamic.line.state_size()), rate(state.size());
  ends.anchor.velocity.setZero(), ends.fairlead.velocity.setZero();
  dynamic.line.rest(ends, state);
  LineLumpedMass::Scratch scratch = dynamic.line.scratch();
  return dynamic.line.rates(0.0, ends, state, rate, StillWater{}, scratch);
}

void Moorings::add_loads(double t, std::span<const Motion> bodies, std::span<Wrench> wrenches) const {
  for (const Line& line : lines_) {
    const LineForces f = forces(line, t, bodies);
    const auto pull = [&](const End& end, const Eigen::Vector3d& force) {
      if (end.body >= 0) wrenches[end.body].add_force(force, bodies[end.body].point(end.point));
    };
    pull(line.fairlead, f.on_fairlead);
    pull(line.anchor, f.on_anchor);
  }
}

void Moorings::add_added_mass(std::span<const Motion> bodies, std::span<Eigen::Matrix<double, 6, 6>> masses) const {
  if (memory_.empty()) return;
  for (const Line& line : lines_) {
    if (!line.dynamic) continue;
    const LineLumpedMass& model = line.dynamic->line;
    const Recalled last{std::span(memory_).subspan(line.dynamic->first)};
    const LineEnds e = last.line_ends();
    const LineLumpedMass::Nodes nodes{model, e, last.of.subspan(Recalled::nodes, model.state_size())};
    const auto add = [&](const End& end, int node) {
      if (end.body < 0) return;
      const Eigen::Vector3d arm = bodies[end.body].point(end.point) - bodies[end.body].position;
      waves::add_point_inertia(model.end_mass(model.tangent(nodes, node)), arm, masses[end.body]);
    };
    add(line.fairlead, model.segments);
    add(line.anchor, 0);
  }
}

LineTension Moorings::tension(std::size_t line, std::span<const Motion> bodies) const {
  const LineForces f = is_dynamic(line) && !memory_.empty()
                           ? Recalled{std::span(memory_).subspan(lines_[line].dynamic->first)}.at_end()
                           : forces(lines_[line], 0.0, bodies);
  return {f.fairlead_tension, f.anchor_tension};
}

void Moorings::begin(double t, std::span<const Motion> bodies, std::span<double> memory) {
  std::vector<double> rate;
  for (Line& line : lines_) {
    if (!line.dynamic) continue;
    auto& [model, scratch, first] = *line.dynamic;
    const std::span<double> state = memory.subspan(first + Recalled::nodes, model.state_size());
    const LineEnds now = ends(line, bodies);
    const LineLumpedMass::Rest rest = model.rest(now, state);
    if (!rest.found())
      throw NumericalFailure(fmt::format("moorings.{} at t = {:.6g} s: the line finds no rest: {:.3g} N are left on a node after "
                                         "{} iterations, {:.3g} N are "
                                         "allowed; look at its length, its ends and its segments",
                                         line.name, t, rest.residual, rest.iterations, rest.limit),
                             "moorings." + line.name, 0, t, rest.limit);
    for (int i = 1; i < model.segments; ++i) {  // an end that moves at the start takes the nodes along
      const double share = double(i) / model.segments;
      Eigen::Map<Eigen::Vector3d>(state.data() + 3 * (model.inner() + std::size_t(i - 1))) =
          (1.0 - share) * now.anchor.velocity + share * now.fairlead.velocity;
    }
    rate.resize(state.size());
    Recalled::write(t, now, model.rates(t, now, state, rate, environment_.water, scratch), {}, memory.subspan(first));
  }
  recall(memory);
}

/// One step of a dynamic line, repeated in ever more substeps while it does not end in numbers.
LineForces Moorings::go_on(Line& line, double t, double h, const LineEnds& from, const LineEnds& to, std::span<double> state) {
  auto& [model, scratch, first] = *line.dynamic;
  constexpr double least = 1e-6;  // of the line itself, so that shorter steps of the bodies do not hide it
  if (const double substep = model.largest_step(); !(substep >= least))
    throw NumericalFailure(
        fmt::format(
            "moorings.{} at t = {:.6g} s: the line needs substeps of {:.3g} s, the least is {:.3g} s: its segments of {:.3g} "
            "m are too stiff, too light or too short; take fewer segments, or look at its units",
            line.name, t, substep, least, model.segment()),
        "moorings." + line.name, 0, t, least);
  constexpr int finest = 16;
  const std::vector<double>& before = (kept_.assign(state.begin(), state.end()), kept_);
  for (int finer = 1; finer <= finest; finer *= 2) {
    const LineForces f = model.advance(t, h, from, to, state, environment_.water, scratch, finer);
    if (std::isfinite(f.fairlead_tension + f.anchor_tension) &&
        std::all_of(state.begin(), state.end(), [](double x) { return std::isfinite(x); }))
      return f;
    std::copy(before.begin(), before.end(), state.begin());
  }
  throw NumericalFailure(
      fmt::format("moorings.{} at t = {:.6g} s: the line's motion has no numbers even in substeps of {:.3g} s; its fairlead "
                  "moves by {:.3g} m "
                  "in the step of {:.3g} s",
                  line.name, t, h / (finest * model.substeps(h)), (to.fairlead.position - from.fairlead.position).norm(), h),
      "moorings." + line.name, 0, t, h);
}

void Moorings::remember(double t, double h, std::span<const Motion> bodies, std::span<double> memory) {
  for (Line& line : lines_) {
    if (!line.dynamic) continue;
    auto& [model, scratch, first] = *line.dynamic;
    const Recalled last{memory.subspan(first)};
    const LineForces before = last.at_end();
    const LineEnds now = ends(line, bodies);
    const LineForces f =
        go_on(line, t - h, h, last.line_ends(), now, memory.subspan(first + Recalled::nodes, model.state_size()));
    const LineForces change{(f.on_fairlead - before.on_fairlead) / h, (f.on_anchor - before.on_anchor) / h};
    Recalled::write(t, now, f, change, memory.subspan(first));
  }
}

}  // namespace spindrift::moorings
