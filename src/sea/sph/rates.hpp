// The pair sweeps of the rates with a viscosity and the scene's diffusion of density, for the files viscosity_*.cpp, which alone
// include this: see schemes.hpp. Tested in tests/src/sea/sph/sweep_test.cpp and viscosity_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/sph/density_diffusion_fourtakas.hpp"
#include "kernels/sph/density_diffusion_molteni.hpp"
#include "src/sea/sph/schemes.hpp"

namespace spindrift::sph {

// Diffusion acts between water and water only: the density of a wall particle is a boundary condition.

template <int dim, class Real>
template <class Viscosity>
GroupSweep<dim, Real> Schemes<dim, Real>::along_centres(const Viscosity& between_water, const Viscosity& with_solid) const {
  return with_kernel([&](auto kernel) {
    const auto with = [&](auto diffusion) {
      using Kernel = decltype(kernel);
      const Real rho0 = Real(p_.eos.rho0);
      const LawMotion<Kernel, Viscosity, decltype(diffusion), Real> water{kernel, between_water, diffusion, rho0};
      const LawOfSolids<LawMotion<Kernel, Viscosity, DensityDiffusionNone, Real>> solid{{kernel, with_solid, {}, rho0}};
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

template <int dim, class Real>
template <bool sub_particle, class Viscosity>
GroupSweep<dim, Real> Schemes<dim, Real>::along_velocity(const Viscosity& between_water, const Viscosity& with_solid) const {
  return with_kernel([&](auto kernel) {
    const auto with = [&](auto diffusion) {
      using Kernel = decltype(kernel);
      const Real rho0 = Real(p_.eos.rho0);
      const LawDrag<Kernel, Viscosity, decltype(diffusion), Real, sub_particle> water{kernel, between_water, diffusion, rho0};
      const LawOfSolids<LawDrag<Kernel, Viscosity, DensityDiffusionNone, Real, sub_particle>> solid{
          {kernel, with_solid, {}, rho0}};
      return sweep(water, solid);
    };
    if (p_.diffusion == DiffusionChoice::none) return with(DensityDiffusionNone{});
    // Molteni's diffusion is that of Fourtakas with no hydrostatic part.
    const double gravity = p_.diffusion == DiffusionChoice::fourtakas ? p_.gravity : 0.0;
    return with(DensityDiffusionFourtakas<Real>(p_.delta, p_.h(), p_.eos, gravity));
  });
}

}  // namespace spindrift::sph
