// A straight, untwisted wing of one aerofoil between two planes, made by the blade's lofter: an O-grid round the section, the
// same on every plane. For comparison with two-dimensional results. Used by validation scenes; tested in
// tests/src/aero/rotor_grid/wing_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "src/aero/grid/multi_block.hpp"
#include "src/aero/rotor_grid/sections.hpp"

namespace spindrift::aero {

struct WingSpec {
  SectionSpacing spacing{.round = 240, .edge = 4, .leading_edge = 0.002, .trailing_edge = 0.003};
  int layers = 64;
  int span_cells = 4;
  double span_chords = 1.0;
  double chord_m = 1.0;
  double first_cell_chords = 1e-5;
  double extent_chords = 50.0;  ///< radius of the outer boundary
  bool planar = false;          ///< one cell along the span and no conditions there: flow in the x-z plane
};

/// One block (i outward, j round from the trailing edge along the pressure side, k along +y); leading edge at the origin, chord
/// along x, suction side towards +z. Patches: wing, far; the two ends are periodic.
MultiBlockGrid make_wing_grid(const Aerofoil& aerofoil, const WingSpec& spec);

/// NACA four-digit symmetric section with its blunt edge of 0.252 % (Abbott & von Doenhoff 1959, eq. 6.2), as an outline of 2 n +
/// 1 points, cosine spaced.
Aerofoil naca_symmetric(double thickness, int n = 100);

}  // namespace spindrift::aero
