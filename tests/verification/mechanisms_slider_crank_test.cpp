// Slider-crank mechanisms. 2-D: compressor of Haug (1989), as in Leble & Barakos (2016), section 2.3, eq. 1 and Table 2;
// reference series in data/slider_crank_haug.csv (one degree of freedom, DOP853 at 1e-13, split at the dead centres). 3-D: crank,
// ball joint, rod, universal joint, slider, after the spatial slider-crank of Haug (1989), section 12.4, with inertias of our
// choice, against the quadrature of its one degree of freedom.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <fstream>
#include <sstream>

#include "tests/order.hpp"
#include "tests/src/bodies/examples.hpp"

using namespace spindrift;
using namespace spindrift::bodies;
using namespace spindrift::bodies::examples;

namespace {

constexpr int crank = 0, rod_body = 1, slider = 2;

/// Paper eq. 1: resistance of the gas while the slider moves inwards [N].
double gas_force(double x, double speed) {
  if (speed <= 0.0) return 0.0;
  return x <= 5.0 ? -282857.0 / (6.0 - x) + 62857.0 : -11e4 * (1.0 - std::sin(2.0 * pi * (x - 5.25)));
}

System compressor() {
  std::vector<Body> bodies{body("crank", 200, {450, 450, 450}, {0, 0, 0}), body("rod", 35, {35, 35, 35}, {-0.25, 0, 0}),
                           body("slider", 25, {0.02, 0.02, 0.02}, {1.5, 0, 0})};
  bodies[crank].initial.omega = {0, 0, 30};
  const Vector3d z = Vector3d::UnitZ();
  std::vector<Joint> joints{joint("main bearing", JointType::revolute, earth, crank, {0, 0, 0}, z),
                            joint("crank pin", JointType::revolute, crank, rod_body, {-2, 0, 0}, z),
                            joint("slider pin", JointType::revolute, rod_body, slider, {1.5, 0, 0}, z),
                            joint("cylinder", JointType::translational, earth, slider, {1.5, 0, 0}, Vector3d::UnitX())};
  LoadSource gas{"gas",
                 [](double, std::span<const Motion> m, std::span<Wrench> w) {
                   w[slider].force.x() += gas_force(m[slider].position.x(), m[slider].velocity.x());
                 },
                 {}};
  LoadSource torque = point_load_source("torque", {{.body = crank, .moment = {0, 0, 41450}}});
  LoadSource gravity = gravity_source(bodies, 9.81, Vector3d::UnitX());
  return System(bodies, joints, {gravity, gas, torque});
}

struct Row {
  double t, phi, omega, x, v;
};
std::vector<Row> reference_series(double end) {
  std::ifstream file(SPINDRIFT_SOURCE_DIR "/tests/verification/data/slider_crank_haug.csv");
  std::vector<Row> rows;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#' || line[0] == 't') continue;
    for (char& c : line) c = c == ',' ? ' ' : c;
    Row row;
    std::istringstream(line) >> row.t >> row.phi >> row.omega >> row.x >> row.v;
    if (row.t <= end) rows.push_back(row);
  }
  REQUIRE(rows.size() > 10);
  return rows;
}

}  // namespace

TEST_CASE("the slider-crank compressor follows the reference to 1e-6 with a converged step", "[bodies][fast]") {
  System system = compressor();
  const Assembly assembly = system.assemble();
  REQUIRE(assembly.contradiction == "");
  CHECK(assembly.degrees_of_freedom == 1);
  BodiesState state = assembly.state;
  CHECK(state.motions[crank].omega.z() == 30.0);  // at the dead centre the crank is the independent coordinate
  // The force switches (dead centres, valve) fall inside steps, so RK4 converges as the square of the step here: 5e-7 at 2.5e-5
  // s.
  const double step = 1.25e-5;
  for (const Row& row : {Row{0.5, 15.01356241, 27.28268429, 0, 0}, Row{1.0, 26.96741016, 23.32115262, 0, 0},
                         Row{2.0, 51.10894108, 19.28848899, 0, 0}}) {
    run(system, state, step, std::lround(row.t / step) - state.tick);
    INFO("t = " << row.t);
    CHECK(pi + state.joint_angles[0] == Approx(row.phi).margin(1e-6));
    CHECK(state.motions[crank].omega.z() == Approx(row.omega).margin(1e-6));
  }
  CHECK(system.constraint_residual(state, 0.0) < 1e-12);
}

