// Lumped-mass lines that meet at junctions, points free in the water: one line alone, bridles, lines with a weight or a float
// between them. Rest by Newton's method, motion by classical Runge-Kutta in substeps that all lines share; Hall & Goupee (2015),
// Ocean Engineering 104, 590-603, the connection nodes of MoorDyn: docs/theory/moorings.md. Called through src/moorings; tested
// in tests/kernels/mooring/line_network_test.cpp and line_lumped_mass_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "kernels/mooring/line_lumped_mass.hpp"

namespace spindrift {

/// A point free in the water at which lines end, with what hangs there.
struct LineJunction {
  Eigen::Vector3d start = Eigen::Vector3d::Zero();  ///< where the search for its rest begins [m]
  double mass = 0.0, volume = 0.0;                  ///< [kg], [m3]
  double drag_area = 0.0, added_mass = 0.5;         ///< coefficient times area [m2]; coefficient on the displaced mass [-]

  /// Share of the volume under water.
  double wet(double z, double surface) const { return std::clamp(0.5 + (surface - z) / height(), 0.0, 1.0); }
  double height() const { return std::max(std::cbrt(volume), 0.01); }
};

struct LineNetwork {
  static constexpr int led = -1;  ///< an end that is moved from outside
  struct Member {
    LineLumpedMass line;
    int anchor = led, fairlead = led;  ///< led, or its junction
  };
  std::vector<Member> lines;
  std::vector<LineJunction> junctions;
  double gravity = 9.81, water_density = 1025.0;

  // The state: of each line in turn, then places and then velocities of the junctions.
  std::size_t first_of_junctions() const {
    std::size_t size = 0;
    for (const Member& m : lines) size += m.line.state_size();
    return size;
  }
  std::size_t state_size() const { return first_of_junctions() + 6 * junctions.size(); }
  /// Of a state.
  LineEnd junction(int j, std::span<const double> state) const {
    const std::size_t first = state.size() - 6 * junctions.size() + 3 * std::size_t(j);
    return {Eigen::Map<const Eigen::Vector3d>(state.data() + first),
            Eigen::Map<const Eigen::Vector3d>(state.data() + first + 3 * junctions.size())};
  }
  /// Ends of a line: `outer` where they are led.
  LineEnds ends(std::size_t l, const LineEnds& outer, std::span<const double> state) const {
    const auto end = [&](int j, const LineEnd& given) { return j == led ? given : junction(j, state); };
    return {end(lines[l].anchor, outer.anchor), end(lines[l].fairlead, outer.fairlead)};
  }

  /// The line whose substep is the least. A junction has the inertia of the half segments at it, so that it is never faster than
  /// the stiffest of its lines.
  std::size_t fastest() const {
    std::size_t found = 0;
    for (std::size_t l = 1; l < lines.size(); ++l)
      if (lines[l].line.fastest_rate() > lines[found].line.fastest_rate()) found = l;
    return found;
  }
  double largest_step() const { return lines[fastest()].line.largest_step(); }
  double substeps(double h) const { return lines[fastest()].line.substeps(h); }  ///< in a step of h

  /// Room for one evaluation.
  struct Scratch {
    std::vector<LineLumpedMass::Scratch> lines;
    std::vector<double> stages;       ///< of Runge-Kutta
    std::vector<LineEnds> ends;       ///< of the lines within a step
    std::vector<LineForces> forces;   ///< on the ends of the lines, as rates() has found them
    std::vector<Eigen::Vector3d> on;  ///< junctions [N]
    std::vector<Eigen::Matrix3d> inertia;
    std::vector<std::vector<LineWater>> water;  ///< of each line's nodes, then of the junctions: see advance()
  };
  Scratch scratch() const {
    Scratch s;
    for (const Member& m : lines) s.lines.push_back(m.line.scratch());
    s.stages.resize(5 * state_size()), s.ends.resize(lines.size()), s.forces.resize(lines.size());
    s.on.resize(junctions.size()), s.inertia.resize(junctions.size());
    for (const Member& m : lines) s.water.emplace_back(3 * std::size_t(m.line.segments + 1));
    s.water.emplace_back(3 * junctions.size());
    return s;
  }

