// SPDX-License-Identifier: Apache-2.0
#include "src/bodies/gathered_loads.hpp"

#include <algorithm>

namespace spindrift::bodies {

GatheredLoads::GatheredLoads(std::span<const LoadSource> sources, std::size_t bodies)
    : sources_(sources), total_(bodies), by_source_(sources.size(), std::vector<Wrench>(bodies)), power_(sources.size(), 0.0) {}

void GatheredLoads::gather(double t, std::span<const Motion> motions) {
  const auto clear = [&](std::vector<Wrench>& on) {
    for (std::size_t b = 0; b < motions.size(); ++b)
      on[b] = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), motions[b].position};
  };
  clear(total_);
  for (std::size_t s = 0; s < sources_.size(); ++s) {
    std::vector<Wrench>& on = by_source_[s];
    clear(on);
    if (!sources_[s].loads) continue;
    sources_[s].loads(t, motions, on);
    power_[s] = 0.0;
    for (std::size_t b = 0; b < motions.size(); ++b)
      power_[s] += on[b].force.dot(motions[b].velocity) + on[b].moment.dot(motions[b].omega_earth());
    for (std::size_t b = 0; b < motions.size(); ++b) total_[b].force += on[b].force, total_[b].moment += on[b].moment;
  }
}

LoadMemory::LoadMemory(std::span<const LoadSource> sources) : sources_(sources) {
  for (const LoadSource& source : sources)
    if (source.memory) size_ += source.memory->size;
}

void LoadMemory::begin(double t, BodiesState& state) const {
  state.memory.assign(size_, 0.0);
  std::size_t first = 0;
  for (const LoadSource& source : sources_) {
    if (!source.memory) continue;
    source.memory->begin(t, state.motions, std::span(state.memory).subspan(first, source.memory->size));
    first += source.memory->size;
  }
}

void LoadMemory::recall(std::span<const double> memory) const {
  std::size_t first = 0;
  for (const LoadSource& source : sources_) {
    if (!source.memory) continue;
    source.memory->recall(memory.empty() ? memory : memory.subspan(first, source.memory->size));
    first += source.memory->size;
  }
}

void LoadMemory::remember(double t, double h, BodiesState& state) const {
  if (state.memory.empty()) return;
  std::size_t first = 0;
  for (const LoadSource& source : sources_) {
    if (!source.memory) continue;
    source.memory->remember(t, h, state.motions, std::span(state.memory).subspan(first, source.memory->size));
    first += source.memory->size;
  }
}

void StepWork::clear() {
  std::ranges::fill(work, 0.0);
  kinetic_gain = 0.0;
}

void StepWork::add(double weight, std::span<const double> of_sources, double of_added_mass, double gain) {
  double sum = 0.0;
  for (std::size_t s = 0; s < of_sources.size(); ++s) work[s] += weight * of_sources[s], sum += of_sources[s];
  const auto after_sources = std::span(work).subspan(of_sources.size());
  after_sources[EnergyBalance::added_mass] += weight * of_added_mass;
  after_sources[EnergyBalance::joints] += weight * (gain - sum - of_added_mass);
  kinetic_gain += weight * gain;
}

}  // namespace spindrift::bodies
