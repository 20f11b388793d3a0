// Lines that meet at junctions, kernels/mooring/line_network.hpp: balance of forces and shapes at rest, motion against the
// pendulum and the modes of a weight on two strings, energy, order, and one line cut in two. SPDX-License-Identifier: Apache-2.0
#include "kernels/mooring/line_network.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "tests/order.hpp"

using namespace spindrift;
using Eigen::Vector3d;

namespace {

constexpr int led = LineNetwork::led;

LineEnd at(double x, double y, double z) { return {{x, y, z}, Vector3d::Zero()}; }

/// Next to no weight.
LineLumpedMass light_string(double length, double axial_stiffness) {
  LineLumpedMass line;
  line.length = length, line.segments = 10, line.diameter = 0.002, line.mass_per_m = 0.01, line.axial_stiffness = axial_stiffness;
  line.bed.contact = false;
  return line;
}

LineLumpedMass chain_of(double length, int segments) {
  LineLumpedMass line;
  line.length = length, line.segments = segments, line.diameter = 0.252, line.mass_per_m = 390.0, line.axial_stiffness = 1.674e9;
  line.bed.level = -200.0;
  return line;
}

struct AtRest {
  std::vector<double> state;
  std::vector<LineForces> forces;
  LineNetwork::Rest rest;
};
AtRest at_rest(const LineNetwork& network, std::span<const LineEnds> outer) {
  AtRest r{std::vector<double>(network.state_size()), {}, {}};
  r.rest = network.rest(outer, r.state);
  LineNetwork::Scratch scratch = network.scratch();
  std::vector<double> rate(r.state.size());
  network.rates(0.0, outer, r.state, rate, StillWater{}, scratch);
  r.forces = scratch.forces;
  return r;
}

}  // namespace

TEST_CASE("a weight between two elastic strings hangs where their pull carries it", "[mooring][fast]") {
  const double stiffness = 2e5, length = 50.0, half = 40.0;  // stretched by some per cent
  LineNetwork network{.lines = {{light_string(length, stiffness), led, 0}, {light_string(length, stiffness), led, 0}},
                      .junctions = {{.start = {5.0, 3.0, -70.0}, .mass = 5e3, .volume = 1.0}}};
  const std::vector<LineEnds> outer{{at(-half, 0, -60), {}}, {at(half, 0, -60), {}}};
  const AtRest r = at_rest(network, outer);
  REQUIRE(r.rest.found());
  const double weight = 9.81 * (5e3 - 1025.0);
  double low = 30.0, high = 100.0;  // sag [m]: 2 EA (l/L - 1) sag/l = weight
  for (int n = 0; n < 100; ++n) {
    const double sag = 0.5 * (low + high), l = std::hypot(half, sag);
    (2.0 * stiffness * (l / length - 1.0) * sag / l < weight ? low : high) = sag;
  }
  const Vector3d place = network.junction(0, r.state).position;
  CHECK(place.x() == Approx(0.0).margin(1e-6));
  CHECK(place.y() == Approx(0.0).margin(1e-6));
  CHECK(place.z() == Approx(-60.0 - low).margin(0.01));
  CHECK((r.forces[0].on_fairlead + r.forces[1].on_fairlead + Vector3d(0, 0, -weight)).norm() < 1e-3);
}

TEST_CASE("three unlike lines at a junction balance its weight", "[mooring][fast]") {
  LineNetwork network{.lines = {{chain_of(300, 20), led, 0}, {chain_of(80, 7), 0, led}, {light_string(90, 1e8), 0, led}},
                      .junctions = {{.start = {100.0, 0.0, -80.0}, .mass = 3e4, .volume = 4.0}}};
  const std::vector<LineEnds> outer{{at(350, 0, -200), {}}, {{}, at(40, -10, -20)}, {{}, at(40, 10, -20)}};
  const AtRest r = at_rest(network, outer);
  REQUIRE(r.rest.found());
  const Vector3d sum = r.forces[0].on_fairlead + r.forces[1].on_anchor + r.forces[2].on_anchor;
  CHECK((sum - Vector3d(0, 0, 9.81 * (3e4 - 4.0 * 1025.0))).norm() < 2.0 * r.rest.limit);
}

