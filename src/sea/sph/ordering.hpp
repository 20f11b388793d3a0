// Sorting particles into groups and clusters. Inside a group each owner's particles are halved along their longest extent until
// 16 are left: compact clusters in bulk, in sheets of wall particles and in splashes alike, and only the last one has empty
// lanes. The result depends on positions and identities alone (ties by identity, 16 sorted by identity), not on the order before.
// Called by SeaSph when the drift since the last sort exceeds its margin; tested in tests/src/sea/sph/ordering_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "src/sea/sph/store.hpp"

namespace spindrift::sph {

/// Fills an empty store; identities are the places in `seeds`.
template <int dim, class Real>
void fill(Store<dim, Real>& store, std::span<const Seed<dim>> seeds, const Columns<dim>& columns, double anchor_step);

/// Sorts again after particles moved. Particles outside the domain go to store.lost; periodic positions are wrapped.
template <int dim, class Real>
void sort(Store<dim, Real>& store, const Columns<dim>& columns, double anchor_step);

}  // namespace spindrift::sph
