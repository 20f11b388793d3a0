// The choice of schemes: turns a scene's names into one pair sweep of compiled schemes. Made once per scene, called once per
// group.
// Called by sea_sph.cpp; tested in tests/src/sea/sph/sweep_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "kernels/sph/density_diffusion_fourtakas.hpp"
#include "kernels/sph/density_diffusion_molteni.hpp"
#include "kernels/sph/kernel_cubic.hpp"
#include "kernels/sph/kernel_wendland.hpp"
#include "src/sea/sph/boundary.hpp"
#include "src/sea/sph/filters.hpp"
#include "src/sea/sph/parameters.hpp"
#include "src/sea/sph/sweep_pairs.hpp"

namespace spindrift::sph {

template <int dim, class Real>
using GroupSweep = std::function<void(Real* sums, int group, Meetings<dim, Real>&)>;

/// Makes sweeps over one store; the store and the columns must outlive them.
template <int dim, class Real>
class Schemes {
 public:
  Schemes(const Store<dim, Real>& store, const Columns<dim>& columns, const Parameters& p)
      : store_(store), columns_(columns), p_(p) {
    double length = 0.0;
    for (int k = 0; k < dim; ++k) length += columns.domain().high[k] - columns.domain().low[k];
    reach_ = float(p.reach() + 4e-7 * length);  // boxes are floats from the corner of the domain
  }

  GroupSweep<dim, Real> rates() const {
    if (p_.laminar()) return laminar();
    return with_kernel([this](auto kernel) {
      const Real delta = Real(p_.delta), c0 = Real(p_.eos.c0), h = Real(p_.h());
      switch (p_.diffusion) {
        case DiffusionChoice::molteni:
          return rates_of(kernel, DensityDiffusionMolteni<Real>{delta, c0, h});
        case DiffusionChoice::fourtakas:
          return rates_of(kernel, DensityDiffusionFourtakas<Real>(p_.delta, p_.h(), p_.eos, p_.gravity));
        case DiffusionChoice::none:
          break;
      }
      return rates_of(kernel, DensityDiffusionNone{});
    });
  }
  /// Rates of strain for the sub-particle stress, which `rates` then reads from the store.
  GroupSweep<dim, Real> strain() const {
    if (!p_.sub_particle()) return {};
    return with_kernel([this](auto kernel) {
      const LawStrain<decltype(kernel), Real> law{kernel, Real(p_.eos.rho0)};
      return sweep(law, law);
    });
  }
  /// Density and velocity of modified walls; to be run on every group between packing and the pair sweeps.
  std::function<void(Store<dim, Real>&, int group, Candidates<dim, Real>&)> boundary(const Ghosts<dim>& ghosts) const {
    if (ghosts.empty()) return {};
    using Boundary = std::function<void(Store<dim, Real>&, int, Candidates<dim, Real>&)>;
    return with_kernel<Boundary>([this, &ghosts](auto kernel) {
      return [kernel, &ghosts, &columns = columns_, &p = p_, reach = reach_](Store<dim, Real>& store, int group,
                                                                             Candidates<dim, Real>& water) {
        apply_boundary(store, columns, ghosts, p, group, reach, 2.0 * p.drift(), kernel, water);
      };
    });
  }
  GroupSweep<dim, Real> filter() const {
    if (p_.filter == FilterChoice::none) return {};
    return with_kernel([this](auto kernel) {
      using Kernel = decltype(kernel);
      if (p_.filter == FilterChoice::mls)
        return sweep(LawMls<Kernel, Real>{kernel, Real(p_.eos.rho0)}, LawMls<Kernel, Real>{kernel, Real(p_.eos.rho0)});
      const LawShepard<Kernel, Real> law{kernel, Real(p_.eos.rho0)};
      return sweep(law, law);
    });
  }
  GroupSweep<dim, Real> shifting() const {
    if (p_.shifting == 0.0) return {};
    return with_kernel(
        [this](auto kernel) { return sweep(LawShifting<decltype(kernel)>{kernel}, LawShifting<decltype(kernel)>{kernel}); });
  }

 private:
  template <class Result = GroupSweep<dim, Real>, class Make>
  Result with_kernel(Make&& make) const {
    if (p_.kernel == KernelChoice::cubic) return make(KernelCubic<dim, Real>(p_.h()));
    return make(KernelWendland<dim, Real>(p_.h()));
  }
  GroupSweep<dim, Real> laminar() const;  // in a file of its own: half of all the code of the sweeps
  template <class Kernel, class Diffusion>
  GroupSweep<dim, Real> rates_of(const Kernel& kernel, const Diffusion& diffusion) const {
    const auto viscosity = [&](double alpha) { return ViscosityArtificial<Real>{Real(alpha), Real(p_.eos.c0), Real(p_.h())}; };
    const LawMotion<Kernel, Diffusion, Real> water{kernel, viscosity(p_.alpha), diffusion, Real(p_.eos.rho0)};
    // Diffusion acts between water and water only: the density of a wall particle is a boundary condition.
    const LawMotion<Kernel, DensityDiffusionNone, Real> solid{kernel, viscosity(p_.alpha_solid), {}, Real(p_.eos.rho0)};
    return sweep(water, solid);
  }
  template <class Water, class Solid>
  GroupSweep<dim, Real> sweep(const Water& water, const Solid& solid) const {
    return
        [&store = store_, &columns = columns_, reach = reach_, water, solid](Real* sums, int group, Meetings<dim, Real>& meets) {
          sweep_pairs(store, sums, columns, group, reach, meets, water, solid);
        };
  }

  const Store<dim, Real>& store_;
  const Columns<dim>& columns_;
  const Parameters& p_;
  float reach_;
};

}  // namespace spindrift::sph
