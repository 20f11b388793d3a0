// The sweeps beside that of the rates: strain, modified boundaries, filters, shifting: see schemes.hpp.
// Called through Schemes; tested in tests/src/sea/sph/filters_test.cpp, viscosity_test.cpp and boundary_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/filters.hpp"
#include "src/sea/sph/schemes.hpp"

namespace spindrift::sph {

template <int dim, class Real>
GroupSweep<dim, Real> Schemes<dim, Real>::strain() const {
  if (!of(p_.viscosity).sub_particle) return {};
  return with_kernel([this](auto kernel) {
    const LawStrain<decltype(kernel), Real> law{kernel, Real(p_.eos.rho0)};
    return sweep(law, law);
  });
}

template <int dim, class Real>
GroupBoundary<dim, Real> Schemes<dim, Real>::boundary(const Ghosts<dim>& ghosts) const {
  if (p_.boundary == BoundaryChoice::extrapolated)
    return with_kernel<GroupBoundary<dim, Real>>([this](auto kernel) {
      const auto walls = [&](auto sticks) {
        return GroupBoundary<dim, Real>([kernel, &columns = columns_, &p = p_, reach = reach_](Store<dim, Real>& store, int group,
                                                                                               Candidates<dim, Real>& water) {
          extrapolate_to_walls<decltype(sticks)::value>(store, columns, p, group, reach, p.drift(), kernel, water);
        });
      };
      return p_.wall == WallChoice::no_slip ? walls(std::true_type{}) : walls(std::false_type{});
    });
  if (ghosts.empty()) return {};
  return with_kernel<GroupBoundary<dim, Real>>([this, &ghosts](auto kernel) {
    return [kernel, &ghosts, &columns = columns_, &p = p_, reach = reach_](Store<dim, Real>& store, int group,
                                                                           Candidates<dim, Real>& water) {
      apply_boundary(store, columns, ghosts, p, group, reach, 2.0 * p.drift(), kernel, water);
    };
  });
}

template <int dim, class Real>
GroupSweep<dim, Real> Schemes<dim, Real>::filter() const {
  if (p_.filter == FilterChoice::none) return {};
  return with_kernel([this](auto kernel) {
    const auto with = [&](const auto& law) { return sweep(law, law); };
    using Kernel = decltype(kernel);
    if (p_.filter == FilterChoice::mls) return with(LawMls<Kernel, Real>{kernel, Real(p_.eos.rho0)});
    return with(LawShepard<Kernel, Real>{kernel, Real(p_.eos.rho0)});
  });
}

template <int dim, class Real>
GroupSweep<dim, Real> Schemes<dim, Real>::shifting() const {
  if (p_.shifting == 0.0) return {};
  return with_kernel([this](auto kernel) {
    const LawShifting<decltype(kernel)> law{kernel};
    return sweep(law, law);
  });
}

// One dimension and one precision at a time: SPINDRIFT_SPH_DIM and _REAL come from CMakeLists.txt, which compiles this file for
// each.
template GroupSweep<SPINDRIFT_SPH_DIM, SPINDRIFT_SPH_REAL> Schemes<SPINDRIFT_SPH_DIM, SPINDRIFT_SPH_REAL>::strain() const;
template GroupBoundary<SPINDRIFT_SPH_DIM, SPINDRIFT_SPH_REAL> Schemes<SPINDRIFT_SPH_DIM, SPINDRIFT_SPH_REAL>::boundary(
    const Ghosts<SPINDRIFT_SPH_DIM>&) const;
template GroupSweep<SPINDRIFT_SPH_DIM, SPINDRIFT_SPH_REAL> Schemes<SPINDRIFT_SPH_DIM, SPINDRIFT_SPH_REAL>::filter() const;
template GroupSweep<SPINDRIFT_SPH_DIM, SPINDRIFT_SPH_REAL> Schemes<SPINDRIFT_SPH_DIM, SPINDRIFT_SPH_REAL>::shifting() const;

}  // namespace spindrift::sph
