// Declarations of the sections of a sea of particles: see particle_options.hpp. How to choose: docs/user/sea_of_particles.md.
// SPDX-License-Identifier: Apache-2.0
#include "src/sea/particle_options.hpp"

#include "src/scene/cases.hpp"
#include "src/scene/section.hpp"

namespace spindrift::sea {

using scene::above;
using scene::between;
using scene::not_negative;
using scene::positive;
using scene::Section;

namespace {

Section<BoxOptions> box(const char* name, const char* help) {
  return Section<BoxOptions>(name, help)
      .vector("low_m", &BoxOptions::low_m, "m", "Lowest corner.")
      .required()
      .vector("high_m", &BoxOptions::high_m, "m", "Highest corner.")
      .required()
      .check([](const BoxOptions& o, const scene::Report& report) {
        for (int k = 0; k < 3; ++k)
          if (!(o.high_m[k] > o.low_m[k])) return report("high_m", "must be above low_m along every axis");
      });
}

scene::Models<sph::ViscosityModel> viscosity_models() { return scene::Models<sph::ViscosityModel>(sph::viscosities()); }

void check_span(const std::array<double, 2>& span, const char* key, const scene::Report& report) {
  if (!(span[1] > span[0])) report(key, "must go from the lower to the higher end");
}

}  // namespace

const Section<ParticleOptions>& particle_section() {
  static const auto section =
      Section<ParticleOptions>("particles", "Resolution and schemes of the sea of particles (docs/theory/sph.md).")
          .number("spacing_m", &ParticleOptions::spacing_m, "m", "Distance d between particles at the start.", positive())
          .required()
          .choice("dimensions", &ParticleOptions::dimensions,
                  {{"2", "the plane of x and z, which bodies stay in; their loads are those of width_m"}, {"3", "space"}},
                  "Dimensions of the scene.")
          .number("width_m", &ParticleOptions::width_m, "m", "Width of sea that a 2-D scene stands for.", positive())
          .only_if("dimensions", {"2"})
          .number("smoothing_over_spacing", &ParticleOptions::smoothing_over_spacing, "-",
                  "Smoothing length h over d; pairs meet within 2 h. Larger is smoother and dearer.", between(1.0, 3.0))
          .choice("kernel", &ParticleOptions::kernel,
                  {{"quintic_spline", sph::KernelChoice::quintic,
                    "quintic B-spline; at h/d 1.5 rows of particles have no effect on it: waves keep speed and height"},
                   {"wendland", sph::KernelChoice::wendland, "Wendland's C2, an eighth cheaper; waves need h/d 2.5"},
                   {"cubic_spline", sph::KernelChoice::cubic, "cubic B-spline"}},
                  "Smoothing kernel.")
          .number("sound_speed_factor", &ParticleOptions::sound_speed_factor, "-",
                  "Speed of sound over sqrt(gravity x water depth). Where neither this nor sound_speed_m_s is given it is 10, "
                  "which keeps density within 1 %, 20 for water that breaks, falls or runs out at open sides. It is at least 20 "
                  "times the speed of bodies that enter the water.",
                  between(5.0, 400.0))
          .number("sound_speed_m_s", &ParticleOptions::sound_speed_m_s, "m/s", "Speed of sound itself.", positive())
          .choice("viscosity_model", &ParticleOptions::viscosity_model,
                  scene::cases<ParticleOptions, sph::ViscosityChoice>(viscosity_models()), "Viscosity of the water.")
          .number("viscosity", &ParticleOptions::viscosity, "-", "Alpha of the artificial viscosity.", between(0.0, 2.0))
          .only_if("viscosity_model", viscosity_models().with("viscosity"))
          .number(
              "solid_viscosity", &ParticleOptions::solid_viscosity, "-",
              "The same between water and walls or bodies. Where absent 0, as in the paper; that of the water on no_slip walls.",
              between(0.0, 2.0))
          .only_if("viscosity_model", viscosity_models().with("solid_viscosity"))
          .number("kinematic_viscosity_m2_s", &ParticleOptions::kinematic_viscosity_m2_s, "m2/s",
                  "Kinematic viscosity. Free waves lose 0.45 of what they lose in a fluid of that viscosity.", not_negative())
          .only_if("viscosity_model", viscosity_models().with("kinematic_viscosity_m2_s"))
          .number("solid_kinematic_viscosity_m2_s", &ParticleOptions::solid_kinematic_viscosity_m2_s, "m2/s",
                  "The same between water and walls or bodies; that of the water where absent.", not_negative())
          .only_if("viscosity_model", viscosity_models().with("solid_kinematic_viscosity_m2_s"))
          .choice("walls", &ParticleOptions::walls,
                  {{"extrapolated", "pressure carried on from the water beside them (Adami et al. 2012), velocity their own"},
                   {"extrapolated_no_slip", "the same, water sticks"},
                   {"dynamic", "particles whose density follows continuity (Crespo et al. 2007)"},
                   {"modified", "density carried on from the water beside them (English et al. 2022), velocity their own"},
                   {"modified_no_slip", "the same, water sticks"},
                   {"modified_free_slip", "the same, water slides"}},
                  "What walls and bodies do to the water beside them; modified ones need a level bed.")
          .choice("body_particles", &ParticleOptions::body_particles,
                  {{"water",
                    "the mass of water's particles: a body is as heavy as its mass_kg says, and the water feels its shape alone"},
                   {"own",
                    "its mass_kg over their number, the relative weight of Leble & Barakos (2016) taken literally: to compare "
                    "with codes that do so; light bodies are not lifted by Archimedes' force"}},
                  "Mass with which the water feels a particle of a body.")
          .flag("contact", &ParticleOptions::contact, "Bodies touch walls and each other; the loads are columns BODY.contact.")
          .number("contact_stiffness", &ParticleOptions::contact_stiffness, "-", "Stiffness of contact over that of the water.",
                  between(0.01, 1.0))
          .only_if("contact", {"true"})
          .number("contact_damping", &ParticleOptions::contact_damping, "-", "Damping of contact, as a share of critical.",
                  between(0.0, 1.0))
          .only_if("contact", {"true"})
          .number("contact_friction", &ParticleOptions::contact_friction, "-", "Coulomb's coefficient of friction.",
                  between(0.0, 2.0))
          .only_if("contact", {"true"})
          .choice("density_diffusion", &ParticleOptions::density_diffusion,
                  {{"none", sph::DiffusionChoice::none, "pressure may be noisy"},
                   {"molteni", sph::DiffusionChoice::molteni, "Molteni & Colagrossi (2009)"},
                   {"fourtakas", sph::DiffusionChoice::fourtakas, "Fourtakas et al. (2019), hydrostatic part taken out"}},
                  "Diffusion of density, which smooths the pressure.")
          .number("diffusion_strength", &ParticleOptions::diffusion_strength, "-", "Delta of the density diffusion.",
                  between(0.0, 0.5))
          .only_if("density_diffusion", {"molteni", "fourtakas"})
          .choice("density_filter", &ParticleOptions::density_filter,
                  {{"none", sph::FilterChoice::none, "density is what continuity makes it"},
                   {"shepard", sph::FilterChoice::shepard, "zeroth order"},
                   {"mls", sph::FilterChoice::mls, "first order"}},
                  "Filter that sets the density anew every so many steps.")
          .integer("filter_every", &ParticleOptions::filter_every, "-", "Steps from one filter to the next.", between(1, 1e6))
          .only_if("density_filter", {"shepard", "mls"})
          .number("shifting", &ParticleOptions::shifting, "-",
                  "Strength of particle shifting, 1 to 6; 0: none. Keeps particles even in violent flow; not for waves.",
                  between(0.0, 6.0))
          .choice("step", &ParticleOptions::step,
                  {{"symplectic", sph::StepChoice::symplectic, "two evaluations, second order (the paper's)"},
                   {"verlet", sph::StepChoice::verlet, "one evaluation, half the cost, half the accuracy"}},
                  "Time step of the particles.")
          .integer("verlet_join_every", &ParticleOptions::verlet_join_every, "-",
                   "Steps from one that ties the two chains of Verlet's step together to the next. With 40 waves blow up at the "
                   "default cfl, with 20 at 0.3.",
                   between(2, 1000))
          .only_if("step", {"verlet"})
          .number("cfl", &ParticleOptions::cfl, "-", "Courant number of the acoustic, force and viscous limits.",
                  above(0.0).up_to(0.6))
          .integer("limits_every", &ParticleOptions::limits_every, "-",
                   "Substeps from one check of these limits to the next. On many ranks a check is a reduction that all wait for; "
                   "between two checks substeps keep to 0.9 of the limits.",
                   between(1, 20))
          .choice("precision", &ParticleOptions::precision,
                  {{"single", "pairs in float, state in double"}, {"double", "everything in double, about twice the time"}},
                  "Arithmetic of the pairs.")
          .integer("lost_at_most", &ParticleOptions::lost_at_most, "-",
                   "Particles that may slip through walls before the run stops; each is counted in history.csv. One in ten "
                   "thousand of the water, or ten, where absent.",
                   between(0, 1e9))
          .number("jitter", &ParticleOptions::jitter, "-",
                  "Largest displacement of the water's particles along each axis from their lattice at the start, in spacings: "
                  "runs of another jitter_seed differ by chance alone, as the replicas of a study do.",
                  between(0.0, 0.2))
          .integer("jitter_seed", &ParticleOptions::jitter_seed, "-",
                   "Seed of the displacements; the same seed gives the same ones on every computer.", not_negative())
          .check([](const ParticleOptions& o, const scene::Report& report) {
            if (o.jitter_seed != ParticleOptions{}.jitter_seed && o.jitter == 0.0)
              report("jitter_seed", "has no effect: jitter is 0");
          })
          .at_most_one_of({"sound_speed_factor", "sound_speed_m_s"});
  return section;
}

const Section<scene::MeshOptions>& tank_mesh_section() {
  static const auto section =
      scene::mesh_section(
          "A surface of triangles as walls of the tank: a beach, a sill, a basin. Walls are stairs of the particles' lattice.")
          .choice("water", &scene::MeshOptions::water,
                  {{"outside", "the surface encloses something solid"}, {"inside", "all around the surface is solid: a basin"}},
                  "Where water may be.");
  return section;
}

const Section<TankOptions>& tank_section() {
  static const std::vector<scene::Choice> sides = {{"wall", "walls of particles"},
                                                   {"periodic", "what leaves on one side enters on the other"},
                                                   {"open", "no walls: what comes there leaves, counted in history.csv"}};
  static const std::vector<scene::Choice> sides_y = [] {
    std::vector<scene::Choice> all = sides;
    all.push_back({"symmetric",
                   "a wall at the upper y; the lower one is a plane of symmetry, through the middle of all bodies, and the tank "
                   "half of one. Loads, masses and energies are those of the whole; bodies stay in the plane"});
    return all;
  }();
  static const auto section =
      Section<TankOptions>("tank",
                           "The tank: walls, bed and open sides. Still water stands at z = 0, the flat bed at the water depth.")
          .vector("x_m", &TankOptions::x_m, "m", "From and to along x; a wavemaker stands at the lower end.")
          .required()
          .vector("y_m", &TankOptions::y_m, "m", "From and to along y; not used in 2-D.")
          .number("top_m", &TankOptions::top_m, "m", "Height of the walls' upper edge.")
          .required()
          .choice("over_edge", &TankOptions::over_edge,
                  {{"splash", "one in a hundred particles of the water may go; more ends the run"}, {"open", "any may go"}},
                  "What may leave over the walls' upper edge, counted in history.csv.")
          .choice("sides_x", &TankOptions::sides_x, sides, "The two ends.")
          .choice("sides_y", &TankOptions::sides_y, sides_y, "The two long sides.")
          .rows("bed_m", &TankOptions::bed_m, "m",
                "Slopes and beaches: rows [x, z] of the bed's height, straight between them and level beyond; level at the water "
                "depth "
                "where there are none.")
          .tables(
              "meshes", &TankOptions::meshes, tank_mesh_section(),
              "Walls from STL files, closed surfaces of triangles: beaches, sills, basins. They become stairs of the lattice.")
          .check([](const TankOptions& o, const scene::Report& report) {
            check_span(o.x_m, "x_m", report);
            for (std::size_t n = 1; n < o.bed_m.size(); ++n)
              if (!(o.bed_m[n][0] > o.bed_m[n - 1][0])) return report("bed_m", "x must increase from row to row");
          });
  return section;
}

const Section<BoxOptions>& water_section() {
  static const auto section =
      box("water",
          "A box of water at the start, with a surface of its own. At a paddle, and in zones towards waves, it is at z = 0.");
  return section;
}
const Section<BoxOptions>& obstacle_section() {
  static const auto section = box("obstacles", "A fixed box in the tank, made of wall particles.");
  return section;
}

const Section<WavemakerOptions>& wavemaker_section() {
  static const auto section =
      Section<WavemakerOptions>(
          "wavemaker",
          "A paddle at the lower x end that makes the waves of [waves] by linear theory (Biesel); stokes2 adds "
          "Madsen's second-order motion, sea states are sums of their harmonics.")
          .choice("type", &WavemakerOptions::type, {{"piston", "moves as a whole"}, {"flap", "turns about a hinge"}},
                  "Kind of paddle.")
          .number("ramp_s", &WavemakerOptions::ramp_s, "s",
                  "Time over which the paddle's motion grows smoothly from nothing; where not given, two periods, and 0 with the "
                  "waves of a file. Where the water starts in waves it is 0.",
                  not_negative())
          .number("start_s", &WavemakerOptions::start_s, "s",
                  "When the paddle starts; negative: while the bodies are still held.", between(-1e6, 1e6))
          .number("hinge_m", &WavemakerOptions::hinge_m, "m", "Height of the flap's hinge; the bed where absent.")
          .only_if("type", {"flap"})
          .number("stroke_m", &WavemakerOptions::stroke_m, "m",
                  "Stroke of a regular wave (of a flap at still water) in place of that of linear theory.", positive());
  return section;
}

const Section<DampingZoneOptions>& damping_zone_section() {
  static const auto section =
      Section<DampingZoneOptions>(
          "damping_zones",
          "A stretch of x or y where the water is brought to rest, or to the motion w of [waves]: dv/dt "
          "= rate s^2 (w - v), s from 0 to 1; towards waves to 1 in the middle and back to 0, and there to rest.")
          .number("from_m", &DampingZoneOptions::from_m, "m", "Where the damping begins.")
          .required()
          .number("to_m", &DampingZoneOptions::to_m, "m",
                  "Where it has its full rate, which holds from there to the tank's end; towards waves where leading has ended. "
                  "Below from_m for a zone at the lower end.")
          .required()
          .number("rate_1_s", &DampingZoneOptions::rate_1_s, "1/s",
                  "Full rate; about the waves' angular frequency times 2 to 5, towards waves times 8 to 30.", positive())
          .required()
          .choice("axis", &DampingZoneOptions::axis, {{"x", "along the tank"}, {"y", "across it, in 3-D"}},
                  "Direction of the stretch.")
          .choice("towards", &DampingZoneOptions::towards,
                  {{"rest", "waves die away"},
                   {"waves",
                    "the sea follows [waves] there, to their order: they keep their height, and what bodies radiate dies away"}},
                  "What the water is brought to.")
          .check([](const DampingZoneOptions& o, const scene::Report& report) {
            if (o.from_m == o.to_m) report("to_m", "is where from_m is");
          });
  return section;
}

const Section<InitialOptions>& initial_section() {
  static const auto section =
      Section<InitialOptions>("initial", "How the sea starts.")
          .choice("state", &InitialOptions::state,
                  {{"still", "at rest, density that of rest"},
                   {"waves", "in the motion of [waves], to its order, at t = 0"},
                   {"standing", "[waves] and its mirror image at half the height: highest crest at x = 0 at t = 0"},
                   {"file", "as a checkpoint of a run of the same sea left it"}},
                  "State of the water.")
          .path("file", &InitialOptions::file,
                "Checkpoint (checkpoints/*.h5 of a run), or another file of that run's folder, which stands for its newest.")
          .only_if("state", {"file"})
          .required()
          .number("settle_s", &InitialOptions::settle_s, "s",
                  "The sea runs this long before t = 0 with the bodies held where they start, then they are released (the "
                  "paper's start).",
                  not_negative())
          .number(
              "settle_damping_1_s", &InitialOptions::settle_damping_1_s, "1/s",
              "Until t = 0 the water's velocity decays at this rate, which calms particles that settle; not with waves before "
              "then.",
              not_negative());
  return section;
}

const Section<GaugeOptions>& gauge_section() {
  static const auto section =
      Section<GaugeOptions>("gauges",
                            "A wave gauge: height of the water's surface at a place. Without particles that of the "
                            "undisturbed waves.")
          .text("name", &GaugeOptions::name, "Name of the columns.")
          .required()
          .vector("point_m", &GaugeOptions::point_m, "m", "x and y.")
          .required()
          .text("body", &GaugeOptions::body,
                "Run-up: the gauge goes with this body, from point_m where the scene describes it; a "
                "spacing off its surface reads best.");
  return section;
}

const Section<SensorOptions>& sensor_section() {
  static const auto section =
      Section<SensorOptions>("sensors",
                             "Pressure and force of the water on a patch, averaged over its area and over time: a rectangle on a "
                             "wall, or the part of a body's surface in a box.")
          .text("name", &SensorOptions::name, "Name of the columns.")
          .required()
          .text("body", &SensorOptions::body, "Body whose surface it is; walls, obstacles and paddle of the tank where absent.")
          .vector("low_m", &SensorOptions::low_m, "m",
                  "Lowest corner; of a body where the scene describes it. On walls the box is flat along one axis.")
          .required()
          .vector("high_m", &SensorOptions::high_m, "m", "Highest corner.")
          .required()
          .number("mean_over_s", &SensorOptions::mean_over_s, "s",
                  "Time before each row over which it is averaged; one window where absent.", not_negative())
          .check([](const SensorOptions& o, const scene::Report& report) {
            for (int k = 0; k < 3; ++k)
              if (o.high_m[k] < o.low_m[k]) return report("high_m", "must not be below low_m along any axis");
          });
  return section;
}

const Section<ProbeOptions>& probe_section() {
  static const auto section = Section<ProbeOptions>("probes", "Pressure and velocity of the water at a point.")
                                  .text("name", &ProbeOptions::name, "Name of the columns.")
                                  .required()
                                  .vector("point_m", &ProbeOptions::point_m, "m", "The point.")
                                  .required();
  return section;
}

const Section<FieldsOptions>& fields_section() {
  static const auto section =
      Section<FieldsOptions>("fields", "Particles and the water's surface, written for ParaView.")
          .number("interval_s", &FieldsOptions::interval_s, "s", "Simulated time between outputs, rounded to windows.",
                  positive())
          .required()
          .number("from_s", &FieldsOptions::from_s, "s", "First output.", between(-1e6, 1e6))
          .number("to_s", &FieldsOptions::to_s, "s", "Last output; the end where absent.", between(-1e6, 1e6))
          .texts("particles", &FieldsOptions::particles,
                 "Fields of the particles: velocity, pressure, density, owner; none: no particles. Owner comes by itself with "
                 "solids.")
          .vector("low_m", &FieldsOptions::low_m, "m", "Only particles above this corner.")
          .vector("high_m", &FieldsOptions::high_m, "m", "Only particles below this corner.")
          .flag("solids", &FieldsOptions::solids, "Walls and bodies are written too.")
          .number("surface_spacing_m", &FieldsOptions::surface_spacing_m, "m",
                  "Mesh of the height field of the surface; 0: none.", not_negative())
          .check([](const FieldsOptions& o, const scene::Report& report) {
            for (const std::string& name : o.particles) {
              if (std::ranges::count(o.particles, name) > 1) return report("particles", "has \"" + name + "\" twice");
              if (name != "velocity" && name != "pressure" && name != "density" && name != "owner")
                return report("particles", "has \"" + name + "\"; known: velocity, pressure, density, owner");
            }
          });
  return section;
}

}  // namespace spindrift::sea
