// SPDX-License-Identifier: Apache-2.0
#include "kernels/rigid/closed_surface.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "kernels/base/in_words.hpp"
#include "kernels/grid/nearest_point.hpp"
#include "kernels/rigid/shapes.hpp"

namespace spindrift {

namespace {

using Eigen::Vector3d;

constexpr double weld_within = 1e-6;  ///< of the size: a float in a file has seven digits

std::string in_words(const Vector3d& x) {
  return "(" + spindrift::in_words(x[0], 6) + ", " + spindrift::in_words(x[1], 6) + ", " + spindrift::in_words(x[2], 6) + ")";
}

/// A side of a triangle, seen from its lower corner.
struct Side {
  int low, high;
  int triangle, number;  ///< number: from that corner of the triangle to the next
  bool rising;           ///< the triangle runs from low to high
  auto place() const { return std::pair(low, high); }
};

/// All sides, those between the same two points beside each other.
std::vector<Side> sides_of(std::span<const std::array<int, 3>> triangles) {
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (int n = 0; n < 3; ++n) {
      const int from = triangles[t][std::size_t(n)], to = triangles[t][std::size_t((n + 1) % 3)];
      sides.push_back({std::min(from, to), std::max(from, to), int(t), n, from < to});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tuple(a.low, a.high, a.triangle) < std::tuple(b.low, b.high, b.triangle);
  });
  return sides;
}

/// Calls visit(sides) for each run of sides between the same two points, until it returns false.
template <class Visit>
void for_edges(std::span<const Side> sides, Visit&& visit) {
  for (std::size_t first = 0, last; first < sides.size(); first = last) {
    for (last = first + 1; last < sides.size() && sides[last].place() == sides[first].place();) ++last;
    if (!visit(sides.subspan(first, last - first))) return;
  }
}

Vector3d doubled_area(const Vector3d& a, const Vector3d& b, const Vector3d& c) { return (b - a).cross(c - a); }

}  // namespace

Triangulation weld(std::span<const Facet> facets) {
  Eigen::AlignedBox3d box;
  for (const Facet& f : facets)
    for (const Vector3d& x : f) box.extend(x);
  const double within = box.isEmpty() ? 0.0 : weld_within * box.diagonal().norm();
  // Cells so small that all corners of one are one point: each joins the first of the file in its cell or near it.
  using Cell = std::array<std::int64_t, 3>;
  struct Hash {
    std::size_t operator()(const Cell& c) const {
      std::uint64_t h = 0;
      for (const std::int64_t n : c) h = (h ^ std::uint64_t(n)) * 0x9e3779b97f4a7c15u, h ^= h >> 29;
      return std::size_t(h);
    }
  };
  const double edge = within / std::sqrt(3.0);
  if (!(edge > 0.0)) return {};
  const auto cell_of = [&](const Vector3d& x) {
    Cell c;
    for (int k = 0; k < 3; ++k) c[std::size_t(k)] = std::int64_t((x[k] - box.min()[k]) / edge);
    return c;
  };
  Triangulation result;
  std::unordered_map<Cell, int, Hash> point_in;
  const auto near = [&](const Vector3d& x, const Cell& at) {
    if (const auto own = point_in.find(at); own != point_in.end()) return own->second;
    for (std::int64_t i = -2; i <= 2; ++i)
      for (std::int64_t j = -2; j <= 2; ++j)
        for (std::int64_t k = -2; k <= 2; ++k)
          if (const auto other = point_in.find({at[0] + i, at[1] + j, at[2] + k});
              other != point_in.end() && (result.points[std::size_t(other->second)] - x).norm() <= within)
            return other->second;
    return -1;
  };
  std::vector<int> number;
  number.reserve(3 * facets.size());
  for (const Facet& f : facets)
    for (const Vector3d& x : f) {
      const Cell at = cell_of(x);
      int n = near(x, at);
      if (n < 0) n = int(result.points.size()), result.points.push_back(x), point_in.emplace(at, n);
      number.push_back(n);
    }
  for (std::size_t f = 0; f < facets.size(); ++f) {
    const std::array<int, 3> t{number[3 * f], number[3 * f + 1], number[3 * f + 2]};
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    result.triangles.push_back(t), result.facets.push_back(f + 1);
  }
  return result;
}

