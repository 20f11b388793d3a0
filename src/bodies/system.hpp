// A system of rigid bodies under constraints and loads, advanced in time: coordinate partitioning (Nikravesh 1988; Wehage & Haug
// 1982) with Newton-Raphson position solution, analytic Jacobian, added mass on the left-hand side. Theory:
// docs/theory/bodies.md. Composed by src/coupling; statics.hpp and linearise.hpp work on its chart; tested in tests/src/bodies
// and tests/verification.
//
//   System system(bodies, joints, {gravity_source(bodies, 9.81), sea, moorings}, Integrator::rk4);
//   Assembly start = system.assemble();            // start.contradiction, start.redundant: report to the user
//   BodiesState state = start.state;
//   StepReport r = system.advance(state, tick_s, ticks);   // t = state.tick * tick_s; state unchanged when !r.ok()
//   if (!r.ok()) throw system.failure(r, state, tick_s);
//   const Evaluation& now = system.evaluate(state, t);     // accelerations and wrenches by source, for output
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "kernels/base/failure.hpp"
#include "kernels/rigid/integrators.hpp"
#include "src/bodies/model.hpp"
#include "src/bodies/state.hpp"

namespace spindrift::bodies {

/// How a step ended. Numbers only, so that reporting costs nothing; System::describe puts it in words.
struct StepReport {
  enum class Trouble {
    none,
    newton,        ///< the position equations did not converge
    singular,      ///< the constraints lost rank: the mechanism is in a singular position
    inconsistent,  ///< a constraint that was redundant at the start is violated
    not_finite,    ///< a position, velocity or acceleration is not a finite number
    mass,          ///< mass plus added mass is not positive definite
    stiff,         ///< the step is beyond what loads as stiff as they are now allow: `value` is about that [s]
    too_far,       ///< a body is farther away than the earth is large: `value` is how far [m]
    too_fast,      ///< a body is faster than what leaves the earth: `value` is its speed [m/s]
    energy,        ///< the steps themselves made or lost more energy than half of what all loads did: `value` is how much [J]
    onset,         ///< what is watched needs more than most_pieces of the step: `onset` is which, `value` the step it allows [s]
  };
  Trouble trouble = Trouble::none;
  int joint = -1, body = -1;   ///< where, -1 when neither
  int onset = -1;              ///< of those watched
  double value = 0.0;          ///< residual over the reference length, pivot, or as the trouble says
  int newton_iterations = 0;   ///< in the whole step
  bool repartitioned = false;  ///< a new independent set was chosen at the start of the step
  bool ok() const { return trouble == Trouble::none; }
};

/// The state at the start: positions and velocities corrected so that every constraint and driver holds.
struct Assembly {
  BodiesState state;
  int degrees_of_freedom = 0;
  std::vector<std::string> redundant;  ///< one sentence for each joint with rows that follow from others
  std::string contradiction;           ///< not empty: the joints cannot hold together; names them
};

/// Accelerations and loads of one state.
struct Evaluation {
  StepReport report;
  std::vector<Eigen::Vector3d> acceleration;          ///< of centres of mass, earth axes [m/s2]
  std::vector<Eigen::Vector3d> angular_acceleration;  ///< earth axes [rad/s2]
  std::vector<std::vector<Wrench>> by_source;         ///< [source][body] about centres of mass; -A a of added mass included
  std::vector<Wrench> joint_reactions;                ///< [joint] on its body j, about the joint's point, driver included
};

/// What sources have at the end of a step: `nothing` of it where the motions alone are wanted and no step follows from there.
enum class Remember : std::uint8_t { nothing, end };

class System {
 public:
  System(std::vector<Body> bodies, std::vector<Joint> joints, std::vector<LoadSource> loads,
         Integrator integrator = Integrator::rk4);
  ~System();
  System(System&&) noexcept;

