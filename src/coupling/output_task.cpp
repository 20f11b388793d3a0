// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/output_task.hpp"

#include <utility>

namespace spindrift::coupling {

void OutputTask::hand_on(Writing writing) {
  if (writing) handed_on_.push_back(std::move(writing));
}

void OutputTask::record(runtime::Graph& graph) {
  graph.collective(
      "output/write", {runtime::updates(graph.datum())}, [this](MPI_Comm) { write(); }, [this] { return !handed_on_.empty(); });
}

void OutputTask::write_now() {
  write();
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

/// What fails does not end the window that it runs beside, nor keep the others from being written.
void OutputTask::write() {
  for (const Writing& writing : std::exchange(handed_on_, {})) try {
      writing();
    } catch (...) {
      if (!failure_) failure_ = std::current_exception();
    }
}

}  // namespace spindrift::coupling