std::optional<std::string> why_not_closed(const Triangulation& surface) {
  if (surface.triangles.empty()) return "has no triangle with an area";
  const auto facet = [&](int t) { return std::to_string(surface.facets[std::size_t(t)]); };
  std::vector<std::pair<std::array<int, 3>, int>> by_corners;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    std::array<int, 3> corners = surface.triangles[t];
    std::sort(corners.begin(), corners.end());
    by_corners.push_back({corners, int(t)});
  }
  std::sort(by_corners.begin(), by_corners.end());
  for (std::size_t n = 1; n < by_corners.size(); ++n)
    if (by_corners[n].first == by_corners[n - 1].first)
      return "has facet " + facet(by_corners[n - 1].second) + " once more as facet " + facet(by_corners[n].second) + ", at " +
             in_words(surface.points[std::size_t(by_corners[n].first[0])]);
  const std::vector<Side> sides = sides_of(surface.triangles);
  const auto place = [&](const Side& s) {
    return "from " + in_words(surface.points[std::size_t(s.low)]) + " to " + in_words(surface.points[std::size_t(s.high)]);
  };
  std::size_t open = 0;
  Side first_open{};
  std::optional<std::string> wrong;
  for_edges(sides, [&](std::span<const Side> edge) {
    if (edge.size() == 1 && open++ == 0) first_open = edge[0];
    return true;
  });
  if (open > 0)
    return "is not closed: it has " + std::to_string(open) + " open edge" + (open == 1 ? "" : "s") + ", the first " +
           place(first_open) + " at facet " + facet(first_open.triangle);
  for_edges(sides, [&](std::span<const Side> edge) {
    if (edge.size() > 2)
      wrong =
          "has an edge that " + std::to_string(edge.size()) + " facets share, " + place(edge[0]) + ": which two belong together?";
    else if (edge[0].rising == edge[1].rising)
      wrong = "has facets " + facet(edge[0].triangle) + " and " + facet(edge[1].triangle) +
              " that turn opposite ways at their edge " + place(edge[0]) + ": one of them is inside out";
    return !wrong;
  });
  return wrong;
}

ClosedSurface::ClosedSurface(Triangulation surface)
    : points_(std::move(surface.points)), triangles_(std::move(surface.triangles)), facets_(std::move(surface.facets)) {
  for (const Vector3d& x : points_) box_.extend(x);
  integrate();
  if ((was_inside_out_ = volume_ < 0.0)) {
    for (std::array<int, 3>& t : triangles_) std::swap(t[1], t[2]);
    integrate();
  }
  make_normals();
}

