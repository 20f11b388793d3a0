// The readers of files beside scenes, each with a small valid file: for damage_test.cpp and the fuzz target.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace spindrift::testing {

struct Reader {
  std::string name;
  bool text = true;                                   ///< lines of words; else bytes
  std::function<void(const std::string& file)> read;  ///< throws as the reader does
  std::function<void(const std::string& file)> write_seed;
  bool titled = false;  ///< the first line may be words
  std::string ending;   ///< of the file's name, where that says its form
};

const std::vector<Reader>& readers();

}  // namespace spindrift::testing
