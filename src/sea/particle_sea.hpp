// The sea of particles for the coupling: bodies held or moving in a tank, advanced in substeps between which the coupling
// moves them, with instruments, output and a state that can be saved and put back. Hides dimensions and precision.
// Called by src/coupling (sea_window.cpp, recorder.cpp) and src/run; tested in tests/coupled/particle_sea_test.cpp and
// tests/coupled.
//
//   const ParticlePlan plan = particle_plan(options, waves, environment, bodies);  // checked before; cheap
//   auto sea = ParticleSea::make(plan, motions at the start, world);  // this and all that follows on all ranks alike
//   sea->evaluate(t, motions);               // loads() are those at t: for what is written before the first window
//   sea->record(graph, driver, first_tag);   // a window's steps as tasks; the driver moves the bodies
//   sea->balance(), sea->open(t, motions, settling);  // before each run of the tasks,
//   sea->close();                                     // and after it
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kernels/rigid/motion.hpp"
#include "kernels/rigid/wrench.hpp"
#include "runtime/graph/graph.hpp"
#include "runtime/mpi/environment.hpp"
#include "src/sea/options.hpp"
#include "src/sea/sph/energy_sums.hpp"
#include "src/sea/sph/sensors.hpp"
#include "src/sea/sph/tank.hpp"
#include "src/sea/wave_field.hpp"

namespace spindrift::sea {

/// Of a side that repeats or is open, across x (0) or y (1), for messages about bodies that come over it.
inline std::string side_without_wall(bool open, int axis) {
  return std::string("that ") + (open ? "is open" : "repeats") + " (sea.tank.sides_" + "xy"[axis] + "): water goes " +
         (open ? "out" : "round") + " there, bodies do not";
}

/// A body that meets the particles, shapes in body axes from the centre of mass. Bodies without shapes do not.
struct ParticleBody {
  std::string name;
  double mass = 0.0;
  Motion described;  ///< where the scene describes it
  std::vector<sph::BodyShape> shapes;
};

/// Everything of the scene in plain numbers.
struct ParticlePlan {
  ParticleOptions options;
  sph::Parameters parameters;
  std::string sound_speed_from;         ///< what it follows from, in words
  sph::TankPlan tank;                   ///< without the bodies
  std::vector<ParticleBody> bodies;     ///< by body of the scene
  std::vector<waves::Component> waves;  ///< of [waves]
  bool second_order = false;
  std::optional<WavemakerOptions> wavemaker;
  std::optional<sph::Wavemaker> paddle;
  std::vector<DampingZoneOptions> damping_zones;
  double settle_damping = 0.0;
  std::vector<ProbeOptions> probes;
  std::vector<SensorOptions> sensors;

  /// What loads, masses and energies of the particles are multiplied by to be those of the scene: a width, or two halves.
  double share() const { return options.planar() ? options.width_m : tank.mirrored ? 2.0 : 1.0; }
  /// What of bodies and walls has particles.
  sph::Cut cut() const { return sph::cut_of(options.planar(), tank.mirrored); }
};
/// `entry_speed` [m/s]: the greatest at which a body meets the water.
ParticlePlan particle_plan(const SeaOptions& options, const WavesOptions& waves, const SeaEnvironment& environment,
                           std::vector<ParticleBody> bodies, double entry_speed);

/// Whether the water stands at z = 0 down to the bed over these stretches of x and y at the start: in one box of [[sea.water]],
/// or in the whole tank where there are none. In 2-D y does not matter.
bool stands_level(const SeaOptions& options, double water_depth, const std::array<double, 2>& x, const std::array<double, 2>& y);

/// Rules between the sections of a sea of particles that it breaks.
std::vector<OptionProblem> particle_problems(const SeaOptions& options, const WavesOptions& waves,
                                             const SeaEnvironment& environment, std::span<const ParticleBody> bodies);

/// Of a particle in a state saved in memory [bytes]: saved.hpp.
inline constexpr double bytes_of_note = 62.0;

/// What a scene amounts to, without running it.
struct ParticleCensus {
  std::size_t water = 0, walls = 0, bodies = 0;
  bool counted = false;                 ///< by columns and volumes, not laid out: within some per cent
  std::size_t values_each = 0;          ///< of a particle in a checkpoint
  double bytes = 0.0;                   ///< of the particles in memory
  double step_s = 0.0;                  ///< largest step at rest
  std::string step_set_by;              ///< "sound", "body NAME"
  double evaluations_per_second = 0.0;  ///< measured on a small sea of the same schemes, one thread
  double leading_s = 0.0;               ///< what zones towards the waves add to a step, for each particle of the water; measured
  struct Body {
    std::string name;
    double volume_m3 = 0.0, wetted_m3 = 0.0;  ///< that its particles stand for: in all, and under z = 0 at the start
    std::optional<double> rise_m;             ///< from there to its static draft by its own weight; none where it sinks
  };
  std::vector<Body> floats;
  std::size_t particles() const { return water + walls + bodies; }
};
/// Seas that take seconds to lay out are counted.
ParticleCensus particle_census(const ParticlePlan& plan, std::span<const Motion> start);

/// Particles for output, of this rank's run of identities (the ranks' samples one after the other are in the order of
/// identities); vectors have three components (y zero in 2-D).
struct ParticleSample {
  std::vector<std::int64_t> id;
  std::vector<double> position, velocity, pressure, density, owner;
};

/// State of this rank's run of identities: x, v, deviation (and those one step earlier where the step is Verlet's), time and
/// steps.
struct ParticleState {
  std::int64_t first = 0, total = 0;  ///< of `values` among those of all ranks
  std::vector<double> values;
  std::vector<double> sensors;  ///< what they have read, the same on all ranks
  sph::EnergyFlow energy;       ///< of all ranks, the same on all of them
  double made_J = 0.0;          ///< energy of late, out of nothing, which a window is judged by; likewise
  double time_s = 0.0;
  std::int64_t steps = 0;
};

/// Moves the bodies while a window goes on as tasks. Called by single tasks, on all ranks with the same numbers; both may throw
/// NumericalFailure, which ends the window.
class WindowDriver {
 public:
  virtual ~WindowDriver() = default;
  struct Steps {
    double dt;  ///< of each [s], at most `limit`
    bool last;  ///< of the window
    int count = 1;
    double last_dt = dt;  ///< of the last of them [s]
  };
  /// At most `most` steps, for which the limit is not looked at again: several keep to sph::share_between_checks of it.
  virtual Steps choose(double limit, int most) = 0;
  /// The sea's loads() are those of the step's begin, or (to_end, but for Verlet's step) of its middle. Sets where the bodies are
  /// at the middle of the step, or at its end, and returns that time [s].
  virtual double move(bool to_end, std::vector<Motion>& bodies) = 0;
};

class ParticleSea {
 public:
  static std::unique_ptr<ParticleSea> make(const ParticlePlan& plan, std::span<const Motion> start, const runtime::World& world);
  virtual ~ParticleSea() = default;

