// The decisions of a pseudo-time march: when a step is good, how large the next may be, when to stop and when to give up. Numbers
// in, decisions out; the same on every rank, as all its numbers are reduced exactly. CFL: switched evolution relaxation
// (Mulder & van Leer 1985, J. Comput. Phys. 59, 232) between bounds, with back-off. Called by tasks.cpp; tested in
// tests/src/aero/flow/control_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
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
  double load_change = 0.0;   ///< relative change of the loads over load_window steps: done; 0: not looked at
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
  double broken = 0.0;  ///< cells whose residual is not finite
  double noise = 0.0;   ///< sum of mean and model that round-off alone may have
  double forced = 0.0;  ///< of squared scaled forces inside the air: what they do to an undisturbed flow
};

/// stopped: the run was asked to stop; a steady march goes on from there, a physical step is to be made again.
enum class Verdict : std::uint8_t { go_on, rejected, converged, failed, stopped };
constexpr bool ends_march(Verdict v) { return v == Verdict::converged || v == Verdict::failed || v == Verdict::stopped; }

class March {
 public:
  explicit March(const MarchOptions& options) : o_(options), cfl_(options.cfl_start) {}

  /// A new physical step: the CFL number stays.
  void begin_step();
  /// The largest CFL number from here on, of the scene's: below 1 where a step is tried again.
  void ease(double factor);
  /// A steady march goes on where it was, for at most so many more steps.
  void resume(int more_steps);
  void set_drop(double drop) { o_.drop = drop; }
  /// The next run judges the state it finds and makes no step; of a march that has begun it changes nothing else ...
  void look() { looking_ = true; }
  /// ... and the one after it begins anew with another state, but what its residual was then counts as the start of its drop.
  void begin_after_look();
  /// Whether a steady march that is to end by its flux balance will not: it stands still, or takes steps of no length.
  bool stands_still() const;
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
  void not_updated() { singular_ = true, linear_drop_ = 1.0; }
  /// Instead of another step.
  void stop();

  double cfl() const { return cfl_; }
  double cfl_of_step() const { return steps_ == 0 ? cfl_ : cfl_of_step_; }  ///< of the step made last
  int steps() const { return steps_; }
  long steps_made() const { return abandoned_ + steps_ - 1; }  ///< of a steady march also before it began again
  int still_for() const { return since_better_; }              ///< pseudo-steps since the flux balance last came to half
  int rejections() const { return rejections_; }
  bool matrix_free() const { return matrix_free_; }
  double density_residual() const { return density_; }
  double mass_residual() const { return mass_; }
  double first_density_residual() const { return first_; }
  /// The norm of all scaled flux balances over its start, or over that of forces inside the air where a step starts nearer its
  /// end: the larger of the mean flow's and of turbulence's, which starts with as much as the mean flow at least.
  double balance_drop() const;
  /// Marches so far that came to an end, and those of them that ended for want of steps.
  long ended() const { return ended_; }
  long unconverged() const { return unconverged_; }
  Verdict verdict() const { return verdict_; }
  bool spent() const { return spent_; }  ///< ended for want of steps
  /// Whether the matrix is to be made anew: always where it is the operator; else after refresh_every steps, or sooner where the
  /// CFL number has left a factor of two, a step was rejected, or a linear system was solved worse than with the fresh matrix.
  bool refresh() const { return refresh_; }
  const char* why() const { return why_; }
  int krylov() const { return krylov_; }
  long krylov_total() const { return krylov_total_; }
  double fraction() const { return fraction_; }
  double linear_drop() const { return linear_drop_; }
  const MarchOptions& options() const { return o_; }

 private:
  template <class Self, class Body>
  static void for_saved(Self& march, Body&& body);
  void uncount();  ///< the march that ended for want of steps goes on
  MarchOptions o_;
  double cfl_, cfl_of_step_ = 0.0, eased_ = 1.0, density_ = 0.0, mass_ = 0.0, first_ = 0.0, before_ = 0.0, fraction_ = 1.0,
               linear_drop_ = 0.0;
  double mean_ = 0.0, model_ = 0.0, first_mean_ = 0.0, first_model_ = 0.0;  ///< norms of the flux balances: now, at the start
  long ended_ = 0, unconverged_ = 0;
  long abandoned_ = 0;   ///< pseudo-steps of marches that began again
  double better_ = 0.0;  ///< the balance's drop when it last came to half of what it was
  int since_better_ = 0;
  int steps_ = 0, last_step_ = 0, rejections_ = 0, in_a_row_ = 0, krylov_ = 0;
  long krylov_total_ = 0;
  int since_refresh_ = 0;
  double cfl_of_matrix_ = 0.0, drop_of_matrix_ = 0.0;
  double ceiling_ = 0.0;  ///< of the CFL number after a leap of turbulence; 0: none
  double reference_ = 0.0, reference_mean_ = 0.0, reference_model_ = 0.0;  ///< least residuals that count as those of the start
  bool refresh_ = true, matrix_free_ = false, retry_ = false, spent_ = false, looking_ = false, singular_ = false;
  Verdict verdict_ = Verdict::go_on;
  const char* why_ = "";
  std::vector<double> loads_;
};

}  // namespace spindrift::aero
