// Orders and stability limits of kernels/rigid/integrators.hpp and stability.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/rigid/integrators.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "kernels/rigid/stability.hpp"
#include "tests/order.hpp"

using namespace spindrift;
using std::complex;

namespace {

/// Steps a second-order system x'' = a(t, x, x') of one coordinate; each step in coordinates that start at zero.
template <class Acceleration>
std::pair<double, double> integrate(Integrator integrator, Acceleration a, double x, double v, double h, long steps) {
  IntegratorWork work;
  work.resize(1);
  Eigen::VectorXd u(1);
  u[0] = v;
  for (long n = 0; n < steps; ++n) {
    const auto rates = [&](double t, const Eigen::VectorXd& dx, const Eigen::VectorXd& w, Eigen::VectorXd& x_rate,
                           Eigen::VectorXd& u_rate) {
      x_rate = w;
      u_rate[0] = a(t, x + dx[0], w[0]);
      return true;
    };
    REQUIRE(step(integrator, rates, double(n) * h, h, u, work));
    x += work.x[0];
  }
  return {x, u[0]};
}

/// Growth of the amplitude of x'' = -|lambda|^2 x + 2 Re(lambda) x' over many steps.
double growth(Integrator integrator, complex<double> lambda, double h) {
  const auto [x, v] = integrate(
      integrator, [&](double, double p, double q) { return -std::norm(lambda) * p + 2 * lambda.real() * q; }, 1.0, 0.0, h, 20000);
  return std::hypot(x, v / std::abs(lambda));
}

}  // namespace

TEST_CASE("each integrator shows its order on a damped, forced oscillator", "[rigid][fast]") {
  const auto [integrator, order] = GENERATE(
      table<Integrator, double>({{Integrator::rk4, 4.0}, {Integrator::explicit_euler, 1.0}, {Integrator::symplectic, 2.0}}));
  const auto force = [](double t, double x, double v) {
    return -4.0 * std::sin(x) - 0.7 * v - 0.2 * v * v * v + std::cos(3 * t);
  };
  const double exact = integrate(Integrator::rk4, force, 0.5, 1.0, 1e-4, 10000).first;
  std::vector<double> h, error;
  for (long steps : {20, 40, 80, 160}) {
    h.push_back(1.0 / double(steps));
    error.push_back(std::abs(integrate(integrator, force, 0.5, 1.0, h.back(), steps).first - exact));
  }
  INFO(name(integrator));
  CHECK(observed_order(h, error) == Approx(order).margin(0.25));
}

TEST_CASE("below the stability limit oscillations stay bounded, above it they grow", "[rigid][fast]") {
  const auto integrator = GENERATE(Integrator::rk4, Integrator::explicit_euler, Integrator::symplectic);
  const double ratio = GENERATE(0.0, 0.02, 0.3, 0.8);  // damping ratio
  const complex<double> lambda = 3.0 * complex<double>(-ratio, std::sqrt(1 - ratio * ratio));
  const double limit = stability_limit(integrator, lambda);
  INFO(name(integrator) << ", damping ratio " << ratio << ", limit " << limit);
  if (integrator == Integrator::explicit_euler && ratio == 0.0) {
    CHECK(limit == 0.0);
    CHECK(growth(integrator, lambda, 1e-2) > 1e3);
    return;
  }
  CHECK(growth(integrator, lambda, 0.95 * limit) < 1.5);  // an undamped Verlet orbit breathes by some parts in ten near its limit
  CHECK_FALSE(growth(integrator, lambda, 1.05 * limit) < 2.0);  // lightly damped Euler grows slowly: 8e-5 a step
}

