// Beds that are no plane, kernels/mooring/bed.hpp, and lines on them. SPDX-License-Identifier: Apache-2.0
#include "kernels/mooring/bed.hpp"

#include <catch2/catch.hpp>

#include "kernels/mooring/line_network.hpp"

using namespace spindrift;
using Eigen::Vector3d;

namespace {

constexpr double slope = 0.3;  // rise per way along x

std::shared_ptr<const Bed> inclined(double x_per_y = 0.0) {
  std::vector<double> z;
  for (const double y : {-500.0, 0.0, 600.0})
    for (const double x : {-1000.0, -200.0, 1000.0}) z.push_back(-300.0 + slope * (x + x_per_y * y));
  return std::make_shared<const Bed>(std::vector<double>{-1000.0, -200.0, 1000.0}, std::vector<double>{-500.0, 0.0, 600.0}, z);
}

LineLumpedMass chain_on(std::shared_ptr<const Bed> bed) {
  LineLumpedMass line;
  line.length = 200.0, line.segments = 40, line.diameter = 0.2, line.mass_per_m = 250.0, line.axial_stiffness = 1e9;
  line.bed.shape = std::move(bed);
  return line;
}

struct Resting {
  std::vector<double> state;
  LineForces forces;
  bool found;
};
Resting rest(const LineLumpedMass& line, const LineEnds& ends) {
  const LineNetwork network{.lines = {{line}}};
  Resting r{std::vector<double>(network.state_size()), {}, false};
  const std::vector<LineEnds> outer{ends};
  r.found = network.rest(outer, r.state).found();
  LineNetwork::Scratch scratch = network.scratch();
  std::vector<double> rate(r.state.size());
  network.rates(0.0, outer, r.state, rate, StillWater{}, scratch);
  r.forces = scratch.forces[0];
  return r;
}

}  // namespace

TEST_CASE("a bed's level is that of its table, straight between and level beyond, its normal square to it", "[mooring][fast]") {
  const auto bed = inclined(0.5);
  CHECK(bed->level(-200.0, 0.0) == Approx(-360.0));
  CHECK(bed->level(100.0, 80.0) == Approx(-300.0 + slope * 140.0));
  CHECK(bed->level(5000.0, 0.0) == Approx(0.0));
  CHECK(bed->highest() == Approx(90.0));
  CHECK((bed->normal(10.0, 20.0) - Vector3d(-slope, -0.5 * slope, 1.0).normalized()).norm() < 1e-12);
  CHECK((bed->normal(5000.0, 20.0) - Vector3d(0.0, -0.5 * slope, 1.0).normalized()).norm() < 1e-12);
  CHECK((bed->covers(1000.0, -500.0) && !bed->covers(1001.0, 0.0) && !bed->covers(0.0, 601.0)));
}

TEST_CASE("a line that lies on a slope hangs on its upper end by its weight along it, and the slope carries the rest",
          "[mooring][fast]") {
  const double x_per_y = GENERATE(0.0, 0.7);
  const LineLumpedMass line = chain_on(inclined(x_per_y));
  const Vector3d normal = line.bed.shape->normal(1.0, 1.0), up = (Vector3d::UnitZ() - normal.z() * normal).normalized();
  const double weight = line.weight_per_m(), sine = up.z();
  // Pulled straight up the slope, sunk in by what the bed gives under the part of the weight that is square to it.
  const double sunk = weight * normal.z() / (line.bed.stiffness * line.diameter), pull = 2e5;
  const double stretched =
      line.length + (pull * line.length + 0.5 * weight * sine * line.length * line.length) / line.axial_stiffness;
  const Vector3d low(-100.0, 0.0, line.bed.shape->level(-100.0, 0.0));
  const auto end = [&](double along) { return LineEnd{low + along * up - sunk * normal, Vector3d::Zero()}; };
  const Resting r = rest(line, {end(0.0), end(stretched)});
  REQUIRE(r.found);
  CHECK(r.forces.on_anchor.dot(up) == Approx(pull).epsilon(1e-3));
  CHECK(-r.forces.on_fairlead.dot(up) == Approx(pull + weight * sine * line.length).epsilon(1e-3));
  for (int i = 1; i < line.segments; ++i) {
    const Vector3d node = Eigen::Map<const Vector3d>(r.state.data() + 3 * (i - 1));
    CHECK((node - low).dot(normal) == Approx(-sunk).epsilon(1e-3));
  }
}

