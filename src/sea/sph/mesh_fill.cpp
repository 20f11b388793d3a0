// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/mesh_fill.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "kernels/rigid/closed_surface.hpp"
#include "kernels/sph/kernel_wendland.hpp"
#include "src/sea/sph/point_cells.hpp"

namespace spindrift::sph {

namespace {

using Eigen::Vector3d;
template <int dim>
using Place = std::array<double, dim>;

constexpr double smoothing_over_spacing = 1.5;  // support of three spacings
constexpr int fill_turns = 100;
constexpr double shell = 4.0;         // spacings under the surface in which particles are moved
constexpr double piece = 0.4;         // spacings: pieces of the surface that push particles inwards
constexpr double least_depth = 0.25;  // spacings: no particle is nearer to the surface

/// In 2-D x and z.
template <int dim>
Place<dim> place(const Vector3d& x) {
  if constexpr (dim == 2)
    return {x[0], x[2]};
  else
    return {x[0], x[1], x[2]};
}
template <int dim>
Vector3d vector(const Place<dim>& x, double y) {
  if constexpr (dim == 2)
    return {x[0], y, x[1]};
  else
    return {x[0], x[1], x[2]};
}

/// The deepest `wanted` points of a lattice with their distances from the surface.
struct Start {
  Points points;
  std::vector<double> distance;
};
template <int dim>
Start start_on_lattice(const ClosedSurface& surface, double spacing, std::size_t wanted) {
  const Vector3d size = surface.box().sizes();
  std::array<int, 3> count;
  Vector3d origin = surface.box().center();
  for (int k = 0; k < 3; ++k) {
    count[std::size_t(k)] = dim == 2 && k == 1 ? 1 : int(std::ceil(size[k] / spacing)) + 2;
    origin[k] -= 0.5 * (count[std::size_t(k)] - 1) * spacing;
  }
  struct Candidate {
    double distance, depth;  // depth: whole millionths of a spacing, so that ties are not broken by rounding
    std::array<int, 3> index;
  };
  std::vector<Candidate> candidates;
  for_distances(surface, origin, Vector3d::Constant(spacing), count, -2.0 * shell * spacing, spacing,
                [&](const std::array<int, 3>& index, double distance) {
                  if (distance < spacing) candidates.push_back({distance, std::round(1e6 * distance / spacing), index});
                });
  if (candidates.size() > wanted) {
    std::nth_element(
        candidates.begin(), candidates.begin() + std::ptrdiff_t(wanted), candidates.end(),
        [](const Candidate& a, const Candidate& b) { return std::tie(a.depth, a.index) < std::tie(b.depth, b.index); });
    candidates.resize(wanted);
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) { return a.index < b.index; });
  Start start;
  for (const Candidate& c : candidates) {
    start.points.push_back(origin + spacing * Vector3d(c.index[0], c.index[1], c.index[2]));
    start.distance.push_back(c.distance);
  }
  return start;
}

/// Of a prism in its middle plane: areas are lengths there.
std::vector<SurfacePiece> pieces_of_outline(const ClosedSurface& prism, double size) {
  std::vector<SurfacePiece> pieces;
  const Outline outline = outline_of(prism, prism.box().center()[1]);
  for (const auto& [p, q] : outline.segments) {
    const Vector3d &from = outline.points[std::size_t(p)], way = outline.points[std::size_t(q)] - from;
    const int count = std::max(1, int(std::ceil(way.norm() / size)));
    for (int n = 0; n < count; ++n) pieces.push_back({from + (n + 0.5) / count * way, way.cross(Vector3d::UnitY()) / count});
  }
  return pieces;
}

/// Pieces of the surface no larger than a share of a spacing, small ones put together.
template <int dim>
std::vector<SurfacePiece> pushing_pieces(const ClosedSurface& surface, double size) {
  std::vector<SurfacePiece> all = dim == 2 ? pieces_of_outline(surface, size) : pieces_of(surface, size);
  const auto cell = [&](const SurfacePiece& p) {
    std::array<long, 3> c;
    for (int k = 0; k < 3; ++k) c[std::size_t(k)] = long(std::floor((p.place[k] - surface.box().min()[k]) / size));
    return c;
  };
  std::stable_sort(all.begin(), all.end(), [&](const SurfacePiece& a, const SurfacePiece& b) { return cell(a) < cell(b); });
  std::vector<SurfacePiece> merged;
  for (std::size_t first = 0, last; first < all.size(); first = last) {
    SurfacePiece sum{Vector3d::Zero(), Vector3d::Zero()};
    double weight = 0.0;
    for (last = first; last < all.size() && cell(all[last]) == cell(all[first]); ++last) {
      const double w = all[last].area.norm();
      sum.area += all[last].area, sum.place += w * all[last].place, weight += w;
    }
    if (!(weight > 0.0)) continue;
    sum.place /= weight;
    merged.push_back(sum);
  }
  return merged;
}

}  // namespace

