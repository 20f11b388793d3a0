// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/tank_count.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/rigid/closed_surface.hpp"
#include "src/sea/sph/store.hpp"
#include "src/sea/sph/tank_lattice.hpp"

namespace spindrift::sph {

namespace {

constexpr double far = 1e300;

template <int dim>
class Counting {
 public:
  Counting(const TankPlan& plan, const Parameters& p) : plan_(plan), p_(p), lattice_(plan, p.spacing), layers_(wall_layers(p)) {}

  TankCount count() const {
    TankCount result;
    result.mass_factor = lattice_.cell() / std::pow(p_.spacing, dim) * mean_density_ratio(plan_, p_);
    count_columns(result);
    count_surfaces(result);
    for (const TankPlan::Body& body : plan_.bodies) count_body(body, result);
    result.water = std::max(0.0, result.water);
    return result;
  }
  double places_of(const TankPlan::Block& block) const {
    double all = 0.0;
    for (int i = 0; i < lattice_.count[0]; ++i) {
      const double x = lattice_.at(0, i);
      all += in_block(block, x, plan_.bed_at(x));
    }
    return all;
  }
  bool holds_wall(const TankPlan::Block& box) const {
    std::array<std::vector<double>, 3> along;  // places in the box, as far as walls may be
    if (dim == 2) along[1] = {0.0};
    for (int k = 0; k < dim; ++k) {
      const int axis = dim == 2 && k == 1 ? 2 : k, layers = axis == 2 || walled(std::size_t(k)) ? layers_ : 0;
      for (int n = -layers; n < lattice_.count[k] + layers; ++n)
        if (const double x = lattice_.at(k, n); x >= box.low[axis] && x <= box.high[axis] && (axis != 2 || x < top()))
          along[std::size_t(axis)].push_back(x);
    }
    for (const double x : along[0])
      for (const double y : along[1])
        for (const double z : along[2])
          if (is_wall_particle({x, y, z})) return true;
    return false;
  }
  double places() const {
    double all = 1.0;
    for (int k = 0; k < dim; ++k) all *= double(lattice_.count[k]) + (k == 1 && plan_.mirrored ? 1.0 : 2.0) * layers_;
    return all;
  }

 private:
  bool walled(std::size_t axis) const { return !plan_.periodic[axis] && !plan_.open[axis]; }
  /// Places along an axis between two coordinates, those beyond the tank too.
  double places(int axis, double low, double high) const {
    const double corner = lattice_.corner[axis], edge = lattice_.edge[axis];
    return std::max(0.0, std::ceil((high - corner) / edge - 0.5) - std::ceil((low - corner) / edge - 0.5));
  }
  /// The same inside the tank across, which in 2-D is one place deep.
  double places_across(double low, double high) const {
    if constexpr (dim == 2)
      return 1.0;
    else
      return places(1, std::max(low, plan_.y[0]), std::min(high, plan_.y[1]));
  }
  double places_up(double low, double high) const { return places(dim - 1, low, std::min(high, top())); }
  double top() const { return -plan_.depth + lattice_.count[dim - 1] * lattice_.edge[dim - 1]; }

  /// Of a block in the column at x, over the bed: all of it, or what is deeper in it than `inset`.
  double in_block(const TankPlan::Block& block, double x, double bed, double inset = 0.0) const {
    if (!(x > block.low[0] + inset && x < block.high[0] - inset)) return 0.0;
    return places_across(block.low[1] + inset, block.high[1] - inset) *
           places_up(std::max(bed, block.low[2] + inset), block.high[2] - inset);
  }
  static TankPlan::Block common(const TankPlan::Block& a, const TankPlan::Block& b) {
    return {a.low.cwiseMax(b.low), a.high.cwiseMin(b.high)};
  }

