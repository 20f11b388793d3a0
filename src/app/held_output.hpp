// Standard output held back until it is known what to say above it. Used by `spindrift check`, whose verdict comes first.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdio>
#include <string>

namespace spindrift::app {

/// Whatever is printed in its life, in whichever function, waits for release(); without one it is printed at the end.
class HeldOutput {
 public:
  HeldOutput();
  ~HeldOutput() { release(""); }
  HeldOutput(const HeldOutput&) = delete;
  HeldOutput& operator=(const HeldOutput&) = delete;

  bool empty() const;
  /// Prints `first` and what was held.
  void release(const std::string& first);

 private:
  std::FILE* real_;
  char* text_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace spindrift::app
