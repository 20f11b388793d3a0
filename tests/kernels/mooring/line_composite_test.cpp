// The static line of several sections of kernels/mooring/line_composite.hpp: the one-part catenary, an integration of its
// equations along the line, statics by hand, point masses on a bed, its stiffness. SPDX-License-Identifier: Apache-2.0
#include "kernels/mooring/line_composite.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <random>

#include "kernels/base/constants.hpp"
#include "kernels/mooring/line_network.hpp"
#include "stiffness_check.hpp"

using namespace spindrift;
using Eigen::Vector3d;

namespace {

const Vector3d still = Vector3d::Zero();

/// Chain below, a light rope above.
const std::vector<CatenarySection> chain_and_rope{{400.0, 3000.0, 1.5e9}, {450.0, 300.0, 2e8}};
/// A chain, a rope that a float holds off the bed, a chain with a weight.
const std::vector<CatenarySection> three{{300.0, 1000.0, 5e8}, {200.0, 400.0, 2e8}, {150.0, 600.0, 3e8}};

struct Hanging {
  std::vector<CatenarySection> sections;
  std::vector<double> hung;
  double friction = 0.0;
  bool bed = true;

  LineComposite line() const { return LineComposite(sections, hung, friction, bed); }

  /// Where the lower end is under the upper one, for the pull (H, V) there: the equations of an elastic string, summed by
  /// Gauss's two points over short pieces from the top down; what the bed carries has no vertical pull.
  Eigen::Vector2d integrate(double h, double v) const {
    Eigen::Vector2d at = Eigen::Vector2d::Zero();
    double loss = 0.0;
    for (std::size_t i = sections.size(); i-- > 0;) {
      const CatenarySection& s = sections[i];
      constexpr int pieces = 40000;
      const double ds = s.length / pieces;
      for (int n = 0; n < pieces; ++n) {
        for (const double share : {0.5 - std::sqrt(1.0 / 12.0), 0.5 + std::sqrt(1.0 / 12.0)}) {
          const double vertical = v - s.weight_per_m * share * ds;
          const bool lies = bed && vertical <= 0.0;
          const double across = lies ? std::max(0.0, h - friction * (loss - vertical)) : h, up = lies ? 0.0 : vertical;
          const double tension = std::hypot(across, up);
          at += 0.5 * ds *
                Eigen::Vector2d(lies ? 1.0 + tension / s.axial_stiffness : (1.0 / tension + 1.0 / s.axial_stiffness) * across,
                                lies ? 0.0 : (1.0 / tension + 1.0 / s.axial_stiffness) * up);
        }
        v -= s.weight_per_m * ds;
        if (bed && v < 0.0) loss -= v, v = 0.0;
      }
      if (i == 0) break;
      v -= hung[i - 1];
      if (bed && v < 0.0) loss -= v, v = 0.0;
    }
    return at;
  }

  /// Newton's method on that integral, with differences for its slopes.
  Eigen::Vector2d shoot(double x, double z) const {
    double weight = 0.0;
    for (const CatenarySection& s : sections) weight += s.weight_per_m * s.length;
    Eigen::Vector2d pull(0.5 * weight, 0.5 * weight);
    for (int n = 0; n < 60; ++n) {
      const Eigen::Vector2d off = Eigen::Vector2d(x, z) - integrate(pull.x(), pull.y());
      if (off.norm() < 1e-9 * x) break;
      Eigen::Matrix2d slopes;
      for (int k : {0, 1}) {
        const double by = 1e-5 * pull.norm();
        Eigen::Vector2d more = pull, less = pull;
        more[k] += by, less[k] -= by;
        slopes.col(k) = (integrate(more.x(), more.y()) - integrate(less.x(), less.y())) / (2.0 * by);
      }
      const Eigen::Vector2d step = slopes.inverse() * off;
      pull += std::min(1.0, 0.5 * pull.norm() / step.norm()) * step;
      pull.x() = std::max(pull.x(), 1e-3 * weight);
    }
    return pull;
  }
};

}  // namespace

