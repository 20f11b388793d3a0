// SPDX-License-Identifier: Apache-2.0
#include "src/moorings/moorings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kernels/base/failure.hpp"
#include "kernels/waves/morison.hpp"

namespace spindrift::moorings {

/// Time and ends of the last step's end, forces there and how they changed in the step: as they lie in the memory.
struct Moorings::Recalled {
  static constexpr std::size_t ends = 1, forces = 13, changes = 19, size = 25;
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

Moorings::End Moorings::attach(const std::string& body, const std::optional<Eigen::Vector3d>& point) const {
  const auto junction = std::ranges::find(junctions_, body, &Junction::name);
  if (junction != junctions_.end()) return {none, int(junction - junctions_.begin()), Eigen::Vector3d::Zero()};
  SPINDRIFT_ASSERT(point, "an end that is at no junction has a place");
  if (body == "earth") return {none, none, *point};
  const auto found = std::find(bodies_.begin(), bodies_.end(), body);
  SPINDRIFT_ASSERT(found != bodies_.end(), "line tied to an unknown body");
  const Motion& m = start_[found - bodies_.begin()];
  return {int(found - bodies_.begin()), none, m.attitude.conjugate() * (*point - m.position)};
}

void Moorings::add_junction(const std::string& name, const JunctionOptions& o) {
  junctions_.push_back({name, {o.position_m, o.mass_kg, o.volume_m3, o.drag_area_m2, o.added_mass_coefficient}});
}

void Moorings::add(const std::string& name, const LineOptions& o) {
  Line line{name, attach(o.body, o.fairlead_m), attach(o.anchor_body, o.anchor_m), {}, {}};
  const LineModel& model = line_models().named(o.model);
  line.model = model.make(o, environment_);
  if (model.make_dynamic) line.dynamic = Dynamic{model.make_dynamic(o, environment_)};
  SPINDRIFT_ASSERT(line.dynamic || (line.fairlead.junction == none && line.anchor.junction == none),
                   "lines at junctions have nodes");
  lines_.push_back(std::move(line));
  connect();
}

/// Networks of all lines so far, in the order of the first line of each, and where they lie in the memory.
void Moorings::connect() {
  const auto ends_at = [](const Line& line, std::size_t j) {
    return line.fairlead.junction == int(j) || line.anchor.junction == int(j);
  };
  std::vector<std::size_t> first(lines_.size());  // line of the network of each line
  for (std::size_t l = 0; l < first.size(); ++l) first[l] = l;
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t j = 0; j < junctions_.size(); ++j) {
      std::size_t least = lines_.size();
      for (std::size_t l = 0; l < lines_.size(); ++l)
        if (ends_at(lines_[l], j)) least = std::min(least, first[l]);
      for (std::size_t l = 0; l < lines_.size(); ++l)
        if (ends_at(lines_[l], j) && first[l] != least) first[l] = least, changed = true;
    }
  }
  networks_.clear(), memory_size_ = 0;
  for (std::size_t l = 0; l < lines_.size(); ++l) {
    if (!lines_[l].dynamic || first[l] != l) continue;
    Network network;
    network.of.gravity = environment_.gravity_m_s2, network.of.water_density = environment_.water_density_kg_m3;
    std::vector<int> member(junctions_.size(), LineNetwork::led);
    const auto held_by = [&](int j) {
      if (j == none) return LineNetwork::led;
      Junction& junction = junctions_[std::size_t(j)];
      if (member[std::size_t(j)] == LineNetwork::led) {
        if (network.junction.empty()) network.junction = junction.name;
        member[std::size_t(j)] = int(network.of.junctions.size());
        junction.network = networks_.size(), junction.member = network.of.junctions.size();
        network.of.junctions.push_back(junction.point);
      }
      return member[std::size_t(j)];
    };
    for (std::size_t k = l; k < lines_.size(); ++k) {
      if (first[k] != l) continue;
      Dynamic& own = *lines_[k].dynamic;
      own.network = networks_.size(), own.member = network.lines.size(), own.header = memory_size_;
      network.lines.push_back(k), memory_size_ += Recalled::size;
      network.of.lines.push_back({own.line, held_by(lines_[k].anchor.junction), held_by(lines_[k].fairlead.junction)});
    }
    network.state = memory_size_, memory_size_ += network.of.state_size();
    network.scratch = network.of.scratch();
    networks_.push_back(std::move(network));
  }
}

