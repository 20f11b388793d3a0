// Outputs of a run, and the one rule by which they are due. Implemented in outputs.cpp and by the simulations; asked by
// driver.cpp after every window. Tested in tests/src/run/output_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>

#include "src/coupling/timeline.hpp"

namespace spindrift::run {

/// Windows completed since outputs were last taken: before < n <= now. The run is to end with `last`.
struct Windows {
  std::int64_t before, now, last;
};

/// Every so many windows, counted from window `origin` in both directions, from window `from` to `to`.
struct Every {
  std::int64_t windows = 0;  ///< 0: never
  std::int64_t origin = 0;
  std::int64_t from = std::numeric_limits<std::int64_t>::min();
  std::int64_t to = std::numeric_limits<std::int64_t>::max();

  /// The number of whole windows nearest to an interval of time, at least one; never for an interval of 0.
  static std::int64_t count(double interval_s, const coupling::Timeline& timeline) {
    return interval_s > 0.0 ? std::max<std::int64_t>(1, std::llround(interval_s / timeline.window_s())) : 0;
  }
  bool due(std::int64_t window) const {
    return windows > 0 && window >= from && window <= to && (window - origin) % windows == 0;
  }
  /// Whether any of the windows completed is.
  bool due(const Windows& done) const {
    for (std::int64_t n = done.now; n > done.before; --n)
      if (due(n)) return true;
    return false;
  }
};

/// All members are collective over the ranks of the run.
class Output {
 public:
  virtual ~Output() = default;
  /// Its time in the table of parts: "output/history".
  virtual std::string_view label() const = 0;
  /// The state that a run begins with, which is the end of `window`; not called after a restart.
  virtual void begin(std::int64_t /*window*/) {}
  /// The state that a restart begins with. Checkpoints come before files for people, and so may be there without them.
  virtual void resume(std::int64_t /*window*/) {}
  virtual bool due(const Windows& done) const = 0;
  /// @pre due(done); the simulation's state is that of the end of done.now. What takes long to write is copied, and handed on to
  /// Simulation::output(), which writes it beside the next window.
  virtual void take(const Windows& done) = 0;
  /// The run ends here, whatever the reason. As take(); what is handed on is written at once.
  virtual void finish(std::int64_t /*window*/) {}
};

}  // namespace spindrift::run
