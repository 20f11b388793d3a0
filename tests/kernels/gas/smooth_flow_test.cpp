// What reconstruction and flux are worth together on flows with exact solutions: the isentropic vortex (order), Gresho's vortex
// (Gresho & Chan 1990, Int. J. Numer. Meth. Fluids 11, 621; low Mach number).
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "kernels/gas/flux_osher.hpp"
#include "kernels/gas/flux_roe.hpp"
#include "kernels/gas/flux_roe_low_mach.hpp"
#include "kernels/gas/flux_rusanov.hpp"
#include "tests/kernels/gas/periodic_flow.hpp"
#include "tests/order.hpp"

using namespace spindrift;
using namespace spindrift::gas;
using namespace spindrift::gas::testing;

namespace {

/// Vortex of Shu (1998), strength 5, in a stream of Mach 0.5 along the diagonal; lengths in core radii, gas in units of the
/// stream.
struct IsentropicVortex {
  static constexpr double size = 10.0, strength = 5.0, mach = 0.5;
  IdealGas gas{.gamma = 1.4, .gas_constant = 1.0};
  double stream = mach * std::sqrt(1.4) / std::sqrt(2.0);  // each component; T = 1, p = 1
  Primitive<double> at(double x, double y, double t) const {
    const auto from_centre = [&](double a) {
      return a - stream * t - 0.5 * size - size * std::round((a - stream * t - 0.5 * size) / size);
    };
    const double dx = from_centre(x), dy = from_centre(y), r2 = dx * dx + dy * dy;
    const double swirl = strength / (2 * M_PI) * std::exp(0.5 * (1.0 - r2));
    const double T = 1.0 - (gas.gamma - 1.0) / (2.0 * gas.gamma) * swirl * swirl;
    return {std::pow(T, gas.gamma / (gas.gamma - 1.0)), stream - swirl * dy, stream + swirl * dx, 0.0, T};
  }
};

template <class Scheme, class Limiter>
double vortex_order(const Scheme& scheme, const Limiter& limiter) {
  const IsentropicVortex vortex;
  const double end = 1.0;
  std::vector<double> h, error;
  for (const int n : {40, 80, 128}) {
    PeriodicFlow flow(vortex.gas, n, vortex.size);
    flow.start([&](double x, double y) { return vortex.at(x, y, 0.0); });
    const int steps = int(std::ceil(end / (0.35 * flow.cell() / 2.5)));
    for (int s = 0; s < steps; ++s) flow.step(scheme, limiter, end / steps);
    h.push_back(flow.cell());
    error.push_back(flow.error(1, [&](double x, double y) { return vortex.at(x, y, end); }));
  }
  INFO("errors " << error[0] << " " << error[1] << " " << error[2]);
  return observed_order(h, error);
}

/// Gresho's vortex of radius 0.4 in a square of 1 m, largest speed 1 m/s, at `mach`.
struct Gresho {
  IdealGas gas;
  explicit Gresho(double mach) {
    gas.gas_constant = 1.0;
    gas.pressure_reference = 1.0 / (1.4 * mach * mach);  // density 1
    gas.temperature_reference = gas.pressure_reference;
  }
  Primitive<double> at(double x, double y) const {
    const double dx = x - 0.5, dy = y - 0.5, r = std::sqrt(dx * dx + dy * dy);
    double speed = 0.0, p = -2.0 + 4.0 * std::log(2.0);
    if (r < 0.2)
      speed = 5.0 * r, p = 12.5 * r * r;
    else if (r < 0.4)
      speed = 2.0 - 5.0 * r, p = 12.5 * r * r + 4.0 * (1.0 - 5.0 * r - std::log(0.2) + std::log(r));
    // Density 1 everywhere: the temperature follows the pressure.
    return {p, -speed * dy / r, speed * dx / r, 0.0, p};
  }
};

/// Share of the kinetic energy left after one turn of the fastest circle, on 80 x 80 cells; and the even-odd part of the
/// pressure.
struct Turn {
  double energy, sawtooth;
};
template <class Scheme>
Turn turned_once(const Scheme& scheme, double mach, double turns = 1.0) {
  const Gresho gresho(mach);
  PeriodicFlow flow(gresho.gas, 80, 1.0);
  flow.start([&](double x, double y) { return gresho.at(x, y); });
  const double before = flow.kinetic_energy(), end = 2 * M_PI * 0.2 * turns;
  const int steps = int(std::ceil(end / (0.4 * flow.cell() / (1.0 / mach + 1.0))));
  for (int s = 0; s < steps; ++s) flow.step(scheme, Unlimited{}, end / steps);
  double sawtooth = 0;  // mean of what alternates from cell to cell, of the pressure's range (0.77 rho u^2)
  for (int j = 0; j < 80; ++j)
    for (int i = 1; i < 79; ++i)
      sawtooth +=
          std::abs(flow.at(j, i - 1).p - 3 * flow.at(j, i).p + 3 * flow.at(j, i + 1).p - flow.at(j, (i + 2) % 80).p) / 8.0;
  return {flow.kinetic_energy() / before, sawtooth / (80 * 78) / 0.77};
}

}  // namespace

TEMPLATE_TEST_CASE("the isentropic vortex converges at second order without limiter", "[gas][fast][order]", OsherP, OsherO, Roe,
                   RoeLowMach, Rusanov) {
  CHECK(vortex_order(TestType{}, Unlimited{}) > 1.9);
}
TEMPLATE_TEST_CASE("the mean error of the isentropic vortex is of second order with van Albada's and van Leer's limiters too",
                   "[gas][fast][order]", VanAlbada, VanLeer) {
  CHECK(vortex_order(OsherP{}, TestType{}) > 1.9);
}

TEST_CASE("Gresho's vortex turns once on 80 x 80 cells with most of its energy", "[gas][fast]") {
  const Turn low = turned_once(RoeLowMach{}, 0.1), roe = turned_once(Roe{}, 0.1);
  INFO("low-Mach Roe " << low.energy << " " << low.sawtooth << ", Roe " << roe.energy << " " << roe.sawtooth);
  CHECK(low.energy > 0.95);
  CHECK(low.energy < 1.0);
  CHECK(low.energy > roe.energy);
  CHECK(low.sawtooth < 0.005);
}

// A quarter of a turn: the explicit steps of Mach 0.01 are many.
TEST_CASE("what Gresho's vortex keeps does not depend on the Mach number with low-Mach Roe, with Roe it does", "[gas][nightly]") {
  const Turn at_1e1 = turned_once(RoeLowMach{}, 0.1, 0.25), at_1e2 = turned_once(RoeLowMach{}, 0.01, 0.25),
             roe = turned_once(Roe{}, 0.01, 0.25);
  INFO("low-Mach Roe " << at_1e1.energy << " " << at_1e2.energy << ", sawtooth " << at_1e2.sawtooth << ", Roe " << roe.energy);
  CHECK(at_1e2.energy == Approx(at_1e1.energy).margin(0.001));
  CHECK(at_1e2.sawtooth < 0.005);
  CHECK(roe.energy < at_1e2.energy - 0.005);
}
