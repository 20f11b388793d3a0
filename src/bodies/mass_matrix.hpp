// The mass of all bodies as the equations of motion want it: their own, added mass, and what sources of load tie between two
// bodies. In chart units: rows of a body are [earth translation over the unit of length, body rotation]. Used by system.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "src/bodies/mechanism.hpp"

namespace spindrift::bodies {

using Vector6 = Eigen::Matrix<double, 6, 1>;

class MassMatrix {
 public:
  /// Bodies and sources outlive it.
  MassMatrix(std::span<const Body> bodies, std::span<const LoadSource> sources);

  /// At time t [s], where the mechanism is, which is where `motions` are.
  void gather(double t, std::span<const Motion> motions, const Mechanism& mechanism);
  /// out = M a, over all coordinates.
  void multiply(const Eigen::VectorXd& a, Eigen::VectorXd& out) const;
  /// B^T M B with the tangent B of the mechanism; valid until the next call.
  const Eigen::MatrixXd& condense(const Eigen::MatrixXd& tangent);

  /// Of the forces -A a [W]; rates: of each body's velocity and spin, earth axes.
  double added_mass_power(std::span<const Motion> motions, std::span<const Vector6> rates) const;
  /// Adds -A a to the loads of each source; `t` and `motions`: those gathered last.
  void add_reactions(double t, std::span<const Motion> motions, std::span<const Vector6> rates,
                     std::span<std::vector<Wrench>> by_source);

 private:
  void gather_added(double t, std::span<const Motion> motions, const Mechanism& mechanism);
  void gather_couplings(double t, std::span<const Motion> motions, const Mechanism& mechanism);
  template <class In, class Out>
  void add_coupled(const In& in, Out& out) const;

  std::span<const Body> bodies_;
  std::span<const LoadSource> sources_;
  bool has_added_mass_ = false;
  std::vector<Matrix6> added_;                    // earth axes, SI
  std::vector<Matrix6> mass_;                     // of each body, chart units
  std::vector<std::array<int, 2>> pairs_;         // of all couplings, in the order of their sources
  std::vector<Matrix6> between_, between_chart_;  // of the pairs: as `added_`, as `mass_`
  Eigen::MatrixXd mass_tangent_, condensed_;
  std::vector<Matrix6> of_one_source_;  // scratch
};

}  // namespace spindrift::bodies
