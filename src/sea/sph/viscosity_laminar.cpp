// Laminar viscosity in the pair sweeps: see viscosity.hpp. SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/rates.hpp"

namespace spindrift::sph {

template <int dim, class Real>
Viscosity<dim, Real> laminar_viscosity() {
  return {{.name = "laminar",
           .help = "of a viscous fluid",
           .keys = {"kinematic_viscosity_m2_s", "solid_kinematic_viscosity_m2_s"},
           .kinematic = [](const Parameters& p) { return std::max(p.nu, p.nu_solid); }},
          [](const Schemes<dim, Real>& schemes) {
            const Parameters& p = schemes.parameters();
            return schemes.template along_velocity<false>(ViscosityLaminar<Real>{Real(p.nu)},
                                                          ViscosityLaminar<Real>{Real(p.nu_solid)});
          }};
}
template Viscosity<SPINDRIFT_SPH_DIM, SPINDRIFT_SPH_REAL> laminar_viscosity();

}  // namespace spindrift::sph
