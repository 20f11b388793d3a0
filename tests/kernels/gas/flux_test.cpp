// Laws that every numerical flux obeys over generated states, then what each scheme claims for itself.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "kernels/gas/flux_osher.hpp"
#include "kernels/gas/flux_roe.hpp"
#include "kernels/gas/flux_roe_low_mach.hpp"
#include "kernels/gas/flux_rusanov.hpp"
#include "tests/kernels/gas/states.hpp"

using namespace spindrift;
using namespace spindrift::gas;
using namespace spindrift::gas::testing;

namespace {

constexpr int samples = 300;
const Face<double> along_x{1.0, 0.0, 0.0, 1.0, 0.0};

/// What `flux` becomes when the observer moves by -v: each of mass, momentum and energy as mechanics asks.
Conserved<double> seen_from(const Conserved<double>& flux, const Eigen::Vector3d& v) {
  return {flux.rho, flux.mx + v.x() * flux.rho, flux.my + v.y() * flux.rho, flux.mz + v.z() * flux.rho,
          flux.E + v.x() * flux.mx + v.y() * flux.my + v.z() * flux.mz + 0.5 * v.squaredNorm() * flux.rho};
}

}  // namespace

TEMPLATE_TEST_CASE("every flux of equal states is the physical flux", "[gas][fast]", OsherP, OsherO, Roe, RoeLowMach, Rusanov) {
  for (const IdealGas& gas : {absolute_air(), gauge_air()}) {
    Generator g;
    double worst = 0;
    for (int n = 0; n < samples; ++n) {
      const auto q = g.state(gas);
      const auto f = g.face();
      worst = std::max(worst, difference(TestType{}(gas, q, q, f), physical_flux(gas, q, f), flux_scale(gas, q, q, f)));
    }
    CHECK(worst < 1e-14);
  }
}

TEMPLATE_TEST_CASE("what leaves one cell enters the next", "[gas][fast]", OsherP, OsherO, Roe, RoeLowMach, Rusanov) {
  const IdealGas gas = gauge_air();
  Generator g;
  double worst = 0;
  for (int n = 0; n < samples; ++n) {
    const auto l = g.state(gas), r = g.near(gas, l, 0.5);
    const auto f = g.face();
    worst = std::max(worst,
                     difference(TestType{}(gas, l, r, f), -1.0 * TestType{}(gas, r, l, reversed(f)), flux_scale(gas, l, r, f)));
  }
  CHECK(worst < 1e-13);
}

TEMPLATE_TEST_CASE("a flux turns with the axes", "[gas][fast]", OsherP, OsherO, Roe, RoeLowMach, Rusanov) {
  const IdealGas gas = absolute_air();
  Generator g;
  double worst = 0;
  for (int n = 0; n < samples; ++n) {
    const auto l = g.state(gas), r = g.near(gas, l, 0.5);
    const auto f = g.face();
    const Eigen::Matrix3d R = random_rotation(g);
    worst = std::max(worst, difference(rotated(TestType{}(gas, l, r, f), R),
                                       TestType{}(gas, rotated(l, R), rotated(r, R), rotated(f, R)), flux_scale(gas, l, r, f)));
  }
  CHECK(worst < 1e-12);
}

TEMPLATE_TEST_CASE("a face that moves with the observer sees the same flux", "[gas][fast]", OsherP, OsherO, Roe, RoeLowMach,
                   Rusanov) {
  const IdealGas gas = gauge_air();
  Generator g;
  double worst = 0;
  for (int n = 0; n < samples; ++n) {
    const auto l = g.state(gas), r = g.near(gas, l, 0.5);
    const auto f = g.face();
    const Eigen::Vector3d v = g.between(0, 300) * g.direction();
    auto moving_l = l, moving_r = r;
    moving_l.u += v.x(), moving_l.v += v.y(), moving_l.w += v.z();
    moving_r.u += v.x(), moving_r.v += v.y(), moving_r.w += v.z();
    auto moving_f = f;
    moving_f.speed += v.x() * f.nx + v.y() * f.ny + v.z() * f.nz;
    moving_f.vx += v.x(), moving_f.vy += v.y(), moving_f.vz += v.z();
    const auto expected = seen_from(TestType{}(gas, l, r, f), v);
    worst = std::max(worst, difference(TestType{}(gas, moving_l, moving_r, moving_f), expected,
                                       flux_scale(gas, moving_l, moving_r, moving_f)));
  }
  CHECK(worst < 1e-12);
}

