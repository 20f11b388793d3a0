// A wake of vortex filaments against Prandtl's wing and the momentum theory of rotors.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/rotor/free_vortex_wake.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "tests/order.hpp"

using namespace spindrift;
using Eigen::Vector3d;

namespace {

/// Lift and induced drag coefficient of a wing of span 2 and elliptic chord, sections as the cosine has them.
struct Wing {
  double lift, drag;
};
Wing elliptic_wing(int sections, double root_chord, double attack) {
  LiftingLines line;
  std::vector<double> chords, widths;
  const auto end = [&](double i) { return -std::cos(pi * i / sections); };
  for (int j = 0; j <= sections; ++j) line.ends.push_back({0, end(j), 0});
  for (int j = 0; j < sections; ++j) {
    line.middles.push_back({0, end(j + 0.5), 0});
    chords.push_back(root_chord * std::sin(pi * (j + 0.5) / sections)), widths.push_back(end(j + 1) - end(j));
  }
  // A radius of a thousand spans makes the first row of the wake long, straight to all intents, and older rows have no
  // circulation. Angles are so small that cores do not grow.
  const FreeVortexWake wake({.turns = 2.0, .core_chords = 1e-6, .viscosity = 0.0}, chords, 1, 2e3);
  std::vector<double> memory(wake.memory_size()), none(chords.size(), 0.0);
  std::vector<Vector3d> induced(chords.size());
  const auto circulation = [&](std::size_t j, const Vector3d& w) { return pi * chords[j] * (attack + w.z()); };
  wake.begin(line, {Vector3d::Zero(), Vector3d::Zero(), Vector3d::UnitX(), Vector3d::UnitX(), 0.0, none}, circulation, memory,
             induced);
  Wing sum{};
  double area = 0.0;
  for (std::size_t j = 0; j < chords.size(); ++j) {
    const double bound_now = circulation(j, induced[j]);
    sum.lift += 2.0 * bound_now * widths[j], sum.drag -= 2.0 * bound_now * induced[j].z() * widths[j];
    area += chords[j] * widths[j];
  }
  return {sum.lift / area, sum.drag / area};
}

/// Blades from this radius to 1, blade 1 upright at azimuth 0.
LiftingLines straight_blades(int blades, int sections, double hub, double azimuth) {
  LiftingLines all;
  for (int b = 0; b < blades; ++b) {
    const double angle = azimuth + 2.0 * pi * b / blades;
    const Vector3d out(0, -std::sin(angle), std::cos(angle));
    for (int j = 0; j <= sections; ++j) all.ends.push_back((hub + (1.0 - hub) * j / sections) * out);
    for (int j = 0; j < sections; ++j) all.middles.push_back((hub + (1.0 - hub) * (j + 0.5) / sections) * out);
  }
  return all;
}

}  // namespace

TEST_CASE("an elliptic wing has Prandtl's lift and induced drag, and tends to them at second order", "[rotor][fast]") {
  const double attack = 1e-6, root_chord = GENERATE(0.2, 0.5), aspect = 4.0 / (pi / 2.0 * root_chord);
  const double lift = 2.0 * pi * attack / (1.0 + 2.0 / aspect), drag = lift * lift / (pi * aspect);
  std::vector<double> h, error;
  for (int n : {10, 20, 40}) {
    const Wing wing = elliptic_wing(n, root_chord, attack);
    h.push_back(1.0 / n), error.push_back(std::abs(wing.lift / lift - 1.0));
    UNSCOPED_INFO(n << ": lift " << wing.lift / lift << ", drag " << wing.drag / drag);
    CHECK(wing.lift == Approx(lift).epsilon(0.01));
    CHECK(wing.drag == Approx(drag).epsilon(0.02));
  }
  CHECK(observed_order(h, error) == Approx(2.0).margin(0.3));
}

