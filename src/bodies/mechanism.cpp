// SPDX-License-Identifier: Apache-2.0
#include "src/bodies/mechanism.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include "kernels/rigid/partition.hpp"
#include "kernels/rigid/rotation.hpp"

namespace spindrift::bodies {

namespace {

constexpr double newton_goal = 1e-15;  // residual over L (and over 1 + distance from the origin) at which Newton stops at once
constexpr double newton_tolerance = 1e-13;  // residual it must reach
constexpr int newton_limit = 30;
constexpr double slow_contraction = 0.1;  // a factor that contracts less than this is computed anew
constexpr double degraded_tangent = 6.0;  // dependent per independent velocity beyond which the partition is chosen anew
constexpr double lost_tangent = 1e8;      // beyond which it cannot be used

Pose scaled_pose(const Motion& m, double length) {
  return {m.attitude.toRotationMatrix(), m.position / length, m.velocity / length, m.attitude * m.omega};
}

/// Infinite when an entry is not a number.
double largest_magnitude(const Eigen::MatrixXd& m) {
  double largest = 0.0;
  for (Eigen::Index k = 0; k < m.size(); ++k)
    if (!(std::abs(m.data()[k]) <= largest)) largest = std::isnan(m.data()[k]) ? INFINITY : std::abs(m.data()[k]);
  return largest;
}

/// [m], a power of two near the largest arm of a joint; 1 without joints.
double reference_length(std::span<const Body> bodies, std::span<const Joint> joints) {
  double arm = 0.0;
  for (const Joint& joint : joints)
    for (int b : {joint.i, joint.j})
      if (b != earth) arm = std::max(arm, (joint.point - bodies[std::size_t(b)].initial.position).norm());
  return arm > 0.0 ? std::exp2(std::round(std::log2(arm))) : 1.0;
}

std::vector<Pose> initial_poses(std::span<const Body> bodies, double length) {
  std::vector<Pose> poses(bodies.size());
  for (std::size_t b = 0; b < bodies.size(); ++b) poses[b] = scaled_pose(bodies[b].initial, length);
  return poses;
}

/// Bodies that carry others are rather kept independent: weights of coordinates from 1/2 (the first of them) up to 1.
Eigen::VectorXd partition_weights(std::span<const Body> bodies, std::span<const Joint> joints) {
  const std::vector<int> places = carrying_places(bodies, joints);
  Eigen::VectorXd weight(Eigen::Index(6 * bodies.size()));
  for (std::size_t b = 0; b < bodies.size(); ++b)
    weight.segment<6>(Eigen::Index(6 * b)).setConstant(0.5 + 0.5 * double(places[b] + 1) / double(bodies.size()));
  return weight;
}

}  // namespace

std::vector<int> carrying_places(std::span<const Body> bodies, std::span<const Joint> joints) {
  std::vector<char> held(bodies.size());
  for (std::size_t b = 0; b < bodies.size(); ++b) held[b] = bodies[b].on_beam;
  for (const Joint& joint : joints)
    if (joint.i == earth || joint.j == earth) held[std::size_t(std::max(joint.i, joint.j))] = true;
  std::vector<std::size_t> order(bodies.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::ranges::stable_sort(order, std::greater(), [&](std::size_t b) { return std::pair(held[b], bodies[b].mass); });
  std::vector<int> places(bodies.size());
  for (std::size_t place = 0; place < order.size(); ++place) places[order[place]] = int(place);
  return places;
}

Mechanism::Mechanism(std::span<const Body> bodies, std::span<const Joint> joints)
    : length_(reference_length(bodies, joints)),
      joints_(joints, initial_poses(bodies, length_), length_),
      weight_(partition_weights(bodies, joints)),
      solved_{.poses = initial_poses(bodies, length_)},
      attitude_(bodies.size()) {
  for (auto* v : {&x_, &solved_.velocity, &solved_.bias, &solved_.drift}) v->setZero(coordinates());
  for (auto* v : {&residual_, &side_}) v->setZero(joints_.count());
  jacobian_.setZero(joints_.count(), coordinates());
}

void Mechanism::place_bodies() {
  for (std::size_t b = 0; b < solved_.poses.size(); ++b) {
    const auto x = x_.segment<6>(Eigen::Index(6 * b));
    solved_.poses[b].position = chart_.centre[b].position / length_ + x.head<3>();
    attitude_[b] = (chart_.centre[b].attitude * rotation_exp(x.tail<3>())).normalized();
    solved_.poses[b].axes = attitude_[b].toRotationMatrix();
  }
}

/// Jacobian with respect to the chart coordinates instead of the angular velocities: rotation columns times T(theta).
void Mechanism::chart_jacobian() {
  joints_.jacobian(solved_.poses, jacobian_);
  for (int b = 0; b < bodies(); ++b) {
    const Eigen::Matrix3d rate = rotation_rate_matrix(x_.segment<3>(6 * b + 3));
    for (int row = 0; row < joints_.count(); ++row) {
      const Eigen::RowVector3d turned = jacobian_.block<1, 3>(row, 6 * b + 3) * rate;
      jacobian_.block<1, 3>(row, 6 * b + 3) = turned;
    }
  }
}

void Mechanism::set_partition(const BodiesState& state) {
  coordinates_.set(state.independent, state.active);
  chart_.tangent.resize(Eigen::Index(coordinates_.dependent().size()), freedoms());
  chart_.displaced.resize(Eigen::Index(coordinates_.dependent().size()));
  solved_.tangent.resize(coordinates(), freedoms());
}

/// Factorises at the present positions and sets tangent and drift: u = tangent * (independent u) + drift.
void Mechanism::solve_tangent() {
  joints_.jacobian(solved_.poses, jacobian_);
  coordinates_.factorise(jacobian_);
  joints_.velocity_side(solved_.poses, side_);
  coordinates_.solve_tangent(jacobian_, side_, solved_.tangent, solved_.drift);
}

/// Chooses the partition anew where the present one has degraded; false where none can be used.
bool Mechanism::choose_again(BodiesState& state, StepReport& report) {
  const double steepest = largest_magnitude(solved_.tangent);
  if (steepest <= degraded_tangent) return true;
  const std::vector<char> active = state.active, independent = state.independent;
  const PartitionChoice choice = choose_partition(jacobian_, weight_, state.active, state.independent);
  report.repartitioned = state.independent != independent || state.active != active;
  if (choice.rank == int(coordinates_.active().size())) return true;
  // Near a singular position: go on with the old set while it can be solved.
  state.active = active;
  state.independent = independent;
  report.repartitioned = false;
  if (steepest <= lost_tangent) return true;
  report.trouble = StepReport::Trouble::singular;
  report.joint = joints_.joint_of(std::max(choice.weakest_row, 0));
  report.value = choice.pivot_ratio;
  return false;
}

StepReport Mechanism::open(BodiesState& state, double t, bool choose) {
  StepReport report;
  solved_.newton_iterations = 0;
  chart_.t = t;
  chart_.centre = state.motions;
  x_.setZero();
  joints_.set_time(t);
  place_bodies();
  if (choose) {
    joints_.jacobian(solved_.poses, jacobian_);
    choose_partition(jacobian_, weight_, state.active, state.independent);
    report.repartitioned = true;
  } else {
    set_partition(state);
    solve_tangent();
    if (!choose_again(state, report)) return report;
  }
  if (report.repartitioned) {
    set_partition(state);
    solve_tangent();
  }

  chart_.velocity.resize(freedoms());
  for (int c = 0; c < freedoms(); ++c) {
    const int k = coordinates_.independent()[std::size_t(c)], b = k / 6, component = k % 6;
    const Motion& m = chart_.centre[std::size_t(b)];
    chart_.velocity[c] = component < 3 ? m.velocity[component] / length_ : m.omega[component - 3];
  }
  solve_velocities(chart_.velocity);
  const std::vector<int>& dependent = coordinates_.dependent();
  for (std::size_t r = 0; r < dependent.size(); ++r) chart_.tangent.row(Eigen::Index(r)) = solved_.tangent.row(dependent[r]);
  chart_.drift = solved_.drift;
  chart_.bias = solved_.bias;
  return report;
}

StepReport Mechanism::solve_positions(double t, const Eigen::VectorXd& x) {
  StepReport report;
  const std::vector<int>&independent = coordinates_.independent(), &dependent = coordinates_.dependent();
  joints_.set_time(t);
  for (int c = 0; c < freedoms(); ++c) x_[independent[std::size_t(c)]] = x[c];
  // Taylor series of the dependent coordinates about the centre: exact to second order along the motion, so that Newton stays on
  // the branch the mechanism is on, also where branches are near (past a singular position).
  const double elapsed = t - chart_.t;
  chart_.displaced.noalias() = chart_.tangent * x;
  for (std::size_t r = 0; r < dependent.size(); ++r) {
    const int k = dependent[r];
    x_[k] = chart_.displaced[Eigen::Index(r)] + elapsed * (chart_.drift[k] + 0.5 * elapsed * chart_.bias[k]);
  }
  double previous = INFINITY;
  bool fresh = false;
  for (int iteration = 0;; ++iteration) {
    place_bodies();
    joints_.residual(solved_.poses, residual_);
    int joint = -1;
    const double norm = worst(residual_, coordinates_.active(), &joint);
    double reach = 1.0;
    for (const Pose& p : solved_.poses) reach = std::max(reach, p.position.cwiseAbs().maxCoeff());
    if (norm <= newton_goal * reach || (norm <= newton_tolerance * reach && norm > 0.25 * previous)) return report;
    if (iteration == newton_limit || !std::isfinite(norm)) {
      report.trouble = std::isfinite(norm) ? StepReport::Trouble::newton : StepReport::Trouble::not_finite;
      report.joint = joint;
      report.value = norm;
      return report;
    }
    if (norm > slow_contraction * previous && !fresh) {
      chart_jacobian();
      coordinates_.factorise(jacobian_);
      fresh = true;
    } else {
      fresh = false;
    }
    const Eigen::VectorXd& solved = coordinates_.solve(residual_);
    for (std::size_t r = 0; r < dependent.size(); ++r) x_[dependent[r]] -= solved[Eigen::Index(r)];
    previous = norm;
    ++solved_.newton_iterations;
  }
}

void Mechanism::solve_velocities(const Eigen::VectorXd& u) {
  solve_tangent();
  solved_.velocity.noalias() = solved_.tangent * u;
  solved_.velocity += solved_.drift;
  for (int b = 0; b < bodies(); ++b) {
    solved_.poses[std::size_t(b)].velocity = solved_.velocity.segment<3>(6 * b);
    solved_.poses[std::size_t(b)].spin = solved_.poses[std::size_t(b)].axes * solved_.velocity.segment<3>(6 * b + 3);
  }
  solved_.bias.setZero();
  const std::vector<int>& dependent = coordinates_.dependent();
  if (dependent.empty()) return;
  joints_.acceleration_side(solved_.poses, residual_);
  const Eigen::VectorXd& solved = coordinates_.solve(residual_);
  for (std::size_t r = 0; r < dependent.size(); ++r) solved_.bias[dependent[r]] = solved[Eigen::Index(r)];
}

void Mechanism::chart_rate(Eigen::VectorXd& x_rate) const {
  const std::vector<int>& independent = coordinates_.independent();
  for (std::size_t c = 0; c < independent.size(); ++c) {
    const int k = independent[c], first = 6 * (k / 6) + 3;
    x_rate[Eigen::Index(c)] =
        k < first ? solved_.velocity[k] : rotation_rate(x_.segment<3>(first), solved_.velocity.segment<3>(first))[k - first];
  }
}

void Mechanism::add_turning(Eigen::VectorXd& u_rate) const {
  const std::vector<int>& independent = coordinates_.independent();
  for (std::size_t c = 0; c < independent.size(); ++c) {
    const int k = independent[c], first = 6 * (k / 6) + 3;
    if (k < first) continue;
    const Eigen::Vector3d spin = chart_.centre[std::size_t(k / 6)].omega;
    u_rate[Eigen::Index(c)] += spin.cross(solved_.velocity.segment<3>(first))[k - first];
  }
}

void Mechanism::motions(std::vector<Motion>& out) const {
  for (std::size_t b = 0; b < solved_.poses.size(); ++b) {
    const auto k = Eigen::Index(6 * b);
    out[b].position = chart_.centre[b].position + length_ * x_.segment<3>(k);
    out[b].attitude = attitude_[b];
    out[b].velocity = length_ * solved_.velocity.segment<3>(k);
    out[b].omega = solved_.velocity.segment<3>(k + 3);
  }
}

/// Largest magnitude in these rows, and whose joint it is.
double Mechanism::worst(const Eigen::VectorXd& values, std::span<const int> rows, int* joint) const {
  double largest = 0.0;
  for (const int row : rows) {
    const double value = std::abs(values[row]);
    if (!(value <= largest)) {
      largest = value;
      if (joint) *joint = joints_.joint_of(row);
      if (std::isnan(value)) return value;
    }
  }
  return largest;
}

double Mechanism::residual(int* joint) {
  joints_.residual(solved_.poses, residual_);
  return worst(residual_, joints_.all(), joint);
}

double Mechanism::velocity_residual(int* joint) {
  residual_.noalias() = jacobian_ * solved_.velocity;
  residual_ -= side_;
  return worst(residual_, joints_.all(), joint);
}

void Mechanism::reactions(const Eigen::VectorXd& out_of_balance, std::vector<Wrench>& on_j) {
  for (Wrench& w : on_j) w = Wrench{};
  const std::vector<int>&active = coordinates_.active(), &dependent = coordinates_.dependent();
  if (active.empty()) return;
  Eigen::VectorXd on_dependent(Eigen::Index(dependent.size()));
  for (std::size_t r = 0; r < dependent.size(); ++r) on_dependent[Eigen::Index(r)] = out_of_balance[dependent[r]];
  const Eigen::VectorXd of_active = coordinates_.solve_transposed(on_dependent);
  Eigen::VectorXd multipliers = Eigen::VectorXd::Zero(joints_.count());
  for (std::size_t r = 0; r < active.size(); ++r) multipliers[active[r]] = of_active[Eigen::Index(r)];
  joints_.reactions(solved_.poses, multipliers, on_j);
}

std::vector<int> Mechanism::joints_behind(int row) const {
  std::vector<int> found{joints_.joint_of(row)};
  const std::vector<int>&active = coordinates_.active(), &dependent = coordinates_.dependent();
  if (active.empty()) return found;
  Eigen::VectorXd right(Eigen::Index(dependent.size()));
  for (std::size_t k = 0; k < dependent.size(); ++k) right[Eigen::Index(k)] = jacobian_(row, dependent[k]);
  const Eigen::VectorXd share = coordinates_.solve_transposed(right);
  for (std::size_t k = 0; k < active.size(); ++k) {
    const int joint = joints_.joint_of(active[k]);
    if (std::abs(share[Eigen::Index(k)]) > 1e-6 && std::ranges::find(found, joint) == found.end()) found.push_back(joint);
  }
  return found;
}

}  // namespace spindrift::bodies
