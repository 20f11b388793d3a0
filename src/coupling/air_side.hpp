// The air's side of a coupled window: from the motion of the rotor it computes the rotor's load. One interface for the
// engineering models, which compute it at once, and for resolved air, whose work is tasks of a graph that may run beside those of
// the sea. Its state can be saved and restored for repeated windows, and goes into checkpoints. Used by window_sides.cpp;
// implemented here and in air_march.cpp; tested in tests/src/coupling/window_test.cpp and tests/coupled/resolved_air_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "runtime/executor/executor.hpp"
#include "runtime/graph/graph.hpp"
#include "runtime/mpi/environment.hpp"
#include "src/aero/rotor_loads.hpp"
#include "src/aero/tile_balance.hpp"
#include "src/coupling/output_task.hpp"
#include "src/coupling/saved_array.hpp"
#include "src/coupling/tasks.hpp"
#include "src/io/history.hpp"
#include "src/io/run_directory.hpp"

namespace spindrift::coupling {

class FloatingSystem;

class AirSide {
 public:
  virtual ~AirSide() = default;

  /// Where the flow is saved while it settles before the run (settling_file.hpp); before begin(). The directory outlives the air.
  virtual void settle_in(const io::RunDirectory&) {}
  /// Load on the rotor at the start of the run, where it is in state `now`; air that has to settle first does so here, unless
  /// it has been restored. Collective.
  virtual aero::RotorLoad begin(double t, const aero::RotorState& now) = 0;
  /// The next step: `dt` seconds, at whose end `t` the rotor is in this state.
  virtual void prepare(double t, double dt, const aero::RotorState& at_end) = 0;
  /// Records the tasks that do it.
  virtual Tasks record(runtime::Graph&) { return Tasks::none; }
  /// Their executors are gone.
  virtual void forget_tasks() {}
  /// To be called once they have run: the load at the end, ramped as the scene asks. Throws NumericalFailure,
  /// and runtime::StopAsked where the work was given up.
  virtual aero::RotorLoad load_at_end() = 0;
  /// Whether load_at_end() asks other ranks: then all ask at once, outside of tasks.
  virtual bool asks_ranks() const { return false; }
  /// With the steps of this retry from here on (retries.hpp); after return_to().
  virtual void ease(int /*retry*/) {}
  /// The load to be written to history, where it is not that of the rotor's present state.
  virtual const aero::RotorLoad* written() const { return nullptr; }

  // Between windows, before their snapshots: tiles of resolved air go to other ranks where that pays; results stay, bit for bit.
  /// What the tasks of this rank took: in executors that have replayed so many windows; so many are still to come.
  struct Measured {
    std::span<const runtime::Executor* const> executors;
    std::int64_t windows, left;
  };
  /// A move that is worth it, on all ranks alike. Collective.
  virtual std::optional<aero::TileMove> better_ranks(const Measured&) { return {}; }
  /// Makes it, once executors are gone and forget_tasks() was called; tasks are to be recorded again. Collective.
  virtual void move_tiles(const aero::TileMove&) {}

  /// Saves the state to be restored: of a window, and of the piece of it that is being iterated.
  enum Snapshot { window, piece };
  virtual void take_snapshot(Snapshot) {}
  virtual void return_to(Snapshot) {}

  virtual std::vector<SavedArray> saved() const { return {}; }
  virtual void restore(const io::CheckpointReader&) {}

  /// Its columns of history.csv, and their present values.
  virtual std::vector<io::Column> columns() const { return {}; }
  virtual std::vector<double> values() const { return {}; }
  // Files for people, in the run's folder; collective over the ranks of the air.
  /// Where they go; a restart goes on after resume_s.
  virtual void open_output(const io::RunDirectory&, double /*resume_s*/) {}
  /// A copy of the fields as they are, to be written while the air lives; empty where there are none.
  virtual Writing copy_fields(std::int64_t /*number*/, double /*t*/) { return {}; }
  /// Of the last window that this process has made; what there is stays where it has made none.
  virtual void write_span() {}
  /// A window has ended well: its state is what the next one goes on from. Collective.
  virtual void end_window() {}
  /// Of the run at its end: counts and doubts of its loads into the summary, sentences for the log. Collective.
  struct Account {
    std::vector<std::pair<std::string, std::int64_t>> counts;
    std::vector<std::string> doubts, sentences;
  };
  virtual Account account() const { return {}; }
  /// A state from a file gets what is said and written of it besides: friction, y+. Collective.
  virtual void fill_gradients() {}
  /// Why its loads are no answer, of the run at its end; empty where they are. Collective.
  virtual std::string failure_at_end() const { return {}; }
  /// Sentences for the log since it was last asked; those that begin with "warning: " warn.
  virtual std::vector<std::string> log_lines() { return {}; }
};

/// Resolved where the scene resolves it, else an engineering one. The floating system outlives it. `now`: of the rotor at the
/// start.
std::unique_ptr<AirSide> make_air(const FloatingSystem& floating, const aero::RotorState& now, const runtime::World& world);
/// Of a floating system whose rotor, if it has one, loads the bodies as they go: nothing to do.
std::unique_ptr<AirSide> make_no_air();
/// Loads by the floating system's engineering rotor.
std::unique_ptr<AirSide> make_engineering_air(const FloatingSystem& floating);

}  // namespace spindrift::coupling
