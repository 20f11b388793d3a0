// What the water round a floating body remembers of its velocity: int K(tau) v(t - tau) dtau, as a sum over the velocities of the
// last steps or as a state for each pole of K. Theory: docs/theory/sea_engineering.md. Part of PotentialBody; tested in
// tests/src/sea/potential_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <variant>
#include <vector>

#include "kernels/waves/radiation_poles.hpp"

namespace spindrift::sea {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// K_ij at 0, step, 2 step ... of two modes that remember one another.
struct RetardationSeries {
  int i, j;
  std::vector<double> values;
};

// Both kinds. Memory as bodies::Memory has it; `force` is that on the body, of the values recalled last.

/// Velocities of the last steps, youngest first from a moving place; trapezoidal rule.
class ConvolutionMemory {
 public:
  ConvolutionMemory(std::vector<RetardationSeries> series, std::size_t steps, double step_s);
  std::size_t size() const { return 2 + 6 * count_; }
  void begin(double t, const Vector6& velocity, std::span<double> memory) const;
  void recall(std::span<const double> memory);
  void remember(double t, const Vector6& velocity, std::span<double> memory) const;
  Vector6 force(double t, const Vector6& velocity) const;

 private:
  struct Pair {
    int i, j;
    std::vector<double> weight;  ///< K_ij times step
  };
  std::vector<Pair> pairs_;  ///< of modes that remember
  std::size_t count_;
  double step_;
  Matrix6 first_ = Matrix6::Zero(), second_ = Matrix6::Zero();  ///< K at 0 and a step
  double time_ = 0.0;
  Vector6 now_ = Vector6::Zero(), later_ = Vector6::Zero(),
          newest_ = Vector6::Zero();  ///< sums at two times, but for the newest interval
};

/// A complex number for each pole; exact for a velocity that is straight within a step.
class StateSpaceMemory {
 public:
  struct Fit {
    int i, j;
    waves::RadiationPoles poles;
  };
  explicit StateSpaceMemory(std::vector<Fit> fits);
  std::size_t size() const { return 7 + 2 * states_; }
  std::size_t states() const { return states_; }  ///< complex ones
  void begin(double t, const Vector6& velocity, std::span<double> memory) const;
  void recall(std::span<const double> memory) { recalled_.assign(memory.begin(), memory.end()); }
  void remember(double t, const Vector6& velocity, std::span<double> memory) const;
  Vector6 force(double t, const Vector6& velocity) const;

 private:
  template <class Visit>
  void for_each_state(double t, const Vector6& velocity, const Visit& visit) const;

  std::vector<Fit> fits_;
  std::size_t states_ = 0;
  std::vector<double> recalled_;
};

}  // namespace spindrift::sea
