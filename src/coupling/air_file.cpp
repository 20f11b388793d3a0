// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/air_file.hpp"

#include <fmt/format.h>

#include <numeric>

#include "runtime/mpi/exchange.hpp"
#include "src/io/machine_failure.hpp"

namespace spindrift::coupling {

namespace {

constexpr const char *set_up_name = "flow/set_up", *cut_name = "flow/cut";

/// Block and cells of each tile.
std::vector<double> cut_of(const aero::Tiling& tiling) {
  std::vector<double> cut;
  for (const aero::Tile& tile : tiling.tiles)
    cut.insert(cut.end(), {double(tile.block), double(tile.ni), double(tile.nj), double(tile.nk)});
  return cut;
}

}  // namespace

void require_same_tiles(const io::CheckpointReader& file, const aero::Tiling& tiling) {
  if (file.has(cut_name) && file.read<double>(cut_name) != cut_of(tiling))
    throw io::InputError(
        fmt::format("{}: its air was cut into other tiles: aero.flow.tile_cells was another", file.path().string()));
}

AirFile::AirFile(aero::FlowSolver& solver, const runtime::World& world) : solver_(solver), world_(world) {
  const std::int64_t per_cell =
      solver.tiles().empty() ? 0 : std::int64_t(solver.restart().size(0)) / solver.tiles()[0].box.count();
  for (const aero::Tile& tile : solver.grid().tiling().tiles) starts_.push_back(total_), total_ += tile.count() * per_cell;
}

std::vector<SavedArray> AirFile::arrays() const {
  SavedArray march{"flow/march", 0, {}}, tiles{"flow/tiles", total_, {}};
  std::vector<double> values = solver_.restart().save_march();
  march.total = std::int64_t(values.size());
  if (world_.rank == 0) march.pieces.push_back({0, std::move(values)});
  for (int n = 0; n < int(solver_.tiles().size()); ++n) {
    tiles.pieces.push_back(
        {starts_[std::size_t(solver_.tiles()[std::size_t(n)].index)], std::vector<double>(solver_.restart().size(n))});
    solver_.restart().save(n, tiles.pieces.back().values);
  }
  std::vector<SavedArray> arrays;  // not by a list, which copies
  arrays.push_back(std::move(march)), arrays.push_back(std::move(tiles));
  const std::vector<double> cut = cut_of(solver_.grid().tiling());
  arrays.push_back({cut_name, std::int64_t(cut.size()), {}});
  if (world_.rank == 0) arrays.back().pieces.push_back({0, cut});
  if (!solver_.restart().keeps_set_up()) return arrays;
  const std::vector<std::int64_t> starts = set_up_starts();
  aero::SetUpNote note = solver_.restart().save_set_up();
  SavedArray& set_up = arrays.emplace_back(SavedArray{set_up_name, starts.back(), {}});
  for (std::size_t n = 0; n < note.tiles.size(); ++n)
    set_up.pieces.push_back({starts[std::size_t(solver_.tiles()[n].index)], std::move(note.tiles[n])});
  return arrays;
}

std::vector<std::int64_t> AirFile::set_up_starts() const {
  std::vector<std::int64_t> sizes(starts_.size() + 1), mine;
  for (int n = 0; n < int(solver_.tiles().size()); ++n)
    mine.insert(mine.end(), {solver_.tiles()[std::size_t(n)].index, std::int64_t(solver_.restart().set_up_size(n))});
  runtime::Packer parcel;
  parcel.put(std::span<const std::int64_t>(mine));
  for (const runtime::Bytes& bytes : runtime::exchange_all(world_.comm, parcel.take())) {
    const auto theirs = runtime::Unpacker(bytes).many<std::int64_t>();
    for (std::size_t n = 0; n < theirs.size(); n += 2) sizes[std::size_t(theirs[n])] = theirs[n + 1];
  }
  std::exclusive_scan(sizes.begin(), sizes.end(), sizes.begin(), std::int64_t(0));
  return sizes;
}

void AirFile::read(const io::CheckpointReader& file) const {
  if (file.size("flow/tiles") != total_)
    throw io::InputError(
        fmt::format("{}: its air has {} values, this one {}", file.path().string(), file.size("flow/tiles"), total_));
  require_same_tiles(file, solver_.grid().tiling());
  for (int n = 0; n < int(solver_.tiles().size()); ++n) {
    std::vector<double> values(solver_.restart().size(n));
    const io::Slice<double> slice{starts_[std::size_t(solver_.tiles()[std::size_t(n)].index)], values};
    file.read<double>("flow/tiles", std::span(&slice, 1));
    solver_.restart().load(n, values);
  }
  solver_.restart().load_march(file.read<double>("flow/march"));
  if (!solver_.restart().keeps_set_up()) return;
  const std::vector<std::int64_t> starts = set_up_starts();
  if (!file.has(set_up_name) || file.size(set_up_name) != starts.back()) return;  // of another march: the next step makes its own
  aero::SetUpNote note;
  for (int n = 0; n < int(solver_.tiles().size()); ++n) {
    std::vector<double>& values = note.tiles.emplace_back(solver_.restart().set_up_size(n));
    const io::Slice<double> slice{starts[std::size_t(solver_.tiles()[std::size_t(n)].index)], values};
    file.read<double>(set_up_name, std::span(&slice, 1));
  }
  solver_.restart().load_set_up(note);
}

}  // namespace spindrift::coupling
