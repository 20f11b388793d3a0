// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/control.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace spindrift::aero {

namespace {

/// Pseudo-steps with the stored first-order matrix as the operator without the flux balance being halved, after which the march
/// takes the linearised residual for good. On thin cells, in steps of many cells' passages, the matrix goes round in circles one
/// or two orders down: NACA 0012 in steps of half a chord had 6e-3 after 100 pseudo-steps where products reach 1e-3 in 5 to 8.
constexpr int circling_steps = 6;
constexpr double from_the_first = 2.0;  ///< as matrix_free_below

/// CFL number times the share of the update below which a pseudo-step is too short for loads to show whether they have settled.
constexpr double least_advance = 1.0;

}  // namespace

double MarchState::balance_drop() const {
  const auto of = [](double now, double was) { return was > 0.0 ? now / was : 0.0; };
  return std::max(of(now.mean, first.mean), of(now.model, std::max(first.model, first.mean)));
}

void March::begin_step() {
  s_.steps = s_.rejections = rejected_in_a_row_ = 0;
  last_step_ = judging_only_ ? 0 : most_;
  s_.first = {};
  s_.matrix_free = s_.spent = false;
  s_.last.fraction = 1.0, s_.last.linear_drop = s_.last.limited = s_.last.clipped = 0.0;
  made_ = Made::nothing;
  ceiling_ = matrix_.cfl = 0.0;
  loads_.clear();
}

void March::begin_after_judging(bool alone) {
  reference_ = s_.now;
  alone_ = alone && s_.now.mean > 0.0;
  reopen();  // a judgement is no march
  judging_only_ = false;
  begin_step();
}

void March::ease(double factor) {
  eased_ = factor < 1.0 ? factor * s_.cfl / o_.cfl_max : 1.0;
  s_.cfl = std::min(s_.cfl, std::max(o_.cfl_least, eased_ * o_.cfl_max));
}

/// What a restart needs of a march besides its loads, as a file has it: the mean flow's norm twice.
template <class Self, class Body>
void March::for_saved(Self& m, Body&& body) {
  const auto each = [&](auto&... values) { (body(values), ...); };
  auto& s = m.s_;
  each(s.cfl, s.last.cfl, s.now.density, s.mass_residual, s.first.density, s.now.mean, s.last.fraction, s.last.linear_drop,
       s.steps, s.rejections, m.rejected_in_a_row_, s.last.krylov, m.ceiling_, m.matrix_.age, m.matrix_.drop, s.matrix_free,
       s.now.mean, s.now.model, s.first.mean, s.first.model, s.ended, s.unconverged, s.spent, m.reference_.density,
       m.reference_.mean, m.reference_.model, s.steps_before, m.better_, s.still_for, s.last.limited, s.last.clipped, m.alone_);
}

std::vector<double> March::save() const {
  std::vector<double> all;
  for_saved(*this, [&](const auto& value) { all.push_back(double(value)); });
  all.push_back(o_.matrix_free_below);
  all.push_back(double(loads_.size()));
  all.insert(all.end(), loads_.begin(), loads_.end());
  all.resize(all.size() + std::size_t(o_.load_window) + 1 - loads_.size(), 0.0);
  return all;
}

void March::load(std::span<const double> from) {
  std::size_t n = 0;
  for_saved(*this, [&]<class T>(T& value) { value = T(from[n++]); });
  // Whether it went in circles, or not yet; else the scene's, which may have changed.
  if (const double below = from[n++]; (below >= from_the_first) != (o_.matrix_free_below >= from_the_first))
    o_.matrix_free_below = below;
  const auto count = std::size_t(from[n++]);
  loads_.assign(from.begin() + std::ptrdiff_t(n), from.begin() + std::ptrdiff_t(n + count));
}

/// A march that has ended goes on: it has not ended for want of steps.
void March::reopen() {
  if (s_.spent) --s_.ended, s_.unconverged -= o_.drop > 0.0;
  s_.spent = false;
  s_.verdict = Verdict::go_on;
}

void March::resume() {
  // The last step of the run before was judged and not solved: it is judged again.
  last_step_ = --s_.steps + (std::exchange(judging_only_, false) ? 0 : most_);
  reopen();
  made_ = Made::nothing;
  matrix_.cfl = 0.0;
}

bool March::stands_still() const {
  if (!o_.by_balance || o_.drop <= 0.0 || better_ <= o_.still_above) return false;
  return s_.still_for >= o_.still_steps || s_.cfl <= 10.0 * o_.cfl_least;
}

void March::begin_again() {
  reopen();
  s_.steps_before += std::max(0, s_.steps - 1);
  s_.cfl = o_.cfl_start, eased_ = 1.0;
  s_.still_for = 0, matrix_ = {};
  begin_step();
}

