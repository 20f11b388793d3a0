// Blades that bend in their slowest modes: their motion under the air, weight and the turning of the rotor, and what they do to
// the hub. Between the steps of the bodies the amplitudes go on as parabolas; at the end of a step they are advanced exactly
// under forces that are linear over it. Equations: docs/theory/structure.md, "Blades". Used by blade_loads.cpp; tested in
// tests/src/aero/flexible_blades_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <string>
#include <vector>

#include "kernels/beam/blade.hpp"
#include "kernels/rigid/wrench.hpp"
#include "src/aero/bem.hpp"
#include "src/aero/blade_roots.hpp"
#include "src/aero/turbine.hpp"

namespace spindrift::aero {

/// From a CSV file with span_m (from the rotor's axis along the blade), mass_kg_m, flap_N_m2, edge_N_m2 and twist_deg.
struct BladeStructure {
  BladeMasses masses;
  std::vector<double> flap, edge, twist;  ///< as in beam::BladeTable
};
/// Throws scene::SceneError with what is wrong, by line.
BladeStructure read_blade_structure(const Turbine& turbine, const std::string& path);

/// How the hub turns and what pulls at masses there; earth frame.
struct HubField {
  Eigen::Vector3d omega;       ///< of the blades, spin included [rad/s]
  Eigen::Vector3d omega_rate;  ///< what is known of its change; the rest goes with `participation` [rad/s2]
  Eigen::Vector3d gravity;     ///< [m/s2]
};

class FlexibleBlades {
 public:
  static constexpr int modes = beam::BladeModes::count;
  using Modal = Eigen::Vector3d;  ///< of the modes of one blade
  static_assert(modes == 3);
  /// Amplitudes [kg^1/2 m] and their rates, of all blades in turn.
  struct Bending {
    std::array<double, std::size_t(modes) * most_blades> amplitudes{}, rates{};
    auto amplitude(int blade) { return Eigen::Map<Modal>(amplitudes.data() + modes * blade); }
    auto rate(int blade) { return Eigen::Map<Modal>(rates.data() + modes * blade); }
    Modal amplitude(int blade) const { return Eigen::Map<const Modal>(amplitudes.data() + modes * blade); }
    Modal rate(int blade) const { return Eigen::Map<const Modal>(rates.data() + modes * blade); }
  };

  /// `damping`: share of the critical one, of each mode.
  FlexibleBlades(const Turbine& turbine, const BladeStructure& structure, std::span<const double> damping);

  int blades() const { return blades_; }
  double mass() const { return mass_; }                                      ///< of one blade [kg]
  const std::array<double, modes>& omega() const { return modes_.omega(); }  ///< at rest [rad/s]
  std::array<double, modes> omega_turning(double speed) const;               ///< of a held hub, without weight [rad/s]
  /// How far the tip of a level blade sinks under its own weight, flapwise or edgewise, whichever is more [m].
  double sag(double gravity_m_s2) const;
  /// For the elements of the rotor; valid while both live.
  BentBlades bent(const Bending& bending) const;
  BladeAxes axes(const DiscMotion& rotor, int blade) const;
  /// Of the tip, along the axes of a blade without pitch: downwind and ahead [m].
  Eigen::Vector2d tip(const DiscMotion& rotor, int blade, const Bending& bending) const;

  /// Forces on the modes of a blade that the air does not make, the stiffness of the pull along it included: weight and inertia
  /// at the bent blade, for a hub that does not accelerate [kg^1/2 m/s2].
  Modal inertial_force(const BladeAxes& axes, const HubField& hub, const Modal& amplitude, const Modal& rate) const;
  /// Force and moment about the hub, [force; moment], of masses that go with the modes' acceleration 1.
  Eigen::Matrix<double, 6, modes> participation(const BladeAxes& axes) const;
  /// Stiffness and damping at the root.
  Modal restoring(const Modal& amplitude, const Modal& rate) const;
  /// What the bent blades do to the hub beyond what rigid ones of their mass would, [force; moment] about it. `air`: force of the
  /// air on the modes. It leaves out the part that goes with the hub's acceleration, which is -`added_mass`.
  Eigen::Matrix<double, 6, 1> reaction(const DiscMotion& rotor, const HubField& hub, const Bending& bending,
                                       std::span<const double> air) const;
  /// About the hub; negative: what bends does not follow the hub. @pre blades are where `rotor` has them.
  Eigen::Matrix<double, 6, 6> added_mass(const DiscMotion& rotor) const;
  /// Amplitudes at rest under these forces.
  void settle(const DiscMotion& rotor, const HubField& hub, std::span<const double> air, Bending& bending) const;

  // What goes on from step to step, in plain numbers that the caller keeps.
  std::size_t memory_size() const { return head + 4 * std::size_t(modes * blades_); }
  /// Bent like this at t. `air` as in reaction.
  void begin(double t, const DiscMotion& rotor, const HubField& hub, const Bending& bending, std::span<const double> air,
             std::span<double> memory) const;
  /// @pre t is within a step or so after the memory's.
  Bending predicted(std::span<const double> memory, double t) const;
  /// To t, at whose end the rotor moves so and the air's forces on the blades as predicted are `air`.
  void advance(double t, double h, const DiscMotion& rotor, const HubField& hub, std::span<const double> air,
               std::span<double> memory) const;

  /// Displacement of the masses of BladeRoots and their acceleration by bending, for a hub that accelerates by `hub`,
  /// [linear; angular] beyond what the field knows.
  std::vector<MassMotion> mass_motions(const DiscMotion& rotor, int blade, const HubField& field,
                                       const Eigen::Matrix<double, 6, 1>& hub, const Bending& bending,
                                       std::span<const double> air) const;

 private:
  static constexpr std::size_t head = 14;  ///< time, steps, velocity and turning of the hub, their last mean rates
  struct Row {
    Eigen::Map<Modal> amplitude, rate, acceleration, force;
  };
  Row row(std::span<double> memory, int blade) const;
  Modal squared() const;
  double along(double at) const { return root_ + at; }

  int blades_;
  double precone_, root_, mass_ = 0.0;
  beam::BladeModes modes_;
  std::vector<beam::BladePoint> points_;
  std::vector<double> prebend_;                      ///< of the points, downwind [m]
  std::vector<BentBlades::Section> sections_;        ///< of the rotor's elements
  std::vector<beam::BladePoint> root_points_;        ///< of BladeRoots
  beam::BladeModes::Square by_turning_, by_weight_;  ///< stiffness of a pull of 1 m/s2 per metre of radius, and of 1 m/s2
  Modal damping_;                                    ///< 2 zeta omega [1/s]
};

}  // namespace spindrift::aero
