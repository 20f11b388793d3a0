// SPDX-License-Identifier: Apache-2.0
#include "src/aero/grid/wall_distance.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>

#include "kernels/grid/nearest_point.hpp"
#include "runtime/mpi/stop_request.hpp"

namespace spindrift::aero {

namespace {

Eigen::Vector3d middle(const WallSurface::Face& f) { return f[0] + 0.25 * ((f[1] - f[0]) + (f[2] - f[0]) + (f[3] - f[0])); }

/// Of two computed squared distances, one to a box (or ball) and one to a point in it, the first may be larger by rounding: only
/// what is farther by more than that is cut off, so that the least of all faces is found whatever the order of the search.
constexpr double rounding = 1e-13;

double squared_distance_to_face(const Eigen::Vector3d& p, const WallSurface::Face& f, const Eigen::Vector3d& m) {
  double least = (m - p).squaredNorm();
  for (int n = 0; n < 4; ++n) least = std::min(least, (nearest_on_triangle(p, f[n], f[(n + 1) % 4], m) - p).squaredNorm());
  return least;
}

}  // namespace

WallSurface::WallSurface(std::vector<Face> faces) {
  std::vector<int> all(faces.size());
  std::iota(all.begin(), all.end(), 0);
  tree_ = BoxTree(
      std::move(all),
      [&](int n) {
        Eigen::AlignedBox3d box;
        for (const Eigen::Vector3d& corner : faces[std::size_t(n)]) box.extend(corner);
        return box;
      },
      [&](int n) { return middle(faces[std::size_t(n)]); });
  for (const int n : tree_.order()) faces_.push_back(faces[std::size_t(n)]);
  balls_.reserve(faces_.size());
  for (const Face& f : faces_) {
    const Eigen::Vector3d m = middle(f);
    double radius = 0.0;
    for (const auto& corner : f) radius = std::max(radius, (corner - m).norm());
    balls_.push_back({m, radius});
  }
}

double WallSurface::closer(const Eigen::Vector3d& p, int face, double least) const {
  const Ball& ball = balls_[face];
  const double reach = std::sqrt(least) + ball.radius;
  if ((ball.middle - p).squaredNorm() > (1.0 + rounding) * reach * reach) return least;
  return squared_distance_to_face(p, faces_[face], ball.middle);
}

double WallSurface::distance(const Eigen::Vector3d& p, int& face) const {
  double least = squared_distance_to_face(p, faces_[face], balls_[face].middle);
  tree_.search(p, 1.0 - rounding, least, [&](int f) {
    if (const double d = closer(p, f, least); d < least) least = d, face = f;
  });
  return std::sqrt(least);
}

namespace {
void add_faces(const MultiBlockGrid& grid, const Window& w, std::vector<WallSurface::Face>& faces) {
  const Block& block = grid.blocks[w.block];
  const int d = direction_of(w.side);
  const auto [u, v] = along(w.side);
  Index at{};
  at[d] = at_end(w.side) ? block.cells()[d] : 0;
  const auto corner = [&, u = u, v = v](int du, int dv) {
    Index n = at;
    n[u] += du, n[v] += dv;
    return block.nodes[block.node(n[2], n[1], n[0])];
  };
  for (at[v] = w.low[1]; at[v] < w.high[1]; ++at[v])
    for (at[u] = w.low[0]; at[u] < w.high[0]; ++at[u]) faces.push_back({corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)});
}
bool named(const Boundary& b, std::span<const std::string> patches) {
  return std::find(patches.begin(), patches.end(), b.patch) != patches.end();
}
}  // namespace

std::vector<WallSurface::Face> wall_faces(const MultiBlockGrid& grid, std::span<const std::string> patches) {
  std::vector<WallSurface::Face> faces;
  for (const Boundary& b : grid.boundaries)
    if (named(b, patches)) add_faces(grid, b.where, faces);
  return faces;
}

std::vector<WallSurface::Face> wall_faces(const GridLayers& part, std::span<const std::string> patches) {
  std::vector<WallSurface::Face> faces;
  for (const Boundary& b : part.grid.boundaries)
    if (named(b, patches)) add_faces(part.grid, counted(part, b.where), faces);
  return faces;
}

WallSurface wall_surface(const MultiBlockGrid& grid, std::span<const std::string> patches) {
  return wall_surface(wall_faces(grid, patches), grid.connections);
}

