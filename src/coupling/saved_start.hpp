// Another run's state that a scene starts from (start.file, start.air, sea.initial.file): opened, and tested for what it must
// have in common with the scene. That takes neither particles nor a grid, so that `spindrift check` refuses what src/run refuses,
// in the same words. Tested in tests/coupled/saved_start_test.py and coupled_system_test.py. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "src/aero/bladed_library.hpp"
#include "src/bodies/state.hpp"
#include "src/coupling/floating_system.hpp"
#include "src/coupling/scenario.hpp"
#include "src/io/checkpoint.hpp"

namespace spindrift::coupling {

/// Arrays of a checkpoint by name.
inline constexpr const char *particles_name = "sea/particles", *bodies_name = "bodies/state",
                            *step_of_bodies = "bodies/step_s",   ///< at which the memory of a convolution is sampled
                                *library_log = "control/calls";  ///< what a controller library was told, to tell it again

/// Null where no library controls the rotor.
aero::BladedLibrary* library_of(const FloatingSystem& floating);

/// A file as a scene names it.
struct NamedState {
  const char* key;
  std::string file;
};
/// Throws scene::SceneError.
[[noreturn]] void refuse_saved(const Scenario& scenario, const NamedState& named, const std::string& why);

/// What is named: a checkpoint, or another file of a run's folder (its scene.toml, say), which stands for the newest
/// checkpoint of that run. Collective; throws scene::SceneError.
io::CheckpointReader open_saved(MPI_Comm comm, const Scenario& scenario, const NamedState& named);

struct SavedStart {
  io::CheckpointReader file;
  double t = 0.0;           ///< of its state [s]
  std::int64_t window = 0;  ///< the one of this run that ends then
};
/// start.file: the state that another run of the same floating system left, whatever its windows and its march. `like`: a state
/// of this one. How many particles and cells are in it is not tested here. Collective; throws scene::SceneError.
SavedStart open_start(MPI_Comm comm, const FloatingSystem& floating, const bodies::BodiesState& like);

/// sea.initial.file likewise.
io::CheckpointReader open_sea(MPI_Comm comm, const FloatingSystem& floating);

/// Why a sea of so many values of particles cannot go on from the file; empty where it can.
std::string other_sea(const io::CheckpointReader& file, std::int64_t values);

}  // namespace spindrift::coupling