bool Moorings::Network::hangs_free() const {
  const LineLumpedMass& first = of.lines[0].line;
  return !junction.empty() || !first.clumps.empty() || (first.bed.shape && first.bed.contact);
}

LineEnd Moorings::moving(const End& end, std::span<const Motion> bodies) const {
  if (end.body < 0) return {end.point, Eigen::Vector3d::Zero()};
  return {bodies[end.body].point(end.point), bodies[end.body].point_velocity(end.point)};
}

LineEnds Moorings::ends(const Line& line, std::span<const Motion> bodies) const {
  return {moving(line.anchor, bodies), moving(line.fairlead, bodies)};
}

std::optional<TautLine> Moorings::taut(std::size_t l) const { return lines_[l].dynamic ? std::nullopt : lines_[l].model->taut(); }

Moorings::Chord Moorings::chord(std::size_t l, std::span<const Motion> bodies) const {
  const Line& line = lines_[l];
  const auto body = [](const End& end) { return end.body < 0 ? std::nullopt : std::optional(std::size_t(end.body)); };
  return {moving(line.anchor, bodies).position, moving(line.fairlead, bodies).position, body(line.anchor), body(line.fairlead)};
}

std::vector<LineEnds> Moorings::ends(const Network& network, std::span<const Motion> bodies) const {
  std::vector<LineEnds> all;
  for (const std::size_t l : network.lines) all.push_back(ends(lines_[l], bodies));
  return all;
}

LineForces Moorings::forces(std::size_t l, double t, std::span<const Motion> bodies, std::span<const LineForces> resting) const {
  const Line& line = lines_[l];
  if (line.dynamic && !memory_.empty()) {
    const Recalled last{std::span(memory_).subspan(line.dynamic->header)};
    LineForces f = last.at_end();
    f.on_fairlead += (t - last.time()) * last.at(Recalled::changes),
        f.on_anchor += (t - last.time()) * last.at(Recalled::changes + 3);
    return f;
  }
  if (line.dynamic && networks_[line.dynamic->network].hangs_free()) return resting[l];
  const auto [anchor, fairlead] = ends(line, bodies);
  return line.model->forces(fairlead.position - anchor.position, fairlead.velocity - anchor.velocity);
}

std::vector<LineForces> Moorings::resting(std::span<const Motion> bodies) const {
  std::vector<LineForces> all;
  for (const Network& network : networks_) {
    if (!network.hangs_free()) continue;
    all.resize(lines_.size());
    std::vector<LineEnds> outer = ends(network, bodies);
    for (LineEnds& e : outer) e.anchor.velocity.setZero(), e.fairlead.velocity.setZero();
    std::vector<double> state(network.of.state_size()), rate(state.size());
    network.of.rest(outer, state);
    LineNetwork::Scratch scratch = network.of.scratch();
    network.of.rates(0.0, outer, state, rate, StillWater{}, scratch);
    for (std::size_t k = 0; k < network.lines.size(); ++k) all[network.lines[k]] = scratch.forces[k];
  }
  return all;
}

void Moorings::add_loads(double t, std::span<const Motion> bodies, std::span<Wrench> wrenches) const {
  const std::vector<LineForces> at_rest = memory_.empty() ? resting(bodies) : std::vector<LineForces>();
  for (std::size_t l = 0; l < lines_.size(); ++l) {
    const LineForces f = forces(l, t, bodies, at_rest);
    const auto pull = [&](const End& end, const Eigen::Vector3d& force) {
      if (end.body >= 0) wrenches[end.body].add_force(force, bodies[end.body].point(end.point));
    };
    pull(lines_[l].fairlead, f.on_fairlead);
    pull(lines_[l].anchor, f.on_anchor);
  }
}

void Moorings::add_added_mass(std::span<const Motion> bodies, std::span<Eigen::Matrix<double, 6, 6>> masses) const {
  if (memory_.empty()) return;
  for (const Network& network : networks_) {
    std::size_t first = network.state;
    for (const std::size_t l : network.lines) {
      const Line& line = lines_[l];
      const LineLumpedMass& model = line.dynamic->line;
      const LineEnds e = Recalled{std::span(memory_).subspan(line.dynamic->header)}.line_ends();
      const LineLumpedMass::Nodes nodes{model, e, std::span(memory_).subspan(first, model.state_size())};
      constexpr double still_water = 0.0;
      const auto add = [&](const End& end, int node) {
        if (end.body < 0) return;
        const Eigen::Vector3d arm = bodies[end.body].point(end.point) - bodies[end.body].position;
        waves::add_point_inertia(model.end_mass(nodes, node, still_water), arm, masses[end.body]);
      };
      add(line.fairlead, model.segments);
      add(line.anchor, 0);
      first += model.state_size();
    }
  }
}

