// A number as messages have it. Used by kernels/rigid and src/sea; tested in tests/kernels/base/in_words_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <string>

namespace spindrift {

inline std::string in_words(double value, int digits = 3) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

}  // namespace spindrift
