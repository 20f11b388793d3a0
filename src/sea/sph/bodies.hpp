// The bodies of a sea between its steps: placing them, and loads and contacts at the last evaluation, summed over all ranks in
// the order of groups. Within a window they are tasks (body_tasks.hpp). Called by sea_sph.cpp, particle_sea.cpp and tests, on all
// ranks of `comm` alike; tested in tests/src/sea/sph/solids_test.cpp and contact_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "src/sea/sph/state.hpp"

namespace spindrift::sph {

/// Declares that the particles of `owner` are a body that is now in `motion`. A body with a mass [kg] (per metre of width in 2-D)
/// is free: it bounds the step and touches walls and other bodies; one without is driven, and only touched. Tasks recorded before
/// do not know it.
template <int dim, class Real>
void add_body(SeaState<dim, Real>& sea, std::uint16_t owner, const Motion& motion, double mass, MPI_Comm comm);

/// Nothing where `owner` is no body.
template <int dim, class Real>
void place_body(SeaState<dim, Real>& sea, std::uint16_t owner, const Motion& motion);

/// Force of the water on the particles of an owner (a body or a wall), about a point.
template <int dim, class Real>
Wrench load_on(const SeaState<dim, Real>& sea, std::uint16_t owner, const Eigen::Vector3d& about, MPI_Comm comm);

/// Contact forces, each with the two owners it acts between; none of them is in load_on.
template <int dim, class Real>
std::vector<Touch> all_contacts(const SeaState<dim, Real>& sea, MPI_Comm comm);

/// Of these, the force on an owner, of all others or of one, about a point.
inline Wrench contact_on(std::span<const Touch> contacts, std::uint16_t owner, const Eigen::Vector3d& about, int of = -1) {
  Wrench total{.point = about};
  for (const Touch& touch : contacts) {
    if (touch.on != owner && touch.of != owner) continue;
    if (of >= 0 && int(touch.on == owner ? touch.of : touch.on) != of) continue;
    Wrench wrench = touch.wrench.about(about);
    if (touch.of == owner) wrench.force = -wrench.force, wrench.moment = -wrench.moment;
    total += wrench;
  }
  return total;
}

}  // namespace spindrift::sph