TEST_CASE("the paper's RK4 step of 1 ms keeps the crank within 6e-3 rad/s for a second", "[bodies][fast]") {
  System system = compressor();
  BodiesState state = start(system);
  double worst = 0.0, slowest = 100.0, fastest = 0.0;
  for (const Row& row : reference_series(1.0)) {
    while (double(state.tick) * 1e-3 < row.t - 1e-9) {
      run(system, state, 1e-3, 1);
      slowest = std::min(slowest, state.motions[crank].omega.z());
      fastest = std::max(fastest, state.motions[crank].omega.z());
    }
    worst = std::max(worst, std::abs(state.motions[crank].omega.z() - row.omega));
    CHECK(state.motions[slider].position.x() == Approx(row.x).margin(5e-3));
  }
  CHECK(worst < 6e-3);
  CHECK(slowest > 17.6);  // the range of the reference: 17.684 ... 31.035 rad/s
  CHECK(fastest < 31.1);
}

namespace {

/// The spatial slider-crank as one degree of freedom: everything in closed form from the crank angle.
/// The crank turns about earth x in the y-z plane; the slider runs along x; a universal joint ties the rod to it.
struct Spatial {
  static constexpr double crank_length = 0.08, rod_length = 0.3, gravity = 9.81;
  static constexpr double crank_mass = 0.12, rod_mass = 0.5, slider_mass = 2.0;
  static inline const Vector3d pivot{0.0, 0.1, 0.12};
  static inline const Vector3d crank_inertia{1e-4, 2e-5, 9e-5}, rod_inertia{4e-4, 4e-3, 3e-3}, slider_inertia{1e-4, 1e-4, 1e-4};

  template <class T>
  using Vec = Eigen::Matrix<T, 3, 1>;
  template <class T>
  struct Place {
    Vec<T> pin, slider, rod_axes[3];
  };
  template <class T>
  static Place<T> at(T angle) {
    using std::cos, std::sin, std::sqrt;
    Place<T> p;
    p.pin = pivot.cast<T>() + Vec<T>(T(0), T(crank_length) * cos(angle), T(crank_length) * sin(angle));
    p.slider = Vec<T>(sqrt(T(rod_length * rod_length) - p.pin.y() * p.pin.y() - p.pin.z() * p.pin.z()), T(0), T(0));
    // rod axes: along the rod; along the cross of the universal joint, perpendicular to the rod and to the slider's y; third
    p.rod_axes[0] = (p.slider - p.pin) / T(rod_length);
    const Vec<T> cross(p.rod_axes[0].z(), T(0), -p.rod_axes[0].x());  // rod x (0, -1, 0) turned into the x-z plane
    p.rod_axes[1] = cross / sqrt(cross.x() * cross.x() + cross.z() * cross.z());
    const Vec<T>&a = p.rod_axes[0], &b = p.rod_axes[1];
    p.rod_axes[2] = Vec<T>(a.y() * b.z() - a.z() * b.y(), a.z() * b.x() - a.x() * b.z(), a.x() * b.y() - a.y() * b.x());
    return p;
  }
  /// Twice the kinetic energy at unit crank rate, by complex-step derivatives (exact to round-off).
  static double inertia(double angle) {
    using C = std::complex<double>;
    constexpr double step = 1e-30;
    const Place<C> p = at<C>(C(angle, step));
    const Place<double> now = at<double>(angle);
    const Vector3d pin_rate = p.pin.imag() / step, slider_rate = p.slider.imag() / step;
    Vector3d rod_rate[3];
    for (int k = 0; k < 3; ++k) rod_rate[k] = p.rod_axes[k].imag() / step;
    const Vector3d spin(rod_rate[1].dot(now.rod_axes[2]), rod_rate[2].dot(now.rod_axes[0]), rod_rate[0].dot(now.rod_axes[1]));
    return crank_inertia.x() + crank_mass * 0.25 * crank_length * crank_length + slider_mass * slider_rate.squaredNorm() +
           rod_mass * (0.5 * (pin_rate + slider_rate)).squaredNorm() + spin.dot(rod_inertia.cwiseProduct(spin));
  }
  static double potential(double angle) {
    const Place<double> p = at<double>(angle);
    return gravity * (crank_mass * 0.5 * (p.pin.z() + pivot.z()) + rod_mass * 0.5 * p.pin.z());
  }
  static double rate(double angle, double energy) { return std::sqrt(2.0 * (energy - potential(angle)) / inertia(angle)); }
  /// Time to reach `angle`: integral of 1/rate, composite Gauss-Legendre of five points, 200 panels a turn.
  static double time(double from, double to, double energy) {
    constexpr std::array<double, 5> node{-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831, 0.9061798459386640};
    constexpr std::array<double, 5> weight{0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
                                           0.2369268850561891};
    const int panels = 1 + int((to - from) * 200 / (2 * pi));
    const double half = 0.5 * (to - from) / panels;
    double sum = 0.0;
    for (int k = 0; k < panels; ++k)
      for (std::size_t g = 0; g < 5; ++g) sum += half * weight[g] / rate(from + (2 * k + 1 + node[g]) * half, energy);
    return sum;
  }