TEST_CASE("a line cut in two at a junction without mass rests and moves as the whole line", "[mooring][fast]") {
  const LineLumpedMass whole = chain_of(760, 40);
  LineNetwork one{.lines = {{whole}}},
      two{.lines = {{chain_of(380, 20), led, 0}, {chain_of(380, 20), 0, led}}, .junctions = {LineJunction{}}};
  two.junctions[0].start = {-300.0, 0.0, -150.0};
  const auto outer = [](double t) {
    const double omega = 2.0 * pi / 10.0;
    return std::vector<LineEnds>{
        {at(700, 0, -200), {Vector3d(0, 0, 2.0 * std::sin(omega * t)), Vector3d(0, 0, 2.0 * omega * std::cos(omega * t))}}};
  };
  const auto apart = [&](double t) {
    const LineEnds e = outer(t)[0];
    return std::vector<LineEnds>{{e.anchor, {}}, {{}, e.fairlead}};
  };
  AtRest a = at_rest(one, outer(0.0)), b = at_rest(two, apart(0.0));
  REQUIRE((a.rest.found() && b.rest.found()));
  CHECK((a.forces[0].on_fairlead - b.forces[1].on_fairlead).norm() < 1e-6 * a.forces[0].fairlead_tension);
  const std::size_t middle = 3 * 19;
  CHECK((two.junction(0, b.state).position - Eigen::Map<const Vector3d>(a.state.data() + middle)).norm() < 1e-4);
  LineNetwork::Scratch for_one = one.scratch(), for_two = two.scratch();
  double worst = 0.0;
  for (int n = 0; n < 400; ++n) {
    const double t = 0.05 * n, next = t + 0.05;
    one.advance(t, 0.05, outer(t), outer(next), a.state, StillWater{}, for_one);
    two.advance(t, 0.05, apart(t), apart(next), b.state, StillWater{}, for_two);
    worst = std::max(worst, std::abs(for_one.forces[0].fairlead_tension / for_two.forces[1].fairlead_tension - 1.0));
  }
  CHECK(worst < 2e-3);  // the tangents of the two half segments at the cut, for one of both
}

TEST_CASE("a float on a string rests at the surface, half out of the water, or is pulled under", "[mooring][fast]") {
  const double depth = GENERATE(40.0, 60.0);
  LineNetwork network{.lines = {{light_string(50, 1e7), led, 0}},
                      .junctions = {{.start = {0, 0, -20}, .mass = 512.5, .volume = 1.0}}};
  const std::vector<LineEnds> outer{{at(0, 0, -depth), {}}};
  const AtRest r = at_rest(network, outer);
  REQUIRE(r.rest.found());
  const double z = network.junction(0, r.state).position.z();
  if (depth < 50.0) {
    CHECK(z == Approx(0.0).margin(0.01));
  } else {
    CHECK(z == Approx(-10.0).margin(0.05));
    CHECK(r.forces[0].fairlead_tension == Approx(9.81 * 512.5).epsilon(1e-3));
  }
}

TEST_CASE("bridles of all kinds find their rest", "[mooring][fast]") {
  std::mt19937 random(7);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  int missed = 0;
  for (int n = 0; n < 200; ++n) {
    // Two lines from the bed to two junctions, a line between these, two bridles from each to the hull.
    const auto line = [&](double apart) {
      LineLumpedMass l = chain_of(apart * between(0.99, 1.4), int(between(2.0, 30.0)));
      l.diameter = between(0.03, 0.3), l.mass_per_m = 1025.0 * l.area() * between(1.1, 8.0);
      l.axial_stiffness = l.weight_per_m() * std::pow(10.0, between(4.5, 7.0));
      return l;
    };
    LineNetwork network{.lines = {{line(400), led, 0}, {line(400), led, 1}, {line(40), 0, 1}},
                        .junctions = {{.start = {100, 20, -80}, .mass = between(0.0, 5e4), .volume = between(0.0, 60.0)},
                                      {.start = {100, -20, -80}, .mass = between(0.0, 5e4)}}};
    std::vector<LineEnds> outer{{at(450, 60, -200), {}}, {at(450, -60, -200), {}}, {}};
    for (const int j : {0, 1})
      for (const double side : {-5.0, 5.0})
        network.lines.push_back({line(110), j, led}), outer.push_back({{}, at(8, side, between(-60.0, -5.0))});
    std::vector<double> state(network.state_size());
    missed += !network.rest(outer, state).found();
  }
  CHECK(missed == 0);
}

