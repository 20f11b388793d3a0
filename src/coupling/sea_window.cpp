// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/sea_window.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/trace/clock.hpp"
#include "src/coupling/floating_system.hpp"
#include "src/coupling/retries.hpp"
#include "src/sea/sph/step_plan.hpp"

namespace spindrift::coupling {

namespace {

/// Bodies that are held do not move.
std::vector<Motion> at_rest(std::vector<Motion> motions) {
  for (Motion& m : motions) m.velocity.setZero(), m.omega.setZero();
  return motions;
}

Substeps choose_substeps(const FloatingSystem& floating, std::int64_t tick, std::int64_t left, double limit, int most) {
  const double tick_s = floating.timeline().tick_s(), t = double(tick) * tick_s;
  if (const std::optional<double>& step = floating.scenario().time.step_s) {
    if (*step > limit)
      throw NumericalFailure(
          fmt::format("t = {:.6g} s: sea: the step of {:.4g} s is above what is stable now, {:.4g} s; leave out time.step_s, "
                      "or give a smaller one",
                      t, *step, limit),
          "sea", long(tick), t, limit);
    return next_substeps(left, 2, most);
  }
  if (most > 1) limit *= sph::share_between_checks;
  const std::int64_t ticks = substep_ticks(left, limit / tick_s);
  if (ticks == 0)
    throw NumericalFailure(
        fmt::format("t = {:.6g} s: sea: the stable step fell to {:.3g} s, less than a ten-millionth of the window", t, limit),
        "sea", long(tick), t, limit);
  return next_substeps(left, ticks, most);
}

}  // namespace

Substeps next_substeps(std::int64_t left, std::int64_t each, int most) {
  const std::int64_t all = (left + each - 1) / each;
  if (all > most) return {most, each, each};
  return {int(all), each, left - each * (all - 1)};
}

std::int64_t substep_ticks(std::int64_t left, double limit) {
  const std::int64_t half = left / 2, most = std::int64_t(std::min(std::floor(0.5 * limit), 9e15));
  if (most < 1) return 0;
  const std::int64_t steps = (half + most - 1) / most;
  return 2 * ((half + steps - 1) / steps);
}

void place_in_particles(FloatingSystem& floating, const bodies::BodiesState& state) {
  const double t = double(state.tick) * floating.timeline().tick_s();
  floating.particles()->place(t, t < 0.0 ? at_rest(state.motions) : state.motions);
}

void evaluate_particles(FloatingSystem& floating, const bodies::BodiesState& state) {
  const double t = double(state.tick) * floating.timeline().tick_s();
  floating.particles()->evaluate(t, t < 0.0 ? at_rest(state.motions) : state.motions);
}

namespace {

class ParticleSide final : public BodySide, sea::WindowDriver {
 public:
  ParticleSide(FloatingSystem& floating, DriverFunction between)
      : floating_(floating), sea_(*floating.particles()), between_(std::move(between)) {}

  void prepare(const bodies::BodiesState& from, std::int64_t end_tick) override {
    state_ = from, end_ = end_tick, held_ = from.tick < 0;
    // A released body moves at once; a held one must not carry its start velocity into the water.
    if (held_) held_motions_ = at_rest(from.motions);
    sea_.open(time(from.tick), held_ ? held_motions_ : from.motions, held_);
  }
  Tasks record(runtime::Graph& graph) override {
    constexpr int first_tag = 64;  // those of the air are below
    sea_.record(graph, between_ ? between_(*this) : *this, first_tag);
    return Tasks::many;
  }
  bodies::BodiesState finish() override {
    sea_.close();
    return state_;
  }
  bool outdated() const override { return sea_.outdated(); }
  void forget_tasks() override { sea_.forget_tasks(); }
  void ease(int retry) override { retry_ = retry; }
  void balance() override { sea_.balance(); }
  void take_snapshot(int slot) override { sea_.take_snapshot(slot); }
  void return_to(int slot) override { sea_.return_to(slot); }

 private:
  Steps choose(double limit, int most) override {
    // A step that the scene gives stays.
    const double share = floating_.scenario().time.step_s ? 1.0 : share_of_substep(retry_);
    substeps_ =
        choose_substeps(floating_, state_.tick, end_ - state_.tick, share * std::min(limit, floating_.body_step_limit_s), most);
    made_ = 0;
    const double tick_s = floating_.timeline().tick_s();
    const Steps steps{double(substeps_.each) * tick_s, state_.tick + substeps_.ticks() == end_, substeps_.count,
                      double(substeps_.last) * tick_s};
    if (!sea_.moves_solids())  // nobody will ask
      for (int n = 0; n < substeps_.count; ++n) {
        std::vector<Motion> motions;
        move(false, motions), move(true, motions);
      }
    return steps;
  }
  double move(bool to_end, std::vector<Motion>& motions) override {
    const std::int64_t begin = runtime::Clock::now_ns(), ticks = to_end ? substeps_.of(made_) : substeps_.of(made_) / 2;
    const double t = time(state_.tick + ticks);
    next_ = state_;
    if (held_ || state_.motions.empty()) {
      next_.tick += ticks;
      motions = held_ ? held_motions_ : state_.motions;
    } else {
      const double tick_s = floating_.timeline().tick_s();
      const bodies::StepReport report = floating_.multibody().advance(next_, tick_s, ticks, pieces_of_step(retry_),
                                                                      to_end ? bodies::Remember::end : bodies::Remember::nothing);
      if (!report.ok()) throw floating_.multibody().failure(report, state_, tick_s);
      motions = next_.motions;
    }
    if (to_end) std::swap(state_, next_), ++steps_, ++made_;
    own_ns_ += runtime::Clock::now_ns() - begin;
    return t;
  }
  double time(std::int64_t tick) const { return double(tick) * floating_.timeline().tick_s(); }

  FloatingSystem& floating_;
  sea::ParticleSea& sea_;
  DriverFunction between_;
  bodies::BodiesState state_, next_;
  std::vector<Motion> held_motions_;
  std::int64_t end_ = 0;
  Substeps substeps_;  ///< until the next check of the sea's limits
  int made_ = 0;       ///< of these
  bool held_ = false;
  int retry_ = 0;
};

}  // namespace

std::unique_ptr<BodySide> make_particle_side(FloatingSystem& floating, DriverFunction between) {
  return std::make_unique<ParticleSide>(floating, std::move(between));
}

}  // namespace spindrift::coupling