  /// What loads a junction but its lines, and its own inertia.
  struct JunctionLoad {
    Eigen::Vector3d force;
    double mass;
  };
  JunctionLoad load(const LineJunction& j, const LineEnd& at, const LineWater& water) const {
    const double wet = j.wet(at.position.z(), water.surface), displaced = wet * water_density * j.volume;
    const Eigen::Vector3d relative = water.velocity - at.velocity;
    JunctionLoad l{Eigen::Vector3d(0.0, 0.0, (displaced - j.mass) * gravity), j.mass + j.added_mass * displaced};
    l.force += 0.5 * water_density * wet * j.drag_area * relative.norm() * relative;
    l.force += displaced * (1.0 + j.added_mass) * water.acceleration;
    return l;
  }

  /// Of the buoyancy of a junction at the surface of still water [N/m].
  double rise_stiffness(const LineJunction& j, double z) const {
    const double wet = j.wet(z, 0.0);
    return wet > 0.0 && wet < 1.0 ? water_density * gravity * j.volume / j.height() : 0.0;
  }

  /// d(state)/dt in `rate`; forces on the ends of all lines in scratch.forces.
  template <class Water>
  void rates(double t, std::span<const LineEnds> outer, std::span<const double> state, std::span<double> rate, const Water& water,
             Scratch& scratch) const {
    rates_in([&](std::size_t, int, const Eigen::Vector3d& point) { return water(t, point); }, outer, state, rate, scratch);
  }

  /// The same in water that is asked for by line, node and place; junctions are the nodes of a line after the last.
  template <class Around>
  void rates_in(const Around& water, std::span<const LineEnds> outer, std::span<const double> state, std::span<double> rate,
                Scratch& scratch) const {
    for (std::size_t j = 0; j < junctions.size(); ++j) {
      const LineEnd at = junction(int(j), state);
      const JunctionLoad own = load(junctions[j], at, water(lines.size(), int(j), at.position));
      scratch.on[j] = own.force, scratch.inertia[j] = own.mass * Eigen::Matrix3d::Identity();
    }
    std::size_t first = 0;
    for (std::size_t l = 0; l < lines.size(); ++l) {
      const LineLumpedMass& line = lines[l].line;
      const LineEnds e = ends(l, outer[l], state);
      const std::span<const double> nodes = state.subspan(first, line.state_size());
      const auto around = [&](int node, const Eigen::Vector3d& point) { return water(l, node, point); };
      const LineForces f = line.rates_in(around, e, nodes, rate.subspan(first, line.state_size()), scratch.lines[l]);
      const auto add = [&](int j, const Eigen::Vector3d& force, int node) {
        if (j == led) return;
        scratch.on[std::size_t(j)] += force;
        scratch.inertia[std::size_t(j)] += line.end_mass(line.tangent({line, e, nodes}, node));
      };
      add(lines[l].anchor, f.on_anchor, 0), add(lines[l].fairlead, f.on_fairlead, line.segments);
      scratch.forces[l] = f, first += line.state_size();
    }
    for (std::size_t j = 0; j < junctions.size(); ++j) {
      const std::size_t k = first + 3 * j;
      Eigen::Map<Eigen::Vector3d>(rate.data() + k) = junction(int(j), state).velocity;
      Eigen::Map<Eigen::Vector3d>(rate.data() + k + 3 * junctions.size()) = scratch.inertia[j].inverse() * scratch.on[j];
    }
  }

