// SPDX-License-Identifier: Apache-2.0
#include "src/bodies/mechanism.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

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

}  // namespace

Mechanism::Mechanism(std::span<const Body> bodies, std::span<const Joint> joints) {
  double arm = 0.0;
  for (const Joint& joint : joints)
    for (int b : {joint.i, joint.j})
      if (b != earth) arm = std::max(arm, (joint.point - bodies[std::size_t(b)].initial.position).norm());
  length_ = arm > 0.0 ? std::exp2(std::round(std::log2(arm))) : 1.0;

  pose_.resize(bodies.size());
  attitude_.resize(bodies.size());
  for (std::size_t b = 0; b < bodies.size(); ++b) pose_[b] = scaled_pose(bodies[b].initial, length_);
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const Joint& joint = joints[k];
    const auto driver = [&](const std::optional<PrescribedMotion>& motion, double unit) {
      if (!motion) return -1;
      drivers_.push_back({*motion, unit});
      return int(drivers_.size()) - 1;
    };
    const int rotation = driver(joint.rotation, 1.0), translation = driver(joint.translation, 1.0 / length_);
    const Eigen::Vector3d axis = joint.axis.normalized(), point = joint.point / length_;
    const Eigen::Vector3d given =
        joint.second_axis - joint.second_axis.dot(axis) * axis;  // the arms of a cross are perpendicular
    const Eigen::Vector3d second =
        joint.type == JointType::universal ? Eigen::Vector3d(given.normalized()) : perpendicular_to(axis);
    const JointFrame on_i = joint_frame(pose(joint.i), point, axis, second),
                     on_j = joint_frame(pose(joint.j), point, axis, second);
    append_joint(joint.type, joint.i, joint.j, on_i, on_j, rotation, translation, int(k), constraints_);
    if (turns(joint.type)) turning_.push_back({int(k), joint.i, joint.j, on_i, on_j});
  }
  for (const Constraint& c : constraints_) row_joint_.insert(row_joint_.end(), std::size_t(c.rows()), c.joint);
  rows_ = int(row_joint_.size());
  drive_.resize(drivers_.size());

  // Heavier bodies are rather kept independent: weights from 1 (lightest) down to 1/2 (heaviest); ties by order.
  std::vector<std::size_t> order(bodies.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return bodies[a].mass > bodies[b].mass; });
  weight_.resize(coordinates());
  for (std::size_t place = 0; place < order.size(); ++place)
    weight_.segment<6>(Eigen::Index(6 * order[place])).setConstant(0.5 + 0.5 * double(place + 1) / double(order.size()));

  const int n = coordinates();
  for (auto* v : {&x_, &u_, &bias_, &drift_}) v->setZero(n);
  residual_.setZero(rows_);
  side_.setZero(rows_);
  jacobian_.setZero(rows_, n);
}

void Mechanism::set_drives(double t) {
  for (std::size_t k = 0; k < drivers_.size(); ++k) {
    const Drive d = drivers_[k].motion.at(t);
    drive_[k] = {d.value * drivers_[k].unit, d.rate * drivers_[k].unit, d.acceleration * drivers_[k].unit};
  }
}

void Mechanism::place_bodies() {
  for (std::size_t b = 0; b < pose_.size(); ++b) {
    const auto x = x_.segment<6>(Eigen::Index(6 * b));
    pose_[b].position = origin_[b].position / length_ + x.head<3>();
    attitude_[b] = (origin_[b].attitude * rotation_exp(x.tail<3>())).normalized();
    pose_[b].axes = attitude_[b].toRotationMatrix();
  }
}

void Mechanism::evaluate_residual() {
  int row = 0;
  for (const Constraint& c : constraints_) {
    const Eigen::Vector3d r = spindrift::residual(c, pose(c.i), pose(c.j), drive(c));
    for (int k = 0; k < c.rows(); ++k) residual_[row++] = r[k];
  }
}

