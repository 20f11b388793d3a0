// Options back to TOML text: the value of one parameter, in the unit of its key, that reads back to the same bits.
// Used by the echo, the reference and conditions; tested in tests/src/scene/echo_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "src/scene/section.hpp"
#include "src/scene/value.hpp"

namespace spindrift::scene {

/// TOML text of the parameter's value in `options`: "150.0", "[1.0, 2.0]", "\"morison\"". Empty for nested tables, absent
/// optionals and paths that are not given.
std::string printed(const Parameter& parameter, const void* options);
/// The same as conditions name it: texts without quotes.
std::string plain_value(const Parameter& parameter, const void* options);

bool holds(const SectionBase& section, const Condition& condition, const void* options);
/// Do all conditions of the parameter hold in `options`?
bool has_effect(const SectionBase& section, const Parameter& parameter, const void* options);

/// Value in the unit of the key, of which `scale` times gives x back bit for bit (shortest such decimal nearby).
double to_key_unit(double x, double scale);

/// The section as TOML under [heading], every default spelled out; `given` is what the scene said, null for nothing.
/// Keys without effect, absent optionals and alternatives not chosen are left out.
std::string rendered(const SectionBase& section, const std::string& heading, const void* options, const Value* given);

}  // namespace spindrift::scene
