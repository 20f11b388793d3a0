// Which ranks of a run have the air and which the sea: as [coupling] says, or as the program was started in two sections (MPMD:
// `mpirun -n 1 spindrift run s.toml --fluid air : -n 2 spindrift run s.toml --fluid sea`). Sections must have been given the same
// scene and the same options. Called by src/app/run.cpp; tested in tests/coupled/coupled_system_test.py.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "runtime/mpi/parts.hpp"
#include "src/coupling/scenario.hpp"

namespace spindrift::coupling {

/// What one rank was started with.
struct Started {
  std::string fluid;  ///< "air", "sea"; empty: not said
  std::string scene;  ///< with all defaults and overrides, one key a line
  std::string rest;   ///< the other options that must be the same, in words
};

/// Runs `read` on every rank and compares what ranks were started with. Throws on all ranks alike, naming ranks: io::InputError
/// where they differ or where `read` failed on others; what it threw on this one. Collective.
void agree(const runtime::World& world, const std::function<Started()>& read);

/// Throws scene::SceneError where the ranks of the run are not enough for what the scene asks. Collective.
runtime::Parts place(const Scenario& scenario, const runtime::World& world, const std::string& fluid);

}  // namespace spindrift::coupling
