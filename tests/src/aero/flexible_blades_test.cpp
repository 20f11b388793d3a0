// Blades that bend, of the DTU 10 MW turbine and of made ones with exact answers. SPDX-License-Identifier: Apache-2.0
#include "src/aero/flexible_blades.hpp"

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <cmath>

#include "kernels/base/constants.hpp"
#include "src/aero/rotor_loads.hpp"
#include "src/scene/error.hpp"
#include "tests/src/aero/data_file.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using Catch::Matchers::Contains;
using Eigen::Vector3d;
using Vector6 = Eigen::Matrix<double, 6, 1>;

namespace {

const Vector3d downwind = Vector3d::UnitX(), up = Vector3d::UnitZ(), weight(0, 0, -9.81);
const std::string turbine_file = SPINDRIFT_SOURCE_DIR "/inputs/turbines/dtu_10mw.toml",
                  structure_file = SPINDRIFT_SOURCE_DIR "/inputs/turbines/dtu_10mw/blade_structure.csv";
const Turbine& dtu() {
  static const Turbine turbine = read_turbine(turbine_file);
  return turbine;
}
const FlexibleBlades& dtu_blades() {
  static const FlexibleBlades blades(dtu(), read_blade_structure(dtu(), structure_file), std::vector{.005, .005, .005});
  return blades;
}
/// Straight and uniform, without cone, of the length of the DTU's.
FlexibleBlades uniform_blades(double mass, double flap, double edge, int count = 3) {
  Turbine t = dtu();
  t.precone = 0.0, t.blades = count;
  std::ranges::fill(t.planform.prebend, 0.0);
  const std::vector<double> span{t.hub_radius, t.planform.span.back()};
  return {t, {{span, {mass, mass}}, {flap, flap}, {edge, edge}, {0.0, 0.0}}, std::vector{0.0, 0.0, 0.0}};
}
DiscMotion standing(double azimuth = 0.0, double pitch = 0.0) {
  return {Vector3d::Zero(), Vector3d::Zero(), downwind, up, azimuth, pitch};
}

}  // namespace

TEST_CASE("the DTU 10 MW blade has the frequencies of its report", "[aero][fast]") {
  // Bak et al. 2013, DTU Wind Energy Report-I-0092, table of the isolated blade: 0.61, 0.93, 1.74 Hz.
  const auto& omega = dtu_blades().omega();
  CHECK(omega[0] / (2.0 * pi) == Approx(.61).epsilon(.02));
  CHECK(omega[1] / (2.0 * pi) == Approx(.93).epsilon(.04));  // shear, left out here, makes it slower
  CHECK(omega[2] / (2.0 * pi) == Approx(1.74).epsilon(.04));
  CHECK(dtu_blades().mass() == Approx(41722.0).epsilon(.005));
  CHECK(dtu_blades().omega_turning(1.005)[0] > 1.03 * omega[0]);  // rated speed stiffens the flap
}

TEST_CASE("as many blades as a turbine may have bend each for itself", "[aero][fast]") {
  const FlexibleBlades blades = uniform_blades(400.0, 5e9, 9e9, most_blades);
  FlexibleBlades::Bending bending;
  blades.settle(standing(), {Vector3d::Zero(), Vector3d::Zero(), weight}, std::vector<double>(3 * most_blades), bending);
  std::ranges::fill(bending.rates, 7.0);
  bending.amplitude(most_blades - 1).setConstant(5.0);
  CHECK(std::ranges::all_of(bending.rates, [](double rate) { return rate == 7.0; }));
  for (int b = 2; b < most_blades / 2; ++b)  // left and right hang alike
    CHECK(bending.amplitude(b)[1] == Approx(-bending.amplitude(most_blades - b)[1]).margin(1e-6));
}

TEST_CASE("a level blade hangs by its weight as a cantilever does", "[aero][fast]") {
  const double mass = 400.0, flap = 5e9, edge = 9e9, length = dtu().planform.span.back() - dtu().hub_radius;
  const FlexibleBlades blades = uniform_blades(mass, flap, edge, 1);
  const DiscMotion level = standing(-0.5 * pi);  // its way ahead is up
  FlexibleBlades::Bending bending;
  blades.settle(level, {Vector3d::Zero(), Vector3d::Zero(), weight}, std::vector(3, 0.0), bending);
  const Eigen::Vector2d tip = blades.tip(level, 0, bending);
  const double exact = mass * 9.81 * std::pow(length, 4) / (8.0 * edge);
  CHECK(tip.y() == Approx(-exact).epsilon(.02));  // one mode of the static shape
  CHECK(std::abs(tip.x()) < 1e-9 * exact);
  // Feathered, it bends flapwise.
  const DiscMotion feathered = standing(-0.5 * pi, 0.5 * pi);
  blades.settle(feathered, {Vector3d::Zero(), Vector3d::Zero(), weight}, std::vector(3, 0.0), bending);
  CHECK(blades.tip(feathered, 0, bending).y() == Approx(-exact * edge / flap).epsilon(.02));
  CHECK(blades.sag(9.81) == Approx(exact * edge / flap).epsilon(.02));  // the softer way
}