void ClosedSurface::integrate() {
  const Vector3d origin = box_.center();
  volume_ = 0.0;
  Vector3d first = Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();  // of x x^T about the box's centre
  for (const auto& t : triangles_) {
    const Vector3d a = points_[std::size_t(t[0])] - origin, b = points_[std::size_t(t[1])] - origin,
                   c = points_[std::size_t(t[2])] - origin, sum = a + b + c;
    const double v = a.dot(b.cross(c)) / 6.0;
    volume_ += v, first += 0.25 * v * sum;
    second += v / 20.0 * (sum * sum.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
  }
  if (volume_ == 0.0) return;
  const Vector3d from_origin = first / volume_;
  centre_ = origin + from_origin;
  second -= volume_ * from_origin * from_origin.transpose();
  inertia_ = second.trace() * Eigen::Matrix3d::Identity() - second;
}

void ClosedSurface::make_normals() {
  normals_.assign(triangles_.size(), Vector3d::Zero());
  corner_normals_.assign(points_.size(), Vector3d::Zero());
  side_normals_.assign(triangles_.size(), {});
  std::vector<int> with_area;
  for (std::size_t n = 0; n < triangles_.size(); ++n) {
    const auto& t = triangles_[n];
    const auto at = [&](int k) -> const Vector3d& { return points_[std::size_t(t[std::size_t(k % 3)])]; };
    const Vector3d area = doubled_area(at(0), at(1), at(2));
    double longest = 0.0;
    for (int k = 0; k < 3; ++k) longest = std::max(longest, (at(k + 1) - at(k)).squaredNorm());
    if (!(area.norm() > 1e-12 * longest)) continue;  // a line: its neighbours have its sides
    with_area.push_back(int(n));
    normals_[n] = area.normalized();
    for (int k = 0; k < 3; ++k) {
      const Vector3d to = at(k + 1) - at(k), back = at(k + 2) - at(k);
      corner_normals_[std::size_t(t[std::size_t(k)])] += std::atan2(to.cross(back).norm(), to.dot(back)) * normals_[n];
    }
  }
  const std::vector<Side> sides = sides_of(triangles_);
  for_edges(sides, [&](std::span<const Side> edge) {
    Vector3d sum = Vector3d::Zero();
    for (const Side& s : edge) sum += normals_[std::size_t(s.triangle)];
    for (const Side& s : edge) side_normals_[std::size_t(s.triangle)][std::size_t(s.number)] = sum;
    return true;
  });
  const auto corner = [&](int t, std::size_t k) -> const Vector3d& {
    return points_[std::size_t(triangles_[std::size_t(t)][k])];
  };
  tree_ = BoxTree(
      std::move(with_area),
      [&](int t) {
        Eigen::AlignedBox3d box;
        for (std::size_t k = 0; k < 3; ++k) box.extend(corner(t, k));
        return box;
      },
      [&](int t) -> Vector3d { return corner(t, 0) + corner(t, 1) + corner(t, 2); });
}

ClosedSurface::Nearest ClosedSurface::nearest(const Vector3d& x) const {
  double least = std::numeric_limits<double>::infinity();
  NearestOnTriangle best{Vector3d::Zero()};
  int of = 0;
  tree_.search(x, 1.0, least, [&](int n) {
    const int number = tree_.order()[std::size_t(n)];
    const auto& t = triangles_[std::size_t(number)];
    const NearestOnTriangle found =
        nearest_place_on_triangle(x, points_[std::size_t(t[0])], points_[std::size_t(t[1])], points_[std::size_t(t[2])]);
    if (const double d = (found.point - x).squaredNorm(); d < least) least = d, best = found, of = number;
  });
  const auto t = std::size_t(of);
  const Vector3d& normal = best.corner >= 0 ? corner_normals_[std::size_t(triangles_[t][std::size_t(best.corner)])]
                           : best.side >= 0 ? side_normals_[t][std::size_t(best.side)]
                                            : normals_[t];
  const double distance = std::sqrt(least);
  return {best.point, normal.dot(x - best.point) < 0.0 ? -distance : distance};
}

std::optional<Vector3d> ClosedSurface::place_of_crossing(int first, int second) const {
  const double touching = weld_within * box_.diagonal().norm();
  for (const auto& [cutting, cut] : {std::pair(first, second), std::pair(second, first)}) {
    const auto &edges = triangles_[std::size_t(cutting)], &face = triangles_[std::size_t(cut)];
    const Vector3d& normal = normals_[std::size_t(cut)];
    const auto of_face = [&](std::size_t k) -> const Vector3d& { return points_[std::size_t(face[k % 3])]; };
    for (std::size_t n = 0; n < 3; ++n) {
      const Vector3d &from = points_[std::size_t(edges[n])], &to = points_[std::size_t(edges[(n + 1) % 3])];
      const double over = normal.dot(from - of_face(0)), under = normal.dot(to - of_face(0));
      if (!(std::min(over, under) < -touching && std::max(over, under) > touching)) continue;
      const Vector3d place = from + over / (over - under) * (to - from);
      bool within = true;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vector3d side = of_face(k + 1) - of_face(k);
        within = within && normal.dot(side.cross(place - of_face(k))) > touching * side.norm();
      }
      if (within) return place;
    }
  }
  return std::nullopt;
}

std::optional<ClosedSurface::Crossing> ClosedSurface::crossing() const {
  const auto share_a_corner = [](const std::array<int, 3>& a, const std::array<int, 3>& b) {
    return std::find_first_of(a.begin(), a.end(), b.begin(), b.end()) != a.end();
  };
  std::vector<std::pair<int, int>> waiting{{0, 0}};
  while (!waiting.empty()) {
    const auto [a, b] = waiting.back();
    waiting.pop_back();
    const BoxTree::Node &p = tree_.nodes()[std::size_t(a)], &q = tree_.nodes()[std::size_t(b)];
    if (!p.box.intersects(q.box)) continue;
    if (p.left == 0 && q.left == 0) {
      for (int i = p.first; i < p.last; ++i)
        for (int j = a == b ? i + 1 : q.first; j < q.last; ++j) {
          const int first = tree_.order()[std::size_t(i)], second = tree_.order()[std::size_t(j)];
          if (share_a_corner(triangles_[std::size_t(first)], triangles_[std::size_t(second)])) continue;
          if (const auto place = place_of_crossing(first, second)) return Crossing{first, second, *place};
        }
    } else if (a == b) {
      waiting.insert(waiting.end(), {{p.left, p.left}, {p.left, p.left + 1}, {p.left + 1, p.left + 1}});
    } else if (q.left == 0 || (p.left != 0 && p.last - p.first >= q.last - q.first)) {
      waiting.insert(waiting.end(), {{p.left, b}, {p.left + 1, b}});
    } else {
      waiting.insert(waiting.end(), {{a, q.left}, {a, q.left + 1}});
    }
  }
  return std::nullopt;
}

