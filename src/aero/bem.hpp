// Blade element momentum: the loads of a rotor given as section tables, element by element and blade by blade, with the motion of
// its body in every element's wind. Equations: docs/theory/rotor_engineering.md; one element: kernels/rotor/blade_element.hpp.
// Used by rotor_loads.cpp; tested in tests/src/aero/bem_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "kernels/rotor/blade_element.hpp"
#include "src/aero/tower.hpp"
#include "src/aero/turbine.hpp"
#include "src/aero/wind.hpp"

namespace spindrift::aero {

/// The rotor as its blades see it; earth frame.
struct DiscMotion {
  Eigen::Vector3d hub_velocity;                   ///< [m/s]
  Eigen::Vector3d omega;                          ///< of the blades, spin included [rad/s]
  Eigen::Vector3d axis, up;                       ///< unit, normal to each other; blade 1 points along `up` at azimuth zero
  double azimuth, blade_pitch;                    ///< [rad]
  Eigen::Vector3d hub = Eigen::Vector3d::Zero();  ///< [m], where the wind goes with height
  std::span<const double> pitches = {};           ///< of each blade [rad]; none: all have blade_pitch
  const Tower* tower = nullptr;                   ///< whose flow the blades meet
  TowerFrame tower_frame = {};
};

struct DiscLoad {
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();  ///< [N], [N m] about the hub, earth frame
  int unbalanced = 0;  ///< elements that found no induction: they act as free aerofoils
};

class BladeElementMomentum {
 public:
  /// `induction`: "madsen" or "buhl".
  BladeElementMomentum(const Turbine& turbine, const std::string& induction, double air_density_kg_m3);

  DiscLoad operator()(const Wind& wind, const DiscMotion& rotor, double t = 0.0) const;
  DiscLoad operator()(const Eigen::Vector3d& wind, const DiscMotion& rotor) const { return (*this)(Wind{wind}, rotor); }

  double tip_radius() const { return tip_radius_; }
  double radius(std::size_t element) const { return elements_[element].radius; }
  double chord(std::size_t element) const { return elements_[element].chord; }
  /// Of one element by itself; the two winds as in solve_element.
  ElementState solve(std::size_t element, double normal_wind, double tangential_wind, double blade_pitch) const;

 private:
  /// Between two stations of the planform.
  struct Element {
    double radius, axial;                ///< of its middle, from the hub [m]; axial downwind
    double normal_radial, normal_axial;  ///< its normal
    double length, chord, twist;         ///< [m], [m], [rad]
    std::size_t first, rows;             ///< its polar in attack_, lift_, drag_
  };
  SectionForce polar(const Element& e, double attack) const;
  template <class Induction>
  DiscLoad load(const Wind& wind, const DiscMotion& rotor, double t, const Induction& induction) const;
  Annulus annulus(const Element& e, double blade_pitch) const;

  std::variant<InductionMadsen, InductionBuhl> induction_;
  int blades_;
  double air_density_, hub_radius_, tip_radius_;
  std::vector<Element> elements_;
  std::vector<double> attack_, lift_, drag_;  ///< polars of all elements, blended in thickness
};

}  // namespace spindrift::aero
