// Every scene key with type, unit, default, range and sentence, written from the declarations: inputs/REFERENCE.md and
// `spindrift reference`. Called by src/app with the list of all sections; tested in tests/src/scene/reference_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "src/scene/section.hpp"

namespace spindrift::scene {

/// A heading and a table of keys per section, as Markdown.
std::string reference_markdown(std::span<const SectionBase* const> sections);

/// Plain text for a terminal. `topic`: empty for everything, a section ("time", "bodies.NAME"), a key ("time.window_s") or
/// a key without its section ("window_s", every place that has it). Throws SceneError with a suggestion for an unknown one.
std::string reference_text(std::span<const SectionBase* const> sections, std::string_view topic = "");

}  // namespace spindrift::scene
