// The rotor as a source of load on the bodies: its engineering model as they go, or what a coupling window has in its place; all
// of it ramped at the start. Held by floating_system.hpp; tested in tests/src/coupling/window_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <functional>
#include <span>
#include <string>
#include <utility>

#include "src/aero/rotor_loads.hpp"
#include "src/coupling/load_sources.hpp"
#include "src/coupling/scenario.hpp"

namespace spindrift::coupling {

class RotorSource {
 public:
  /// `scenario`: one of by_rotor(); `start`: of the bodies; `step_s`: theirs. `wanted` outlives this.
  RotorSource(std::string name, const Scenario& scenario, const aero::Wind& wind, std::span<const Motion> start, double step_s,
              const LoadsWanted& wanted);
  RotorSource(RotorSource&&) = delete;

  const std::string name;  ///< of the source of load and its columns: "rotor", or "rotor.NAME" of [rotors.NAME]
  const double radius;     ///< as rotor_radius has it [m]
  /// Where the rotor is, and its loads by the engineering model; of a resolved rotor by blade element momentum on the same
  /// blades, for estimates (static equilibrium, linearisation, `check`).
  aero::RotorLoads loads;
  /// This outlives the source.
  void add_to(LoadSources& sources);

  /// Of the bodies, from elsewhere than the engineering model.
  using Loads = std::function<void(double, std::span<const Motion>, std::span<Wrench>)>;
  /// Where they are given, bodies take the rotor's load from `loads`, and history has it from `written`; the tower's drag stays.
  /// For coupling windows.
  void replace(Loads loads, const aero::RotorLoad* written);
  bool is_replaced() const { return bool(replaced_); }
  /// The air's moment that turns the rotor where the scene has control, as aero::RotorLoads::turn_by has it.
  void turn_by(aero::RotorLoads::AirMoment moment) { loads.turn_by(std::move(moment)); }
  /// The load as history has it: what a coupling window wrote, else that of this state.
  aero::RotorLoad written(double t, const aero::RotorState& now) const;

  /// Factor on the loads at time t [s] (start.ramp_s): 0 at the start, 1 after the ramp, with a continuous rate.
  double ramp(double t) const;
  /// Its parts in a coupling window: the load of the air's side has the first. A drive train is turned by the whole of it, and
  /// the second goes on what acts on the bodies.
  double ramp_of_air(double t) const { return loads.control() ? 1.0 : ramp(t); }
  double ramp_after_air(double t) const { return loads.control() ? ramp(t) : 1.0; }

 private:
  double ramp_s_;
  std::size_t bodies_;
  const LoadsWanted& wanted_;
  Loads replaced_;
  const aero::RotorLoad* written_ = nullptr;
};

/// In the order of by_rotor(scenario), all in one wind.
std::deque<RotorSource> make_rotors(const Scenario& scenario, std::span<const Motion> start, double step_s,
                                    const LoadsWanted& wanted);

}  // namespace spindrift::coupling
