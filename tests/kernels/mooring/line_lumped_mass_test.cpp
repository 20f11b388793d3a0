// The lumped-mass line of kernels/mooring/line_lumped_mass.hpp alone: its statics against the catenary and OrcaFlex, its motion
// against OrcaFlex, the string and the laws of energy. SPDX-License-Identifier: Apache-2.0
#include "kernels/mooring/line_network.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "tests/order.hpp"

using namespace spindrift;
using Eigen::Vector3d;

namespace {

struct Chain {
  double out, depth, length;
};
/// D 0.252 m, 390 kg/m, EA 1.674e9 N, Cd 1.37 and 0.64, half friction: the chains of FloatingArrayDesign/MoorDyn, tests (BSD-3),
/// which compare with OrcaFlex. Everything else is ours by default.
LineLumpedMass chain_line(const Chain& c) {
  LineLumpedMass line;
  line.length = c.length, line.diameter = 0.252, line.mass_per_m = 390.0, line.axial_stiffness = 1.674e9;
  line.gravity = standard_gravity, line.bed.level = -c.depth, line.bed.friction = 0.5;
  line.normal_drag = 1.37, line.tangential_drag = 0.64;
  return line;
}
LineEnds chain_ends(const Chain& c) { return {{{c.out, 0.0, -c.depth}, Vector3d::Zero()}, {}}; }

LineNetwork::Rest find_rest(const LineLumpedMass& line, const LineEnds& ends, std::span<double> state) {
  return LineNetwork{.lines = {{line}}}.rest({&ends, 1}, state);
}

/// The line in motion, alone.
struct Moving {
  LineNetwork network;
  LineNetwork::Scratch scratch;
  explicit Moving(const LineLumpedMass& line) : network{.lines = {{line}}}, scratch(network.scratch()) {}
  template <class Water>
  LineForces advance(double t, double h, const LineEnds& from, const LineEnds& to, std::span<double> state, const Water& water) {
    network.advance(t, h, {&from, 1}, {&to, 1}, state, water, scratch);
    return scratch.forces[0];
  }
};

/// Kinetic, elastic, of weight in water and of the bed's spring [J].
double energy(const LineLumpedMass& line, const LineEnds& ends, std::span<const double> state) {
  const LineLumpedMass::Nodes nodes{line, ends, state};
  const double l0 = line.segment(), displaced = line.water_density * line.area() * l0, m = line.mass_per_m * l0;
  double sum = 0.0;
  for (int i = 0; i < line.segments; ++i) {
    const double stretch = std::max((nodes.position(i + 1) - nodes.position(i)).norm() / l0 - 1.0, 0.0);
    sum += 0.5 * line.axial_stiffness * l0 * stretch * stretch;
  }
  for (int i = 1; i < line.segments; ++i) {
    const Vector3d v = nodes.velocity(i), q = line.tangent(nodes, i), along = v.dot(q) * q;
    sum += 0.5 * (m + line.normal_added_mass * displaced) * (v - along).squaredNorm() +
           0.5 * (m + line.tangential_added_mass * displaced) * along.squaredNorm();
    const double z = nodes.position(i).z(), sunk = line.bed.contact ? std::max(line.bed.level - z, 0.0) : 0.0;
    sum += line.weight_per_m() * l0 * z + 0.5 * line.bed.stiffness * line.diameter * l0 * sunk * sunk;
  }
  return sum;
}

}  // namespace

TEST_CASE("a lumped-mass chain at rest agrees with OrcaFlex to 1.5 per cent", "[mooring][fast]") {
  // OrcaFlex statics: FloatingArrayDesign/MoorDyn, tests/quasi_static_chain.cpp (BSD-3).
  struct Case {
    Chain chain;
    double fairlead, anchor;
  };
  const Case c = GENERATE(Case{{400, 50, 410}, 991.6e3, 826.2e3}, Case{{700, 200, 760}, 2065.4e3, 1402.2e3},
                          Case{{1500, 600, 1700}, 5232.6e3, 3244.2e3});
  const LineLumpedMass line = chain_line(c.chain);
  auto scratch = line.scratch();
  std::vector<double> state(line.state_size()), rate(state.size());
  const LineEnds ends = chain_ends(c.chain);
  const auto rest = find_rest(line, ends, state);
  INFO("iterations " << rest.iterations << ", residual " << rest.residual << " of " << rest.limit);
  REQUIRE(rest.found());
  const LineForces f = line.rates(0.0, ends, state, rate, StillWater{}, scratch);
  CHECK(f.fairlead_tension == Approx(c.fairlead).epsilon(0.015));
  CHECK(Eigen::Vector2d(f.on_anchor.x(), f.on_anchor.y()).norm() == Approx(c.anchor).epsilon(0.015));
}

