// The choice of schemes: turns a scene's names into one pair sweep of compiled schemes. Made once per scene, called once per
// group. The sweeps are compiled in viscosity_*.cpp (with rates.hpp) and schemes_extra.cpp.
// Called by schemes.cpp; tested in tests/src/sea/sph/sweep_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <stdexcept>

#include "kernels/sph/kernel_cubic.hpp"
#include "kernels/sph/kernel_quintic.hpp"
#include "kernels/sph/kernel_wendland.hpp"
#include "src/sea/sph/boundary.hpp"
#include "src/sea/sph/parameters.hpp"
#include "src/sea/sph/subdomain.hpp"
#include "src/sea/sph/sweep_pairs.hpp"

namespace spindrift::sph {

template <int dim, class Real>
using GroupSweep = std::function<void(SweepSums<Real>, int group, NeighbourLists<dim, Real>&)>;
template <int dim, class Real>
using GroupBoundary = std::function<void(Store<dim, Real>&, int group, Candidates<dim, Real>&)>;

/// All sweeps over one sea with the scene's schemes; each empty where the scene has none.
template <int dim, class Real>
struct Sweeps {
  GroupSweep<dim, Real> rates, strain, filter, shifting;
  GroupBoundary<dim, Real> boundary;
};

/// Makes sweeps over one store; the store, the columns and the subdomain must outlive them.
template <int dim, class Real>
class Schemes {
 public:
  Schemes(const Store<dim, Real>& store, const Columns<dim>& columns, const Subdomain& subdomain, const Parameters& p)
      : store_(store), columns_(columns), subdomain_(subdomain), p_(p) {
    double length = 0.0;
    for (int k = 0; k < dim; ++k) length += columns.domain().high[k] - columns.domain().low[k];
    reach_ = float(p.reach() + 4e-7 * length);  // boxes are floats from the corner of the domain
  }

  const Parameters& parameters() const { return p_; }
  GroupSweep<dim, Real> rates() const;
  /// Rates with a viscosity that acts along the line of centres (LawMotion): between water and water, and water and solids.
  template <class Viscosity>
  GroupSweep<dim, Real> along_centres(const Viscosity& between_water, const Viscosity& with_solid) const;
  /// The same along the relative velocity (LawDrag), and with `sub_particle` the stress of unresolved turbulence.
  template <bool sub_particle, class Viscosity>
  GroupSweep<dim, Real> along_velocity(const Viscosity& between_water, const Viscosity& with_solid) const;
  /// Rates of strain for the sub-particle stress, which `rates` then reads from the store; empty without that stress.
  GroupSweep<dim, Real> strain() const;
  /// Density and velocity of extrapolated or modified walls, for every group between packing and the pair sweeps; empty for
  /// dynamic ones.
  GroupBoundary<dim, Real> boundary(const Ghosts<dim>& ghosts) const;
  GroupSweep<dim, Real> filter() const;    ///< empty without a filter
  GroupSweep<dim, Real> shifting() const;  ///< empty without shifting

 private:
  template <class Result = GroupSweep<dim, Real>, class Make>
  Result with_kernel(Make&& make) const {
    switch (p_.kernel) {
      case KernelChoice::quintic:
        return make(KernelQuintic<dim, Real>(p_.h()));
      case KernelChoice::wendland:
        return make(KernelWendland<dim, Real>(p_.h()));
      case KernelChoice::cubic:
        return make(KernelCubic<dim, Real>(p_.h()));
    }
    throw std::logic_error("no such kernel");
  }
  template <class Water, class Solid>
  GroupSweep<dim, Real> sweep(const Water& water, const Solid& solid) const {
    return [&store = store_, &columns = columns_, &subdomain = subdomain_, reach = reach_, water, solid](
               SweepSums<Real> sums, int group, NeighbourLists<dim, Real>& meets) {
      sweep_pairs(store, sums, columns, group, reach, meets, water, solid, [&](int other) { return subdomain.owns(other); });
    };
  }

  const Store<dim, Real>& store_;
  const Columns<dim>& columns_;
  const Subdomain& subdomain_;
  const Parameters& p_;
  float reach_;
};

/// A viscosity with its sweep of one dimension and precision; the functions NAME_viscosity() of the files viscosity_*.cpp.
template <int dim, class Real>
struct Viscosity : ViscosityModel {
  GroupSweep<dim, Real> (*rates)(const Schemes<dim, Real>&) = nullptr;
};
#define VISCOSITY(name)          \
  template <int dim, class Real> \
  Viscosity<dim, Real> name##_viscosity();
#include "src/sea/sph/viscosities.inc"
#undef VISCOSITY

template <int dim, class Real>
struct SeaState;
/// The sweeps of the scene's schemes over a sea, which must outlive them; gives its store the planes of sums that they need
/// (schemes.cpp, which alone takes long to compile).
template <int dim, class Real>
Sweeps<dim, Real> sweeps_over(SeaState<dim, Real>& sea);

}  // namespace spindrift::sph