  static System system(double angle, double omega) {
    const Place<double> p = at<double>(angle);
    std::vector<Body> bodies{body("crank", crank_mass, crank_inertia, 0.5 * (pivot + p.pin)),
                             body("rod", rod_mass, rod_inertia, 0.5 * (p.pin + p.slider)),
                             body("slider", slider_mass, slider_inertia, p.slider)};
    bodies[0].initial.attitude = Eigen::AngleAxisd(angle, Vector3d::UnitX());
    Eigen::Matrix3d axes;
    axes << p.rod_axes[0], p.rod_axes[1], p.rod_axes[2];
    bodies[1].initial.attitude = Eigen::Quaterniond(axes);
    bodies[0].initial.omega = {omega, 0, 0};
    const Vector3d x = Vector3d::UnitX();
    std::vector<Joint> joints{joint("crank bearing", JointType::revolute, earth, 0, pivot, x),
                              joint("ball", JointType::spherical, 0, 1, p.pin),
                              joint("universal", JointType::universal, 1, 2, p.slider, p.rod_axes[1]),
                              joint("guide", JointType::translational, earth, 2, p.slider, x)};
    joints[2].second_axis = Vector3d::UnitY();
    LoadSource weight = gravity_source(bodies, gravity);
    return System(std::move(bodies), std::move(joints), {weight});
  }
};

}  // namespace

TEST_CASE("the spatial slider-crank agrees with the quadrature of its one degree of freedom", "[bodies][fast]") {
  const double angle = 0.3, omega = 15.0;
  System system = Spatial::system(angle, omega);
  const Assembly assembly = system.assemble();
  REQUIRE(assembly.contradiction == "");
  CHECK(assembly.degrees_of_freedom == 1);
  CHECK(assembly.redundant.empty());
  BodiesState state = assembly.state;
  const double start_rate = state.motions[crank].omega.x();
  const double energy = Spatial::potential(angle) + 0.5 * Spatial::inertia(angle) * start_rate * start_rate;
  CHECK(system.kinetic_energy(state) == Approx(0.5 * Spatial::inertia(angle) * start_rate * start_rate).epsilon(1e-12));
  std::vector<double> h, error;
  for (double step : {1e-3, 5e-4, 2.5e-4}) {
    state = assembly.state;
    run(system, state, step, std::lround(3.0 / step));
    const double now = angle + state.joint_angles[0];
    h.push_back(step);
    error.push_back(std::abs(Spatial::time(angle, now, energy) - 3.0) * Spatial::rate(now, energy));
    CHECK(state.motions[crank].omega.x() == Approx(Spatial::rate(now, energy)).margin(3e-6));
    CHECK(now - angle > 40.0);  // more than seven turns
  }
  CHECK(error.back() < 1e-8);                                  // measured: 2.6e-6, 8.8e-8, 3.1e-9 rad
  CHECK(observed_order(h, error) == Approx(4.8).margin(0.5));  // RK4 shows 4 or better; here the next term still leads
}
