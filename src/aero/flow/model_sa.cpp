// SPDX-License-Identifier: Apache-2.0
#include "kernels/turbulence/model_sa.hpp"

#include "src/aero/flow/sweep_model_of.hpp"

namespace spindrift::aero {

std::span<const ModelSweeps> sweeps_of_sa() {
  static const ModelSweeps models[]{SweepsOf<turbulence::Sa>::table(), SweepsOf<turbulence::SaNeg>::table()};
  return models;
}

}  // namespace spindrift::aero
