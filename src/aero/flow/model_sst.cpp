// SPDX-License-Identifier: Apache-2.0
#include "kernels/turbulence/model_sst.hpp"

#include "src/aero/flow/sweep_model_of.hpp"

namespace spindrift::aero {

std::span<const ModelSweeps> sweeps_of_sst() {
  static const ModelSweeps models[]{SweepsOf<turbulence::Sst1994>::table(), SweepsOf<turbulence::SstV>::table(),
                                    SweepsOf<turbulence::SstVm>::table()};
  return models;
}

}  // namespace spindrift::aero