void Mechanism::evaluate_jacobian() {
  int row = 0;
  for (const Constraint& c : constraints_) {
    const ConstraintRows block = jacobian(c, pose(c.i), pose(c.j), drive(c));
    const int n = c.rows();
    if (c.i != earth) {
      jacobian_.block(row, 6 * c.i, n, 3) = block.translation_i.topRows(n);
      jacobian_.block(row, 6 * c.i + 3, n, 3) = block.rotation_i.topRows(n);
    }
    if (c.j != earth) {
      jacobian_.block(row, 6 * c.j, n, 3) = block.translation_j.topRows(n);
      jacobian_.block(row, 6 * c.j + 3, n, 3) = block.rotation_j.topRows(n);
    }
    row += n;
  }
}

/// Jacobian with respect to the chart coordinates instead of the angular velocities: rotation columns times T(theta).
void Mechanism::chart_jacobian() {
  evaluate_jacobian();
  for (int b = 0; b < bodies(); ++b) {
    const Eigen::Matrix3d rate = rotation_rate_matrix(x_.segment<3>(6 * b + 3));
    for (int row = 0; row < rows_; ++row) {
      const Eigen::RowVector3d turned = jacobian_.block<1, 3>(row, 6 * b + 3) * rate;
      jacobian_.block<1, 3>(row, 6 * b + 3) = turned;
    }
  }
}

void Mechanism::factorise() {
  for (std::size_t c = 0; c < dependent_.size(); ++c)
    for (std::size_t r = 0; r < active_.size(); ++r)
      dependent_block_(Eigen::Index(r), Eigen::Index(c)) = jacobian_(active_[r], dependent_[c]);
  if (!active_.empty()) lu_.compute(dependent_block_);
}

void Mechanism::index_partition(const BodiesState& state) {
  independent_.clear();
  dependent_.clear();
  active_.clear();
  for (int k = 0; k < coordinates(); ++k) (state.independent[std::size_t(k)] ? independent_ : dependent_).push_back(k);
  for (int k = 0; k < rows_; ++k)
    if (state.active[std::size_t(k)]) active_.push_back(k);
  const Eigen::Index rank = Eigen::Index(active_.size()), free = Eigen::Index(independent_.size());
  dependent_block_.resize(rank, rank);
  right_.resize(rank, free + 1);
  solution_.resize(rank, free + 1);
  solved_.resize(rank);
  gathered_.resize(rank);
  open_tangent_.resize(rank, free);
  tangent_.resize(coordinates(), free);
}

/// Factorises at the present positions and sets tangent and drift: u = tangent * (independent u) + drift.
void Mechanism::solve_tangent() {
  evaluate_jacobian();
  factorise();
  const Eigen::Index free = freedoms();
  for (std::size_t r = 0; r < active_.size(); ++r)
    for (Eigen::Index c = 0; c < free; ++c) right_(Eigen::Index(r), c) = -jacobian_(active_[r], independent_[std::size_t(c)]);
  int row = 0;
  for (const Constraint& c : constraints_) {
    const Eigen::Vector3d nu = velocity_side(c, pose(c.i), pose(c.j), drive(c));
    for (int k = 0; k < c.rows(); ++k) side_[row++] = nu[k];
  }
  for (std::size_t r = 0; r < active_.size(); ++r) right_(Eigen::Index(r), free) = side_[active_[r]];
  if (!active_.empty()) solution_ = lu_.solve(right_);
  tangent_.setZero();
  drift_.setZero();
  for (Eigen::Index c = 0; c < free; ++c) tangent_(independent_[std::size_t(c)], c) = 1.0;
  for (std::size_t r = 0; r < dependent_.size(); ++r) {
    tangent_.row(dependent_[r]) = solution_.row(Eigen::Index(r)).head(free);
    drift_[dependent_[r]] = solution_(Eigen::Index(r), free);
  }
}

