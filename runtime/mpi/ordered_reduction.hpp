// A sum (or min, max) of per-part values that has the same bits for any distribution of the parts over ranks: all partials are
// gathered (MPI_Iallgatherv) and added in the order of their global indices. Volume: 8 bytes x parts x components to each rank,
// so parts are tiles, not cells (4000 tiles: 32 kB). MPI_Iallreduce adds in an order that depends on the number of ranks. Posted
// and completed by runtime/mpi/messages; tested in tests/runtime/messages_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "runtime/graph/graph.hpp"
#include "runtime/mpi/communicator.hpp"

namespace spindrift::runtime {

class OrderedReduction {
 public:
  /// Collective over `comm`. Throws GraphError where a part has two owners or the sizes do not fit.
  OrderedReduction(std::string_view label, Reduction reduction, MPI_Comm comm);

  bool needs_messages() const { return comm_.size() > 1; }
  void post(MPI_Request& request);  ///< starts gathering; partials must stay unchanged until finish
  void finish();                    ///< reduces what came into `result`
  std::size_t bytes() const { return gathered_.size() * sizeof(double); }

 private:
  Reduction reduction_;
  Communicator comm_;
  std::vector<int> counts_, offsets_;  ///< by rank, in values
  std::vector<std::size_t> first_of_;  ///< by rising global index: where the part's components start in gathered_
  std::vector<double> gathered_;
};

}  // namespace spindrift::runtime