TEST_CASE("tensions of a shaken chain have the extremes of OrcaFlex to 5 per cent", "[mooring][fast]") {
  // Fairlead heaving 2 m at 10 s from t = -10 s; OrcaFlex over 0 to 20 s, FloatingArrayDesign/MoorDyn, tests (BSD-3):
  // WD0050_Chain_ZZP1_A1.txt, WD0200_Chain_ZZP1_A1.txt.
  struct Case {
    Chain chain;
    double fairlead[2], anchor[2];
  };
  const Case c = GENERATE(Case{{400, 50, 410}, {899.198e3, 1093.194e3}, {778.104e3, 877.743e3}},
                          Case{{700, 200, 760}, {1828.374e3, 2304.96e3}, {1319.76e3, 1482.163e3}});
  const LineLumpedMass line = chain_line(c.chain);
  Moving moving(line);
  std::vector<double> state(line.state_size());
  const auto ends = [&](double t) {
    LineEnds e = chain_ends(c.chain);
    const double omega = 2.0 * pi / 10.0;
    e.fairlead.position.z() = 2.0 * std::sin(omega * t), e.fairlead.velocity.z() = 2.0 * omega * std::cos(omega * t);
    return e;
  };
  LineEnds first = ends(-10.0);
  REQUIRE(find_rest(line, first, state).found());
  const double h = 0.025;
  double low[2] = {1e99, 1e99}, high[2] = {0.0, 0.0};
  for (int n = 0; n < 1200; ++n) {
    const double t = -10.0 + n * h;
    const LineForces f = moving.advance(t, h, ends(t), ends(t + h), state, StillWater{});
    if (t + h < -1e-9) continue;
    const double now[2] = {f.fairlead_tension, f.anchor_tension};
    for (int i : {0, 1}) low[i] = std::min(low[i], now[i]), high[i] = std::max(high[i], now[i]);
  }
  INFO("extremes " << low[0] << " " << high[0] << " " << low[1] << " " << high[1]);
  CHECK(low[0] == Approx(c.fairlead[0]).epsilon(0.05));
  CHECK(high[0] == Approx(c.fairlead[1]).epsilon(0.05));
  CHECK(low[1] == Approx(c.anchor[0]).epsilon(0.05));
  CHECK(high[1] == Approx(c.anchor[1]).epsilon(0.05));
}

TEST_CASE("the static shape of a lumped-mass line converges with the second order to the catenary", "[mooring][fast]") {
  LineLumpedMass line = chain_line({700, 200, 760});
  line.bed.contact = false;
  const LineEnds ends = chain_ends({700, 200, 760});
  const LineForces exact = line.catenary().forces(ends.fairlead.position - ends.anchor.position, Vector3d::Zero());
  std::vector<double> h, fairlead, anchor;
  for (int segments : {10, 20, 40, 80}) {
    line.segments = segments;
    auto scratch = line.scratch();
    std::vector<double> state(line.state_size()), rate(state.size());
    REQUIRE(find_rest(line, ends, state).found());
    const LineForces f = line.rates(0.0, ends, state, rate, StillWater{}, scratch);
    h.push_back(line.segment());
    fairlead.push_back((f.on_fairlead - exact.on_fairlead).norm()), anchor.push_back((f.on_anchor - exact.on_anchor).norm());
  }
  CHECK(observed_order(h, fairlead) == Approx(2.0).margin(0.1));
  CHECK(observed_order(h, anchor) == Approx(2.0).margin(0.1));
}