void for_distances(const ClosedSurface& surface, const Vector3d& origin, const Vector3d& edges, const std::array<int, 3>& count,
                   double low, double high, const std::function<void(const std::array<int, 3>&, double)>& visit) {
  for (int i = 0; i < count[0]; ++i)
    for (int j = 0; j < count[1]; ++j) {
      double known = 0.0;  // the last that was computed in this row, and where
      int of = -1;
      for (int k = 0; k < count[2]; ++k) {
        const double way = of < 0 ? 1e300 : (k - of) * edges[2];
        double distance = known;  // it changes by no more than the way
        if (!(known + way < low || known - way > high))
          known = distance = surface.signed_distance(origin + edges.cwiseProduct(Vector3d(i, j, k))), of = k;
        else
          distance = known < low ? known + way : known - way;
        visit({i, j, k}, distance);
      }
    }
}

template <int dim>
Points fill_mesh(const Mesh& mesh, double spacing) {
  const ClosedSurface& surface = *mesh.surface;
  const double cell = std::pow(spacing, dim), y = surface.box().center()[1];
  const double size = dim == 2 ? mesh.section() : mesh.volume();
  Start start = start_on_lattice<dim>(surface, spacing, std::size_t(std::max(1L, std::lround(size / cell))));
  const KernelWendland<dim> kernel(smoothing_over_spacing * spacing);
  const double h = kernel.h(), support = 2.0 * h, rate = 0.4 * h * h;
  constexpr double longest = 0.1;  // spacings in one turn
  std::vector<std::size_t> moving;
  std::vector<Place<dim>> all;  // those that move, then those that they stand beside
  for (std::size_t n = 0; n < start.points.size(); ++n)
    if (start.distance[n] > -shell * spacing) moving.push_back(n), all.push_back(place<dim>(start.points[n]));
  for (std::size_t n = 0; n < start.points.size(); ++n)
    if (start.distance[n] <= -shell * spacing && start.distance[n] > -2.0 * shell * spacing)
      all.push_back(place<dim>(start.points[n]));
  const std::vector<SurfacePiece> walls = pushing_pieces<dim>(surface, piece * spacing);
  std::vector<Place<dim>> wall_places;
  for (const SurfacePiece& w : walls) wall_places.push_back(place<dim>(w.place));
  const PointCells<dim> wall_cells(wall_places, support);
  std::vector<Place<dim>> next(moving.size());
  for (int turn = 0; turn < fill_turns; ++turn) {
    const PointCells<dim> cells(all, support);
    for (std::size_t i = 0; i < moving.size(); ++i) {
      const Vector3d x = vector<dim>(all[i], y);
      Vector3d way = Vector3d::Zero();
      cells.for_near(all[i], [&](std::uint32_t j) {
        const Vector3d from = x - vector<dim>(all[j], y);
        const double r2 = from.squaredNorm();
        if (r2 < support * support && j != i) way -= rate * cell * kernel.slope(std::max(r2, 1e-30)) * from;
      });
      wall_cells.for_near(all[i], [&](std::uint32_t w) {
        const double r2 = (x - vector<dim>(wall_places[w], y)).squaredNorm();
        if (r2 < support * support) way -= rate * kernel.value(r2) * walls[w].area;
      });
      const double factor = std::min(1.0, longest * spacing / std::max(way.norm(), 1e-30));
      next[i] = place<dim>(x + factor * way);
    }
    std::copy(next.begin(), next.end(), all.begin());
  }
  for (std::size_t i = 0; i < moving.size(); ++i) {
    Vector3d x = vector<dim>(all[i], y);
    const ClosedSurface::Nearest near = surface.nearest(x);
    if (near.distance > -least_depth * spacing && near.distance != 0.0)
      x = near.point - least_depth * spacing * (x - near.point) / near.distance;
    start.points[moving[i]] = x;
  }
  for (Vector3d& x : start.points) x -= mesh.origin;
  return start.points;
}

template Points fill_mesh<2>(const Mesh& mesh, double spacing);
template Points fill_mesh<3>(const Mesh& mesh, double spacing);

}  // namespace spindrift::sph
