// SPDX-License-Identifier: Apache-2.0
#include "kernels/turbulence/model_sa_des.hpp"

#include "src/aero/flow/sweep_model_of.hpp"

namespace spindrift::aero {

std::span<const ModelSweeps> sweeps_of_sa_des() {
  static const ModelSweeps models[]{SweepsOf<turbulence::Des97>::table(), SweepsOf<turbulence::Ddes>::table()};
  return models;
}

}  // namespace spindrift::aero
