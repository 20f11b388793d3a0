// The step of the sea as tasks of a runtime::Graph. `tasks.cpp` read top to bottom is the algorithm. Data that tasks share are
// the groups' (state, planes, sums); colours fix the order of the sums, ranks exchange planes, and substeps of different regions
// overlap. Between two checks of the limits nothing but data orders; a check is a reduction over all ranks.
// Called by sea_sph.cpp, or to record the sea into the graph of a whole machine; tested in tests/src/sea/sph/tasks_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "runtime/graph/graph.hpp"
#include "src/sea/sph/schemes.hpp"
#include "src/sea/sph/state.hpp"

namespace spindrift::sph {

template <int dim, class Real>
class StepTasks {
 public:
  /// The sea, its sweeps, its driver, and this, must outlive the graph's executor. What the driver's steps_per_check is, and
  /// whether it moves bodies, is read here. threads: of that executor. first_tag: of the messages, which take as many tags as
  /// there are exchanges in what is recorded.
  StepTasks(SeaState<dim, Real>& sea, const Sweeps<dim, Real>& sweeps, const StepDriver& driver, runtime::Graph& graph,
            int threads, int first_tag = 0);
  StepTasks(const StepTasks&) = delete;
  StepTasks& operator=(const StepTasks&) = delete;

  /// The steps of a window of plan.left seconds: what a coupled run records beside the other fluid.
  void window();

  // Its parts, for who drives the step himself.
  enum class Half { begin, middle };
  void sort();               ///< does its work where plan.sort is set
  void evaluate(Half half);  ///< planes and rates at n, or at n + 1/2
  void limits();             ///< after evaluate(begin): plan.limit
  void bodies(Half half);    ///< loads, motions, places; nothing without StepDriver::move_bodies
  void sensors();            ///< notes what sensors read at the last evaluation; nothing without them
  void correct();            ///< to n + 1
  void filters();            ///< density filter and shifting, where the step is due

  /// Whether a body may soon leave the groups whose loads are gathered: record again before the next window.
  bool outdated() const;

 private:
  using Data = std::vector<runtime::Datum>;
  using Sweep = GroupSweep<dim, Real>;
  /// Which of the planned steps a task is part of, seen from within it.
  using Step = std::function<int(const runtime::Context&)>;

  template <class Do>
  std::function<void(const runtime::Context&)> if_active(Do&& work) const;
  void steps(bool first);
  void step();
  void pack(Half half);
  void set_walls();
  void stress();
  void show(const std::string& what, bool stress);
  void contacts();
  void sweep_pairs(const std::string& label, const Sweep& sweep, std::function<Real*()> sums, const Data& data,
                   bool with_stress = false);
  void clear(std::size_t which, const std::string& label);
  void extra_sweep(std::size_t which, const std::string& label, const Sweep& sweep, std::function<bool(int step)> due,
                   std::function<double(int group)> apply);
  void find_bodies();
  void find_sensors();
  double path_limit() const;
  runtime::Uses of_groups(const std::vector<int>& groups, runtime::Use (*how)(runtime::Datum), const Data& data) const;
  static std::string name(const std::string& path, std::size_t n) { return "sea/" + path + "/" + std::to_string(n); }

  struct Shared;  // what tasks use while they run, beside the sea
  SeaState<dim, Real>& sea_;
  const Sweeps<dim, Real>& sweeps_;
  const StepDriver& driver_;
  runtime::Graph& graph_;
  int next_tag_;
  double path_;                                 // of bodies when this was recorded [m]
  std::vector<std::vector<int>> bundles_;       // own groups, some thousand particles each
  std::vector<std::vector<int>> pair_bundles_;  // groups of one colour, colour by colour
  std::vector<std::pair<int, int>> touching_;   // owners whose contacts are told to bodies
  std::vector<int> body_groups_;                // own groups that bodies may come into before the next recording
  std::vector<int> sensor_groups_;              // own groups that sensors' patches are in or near
  runtime::Datum order_, plan_, loads_, records_;
  Data state_, planes_, walls_, sums_, stress_, extra_[3], touches_, extremes_, partial_loads_, partial_readings_;
  Step step_ = [](const runtime::Context&) { return 0; };
  std::function<bool(int step)> due_;  // further condition on the tasks being recorded
  std::shared_ptr<Shared> shared_;
};

}  // namespace spindrift::sph
