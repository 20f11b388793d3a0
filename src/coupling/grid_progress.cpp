// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/grid_progress.hpp"

#include <spdlog/spdlog.h>

#include <chrono>
#include <memory>
#include <string>

#include "src/io/progress.hpp"

namespace spindrift::coupling {

namespace {

double steady_seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

struct Stage {
  std::string what;
  double began, said;
};

}  // namespace

aero::GridProgress grid_progress(std::function<double()> clock) {
  if (!clock) clock = steady_seconds;
  auto now = std::make_shared<Stage>(Stage{"", clock(), clock()});
  return [clock, now](std::string_view what, double share) {
    constexpr double every_s = 10.0;
    const double time = clock();
    if (now->what != what) now->what = what, now->began = time;
    if (time - now->said < every_s) return;
    now->said = time;
    const double spent = time - now->began;
    if (share > 0.0 && spent > 0.0)
      spdlog::info("air: {}, {:.0f} % made, about {} left", what, 100.0 * share, io::duration_text(spent * (1.0 / share - 1.0)));
    else
      spdlog::info("air: {}", what);
  };
}

}  // namespace spindrift::coupling
