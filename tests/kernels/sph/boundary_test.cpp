// Laws of the wall treatments.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/sph/boundary_modified.hpp"

#include <catch2/catch.hpp>

#include <random>

#include "kernels/sph/boundary_dynamic.hpp"
#include "kernels/sph/boundary_extrapolated.hpp"
#include "kernels/sph/kernel_quintic.hpp"
#include "kernels/sph/kernel_wendland.hpp"

using namespace spindrift::sph;

namespace {

template <int dim>
void gather(Vec<double, BoundaryModified<dim>::planes>& sums, const Vec<double, dim>& x, double volume, double h,
            double deviation, const Vec<double, dim>& velocity) {
  const KernelWendland<dim> kernel(h);
  const double r2 = std::max(dot(x, x), 1e-30);
  Vec<double, dim + 1> fields{deviation};
  for (int k = 0; k < dim; ++k) fields[k + 1] = velocity[k];
  sums += BoundaryModified<dim>::pair_terms(x, kernel.value(r2), kernel.slope(r2), volume, fields, h, 1.0 / h);
}

/// Sums at a ghost node 1.2 spacings into water that fills z > 0, of a deviation f(particle - node) and the velocity 2 f.
template <int dim, class Field>
Vec<double, BoundaryModified<dim>::planes> moments(Field&& field, double d, double h) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-0.2 * d, 0.2 * d);
  Vec<double, BoundaryModified<dim>::planes> sums{};
  for (int a = -5; a <= 5; ++a)
    for (int b = 0; b <= 6; ++b)
      for (int c = dim == 3 ? -5 : 0; c <= (dim == 3 ? 5 : 0); ++c) {
        Vec<double, dim> particle;
        particle[0] = a * d + unit(random), particle[dim - 1] = (b + 0.5) * d + unit(random);
        if constexpr (dim == 3) particle[1] = c * d + unit(random);
        Vec<double, dim> x = Vec<double, dim>{} - particle;
        x[dim - 1] += 1.2 * d;
        const double f = field(Vec<double, dim>{} - x);
        gather<dim>(sums, x, std::pow(d, dim), h, f, Vec<double, dim>{2.0 * f});
      }
  return sums;
}

}  // namespace

TEST_CASE("an extrapolated wall has the pressure of water at rest at its place, and nothing without water", "[sph][fast]") {
  using Boundary = BoundaryExtrapolated<2, true>;
  const double rho = 1000.0, g = 9.81, d = 0.1;
  const KernelWendland<2> kernel(0.15);
  const Vec<double, 2> gravity{0.0, -g}, wall{0.02, -0.13};
  Vec<double, Boundary::planes> sums{};
  for (int a = -4; a <= 4; ++a)
    for (int b = 0; b < 4; ++b) {
      const Vec<double, 2> water{a * d, (b + 0.5) * d};
      const Vec<double, 2> x = wall - water;
      Boundary::add(sums, x, kernel.value(dot(x, x)), 5000.0 - rho * g * water[1], rho, Vec<double, 2>{1.0, 2.0});
    }
  CHECK(Boundary::pressure(sums, gravity, 1e-6) == Approx(5000.0 + rho * g * 0.13).epsilon(1e-12));
  CHECK(Boundary::velocity(sums, 0, 0.25, 1e-6) == Approx(2.0 * 0.25 - 1.0));
  CHECK(Boundary::pressure(Vec<double, Boundary::planes>{}, gravity, 1e-6) == 0.0);
  CHECK(Boundary::velocity(Vec<double, Boundary::planes>{}, 1, 0.25, 1e-6) == 0.25);
}

TEST_CASE("weight does not make an extrapolated wall pull more than the water presses, water under tension does", "[sph][fast]") {
  using Boundary = BoundaryExtrapolated<2, false>;
  const KernelWendland<2> kernel(0.15);
  const Vec<double, 2> gravity{0.0, -9.81}, above{0.0, 0.1};
  const auto ceiling = [&](double pressure) {
    Vec<double, Boundary::planes> sums{};
    Boundary::add(sums, above, kernel.value(0.01), pressure, 1000.0, Vec<double, 2>{});
    return Boundary::pressure(sums, gravity, 1e-6);
  };
  CHECK(ceiling(0.0) == 0.0);
  CHECK(ceiling(100.0) == Approx(-100.0));  // and so no force
  CHECK(ceiling(2000.0) == Approx(2000.0 - 981.0));
  CHECK(ceiling(-300.0) == Approx(-300.0));
}