TEST_CASE("sections of equal properties are the catenary of one", "[mooring][fast]") {
  std::mt19937 random(7);
  const auto pick = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  double worst = 0.0, worst_stiffness = 0.0;
  int most = 0;
  for (int n = 0; n < 10000; ++n) {
    LineCatenary one{.length = std::exp(pick(0, 8)),
                     .weight_per_m = std::exp(pick(-2, 10)),
                     .bed_friction = n % 2 ? std::exp(pick(-8, 1)) : 0.0,
                     .bed_contact = n % 3 != 0};
    one.axial_stiffness = one.weight_per_m * one.length * std::exp(pick(0, 16));
    const double angle = pick(0, 0.5 * pi), chord = one.length * (n % 4 ? pick(0.3, 1.0) : 1.0 + std::exp(pick(-20, 0)));
    const double a = pick(0.1, 0.5), b = pick(0.1, 0.4);
    std::vector<CatenarySection> sections;
    for (const double share : {a, b, 1.0 - a - b})
      sections.push_back({share * one.length, one.weight_per_m, one.axial_stiffness});
    const LineComposite row(sections, {0.0, 0.0}, one.bed_friction, one.bed_contact);
    const Vector3d span(chord * std::cos(angle), 0.0, (n % 5 ? 1.0 : -1.0) * chord * std::sin(angle));
    const LineForces f = one.forces(span, still), g = row.forces(span, still);
    const double scale = f.on_fairlead.norm() + f.on_anchor.norm();
    worst = std::max({worst, (g.on_fairlead - f.on_fairlead).norm() / scale, (g.on_anchor - f.on_anchor).norm() / scale});
    const Eigen::Matrix3d k = one.stiffness(span);
    worst_stiffness = std::max(worst_stiffness, (row.stiffness(span) - k).norm() / k.norm());
    const CompositeState s = row.upright.solve(span.x(), std::abs(span.z()));
    REQUIRE(s.converged);
    most = std::max(most, s.evaluations);
  }
  CHECK(worst < 1e-9);
  CHECK(worst_stiffness < 1e-8);
  CHECK(most < 60);
}

TEST_CASE("chain and rope in a row pull as the equations of the string do, summed along it", "[mooring][fast]") {
  Hanging hanging{chain_and_rope, {0.0}};
  hanging.friction = GENERATE(0.0, 0.6);
  const auto [x, z, weight, bed] = GENERATE(table<double, double, double, bool>({{780.0, 150.0, 0.0, true},
                                                                                 {700.0, 350.0, 0.0, true},
                                                                                 {780.0, 150.0, 2e5, true},
                                                                                 {780.0, 350.0, -1e5, true},
                                                                                 {780.0, 350.0, -3e5, true},
                                                                                 {700.0, 250.0, -4e5, false},
                                                                                 {760.0, 0.0, 1e5, false},
                                                                                 {500.0, 690.0, 0.0, true}}));
  hanging.hung = {weight}, hanging.bed = bed;
  const CompositeState s = hanging.line().upright.solve(x, z);
  const Eigen::Vector2d pull = hanging.shoot(x, z);
  CAPTURE(x, z, weight, bed, hanging.friction, int(s.regime));
  CHECK(s.converged);
  CHECK(s.horizontal == Approx(pull.x()).epsilon(2e-6));
  CHECK(s.vertical == Approx(pull.y()).epsilon(2e-6).margin(1.0));
}

TEST_CASE("a weight between two light ropes, and a float, pull as by hand", "[mooring][fast]") {
  // Two straight legs of 60 and 80 m with a right angle where they meet; ends 100 m apart, level.
  const double weight = GENERATE(5e4, -5e4);
  const std::vector<CatenarySection> legs{{60.0, 1e-6, 1e14}, {80.0, 1e-6, 1e14}};
  const LineComposite line(legs, {weight}, 0.0, false);
  const LineForces f = line.forces({100.0, 0.0, 0.0}, still);
  // Parts of the load: of a leg its other leg's share of the span, 36 and 64 m.
  CHECK(f.on_anchor.z() == Approx(-weight * 0.64).epsilon(1e-6));
  CHECK(f.on_fairlead.z() == Approx(-weight * 0.36).epsilon(1e-6));
  CHECK(f.on_anchor.x() == Approx(std::abs(weight) * 0.48).epsilon(1e-6));
  CHECK(line.joint_heights({100.0, 0.0, 0.0})[0] == Approx(weight > 0.0 ? -48.0 : 48.0).epsilon(1e-6));
}

