// A sum (or min, max) of per-part values that has the same bits for any distribution of the parts over ranks and any order in
// which ranks are joined: each rank adds up its parts in bins (kernels/base/binned_sum.hpp), one MPI_Iallreduce with an operation
// of our own joins the ranks. Per component 40 bytes and O(log ranks) messages, whatever the number of parts; within a sum's bins
// it is exact. MPI's own sum of doubles depends on the number of ranks; gathering all partials to add them in order took 29 us to
// post at 64 ranks. MPI plans the operation once, at the first post, and each post starts it: at 64 ranks 2.8 us of processor
// time for one component (perf/reductions). Posted and completed by runtime/mpi/messages; tested in
// tests/runtime/messages_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mpi.h>

#include <string_view>
#include <vector>

#include "kernels/base/binned_sum.hpp"
#include "runtime/graph/graph.hpp"

namespace spindrift::runtime {

/// An allreduce in place that MPI plans at the first start, where it has persistent collectives, and each start begins.
class PlannedAllreduce {
 public:
  /// The same values in every call. MPI may keep `request` when it has completed: whoever waits for it forgets it then.
  void start(void* values, std::size_t count, MPI_Datatype type, MPI_Op operation, MPI_Comm comm, MPI_Request& request);
  void release();  ///< what MPI keeps for it: after the last one has completed, before the communicator goes

 private:
  MPI_Request planned_ = MPI_REQUEST_NULL;
};

class Allreduce {
 public:
  /// Throws GraphError where partials are no multiple of the results. `comm` carries one operation after the other, in the same
  /// order on all ranks; it is not owned. `ranks` in it: with one nothing is sent.
  Allreduce(std::string_view label, Reduction reduction, MPI_Comm comm, int ranks);

  Allreduce(const Allreduce&) = delete;
  Allreduce& operator=(const Allreduce&) = delete;

  bool active() const { return !reduction_.active || reduction_.active(); }
  bool needs_messages() const { return ranks_ > 1; }
  /// Takes in the partials, which may change from then on, and starts joining the ranks (PlannedAllreduce::start).
  void post(MPI_Request& request);
  void finish();  ///< writes `result`; without messages it takes in the partials first
  void release() { planned_.release(); }
  std::size_t bytes() const { return sums_.size() * sizeof(BinnedSum) + extremes_.size() * sizeof(double); }

 private:
  void take_in();
  Reduction reduction_;
  MPI_Comm comm_;
  int ranks_;
  std::vector<BinnedSum> sums_;   ///< by component; empty for min and max
  std::vector<double> extremes_;  ///< by component; empty for sums
  PlannedAllreduce planned_;
};

}  // namespace spindrift::runtime