  /// Goes on by h from t, while the led ends move from `from` to `to` on cubics that keep places and velocities. Forces on the
  /// ends at t + h are in scratch.forces. The water is asked for at t, t + h/2 and t + h, where each node's velocity takes it,
  /// and goes on a parabola between: waves change in the bodies' step, not in the substeps that axial waves of the lines ask for.
  template <class Water>
  void advance(double t, double h, std::span<const LineEnds> from, std::span<const LineEnds> to, std::span<double> state,
               const Water& water, Scratch& scratch, int finer = 1) const {
    const std::size_t n = state_size();
    const auto stage = [&](std::size_t i) { return std::span<double>(scratch.stages).subspan(i * n, n); };
    const std::span<double> k1 = stage(0), k2 = stage(1), k3 = stage(2), k4 = stage(3), trial = stage(4);
    const int count = finer * int(substeps(h));
    const double dt = h / count;
    const auto ends = [&](double s) -> std::span<const LineEnds> {  // s: substeps since t
      for (std::size_t l = 0; l < lines.size(); ++l)
        scratch.ends[l] = {on_cubic(from[l].anchor, to[l].anchor, h, s / count),
                           on_cubic(from[l].fairlead, to[l].fairlead, h, s / count)};
      return scratch.ends;
    };
    const auto go = [&](double step, std::span<const double> rate) {
      for (std::size_t i = 0; i < n; ++i) trial[i] = state[i] + step * rate[i];
    };
    sample_water(t, h, from, state, water, scratch);
    const auto at = [&](double s) {  // s: substeps since t
      const double x = s / count, first = (1.0 - x) * (1.0 - 2.0 * x), middle = 4.0 * x * (1.0 - x), last = x * (2.0 * x - 1.0);
      return [&scratch, first, middle, last](std::size_t line, int node, const Eigen::Vector3d& /*point*/) {
        const LineWater *a = &scratch.water[line][3 * std::size_t(node)], *b = a + 1, *c = a + 2;
        return LineWater{first * a->velocity + middle * b->velocity + last * c->velocity,
                         first * a->acceleration + middle * b->acceleration + last * c->acceleration,
                         first * a->surface + middle * b->surface + last * c->surface};
      };
    };
    for (int m = 0; m < count; ++m) {
      rates_in(at(m), ends(m), state, k1, scratch);
      go(0.5 * dt, k1);
      const std::span<const LineEnds> middle = ends(m + 0.5);
      rates_in(at(m + 0.5), middle, trial, k2, scratch);
      go(0.5 * dt, k2);
      rates_in(at(m + 0.5), middle, trial, k3, scratch);
      go(dt, k3);
      rates_in(at(m + 1), ends(m + 1), trial, k4, scratch);
      for (std::size_t i = 0; i < n; ++i) state[i] += dt / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
    }
    rates_in(at(count), to, state, k1, scratch);
  }

  /// What the search for rest came to: the largest force left on a node, and what is allowed [N].
  struct Rest {
    double residual, limit;
    int iterations;
    bool found() const { return residual <= limit; }
  };
  /// All lines in rest between led ends that do not move, in still water. Friction of the bed, which depends on how it was laid,
  /// is left out. Segments that only pull, weight, buoyancy and a bed that only pushes have a convex energy: Newton's method with
  /// a damping that grows where the energy does not fall finds its least value.
  Rest rest(std::span<const LineEnds> outer, std::span<double> state) const;

 private:
  template <class Water>
  void sample_water(double t, double h, std::span<const LineEnds> from, std::span<const double> state, const Water& water,
                    Scratch& scratch) const {
    const auto sample = [&](std::size_t line, std::size_t node, const LineEnd& at) {
      for (int k = 0; k < 3; ++k)
        scratch.water[line][3 * node + std::size_t(k)] = water(t + 0.5 * k * h, at.position + 0.5 * k * h * at.velocity);
    };
    std::size_t first = 0;
    for (std::size_t l = 0; l < lines.size(); ++l) {
      const LineLumpedMass& line = lines[l].line;
      const LineEnds e = ends(l, from[l], state);
      const LineLumpedMass::Nodes nodes{line, e, state.subspan(first, line.state_size())};
      for (int i = 0; i <= line.segments; ++i) sample(l, std::size_t(i), {nodes.position(i), nodes.velocity(i)});
      first += line.state_size();
    }
    for (std::size_t j = 0; j < junctions.size(); ++j) sample(lines.size(), j, junction(int(j), state));
  }

