// Tells a scene from the other files that a user has beside it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "kernels/base/failure.hpp"
#include "src/scene/document.hpp"
#include "src/scene/error.hpp"

namespace spindrift::app {

/// As scene::load; a study or a turbine file is refused with the command or the key that takes it.
scene::Document load_scene(const std::string& path, const std::vector<std::string>& overrides,
                           const scene::Source& overrider = scene::command_line());

/// What `make` makes of a scene; what it refuses by a key of the scene is refused by file and line.
template <class Make>
auto by_lines(const scene::Document& document, const Make& make) {
  try {
    return make();
  } catch (const scene::SceneError& late) { throw document.located(late); }
}

/// As by_lines. At t = 0, before anything moves, a state that the numerics cannot find, lines that come to no
/// rest, is refused by the section it is of.
template <class Make>
auto by_lines_at_rest(const scene::Document& document, const Make& make) {
  return by_lines(document, [&] {
    try {
      return make();
    } catch (const NumericalFailure& failure) {
      if (failure.time_s != 0.0) throw;
      throw scene::SceneError({{document.source(), 0, failure.place, "", failure.what()}});
    }
  });
}

/// Throws where `path` is a scene and no study.
void require_study(const std::string& path);

}  // namespace spindrift::app
