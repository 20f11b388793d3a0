// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/step_plan.hpp"

#include <algorithm>
#include <cmath>

namespace spindrift::sph {

bool Plan::sort_is_due(double drift) const {
  return std::max(this->drift + 2.0 * travel, solid_drift + 2.0 * solid_travel) > drift;
}

void Plan::sorted() {
  drift = solid_drift = travel = solid_travel = shifted = 0.0;
  sort = false;
}

void Plan::check_limits(const Parameters& p, double body_limit, double speed2, double acceleration2, double shifted) {
  speed = std::sqrt(speed2), acceleration = std::sqrt(acceleration2);
  this->shifted = shifted;
  drift += shifted;
  const auto kinematic = of(p.viscosity).kinematic;
  limits = step_limits(p.cfl, p.h(), p.eos.c0, speed, acceleration, kinematic != nullptr ? kinematic(p) : 0.0);
  limits.body = body_limit;
  limit = limits.smallest();
  constexpr double smallest_share = 1e-2;  // of the step of water at rest: speeds of 100 c0 are no flow
  if (!(limit > smallest_share * p.cfl * p.h() / p.eos.c0) && !failure)
    failure = NumericalFailure("sea: the stable step fell to " + in_words(limit) + " s, the limit is " +
                                   in_words(smallest_share * p.cfl * p.h() / p.eos.c0) + " s (largest speed " + in_words(speed) +
                                   " m/s, acceleration " + in_words(acceleration) +
                                   " m/s2); try a smaller sea.particles.cfl or more viscosity",
                               "sea", steps, time, limit);
}

namespace {

/// Over the steps a particle goes at most (|v| + T |a|) T; the half steps' acceleration may be larger, hence the factor two.
double farthest(double duration, double speed, double acceleration) { return duration * (speed + 2.0 * duration * acceleration); }

}  // namespace

int Plan::steps_within(double drift, int most) const {
  int count = most;
  while (count > 1 && this->drift + shifted + farthest(count * limit, speed, acceleration) > drift) --count;
  return count;
}

void Plan::start_steps(double dt, int count, double last_dt) {
  this->dt = dt, this->last_dt = last_dt, planned = count;
  travel = farthest(dt * (count - 1) + last_dt, speed, acceleration) + shifted;
  drift += travel - shifted;
  solid_travel = 0.0;
}

void Plan::choose_steps(const StepControl& control, double drift) {
  if (ended()) return void(planned = 0);
  const int most = steps_within(drift, control.steps_per_check);
  if (control.choose) {
    try {
      const StepControl::Choice choice = control.choose(limit, most);
      last = choice.last;
      start_steps(choice.dt, choice.count, choice.last_dt);
    } catch (const NumericalFailure& refused) { failure = refused, planned = 0; }
  } else if (control.dt > 0.0) {
    if (control.dt > limit * (1.0 + 1e-12))
      failure =
          NumericalFailure("sea: the fixed step of " + in_words(control.dt) + " s is beyond the limit of " + in_words(limit) +
                               " s (largest speed " + in_words(speed) + " m/s, acceleration " + in_words(acceleration) + " m/s2)",
                           "sea", steps, time, limit);
    const double steps_left = std::round(left / control.dt);
    start_steps(control.dt, failure ? 0 : int(std::min<double>(most, steps_left)));
  } else if (control.steps_per_check == 1) {
    start_steps(std::min(limit, left), 1);
  } else {
    const double step = share_between_checks * limit, count = std::ceil(left / step);
    const bool ends = count <= most;
    start_steps(ends ? left / count : step, ends ? int(count) : most);
  }
}

void Plan::finish_steps(const StepControl& control, StepChoice step, Work& work) {
  const bool ends = control.choose     ? last
                    : control.dt > 0.0 ? std::round(left / control.dt) <= planned
                                       : dt * planned >= left * (1.0 - 1e-12);
  for (int n = 0; n < planned; ++n) time += dt_of(n);
  steps += planned, work.steps = steps;
  work.evaluations += planned * (step == StepChoice::symplectic ? 2 : 1);
  if (planned > 1) shifted *= planned;  // what one of them did at most, so far
  if (ends || ended())
    left = 0.0;
  else if (!control.choose)  // who chooses steps knows what is left
    left -= dt * planned;
}

}  // namespace spindrift::sph