TEST_CASE("a weight that lies on the bed is not felt above it, a float lifts an arch of its own lift", "[mooring][fast]") {
  const Hanging light{{{300.0, 1000.0, 5e8}, {400.0, 1000.0, 5e8}}, {0.0}}, heavy{light.sections, {5e5}},
      lifted{light.sections, {-1e5}};
  const Vector3d span(620.0, 0.0, 100.0), loose(450.0, 0.0, 100.0);
  CHECK(light.line().upright.solve(620.0, 100.0).on_bed > 300.0);
  CHECK((heavy.line().forces(span, still).on_fairlead - light.line().forces(span, still).on_fairlead).norm() < 1e-6);
  // Slack: the float stands over the bed, 50 m of chain hanging from it on either side.
  const CompositeState s = lifted.line().upright.solve(450.0, 100.0);
  CHECK(s.regime == CatenaryRegime::slack);
  const double stretch = 1000.0 / (2.0 * 5e8);
  CHECK(lifted.line().joint_heights(loose)[0] == Approx(50.0 + stretch * 2500.0));
  const double lifted_length = s.vertical / 1000.0;
  CHECK(lifted_length + stretch * lifted_length * lifted_length == Approx(100.0));
  CHECK(s.on_bed == Approx(700.0 - 100.0 - lifted_length));
}

TEST_CASE("floats and weights over a bed rest as point masses do", "[mooring][fast]") {
  const auto [x, z, lift, weight] = GENERATE(table<double, double, double, double>({{620.0, 60.0, 1.5e5, 2e4},
                                                                                    {600.0, 20.0, 1.5e5, 8e4},
                                                                                    {560.0, 150.0, 0.8e5, -0.6e5},
                                                                                    {610.0, 40.0, 1e5, -1e5},
                                                                                    {590.0, 40.0, 0.9e5, -0.7e5}}));
  const double water = 1025.0, g = 9.81;
  // The last with floats so near each other that they share an arch, which stands between two parts on the bed.
  const std::vector<CatenarySection> sections =
      weight == -0.7e5 ? std::vector<CatenarySection>{{250.0, 1000.0, 5e8}, {30.0, 400.0, 2e8}, {370.0, 600.0, 3e8}} : three;
  const Hanging hanging{sections, {-lift, weight}};
  LineNetwork network;
  network.gravity = g, network.water_density = water;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    LineLumpedMass line;
    line.length = sections[i].length, line.segments = 80, line.axial_stiffness = sections[i].axial_stiffness;
    line.diameter = 0.1, line.gravity = g, line.water_density = water;
    line.mass_per_m = sections[i].weight_per_m / g + water * line.area();
    line.bed.level = -300.0, line.bed.stiffness = 1e8;
    network.lines.push_back({line, i == 0 ? LineNetwork::led : int(i) - 1, i == 2 ? LineNetwork::led : int(i)});
  }
  // Deep enough for floats to stay under water.
  for (const double net : {-lift, weight})
    network.junctions.push_back({{0.5 * x, 0.0, -280.0}, std::max(0.0, net / g), std::max(0.0, -net / (g * water))});
  std::vector<LineEnds> ends(3);
  ends[0].anchor.position = {0.0, 0.0, -300.0}, ends[2].fairlead.position = {x, 0.0, z - 300.0};
  std::vector<double> state(network.state_size()), rate(network.state_size());
  REQUIRE(network.rest(ends, state).found());
  LineNetwork::Scratch scratch = network.scratch();
  network.rates(0.0, ends, state, rate, StillWater{}, scratch);
  const LineForces f = hanging.line().forces({x, 0.0, z}, still);
  const std::vector<double> heights = hanging.line().joint_heights({x, 0.0, z});
  CAPTURE(x, z, lift, weight, heights[0], heights[1], f.on_fairlead.transpose(), scratch.forces[2].on_fairlead.transpose());
  CHECK((scratch.forces[2].on_fairlead - f.on_fairlead).norm() < 0.003 * f.on_fairlead.norm());
  CHECK(scratch.forces[0].on_anchor.x() == Approx(f.on_anchor.x()).epsilon(0.003));  // half a segment hangs on its last node
  for (int j : {0, 1}) CHECK(network.junction(j, state).position.z() + 300.0 == Approx(heights[std::size_t(j)]).margin(0.2));
}

