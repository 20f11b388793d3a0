// The pair sweeps with laminar viscosity, with and without sub-particle stress: see schemes.hpp.
// Called through Schemes::rates; tested in tests/src/sea/sph/viscosity_test.cpp and
// tests/verification/sea_sph/viscous_flow_test.cpp. SPDX-License-Identifier: Apache-2.0
#include "kernels/sph/density_diffusion_fourtakas.hpp"
#include "src/sea/sph/schemes.hpp"

namespace spindrift::sph {

template <int dim, class Real>
GroupSweep<dim, Real> Schemes<dim, Real>::laminar() const {
  return with_kernel([this](auto kernel) {
    const auto with = [&](auto sub_particle, auto diffusion) {
      using Kernel = decltype(kernel);
      const Real rho0 = Real(p_.eos.rho0);
      const LawLaminar<Kernel, decltype(diffusion), Real, sub_particle()> water{kernel, {Real(p_.nu)}, diffusion, rho0};
      const LawLaminar<Kernel, DensityDiffusionNone, Real, sub_particle()> solid{kernel, {Real(p_.nu_solid)}, {}, rho0};
      return sweep(water, solid);
    };
    const auto diffusing = [&](auto sub_particle) {
      if (p_.diffusion == DiffusionChoice::none) return with(sub_particle, DensityDiffusionNone{});
      // Molteni's diffusion is that of Fourtakas with no hydrostatic part.
      const double gravity = p_.diffusion == DiffusionChoice::fourtakas ? p_.gravity : 0.0;
      return with(sub_particle, DensityDiffusionFourtakas<Real>(p_.delta, p_.h(), p_.eos, gravity));
    };
    return p_.sub_particle() ? diffusing(std::true_type{}) : diffusing(std::false_type{});
  });
}

// One dimension and one precision at a time: SPINDRIFT_SPH_DIM and _REAL come from CMakeLists.txt, which compiles this file for
// each.
template GroupSweep<SPINDRIFT_SPH_DIM, SPINDRIFT_SPH_REAL> Schemes<SPINDRIFT_SPH_DIM, SPINDRIFT_SPH_REAL>::laminar() const;

}  // namespace spindrift::sph
