// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/air_output.hpp"

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <string>

#include "src/io/atomic_file.hpp"

namespace spindrift::coupling {

namespace {

bool on_wall(const aero::FlowSolver& solver, const aero::TileBoundary& b) {
  return aero::is_closed(solver.judgement().conditions()[std::size_t(b.patch)].condition);
}

}  // namespace

AirOutput::AirOutput(MPI_Comm comm, const aero::FlowSolver& solver, const std::filesystem::path& folder, Choice choice)
    : solver_(&solver) {
  const aero::Tiling& tiling = solver.grid().tiling();
  std::vector<io::GridBlock> blocks;
  for (const aero::Tile& tile : tiling.tiles)
    blocks.push_back({fmt::format("tile_{}", blocks.size()), tile.ni, tile.nj, tile.nk});
  std::vector<io::Field> fields{{"pressure", "Pa"}, {"velocity", "m/s", 3}, {"temperature", "K"}};
  const int carried = solver.tiles().empty() ? 0 : solver.tiles()[0].turbulence;
  for (int t = 0; t < carried; ++t)
    fields.push_back({fmt::format("turbulence_{}", t + 1), carried == 1 ? "m2/s" : t == 0 ? "m2/s2" : "1/s"});
  volume_ =
      std::make_unique<io::GridFields>(comm, folder, "air", std::move(blocks), std::move(fields), choice.moves, choice.resume_s);
  if (!choice.walls) return;
  // A block for each window of a tile on a wall.
  std::vector<io::GridBlock> faces;
  for (int tile = 0; tile < tiling.size(); ++tile) {
    first_block_.push_back(int(faces.size()));
    for (const aero::TileBoundary& b : tiling.boundary(tile))
      if (on_wall(solver, b))
        faces.push_back({fmt::format("{}_{}", tiling.patches[std::size_t(b.patch)], faces.size()), b.high[0] - b.low[0],
                         b.high[1] - b.low[1], 0});
  }
  if (faces.empty()) return;
  walls_ = std::make_unique<io::GridFields>(
      comm, folder, "walls", std::move(faces),
      std::vector<io::Field>{
          {"pressure", "Pa"}, {"pressure_coefficient", "-"}, {"friction_coefficient", "-", 3}, {"y_plus", "-"}},
      choice.moves, choice.resume_s);
}

Writing AirOutput::copy(std::int64_t number, double time_s) const {
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
  const int carried = solver_->tiles().empty() ? 0 : solver_->tiles()[0].turbulence;
  const gas::IdealGas& gas = solver_->setting().gas;
  const auto copy = std::make_shared<FieldCopy>();
  auto& kept = copy->arrays;
  auto& values = copy->values;
  kept.reserve(solver_->tiles().size() * std::size_t(4 + carried));
  for (const aero::FlowTile& t : solver_->tiles()) {
    const std::size_t cells = std::size_t(t.box.count());
    const auto array_of = [&](std::size_t count) -> std::vector<double>& {
      auto& array = kept.emplace_back();
      array.reserve(count);
      return array;
    };
    const auto component = [&](int c, double offset) -> std::vector<double>& {
      auto& out = array_of(cells);
      aero::for_rows(t.box, [&](int k, int j) {
        for (int i = 0; i < t.box.ni; ++i) out.push_back(offset + t.state.data()[c * t.cells.component + t.cells.at(k, j, i)]);
      });
      return out;
    };
    auto& points = array_of(3 * std::size_t(t.box.ni + 1) * std::size_t(t.box.nj + 1) * std::size_t(t.box.nk + 1));
    const BoxLayout& nodes = t.geometry->node_box;
    for (int k = 0; k <= t.box.nk; ++k)
      for (int j = 0; j <= t.box.nj; ++j)
        for (int i = 0; i <= t.box.ni; ++i)
          for (int c = 0; c < 3; ++c) points.push_back(t.geometry->node_data.data()[c * nodes.component + nodes.at(k, j, i)]);
    io::GridFields::Values v{t.index, points, {}};
    v.fields.push_back(component(0, gas.pressure_reference));
    auto& velocity = array_of(3 * cells);
    aero::for_rows(t.box, [&](int k, int j) {
      for (int i = 0; i < t.box.ni; ++i)
        for (int c = 1; c < 4; ++c) velocity.push_back(t.state.data()[c * t.cells.component + t.cells.at(k, j, i)]);
    });
    v.fields.push_back(velocity);
    v.fields.push_back(component(4, gas.temperature_reference));
    for (int c = 0; c < carried; ++c) v.fields.push_back(component(aero::mean_unknowns + c, 0.0));
    values.push_back(std::move(v));
  }
  return [fields = volume_.get(), number, time_s, copy] { fields->write(number, time_s, copy->values); };
}

Writing AirOutput::copy_walls(std::int64_t number, double time_s) const {
  const aero::FlowSetting& s = solver_->setting();
  const double q = 0.5 * gas::density(s.gas, s.stream) * s.speed * s.speed;
  const auto copy = std::make_shared<FieldCopy>();
  for (const aero::FlowTile& t : solver_->tiles()) {
    const std::vector<aero::WallPoint> points = solver_->wall_points(t);
    std::size_t at = 0;
    int block = first_block_[std::size_t(t.index)];
    for (const aero::FlowBoundary& b : t.boundaries) {
      if (!on_wall(*solver_, b.where)) continue;
      std::vector<double> corners, pressure, cp, cf, y_plus;
      const int d = aero::direction_of(b.where.side), extent[3] = {t.box.ni, t.box.nj, t.box.nk};
      const auto [along_a, along_b] = aero::along(b.where.side);
      const BoxLayout& nodes = t.geometry->node_box;
      int n[3];
      n[d] = aero::at_end(b.where.side) ? extent[d] : 0;
      for (n[along_b] = b.where.low[1]; n[along_b] <= b.where.high[1]; ++n[along_b])
        for (n[along_a] = b.where.low[0]; n[along_a] <= b.where.high[0]; ++n[along_a])
          for (int c = 0; c < 3; ++c)
            corners.push_back(t.geometry->node_data.data()[c * nodes.component + nodes.at(n[2], n[1], n[0])]);
      const int faces = (b.where.high[0] - b.where.low[0]) * (b.where.high[1] - b.where.low[1]);
      for (int m = 0; m < faces; ++m) {
        const aero::WallPoint& p = points.at(at++);
        pressure.push_back(s.gas.pressure_reference + p.pressure), cp.push_back(p.pressure / q), y_plus.push_back(p.y_plus);
        for (const double stress : p.traction) cf.push_back(stress / q);
      }
      // A span follows a vector's memory, which moving it does not move.
      copy->values.push_back({block++, corners, {pressure, cp, cf, y_plus}});
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
