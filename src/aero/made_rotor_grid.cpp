// SPDX-License-Identifier: Apache-2.0
#include "src/aero/made_rotor_grid.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <span>
#include <string>
#include <utility>

#include "kernels/base/failure.hpp"
#include "runtime/mpi/exchange.hpp"
#include "runtime/mpi/stop_request.hpp"
#include "src/aero/grid/checks.hpp"
#include "src/aero/rotor_grid/options.hpp"
#include "src/aero/rotor_grid/pitching.hpp"
#include "src/aero/rotor_grid/quality.hpp"
#include "src/scene/error.hpp"

namespace spindrift::aero {

namespace {

/// Of the nodes on a surface of a block: their number and moments of their places, equal for equal grids and hardly ever for
/// others.
struct Moments {
  int block = 0;
  std::array<double, 3> sums{};
};

/// What ranks see in layers from the hub on, one after the other.
struct Look {
  std::string failure;    ///< why it could not be; then there is nothing else
  bool given_up = false;  ///< since the run is to stop; likewise
  RotorGridQuality quality;
  EdgeLengths edges;
  std::vector<Moments> moments;
  std::vector<double> radii;
  std::vector<WallSurface::Face> walls;
  std::vector<std::vector<BladeStation>> stations;
};

/// `last`: nothing lies beyond, so that the outermost surface is one of these too.
void add_moments(const GridLayers& part, bool last, std::vector<Moments>& moments) {
  for (std::size_t n = 0; n < part.grid.blocks.size(); ++n) {
    const Block& b = part.grid.blocks[n];
    for (int k = 0; k < part.count[n] + (last && part.count[n] > 0 ? 1 : 0); ++k) {
      Moments& surface = moments.emplace_back(Moments{.block = int(n)});
      for (std::size_t p = b.node(k, 0, 0); p < b.node(k + 1, 0, 0); ++p) {
        const Eigen::Vector3d& x = b.nodes[p];
        surface.sums[0] += 1.0, surface.sums[1] += x.x() + 2.0 * x.y() + 3.0 * x.z(), surface.sums[2] += x.squaredNorm();
      }
    }
  }
}

std::array<double, 3> sum(std::span<const Moments> moments, std::size_t blocks) {
  std::vector<std::array<double, 3>> by_block(blocks);
  for (const Moments& m : moments)
    for (std::size_t d = 0; d < 3; ++d) by_block[std::size_t(m.block)][d] += m.sums[d];
  std::array<double, 3> all{};
  for (const auto& of_block : by_block)
    for (std::size_t d = 0; d < 3; ++d) all[d] += of_block[d];
  return all;
}

// ---- from rank to rank: vectors of Eigen are no plain bytes

template <class Quality>
auto extremes(Quality& q) {
  auto& g = q.general;
  return std::array{&g.min_volume,        &g.max_volume,  &g.aspect_ratio,      &g.skewness,   &g.scaled_jacobian,
                    &g.non_orthogonality, &g.stretch,     &g.volume_ratio,      &q.stretch[0], &q.stretch[1],
                    &q.stretch[2],        &q.wall_growth, &q.wall_orthogonality};
}

void put(runtime::Packer& to, const Eigen::Vector3d& v) { to.put_one(std::array{v.x(), v.y(), v.z()}); }
Eigen::Vector3d vector(runtime::Unpacker& from) {
  const auto v = from.one<std::array<double, 3>>();
  return {v[0], v[1], v[2]};
}

void put(runtime::Packer& to, const RotorGridQuality& q) {
  to.put_one(q.general.cells), to.put_one(q.general.volume), to.put_one(q.folded), to.put_one(q.skewed);
  to.put_one(q.first_cell_low), to.put_one(q.first_cell_high), to.put_one(q.interface_gap), to.put_one(q.reach);
  for (const Extreme* e : extremes(q)) {
    to.put_one(e->value), to.put_one(std::array{e->block, e->k, e->j, e->i});
    put(to, e->at);
  }
}
RotorGridQuality quality(runtime::Unpacker& from) {
  RotorGridQuality q;
  q.general.cells = from.one<long>(), q.general.volume = from.one<double>();
  q.folded = from.one<long>(), q.skewed = from.one<long>();
  q.first_cell_low = from.one<double>(), q.first_cell_high = from.one<double>();
  q.interface_gap = from.one<double>(), q.reach = from.one<double>();
  for (Extreme* e : extremes(q)) {
    e->value = from.one<double>();
    const auto place = from.one<std::array<int, 4>>();
    e->block = place[0], e->k = place[1], e->j = place[2], e->i = place[3];
    e->at = vector(from);
  }
  return q;
}

void put(runtime::Packer& to, const BladeStation& s) {
  to.put_one(std::array{s.block, s.k}), to.put_one(std::array{s.radius, s.length, s.chord, s.wetted_area});
  for (const Eigen::Vector3d* v : {&s.quarter, &s.normal, &s.tangential, &s.chordwise}) put(to, *v);
}
BladeStation station(runtime::Unpacker& from) {
  BladeStation s;
  const auto row = from.one<std::array<int, 2>>();
  const auto sizes = from.one<std::array<double, 4>>();
  s.block = row[0], s.k = row[1];
  s.radius = sizes[0], s.length = sizes[1], s.chord = sizes[2], s.wetted_area = sizes[3];
  for (Eigen::Vector3d* v : {&s.quarter, &s.normal, &s.tangential, &s.chordwise}) *v = vector(from);
  return s;
}

runtime::Bytes parcel(const Look& look) {
  runtime::Packer to;
  to.put(std::span<const char>(look.failure));
  to.put_one(look.given_up);
  put(to, look.quality);
  to.put(look.edges.layers());
  to.put(std::span<const Moments>(look.moments));
  to.put(std::span<const double>(look.radii));
  std::vector<double> corners;
  for (const WallSurface::Face& face : look.walls)
    for (const Eigen::Vector3d& corner : face) corners.insert(corners.end(), corner.begin(), corner.end());
  to.put(std::span<const double>(corners));
  to.put_one(look.stations.size());
  for (const auto& blade : look.stations) {
    to.put_one(blade.size());
    for (const BladeStation& s : blade) put(to, s);
  }
  return to.take();
}

template <class T>
void append(std::vector<T>& to, const std::vector<T>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

/// Behind what ranks before have seen.
void add(Look& all, const runtime::Bytes& bytes) {
  runtime::Unpacker from(bytes);
  const std::vector<char> failure = from.many<char>();
  if (all.failure.empty()) all.failure.assign(failure.begin(), failure.end());
  all.given_up = from.one<bool>() || all.given_up;
  merge(all.quality, quality(from));
  all.edges.append(from.many<EdgeLengths::Layer>());
  append(all.moments, from.many<Moments>());
  append(all.radii, from.many<double>());
  const std::vector<double> corners = from.many<double>();
  for (const double* c = corners.data(); c != corners.data() + corners.size();)
    for (Eigen::Vector3d& corner : all.walls.emplace_back()) corner = Eigen::Map<const Eigen::Vector3d>(c), c += 3;
  const auto blades = from.one<std::size_t>();
  all.stations.resize(std::max(all.stations.size(), blades));
  for (std::size_t b = 0; b < blades; ++b)
    for (auto rows = from.one<std::size_t>(); rows > 0; --rows) all.stations[b].push_back(station(from));
}

/// By the coordinates of their corners, so that their order does not tell who found them.
void sort(std::vector<WallSurface::Face>& faces) {
  std::ranges::sort(faces, [](const WallSurface::Face& a, const WallSurface::Face& b) {
    for (std::size_t n = 0; n < a.size(); ++n)
      if (a[n] != b[n]) return std::ranges::lexicographical_compare(a[n], b[n]);
    return false;
  });
}

void describe(MadeRotorGrid& made, const ResolvedRotorSetup& setup) {
  made.turbine = read_turbine(setup.rotor.turbine);
  made.spec = rotor_grid_spec(setup.grid, made.turbine, setup.rotor.blade_pitch, setup.rotor.speed, setup.wind.norm());
  made.maker = std::make_shared<RotorGridMaker>(made.turbine, made.spec);
  made.grid = made.maker->described();
}

std::vector<std::string> sticking_patches(const ResolvedRotorSetup& setup, const MultiBlockGrid& grid) {
  std::vector<std::string> sticking;
  for (const PatchOptions& b : with_default_patches(setup.flow, grid).boundaries)
    if (sticks(b.condition)) sticking.push_back(b.patch);
  return sticking;
}

/// Through this rank's share of the layers, some at once.
Look look_through(const MadeRotorGrid& made, const std::vector<std::string>& sticking, MPI_Comm comm, const GridProgress& told) {
  Look look;
  look.edges = EdgeLengths(made.grid);
  const long ranks = runtime::ranks_in(comm), rank = runtime::rank_in(comm);
  const int layers = made.maker->layers(), some = made.layers_at_once();
  const int begin = int(layers * rank / ranks), last = int(layers * (rank + 1) / ranks);
  for (int first = begin; first < last; first += some) {
    if (told) told("rotor grid", double(first - begin) / (last - begin));
    runtime::StopRequest::give_up_if_asked();
    const int end = std::min(last, first + some);
    const GridLayers part = made.maker->make(first, end, true);
    merge(look.quality, rotor_grid_quality(part, {"blade_"}));
    look.edges.add(part);
    add_moments(part, end == layers, look.moments);
    const std::vector<double> radii = surface_radii(part.grid.blocks[0]);
    look.radii.insert(look.radii.end(), radii.begin(), end == layers ? radii.end() : radii.begin() + (end - first));
    append(look.walls, wall_faces(part, sticking));
    add_stations(part, look.stations);
  }
  return look;
}

}  // namespace

int MadeRotorGrid::layers_at_once() const {
  // Two of eighteen surfaces are made twice, and more of grids so large that the nodes would take more than a quarter of a GB.
  constexpr long most_nodes = 10'000'000;
  long nodes = 0;  // of a layer, before every second one is left out
  for (const Block& b : grid.blocks) nodes += long(b.ni + 1) * (b.nj + 1) << 3 * spec.coarsen;
  return int(std::clamp(most_nodes / nodes - 2, 4L, 16L));
}

FlowOptions with_default_patches(FlowOptions o, const MultiBlockGrid& grid) {
  for (const Boundary& boundary : grid.boundaries) {
    const std::string& patch = boundary.patch;
    if (std::ranges::any_of(o.boundaries, [&](const PatchOptions& b) { return b.patch == patch; })) continue;
    if (patch.starts_with("blade_"))
      o.boundaries.push_back({patch, o.viscous == "none" ? Condition::slip : o.blades, true, {}});
    else
      o.boundaries.push_back({patch, patch == "hub" ? Condition::slip : Condition::far_field, false, {}});
  }
  return o;
}

Tiling rotor_tiling(const FlowOptions& flow, const MultiBlockGrid& grid, const EdgeLengths& edges) {
  std::vector<std::string> blades;
  for (const Boundary& b : grid.boundaries)
    if (b.patch.starts_with("blade_")) blades.push_back(b.patch);
  Tiling tiling = make_tiling(grid, blades, tile_limits(flow), edges);
  require_rows(tiling, "", "aero.grid", "");
  return tiling;
}

std::shared_ptr<const MadeRotorGrid> made_rotor_grid(const ResolvedRotorSetup& setup, MPI_Comm comm,
                                                     const GridProgress& told) try {
  auto made = std::make_shared<MadeRotorGrid>();
  Look mine;
  std::exception_ptr own;  // of this rank: the others must hear of it before it goes on
  try {
    describe(*made, setup);
    mine = look_through(*made, sticking_patches(setup, made->grid), comm, told);
  } catch (const runtime::StopAsked&) { mine.given_up = true; } catch (const std::exception& failure) {
    own = std::current_exception(), mine.failure = failure.what();
  }
  Look all;
  all.edges = EdgeLengths(made->grid);
  for (const runtime::Bytes& bytes : runtime::exchange_all(comm, parcel(mine))) add(all, bytes);
  if (all.given_up) throw runtime::StopAsked();
  if (own) std::rethrow_exception(own);
  if (!all.failure.empty()) throw NumericalFailure(all.failure, "aero.grid", 0, 0.0);
  made->edges = std::move(all.edges), made->radii = std::move(all.radii);
  made->walls = std::move(all.walls), made->stations = std::move(all.stations);
  made->moments = sum(all.moments, made->grid.blocks.size());
  for (const double moment : made->moments)
    if (!std::isfinite(moment)) throw NumericalFailure("grid refused: it has nodes that are not finite", "aero.grid", 0, 0.0);
  sort(made->walls);
  require_quality(made->grid, all.quality,
                  {.scaled_jacobian = setup.grid.least_scaled_jacobian, .non_orthogonality = setup.grid.most_off_orthogonal_deg});
  require_sound(made->grid, "aero.grid", {.nodes = false});
  return made;
} catch (const NumericalFailure& failure) {
  throw scene::SceneError({{setup.rotor.turbine, 0, "aero.grid", "", failure.what()}});
}

}  // namespace spindrift::aero
