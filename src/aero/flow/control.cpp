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

}  // namespace

void March::begin_step() {
  steps_ = rejections_ = in_a_row_ = 0;
  last_step_ = looking_ ? 0 : o_.max_steps;
  first_ = before_ = first_mean_ = first_model_ = 0.0;
  matrix_free_ = retry_ = spent_ = singular_ = false;
  ceiling_ = 0.0;
  fraction_ = 1.0, linear_drop_ = 0.0;
  loads_.clear();
  cfl_of_matrix_ = 0.0;
}

void March::begin_after_look() {
  reference_ = density_, reference_mean_ = mean_, reference_model_ = model_;
  if (spent_) uncount();  // a look is no march
  looking_ = false;
  begin_step();
  verdict_ = Verdict::go_on;
}

void March::ease(double factor) {
  eased_ = factor < 1.0 ? factor * cfl_ / o_.cfl_max : 1.0;
  cfl_ = std::min(cfl_, std::max(o_.cfl_least, eased_ * o_.cfl_max));
}

void March::stop() {
  why_ = "asked to stop";
  verdict_ = Verdict::stopped;
  spent_ = true, ++ended_, unconverged_ += o_.drop > 0.0;  // as a march that ends for want of steps: resume() undoes it
}

/// What a restart needs of a march besides its loads, one after the other.
template <class Self, class Body>
void March::for_saved(Self& m, Body&& body) {
  const auto each = [&](auto&... values) { (body(values), ...); };
  each(m.cfl_, m.cfl_of_step_, m.density_, m.mass_, m.first_, m.before_, m.fraction_, m.linear_drop_, m.steps_, m.rejections_,
       m.in_a_row_, m.krylov_, m.ceiling_, m.since_refresh_, m.drop_of_matrix_, m.matrix_free_, m.mean_, m.model_, m.first_mean_,
       m.first_model_, m.ended_, m.unconverged_, m.spent_, m.reference_, m.reference_mean_, m.reference_model_, m.abandoned_,
       m.better_, m.since_better_);
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

void March::uncount() { --ended_, unconverged_ -= o_.drop > 0.0; }

double March::balance_drop() const {
  const auto of = [](double now, double was) { return was > 0.0 ? now / was : 0.0; };
  return std::max(of(mean_, first_mean_), of(model_, std::max(first_model_, first_mean_)));
}

void March::resume(int more_steps) {
  // The last step of the run before was judged and not solved: it is judged again.
  last_step_ = --steps_ + (std::exchange(looking_, false) ? 0 : more_steps);
  if (spent_) uncount();
  verdict_ = Verdict::go_on;
  spent_ = false;
  retry_ = true;
  cfl_of_matrix_ = 0.0;
}

bool March::stands_still() const {
  if (!o_.by_balance || o_.drop <= 0.0 || better_ <= o_.still_above) return false;
  return since_better_ >= o_.still_steps || cfl_ <= 10.0 * o_.cfl_least;
}

void March::begin_again() {
  if (spent_) uncount();
  abandoned_ += std::max(0, steps_ - 1);
  cfl_ = o_.cfl_start, eased_ = 1.0;
  since_refresh_ = since_better_ = 0, drop_of_matrix_ = 0.0;
  begin_step();
  verdict_ = Verdict::go_on;
}

Verdict March::judge(const Norms& n, double load) {
  const double total = std::sqrt(n.mean), density = std::sqrt(n.density / n.cells);
  const bool fresh = steps_ == 0;
  const bool singular = std::exchange(singular_, false), stepped = !fresh && !retry_;
  const bool leapt = stepped && n.model > n.mean && std::sqrt(n.model) > o_.leap_limit * model_ && model_ > 0.0;
  const bool bad = n.broken > 0.0 || !std::isfinite(total) || singular || (stepped && total > o_.rise_limit * before_) || leapt;
  ++steps_;
  if (bad) {
    ++rejections_;
    if (fresh) {
      why_ = "the state it starts from has no finite residual";
      return verdict_ = Verdict::failed;
    }
    if (leapt) ceiling_ = 0.5 * cfl_;
    cfl_ *= o_.back_off;
    retry_ = true;
    cfl_of_matrix_ = 0.0;
    if (++in_a_row_ > 12 || cfl_ < o_.cfl_least) {
      why_ = "no pseudo-step was small enough";
      return verdict_ = Verdict::failed;
    }
    return verdict_ = Verdict::rejected;
  }
  density_ = density, mass_ = std::sqrt(n.mass / n.cells), mean_ = total, model_ = std::sqrt(n.model);
  if (fresh) {
    first_ = std::max(density, reference_), before_ = total;
    first_mean_ = std::max({total, reference_mean_, std::sqrt(n.forced)}),
    first_model_ = std::max(std::sqrt(n.model), reference_model_);
    if (reference_ > 0.0) cfl_ = std::clamp(o_.cfl_start * first_ / density, cfl_, std::max(cfl_, o_.cfl_max));
  }
  first_ = std::max(first_, density);  // what an impulsive start stirs up counts as the start
  if (stepped) {
    in_a_row_ = 0;
    const double ratio = before_ > 0.0 ? total / before_ : 1.0;
    // Full steps let the number grow by what the residual fell, and by a little where it did not rise much; shortened ones hold
    // it. So does a linear system that was hardly solved: its solution is no Newton step, and larger ones would be worse.
    if (linear_drop_ > 0.9)
      cfl_ *= 0.6;
    else if (fraction_ > 0.99 && linear_drop_ < 0.7)
      cfl_ *= std::clamp(ratio < 1.0 ? std::max(1.3, 1.0 / ratio) : 1.3 / (ratio * ratio), 0.5, o_.growth);
    else if (fraction_ < 0.3)
      cfl_ *= 0.5;
    if (ceiling_ > 0.0) {
      ceiling_ *= 1.1;
      cfl_ = std::min(cfl_, ceiling_);
    }
    cfl_ = std::clamp(cfl_, o_.cfl_least, std::max(o_.cfl_least, eased_ * o_.cfl_max));
  }
  retry_ = false;
  before_ = total;
  if (stepped) ++since_better_;
  if (fresh || balance_drop() < 0.5 * better_) better_ = balance_drop(), since_better_ = 0;
  if (o_.by_balance && o_.drop > 0.0 && o_.matrix_free_below > 0.0 && !matrix_free_ && since_better_ >= circling_steps)
    o_.matrix_free_below = from_the_first;
  if (o_.matrix_free_below > 0.0) matrix_free_ = density < o_.matrix_free_below * first_;
  const double of_matrix = cfl_of_matrix_ > 0.0 ? cfl_ / cfl_of_matrix_ : 0.0;
  refresh_ = !matrix_free_ || ++since_refresh_ >= o_.refresh_every || !(of_matrix > 0.5 && of_matrix < 2.0) ||
             linear_drop_ > std::max(o_.krylov_drop, 1.5 * drop_of_matrix_);
  if (refresh_) since_refresh_ = 0, cfl_of_matrix_ = cfl_;
  const auto done = [&](const char* why) {
    why_ = why, ++ended_;
    return verdict_ = Verdict::converged;
  };
  if (int(loads_.size()) > o_.load_window) loads_.erase(loads_.begin());
  loads_.push_back(load);
  if (steps_ > o_.min_steps) {
    if (o_.by_balance && balance_drop() <= o_.drop) return done("the flux balance fell by the drop asked for");
    if (o_.by_balance && n.mean + n.model <= n.noise) return done("the flux balance is down to round-off");
    if (!o_.by_balance && density <= o_.drop * first_) return done("the density residual fell by the drop asked for");
    if (density <= o_.absolute) return done("the density residual is below the absolute limit");
    if (o_.load_change > 0.0 && int(loads_.size()) > o_.load_window) {
      const auto [low, high] = std::minmax_element(loads_.end() - o_.load_window, loads_.end());
      if (*high - *low <= o_.load_change * std::max(std::abs(*low), std::abs(*high))) return done("the loads have settled");
    }
  }
  if (steps_ > last_step_) {
    spent_ = true;
    unconverged_ += o_.drop > 0.0;
    return done("the number of pseudo-steps is spent");
  }
  return verdict_ = Verdict::go_on;
}

void March::updated(double fraction, int krylov, double linear_drop) {
  cfl_of_step_ = cfl_;
  linear_drop_ = linear_drop;
  if (refresh_) drop_of_matrix_ = linear_drop;
  fraction_ = fraction;
  krylov_ = krylov;
  krylov_total_ += krylov;
}

}  // namespace spindrift::aero