  /// Puts bodies and paddle where they are at time t: how far they go in tasks recorded after it counts from there.
  virtual void place(double t_s, std::span<const Motion> bodies) = 0;
  /// Places them and evaluates that state, without a step.
  virtual void evaluate(double t_s, std::span<const Motion> bodies) = 0;

  // A window as tasks: balance(), then for each run of the tasks open(), the tasks, close().
  /// Deals groups out to the ranks anew where that pays; afterwards tasks are outdated().
  virtual void balance() = 0;
  /// Records the steps of a window; `first_tag`: of their messages. The driver outlives the tasks.
  virtual void record(runtime::Graph& graph, WindowDriver& driver, int first_tag) = 0;
  /// Whether any body or paddle moves with the sea; where none does the driver is asked for steps alone.
  virtual bool moves_solids() const = 0;
  virtual bool outdated() const = 0;
  /// The executors of what was recorded are gone.
  virtual void forget_tasks() = 0;
  /// `settling`: the water is damped as until t = 0.
  virtual void open(double t_s, std::span<const Motion> bodies, bool settling) = 0;
  /// Throws the NumericalFailure of the window, or runtime::StopAsked where it was given up.
  virtual void close() = 0;
  /// Saves the state (0, 1), and restores it bit for bit.
  virtual void take_snapshot(int slot) = 0;
  virtual void return_to(int slot) = 0;

  /// Of the last evaluation, by body of the scene, each about the place of its centre of mass then; zero for bodies without
  /// shapes.
  virtual std::span<const Wrench> loads() const = 0;
  /// The same of contact with walls and other bodies, which is not in loads().
  virtual std::span<const Wrench> contacts() const = 0;
  /// Adds loads() or contacts() moved to where the centres of mass are now.
  void add_loads(std::span<const Motion> bodies, std::span<Wrench> wrenches) const;
  void add_contacts(std::span<const Motion> bodies, std::span<Wrench> wrenches) const;

  // Instruments, any time between steps.
  virtual std::vector<double> surface(std::span<const std::array<double, 2>> places) const = 0;
  struct Reading {
    double pressure;
    Eigen::Vector3d velocity;
  };
  virtual Reading probe(const Eigen::Vector3d& at) const = 0;
  /// Mean of the plan's sensor n; force in earth axes [N].
  virtual sph::PatchReading sensor(std::size_t n) const = 0;
  /// Displacement and velocity of the paddle at still water [m], [m/s]; zero without one.
  virtual sph::Wavemaker::Stroke paddle(double t_s) const = 0;
  /// Farthest and highest water [m], kinetic energy of the water [J] (2-D: of the scene's width).
  struct Extent {
    double x_max, z_max;
    double mass, kinetic_energy, potential_energy, compression_energy;  ///< [kg], [J]; potential: from still water, z = 0
    double work_of_solids, dissipated, absorbed;                        ///< since the sea was made [J]: energy_flow.hpp
    double left;  ///< kinetic and potential energy [J] that particles took along which are no more in the tank
  };
  virtual Extent extent() const = 0;
  virtual ParticleSample sample(const std::optional<Eigen::Vector3d>& low, const std::optional<Eigen::Vector3d>& high,
                                bool solids) const = 0;

  virtual ParticleState save() const = 0;
  /// Which values restore() wants on this rank.
  virtual ParticleState layout() const = 0;
  /// The next call is place() or evaluate(): where bodies are is not in the state.
  virtual void restore(const ParticleState& state) = 0;

  struct Counts {
    std::size_t particles;   ///< of all ranks, as seeded
    std::size_t lost, left;  ///< slipped through walls; left over the walls' edge or through open sides
    std::int64_t evaluations, sorts;
  };
  virtual Counts counts() const = 0;
};

}  // namespace spindrift::sea
