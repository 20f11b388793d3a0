// Instruments on particles whose answer is known: a level and a sloping surface, hydrostatic pressure, uniform flow.
// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/gauges.hpp"

#include <catch2/catch.hpp>

#include "kernels/base/constants.hpp"
#include "src/sea/sph/lattice.hpp"
#include "src/sea/sph/ordering.hpp"

using namespace spindrift;
using namespace spindrift::sph;

namespace {

template <int dim>
struct Water {
  Parameters p;
  Domain<dim> domain;
  Store<dim, float> store;

  /// `spray`: heights of single particles over the place (1, 1).
  explicit Water(double spacing, double slope, std::array<double, dim> velocity = {}, const std::vector<double>& spray = {}) {
    p.spacing = spacing, p.h_over_d = 1.5, p.eos = {1000.0, 40.0};
    domain.low.fill(-1.0), domain.high.fill(3.0), domain.high[dim - 1] = 6.0;
    std::vector<Seed<dim>> seeds;
    for (const double z : spray) {
      seeds.emplace_back().position.fill(1.01);
      seeds.back().position[dim - 1] = z;
    }
    std::array<int, dim> low{}, high;
    high.fill(int(std::lround(2.0 / spacing)));
    std::array<double, dim> origin;
    origin.fill(0.5 * spacing);
    for_lattice<dim>(low, high, [&](const std::array<int, dim>& index) {
      Seed<dim> seed{.position = lattice_point<dim>(origin, spacing, index), .velocity = velocity};
      const double surface = 1.0 + slope * (seed.position[0] - 1.0);
      if (seed.position[dim - 1] > surface) return;
      seed.deviation = p.eos.hydrostatic_deviation(surface - seed.position[dim - 1], p.gravity);
      seeds.push_back(seed);
    });
    fill<dim, float>(store, seeds, Columns<dim>(domain, 2.0 * p.reach(), 2.0 * p.reach()), p.anchor_step());
  }
  double height(double x, double y = 1.0) const {
    std::array<double, dim - 1> place;
    place.fill(y), place[0] = x;
    return surface_heights<dim>(store, p, domain, std::span(&place, 1), -9.0)[0];
  }
};

}  // namespace

TEST_CASE("a gauge reads a level surface within a twentieth of a spacing, in 2-D and 3-D, beside a wall too",
          "[sea][sph][fast]") {
  const Water<2> plane(0.05, 0.0);
  for (double x : {0.02, 0.4, 1.0, 1.013}) CHECK(plane.height(x) == Approx(1.0).margin(0.0025));
  const Water<3> space(0.1, 0.0);
  for (double x : {0.7, 1.0, 1.03}) CHECK(space.height(x) == Approx(1.0).margin(0.005));
  for (double y : {0.0, 0.02, 0.1}) CHECK(space.height(0.0, y) == Approx(1.0).margin(0.005));  // in a corner
}

TEST_CASE("a gauge reads a slope of lattice stairs within half a spacing and nothing where there is no water",
          "[sea][sph][fast]") {
  const Water<2> plane(0.05, 0.2);
  for (double x : {0.4, 0.8, 1.2, 1.6}) CHECK(plane.height(x) == Approx(1.0 + 0.2 * (x - 1.0)).margin(0.025));
  CHECK(plane.height(2.6) == -9.0);
}

namespace {

/// Within a twentieth of a spacing under spray so many smoothing lengths above.
template <int dim>
void reads_level_under_spray(double spacing) {
  const double h = 1.5 * spacing;
  for (const std::vector<double>& above : std::vector<std::vector<double>>{{1.5}, {3}, {4}, {5}, {9}, {20}, {2.5, 5, 9, 11}}) {
    std::vector<double> spray;
    for (const double n : above) spray.push_back(1.0 + n * h);
    CAPTURE(dim, above);
    CHECK(Water<dim>(spacing, 0.0, {}, spray).height(1.0) == Approx(1.0).margin(0.05 * spacing));
  }
}

}  // namespace

TEST_CASE("a gauge reads the level under spray, and nothing where there is spray alone", "[sea][sph][fast]") {
  reads_level_under_spray<2>(0.05);
  reads_level_under_spray<3>(0.1);
  CHECK(Water<2>(0.05, 0.0, {}, {1.5}).height(2.6) == -9.0);
  CHECK(Water<2>(0.05, -9.0, {}, {1.5, 2.5}).height(1.9) == -9.0);
}

TEST_CASE("a gauge beside sides that repeat sees the water of both", "[sea][sph][fast]") {
  Parameters p;
  p.spacing = 0.05, p.h_over_d = 1.5, p.eos = {1000.0, 40.0};
  Domain<2> domain;
  domain.low.fill(0.0), domain.high.fill(4.0), domain.periodic = {true, false};
  std::vector<Seed<2>> seeds;
  for (int i = 0; i < 80; ++i)
    for (int k = 0; k < 30; ++k) {
      const Seed<2> seed{.position = {(i + 0.5) * p.spacing, (k + 0.5) * p.spacing}};
      if (seed.position[1] < 1.0 + 0.2 * std::sin(pi * seed.position[0])) seeds.push_back(seed);  // two waves
    }
  Store<2, double> store;
  fill<2, double>(store, seeds, Columns<2>(domain, 2.0 * p.reach(), 2.0 * p.reach()), p.anchor_step());
  for (const double x : {0.001, 0.04, 0.1, 1.9, 1.96, 1.999}) {
    const std::vector<std::array<double, 1>> places{{x}, {x + 2.0}};
    const std::vector<double> read = surface_heights<2>(store, p, domain, std::span(places), -9.0);
    CHECK(read[0] == Approx(read[1]).margin(1e-12));
  }
}

TEST_CASE("a probe reads hydrostatic pressure within 1 % of the depth's, also at a wall, and the flow's velocity",
          "[sea][sph][fast]") {
  const Water<2> water(0.05, 0.0, {0.7, -0.2});
  for (const std::array<double, 2> at : {std::array{1.0, 0.5}, {0.0, 0.3}, {1.02, 0.97}}) {
    const auto reading = probe<2>(water.store, water.p, water.domain, at);
    const double expected = water.p.eos.pressure(water.p.eos.hydrostatic_deviation(1.0 - at[1], water.p.gravity));
    CHECK(reading.pressure == Approx(expected).margin(0.01 * 9810.0));
    CHECK(reading.velocity[0] == Approx(0.7));
    CHECK(reading.velocity[1] == Approx(-0.2));
  }
  for (const double over : {0.01, 0.03, 0.05})
    CHECK(probe<2>(water.store, water.p, water.domain, {1.0, 1.0 + over}).pressure == 0.0);  // of weight alone
  const auto dry = probe<2>(water.store, water.p, water.domain, {1.0, 1.8});
  CHECK(dry.pressure == 0.0);
  CHECK(std::isnan(dry.velocity[0]));
}
