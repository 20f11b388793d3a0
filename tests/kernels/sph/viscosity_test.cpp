// Laws of kernels/sph/viscosity_laminar_sps.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/sph/viscosity_laminar_sps.hpp"

#include <catch2/catch.hpp>

#include "kernels/sph/kernel_wendland.hpp"

using namespace spindrift::sph;

TEST_CASE("laminar viscosity of a shear wave on a lattice is nu k^2, better with resolution", "[sph][fast][order]") {
  const double nu = 1e-2, k = 2.0, rho = 1000.0;
  const auto damping_error = [&](double d) {
    const double h = 2.0 * d;
    const KernelWendland<2> kernel(h);
    const ViscosityLaminar<> viscosity{nu};
    double a = 0.0;  // of the crest of v_x = cos(k z)
    for (int i = -6; i <= 6; ++i)
      for (int j = -6; j <= 6; ++j) {
        if (i == 0 && j == 0) continue;
        const auto pair = make_pair(kernel, Vec<double, 2>{i * d, j * d}, Vec<double, 2>{1.0 - std::cos(k * j * d), 0.0});
        a += rho * d * d * viscosity(pair, 1.0 / (2.0 * rho)) * pair.v[0];
      }
    return std::abs(a / (-nu * k * k) - 1.0);
  };
  CHECK(damping_error(0.05) < 0.05);
  CHECK(damping_error(0.025) < damping_error(0.1));
}

TEST_CASE("places of a symmetric tensor do not collide", "[sph][fast]") {
  CHECK(SymmetricTensor<double, 2>::place(1, 0) == 1);
  CHECK(SymmetricTensor<double, 2>::place(1, 1) == 2);
  int seen = 0;
  for (int a = 0; a < 3; ++a)
    for (int b = a; b < 3; ++b) {
      CHECK(SymmetricTensor<double, 3>::place(a, b) == seen++);
      CHECK(SymmetricTensor<double, 3>::place(b, a) == seen - 1);
    }
}

TEST_CASE("the strain rate of a linear flow on a lattice is that flow's", "[sph][fast]") {
  const double d = 0.1, h = 0.2;
  const KernelWendland<3> kernel(h);
  const double g[3][3] = {{0.1, 0.5, -0.3}, {0.2, -0.4, 0.7}, {0.0, 0.6, 0.3}};  // dv_a/dx_b
  SymmetricTensor<double, 3> strain{};
  for (int i = -5; i <= 5; ++i)
    for (int j = -5; j <= 5; ++j)
      for (int k = -5; k <= 5; ++k) {
        const Vec<double, 3> x{i * d, j * d, k * d};
        Vec<double, 3> v{};
        for (int a = 0; a < 3; ++a)
          for (int b = 0; b < 3; ++b) v[a] += g[a][b] * x[b];
        strain.c += (d * d * d) * ViscositySps::strain_terms(make_pair(kernel, x, v)).c;
      }
  for (int a = 0; a < 3; ++a)
    for (int b = a; b < 3; ++b) CHECK(strain(a, b) == Approx(0.5 * (g[a][b] + g[b][a])).epsilon(0.01).margin(0.005));
}

TEST_CASE("the sub-particle stress of pure shear is Smagorinsky's and its pair force is antisymmetric", "[sph][fast]") {
  SymmetricTensor<double, 2> strain{};
  strain(0, 1) = 0.5 * 3.0;  // dv_x/dz = 3
  const auto tau = ViscositySps{}.stress(strain, 0.1);
  CHECK(tau(0, 1) == Approx(0.12 * 0.12 * 0.01 * 3.0 * 3.0));
  CHECK(tau(0, 0) == Approx(-2.0 / 3.0 * 0.0066 * 0.01 * 9.0));
  const KernelWendland<2> kernel(0.2);
  const Vec<double, 2> x{0.1, 0.05};
  const auto ij = ViscositySps::acceleration(make_pair(kernel, x, Vec<double, 2>{}), tau);
  const auto ji = ViscositySps::acceleration(make_pair(kernel, Vec<double, 2>{} - x, Vec<double, 2>{}), tau);
  for (int k = 0; k < 2; ++k) CHECK(ij[k] == -ji[k]);
}
