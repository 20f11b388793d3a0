// What a turbulence model adds to the sweeps: closures in cells (eddy viscosity and diffusivities, exchanged with the gradients),
// diffusion and sources in the residual, and a matrix of its own, solved beside that of the mean flow (docs/theory/air.md,
// "Turbulence"). One table of functions per model of kernels/turbulence, chosen once. Tested in tests/verification/air (closures,
// wall_function). SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "src/aero/flow/sweep_jacobian.hpp"
#include "src/aero/flow/sweep_viscous.hpp"
#include "src/scene/models.hpp"

namespace spindrift::aero {

struct ModelSweeps {
  int equations = 0;                    ///< 0 with closures: an algebraic eddy viscosity
  std::array<double, 2> lowest{};       ///< bounds that updates respect
  std::array<double, 2> wall_spread{};  ///< diffusivity on a no-slip wall over the laminar viscosity
  void (*closures)(FlowTile& tile, const double* state, const ViscousSetting& s) = nullptr;
  void (*residual)(FlowTile& tile, const double* state, double* residual, const ViscousSetting& s) = nullptr;
  void (*matrix)(FlowTile& tile, const double* state, double cfl, const ImplicitSetting& s) = nullptr;
  void (*multiply)(FlowTile& tile, const float* x, float* y) = nullptr;
  void (*wall)(const double* inside, double nu, double distance, double* ghost) = nullptr;
  std::array<double, 2> (*far_field)(double nu, double speed, double sound_speed) = nullptr;
  const turbulence::WallLaw& (*wall_law)() = nullptr;  ///< the closure's own law of the wall, solved for when first asked for
};

/// A turbulence model that a scene may choose: a variable in a file model_*.cpp and its line in closures.inc.
struct Closure {
  std::string_view name, help;
  std::vector<std::string> keys;  ///< of [aero.flow] that it reads
  ModelSweeps sweeps;
  bool resolves_eddies = false;  ///< in three dimensions only
};

/// "none" is not among them.
scene::Models<Closure> closures();
/// By the name in the scene; "none" has no functions. Throws where no model has the name.
const ModelSweeps& model_sweeps(std::string_view name);

/// Added to the pseudo-time [kg/s] of k where its residual makes it grow: 1.1 times the rate of growth, so that an implicit
/// update grows it at most elevenfold. A Newton step longer than the time in which k grows points to k = 0 instead, the laminar
/// solution, and stays there. It goes with the residual, so that the end of a march is Newton's. (Twice the rate, and omega too,
/// took up to three times the steps.)
constexpr double growth_damping(double residual, double k) { return residual < 0.0 ? -1.1 * residual / k : 0.0; }

/// Components of FlowTile::gradients after those of gradients: what closures() leaves there.
constexpr int eddy_component(int equations) { return 3 * (4 + equations); }

}  // namespace spindrift::aero
