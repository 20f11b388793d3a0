// The blocks of a recorded graph: what stands at one place of the thread team (a tile, a column of particles), which a recording
// is cut by and copied by. Used by recut.hpp and copies.hpp; tested through tests/runtime/replay/recut_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "runtime/partition/block_graph.hpp"
#include "runtime/replay/recording.hpp"

namespace spindrift::runtime {

inline constexpr int no_block = -1;
inline constexpr std::uint64_t unknown_bytes = 64;  ///< of a datum of which nothing was said

inline bool writes_to(const UseRecord& use) { return use.how != Access::read; }

/// A run whose nodes are yet to be written.
RunRecord without_nodes(const RunRecord& run);
/// `done`: what cannot be done with messages ("copied"). Throws std::invalid_argument.
void require_no_messages(const GraphRecord& graph, const std::string& done);

class Blocks {
 public:
  Blocks(const GraphRecord& graph, const RunRecord& run);
  const std::vector<int>& of_datum() const { return of_; }
  /// Costs as measured, by module, and the bytes that pass between blocks: what is partitioned.
  const BlockGraph& weighted() const { return weighted_; }
  const std::vector<std::string>& modules() const { return modules_; }
  /// Index in modules(), by block: those of a module stand together, in the order of their places.
  const std::vector<int>& module_of_block() const { return module_of_block_; }
  int count() const { return int(place_.size()); }
  /// The first that a task writes, or no_block.
  int written_by(const NodeRecord& node) const;

 private:
  using Place = std::pair<int, float>;  // module, place

  void find_modules();
  void find_tiles();
  void follow_tiles();
  int nearest(int module, float place) const;
  void weigh(const RunRecord& run);

  const GraphRecord& graph_;
  std::vector<std::string> modules_;
  std::vector<int> module_of_datum_, of_, module_of_block_;
  std::map<Place, int> place_;
  BlockGraph weighted_;
};

}  // namespace spindrift::runtime
