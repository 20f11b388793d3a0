// The conditions that a scene may set on a patch of the air's grid. Each is a file, condition_NAME.cpp, and a line in
// conditions.inc. The file has its name, what the reference says of it, the keys that it reads, what its faces are to the sweeps,
// its ghost cells and how they follow the cell inside; the line names its enumerator. Formulas are in kernels/gas/boundary.hpp.
// Used by the sweeps of src/aero/flow and by flow_options.cpp; tested in tests/src/aero/flow/conditions_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/gas/boundary.hpp"

namespace spindrift::scene {
template <class Model>
class Models;
}

namespace spindrift::aero {

class BoundaryFace;

enum class Condition : unsigned char {
#define CONDITION(name) name,
#include "src/aero/flow/conditions.inc"
#undef CONDITION
};

/// What the faces of a condition are to the sweeps.
enum class Surface : unsigned char {
  open,    ///< the flow goes through; what comes in brings the turbulence of the wind
  mirror,  ///< a plane: the flux scheme acts between mirror images, so that half a flow is the whole one cell by cell; its mass
           ///< flux there is none by symmetry
  slip,    ///< a wall: no flux scheme, through it goes pressure alone
  no_slip  ///< a wall at whose velocity the gas moves
};

/// Ghost cells behind a face, the first at it.
struct Ghosts {
  gas::Primitive<double> first, second;
};

/// A face of a boundary in the matrix of the mean flow: the block of the cell inside and that of the ghost cell, which is no
/// unknown. Unknowns p u v w T, scaled.
struct FoldedFace {
  float* diagonal;
  const float* beyond;
  gas::Face<double> face;
  std::array<double, 3> wind;  ///< undisturbed velocity over its scale
  bool held;                   ///< at a temperature

  /// An unknown of the ghost cell changes by `factor` times the change of one of the cell inside.
  void follow(int ghost, float factor, int inside) const {
    for (int row = 0; row < 5; ++row) diagonal[inside * 5 + row] += factor * beyond[ghost * 5 + row];
  }
};

struct BoundaryCondition {
  std::string_view name, help;
  std::vector<std::string> keys;  ///< of a boundary that it reads besides patch, condition and loads
  Surface surface = Surface::open;
  bool wall_law = false;  ///< friction by the law of the wall; goes with closures that transport turbulence
  Ghosts (*ghosts)(const BoundaryFace& at) = nullptr;
  void (*fold)(const FoldedFace& at) = nullptr;  ///< null: the ghost cell is given from outside
};

scene::Models<BoundaryCondition> conditions();
const BoundaryCondition& of(Condition condition);

inline bool sticks(const BoundaryCondition& c) { return c.surface == Surface::no_slip; }
inline bool is_closed(const BoundaryCondition& c) { return c.surface == Surface::slip || sticks(c); }
/// Closed, or a plane of symmetry.
inline bool is_wall(const BoundaryCondition& c) { return c.surface != Surface::open; }
inline bool sticks(Condition c) { return sticks(of(c)); }
inline bool is_closed(Condition c) { return is_closed(of(c)); }

// What several of them are made of.
/// Behind a no-slip wall, at its velocity and, where it is held at one, its temperature.
Ghosts no_slip_ghosts(const BoundaryFace& at);
void fold_no_slip(const FoldedFace& at);
void fold_mirror(const FoldedFace& at);

}  // namespace spindrift::aero