  static LineEnd on_cubic(const LineEnd& a, const LineEnd& b, double h, double s) {
    const double r = 1.0 - s, u = s * s * (3.0 - 2.0 * s);
    const Eigen::Vector3d way = b.position - a.position;
    return {a.position + u * way + h * s * r * (r * a.velocity - s * b.velocity),
            6.0 * s * r / h * way + r * (1.0 - 3.0 * s) * a.velocity + s * (3.0 * s - 2.0) * b.velocity};
  }

  struct Newton;
  /// Newton's method with the tensions of the segments as unknowns of their own: stiff segments turn through large angles in one
  /// step, where the stretch that a straight step gives them would hold them fast. Not every network comes to rest by it.
  void swing(Newton& newton, std::span<double> state, double limit) const;
  /// Places of the junctions where the lines are catenaries, from their starts.
  void hang_as_catenaries(std::span<const LineEnds> outer, std::span<double> state) const;
};

/// One step of the search for rest: forces, the stiffness of the lines eliminated onto the junctions, and the step of all points.
struct LineNetwork::Newton {
  using Vectors = std::vector<Eigen::Vector3d>;
  using Matrices = std::vector<Eigen::Matrix3d>;
  struct Line {
    LineEnds ends;
    Vectors force, left, step;           ///< of the inner nodes
    std::vector<double> tension;         ///< of the segments, as the last step foresaw it; empty: as they are stretched
    Matrices diagonal, upper, to_start;  ///< blocks between nodes; to_start: to the junction that holds the anchor
  };
  const LineNetwork& network;
  std::vector<Line> lines;
  Vectors force, step;  ///< of the junctions
  double scale = 0.0;   ///< stiffest segment [N/m]

  Newton(const LineNetwork& n, std::span<const LineEnds> outer)
      : network(n), lines(n.lines.size()), force(n.junctions.size()), step(n.junctions.size()) {
    for (std::size_t l = 0; l < lines.size(); ++l) {
      const std::size_t inner = n.lines[l].line.inner();
      lines[l].ends = {{outer[l].anchor.position, Eigen::Vector3d::Zero()},
                       {outer[l].fairlead.position, Eigen::Vector3d::Zero()}};
      for (Vectors* v : {&lines[l].force, &lines[l].left, &lines[l].step}) v->resize(inner);
      for (Matrices* m : {&lines[l].diagonal, &lines[l].upper, &lines[l].to_start}) m->resize(inner);
      scale = std::max(scale, n.lines[l].line.axial_stiffness / n.lines[l].line.segment());
    }
  }

  /// Calls visit(line's index, its values, its ends, its state) in turn.
  template <class Visit>
  void each_line(std::span<const double> state, const Visit& visit) {
    std::size_t first = 0;
    for (std::size_t l = 0; l < lines.size(); ++l) {
      const std::size_t size = network.lines[l].line.state_size();
      visit(network.lines[l], lines[l], network.ends(l, lines[l].ends, state), state.subspan(first, size));
      first += size;
    }
  }

  /// Pull of segment s. Where its tension was foreseen it may push: it is then only on its way.
  static Eigen::Vector3d pull(const Member& member, const Line& own, int s, const Eigen::Vector3d& span) {
    if (own.tension.empty() || own.tension[std::size_t(s)] <= 0.0) return member.line.pull(span, Eigen::Vector3d::Zero());
    const double l = span.norm(), l0 = member.line.segment();
    return member.line.axial_stiffness * (l / l0 - 1.0) / l * span;
  }

