// The two sides of a coupled window on the ranks that have them. Placed `shared`, every rank has both; placed `split`, a rank has
// the air or the bodies with their sea, and the result of a side (the rotor's load; the bodies' state: a few numbers)
// goes to all ranks. The schemes do not know the difference, so results do not depend on it. Used by src/run; tested in
// tests/coupled/coupled_system_test.py and tests/src/coupling/sides_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <span>

#include "runtime/mpi/parts.hpp"
#include "src/coupling/air_side.hpp"
#include "src/coupling/body_side.hpp"

namespace spindrift::coupling {

/// Parts of a split run. The sea's ranks come first: rank 0 writes history, where bodies and water are known.
enum Part : int { sea_part = 0, air_part = 1 };

struct Sides {
  std::unique_ptr<AirSide> air;
  std::unique_ptr<BodySide> bodies;
};

/// `start`: of the bodies; of a floating system with particles: after FloatingSystem::fill_sea on the sea's ranks. Both floating
/// system and parts outlive them. Collective; a failure is thrown on all ranks alike.
Sides make_sides(FloatingSystem& floating, std::span<const Motion> start, const runtime::Parts& parts);

/// Runs `work` on every rank, each for the parts it has. What is wrong with the user's scene or files (scene::SceneError,
/// io::InputError, alike on all ranks of a part) is thrown on all ranks, as io::InputError; so is runtime::StopAsked. Anything
/// else ends the program.
/// Collective.
void on_parts(const runtime::Parts& parts, const std::function<void()>& work);

/// A side that runs on the ranks of its part and has its result on all. `own` is null where this rank has not the part.
std::unique_ptr<AirSide> share_air(const runtime::Parts& parts, std::unique_ptr<AirSide> own);
std::unique_ptr<BodySide> share_bodies(const runtime::Parts& parts, std::unique_ptr<BodySide> own);

}  // namespace spindrift::coupling
