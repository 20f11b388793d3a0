// The list of coupling schemes: see scheme.hpp. SPDX-License-Identifier: Apache-2.0
#include <array>

#include "src/coupling/scheme.hpp"
#include "src/scene/models.hpp"

namespace spindrift::coupling {

#define SCHEME(name) extern const CouplingScheme name##_scheme;
#include "src/coupling/schemes.inc"
#undef SCHEME

namespace {

#define SCHEME(name) &name##_scheme,
const std::array listed_schemes{
#include "src/coupling/schemes.inc"
};
#undef SCHEME

}  // namespace

scene::Models<CouplingScheme> coupling_schemes() { return scene::Models<CouplingScheme>(listed_schemes); }

const CouplingScheme& of(SchemeKind scheme) { return *listed_schemes.at(std::size_t(scheme) - 1); }  // after `automatic`

bool is_loose(SchemeKind scheme) { return scheme != SchemeKind::automatic && of(scheme).staggering != nullptr; }
bool is_strong(SchemeKind scheme) { return scheme != SchemeKind::automatic && of(scheme).strong != nullptr; }

std::vector<std::string> strong_keys(std::vector<std::string> more) {
  more.insert(more.end(), {"predictor_order", "tolerance", "max_evaluations", "max_cuts", "samples", "interpolation"});
  return more;
}

}  // namespace spindrift::coupling