TEST_CASE("a rotor of even loading slows the wind nearly as momentum theory says, at the disc and a radius behind",
          "[rotor][fast]") {
  // Blades of constant circulation Gamma: thrust coefficient B Gamma omega / (pi U^2) = 0.8, of which 1 - sqrt(1 - C_T) is 2 a.
  const int blades = 3, sections = 6;
  const double speed = 10.0, thrust = 0.8, a = 0.5 * (1.0 - std::sqrt(1.0 - thrust)), hub = 0.1, step = 10.0 * radians_per_degree;
  const double bound = thrust * pi / (blades * speed);
  const auto lines = [&](double azimuth) { return straight_blades(blades, sections, hub, azimuth); };
  const std::vector<double> chords(sections, 0.1), strengths(std::size_t(blades * sections), bound);
  const FreeVortexWake wake({.turns = 8.0, .step = step, .core_chords = 0.5, .viscosity = 1e-8}, chords, blades, 1.0);
  std::vector<double> memory(wake.memory_size());
  std::vector<Vector3d> induced(strengths.size());
  const auto constant = [&](std::size_t, const Vector3d&) { return bound; };
  const auto air = [](const Vector3d&) { return Vector3d(1, 0, 0); };
  wake.begin(lines(0.0), {Vector3d::Zero(), {speed, 0, 0}, Vector3d::UnitX(), Vector3d::UnitX(), a, strengths}, constant, memory,
             induced);
  const auto slowed = [&](double x, double reach) {
    std::vector<Vector3d> points, velocities;
    for (int ring = 0; ring < 20; ++ring)
      for (int i = 0; i < 48; ++i) {  // each with the same area
        const double r = reach * std::sqrt((ring + 0.5) / 20.0), angle = 2.0 * pi * (i + 0.3) / 48;
        points.push_back({x, r * std::sin(angle), r * std::cos(angle)}), velocities.push_back(Vector3d::Zero());
      }
    wake.add_velocities(memory, 1.0, points, velocities);
    double sum = 0.0;
    for (const Vector3d& v : velocities) sum -= v.x() / double(points.size());
    return sum;
  };
  const double h = step / speed;
  for (int n = 1; n <= 6 * 36; ++n) wake.advance(lines(speed * h * n), air, h, constant, memory, induced);
  // Lost to the wake's end some 2 per cent, to chords of ten degrees in place of arcs 1, to three blades for many 2.
  CHECK(slowed(0.0, 1.0) == Approx(a).epsilon(0.055));
  // On the axis of a vortex cylinder 1 + x / sqrt(x^2 + R^2) of that.
  CHECK(slowed(1.0, 0.8) / slowed(0.0, 0.8) == Approx(1.0 + std::sqrt(0.5)).epsilon(0.06));
}

TEST_CASE("without wind a rotor begins in air at rest, a breath of wind changes nothing, and the wake it leaves is driven down",
          "[rotor][fast]") {
  // Blades set to lift in still air; two pi of lift per angle.
  const int blades = 3, sections = 6;
  const double speed = 10.0, hub = 0.1, setting = 0.1, chord = 0.1, step = 10.0 * radians_per_degree, h = step / speed;
  const auto lines = [&](double azimuth) { return straight_blades(blades, sections, hub, azimuth); };
  const std::vector<double> chords(sections, chord), bound(std::size_t(blades * sections), 0.2);
  const auto circulation = [&](std::size_t i, const Vector3d& w) {
    const double across = speed * (hub + (1.0 - hub) * (double(i % sections) + 0.5) / sections);
    return pi * chord * across * (setting + w.x() / across);
  };
  const FreeVortexWake wake({.turns = 4.0, .step = step, .core_chords = 0.5, .viscosity = 1e-8}, chords, blades, 1.0);
  const auto begin = [&](double wind, std::vector<double>& memory) {
    memory.assign(wake.memory_size(), 0.0);
    std::vector<Vector3d> induced(bound.size());
    REQUIRE(wake.begin(lines(0.0), {Vector3d::Zero(), {speed, 0, 0}, Vector3d::UnitX(), {wind, 0, 0}, 0.0, bound}, circulation,
                       memory, induced));
    return induced;
  };
  std::vector<double> memory;
  const std::vector<Vector3d> breath = begin(1e-3, memory), still = begin(0.0, memory);
  for (std::size_t i = 0; i < still.size(); ++i) {
    CHECK(still[i].allFinite());
    CHECK(still[i].norm() < setting * speed);  // less than what makes the lift
    CHECK((still[i] - breath[i]).norm() < 1e-9);
  }
  std::vector<Vector3d> induced(bound.size());
  for (int n = 1; n <= 3 * 36; ++n)
    REQUIRE(wake.advance(
        lines(speed * h * n), [](const Vector3d&) { return Vector3d::Zero().eval(); }, h, circulation, memory, induced));
  double mean = 0.0;
  for (const Vector3d& w : induced) mean += w.x() / double(induced.size());
  CHECK(mean < 0.0);  // against the axis, as the blades' own lift pushes the air
  CHECK(mean > -setting * speed);
}
