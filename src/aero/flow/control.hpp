// The decisions of a pseudo-time march: when a step is good, how large the next may be, when to stop and when to give up. Numbers
// in, decisions out; the same on every rank, as all its numbers are reduced exactly. CFL: switched evolution relaxation
// (Mulder & van Leer 1985, J. Comput. Phys. 59, 232) between bounds, with back-off. Called by tasks.cpp; tested in
// tests/src/aero/flow/control_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace spindrift::aero {

struct MarchOptions {
  double cfl_start = 5.0, cfl_max = 1e4, cfl_least = 1e-3;
  double growth = 2.0;        ///< most that the CFL number grows in a step
  double back_off = 0.2;      ///< what it is multiplied by after a rejected step
  double rise_limit = 10.0;   ///< of the mean flow's residual in one step; beyond it the step is rejected
  double leap_limit = 100.0;  ///< of turbulence's, likewise; the CFL number it leapt at is then approached slowly
  double drop = 1e-2;         ///< of the residual since the start of the (physical) step: done; 0: all steps are meant
  bool by_balance = false;    ///< that residual is the norm of all scaled flux balances; else that of the density's rate
  double absolute = 0.0;      ///< density residual [kg/(m3 s)] below which all is done
  double load_change = 0.0;   ///< relative change of the loads over load_window steps of full length: done; 0: not checked
  int load_window = 20;
  int min_steps = 1, max_steps = 500;
  int still_steps = 200;            ///< pseudo-steps without the flux balance being halved: the march stands still,
  double still_above = 1e-4;        ///< unless it has come down to this; steep flows pause for up to 190 steps and then go on
  int krylov_steps = 18;            ///< most Krylov iterations of a pseudo-step
  double krylov_drop = 0.05;        ///< of the linear residual: enough
  int refresh_every = 1;            ///< pseudo-steps between two matrices of the preconditioner, where products are matrix-free
  double matrix_free_below = 0.01;  ///< drop of the residual from which on products are matrix-free; 0: never
};

/// What the tiles report of a state, summed over all cells.
struct Norms {
  double density = 0.0;  ///< sum of squared density rates
  double mass = 0.0;     ///< of squared mass balances: not divided by volumes
  double mean = 0.0;     ///< of squared scaled residuals of the mean flow
  double model = 0.0;    ///< of the turbulence unknowns
  double cells = 1.0;
  double broken = 0.0;                  ///< cells whose residual is not finite
  double noise = 0.0;                   ///< sum of mean and model that round-off alone may have
  double forced = 0.0;                  ///< of squared scaled forces inside the air: what they do to an undisturbed flow
  double limited = 0.0, clipped = 0.0;  ///< as PseudoStep has them, of the update that led to the state
};

/// stopped: the run was asked to stop; a steady march goes on from there, a physical step is to be made again.
enum class Verdict : std::uint8_t { go_on, rejected, converged, failed, stopped };
constexpr bool ends_march(Verdict v) { return v == Verdict::converged || v == Verdict::failed || v == Verdict::stopped; }

/// Of a state, over all cells.
struct Residuals {
  double density = 0.0;  ///< root mean square of the density's rate [kg/(m3 s)]
  double mean = 0.0;     ///< norm of the scaled flux balances of the mean flow
  double model = 0.0;    ///< likewise of turbulence
};

/// A pseudo-step that was made.
struct PseudoStep {
  double cfl = 0.0;
  double fraction = 1.0;     ///< of the update that was applied
  double linear_drop = 0.0;  ///< of the linear system's residual
  int krylov = 0;            ///< iterations
  double limited = 0.0;      ///< cells whose own bounds on pressure, temperature or velocity its update went beyond
  double clipped = 0.0;      ///< cells in which that of turbulence was shortened to stay above its bound
};

