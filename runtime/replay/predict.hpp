// What a window of a recording takes on another computer and in another placement of the two sides (air; sea and bodies). Used by
// `spindrift replay` and `spindrift profile`; tested in tests/runtime/replay/predict_test.cpp. SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/replay/simulate.hpp"

namespace spindrift::runtime {

enum class Placement {
  in_turns,          ///< all ranks do one side, then the other
  shared,            ///< all ranks do both sides at once, as one graph
  split,             ///< some ranks do one side, the rest the other, at once
  bulk_synchronous,  ///< all ranks, one phase of one side after the other, a barrier after each
};
inline constexpr Placement placements[] = {Placement::in_turns, Placement::shared, Placement::split, Placement::bulk_synchronous};
std::string_view name_of(Placement placement);

struct Prediction {
  Placement placement = Placement::shared;
  Cluster cluster;
  int second_side_ranks = 0;  ///< split: of the ranks
  int windows = 0;            ///< that the figures are means of
  int simulated_copies = 1;   ///< of all
  // Per window.
  double wall_s = 0.0;
  double outside_s = 0.0;  ///< of it between the graphs, as recorded for each copy that a rank has: snapshot, exchange, schemes
  /// Sums over the windows' graphs, divided by the windows; slices of the first window alone, and only where all is simulated.
  Simulated tasks;
  double work_s = 0.0;                ///< core-seconds of tasks as recorded, of all copies
  double efficiency = 0.0;            ///< work_s over cores x wall_s
  double repeated = 0.0;              ///< part of the work that more than one rank does
  double imbalance = 1.0;             ///< of the most loaded rank, worst of the modules
  std::map<std::string, int> pieces;  ///< that ranks share (tiles, columns of particles), by module; of one rank's recording
};

/// Which side a module (first component of the labels) is of; either: of the first that its graph has (exchange, output).
enum class Side { first, second, either };
using SideOf = std::function<Side(std::string_view module)>;

/// One window of which every execution took the median of what it took in all windows that were like the first: what a window
/// takes without what other programs on the computer took from it. Throws std::invalid_argument where there is no window.
Recording typical(const Recording& recording);

/// The executor's own work per task, on average over all runs.
double task_overhead_s(const Recording& recording);

/// What copies are cut into: the largest number of equal units of whole copies on whole nodes.
struct Units {
  int count = 1;              ///< of them
  int copies = 1, ranks = 1;  ///< of each
};
Units units_of(const Cluster& cluster);

/// Units that are simulated at most, where not all are asked for. They border each other in a ring, the slowest of all among
/// them. The rest are taken to come no later to any reduction than these.
inline constexpr int simulated_units = 4;

/// Placements that a recording can be replayed in on so many ranks (of a unit): in_turns and split need two sides, split two
/// ranks; a recording of several ranks is replayed on these alone, as it was placed or bulk-synchronously.
std::vector<Placement> possible(const Recording& recording, int ranks, const SideOf& side_of);

/// `most_units`: that are simulated. Throws std::invalid_argument where the recording cannot be had on so many ranks or in
/// copies, or has no window.
Prediction predict(const Recording& recording, const Cluster& cluster, Placement placement, const SideOf& side_of,
                   int most_units = simulated_units);

}  // namespace spindrift::runtime
