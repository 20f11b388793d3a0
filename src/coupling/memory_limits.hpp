// Whether a scene fits into the computer's memory: counted in double precision from its keys, before any of it is made.
// Called by `run` and `check` before all else; what is counted is the least that a scene takes, so that nothing that fits is
// refused. Tested in tests/src/coupling/memory_limits_test.cpp and by the malformed scenes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "src/coupling/scenario.hpp"

namespace spindrift::coupling {

/// A part of a scene that grows with a key.
struct Demand {
  std::string key, value;  ///< that would mend it
  std::string things;      ///< "particles"
  double count = 0.0, bytes = 0.0;
  std::string that_fits;  ///< a value of the key that would do
  double most = 1e12;     ///< that can be told apart, whatever the memory
};

/// What the scene takes at least, and what would fit into so much.
std::vector<Demand> demands_of(const Scenario& scenario, double memory_bytes);
/// Throws scene::SceneError where a part is beyond `memory_bytes` or has more things than can be counted: key, count, bytes, and
/// the value that would fit.
void require_memory(const Scenario& scenario, double memory_bytes);

/// What this process may use of this computer [bytes]: its memory, or the limit of its control group.
double machine_memory();

}  // namespace spindrift::coupling