  /// Rows of columns along x: what stands in one is known from its bed.
  void count_columns(TankCount& result) const {
    const int behind = plan_.paddle ? layers_ + int(std::ceil(plan_.paddle_reach / lattice_.edge[0])) + 1 : layers_;
    const int low = walled(0) ? -behind : 0, high = lattice_.count[0] + (walled(0) ? layers_ : 0);
    const double inside = places_across(-far, far), beside = dim == 3 && walled(1) ? (plan_.mirrored ? 1.0 : 2.0) * layers_ : 0.0;
    const double deep = layers_ * p_.spacing;
    std::vector<TankPlan::Block> water = plan_.water;
    if (water.empty()) water.push_back({Eigen::Vector3d::Constant(-far), {far, far, 0.0}});
    std::vector<double> beds;
    for (int i = low - layers_; i < high + layers_; ++i) beds.push_back(plan_.bed_at(lattice_.at(0, i)));
    for (int i = low; i < high; ++i) {
      const double x = lattice_.at(0, i);
      const auto here = beds.begin() + (i - low) + layers_;
      const double bed = *here, lowest = *std::min_element(here - layers_, here + layers_ + 1),
                   under = lowest - layers_ * lattice_.edge[dim - 1];
      const bool in_tank = i >= 0 && i < lattice_.count[0];
      if (walled(0) && (i >= lattice_.count[0] || (i < 0 && !plan_.paddle))) {
        result.walls += (inside + beside) * places_up(under, far);
        continue;
      }
      result.walls += (inside + beside) * places_up(under, bed) + beside * places_up(bed, far);
      if (!in_tank) continue;
      for (const TankPlan::Block& block : water) {
        result.water += in_block(block, x, bed);
        for (const TankPlan::Block& obstacle : plan_.obstacles) result.water -= in_block(common(block, obstacle), x, bed);
      }
      for (const TankPlan::Block& obstacle : plan_.obstacles)
        result.walls += in_block(obstacle, x, bed) - in_block(obstacle, x, bed, deep);
    }
    if (plan_.paddle) result.walls += layers_ * inside * places_up(plan_.bed_at(plan_.x[0]), far);
  }

  bool is_water(const Eigen::Vector3d& x) const {
    if (x[0] < plan_.x[0] || x[0] > plan_.x[1] || x[2] < plan_.bed_at(x[0])) return false;
    if (dim == 3 && (x[1] < plan_.y[0] || x[1] > plan_.y[1])) return false;
    const auto holds = [&](const TankPlan::Block& block) { return inside<dim>(block, x); };
    if (std::any_of(plan_.obstacles.begin(), plan_.obstacles.end(), holds)) return false;
    return plan_.water.empty() ? x[2] < 0.0 : std::any_of(plan_.water.begin(), plan_.water.end(), holds);
  }
  bool is_wall(const Eigen::Vector3d& x, const TankPlan::Walls& walls) const {
    return (walls.surface->signed_distance(x) > 0.0) == walls.water_inside;
  }

  /// Of the sides, the bed, obstacles and surfaces, as deep as water feels it.
  bool is_wall_particle(const Eigen::Vector3d& x) const {
    const double deep = layers_ * p_.spacing;
    for (int k = 0; k < dim - 1; ++k) {
      const std::array<double, 2>& sides = k == 0 ? plan_.x : plan_.y;
      const bool open_below = k == 0 ? plan_.paddle.has_value() : plan_.mirrored;
      if (x[k] > sides[1] || (x[k] < sides[0] && !open_below)) return true;
      if (x[k] < sides[0]) return false;
    }
    double lowest = plan_.bed_at(x[0]);
    for (const double beside : {-deep, deep}) lowest = std::min(lowest, plan_.bed_at(x[0] + beside));
    if (x[2] < plan_.bed_at(x[0]) && x[2] >= lowest - deep) return true;
    const auto shell = [&](const TankPlan::Block& block) {
      double depth = 1e300;
      for (int k = 0; k < 3; ++k)
        if (dim == 3 || k != 1) depth = std::min({depth, x[k] - block.low[k], block.high[k] - x[k]});
      return depth > 0.0 && depth <= deep;
    };
    return std::ranges::any_of(plan_.obstacles, shell) || std::ranges::any_of(plan_.walls, [&](const TankPlan::Walls& walls) {
             const double distance = walls.surface->signed_distance(x), depth = walls.water_inside ? distance : -distance;
             return depth > 0.0 && depth <= deep;
           });
  }

