// Planar grids of verification cases, each a family: one smooth law sampled by any number of cells, so that errors of its members
// compare. i runs along the wall, j away from it, k along -y; the flow is in the x-z plane. Called by tests, benchmarks,
// validation scenes; tested in tests/src/aero/grid/generators_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include "src/aero/grid/multi_block.hpp"

namespace spindrift::aero {

/// NASA TMR flat plate: x from -0.33333 to 2, z to 1, plate from x = 0, the clustering of the TMR's own grids (reproduced to
/// 1e-10). 34 n x 24 n cells; n = 1, 2, 4, 8, 16 are the TMR's 35x25 ... 545x385. Patches: inflow, outflow, symmetry, wall, top.
MultiBlockGrid flat_plate(int n, double width = 1.0);

/// O-grid round a circular cylinder at the origin, `around` x `outward` cells; i clockwise. first_cell 0: radii in geometric
/// progression (cells as high as long everywhere when outward = around ln(far/radius) / 2 pi). Patches: wall, farfield.
struct CylinderOptions {
  int around = 64, outward = 32;
  double radius = 0.5, far = 50.0;  ///< [m]
  double first_cell = 0.0;          ///< [m] height at the wall, of the member with `around` = 64: others in proportion
  double width = 1.0;
};
MultiBlockGrid cylinder(const CylinderOptions& options);

/// C-grid round NACA 0012 with the closed, sharp trailing edge of the NASA TMR, chord 1 along x from 0 to 1. The TMR's family of
/// sizes: 112 n x 32 n cells, n = 1, 2, 4, 8, half of i on the aerofoil. Parabolic (conformal) coordinates round the leading edge
/// with lines normal to the wall; outer boundary 500 chords upstream and downstream. Patches: wall, farfield, outflow.
struct AerofoilOptions {
  int n = 2;
  double far = 500.0;          ///< chords
  double first_cell = 3.6e-6;  ///< chords; of n = 2, others in proportion
  double width = 1.0;
};
MultiBlockGrid naca0012(const AerofoilOptions& options);
/// The same round any outline: points from the trailing edge along the upper side to the nose and back along the lower side,
/// scaled so that the middle of its ends, the trailing edge, lies 1 from the origin; that edge may lie off the x axis (a flap, a
/// turned section) and stays in its place. An open one of up to 3 % of the chord is closed to its middle. Throws
/// std::invalid_argument with the reason where no such grid goes round it.
MultiBlockGrid aerofoil(std::span<const Eigen::Vector2d> outline, const AerofoilOptions& options);
/// Half thickness at x in [0, 1]; closed at x = 1.
double naca0012_half_thickness(double x);

/// Channel with the bump of the NASA TMR, z = 0.05 sin^4(pi x / 0.9 - pi / 3) for 0.3 < x < 1.2, on a wall from x = 0 to 1.5.
/// 44 n x 20 n cells. Patches: inflow, outflow, symmetry (wall upstream and downstream), wall, top.
struct BumpOptions {
  int n = 2;
  double height = 5.0, upstream = 25.0, downstream = 25.0;  ///< [m] beyond the wall's ends
  double first_cell = 1e-5;                                 ///< [m]; of n = 2, others in proportion; 0.05 for inviscid flow
  double width = 1.0;
};
MultiBlockGrid bump_channel(const BumpOptions& options);
double bump_height(double x);

/// A planar grid drawn out along -y over `width`: nk equal cells, the sides periodic or of the given patch.
MultiBlockGrid extruded(const MultiBlockGrid& planar, int nk, double width, bool periodic,
                        const std::string& side_patch = "sides");

}  // namespace spindrift::aero
