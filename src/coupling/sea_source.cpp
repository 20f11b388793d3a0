// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/sea_source.hpp"

#include <algorithm>

#include "src/bodies/extent.hpp"
#include "src/sea/still_water.hpp"

namespace spindrift::coupling {

namespace {

/// At rest that is buoyancy and the water's inertia, of which particles need the second.
sea::SeaOptions hydrostatics() {
  sea::SeaOptions still;
  still.model = "morison", still.axial_added_mass_coefficient = 1.0;
  return still;
}

/// The cylinders of bodies that have no other shapes, in a plane as wide as the scene; none where a shape is no cylinder of water
/// on all sides.
std::optional<std::vector<sea::SeaBody>> only_cylinders(const Scenario& s) {
  if (s.bodies.empty()) return std::nullopt;
  for (const auto& [name, body] : s.bodies)
    if (!body.boxes.empty() || !body.spheres.empty() || !body.meshes.empty()) return std::nullopt;
  std::vector<sea::SeaBody> all = sea_bodies(s.bodies);
  if (!s.sea.particles->planar()) return all;
  for (sea::SeaBody& body : all)
    for (sea::NamedCylinder& cylinder : body.cylinders) {
      Cylinder& c = cylinder.shape;
      if (std::abs(c.axis()[1]) < 0.5) return std::nullopt;
      const Eigen::Vector3d middle = 0.5 * (c.start + c.end), half = 0.5 * s.sea.particles->width_m * Eigen::Vector3d::UnitY();
      c.start = middle - half, c.end = middle + half;
    }
  return all;
}

/// Bodies that an engineering sea loads otherwise than by their cylinders.
std::vector<int> named_in(const sea::SeaOptions& sea, const bodies::NamedBodies& all) {
  std::vector<int> named;
  for (const sea::DampingOptions& damping : sea.damping) named.push_back(bodies::index_of(all, damping.body));
  for (const sea::MatricesOptions& matrices : sea.matrices) named.push_back(bodies::index_of(all, matrices.body));
  if (sea.potential) named.push_back(bodies::index_of(all, sea.potential->body));
  return named;
}

}  // namespace

SeaSource::SeaSource(const Scenario& s, double step_s, const LoadsWanted& loads) : loads_(loads) {
  if (s.has_particles()) {
    plan_particles(s);
  } else if (s.has_sea()) {
    const std::vector<sea::SeaBody> wetted = sea_bodies(s.bodies);
    moving_.emplace(s.sea, s.waves, sea_environment(s.environment), wetted, step_s);
    if (s.has_waves()) still_.emplace(s.sea, sea::WavesOptions{}, sea_environment(s.environment), wetted, step_s);
    on_ = marked(s.bodies.size(), named_in(s.sea, s.bodies));
    for (std::size_t b = 0; b < wetted.size(); ++b)
      if (!wetted[b].cylinders.empty()) on_[b] = true;
  }
}

void SeaSource::plan_particles(const Scenario& s) {
  const std::vector<sea::ParticleBody> shaped = particle_bodies(s.bodies);
  plan_ =
      sea::particle_plan(s.sea, s.waves, sea_environment(s.environment), shaped,
                         bodies::entry_speed(s.bodies, s.joints, s.beams, s.environment.gravity_m_s2, s.sea.lowest_surface()));
  for (sea::SensorOptions& sensor : plan_->sensors)
    if (sensor.mean_over_s == 0.0) sensor.mean_over_s = s.time.window_s;
  std::vector<std::vector<sph::BodyShape>> shapes;
  for (const sea::ParticleBody& body : shaped) on_.push_back(!body.shapes.empty()), shapes.push_back(body.shapes);
  before_particles_ = std::make_shared<const sea::StillWater>(
      shapes, s.environment.water_density_kg_m3 * s.environment.gravity_m_s2,
      s.sea.particles->planar() ? sph::Cut::plane : sph::Cut::space, s.sea.particles->width_m);
  if (const auto cylinders = only_cylinders(s))
    moving_.emplace(hydrostatics(), sea::WavesOptions{}, sea_environment(s.environment), *cylinders);
}

void SeaSource::fill(std::span<const Motion> start, const runtime::World& world) {
  if (plan_) particles_ = sea::ParticleSea::make(*plan_, start, world);
}

LineWater SeaSource::water(double t, const Eigen::Vector3d& point) const {
  if (!moving_ || plan_) return {};
  const waves::Kinematics water = now().water(t, point);
  return {water.velocity, water.acceleration, now().elevation(point.x(), point.y(), t)};
}

void SeaSource::add_to(LoadSources& sources) {
  if (plan_) return add_particles(sources);
  if (moving_) sources.add(engineering_source(), on_);
}

void SeaSource::add_particles(LoadSources& sources) {
  sources.add({"sea",
               [this](double, std::span<const Motion> m, std::span<Wrench> w) {
                 if (particles_)
                   particles_->add_loads(m, w);
                 else
                   before_particles_->add_loads(m, w);
               },
               [this](double t, std::span<const Motion> m, std::span<bodies::Matrix6> a) {
                 if (!particles_ && moving_) moving_->add_added_mass(t, m, a);  // particles push back by themselves
               }},
              on_);
  if (!plan_->parameters.contact || std::ranges::find(on_, true) == on_.end()) return;
  sources.add({"contact",
               [this](double, std::span<const Motion> m, std::span<Wrench> w) {
                 if (particles_) particles_->add_contacts(m, w);
               },
               {}},
              on_);
}

bodies::LoadSource SeaSource::engineering_source() {
  bodies::LoadSource source{
      "sea", [this](double t, std::span<const Motion> m, std::span<Wrench> w) { now().add_loads(t, m, w); }, {}};
  if (moving_->has_added_mass())
    source.added_mass = [this](double t, std::span<const Motion> m, std::span<bodies::Matrix6> a) {
      now().add_added_mass(t, m, a);
    };
  if (moving_->memory_size() > 0)
    source.memory = {
        moving_->memory_size(),
        [this](double t, std::span<const Motion> m, std::span<double> memory) { moving_->begin(t, m, memory); },
        [this](std::span<const double> memory) { moving_->recall(memory); },
        [this](double t, double, std::span<const Motion> m, std::span<double> memory) { moving_->remember(t, m, memory); }};
  return source;
}

}  // namespace spindrift::coupling
