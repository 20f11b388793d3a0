// What a rotor grid is made to: its numbers of cells, distances and first cells; and the laws of the radius that follow from
// them: coaxial surfaces, box round the section, first cell. Recipe: docs/theory/rotor_grid.md. Used by plane.cpp and
// rotor_grid.cpp; tested in tests/src/aero/rotor_grid/rotor_grid_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "src/aero/rotor_grid/blade_surface.hpp"

namespace spindrift::aero {

/// Cells of one sector.
struct RotorGridSizes {
  int round = 40;  ///< round the section, even
  int edge = 2;    ///< of them on the trailing edge, and across the plug beyond the tip; even
  int box = 10;    ///< of them on each of the two sides of the box that face along the rotor's plane
  int layers = 8;  ///< from the wall to the box
  int beside = 6;  ///< from the box to the sector's side, each side
  int upstream = 7, downstream = 9;
  int span = 12;     ///< from hub cylinder to tip
  int outboard = 8;  ///< from tip to outer radius
  int box_chordwise() const { return round / 2 - box; }
  int chordwise() const { return round / 2 - edge; }  ///< of the plug
  int radial() const { return span + outboard; }
  int across() const { return 2 * beside + box_chordwise(); }
  int axial() const { return upstream + box + downstream; }
  long cells() const;  ///< of one sector
};

/// The sizes of resolution n: every number grows with n, about 16 000 n^3 cells a sector.
RotorGridSizes sizes_of(double n);

/// Nodes round the section for these sizes.
SectionSpacing section_spacing(const RotorGridSizes& sizes, bool rounded_edge = false);

struct RotorGridSpec {
  RotorGridSizes sizes;
  double hub_radius_m = 5.0;
  double radial_extent = 12.0, upstream_extent = 10.0, downstream_extent = 12.0;  ///< from the hub, in tip radii
  double first_cell_chords = 1e-3;  ///< height of the first cell over the local chord, where first_cell_m is zero
  double first_cell_m = 0.0;
  double y_plus = 0.0;       ///< where positive: of the first cell's centre, in the flow below
  double rotor_speed = 0.0;  ///< [rad/s]
  double wind_m_s = 0.0;
  double kinematic_viscosity = 1.46e-5;  ///< [m2/s]
  double pitch = 0.0;                    ///< [rad]
  bool rounded_edge = false;             ///< trailing edges closed by half a circle
  int coarsen = 0;                       ///< times that every second node is kept
  bool whole = true;                     ///< all blades; else one sector with rotational periodicity
  double resolution() const { return sizes.round / 40.0; }
};

/// Height of a first cell whose centre is at y+ under a turbulent boundary layer at half the chord: u_tau from the flat-plate law
/// c_f = 0.026 Re_x^(-1/7) (White 1974, Viscous Fluid Flow).
double first_cell_for(double y_plus, double speed_m_s, double chord_m, double kinematic_viscosity);

class RotorLayout {
 public:
  RotorLayout(const BladeSurface& blade, const RotorGridSpec& spec, int blades, int roll);

  const RotorGridSpec& spec() const { return spec_; }
  int roll() const { return roll_; }
  const std::vector<double>& radii() const { return radii_; }
  double sector(double r) const;   ///< arc length from the sector's middle to its side
  double first_cell(int k) const;  ///< [m]
  struct Box {
    double s, x;            ///< its centre
    double half_s, half_x;  ///< half its widths
  };
  Box box(double r) const;
  double reach() const { return reach_; }  ///< three quarters of the tip radius, where axial sizes are as everywhere far away

 private:
  double smoothed_chord(double r) const;
  const BladeSurface& blade_;
  RotorGridSpec spec_;
  int blades_, roll_;
  double reach_;
  std::vector<double> radii_;
};

}  // namespace spindrift::aero
