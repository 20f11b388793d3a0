// The pair sweeps with artificial viscosity: see schemes.hpp.
// Called through Schemes::rates; tested in tests/src/sea/sph/sweep_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/sph/density_diffusion_fourtakas.hpp"
#include "kernels/sph/density_diffusion_molteni.hpp"
#include "src/sea/sph/schemes.hpp"

namespace spindrift::sph {

template <int dim, class Real>
GroupSweep<dim, Real> Schemes<dim, Real>::artificial() const {
  return with_kernel([this](auto kernel) {
    const auto with = [&](auto diffusion) {
      using Kernel = decltype(kernel);
      const Real rho0 = Real(p_.eos.rho0), c0 = Real(p_.eos.c0), h = Real(p_.h());
      const LawMotion<Kernel, decltype(diffusion), Real> water{kernel, {Real(p_.alpha), c0, h}, diffusion, rho0};
      // Diffusion acts between water and water only: the density of a wall particle is a boundary condition.
      const LawMotion<Kernel, DensityDiffusionNone, Real> solid{kernel, {Real(p_.alpha_solid), c0, h}, {}, rho0};
      return sweep(water, solid);
    };
    switch (p_.diffusion) {
      case DiffusionChoice::molteni:
        return with(DensityDiffusionMolteni<Real>{Real(p_.delta), Real(p_.eos.c0), Real(p_.h())});
      case DiffusionChoice::fourtakas:
        return with(DensityDiffusionFourtakas<Real>(p_.delta, p_.h(), p_.eos, p_.gravity));
      case DiffusionChoice::none:
        break;
    }
    return with(DensityDiffusionNone{});
  });
}

// One dimension and one precision at a time: SPINDRIFT_SPH_DIM and _REAL come from CMakeLists.txt, which compiles this file for
// each.
template GroupSweep<SPINDRIFT_SPH_DIM, SPINDRIFT_SPH_REAL> Schemes<SPINDRIFT_SPH_DIM, SPINDRIFT_SPH_REAL>::artificial() const;

}  // namespace spindrift::sph
