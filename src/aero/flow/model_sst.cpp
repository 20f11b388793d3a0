// SPDX-License-Identifier: Apache-2.0
#include "kernels/turbulence/model_sst.hpp"

#include "src/aero/flow/sweep_model_of.hpp"

namespace spindrift::aero {

const ModelSweeps& sweeps_sst() {
  static const ModelSweeps table = SweepsOf<turbulence::Sst>::table();
  return table;
}
const ModelSweeps& sweeps_sst_vm() {
  static const ModelSweeps table = SweepsOf<turbulence::SstVm>::table();
  return table;
}

}  // namespace spindrift::aero
