// The writing of outputs beside the next window: an output copies what it is to write at a window's end and hands its writing
// on, which becomes a task of the next window's graph. One task does all of it, one after the other: HDF5 knows no threads.
// Owned by what the driver advances (src/run/simulation.hpp), recorded by window_tasks.cpp and src/run/flow_simulation.cpp;
// tested in tests/src/coupling/output_task_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <functional>
#include <vector>

#include "runtime/graph/graph.hpp"

namespace spindrift::coupling {

/// Writes what it holds a copy of. Collective over the ranks that its files are of; throws on all of these alike.
using Writing = std::function<void()>;

class OutputTask {
 public:
  /// To be done by the task, or by write_now(), in the order handed on. Empty ones are nothing. All ranks of a graph hand on the
  /// same.
  void hand_on(Writing writing);
  /// Records "output/write", which does what was handed on before the replay; nothing where that is nothing.
  void record(runtime::Graph& graph);
  /// @post nothing is left to write. Throws what failed first, here or in the task since the last call.
  void write_now();

 private:
  void write();

  std::vector<Writing> handed_on_;
  std::exception_ptr failure_;
};

}  // namespace spindrift::coupling