std::vector<LineTension> Moorings::tensions(std::span<const Motion> bodies) const {
  const std::vector<LineForces> at_rest = memory_.empty() ? resting(bodies) : std::vector<LineForces>();
  std::vector<LineTension> all;
  for (std::size_t l = 0; l < lines_.size(); ++l) {
    const LineForces f = is_dynamic(l) && !memory_.empty()
                             ? Recalled{std::span(memory_).subspan(lines_[l].dynamic->header)}.at_end()
                             : forces(l, 0.0, bodies, at_rest);
    all.push_back({f.fairlead_tension, f.anchor_tension});
  }
  return all;
}

std::vector<LineEnd> Moorings::junction_motions(std::span<const Motion> bodies) const {
  std::vector<LineEnd> all(junctions_.size());
  for (std::size_t n = 0; n < networks_.size(); ++n) {
    const Network& network = networks_[n];
    if (network.junction.empty()) continue;
    std::vector<double> at_rest;
    std::span<const double> state = std::span(memory_);
    if (memory_.empty()) {
      at_rest.resize(network.of.state_size());
      network.of.rest(ends(network, bodies), at_rest), state = at_rest;
    } else {
      state = state.subspan(network.state, network.of.state_size());
    }
    for (std::size_t j = 0; j < junctions_.size(); ++j)
      if (junctions_[j].network == n) all[j] = network.of.junction(int(junctions_[j].member), state);
  }
  return all;
}

std::vector<double> Moorings::rest(const Network& network, double t, std::span<const Motion> bodies) const {
  std::vector<LineEnds> outer = ends(network, bodies);
  std::vector<double> state(network.of.state_size());
  const LineNetwork::Rest rest = network.of.rest(outer, state);
  const std::string& first = lines_[network.lines[0]].name;
  if (!rest.found())
    throw NumericalFailure(
        network.junction.empty()
            ? fmt::format("moorings.{} at t = {:.6g} s: the line finds no rest: {:.3g} N are left on a node after {} iterations, "
                          "{:.3g} N are allowed; look at its length, its ends and its segments",
                          first, t, rest.residual, rest.iterations, rest.limit)
            : fmt::format("junctions.{} at t = {:.6g} s: the lines that meet find no rest: {:.3g} N are left on a node after {} "
                          "iterations, {:.3g} N are allowed; look at their lengths, ends and segments",
                          network.junction, t, rest.residual, rest.iterations, rest.limit),
        network.junction.empty() ? "moorings." + first : "junctions." + network.junction, 0, t, rest.limit);
  // Ends that move at the start take junctions along as if the lines were always at rest, and nodes between their ends.
  const std::size_t count = 3 * network.of.junctions.size(), places = state.size() - 2 * count;
  if (std::ranges::any_of(outer,
                          [](const LineEnds& e) { return !e.anchor.velocity.isZero(0.0) || !e.fairlead.velocity.isZero(0.0); }) &&
      count > 0) {
    // Central differences, long enough for the search's tolerance: the fastest end moves by a thousandth of the lines.
    double fastest = 0.0, length = 0.0;
    for (const LineEnds& e : outer) fastest = std::max({fastest, e.anchor.velocity.norm(), e.fairlead.velocity.norm()});
    for (const LineNetwork::Member& l : network.of.lines) length += l.line.segment() * l.line.segments;
    const double moment = 1e-3 * length / fastest;
    const auto rest_at = [&](double later) {
      std::vector<LineEnds> moved = outer;
      for (LineEnds& e : moved)
        e.anchor.position += later * e.anchor.velocity, e.fairlead.position += later * e.fairlead.velocity;
      std::vector<double> there(state.size());
      network.of.rest(moved, there);
      return there;
    };
    const std::vector<double> before = rest_at(-moment), after = rest_at(moment);
    for (std::size_t i = 0; i < count; ++i) state[places + count + i] = (after[places + i] - before[places + i]) / (2.0 * moment);
  }
  std::size_t nodes = 0;
  for (std::size_t k = 0; k < network.lines.size(); ++k) {
    const LineLumpedMass& line = network.of.lines[k].line;
    const LineEnds e = network.of.ends(k, outer[k], state);
    for (int i = 1; i < line.segments; ++i) {
      const double share = double(i) / line.segments;
      Eigen::Map<Eigen::Vector3d>(state.data() + nodes + 3 * (line.inner() + std::size_t(i - 1))) =
          (1.0 - share) * e.anchor.velocity + share * e.fairlead.velocity;
    }
    nodes += line.state_size();
  }
  return state;
}