TEMPLATE_TEST_CASE("a flux does not depend on what pressure and temperature are measured from", "[gas][fast]", OsherP, OsherO,
                   Roe, RoeLowMach, Rusanov) {
  const IdealGas absolute = absolute_air(), gauge = gauge_air();
  Generator g;
  double worst = 0;
  for (int n = 0; n < samples; ++n) {
    const auto l = g.state(absolute), r = g.near(absolute, l, 0.5);
    const auto f = g.face();
    const auto shift = [&](Primitive<double> q) {
      return q.p -= gauge.pressure_reference, q.T -= gauge.temperature_reference, q;
    };
    const auto a = TestType{}(absolute, l, r, f);
    auto b = TestType{}(gauge, shift(l), shift(r), f);
    const double push = gauge.pressure_reference * f.area;
    b.mx += push * f.nx, b.my += push * f.ny, b.mz += push * f.nz;
    b.E += push * f.speed + gauge.enthalpy_reference() * b.rho;
    worst = std::max(worst, difference(a, b, flux_scale(gauge, shift(l), shift(r), f)));
  }
  CHECK(worst < 1e-12);
}

TEMPLATE_TEST_CASE("contact-resolving fluxes keep a contact at rest on its moving face", "[gas][fast]", OsherP, OsherO, Roe,
                   RoeLowMach) {
  const IdealGas gas = absolute_air();
  Generator g;
  double worst = 0;
  for (int n = 0; n < samples; ++n) {
    const auto f = g.face();
    auto l = g.state(gas, 0.9);
    const auto slide = g.state(gas, 0.9);
    const auto still = [&](Primitive<double> q) {  // no velocity across the face
      const double un = normal_velocity(q, f) - f.speed;
      return q.u -= un * f.nx, q.v -= un * f.ny, q.w -= un * f.nz, q;
    };
    auto r = slide;
    r.p = l.p;
    l = still(l), r = still(r);
    const auto flux = TestType{}(gas, l, r, f), pressure = Conserved<double>{0.0, f.area * l.p * f.nx, f.area * l.p * f.ny,
                                                                             f.area * l.p * f.nz, f.area * l.p * f.speed};
    worst = std::max(worst, difference(flux, pressure, flux_scale(gas, l, r, f)));
  }
  CHECK(worst < 1e-14);
}

TEMPLATE_TEST_CASE("a moving contact carries its upwind side", "[gas][fast]", OsherP, OsherO, Roe, RoeLowMach) {
  const IdealGas gas = absolute_air();
  const Primitive<double> l{1e5, 60.0, 0.0, 0.0, 300.0}, r{1e5, 60.0, 0.0, 0.0, 500.0};
  const auto flux = TestType{}(gas, l, r, along_x), exact = physical_flux(gas, l, along_x);
  CHECK(difference(flux, exact, flux_scale(gas, l, r, along_x)) < 1e-14);
}

TEMPLATE_TEST_CASE("supersonic flow takes everything from upwind", "[gas][fast]", OsherP, OsherO, Roe, RoeLowMach) {
  const IdealGas gas = gauge_air();
  Generator g;
  double worst = 0;
  for (int n = 0; n < samples; ++n) {
    auto l = g.state(gas, 0.3);
    auto r = g.near(gas, l, 0.15);
    const auto f = g.face();
    const double push = (n % 2 == 0 ? 2.2 : -2.2) * sound_speed(gas, l) + f.speed;
    l.u += push * f.nx, l.v += push * f.ny, l.w += push * f.nz;
    r.u += push * f.nx, r.v += push * f.ny, r.w += push * f.nz;
    worst = std::max(worst,
                     difference(TestType{}(gas, l, r, f), physical_flux(gas, n % 2 == 0 ? l : r, f), flux_scale(gas, l, r, f)));
  }
  CHECK(worst < 1e-13);
}

