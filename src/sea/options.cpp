// Declarations of [waves] and [sea]: see options.hpp. Why the defaults are what they are: docs/theory/sea_engineering.md,
// section 5. SPDX-License-Identifier: Apache-2.0
#include "src/sea/options.hpp"

#include <algorithm>

#include "kernels/waves/bound_waves.hpp"
#include "src/sea/wave_model.hpp"

namespace spindrift::sea {
namespace {

using scene::Section;

const Section<CoefficientsOptions>& coefficients_section() {
  static const auto section =
      Section<CoefficientsOptions>("coefficients", "Coefficients of one cylinder in place of those of [sea].")
          .text("cylinder", &CoefficientsOptions::cylinder, "Name of a cylinder in [[bodies.NAME.cylinders]].")
          .required()
          .number("drag_coefficient", &CoefficientsOptions::drag_coefficient, "-", "Transverse drag.", scene::between(0.0, 20.0))
          .number("added_mass_coefficient", &CoefficientsOptions::added_mass_coefficient, "-", "Transverse added mass.",
                  scene::between(0.0, 20.0))
          .number("axial_drag_coefficient", &CoefficientsOptions::axial_drag_coefficient, "-", "Drag of the exposed ends.",
                  scene::between(0.0, 100.0))
          .number("axial_added_mass_coefficient", &CoefficientsOptions::axial_added_mass_coefficient, "-",
                  "Added mass of the exposed ends.", scene::between(0.0, 100.0))
          .number("end_axial_drag_coefficient", &CoefficientsOptions::end_axial_drag_coefficient, "-",
                  "Drag at end_m, where it differs from that at start_m.", scene::between(0.0, 100.0))
          .number("end_axial_added_mass_coefficient", &CoefficientsOptions::end_axial_added_mass_coefficient, "-",
                  "Added mass at end_m, where it differs from that at start_m.", scene::between(0.0, 100.0))
          .choice("diffraction", &CoefficientsOptions::diffraction,
                  {{"none", "the cylinder is slender: added_mass_coefficient, whatever the wave"},
                   {"maccamy_fuchs", "waves scatter at an upright round column: their inertia load is MacCamy and Fuchs's"}},
                  "What a wide cylinder does to linear waves.");
  return section;
}

const Section<DampingOptions>& damping_section() {
  static const auto section =
      Section<DampingOptions>("damping", "Linear damping of one body in its own axes, of radiation or fitted to decay tests.")
          .text("body", &DampingOptions::body, "Name of a body.")
          .required()
          .vector("force_N_s_m", &DampingOptions::force_N_s_m, "N s/m", "Force per velocity in surge, sway and heave.",
                  scene::not_negative())
          .vector("moment_N_m_s", &DampingOptions::moment_N_m_s, "N m s", "Moment per angular velocity in roll, pitch and yaw.",
                  scene::not_negative())
          .vector("point_m", &DampingOptions::point_m, "m",
                  "Where the force acts, in earth coordinates of the start; the centre of mass where not given.");
  return section;
}

const Section<MatricesOptions>& matrices_section() {
  static const auto section =
      Section<MatricesOptions>("matrices",
                               "Stiffness and damping of a body over surge, sway, heave, roll, pitch, yaw of one of its "
                               "points, as a mooring's yaw spring or damping fitted to tests.")
          .text("body", &MatricesOptions::body, "Name of a body.")
          .required()
          .vector("point_m", &MatricesOptions::point_m, "m", "The point, initial earth coordinates.")
          .rows(
              "stiffness", &MatricesOptions::stiffness, "-",
              "Six rows: force and moment [N, N m] per displacement and rotation [m, rad] since the start, about the axes of the "
              "earth however the body yaws.")
          .rows("damping", &MatricesOptions::damping, "-", "Six rows: the same per velocity [m/s, rad/s].")
          .rows("quadratic_damping", &MatricesOptions::quadratic_damping, "-",
                "Six rows: the same per velocity times its magnitude, component by component.")
          .check([](const MatricesOptions& o, const scene::Report& report) {
            for (const auto& [key, rows] : {std::pair{"stiffness", &o.stiffness}, std::pair{"damping", &o.damping},
                                            std::pair{"quadratic_damping", &o.quadratic_damping}})
              if (!rows->empty() && rows->size() != 6) report(key, "must have six rows of six numbers");
          });
  return section;
}

const Section<PotentialOptions>& potential_section() {
  static const auto section =
      Section<PotentialOptions>("potential",
                                "Potential flow round one body, from the files of WAMIT or of a code that writes them.")
          .text("body", &PotentialOptions::body, "The body.")
          .required()
          .path("radiation_file", &PotentialOptions::radiation_file, "Added mass and damping, NAME.1.")
          .required()
          .path("excitation_file", &PotentialOptions::excitation_file,
                "Wave exciting forces, NAME.3; needed where there are waves.")
          .path("hydrostatics_file", &PotentialOptions::hydrostatics_file,
                "Hydrostatic stiffness of the water alone, NAME.hst of a run with the centre of mass at the files' origin: the "
                "body's mass has its weight; where absent, exact buoyancy of the body's cylinders.")
          .number("length_m", &PotentialOptions::length_m, "m", "ULEN, with which the files are made dimensional.",
                  scene::positive())
          .vector("point_m", &PotentialOptions::point_m, "m", "Origin of the files' axes, initial earth coordinates.")
          .number("volume_m3", &PotentialOptions::volume_m3, "m3",
                  "Displaced where the scene puts the body; with "
                  "hydrostatics_file.",
                  scene::positive())
          .vector("buoyancy_centre_m", &PotentialOptions::buoyancy_centre_m, "m",
                  "Earth x and y of the centre of that volume; its height is in the stiffness.")
          .choice("radiation", &PotentialOptions::radiation,
                  {{"convolution", "memory of the body's velocity, sampled at every step"},
                   {"state_space", "the same memory by poles fitted to it: less work at small steps"},
                   {"none", "added mass at infinite frequency alone"}},
                  "Waves that the body makes.")
          .number("memory_s", &PotentialOptions::memory_s, "s", "How long the water remembers.", scene::above(0.0).up_to(1e4))
          .only_if("radiation", {"convolution", "state_space"})
          .number(
              "fit_tolerance", &PotentialOptions::fit_tolerance, "-",
              "Root mean square error of the fitted memory over that of the memory; what needs more than 24 poles is refused.",
              scene::between(1e-5, 0.05))
          .only_if("radiation", {"state_space"})
          .choice("drift", &PotentialOptions::drift,
                  {{"none", "no slow drift of second order"},
                   {"mean", "its mean alone"},
                   {"newman", "mean and slow part, by Newman's approximation from the mean drift of each frequency"},
                   {"full", "mean and slow part from the file's matrix of difference frequencies"}},
                  "Wave loads at differences of frequencies.")
          .path("drift_file", &PotentialOptions::drift_file,
                "NAME.7, .8, .9 (mean drift) or NAME.10d, .11d, .12d (difference frequencies); \"full\" needs one of the latter.")
          .only_if("drift", {"mean", "newman", "full"})
          .required()
          .path("sum_frequency_file", &PotentialOptions::sum_frequency_file,
                "Wave loads at sums of frequencies, NAME.10s, .11s, .12s; without it there are none.")
          .check([](const PotentialOptions& o, const scene::Report& report) {
            if (!o.hydrostatics_file.empty() && !o.volume_m3) report("volume_m3", "must be given with hydrostatics_file");
            if (o.hydrostatics_file.empty() && o.volume_m3) report("volume_m3", "has no effect without hydrostatics_file");
          });
  return section;
}

std::vector<scene::Choice> wave_choices() {
  std::vector<scene::Choice> choices = wave_models().choices();
  choices.insert(choices.begin(), {"none", "still water"});
  return choices;
}

void check_waves(const WavesOptions& o, const scene::Report& report) {
  if (o.second_order && o.spreading_exponent)
    report("spreading_exponent", "must not be given with second_order: bound waves are those of a sea of one direction");
  if (o.second_order && o.components > int(waves::BoundWaves::most))
    report("components", "must be at most " + std::to_string(waves::BoundWaves::most) +
                             " with second_order, whose cost goes with their square");
  if (!o.spreading_exponent && o.spreading_range != WavesOptions{}.spreading_range)
    report("spreading_range_deg", "has no effect without spreading_exponent");
  if (o.crest_height_m) return;
  if (o.crest_time_s != 0.0) report("crest_time_s", "has no effect without crest_height_m");
  if (o.crest_place_m != WavesOptions{}.crest_place_m) report("crest_place_m", "has no effect without crest_height_m");
  if (o.crest_alone) report("crest_alone", "has no effect without crest_height_m");
}

void check_sea(const SeaOptions& o, const scene::Report& report) {
  for (std::size_t i = 1; i < o.current_profile.size(); ++i)
    if (!(o.current_profile[i][0] > o.current_profile[i - 1][0])) {
      report("current_profile", "must have its rows from the lowest z to the highest");
      break;
    }
}

}  // namespace

double growth_time(const WavesOptions& waves) {
  const double before_crest = std::max(0.0, waves.crest_time_s - waves.period_s);
  return waves.crest_height_m ? std::min(2.0 * waves.period_s, before_crest) : 2.0 * waves.period_s;
}

const Section<WavesOptions>& waves_section() {
  static const auto section =
      Section<WavesOptions>("waves", "The undisturbed sea.")
          .choice("model", &WavesOptions::model, wave_choices(), "Kind of waves.")
          .number("height_m", &WavesOptions::height_m, "m", "Crest to trough; of a sea state, the significant height.",
                  scene::positive())
          .required()
          .only_if("model", wave_models().with("height_m"))
          .number("period_s", &WavesOptions::period_s, "s", "Period; of a sea state, the peak period.", scene::positive())
          .required()
          .only_if("model", wave_models().with("period_s"))
          .degrees("direction_deg", &WavesOptions::direction, "Towards which the waves travel: 0 along x, 90 along y.",
                   scene::between(-360.0, 360.0))
          .only_if("model", wave_models().names())
          .degrees("phase_deg", &WavesOptions::phase, "Phase at the origin at time 0; 0 is a crest.",
                   scene::between(-360.0, 360.0))
          .only_if("model", wave_models().with("phase_deg"))
          .number("ramp_s", &WavesOptions::ramp_s, "s",
                  "Time over which the waves grow smoothly from nothing, 0 for full waves at once; where not given, two periods, "
                  "ending a period before the crest of crest_height_m, and 0 for the waves of a file.",
                  scene::not_negative())
          .only_if("model", wave_models().names())
          .flag("second_order", &WavesOptions::second_order,
                "With the waves that every two harmonics carry at the sum and the difference of their frequencies; the cost goes "
                "with the square of components.")
          .only_if("model", wave_models().with("second_order"))
          .choice("stretching", &WavesOptions::stretching,
                  {{"wheeler", "profiles are squeezed or stretched to the surface"},
                   {"vertical", "constant above still water"},
                   {"extrapolated", "the formula is used up to the surface"}},
                  "How linear kinematics reach the moving surface; nonlinear waves are always extrapolated. Not in a sea of "
                  "particles.")
          .only_if("model", wave_models().with("stretching"))
          .only_if("second_order", {"false"})
          .integer("seed", &WavesOptions::seed, "-",
                   "Seed of the random phases; the same seed gives the same sea on every computer.", scene::not_negative())
          .only_if("model", wave_models().with("seed"))
          .integer("components", &WavesOptions::components, "-", "Number of harmonics.", scene::between(8, 20000))
          .only_if("model", wave_models().with("components"))
          .choice("spacing", &WavesOptions::spacing,
                  {{"equal_energy", "each harmonic carries the same energy; the sea does not repeat"},
                   {"equal_frequency", "equal steps of frequency; the sea repeats after 2 pi / step"}},
                  "How the frequencies of the harmonics are chosen.")
          .only_if("model", wave_models().with("spacing"))
          .number("peak_enhancement", &WavesOptions::peak_enhancement, "-",
                  "Gamma of the JONSWAP spectrum; where not given, from height and period after DNV-RP-C205.",
                  scene::between(1.0, 7.0))
          .only_if("model", wave_models().with("peak_enhancement"))
          .path("file", &WavesOptions::file,
                "CSV file with columns time_s, elevation_m: the elevation at the origin at equal steps, over still water.")
          .only_if("model", wave_models().with("file"))
          .required()
          .number("highest_Hz", &WavesOptions::highest_Hz, "Hz",
                  "Harmonics of the file above it are left out; where not given, those that hold the last 0.1 % of the energy.",
                  scene::positive())
          .only_if("model", wave_models().with("highest_Hz"))
          .number("spreading_exponent", &WavesOptions::spreading_exponent, "-",
                  "s of a short-crested sea, whose directions b have the density |cos(pi (b - direction_deg) / "
                  "spreading_range_deg)|^2s; where not given, all waves travel in direction_deg.",
                  scene::between(0.0, 1000.0))
          .only_if("model", wave_models().with("spreading_exponent"))
          .degrees("spreading_range_deg", &WavesOptions::spreading_range, "Range of the directions; 180: half a circle.",
                   scene::between(1.0, 360.0))
          .only_if("model", wave_models().with("spreading_exponent"))
          .number("crest_height_m", &WavesOptions::crest_height_m, "m",
                  "Height over still water of a crest that the random sea is made to have (constrained NewWave).",
                  scene::positive())
          .only_if("model", wave_models().with("crest_height_m"))
          .number("crest_time_s", &WavesOptions::crest_time_s, "s", "When that crest is there.")
          .only_if("model", wave_models().with("crest_height_m"))
          .vector("crest_place_m", &WavesOptions::crest_place_m, "m", "Where: earth x and y.")
          .only_if("model", wave_models().with("crest_height_m"))
          .flag("crest_alone", &WavesOptions::crest_alone, "Only that crest and the waves that belong to it (NewWave).")
          .only_if("model", wave_models().with("crest_height_m"))
          .check(check_waves);
  return section;
}

const Section<SeaOptions>& sea_section() {
  static const std::vector<std::string> wet = {"hydrostatic", "morison", "potential"}, strips = {"morison", "potential"},
                                        particles = {"sph"}, gauged = {"morison", "potential", "sph"};
  static const auto section =
      Section<SeaOptions>("sea", "Hydrodynamic model.")
          .choice("model", &SeaOptions::model,
                  {{"none", "no water"},
                   {"hydrostatic", "exact buoyancy in still water and linear damping"},
                   {"morison", "exact buoyancy up to the waves; inertia and drag by strips (Morison), current, linear damping"},
                   {"potential",
                    "waves that the body scatters and makes, from a boundary-element code's files, with the drag of strips"},
                   {"sph", "a tank of particles (weakly compressible SPH): waves, breaking, green water, any motion"}},
                  "Model, cheapest first.")
          .number("drag_coefficient", &SeaOptions::drag_coefficient, "-", "Transverse drag of the cylinders, on the diameter.",
                  scene::between(0.0, 20.0))
          .only_if("model", strips)
          .number("added_mass_coefficient", &SeaOptions::added_mass_coefficient, "-",
                  "Transverse added mass of the cylinders, on the displaced mass.", scene::between(0.0, 20.0))
          .only_if("model", strips)
          .number("axial_drag_coefficient", &SeaOptions::axial_drag_coefficient, "-", "Drag of each exposed end, on its area.",
                  scene::between(0.0, 100.0))
          .only_if("model", strips)
          .number("axial_added_mass_coefficient", &SeaOptions::axial_added_mass_coefficient, "-",
                  "Added mass of each exposed end, on the water in a hemisphere over it.", scene::between(0.0, 100.0))
          .only_if("model", strips)
          .number("strip_length_m", &SeaOptions::strip_length_m, "m",
                  "Longest strip of a cylinder; each has two points of integration.", scene::positive())
          .only_if("model", strips)
          .vector("current_m_s", &SeaOptions::current_m_s, "m/s", "Uniform current, earth axes.", scene::between(-20.0, 20.0))
          .only_if("model", strips)
          .rows(
              "current_profile", &SeaOptions::current_profile, "-",
              "Rows of z [m] and the current's velocity along x and y [m/s] there, from below; linear between, constant beyond. "
              "Adds to current_m_s.")
          .only_if("model", strips)
          .tables("coefficients", &SeaOptions::coefficients, coefficients_section(), "Coefficients of single cylinders.")
          .only_if("model", strips)
          .tables("damping", &SeaOptions::damping, damping_section(), "Linear damping of bodies.")
          .only_if("model", wet)
          .tables("matrices", &SeaOptions::matrices, matrices_section(), "Stiffness and damping over all six motions of bodies.")
          .only_if("model", wet)
          .table("potential", &SeaOptions::potential, potential_section(), "Potential flow round a body.")
          .only_if("model", {"potential"})
          .required()
          .table("particles", &SeaOptions::particles, particle_section(), "Resolution and schemes.")
          .only_if("model", particles)
          .required()
          .table("tank", &SeaOptions::tank, tank_section(), "Where water may be.")
          .only_if("model", particles)
          .required()
          .tables("water", &SeaOptions::water, water_section(),
                  "Boxes of water; where there are none the tank is filled to z = 0.")
          .only_if("model", particles)
          .tables("obstacles", &SeaOptions::obstacles, obstacle_section(), "Fixed boxes.")
          .only_if("model", particles)
          .table("wavemaker", &SeaOptions::wavemaker, wavemaker_section(), "A paddle.")
          .only_if("model", particles)
          .tables("damping_zones", &SeaOptions::damping_zones, damping_zone_section(), "Where waves die away.")
          .only_if("model", particles)
          .table("initial", &SeaOptions::initial, initial_section(), "How the sea starts.")
          .only_if("model", particles)
          .tables("gauges", &SeaOptions::gauges, gauge_section(), "Wave gauges.")
          .only_if("model", gauged)
          .tables("probes", &SeaOptions::probes, probe_section(), "Pressure and velocity probes.")
          .only_if("model", particles)
          .tables("sensors", &SeaOptions::sensors, sensor_section(), "Pressure and force on patches of walls and bodies.")
          .only_if("model", particles)
          .table("fields", &SeaOptions::fields, fields_section(), "Output for ParaView.")
          .only_if("model", particles)
          .check(check_sea);
  return section;
}

}  // namespace spindrift::sea
