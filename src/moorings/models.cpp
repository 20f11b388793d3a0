// The list of line models: see model.hpp. SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

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

TautLine taut_from_sag(double length, double weight, double stiffness) {
  // A taut line of weight W under the pull T is W^2 L / (24 T^2) shorter than straight; that gives it the stiffness
  // 12 T^3 / (W^2 L) (Irvine 1981, chapter 2).
  constexpr double share = 0.01;
  const double pull = std::cbrt(share * stiffness * weight * weight * length / 12.0);
  const double sag = pull > 0.0 ? weight * weight * length / (24.0 * pull * pull) : 0.0;
  return {std::max(length - sag, 0.0), stiffness, 0.0};
}

scene::Models<LineModel> line_models() { return scene::Models<LineModel>(models); }

}  // namespace spindrift::moorings
