// How large a scene's rotor will be and what a pseudo-step of it costs, for `spindrift check`: bytes as store.cpp and
// flow_solver.cpp allocate them, tile by tile of the sector's blocks; rates stated, or measured by a short march. Declared in
// resolved_rotor_setup.hpp; tested against the solver's own count in tests/src/aero/resolved_rotor_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <vector>

#include "kernels/base/constants.hpp"
#include "kernels/linear/stencil_matrix.hpp"
#include "src/aero/flow/flow_solver.hpp"
#include "src/aero/flow/sweep_gradients.hpp"
#include "src/aero/flow/sweep_model.hpp"
#include "src/aero/flow_size.hpp"
#include "src/aero/resolved_rotor.hpp"
#include "src/aero/resolved_rotor_setup.hpp"
#include "src/aero/rotor_grid/layout.hpp"
#include "src/aero/turbine.hpp"

namespace spindrift::aero {

namespace {

// Of a pseudo-step, for each cell, measured on one core of 50 GFLOP/s in double (docs/developer/notes/rotor_resolved.md,
// coupled_system.md). Of steady marches, whose linear solutions take all their steps, each a residual sweep: SA with 20 Krylov
// vectors; inviscid. Of physical steps, which take some six steps by the matrix: SA; SA of a rotor to a drop, which take ten;
// inviscid. Where a rotor turns far in one of them its linear solutions take all their steps too. In the plane there are two
// directions of faces, and one cell in depth.
constexpr double viscous_seconds = 12e-6, inviscid_seconds = 7.5e-6, viscous_physical_seconds = 3.2e-6,
                 viscous_converged_seconds = 8e-6, inviscid_physical_seconds = 1.2e-6, planar_share = 0.5;

struct Kind {
  int unknowns = 5, turbulence = 0, time_order = 0, krylov_steps = 0;
  int levels = 0;  ///< past ones of the flow
  bool flexible = false, eddies = false, planar = false;
  bool turns = true;    ///< faces have speeds: a rotor's grid, which turns with it
  bool moving = false;  ///< nodes have places of steps before
  TilingOptions tiles;
  bool coarse = false;  ///< the preconditioner has groups of cells that move together
  int group_cells = 0, direct_groups = 0;
};

/// Of blocks: their tiles, the copy of their fields for a file, and the groups of cells of a coarse correction.
struct Parts {
  double bytes = 0.0, output = 0.0, groups = 0.0;
  Parts& operator+=(const Parts& more) {
    bytes += more.bytes, output += more.output, groups += more.groups;
    return *this;
  }
};

Kind kind_of(const FlowOptions& o) {
  Kind kind;
  kind.eddies = o.viscous != "none" && o.turbulence != "none";
  if (kind.eddies) kind.turbulence = model_sweeps(o.turbulence).equations;
  kind.unknowns += kind.turbulence;
  kind.time_order = time_order(o), kind.levels = past_levels(o);
  kind.tiles = tile_limits(o);
  kind.coarse = o.preconditioner == "coarse", kind.group_cells = o.group_cells, kind.direct_groups = o.direct_groups;
  kind.krylov_steps = o.krylov_steps, kind.flexible = o.krylov != KrylovMethod::gmres;
  return kind;
}

/// Of a tile, its i across the walls.
double tile_bytes(const Kind& kind, int ni, int nj, int nk) {
  constexpr double wide = sizeof(double), narrow = sizeof(float);
  const auto box = [&](int i, int j, int k, int ghosts, int components) {
    return double(BoxLayout(i, j, k, {ghosts, ghosts, kind.planar ? 0 : ghosts}).size(components));
  };
  const linear::CellBox cells{ni, nj, nk};
  const int directions = kind.planar ? 2 : 3;
  double bytes = wide * (2.0 * box(ni, nj, nk, state_ghosts, kind.unknowns) +
                         box(ni, nj, nk, gradient_ghosts, gradient_components(kind.turbulence, kind.eddies)) +
                         (1 + kind.levels) * box(ni, nj, nk, 0, kind.unknowns) + box(ni, nj, nk, 0, 1));
  double matrix = double(MeanMatrix::size(cells, directions)), vectors = kind.krylov_steps + 1;
  if (kind.turbulence == 1) matrix += double(linear::StencilMatrix<1>::size(cells, directions));
  if (kind.turbulence == 2) matrix += double(linear::StencilMatrix<2>::size(cells, directions));
  if (kind.flexible) vectors += kind.krylov_steps;
  if (kind.coarse)
    matrix += 25.0 * sizeof(linear::ShortFloat) / narrow * double(cells.count());  // blocks within a group, added up
  bytes += narrow * (matrix + box(ni, nj, nk, gradient_ghosts, kind.unknowns) + vectors * double(cells.count()) * kind.unknowns);
  // The grid: see store.hpp. Faces have a vector, speeds (also in a turning frame), and where nodes move two swept volumes; of
  // third order a step more.
  const int third = kind.moving && kind.time_order > 2 ? 1 : 0;
  bytes += wide * ((kind.moving ? 4 + third : 1) * box(ni + 1, nj + 1, nk + 1, 0, 3) + box(ni, nj, nk, cell_ghosts, 1) +
                   box(ni, nj, nk, cell_ghosts, 3) + box(ni, nj, nk, 0, 1));
  for (int d = 0; d < 3; ++d)
    bytes += wide * (3 + (kind.turns ? 1 : 0) + (kind.moving ? 2 + third : 0)) *
             box(ni + (d == 0), nj + (d == 1), nk + (d == 2), 0, 1);
  return bytes;
}

/// Of the copy of a tile's fields that is written as the run goes on: pressure, velocity, temperature, what turbulence carries;
/// nodes.
double output_bytes(const Kind& kind, int ni, int nj, int nk) {
  return sizeof(double) * (double(kind.unknowns) * ni * nj * nk + 3.0 * (ni + 1.0) * (nj + 1.0) * (nk + 1.0));
}

/// Of a block cut as tiling.cpp does; which direction is i matters little.
Parts parts_of_block(const Kind& kind, std::array<int, 3> n) {
  const Index target = tile_target(n[0], false, false, kind.tiles);
  double tiles = 1.0, groups_of_tile = 1.0;
  std::array<int, 3> size;
  for (std::size_t d = 0; d < 3; ++d) {
    const int pieces = std::max(1, (n[d] + target[d] - 1) / target[d]);
    size[d] = (n[d] + pieces - 1) / pieces, tiles *= double(n[d]) / size[d];
    if (kind.group_cells > 0) groups_of_tile *= (size[d] + kind.group_cells - 1) / kind.group_cells;
  }
  return {tiles * tile_bytes(kind, size[0], size[1], size[2]), tiles * output_bytes(kind, size[0], size[1], size[2]),
          tiles * groups_of_tile};
}

/// Counts a coarse level's matrix and factors. By elimination, which every rank makes: an envelope as wide as a plane through all
/// groups (a line in the plane), in double, and the entries it is made of, twice. By multigrid, shared: the matrix, its coarser
/// ones and their factors.
void add_coarse_level(FlowSize& size, const Kind& kind, double groups) {
  if (!kind.coarse) return;
  constexpr double block = 25.0 * sizeof(double), entries = 7.0, levels = 4.0;
  if (groups > kind.direct_groups)
    size.bytes += groups * entries * block * levels;
  else
    size.bytes_each = groups * block * (2.0 * std::pow(groups, kind.planar ? 1.0 / 2.0 : 2.0 / 3.0) + 2.0 * entries);
}

/// Cells of the sector's blocks along their directions.
std::vector<std::array<int, 3>> blocks_of_sector(const RotorGridSpec& spec) {
  const auto kept = [&](int n) { return std::max(1, n >> spec.coarsen); };
  const RotorGridSizes& z = spec.sizes;
  const int radial = kept(z.radial()), beside = kept(z.beside);
  std::vector<std::array<int, 3>> blocks{{kept(z.layers), kept(z.round), radial},
                                         {kept(z.edge), kept(z.chordwise()), kept(z.outboard)}};
  for (const int along : {kept(z.upstream), kept(z.downstream)}) {
    blocks.insert(blocks.end(), 2, {beside, along, radial});
    blocks.push_back({kept(z.box_chordwise()), along, radial});
  }
  blocks.insert(blocks.end(), 2, {beside, kept(z.box), radial});
  return blocks;
}

double seconds_per_cell(const ResolvedRotorSetup& setup) {
  FlowOptions like = setup.flow;
  if (turns_far(setup)) like.time = "steady";
  const bool converges = like.time != "steady" && like.viscous != "none" && like.drop > 0.0;
  return converges ? viscous_converged_seconds : seconds_per_cell(like);
}

}  // namespace

bool turns_far(const ResolvedRotorSetup& setup) {
  constexpr double far = 4.0 * radians_per_degree;  // recorded: 2.6 degrees are not, 5.5 are
  return std::abs(setup.rotor.speed) * setup.dt > far;
}

double seconds_per_cell(const FlowOptions& flow) {
  if (flow.time == "steady") return flow.viscous == "none" ? inviscid_seconds : viscous_seconds;
  return flow.viscous == "none" ? inviscid_physical_seconds : viscous_physical_seconds;
}

ResolvedRotorSize resolved_rotor_size(const ResolvedRotorSetup& setup) {
  const Turbine turbine = read_turbine(setup.rotor.turbine);
  const RotorGridSpec spec = rotor_grid_spec(setup.grid, turbine, setup.rotor.blade_pitch, setup.rotor.speed, setup.wind.norm());
  Kind kind = kind_of(setup.flow);
  kind.moving = kind.time_order > 0;
  ResolvedRotorSize size;
  size.sectors = spec.whole ? turbine.blades : 1;
  size.cells = size.sectors * spec.sizes.cells() >> (3 * spec.coarsen);
  size.stations = spec.sizes.span >> spec.coarsen;
  const double state = sizeof(double) * double(size.cells) * kind.unknowns * (1 + kind.levels);
  Parts sector;
  for (const std::array<int, 3>& block : blocks_of_sector(spec)) sector += parts_of_block(kind, block);
  size.bytes_of_output = size.sectors * sector.output;
  size.bytes = size.sectors * sector.bytes + (kind.moving ? state : 0.0);
  add_coarse_level(size, kind, size.sectors * sector.groups);
  size.bytes_of_checkpoint = state;
  size.core_seconds_per_pseudo_step = double(size.cells) * seconds_per_cell(setup);
  return size;
}

FlowSize flow_size(const FlowOptions& flow, const MultiBlockGrid& grid) {
  Kind kind = kind_of(flow);
  kind.planar = grid.planar;
  kind.turns = kind.moving = flow.motion && kind.time_order > 0;
  FlowSize size;
  Parts parts;
  for (const Block& b : grid.blocks) {
    size.cells += long(b.ni) * b.nj * b.nk;
    parts += parts_of_block(kind, {b.ni, b.nj, b.nk});
    size.bytes += 3.0 * sizeof(double) * double(b.ni + 1) * (b.nj + 1) * (b.nk + 1);  // nodes of the grid as read or made
  }
  // The coarser grids that a steady march begins on are gone before the fine one's matrix is first written: they add nothing.
  size.bytes += parts.bytes, size.bytes_of_output = parts.output;
  add_coarse_level(size, kind, parts.groups);
  size.bytes_of_checkpoint = sizeof(double) * double(size.cells) * kind.unknowns * (1 + kind.levels);
  size.core_seconds_per_pseudo_step = double(size.cells) * seconds_per_cell(flow) * (grid.planar ? planar_share : 1.0);
  return size;
}

AirRate measured_air_rate(const ResolvedRotorSetup& scene) {
  ResolvedRotorSetup setup = scene;
  setup.grid = {};
  setup.grid.resolution = 1.0, setup.grid.sectors = "one";
  if (!setup.wind.isZero()) setup.rotor.axis = setup.wind.normalized();
  setup.dt = 0.0;
  setup.flow.time = "steady", setup.flow.max_pseudo_steps = 8, setup.flow.drop = 1e-12, setup.flow.load_change = 0.0;
  ResolvedRotor rotor(setup);
  rotor.solver().start_uniform();
  rotor.prepare(MPI_COMM_SELF, {.threads = 1});
  const std::clock_t begin = std::clock();
  rotor.run();
  AirRate rate{.cells = rotor.solver().cells(), .pseudo_steps = std::max(1, rotor.solver().march().steps - 1)};
  rate.core_seconds = double(std::clock() - begin) / CLOCKS_PER_SEC / (double(rate.cells) * rate.pseudo_steps);
  rate.core_seconds *= seconds_per_cell(scene) / seconds_per_cell(setup);  // of steps like the scene's
  return rate;
}

}  // namespace spindrift::aero
