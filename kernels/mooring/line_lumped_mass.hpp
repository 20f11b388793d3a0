// A dynamic mooring line as point masses joined by axial springs and dampers: weight, bed, drag and inertia of the water at the
// nodes. Hall & Goupee (2015), Ocean Engineering 104, 590-603, the equations of MoorDyn: docs/theory/moorings.md. Its rest and
// its motion, alone and with other lines: line_network.hpp, which calls it; tested in
// tests/kernels/mooring/line_lumped_mass_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <vector>

#include "kernels/base/constants.hpp"
#include "kernels/mooring/bed.hpp"
#include "kernels/mooring/line.hpp"
#include "kernels/mooring/line_catenary.hpp"

namespace spindrift {

/// The water at a point; z of the surface above it [m].
struct LineWater {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();      ///< [m/s]
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  ///< [m/s2]
  double surface = 0.0;
};

/// Still water up to z = 0.
struct StillWater {
  LineWater operator()(double /*t*/, const Eigen::Vector3d& /*point*/) const { return {}; }
};

/// Where an end is and how it moves; earth frame.
struct LineEnd {
  Eigen::Vector3d position = Eigen::Vector3d::Zero(), velocity = Eigen::Vector3d::Zero();
};
struct LineEnds {
  LineEnd anchor, fairlead;
};

/// A body hung on a node: a weight, or a float.
struct LineClump {
  int node = 1;                              ///< of 1 to N - 1
  double mass = 0.0, volume = 0.0;           ///< [kg], [m3]
  double drag_area = 0.0, added_mass = 0.5;  ///< coefficient times area [m2]; coefficient on the displaced mass [-]
};

/// The bed under a line: it pushes along its normal, never holds, and resists sliding.
struct LineBed {
  bool contact = true;
  double level = 0.0;                ///< z [m], where there is no `shape`
  std::shared_ptr<const Bed> shape;  ///< null: level
  double stiffness = 3e6;            ///< per depth of sinking in and projected area [Pa/m]
  double damping = 3e5;              ///< [Pa s/m]
  double friction = 0.0;             ///< [-]

  static constexpr double creep_speed = 0.01;  ///< below it friction falls to nothing linearly [m/s]

  /// How far a point is under the bed, measured upright [m]; 0 over it.
  double depth(const Eigen::Vector3d& point) const {
    if (!contact || point.z() >= (shape ? shape->highest() : level)) return 0.0;
    return std::max(0.0, (shape ? shape->level(point.x(), point.y()) : level) - point.z());
  }
  Eigen::Vector3d normal(const Eigen::Vector3d& point) const {
    return shape ? shape->normal(point.x(), point.y()) : Eigen::Vector3d(Eigen::Vector3d::UnitZ());
  }
  /// On a piece of line of this projected area [m2] that has sunk in so deep.
  Eigen::Vector3d force(double area, const LineEnd& node, double depth) const {
    const Eigen::Vector3d up = normal(node.position);
    const double rise = node.velocity.dot(up), push = area * std::max(0.0, stiffness * (depth * up.z()) - damping * rise);
    const Eigen::Vector3d slide = node.velocity - rise * up;
    return push * up - friction * push / std::max(slide.norm(), creep_speed) * slide;
  }
};

struct LineLumpedMass {
  static constexpr std::string_view name = "lumped_mass";
  double length = 1.0;                               ///< L, unstretched [m]
  int segments = 20;                                 ///< N; nodes 0 (anchor) to N (fairlead)
  double diameter = 0.1;                             ///< d, of a cylinder of the line's volume [m]
  double mass_per_m = 1.0;                           ///< m', dry [kg/m]
  double axial_stiffness = 1.0;                      ///< EA [N]
  double damping_ratio = 1.0;                        ///< zeta, of the shortest axial wave the segments carry; at most 1 [-]
  double normal_drag = 1.33, tangential_drag = 0.2;  ///< on d and on pi d, each per length [-]
  double normal_added_mass = 1.0, tangential_added_mass = 0.0;  ///< on the displaced mass [-]
  double gravity = 9.81, water_density = 1025.0;
  LineBed bed;
  bool anchored = false;  ///< node 0 is held by the earth: where that is under the bed, the bed does not push it
  std::vector<LineClump> clumps;

  double segment() const { return length / segments; }
  double area() const { return 0.25 * pi * diameter * diameter; }
  double weight_per_m() const { return (mass_per_m - water_density * area()) * gravity; }  ///< in water [N/m]
  /// BA of T = EA e + BA de/dt [N s].
  double internal_damping() const { return damping_ratio * segment() * std::sqrt(axial_stiffness * mass_per_m); }
  std::size_t inner() const { return std::size_t(segments - 1); }
  std::size_t state_size() const { return 6 * inner(); }  ///< positions of the inner nodes, then their velocities

