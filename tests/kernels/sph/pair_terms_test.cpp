// Laws of the pair terms in kernels/sph: exchange of partners, directions of dissipation, one value each worked out by hand.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "kernels/sph/continuity.hpp"
#include "kernels/sph/density_diffusion_fourtakas.hpp"
#include "kernels/sph/density_diffusion_molteni.hpp"
#include "kernels/sph/kernel_wendland.hpp"
#include "kernels/sph/momentum.hpp"
#include "kernels/sph/viscosity_artificial.hpp"

using namespace spindrift::sph;

namespace {

using V3 = Vec<double, 3>;
const KernelWendland<3> kernel(0.1);
const V3 xi{0.03, -0.02, 0.11}, xj{-0.01, 0.04, 0.02}, vi{0.3, -0.4, 0.1}, vj{0.1, 0.2, -0.5};

double inverse_of(const Pair<double, 3>& pair, double rho_sum) { return 1.0 / (rho_sum * (pair.r2 + softening(0.1))); }

}  // namespace

TEST_CASE("every pair term keeps its law when the partners are exchanged", "[sph][fast]") {
  const auto ij = make_pair(kernel, xi - xj, vi - vj), ji = make_pair(kernel, xj - xi, vj - vi);
  CHECK(continuity(ij) == continuity(ji));
  CHECK(momentum_symmetric(ij, 3.0, 5.0, 0.1) == momentum_symmetric(ji, 5.0, 3.0, 0.1));  // times x_ij: antisymmetric
  const ViscosityArtificial<> viscosity{0.1, 30.0, 0.1};
  CHECK(viscosity(ij, inverse_of(ij, 2010.0)) == viscosity(ji, inverse_of(ji, 2010.0)));
  const DensityDiffusionMolteni<> molteni{0.1, 30.0, 0.1};
  CHECK(molteni(ij, 4.0, 6.0, inverse_of(ij, 2010.0)) == -molteni(ji, 6.0, 4.0, inverse_of(ji, 2010.0)));
  const DensityDiffusionFourtakas<> fourtakas(0.1, 0.1, EosTait{1000.0, 30.0}, 9.81);
  CHECK(fourtakas(ij, 4.0, 6.0, inverse_of(ij, 2010.0)) == -fourtakas(ji, 6.0, 4.0, inverse_of(ji, 2010.0)));
}

TEST_CASE("pressure pushes particles apart, approach raises the density", "[sph][fast]") {
  const auto pair = make_pair(kernel, xi - xj, V3{} - (xi - xj));
  CHECK(momentum_symmetric(pair, 1.0, 1.0, 0.0) > 0.0);
  CHECK(continuity(pair) > 0.0);
}

TEST_CASE("artificial viscosity acts on approaching particles only and takes energy out", "[sph][fast]") {
  const ViscosityArtificial<> viscosity{0.1, 30.0, 0.1};
  const auto closing = make_pair(kernel, xi - xj, V3{} - (xi - xj)), opening = make_pair(kernel, xi - xj, xi - xj);
  CHECK(viscosity(opening, inverse_of(opening, 2000.0)) == 0.0);
  const double pi_ij = viscosity(closing, inverse_of(closing, 2000.0));
  // Monaghan (1992), eq. 4.1: -alpha c0 h (v.x)/(r2 + 0.01 h2) / rho with v = -x.
  const double r2 = dot(xi - xj, xi - xj);
  CHECK(pi_ij == Approx(0.1 * 30.0 * 0.1 * r2 / (r2 + 0.01 * 0.01) / 1000.0));
  CHECK(momentum_symmetric(closing, 0.0, 0.0, pi_ij) * closing.v_dot_x < 0.0);  // power of the pair
}

TEST_CASE("density diffusion levels densities; Fourtakas' form leaves still water alone", "[sph][fast]") {
  const auto pair = make_pair(kernel, xi - xj, vi - vj);
  const double inverse = inverse_of(pair, 2000.0), g = 9.81, c0 = 30.0;
  const DensityDiffusionMolteni<> molteni{0.1, c0, 0.1};
  const EosTait eos{1000.0, c0};
  const DensityDiffusionFourtakas<> fourtakas(0.1, 0.1, eos, g);
  CHECK(molteni(pair, 1.0, 2.0, inverse) > 0.0);
  CHECK(molteni(pair, 2.0, 2.0, inverse) == 0.0);
  for (double depth : {0.2, 0.5, 0.9}) {  // to 10 sqrt(g H): what is left of the flow is less than 0.2 % of Molteni's
    const double di = eos.hydrostatic_deviation(depth - xi[2], g), dj = eos.hydrostatic_deviation(depth - xj[2], g);
    CHECK(std::abs(fourtakas(pair, di, dj, inverse)) < 2e-3 * std::abs(molteni(pair, di, dj, inverse)));
  }
  const DensityDiffusionFourtakas<> weightless(0.1, 0.1, eos, 0.0);
  CHECK(weightless(pair, 3.0, 1.0, inverse) == Approx(molteni(pair, 3.0, 1.0, inverse)));
  // Molteni & Colagrossi (2009): delta h c0 * 2 (rho_j - rho_i) / r^2 * (-r W') * m / rho per unit m.
  const double r2 = pair.r2;
  CHECK(molteni(pair, 1.0, 2.0, inverse) == Approx(0.1 * 0.1 * c0 * 2.0 / (r2 + 1e-4) * -(r2 * pair.slope) / 1000.0));
}

TEST_CASE("a particle paired with itself contributes nothing", "[sph][fast]") {
  const auto self = make_pair(kernel, xi - xi, vi - vi);
  CHECK(continuity(self) == 0.0);
  CHECK(momentum_symmetric(self, 7.0, 7.0, 0.0) * self.x[0] == 0.0);
  CHECK(std::isfinite(momentum_symmetric(self, 7.0, 7.0, 0.0)));
}