  /// Forces at a state whose velocities are zero; returns the largest.
  double forces(std::span<const double> state) {
    const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
    for (std::size_t j = 0; j < force.size(); ++j)
      force[j] = network.load(network.junctions[j], {network.junction(int(j), state).position, zero}, {}).force;
    double largest = 0.0;
    each_line(state, [&](const Member& member, Line& own, const LineEnds& ends, std::span<const double> at) {
      const LineLumpedMass& line = member.line;
      const LineLumpedMass::Nodes nodes{line, ends, at};
      const double l0 = line.segment();
      for (int i = 1; i < line.segments; ++i) {
        const Eigen::Vector3d r = nodes.position(i);
        LineLumpedMass::NodeLoad load = line.node_load(l0, line.tangent(nodes, i), {r, zero}, {});
        line.add_clumps(i, {r, zero}, {}, load);
        Eigen::Vector3d& sum = own.force[std::size_t(i - 1)];
        sum = pull(member, own, i, nodes.position(i + 1) - r) - pull(member, own, i - 1, r - nodes.position(i - 1)) + load.force;
        largest = std::max(largest, sum.norm());
      }
      const auto at_junction = [&](int j, int node, int next, double middle) {
        if (j == led) return;
        const Eigen::Vector3d r = nodes.position(node), q = line.tangent(nodes, node);
        force[std::size_t(j)] += line.node_load(0.5 * l0, q, {r, zero}, {}, middle * q.z()).force +
                                 pull(member, own, std::min(node, next), nodes.position(next) - r);
      };
      at_junction(member.anchor, 0, 1, 0.25 * l0);
      at_junction(member.fairlead, line.segments, line.segments - 1, -0.25 * l0);
    });
    for (const Eigen::Vector3d& f : force) largest = std::max(largest, f.norm());
    return largest;
  }

  /// Takes this share of the step.
  void go(std::span<const double> from, double share, std::span<double> to) const {
    std::size_t k = 0;
    const auto add = [&](const Eigen::Vector3d& s) {
      for (Eigen::Index i = 0; i < 3; ++i, ++k) to[k] = from[k] + share * s[i];
    };
    for (const Line& line : lines) {
      for (const Eigen::Vector3d& s : line.step) add(s);
      k += 3 * line.step.size();  // velocities
    }
    for (const Eigen::Vector3d& s : step) add(s);
  }

  double along_step() const {
    double work = 0.0;
    for (const Line& line : lines)
      for (std::size_t i = 0; i < line.force.size(); ++i) work += line.force[i].dot(line.step[i]);
    for (std::size_t j = 0; j < force.size(); ++j) work += force[j].dot(step[j]);
    return work;
  }

  /// Steps from the forces at this state, which forces() has found: K step = force, K with `damping` on its diagonal.
  void solve(std::span<const double> state, double damping) {
    const auto size = Eigen::Index(3 * network.junctions.size());
    Eigen::MatrixXd stiffness = damping * Eigen::MatrixXd::Identity(size, size);  // of the junctions, all lines eliminated
    Eigen::VectorXd right(size);
    for (std::size_t j = 0; j < force.size(); ++j) {
      right.segment<3>(Eigen::Index(3 * j)) = force[j];
      stiffness(Eigen::Index(3 * j + 2), Eigen::Index(3 * j + 2)) +=
          network.rise_stiffness(network.junctions[j], network.junction(int(j), state).position.z());
    }
    each_line(state, [&](const Member& member, Line& own, const LineEnds& ends, std::span<const double> at) {
      assemble(member, own, {member.line, ends, at}, damping, stiffness);
      eliminate(member, own, stiffness, right);
    });
    if (size > 0) {
      const Eigen::VectorXd all = stiffness.ldlt().solve(right);
      for (std::size_t j = 0; j < step.size(); ++j) step[j] = all.segment<3>(Eigen::Index(3 * j));
    }
    for (std::size_t l = 0; l < lines.size(); ++l) substitute(network.lines[l], lines[l]);
  }

 private:
  static auto block(Eigen::MatrixXd& m, int a, int b) { return m.block<3, 3>(3 * a, 3 * b); }

