// Planar mechanisms with redundant constraints (every pin is a spatial revolute joint).
// Andrews' squeezing mechanism: constants and end state at 0.03 s from the Test Set for IVP Solvers (Mazzia & Magherini 2008,
// Univ. Bari, problem "andrews"; Schiehlen 1990; Hairer & Wanner 1996, chapter VII.7). N four-bar windows: IFToMM library of
// computational benchmark problems, A02 (after Bayo & Avello 1994), checked against its one degree of freedom.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/src/bodies/examples.hpp"

using namespace spindrift;
using namespace spindrift::bodies;
using namespace spindrift::bodies::examples;

namespace {

Vector3d along(double length, double angle) { return {length * std::cos(angle), length * std::sin(angle), 0}; }

Body link(std::string name, double mass, double inertia, const Vector3d& centre, double angle) {
  Body b = body(std::move(name), mass, {inertia, inertia, inertia}, centre);
  b.initial.attitude = Eigen::AngleAxisd(angle, Vector3d::UnitZ());
  return b;
}

Joint pin(std::string name, int i, int j, const Vector3d& at) {
  return joint(std::move(name), JointType::revolute, i, j, at, {0, 0, 1});
}

struct Andrews {
  static constexpr double beta = -0.0617138900142764496358948458001, theta = 0.0, gamma = 0.455279819163070380255912382449,
                          phi = 0.222668390165885884674473185609, delta = 0.487364979543842550225598953530, omega = -phi,
                          epsilon = 1.23054744454982119249735015568;
  static constexpr std::array<double, 7> start{beta, theta, gamma, phi, delta, omega, epsilon};
  static constexpr std::array<double, 7> end{15.81077119629904,  -15.75637105984298, 0.04082224013073101, -0.5347301163226948,
                                             0.5244099658805304, 0.5347301163226948, 1.048080741042263};
  static constexpr std::array<double, 7> end_rate{1139.920302151208,  -1424.379294994111, 11.03291221937134, 19.29337464421385,
                                                  0.5735699284790808, -19.29337464421385, 0.3231791658026955};

