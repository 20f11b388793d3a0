// How a task says which data it touches. A datum is a name for something that tasks share (a tile's state, a halo, a residual);
// the runtime never touches its bytes. Order follows from the accesses alone (graph/edges.hpp).
// Used by every tasks.cpp; tested in tests/runtime/graph_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace spindrift::runtime {

/// A datum of one graph, made by Graph::datum or Graph::data.
struct Datum {
  std::uint32_t index = ~0u;
};

enum class Access : std::uint8_t { read, write, update };

/// One datum, or a range of data, and how it is touched.
class Use {
 public:
  Use(Access how, Datum one) : how_(how), one_(one) {}
  Use(Access how, std::span<const Datum> many) : how_(how), many_(many), single_(false) {}
  Access how() const { return how_; }
  std::span<const Datum> data() const { return single_ ? std::span<const Datum>(&one_, 1) : many_; }

 private:
  Access how_;
  Datum one_;
  std::span<const Datum> many_;  ///< read only while the task is being recorded
  bool single_ = true;
};

inline Use reads(Datum d) { return {Access::read, d}; }
inline Use writes(Datum d) { return {Access::write, d}; }    ///< its old value does not matter
inline Use updates(Datum d) { return {Access::update, d}; }  ///< read and written
inline Use reads(std::span<const Datum> d) { return {Access::read, d}; }
inline Use writes(std::span<const Datum> d) { return {Access::write, d}; }
inline Use updates(std::span<const Datum> d) { return {Access::update, d}; }

/// The accesses of one task: written as a braced list, or built up where their number varies.
using Uses = std::vector<Use>;

}  // namespace spindrift::runtime
