// What a scene may say about a sea of particles (sea.model = "sph"): [sea.particles], [sea.tank], [[sea.water]],
// [[sea.obstacles]], [sea.wavemaker], [[sea.damping_zones]], [sea.initial], [[sea.gauges]], [[sea.probes]], [[sea.sensors]],
// [sea.fields]. Part of SeaOptions. Used by src/sea/particle_sea.cpp and src/sea/sph; tested in
// tests/coupled/particle_sea_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "src/scene/surface_file.hpp"
#include "src/sea/sph/parameters.hpp"

namespace spindrift::scene {
template <class Options>
class Section;
}

namespace spindrift::sea {

/// [sea.particles]: resolution and schemes.
struct ParticleOptions {
  double spacing_m = 0.0;
  std::string dimensions = "3";
  double width_m = 1.0;  ///< 2-D: loads are those of this width of sea
  double smoothing_over_spacing = 1.5;
  sph::KernelChoice kernel = sph::KernelChoice::quintic;
  std::optional<double> sound_speed_factor;  ///< times sqrt(g depth)
  std::optional<double> sound_speed_m_s;
  sph::ViscosityChoice viscosity_model = sph::ViscosityChoice::artificial;
  double viscosity = 0.02;                 ///< alpha of the artificial viscosity
  std::optional<double> solid_viscosity;   ///< with walls and bodies; where absent that of the water on no_slip walls, else 0
  double kinematic_viscosity_m2_s = 1e-6;  ///< of the laminar models
  std::optional<double> solid_kinematic_viscosity_m2_s;
  std::string walls = "extrapolated";    ///< dynamic, extrapolated, extrapolated_no_slip, modified, ...
  std::string body_particles = "water";  ///< whose mass a body's particles have: water's, or their share of the body's own
  bool contact = true;                   ///< of bodies with walls and each other
  double contact_stiffness = 1.0, contact_damping = 0.2, contact_friction = 0.0;
  sph::DiffusionChoice density_diffusion = sph::DiffusionChoice::fourtakas;
  double diffusion_strength = 0.1;
  sph::FilterChoice density_filter = sph::FilterChoice::none;
  int filter_every = 30;
  double shifting = 0.0;
  sph::StepChoice step = sph::StepChoice::symplectic;
  double cfl = 0.2;
  int limits_every = 1;  ///< substeps between two checks of the limits
  std::string precision = "single";
  int verlet_join_every = 10;
  std::optional<int> lost_at_most;
  double jitter = 0.0;  ///< of the water's particles at the start, in spacings
  std::int64_t jitter_seed = 1;

  bool planar() const { return dimensions == "2"; }
  bool modified_walls() const { return walls.starts_with("modified"); }
};

/// [sea.tank]: where water may be.
struct TankOptions {
  std::array<double, 2> x_m{}, y_m{};
  double top_m = 0.0;  ///< of the walls; above it is open
  std::string sides_x = "wall", sides_y = "wall";
  std::string over_edge = "splash";
  std::vector<scene::MeshOptions> meshes;
  std::vector<std::array<double, 2>> bed_m;  ///< [x, z]: height of the bed along x; flat at the water depth where empty

  bool symmetric() const { return sides_y == "symmetric"; }
};

/// [[sea.water]], [[sea.obstacles]]
struct BoxOptions {
  Eigen::Vector3d low_m = Eigen::Vector3d::Zero(), high_m = Eigen::Vector3d::Zero();
};

/// [sea.wavemaker]: a wall at the low x end that makes the waves of [waves].
struct WavemakerOptions {
  std::string type = "piston";
  std::optional<double> ramp_s;  ///< growth_time([waves]) where absent, 0 in water that moves already
  double start_s = 0.0;
  std::optional<double> hinge_m;   ///< flap: height of its hinge; the bed where absent
  std::optional<double> stroke_m;  ///< of a regular wave, instead of what linear theory asks for
};

/// [[sea.damping_zones]]
struct DampingZoneOptions {
  double from_m = 0.0, to_m = 0.0;  ///< no damping there; full damping there
  double rate_1_s = 0.0;
  std::string axis = "x";        ///< x, y
  std::string towards = "rest";  ///< rest, waves
};

/// [sea.initial]
struct InitialOptions {
  std::string state = "still";  ///< still, waves, standing, file
  std::string file;
  double settle_s = 0.0;
  double settle_damping_1_s = 0.0;
};

/// [[sea.gauges]]
struct GaugeOptions {
  std::string name;
  std::array<double, 2> point_m{};
  std::string body;  ///< that it goes with; empty: stands
};
/// [[sea.sensors]]
struct SensorOptions {
  std::string name;
  std::string body;  ///< empty: walls and obstacles
  Eigen::Vector3d low_m = Eigen::Vector3d::Zero(), high_m = Eigen::Vector3d::Zero();
  double mean_over_s = 0.0;  ///< 0: one window
};
/// [[sea.probes]]
struct ProbeOptions {
  std::string name;
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();
};

/// [sea.fields]: particles and surface for ParaView and the report.
struct FieldsOptions {
  double interval_s = 0.0;
  double from_s = 0.0;
  std::optional<double> to_s;
  std::vector<std::string> particles{"velocity", "pressure"};
  std::optional<Eigen::Vector3d> low_m, high_m;  ///< only particles inside
  bool solids = true;
  double surface_spacing_m = 0.0;  ///< 0: no height field
};

const scene::Section<ParticleOptions>& particle_section();
const scene::Section<TankOptions>& tank_section();
const scene::Section<BoxOptions>& water_section();
const scene::Section<BoxOptions>& obstacle_section();
const scene::Section<WavemakerOptions>& wavemaker_section();
const scene::Section<DampingZoneOptions>& damping_zone_section();
const scene::Section<InitialOptions>& initial_section();
const scene::Section<GaugeOptions>& gauge_section();
const scene::Section<ProbeOptions>& probe_section();
const scene::Section<SensorOptions>& sensor_section();
const scene::Section<FieldsOptions>& fields_section();

}  // namespace spindrift::sea
