// A sea of particles: its state, and its step driven by itself. A facade over the tasks (tasks.hpp): whole windows as one graph,
// or the parts of a step one by one. What needs the state alone is beside it: bodies.hpp, sensor_tasks.hpp, load_balance.hpp.
// Method: docs/theory/sph.md. Called by tests, perf/sea and the coupling; tested in tests/src/sea/sph.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "runtime/mpi/communicator.hpp"
#include "src/sea/sph/bodies.hpp"
#include "src/sea/sph/recorded_steps.hpp"
#include "src/sea/sph/saved.hpp"
#include "src/sea/sph/state.hpp"
#include "src/sea/sph/tasks.hpp"

namespace spindrift::sph {

/// Every member is to be called by all ranks of the resources' communicator alike.
template <int dim, class Real = float>
class SeaSph {
 public:
  /// All ranks give the same stream; each keeps those in its groups.
  SeaSph(const Parameters& parameters, const Domain<dim>& domain, const SeedStream<dim>& seeds, const Resources& resources = {});
  SeaSph(const SeaSph&) = delete;  // its tasks refer to its state
  SeaSph& operator=(const SeaSph&) = delete;

  /// Steps up to exactly `duration` [s] later, as one graph: bodies are moved by the hook.
  void advance(double duration);
  void set_step_control(StepControl control);
  void set_bodies(MoveBodies move);

  /// One step of at most dt_max [s]; returns its length. Solids stay; with moving ones use the three parts.
  double step(double dt_max);

  // A step in three parts, between which moving solids are placed (place_body): at n + 1/2 before half_step, at n + 1 after it
  // and before end_step. Loads are those of the last evaluation: n after begin_step, n + 1/2 after half_step. With Verlet's step
  // half_step does nothing.
  double begin_step(double dt_max);
  void half_step();
  void end_step();
  /// Evaluates the state at n and returns the longest step that it allows [s].
  double step_limit();

  /// Sorts at once, whatever the drift. What follows is then a function of the particles' state alone.
  void sort();
  /// Goes on as after `steps` steps at `time` [s]; the caller has put that state into store().
  void resume(double time, long steps) { s_.plan.time = time, s_.plan.steps = s_.work.steps = steps; }

  /// Rates of the state at n, left in store().sums: what begin_step starts with.
  void evaluate();

  /// See bodies.hpp. What was recorded is recorded again.
  void add_body(std::uint16_t owner, const Motion& motion, double mass = 0.0);
  Wrench load_on(std::uint16_t owner, const Eigen::Vector3d& about) const { return sph::load_on(s_, owner, about, comm_.get()); }
  /// A patch to be read in every step of windows from now on: state().records. Before the first, read_sensors() reads it.
  void add_sensor(Patch patch);
  /// Of all ranks, at the last evaluation of a step driven by its parts; see contact_on().
  const std::vector<Touch>& contacts() const { return contacts_; }

  /// The state of this rank's groups, to go back to (restore) or to write out. 62 bytes per particle.
  Saved<dim> save() const;
  /// Back to a saved state, bit for bit. `pieces` hold all groups between them, and may come from any number of ranks.
  void restore(std::span<const Saved<dim>> pieces);
  void restore(const Saved<dim>& mine) { restore(std::span<const Saved<dim>>(&mine, 1)); }
  /// Deals groups out anew where the ranks' counted costs are out of balance; results do not change. Between windows `advance`
  /// does so by itself. Returns whether groups moved.
  bool repartition();
  bool repartition(std::vector<int> rank_of_group);

  const Parameters& parameters() const { return s_.p; }
  const Store<dim, Real>& store() const { return s_.store; }
  Store<dim, Real>& store() { return s_.store; }
  const SeaState<dim, Real>& state() const { return s_; }
  SeaState<dim, Real>& state() { return s_; }
  double time() const { return s_.plan.time; }
  /// Records a window of this sea into the graph of a whole run; `driver` must outlive it. See StepTasks.
  std::unique_ptr<StepTasks<dim, Real>> tasks(const StepDriver& driver, runtime::Graph& graph, int threads, int first_tag) {
    return std::make_unique<StepTasks<dim, Real>>(s_, sweeps_, driver, graph, threads, first_tag);
  }
  /// Of the last window: its costs and records.
  const runtime::Executor* window_executor() const { return recorded_.window_executor(); }

 private:
  void set_ranks(std::vector<int> rank_of_group);
  void count_work_of_solids(double share);

  runtime::Communicator comm_;
  double repartition_above_;
  SeaState<dim, Real> s_;
  Sweeps<dim, Real> sweeps_;  ///< over s_
  RecordedSteps<dim, Real> recorded_;
  std::vector<Touch> contacts_;
};

}  // namespace spindrift::sph
