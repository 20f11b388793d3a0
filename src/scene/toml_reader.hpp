// TOML text to a tree of values with lines: the only place that includes toml++ 3.3.0, and what protects it from bad bytes.
// Called by src/scene/layers.cpp; tested in tests/src/scene/document_test.cpp and fuzzed by
// tests/src/scene/fuzz_scene_reader.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "src/scene/value.hpp"

namespace spindrift::scene {

/// Parses `text`; every value is marked with `source` and its line. Throws SceneError (one problem: TOML ends at its
/// first error) naming the text `name`.
Value read_toml(std::string_view text, int source, const std::string& name);

}  // namespace spindrift::scene