// A transonic rarefaction with its sonic point on the face: the exact Riemann flux is the sonic one. Osher's flux is that by
// construction; Roe's without its fix lets an expansion shock stand.
TEST_CASE("Osher's flux passes a sonic rarefaction as the exact solution does", "[gas][fast]") {
  const IdealGas gas = absolute_air();
  const double g = 0.5 * (gas.gamma - 1.0);
  const Primitive<double> l{1e5, 150.0, 0.0, 0.0, 300.0};
  const double cl = sound_speed(gas, l), cr = 0.8 * cl;
  const Primitive<double> r{l.p * std::pow(cr / cl, gas.gamma / g), l.u + (cl - cr) / g, 0.0, 0.0, l.T * cr * cr / (cl * cl)};
  REQUIRE(l.u < cl);
  REQUIRE(r.u > cr);
  const double cs = (g * l.u + cl) / (1.0 + g);
  const Primitive<double> sonic{l.p * std::pow(cs / cl, gas.gamma / g), cs, 0.0, 0.0, l.T * cs * cs / (cl * cl)};
  const auto exact = physical_flux(gas, sonic, along_x), scale = flux_scale(gas, l, r, along_x);
  CHECK(difference(OsherP{}(gas, l, r, along_x), exact, scale) < 1e-13);
  CHECK(difference(Roe{.entropy_fix = 0.0}(gas, l, r, along_x), exact, scale) > 1e-3);
}

TEST_CASE("an expansion shock stands with Roe's flux and is broken up by its fix and by Osher's", "[gas][fast]") {
  // States that obey the jump conditions in the order that entropy forbids: equal physical fluxes on both sides.
  const IdealGas gas = absolute_air();
  const double M = 0.8, k = gas.gamma;  // subsonic on the left, supersonic on the right
  const Primitive<double> l{1e5, M * std::sqrt(k * gas.gas_constant * 300.0), 0.0, 0.0, 300.0};
  // Normal shock relations hold both ways.
  const double M2 = M * M, ratio = (2 * k * M2 - (k - 1)) / (k + 1), rho = (k + 1) * M2 / ((k - 1) * M2 + 2);
  const Primitive<double> r{l.p * ratio, l.u / rho, 0.0, 0.0, l.T * ratio / rho};
  const auto scale = flux_scale(gas, l, r, along_x), physical = physical_flux(gas, l, along_x);
  REQUIRE(difference(physical, physical_flux(gas, r, along_x), scale) < 1e-13);
  CHECK(difference(Roe{.entropy_fix = 0.0}(gas, l, r, along_x), physical, scale) < 1e-12);
  CHECK(difference(Roe{.entropy_fix = 0.3}(gas, l, r, along_x), physical, scale) > 1e-3);
  CHECK(difference(OsherP{}(gas, l, r, along_x), physical, scale) > 1e-3);
  CHECK(difference(OsherO{}(gas, l, r, along_x), physical, scale) > 1e-3);
}

TEST_CASE("Osher's flux between close states is Roe's", "[gas][fast]") {
  // To first order in the jump both add |A| times it: the gap falls with its square.
  const IdealGas gas = absolute_air();
  const Primitive<double> l{1e5, 100.0, 20.0, -10.0, 300.0};
  const auto gap = [&](const auto& scheme, double e) {
    const Primitive<double> r{l.p + 2e4 * e, l.u - 60.0 * e, l.v + 30 * e, l.w, l.T + 40.0 * e};
    return difference(scheme(gas, l, r, along_x), Roe{.entropy_fix = 0.0}(gas, l, r, along_x), flux_scale(gas, l, r, along_x));
  };
  CHECK(gap(OsherP{}, 0.05) / gap(OsherP{}, 0.025) > 3.8);
  CHECK(gap(OsherO{}, 0.05) / gap(OsherO{}, 0.025) > 3.8);
}

