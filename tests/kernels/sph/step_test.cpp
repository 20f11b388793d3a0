// Orders of the SPH time steps on an oscillator, and the limits on the step.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include <vector>

#include "kernels/base/constants.hpp"
#include "kernels/sph/step_symplectic.hpp"
#include "kernels/sph/step_verlet.hpp"
#include "kernels/sph/time_step.hpp"

using spindrift::pi;
using namespace spindrift::sph;

namespace {

double symplectic_error(int steps) {
  const double dt = 2.0 / steps;
  double x = 1.0, v = 0.0;
  for (int n = 0; n < steps; ++n) {
    const double x_half = StepSymplectic::half(x, v, dt), v_new = StepSymplectic::velocity(v, -x_half, dt);
    x = StepSymplectic::position(x, v, v_new, dt);
    v = v_new;
  }
  return std::hypot(x - std::cos(2.0), v + std::sin(2.0));
}

double verlet_error(int steps) {
  const double dt = 2.0 / steps;
  double x = 1.0, v = 0.0, v_before = std::sin(dt);  // v(-dt)
  for (int n = 0; n < steps; ++n) {
    const double a = -x, v_new = StepVerlet::leap(v_before, a, dt);
    x = StepVerlet::position(x, v, a, dt);
    v_before = v, v = v_new;
  }
  return std::hypot(x - std::cos(2.0), v + std::sin(2.0));
}

}  // namespace

TEST_CASE("the symplectic and the Verlet step are of second order", "[sph][fast][order]") {
  CHECK(std::log2(symplectic_error(100) / symplectic_error(200)) == Approx(2.0).margin(0.1));
  CHECK(std::log2(verlet_error(100) / verlet_error(200)) == Approx(2.0).margin(0.1));
}

TEST_CASE("the symplectic density step is that of exponential growth to second order", "[sph][fast][order]") {
  const auto error = [](int steps) {  // d rho/dt = rate * rho
    const double dt = 1.0 / steps, rho0 = 1000.0, rate = 0.3;
    double d = 0.0;
    for (int n = 0; n < steps; ++n) {
      const double d_half = StepSymplectic::half(d, rate * (rho0 + d), dt);
      d = StepSymplectic::deviation(d, d_half, rate * (rho0 + d_half), dt, rho0);
    }
    return std::abs(d - rho0 * std::expm1(rate));
  };
  CHECK(std::log2(error(20) / error(40)) == Approx(2.0).margin(0.1));
}

TEST_CASE("velocity and density that push each other keep their energy, whatever the step", "[sph][fast][order]") {
  struct State {
    double v = 0.0, rho = 1.0;  // v' = -omega rho, rho' = omega v
  };
  const auto after = [](State s, int steps, double omega_dt, double courant) {
    for (int n = 0; n < steps; ++n) {
      const double v_half = StepSymplectic::velocity_half(s.v, -omega_dt * s.rho, 1.0, courant);
      const double rho_half = StepSymplectic::half(s.rho, omega_dt * s.v, 1.0);
      s = {StepSymplectic::velocity(s.v, -omega_dt * rho_half, 1.0), s.rho + omega_dt * v_half};
    }
    return s;
  };
  const auto energy = [](State s) { return s.v * s.v + s.rho * s.rho; };
  for (const double courant : {0.05, 0.1, 0.2, 0.3, 0.4})
    for (const double faster : {0.5, 1.2, 1.7}) CHECK(energy(after({}, 10000, faster * courant, courant)) < 1.0);
  CHECK(energy(after({}, 10000, 0.24, 0.0)) > 100.0);  // in the very middle it grows
  // A wave of the sea: 3,000 steps a period.
  CHECK(energy(after({}, 3000, 2.0 * pi / 3000, 0.2)) == Approx(1.0).epsilon(1e-3));
  const auto error = [&](int steps) {
    const State s = after({}, steps, 2.0 / steps, 2.0 / steps);
    return std::hypot(s.v + std::sin(2.0), s.rho - std::cos(2.0));
  };
  CHECK(std::log2(error(100) / error(200)) == Approx(2.0).margin(0.1));
}

TEST_CASE("the symplectic step is bounded just inside its limit omega dt = 2 and grows just outside", "[sph][fast]") {
  const auto farthest = [](double dt) {
    double x = 1.0, v = 0.0, far = 0.0;
    for (int n = 0; n < 2000; ++n) {
      const double v_new = StepSymplectic::velocity(v, -StepSymplectic::half(x, v, dt), dt);
      x = StepSymplectic::position(x, v, v_new, dt);
      v = v_new;
      far = std::max(far, std::abs(x));
    }
    return far;
  };
  CHECK(farthest(0.99 * 2.0) < 20.0);
  CHECK(farthest(1.01 * 2.0) > 1e6);
}

TEST_CASE("step limits are those of sound, force and viscosity", "[sph][fast]") {
  const StepLimits limits = step_limits(0.2, 0.01, 34.0, 1.0, 100.0, 1e-3);
  CHECK(limits.acoustic == Approx(0.2 * 0.01 / 35.0));
  CHECK(limits.force == Approx(0.2 * 0.01));
  CHECK(limits.viscous == Approx(0.125 * 1e-4 / 1e-3));
  CHECK(limits.smallest() == limits.acoustic);
  CHECK(std::string(limits.name()) == "acoustic");
  StepLimits light = limits;
  light.body = step_limit_body(0.01, 1.0, 0.01, 34.0);  // a sheet of cork: omega = c0/(d sqrt(w n))
  CHECK(light.body == Approx(2.0 * 0.1 * 0.01 / 34.0));
  light.body *= 0.1;
  CHECK(std::string(light.name()) == "light body");
  CHECK(light.smallest() == light.body);
  CHECK(step_limits(0.2, 0.01, 34.0, 1.0, 0.0, 0.0).force > 1e300);
  CHECK(step_limits(0.2, 0.01, 34.0, 1e150, 1e150, 0.0).smallest() < 1e-70);
}
