// A doubt about a scene: what it says is possible, and looks like a slip of unit, sign or place. Doubts are warnings: `check` and
// `run` print them and go on. Rules are plain functions of options, in doubts.cpp of each module, with the source of their bound;
// tested by the blunders of tests/extremes/blunders.toml, none on the scenes of inputs. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace spindrift::scene {

struct Doubt {
  std::string key;     ///< of the scene: "moorings.line_1.rest_length_m"
  std::string what;    ///< what is there, with its value
  std::string rule;    ///< what is usual, with its bound
  std::string advice;  ///< what to look at
};
using Doubts = std::vector<Doubt>;

inline void append(Doubts& to, const Doubts& more) { to.insert(to.end(), more.begin(), more.end()); }

/// "moorings.a.rest_length_m: 302 m for ends 863 m apart; usual is 0.95 to 1.3 of the distance: look at the length and its unit".
inline std::string text(const Doubt& doubt) {
  return doubt.key + ": " + doubt.what + "; usual is " + doubt.rule + ": " + doubt.advice;
}

}  // namespace spindrift::scene
