// What is wrong with a scene, said to the person who wrote it: file, line, key, value, what is allowed.
// One of the four kinds of failure of docs/developer/errors.md; the program answers it with exit code 2.
// Thrown by src/scene/document.hpp; tested over tests/src/scene/malformed.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace spindrift::scene {

struct Problem {
  std::string source;   ///< the file as the user named it, or "command line"
  int line = 0;         ///< 0 where no line can be named (a missing section, the command line)
  std::string key;      ///< "bodies.platform.mass_kg"; empty where the file as a whole is meant
  std::string value;    ///< as written, shortened; empty where there is none
  std::string message;  ///< "must be > 0 kg (mass of the body)"
  /// A key whose value makes this a mistake: where that key has a problem itself, this is none. Empty: a mistake whatever else
  /// is.
  std::string follows_from = {};

  std::string text() const;  ///< "case1.toml:12: time.window_s = -0.1: must be > 0 and <= 1000 s (...)"
};

/// All problems of a scene at once, by file and line; what() is the readable list.
class SceneError : public std::runtime_error {
 public:
  explicit SceneError(std::vector<Problem> problems);
  const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

}  // namespace spindrift::scene
