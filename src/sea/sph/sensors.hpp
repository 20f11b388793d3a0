// Sensors: patches of a wall or of a body's surface over which the water's pressure and force are averaged, in space and in time.
// Pressure: the mean over points of the surface of what a probe reads there (gauges.hpp), zero where a point is dry. Force: of
// the water on the patch's particles, from the pair sweep, so that patches which share out a body add up to its load. Groups add
// to sums that are reduced in their order: the same bits for any number of threads and ranks. A patch is read at the last
// evaluation of each step, its middle (Verlet's: its begin). Called by tasks.cpp and particle_sea.cpp; tested in
// tests/src/sea/sph/sensors_test.cpp and tests/coupled/particle_sea_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <deque>
#include <span>
#include <vector>

#include "kernels/sph/kernel_wendland.hpp"
#include "src/sea/sph/body_shapes.hpp"
#include "src/sea/sph/gauges.hpp"
#include "src/sea/sph/solids.hpp"
#include "src/sea/sph/tank.hpp"

namespace spindrift::sph {

struct Patch {
  std::uint16_t owner = 0;    ///< of the particles that the force is counted on
  Eigen::Vector3d low, high;  ///< the box they are in: body axes from the centre of mass, of walls the earth's [m]
  Points points;              ///< of the surface, likewise
  std::vector<char> counted;  ///< of solids: whether the force on a particle counts, by its identity from the solid's first on
  double mean_over = 0.0;     ///< [s]
};

/// Of the box with its faces; in a 2-D scene whatever the y.
inline bool in_box(const Eigen::Vector3d& x, const Eigen::Vector3d& low, const Eigen::Vector3d& high, bool planar) {
  for (int k = 0; k < 3; ++k)
    if (!(planar && k == 1) && (x[k] < low[k] || x[k] > high[k])) return false;
  return true;
}
/// Points a spacing apart or less, of the rectangle that a box without extent along one axis is.
Points points_of_rectangle(const Eigen::Vector3d& low, const Eigen::Vector3d& high, double spacing, Cut cut);
/// The box of the particles of the wall that such a rectangle is on: as deep on either side of it as water feels them.
TankPlan::Block particles_of_rectangle(const Eigen::Vector3d& low, const Eigen::Vector3d& high, double reach);
/// Points of the surface of a union of shapes inside a box, under its outermost particles; body axes.
Points points_of_surface(const Points& particles, std::span<const BodyShape> shapes, const Eigen::Vector3d& low,
                         const Eigen::Vector3d& high, double spacing, Cut cut);
/// The patch of a body's surface inside a box of body axes. Particles count by the point of the surface nearest to them: water
/// presses on several rows of particles, and a thin box along the surface holds one of them or none.
Patch patch_of_body(const Solid& solid, std::span<const BodyShape> shapes, const Eigen::Vector3d& low,
                    const Eigen::Vector3d& high, const Parameters& p, Cut cut);
/// A patch of the wall goes with the paddle that stands there, whose centre is at `origin`.
void put_on_paddle(Patch& patch, const Solid& paddle, const Eigen::Vector3d& origin, Cut cut);

/// What a patch reads.
struct PatchReading {
  double pressure = 0.0;                            ///< [Pa]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< earth axes [N], in 2-D per metre of width
};

/// The readings of a patch over the last while.
class PatchRecord {
 public:
  explicit PatchRecord(double mean_over = 0.0) : mean_over_(mean_over) {}
  /// Readings that held for dt [s]; what is from before the mean's interval is dropped.
  void add(double dt, const PatchReading& reading) {
    steps_.push_back({dt, reading});
    for (double kept = lasted(); kept - steps_.front().dt >= mean_over_ && steps_.size() > 1; steps_.pop_front())
      kept -= steps_.front().dt;
  }
  /// Mean over the last mean_over seconds, or over what there is of them.
  PatchReading mean() const {
    PatchReading mean;
    double left = mean_over_, weight = 0.0;
    for (auto step = steps_.rbegin(); step != steps_.rend() && left > 0.0; ++step) {
      const double share = std::min(step->dt, left);
      mean.pressure += share * step->reading.pressure, mean.force += share * step->reading.force;
      weight += share, left -= share;
    }
    if (!(weight > 0.0)) return steps_.empty() ? PatchReading() : steps_.back().reading;
    mean.pressure /= weight, mean.force /= weight;
    return mean;
  }
  bool empty() const { return steps_.empty(); }
  static constexpr std::size_t numbers = 5;  ///< of a step, when packed
  void pack(std::vector<double>& into) const {
    into.push_back(double(steps_.size()));
    for (const Step& s : steps_)
      into.insert(into.end(), {s.dt, s.reading.pressure, s.reading.force[0], s.reading.force[1], s.reading.force[2]});
  }
  void unpack(std::span<const double> steps) {
    steps_.clear();
    for (std::size_t n = 0; n + numbers <= steps.size(); n += numbers)
      steps_.push_back({steps[n], {steps[n + 1], {steps[n + 2], steps[n + 3], steps[n + 4]}}});
  }

