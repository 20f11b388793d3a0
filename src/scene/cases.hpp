// The models of a list as the values of a choice whose enum is made from the same list, in the same order. Used by the options of
// modules; tested through tests/src/aero/flow and tests/src/sea. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "src/scene/models.hpp"

namespace spindrift::scene {

/// Of those that `wanted` holds for; `first`: value of the first in the list.
template <class Options, class Enum, class Model, class Wanted>
auto cases(const Models<Model>& models, Wanted&& wanted, int first = 0) {
  std::vector<typename Section<Options>::template Case<Enum>> cases;
  int value = first;
  for (const Model* model : models) {
    if (wanted(*model)) cases.push_back({std::string(model->name), Enum(value), std::string(model->help)});
    ++value;
  }
  return cases;
}
template <class Options, class Enum, class Model>
auto cases(const Models<Model>& models, int first = 0) {
  return cases<Options, Enum>(
      models, [](const Model&) { return true; }, first);
}

}  // namespace spindrift::scene
