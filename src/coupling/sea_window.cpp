// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/sea_window.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/trace/clock.hpp"

namespace spindrift::coupling {

namespace {

/// Adds the time of its life to the source "sea".
class SeaClock {
 public:
  explicit SeaClock(Machine& machine) : machine_(machine), begin_(runtime::Clock::now_ns()) {}
  ~SeaClock() { machine_.count_sea(runtime::Clock::now_ns() - begin_, 0); }
  SeaClock(const SeaClock&) = delete;
  SeaClock& operator=(const SeaClock&) = delete;

 private:
  Machine& machine_;
  std::int64_t begin_;
};

/// Bodies that are held do not move.
std::vector<Motion> at_rest(std::vector<Motion> motions) {
  for (Motion& m : motions) m.velocity.setZero(), m.omega.setZero();
  return motions;
}

std::int64_t choose_substep(const Machine& machine, std::int64_t tick, std::int64_t left, double limit) {
  const double tick_s = machine.timeline().tick_s(), t = double(tick) * tick_s;
  if (const std::optional<double>& step = machine.scenario().time.step_s) {
    if (*step > limit)
      throw NumericalFailure(fmt::format("t = {:.6g} s: sea: the step of {:.4g} s is above what is stable now, {:.4g} s; leave out time.step_s, "
                                         "or give a smaller one",
                                         t, *step, limit),
                             "sea", long(tick), t, limit);
    return 2;
  }
  const std::int64_t ticks = substep_ticks(left, limit / tick_s);
  if (ticks == 0)
    throw NumericalFailure(fmt::format("t = {:.6g} s: sea: the stable step fell to {:.3g} s, less than a ten-millionth of the window", t, limit),
                           "sea", long(tick), t, limit);
  return ticks;
}

}  // namespace

std::int64_t substep_ticks(std::int64_t left, double limit) {
  const std::int64_t half = left / 2, most = std::int64_t(std::min(std::floor(0.5 * limit), 9e15));
  if (most < 1) return 0;
  const std::int64_t steps = (half + most - 1) / most;
  return 2 * ((half + steps - 1) / steps);
}

void evaluate_particles(Machine& machine, const bodies::BodiesState& state) {
  const SeaClock clock(machine);
  sea::ParticleSea& sea = *machine.particles();
  const double t = double(state.tick) * machine.timeline().tick_s();
  sea.place(t, t < 0.0 ? at_rest(state.motions) : state.motions);
  sea.open_window();
  sea.step_limit();
}

std::int64_t advance_with_particles(Machine& machine, bodies::BodiesState& state, std::int64_t end_tick) {
  sea::ParticleSea& sea = *machine.particles();
  const double tick_s = machine.timeline().tick_s();
  bodies::BodiesState middle, next;
  std::int64_t substeps = 0;
  const bool held = state.tick < 0;
  const std::vector<Motion> held_motions = held ? at_rest(state.motions) : std::vector<Motion>();
  const auto advance = [&](const bodies::BodiesState& from, bodies::BodiesState& to, std::int64_t ticks) {
    to = from;
    const bodies::StepReport report = machine.system().advance(to, tick_s, ticks);
    if (!report.ok()) throw machine.system().failure(report, from, tick_s);
  };
  {
    const SeaClock clock(machine);
    // A released body moves at once; a held one must not carry its start velocity into the water.
    sea.place(double(state.tick) * tick_s, held ? held_motions : state.motions);
    sea.open_window();
  }
  while (state.tick < end_tick) {
    double limit;
    {
      const SeaClock clock(machine);
      limit = std::min(sea.step_limit(), machine.body_step_limit());
    }
    const std::int64_t ticks = choose_substep(machine, state.tick, end_tick - state.tick, limit);
    const double t = double(state.tick) * tick_s;
    if (!held && !state.motions.empty()) advance(state, middle, ticks / 2);
    {
      const SeaClock clock(machine);
      sea.start_step(double(ticks) * tick_s);
      sea.place(t + 0.5 * double(ticks) * tick_s, held ? held_motions : middle.motions);
      sea.half_step();
    }
    if (!held && !state.motions.empty()) advance(state, next, ticks);
    {
      const SeaClock clock(machine);
      sea.place(double(state.tick + ticks) * tick_s, held ? held_motions : next.motions);
      sea.end_step(held);
    }
    if (!held && !state.motions.empty())
      std::swap(state, next);
    else
      state.tick += ticks;
    ++substeps;
  }
  machine.count_sea(0, substeps);
  return substeps;
}

}  // namespace spindrift::coupling
