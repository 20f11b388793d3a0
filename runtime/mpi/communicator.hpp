// Owner of a duplicated communicator, so that the runtime's messages never meet anybody else's.
// Used by runtime/graph; tested through tests/runtime/messages_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mpi.h>

#include <utility>

namespace spindrift::runtime {

class Communicator {
 public:
  Communicator() = default;
  /// Collective over `of`; MPI_COMM_SELF is taken as it is, without a call of MPI.
  explicit Communicator(MPI_Comm of);
  /// A communicator of the ranks of `of` that give the same colour, in the order of their keys. Collective over `of`.
  static Communicator split(MPI_Comm of, int colour, int key);
  Communicator(Communicator&& other) noexcept : comm_(std::exchange(other.comm_, MPI_COMM_NULL)) { take_size(other); }
  Communicator& operator=(Communicator&& other) noexcept {
    std::swap(comm_, other.comm_);
    take_size(other);
    return *this;
  }
  ~Communicator();

  MPI_Comm get() const { return comm_; }
  /// Never frees it: something that nobody will complete is under way on it.
  void leave() { comm_ = MPI_COMM_NULL; }
  int rank() const { return rank_; }
  int size() const { return size_; }
  int ranks_on_node() const { return ranks_on_node_; }

 private:
  void measure();
  void take_size(const Communicator& other) { rank_ = other.rank_, size_ = other.size_, ranks_on_node_ = other.ranks_on_node_; }
  MPI_Comm comm_ = MPI_COMM_NULL;
  int rank_ = 0, size_ = 1, ranks_on_node_ = 1;
};

}  // namespace spindrift::runtime
