// Where the core-seconds of a run went, all of them: tasks of every executor there was, also of those that are gone, and what a
// rank did outside of tasks, by label; waiting, messages and the runtime's own work. Made by the driver of a run; fed by Executor
// and by spans; read as a trace (trace_of.hpp), from which table, summary and trace.json.gz follow.
// Tested in tests/runtime/trace/ledger_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "runtime/replay/recording.hpp"
#include "runtime/trace/rank_trace.hpp"

namespace spindrift::runtime {

struct Team;

class Ledger {
 public:
  /// From now on every executor of this process is counted. `records`: of spans, kept for the trace. `threads`: that the run
  /// uses, also before its first executor; 0: those of OpenMP. One ledger at a time.
  explicit Ledger(std::size_t records = 0, int threads = 0);
  ~Ledger();
  Ledger(const Ledger&) = delete;
  Ledger& operator=(const Ledger&) = delete;
  /// Null where nobody counts.
  static Ledger* current();

  /// Of time inside tasks of the module `from`, this much belongs to `label`: what a task asked of others, counted by itself.
  /// Neither clocks nor counts may go beyond what the module has.
  void move(std::string_view from, std::string_view label, std::int64_t ns, std::int64_t count);

  /// Everything so far. The threads' wall times are those of the ledger: wall = task + idle + poll + overhead for each, and the
  /// costs of the nodes add up to the tasks' times.
  RankTrace trace(int rank) const;
  /// The same by_module and without records, in memory that does not grow with the graphs.
  RankTrace sums(int rank) const;
  /// Records that a trace has.
  std::size_t records() const;
  /// The run ends here: what is done later is not of its time.
  void close();

  /// What a window leaves: records of tasks and spans (a trace), or besides these its runs, for a recording.
  enum class Keep { nothing, records, runs };
  /// What is done from here on belongs to this window. Before the first one records are kept.
  void begin_window(std::int64_t number, Keep keep);
  void end_window();
  /// Of the time between the runs of this window the rank spent so much on all that it holds: more ranks would share it.
  void on_all(std::int64_t ns);
  /// No records from here to the next window.
  void pause() { keep_ = Keep::nothing; }
  bool keeps_records() const { return keep_ != Keep::nothing; }
  /// The runs of all windows that were to leave them, with their graphs; windows of which a record was lost are left out.
  RankRecording recording(int rank) const;
  std::vector<WindowRecord> windows() const { return windows_; }

  // For Executor.
  void opened(const Team& team);
  void closed(const Team& team);
  void starts(const Team& team);
  void ran(const Team& team, std::int64_t begin_ns, std::int64_t ns);

  // For Span: of the first thread, one inside the other.
  void enter(std::string_view label);
  void leave(bool waits);

  /// Wall time [ns] of the first thread by Phase, without that of phases inside.
  const std::map<std::string, std::int64_t, std::less<>>& phases() const { return phases_; }
  void enter_phase(std::string_view name);
  void leave_phase();

 private:
  struct Live {
    const Team* team;
    std::int64_t wall_ns = 0;
    ThreadTimes before = {};                 ///< sums of its threads when its last run began
    std::uint32_t replays = 0;               ///< that it had done by then
    std::vector<RunRecord> runs = {};        ///< to be recorded
    std::vector<std::uint32_t> replay = {};  ///< the first of each
  };
  /// What makes nodes of two graphs the same: kind, loop (as merged), label, peer, tag, and the how-manieth of these in its
  /// graph.
  using Key = std::tuple<NodeKind, std::uint32_t, std::string, int, int, std::uint32_t>;
  struct Merged {
    RankTrace trace;
    std::map<Key, std::uint32_t> nodes;
    std::uint32_t replays = 0;
  };
  /// `own`: of an executor whose runs took `wall_ns`.
  static void add(Merged& to, RankTrace own, std::int64_t wall_ns);
  static void add(RankRecording& to, const Live& live);
  /// With what was done outside of executors.
  RankTrace whole(RankTrace of_executors, int rank, bool with_records) const;
  Live* live(const Team& team);
  struct Cost {
    std::int64_t ns = 0;
    std::uint64_t count = 0;
  };
  struct Move {
    std::string from;
    Cost cost;
  };

  const std::int64_t begin_ns_;
  std::optional<std::int64_t> end_ns_;
  std::size_t capacity_;
  std::vector<Live> live_;
  Merged gone_;
  std::map<std::string, Cost, std::less<>> spans_, waits_;
  std::map<std::string, Move, std::less<>> moves_;
  struct SpanRecord {
    std::string label;
    std::int64_t begin_ns, end_ns;
  };
  std::vector<SpanRecord> records_;
  struct OpenSpan {
    std::string label;
    std::int64_t begin_ns, inner_ns = 0;
  };
  std::vector<OpenSpan> open_;         ///< the innermost last
  std::vector<OpenSpan> open_phases_;  ///< likewise
  std::map<std::string, std::int64_t, std::less<>> phases_;
  Keep keep_ = Keep::records;
  std::int64_t window_begin_ns_ = 0;
  bool in_window_ = false;
  std::vector<WindowRecord> windows_;
  RankRecording recorded_;  ///< of executors that are gone
};

/// Work of the first thread outside of tasks, or its wait for other ranks, under a label like a task's; all other threads wait.
/// What runs inside it under another label (an executor, another span) is not its own. Inside a task it does nothing.
class Span {
 public:
  enum class Kind { work, wait };
  explicit Span(std::string_view label, Kind kind = Kind::work);
  ~Span();
  Span(const Span&) = delete;
  Span& operator=(const Span&) = delete;

 private:
  Ledger* ledger_;
  Kind kind_;
};

/// A part of the run as its wall time sees it, tasks and all: start-up, windows, output. Phases divide the time, one inside the
/// other or one after the other; spans divide the work. Outside of tasks; nothing where nobody counts.
class Phase {
 public:
  explicit Phase(std::string_view name);
  ~Phase();
  Phase(const Phase&) = delete;
  Phase& operator=(const Phase&) = delete;

 private:
  Ledger* ledger_;
};

}  // namespace spindrift::runtime
