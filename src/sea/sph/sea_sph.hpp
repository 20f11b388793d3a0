// A sea of particles: its state, and its step driven by itself. A facade over the tasks (tasks.hpp): whole windows as one graph,
// or the parts of a step one by one. Method: docs/theory/sph.md. Called by tests, perf/sea and the coupling; tested in
// tests/src/sea/sph.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "runtime/executor/executor.hpp"
#include "runtime/mpi/communicator.hpp"
#include "src/sea/sph/saved.hpp"
#include "src/sea/sph/state.hpp"
#include "src/sea/sph/tasks.hpp"

namespace spindrift::sph {

/// Where a sea runs. Every member of SeaSph is to be called by all ranks of `comm` alike.
struct Resources {
  MPI_Comm comm = MPI_COMM_SELF;
  int threads = 0;  ///< 0: as OMP_NUM_THREADS says
  std::optional<std::uint64_t> random_schedule = {};
  std::size_t records = 0;           ///< per thread, of the window's executor, for its trace
  double repartition_above = 1.2;    ///< imbalance (most loaded rank over the mean) above which groups change ranks
  std::vector<int> rank_of_group{};  ///< at the start; empty: by the counted costs of the groups
};

template <int dim, class Real = float>
class SeaSph {
 public:
  /// All ranks give the same stream; each keeps those in its groups.
  SeaSph(const Parameters& parameters, const Domain<dim>& domain, const SeedStream<dim>& seeds, Resources resources = {});
  SeaSph(const SeaSph&) = delete;  // its tasks refer to its state
  SeaSph& operator=(const SeaSph&) = delete;

  /// Steps up to exactly `duration` [s] later, as one graph: bodies are moved by the hook.
  void advance(double duration);
  void set_step_control(StepControl step_control);
  void set_bodies(MoveBodies move);

  /// One step no longer than dt_max [s]; returns its length. Solids stay; with moving ones use the three parts.
  double step(double dt_max);

  // A step in three parts, between which moving solids are placed: at n + 1/2 before half_step, at n + 1 after it and before
  // end_step. Loads are those of the last evaluation: n after begin_step, n + 1/2 after half_step. With Verlet's step half_step
  // does nothing.
  double begin_step(double dt_max);
  /// The same in two, for who must know the limit before choosing: step_limit evaluates the state at n, start_step takes dt <=
  /// limit.
  double step_limit();
  void start_step(double dt);
  void half_step();
  void end_step();

  /// Sorts now, whatever the drift. What follows is then a function of the particles' state alone.
  void sort();
  /// Goes on as after `steps` steps at `time` [s]; the caller has put that state into store().
  void resume(double time, long steps) { s_.plan.time = time, s_.plan.steps = s_.work.steps = steps; }

  /// Rates of the state at n, left in store().sums: what begin_step starts with.
  void evaluate();

  /// Declares that the particles of `owner` are a body that is now in `motion`. A body with a mass [kg] (per metre of width in
  /// 2-D) is free: it bounds the step and touches walls and other bodies; one without is driven, and only touched.
  void add_body(std::uint16_t owner, const Motion& motion, double mass = 0.0);
  void place_body(std::uint16_t owner, const Motion& motion);
  /// Force of the water on the particles of an owner (a body or a wall), about a point.
  Wrench load_on(std::uint16_t owner, const Eigen::Vector3d& about) const;

  /// A patch to be read in every step of windows from now on: state().records. Before the first, read_sensors() reads it.
  void add_sensor(Patch patch);
  /// Reads the sensors that have read nothing so far, at the last evaluation.
  void read_sensors();

  /// Contact forces at the last evaluation of a step driven by its parts, each with the two owners it acts between; none of them
  /// is in load_on.
  const std::vector<Touch>& contacts() const { return contacts_; }
  /// Contact force on an owner, of all others or of one, about a point.
  Wrench contact_on(std::uint16_t owner, const Eigen::Vector3d& about, int of = -1) const;
  /// What bounded the last step: acoustic, force, viscous or light body.
  const StepLimits& limits() const { return s_.plan.limits; }

  /// The state of this rank's groups, to go back to (restore) or to write out. 62 bytes per particle.
  Saved<dim> save() const;
  /// Back to a saved state, bit for bit. `pieces` hold all groups between them, and may come from any number of ranks.
  void restore(std::span<const Saved<dim>> pieces);
  void restore(const Saved<dim>& mine) { restore(std::span<const Saved<dim>>(&mine, 1)); }
  /// Deals groups out anew where the ranks' counted costs are out of balance; results do not change. Between windows `advance`
  /// does so by itself. Returns whether groups moved.
  bool repartition();
  bool repartition(std::vector<int> rank_of_group);
  double imbalance() const;

  const Parameters& parameters() const { return s_.p; }
  const Columns<dim>& columns() const { return s_.columns; }
  const Subdomain& subdomain() const { return s_.subdomain; }
  const Store<dim, Real>& store() const { return s_.store; }
  Store<dim, Real>& store() { return s_.store; }
  const SeaState<dim, Real>& state() const { return s_; }
  SeaState<dim, Real>& state() { return s_; }
  /// Records a window of this sea into the graph of a whole run; `driver` must outlive it. See StepTasks.
  std::unique_ptr<StepTasks<dim, Real>> tasks(const StepDriver& driver, runtime::Graph& graph, int threads, int first_tag) {
    return std::make_unique<StepTasks<dim, Real>>(s_, sweeps_, driver, graph, threads, first_tag);
  }
  const Work& work() const { return s_.work; }
  double time() const { return s_.plan.time; }
  std::size_t particles() const { return particles_; }  ///< of all ranks, as seeded
  /// Of the last window: its costs and records.
  const runtime::Executor* window_executor() const { return window_ ? &window_->executor : nullptr; }

 private:
  struct Program {  // a recorded part of the step
    std::unique_ptr<StepTasks<dim, Real>> tasks;
    runtime::Executor executor;
  };
  template <class Record>
  void run(std::unique_ptr<Program>& program, Record&& record);
  void set_territory(std::vector<int> rank_of_group);
  void forget_programs();
  void sort_if_due();
  std::vector<GroupCount> counts() const;
  void gather_contacts();

  Resources resources_;
  runtime::Communicator comm_;
  SeaState<dim, Real> s_;
  Sweeps<dim, Real> sweeps_;  ///< over s_
  StepDriver driver_;         ///< of the windows of advance()
  std::unique_ptr<Program> sort_, begin_, half_, end_, window_;
  std::vector<Touch> contacts_;
  std::size_t particles_ = 0;
};

}  // namespace spindrift::sph
