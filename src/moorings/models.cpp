// The list of line models: see model.hpp. SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "kernels/base/assert.hpp"
#include "src/moorings/model.hpp"

namespace spindrift::moorings {

#define MODEL(name) extern const LineModel name;
#include "src/moorings/models.inc"
#undef MODEL

namespace {

#define MODEL(name) &name,
const std::array models{
#include "src/moorings/models.inc"
};
#undef MODEL

}  // namespace

std::span<const LineModel* const> line_models() { return models; }

const LineModel& line_model(std::string_view name) {
  const auto found = std::ranges::find(models, name, &LineModel::name);
  SPINDRIFT_ASSERT(found != models.end(), "a line of an unknown model");
  return **found;
}

std::vector<std::string> line_models_with(std::string_view key) {
  std::vector<std::string> names;
  for (const LineModel* model : models)
    if (std::ranges::find(model->keys, key) != model->keys.end()) names.emplace_back(model->name);
  return names;
}

}  // namespace spindrift::moorings