// The artificial pressure of a jump of normal velocity: rho c dun for Roe (grows as 1/M against rho un^2), rho |u| dun for
// Rieper.
TEST_CASE("low-Mach Roe dissipates in proportion to the flow, Roe to the sound speed", "[gas][fast]") {
  const IdealGas gas = gauge_air();
  std::vector<double> roe, low;
  for (const double mach : {1e-2, 1e-3, 1e-4}) {
    const double U = mach * 340.0;
    const Primitive<double> l{0.0, U, 0.0, 0.0, 0.0}, r{0.0, 0.9 * U, 0.0, 0.0, 0.0};
    const auto excess = [&](const auto& scheme) {
      return (scheme(gas, l, r, along_x).mx - central_flux(gas, l, r, along_x).mx) / (density(gas, l) * U * U);
    };
    roe.push_back(excess(Roe{})), low.push_back(excess(RoeLowMach{}));
  }
  for (int n : {0, 1}) {
    CHECK(roe[n + 1] / roe[n] == Approx(10.0).epsilon(0.03));
    CHECK(low[n + 1] / low[n] == Approx(1.0).epsilon(0.03));
  }
}

TEMPLATE_TEST_CASE("a pressure that varies by 1e-10 of itself keeps six digits of its force", "[gas][fast]", OsherP, OsherO, Roe,
                   RoeLowMach, Rusanov) {
  // Mach 1e-5: everything scales with powers of M, so a flux at M is known from one at 4 M up to O(M).
  const IdealGas gas = gauge_air();
  const auto mean_pressure_force = [&](double M) {
    const double U = M * 340.0, q = density(gas, Primitive<double>{}) * U * U;
    const Primitive<double> l{0.3 * q, 0.0, 0.5 * U, 0.0, 0.0}, r{0.3 * q, 0.0, 0.7 * U, 0.0, 0.0};
    return TestType{}(gas, l, r, along_x).mx / q;
  };
  CHECK(mean_pressure_force(1e-5) == Approx(0.3).epsilon(1e-6));
}

TEMPLATE_TEST_CASE("lanes compute the flux of one number", "[gas][fast]", OsherP, OsherO, Roe, RoeLowMach, Rusanov) {
  using V = Wide<double, 8>;
  const IdealGas gas = gauge_air();
  Generator g;
  double worst = 0;
  for (int n = 0; n < samples / V::size; ++n) {
    double from[15][V::size];
    Primitive<double> l[V::size], r[V::size];
    Face<double> f[V::size];
    for (int k = 0; k < V::size; ++k) {
      l[k] = g.state(gas), r[k] = g.near(gas, l[k], 0.5), f[k] = g.face();
      const double numbers[] = {l[k].p, l[k].u, l[k].v,  l[k].w,  l[k].T,  r[k].p,    r[k].u,    r[k].v,
                                r[k].w, r[k].T, f[k].nx, f[k].ny, f[k].nz, f[k].area, f[k].speed};
      for (int c = 0; c < 15; ++c) from[c][k] = numbers[c];
    }
    const auto lane = [&](int c) { return V::load(from[c]); };
    const auto flux = TestType{}(gas, load_primitive<V>(from[0], V::size), load_primitive<V>(from[5], V::size),
                                 Face<V>{lane(10), lane(11), lane(12), lane(13), lane(14)});
    for (int k = 0; k < V::size; ++k) {
      const Conserved<double> one{flux.rho[k], flux.mx[k], flux.my[k], flux.mz[k], flux.E[k]};
      worst = std::max(worst, difference(one, TestType{}(gas, l[k], r[k], f[k]), flux_scale(gas, l[k], r[k], f[k])));
    }
  }
  CHECK(worst < 1e-14);
}
