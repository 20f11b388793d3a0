// Text that must not reach toml++ 3.3.0: not UTF-8, characters that run into its undefined behaviour (its issue 190: 44 ef bb
// bb), nesting that would exhaust the stack it recurses on. All of it is either no TOML or no sensible scene. Called by
// src/scene/toml_reader.cpp; tested in tests/src/scene/document_test.cpp and by the fuzz target. SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace spindrift::scene {

struct Refusal {
  std::size_t offset;  ///< of the byte where it shows
  std::string why;
};

/// Why the text is refused, or nothing. Text that is not TOML is scanned rightly up to its first error, which is enough:
/// the parser stops there.
std::optional<Refusal> refuse(std::string_view text);

}  // namespace spindrift::scene
