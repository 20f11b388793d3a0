// What a step of the sea works on: particles, bodies, sensors, and the plan of its steps. Which sweeps work on it is not here
// (schemes.hpp), nor who moves its bodies (StepDriver).
// Called by tasks.cpp and sea_sph.cpp; tested through them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "src/sea/sph/boundary.hpp"
#include "src/sea/sph/contact.hpp"
#include "src/sea/sph/damping.hpp"
#include "src/sea/sph/energy_flow.hpp"
#include "src/sea/sph/ordering.hpp"
#include "src/sea/sph/parameters.hpp"
#include "src/sea/sph/sensors.hpp"
#include "src/sea/sph/solids.hpp"
#include "src/sea/sph/step_plan.hpp"
#include "src/sea/sph/subdomain.hpp"
#include "src/sea/sph/sweep_pairs.hpp"

namespace spindrift::sph {

/// Half a step, for the bodies.
struct HalfStep {
  int half;                         ///< 0: loads are those of `time`; 1: of the middle of the step
  double time, to;                  ///< begin of the step, and the time that the motions are wanted at [s]
  double dt;                        ///< of the whole step [s]
  std::span<const Touch> contacts;  ///< of bodies with walls and each other; not in the loads
};
/// Moves the bodies: `motions` hold where they are and are to be set to where they are at half.to; loads are about the centres of
/// mass as they are. In the order in which the bodies were added. Called by one task on every rank with the same numbers.
using MoveBodies = std::function<void(const HalfStep& half, std::span<const Wrench> loads, std::span<Motion> motions)>;

/// Who drives a window from outside: chooses its steps, moves its bodies.
struct StepDriver {
  StepControl steps;
  MoveBodies move_bodies = {};  ///< empty: bodies stay where they are placed
};

template <int dim, class Real>
struct SeaState {
  SeaState(const Parameters& parameters, const Domain<dim>& domain)
      : p(parameters), columns(domain, p.reach() + 2.0 * p.drift(), p.column_over_reach * (p.reach() + 2.0 * p.drift())) {}
  SeaState(const SeaState&) = delete;  // sweeps refer to it
  SeaState& operator=(const SeaState&) = delete;

  Parameters p;
  Columns<dim> columns;
  Subdomain subdomain;
  Store<dim, Real> store;
  std::vector<Solid> solids;
  Ghosts<dim> ghosts;                                           ///< of modified walls
  std::vector<BodyBox<dim>> free;                               ///< boxes round the free bodies
  double body_limit = std::numeric_limits<double>::infinity();  ///< on the step [s]
  std::vector<std::vector<Touch>> touches;                      ///< of each own group, at the last evaluation
  std::vector<Patch> patches;                                   ///< of sensors
  std::vector<PatchRecord> records;                             ///< what they read, by patch
  Damping damping;
  EnergyFlow energy;  ///< so far
  Plan plan;
  Work work;

  /// The particles have been sorted; too many lost ones are a failure.
  void sorted() {
    plan.sorted();
    ++work.sorts;
    if (store.lost.empty() || plan.failure) return;
    using Exit = typename Domain<dim>::Exit;
    const Gone gone = this->gone();
    const auto stop = [&](Exit by, std::size_t count, std::size_t limit, const std::string& how, const std::string& advice) {
      if (count <= limit || plan.failure) return;
      const auto last = std::find_if(store.lost.rbegin(), store.lost.rend(),
                                     [&](const auto& particle) { return columns.domain().exit_of(particle.position) == by; });
      std::string place = "(";
      for (int k = 0; k < dim; ++k) place += (k > 0 ? ", " : "") + in_words(last->position[k]);
      plan.failure =
          NumericalFailure("sea: " + std::to_string(count) + " particles " + how + " (allowed " + std::to_string(limit) +
                               "), the last one, " + std::to_string(last->id) + ", at " + place + ") m; " + advice,
                           "sea", plan.steps, plan.time, double(limit));
    };
    stop(Exit::lost, gone.lost, p.lost_at_most, "left the tank through its walls",
         "check that walls and obstacles are closed and bodies start clear of them, take a smaller sea.particles.cfl, or raise "
         "sea.particles.lost_at_most");
    stop(Exit::over_edge, gone.over_edge, p.left_at_most, "left over the upper edge of the tank's walls",
         "raise sea.tank.top_m, or let them go with sea.tank.over_edge = \"open\"");
  }
  /// Particles that are no more in the tank.
  struct Gone {
    std::size_t lost = 0, over_edge = 0, through_open_sides = 0;
  };
  Gone gone() const {
    Gone gone;
    for (const LostParticle<dim>& particle : store.lost) switch (columns.domain().exit_of(particle.position)) {
        case Domain<dim>::Exit::lost:
          ++gone.lost;
          break;
        case Domain<dim>::Exit::over_edge:
          ++gone.over_edge;
          break;
        case Domain<dim>::Exit::open_side:
          ++gone.through_open_sides;
          break;
      }
    return gone;
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
    plan.count_travel_of_body(solid.travel_to(motion));
    solid.motion = motion;
    follow(solid);
  }
};

}  // namespace spindrift::sph
