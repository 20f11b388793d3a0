// What a turbulence model adds to the sweeps: closures in cells (eddy viscosity and diffusivities, exchanged with the gradients),
// diffusion and sources in the residual, and a matrix of its own, solved beside that of the mean flow (docs/theory/air.md,
// "Turbulence"). One table of functions per model of kernels/turbulence, chosen once. Tested in tests/verification/air (closures,
// wall_function). SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include "src/aero/flow/sweep_jacobian.hpp"
#include "src/aero/flow/sweep_viscous.hpp"

namespace spindrift::aero {

struct ModelSweeps {
  std::string_view name = "none";
  int equations = 0;                    ///< 0 with closures: an algebraic eddy viscosity
  std::array<double, 2> lowest{};       ///< bounds that updates respect
  std::array<double, 2> wall_spread{};  ///< diffusivity on a no-slip wall over the laminar viscosity
  void (*closures)(FlowTile& tile, const double* state, const ViscousSetting& s) = nullptr;
  void (*residual)(FlowTile& tile, const double* state, double* residual, const ViscousSetting& s) = nullptr;
  void (*matrix)(FlowTile& tile, const double* state, const ImplicitSetting& s) = nullptr;
  void (*multiply)(FlowTile& tile, const float* x, float* y) = nullptr;
  void (*wall)(const double* inside, double nu, double distance, double* ghost) = nullptr;
  std::array<double, 2> (*far_field)(double nu, double speed, double sound_speed) = nullptr;
  const turbulence::WallLaw& (*wall_law)() = nullptr;  ///< the closure's own law of the wall, solved for when first asked for
};

/// By the name in the scene; "none" has no functions. Throws where no model has the name.
const ModelSweeps& model_sweeps(std::string_view name);
/// The families of models, one model_*.cpp each.
std::span<const ModelSweeps> sweeps_of_sa();
std::span<const ModelSweeps> sweeps_of_sa_des();
std::span<const ModelSweeps> sweeps_of_sst();
std::span<const ModelSweeps> sweeps_of_sst_2003();
std::span<const ModelSweeps> sweeps_of_k_omega();
std::span<const ModelSweeps> sweeps_of_les();

/// Components of FlowTile::gradients after those of gradients: what closures() leaves there.
constexpr int eddy_component(int equations) { return 3 * (4 + equations); }

}  // namespace spindrift::aero
