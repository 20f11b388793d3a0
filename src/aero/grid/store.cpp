// SPDX-License-Identifier: Apache-2.0
#include "src/aero/grid/store.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "runtime/mpi/stop_request.hpp"

namespace spindrift::aero {

namespace {

Eigen::Vector3d vector_at(BoxView<const double> view, int k, int j, int i) {
  return {view(0, k, j, i), view(1, k, j, i), view(2, k, j, i)};
}
void set_vector(BoxView<double> view, int k, int j, int i, const Eigen::Vector3d& v) {
  for (int c = 0; c < 3; ++c) view(c, k, j, i) = v[c];
}

/// Face n of direction d below cell (k, j, i), its corners so that the vector points towards growing index.
Quad face_at(BoxView<const double> x, int direction, int k, int j, int i) {
  const auto at = [&](int dk, int dj, int di) { return vector_at(x, k + dk, j + dj, i + di); };
  if (direction == 0) return {at(0, 0, 0), at(0, 1, 0), at(1, 1, 0), at(1, 0, 0)};
  if (direction == 1) return {at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1)};
  return {at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0)};
}
Hexahedron cell_at(BoxView<const double> x, int k, int j, int i) {
  Hexahedron h;
  for (int n = 0; n < 8; ++n) h.x[n] = vector_at(x, k + n / 4, j + n / 2 % 2, i + n % 2);
  return h;
}
template <class Body>
void for_box(const BoxLayout& box, Body&& body) {
  for (int k = 0; k < box.nk; ++k)
    for (int j = 0; j < box.nj; ++j)
      for (int i = 0; i < box.ni; ++i) body(k, j, i);
}
int flow_directions(bool planar) { return planar ? 2 : 3; }

}  // namespace

std::size_t TileGeometry::bytes() const {
  std::size_t sum = 0;
  const auto add = [&sum](const AlignedArray<double>& a) { sum += a.bytes(); };
  for (const auto* a : {&node_data, &volume_data, &centre_data, &wall_distance_data}) add(*a);
  for (const auto* family : {&face_data, &speed_data}) std::ranges::for_each(*family, add);
  if (!history) return sum;
  const MotionHistory& h = *history;
  for (const auto* a : {&h.reference_nodes, &h.old_nodes, &h.older_nodes, &h.oldest_nodes}) add(*a);
  for (const auto* family : {&h.swept, &h.old_swept, &h.older_swept}) std::ranges::for_each(*family, add);
  return sum;
}

std::unique_ptr<TileGeometry> empty_geometry(const Tile& tile, bool planar) {
  auto geometry = std::make_unique<TileGeometry>();
  TileGeometry& g = *geometry;
  g.node_box = BoxLayout(tile.ni + 1, tile.nj + 1, tile.nk + 1);
  g.cell_box = cell_layout(tile, cell_ghosts, planar);
  g.inner_box = cell_layout(tile, 0, planar);
  for (int d = 0; d < 3; ++d) g.face_box[d] = BoxLayout(tile.ni + (d == 0), tile.nj + (d == 1), tile.nk + (d == 2));
  g.node_data = AlignedArray<double>(g.node_box.size(3));
  g.volume_data = AlignedArray<double>(g.cell_box.size(1));
  g.centre_data = AlignedArray<double>(g.cell_box.size(3));
  g.wall_distance_data = AlignedArray<double>(g.inner_box.size(1));
  std::ranges::fill(g.volume_data.span(), 1.0);  // padding is divided by
  std::ranges::fill(g.wall_distance_data.span(), std::numeric_limits<double>::infinity());
  for (int d = 0; d < 3; ++d) g.face_data[d] = AlignedArray<double>(g.face_box[d].size(3));
  return geometry;
}

void copy_nodes(TileGeometry& g, const Tile& tile, const Block& piece, int first) {
  // Nodes lie between cells: along a direction walked backwards, node n is above cell n - 1 of the block.
  const IndexMap& map = tile.to_block;
  BoxView<double> x = g.nodes();
  for_box(g.node_box, [&](int k, int j, int i) {
    Index at = map({i, j, k});
    for (int d = 0; d < 3; ++d)
      if (map.sign(d) < 0) at[map.target(d)] += 1;
    at[2] -= first;
    if (at[2] >= 0 && at[2] <= piece.nk) set_vector(x, k, j, i, piece.nodes[piece.node(at[2], at[1], at[0])]);
  });
}

std::unique_ptr<TileGeometry> make_geometry(const MultiBlockGrid& grid, const Tile& tile, bool planar) {
  auto geometry = empty_geometry(tile, planar);
  copy_nodes(*geometry, tile, grid.blocks[tile.block]);
  update_metrics(*geometry, planar);
  return geometry;
}

