// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/body_side.hpp"

#include <optional>

#include "kernels/base/failure.hpp"
#include "runtime/trace/clock.hpp"
#include "src/coupling/floating_system.hpp"
#include "src/coupling/flow_scene.hpp"
#include "src/coupling/out_of_place.hpp"
#include "src/coupling/retries.hpp"
#include "src/coupling/sea_window.hpp"

namespace spindrift::coupling {

namespace {

/// The bodies' own steps, one after the other.
class Steps final : public BodySide {
 public:
  explicit Steps(FloatingSystem& floating) : floating_(floating) {}
  void prepare(const bodies::BodiesState& from, std::int64_t end_tick) override { state_ = from, end_ = end_tick; }
  Tasks record(runtime::Graph& graph) override {
    graph.task("bodies/steps", {runtime::updates(graph.datum())}, [this] { advance(); });
    return Tasks::single;
  }
  bodies::BodiesState finish() override {
    if (failure_) throw *failure_;
    return state_;
  }
  void ease(int retry) override { pieces_ = pieces_of_step(retry); }

 private:
  void advance() {
    const std::int64_t begin = runtime::Clock::now_ns();
    const double tick_s = floating_.timeline().tick_s();
    failure_.reset();
    while (state_.tick < end_ && !failure_) try {
        const bodies::StepReport report = floating_.multibody().advance(state_, tick_s, 1, pieces_);
        if (report.ok())
          ++steps_;
        else
          failure_ = floating_.multibody().failure(report, state_, tick_s);
      } catch (const NumericalFailure& failure) { failure_ = failure; }  // of what remembers: a line
    if (!failure_) failure_ = out_of_place(floating_, state_);
    own_ns_ += runtime::Clock::now_ns() - begin;
  }

  FloatingSystem& floating_;
  std::optional<NumericalFailure> failure_;
  bodies::BodiesState state_;
  std::int64_t end_ = 0;
  int pieces_ = 1;
};

}  // namespace

std::unique_ptr<BodySide> make_body_side(FloatingSystem& floating) {
  if (floating.particles()) return make_particle_side(floating);
  return std::make_unique<Steps>(floating);
}

}  // namespace spindrift::coupling
