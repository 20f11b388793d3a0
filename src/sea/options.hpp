// What a scene may say about waves and about the engineering models of the sea: [waves], [sea], [[sea.coefficients]],
// [[sea.damping]]. Read by the coupling, which builds an EngineeringSea from them; tested in tests/src/sea.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "src/scene/section.hpp"
#include "src/sea/particle_options.hpp"

namespace spindrift::sea {

/// [waves]
struct WavesOptions {
  std::string model = "none";                  ///< none, or a name of wave_models()
  double height_m = 0.0;                       ///< crest to trough; of a sea state, the significant height
  double period_s = 0.0;                       ///< of a sea state, the peak period
  double direction = 0.0;                      ///< towards which the waves travel, from x to y [rad]
  double phase = 0.0;                          ///< of a regular wave at the origin at t = 0; 0: a crest [rad]
  std::optional<double> ramp_s;                ///< the waves grow from nothing over this time; at once where absent
  std::string stretching = "wheeler";          ///< wheeler, vertical, extrapolated (stokes2 is always extrapolated)
  std::int64_t seed = 1;                       ///< of the random phases
  int components = 200;                        ///< harmonics of a sea state
  std::string spacing = "equal_energy";        ///< equal_energy, equal_frequency
  std::optional<double> peak_enhancement;      ///< gamma of JONSWAP; from height and period where absent (DNV-RP-C205)
  bool second_order = false;                   ///< of a sea state: with its bound waves
  std::optional<double> spreading_exponent;    ///< s of |cos(pi b / range)|^2s; absent: one direction
  double spreading_range = 6.283185307179586;  ///< [rad]
  std::optional<double> crest_height_m;        ///< of a constrained sea, over still water
  double crest_time_s = 0.0;
  std::array<double, 2> crest_place_m{0.0, 0.0};
  bool crest_alone = false;          ///< NewWave: without the random sea
  std::string file;                  ///< path, of a measured sea
  std::optional<double> highest_Hz;  ///< of a measured sea's harmonics
};

/// Time over which waves grow where the scene does not say [s]: two periods, so that what floats is not struck by a whole wave at
/// the start. It ends a period before the crest that the scene asks for; the times of a measured sea are its own.
double growth_time(const WavesOptions& waves);

/// [[sea.coefficients]]: what one cylinder has instead of the values of [sea].
struct CoefficientsOptions {
  std::string cylinder;
  std::optional<double> drag_coefficient, added_mass_coefficient, axial_drag_coefficient, axial_added_mass_coefficient;
  std::optional<double> end_axial_drag_coefficient, end_axial_added_mass_coefficient;  ///< those of both ends where absent
  std::string diffraction = "none";                                                    ///< none, maccamy_fuchs
};

/// [[sea.damping]]: linear damping of one body in its own axes, e.g. radiation damping or one fitted to decay tests.
struct DampingOptions {
  std::string body;
  Eigen::Vector3d force_N_s_m = Eigen::Vector3d::Zero();   ///< surge, sway, heave
  Eigen::Vector3d moment_N_m_s = Eigen::Vector3d::Zero();  ///< roll, pitch, yaw
  std::optional<Eigen::Vector3d> point_m;  ///< initial earth position where the force acts; the centre of mass where absent
};

/// [[sea.matrices]]: stiffness and damping of one body over all six motions of one of its points.
struct MatricesOptions {
  std::string body;
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();                         ///< initial earth coordinates
  std::vector<std::array<double, 6>> stiffness, damping, quadratic_damping;  ///< six rows or none [SI]
};

/// [sea.potential]
struct PotentialOptions {
  std::string body;
  std::string radiation_file, excitation_file, hydrostatics_file;  ///< paths
  double length_m = 1.0;
  Eigen::Vector3d point_m = Eigen::Vector3d::Zero();  ///< initial earth coordinates
  std::optional<double> volume_m3;
  std::array<double, 2> buoyancy_centre_m{0.0, 0.0};
  std::string radiation = "convolution";  ///< convolution, state_space, none
  double memory_s = 60.0;
  double fit_tolerance = 0.002;                ///< of a state space, share of K
  std::string drift = "none";                  ///< none, mean, newman, full
  std::string drift_file, sum_frequency_file;  ///< paths
};

/// [sea]
struct SeaOptions {
  std::string model = "none";                  ///< none, hydrostatic, morison, potential, sph
  double drag_coefficient = 1.0;               ///< transverse, on the diameter
  double added_mass_coefficient = 1.0;         ///< transverse, on the displaced mass
  double axial_drag_coefficient = 1.0;         ///< of each exposed end, on its area
  double axial_added_mass_coefficient = 0.64;  ///< of each exposed end, on the hemisphere 2/3 pi R^3; 2/pi: one side of a disc
  double strip_length_m = 5.0;                 ///< longest strip of a cylinder
  Eigen::Vector3d current_m_s = Eigen::Vector3d::Zero();  ///< uniform, earth axes
  std::vector<std::array<double, 3>> current_profile;     ///< rows of z [m], velocity along x and y [m/s]; adds to it
  std::vector<CoefficientsOptions> coefficients;
  std::vector<DampingOptions> damping;
  std::vector<MatricesOptions> matrices;
  std::optional<PotentialOptions> potential;
  // of "sph"
  std::optional<ParticleOptions> particles;
  std::optional<TankOptions> tank;
  std::vector<BoxOptions> water, obstacles;
  std::optional<WavemakerOptions> wavemaker;
  std::vector<DampingZoneOptions> damping_zones;
  std::optional<InitialOptions> initial;
  std::vector<GaugeOptions> gauges;
  std::vector<ProbeOptions> probes;
  std::vector<SensorOptions> sensors;
  std::optional<FieldsOptions> fields;

  bool has_particles() const { return model == "sph"; }
  /// Of the water at the start, which stands at z = 0 where there are no boxes of it [m].
  double lowest_surface() const {
    if (water.empty()) return 0.0;
    return std::ranges::min(water, {}, [](const BoxOptions& box) { return box.high_m.z(); }).high_m.z();
  }
  double settle_s() const { return initial ? initial->settle_s : 0.0; }
  bool starts_in_waves() const { return initial && (initial->state == "waves" || initial->state == "standing"); }
  bool led_to_waves() const {
    return std::ranges::any_of(damping_zones, [](const auto& zone) { return zone.towards == "waves"; });
  }
};

const scene::Section<WavesOptions>& waves_section();
const scene::Section<SeaOptions>& sea_section();

/// What [environment] and the still-water level mean for the sea.
struct SeaEnvironment {
  double water_density = 1025.0;  ///< [kg/m3]
  double water_depth = 100.0;     ///< [m]
  double gravity = 9.80665;       ///< [m/s2]
};

}  // namespace spindrift::sea
