// What a step of the sea works on, and the few numbers that steer it. All ranks have the same `Plan`: it is computed from global
// extremes and sums only.
// Called by tasks.cpp and sea_sph.cpp; tested through them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kernels/base/failure.hpp"
#include "kernels/sph/time_step.hpp"
#include "src/sea/sph/boundary.hpp"
#include "src/sea/sph/contact.hpp"
#include "src/sea/sph/ordering.hpp"
#include "src/sea/sph/parameters.hpp"
#include "src/sea/sph/sensors.hpp"
#include "src/sea/sph/solids.hpp"
#include "src/sea/sph/subdomain.hpp"
#include "src/sea/sph/sweep_pairs.hpp"

namespace spindrift::sph {

/// A number as messages have it.
inline std::string in_words(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// Counters of a run, for reports and benchmarks.
struct Work {
  long steps = 0, evaluations = 0, sorts = 0;
};

/// How the steps of a window are chosen.
struct StepControl {
  double dt = 0.0;  ///< a fixed step [s]; 0: as the limits allow
  /// Steps between two looks at the limits (and sorts). 1: before each, with a reduction over all ranks in each step.
  int steps_per_check = 1;
  /// A step chosen by who counts time himself, and whether the window ends with it.
  struct Choice {
    double dt;
    bool last;
  };
  /// With steps_per_check 1: asked before each step for one not above the limit [s], on all ranks alike; may throw
  /// NumericalFailure.
  std::function<Choice(double limit)> choose = {};
};

/// Half a step as bodies see it.
struct HalfStep {
  int half;                         ///< 0: loads are those of `time`; 1: of the middle of the step
  double time, to;                  ///< begin of the step, and the time that the motions are wanted at [s]
  double dt;                        ///< of the whole step [s]
  std::span<const Touch> contacts;  ///< of bodies with walls and each other; not in the loads
};
/// Moves the bodies: `motions` hold where they are and are to be set to where they are at half.to; loads are about the centres of
/// mass as they are. In the order in which the bodies were added. Called by one task on every rank with the same numbers.
using MoveBodies = std::function<void(const HalfStep& half, std::span<const Wrench> loads, std::span<Motion> motions)>;

/// Where the run stands.
struct Plan {
  double time = 0.0;
  long steps = 0;
  double left = 0.0;                                    ///< of the window [s]
  double dt = 0.0;                                      ///< of the steps planned [s]
  int planned = 0;                                      ///< steps until the next check of the limits
  double speed = 0.0, acceleration = 0.0, limit = 0.0;  ///< largest at the last check of the limits, and what they allow [s]
  StepLimits limits{};
  double drift = 0.0, solid_drift = 0.0;  ///< bounds on the way since the last sort [m]
  double way = 0.0, solid_way = 0.0;      ///< and since the last check of the limits
  double shifted = 0.0;                   ///< largest way by shifting since the last check of the limits
  double solid_path = 0.0;                ///< of bodies in all [m]
  bool sort = false;
  bool last = false;                        ///< the step planned ends the window (StepControl::choose)
  std::optional<NumericalFailure> failure;  ///< set where the numerics gave up; what is left of the window does nothing
  bool stopped = false;                     ///< the run was asked to stop: likewise
  bool ended() const { return failure || stopped; }
};

template <int dim, class Real>
struct SeaState {
  SeaState(const Parameters& parameters, const Domain<dim>& domain)
      : p(parameters), columns(domain, p.reach() + 2.0 * p.drift(), p.column_over_reach * (p.reach() + 2.0 * p.drift())) {}
  SeaState(const SeaState&) = delete;  // sweeps refer to it
  SeaState& operator=(const SeaState&) = delete;

  using Sweep = std::function<void(Real* sums, int group, NeighbourLists<dim, Real>&)>;

  Parameters p;
  Columns<dim> columns;
  Subdomain subdomain;
  Store<dim, Real> store;
  std::vector<Solid> solids;
  Ghosts<dim> ghosts;                                           ///< of modified walls
  std::vector<BodyBox<dim>> free;                               ///< boxes round the free bodies
  double body_limit = std::numeric_limits<double>::infinity();  ///< on the step [s]
  Sweep rates, strain, filter, shifting;  ///< pair sweeps of one group with the scene's schemes; empty where there is none
  std::function<void(Store<dim, Real>&, int group, Candidates<dim, Real>&)> boundary;  ///< empty without ghost nodes
  std::vector<std::vector<Touch>> touches;  ///< of each own group, at the last evaluation
  std::vector<Patch> patches;               ///< of sensors
  std::vector<PatchRecord> records;         ///< what they read, by patch
  MoveBodies move_bodies;
  std::function<void(int group, double dt)> after_step;  ///< what else a step does to the particles of a group (damping zones)
  StepControl step_control;
  Plan plan;
  Work work;

  /// Whether to sort before the next steps: they may go twice as far as those before.
  bool sort_is_due() const { return std::max(plan.drift + 2.0 * plan.way, plan.solid_drift + 2.0 * plan.solid_way) > p.drift(); }
  void sorted() {
    plan.drift = plan.solid_drift = plan.way = plan.solid_way = 0.0;  // what follows depends on the particles alone
    plan.sort = false;
    ++work.sorts;
    if (store.lost.empty() || plan.failure) return;
    using Way = typename Domain<dim>::Way;
    const Gone gone = this->gone();
    const auto stop = [&](Way way, std::size_t count, std::size_t limit, const std::string& how, const std::string& advice) {
      if (count <= limit || plan.failure) return;
      const auto last = std::find_if(store.lost.rbegin(), store.lost.rend(),
                                     [&](const auto& particle) { return columns.domain().way_out(particle.position) == way; });
      std::string place = "(";
      for (int k = 0; k < dim; ++k) place += (k > 0 ? ", " : "") + in_words(last->position[k]);
      plan.failure =
          NumericalFailure("sea: " + std::to_string(count) + " particles " + how + " (allowed " + std::to_string(limit) +
                               "), the last one, " + std::to_string(last->id) + ", at " + place + ") m; " + advice,
                           "sea", plan.steps, plan.time, double(limit));
    };
    stop(Way::lost, gone.lost, p.lost_at_most, "left the tank through its walls",
         "check that walls and obstacles are closed and bodies start clear of them, take a smaller sea.particles.cfl, or raise "
         "sea.particles.lost_at_most");
    stop(Way::over_edge, gone.over_edge, p.left_at_most, "left over the upper edge of the tank's walls",
         "raise sea.tank.top_m, or let them go with sea.tank.over_edge = \"open\"");
  }
  /// Particles that are no more in the tank.
  struct Gone {
    std::size_t lost = 0, over_edge = 0, through_open_sides = 0;
  };
  Gone gone() const {
    Gone gone;
    for (const LostParticle<dim>& particle : store.lost) switch (columns.domain().way_out(particle.position)) {
        case Domain<dim>::Way::lost:
          ++gone.lost;
          break;
        case Domain<dim>::Way::over_edge:
          ++gone.over_edge;
          break;
        case Domain<dim>::Way::open_side:
          ++gone.through_open_sides;
          break;
      }
    return gone;
  }
  /// Takes in the extremes of the state at n.
  void check_limits(double speed2, double acceleration2, double shifted) {
    plan.speed = std::sqrt(speed2), plan.acceleration = std::sqrt(acceleration2);
    plan.shifted = shifted;
    plan.drift += shifted;
    const auto kinematic = of(p.viscosity).kinematic;
    plan.limits = step_limits(p.cfl, p.h(), p.eos.c0, plan.speed, plan.acceleration, kinematic != nullptr ? kinematic(p) : 0.0);
    plan.limits.body = body_limit;
    plan.limit = plan.limits.smallest();
    constexpr double smallest_share = 1e-2;  // of the step of water at rest: speeds of 100 c0 are no flow
    if (!(plan.limit > smallest_share * p.cfl * p.h() / p.eos.c0) && !plan.failure)
      plan.failure = NumericalFailure("sea: the stable step fell to " + in_words(plan.limit) + " s, the limit is " +
                                          in_words(smallest_share * p.cfl * p.h() / p.eos.c0) + " s (largest speed " +
                                          in_words(plan.speed) + " m/s, acceleration " + in_words(plan.acceleration) +
                                          " m/s2); try a smaller sea.particles.cfl or more viscosity",
                                      "sea", plan.steps, plan.time, plan.limit);
  }
  void start_steps(double dt, int count) {
    plan.dt = dt, plan.planned = count;
    // Over the steps a particle goes at most (|v| + T |a|) T; the half steps' acceleration may be larger, hence the factor two.
    const double duration = dt * count;
    plan.way = duration * (plan.speed + 2.0 * duration * plan.acceleration) + plan.shifted;
    plan.drift += plan.way - plan.shifted;
    plan.solid_way = 0.0;
  }
  /// Chooses the next steps of a window.
  void choose_steps() {
    if (plan.ended()) return void(plan.planned = 0);
    if (step_control.choose) {
      try {
        const StepControl::Choice choice = step_control.choose(plan.limit);
        plan.last = choice.last;
        start_steps(choice.dt, 1);
      } catch (const NumericalFailure& failure) { plan.failure = failure, plan.planned = 0; }
    } else if (step_control.dt > 0.0) {
      if (step_control.dt > plan.limit * (1.0 + 1e-12))
        plan.failure = NumericalFailure("sea: the fixed step of " + in_words(step_control.dt) + " s is beyond the limit of " +
                                            in_words(plan.limit) + " s (largest speed " + in_words(plan.speed) +
                                            " m/s, acceleration " + in_words(plan.acceleration) + " m/s2)",
                                        "sea", plan.steps, plan.time, plan.limit);
      const double steps_left = std::round(plan.left / step_control.dt);
      start_steps(step_control.dt, plan.failure ? 0 : int(std::min<double>(step_control.steps_per_check, steps_left)));
    } else if (step_control.steps_per_check == 1) {
      start_steps(std::min(plan.limit, plan.left), 1);
    } else {
      constexpr double margin = 0.9;  // the limits may tighten before the next check of the limits
      const double count = std::ceil(plan.left / (margin * plan.limit));
      const bool last = count <= step_control.steps_per_check;
      start_steps(last ? plan.left / count : margin * plan.limit, last ? int(count) : step_control.steps_per_check);
    }
  }
  void finish_steps() {
    const bool last = step_control.choose     ? plan.last
                      : step_control.dt > 0.0 ? std::round(plan.left / step_control.dt) <= plan.planned
                                              : plan.dt * plan.planned >= plan.left * (1.0 - 1e-12);
    for (int n = 0; n < plan.planned; ++n) plan.time += plan.dt;
    plan.steps += plan.planned, work.steps = plan.steps;
    work.evaluations += plan.planned * (p.step == StepChoice::symplectic ? 2 : 1);
    plan.left = last || plan.ended() ? 0.0 : plan.left - plan.dt * plan.planned;
  }
  /// What goes with a body beside its particles: the box round it, and the ghost nodes of its surface.
  void follow(const Solid& solid) {
    for (BodyBox<dim>& box : free)
      if (box.owner == solid.owner) box = box_of<dim>(solid, solid.motion);
    if (!ghosts.empty()) ghosts.turn(solid, solid.motion.attitude * solid.built.conjugate());
  }
  bool has_contacts() const { return p.contact && !free.empty(); }
  /// Notes where a body is now; placing its particles is for each group.
  void set_motion(Solid& solid, const Motion& motion) {
    const double way = solid.way_to(motion);
    plan.solid_drift += way, plan.solid_way += way, plan.solid_path += way;
    solid.motion = motion;
    follow(solid);
  }
};

/// Sets the sweeps of the scene's schemes, and the planes of sums that they need (schemes.cpp, which alone takes long to
/// compile).
template <int dim, class Real>
void set_schemes(SeaState<dim, Real>& sea);

}  // namespace spindrift::sph
