// What still water lifts the bodies of a sea of particles by, from their shapes: the load that statics and modes see before the
// particles are there. The particles' own lift is that within 2 % (docs/verification/sea.md): water is fitted to the bodies so
// that they displace their volume. Held by src/coupling/sea_source.hpp; tested in tests/src/sea/still_water_test.cpp and
// tests/coupled/particle_start_test.py. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <variant>
#include <vector>

#include "kernels/rigid/closed_surface.hpp"
#include "kernels/rigid/motion.hpp"
#include "kernels/rigid/wrench.hpp"
#include "kernels/waves/wetted.hpp"
#include "src/sea/sph/body_shapes.hpp"

namespace spindrift::sea {

class StillWater {
 public:
  /// Bodies as unions of shapes in body axes from the centre of mass; none where a body does not meet the water. `width` [m]: of
  /// a scene in the plane, which has its bodies' sections that wide; it loads nothing across the plane.
  StillWater(std::span<const std::vector<sph::BodyShape>> bodies, double weight_N_m3, sph::Cut cut, double width);

  /// Adds the buoyancy to one wrench per body, each about its body's centre of mass.
  void add_loads(std::span<const Motion> bodies, std::span<Wrench> wrenches) const;
  /// Under z = 0 of a body in `motion`, its first moment about the centre of mass in earth axes.
  waves::Wetted wetted(std::size_t body, const Motion& motion) const;

 private:
  /// A closed surface whose points x stand at x - origin in body axes.
  struct Surface {
    std::shared_ptr<const ClosedSurface> surface;
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  };
  using Solid = std::variant<Cylinder, Sphere, Surface>;
  /// What shapes that overlap have more than once: cells of volumes [m3], each a level slab `edge` [m] high round its place.
  struct Shared {
    struct Cell {
      Eigen::Vector3d place;
      double volume;
    };
    std::vector<Cell> cells;
    double edge = 1.0;
  };
  struct Body {
    std::vector<Solid> solids;
    std::vector<Shared> shared;
  };
  Solid solid_of(const sph::BodyShape& shape) const;
  Solid drawn_out(const std::vector<Eigen::Vector3d>& outline) const;
  Shared shared_by(const sph::BodyShape& shape, std::span<const sph::BodyShape> earlier) const;

  double weight_, width_;
  sph::Cut cut_;
  std::vector<Body> bodies_;
};

}  // namespace spindrift::sea
