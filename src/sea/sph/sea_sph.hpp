// A sea of particles in one process: state, sorting, and the step over groups. A thin driver: each sweep is a function of one group.
// Method: docs/theory/sph.md. Called by tests and perf/sea, later by the sea module's tasks; tested in tests/src/sea/sph.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "kernels/sph/time_step.hpp"
#include "src/sea/sph/ordering.hpp"
#include "src/sea/sph/parameters.hpp"
#include "src/sea/sph/sweep_pairs.hpp"

namespace spindrift::sph {

/// Counters of a run, for reports and benchmarks.
struct Work {
  long steps = 0, evaluations = 0, sorts = 0;
  double sort_s = 0, pack_s = 0, pair_s = 0, correct_s = 0;
};

template <int dim, class Real = float>
class SeaSph {
 public:
  SeaSph(const Parameters& parameters, const Domain<dim>& domain, std::span<const Seed<dim>> seeds);

  /// One step no longer than dt_max [s]; returns its length.
  double step(double dt_max);
  /// Steps of equal right to the limits until exactly `duration` [s] later.
  void advance(double duration);
  /// Rates of the state at n, left in store().sums: what step() starts with.
  void evaluate();

  const Parameters& parameters() const { return p_; }
  const Columns<dim>& columns() const { return columns_; }
  const Store<dim, Real>& store() const { return store_; }
  Store<dim, Real>& store() { return store_; }
  const Work& work() const { return work_; }
  double time() const { return time_; }
  std::size_t particles() const { return particles_; }

 private:
  void sort_if_drifted();
  void pack_all(double half_dt);
  void sweep_all();

  Parameters p_;
  Columns<dim> columns_;
  Store<dim, Real> store_;
  std::function<void(int, Meetings<dim, Real>&)> sweep_;   // the pair sweep of one group, with the scene's schemes
  std::vector<std::vector<int>> colours_;                    // groups of each colour
  std::vector<Meetings<dim, Real>> scratch_;               // one per thread
  std::size_t particles_ = 0, candidates_at_most_ = 0;
  double time_ = 0.0, drift_ = 0.0, fastest_ = 0.0;
  Work work_;
};

}  // namespace spindrift::sph
