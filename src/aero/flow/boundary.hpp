// Ghost cells behind boundary windows and the pressure of walls. Ghosts serve gradients, viscous faces and open boundaries;
// through wall faces no flux scheme is called: the pressure there is extrapolated along the line of cells and nothing else
// passes. Called by the tasks of src/aero/flow; tested in tests/src/aero/flow/solver_test.cpp. SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>

#include "kernels/rotor/wind_profile.hpp"
#include "src/aero/flow/condition.hpp"
#include "src/aero/flow/flow_tile.hpp"

namespace spindrift::aero {

/// Forces on a plane across the wind. They give the air that passes the turbulence that wide cells of far sides would lose
/// (Gilling & Sorensen 2011, Wind Energy 14, 661; Troldborg et al. 2014, Wind Energy 17, 657).
struct InflowPlane {
  Eigen::Vector3d centre, normal;  ///< [m]; the way the wind blows
  double width = 1.0;              ///< of the Gaussian over which the forces are spread along the normal [m]
  /// At the end of the physical step: acceleration integrated over the normal [m2/s2].
  std::function<Eigen::Vector3d(const Eigen::Vector3d& place)> push;

  /// Mean over a cell of this centre and extent along the normal [m/s2].
  Eigen::Vector3d acceleration(const Eigen::Vector3d& cell, double extent) const;
};

/// The undisturbed wind where it changes in time.
struct UndisturbedWind {
  /// At a place, so long before the end of the physical step [m, s -> m/s]; empty where the wind is steady.
  std::function<Eigen::Vector3d(const Eigen::Vector3d& place, double ago)> velocity;
  std::optional<InflowPlane> plane;

  bool steady() const { return !velocity; }
};

struct BoundarySetting {
  gas::IdealGas gas;
  gas::Primitive<double> stream{};  ///< undisturbed flow, above the references; at the reference height of
  WindProfile profile{};            ///< its velocity over the height z
  UndisturbedWind wind;             ///< in place of that velocity, where it changes in time
  gas::Reservoir reservoir{};       ///< that the undisturbed flow comes from
  std::array<double, 2> carried{};  ///< of the turbulence unknowns in it
  double reference_speed = 1e30;    ///< of the far field's waves [m/s]; beyond the sound speed: the physical ones
  double dt = 0.0;                  ///< of a moving grid, for the speed of its walls, with
  TimeWeights weights{};            ///< those of the physical step
  bool inviscid = false;            ///< behind slip walls all is extrapolated; else pressure alone, and nothing rubs
  bool turning = false;             ///< walls at rest in a frame that turns: their speed follows from TileGeometry's own
  /// Ghost value of the turbulence unknowns behind a no-slip wall, of those inside, the laminar nu and the wall distance; null:
  /// none.
  void (*wall_carried)(const double* inside, double nu, double distance, double* ghost) = nullptr;
};

/// A face of a boundary, with what its condition needs.
class BoundaryFace {
 public:
  const FlowTile& tile;
  const double* state;
  const FlowBoundary& boundary;
  const BoundarySetting& setting;
  int k, j, i;                    ///< of the cell at it
  bool deep;                      ///< the tile has more than one cell across
  gas::Face<double> face;         ///< out of the flow
  gas::Primitive<double> inside;  ///< the cell at it

  gas::Primitive<double> next() const;        ///< the cell behind it; `inside` where there is none
  gas::Vector<double> wall_velocity() const;  ///< [m/s]
  gas::Primitive<double> stream() const;      ///< undisturbed flow at its height
  /// Share of the difference of both cells by which a value changes from `inside` to the face; where `deep`.
  double weight() const;
};

void fill_boundaries(FlowTile& tile, double* state, const BoundarySetting& setting);
void add_wall_pressure(FlowTile& tile, const double* state, double* residual);
/// 1 where the flux scheme acts: sets FlowTile::open from its boundaries.
void set_open_faces(FlowTile& tile);

/// Where the undisturbed flow at this height comes to rest without loss.
gas::Reservoir reservoir_of(const gas::IdealGas& gas, const gas::Primitive<double>& stream);
/// Undisturbed flow whose velocity goes with the height z.
inline gas::Primitive<double> stream_at(const gas::Primitive<double>& stream, const WindProfile& profile, double z) {
  if (profile.uniform()) return stream;
  const double share = profile.share(z);
  return {stream.p, share * stream.u, share * stream.v, share * stream.w, stream.T};
}

/// Centre of a face of a tile's side [m].
Eigen::Vector3d face_centre(const TileGeometry& g, Side side, int k, int j, int i);

/// Pressure on a wall face (above the reference) and the velocity of the wall [m/s].
double wall_pressure(const FlowTile& tile, const double* state, Side side, int k, int j, int i);
gas::Vector<double> wall_velocity(const TileGeometry& g, Side side, int k, int j, int i, const BoundarySetting& setting);

}  // namespace spindrift::aero
