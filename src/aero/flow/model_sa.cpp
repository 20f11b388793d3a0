// SPDX-License-Identifier: Apache-2.0
#include "kernels/turbulence/model_sa.hpp"

#include "src/aero/flow/sweep_model_of.hpp"

namespace spindrift::aero {

const ModelSweeps& sweeps_sa() {
  static const ModelSweeps table = SweepsOf<turbulence::Sa>::table();
  return table;
}
const ModelSweeps& sweeps_sa_neg() {
  static const ModelSweeps table = SweepsOf<turbulence::SaNeg>::table();
  return table;
}

}  // namespace spindrift::aero