StepReport Mechanism::open(BodiesState& state, double t, bool choose) {
  StepReport report;
  newton_iterations_ = 0;
  t_open_ = t;
  origin_ = state.motions;
  x_.setZero();
  set_drives(t);
  place_bodies();
  if (!choose) {
    index_partition(state);
    solve_tangent();
    const double steepest = largest_magnitude(tangent_);
    choose = !(steepest <= degraded_tangent);
    if (choose) {
      const std::vector<char> active = state.active, independent = state.independent;
      const PartitionChoice choice = choose_partition(jacobian_, weight_, state.active, state.independent);
      report.repartitioned = state.independent != independent || state.active != active;
      if (choice.rank != int(active_.size())) {  // near a singular position: go on with the old set while it can be solved
        state.active = active;
        state.independent = independent;
        report.repartitioned = false;
        if (!(steepest <= lost_tangent)) {
          report.trouble = StepReport::Trouble::singular;
          report.joint = joint_of_row(std::max(choice.weakest_row, 0));
          report.value = choice.pivot_ratio;
          return report;
        }
      }
    }
  } else {
    evaluate_jacobian();
    choose_partition(jacobian_, weight_, state.active, state.independent);
    report.repartitioned = true;
  }
  if (report.repartitioned) {
    index_partition(state);
    solve_tangent();
  }

  u_open_.resize(freedoms());
  for (int c = 0; c < freedoms(); ++c) {
    const int k = independent_[std::size_t(c)], b = k / 6, component = k % 6;
    const Motion& m = origin_[std::size_t(b)];
    u_open_[c] = component < 3 ? m.velocity[component] / length_ : m.omega[component - 3];
  }
  solve_velocities(u_open_);
  for (std::size_t r = 0; r < dependent_.size(); ++r) open_tangent_.row(Eigen::Index(r)) = tangent_.row(dependent_[r]);
  open_drift_ = drift_;
  open_bias_ = bias_;
  return report;
}

StepReport Mechanism::solve_positions(double t, const Eigen::VectorXd& x) {
  StepReport report;
  set_drives(t);
  for (int c = 0; c < freedoms(); ++c) x_[independent_[std::size_t(c)]] = x[c];
  // Taylor series of the dependent coordinates about the centre: exact to second order along the motion, so that Newton stays on
  // the branch the mechanism is on, also where branches are near (past a singular position).
  const double elapsed = t - t_open_;
  solved_.noalias() = open_tangent_ * x;
  for (std::size_t r = 0; r < dependent_.size(); ++r) {
    const int k = dependent_[r];
    x_[k] = solved_[Eigen::Index(r)] + elapsed * (open_drift_[k] + 0.5 * elapsed * open_bias_[k]);
  }
  double previous = INFINITY;
  bool fresh = false;
  for (int iteration = 0;; ++iteration) {
    place_bodies();
    evaluate_residual();
    int joint = -1;
    const double norm = worst(residual_, true, &joint);
    double reach = 1.0;
    for (const Pose& p : pose_) reach = std::max(reach, p.position.cwiseAbs().maxCoeff());
    if (norm <= newton_goal * reach || (norm <= newton_tolerance * reach && norm > 0.25 * previous)) return report;
    if (iteration == newton_limit || !std::isfinite(norm)) {
      report.trouble = std::isfinite(norm) ? StepReport::Trouble::newton : StepReport::Trouble::not_finite;
      report.joint = joint;
      report.value = norm;
      return report;
    }
    if (norm > slow_contraction * previous && !fresh) {
      chart_jacobian();
      factorise();
      fresh = true;
    } else {
      fresh = false;
    }
    for (std::size_t r = 0; r < active_.size(); ++r) gathered_[Eigen::Index(r)] = residual_[active_[r]];
    solved_ = lu_.solve(gathered_);
    for (std::size_t r = 0; r < dependent_.size(); ++r) x_[dependent_[r]] -= solved_[Eigen::Index(r)];
    previous = norm;
    ++newton_iterations_;
  }
}

void Mechanism::solve_velocities(const Eigen::VectorXd& u) {
  solve_tangent();
  u_.noalias() = tangent_ * u;
  u_ += drift_;
  for (int b = 0; b < bodies(); ++b) {
    pose_[std::size_t(b)].velocity = u_.segment<3>(6 * b);
    pose_[std::size_t(b)].spin = pose_[std::size_t(b)].axes * u_.segment<3>(6 * b + 3);
  }
  int row = 0;
  for (const Constraint& c : constraints_) {
    const Eigen::Vector3d gamma = acceleration_side(c, pose(c.i), pose(c.j), drive(c));
    for (int k = 0; k < c.rows(); ++k) residual_[row++] = gamma[k];
  }
  bias_.setZero();
  if (active_.empty()) return;
  for (std::size_t r = 0; r < active_.size(); ++r) gathered_[Eigen::Index(r)] = residual_[active_[r]];
  solved_ = lu_.solve(gathered_);
  for (std::size_t r = 0; r < dependent_.size(); ++r) bias_[dependent_[r]] = solved_[Eigen::Index(r)];
}

