// The coupling schemes that a scene may choose. Each is a file, scheme_NAME.cpp, and a line in schemes.inc. The file has its
// name, what the reference says of it, the keys of [coupling] that it reads and either its staggering with the limit of its
// added mass or the object that iterates; the line names its enumerator. The mathematics is in kernels/coupling. Used by
// coupling_options.cpp, window.cpp, campbell.cpp and limits.cpp; tested in tests/src/coupling/window_test.cpp and
// tests/coupled/schemes_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace spindrift::scene {
template <class Model>
class Models;
}

namespace spindrift::coupling {

struct CouplingOptions;
struct Staggering;
class StrongScheme;

enum class SchemeKind {
  automatic,  ///< read_scenario puts the one it stands for
#define SCHEME(name) name,
#include "src/coupling/schemes.inc"
#undef SCHEME
};

/// Loose where it has a staggering, strong where it makes an object that iterates, monolithic where it has neither.
struct CouplingScheme {
  std::string_view name, help;
  std::vector<std::string> keys;
  Staggering (*staggering)(const CouplingOptions&) = nullptr;
  /// Of a loose scheme: the characteristic polynomial of its growth per window, by rising power, where the fluid's added mass is
  /// `ratio` of the structure's (kernels/coupling/loose_limits.hpp).
  std::vector<double> (*added_mass)(const CouplingOptions&, double ratio) = nullptr;
  std::string (*judged)(const CouplingOptions&) = nullptr;  ///< what check and messages call it
  std::unique_ptr<StrongScheme> (*strong)(const CouplingOptions&) = nullptr;
};

scene::Models<CouplingScheme> coupling_schemes();
/// Not of `automatic`.
const CouplingScheme& of(SchemeKind scheme);
bool is_loose(SchemeKind scheme);
bool is_strong(SchemeKind scheme);

/// Keys that all strong schemes read, and `more`.
std::vector<std::string> strong_keys(std::vector<std::string> more);

}  // namespace spindrift::coupling