  /// The line in rest that the nodes tend to as they grow many.
  LineCatenary catenary() const {
    return {.length = length, .weight_per_m = weight_per_m(), .axial_stiffness = axial_stiffness, .bed_contact = bed.contact};
  }

  /// Fastest rate of the nodes [1/s]: axial waves of two segments, the bed's spring and damper, friction at creeping speed.
  double fastest_rate() const {
    double rate = 2.0 / segment() * std::sqrt(axial_stiffness / mass_per_m);
    if (!bed.contact) return rate;
    rate = std::max({rate, std::sqrt(bed.stiffness * diameter / mass_per_m), bed.damping * diameter / mass_per_m});
    return std::max(rate, bed.friction * weight_per_m() / (mass_per_m * LineBed::creep_speed));
  }
  /// Substep: RK4 is stable up to 2.78 of the fastest rate on the real axis and 2.83 on the imaginary one; a fifth is kept back.
  double largest_step() const { return 2.2 / fastest_rate(); }
  double substeps(double h) const { return std::max(1.0, std::ceil(h / largest_step() * (1.0 - 1e-12))); }  ///< in a step of h

  /// Room for one evaluation.
  struct Scratch {
    std::vector<Eigen::Vector3d> pull;  ///< of each segment on its lower-numbered node [N]
  };
  Scratch scratch() const { return {std::vector<Eigen::Vector3d>(std::size_t(segments))}; }

  /// Nodes of a state with its ends, as one row.
  struct Nodes {
    const LineLumpedMass& line;
    const LineEnds& ends;
    std::span<const double> state;
    Eigen::Vector3d position(int i) const { return at(i, 0, ends.anchor.position, ends.fairlead.position); }
    Eigen::Vector3d velocity(int i) const { return at(i, 3 * line.inner(), ends.anchor.velocity, ends.fairlead.velocity); }

   private:
    Eigen::Vector3d at(int i, std::size_t first, const Eigen::Vector3d& anchor, const Eigen::Vector3d& fairlead) const {
      if (i == 0) return anchor;
      if (i == line.segments) return fairlead;
      return Eigen::Map<const Eigen::Vector3d>(state.data() + first + 3 * std::size_t(i - 1));
    }
  };

  /// T n of the segment from r to s, by how it is stretched and how fast; nothing where it is slack.
  Eigen::Vector3d pull(const Eigen::Vector3d& span, const Eigen::Vector3d& rate) const {
    const double l0 = segment(), l = span.norm();
    if (l <= l0) return Eigen::Vector3d::Zero();
    const double tension = axial_stiffness * (l / l0 - 1.0) + internal_damping() * span.dot(rate) / (l * l0);
    return tension > 0.0 ? Eigen::Vector3d(tension / l * span) : Eigen::Vector3d(Eigen::Vector3d::Zero());
  }

  /// Share of a piece that is under water. `middle`: height of its middle above its node [m].
  double wet_share(double piece, const Eigen::Vector3d& tangent, const Eigen::Vector3d& node, double surface,
                   double middle) const {
    const double height = std::max(piece * std::abs(tangent.z()), diameter);
    return std::clamp(0.5 + (surface - node.z() - middle) / height, 0.0, 1.0);
  }
  /// Height of the middle of the half segment at an end above the end [m].
  double half_segment_middle(int end, const Eigen::Vector3d& tangent) const {
    return (end == 0 ? 0.25 : -0.25) * segment() * tangent.z();
  }

  /// What loads a piece of line but its neighbours, and its inertia across and along `tangent`. `middle`: height of its middle
  /// above the node [m].
  struct NodeLoad {
    Eigen::Vector3d force;
    double mass_across, mass_along;
  };
  NodeLoad node_load(double piece, const Eigen::Vector3d& tangent, const LineEnd& node, const LineWater& water,
                     double middle = 0.0, bool meets_bed = true) const {
    const double displaced = water_density * area() * piece;
    const double wet = wet_share(piece, tangent, node.position, water.surface, middle);
    NodeLoad load{Eigen::Vector3d(0.0, 0.0, (wet * displaced - mass_per_m * piece) * gravity), mass_per_m * piece,
                  mass_per_m * piece};
    if (wet > 0.0) {
      const auto along = [&](const Eigen::Vector3d& v) { return Eigen::Vector3d(v.dot(tangent) * tangent); };
      const Eigen::Vector3d relative = water.velocity - node.velocity, tangential = along(relative),
                            normal = relative - tangential;
      const double dynamic = 0.5 * water_density * wet * piece * diameter;
      load.force += dynamic * (normal_drag * normal.norm() * normal + pi * tangential_drag * tangential.norm() * tangential);
      const Eigen::Vector3d with = along(water.acceleration), across = water.acceleration - with;
      load.force += wet * displaced * ((1.0 + normal_added_mass) * across + (1.0 + tangential_added_mass) * with);
      load.mass_across += wet * normal_added_mass * displaced, load.mass_along += wet * tangential_added_mass * displaced;
    }
    if (const double depth = meets_bed ? bed.depth(node.position) : 0.0; depth > 0.0)
      load.force += bed.force(piece * diameter, node, depth);
    return load;
  }

