// What the resolved air leaves in a run's folder for people: fields/air.xdmf (pressure, velocity, temperature, turbulence at cell
// centres) and fields/walls.xdmf by the blocks and the walls of the grid as it was given, spanwise.csv. At the end of a run of
// the air alone, at chosen times of a coupled one. Called by src/run and air_march.cpp; tested in tests/coupled/rotor_run_test.py
// and coupled_system_test.py. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/mpi/environment.hpp"
#include "src/aero/resolved_rotor.hpp"
#include "src/coupling/output_task.hpp"
#include "src/io/fields.hpp"
#include "src/io/run_directory.hpp"

namespace spindrift::coupling {

class AirOutput {
 public:
  struct Choice {
    bool walls = true;
    bool moves = false;  ///< the grid, from one output to the next
    double resume_s = io::from_the_start;
  };
  /// The solver is to outlive it. Collective over `comm`.
  AirOutput(MPI_Comm comm, const aero::FlowSolver& solver, const std::filesystem::path& folder, Choice choice);
  /// From now on the flow is that of another solver on the same tiles.
  void follow(const aero::FlowSolver& solver) { solver_ = &solver; }
  /// A copy of the flow as it is, to be written while this object lives; nothing where this time is what was written last, by the
  /// run before too. Collective.
  Writing copy(std::int64_t number, double time_s);

 private:
  Writing copy_volume(std::int64_t number, double time_s) const;
  Writing copy_walls(std::int64_t number, double time_s) const;

  const aero::FlowSolver* solver_;
  std::optional<double> written_s_;  ///< handed out last
  std::unique_ptr<io::GridFields> volume_, walls_;
  std::vector<int> wall_block_;  ///< of walls_, by window of the grid; -1 where there is no wall
};

/// scene.toml names what preconditioner = "auto" became, so that it runs alike. By one rank.
void write_choice(const io::RunDirectory& directory, const std::string& preconditioner);

/// Loads along the blades: spanwise.csv.
void write_span(const runtime::World& world, const std::vector<aero::SpanLoad>& loads, const io::RunDirectory& directory);

}  // namespace spindrift::coupling