TEST_CASE("a chain leaves a slope where the catenary from there leaves it along the slope", "[mooring][fast]") {
  // Laid down the slope from its anchor and up to its fairlead: without friction the tension along the slope is
  // T = T_a - w (height of the anchor over the point) on the bed, and w times the height over the point where it leaves beyond.
  LineLumpedMass line = chain_on(inclined());
  line.length = 420.0, line.segments = 200;
  const Vector3d anchor(400.0, 0.0, line.bed.shape->level(400.0, 0.0)), fairlead(30.0, 0.0, -150.0);
  const Resting r = rest(line, {{anchor, Vector3d::Zero()}, {fairlead, Vector3d::Zero()}});
  REQUIRE(r.found);
  // On the bed and in the water dT = w dz alike: between the ends it is the difference of their heights.
  CHECK(r.forces.fairlead_tension - r.forces.anchor_tension ==
        Approx(line.weight_per_m() * (fairlead.z() - anchor.z())).epsilon(0.01));
  int laid = 0;
  for (int i = 1; i < line.segments; ++i) {
    const Vector3d node = Eigen::Map<const Vector3d>(r.state.data() + 3 * (i - 1));
    laid += line.bed.depth(node) > 0.0;
  }
  CHECK((laid > 20 && laid < 180));
}

TEST_CASE("a chain that slides down a slope comes to rest by friction, and not without", "[mooring][fast]") {
  const double friction = GENERATE(0.0, 0.6);  // the slope is 0.3
  LineLumpedMass line = chain_on(inclined());
  line.length = 40.0, line.segments = 8, line.bed.friction = friction;
  const LineNetwork network{.lines = {{line, 0, 1}}, .junctions = {LineJunction{}, LineJunction{}}};
  std::vector<double> state(network.state_size());
  const Vector3d up = Vector3d(1.0, 0.0, slope).normalized(), low(0.0, 0.0, line.bed.shape->level(0.0, 0.0));
  const auto at = [&](int i) { return Vector3d(low + line.segment() * i * up - Vector3d(0.0, 0.0, 0.004)); };
  for (int i = 1; i < line.segments; ++i) Eigen::Map<Vector3d>(state.data() + 3 * (i - 1)) = at(i);
  Eigen::Map<Vector3d>(state.data() + network.first_of_junctions()) = at(0);
  Eigen::Map<Vector3d>(state.data() + network.first_of_junctions() + 3) = at(line.segments);
  LineNetwork::Scratch scratch = network.scratch();
  const std::vector<LineEnds> outer{{}};
  for (int n = 0; n < 100; ++n) network.advance(0.02 * n, 0.02, outer, outer, state, StillWater{}, scratch);
  const double moved = (at(0) - network.junction(0, state).position).dot(up);
  if (friction > 0.0)
    CHECK(std::abs(moved) < 0.03);  // creep
  else
    CHECK(moved > 1.0);
}

TEST_CASE("a flat table is a flat bed", "[mooring][fast]") {
  LineLumpedMass level, table;
  level.length = 760.0, level.segments = 40, level.diameter = 0.252, level.mass_per_m = 390.0, level.axial_stiffness = 1.674e9;
  table = level;
  level.bed.level = -200.0;
  table.bed.shape = std::make_shared<const Bed>(std::vector<double>{0.0, 1000.0}, std::vector<double>{0.0},
                                                std::vector<double>{-200.0, -200.0});
  const LineEnds ends{{{700, 0, -200}, {0, 0, 0}}, {{0, 0, 0}, {0, 0, 0}}};
  const Resting a = rest(level, ends), b = rest(table, ends);
  REQUIRE((a.found && b.found));
  CHECK((a.forces.on_fairlead - b.forces.on_fairlead).norm() < 1e-9 * a.forces.fairlead_tension);
}