  std::span<const Body> bodies() const;
  std::span<const Joint> joints() const;
  std::span<const LoadSource> loads() const;
  Integrator integrator() const;
  /// Whether loads follow also from what is set between steps (another module's), and not from time, motions and memory alone. If
  /// not, as at first, a step from a state that was just evaluated does not evaluate it again.
  void set_loads_from_outside(bool outside);
  double reference_length() const;  ///< [m] largest arm of a joint, rounded to a power of two; 1 without joints

  /// Consistent state at time `t_s` from the bodies' initial motions (tick 0).
  Assembly assemble(double t_s = 0.0);
  /// Consistent state with the given motions; `tick` and turns are kept from `near`.
  Assembly assemble_from(const BodiesState& near, double t_s);

  /// Begins a run at this state: gives the sources of load the memory that they begin with, and counts work from here on. Without
  /// it loads are the steady ones.
  void begin(BodiesState& state, double t_s);

  /// Sources of load remember what this state has, for whoever asks them about it.
  void recall(const BodiesState& state);

  /// From now on a step that meets one of these is made in pieces: so many that it turns by a fraction of a radian in each.
  void watch(std::vector<Onset> onsets);
  std::span<const Onset> watched() const;
  /// Of a step of so many seconds that meets the onset.
  double pieces_at(const Onset& onset, double step_s) const;
  static constexpr int most_pieces = 4096;

  /// One step of `ticks` ticks with the chosen integrator, or so many equal pieces of it; more where it meets what is watched. On
  /// trouble the state is left as it was. Does not allocate unless the independent set is chosen anew. Sources remember the end
  /// of each piece, the last once the number of pieces is settled: each call is one of a controller library.
  StepReport advance(BodiesState& state, double tick_s, std::int64_t ticks, int pieces = 1, Remember = Remember::end);

  /// Accelerations and loads by source; the reference is valid until the next call.
  const Evaluation& evaluate(const BodiesState& state, double t_s);

  /// Largest residual of all constraints over the reference length.
  double constraint_residual(const BodiesState& state, double t_s);
  /// The same at the state that was evaluated last; nothing is solved for it.
  double constraint_residual_now();
  /// Kinetic energy [J], added mass not included.
  double kinetic_energy(const BodiesState& state) const;

  std::string describe(const StepReport& report) const;
  NumericalFailure failure(const StepReport& report, const BodiesState& state, double tick_s) const;

  // Loads in the chart are the steady ones: memory is left out.
  // The chart: coordinates of the configurations near a state, x in R^n with x = 0 at the state, one for each independent
  // velocity u. Translations in units of reference_length(). For statics and linearisation.
  StepReport open_chart(const BodiesState& state, double t_s);
  int freedoms() const;
  const Eigen::VectorXd& chart_velocity() const;  ///< u of the state
  /// du/dt at chart point (x, u) in axes that stay where those of the bodies are at the centre. Small deviations from the motion
  /// through the centre have dx/dt = u in them, also of a body that spins.
  bool rates(double t_s, const Eigen::VectorXd& x, const Eigen::VectorXd& u, Eigen::VectorXd& u_rate);
  /// Generalised forces of the loads at x with everything at rest but what drivers turn (a rotor has its thrust while it spins),
  /// and the mass matrix (added mass included), both in chart coordinates. all_loads: sum over sources and bodies of |force| /
  /// sqrt(mass), to measure a balance against [sqrt(kg) m/s2 over L].
  bool forces_at_rest(double t_s, const Eigen::VectorXd& x, Eigen::VectorXd& force, Eigen::MatrixXd& mass,
                      double* all_loads = nullptr);
  /// The state at chart point (x, u); false when the position equations fail (then chart_report()).
  bool close_chart(double t_s, const Eigen::VectorXd& x, const Eigen::VectorXd& u, BodiesState& state);
  /// Velocities of all bodies per unit of each independent one: 6 rows per body (earth velocity [m/s]; body-axes spin), n
  /// columns.
  Eigen::MatrixXd motion_of_freedoms() const;
  const StepReport& chart_report() const;

 private:
  struct Work;
  std::unique_ptr<Work> w_;
};

}  // namespace spindrift::bodies