 private:
  struct Step {
    double dt;
    PatchReading reading;
  };
  double lasted() const {
    double sum = 0.0;
    for (const Step& s : steps_) sum += s.dt;
    return sum;
  }
  double mean_over_;
  std::deque<Step> steps_;
};

/// Sums of a patch: weight, weighted pressure and weight of the water over each point, then the force.
inline std::size_t sums_of(const Patch& patch) { return 3 * patch.points.size() + 3; }

/// The body a patch is on; null on walls.
inline const Solid* body_of(const Patch& patch, const std::vector<Solid>& solids) {
  for (const Solid& solid : solids)
    if (solid.owner == patch.owner) return &solid;
  return nullptr;
}
inline Eigen::Vector3d now(const Solid* body, const Eigen::Vector3d& local) { return body ? body->motion.point(local) : local; }

/// Columns that may hold water within reach of a patch, or its particles, as it is now.
template <int dim>
std::vector<int> groups_near(const Patch& patch, const std::vector<Solid>& solids, const Columns<dim>& columns, double reach) {
  const Solid* const body = body_of(patch, solids);
  std::array<double, dim> low, high;
  low.fill(1e300), high.fill(-1e300);
  const auto take = [&](const Eigen::Vector3d& local) {
    const auto x = from_earth<dim>(now(body, local));
    for (int k = 0; k < dim; ++k) low[k] = std::min(low[k], x[k] - reach), high[k] = std::max(high[k], x[k] + reach);
  };
  for (const Eigen::Vector3d& point : patch.points) take(point);
  for (int corner = 0; corner < 8; ++corner)
    take({(corner & 1 ? patch.high : patch.low)[0], (corner & 2 ? patch.high : patch.low)[1],
          (corner & 4 ? patch.high : patch.low)[2]});
  std::vector<int> groups;
  columns.for_overlapping(low, high, [&](const Neighbour<dim>& near) { groups.push_back(near.group); });
  std::sort(groups.begin(), groups.end());
  groups.erase(std::unique(groups.begin(), groups.end()), groups.end());
  return groups;
}

/// Writes what one group adds to the sums of a patch, from the planes and sums of the last evaluation.
template <int dim, class Real>
void read_patch(const Store<dim, Real>& store, const Parameters& p, const Domain<dim>& domain, const Patch& patch,
                const std::vector<Solid>& solids, int group, std::span<double> sums) {
  std::fill(sums.begin(), sums.end(), 0.0);
  const Solid* const body = body_of(patch, solids);
  const double mass = p.mass(dim), reach = p.reach();
  std::vector<std::array<double, dim>> points;
  std::array<double, dim> low, high;
  low.fill(1e300), high.fill(-1e300);
  for (const Eigen::Vector3d& local : patch.points) {
    points.push_back(from_earth<dim>(now(body, local)));
    for (int k = 0; k < dim; ++k) low[k] = std::min(low[k], points.back()[k]), high[k] = std::max(high[k], points.back()[k]);
  }
  const auto place = [&](std::size_t cluster, int lane) {
    std::array<double, dim> x;
    for (int k = 0; k < dim; ++k) x[k] = store.anchor[k][cluster] + double(store.pack_of(cluster)[k * cluster_size + lane]);
    return x;
  };
  const KernelWendland<dim> kernel(p.h());
  const Group& range = store.groups[std::size_t(group)];
  for (std::uint32_t cluster = range.fluid; cluster < range.solid; ++cluster) {
    bool near = true;
    for (int k = 0; k < dim; ++k)
      near = near && (domain.periodic[k] || (store.corner[k] + double(store.low[k][cluster]) < high[k] + reach &&
                                             store.corner[k] + double(store.high[k][cluster]) > low[k] - reach));
    if (!near) continue;
    const Real* const planes = store.pack_of(cluster);
    for (int lane = 0; lane < cluster_size && store.id[cluster * cluster_size + lane] != no_particle; ++lane) {
      const auto x = place(cluster, lane);
      const double rho = p.eos.rho0 + double(planes[2 * dim * cluster_size + lane]);
      const double pressure = double(planes[(2 * dim + 1) * cluster_size + lane]) * rho * rho;
      for (std::size_t n = 0; n < points.size(); ++n) {
        double distance2 = 0.0;
        for (int k = 0; k < dim; ++k) {
          const double difference = apart(domain, k, x[k] - points[n][k]);
          distance2 += difference * difference;
        }
        if (distance2 >= reach * reach) continue;
        const double weight = mass / rho * kernel.value(distance2);
        sums[3 * n] += weight, sums[3 * n + 1] += weight * pressure;
        sums[3 * n + 2] += weight * rho * p.gravity * (x[dim - 1] - points[n][dim - 1]);
      }
    }
  }
  double* const force = sums.data() + 3 * points.size();
  for_clusters_of(store, patch.owner, group, [&](std::size_t cluster) {
    const double own_mass = mass * store.weight_of(cluster);
    for (int lane = 0; lane < cluster_size && store.id[cluster * cluster_size + lane] != no_particle; ++lane) {
      const bool counts = body ? patch.counted[store.id[cluster * cluster_size + lane] - body->first_id] != 0
                               : in_box(to_earth<dim>(place(cluster, lane)), patch.low, patch.high, dim == 2);
      if (!counts) continue;
      std::array<double, dim> f;
      for (int k = 0; k < dim; ++k) f[k] = own_mass * mass * double(store.sums_of(cluster)[k * cluster_size + lane]);
      const Eigen::Vector3d on = to_earth<dim>(f);
      for (int k = 0; k < 3; ++k) force[k] += on[k];
    }
  });
}

/// The reading that sums over all groups amount to. As on walls (boundary_extrapolated.hpp) weight alone makes no tension: a
/// point over the surface is dry.
inline PatchReading reading_of(const Patch& patch, std::span<const double> sums) {
  PatchReading reading;
  for (std::size_t n = 0; n < patch.points.size(); ++n) {
    const double weight = sums[3 * n], pressure = sums[3 * n + 1], over = sums[3 * n + 2];
    if (weight >= least_water)
      reading.pressure += std::max(pressure + over, std::min(pressure, 0.0)) / weight / double(patch.points.size());
  }
  for (int k = 0; k < 3; ++k) reading.force[k] = sums[3 * patch.points.size() + std::size_t(k)];
  return reading;
}

}  // namespace spindrift::sph
