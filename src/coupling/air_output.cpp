// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/air_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <fstream>
#include <string>

#include "src/io/atomic_file.hpp"

namespace spindrift::coupling {

namespace {

/// A name that HDF5 and XDMF take for one: files of grids have blanks, colons and slashes in theirs.
std::string path_part(std::string name) {
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-' && c != '.') c = '_';
  return name;
}

/// Each block of a grid by its name; by its number too where it has no name of its own.
std::vector<std::string> block_names(const aero::Tiling& tiling) {
  std::vector<std::string> names;
  for (const std::string& given : tiling.block_names) {
    std::string name = path_part(given);
    if (name.find_first_not_of("0123456789.") == std::string::npos) name = "block_" + name;
    while (std::ranges::find(names, name) != names.end()) name += fmt::format("_{}", names.size() + 1);
    names.push_back(std::move(name));
  }
  return names;
}

/// A box of cells or nodes of a tile, or of one of its sides, walked in the order of the tile's block: i fastest, then j, then k.
class BlockOrder {
 public:
  /// `count` and `step` in memory along the tile's directions, `first` is the element at the tile's (0, 0, 0) or the side's.
  BlockOrder(const aero::IndexMap& to_block, const aero::Index& count, const std::array<std::ptrdiff_t, 3>& step,
             std::ptrdiff_t first)
      : first_(first) {
    for (int d = 0; d < 3; ++d) {
      const auto t = std::size_t(to_block.target(d));
      count_[t] = count[std::size_t(d)], step_[t] = to_block.sign(d) * step[std::size_t(d)];
      if (to_block.sign(d) < 0) first_ += (count[std::size_t(d)] - 1) * step[std::size_t(d)];
    }
  }
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (int k = 0; k < count_[2]; ++k)
      for (int j = 0; j < count_[1]; ++j)
        for (int i = 0; i < count_[0]; ++i) visit(first_ + k * step_[2] + j * step_[1] + i * step_[0]);
  }
  std::size_t size() const { return std::size_t(count_[0]) * std::size_t(count_[1]) * std::size_t(count_[2]); }

 private:
  aero::Index count_{};
  std::array<std::ptrdiff_t, 3> step_{};
  std::ptrdiff_t first_;
};

std::array<std::ptrdiff_t, 3> steps(const BoxLayout& box) { return {box.stride(0), box.stride(1), box.stride(2)}; }

/// In full: at low Mach numbers single precision (8 mPa at one bar) leaves nothing of what the flow adds to the undisturbed one.
const io::Field absolute_pressure{"pressure", "Pa", 1, io::Precision::full};

}  // namespace

AirOutput::AirOutput(MPI_Comm comm, const aero::FlowSolver& solver, const std::filesystem::path& folder, Choice choice)
    : solver_(&solver) {
  const aero::Tiling& tiling = solver.grid().tiling();
  const std::vector<std::string> names = block_names(tiling);
  std::vector<io::GridBlock> blocks;
  for (std::size_t n = 0; n < names.size(); ++n) {
    const auto [ni, nj, nk] = tiling.block_cells[n];
    blocks.push_back({names[n], ni, nj, nk});
  }
  std::vector<io::Field> fields{absolute_pressure, {"velocity", "m/s", 3}, {"temperature", "K"}};
  const int carried = solver.tiles().empty() ? 0 : solver.tiles()[0].turbulence;
  for (int t = 0; t < carried; ++t)
    fields.push_back({fmt::format("turbulence_{}", t + 1), carried == 1 ? "m2/s" : t == 0 ? "m2/s2" : "1/s"});
  volume_ =
      std::make_unique<io::GridFields>(comm, folder, "air", std::move(blocks), std::move(fields), choice.moves, choice.resume_s);
  if (volume_->ends_with(choice.resume_s)) written_s_ = choice.resume_s;
  if (!choice.walls) return;
  // A surface for each of the grid's windows on a wall.
  std::vector<io::GridBlock> faces;
  for (const aero::Boundary& b : tiling.windows) {
    const bool wall = aero::is_closed(solver.judgement().conditions()[std::size_t(tiling.patch(b.patch))].condition);
    wall_block_.push_back(wall ? int(faces.size()) : -1);
    if (wall)
      faces.push_back({fmt::format("{}_{}", path_part(b.patch), faces.size()), b.where.high[0] - b.where.low[0],
                       b.where.high[1] - b.where.low[1], 0});
  }
  if (faces.empty()) return;
  walls_ = std::make_unique<io::GridFields>(
      comm, folder, "walls", std::move(faces),
      std::vector<io::Field>{absolute_pressure, {"pressure_coefficient", "-"}, {"friction_coefficient", "-", 3}, {"y_plus", "-"}},
      choice.moves, choice.resume_s);
}

