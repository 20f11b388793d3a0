// Both fluids of a floating system without the scheme between them: windows of the air, of the sea or of both as one graph.
// Used by perf/coupling and perf/air_beside_sea. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "perf/harness.hpp"
#include "src/coupling/floating_system.hpp"
#include "src/coupling/sides.hpp"
#include "src/coupling/start.hpp"
#include "src/coupling/window_tasks.hpp"

namespace spindrift::coupling {

/// The sides of a floating system, advanced by whole windows with the rotor going on as it does and bodies under the water's
/// loads alone.
struct Alone {
  explicit Alone(FloatingSystem& m)
      : floating(m),
        state(make_start(m).state),
        air(make_air(m, m.rotor()->state(0.0, state.motions), {MPI_COMM_SELF, 0, 1})),
        bodies(make_body_side(m)) {
    air->begin(0.0, m.rotor()->state(0.0, state.motions));
    rotor = m.rotor()->state(0.0, state.motions);
  }
  double window(WindowTasks& tasks, Run run) {
    const double dt = floating.timeline().window_s();
    if (has_air(run)) rotor.azimuth += rotor.speed * dt, air->prepare(air_time += dt, dt, rotor);
    if (has_bodies(run))
      bodies->balance(), bodies->take_snapshot(0), bodies->prepare(state, state.tick + floating.timeline().steps_per_window());
    const double s = perf::seconds([&] { tasks.run(run); });
    if (has_air(run)) air->load_at_end();
    if (has_bodies(run)) state = bodies->finish();
    return s;
  }
  FloatingSystem& floating;
  bodies::BodiesState state;
  std::unique_ptr<AirSide> air;
  std::unique_ptr<BodySide> bodies;
  OutputTask output;  ///< with nothing to write
  aero::RotorState rotor;
  double air_time = 0.0;
};

}  // namespace spindrift::coupling