void make_movable(TileGeometry& g) {
  MotionHistory& h = g.history.emplace();
  for (auto* nodes : {&h.reference_nodes, &h.old_nodes, &h.older_nodes}) *nodes = AlignedArray<double>(g.node_box.size(3));
  std::ranges::copy(g.node_data.span(), h.reference_nodes.data());
  std::ranges::copy(g.node_data.span(), h.old_nodes.data());
  for (int d = 0; d < 3; ++d)
    for (auto* family : {&h.swept, &h.old_swept, &g.speed_data}) (*family)[d] = AlignedArray<double>(g.face_box[d].size(1));
  begin_step(g);
  begin_step(g);
}

void keep_third_step(TileGeometry& g) {
  MotionHistory& h = *g.history;
  h.oldest_nodes = AlignedArray<double>(g.node_box.size(3));
  std::ranges::copy(g.node_data.span(), h.oldest_nodes.data());
  for (int d = 0; d < 3; ++d) h.older_swept[d] = AlignedArray<double>(g.face_box[d].size(1));
}

double extent_along(const TileGeometry& g, const Eigen::Vector3d& normal, int k, int j, int i) {
  double area = 0.0;
  for (int d = 0; d < 3; ++d) {
    const BoxLayout& box = g.face_box[std::size_t(d)];
    const double* face = g.face_data[std::size_t(d)].data() + box.at(k, j, i);
    double both = 0.0;  // faces below and above
    for (int c = 0; c < 3; ++c) both += normal[c] * (face[c * box.component] + face[c * box.component + box.stride(d)]);
    area += 0.5 * std::abs(both);
  }
  return g.volume_data.data()[g.cell_box.at(k, j, i)] / area;
}

void update_metrics(TileGeometry& g, bool planar) {
  const BoxView<const double> x = g.nodes();
  for (int d = 0; d < flow_directions(planar); ++d) {
    BoxView<double> s = g.face(d);
    for_box(g.face_box[d], [&](int k, int j, int i) { set_vector(s, k, j, i, face_vector(face_at(x, d, k, j, i))); });
  }
  BoxView<double> volume = g.volume(), centre = g.centre();
  for_box(g.inner_box, [&](int k, int j, int i) {
    const Hexahedron h = cell_at(x, k, j, i);
    volume(0, k, j, i) = hexahedron_volume(h);
    set_vector(centre, k, j, i, cell_centre(h));
  });
}

void fill_boundary_geometry(TileGeometry& g, std::span<const TileBoundary> boundaries) {
  const BoxView<const double> x = g.nodes();
  BoxView<double> volume = g.volume(), centre = g.centre();
  for (const TileBoundary& b : boundaries) {
    const int d = direction_of(b.side);
    const auto [first, second] = along(b.side);
    const Index cells{g.inner_box.ni, g.inner_box.nj, g.inner_box.nk};
    for (int v = b.low[1]; v < b.high[1]; ++v)
      for (int u = b.low[0]; u < b.high[0]; ++u) {
        Index inside{};
        inside[first] = u, inside[second] = v, inside[d] = at_end(b.side) ? cells[d] - 1 : 0;
        Index ghost = inside, face = inside;
        ghost[d] += at_end(b.side) ? 1 : -1;
        face[d] += at_end(b.side) ? 1 : 0;
        const Quad q = face_at(x, d, face[2], face[1], face[0]);
        const Eigen::Vector3d normal = face_vector(q).normalized();
        const Eigen::Vector3d c = vector_at(centre, inside[2], inside[1], inside[0]);
        const Eigen::Vector3d middle = q.a + 0.25 * ((q.b - q.a) + (q.c - q.a) + (q.d - q.a));
        set_vector(centre, ghost[2], ghost[1], ghost[0], c + 2.0 * (middle - c).dot(normal) * normal);
        volume(0, ghost[2], ghost[1], ghost[0]) = volume(0, inside[2], inside[1], inside[0]);
        ghost[d] += at_end(b.side) ? 1 : -1;
        if (cells[d] > 1) inside[d] += at_end(b.side) ? -1 : 1;
        volume(0, ghost[2], ghost[1], ghost[0]) = volume(0, inside[2], inside[1], inside[0]);
      }
  }
}

void begin_step(TileGeometry& g) {
  MotionHistory& h = *g.history;
  if (h.third_order()) std::swap(h.older_nodes, h.oldest_nodes), std::swap(h.old_swept, h.older_swept);
  std::swap(h.old_nodes, h.older_nodes);
  std::ranges::copy(g.node_data.span(), h.old_nodes.data());
  std::swap(h.swept, h.old_swept);
}

