// Lumped-mass lines that meet at junctions, points free in the water: one line alone, bridles, lines with a weight or a float
// between them. Rest by Newton's method, motion by classical Runge-Kutta in substeps that all lines share; Hall & Goupee (2015),
// Ocean Engineering 104, 590-603, the connection nodes of MoorDyn: docs/theory/moorings.md. Called through src/moorings; tested
// in tests/kernels/mooring/line_network_test.cpp and line_lumped_mass_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
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
        const LineLumpedMass::Nodes row{line, e, nodes};
        scratch.inertia[std::size_t(j)] += line.end_mass(row, node, around(node, row.position(node)).surface);
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

}  // namespace spindrift
