// What `check` says of a sea of particles and of surfaces from files: counts, drafts, steps, cost; and whether the saved state
// that a scene starts from is its own. Called by check.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "runtime/mpi/environment.hpp"
#include "src/app/cost.hpp"
#include "src/coupling/floating_system.hpp"
#include "src/coupling/saved_start.hpp"
#include "src/coupling/start.hpp"

namespace spindrift::app {

/// The state of another run that the scene starts from, and where the sea in it comes from.
struct SavedParts {
  std::optional<io::CheckpointReader> sea;
  coupling::NamedState sea_named;
};
/// Throws scene::SceneError where it is not of this scene. Collective.
SavedParts open_saved_parts(const runtime::World& world, const coupling::FloatingSystem& floating, const coupling::Start& start);
/// Statics of the surfaces that a scene takes from files, where they are at the start; in 2-D of their outline in its width. Then
/// the particles: how many, how large, how long. Nothing of them is made but a list of places. @pre there are particles
PartCost print_particles(const coupling::FloatingSystem& floating, const coupling::Start& start, const SavedParts& saved);

}  // namespace spindrift::app
