// The sea as a source of load on the bodies: an engineering sea; or particles and, until they are made, the buoyancy of the
// bodies' shapes and the added mass of cylinders, which statics and modes need. Held by floating_system.hpp; tested through
// tests/src/coupling and tests/coupled. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "kernels/mooring/line_lumped_mass.hpp"
#include "src/coupling/load_sources.hpp"
#include "src/coupling/scenario.hpp"
#include "src/sea/engineering_sea.hpp"
#include "src/sea/particle_sea.hpp"

namespace spindrift::sea {
class StillWater;
}

namespace spindrift::coupling {

class SeaSource {
 public:
  /// `step_s`: of the bodies. `loads` outlives this.
  SeaSource(const Scenario& scenario, double step_s, const LoadsWanted& loads);
  SeaSource(SeaSource&&) = delete;

  /// Of a scene with particles: the added mass, where all its shapes are cylinders. Null where there is none.
  const sea::EngineeringSea* engineering() const { return moving_ ? &*moving_ : nullptr; }
  /// Null without particles.
  const sea::ParticlePlan* plan() const { return plan_ ? &*plan_ : nullptr; }
  /// Null until fill().
  sea::ParticleSea* particles() const { return particles_.get(); }
  /// Makes the particles, if the scene has any, round the bodies where they start; from then on the loads are theirs.
  void fill(std::span<const Motion> start, const runtime::World& world);
  /// Round mooring lines; at rest in a sea of particles.
  LineWater water(double t, const Eigen::Vector3d& point) const;
  /// This outlives the sources.
  void add_to(LoadSources& sources);

 private:
  const sea::EngineeringSea& now() const { return loads_.mean && still_ ? *still_ : *moving_; }
  void plan_particles(const Scenario& scenario);
  void add_particles(LoadSources& sources);
  bodies::LoadSource engineering_source();

  const LoadsWanted& loads_;
  std::optional<sea::EngineeringSea> moving_, still_;  ///< the second of a sea with waves: the same without them
  std::optional<sea::ParticlePlan> plan_;
  std::shared_ptr<const sea::StillWater> before_particles_;  ///< of plan_
  std::unique_ptr<sea::ParticleSea> particles_;
  std::vector<bool> on_;  ///< by body
};

}  // namespace spindrift::coupling