TEST_CASE("a rotor that falls freely does not bend and does not hold its hub", "[aero][fast]") {
  const DiscMotion rotor = standing(0.4);
  const HubField field{Vector3d::Zero(), Vector3d::Zero(), weight};
  const FlexibleBlades::Bending straight{};
  const std::vector<double> no_air(9, 0.0);
  Vector6 fall;
  fall << weight, Vector3d::Zero();
  const Vector6 load = dtu_blades().reaction(rotor, field, straight, no_air) - dtu_blades().added_mass(rotor) * fall;
  CHECK(load.norm() < 1e-9 * dtu_blades().mass() * 9.81);
  for (int b = 0; b < 3; ++b)
    for (const MassMotion& m : dtu_blades().mass_motions(rotor, b, field, fall, straight, no_air))
      CHECK(m.acceleration.norm() < 1e-9);
}

TEST_CASE("hub and blades swing at the frequencies of the whole, and lose no more than the step makes", "[aero][fast]") {
  // A hub on a spring along the axis, its mass with that of the blades; no air, no turning. Exact: three modes of each blade and
  // the hub, by their mass and stiffness matrices.
  const FlexibleBlades blades = uniform_blades(400.0, 5e9, 9e9, 3);
  const double mass = 6.0 * blades.mass(), stiffness = 9.0 * mass;
  const DiscMotion rotor = standing();
  const HubField field{Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()};
  const std::vector<double> no_air(9, 0.0);
  Eigen::Matrix<double, 10, 10> m = Eigen::Matrix<double, 10, 10>::Identity(), k = m;
  m(0, 0) = mass, k(0, 0) = stiffness;
  for (int b = 0; b < 3; ++b) {
    m.block<1, 3>(0, 1 + 3 * b) = blades.participation(blades.axes(rotor, b)).row(0);
    m.block<3, 1>(1 + 3 * b, 0) = m.block<1, 3>(0, 1 + 3 * b).transpose();
    for (int i = 0; i < 3; ++i) k(1 + 3 * b + i, 1 + 3 * b + i) = std::pow(blades.omega()[std::size_t(i)], 2);
  }
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix<double, 10, 10>> exact(k, m);
  const auto swing = [&](double h, double end) {
    double x = 1.0, v = 0.0;
    std::vector<double> memory(blades.memory_size());
    blades.begin(0.0, rotor, field, {}, no_air, memory);
    const double with = blades.added_mass(rotor)(0, 0);
    const auto acceleration = [&](double t, double at) {
      return (-stiffness * at + blades.reaction(rotor, field, blades.predicted(memory, t), no_air)[0]) / (mass + with);
    };
    for (int n = 0; n < int(std::lround(end / h)); ++n) {
      const double t = n * h;
      const double v1 = acceleration(t, x), v2 = acceleration(t + h / 2, x + h / 2 * v),
                   v3 = acceleration(t + h / 2, x + h / 2 * (v + h / 2 * v1)), v4 = acceleration(t + h, x + h * (v + h / 2 * v2));
      x += h * (v + h / 6 * (v1 + v2 + v3)), v += h / 6 * (v1 + 2 * v2 + 2 * v3 + v4);
      DiscMotion moving = rotor;
      moving.hub_velocity.x() = v;
      blades.advance(t + h, h, moving, field, no_air, memory);
    }
    return x;
  };
  // Modal answer to a hub let go at 1 m.
  const auto whole = [&](double t) {
    const auto& v = exact.eigenvectors();
    const Eigen::Matrix<double, 10, 1> start = v.transpose() * m * Eigen::Matrix<double, 10, 1>::Unit(0);
    double x = 0.0;
    for (int i = 0; i < 10; ++i) x += v(0, i) * start[i] * std::cos(std::sqrt(std::max(0.0, exact.eigenvalues()[i])) * t);
    return x;
  };
  const double end = 4.0, coarse = std::abs(swing(.02, end) - whole(end)), fine = std::abs(swing(.01, end) - whole(end));
  CHECK(coarse < 5e-3);
  CHECK(coarse / fine > 3.0);  // second order
  double largest = 0.0;
  for (double t = 60.0; t < 66.0; t += .25) largest = std::max(largest, std::abs(swing(.05, t)));
  CHECK(largest > .7);
  CHECK(largest < 1.01);
}

