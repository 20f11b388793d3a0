// SPDX-License-Identifier: Apache-2.0
#include "kernels/mooring/line_network.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <limits>

namespace spindrift {

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
      if (!(line.bed.depth(nodes.position(node)) > 0.0)) return Eigen::Matrix3d::Zero();
      const Eigen::Vector3d normal = line.bed.normal(nodes.position(node));
      return line.bed.stiffness * line.diameter * piece * normal * normal.transpose();
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

void LineNetwork::hang_as_catenaries(std::span<const LineEnds> outer, std::span<double> state) const {
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
      const double bed = 0.5 * line.bed.stiffness * line.diameter * line.segment();
      const auto add = [&](int j, int other, const Eigen::Vector3d& pull, const Eigen::Vector3d& at_end) {
        if (j == led) return;
        force.segment<3>(3 * j) += pull;
        stiffness.block<3, 3>(3 * j, 3 * j) += own;
        if (other != led) stiffness.block<3, 3>(3 * j, 3 * other) -= own;
        const double depth = line.bed.depth(at_end);
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

void LineNetwork::swing(Newton& newton, std::span<double> state, double limit) const {
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

LineNetwork::Rest LineNetwork::rest(std::span<const LineEnds> outer, std::span<double> state) const {
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
