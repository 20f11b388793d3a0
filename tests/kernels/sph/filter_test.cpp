// Consistency of the density filters and of particle shifting on disordered neighbourhoods, cut by a surface or not.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include <random>
#include <vector>

#include "kernels/sph/filter_mls.hpp"
#include "kernels/sph/filter_shepard.hpp"
#include "kernels/sph/kernel_wendland.hpp"
#include "kernels/sph/shifting.hpp"

using namespace spindrift::sph;

namespace {

constexpr double d = 0.1, h = 0.15;

/// Offsets x_i - x_j of partners in a disordered lattice round the origin, only those below `surface`; the particle itself first.
template <int dim>
std::vector<Vec<double, dim>> neighbourhood(double disorder, double surface = 1e9) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-disorder * d, disorder * d);
  std::vector<Vec<double, dim>> offsets{Vec<double, dim>{}};
  const int n = 4;
  for (int a = -n; a <= n; ++a)
    for (int b = -n; b <= n; ++b)
      for (int c = dim == 3 ? -n : 0; c <= (dim == 3 ? n : 0); ++c) {
        if (a == 0 && b == 0 && c == 0) continue;
        Vec<double, dim> x;
        x[0] = a * d + unit(random), x[dim - 1] = b * d + unit(random);
        if constexpr (dim == 3) x[1] = c * d + unit(random);
        if (-x[dim - 1] < surface) offsets.push_back(x);
      }
  return offsets;
}

double value(const KernelWendland<2>& k, const Vec<double, 2>& x) { return k.value(std::max(dot(x, x), 1e-30)); }
double value(const KernelWendland<3>& k, const Vec<double, 3>& x) { return k.value(std::max(dot(x, x), 1e-30)); }

template <int dim, class Density>
double mls(const std::vector<Vec<double, dim>>& offsets, Density&& rho) {
  const KernelWendland<dim> kernel(h);
  Vec<double, FilterMls<dim>::planes> sums{};
  for (const auto& x : offsets) {
    // Any volumes do: here those of particles of one mass.
    sums += FilterMls<dim>::pair_terms(value(kernel, x), 1.0 / rho(x), rho(x), x, 1.0 / h);
  }
  return FilterMls<dim>::value(sums);
}

}  // namespace

TEST_CASE("the Shepard filter keeps a constant density at any surface and disorder", "[sph][fast]") {
  const KernelWendland<3> kernel(h);
  for (double surface : {1e9, 0.05, -0.05}) {
    Vec<double, 2> sums{};
    for (const auto& x : neighbourhood<3>(0.25, surface))
      sums += FilterShepard::pair_terms(value(kernel, x), 1.0 / 1017.0, 1017.0);
    CHECK(FilterShepard::value(sums) == Approx(1017.0).epsilon(1e-13));
  }
}

TEST_CASE("the MLS filter keeps a linear density at any surface and disorder", "[sph][fast]") {
  const auto rho2 = [](const Vec<double, 2>& x) { return 1000.0 - 30.0 * x[0] + 70.0 * x[1]; };
  const auto rho3 = [](const Vec<double, 3>& x) { return 1000.0 - 30.0 * x[0] + 70.0 * x[1] + 11.0 * x[2]; };
  for (double surface : {1e9, 0.05}) {
    CHECK(mls<2>(neighbourhood<2>(0.25, surface), rho2) == Approx(1000.0).epsilon(1e-12));
    CHECK(mls<3>(neighbourhood<3>(0.25, surface), rho3) == Approx(1000.0).epsilon(1e-12));
  }
}

TEST_CASE("the MLS filter of too few partners is the Shepard filter", "[sph][fast]") {
  const std::vector<Vec<double, 3>> line{{0, 0, 0}, {0.1, 0, 0}, {-0.1, 0, 0}};
  CHECK(mls<3>(line, [](const auto&) { return 1003.0; }) == Approx(1003.0));
  CHECK(mls<3>({{0, 0, 0}}, [](const auto&) { return 990.0; }) == Approx(990.0));
}

TEST_CASE("shifting leaves a lattice alone, levels disorder and stops at the surface", "[sph][fast]") {
  const KernelWendland<2> kernel(h);
  const Shifting<2> shifting;
  const auto sums = [&](const std::vector<Vec<double, 2>>& offsets) {
    Vec<double, 3> s{};
    for (const auto& x : offsets) s += (d * d) * Shifting<2>::pair_terms(make_pair(kernel, x, Vec<double, 2>{}));
    return s;
  };
  const auto even = sums(neighbourhood<2>(0.0));
  CHECK(std::hypot(even[0], even[1]) < 1e-12);
  CHECK(even[2] == Approx(2.0).epsilon(0.02));
  const auto crowded = [&] {  // one partner too near on the right
    auto offsets = neighbourhood<2>(0.0);
    offsets.push_back({-0.5 * d, 0.0});
    return sums(offsets);
  }();
  const auto dx = shifting.shift({crowded[0], crowded[1]}, crowded[2], 1.0, h, 1e-3);
  CHECK(dx[0] < 0.0);
  CHECK(std::abs(dx[1]) < 1e-12);
  const auto cut = sums(neighbourhood<2>(0.0, 0.05));
  CHECK(shifting.depth(cut[2]) == 0.0);
  const auto none = shifting.shift({cut[0], cut[1]}, cut[2], 1.0, h, 1e-3);
  CHECK(std::hypot(none[0], none[1]) == 0.0);
  const auto most = shifting.shift({1e9, 0.0}, 2.0, 1.0, h, 1.0);
  CHECK(std::hypot(most[0], most[1]) == Approx(0.1 * h));
}
