// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/sweep_model.hpp"

#include <array>

namespace spindrift::aero {

#define MODEL(name) extern const Closure name;
#include "src/aero/flow/closures.inc"
#undef MODEL

scene::Models<Closure> closures() {
#define MODEL(name) &name,
  static const std::array all{
#include "src/aero/flow/closures.inc"
  };
#undef MODEL
  return scene::Models<Closure>(all);
}

const ModelSweeps& model_sweeps(std::string_view name) {
  static const ModelSweeps none;
  return name == "none" ? none : closures().named(name).sweeps;
}

}  // namespace spindrift::aero