TEST_CASE("the textbook limits come out", "[rigid][fast]") {
  CHECK(stability_limit(Integrator::rk4, {0.0, 2.0}) == Approx(std::sqrt(8.0) / 2.0).epsilon(1e-6));
  CHECK(stability_limit(Integrator::rk4, {-4.0, 0.0}) == Approx(2.785293563405282 / 4.0).epsilon(1e-6));
  CHECK(stability_limit(Integrator::symplectic, {0.0, 4.0}) == Approx(0.5).epsilon(1e-6));
  CHECK(stability_limit(Integrator::explicit_euler, {-4.0, 0.0}) == Approx(0.5));
  CHECK(stability_limit(Integrator::explicit_euler, {-0.1, 2.0}) == Approx(0.2 / 4.01));
  CHECK(stability_limit(Integrator::explicit_euler, {-1e-8, 2.0}) == 0.0);  // round-off is not damping
  CHECK(stability_limit(Integrator::explicit_euler, {0.0, 0.0}) > 1e300);   // a free direction limits nothing
  CHECK(stability_limit(Integrator::rk4, {2.0, 0.0}) > 1e300);              // growth of the system's own
}

TEST_CASE("rk4 sees how stiff what moves is, and loads that set in within a step", "[rigid][fast]") {
  IntegratorWork work;
  work.resize(1);
  const double h = 0.01;
  for (const double z : {0.5, 2.0, 3.0, 10.0}) {  // h omega
    Eigen::VectorXd u(1);
    u[0] = 0.3 * z / h;
    const auto oscillator = [&](double, const Eigen::VectorXd& x, const Eigen::VectorXd& w, Eigen::VectorXd& x_rate,
                                Eigen::VectorXd& u_rate) {
      x_rate = w;
      u_rate[0] = -z * z / (h * h) * (1.0 + x[0]);
      return true;
    };
    REQUIRE(step(Integrator::rk4, oscillator, 0.0, h, u, work));
    CHECK(work.stiffness == Approx(0.25 * z * z));
  }
  // It passes its rest smoothly: no onset, unless the step is a sixth of its period.
  for (const double z : {0.3, 0.6, 1.2}) {
    Eigen::VectorXd u = Eigen::VectorXd::Ones(1);
    const auto oscillator = [&](double, const Eigen::VectorXd& x, const Eigen::VectorXd& w, Eigen::VectorXd& x_rate,
                                Eigen::VectorXd& u_rate) {
      x_rate = w;
      u_rate = -z * z / (h * h) * x;
      return true;
    };
    REQUIRE(step(Integrator::rk4, oscillator, 0.0, h, u, work));
    CHECK(work.onset == Approx(0.25 * std::pow(z, 4)));
  }
  // A line that is slack at the start and taut within the step.
  Eigen::VectorXd u(1);
  u[0] = 3.0;
  const auto line = [&](double, const Eigen::VectorXd& x, const Eigen::VectorXd& w, Eigen::VectorXd& x_rate,
                        Eigen::VectorXd& u_rate) {
    x_rate = w;
    u_rate[0] = 9.81 - 1e5 * std::max(0.0, x[0] - 0.02);
    return true;
  };
  REQUIRE(step(Integrator::rk4, line, 0.0, h, u, work));
  CHECK(work.onset > 0.25);
  u[0] = 3.0;
  REQUIRE(step(Integrator::rk4, line, 0.0, h / 16.0, u, work));
  CHECK(work.onset == 0.0);
}

TEST_CASE("a step that cannot be evaluated stops at once and says so", "[rigid][fast]") {
  const auto integrator = GENERATE(Integrator::rk4, Integrator::explicit_euler, Integrator::symplectic);
  IntegratorWork work;
  work.resize(1);
  Eigen::VectorXd u = Eigen::VectorXd::Ones(1);
  int calls = 0;
  const auto rates = [&](double, const auto&, const auto&, auto&, auto&) { return ++calls < 1; };
  CHECK_FALSE(step(integrator, rates, 0.0, 0.1, u, work));
  CHECK(calls == 1);
  CHECK(integrator_named(name(integrator)) == integrator);
  CHECK_FALSE(integrator_named("leapfrog"));
}