TEST_CASE("water at its waterline does not lift an upright wall", "[sph][fast]") {
  // Water at rest left of x = 0 and below z = 0, a wall to the right that reaches over it; lengths in spacings, rho g = 1. Lift
  // of the wall over that by the mirror image of the water, in d^2 per length of waterline: a float displaces so much too much.
  const double h = 1.5, offset = GENERATE(0.0, 0.25, 0.5, 0.75);
  using Boundary = BoundaryExtrapolated<2, false>;
  const KernelQuintic<2> kernel(h);
  double lift = 0.0;
  for (int column = 0; column < 3; ++column)
    for (int row = -8; row < 4; ++row) {
      const Vec<double, 2> wall{column + 0.5, row + 0.5 - offset};
      const auto for_water = [&](auto&& visit) {
        for (int a = 0; a < 3; ++a)
          for (int b = 0; b < 12; ++b) {
            const Vec<double, 2> x = wall - Vec<double, 2>{-a - 0.5, -b - 0.5};
            visit(x, b + 0.5, std::max(dot(x, x), 1e-30));
          }
      };
      Vec<double, Boundary::planes> sums{};
      for_water([&](const Vec<double, 2>& x, double p, double r2) {
        Boundary::add(sums, x, kernel.value(r2), p, 1.0, Vec<double, 2>{});
      });
      const double p_wall = Boundary::pressure(sums, Vec<double, 2>{0.0, -1.0}, 1e-9), p_mirror = -wall[1];
      for_water([&](const Vec<double, 2>& x, double p, double r2) {
        lift -= (p + p_wall) * kernel.slope(r2) * x[1];
        if (wall[1] < 0.0) lift += (p + p_mirror) * kernel.slope(r2) * x[1];
      });
    }
  CHECK(std::abs(lift) < (offset == 0.5 ? 0.12 : 0.03));  // without tension .06 to .14; a row at the level itself still presses
}

TEST_CASE("walls push and never pull", "[sph][fast]") {
  CHECK(boundary_dynamic(-3.0) == 0.0);
  CHECK(boundary_dynamic(2.0f) == 2.0f);
}

TEST_CASE("a modified boundary continues a linear field through the wall exactly", "[sph][fast]") {
  const double d = 0.1, h = 0.15;
  const auto linear2 = [](const Vec<double, 2>& x) { return 4.0 + 3.0 * x[0] - 7.0 * x[1]; };
  const auto seen2 = BoundaryModified<2>::seen(moments<2>(linear2, d, h), {0.05, -0.24}, h);
  CHECK(seen2.water);
  CHECK(seen2.deviation == Approx(linear2({0.05, -0.24})).epsilon(1e-10));
  CHECK(seen2.velocity[0] == Approx(2.0 * linear2({})).epsilon(1e-10));
  const auto linear3 = [](const Vec<double, 3>& x) { return 4.0 + 3.0 * x[0] - 7.0 * x[2] + 2.0 * x[1]; };
  const auto seen3 = BoundaryModified<3>::seen(moments<3>(linear3, d, h), {0.05, 0.1, -0.24}, h);
  CHECK(seen3.deviation == Approx(linear3({0.05, 0.1, -0.24})).epsilon(1e-10));
}

TEST_CASE("a ghost node in the air sees no water, one with a lone particle that particle's state", "[sph][fast]") {
  Vec<double, BoundaryModified<3>::planes> sums{};
  CHECK_FALSE(BoundaryModified<3>::seen(sums, {0, 0, -0.2}, 0.15).water);
  gather<3>(sums, {0.02, 0.0, 0.03}, 1e-3, 0.15, 2.5, {1, 2, 3});
  const auto seen = BoundaryModified<3>::seen(sums, {0, 0, -0.2}, 0.15);
  CHECK(seen.water);
  CHECK(seen.deviation == Approx(2.5));
  CHECK(seen.velocity[1] == Approx(2.0));
}

TEST_CASE("the velocity halfway between water and a modified wall is the wall's, or its normal part", "[sph][fast]") {
  const Vec<double, 3> water{1.0, 2.0, 3.0}, wall{0.5, 0.0, -1.0}, normal{0, 0, 1};
  const auto stick = BoundaryModified<3>::velocity(water, wall, normal, false),
             slide = BoundaryModified<3>::velocity(water, wall, normal, true);
  for (int k = 0; k < 3; ++k) CHECK(0.5 * (stick[k] + water[k]) == Approx(wall[k]));
  CHECK(0.5 * (slide[2] + water[2]) == Approx(wall[2]));
  CHECK(slide[0] == Approx(water[0]));
}