  /// Blocks of one line; its own stiffness at the junctions.
  void assemble(const Member& member, Line& own, const LineLumpedMass::Nodes& nodes, double damping,
                Eigen::MatrixXd& junctions) const {
    const LineLumpedMass& line = member.line;
    const double l0 = line.segment();
    const auto segment = [&](int s) -> Eigen::Matrix3d {
      const Eigen::Vector3d along = nodes.position(s + 1) - nodes.position(s);
      const double l = along.norm();
      double tension = line.axial_stiffness * (l / l0 - 1.0);
      if (!own.tension.empty() && own.tension[std::size_t(s)] > 0.0) tension = own.tension[std::size_t(s)];
      if (tension <= 0.0) return Eigen::Matrix3d::Zero();
      return chord_stiffness(along, tension, line.axial_stiffness / l0);
    };
    const auto bed = [&](int node, double piece) -> Eigen::Matrix3d {
      if (!(line.depth_in_bed(nodes.position(node)) > 0.0)) return Eigen::Matrix3d::Zero();
      const Eigen::Vector3d normal = line.bed_normal(nodes.position(node));
      return line.bed_stiffness * line.diameter * piece * normal * normal.transpose();
    };
    const auto at_junction = [&](int j, int node, const Eigen::Matrix3d& next) {
      if (j == led) return;
      block(junctions, j, j) += next + bed(node, 0.5 * l0);
    };
    const std::size_t n = line.inner();
    Eigen::Matrix3d below = segment(0);
    at_junction(member.anchor, 0, below);
    own.to_start[0] = -below;
    for (std::size_t i = 0; i < n; ++i) {
      const Eigen::Matrix3d above = segment(int(i) + 1);
      own.diagonal[i] = below + above + damping * Eigen::Matrix3d::Identity() + bed(int(i) + 1, l0);
      own.upper[i] = -above, below = above;
    }
    at_junction(member.fairlead, line.segments, below);
  }

  /// Block elimination of the inner nodes. own.diagonal holds inverses afterwards.
  void eliminate(const Member& member, Line& own, Eigen::MatrixXd& junctions, Eigen::VectorXd& right) const {
    const std::size_t n = own.force.size();
    own.left = own.force;
    for (std::size_t i = 0; i < n; ++i) {
      if (i > 0) {
        const Eigen::Matrix3d factor = own.upper[i - 1].transpose() * own.diagonal[i - 1];
        own.diagonal[i] -= factor * own.upper[i - 1];
        own.left[i] -= factor * own.left[i - 1];
        if (member.anchor != led) own.to_start[i] = -factor * own.to_start[i - 1];
      }
      own.diagonal[i] = own.diagonal[i].inverse().eval();
      if (member.anchor == led) continue;
      const Eigen::Matrix3d factor = own.to_start[i].transpose() * own.diagonal[i];
      block(junctions, member.anchor, member.anchor) -= factor * own.to_start[i];
      right.segment<3>(3 * member.anchor) -= factor * own.left[i];
    }
    if (member.fairlead == led) return;
    const Eigen::Matrix3d factor = own.upper[n - 1].transpose() * own.diagonal[n - 1];
    block(junctions, member.fairlead, member.fairlead) -= factor * own.upper[n - 1];
    right.segment<3>(3 * member.fairlead) -= factor * own.left[n - 1];
    if (member.anchor == led) return;
    const Eigen::Matrix3d across = factor * own.to_start[n - 1];
    block(junctions, member.fairlead, member.anchor) -= across;
    block(junctions, member.anchor, member.fairlead) -= across.transpose();
  }

