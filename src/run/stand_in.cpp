// SPDX-License-Identifier: Apache-2.0
#include "src/run/stand_in.hpp"

namespace spindrift::run {

namespace {

class StillBodies final : public coupling::BodySide {
 public:
  void prepare(const bodies::BodiesState& from, std::int64_t end_tick) override { state_ = from, state_.tick = end_tick; }
  bodies::BodiesState finish() override { return state_; }

 private:
  bodies::BodiesState state_;
};

class SilentAir final : public coupling::AirSide {
 public:
  aero::RotorLoad begin(double, const aero::RotorState&) override { return none_; }
  void prepare(double, double, const aero::RotorState&) override {}
  aero::RotorLoad load_at_end() override { return none_; }
  const aero::RotorLoad* written() const override { return &none_; }

 private:
  aero::RotorLoad none_;
};

}  // namespace

std::unique_ptr<coupling::BodySide> make_still_bodies() { return std::make_unique<StillBodies>(); }
std::unique_ptr<coupling::AirSide> make_silent_air() { return std::make_unique<SilentAir>(); }

}  // namespace spindrift::run
