// Sections of a blade, all with the same number of nodes: aerofoil outlines resampled once, blended node by node in relative
// thickness. Recipe: docs/theory/rotor_grid.md. Used by blade_surface.cpp and wing.cpp; tested in
// tests/src/aero/rotor_grid/rotor_grid_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <span>
#include <vector>

#include "kernels/grid/aerofoil.hpp"
#include "src/aero/turbine.hpp"

namespace spindrift::aero {

/// Whether an outline over the chord ends where it begins without a corner, as a circle does and a sharp trailing edge does not.
bool is_round(std::span<const Eigen::Vector2d> outline);
/// Nodes of one outline, spacing as in `resample`. Chord 1 from the leading edge at (0, 0) to the trailing edge at (1, 0). An
/// edge that is too thin for the cells on it, or sharp, is opened to a tenth of the cells beside it for each.
std::vector<Eigen::Vector2d> resample_outline(const Aerofoil& aerofoil, const SectionSpacing& spacing, double slide = 0.0);

class Sections {
 public:
  /// Aerofoils by increasing thickness.
  Sections(std::span<const Aerofoil> aerofoils, const SectionSpacing& spacing);

  int round() const { return spacing_.round; }
  /// The section of relative thickness `thickness` (of chord 1). `slide` [rad] turns the nodes of a round root (a circle)
  /// back against the section, with a weight that grows from 0 where the blend first meets the round outline's neighbour.
  void blend(double thickness, double slide, std::span<Eigen::Vector2d> nodes) const;

 private:
  std::vector<double> thickness_;
  std::vector<std::vector<Eigen::Vector2d>> nodes_;   ///< by aerofoil
  std::vector<std::vector<Eigen::Vector2d>> slopes_;  ///< d node / d thickness
  SectionSpacing spacing_;
  bool round_root_ = false;  ///< the thickest outline is a circle or like one
  Aerofoil root_;
};

}  // namespace spindrift::aero
