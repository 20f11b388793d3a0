// What the parts of the graph of a step share while they are recorded: the data that order the tasks, the groups in bundles with
// enough work for a task, and which of the planned steps the tasks belong to. Used by tasks.cpp, halo_tasks.cpp, body_tasks.cpp
// and sensor_tasks.cpp; tested in tests/src/sea/sph/tasks_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "runtime/graph/graph.hpp"
#include "src/sea/sph/state.hpp"

namespace spindrift::sph {

/// The evaluations of a step.
enum class Half { begin, middle };

/// Data of tasks, by group.
using GroupData = std::vector<runtime::Datum>;

template <int dim, class Real>
struct StepRecording {
  /// Makes the data in `graph`; tasks refer to `sea` and to this.
  StepRecording(SeaState<dim, Real>& sea, runtime::Graph& graph);
  StepRecording(const StepRecording&) = delete;
  StepRecording& operator=(const StepRecording&) = delete;

  /// work(), or work(context, n) with the number of the planned step, of a task that does nothing in steps that are not to be
  /// made and where `due` says no.
  template <class Do>
  std::function<void(const runtime::Context&)> if_active(Do&& work) const {
    return [&plan = sea.plan, step = step, due = due, work = std::forward<Do>(work)](const runtime::Context& context) {
      const int n = step(context);
      if (n >= plan.planned || plan.ended() || (due && !due(n))) return;
      if constexpr (std::is_invocable_v<Do, const runtime::Context&, int>)
        work(context, n);
      else
        work();
    };
  }

  /// A sum over all ranks of what one step of those planned gives, which all ranks make or none.
  void sum(const std::string& label, const std::vector<runtime::Datum>& partial, runtime::Datum total, std::span<double> from,
           std::span<double> to) const {
    runtime::Uses uses = active_from;
    uses.push_back(runtime::reads(partial)), uses.push_back(runtime::writes(total));
    graph.reduce(label, uses, {runtime::Reduction::Operation::sum, from, to, active});
  }

  SeaState<dim, Real>& sea;
  runtime::Graph& graph;
  std::vector<std::vector<int>> bundles;       ///< own groups, some thousand particles each
  std::vector<std::vector<int>> wall_bundles;  ///< own groups, some hundred particles of walls and bodies each
  std::vector<std::vector<int>> pair_bundles;  ///< groups of one colour, colour by colour
  runtime::Datum order, plan, loads;           ///< of groups and particles in memory; sea.plan; where bodies are
  GroupData state, planes, walls, sums, carried, stress, extra[3], touches;
  /// Which of the planned steps a task recorded now is part of, seen from within it.
  std::function<int(const runtime::Context&)> step = [](const runtime::Context&) { return 0; };
  std::function<bool(int step)> due = {};  ///< further condition on the tasks recorded now
  /// Of sums recorded now: whether their step is one of those planned, and what says so.
  std::function<bool()> active = {};
  runtime::Uses active_from = {};
};

inline std::string task_name(const std::string& path, std::size_t n) { return "sea/" + path + "/" + std::to_string(n); }

inline runtime::Uses of_groups(const std::vector<int>& groups, runtime::Use (*how)(runtime::Datum), const GroupData& data) {
  runtime::Uses uses;
  for (const int g : groups) uses.push_back(how(data[std::size_t(g)]));
  return uses;
}

}  // namespace spindrift::sph
