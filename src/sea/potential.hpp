// Potential flow round one floating body: Cummins' equation with the coefficients of a boundary-element code. Added mass at
// infinite frequency goes on the left-hand side; radiation memory is a convolution with the body's velocity or a fitted state
// space; waves excite by force per amplitude, and to second order; still water carries by exact buoyancy of the cylinders or by
// linear stiffness that yaws with the hull. Else small motions about the scene's position, axes of the earth. Theory:
// docs/theory/sea_engineering.md. Part of EngineeringSea; tested in tests/src/sea/potential_test.cpp. SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "kernels/rigid/motion.hpp"
#include "kernels/rigid/wrench.hpp"
#include "kernels/waves/components.hpp"
#include "src/sea/options.hpp"
#include "src/sea/radiation.hpp"
#include "src/sea/second_order.hpp"
#include "src/sea/wamit.hpp"

namespace spindrift::sea {

/// Displacement of a point of a body since the start and the body's rotation as tilt about x, about y, and yaw; velocity of the
/// same, earth axes.
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

  // Memory as bodies::Memory has it.
  std::size_t memory_size() const;
  void begin(double t, const Motion& motion, std::span<double> memory) const;
  void recall(std::span<const double> memory);
  void remember(double t, const Motion& motion, std::span<double> memory) const;

  const Matrix6& infinite_added_mass() const { return infinite_; }
  /// What the memory's end cuts off: the mode whose memory of itself is largest there, over its largest value.
  struct Cut {
    int mode = 0;
    double share = 0.0;
  };
  const Cut& cut() const { return cut_; }
  /// The mode whose damping is nearest to its largest at the last frequency of the file [rad/s]. Above `died_out` the added mass
  /// at infinite frequency is the one with which the memory gives the file's added mass at most of its frequencies.
  static constexpr double died_out = 0.25;
  struct CutDamping {
    int mode = 0;
    double share = 0.0, omega = 0.0;
  };
  const CutDamping& cut_damping() const { return cut_damping_; }
  /// Of the waves, the share of their energy beyond the excitation's last frequency, and its period [s].
  struct Unexcited {
    double share = 0.0, period_s = 0.0;
  };
  const Unexcited& unexcited() const { return unexcited_; }
  /// Heave force per amplitude of the longest waves of the file that have one, in its first direction [rad/s, N/m].
  struct LongWaves {
    double omega = 0.0, heave_N_m = 0.0;
  };
  const LongWaves& long_waves() const { return long_waves_; }
  /// By the file of hydrostatics [N/m]; 0 without one.
  double heave_stiffness() const { return stiffness_(2, 2); }
  /// Numbers that a fitted state space has; 0 of the others.
  std::size_t states() const;

 private:
  void make_radiation(const PotentialOptions& options, const WamitRadiation& file);
  void note_cut(int mode, std::span<const double> memory);
  void note_cut_damping(const WamitRadiation& file);

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
  std::optional<SecondOrderLoads> second_order_;
  double step_;
  Cut cut_;
  CutDamping cut_damping_;
  Unexcited unexcited_;
  LongWaves long_waves_;
  std::variant<std::monostate, ConvolutionMemory, StateSpaceMemory> memory_;
  bool recalled_ = false;
};

}  // namespace spindrift::sea
