// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/air_file.hpp"

#include <fmt/format.h>

#include "src/io/machine_failure.hpp"

namespace spindrift::coupling {

AirFile::AirFile(aero::FlowSolver& solver, const aero::GridStore& store, int rank) : solver_(solver), rank_(rank) {
  const std::int64_t per_cell = solver.tiles().empty() ? 0 : std::int64_t(solver.saved_size(0)) / solver.tiles()[0].box.count();
  for (const aero::Tile& tile : store.tiling().tiles) starts_.push_back(total_), total_ += tile.count() * per_cell;
}

std::vector<SavedArray> AirFile::arrays() const {
  SavedArray march{"flow/march", 0, {}}, tiles{"flow/tiles", total_, {}};
  std::vector<double> values = solver_.save_march();
  march.total = std::int64_t(values.size());
  if (rank_ == 0) march.pieces.push_back({0, std::move(values)});
  for (int n = 0; n < int(solver_.tiles().size()); ++n) {
    tiles.pieces.push_back({starts_[std::size_t(solver_.tiles()[std::size_t(n)].index)], std::vector<double>(solver_.saved_size(n))});
    solver_.save(n, tiles.pieces.back().values);
  }
  return {std::move(march), std::move(tiles)};
}

void AirFile::read(const io::CheckpointReader& file) const {
  if (file.size("flow/tiles") != total_)
    throw io::InputError(
        fmt::format("{}: its air has {} values, this one {}", file.path().string(), file.size("flow/tiles"), total_));
  for (int n = 0; n < int(solver_.tiles().size()); ++n) {
    std::vector<double> values(solver_.saved_size(n));
    const io::Slice<double> slice{starts_[std::size_t(solver_.tiles()[std::size_t(n)].index)], values};
    file.read<double>("flow/tiles", std::span(&slice, 1));
    solver_.load(n, values);
  }
  solver_.load_march(file.read<double>("flow/march"));
}

}  // namespace spindrift::coupling
