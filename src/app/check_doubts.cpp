// SPDX-License-Identifier: Apache-2.0
#include "src/app/check_doubts.hpp"

#include <fmt/format.h>

#include <exception>

#include "src/coupling/doubts.hpp"

namespace spindrift::app {

void print_doubts(scene::Doubts doubts, const scene::Doubts& more) {
  append(doubts, more);
  if (doubts.empty()) return;
  fmt::print("\nDoubts: possible, but it looks like a slip\n");
  for (const scene::Doubt& doubt : doubts) fmt::print("  warning: {}\n", text(doubt));
}

coupling::Start start_or_doubts(coupling::FloatingSystem& floating, const scene::Doubts& angles, bool prints) {
  try {
    return make_start(floating);
  } catch (const std::exception&) {  // refused, or not to be found
    if (prints) print_doubts(angles, coupling::doubts_as_described(floating));
    throw;
  }
}

}  // namespace spindrift::app
