// What a lattice of particles under pressure does against a shear that changes no volume. Pressure acts along the gradient of the
// sum of kernels: where that sum changes under shear the lattice holds an energy of beta strain^2 times the pressure, as an
// elastic body would; water has none. By energy it raises the frequency of waves by about (beta_pure + beta_simple)/4
// (docs/developer/notes/sea_physics.md). SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>

#include "kernels/sph/kernel_quintic.hpp"
#include "kernels/sph/kernel_wendland.hpp"

using namespace spindrift::sph;

namespace {

/// Sum of V W over a square lattice of spacing 1 under the strain [[xx, xz], [xz, zz]].
template <class Kernel>
double filled(double h, double xx, double xz, double zz) {
  const Kernel kernel(h);
  double sum = 0.0;
  for (int i = -8; i <= 8; ++i)
    for (int j = -8; j <= 8; ++j) {
      const double x = xx * i + xz * j, z = xz * i + zz * j;
      sum += kernel.value(std::max(x * x + z * z, 1e-20));
    }
  return sum;
}

struct Stiffness {
  double pure, simple;  ///< beta along the axes of the lattice, along its diagonals
};
template <class Kernel = KernelWendland<2>>
Stiffness stiffness(double h_over_d, double strain) {
  const double rest = filled<Kernel>(h_over_d, 1.0, 0.0, 1.0), c = std::cosh(strain), s = std::sinh(strain);
  return {(filled<Kernel>(h_over_d, c + s, 0.0, c - s) - rest) / (strain * strain),
          (filled<Kernel>(h_over_d, c, s, c) - rest) / (strain * strain)};
}

}  // namespace

TEST_CASE("a lattice of particles is stiff at a support of 3 spacings, a fifth as much at 5", "[sph][fast]") {
  const double strain = 0.01;
  const Stiffness narrow = stiffness(1.5, strain), wide = stiffness(2.5, strain);
  CHECK(narrow.pure == Approx(0.047).margin(0.001));
  CHECK(narrow.simple == Approx(-0.023).margin(0.001));  // it gives way: particles leave their lattice, which costs energy
  CHECK(std::abs(wide.pure) < 0.2 * narrow.pure);
  CHECK(std::abs(wide.simple) < 0.1 * std::abs(narrow.simple));
}

TEST_CASE("below a support of 2.6 spacings a lattice gives way under shear by a tenth of its pressure", "[sph][fast]") {
  CHECK(stiffness(1.2, 0.01).simple < -0.09);
}

TEST_CASE("by the quintic spline it has a third of that stiffness at a support of 3 spacings, and never gives way",
          "[sph][fast]") {
  const Stiffness quintic = stiffness<KernelQuintic<2>>(1.5, 0.01);
  CHECK(quintic.pure == Approx(0.0013).margin(5e-4));
  CHECK(quintic.simple == Approx(-0.0088).margin(5e-4));
}
