// SPDX-License-Identifier: Apache-2.0
#include "src/app/check_sea.hpp"

#include <fmt/format.h>

#include <cmath>

#include "kernels/rigid/closed_surface.hpp"
#include "kernels/sph/viscosity_artificial.hpp"
#include "src/app/forecast.hpp"
#include "src/coupling/out_of_place.hpp"
#include "src/coupling/saved_air.hpp"

namespace spindrift::app {

using coupling::FloatingSystem;

namespace {

/// A sea that is laid out to be counted must have as many particles as the saved one; one that is not, about as many.
void require_particles(const SavedParts& saved, const coupling::Scenario& s, const sea::ParticleCensus& census) {
  if (!saved.sea) return;
  const auto values = std::int64_t(census.particles() * census.values_each);
  const std::string why = coupling::other_sea(*saved.sea, values);
  const double has = double(saved.sea->size(coupling::particles_name));
  constexpr double counted_to = 0.1;
  if (!why.empty() && !(census.counted && std::abs(has - double(values)) <= counted_to * double(values)))
    refuse_saved(s, saved.sea_named, why);
  if (census.counted)
    fmt::print("  {:<22}must be those of {} exactly, which a run tells: {:.4g} are in it\n", "", saved.sea_named.key,
               has / double(census.values_each));
}

/// Statics of the surfaces that a scene takes from files, where they are at the start; in 2-D of their outline in its width.
void print_meshes(const FloatingSystem& floating, const coupling::Start& start) {
  const coupling::Scenario& s = floating.scenario();
  for (std::size_t b = 0; b < s.bodies.size(); ++b)
    for (const scene::MeshOptions& mesh : s.bodies[b].options.meshes) {
      const bool planar = mesh.prism != nullptr;
      const ClosedSurface& surface = planar ? *mesh.prism : *mesh.surface;
      const double share = planar ? s.sea.particles->width_m / surface.box().sizes()[1] : 1.0;
      const Motion& now = start.state.motions[b];
      const Eigen::Vector3d size = mesh.surface->box().sizes();
      const Eigen::Matrix3d inertia = surface.inertia() / surface.volume(), turn = now.attitude.toRotationMatrix();
      const auto place = [&](const Eigen::Vector3d& x) {  // without the last digits of sums that cancel
        const Eigen::Vector3d plain = x.unaryExpr([&](double c) { return std::abs(c) < 1e-9 * size.norm() ? 0.0 : c; });
        return fmt::format("({:.6g}, {:.6g}, {:.6g}) m", plain[0], plain[1], plain[2]);
      };
      const std::string inertia_over_mass =
          planar ? fmt::format("{:.6g} m2 in pitch", inertia(1, 1))
                 : fmt::format("[{:.6g}, {:.6g}, {:.6g}] m2", inertia(0, 0), inertia(1, 1), inertia(2, 2));
      fmt::print("\nMesh {} of {}: {} triangles, {:.6g} x {:.6g} x {:.6g} m{}\n", mesh.name, s.bodies[b].name,
                 mesh.surface->triangles().size(), size[0], size[1], size[2],
                 planar ? fmt::format("; of its outline in the plane y = {:g} m, {:g} m wide", s.bodies[b].options.centre_m[1],
                                      s.sea.particles->width_m)
                        : "");
      fmt::print("  {:<22}{:.6g} m3 about {}; of even density its inertia about there is the mass times {}\n", "volume",
                 share * surface.volume(), place(surface.centre()), inertia_over_mass);
      const Submerged under = submerged(surface, turn, now.position - turn * s.bodies[b].options.centre_m);
      if (!(under.volume > 0.0)) {
        fmt::print("  {:<22}above the water\n", "at the start");
        continue;
      }
      const double over = under.centre[2] - now.position[2];  // of the centre of buoyancy
      fmt::print("  {:<22}{:.6g} m3 ({:.6g} kg) under water, centre of buoyancy {}\n", "at the start", share * under.volume,
                 s.environment.water_density_kg_m3 * share * under.volume, place(under.centre));
      fmt::print("  {:<22}{:.6g} m2; metacentre over the centre of mass: {}{:+.4g} m in pitch\n", "waterplane",
                 share * under.area, planar ? "" : fmt::format("{:+.4g} m in roll, ", over + under.metacentric_radius_roll()),
                 over + under.metacentric_radius_pitch());
    }
}

}  // namespace

SavedParts open_saved_parts(const runtime::World& world, const FloatingSystem& floating, const coupling::Start& start) {
  const coupling::Scenario& s = floating.scenario();
  if (!s.start.air.empty()) coupling::open_air(world.comm, s);
  if (!s.start.file.empty()) return {coupling::open_start(world.comm, floating, start.state).file, {"start.file", s.start.file}};
  if (floating.particle_plan() && s.sea.initial && s.sea.initial->state == "file")
    return {coupling::open_sea(world.comm, floating), {"sea.initial.file", s.sea.initial->file}};
  return {};
}

PartCost print_particles(const FloatingSystem& floating, const coupling::Start& start, const SavedParts& saved) {
  print_meshes(floating, start);
  const coupling::Scenario& s = floating.scenario();
  const sea::ParticleCensus census = particle_census(*floating.particle_plan(), start.state.motions);
  const sph::Parameters& p = floating.particle_plan()->parameters;
  const double steps_per_window = particle_steps(floating, census);
  fmt::print("\nSea of particles\n");
  if (census.counted)
    fmt::print("  {:<22}about {:.3g} ({:.3g} water, {:.3g} walls, {:.3g} bodies), by columns and volumes\n", "particles",
               double(census.particles()), double(census.water), double(census.walls), double(census.bodies));
  else
    fmt::print("  {:<22}{} ({} water, {} walls, {} bodies)\n", "particles", census.particles(), census.water, census.walls,
               census.bodies);
  require_particles(saved, s, census);
  const bool alone = coupling::has_level_water(s) && s.joints.empty() && s.moorings.empty() && s.beams.empty() && !s.has_rotor();
  for (const sea::ParticleCensus::Body& body : census.floats)
    fmt::print("  {:<22}{:.6g} m3 displaced by its particles, {:.6g} m3 at the start{}\n", body.name, body.volume_m3,
               body.wetted_m3,
               !alone        ? ""
               : body.rise_m ? fmt::format("; it floats {:+.4g} m from there", *body.rise_m)
                             : "; it sinks");
  fmt::print("  {:<22}{:.4g} m/s ({}), {:.3g} m spacing, support {:.3g} m\n", "speed of sound", p.eos.c0,
             floating.particle_plan()->sound_speed_from, p.spacing, p.reach());
  if (p.viscosity == sph::ViscosityChoice::artificial && p.alpha > 0.0) {
    const int dim = s.sea.particles->planar() ? 2 : 3;
    const double on_all_pairs = sph::ViscosityArtificial<>{p.alpha, p.eos.c0, p.h()}.equivalent_kinematic(dim);
    fmt::print("  {:<22}that of a fluid of about {:.2g} m2/s: alpha {:.3g}, and half of alpha c0 h / {}\n", "viscosity",
               0.5 * on_all_pairs, p.alpha, 2 * (dim + 2));
  }
  fmt::print("  {:<22}{:.4g} s at rest, set by {}{}; {:.0f} to a window\n", "largest step", census.step_s, census.step_set_by,
             s.time.step_s ? fmt::format("; the scene asks for {} s", *s.time.step_s) : "", steps_per_window);
  return cost_of_particles(floating, census, steps_per_window);
}

}  // namespace spindrift::app