namespace {

RigidMap inverse(const RigidMap& m) { return {m.rotation.transpose(), -(m.rotation.transpose() * m.translation)}; }
RigidMap product(const RigidMap& a, const RigidMap& b) {
  return {a.rotation * b.rotation, a.rotation * b.translation + a.translation};
}
bool contains(std::span<const RigidMap> maps, const RigidMap& m, double tolerance) {
  return std::ranges::any_of(maps, [&](const RigidMap& other) {
    return (other.rotation - m.rotation).norm() < tolerance &&
           (other.translation - m.translation).norm() < tolerance * (1 + m.translation.norm());
  });
}

/// Steps across the corners where periods meet: products of two or three different maps or their inverses. `maps` hold each map
/// and its inverse; those of files differ in the digits of single precision, and no more than three are independent.
std::vector<RigidMap> across_corners(std::span<const RigidMap> maps) {
  constexpr double same = 1e-5;
  constexpr std::size_t most = 3;
  std::vector<RigidMap> independent, steps{RigidMap{}};
  for (const RigidMap& m : maps)
    if (independent.size() < most && !contains(independent, m, same) && !contains(independent, inverse(m), same))
      independent.push_back(m);
  for (const RigidMap& m : independent)
    for (std::size_t n = 0, before = steps.size(); n < before; ++n)
      for (const RigidMap& next : {product(m, steps[n]), product(inverse(m), steps[n])})
        if (!contains(steps, next, same)) steps.push_back(next);
  std::erase_if(steps, [&](const RigidMap& m) { return contains(std::array{RigidMap{}}, m, same) || contains(maps, m, same); });
  return steps;
}

}  // namespace

WallSurface wall_surface(std::vector<WallSurface::Face> faces, std::span<const Connection> connections) {
  std::vector<RigidMap> images;
  for (const Connection& c : connections) {
    if (!c.periodic) continue;
    for (const RigidMap& m : {*c.periodic, inverse(*c.periodic)})  // the same map joins many windows
      if (!contains(images, m, 1e-9)) images.push_back(m);
  }
  const std::vector<RigidMap> corners = across_corners(images);
  images.insert(images.end(), corners.begin(), corners.end());
  const std::size_t own = faces.size();
  for (const RigidMap& m : images)
    for (std::size_t f = 0; f < own; ++f) {
      WallSurface::Face image;
      for (int n = 0; n < 4; ++n) image[n] = m.rotation * faces[f][n] + m.translation;
      faces.push_back(image);
    }
  return WallSurface(std::move(faces));
}

void fill_wall_distance(TileGeometry& g, const WallSurface& wall) {
  BoxView<double> distance = g.wall_distance();
  const BoxView<const double> centre = g.centre();
  int face = 0;
  for (int k = 0; k < g.inner_box.nk; ++k)
    for (int j = 0; j < g.inner_box.nj; ++j)
      for (int m = 0; m < g.inner_box.ni; ++m) {
        const int i = j % 2 == 0 ? m : g.inner_box.ni - 1 - m;  // to and fro: each cell next to the one before
        distance(0, k, j, i) = wall.empty() ? std::numeric_limits<double>::infinity()
                                            : wall.distance({centre(0, k, j, i), centre(1, k, j, i), centre(2, k, j, i)}, face);
      }
}

void fill_wall_distance(GridStore& store, const WallSurface& wall, const std::function<void(double)>& told) {
  const std::span<const int> owned = store.owned();
  std::size_t filled = 0;
  std::atomic<bool> stops = false;  // no exception leaves a parallel loop
#pragma omp parallel for schedule(dynamic)
  for (std::size_t t = 0; t < owned.size(); ++t) {
    if (stops || (stops = runtime::StopRequest::asked())) continue;
    fill_wall_distance(store[owned[t]], wall);
    if (!told) continue;
#pragma omp critical(wall_distance_progress)
    told(double(++filled) / double(owned.size()));
  }
  if (stops) throw runtime::StopAsked();
}

void keep_wall_distance(const GridStore& store, WallDistances& kept) {
  for (const int t : store.owned()) {
    const auto distances = store[t].wall_distance_data.span();
    kept[t].assign(distances.begin(), distances.end());
  }
}

bool take_wall_distance(GridStore& store, const WallDistances& kept) {
  if (!std::ranges::all_of(store.owned(), [&](int t) { return kept.contains(t); })) return false;
  for (const int t : store.owned()) std::ranges::copy(kept.at(t), store[t].wall_distance_data.data());
  return true;
}

}  // namespace spindrift::aero