TEST_CASE("turning blades bend back from their cone and out of the wind", "[aero][fast]") {
  const BladeElementMomentum bem(dtu(), "madsen", 1.225);
  const double speed = 8.836 * rad_s_per_rpm;
  const auto tip = [&](double wind, double turning) {
    FlexibleBlades::Bending bending;
    std::vector<double> air(9);
    DiscMotion rotor{Vector3d::Zero(), turning * downwind, downwind, up, 0.5 * pi, 0.0};
    for (int pass = 0; pass < 30; ++pass) {
      const FlexibleBlades::Bending before = bending;
      const BentBlades bent = dtu_blades().bent(before);
      rotor.bent = &bent;
      bem.on_modes(Wind{Vector3d(wind, 0, 0)}, rotor, 0.0, {}, air);
      dtu_blades().settle(rotor, {rotor.omega, Vector3d::Zero(), Vector3d::Zero()}, air, bending);
    }
    return dtu_blades().tip(rotor, 0, bending);
  };
  const double loaded = tip(11.0, speed).x(), light = tip(5.0, speed * 5.0 / 11.0).x();
  CHECK(loaded > 6.0);  // HAWCStab2's table with deformation: 8 to 9 m at rated
  CHECK(loaded < 10.0);
  CHECK(light < .35 * loaded);
}

TEST_CASE("the rotor of blades hardly to be bent has the loads of the rigid one", "[aero][fast]") {
  std::string stiff = "span_m, mass_kg_m, flap_N_m2, edge_N_m2, twist_deg\n";
  stiff += "2.8, 900, 1e15, 1e15, 0\n89.166, 100, 1e15, 1e15, 0\n";
  AeroOptions aero;
  aero.model = "bem";
  RotorOptions options;
  options.turbine = turbine_file, options.speed = .925;
  const Motion body{};
  WindOptions wind;
  wind.speed_m_s = 11.0;
  const RotorPlacement place{.body = 0, .support = {}, .hub = {0, 0, 119.0}, .axis = downwind};
  const Wind blows = wind_of(wind, {place.hub, 178.33});
  const RotorLoads rigid(aero, options, blows, 1.225, place, std::span(&body, 1));
  options.blade_structure = data_file("stiff_blades.csv", stiff);
  RotorLoads bending(aero, options, blows, 1.225, place, std::span(&body, 1), {}, .02, weight);
  std::vector<double> memory(bending.memory_size());
  bending.begin(0.0, std::span(&body, 1), memory);
  for (int n = 1; n <= 5; ++n) bending.remember(.02 * n, .02, std::span(&body, 1), memory), bending.recall(memory);
  const double t = .1;
  const RotorLoad a = rigid.load(t, rigid.state(t, std::span(&body, 1))),
                  b = bending.load(t, bending.state(t, std::span(&body, 1)));
  CHECK(b.thrust == Approx(a.thrust).epsilon(1e-4));
  CHECK(b.power == Approx(a.power).epsilon(1e-4));
  CHECK((b.force - a.force).norm() < 1e-3 * a.force.norm());
  CHECK((b.moment - a.moment).norm() < 1e-3 * a.moment.norm());
}

TEST_CASE("a structure that is none is refused by line", "[aero][fast]") {
  const auto refused = [](const std::string& rows) {
    return data_file("blade_structure.csv", "span_m, mass_kg_m, flap_N_m2, edge_N_m2, twist_deg\n" + rows);
  };
  CHECK_THROWS_WITH(read_blade_structure(dtu(), refused("2.8, 900, 0, 1e9, 0\n89.166, 100, 1e7, 1e8, 0\n")),
                    Contains("flap_N_m2 = 0 must be positive"));
  CHECK_THROWS_WITH(read_blade_structure(dtu(), refused("2.8, 900, 1e9, 1e9, 0\n60, 100, 1e7, 1e8, 0\n")),
                    Contains("must be the tip of the planform"));
  CHECK_THROWS_WITH(read_blade_structure(dtu(), refused("2.8, 0, 1e9, 1e9, 0\n89.166, 100, 1e7, 1e8, 0\n")),
                    Contains("mass_kg_m = 0 must be positive"));
}
