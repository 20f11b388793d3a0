// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/load_sources.hpp"

#include "runtime/trace/clock.hpp"

namespace spindrift::coupling {

std::vector<bool> marked(std::size_t count, const std::vector<int>& which) {
  std::vector<bool> all(count);
  for (const int body : which)
    if (body != bodies::earth) all[std::size_t(body)] = true;
  return all;
}

/// Wraps the source so that its time is counted; two readings of the clock, 16 ns, per evaluation.
void LoadSources::add(bodies::LoadSource source, std::vector<bool> on) {
  const std::size_t index = sources_.size();
  const auto clocked = [this, index](auto inner) {
    return [this, index, inner](double t, auto motions, auto out) {
      const std::int64_t begin = runtime::Clock::now_ns();
      inner(t, motions, out);
      clocks[index].ns += runtime::Clock::now_ns() - begin;
      ++clocks[index].calls;
    };
  };
  source.loads = clocked(source.loads);
  if (source.added_mass) source.added_mass = clocked(source.added_mass);
  if (source.memory)
    source.memory->remember = [this, index, inner = source.memory->remember](double t, double h, auto motions, auto memory) {
      const std::int64_t begin = runtime::Clock::now_ns();
      inner(t, h, motions, memory);
      clocks[index].ns += runtime::Clock::now_ns() - begin;
    };
  sources_.push_back(std::move(source)), on_.push_back(std::move(on)), clocks.emplace_back();
}

}  // namespace spindrift::coupling
