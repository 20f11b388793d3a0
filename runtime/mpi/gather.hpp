// Bytes of any size from every rank to every rank, by MPI's own gathering calls: what exchange_all (exchange.hpp) is made of.
// Tested in tests/runtime/exchange_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "runtime/mpi/exchange.hpp"

namespace spindrift::runtime {

/// The parcels of all ranks, in the order of ranks. Collective. No rank sends to each other one: MPI gathers in O(log ranks)
/// messages a rank, or passes long parcels on round a ring. `at_once` [bytes]: of all ranks together in one call, whose counts
/// are int; longer parcels take several.
std::vector<Bytes> gather_from_all(MPI_Comm comm, const Bytes& mine, std::size_t at_once);

}  // namespace spindrift::runtime
