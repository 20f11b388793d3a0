// The preconditioned pseudo-time: its matrix and inverse, its limits, its wave speeds against eigenvalues.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/gas/preconditioner.hpp"

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>

#include "kernels/gas/jacobians.hpp"
#include "tests/kernels/gas/states.hpp"

using namespace spindrift;
using namespace spindrift::gas;
using namespace spindrift::gas::testing;

namespace {
using Matrix5 = Eigen::Matrix<double, 5, 5>;
Matrix5 matrix(const Block5<double>& b) { return Eigen::Map<const Eigen::Matrix<double, 5, 5, Eigen::RowMajor>>(&b.m[0][0]); }
}  // namespace

TEST_CASE("the change of variables agrees with the conserved variables' slopes", "[gas][fast]") {
  const IdealGas gas = gauge_air();
  Generator g;
  double worst = 0;
  for (int n = 0; n < 100; ++n) {
    const auto q = g.state(gas), d = 1e-5 * g.near(gas, Primitive<double>{0, 0, 0, 0, 0}, 1.0);
    const auto slope = conserved(gas, q + d) - conserved(gas, q - d), linear = 2.0 * conserved_change(gas, thermo(gas, q), q, d);
    Eigen::Matrix<double, 5, 1> a(&slope.rho), b(&linear.rho);
    worst = std::max({worst, std::abs(a[0] - b[0]) / std::abs(a[0]), std::abs(a[4] - b[4]) / std::abs(a[4]),
                      (a.segment<3>(1) - b.segment<3>(1)).norm() / a.segment<3>(1).norm()});
  }
  CHECK(worst < 1e-6);
}

TEST_CASE("matrix, product and inverse of the (preconditioned) change of variables belong together", "[gas][fast]") {
  const IdealGas gas = gauge_air();
  Generator g;
  double worst = 0, worst_back = 0, unchanged = 0;
  for (int n = 0; n < 200; ++n) {
    const auto q = g.state(gas);
    const double c2 = std::pow(sound_speed(gas, q), 2);
    const auto plain = thermo(gas, q);
    const auto t = n % 2 == 0 ? plain : preconditioned(gas, plain, std::pow(10.0, g.between(-8, 0)) * c2);
    const auto d = g.near(gas, Primitive<double>{0, 0, 0, 0, 0}, 0.1);
    const Eigen::Matrix<double, 5, 1> step(&d.p), product = matrix(conserved_by_primitive(gas, t, q)) * step;
    const auto applied = conserved_change(gas, t, q, d);
    const Eigen::Matrix<double, 5, 1> same(&applied.rho);
    for (int k = 0; k < 5; ++k)
      worst = std::max(worst, std::abs(product[k] - same[k]) / (std::abs(product[k]) + product.norm() * 1e-3));
    const auto back = primitive_change(gas, t, q, applied);
    worst_back = std::max({worst_back, std::abs(back.p - d.p) / std::abs(d.p), std::abs(back.T - d.T) / std::abs(d.T)});
    unchanged = std::max(unchanged, std::abs(preconditioned(gas, plain, c2).rho_p / plain.rho_p - 1.0));
  }
  CHECK(worst < 1e-11);
  CHECK(worst_back < 1e-6);  // pressure against heat at 1e-8 of the sound speed squared: 8 digits cancel
  CHECK(unchanged < 1e-13);  // with the sound speed for reference nothing is preconditioned
}

TEST_CASE("wave speeds are the eigenvalues of the preconditioned system", "[gas][fast]") {
  const IdealGas gas = gauge_air();
  Generator g;
  double worst = 0;
  for (int n = 0; n < 100; ++n) {
    const auto q = g.state(gas, 0.8);
    auto f = g.face();
    f.area = 1.0;
    const double c2 = std::pow(sound_speed(gas, q), 2), r2 = std::pow(10.0, g.between(-3, 0)) * c2,
                 un = normal_velocity(q, f) - f.speed;
    const Matrix5 A = matrix(conserved_by_primitive(gas, preconditioned(gas, thermo(gas, q), r2), q)).inverse() *
                      matrix(physical_jacobian(gas, q, f));
    const auto s = preconditioned_speeds(un, c2, r2);
    Eigen::VectorXd found = Eigen::EigenSolver<Matrix5>(A).eigenvalues().real(), expected(5);
    expected << s.slow, un, un, un, s.fast;
    std::sort(found.begin(), found.end()), std::sort(expected.begin(), expected.end());
    worst = std::max(worst, (found - expected).lpNorm<Eigen::Infinity>() / std::sqrt(c2));
  }
  CHECK(worst < 1e-5);  // the triple eigenvalue is defective to round-off
}

TEST_CASE("at low Mach number all preconditioned waves are as slow as the flow", "[gas][fast]") {
  for (const double mach : {1e-1, 1e-3, 1e-5}) {
    const double c = 340.0, u = mach * c;
    const auto s = preconditioned_speeds(u, c * c, u * u);
    CHECK(s.fast / -s.slow == Approx((std::sqrt(5.0) + 1) / (std::sqrt(5.0) - 1)).epsilon(0.05));
    CHECK(s.fast < 1.7 * u);
  }
  CHECK(reference_speed_squared(4.0, 1.0, 100.0) == 4.0);
  CHECK(reference_speed_squared(0.0, 1.0, 100.0) == 1.0);
  CHECK(reference_speed_squared(4e4, 1.0, 100.0) == 100.0);
}