/// Where a march is, as last judged.
struct MarchState {
  Verdict verdict = Verdict::go_on;
  const char* why = "";  ///< it ended
  bool spent = false;    ///< it ended for want of steps
  int steps = 0;         ///< states judged since it began
  int rejections = 0;
  double cfl = 0.0;            ///< of the next step
  Residuals now, first;        ///< `first`: of its start, or of what stands for that
  double mass_residual = 0.0;  ///< root mean square of the mass balances [kg/s]
  PseudoStep last;
  double load_swing = 1.0;   ///< change of the loads over the last load_window states, of the larger; 1: too few are known
  int still_for = 0;         ///< pseudo-steps since the flux balance last came to half
  bool matrix_free = false;  ///< the products of the next step
  /// Whether the matrix is to be made anew: always where it is the operator; else after refresh_every steps, or sooner where the
  /// CFL number has left a factor of two, a step was rejected, or a linear system was solved worse than with the fresh matrix.
  bool refresh = true;
  long steps_before = 0;  ///< pseudo-steps of a steady march before it began again
  long krylov_total = 0;
  long ended = 0, unconverged = 0;  ///< marches so far that came to an end, and those of them that ended for want of steps

  long steps_made() const { return steps_before + steps - 1; }
  double density_drop() const { return now.density / std::max(first.density, 1e-300); }
  /// The norm of all scaled flux balances over its start, or over that of forces inside the air where a step starts nearer its
  /// end: the larger of the mean flow's and of turbulence's, which starts with as much as the mean flow at least.
  double balance_drop() const;
};

class March {
 public:
  explicit March(const MarchOptions& options) : o_(options), most_(options.max_steps) { s_.cfl = options.cfl_start; }

  const MarchState& state() const { return s_; }
  const MarchOptions& options() const { return o_; }

  /// A new physical step: the CFL number stays.
  void begin_step();
  /// The largest CFL number from here on, of the scene's: below 1 where a step is tried again.
  void ease(double factor);
  /// Steps that a run makes at most from here on, and no more than the options have.
  void limit(int steps) { most_ = std::min(steps, o_.max_steps); }
  /// A steady march goes on where it was.
  void resume();
  /// The next run judges the state it finds and makes no step; of a march that has begun it changes nothing else ...
  void judge_only() { judging_only_ = true; }
  /// ... and the one after it begins anew with another state, but what its residual was then counts as the start of its drop:
  /// where it is more than that of the new state, or `alone`, whatever that has. An impulsive start's may be thousands of times
  /// as large, and the same drop from it ends a flow that has not settled.
  void begin_after_judging(bool alone = false);
  /// Whether a steady march that is to end by its flux balance will not: it stands still, or takes steps of no length.
  bool stands_still() const;
  /// What the march has begun with is the least that its drop counts from, however it begins again.
  void keep_start() { reference_ = s_.first; }
  /// From another state, or by another pseudo-time: the steps made so far still count.
  void begin_again();
  /// All that decisions follow from, for a restart of a steady march.
  std::vector<double> save() const;
  void load(std::span<const double> from);
  /// After each residual.
  Verdict judge(const Norms& norms, double load);
  /// After each update: the fraction of it that was applied, and the Krylov iterations it took. Without one, as a matrix was
  /// singular, the step is rejected.
  void updated(double fraction, int krylov, double linear_drop);
  void not_updated();
  /// Instead of another step.
  void stop() { end(Verdict::stopped, "asked to stop", true); }

 private:
  /// Since the last judgement.
  enum class Made : std::uint8_t { nothing, step, singular_matrix };
  /// The matrix of the preconditioner.
  struct Matrix {
    int age = 0;                   ///< pseudo-steps
    double cfl = 0.0, drop = 0.0;  ///< the CFL number it was made for; of the first linear system that was solved with it
  };

  template <class Self, class Body>
  static void for_saved(Self& march, Body&& body);
  void reopen();
  Verdict end(Verdict verdict, const char* why, bool spent = false);
  Verdict reject(bool leapt);
  void begin_drop(const Norms& norms);
  void adapt_cfl(double ratio);
  void choose_operator();
  const char* why_done(const Norms& norms) const;

  MarchOptions o_;
  MarchState s_;
  Residuals reference_;  ///< least that count as those of the start, or, of the flux balance, the only ones
  bool alone_ = false;
  double eased_ = 1.0;    ///< share of the scene's largest CFL number
  double ceiling_ = 0.0;  ///< of the CFL number after a leap of turbulence; 0: none
  double better_ = 0.0;   ///< the balance's drop when it last came to half of what it was
  int most_, last_step_ = 0, rejected_in_a_row_ = 0;
  bool judging_only_ = false;
  Made made_ = Made::nothing;
  Matrix matrix_;
  std::vector<double> loads_;  ///< of the last load_window steps, and one more; none from before a step of no length
};

}  // namespace spindrift::aero
