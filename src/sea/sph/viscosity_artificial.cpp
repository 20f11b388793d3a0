// Monaghan's artificial viscosity in the pair sweeps: see viscosity.hpp. SPDX-License-Identifier: Apache-2.0
#include "kernels/sph/viscosity_artificial.hpp"

#include "src/sea/sph/rates.hpp"

namespace spindrift::sph {

template <int dim, class Real>
Viscosity<dim, Real> artificial_viscosity() {
  return {{.name = "artificial",
           .help = "Monaghan's, on approaching pairs: steadies and dissipates",
           .keys = {"viscosity", "solid_viscosity"}},
          [](const Schemes<dim, Real>& schemes) {
            const Parameters& p = schemes.parameters();
            const auto with = [&](double alpha) { return ViscosityArtificial<Real>{Real(alpha), Real(p.eos.c0), Real(p.h())}; };
            return schemes.along_centres(with(p.alpha), with(p.alpha_solid));
          }};
}
template Viscosity<SPINDRIFT_SPH_DIM, SPINDRIFT_SPH_REAL> artificial_viscosity();

}  // namespace spindrift::sph
