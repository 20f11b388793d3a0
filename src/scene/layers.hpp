// How scenes compose: base files under the file that names them, overrides of the command line on top.
// The rules are those of docs/user/scenes.md. Called by src/scene/document.cpp and study.cpp; tested in
// tests/src/scene/layers_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "src/scene/document.hpp"
#include "src/scene/error.hpp"
#include "src/scene/value.hpp"

namespace spindrift::scene {

/// One step of a dotted key: `cylinders[1]` is {"cylinders", {1}}.
struct KeyStep {
  std::string name;
  std::vector<std::size_t> indices;
};
/// "bodies.platform.cylinders[1].diameter_m"; nothing where the text is not a key (overrides.cpp).
std::optional<std::vector<KeyStep>> parse_key(std::string_view text);

/// Puts `over` on `under`: tables key by key, everything else (lists of tables too) replaced as a whole.
void overlay(Value& under, Value over);

/// A scene as composed so far.
struct Layers {
  Value root;
  std::vector<Source> sources;
  std::vector<Problem> problems;  ///< those that need not stop the reading: bad overrides, keys of `without` that are not there
};

/// Takes `base` or `without` (a text or a list of texts) out of the top of a file. Throws SceneError for anything else.
std::vector<Value> take_texts(const Layers& layers, Value& root, std::string_view name);
/// Takes the key that the text `key` names out of `root`; a problem where it is not there.
void take_away(Layers& layers, Value& root, const Value& key);

/// Reads `path` and its bases. Throws SceneError where a text cannot be read at all.
void add_file(Layers& layers, const std::string& path);
/// The same from memory.
void add_text(Layers& layers, std::string_view text, const std::string& name, const std::string& directory);
/// Applies "a.b=c" overrides in their order, as from `source` (overrides.cpp).
void add_overrides(Layers& layers, const std::vector<std::string>& overrides, const Source& source);

}  // namespace spindrift::scene
