// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/sweep_model.hpp"

#include <stdexcept>
#include <string>

namespace spindrift::aero {

const ModelSweeps& model_sweeps(std::string_view name) {
  static const ModelSweeps none;
  if (name == none.name) return none;
  for (const auto family :
       {sweeps_of_sa(), sweeps_of_sa_des(), sweeps_of_sst(), sweeps_of_sst_2003(), sweeps_of_k_omega(), sweeps_of_les()})
    for (const ModelSweeps& model : family)
      if (model.name == name) return model;
  throw std::invalid_argument("flow: no turbulence model has the name \"" + std::string(name) + "\"");
}

}  // namespace spindrift::aero