  /// Steps of the inner nodes from those of the junctions.
  void substitute(const Member& member, Line& own) const {
    const std::size_t n = own.force.size();
    for (std::size_t i = n; i-- > 0;) {
      Eigen::Vector3d rest = own.left[i];
      if (i + 1 < n)
        rest = own.left[i] - own.upper[i] * own.step[i + 1];
      else if (member.fairlead != led)
        rest -= own.upper[i] * step[std::size_t(member.fairlead)];
      if (member.anchor != led) rest -= own.to_start[i] * step[std::size_t(member.anchor)];
      own.step[i] = own.diagonal[i] * rest;
    }
  }
};

inline void LineNetwork::hang_as_catenaries(std::span<const LineEnds> outer, std::span<double> state) const {
  const auto size = Eigen::Index(3 * junctions.size());
  if (size == 0) return;
  // The bed is at the level of a led anchor; a line whose lower end is a junction hangs free, and the junction may lie on the
  // bed.
  std::vector<LineCatenary> hanging;
  double scale = 0.0;
  for (const Member& m : lines) {
    hanging.push_back(m.line.catenary());
    hanging.back().bed_contact = hanging.back().bed_contact && m.anchor == led;
    scale = std::max(scale, m.line.axial_stiffness / m.line.length);
  }
  Eigen::VectorXd force(size);
  Eigen::MatrixXd stiffness(size, size);
  const auto find_forces = [&](std::span<const double> at) {
    force.setZero(), stiffness.setZero();
    for (std::size_t j = 0; j < junctions.size(); ++j) {
      const auto k = Eigen::Index(3 * j);
      const Eigen::Vector3d place = junction(int(j), at).position;
      force.segment<3>(k) = load(junctions[j], {place, Eigen::Vector3d::Zero()}, {}).force;
      stiffness(k + 2, k + 2) = rise_stiffness(junctions[j], place.z());
    }
    for (std::size_t l = 0; l < lines.size(); ++l) {
      const LineLumpedMass& line = lines[l].line;
      const LineEnds e = ends(l, outer[l], at);
      const Eigen::Vector3d span = e.fairlead.position - e.anchor.position;
      const LineForces f = hanging[l].forces(span, Eigen::Vector3d::Zero());
      const Eigen::Matrix3d own = hanging[l].stiffness(span);
      const double bed = 0.5 * line.bed_stiffness * line.diameter * line.segment();
      const auto add = [&](int j, int other, const Eigen::Vector3d& pull, const Eigen::Vector3d& at_end) {
        if (j == led) return;
        force.segment<3>(3 * j) += pull;
        stiffness.block<3, 3>(3 * j, 3 * j) += own;
        if (other != led) stiffness.block<3, 3>(3 * j, 3 * other) -= own;
        const double depth = line.depth_in_bed(at_end);
        if (!(depth > 0.0)) return;
        force[3 * j + 2] += bed * depth, stiffness(3 * j + 2, 3 * j + 2) += bed;
      };
      add(lines[l].anchor, lines[l].fairlead, f.on_anchor, e.anchor.position);
      add(lines[l].fairlead, lines[l].anchor, f.on_fairlead, e.fairlead.position);
    }
  };
  std::vector<double> trial(state.begin(), state.end());
  double damping = 1e-3 * scale;
  for (int n = 0; n < 500 && damping < 1e6 * scale; ++n) {
    find_forces(state);
    const Eigen::VectorXd here = force;
    if (here.norm() < 1e-9 * scale) return;
    const Eigen::VectorXd step = (stiffness + damping * Eigen::MatrixXd::Identity(size, size)).ldlt().solve(here);
    for (Eigen::Index i = 0; i < size; ++i)
      trial[first_of_junctions() + std::size_t(i)] = state[first_of_junctions() + std::size_t(i)] + step[i];
    find_forces(trial);
    if (step.dot(here + force) > 0.0) {  // the energy fell, by the trapezium of the forces' work
      std::copy(trial.begin(), trial.end(), state.begin());
      damping = std::max(0.2 * damping, 1e-12 * scale);
    } else {
      damping *= 5.0;
    }
  }
}

inline void LineNetwork::swing(Newton& newton, std::span<double> state, double limit) const {
  constexpr int most = 60;
  newton.each_line(state, [&](const Member& member, Newton::Line& own, const LineEnds& ends, std::span<const double> at) {
    const LineLumpedMass::Nodes nodes{member.line, ends, at};
    const double weight = member.line.weight_per_m() * member.line.length;
    own.tension.clear();
    for (int s = 0; s < member.line.segments; ++s)
      own.tension.push_back(
          std::max(member.line.pull(nodes.position(s + 1) - nodes.position(s), Eigen::Vector3d::Zero()).norm(), weight));
  });
  double last = std::numeric_limits<double>::infinity();
  bool found = false;
  for (int n = 0; n < most && !found; ++n) {
    newton.forces(state);
    newton.solve(state, 1e-9 * newton.scale);
    // Tensions after the step, and the share of it that turns no segment by more than half a radian.
    double share = 1.0;
    std::vector<std::vector<double>> foreseen;
    newton.each_line(state, [&](const Member& member, Newton::Line& own, const LineEnds& ends, std::span<const double> at) {
      const LineLumpedMass::Nodes nodes{member.line, ends, at};
      const auto step = [&](int node) -> Eigen::Vector3d {
        if (node > 0 && node < member.line.segments) return own.step[std::size_t(node - 1)];
        const int j = node == 0 ? member.anchor : member.fairlead;
        return j == led ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : newton.step[std::size_t(j)];
      };
      std::vector<double>& tension = foreseen.emplace_back();
      for (int s = 0; s < member.line.segments; ++s) {
        const Eigen::Vector3d span = nodes.position(s + 1) - nodes.position(s), change = step(s + 1) - step(s);
        const double l = span.norm(), l0 = member.line.segment();
        tension.push_back(member.line.axial_stiffness / l0 * (l - l0 + span.dot(change) / l));
        share = std::min(share, 0.5 * l / std::max(change.norm(), 1e-300));
      }
    });
    for (std::size_t l = 0; l < lines.size(); ++l)
      for (std::size_t s = 0; s < foreseen[l].size(); ++s)
        newton.lines[l].tension[s] =
            std::max((1.0 - share) * newton.lines[l].tension[s] + share * foreseen[l][s], 0.2 * newton.lines[l].tension[s]);
    newton.go(state, share, state);
    std::vector<std::vector<double>> kept;
    for (Newton::Line& line : newton.lines) kept.push_back(std::move(line.tension)), line.tension.clear();
    const double left = newton.forces(state);
    found = left <= limit || (share == 1.0 && std::abs(left - last) < 1e-3 * last), last = left;  // slack segments push
    for (std::size_t l = 0; l < lines.size(); ++l) newton.lines[l].tension = std::move(kept[l]);
  }
  for (Newton::Line& line : newton.lines) line.tension.clear();
}

inline LineNetwork::Rest LineNetwork::rest(std::span<const LineEnds> outer, std::span<double> state) const {
  Newton newton(*this, outer);
  for (std::size_t j = 0; j < junctions.size(); ++j) {
    const std::size_t k = first_of_junctions() + 3 * j;
    Eigen::Map<Eigen::Vector3d>(state.data() + k) = junctions[j].start;
    Eigen::Map<Eigen::Vector3d>(state.data() + k + 3 * junctions.size()).setZero();
  }
  hang_as_catenaries(outer, state);
  Rest rest{0.0, 0.0, 0};
  std::size_t first = 0;
  for (std::size_t l = 0; l < lines.size(); ++l) {
    const LineLumpedMass& line = lines[l].line;
    line.lay_as_catenary(ends(l, newton.lines[l].ends, state), state.subspan(first, line.state_size()));
    rest.limit = std::max(rest.limit, 1e-7 * line.mass_per_m * line.gravity * line.segment() + 1e-12 * line.axial_stiffness);
    first += line.state_size();
  }
  std::vector<double> trial(state.begin(), state.end());
  rest.residual = newton.forces(state);
  if (!junctions.empty()) {
    swing(newton, trial, rest.limit);
    if (const double left = newton.forces(trial); left < rest.residual) {
      std::copy(trial.begin(), trial.end(), state.begin());
      rest.residual = left;
    }
  }
  double damping = 1e-6 * newton.scale;
  for (; rest.iterations < 2000 && !rest.found(); ++rest.iterations) {
    newton.forces(state);
    newton.solve(state, damping);
    newton.go(state, 1.0, trial);
    const double before = newton.along_step(), largest = newton.forces(trial);
    if (before + newton.along_step() > 0.0) {  // the energy fell, by the trapezium of the forces' work
      std::copy(trial.begin(), trial.end(), state.begin());
      rest.residual = largest, damping = std::max(0.2 * damping, 1e-12 * newton.scale);
    } else {
      damping *= 5.0;
      if (damping > 1e6 * newton.scale) break;
    }
  }
  return rest;
}

}  // namespace spindrift
