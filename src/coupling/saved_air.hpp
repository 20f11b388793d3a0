// Air that one run leaves for another to start from (start.air; Leble & Barakos 2016, section 4.6): beside tiles and march, a
// checkpoint of a resolved rotor says on which grid and with which settings it was made, where the rotor was and what load it
// computed. Written by src/run, read by resolved_air.cpp; tested in tests/coupled/coupled_system_test.py.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "src/aero/resolved_rotor.hpp"
#include "src/coupling/saved_array.hpp"
#include "src/coupling/scenario.hpp"

namespace spindrift::coupling {

/// Whereby saved air must be like this scene's: "aero.grid.cells_round = 28" and so on, one a line. Into the checkpoint.
void write_air_settings(io::CheckpointCopy& copy, const Scenario& scenario);

/// Loads of the rotor as a whole, and of each blade of its grid (blade 1 first).
struct ComputedLoads {
  aero::RotorLoad rotor;
  std::vector<aero::RotorLoad> blades;
};
ComputedLoads computed_loads(const aero::ResolvedRotor& rotor);

/// `rank`: among those that have the air.
SavedArray computed_loads_array(const ComputedLoads& computed, int rank);
/// Pose, loads and a measure of the grid of a rotor.
std::vector<SavedArray> rotor_arrays(const aero::ResolvedRotor& rotor, const ComputedLoads& computed, int rank);

ComputedLoads computed_loads_in(const io::CheckpointReader& file, int blades);
/// The last load of the air of a coupled run and its physical step [s], for a run that goes on from there.
struct SavedRotorLoad {
  aero::RotorLoad load;
  double dt;
};
SavedArray rotor_load_array(const SavedRotorLoad& saved, int rank);
SavedRotorLoad rotor_load_in(const io::CheckpointReader& file);

/// Where a rotor with blades that pitch was at the beginning and at the end of its last step, and where time is of third order
/// (else as `before`) a step earlier: what TileMotion does not keep.
struct RotorPlaces {
  aero::RotorPlace long_before, before, now;
};
SavedArray rotor_places_array(const aero::ResolvedRotor& rotor, int rank);
/// Nothing where no blade could pitch.
std::optional<RotorPlaces> rotor_places_in(const io::CheckpointReader& file);

/// Whether the wind of the file's air was the same at all heights and times: what a scene's is beside that is then to be added.
bool is_of_plain_wind(const io::CheckpointReader& file);
/// start.air, opened and tested as far as that takes no grid. Collective; throws scene::SceneError.
io::CheckpointReader open_air(MPI_Comm comm, const Scenario& scenario);
/// Gives `rotor` the flow of the file, carried along with the blades to `start`, without a past. Returns what was computed,
/// turned likewise. Throws scene::SceneError where the file's air is another one.
ComputedLoads start_from(const io::CheckpointReader& file, const Scenario& scenario, aero::ResolvedRotor& rotor,
                         const aero::RotorPose& start);

}  // namespace spindrift::coupling
