// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/sweep_model.hpp"

namespace spindrift::aero {

const ModelSweeps& model_sweeps(std::string_view name) {
  static const ModelSweeps none;
  for (const ModelSweeps* model : {&sweeps_sa(), &sweeps_sa_neg(), &sweeps_sst(), &sweeps_sst_vm()})
    if (model->name == name) return *model;
  return none;
}

}  // namespace spindrift::aero
