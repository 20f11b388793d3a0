// Loads at the roots of blades: of the air, of weight and of the blades' own motion, from their mass along the span.
// Frames and signs: docs/theory/rotor_engineering.md, "Blade roots". Used by blade_loads.cpp; tested in
// tests/src/aero/blade_roots_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "kernels/rigid/wrench.hpp"
#include "src/aero/turbine.hpp"

namespace spindrift::scene {
class Columns;
}

namespace spindrift::aero {

/// Load of a blade on the hub: force along the rotor's axis downwind, in the blade's direction of motion, outward (normal to
/// the axis), and the moments about its root that these make by the blade's length.
struct BladeRootLoad {
  double downwind = 0.0, ahead = 0.0, outward = 0.0;  ///< [N]
  double flap = 0.0;                                  ///< positive where the blade is pushed downwind [N m]
  double edge = 0.0;                                  ///< positive where it is pushed ahead [N m]
};

/// How the hub moves; earth frame, rates of the blades, spin included.
struct HubMotion {
  Eigen::Vector3d acceleration;       ///< of the hub [m/s2]
  Eigen::Vector3d omega, omega_rate;  ///< [rad/s], [rad/s2]
};

/// Mass along a blade, straight lines between the rows.
struct BladeMasses {
  std::vector<double> span, mass;  ///< from the rotor's axis along the blade, as in the planform [m]; [kg/m]
};
/// From a CSV file with span_m and mass_kg_m. Throws scene::SceneError.
BladeMasses read_blade_masses(const Turbine& turbine, const std::string& path);
/// The same columns of a file that has others too.
BladeMasses blade_masses_of(const Turbine& turbine, const scene::Columns& file);

/// What bending adds to a piece of a blade, from the rigid blade; earth frame.
struct MassMotion {
  Eigen::Vector3d displacement, acceleration;  ///< [m], [m/s2]
};

class BladeRoots {
 public:
  BladeRoots(const Turbine& turbine, const BladeMasses& masses);

  std::size_t blades() const { return std::size_t(blades_); }
  /// Root of a blade that points along `out`, from the hub [m].
  Eigen::Vector3d root(const Eigen::Vector3d& axis, const Eigen::Vector3d& out) const {
    return root_radius_ * out + root_axial_ * axis;
  }
  /// Adds weight and inertia of the blade along `out` to a wrench about its root; `point` is from the hub.
  void add_mass_loads(const HubMotion& hub, const Eigen::Vector3d& axis, const Eigen::Vector3d& out,
                      const Eigen::Vector3d& gravity_m_s2, Wrench& wrench, std::span<const MassMotion> bent = {}) const;
  /// Where the masses are, along the blade from the rotor's axis [m]: two to a row of the table.
  static std::vector<double> stations(const BladeMasses& masses);
  /// About the root of a blade along `out`. `sense`: 1, or -1 of blades that turn against the axis.
  static BladeRootLoad along_blade(const Wrench& wrench, const Eigen::Vector3d& axis, const Eigen::Vector3d& out,
                                   double sense = 1.0);

 private:
  struct Point {
    double mass, radius, axial;  ///< [kg]; from the hub [m], axial downwind
  };
  int blades_;
  double root_radius_, root_axial_;
  std::vector<Point> points_;
};

}  // namespace spindrift::aero