TEST_CASE("what a line of sections does to its ends balances what it weighs, and from the other end it is the same line",
          "[mooring][fast]") {
  const Hanging hanging{three, {-1.5e5, 2e4}, 0.0, false};
  const Hanging turned{{three[2], three[1], three[0]}, {2e4, -1.5e5}, 0.0, false};
  const Vector3d span =
      GENERATE(Vector3d(500, 100, 50), Vector3d(-580, 90, -50), Vector3d(0, 0, 12), Vector3d(0, 0, -700), Vector3d(300, 0, 0));
  const LineForces f = hanging.line().forces(span, still), g = turned.line().forces(-span, still);
  const double weight = 300 * 1000.0 + 200 * 400.0 + 150 * 600.0 - 1.3e5;
  CHECK((f.on_fairlead + f.on_anchor + Vector3d(0, 0, weight)).norm() < 1e-6 * weight);
  CHECK((g.on_fairlead - f.on_anchor).norm() < 1e-6 * f.on_anchor.norm());
  CHECK(f.fairlead_tension == Approx(f.on_fairlead.norm()));
}

TEST_CASE("the stiffness of a line of sections agrees with differences, on the bed, over it and under the anchor",
          "[mooring][fast]") {
  const double friction = GENERATE(0.0, 0.3);
  const Hanging hanging =
      GENERATE_COPY(Hanging{three, {-1.5e5, 2e4}, friction, true}, Hanging{three, {-1.5e5, 2e4}, 0.0, false},
                    Hanging{three, {-8e4, -6e4}, friction, true}, Hanging{chain_and_rope, {5e4}, friction, true});
  const Vector3d span = GENERATE(Vector3d(300, 0, 50), Vector3d(-450, 90, 50), Vector3d(600, 0, 50), Vector3d(560, 20, 150),
                                 Vector3d(640, 10, 100), Vector3d(-580, 90, -50), Vector3d(600, 0, 0.5));
  const LineComposite line = hanging.line();
  const Eigen::Matrix3d exact = line.stiffness(span), differences = difference_stiffness(line, span, 1e-3);
  CAPTURE(span.transpose(), friction, hanging.hung, hanging.bed);
  INFO(exact << "\n\n" << differences);
  CHECK((exact - differences).norm() < 1e-6 * (exact.norm() + 1.0));
  if (friction == 0.0 && span.z() > 0.0) CHECK((exact - exact.transpose()).norm() < 1e-8 * (exact.norm() + 1.0));
}

TEST_CASE("forces are continuous where floats lift off, arches meet and weights leave the bed", "[mooring][fast]") {
  const Hanging hanging = GENERATE(Hanging{three, {-1.5e5, 2e4}, 0.3, true}, Hanging{three, {-8e4, -6e4}, 0.0, true},
                                   Hanging{three, {5e4, -9e4}, 0.3, true});
  const LineComposite line = hanging.line();
  const auto jump = [&](const Vector3d& from, const Vector3d& to) {
    constexpr int steps = 4000;
    LineForces last = line.forces(from, still);
    double worst = 0.0;
    for (int i = 1; i <= steps; ++i) {
      const LineForces now = line.forces(from + (to - from) * i / steps, still);
      worst = std::max({worst, (now.on_fairlead - last.on_fairlead).norm(), (now.on_anchor - last.on_anchor).norm()});
      last = now;
    }
    return worst * steps / (to - from).norm();  // [N/m]
  };
  const double bar = 1.0 / (300.0 / 5e8 + 200.0 / 2e8 + 150.0 / 3e8);
  CHECK(jump({250, 0, 90}, {655, 0, 90}) < bar);
  CHECK(jump({560, 0, 1}, {560, 0, 330}) < bar);
  CHECK(jump({500, 0, -30}, {500, 0, 30}) < bar);
}
