// Recording of halos: which task of which tile waits for which ghosts, by copies on one rank and by one message per pair of
// ranks. Used by tasks.cpp and poisson.cpp; tested through tests/src/aero/flow/solver_test.cpp. SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "runtime/graph/graph.hpp"
#include "runtime/graph/sizes.hpp"
#include "src/aero/grid/store.hpp"

namespace spindrift::aero {

/// A field of the tiles with ghosts: where it is, what its components mean, and the data that stand for it in the graph.
template <class T>
struct HaloField {
  std::string label;                             ///< path of its tasks
  std::function<BoxView<T>(int tile)> view;      ///< of an owned tile, asked when the task runs (arrays may be swapped)
  std::function<BoxLayout(const Tile&)> layout;  ///< of any tile
  std::vector<Quantity> quantities;
  int layers = 1;
  const std::vector<runtime::Datum>*inside = nullptr, *ghosts = nullptr;  ///< by owned tile
  int tag = 0;                                      ///< of its messages; one per field and place in the graph
  const std::vector<RigidMap>* periodic = nullptr;  ///< of the grid where it is when the task runs
};

/// Records what fills the ghosts of all owned tiles: packing, messages, and one task per tile that copies, unpacks and then calls
/// `boundaries` (owned index). `active` false: the tasks do nothing and no message
/// passes; it is the same on all ranks and depends on `control` alone.
template <class T>
void record_halo(runtime::Graph& graph, const GridStore& grid, const std::vector<int>& local, const HaloField<T>& field,
                 std::deque<std::vector<T>>& buffers, const std::function<bool()>& active,
                 const std::function<void(int)>& boundaries, const std::vector<runtime::Use>& control) {
  using namespace runtime;
  const Tiling& tiling = grid.tiling();
  const int components = components_of(field.quantities);
  struct Incoming {
    const T* buffer;
    Datum datum;
    int link;
  };
  std::vector<std::vector<Incoming>> incoming(grid.owned().size());
  for (const LinkPlan::Message& message : grid.plan().sends) {
    std::size_t size = 0;
    for (const int l : message.links) size += packed_size(tiling.links[std::size_t(l)], components, field.layers);
    auto& buffer = buffers.emplace_back(size);
    const Datum datum = graph.datum();
    Uses uses = control;
    uses.push_back(writes(datum));
    for (const int l : message.links)
      uses.push_back(reads((*field.inside)[std::size_t(local[std::size_t(tiling.links[std::size_t(l)].from)])]));
    graph.task(field.label + "/pack/" + std::to_string(message.rank), uses,
               [field, &grid, &tiling, &buffer, links = message.links, components, active] {
                 if (!active()) return;
                 T* at = buffer.data();
                 for (const int l : links) {
                   const GhostLink& link = tiling.links[std::size_t(l)];
                   at = pack<T>(link, components, field.layers, field.view(link.from),
                                field.layout(tiling.tiles[std::size_t(link.to)]), at);
                 }
               });
    Uses sent = control;
    sent.push_back(reads(datum));
    graph.send(field.label + "/send/" + std::to_string(message.rank), sent,
               {message.rank, field.tag, buffer_of(std::span(buffer)), {}, active});
  }
  for (const LinkPlan::Message& message : grid.plan().receives) {
    std::size_t size = 0;
    for (const int l : message.links) size += packed_size(tiling.links[std::size_t(l)], components, field.layers);
    auto& buffer = buffers.emplace_back(size);
    const Datum datum = graph.datum();
    Uses received = control;
    received.push_back(writes(datum));
    graph.receive(field.label + "/receive/" + std::to_string(message.rank), received,
                  {message.rank, field.tag, buffer_of(std::span(buffer)), {}, active});
    const T* at = buffer.data();
    for (const int l : message.links) {
      const GhostLink& link = tiling.links[std::size_t(l)];
      incoming[std::size_t(local[std::size_t(link.to)])].push_back({at, datum, l});
      at += packed_size(link, components, field.layers);
    }
  }
  for (std::size_t n = 0; n < grid.owned().size(); ++n) {
    const int tile = grid.owned()[n];
    Uses uses = control;
    uses.push_back(reads((*field.inside)[n])), uses.push_back(writes((*field.ghosts)[n]));
    for (const GhostLink& link : tiling.into(tile))
      if (grid.owns(link.from)) uses.push_back(reads((*field.inside)[std::size_t(local[std::size_t(link.from)])]));
    for (const Incoming& in : incoming[n]) uses.push_back(reads(in.datum));
    const std::uint32_t task = graph.task(
        field.label + "/" + std::to_string(tile), uses, [field, &grid, &tiling, tile, n, from = incoming[n], active, boundaries] {
          if (!active()) return;
          for (const GhostLink& link : tiling.into(tile))
            if (grid.owns(link.from))
              copy_ghosts<T>(link, *field.periodic, field.quantities, field.layers, field.view(link.from), field.view(tile));
          for (const Incoming& in : from)
            unpack<T>(tiling.links[std::size_t(in.link)], *field.periodic, field.quantities, field.layers, in.buffer,
                      field.view(tile));
          boundaries(int(n));
        });
    for (const GhostLink& link : tiling.into(tile))
      if (grid.owns(link.from))
        set_bytes(graph, task, (*field.inside)[std::size_t(local[std::size_t(link.from)])],
                  packed_size(link, components, field.layers) * sizeof(T));
  }
}

}  // namespace spindrift::aero
