// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/air_side.hpp"

#include <optional>

#include "kernels/base/failure.hpp"
#include "src/coupling/actuator_air.hpp"
#include "src/coupling/floating_system.hpp"
#include "src/coupling/resolved_air.hpp"

namespace spindrift::coupling {

namespace {

/// Loads without a past: there is nothing to keep.
class EngineeringAir final : public AirSide {
 public:
  explicit EngineeringAir(const FloatingSystem& floating) : floating_(floating) {}
  aero::RotorLoad begin(double t, const aero::RotorState& now) override {
    prepare(t, 0.0, now);
    solve();
    return load_at_end();
  }
  void prepare(double t, double, const aero::RotorState& at_end) override { t_ = t, state_ = at_end; }
  Tasks record(runtime::Graph& graph) override {
    graph.task("rotor/load", {runtime::updates(graph.datum())}, [this] { solve(); });
    return Tasks::single;
  }
  aero::RotorLoad load_at_end() override {
    if (failure_) throw *failure_;
    return load_;
  }

 private:
  void solve() {
    failure_.reset();
    try {
      load_ = floating_.rotor()->load(t_, state_, floating_.rotor_source().ramp(t_));
    } catch (const NumericalFailure& failure) { failure_ = failure; }
  }

  const FloatingSystem& floating_;
  double t_ = 0.0;
  aero::RotorState state_;
  aero::RotorLoad load_;
  std::optional<NumericalFailure> failure_;
};

class NoAir final : public AirSide {
 public:
  aero::RotorLoad begin(double, const aero::RotorState&) override { return {}; }
  void prepare(double, double, const aero::RotorState&) override {}
  aero::RotorLoad load_at_end() override { return {}; }
};

}  // namespace

std::unique_ptr<AirSide> make_no_air() { return std::make_unique<NoAir>(); }

std::unique_ptr<AirSide> make_engineering_air(const FloatingSystem& floating) {
  return std::make_unique<EngineeringAir>(floating);
}

std::unique_ptr<AirSide> make_air(const FloatingSystem& floating, const aero::RotorState& now, const runtime::World& world) {
  if (floating.scenario().has_actuator()) return make_actuator_air(floating, now, world);
  if (floating.scenario().resolves_air()) return make_resolved_air(floating, now, world);
  return make_engineering_air(floating);
}

}  // namespace spindrift::coupling
