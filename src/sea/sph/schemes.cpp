// The scene's sweeps in one place: see schemes.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/schemes.hpp"

#include "kernels/sph/filter_mls.hpp"
#include "kernels/sph/filter_shepard.hpp"
#include "kernels/sph/shifting.hpp"
#include "src/sea/sph/state.hpp"

namespace spindrift::sph {

namespace {

/// In the order of ViscosityChoice.
template <int dim, class Real>
const auto& listed_viscosities() {
#define VISCOSITY(name) name##_viscosity<dim, Real>(),
  static const std::array all{
#include "src/sea/sph/viscosities.inc"
  };
#undef VISCOSITY
  return all;
}

}  // namespace

std::span<const ViscosityModel* const> viscosities() {
  static const auto models = [] {
    std::vector<const ViscosityModel*> models;
    for (const auto& viscosity : listed_viscosities<3, float>()) models.push_back(&viscosity);
    return models;
  }();
  return models;
}
const ViscosityModel& of(ViscosityChoice viscosity) { return *viscosities()[std::size_t(viscosity)]; }

template <int dim, class Real>
GroupSweep<dim, Real> Schemes<dim, Real>::rates() const {
  return listed_viscosities<dim, Real>()[std::size_t(p_.viscosity)].rates(*this);
}

template <int dim, class Real>
Sweeps<dim, Real> sweeps_over(SeaState<dim, Real>& sea) {
  const Parameters& p = sea.p;
  const Schemes<dim, Real> schemes(sea.store, sea.columns, sea.subdomain, p);
  Sweeps<dim, Real> sweeps{schemes.rates(), schemes.strain(), schemes.filter(), schemes.shifting(), schemes.boundary(sea.ghosts)};
  auto& planes = sea.store.extra_planes;
  if (sweeps.filter) planes[of_filter] = p.filter == FilterChoice::mls ? FilterMls<dim>::planes : FilterShepard::planes;
  if (sweeps.shifting) planes[of_shifting] = Shifting<dim>::planes;
  if (sweeps.strain) planes[of_strain] = sea.store.stress_planes = SymmetricTensor<double, dim>::components;
  return sweeps;
}

template Sweeps<2, float> sweeps_over(SeaState<2, float>&);
template Sweeps<2, double> sweeps_over(SeaState<2, double>&);
template Sweeps<3, float> sweeps_over(SeaState<3, float>&);
template Sweeps<3, double> sweeps_over(SeaState<3, double>&);

}  // namespace spindrift::sph