TEST_CASE("a weight on a string swings as a pendulum, without loss", "[mooring][fast]") {
  LineLumpedMass string = light_string(10, 1e6);
  string.mass_per_m = 0.1, string.segments = 4, string.damping_ratio = 0.0, string.water_density = 1e-9;
  LineNetwork network{.lines = {{string, 0, led}}, .junctions = {{.start = {0, 0, 10}, .mass = 1e3}}, .water_density = 1e-9};
  const std::vector<LineEnds> outer{{{}, at(0, 0, 20)}};
  AtRest r = at_rest(network, outer);
  REQUIRE(r.rest.found());
  const double length = 20.0 - network.junction(0, r.state).position.z(), lean = 0.05;
  for (std::size_t k = 0; k < 4; ++k) {  // leans as a whole
    double* p = r.state.data() + (k < 3 ? 3 * k : network.first_of_junctions());
    const double below = 20.0 - p[2];
    p[0] = below * std::sin(lean), p[2] = 20.0 - below * std::cos(lean);
  }
  LineNetwork::Scratch scratch = network.scratch();
  const double h = 0.01, period = 2.0 * pi * std::sqrt(length / 9.81);
  std::vector<double> crossings;
  double before = network.junction(0, r.state).position.x(), largest = 0.0;
  for (int n = 0; n * h < 3.2 * period; ++n) {
    network.advance(n * h, h, outer, outer, r.state, StillWater{}, scratch);
    const double x = network.junction(0, r.state).position.x();
    if (before > 0.0 && x <= 0.0) crossings.push_back(h * (n + before / (before - x)));
    if (n * h > 2.2 * period) largest = std::max(largest, x);
    before = x;
  }
  REQUIRE(crossings.size() == 3);
  CHECK(0.5 * (crossings[2] - crossings[0]) == Approx(period * (1.0 + lean * lean / 16.0)).epsilon(1e-3));
  CHECK(largest == Approx(length * std::sin(lean)).epsilon(1e-3));
}

TEST_CASE("a weight on two strings rings at the frequencies of their stiffness, along, across and up", "[mooring][fast]") {
  LineLumpedMass string = light_string(50, 2e5);
  string.segments = 2, string.damping_ratio = 0.0, string.water_density = 1e-9;
  const double half = 40.0, mass = 2e3;
  LineNetwork network{
      .lines = {{string, led, 0}, {string, led, 0}}, .junctions = {{.start = {0, 0, -30}, .mass = mass}}, .water_density = 1e-9};
  const std::vector<LineEnds> outer{{at(-half, 0, 0), {}}, {at(half, 0, 0), {}}};
  AtRest r = at_rest(network, outer);
  REQUIRE(r.rest.found());
  const Vector3d rest = network.junction(0, r.state).position;
  const double l = std::hypot(half, rest.z()), c = half / l, s = -rest.z() / l, k = 2e5 / 50.0, turn = 0.5 * mass * 9.81 / s / l;
  const Vector3d stiffness = 2.0 * Vector3d(k * c * c + turn * s * s, turn, k * s * s + turn * c * c);
  const int direction = GENERATE(0, 1, 2);
  const double period = 2.0 * pi / std::sqrt(stiffness[direction] / mass), h = period / 200;
  r.state[r.state.size() - 3 + std::size_t(direction)] = 1e-3;
  LineNetwork::Scratch scratch = network.scratch();
  std::vector<double> crossings;
  double before = 0.0;
  for (int n = 0; n < 1050; ++n) {
    network.advance(n * h, h, outer, outer, r.state, StillWater{}, scratch);
    const double out = network.junction(0, r.state).position[direction] - rest[direction];
    if (before > 0.0 && out <= 0.0) crossings.push_back(h * (n + before / (before - out)));
    before = out;
  }
  REQUIRE(crossings.size() == 5);
  CHECK(0.25 * (crossings[4] - crossings[0]) == Approx(period).epsilon(1e-3));  // the strings weigh 5e-4 of what they carry
}

