// Laminar viscosity and the sub-particle stress in the pair sweeps: see viscosity.hpp. SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/rates.hpp"

namespace spindrift::sph {

template <int dim, class Real>
Viscosity<dim, Real> laminar_sps_viscosity() {
  return {{.name = "laminar_sps",
           .help = "the same and the stress of unresolved turbulence",
           .keys = {"kinematic_viscosity_m2_s", "solid_kinematic_viscosity_m2_s"},
           .sub_particle = true,
           .kinematic = [](const Parameters& p) { return std::max(p.nu, p.nu_solid); }},
          [](const Schemes<dim, Real>& schemes) {
            const Parameters& p = schemes.parameters();
            return schemes.template along_velocity<true>(ViscosityLaminar<Real>{Real(p.nu)},
                                                         ViscosityLaminar<Real>{Real(p.nu_solid)});
          }};
}
template Viscosity<SPINDRIFT_SPH_DIM, SPINDRIFT_SPH_REAL> laminar_sps_viscosity();

}  // namespace spindrift::sph
