// What the driver advances: a floating system or the air alone, window by window, with the state that goes into checkpoints, the
// row of history of a window's end, and the files for people that it can write. Implemented in system_simulation.cpp and
// flow_simulation.cpp; used by driver.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "src/coupling/output_task.hpp"
#include "src/coupling/scenario.hpp"
#include "src/coupling/timeline.hpp"
#include "src/io/checkpoint.hpp"
#include "src/io/history.hpp"
#include "src/io/run_directory.hpp"
#include "src/io/summary.hpp"
#include "src/run/output.hpp"

namespace spindrift::runtime {
class Ledger;
}

namespace spindrift::run {

/// How far one call of Simulation::advance came.
struct Advance {
  std::int64_t windows = 0;  ///< completed: one, or more pseudo-steps of a steady flow; none where the first failed, or was given
                             ///< up since the run is to stop
  std::string settled;       ///< not empty: why it has settled
  std::string failure;       ///< not empty: the numerics gave up: what, where, when, limit
};

/// All members are collective over the ranks of the run.
class Simulation {
 public:
  virtual ~Simulation() = default;

  virtual const coupling::Scenario& scenario() const = 0;
  virtual const coupling::Timeline& timeline() const = 0;
  /// A march to a steady state: a window is a pseudo-step, and the scene's end the most that it may take.
  virtual bool counts_pseudo_steps() const { return false; }
  /// Number of a window's files: not negative, whatever window the run begins with.
  virtual std::int64_t file_number(std::int64_t window) const = 0;

  /// The state that the scene starts from. Returns the window it is the end of: 0, below where bodies are held first, above where
  /// start.file continues another run. What takes long to settle is kept in the directory.
  virtual std::int64_t begin(const io::RunDirectory& directory) = 0;
  /// The state of a checkpoint of this run instead. Throws io::InputError where it is another run's.
  virtual void restore(const io::CheckpointReader& file) = 0;
  /// Why the march had settled that restore() took; empty where it had not.
  virtual std::string settled() const { return {}; }
  /// @pre restore(), and no advance() follows: what is said and written of the state at the end needs no more.
  virtual void nothing_left() {}
  /// Copies all that restore() wants, of the last window's end; of its start where the window failed.
  virtual void save(io::CheckpointCopy& copy) = 0;

  /// @pre begin() or restore(), or advance() without failure: the state is that of the end of `window`. `last`: of the run.
  virtual Advance advance(std::int64_t window, std::int64_t last) = 0;
  /// What is handed on to it is written while the next advance() runs.
  virtual coupling::OutputTask& output() = 0;
  /// Why a run that reached the scene's end without settling failed all the same; empty where it did not.
  virtual std::string failure_at_end() const { return {}; }
  /// Why a run that reached the scene's end is done.
  virtual std::string done() const { return "done"; }

  virtual void declare(io::History& history) = 0;
  /// Whether this rank knows the values of a row, and whether there is one of the state that a run begins with.
  virtual bool has_rows() const { return true; }
  virtual bool has_first_row() const { return true; }
  /// Fills the row of a window that the last advance() completed, or of the one that the run begins with.
  virtual void fill_row(std::int64_t window, std::span<double> row) = 0;
  /// Files for people. Series go on after `resume_s` (io::from_the_start: anew).
  virtual std::vector<std::unique_ptr<Output>> outputs(const io::RunDirectory& directory, double resume_s) = 0;

  /// Counts into the summary; into the ledger what only the simulation can tell apart.
  virtual void summarise(io::Summary& summary, runtime::Ledger& ledger) = 0;
};

}  // namespace spindrift::run