void move_nodes(TileGeometry& g, const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& position) {
  const BoxView<const double> reference{g.history->reference_nodes.data(), g.node_box};
  BoxView<double> x = g.nodes();
  for_box(g.node_box, [&](int k, int j, int i) { set_vector(x, k, j, i, position(vector_at(reference, k, j, i))); });
}

namespace {
/// Nodes to where the map takes these.
void carry_nodes(TileGeometry& g, const double* nodes, const RigidMap& map) {
  const BoxView<const double> from{nodes, g.node_box};
  BoxView<double> x = g.nodes();
  for_box(g.node_box, [&](int k, int j, int i) {
    const Eigen::Vector3d moved = map.rotation * vector_at(from, k, j, i) + map.translation;
    set_vector(x, k, j, i, moved);
  });
}
}  // namespace

void move_rigidly(TileGeometry& g, const RigidMap& map) { carry_nodes(g, g.history->reference_nodes.data(), map); }

void update_sweeps(TileGeometry& g, bool planar) {
  const BoxView<const double> now = g.nodes(), old{g.history->old_nodes.data(), g.node_box};
  for (int d = 0; d < flow_directions(planar); ++d) {
    BoxView<double> swept{g.history->swept[d].data(), g.face_box[d]};
    for_box(g.face_box[d],
            [&](int k, int j, int i) { swept(0, k, j, i) = swept_volume(face_at(old, d, k, j, i), face_at(now, d, k, j, i)); });
  }
}

void update_speeds(TileGeometry& g, TimeWeights weights, double dt, bool planar) {
  for (int d = 0; d < flow_directions(planar); ++d) {
    BoxView<double> speed = g.speed(d);
    const BoxView<const double> swept{g.history->swept[d].data(), g.face_box[d]},
        old{g.history->old_swept[d].data(), g.face_box[d]};
    if (g.history->third_order()) {
      const BoxView<const double> older{g.history->older_swept[d].data(), g.face_box[d]};
      for_box(g.face_box[d], [&](int k, int j, int i) {
        speed(0, k, j, i) = swept_rate(weights, swept(0, k, j, i), old(0, k, j, i), older(0, k, j, i), dt);
      });
      continue;
    }
    for_box(g.face_box[d],
            [&](int k, int j, int i) { speed(0, k, j, i) = swept_rate(weights, swept(0, k, j, i), old(0, k, j, i), dt); });
  }
}

Eigen::Vector3d node_velocity(const TileGeometry& g, TimeWeights w, double dt, int k, int j, int i) {
  const MotionHistory& h = *g.history;
  Eigen::Vector3d v;
  for (int c = 0; c < 3; ++c) {
    const std::ptrdiff_t at = c * g.node_box.component + g.node_box.at(k, j, i);
    const double now = g.node_data.data()[at], old = h.old_nodes.data()[at];
    // With differences, not positions: digits of small steps far from the origin.
    if (h.third_order())
      v[c] = swept_rate(w, now - old, old - h.older_nodes.data()[at], h.older_nodes.data()[at] - h.oldest_nodes.data()[at], dt);
    else
      v[c] = (w.now * (now - old) - w.older * (old - h.older_nodes.data()[at])) / dt;
  }
  return v;
}

namespace {
/// Integral of (omega x r) . n over a bilinear face: 2 x 2 Gauss points are exact, the integrand is quadratic in each coordinate.
double turned_volume(const Quad& f, const Eigen::Vector3d& omega, const Eigen::Vector3d& centre) {
  const Eigen::Vector3d q = f.b - f.a, r = f.d - f.a, s = (f.a - f.b) + (f.c - f.d);
  const double low = 0.5 - 0.5 / std::sqrt(3.0);
  double sum = 0.0;
  for (const double u : {low, 1.0 - low})
    for (const double v : {low, 1.0 - low}) {
      const Eigen::Vector3d x = (f.a - centre) + u * q + v * r + u * v * s;
      sum += 0.25 * omega.cross(x).dot((q + v * s).cross(r + u * s));
    }
  return sum;
}
}  // namespace

void turn_frame(TileGeometry& g, const Eigen::Vector3d& omega, const Eigen::Vector3d& centre, bool planar) {
  const BoxView<const double> x = g.nodes();
  g.rate = {-omega.cross(centre), omega};
  for (int d = 0; d < 3; ++d)
    if (g.speed_data[d].size() == 0) g.speed_data[d] = AlignedArray<double>(g.face_box[d].size(1));
  for (int d = 0; d < flow_directions(planar); ++d) {
    BoxView<double> speed = g.speed(d);
    for_box(g.face_box[d],
            [&](int k, int j, int i) { speed(0, k, j, i) = turned_volume(face_at(x, d, k, j, i), omega, centre); });
  }
}