  static System system() {
    const Vector3d o(0, 0, 0), a(-.06934, -.00227, 0), b(-.03635, .03273, 0), c(.014, .072, 0);
    const double d = .028, da = .0115, e = .02, ea = .01421, rr = .007, ra = .00092, sa = .01874, sb = .01043, sc = .018,
                 sd = .02, ta = .02308, tb = .00916, u = .04, ua = .01228, ub = .00449, zf = .02, zt = .04, fa = .01421;
    const double down = -0.5 * pi;  // (sin x, -cos x) is the direction x - 90 deg
    const Vector3d f = along(rr, beta), ee = f - along(d, beta + theta), h = a + along(zt, delta),
                   g = a + along(u, epsilon + down);
    const Vector3d spring_on_k3 = b + along(sd, gamma) + along(sc, gamma + down);
    std::vector<Body> k{link("K1", .04325, 2.194e-6, along(ra, beta), beta),
                        link("K2", .00365, 4.410e-7, f - along(da, beta + theta), beta + theta),
                        link("K3", .02373, 5.255e-6, b + along(sa, gamma + down) + along(sb, gamma), gamma),
                        link("K4", .00706, 5.667e-7, h + along(e - ea, phi + delta + down), phi + delta),
                        link("K5", .07050, 1.169e-5, a + along(ta, delta) + along(tb, delta + down), delta),
                        link("K6", .00706, 5.667e-7, g + along(zf - fa, omega + epsilon), omega + epsilon),
                        link("K7", .05498, 1.912e-5, a + along(ua, epsilon + down) + along(ub, epsilon), epsilon)};
    const Vector3d on_k3 = k[2].initial.attitude.conjugate() * (spring_on_k3 - k[2].initial.position);
    LoadSource spring{"spring",
                      [c, on_k3](double, std::span<const Motion> m, std::span<Wrench> w) {
                        const Vector3d at = m[2].point(on_k3), pull = at - c;
                        w[2].add_force(-4530.0 * (pull.norm() - .07785) / pull.norm() * pull, at);
                      },
                      {}};
    return System(
        k,
        {// the first seven turn by beta, theta, gamma, phi, delta, omega, epsilon
         pin("O", earth, 0, o), pin("F", 0, 1, f), pin("B", earth, 2, b), pin("H", 4, 3, h), pin("A5", earth, 4, a),
         pin("G", 6, 5, g), pin("A7", earth, 6, a), pin("E2-3", 1, 2, ee), pin("E3-4", 2, 3, ee), pin("E4-6", 3, 5, ee)},
        {spring, point_load_source("motor", {{.body = 0, .moment = {0, 0, .033}}})});
  }
};

/// N windows: uprights 0..N of length 1 at x = 0..N, couplers 0..N-1 on top; all tops start with 1 m/s in +x.
System four_bars(int n) {
  std::vector<Body> bodies;
  std::vector<Joint> joints;
  for (int k = 0; k <= n; ++k) {
    bodies.push_back(link("upright " + std::to_string(k), 1.0, 1.0 / 12, {double(k), 0.5, 0}, 0.0));
    bodies.back().initial.omega = {0, 0, -1};
    bodies.back().initial.velocity = {0.5, 0, 0};
  }
  for (int k = 0; k < n; ++k) {
    bodies.push_back(link("coupler " + std::to_string(k), 1.0, 1.0 / 12, {k + 0.5, 1, 0}, 0.0));
    bodies.back().initial.velocity = {1, 0, 0};
  }
  for (int k = 0; k <= n; ++k) joints.push_back(pin("A" + std::to_string(k), earth, k, {double(k), 0, 0}));
  for (int k = 0; k < n; ++k) {
    joints.push_back(pin("B" + std::to_string(k) + " right", k, n + 1 + k, {double(k), 1, 0}));
    joints.push_back(pin("B" + std::to_string(k + 1) + " left", n + 1 + k, k + 1, {k + 1.0, 1, 0}));
  }
  LoadSource gravity = gravity_source(bodies, 9.81, -Vector3d::UnitY());
  return System(std::move(bodies), std::move(joints), {gravity});
}

/// Angle from the vertical of the same windows as one degree of freedom, by RK4 at 1e-5 s.
double four_bar_angle(int n, double end) {
  const double inertia = (n + 1) / 3.0 + n, weight = 9.81 * ((n + 1) / 2.0 + n);
  const auto rate = [&](double angle) { return weight / inertia * std::sin(angle); };
  double x = 0.0, v = 1.0;
  const long steps = std::lround(end / 1e-5);
  const double h = end / double(steps);
  for (long k = 0; k < steps; ++k) {
    const double a1 = rate(x), a2 = rate(x + h / 2 * v), a3 = rate(x + h / 2 * v + h * h / 4 * a1),
                 a4 = rate(x + h * v + h * h / 2 * a2);
    x += h * v + h * h / 6 * (a1 + a2 + a3);
    v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  return x;
}

}  // namespace

TEST_CASE("Andrews' squeezing mechanism ends where the test set publishes, its ten pins redundant", "[bodies][fast]") {
  System system = Andrews::system();
  const Assembly assembly = system.assemble();
  REQUIRE(assembly.contradiction == "");
  CHECK(assembly.degrees_of_freedom == 1);
  CHECK(assembly.redundant.size() > 0);  // 50 conditions for 41 to take away
  BodiesState state = assembly.state;
  const double step = 1e-5;
  run(system, state, step, std::lround(0.03 / step));
  for (std::size_t k = 0; k < 7; ++k) {
    INFO("angle " << k);
    CHECK(Andrews::start[k] + state.joint_angles[k] == Approx(Andrews::end[k]).margin(1e-8));  // measured: 1.7e-9
  }
  const auto spin = [&](int b) { return state.motions[std::size_t(b)].omega.z(); };
  const std::array<double, 7> rates{spin(0), spin(1) - spin(0), spin(2), spin(3) - spin(4), spin(4), spin(5) - spin(6), spin(6)};
  for (std::size_t k = 0; k < 7; ++k) CHECK(rates[k] == Approx(Andrews::end_rate[k]).epsilon(1e-8).margin(1e-6));
  CHECK(system.constraint_residual(state, 0.0) < 1e-12);
}

TEST_CASE("N four-bar windows pass their singular positions on the right branch", "[bodies][fast]") {
  const int n = GENERATE(2, 3, 5, 8);
  System system = four_bars(n);
  BodiesState state = start(system);
  const double step = 5e-3;
  run(system, state, step, 400);  // a little more than one turn: both singular positions, all links in line
  INFO("N = " << n);
  CHECK(-state.joint_angles[0] == Approx(four_bar_angle(n, 2.0)).margin(1e-5));
  CHECK(system.constraint_residual(state, 0.0) < 1e-12);
}

TEST_CASE("forty four-bar windows turn through their singular positions", "[bodies][nightly]") {
  const int n = GENERATE(20, 40);
  System system = four_bars(n);
  BodiesState state = start(system);
  run(system, state, 1e-2, 200);
  CHECK(-state.joint_angles[0] == Approx(four_bar_angle(n, 2.0)).margin(1e-4));
  CHECK(system.constraint_residual(state, 0.0) < 1e-12);
}