TEST_CASE("a slack line falls to rest, and every line finds its rest", "[mooring][fast]") {
  const double out = GENERATE(0.0, 50.0, 350.0, 400.0, 408.0, 420.0), up = GENERATE(-10.0, 0.0, 50.0);
  const LineLumpedMass line = chain_line({400, 50, 410});
  std::vector<double> state(line.state_size());
  const LineEnds ends{{{0, 0, -50}, Vector3d::Zero()}, {{0.6 * out, 0.8 * out, -50 + up}, Vector3d::Zero()}};
  INFO(out << " m out, " << up << " m up");
  const auto rest = find_rest(line, ends, state);
  INFO("iterations " << rest.iterations << ", residual " << rest.residual << " of " << rest.limit);
  CHECK(rest.found());
}

TEST_CASE("a weight in the middle of a light line hangs on two straight halves", "[mooring][fast]") {
  LineLumpedMass line;
  line.length = 100.0, line.diameter = 0.01, line.mass_per_m = 0.1, line.axial_stiffness = 1e9, line.bed.contact = false;
  line.clumps = {{10, 5e3, 1.0, 0.0, 0.5}};
  const LineEnds ends{{{0, 0, -60}, Vector3d::Zero()}, {{80, 0, -60}, Vector3d::Zero()}};
  auto scratch = line.scratch();
  std::vector<double> state(line.state_size()), rate(state.size());
  REQUIRE(find_rest(line, ends, state).found());
  const LineForces f = line.rates(0.0, ends, state, rate, StillWater{}, scratch);
  const double weight = 9.81 * (5e3 - 1025.0);  // halves of 50 m, 40 m out and 30 m down
  CHECK(-f.on_fairlead.z() == Approx(0.5 * weight).epsilon(1e-3));
  CHECK(f.fairlead_tension == Approx(0.5 * weight / 0.6).epsilon(2e-3));
  // Let go, it falls with its own mass and that of the water.
  for (double& z : state) z = 0.0;
  for (int i = 1; i < 20; ++i) state[std::size_t(3 * (i - 1))] = 4.0 * i, state[std::size_t(3 * (i - 1) + 2)] = -60.0;
  line.rates(0.0, ends, state, rate, StillWater{}, scratch);
  CHECK(rate[line.state_size() / 2 + 3 * 9 + 2] == Approx(-weight / (5e3 + 0.5 * 1025.0)).epsilon(1e-3));
}

TEST_CASE("lines of all kinds find their rest", "[mooring][fast]") {
  std::mt19937 random(5);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  int missed = 0;
  for (int n = 0; n < 400; ++n) {
    LineLumpedMass line;
    line.diameter = between(0.02, 0.4), line.mass_per_m = 1025.0 * line.area() * between(1.05, 8.0);
    line.axial_stiffness = line.weight_per_m() * std::pow(10.0, between(4.0, 7.5));
    line.segments = int(between(2.0, 60.0));
    const double out = between(0.0, 1000.0), up = between(-100.0, 600.0);
    line.length = std::max(1.0, std::hypot(out, up) * between(0.995, 1.5));
    line.bed.contact = n % 2 == 0, line.bed.level = -700.0 + std::min(up, 0.0);
    std::vector<double> state(line.state_size());
    const auto rest = find_rest(line, {{{0, 0, -700}, Vector3d::Zero()}, {{out, 0, -700 + up}, Vector3d::Zero()}}, state);
    missed += !rest.found();
  }
  CHECK(missed == 0);
}

TEST_CASE("a line that snaps taut gives back no more than the energy put in", "[mooring][fast]") {
  LineLumpedMass line = chain_line({0, 0, 100});
  line.bed.contact = false, line.damping_ratio = GENERATE(0.0, 0.1, 1.0);
  const bool in_water = GENERATE(false, true);
  if (!in_water) line.normal_drag = line.tangential_drag = 0.0;
  auto scratch = line.scratch();
  Moving moving(line);
  std::vector<double> state(line.state_size());
  // Pulled from 80 m to 101.5 m apart at up to 8 m/s, held there, let go, three times over.
  const auto ends = [&](double t) {
    const double omega = 2.0 * pi / 8.0;
    LineEnds e{{{0, 0, -60}, Vector3d::Zero()}, {{90.75 - 10.75 * std::cos(omega * t), 0, -60}, Vector3d::Zero()}};
    e.fairlead.velocity.x() = 10.75 * omega * std::sin(omega * t);
    return e;
  };
  REQUIRE(find_rest(line, ends(0.0), state).found());
  const double h = 0.0025, start = energy(line, ends(0.0), state);
  std::vector<double> rate(state.size());
  LineForces before = line.rates(0.0, ends(0.0), state, rate, StillWater{}, scratch);
  double work = 0.0, highest = 0.0, largest = 0.0;
  for (int n = 0; n < 9600; ++n) {
    const double t = n * h;
    const LineForces f = moving.advance(t, h, ends(t), ends(t + h), state, StillWater{});
    work -= 0.5 * h * (before.on_fairlead.dot(ends(t).fairlead.velocity) + f.on_fairlead.dot(ends(t + h).fairlead.velocity));
    before = f, highest = std::max(highest, f.fairlead_tension);
    const double excess = energy(line, ends(t + h), state) - start - work;
    largest = std::max(largest, excess);
  }
  INFO("highest tension " << highest << " N, energy beyond the work " << largest << " J of " << work << " J");
  CHECK(highest > 5e5);                                                         // it did snap
  CHECK(largest < 0.002 * line.axial_stiffness * line.length * 0.015 * 0.015);  // the trapezium's error in the work
}

