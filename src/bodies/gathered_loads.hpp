// What all sources of load give at one state, and the memory that those which have one keep in it. Used by system.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "src/bodies/model.hpp"
#include "src/bodies/state.hpp"

namespace spindrift::bodies {

/// Loads of all sources on all bodies, about their centres of mass; without what added mass takes.
class GatheredLoads {
 public:
  /// The sources outlive it.
  GatheredLoads(std::span<const LoadSource> sources, std::size_t bodies);

  void gather(double t, std::span<const Motion> motions);

  const std::vector<Wrench>& total() const { return total_; }
  const std::vector<std::vector<Wrench>>& by_source() const { return by_source_; }  ///< [source][body]
  const std::vector<double>& power() const { return power_; }                       ///< of each source [W]

 private:
  std::span<const LoadSource> sources_;
  std::vector<Wrench> total_;
  std::vector<std::vector<Wrench>> by_source_;
  std::vector<double> power_;
};

/// Hands each source its part of the memory in a state.
class LoadMemory {
 public:
  /// The sources outlive it.
  explicit LoadMemory(std::span<const LoadSource> sources);

  void begin(double t, BodiesState& state) const;
  /// To all of them nothing where `memory` is empty: their loads are the steady ones.
  void recall(std::span<const double> memory) const;
  /// @pre the sources recall the memory of t - h; `state` is that of t but for its memory.
  void remember(double t, double h, BodiesState& state) const;

 private:
  std::span<const LoadSource> sources_;
  std::size_t size_ = 0;
};

/// The work of the loads in one step [J], divided by its length: by source, then by EnergyBalance.
struct StepWork {
  explicit StepWork(std::size_t sources) : work(sources + EnergyBalance::count, 0.0) {}
  void clear();
  /// Adds the powers [W] at one evaluation, which is so much of the step; gain: of the kinetic energy.
  void add(double weight, std::span<const double> of_sources, double of_added_mass, double gain);

  std::vector<double> work;
  double kinetic_gain = 0.0;
};

}  // namespace spindrift::bodies
