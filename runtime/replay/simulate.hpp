// Discrete-event simulation of the executor on any computer: every rank's recorded graph is replayed by the
// executor's own program, counters, levels of priority, homes of tasks, queues and stealing, with the recorded times of each
// execution; messages, reductions and collective calls by a model of the network. Used by predict.hpp; tested in
// tests/runtime/replay/simulate_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "runtime/replay/recording.hpp"

namespace spindrift::runtime {

struct Wire {
  double latency_s = 0.0, bytes_per_s = std::numeric_limits<double>::infinity();
};

struct Cluster {
  int nodes = 1, ranks = 1, threads = 1;  ///< ranks of all nodes, threads of each rank
  Wire between{1.5e-6, 12.0e9};           ///< nodes; all that a node sends goes through one such wire
  Wire within{0.5e-6, 6.0e9};             ///< ranks of one node
  double skew = 0.0;                      ///< standard deviation of the ranks' speeds
  double task_overhead_s = 0.0;           ///< of the executor, per task
  int copies = 1;                         ///< of the recorded work, side by side (copies.hpp)
  double times = 1.0;                     ///< ranks of all over those simulated, which stand for the rest in reductions
  int node_of(int rank) const { return int(long(rank) * nodes / ranks); }
};

/// One rank's graph and what its nodes took in one run.
struct RankRun {
  GraphRecord graph;
  RunRecord run;
  std::vector<std::uint32_t> origin =
      {};           ///< by node: that of the graph it was cut from, of a message what it is for; none: its own
  int group = 0;    ///< ranks that share reductions and collective calls; messages name ranks of all groups
  int number = -1;  ///< on the cluster, which says its node and speed; -1: as it stands in the list that is simulated
  int number_at(int place) const { return number < 0 ? place : number; }
};

/// Of a chain: what all executions of a family of labels took, or all messages and reductions of a module.
struct Link {
  std::string label;
  double s = 0.0;
  long executions = 0;
};

/// A piece of a thread's time.
struct Slice {
  int rank, thread;
  double begin_s, end_s;
  std::string module;
};

struct Simulated {
  double wall_s = 0.0;
  double busy_s = 0.0, overhead_s = 0.0, waiting_s = 0.0;  ///< core-seconds; together wall x ranks x threads
  double critical_path_s = 0.0;                            ///< longest chain of tasks and messages by data alone
  std::vector<Link> critical_path = {};                    ///< what it is made of, most first
  double bytes = 0.0;
  long messages = 0, reductions = 0, tasks = 0;
  std::map<std::string, double> busy_of;         ///< [core-s] by module
  std::vector<Slice> slices;                     ///< of tasks
  Simulated& operator+=(const Simulated& next);  ///< which begins when this one has ended
};

/// All ranks from the start of their runs until each has ended. Throws std::runtime_error where ranks wait for each other for
/// ever.
Simulated simulate(std::span<const RankRun> ranks, const Cluster& cluster);

/// The same work in bulk-synchronous steps: the tasks of a loop in the order of recording, cut into phases of one family of
/// labels without dependencies; a phase is shared out among the threads of each rank as they become free, and the next one
/// begins when all ranks have done it and a barrier has told them so.
Simulated simulate_bulk_synchronous(std::span<const RankRun> ranks, const Cluster& cluster);

/// A reduction of so many bytes, by doubling: first among the ranks of a node, then among nodes.
double all_to_all_s(const Cluster& cluster, int ranks, double bytes);

/// Of the whole computer, where `ranks` of a group are simulated.
int ranks_in_all(const Cluster& cluster, int ranks);

/// Factor on the times of a rank's tasks, at least 0.2; the same for a rank in every simulation.
double speed_factor(const Cluster& cluster, int rank);

}  // namespace spindrift::runtime