  /// Water that surfaces take, from samples; their walls from their area in the tank.
  void count_surfaces(TankCount& result) const {
    if (plan_.walls.empty()) return;
    constexpr int along = dim == 2 ? 200 : 40;
    const Eigen::Vector3d low(plan_.x[0], dim == 2 ? 0.0 : plan_.y[0], -plan_.depth),
        high(plan_.x[1], dim == 2 ? 0.0 : plan_.y[1], top());
    double water = 0.0, kept = 0.0;
    for (int i = 0; i < along; ++i)
      for (int j = 0; j < (dim == 2 ? 1 : along); ++j)
        for (int k = 0; k < along; ++k) {
          const Eigen::Vector3d x = low + (high - low).cwiseProduct(Eigen::Vector3d(i + 0.5, j + 0.5, k + 0.5) / along);
          if (!is_water(x)) continue;
          ++water;
          kept += std::none_of(plan_.walls.begin(), plan_.walls.end(), [&](const auto& walls) { return is_wall(x, walls); });
        }
    if (water > 0.0) result.water *= kept / water;
    const auto in_tank = [&](const Eigen::Vector3d& x) {
      return x[0] > plan_.x[0] && x[0] < plan_.x[1] && x[2] > -plan_.depth && x[2] < top() &&
             (dim == 2 || (x[1] > plan_.y[0] && x[1] < plan_.y[1]));
    };
    for (const TankPlan::Walls& walls : plan_.walls) {
      double area = 0.0;
      const double size = (high - low).maxCoeff() / 50.0;
      if constexpr (dim == 2) {
        const Outline outline = outline_of(*walls.surface, 0.0);
        constexpr int pieces = 50;
        for (const auto& [from, to] : outline.segments) {
          const Eigen::Vector3d &a = outline.points[std::size_t(from)], &b = outline.points[std::size_t(to)];
          for (int n = 0; n < pieces; ++n)
            if (in_tank(a + (n + 0.5) / pieces * (b - a))) area += (b - a).norm() / pieces;
        }
      } else {
        for (const SurfacePiece& piece : pieces_of(*walls.surface, size))
          if (in_tank(piece.place)) area += piece.area.norm();
      }
      result.walls += area * layers_ * p_.spacing / lattice_.cell();
    }
  }

  /// As many particles as stand for its volume, and no water where they are.
  void count_body(const TankPlan::Body& body, TankCount& result) const {
    const Cut cut = cut_of(dim == 2, plan_.mirrored);
    constexpr double points = 600.0;
    double volume = 0.0;
    for (const BodyShape& shape : body.shapes) volume += volume_of(shape, cut);
    const double spacing = std::max(std::pow(volume / points, 1.0 / dim), std::pow(lattice_.cell(), 1.0 / dim));
    TankCount::Body counted{.particles = 0.0, .points = fill_body(body.shapes, spacing, cut), .cell = std::pow(spacing, dim)};
    double wet = 0.0;
    for (const Eigen::Vector3d& point : counted.points) wet += is_water(body.motion.point(point));
    counted.particles = double(counted.points.size()) * counted.cell / lattice_.cell();
    result.water -= wet * counted.cell / lattice_.cell();
    result.bodies.push_back(std::move(counted));
  }

  const TankPlan& plan_;
  const Parameters& p_;
  TankLattice<dim> lattice_;
  int layers_;
};

}  // namespace

template <int dim>
TankCount count_tank(const TankPlan& plan, const Parameters& p) {
  return Counting<dim>(plan, p).count();
}
template TankCount count_tank<2>(const TankPlan&, const Parameters&);
template TankCount count_tank<3>(const TankPlan&, const Parameters&);

template <int dim>
double lattice_places(const TankPlan& plan, const Parameters& p) {
  return Counting<dim>(plan, p).places();
}
template double lattice_places<2>(const TankPlan&, const Parameters&);
template double lattice_places<3>(const TankPlan&, const Parameters&);

template <int dim>
double places_in(const TankPlan& plan, const Parameters& p, const TankPlan::Block& block) {
  return Counting<dim>(plan, p).places_of(block);
}
template double places_in<2>(const TankPlan&, const Parameters&, const TankPlan::Block&);
template double places_in<3>(const TankPlan&, const Parameters&, const TankPlan::Block&);

template <int dim>
bool holds_wall(const TankPlan& plan, const Parameters& p, const TankPlan::Block& box) {
  return Counting<dim>(plan, p).holds_wall(box);
}
template bool holds_wall<2>(const TankPlan&, const Parameters&, const TankPlan::Block&);
template bool holds_wall<3>(const TankPlan&, const Parameters&, const TankPlan::Block&);

}  // namespace spindrift::sph