Writing AirOutput::copy(std::int64_t number, double time_s) {
  if (written_s_ == time_s) return {};
  written_s_ = time_s;
  Writing volume = copy_volume(number, time_s);
  if (!walls_) return volume;
  return [volume = std::move(volume), walls = copy_walls(number, time_s)] { volume(), walls(); };
}

namespace {

/// Values of fields, and the memory that they are in.
struct FieldCopy {
  std::vector<std::vector<double>> arrays;
  std::vector<io::GridFields::Values> values;
};

}  // namespace

Writing AirOutput::copy_volume(std::int64_t number, double time_s) const {
  const aero::Tiling& tiling = solver_->grid().tiling();
  const int carried = solver_->tiles().empty() ? 0 : solver_->tiles()[0].turbulence;
  const gas::IdealGas& gas = solver_->setting().gas;
  const auto copy = std::make_shared<FieldCopy>();
  auto& kept = copy->arrays;
  auto& values = copy->values;
  kept.reserve(solver_->tiles().size() * std::size_t(4 + carried));
  for (const aero::FlowTile& t : solver_->tiles()) {
    const aero::Tile& tile = tiling.tiles[std::size_t(t.index)];
    const auto array_of = [&](std::size_t count) -> std::vector<double>& {
      auto& array = kept.emplace_back();
      array.reserve(count);
      return array;
    };
    const BoxLayout& nodes = t.geometry->node_box;
    const BlockOrder corners(tile.to_block, {tile.ni + 1, tile.nj + 1, tile.nk + 1}, steps(nodes), nodes.at(0, 0, 0)),
        cells(tile.to_block, tile.cells(), steps(t.cells), t.cells.at(0, 0, 0));
    const auto component = [&](int c, double offset) -> std::vector<double>& {
      auto& out = array_of(cells.size());
      cells.for_each([&](std::ptrdiff_t at) { out.push_back(offset + t.state.data()[c * t.cells.component + at]); });
      return out;
    };
    auto& points = array_of(3 * corners.size());
    corners.for_each([&](std::ptrdiff_t at) {
      for (int c = 0; c < 3; ++c) points.push_back(t.geometry->node_data.data()[c * nodes.component + at]);
    });
    const aero::Box box = image(tile.to_block, tile.box());
    io::GridFields::Values v{tile.block, box.low, box.high, points, {}};
    v.fields.push_back(component(0, gas.pressure_reference));
    auto& velocity = array_of(3 * cells.size());
    cells.for_each([&](std::ptrdiff_t at) {
      for (int c = 1; c < 4; ++c) velocity.push_back(t.state.data()[c * t.cells.component + at]);
    });
    v.fields.push_back(velocity);
    v.fields.push_back(component(4, gas.temperature_reference));
    for (int c = 0; c < carried; ++c) v.fields.push_back(component(aero::mean_unknowns + c, 0.0));
    values.push_back(std::move(v));
  }
  return [fields = volume_.get(), number, time_s, copy] { fields->write(number, time_s, copy->values); };
}

