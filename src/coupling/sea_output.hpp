// What a sea of particles leaves in fields/: particles and the height of the surface, at the times, places and with the fields
// that [sea.fields] asks for. Called by src/run at window ends; tested in tests/coupled/particle_sea_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/mpi/environment.hpp"
#include "src/coupling/floating_system.hpp"
#include "src/coupling/output_task.hpp"
#include "src/io/fields.hpp"

namespace spindrift::coupling {

class SeaOutput {
 public:
  /// Collective. Files go to `folder`; a restart goes on after resume_s.
  SeaOutput(const FloatingSystem& floating, const std::filesystem::path& folder, const runtime::World& world,
            double resume_s = io::from_the_start);
  /// A copy of the state at time t [s], to be written while this object lives, as files of this number; of the series that do not
  /// end there already. Collective.
  Writing copy(std::int64_t number, double t) const;

 private:
  Writing copy_particles(std::int64_t tick, double t) const;
  Writing copy_surface(std::int64_t tick, double t) const;

  const FloatingSystem& floating_;
  std::vector<std::string> names_;  ///< of the particles' fields
  bool writes_;                     ///< this rank hands the surface in: all ranks have all of it
  std::unique_ptr<io::ParticleFields> particles_;
  std::unique_ptr<io::GridFields> surface_;
  int nx_ = 0, ny_ = 0;
  double dx_ = 0.0, dy_ = 0.0;
};

}  // namespace spindrift::coupling
