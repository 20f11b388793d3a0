// SPDX-License-Identifier: Apache-2.0
#include "runtime/mpi/communicator.hpp"

namespace spindrift::runtime {

Communicator::Communicator(MPI_Comm of) {
  if (of == MPI_COMM_SELF) {
    comm_ = MPI_COMM_SELF;
    return;
  }
  MPI_Comm_dup(of, &comm_);
  measure();
}

Communicator Communicator::split(MPI_Comm of, int colour, int key) {
  Communicator part;
  MPI_Comm_split(of, colour, key, &part.comm_);
  part.measure();
  return part;
}

void Communicator::measure() {
  MPI_Comm_rank(comm_, &rank_);
  MPI_Comm_size(comm_, &size_);
  MPI_Comm node;
  MPI_Comm_split_type(comm_, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &node);
  MPI_Comm_size(node, &ranks_on_node_);
  MPI_Comm_free(&node);
}

Communicator::~Communicator() {
  if (comm_ == MPI_COMM_NULL || comm_ == MPI_COMM_SELF) return;
  int finalized = 0;
  MPI_Finalized(&finalized);
  if (!finalized) MPI_Comm_free(&comm_);
}

}  // namespace spindrift::runtime
