// SPDX-License-Identifier: Apache-2.0
#include "kernels/turbulence/model_les.hpp"

#include "src/aero/flow/sweep_model_of.hpp"

namespace spindrift::aero {

std::span<const ModelSweeps> sweeps_of_les() {
  static const ModelSweeps models[]{ClosuresOf<turbulence::Smagorinsky>::table(), ClosuresOf<turbulence::Wale>::table()};
  return models;
}

}  // namespace spindrift::aero
