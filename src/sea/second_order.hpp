// Wave loads of second order on a body in place: mean drift, slowly varying drift by Newman's approximation (Newman 1974, Symp.
// on the dynamics of marine vehicles, London) or by the full matrix of difference frequencies, and loads of sum frequencies. For
// waves of one direction. Theory: docs/theory/sea_engineering.md. Part of PotentialBody; tested in
// tests/src/sea/second_order_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <complex>
#include <optional>
#include <vector>

#include "kernels/waves/components.hpp"
#include "src/sea/options.hpp"
#include "src/sea/wamit.hpp"

namespace spindrift::sea {

using Vector6 = Eigen::Matrix<double, 6, 1>;

class SecondOrderLoads {
 public:
  static constexpr std::size_t most_components = 2000;  ///< of the full matrices, which are that number squared

  /// Of [sea.potential]; throws scene::SceneError where a file cannot be read.
  SecondOrderLoads(const PotentialOptions& options, const WamitScale& scale, const std::vector<waves::Component>& waves);

  /// About the point of the files' axes, earth axes [N], [N m].
  Vector6 at(double t) const;

 private:
  using Matrix = Eigen::MatrixXcd;
  struct Full {
    int mode;
    Matrix transfer;  ///< by pairs of components
  };
  void take_mean(const WamitDrift& drift, bool newman, const std::vector<waves::Component>& waves);
  std::vector<Full> transfers(const WamitQuadratic& file, bool difference, const std::vector<waves::Component>& waves) const;

  std::vector<double> omega_;   ///< of the components [rad/s]
  Eigen::VectorXcd amplitude_;  ///< crest at phase 0 at the files' point at t = 0 [m]
  Vector6 mean_ = Vector6::Zero();
  Eigen::Matrix<double, 6, Eigen::Dynamic> drift_;  ///< of Newman's approximation, by component [N/m2]; else empty
  std::vector<Full> difference_, sum_;
  mutable std::optional<double> time_;  ///< at which `load_` was found: stages of a step ask for the same times
  mutable Vector6 load_ = Vector6::Zero();
  mutable Eigen::VectorXcd eta_;  ///< elevation of each component at that time [m]
};

}  // namespace spindrift::sea
