// Potential flow round one floating body: Cummins' equation with the coefficients of a boundary-element code. Added mass at
// infinite frequency goes on the left-hand side; radiation memory is a convolution with the body's velocity;
// waves excite by force per amplitude; still water carries by exact buoyancy of the cylinders or by linear
// stiffness. Small motions about the scene's position, axes of the earth. Theory: docs/theory/sea_engineering.md. Part of
// EngineeringSea; tested in tests/src/sea/potential_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "kernels/rigid/motion.hpp"
#include "kernels/rigid/wrench.hpp"
#include "kernels/waves/components.hpp"
#include "src/sea/options.hpp"
#include "src/sea/wamit.hpp"

namespace spindrift::sea {

using Vector6 = Eigen::Matrix<double, 6, 1>;

/// Displacement of a point of a body since the start and the body's rotation as roll, pitch, yaw; velocity of the same, earth
/// axes.
struct PoseOfPoint {
  Vector6 displacement, velocity;
  Eigen::Vector3d point;  ///< now [m]
};
PoseOfPoint pose_of(const Motion& now, const Motion& initial, const Eigen::Vector3d& point_in_body);

class PotentialBody {
 public:
  /// `step_s`: of the bodies, at which the memory is sampled. Throws scene::SceneError where a file cannot be read.
  PotentialBody(const PotentialOptions& options, const SeaEnvironment& environment, const Motion& initial,
                const std::vector<waves::Component>& waves, double step_s);

  bool linear_hydrostatics() const { return linear_hydrostatics_; }
  /// Still water, waves (times `ramp`) and memory, about the body's centre of mass; not the added mass.
  Wrench load(double t, double ramp, const Motion& motion) const;
  void add_added_mass(const Motion& motion, Matrix6& mass) const;

  // Memory as bodies::Memory has it: velocities of the last steps, youngest first from a moving place.
  std::size_t memory_size() const { return memory_size_; }
  void begin(double t, const Motion& motion, std::span<double> memory) const;
  void recall(std::span<const double> memory);
  void remember(double t, const Motion& motion, std::span<double> memory) const;

  const Matrix6& infinite_added_mass() const { return infinite_; }
  /// K at n steps.
  const Matrix6& retardation(std::size_t n) const { return retardation_[n]; }

 private:
  Vector6 memory_force(double t, const Vector6& velocity) const;

  SeaEnvironment environment_;
  Motion initial_;
  Eigen::Vector3d point_;  ///< of the coefficients, body axes from the centre of mass
  Matrix6 infinite_, stiffness_ = Matrix6::Zero();
  Vector6 buoyancy_ = Vector6::Zero();  ///< of the body in place
  bool linear_hydrostatics_ = false;
  struct Exciting {
    double omega, phase;  ///< [rad/s], of the wave at the coefficients' point [rad]
    Eigen::Matrix<std::complex<double>, 6, 1> force;
  };
  std::vector<Exciting> exciting_;
  double step_;
  std::vector<Matrix6> retardation_;  ///< at 0, 1, 2 ... steps; trapezoidal weights not included
  struct Pair {
    int i, j;
    std::vector<double> weight;  ///< K_ij times step
  };
  std::vector<Pair> pairs_;  ///< of modes that remember
  std::size_t memory_size_ = 0;
  // Recalled: the memory's force now and a step later, apart from the newest interval.
  bool recalled_ = false;
  double time_ = 0.0;
  Vector6 now_ = Vector6::Zero(), later_ = Vector6::Zero(), newest_ = Vector6::Zero();
};

}  // namespace spindrift::sea
