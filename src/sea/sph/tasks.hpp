// The step of the sea as tasks of a runtime::Graph. `tasks.cpp` read top to bottom is the algorithm. Data that tasks share are
// the groups' (state, planes, sums); colours fix the order of the sums, ranks exchange planes, and substeps of different regions
// overlap. Between two checks of the limits nothing but data orders; a check is a reduction over all ranks.
// Called by sea_sph.cpp, or to record the sea into the graph of a floating system; tested in tests/src/sea/sph/tasks_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "runtime/graph/graph.hpp"
#include "src/sea/sph/body_tasks.hpp"
#include "src/sea/sph/halo_tasks.hpp"
#include "src/sea/sph/schemes.hpp"
#include "src/sea/sph/sensor_tasks.hpp"
#include "src/sea/sph/step_recording.hpp"

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
  void sort();               ///< does its work where plan.sort is set
  void evaluate(Half half);  ///< planes and rates at n, or at n + 1/2
  void limits();             ///< after evaluate(begin): plan.limit
  void correct();            ///< to n + 1
  void filters();            ///< density filter and shifting, where the step is due

  /// Whether a body may soon leave the groups whose loads are gathered: record again before the next window.
  bool outdated() const { return bodies_.outdated(); }

 private:
  using Sweep = GroupSweep<dim, Real>;

  void steps(bool first);
  void step();
  void show_planes(Half half, const std::string& label);
  void set_walls();
  void stress();
  void sweep_pairs(const std::string& label, const Sweep& sweep, Array<Real>& sums, int planes, const GroupData& data,
                   bool with_stress = false);
  void extra_sweep(std::size_t which, const std::string& label, const Sweep& sweep, std::function<bool(int step)> due,
                   std::function<double(int group, int step)> apply);

  static constexpr std::size_t extremes_size = 4;  // speed, acceleration (squares), shift, a request to stop
  StepRecording<dim, Real> recording_;
  const Sweeps<dim, Real>& sweeps_;
  const StepDriver& driver_;
  Sorting<dim, Real> sorting_;
  HaloTasks<dim, Real> halo_;
  BodyTasks<dim, Real> bodies_;
  SensorTasks<dim, Real> sensors_;
  std::vector<NeighbourLists<dim, Real>> neighbour_lists_;  // one per thread
  std::vector<runtime::Datum> extremes_data_;
  std::vector<double> extremes_;  // by bundle
  double most_[extremes_size] = {};
  int substep_ = 0;  // of the planned steps, the one that is made
};

}  // namespace spindrift::sph
