// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/air_side.hpp"

#include <optional>

#include "kernels/base/failure.hpp"
#include "src/coupling/machine.hpp"
#include "src/coupling/resolved_air.hpp"

namespace spindrift::coupling {

namespace {

/// Loads without a past: there is nothing to keep.
class EngineeringAir final : public AirSide {
 public:
  explicit EngineeringAir(const Machine& machine) : machine_(machine) {}
  aero::RotorLoad begin(double t, const aero::RotorState& now) override {
    aim(t, 0.0, now);
    solve();
    return answer();
  }
  void aim(double t, double, const aero::RotorState& at_end) override { t_ = t, state_ = at_end; }
  Tasks record(runtime::Graph& graph) override {
    graph.task("rotor/load", {runtime::updates(graph.datum())}, [this] { solve(); });
    return Tasks::single;
  }
  aero::RotorLoad answer() override {
    if (failure_) throw *failure_;
    return load_;
  }

 private:
  void solve() {
    failure_.reset();
    try {
      load_ = machine_.rotor()->load(t_, state_, machine_.ramp(t_));
    } catch (const NumericalFailure& failure) { failure_ = failure; }
  }

  const Machine& machine_;
  double t_ = 0.0;
  aero::RotorState state_;
  aero::RotorLoad load_;
  std::optional<NumericalFailure> failure_;
};

class NoAir final : public AirSide {
 public:
  aero::RotorLoad begin(double, const aero::RotorState&) override { return {}; }
  void aim(double, double, const aero::RotorState&) override {}
  aero::RotorLoad answer() override { return {}; }
};

}  // namespace

std::unique_ptr<AirSide> make_no_air() { return std::make_unique<NoAir>(); }

std::unique_ptr<AirSide> make_engineering_air(const Machine& machine) { return std::make_unique<EngineeringAir>(machine); }

std::unique_ptr<AirSide> make_air(const Machine& machine, const aero::RotorState& now, const runtime::World& world) {
  if (machine.scenario().resolves_air()) return make_resolved_air(machine, now, world);
  return make_engineering_air(machine);
}

}  // namespace spindrift::coupling