void Moorings::begin(double t, std::span<const Motion> bodies, std::span<double> memory) {
  for (Network& network : networks_) {
    const std::vector<double> state = rest(network, t, bodies);
    std::copy(state.begin(), state.end(), memory.begin() + std::ptrdiff_t(network.state));
    const std::vector<LineEnds> outer = ends(network, bodies);
    std::vector<double> rate(state.size());
    network.of.rates(t, outer, state, rate, environment_.water, network.scratch);
    for (std::size_t k = 0; k < network.lines.size(); ++k)
      Recalled::write(t, network.of.ends(k, outer[k], state), network.scratch.forces[k], {},
                      memory.subspan(lines_[network.lines[k]].dynamic->header));
  }
  recall(memory);
}

/// One step of lines that move together, repeated in ever more substeps while it does not end in numbers. Forces are in the
/// network's scratch.
void Moorings::go_on(Network& network, double t, double h, std::span<const LineEnds> from, std::span<const LineEnds> to,
                     std::span<double> state) {
  constexpr double least = 1e-6;  // of the lines themselves, so that shorter steps of the bodies do not hide it
  const LineNetwork& lines = network.of;
  const std::size_t fastest = lines.fastest();
  const std::string& name = lines_[network.lines[fastest]].name;
  if (const double substep = lines.largest_step(); !(substep >= least))
    throw NumericalFailure(
        fmt::format(
            "moorings.{} at t = {:.6g} s: the line needs substeps of {:.3g} s, the least is {:.3g} s: its segments of {:.3g} "
            "m are too stiff, too light or too short; take fewer segments, or look at its units",
            name, t, substep, least, lines.lines[fastest].line.segment()),
        "moorings." + name, 0, t, least);
  constexpr int finest = 16;
  const auto in_numbers = [&] {
    return std::ranges::all_of(network.scratch.forces,
                               [](const LineForces& f) { return std::isfinite(f.fairlead_tension + f.anchor_tension); }) &&
           std::ranges::all_of(state, [](double x) { return std::isfinite(x); });
  };
  kept_.assign(state.begin(), state.end());
  for (int finer = 1; finer <= finest; finer *= 2) {
    lines.advance(t, h, from, to, state, environment_.water, network.scratch, finer);
    if (in_numbers()) return;
    std::copy(kept_.begin(), kept_.end(), state.begin());
  }
  throw NumericalFailure(
      fmt::format("moorings.{} at t = {:.6g} s: the line's motion has no numbers even in substeps of {:.3g} s; its fairlead "
                  "moves by {:.3g} m in the step of {:.3g} s",
                  name, t, h / (finest * lines.substeps(h)),
                  (to[fastest].fairlead.position - from[fastest].fairlead.position).norm(), h),
      "moorings." + name, 0, t, h);
}

void Moorings::remember(double t, double h, std::span<const Motion> bodies, std::span<double> memory) {
  for (Network& network : networks_) {
    const auto header = [&](std::size_t k) { return memory.subspan(lines_[network.lines[k]].dynamic->header); };
    const std::vector<LineEnds> now = ends(network, bodies);
    std::vector<LineEnds> before;
    for (std::size_t k = 0; k < network.lines.size(); ++k) before.push_back(Recalled{header(k)}.line_ends());
    const std::span<double> state = memory.subspan(network.state, network.of.state_size());
    go_on(network, t - h, h, before, now, state);
    for (std::size_t k = 0; k < network.lines.size(); ++k) {
      const LineForces last = Recalled{header(k)}.at_end(), &f = network.scratch.forces[k];
      const LineForces change{(f.on_fairlead - last.on_fairlead) / h, (f.on_anchor - last.on_anchor) / h};
      Recalled::write(t, network.of.ends(k, now[k], state), f, change, header(k));
    }
  }
}

}  // namespace spindrift::moorings
