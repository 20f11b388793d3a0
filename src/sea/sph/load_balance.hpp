// Which rank has which group: by counted costs at the start, and dealt out anew where they are out of balance. Called by
// sea_sph.cpp on all ranks of `comm` alike; tested in tests/src/sea/sph/tasks_test.cpp on several ranks.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "runtime/mpi/communicator.hpp"
#include "src/sea/sph/saved.hpp"
#include "src/sea/sph/seeds.hpp"
#include "src/sea/sph/state.hpp"

namespace spindrift::sph {

/// Ranks of the groups by what the seeds fill them with.
template <int dim>
std::vector<int> first_ranks(const Columns<dim>& columns, const SeedStream<dim>& seeds, const runtime::Communicator& comm);

/// Counted cost of the most loaded rank over the mean.
template <int dim, class Real>
double imbalance(const SeaState<dim, Real>& sea, const runtime::Communicator& comm);

/// Ranks of the groups that are worth the move; none where the imbalance is at most `repartition_above`, or would stay so.
template <int dim, class Real>
std::optional<std::vector<int>> better_ranks(const SeaState<dim, Real>& sea, double repartition_above,
                                             const runtime::Communicator& comm);

/// Groups go to their new ranks: returns the states of those that are now this rank's.
template <int dim, class Real>
std::vector<Saved<dim>> send_groups(const SeaState<dim, Real>& sea, const std::vector<int>& rank_of_group,
                                    const runtime::Communicator& comm);

}  // namespace spindrift::sph