Writing AirOutput::copy_walls(std::int64_t number, double time_s) const {
  const aero::Tiling& tiling = solver_->grid().tiling();
  const aero::FlowSetting& s = solver_->setting();
  const double q = 0.5 * gas::density(s.gas, s.stream) * s.speed * s.speed;
  const auto copy = std::make_shared<FieldCopy>();
  for (const aero::FlowTile& t : solver_->tiles()) {
    const aero::Tile& tile = tiling.tiles[std::size_t(t.index)];
    const std::vector<aero::WallPoint> points = solver_->wall_points(t);  // boundary by boundary, the lower direction fastest
    std::size_t at = 0;
    for (const aero::FlowBoundary& b : t.boundaries) {
      const int block = wall_block_[std::size_t(b.where.window)];
      if (block < 0) continue;
      std::vector<double> corners, pressure, cp, cf, y_plus;
      const auto d = std::size_t(aero::direction_of(b.where.side));
      const auto [along_a, along_b] = aero::along(b.where.side);
      const std::array<int, 2> n{b.where.high[0] - b.where.low[0], b.where.high[1] - b.where.low[1]};
      const BoxLayout& nodes = t.geometry->node_box;
      aero::Index first{}, faces{1, 1, 1}, edges{1, 1, 1};
      std::array<std::ptrdiff_t, 3> step{};
      first[d] = aero::at_end(b.where.side) ? tile.cells()[d] : 0;
      first[std::size_t(along_a)] = b.where.low[0], first[std::size_t(along_b)] = b.where.low[1];
      faces[std::size_t(along_a)] = n[0], faces[std::size_t(along_b)] = n[1];
      edges[std::size_t(along_a)] = n[0] + 1, edges[std::size_t(along_b)] = n[1] + 1;
      step[std::size_t(along_a)] = 1, step[std::size_t(along_b)] = n[0];
      BlockOrder(tile.to_block, edges, steps(nodes), nodes.at(first[2], first[1], first[0])).for_each([&](std::ptrdiff_t node) {
        for (int c = 0; c < 3; ++c) corners.push_back(t.geometry->node_data.data()[c * nodes.component + node]);
      });
      BlockOrder(tile.to_block, faces, step, std::ptrdiff_t(at)).for_each([&](std::ptrdiff_t face) {
        const aero::WallPoint& p = points.at(std::size_t(face));
        pressure.push_back(s.gas.pressure_reference + p.pressure), cp.push_back(p.pressure / q), y_plus.push_back(p.y_plus);
        for (const double stress : p.traction) cf.push_back(stress / q);
      });
      at += std::size_t(n[0]) * std::size_t(n[1]);
      // The faces in their window: where the cells under them lie in the block, along the block's side.
      const aero::Window& window = tiling.windows[std::size_t(b.where.window)].where;
      const aero::Box under =
          image(tile.to_block, aero::cells_at({0, b.where.side, b.where.low, b.where.high}, tile.cells(), false));
      const auto [i, j] = aero::along(window.side);
      const std::array<int, 3> low{under.low[std::size_t(i)] - window.low[0], under.low[std::size_t(j)] - window.low[1], 0},
          high{under.high[std::size_t(i)] - window.low[0], under.high[std::size_t(j)] - window.low[1], 0};
      // A span follows a vector's memory, which moving it does not move.
      copy->values.push_back({block, low, high, corners, {pressure, cp, cf, y_plus}});
      for (auto* array : {&corners, &pressure, &cp, &cf, &y_plus}) copy->arrays.push_back(std::move(*array));
    }
  }
  return [fields = walls_.get(), number, time_s, copy] { fields->write(number, time_s, copy->values); };
}

void write_choice(const io::RunDirectory& directory, const std::string& preconditioner) {
  std::ifstream in(directory.scene());
  std::string text, line;
  while (std::getline(in, line)) {
    const std::string automatic = "preconditioner = \"auto\"";
    if (const std::size_t at = line.find(automatic); at != std::string::npos)
      line.replace(at, automatic.size(), fmt::format("preconditioner = \"{}\"", preconditioner));
    // Keys that "auto" knows and block ILU does not would be refused.
    const bool has_none =
        preconditioner == "block_ilu" && (line.starts_with("group_cells =") || line.starts_with("direct_groups =") ||
                                          line.starts_with("common_every =") || line.starts_with("common_steps ="));
    if (!has_none) text += line + "\n";
  }
  io::write_atomically(directory.scene(), text);
}

void write_span(const runtime::World& world, const std::vector<aero::SpanLoad>& loads, const io::RunDirectory& directory) {
  if (world.rank != 0) return;
  std::string text = "blade,radius_m,length_m,chord_m,normal_N_m,tangential_N_m,friction_normal_N_m,friction_tangential_N_m\n";
  for (const aero::SpanLoad& s : loads)
    text += fmt::format("{},{:.6g},{:.6g},{:.6g},{:.17g},{:.17g},{:.17g},{:.17g}\n", s.blade, s.radius, s.length, s.chord,
                        s.load.normal, s.load.tangential, s.friction.normal, s.friction.tangential);
  io::write_atomically(directory.path() / "spanwise.csv", text);
}

}  // namespace spindrift::coupling
