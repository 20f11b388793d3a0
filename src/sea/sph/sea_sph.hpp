// A sea of particles in one process: state, sorting, and the step over groups. A thin driver: each sweep is a function of one
// group. Method: docs/theory/sph.md. Called by tests and perf/sea, later by the sea module's tasks; tested in tests/src/sea/sph.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "kernels/sph/time_step.hpp"
#include "src/sea/sph/boundary.hpp"
#include "src/sea/sph/contact.hpp"
#include "src/sea/sph/ordering.hpp"
#include "src/sea/sph/parameters.hpp"
#include "src/sea/sph/solids.hpp"
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
  SeaSph(const SeaSph&) = delete;  // its sweeps refer to its store
  SeaSph& operator=(const SeaSph&) = delete;

  /// One step no longer than dt_max [s]; returns its length. Solids stay; with moving ones use the three parts.
  double step(double dt_max);
  /// Steps up to exactly `duration` [s] later.
  void advance(double duration);

  // A step in three parts, between which moving solids are placed: at n + 1/2 before half_step, at n + 1 after it and before
  // end_step. Loads are those of the last evaluation: n after begin_step, n + 1/2 after half_step. With Verlet's step half_step
  // does nothing.
  double begin_step(double dt_max);
  void half_step();
  void end_step();

  /// Rates of the state at n, left in store().sums: what begin_step starts with.
  void evaluate();

  /// Declares that the particles of `owner` are a body that is now in `motion`. A body with a mass [kg] (per metre of width in
  /// 2-D) is free: it bounds the step and touches walls and other bodies; one without is driven, and only touched.
  void add_body(std::uint16_t owner, const Motion& motion, double mass = 0.0);
  void place_body(std::uint16_t owner, const Motion& motion);
  /// Force of the water on the particles of an owner (a body or a wall), about a point.
  Wrench load_on(std::uint16_t owner, const Eigen::Vector3d& about) const { return load(store_, owner, p_.mass(dim), about); }

  /// Contact forces at the last evaluation, each with the two owners it acts between; none of them is in load_on.
  const std::vector<Touch>& contacts() const { return contacts_; }
  /// Contact force on an owner, of all others or of one, about a point.
  Wrench contact_on(std::uint16_t owner, const Eigen::Vector3d& about, int of = -1) const;
  /// What bounded the last step: acoustic, force, viscous or light body.
  const StepLimits& limits() const { return limits_; }

  const Parameters& parameters() const { return p_; }
  const Columns<dim>& columns() const { return columns_; }
  const Store<dim, Real>& store() const { return store_; }
  Store<dim, Real>& store() { return store_; }
  const Work& work() const { return work_; }
  double time() const { return time_; }
  std::size_t particles() const { return particles_; }

 private:
  using Sweep = std::function<void(Real* sums, int group, Meetings<dim, Real>&)>;

  void sort_if_drifted();
  void prepare(double half_dt);  // packs, sets modified walls
  void evaluate_packed();
  void reserve_scratch();
  void run(const Sweep& sweep, Array<Real>& sums);
  template <class Body>
  void for_groups(double& seconds, Body&& body);
  void filter_if_due();

  Parameters p_;
  Columns<dim> columns_;
  Store<dim, Real> store_;
  std::vector<Solid> solids_;
  std::vector<Motion> built_;       // of each solid when it was added
  std::vector<BodyBox<dim>> free_;  // boxes round the free bodies
  double body_limit_;               // on the step [s]
  StepLimits limits_{};
  std::vector<Touch> contacts_;
  Ghosts<dim> ghosts_;
  std::function<void(Store<dim, Real>&, int, Candidates<dim, Real>&)> boundary_;  // empty where no wall has a ghost node
  Sweep rates_, strain_, filter_, shifting_;  // pair sweeps of one group with the scene's schemes; empty where there is none
  Array<Real> extra_sums_;                    // of filters and shifting
  std::vector<std::vector<int>> colours_;     // groups of each colour
  std::vector<Meetings<dim, Real>> scratch_;  // one per thread
  std::size_t particles_ = 0;
  double time_ = 0.0, dt_ = 0.0;
  double drift_ = 0.0, solid_drift_ = 0.0;  // bounds on the way since the last sort [m]
  Work work_;
};

}  // namespace spindrift::sph