std::optional<ClosedSurface::Misplaced> ClosedSurface::misplaced_part() const {
  std::vector<int> part(points_.size());  // of each point, the lowest of its part once `root` has been asked
  for (std::size_t n = 0; n < part.size(); ++n) part[n] = int(n);
  const auto root = [&](int n) {
    while (part[std::size_t(n)] != n) n = part[std::size_t(n)] = part[std::size_t(part[std::size_t(n)])];
    return n;
  };
  for (const auto& t : triangles_)
    for (const int p : t) {
      const int a = root(t[0]), b = root(p);
      part[std::size_t(std::max(a, b))] = std::min(a, b);
    }
  struct Part {
    std::vector<int> triangles;
    Eigen::AlignedBox3d box;
    double volume = 0.0;
  };
  std::map<int, Part> parts;
  for (std::size_t n = 0; n < triangles_.size(); ++n) {
    const auto& t = triangles_[n];
    Part& its = parts[root(t[0])];
    const Vector3d origin = points_[std::size_t(root(t[0]))];
    its.triangles.push_back(int(n));
    for (const int p : t) its.box.extend(points_[std::size_t(p)]);
    its.volume += (points_[std::size_t(t[0])] - origin)
                      .dot((points_[std::size_t(t[1])] - origin).cross(points_[std::size_t(t[2])] - origin)) /
                  6.0;
  }
  for (const auto& [number, its] : parts) {
    // How often the others enclose it: their solid angles seen from a point of it (van Oosterom & Strackee 1983).
    const Vector3d& x = points_[std::size_t(number)];
    double turns = 0.0;
    for (const auto& [other, theirs] : parts) {
      if (other == number || !theirs.box.contains(its.box)) continue;
      for (const int n : theirs.triangles) {
        const auto& t = triangles_[std::size_t(n)];
        const Vector3d a = points_[std::size_t(t[0])] - x, b = points_[std::size_t(t[1])] - x, c = points_[std::size_t(t[2])] - x;
        const double la = a.norm(), lb = b.norm(), lc = c.norm();
        turns += std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb) / (2.0 * pi);
      }
    }
    if (std::abs(turns - std::round(turns)) > 0.1) continue;  // on another part
    const double enclosed = std::round(turns);
    if (its.volume > 0.0 && enclosed > 0.0) return Misplaced{its.triangles.front(), true};
    if (its.volume < 0.0 && enclosed < 1.0) return Misplaced{its.triangles.front(), false};
  }
  return std::nullopt;
}

double Mesh::volume() const { return surface->volume(); }
double Mesh::section() const { return surface->volume() / surface->box().sizes()[1]; }

Submerged submerged(const ClosedSurface& surface, const Eigen::Matrix3d& attitude, const Vector3d& shift) {
  Submerged result;
  Eigen::Vector2d first = Eigen::Vector2d::Zero();
  Vector3d moment = Vector3d::Zero();
  // Divergence theorem over the wetted surface, which the waterplane z = 0 closes: tetrahedra from the origin have no volume
  // there.
  const auto add = [&](const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    const double v = a.dot(b.cross(c)) / 6.0, up = 0.5 * doubled_area(a, b, c)[2];
    result.volume += v, moment += 0.25 * v * (a + b + c);
    result.area -= up;
    const Eigen::Vector2d p = a.head<2>(), q = b.head<2>(), r = c.head<2>(), sum = p + q + r;
    first -= up / 3.0 * sum;
    result.area_moment -= up / 12.0 * (sum * sum.transpose() + p * p.transpose() + q * q.transpose() + r * r.transpose());
  };
  std::vector<Vector3d> points;
  // About a vertical line through the middle: moments keep their digits however far from the origin the body is.
  const Vector3d middle = attitude * surface.box().center() + shift, origin(middle[0], middle[1], 0.0);
  for (const Vector3d& x : surface.points()) points.push_back(attitude * x + shift - origin);
  for (const auto& t : surface.triangles()) {
    std::array<Vector3d, 4> under;
    std::size_t count = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d &from = points[std::size_t(t[k])], &to = points[std::size_t(t[(k + 1) % 3])];
      if (from[2] <= 0.0) under[count++] = from;
      if ((from[2] <= 0.0) == (to[2] <= 0.0)) continue;
      under[count] = from + from[2] / (from[2] - to[2]) * (to - from);
      under[count++][2] = 0.0;
    }
    for (std::size_t k = 2; k < count; ++k) add(under[0], under[k - 1], under[k]);
  }
  if (result.volume > 0.0) result.centre = moment / result.volume + origin;
  if (result.area > 0.0) {
    const Eigen::Vector2d mean = first / result.area;
    result.area_moment -= result.area * mean * mean.transpose();
    result.area_centre = mean + origin.head<2>();
  }
  return result;
}

