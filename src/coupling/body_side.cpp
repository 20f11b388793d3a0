// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/body_side.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "kernels/base/failure.hpp"
#include "runtime/mpi/stop_request.hpp"
#include "runtime/trace/clock.hpp"
#include "src/coupling/floating_system.hpp"
#include "src/coupling/flow_scene.hpp"
#include "src/coupling/out_of_place.hpp"
#include "src/coupling/retries.hpp"
#include "src/coupling/sea_window.hpp"

namespace spindrift::coupling {

namespace {

/// Steps after which the ranks look whether the run is to stop: a tenth of a second of the dearest bodies.
constexpr std::int64_t steps_between_looks = 100;

/// The bodies' own steps, one after the other. A window of many is cut: some of them at a time, until its end or a request to
/// stop.
class Steps final : public BodySide {
 public:
  explicit Steps(FloatingSystem& floating) : floating_(floating) {}
  void prepare(const bodies::BodiesState& from, std::int64_t end_tick) override { state_ = from, end_ = end_tick; }
  Tasks record(runtime::Graph& graph) override {
    const runtime::Datum state = graph.datum(), asked = graph.datum();
    if (floating_.timeline().steps_per_window() <= steps_between_looks) {
      graph.task("bodies/steps", {runtime::updates(state)}, [this] { advance(end_); });
      return Tasks::single;
    }
    graph.loop("bodies/steps", {}, [&] {
      graph.task("bodies/steps", {runtime::updates(state), runtime::writes(asked)}, [this] {
        advance(std::min(end_, state_.tick + std::max<std::int64_t>(1, steps_between_looks / pieces_)));
        asked_[0] = runtime::StopRequest::asked() ? 1.0 : 0.0;
      });
      const runtime::Datum agreed = graph.datum();
      graph.reduce("bodies/stop", {runtime::reads(asked), runtime::writes(agreed)},
                   {runtime::Reduction::Operation::max, asked_, agreed_});
      graph.until("bodies/end", {runtime::reads(state), runtime::reads(agreed)}, [this] {
        stopped_ = !failure_ && state_.tick < end_ && agreed_[0] > 0.0;
        return stopped_ || failure_ || state_.tick >= end_;
      });
    });
    return Tasks::single;
  }
  bodies::BodiesState finish() override {
    if (stopped_) throw runtime::StopAsked();
    if (failure_) throw *failure_;
    return state_;
  }
  void ease(int retry) override { pieces_ = pieces_of_step(retry); }

 private:
  void advance(std::int64_t end) {
    const std::int64_t begin = runtime::Clock::now_ns();
    const double tick_s = floating_.timeline().tick_s();
    failure_.reset();
    while (state_.tick < end && !failure_) try {
        const bodies::StepReport report = floating_.multibody().advance(state_, tick_s, 1, pieces_);
        if (report.ok())
          ++steps_;
        else
          failure_ = floating_.multibody().failure(report, state_, tick_s);
      } catch (const NumericalFailure& failure) { failure_ = failure; }  // of what remembers: a line
    if (!failure_ && end == end_) failure_ = out_of_place(floating_, state_);
    own_ns_ += runtime::Clock::now_ns() - begin;
  }

  FloatingSystem& floating_;
  std::optional<NumericalFailure> failure_;
  bodies::BodiesState state_;
  std::int64_t end_ = 0;
  int pieces_ = 1;
  bool stopped_ = false;  ///< since the run is to stop, on all ranks that share the graph
  std::array<double, 1> asked_{}, agreed_{};
};

}  // namespace

std::unique_ptr<BodySide> make_body_side(FloatingSystem& floating) {
  if (floating.particles()) return make_particle_side(floating);
  return std::make_unique<Steps>(floating);
}

}  // namespace spindrift::coupling
