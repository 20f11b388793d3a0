// Jacobians against finite differences, and the frozen ones against the exact ones.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/gas/jacobians.hpp"

#include <catch2/catch.hpp>

#include "tests/kernels/gas/states.hpp"

using namespace spindrift;
using namespace spindrift::gas;
using namespace spindrift::gas::testing;

namespace {

double& component(Primitive<double>& q, int n) { return *(&q.p + n); }
double component(const Conserved<double>& c, int n) { return *(&c.rho + n); }

/// A step of each variable that is the same fraction of the thermodynamic state.
Primitive<double> steps(const IdealGas& gas, const Primitive<double>& q, double fraction) {
  const double c = fraction * sound_speed(gas, q);
  return {fraction * absolute_pressure(gas, q), c, c, c, fraction * absolute_temperature(gas, q)};
}

/// Largest difference of J and central differences of f at q (fourth order), in steps of 1e-3 of the thermodynamic state and
/// relative to what that changes of a flux of size `scale`.
template <class Function>
double error(const Block5<double>& J, const IdealGas& gas, const Function& f, const Primitive<double>& q,
             const Conserved<double>& scale) {
  const double fraction = 1e-3;
  auto h = steps(gas, q, fraction);
  double worst = 0;
  for (int row = 0; row < 5; ++row)
    for (int column = 0; column < 5; ++column) {
      const auto at = [&](double factor) {
        auto moved = q;
        component(moved, column) += factor * component(h, column);
        return component(f(moved), row);
      };
      const double slope = (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / 12.0;
      worst = std::max(worst, std::abs(slope - J.m[row][column] * component(h, column)) / (fraction * component(scale, row)));
    }
  return worst;
}

/// Largest difference of two Jacobians on the same scale.
double error(const Block5<double>& J, const Block5<double>& exact, const IdealGas& gas, const Primitive<double>& q,
             const Conserved<double>& scale) {
  auto h = steps(gas, q, 1.0);
  double worst = 0;
  for (int row = 0; row < 5; ++row)
    for (int column = 0; column < 5; ++column)
      worst = std::max(worst, std::abs((exact.m[row][column] - J.m[row][column]) * component(h, column)) / component(scale, row));
  return worst;
}

}  // namespace

TEST_CASE("the Jacobian of the physical flux agrees with finite differences", "[gas][fast]") {
  const IdealGas gas = gauge_air();
  Generator g;
  double worst = 0, with_diagonal = 0;
  for (int n = 0; n < 200; ++n) {
    const auto q = g.state(gas);
    const auto f = g.face();
    worst = std::max(worst, error(
                                physical_jacobian(gas, q, f), gas, [&](const auto& x) { return physical_flux(gas, x, f); }, q,
                                flux_scale(gas, q, q, f)));
    const double s = g.between(-500, 500);
    const auto damped = [&](const auto& x) { return 0.5 * physical_flux(gas, x, f) + s * conserved(gas, x); };
    with_diagonal =
        std::max(with_diagonal, error(physical_jacobian(gas, q, f, 0.5, s), gas, damped, q, flux_scale(gas, q, q, f)));
  }
  CHECK(worst < 1e-9);
  CHECK(with_diagonal < 1e-9);
}

// Away from states where a wave's speed changes sign the flux is smooth and both must agree.
TEMPLATE_TEST_CASE("exact Jacobians agree with finite differences of the flux", "[gas][fast]", OsherP, OsherO, Roe, RoeLowMach,
                   Rusanov) {
  const IdealGas gas = gauge_air();
  Generator g;
  double worst = 0;
  int checked = 0;
  for (int n = 0; n < 300; ++n) {
    const auto f = g.face();
    auto l = g.state(gas, 0.0);
    const double un = f.speed + g.between(-2.0, 2.0) * sound_speed(gas, l);
    l.u += un * f.nx + g.between(10, 50), l.v += un * f.ny, l.w += un * f.nz;
    const auto r = g.near(gas, l, 0.08);
    // Roe's and Rusanov's |u -+ c| and |u| bend at zero, and the rounding of the acoustic ones at its width.
    const double mach = std::abs(normal_velocity(l, f) - f.speed) / sound_speed(gas, l);
    if (mach < 0.2 || std::abs(mach - 1.0) < 0.4) continue;
    // Rusanov's speed changes sides where both are equal.
    const auto speed = [&](const auto& q) { return rusanov_speed(gas, q, q, f); };
    if (std::abs(speed(l) - speed(r)) < 0.02 * speed(l)) continue;
    ++checked;
    const auto scale = flux_scale(gas, l, r, f);
    const auto J = exact_jacobian(TestType{}, gas, l, r, f);
    worst = std::max(worst, error(
                                J.left, gas, [&](const auto& x) { return TestType{}(gas, x, r, f); }, l, scale));
    worst = std::max(worst, error(
                                J.right, gas, [&](const auto& x) { return TestType{}(gas, l, x, f); }, r, scale));
  }
  CHECK(checked > 40);
  CHECK(worst < 1e-6);
}

TEMPLATE_TEST_CASE("frozen Jacobians are exact between equal states and off by the jump otherwise", "[gas][fast]", OsherP, OsherO,
                   Roe, RoeLowMach, Rusanov) {
  const IdealGas gas = gauge_air();
  Generator g;
  double equal = 0, gap_1 = 0, gap_2 = 0;
  for (int n = 0; n < 200; ++n) {
    const auto f = g.face();
    auto l = g.state(gas, 0.0);
    const double un = f.speed + 0.5 * sound_speed(gas, l);
    l.u += un * f.nx, l.v += un * f.ny, l.w += un * f.nz;
    const double slide = 0.3 * sound_speed(gas, l);  // the low-Mach scaling has no slope where nothing slides
    l.u += slide * f.ny, l.v -= slide * f.nx;
    const auto gap = [&](const Primitive<double>& r) {
      const auto exact = exact_jacobian(TestType{}, gas, l, r, f), frozen = flux_jacobian(TestType{}, gas, l, r, f);
      const auto scale = flux_scale(gas, l, r, f);
      return std::max(error(frozen.left, exact.left, gas, l, scale), error(frozen.right, exact.right, gas, l, scale));
    };
    equal = std::max(equal, gap(l));
    const auto r = g.near(gas, l, 0.02);
    gap_1 = std::max(gap_1, gap(r));
    gap_2 = std::max(gap_2, gap(l + 0.5 * (r - l)));
  }
  CHECK(equal < 1e-12);
  CHECK(gap_2 < 0.6 * gap_1);
  CHECK(gap_1 < 0.1);
}

TEST_CASE("the matrix of a frozen dissipation is the dissipation", "[gas][fast]") {
  const IdealGas gas = gauge_air();
  Generator g;
  double worst = 0;
  for (int n = 0; n < 200; ++n) {
    const auto l = g.state(gas), r = g.near(gas, l, 0.5);
    const auto f = g.face();
    const auto m = roe_mean(gas, l, r, f);
    const double slow = g.between(0, 300), middle = g.between(0, 300), fast = g.between(0, 300), scale = g.between(0, 1);
    const auto D = dissipation_jacobian(gas, m, f, slow, middle, fast, scale);
    auto d = r - l;
    Conserved<double> product{};
    for (int row = 0; row < 5; ++row)
      for (int column = 0; column < 5; ++column) *(&product.rho + row) += D.m[row][column] * component(d, column);
    worst = std::max(worst,
                     difference(product, wave_dissipation(gas, m, l, r, f, slow, middle, fast, scale), flux_scale(gas, l, r, f)));
  }
  CHECK(worst < 1e-13);
}

TEST_CASE("the thin-layer Jacobian agrees with finite differences of the viscous flux", "[gas][fast]") {
  const IdealGas gas = gauge_air();
  Generator g;
  double worst = 0;
  for (int n = 0; n < 100; ++n) {
    const auto l = g.state(gas, 0.5), r = g.near(gas, l, 0.1), m = g.state(gas, 0.5);
    const auto f = g.face();
    const Eigen::Vector3d d = 0.01 * (Eigen::Vector3d(f.nx, f.ny, f.nz) + 0.5 * g.direction());
    const auto line = face_line(Vector<double>{d.x(), d.y(), d.z()}, f);
    const auto t = transport(gas, 1.8e-5, g.between(0.0, 1e-2));
    const auto flux = [&](const Primitive<double>& x) {
      return viscous_flux(t, thin_layer_gradients(l, x, line), m.u, m.v, m.w, f);
    };
    auto J = thin_layer_jacobian(t, line, m.u, m.v, m.w, f);
    const auto h = steps(gas, r, 1e-3);
    for (int row = 1; row < 5; ++row)
      for (int column = 0; column < 5; ++column) {
        auto high = r, low = r, step = h;
        component(high, column) += component(step, column), component(low, column) -= component(step, column);
        const double slope = component(flux(high), row) - component(flux(low), row),
                     size = std::abs(component(flux(r + h), row)) + std::abs(component(flux(r), row));
        worst = std::max(worst, std::abs(slope - 2.0 * J.m[row][column] * component(step, column)) / size);
      }
  }
  CHECK(worst < 1e-9);
}
