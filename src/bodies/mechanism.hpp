// The kinematics of bodies under joints: constraints of the whole system, the chart of configurations near a state, position
// solution by Newton-Raphson, velocities, and the velocity-dependent part of the accelerations. Knows no mass and no load. Chart:
// body b sits at r = r0 + L x_b[0..2], q = q0 exp(x_b[3..5]); the independent components of x are the coordinates, the others
// follow from the constraints (coordinate partitioning). All lengths inside are in units of L, a power of two near the largest
// joint arm, so that rows and columns of the Jacobian compare; scaling by it is exact. Used by system.cpp alone; tested through
// tests/src/bodies. Theory: docs/theory/bodies.md, "Positions" and "Velocities". SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "src/bodies/coordinates.hpp"
#include "src/bodies/joint_rows.hpp"
#include "src/bodies/system.hpp"

namespace spindrift::bodies {

/// Place of each body in the order in which they carry one another, from 0: first those that the earth or a beam holds, then
/// heavier ones; ties by order. A driven rotor turns on its nacelle, however heavy it is.
std::vector<int> carrying_places(std::span<const Body> bodies, std::span<const Joint> joints);

class Mechanism {
 public:
  Mechanism(std::span<const Body> bodies, std::span<const Joint> joints);

  int bodies() const { return int(solved_.poses.size()); }
  int coordinates() const { return 6 * bodies(); }
  const JointRows& joints() const { return joints_; }
  int freedoms() const { return int(coordinates_.independent().size()); }
  double length() const { return length_; }

  /// Centres the chart on a state and factorises; chooses a new partition when `choose` or when the old one has degraded (then
  /// state.independent and state.active change).
  StepReport open(BodiesState& state, double t, bool choose);
  /// Positions at independent coordinates x (chart); Newton-Raphson on the dependent ones.
  StepReport solve_positions(double t, const Eigen::VectorXd& x);
  /// Velocities from the independent ones at the positions last solved.
  void solve_velocities(const Eigen::VectorXd& u);
  /// Independent components of d(coordinates)/dt.
  void chart_rate(Eigen::VectorXd& x_rate) const;
  /// From rates of the independent velocities, in axes of the bodies, to those in axes that stay where these are at the centre.
  void add_turning(Eigen::VectorXd& u_rate) const;
  /// Motions in SI units.
  void motions(std::vector<Motion>& out) const;
  /// Angles of the joints that turn, continued from those in `angles`.
  void turn_joints(std::vector<double>& angles) const { joints_.turn_joints(solved_.poses, angles); }

  /// What was solved last, in chart units: velocity = tangent * independent ones + drift, accelerations = tangent * independent
  /// ones + bias.
  struct Solved {
    std::vector<Pose> poses;
    Eigen::MatrixXd tangent;
    Eigen::VectorXd velocity, drift, bias;
    int newton_iterations = 0;  ///< since the chart was opened
  };
  const Solved& solved() const { return solved_; }
  const Eigen::VectorXd& open_velocity() const { return chart_.velocity; }  ///< independent velocities at the centre

  /// Largest residual of all rows, redundant ones included, at the positions last solved; over L.
  double residual(int* joint = nullptr);
  /// Largest |C u - nu| of all rows at the velocities last solved.
  double velocity_residual(int* joint = nullptr);
  /// Generalised constraint forces on all coordinates of each joint's body j, from the out-of-balance of the dependent
  /// coordinates.
  void reactions(const Eigen::VectorXd& out_of_balance, std::vector<Wrench>& on_j);
  /// Names of the joints whose rows combine into the redundant row r, r's own first.
  std::vector<int> joints_behind(int row) const;

 private:
  void place_bodies();
  void chart_jacobian();
  void set_partition(const BodiesState& state);
  void solve_tangent();
  bool choose_again(BodiesState& state, StepReport& report);
  double worst(const Eigen::VectorXd& values, std::span<const int> rows, int* joint) const;

  /// What the dependent coordinates do near the centre, to second order along the motion.
  struct Chart {
    double t = 0.0;
    std::vector<Motion> centre;
    Eigen::MatrixXd tangent;  // dependent rows
    Eigen::VectorXd drift, bias, velocity;
    Eigen::VectorXd displaced;  // scratch
  };

  double length_ = 1.0;
  JointRows joints_;
  PartitionedCoordinates coordinates_;
  Eigen::VectorXd weight_;  // of the coordinates in the choice of the partition
  Chart chart_;

  Solved solved_;
  std::vector<Eigen::Quaterniond> attitude_;
  Eigen::VectorXd x_;
  Eigen::MatrixXd jacobian_;
  Eigen::VectorXd residual_, side_;
};

}  // namespace spindrift::bodies