Outline outline_of(const ClosedSurface& surface, double y) {
  const auto points = surface.points();
  const double on_it = 1e-9 * surface.box().diagonal().norm();
  std::vector<double> height;
  for (const Vector3d& x : points) height.push_back(std::abs(x[1] - y) < on_it ? 0.0 : x[1] - y);
  Outline outline;
  std::map<std::pair<int, int>, int> number;  // of the point on an edge; of a corner in the plane on the edge from it to itself
  const auto crossing = [&](int under, int over) {
    const double h = height[std::size_t(under)];
    const auto [known, is_new] =
        number.try_emplace(h == 0.0 ? std::pair(under, under) : std::pair(under, over), int(outline.points.size()));
    if (is_new) {
      const Vector3d &from = points[std::size_t(under)], &to = points[std::size_t(over)];
      outline.points.push_back(from + h / (h - height[std::size_t(over)]) * (to - from));
      outline.points.back()[1] = y;
    }
    return known->second;
  };
  for (const auto& t : surface.triangles()) {
    int up = -1, down = -1;
    for (std::size_t k = 0; k < 3; ++k) {
      const int from = t[k], to = t[(k + 1) % 3];
      const bool from_under = height[std::size_t(from)] <= 0.0, to_under = height[std::size_t(to)] <= 0.0;
      if (from_under && !to_under) up = crossing(from, to);
      if (!from_under && to_under) down = crossing(to, from);
    }
    if (up != down) outline.segments.push_back({down, up});
  }
  return outline;
}

ClosedSurface prism_of(const Outline& outline) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& x : outline.points) box.extend(x);
  const Vector3d half = 100.0 * box.diagonal().norm() * Vector3d::UnitY();
  Triangulation prism;
  for (const Vector3d& x : outline.points) prism.points.insert(prism.points.end(), {x - half, x + half});
  // Ends are fans round one point each: of a hollow one they overlap, whose areas cancel, and are too far off to be nearest.
  const int low = int(prism.points.size()), high = low + 1;
  prism.points.insert(prism.points.end(), {box.center() - half, box.center() + half});
  for (const auto& [p, q] : outline.segments)
    prism.triangles.insert(
        prism.triangles.end(),
        {{2 * p, 2 * q, 2 * q + 1}, {2 * p, 2 * q + 1, 2 * p + 1}, {2 * q, 2 * p, low}, {2 * p + 1, 2 * q + 1, high}});
  return ClosedSurface(std::move(prism));
}

std::vector<SurfacePiece> pieces_of(const ClosedSurface& surface, double size) {
  std::vector<SurfacePiece> pieces;
  for (const auto& t : surface.triangles()) {
    const Vector3d &a = surface.points()[std::size_t(t[0])], &b = surface.points()[std::size_t(t[1])],
                   &c = surface.points()[std::size_t(t[2])];
    const double longest = std::sqrt(std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}));
    const int m = std::max(1, int(std::ceil(longest / size)));
    const Vector3d u = (b - a) / m, v = (c - a) / m, area = 0.5 * u.cross(v);
    for (int i = 0; i < m; ++i)
      for (int j = 0; i + j < m; ++j) {
        pieces.push_back({a + (i + 1.0 / 3.0) * u + (j + 1.0 / 3.0) * v, area});
        if (i + j < m - 1) pieces.push_back({a + (i + 2.0 / 3.0) * u + (j + 2.0 / 3.0) * v, area});
      }
  }
  return pieces;
}

}  // namespace spindrift
