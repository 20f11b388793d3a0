// SPDX-License-Identifier: Apache-2.0
#include "kernels/turbulence/model_k_omega.hpp"

#include "src/aero/flow/sweep_model_of.hpp"

namespace spindrift::aero {

std::span<const ModelSweeps> sweeps_of_k_omega() {
  static const ModelSweeps models[]{SweepsOf<turbulence::KOmega1988>::table(), SweepsOf<turbulence::KOmega>::table()};
  return models;
}

}  // namespace spindrift::aero
