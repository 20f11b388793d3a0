// The sources of load of a floating system: which bodies each can load, and the time spent in it inside the right-hand side of
// the bodies. Filled by floating_system.cpp, sea_source.cpp, rotor_source.cpp; tested through tests/src/coupling.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "src/bodies/system.hpp"

namespace spindrift::coupling {

/// Which loads the sources are asked for. Those of a run are ramped and of the moment.
struct LoadsWanted {
  bool full = false;  ///< without the ramp of the start: for statics and stability
  bool mean = false;  ///< for statics: still water but for its current, no gusts or turbulence, the rotor's mean over a turn
};

/// By body of so many, true for `which`; the earth is passed over.
std::vector<bool> marked(std::size_t count, const std::vector<int>& which);

class LoadSources {
 public:
  LoadSources() = default;
  LoadSources(LoadSources&&) = delete;

  struct Clock {
    std::int64_t ns = 0, calls = 0;
  };

  /// `on`: by body, whether the source can load it at all.
  void add(bodies::LoadSource source, std::vector<bool> on);
  /// For the bodies, once; this is to outlive them.
  std::vector<bodies::LoadSource> take() { return std::move(sources_); }
  /// What cannot is not written.
  bool loads_body(std::size_t source, std::size_t body) const { return on_[source][body]; }
  void reset_clocks() { clocks.assign(clocks.size(), {}); }

  std::vector<Clock> clocks;  ///< by source, in the order of bodies::System::loads()

 private:
  std::vector<bodies::LoadSource> sources_;
  std::vector<std::vector<bool>> on_;  ///< [source][body]
};

}  // namespace spindrift::coupling
