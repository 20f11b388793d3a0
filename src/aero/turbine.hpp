// A rotor's blades as data: sections along the span and their polars, from a turbine file (inputs/turbines).
// Read by turbine.cpp; used by bem.cpp and rotor_grid; tested in tests/src/aero/bem_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

namespace spindrift::scene {
template <class Options>
class Section;
}

namespace spindrift::aero {

inline constexpr int most_blades = 12;                      ///< of a rotor
inline constexpr double air_kinematic_viscosity = 1.46e-5;  ///< of air at 15 C [m2/s], ISO 2533

/// Of a polar, for dynamic stall after Beddoes & Leishman: in place of what the polar itself says.
struct StallOptions {
  double normal_slope = 0.0;                                 ///< of the normal force in attached flow [1/rad]; 0: no stall
  double zero_lift = 0.0;                                    ///< [rad]
  double drag_0 = 0.0;                                       ///< at that angle
  double critical_normal = 2.0, critical_normal_low = -2.0;  ///< normal force at which the leading edge separates
};

struct PolarOptions {
  std::optional<double> thickness_pct;
  std::optional<int> number;       ///< in place of a thickness
  std::optional<double> reynolds;  ///< absent: the only polar of its thickness or number
  std::string file;                ///< path
  std::optional<StallOptions> stall;
};

struct OutlineOptions {
  double thickness_pct = 0.0;
  std::string file;  ///< path
};

/// [turbine] of a turbine file.
struct TurbineOptions {
  int blades = 3;
  double hub_radius_m = 0.0;
  double precone = 0.0;  ///< [rad], positive: blades tilt upwind
  std::string planform;  ///< path
  std::string elements = "between_stations";
  std::vector<PolarOptions> polars;
  std::vector<OutlineOptions> aerofoils;
  std::string operation, controller;  ///< paths
};

const scene::Section<TurbineOptions>& turbine_section();

/// Lift and drag against angle of attack, over the whole circle.
struct Polar {
  double place = 0.0;                ///< along Planform::place(): thickness over chord [-], or a number
  std::optional<double> reynolds{};  ///< of the chord; absent: the only polar of its place
  std::vector<double> attack;        ///< increasing from -pi to pi [rad]
  std::vector<double> lift, drag;
  std::optional<StallOptions> stall{};  ///< absent: what the polar says
};

/// The outline of a section of chord 1.
struct Aerofoil {
  double thickness = 0.0;  ///< over chord [-]
  std::vector<Eigen::Vector2d>
      outline;  ///< trailing edge (1, y), suction side (y > 0), leading edge (0, 0), pressure side, trailing edge
};

/// Sections from root to tip on the undeformed blade.
struct Planform {
  std::vector<double> span;       ///< distance from the rotor axis along the coned blade axis [m]
  std::vector<double> chord;      ///< [m]
  std::vector<double> twist;      ///< nose into the wind positive [rad]
  std::vector<double> thickness;  ///< over chord [-]; may be empty where polars go by number
  std::vector<double> prebend;    ///< offset of the centre line across the blade axis, downwind positive [m]
  std::vector<double> sweep;      ///< the same in the rotor's plane, towards the leading edge positive [m]
  std::vector<double> polar{};    ///< number of the polar, with a fraction between two; empty: polars go by thickness

  /// By which sections find their polars.
  const std::vector<double>& place() const { return polar.empty() ? thickness : polar; }
};

struct Turbine {
  int blades = 3;
  double hub_radius = 0.0, precone = 0.0;  ///< [m], [rad]
  Planform planform;
  std::vector<Polar> polars;        ///< by increasing place, at one place by increasing Reynolds number
  std::vector<Aerofoil> aerofoils;  ///< by increasing thickness; none where the file gives none
  bool elements_at_stations = false;
};

/// A piece of a blade that blade elements take for one section; from the hub along the rotor's axis and square to it.
struct BladePiece {
  double span;               ///< of its middle, along the coned blade from the rotor's axis [m]
  double radius, axial;      ///< of its middle; axial downwind [m]
  double outward, downwind;  ///< from its inner end to its outer one [m]
  double length;             ///< [m]
  double chord, twist;       ///< [m], [rad]
  double place;              ///< among the polars, as Planform::place
};
/// From root to tip: between the stations, or round all but the first and the last, where the loss at the ends leaves no load.
std::vector<BladePiece> blade_pieces(const Turbine& turbine);

/// What a turbine file says besides its blades: paths of its operating table and its controller, empty where it names none.
struct TurbineFiles {
  std::string operation, controller;
};
TurbineFiles turbine_files(const std::string& path);

/// Outline of an aerofoil over its chord, in the order of `Aerofoil::outline`, from CSV (x_c, y_c) or a Selig file (.dat). Throws
/// scene::SceneError where no grid could go round it.
std::vector<Eigen::Vector2d> read_outline(const std::string& path);

/// Some section has polars at several Reynolds numbers.
bool depends_on_reynolds(const Turbine& turbine);

/// Throws scene::SceneError with all that is wrong with the file and the data files that it names.
Turbine read_turbine(const std::string& path);

}  // namespace spindrift::aero