Verdict March::judge(const Norms& n, double load) {
  const Residuals found{std::sqrt(n.density / n.cells), std::sqrt(n.mean), std::sqrt(n.model)}, before = s_.now;
  const bool fresh = s_.steps == 0;
  const Made made = std::exchange(made_, Made::nothing);
  const bool stepped = made == Made::step;
  if (stepped) s_.last.limited = n.limited, s_.last.clipped = n.clipped;
  const bool leapt = stepped && n.model > n.mean && found.model > o_.leap_limit * before.model && before.model > 0.0;
  ++s_.steps;
  if (n.broken > 0.0 || !std::isfinite(found.mean) || made == Made::singular_matrix || leapt ||
      (stepped && found.mean > o_.rise_limit * before.mean))
    return reject(leapt);
  s_.now = found, s_.mass_residual = std::sqrt(n.mass / n.cells);
  if (fresh) begin_drop(n);
  s_.first.density = std::max(s_.first.density, found.density);  // what an impulsive start stirs up counts as the start
  if (stepped) {
    rejected_in_a_row_ = 0, ++s_.still_for;
    adapt_cfl(before.mean > 0.0 ? found.mean / before.mean : 1.0);
  }
  if (fresh || s_.balance_drop() < 0.5 * better_) better_ = s_.balance_drop(), s_.still_for = 0;
  choose_operator();
  if (stepped && s_.last.cfl * s_.last.fraction < least_advance) loads_.clear();
  if (int(loads_.size()) > o_.load_window) loads_.erase(loads_.begin());
  loads_.push_back(load);
  s_.load_swing = 1.0;
  if (int(loads_.size()) > o_.load_window) {
    const auto [low, high] = std::minmax_element(loads_.end() - o_.load_window, loads_.end());
    const double larger = std::max(std::abs(*low), std::abs(*high));
    s_.load_swing = larger > 0.0 ? (*high - *low) / larger : 0.0;
  }
  if (s_.steps > o_.min_steps)
    if (const char* why = why_done(n)) return end(Verdict::converged, why);
  if (s_.steps > last_step_) return end(Verdict::converged, "the number of pseudo-steps is spent", true);
  return s_.verdict = Verdict::go_on;
}

Verdict March::end(Verdict verdict, const char* why, bool spent) {
  s_.why = why;
  s_.ended += verdict != Verdict::failed;
  if (spent) s_.spent = true, s_.unconverged += o_.drop > 0.0;
  return s_.verdict = verdict;
}

Verdict March::reject(bool leapt) {
  ++s_.rejections;
  if (s_.steps == 1) return end(Verdict::failed, "the state it starts from has no finite residual");
  if (leapt) ceiling_ = 0.5 * s_.cfl;
  s_.cfl *= o_.back_off;
  matrix_.cfl = 0.0;
  if (++rejected_in_a_row_ > 12 || s_.cfl < o_.cfl_least) return end(Verdict::failed, "no pseudo-step was small enough");
  return s_.verdict = Verdict::rejected;
}

/// The first state of a march has been found good.
void March::begin_drop(const Norms& n) {
  const Residuals& least = reference_;
  const Residuals own = alone_ ? Residuals{.density = s_.now.density} : s_.now;
  s_.first = {std::max(own.density, least.density), std::max({own.mean, least.mean, std::sqrt(n.forced)}),
              std::max(own.model, least.model)};
  if (least.density > 0.0)
    s_.cfl = std::clamp(o_.cfl_start * s_.first.density / s_.now.density, s_.cfl, std::max(s_.cfl, o_.cfl_max));
}

/// After a step that is kept, by the mean flow's residual over that before it. Full steps let the number grow by what the
/// residual fell, and by a little where it did not rise much; shortened ones hold it. So does a linear system that was hardly
/// solved: its solution is no Newton step, and larger ones would be worse.
void March::adapt_cfl(double ratio) {
  if (s_.last.linear_drop > 0.9)
    s_.cfl *= 0.6;
  else if (s_.last.fraction > 0.99 && s_.last.linear_drop < 0.7)
    s_.cfl *= std::clamp(ratio < 1.0 ? std::max(1.3, 1.0 / ratio) : 1.3 / (ratio * ratio), 0.5, o_.growth);
  else if (s_.last.fraction < 0.3)
    s_.cfl *= 0.5;
  if (ceiling_ > 0.0) {
    ceiling_ *= 1.1;
    s_.cfl = std::min(s_.cfl, ceiling_);
  }
  s_.cfl = std::clamp(s_.cfl, o_.cfl_least, std::max(o_.cfl_least, eased_ * o_.cfl_max));
}

/// The stored matrix or the linearised residual, and whether the matrix is made anew.
void March::choose_operator() {
  if (o_.by_balance && o_.drop > 0.0 && o_.matrix_free_below > 0.0 && !s_.matrix_free && s_.still_for >= circling_steps)
    o_.matrix_free_below = from_the_first;
  if (o_.matrix_free_below > 0.0) s_.matrix_free = s_.now.density < o_.matrix_free_below * s_.first.density;
  const double of_matrix = matrix_.cfl > 0.0 ? s_.cfl / matrix_.cfl : 0.0;
  s_.refresh = !s_.matrix_free || ++matrix_.age >= o_.refresh_every || !(of_matrix > 0.5 && of_matrix < 2.0) ||
               s_.last.linear_drop > std::max(o_.krylov_drop, 1.5 * matrix_.drop);
  if (s_.refresh) matrix_.age = 0, matrix_.cfl = s_.cfl;
}

/// Null: it is not.
const char* March::why_done(const Norms& n) const {
  if (o_.by_balance && s_.balance_drop() <= o_.drop) return "the flux balance fell by the drop asked for";
  if (o_.by_balance && n.mean + n.model <= n.noise) return "the flux balance is down to round-off";
  if (!o_.by_balance && s_.now.density <= o_.drop * s_.first.density) return "the density residual fell by the drop asked for";
  if (s_.now.density <= o_.absolute) return "the density residual is below the absolute limit";
  if (o_.load_change > 0.0 && s_.load_swing <= o_.load_change) return "the loads have settled";
  return nullptr;
}

void March::updated(double fraction, int krylov, double linear_drop) {
  made_ = Made::step;
  s_.last = {.cfl = s_.cfl, .fraction = fraction, .linear_drop = linear_drop, .krylov = krylov};
  if (s_.refresh) matrix_.drop = linear_drop;
  s_.krylov_total += krylov;
}

void March::not_updated() {
  made_ = Made::singular_matrix;
  s_.last.linear_drop = 1.0;
}

}  // namespace spindrift::aero
