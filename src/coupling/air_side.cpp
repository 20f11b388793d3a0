// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/air_side.hpp"

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
    return answer();
  }
  void aim(double t, double, const aero::RotorState& at_end) override { t_ = t, state_ = at_end; }
  aero::RotorLoad answer() override { return machine_.rotor()->load(t_, state_, machine_.ramp(t_)); }

 private:
  const Machine& machine_;
  double t_ = 0.0;
  aero::RotorState state_;
};

}  // namespace

std::unique_ptr<AirSide> make_engineering_air(const Machine& machine) { return std::make_unique<EngineeringAir>(machine); }

std::unique_ptr<AirSide> make_air(const Machine& machine, const aero::RotorState& now, const runtime::World& world) {
  if (machine.scenario().resolves_air()) return make_resolved_air(machine, now, world);
  return make_engineering_air(machine);
}

}  // namespace spindrift::coupling