void Mechanism::chart_rate(Eigen::VectorXd& x_rate) const {
  for (std::size_t c = 0; c < independent_.size(); ++c) {
    const int k = independent_[c], first = 6 * (k / 6) + 3;
    x_rate[Eigen::Index(c)] = k < first ? u_[k] : rotation_rate(x_.segment<3>(first), u_.segment<3>(first))[k - first];
  }
}

void Mechanism::motions(std::vector<Motion>& out) const {
  for (std::size_t b = 0; b < pose_.size(); ++b) {
    const auto k = Eigen::Index(6 * b);
    out[b].position = origin_[b].position + length_ * x_.segment<3>(k);
    out[b].attitude = attitude_[b];
    out[b].velocity = length_ * u_.segment<3>(k);
    out[b].omega = u_.segment<3>(k + 3);
  }
}

void Mechanism::turn_joints(std::vector<double>& angles) const {
  for (const Turning& j : turning_) {
    double& angle = angles[std::size_t(j.joint)];
    angle = unwrapped(joint_angle(j.on_i, j.on_j, pose(j.i), pose(j.j)), angle);
  }
}

double Mechanism::worst(const Eigen::VectorXd& values, bool active_only, int* joint) const {
  double largest = 0.0;
  const int count = active_only ? int(active_.size()) : rows_;
  for (int k = 0; k < count; ++k) {
    const int row = active_only ? active_[std::size_t(k)] : k;
    const double value = std::abs(values[row]);
    if (!(value <= largest)) {
      largest = value;
      if (joint) *joint = joint_of_row(row);
      if (std::isnan(value)) return value;
    }
  }
  return largest;
}

double Mechanism::residual(int* joint) {
  evaluate_residual();
  return worst(residual_, false, joint);
}

double Mechanism::velocity_residual(int* joint) {
  residual_.noalias() = jacobian_ * u_;
  residual_ -= side_;
  return worst(residual_, false, joint);
}

void Mechanism::reactions(const Eigen::VectorXd& out_of_balance, std::vector<Wrench>& on_j) {
  for (Wrench& w : on_j) w = Wrench{};
  if (active_.empty()) return;
  for (std::size_t r = 0; r < dependent_.size(); ++r) solved_[Eigen::Index(r)] = out_of_balance[dependent_[r]];
  const Eigen::VectorXd multipliers = lu_.transpose().solve(solved_);
  side_.setZero();
  for (std::size_t r = 0; r < active_.size(); ++r) side_[active_[r]] = multipliers[Eigen::Index(r)];
  int row = 0;
  for (const Constraint& c : constraints_) {
    const ConstraintRows block = jacobian(c, pose(c.i), pose(c.j), drive(c));
    Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();
    for (int k = 0; k < c.rows(); ++k, ++row) {
      force += side_[row] / length_ * block.translation_j.row(k).transpose();
      moment += side_[row] * (pose(c.j).axes * block.rotation_j.row(k).transpose());
    }
    Wrench& w = on_j[std::size_t(c.joint)];
    w.point = length_ * (pose(c.j).position + pose(c.j).axes * c.point_j);
    w.force += force;
    w.moment += moment + (length_ * pose(c.j).position - w.point).cross(force);
  }
}

std::vector<int> Mechanism::joints_behind(int row) const {
  std::vector<int> found{joint_of_row(row)};
  if (active_.empty()) return found;
  Eigen::VectorXd right(Eigen::Index(dependent_.size()));
  for (std::size_t k = 0; k < dependent_.size(); ++k) right[Eigen::Index(k)] = jacobian_(row, dependent_[k]);
  const Eigen::VectorXd share = lu_.transpose().solve(right);
  for (std::size_t k = 0; k < active_.size(); ++k)
    if (std::abs(share[Eigen::Index(k)]) > 1e-6 && std::find(found.begin(), found.end(), joint_of_row(active_[k])) == found.end())
      found.push_back(joint_of_row(active_[k]));
  return found;
}

}  // namespace spindrift::bodies
