// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/air_file.hpp"

#include <fmt/format.h>

#include "src/io/machine_failure.hpp"

namespace spindrift::coupling {

AirFile::AirFile(aero::FlowSolver& solver, const aero::GridStore& store) : solver_(solver) {
  const std::int64_t per_cell = solver.tiles().empty() ? 0 : std::int64_t(solver.saved_size(0)) / solver.tiles()[0].box.count();
  for (const aero::Tile& tile : store.tiling().tiles) starts_.push_back(total_), total_ += tile.count() * per_cell;
}

void AirFile::write(io::CheckpointWriter& file) const {
  std::vector<std::vector<double>> tiles;
  std::vector<io::Slice<const double>> slices;
  for (int n = 0; n < int(solver_.tiles().size()); ++n) {
    auto& values = tiles.emplace_back(solver_.saved_size(n));
    solver_.save(n, values);
  }
  for (std::size_t n = 0; n < tiles.size(); ++n)
    slices.push_back({starts_[std::size_t(solver_.tiles()[n].index)], std::span<const double>(tiles[n])});
  file.write<double>("flow/march", std::span<const double>(solver_.save_march()));
  file.write<double>("flow/tiles", total_, slices);
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
