// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/body_side.hpp"

#include <optional>

#include "kernels/base/failure.hpp"
#include "runtime/trace/clock.hpp"
#include "src/coupling/machine.hpp"
#include "src/coupling/retries.hpp"
#include "src/coupling/sea_window.hpp"

namespace spindrift::coupling {

namespace {

/// The bodies' own steps, one after the other.
class Steps final : public BodySide {
 public:
  explicit Steps(Machine& machine) : machine_(machine) {}
  void aim(const bodies::BodiesState& from, std::int64_t end_tick) override { state_ = from, end_ = end_tick; }
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
    const double tick_s = machine_.timeline().tick_s();
    failure_.reset();
    while (state_.tick < end_ && !failure_) try {
        const bodies::StepReport report = machine_.system().advance(state_, tick_s, 1, pieces_);
        if (report.ok())
          ++steps_;
        else
          failure_ = machine_.system().failure(report, state_, tick_s);
      } catch (const NumericalFailure& failure) { failure_ = failure; }  // of what remembers: a line
    own_ns_ += runtime::Clock::now_ns() - begin;
  }

  Machine& machine_;
  std::optional<NumericalFailure> failure_;
  bodies::BodiesState state_;
  std::int64_t end_ = 0;
  int pieces_ = 1;
};

}  // namespace

std::unique_ptr<BodySide> make_body_side(Machine& machine) {
  if (machine.particles()) return make_particle_side(machine);
  return std::make_unique<Steps>(machine);
}

}  // namespace spindrift::coupling