  void add_clumps(int i, const LineEnd& node, const LineWater& water, NodeLoad& load) const {
    for (const LineClump& c : clumps) {
      if (c.node != i) continue;
      const double height = std::max(std::cbrt(c.volume), diameter);
      const double wet = std::clamp(0.5 + (water.surface - node.position.z()) / height, 0.0, 1.0);
      const double displaced = wet * water_density * c.volume;
      const Eigen::Vector3d relative = water.velocity - node.velocity;
      load.force.z() += (displaced - c.mass) * gravity;
      load.force += 0.5 * water_density * wet * c.drag_area * relative.norm() * relative;
      load.force += displaced * (1.0 + c.added_mass) * water.acceleration;
      load.mass_across += c.mass + c.added_mass * displaced, load.mass_along += c.mass + c.added_mass * displaced;
    }
  }

  Eigen::Vector3d tangent(const Nodes& nodes, int i) const {
    const Eigen::Vector3d chord = nodes.position(std::min(i + 1, segments)) - nodes.position(std::max(i - 1, 0));
    const double l = chord.norm();
    return l > 0.0 ? Eigen::Vector3d(chord / l) : Eigen::Vector3d(Eigen::Vector3d::UnitZ());
  }

  /// d(state)/dt in `rate`. Returns the forces on the two ends; the half segment at an end is part of them but for its inertia,
  /// end_mass().
  template <class Water>
  LineForces rates(double t, const LineEnds& ends, std::span<const double> state, std::span<double> rate, const Water& water,
                   Scratch& scratch) const {
    return rates_in([&](int, const Eigen::Vector3d& point) { return water(t, point); }, ends, state, rate, scratch);
  }

  /// The same in water that is asked for by node and place.
  template <class Around>
  LineForces rates_in(const Around& water, const LineEnds& ends, std::span<const double> state, std::span<double> rate,
                      Scratch& scratch) const {
    const Nodes nodes{*this, ends, state};
    for (int i = 0; i < segments; ++i)
      scratch.pull[std::size_t(i)] = pull(nodes.position(i + 1) - nodes.position(i), nodes.velocity(i + 1) - nodes.velocity(i));
    const double l0 = segment();
    for (int i = 1; i < segments; ++i) {
      const LineEnd node{nodes.position(i), nodes.velocity(i)};
      const Eigen::Vector3d q = tangent(nodes, i);
      const LineWater around = water(i, node.position);
      NodeLoad load = node_load(l0, q, node, around);
      add_clumps(i, node, around, load);
      const Eigen::Vector3d force = load.force + scratch.pull[std::size_t(i)] - scratch.pull[std::size_t(i - 1)];
      const Eigen::Vector3d along = force.dot(q) * q;
      const std::size_t k = 3 * std::size_t(i - 1);
      Eigen::Map<Eigen::Vector3d>(rate.data() + k) = node.velocity;
      Eigen::Map<Eigen::Vector3d>(rate.data() + 3 * inner() + k) = (force - along) / load.mass_across + along / load.mass_along;
    }
    const auto end = [&](int i, const LineEnd& e) {
      const Eigen::Vector3d q = tangent(nodes, i);
      return node_load(0.5 * l0, q, e, water(i, e.position), half_segment_middle(i, q), i > 0 || !anchored).force;
    };
    LineForces f;
    f.on_fairlead = end(segments, ends.fairlead) - scratch.pull.back();
    f.on_anchor = end(0, ends.anchor) + scratch.pull.front();
    f.fairlead_tension = f.on_fairlead.norm(), f.anchor_tension = f.on_anchor.norm();
    return f;
  }

  /// Inertia [kg] of the half segment at an end, node 0 or N, with the water's as far as it is wet.
  Eigen::Matrix3d end_mass(const Nodes& nodes, int end, double surface) const {
    const Eigen::Vector3d q = tangent(nodes, end);
    const double piece = 0.5 * segment(), wet = wet_share(piece, q, nodes.position(end), surface, half_segment_middle(end, q)),
                 displaced = wet * water_density * area() * piece;
    const double across = mass_per_m * piece + normal_added_mass * displaced;
    const double along = mass_per_m * piece + tangential_added_mass * displaced;
    return across * Eigen::Matrix3d::Identity() + (along - across) * q * q.transpose();
  }

  /// Nodes on the catenary between the ends, without velocity: a first guess of their rest.
  void lay_as_catenary(const LineEnds& ends, std::span<double> state) const;
};

}  // namespace spindrift