TEST_CASE("slowly moved, a lumped-mass line carries what the catenary carries", "[mooring][fast]") {
  LineLumpedMass line = chain_line({700, 200, 760});
  line.segments = 40, line.bed.friction = 0.0;
  Moving moving(line);
  std::vector<double> state(line.state_size());
  const auto ends = [](double t) {
    LineEnds e = chain_ends({700, 200, 760});
    e.fairlead.position.x() = 5.0 * std::cos(2.0 * pi * t / 400.0) - 5.0;
    e.fairlead.velocity.x() = -5.0 * 2.0 * pi / 400.0 * std::sin(2.0 * pi * t / 400.0);
    return e;
  };
  REQUIRE(find_rest(line, ends(0.0), state).found());
  double worst = 0.0;
  for (int n = 0; n < 4000; ++n) {
    const LineForces f = moving.advance(0.1 * n, 0.1, ends(0.1 * n), ends(0.1 * (n + 1)), state, StillWater{});
    const LineForces still =
        line.catenary().forces(ends(0.1 * (n + 1)).fairlead.position - ends(0.0).anchor.position, Vector3d::Zero());
    worst = std::max(worst, std::abs(f.fairlead_tension / still.fairlead_tension - 1.0));
  }
  CHECK(worst < 0.01);
}

TEST_CASE("a taut line rings at the frequency of a string", "[mooring][fast]") {
  LineLumpedMass line;
  line.length = 100.0, line.segments = 40, line.diameter = 0.1, line.mass_per_m = 60.0, line.axial_stiffness = 1e8;
  line.gravity = 1e-9, line.damping_ratio = 0.0, line.normal_drag = line.tangential_drag = 0.0, line.bed.contact = false;
  const LineEnds ends{{{0, 0, -60}, Vector3d::Zero()}, {{101, 0, -60}, Vector3d::Zero()}};
  Moving moving(line);
  std::vector<double> state(line.state_size());
  REQUIRE(find_rest(line, ends, state).found());
  for (std::size_t i = 0; i < line.inner(); ++i) state[3 * i + 1] += 0.01 * std::sin(pi * double(i + 1) / 40.0);
  const std::size_t middle = 3 * (line.inner() / 2) + 1;
  double crossing = 0.0, before = state[middle];
  const double h = 0.001;
  for (int n = 0; n < 4000 && crossing == 0.0; ++n) {
    moving.advance(n * h, h, ends, ends, state, StillWater{});
    if (state[middle] <= 0.0) crossing = h * (n + before / (before - state[middle]));
    before = state[middle];
  }
  const double m = line.mass_per_m + line.water_density * line.area();  // stretched by a hundredth: 1 % less mass per length
  CHECK(4.0 * crossing == Approx(2.0 * 101.0 / std::sqrt(1e6 / (m / 1.01))).epsilon(2e-3));
}

