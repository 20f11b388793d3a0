// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/sea_output.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace spindrift::coupling {

namespace {

io::Field field_named(const std::string& name) {
  if (name == "velocity") return {name, "m/s", 3};
  if (name == "pressure") return {name, "Pa", 1};
  if (name == "density") return {name, "kg/m3", 1};
  return {"owner", "-", 1};
}

}  // namespace

SeaOutput::SeaOutput(const FloatingSystem& floating, const std::filesystem::path& folder, const runtime::World& world,
                     double resume_s)
    : floating_(floating), writes_(world.rank == 0) {
  const auto& options = floating.scenario().sea.fields;
  if (!floating.particles() || !options) return;
  names_ = options->particles;
  // Else walls and bodies could not be told from water.
  if (options->solids && !names_.empty() && std::ranges::find(names_, "owner") == names_.end()) names_.push_back("owner");
  std::vector<io::Field> fields;
  for (const std::string& name : names_) fields.push_back(field_named(name));
  if (!fields.empty()) particles_ = std::make_unique<io::ParticleFields>(world.comm, folder, "particles", fields, resume_s);
  if (options->surface_spacing_m == 0.0) return;
  const sph::TankPlan& tank = floating.particle_plan()->tank;
  const bool planar = floating.particle_plan()->options.planar();
  const auto cells = [&](double length) { return std::max(1, int(std::lround(length / options->surface_spacing_m))); };
  nx_ = cells(tank.x[1] - tank.x[0]), dx_ = (tank.x[1] - tank.x[0]) / nx_;
  ny_ = planar ? 1 : cells(tank.y[1] - tank.y[0]), dy_ = planar ? dx_ : (tank.y[1] - tank.y[0]) / ny_;
  surface_ = std::make_unique<io::GridFields>(world.comm, folder, "surface", std::vector<io::GridBlock>{{"water", nx_, ny_, 1}},
                                              std::vector<io::Field>{{"elevation", "m", 1}}, true, resume_s);
}

Writing SeaOutput::copy(std::int64_t number, double t) const {
  Writing particles = particles_ && !particles_->ends_with(t) ? copy_particles(number, t) : Writing();
  Writing surface = surface_ && !surface_->ends_with(t) ? copy_surface(number, t) : Writing();
  if (!surface) return particles;
  if (!particles) return surface;
  return [particles = std::move(particles), surface = std::move(surface)] { particles(), surface(); };
}

Writing SeaOutput::copy_particles(std::int64_t tick, double t) const {
  const sea::FieldsOptions& options = *floating_.scenario().sea.fields;
  const auto sample =
      std::make_shared<const sea::ParticleSample>(floating_.particles()->sample(options.low_m, options.high_m, options.solids));
  return [this, sample, tick, t] {
    std::vector<std::span<const double>> fields;
    for (const std::string& name : names_)
      fields.push_back(name == "velocity"   ? sample->velocity
                       : name == "pressure" ? sample->pressure
                       : name == "density"  ? sample->density
                                            : sample->owner);
    particles_->write(tick, t, sample->id, sample->position, fields);
  };
}

/// One layer of cells from the bed to the surface, whose upper corners are heights read there and whose value is the middle's.
Writing SeaOutput::copy_surface(std::int64_t tick, double t) const {
  const sph::TankPlan& tank = floating_.particle_plan()->tank;
  const double y0 = floating_.particle_plan()->options.planar() ? -0.5 * dy_ : tank.y[0];
  std::vector<std::array<double, 2>> corners, middles;
  for (int j = 0; j <= ny_; ++j)
    for (int i = 0; i <= nx_; ++i) corners.push_back({tank.x[0] + i * dx_, y0 + j * dy_});
  for (int j = 0; j < ny_; ++j)
    for (int i = 0; i < nx_; ++i) middles.push_back({tank.x[0] + (i + 0.5) * dx_, y0 + (j + 0.5) * dy_});
  std::vector<double> heights = floating_.particles()->surface(corners), elevation = floating_.particles()->surface(middles);
  const auto wet = [&](double height, double x) { return std::isfinite(height) ? height : tank.bed_at(x); };
  if (!writes_) return [this, tick, t] { surface_->write(tick, t, {}); };
  std::vector<double> points;
  for (int k = 0; k <= 1; ++k)
    for (std::size_t n = 0; n < corners.size(); ++n)
      points.insert(points.end(),
                    {corners[n][0], corners[n][1], k == 0 ? tank.bed_at(corners[n][0]) : wet(heights[n], corners[n][0])});
  for (std::size_t n = 0; n < middles.size(); ++n) elevation[n] = wet(elevation[n], middles[n][0]);
  return [this, tick, t, points = std::move(points), elevation = std::move(elevation)] {
    const io::GridFields::Values values{0, {0, 0, 0}, {nx_, ny_, 1}, points, {elevation}};
    surface_->write(tick, t, std::span(&values, 1));
  };
}

}  // namespace spindrift::coupling
