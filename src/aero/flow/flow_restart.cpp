// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/flow_restart.hpp"

#include <algorithm>

#include "src/aero/flow/sweep.hpp"

namespace spindrift::aero {

namespace {
template <class Tile, class Body>
void for_saved(Tile& t, int levels, Body&& body) {
  const auto walk = [&](auto& array, const BoxLayout& layout) {
    for (int c = 0; c < t.unknowns(); ++c)
      for_rows(t.box, [&](int k, int j) {
        for (int i = 0; i < t.box.ni; ++i) body(array.data()[c * layout.component + layout.at(k, j, i)]);
      });
  };
  walk(t.state, t.cells);
  for (int n = 0; n < levels; ++n) walk(t.past[std::size_t(n)], t.inner);
}
}  // namespace

std::size_t FlowRestart::size(int owned) const {
  const FlowTile& t = arrays_.tiles[std::size_t(owned)];
  return std::size_t(t.box.count()) * std::size_t(t.unknowns()) * std::size_t(1 + time_.levels);
}

void FlowRestart::save(int owned, std::span<double> to) const {
  std::size_t n = 0;
  for_saved(arrays_.tiles[std::size_t(owned)], time_.levels, [&](const double& value) { to[n++] = value; });
}

void FlowRestart::load(int owned, std::span<const double> from) {
  std::size_t n = 0;
  for_saved(arrays_.tiles[std::size_t(owned)], time_.levels, [&](double& value) { value = from[n++]; });
}

SetUpNote FlowRestart::save_set_up() const {
  SetUpNote note;
  if (!keeps_set_up()) return note;
  const Preconditioner& kept = system_.preconditioner();
  note.number = kept.kept_number();
  for (const FlowTile& tile : arrays_.tiles) kept.save_kept(tile, note.tiles.emplace_back(kept.kept_size(tile)));
  return note;
}

void FlowRestart::load_set_up(const SetUpNote& from) {
  if (!keeps_set_up() || from.tiles.size() != arrays_.tiles.size()) return;
  Preconditioner& kept = system_.preconditioner();
  if (from.number > 0 && from.number == kept.kept_number()) return;  // it stands
  for (std::size_t n = 0; n < from.tiles.size(); ++n) kept.load_kept(arrays_.tiles[n], from.tiles[n]);
  kept.set_kept_number(from.number);
}

std::vector<double> FlowRestart::save_march() const {
  std::vector<double> all = march_.save();
  all.push_back(double(time_.steps));
  all.insert(all.end(), time_.before.begin(), time_.before.begin() + time_.lengths());
  if (motion_.moves()) motion_.save(all);
  return all;
}

void FlowRestart::load_march(std::span<const double> from) {
  march_.load(from);
  from = from.subspan(march_.save().size());
  time_.steps = std::int64_t(from[0]);
  from = from.subspan(1);
  std::copy_n(from.begin(), time_.lengths(), time_.before.begin());
  if (motion_.moves()) motion_.load(from.subspan(std::size_t(time_.lengths())));
}

TileStates FlowRestart::save_tiles() const {
  TileStates tiles;
  for (int n = 0; n < int(arrays_.tiles.size()); ++n) save(n, tiles.emplace_back(size(n)));
  return tiles;
}

void FlowRestart::load_tiles(const TileStates& from) {
  for (int n = 0; n < int(from.size()); ++n) {
    std::vector<double> values(size(n));
    std::ranges::copy(from[std::size_t(n)], values.begin());
    load(n, values);
  }
}

FlowSnapshot FlowRestart::snapshot() const { return {.tiles = save_tiles(), .march = save_march(), .set_up = save_set_up()}; }

void FlowRestart::restore(const FlowSnapshot& from) {
  load_tiles(from.tiles);
  load_march(from.march);
  load_set_up(from.set_up);
}

}  // namespace spindrift::aero