TEST_CASE("a line hanging in a current takes the drag of its chord", "[mooring][fast]") {
  LineLumpedMass line;
  line.length = 100.0, line.diameter = 0.2, line.mass_per_m = 300.0, line.axial_stiffness = 1e8, line.bed.contact = false;
  const LineEnds ends{{{0, 0, -140}, Vector3d::Zero()}, {{0, 0, -39.9}, Vector3d::Zero()}};
  Moving moving(line);
  std::vector<double> state(line.state_size());
  REQUIRE(find_rest(line, ends, state).found());
  const auto current = [](double, const Vector3d&) { return LineWater{{0.5, 0.0, 0.0}, Vector3d::Zero(), 0.0}; };
  LineForces f;
  for (int n = 0; n < 600; ++n) f = moving.advance(0.1 * n, 0.1, ends, ends, state, current);
  const double drag = 0.5 * 1025.0 * line.normal_drag * 0.2 * 0.25 * 100.0;
  CHECK(f.on_fairlead.x() + f.on_anchor.x() == Approx(drag).epsilon(0.02));
}

TEST_CASE("out of the water a line has neither drag nor added mass, nor have its clumps and its ends", "[mooring][fast]") {
  LineLumpedMass line;
  line.length = 20.0, line.segments = 4, line.diameter = 0.2, line.mass_per_m = 300.0, line.axial_stiffness = 1e8;
  line.bed.contact = false, line.clumps = {{.node = 2, .mass = 500.0, .volume = 0.3, .drag_area = 2.0}};
  const auto stream = [](double, const Vector3d&) { return LineWater{{2.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 0.0}; };
  for (const double low : {5.0, -30.0}) {
    const LineEnds ends{{{0, 0, low}, Vector3d::Zero()}, {{0, 0, low + 20.01}, Vector3d::Zero()}};
    std::vector<double> state(line.state_size()), rate(line.state_size());
    line.lay_as_catenary(ends, state);
    LineLumpedMass::Scratch scratch = line.scratch();
    line.rates(0.0, ends, state, rate, stream, scratch);
    const double swept = rate[3 * line.inner() + 3];  // along x, of the clump
    const Eigen::Matrix3d end = line.end_mass({line, ends, state}, line.segments, 0.0);
    const double dry = 300.0 * 2.5, water = 1025.0 * line.area() * 2.5;
    CHECK(end(0, 0) == Approx(low > 0.0 ? dry : dry + water));
    CHECK(end(2, 2) == Approx(dry));
    if (low > 0.0)
      CHECK(std::abs(swept) < 1e-9);
    else
      CHECK(swept > 1.0);
  }
}

TEST_CASE("waves load a line the same in long steps of the bodies as in short ones", "[mooring][fast]") {
  // A wave of 4 m and 8 s in deep water over a chain; the water is asked for three times in a step, whatever its substeps.
  LineLumpedMass line = chain_line({700, 200, 760});
  line.bed.contact = false;  // its friction begins at once, whatever the step
  const LineEnds ends = chain_ends({700, 200, 760});
  const double omega = 2.0 * pi / 8.0, k = omega * omega / 9.81;
  int asked = 0;
  const auto sea = [&](double t, const Vector3d& p) {
    ++asked;
    const double phase = k * p.x() - omega * t, u = 2.0 * omega * std::exp(k * std::min(p.z(), 0.0));
    return LineWater{{u * std::cos(phase), 0.0, u * std::sin(phase)},
                     {omega * u * std::sin(phase), 0.0, -omega * u * std::cos(phase)},
                     2.0 * std::cos(phase)};
  };
  const auto tensions = [&](double h) {
    Moving moving(line);
    std::vector<double> state(line.state_size()), found;
    REQUIRE(find_rest(line, ends, state).found());
    const int every = int(std::lround(0.2 / h));
    for (int n = 0; n < 100 * every; ++n) {
      const double tension = moving.advance(n * h, h, ends, ends, state, sea).fairlead_tension;
      if ((n + 1) % every == 0) found.push_back(tension);
    }
    return found;
  };
  const std::vector<double> fine = tensions(0.0125);
  const auto [low, high] = std::minmax_element(fine.begin(), fine.end());
  for (const double h : {0.2, 0.05}) {
    asked = 0;
    const std::vector<double> now = tensions(h);
    CHECK(asked == 3 * (line.segments + 1) * int(std::lround(20.0 / h)));
    double worst = 0.0;
    for (std::size_t i = 0; i < now.size(); ++i) worst = std::max(worst, std::abs(now[i] - fine[i]));
    CHECK(worst < 1e-4 * (*high - *low));
  }
}