namespace {

/// Motion, height and stretch, with the weight in water for the weight [J].
double energy(const LineNetwork& network, std::span<const LineEnds> outer, std::span<const double> state) {
  double sum = 0.0;
  std::size_t first = 0;
  const auto add_mass = [&](double mass, double weight, const LineEnd& at) {
    sum += 0.5 * mass * at.velocity.squaredNorm() + weight * at.position.z();
  };
  for (std::size_t l = 0; l < network.lines.size(); ++l) {
    const LineLumpedMass& line = network.lines[l].line;
    const LineEnds ends = network.ends(l, outer[l], state);
    const std::span<const double> own = state.subspan(first, line.state_size());
    const auto node = [&](int i) -> LineEnd {
      if (i == 0 || i == line.segments) return i == 0 ? ends.anchor : ends.fairlead;
      const double* p = own.data() + 3 * (i - 1);
      return {Eigen::Map<const Vector3d>(p), Eigen::Map<const Vector3d>(p + 3 * line.inner())};
    };
    for (int i = 0; i < line.segments; ++i) {
      const double l0 = line.segment(), stretch = std::max((node(i + 1).position - node(i).position).norm() - l0, 0.0);
      sum += 0.5 * line.axial_stiffness / l0 * stretch * stretch;
      for (const int end : {i, i + 1}) add_mass(0.5 * l0 * line.mass_per_m, 0.5 * l0 * line.weight_per_m(), node(end));
    }
    first += line.state_size();
  }
  for (std::size_t j = 0; j < network.junctions.size(); ++j) {
    const LineJunction& own = network.junctions[j];
    add_mass(own.mass, (own.mass - network.water_density * own.volume) * network.gravity, network.junction(int(j), state));
  }
  return sum;
}

}  // namespace

TEST_CASE("three lines and the weight between them keep their energy, and lose it to water and damping", "[mooring][fast]") {
  const bool lossless = GENERATE(true, false);
  LineNetwork network{
      .lines = {{light_string(90, 2e6), led, 0}, {light_string(80, 2e6), 0, led}, {light_string(80, 2e6), 0, led}},
      .junctions = {{.start = {20.0, 0.0, -80.0}, .mass = 8e3, .volume = 1.0, .drag_area = 3.0}}};
  if (lossless) network.water_density = 1e-9;
  for (LineNetwork::Member& m : network.lines) {
    m.line.mass_per_m = 20.0, m.line.diameter = 0.06;
    m.line.normal_added_mass = 0.0;
    if (lossless) m.line.water_density = 1e-9, m.line.damping_ratio = 0.0;
  }
  network.junctions[0].added_mass = 0.0;
  const std::vector<LineEnds> outer{{at(95, 0, -110), {}}, {{}, at(-40, -10, -30)}, {{}, at(-40, 10, -30)}};
  AtRest r = at_rest(network, outer);
  REQUIRE(r.rest.found());
  const double least = energy(network, outer, r.state);
  for (const std::size_t k : {std::size_t(0), std::size_t(1), std::size_t(2)}) r.state[r.state.size() - 3 + k] = 1.0;
  LineNetwork::Scratch scratch = network.scratch();
  const double start = energy(network, outer, r.state) - least;
  double before = start, rise = 0.0;
  for (int n = 0; n < 400; ++n) {
    network.advance(0.05 * n, 0.05, outer, outer, r.state, StillWater{}, scratch, lossless ? 4 : 1);
    const double now = energy(network, outer, r.state) - least;
    rise = std::max(rise, now - before), before = now;
  }
  INFO(start << " " << before << " " << rise);
  if (lossless)
    CHECK(before == Approx(start).epsilon(1e-3));  // Runge-Kutta's own loss at the stiffest frequencies
  else
    CHECK(before < 0.1 * start);
  CHECK(rise < 1e-5 * start);
}

TEST_CASE("motion of a junction converges with the fourth order in its substeps", "[mooring][fast]") {
  LineNetwork network{.lines = {{light_string(40, 1e6), led, 0}, {light_string(40, 1e6), led, 0}},
                      .junctions = {{.start = {0, 0, -80}, .mass = 4e3, .volume = 1.0, .drag_area = 2.0}}};
  for (LineNetwork::Member& m : network.lines) m.line.mass_per_m = 5.0, m.line.diameter = 0.05, m.line.segments = 3;
  const std::vector<LineEnds> outer{{at(-30, 0, -60), {}}, {at(30, 0, -60), {}}};
  const AtRest start = at_rest(network, outer);
  REQUIRE(start.rest.found());
  const auto end = [&](int finer) {
    std::vector<double> state = start.state;
    for (const std::size_t k : {std::size_t(0), std::size_t(2)}) state[state.size() - 3 + k] = 0.3;  // pushed aside and up
    LineNetwork::Scratch scratch = network.scratch();
    network.advance(0.0, 0.4, outer, outer, state, StillWater{}, scratch, finer);
    return network.junction(0, state).position;
  };
  const Vector3d exact = end(64);
  std::vector<double> h, error;
  for (const int finer : {1, 2, 4, 8}) h.push_back(1.0 / finer), error.push_back((end(finer) - exact).norm());
  INFO(error[0] << " " << error[1] << " " << error[2] << " " << error[3]);
  CHECK(observed_order(h, error) == Approx(4.0).margin(0.5));
}