GridStore::GridStore(Tiling tiling, std::vector<int> rank_of_tile, int rank)
    : tiling_(std::move(tiling)),
      rank_of_tile_(std::move(rank_of_tile)),
      rank_(rank),
      plan_(link_plan(tiling_, rank_of_tile_, rank)) {
  geometry_.resize(tiling_.size());
  for (int t = 0; t < tiling_.size(); ++t)
    if (owns(t)) owned_.push_back(t);
}

void GridStore::build(int tile, const MultiBlockGrid& grid, bool moving) {
  geometry_[tile] = make_geometry(grid, tiling_.tiles[tile], tiling_.planar);
  if (moving) make_movable(*geometry_[tile]);
}

void GridStore::build_all(const MultiBlockGrid& grid, bool moving) {
  for (const int t : owned_) {
    runtime::StopRequest::give_up_if_asked();
    build(t, grid, moving);
  }
  fill_local_geometry();
}

void GridStore::begin_parts() {
  for (const int t : owned_) geometry_[t] = empty_geometry(tiling_.tiles[t], tiling_.planar);
}

void GridStore::take(const GridLayers& part) {
  for (const int t : owned_) {
    const Tile& tile = tiling_.tiles[t];
    const Block& piece = part.grid.blocks[tile.block];
    const Box box = block_box(tiling_, t);
    const int first = part.first[tile.block];
    if (piece.nk > 0 && box.low[2] <= first + piece.nk && first <= box.high[2]) copy_nodes(*geometry_[t], tile, piece, first);
  }
}

void GridStore::end_parts(bool moving) {
#pragma omp parallel for schedule(dynamic)
  for (const int t : owned_) {
    update_metrics(*geometry_[t], tiling_.planar);
    if (moving) make_movable(*geometry_[t]);
  }
  fill_local_geometry();
}

void GridStore::carry(const RigidMap& map) {
#pragma omp parallel for schedule(dynamic)
  for (const int t : owned_) {
    carry_nodes(*geometry_[t], geometry_[t]->node_data.data(), map);
    update_metrics(*geometry_[t], tiling_.planar);
  }
  fill_local_geometry();
}

void GridStore::fill_local_geometry(std::span<const RigidMap> periodic) {
  for (const int t : owned_) fill_boundary_geometry(*geometry_[t], tiling_.boundary(t));
  for (const int l : plan_.local) {
    const GhostLink& link = tiling_.links[l];
    TileGeometry &from = *geometry_[link.from], &to = *geometry_[link.to];
    copy_ghosts<double>(link, periodic, centre_quantities, cell_ghosts, from.centre(), to.centre());
    copy_ghosts<double>(link, periodic, volume_quantities, cell_ghosts, from.volume(), to.volume());
  }
}

std::size_t GridStore::bytes() const {
  std::size_t sum = 0;
  for (const auto& g : geometry_) sum += g ? g->bytes() : 0;
  return sum;
}

namespace {
template <class Body>
void for_cells(const Tiling& tiling, int tile, Body&& body) {
  const Tile& t = tiling.tiles[tile];
  const Index n = tiling.block_cells[t.block];
  for (int k = 0; k < t.nk; ++k)
    for (int j = 0; j < t.nj; ++j)
      for (int i = 0; i < t.ni; ++i) {
        const Index at = t.to_block({i, j, k});
        body((std::size_t(at[2]) * n[1] + at[1]) * n[0] + at[0], k, j, i);
      }
}
}  // namespace

void gather_cells(const Tiling& tiling, int tile, BoxView<const double> values, int component, std::span<double> block_values) {
  for_cells(tiling, tile, [&](std::size_t at, int k, int j, int i) { block_values[at] = values(component, k, j, i); });
}
void scatter_cells(const Tiling& tiling, int tile, std::span<const double> block_values, int component, BoxView<double> values) {
  for_cells(tiling, tile, [&](std::size_t at, int k, int j, int i) { values(component, k, j, i) = block_values[at]; });
}
void copy_points(const TileGeometry& g, std::span<double> points) {
  std::size_t at = 0;
  const BoxView<const double> x = g.nodes();
  for_box(g.node_box, [&](int k, int j, int i) {
    for (int c = 0; c < 3; ++c) points[at++] = x(c, k, j, i);
  });
}
void copy_cells(BoxView<const double> values, int first, int count, std::span<double> cells) {
  std::size_t at = 0;
  for_box(values.layout, [&](int k, int j, int i) {
    for (int c = first; c < first + count; ++c) cells[at++] = values(c, k, j, i);
  });
}
Box block_box(const Tiling& tiling, int tile) { return image(tiling.tiles[tile].to_block, tiling.tiles[tile].box()); }

}  // namespace spindrift::aero
