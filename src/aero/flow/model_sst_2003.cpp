// SPDX-License-Identifier: Apache-2.0
#include "kernels/turbulence/model_sst.hpp"

#include "src/aero/flow/sweep_model_of.hpp"

namespace spindrift::aero {

std::span<const ModelSweeps> sweeps_of_sst_2003() {
  static const ModelSweeps models[]{SweepsOf<turbulence::Sst>::table(), SweepsOf<turbulence::Sst2003Vm>::table()};
  return models;
}

}  // namespace spindrift::aero
