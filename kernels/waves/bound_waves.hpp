// Bound waves of second order of a long-crested sea in water of finite depth: every two harmonics m, n of the linear sea carry
// one at the sum of their phases and one at the difference. Longuet-Higgins (1963), J. Fluid Mech. 17, 459-480 (deep water);
// Sharma & Dean (1981), Soc. Petroleum Engineers J. 21, 129-140 (finite depth), whose D and K are `potential` and `elevation`
// here, with dimensions. Docs: docs/theory/waves.md, section 3. Sums over pairs are products: phase and depth of a pair are those
// of its two harmonics multiplied, so that a pair takes neither sine nor exponential. Called by src/sea/wave_field; tested in
// tests/kernels/waves/bound_waves_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "kernels/waves/components.hpp"

namespace spindrift::waves {

enum class BoundAt { sum, difference };

/// What two linear waves of unit amplitude in one direction carry, to be summed over m and n in both orders:
///   phi = potential cosh k(z+h) / cosh kh sin(psi_m +- psi_n) ,   eta = elevation cos(psi_m +- psi_n) ,   k = |k_m +- k_n|
struct BoundPair {
  double potential;  ///< [1/s]
  double elevation;  ///< [1/m]
};

/// By the surface's conditions to second order, with the pressure at rest at z = 0 as the constant of Bernoulli's: a wave with
/// itself at the difference has the set-down -k / (2 sinh 2kh).
inline BoundPair bound_pair(const Component& m, const Component& n, BoundAt at, double depth, double gravity) {
  const double sign = at == BoundAt::sum ? 1.0 : -1.0;
  const double wm = m.angular_frequency, wn = n.angular_frequency, omega = wm + sign * wn;
  const double k = std::abs(m.wave_number + sign * n.wave_number);
  // Products of the velocities along and across the surface, and the vertical change of what stands in its linear condition.
  const double along = gravity * gravity * m.wave_number * n.wave_number / (wm * wn), across = wm * wn;
  const auto change = [&](const Component& c) {
    const double w = c.angular_frequency, gk = gravity * c.wave_number;
    return gk * gk / w - w * w * w;
  };
  const double load = -0.5 * (along - sign * across) * omega - 0.25 * (change(m) + sign * change(n));
  const double potential = k > 0.0 ? load / (gravity * k * std::tanh(k * depth) - omega * omega) : 0.0;
  return {potential, (potential * omega - 0.25 * (along - sign * across) + 0.25 * (wm * wm + wn * wn)) / gravity};
}

/// The bound waves of a sea. Of N harmonics a place costs 2 N^2 products for the surface, 3 N^2 and more for the kinematics.
class BoundWaves {
 public:
  static constexpr std::size_t most = 1024;  ///< harmonics

  BoundWaves() = default;
  /// `sea`: at most `most` harmonics of one direction.
  BoundWaves(std::span<const Component> sea, double depth, double gravity);

  bool empty() const { return count_ == 0; }
  Surface surface(double t, double x, double y) const;
  /// At -h <= z <= 0. The pressure is -d phi/dt, without the square of the linear velocity.
  Kinematics kinematics(double t, double x, double y, double z) const;

 private:
  static constexpr std::size_t most_groups = most / lanes;
  using Row = std::array<Lanes, most_groups>;

  /// One part of the kinematics: pairs at the sum or the difference, and of cosh = (e^ + e^-)/2 the one exponential.
  struct Part {
    Lanes u{}, w{}, ax{}, az{}, p{};
  };
  /// What all pairs of the lanes' harmonics m with one n <= m have; zero where n > m.
  struct Flow {
    Lanes speed, pressure;
  };
  struct Height {
    Lanes cosines, sines;
  };
  std::size_t columns(std::size_t group) const { return std::min((group + 1) * std::size_t(lanes), count_); }
  void phases(double t, double x, double y, Row& sine, Row& cosine) const;
  void add(Part& part, double vertical, const Row& sine, const Row& cosine, std::span<const Flow> flows, BoundAt at, double reach,
           std::span<const std::size_t> first, std::span<const std::size_t> last) const;

  std::size_t count_ = 0;
  double depth_ = 0.0, cos_b_ = 1.0, sin_b_ = 0.0;
  std::vector<Lanes> k_, omega_, phase_;
  std::vector<double> numbers_, rates_;  ///< the same k and omega one by one
  std::vector<std::size_t> start_;       ///< of a group's rows in `heights_` and the flows
  std::vector<Height> heights_;
  std::vector<Flow> sums_, differences_;
  std::vector<std::size_t> none_, all_, near_, sum_up_, sum_down_;  ///< by group: first and last columns of the four parts
};

}  // namespace spindrift::waves
