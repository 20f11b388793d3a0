// The list of line models: see model.hpp. SPDX-License-Identifier: Apache-2.0
#include <array>

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

scene::Models<LineModel> line_models() { return scene::Models<LineModel>(models); }

}  // namespace spindrift::moorings
