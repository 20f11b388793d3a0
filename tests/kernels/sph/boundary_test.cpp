// Laws of the wall treatments.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/sph/boundary_modified.hpp"

#include <catch2/catch.hpp>

#include <random>

#include "kernels/sph/boundary_dynamic.hpp"
#include "kernels/sph/kernel_wendland.hpp"

using namespace spindrift::sph;

namespace {

/// Moments at a ghost node 1.2 spacings into water that fills z > 0, of a field f(particle - node).
template <int dim, class Field>
typename BoundaryModified<dim>::Moments moments(Field&& field, double d, double h) {
  const KernelWendland<dim> kernel(h);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-0.2 * d, 0.2 * d);
  typename BoundaryModified<dim>::Moments m;
  for (int a = -5; a <= 5; ++a)
    for (int b = 0; b <= 6; ++b)
      for (int c = dim == 3 ? -5 : 0; c <= (dim == 3 ? 5 : 0); ++c) {
        Vec<double, dim> particle;
        particle[0] = a * d + unit(random), particle[dim - 1] = (b + 0.5) * d + unit(random);
        if constexpr (dim == 3) particle[1] = c * d + unit(random);
        Vec<double, dim> x = Vec<double, dim>{} - particle;
        x[dim - 1] += 1.2 * d;
        const double r2 = std::max(dot(x, x), 1e-30);
        BoundaryModified<dim>::gather(m, x, kernel.value(r2), kernel.slope(r2), std::pow(d, dim), field(Vec<double, dim>{} - x));
      }
  return m;
}

}  // namespace

TEST_CASE("walls push and never pull", "[sph][fast]") {
  CHECK(boundary_dynamic(-3.0) == 0.0);
  CHECK(boundary_dynamic(2.0f) == 2.0f);
}

TEST_CASE("a modified boundary continues a linear field through the wall exactly", "[sph][fast]") {
  const double d = 0.1, h = 0.15;
  const auto linear2 = [](const Vec<double, 2>& x) { return 4.0 + 3.0 * x[0] - 7.0 * x[1]; };
  CHECK(BoundaryModified<2>::value(moments<2>(linear2, d, h), {0.05, -0.24}, h, 0.0) ==
        Approx(linear2({0.05, -0.24})).epsilon(1e-10));
  const auto linear3 = [](const Vec<double, 3>& x) { return 4.0 + 3.0 * x[0] - 7.0 * x[2] + 2.0 * x[1]; };
  CHECK(BoundaryModified<3>::value(moments<3>(linear3, d, h), {0.05, 0.1, -0.24}, h, 0.0) ==
        Approx(linear3({0.05, 0.1, -0.24})).epsilon(1e-10));
}

TEST_CASE("a ghost node in the air gives the wall its rest value, one with a lone particle that particle's", "[sph][fast]") {
  BoundaryModified<3>::Moments m;
  CHECK(BoundaryModified<3>::value(m, {0, 0, -0.2}, 0.15, 7.5) == 7.5);
  const KernelWendland<3> kernel(0.15);
  const Vec<double, 3> x{0.02, 0.0, 0.03};
  BoundaryModified<3>::gather(m, x, kernel.value(dot(x, x)), kernel.slope(dot(x, x)), 1e-3, 2.5);
  CHECK(BoundaryModified<3>::value(m, {0, 0, -0.2}, 0.15, 7.5) == Approx(2.5));
}

TEST_CASE("the velocity halfway between water and a modified wall is the wall's, or its normal part", "[sph][fast]") {
  const Vec<double, 3> water{1.0, 2.0, 3.0}, wall{0.5, 0.0, -1.0}, normal{0, 0, 1};
  const auto stick = BoundaryModified<3>::velocity(water, wall, normal, false),
             slide = BoundaryModified<3>::velocity(water, wall, normal, true);
  for (int k = 0; k < 3; ++k) CHECK(0.5 * (stick[k] + water[k]) == Approx(wall[k]));
  CHECK(0.5 * (slide[2] + water[2]) == Approx(wall[2]));
  CHECK(slide[0] == Approx(water[0]));
}
