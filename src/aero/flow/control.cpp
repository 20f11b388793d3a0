// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/control.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace spindrift::aero {

void March::begin_step() {
  steps_ = rejections_ = in_a_row_ = 0;
  last_step_ = looking_ ? 0 : o_.max_steps;
  first_ = before_ = 0.0;
  matrix_free_ = retry_ = spent_ = false;
  share_ = 1.0, cap_ = low_ = first_mean_ = first_model_ = 0.0;
  shortened_ = since_low_ = bad_in_a_row_ = 0;
  fraction_ = 1.0, linear_drop_ = 0.0;
  loads_.clear();
  cfl_of_matrix_ = 0.0;
}

void March::begin_after_look() {
  reference_ = density_, reference_mean_ = mean_, reference_model_ = model_;
  if (spent_) --ended_, unconverged_ -= o_.drop > 0.0;  // a look is no march
  looking_ = false;
  begin_step();
  verdict_ = Verdict::go_on;
}

std::vector<double> March::save() const {
  std::vector<double> all{cfl_,
                          density_,
                          mass_,
                          first_,
                          before_,
                          fraction_,
                          linear_drop_,
                          double(steps_),
                          double(rejections_),
                          double(in_a_row_),
                          double(krylov_),
                          double(since_refresh_),
                          drop_of_matrix_,
                          double(matrix_free_),
                          cap_,
                          low_,
                          double(since_low_),
                          first_mean_,
                          first_model_,
                          mean_,
                          model_,
                          double(ended_),
                          double(unconverged_),
                          double(spent_),
                          reference_,
                          reference_mean_,
                          reference_model_,
                          double(loads_.size())};
  all.insert(all.end(), loads_.begin(), loads_.end());
  all.resize(all.size() + std::size_t(o_.load_window) + 1 - loads_.size(), 0.0);
  return all;
}

void March::load(std::span<const double> from) {
  cfl_ = from[0], density_ = from[1], mass_ = from[2], first_ = from[3], before_ = from[4], fraction_ = from[5],
  linear_drop_ = from[6];
  steps_ = int(from[7]), rejections_ = int(from[8]), in_a_row_ = int(from[9]), krylov_ = int(from[10]),
  since_refresh_ = int(from[11]);
  drop_of_matrix_ = from[12], matrix_free_ = from[13] != 0.0;
  cap_ = from[14], low_ = from[15], since_low_ = int(from[16]), first_mean_ = from[17], first_model_ = from[18], mean_ = from[19],
  model_ = from[20];
  ended_ = long(from[21]), unconverged_ = long(from[22]), spent_ = from[23] != 0.0;
  reference_ = from[24], reference_mean_ = from[25], reference_model_ = from[26];
  loads_.assign(from.begin() + 28, from.begin() + 28 + std::ptrdiff_t(from[27]));
}

void March::resume(int more_steps) {
  // The last step of the run before was judged and not solved: it is judged again.
  last_step_ = --steps_ + more_steps;
  if (spent_) --ended_, unconverged_ -= o_.drop > 0.0;
  verdict_ = Verdict::go_on;
  spent_ = false;
  retry_ = true;
  cfl_of_matrix_ = 0.0;
}

/// Of the loads over the last steps, relative; without bound where there are not so many.
double March::swing(int steps) const {
  if (int(loads_.size()) < steps) return std::numeric_limits<double>::infinity();
  const auto [low, high] = std::minmax_element(loads_.end() - steps, loads_.end());
  const double most = std::max(std::abs(*low), std::abs(*high));
  return most > 0.0 ? (*high - *low) / most : 0.0;
}

double March::balance_drop() const {
  const auto of = [](double now, double was) { return was > 0.0 ? std::sqrt(now / was) : 0.0; };
  return std::max(of(mean_, first_mean_), of(model_, std::max(first_model_, first_mean_)));
}

Verdict March::judge(const Norms& n, double load) {
  const double total = std::sqrt(n.total()), density = std::sqrt(n.density / n.cells);
  const bool fresh = steps_ == 0, stepped = !fresh && !retry_;
  // Mean flow and turbulence each by what they were: of both together the larger would hide the other. One that was next to
  // nothing beside the other counts by the other.
  constexpr double next_to_nothing = 1e-8;
  const auto of = [&](double now, double was, double other) {
    const double by = std::max({was, next_to_nothing * other, 1e-300});
    return std::sqrt(now / by);
  };
  const double mean_ratio = of(n.mean, mean_, model_), model_ratio = of(n.model, model_, mean_);
  const double ratio = !stepped ? 1.0 : n.model > 0.0 ? std::sqrt(mean_ratio * model_ratio) : mean_ratio;
  const double left = !stepped ? 0.0 : std::max(of(n.mean_left, mean_, model_), of(n.model_left, model_, mean_));
  const bool broken = n.broken > 0.0 || !std::isfinite(total), leapt = stepped && total > o_.rise_limit * before_;
  const bool worse = stepped && bad_in_a_row_ < o_.patience && (mean_ratio > 1.0 || model_ratio > 1.0) && !(left <= o_.accept);
  const bool bad = broken || ((leapt || worse) && !(n.total() <= n.noise));
  ++steps_;
  if (bad) {
    ++rejections_;
    if (fresh) {
      why_ = "the state it starts from has no finite residual";
      return verdict_ = Verdict::failed;
    }
    if (stepped && !broken && shortened_ < o_.shortenings) {
      ++shortened_, share_ *= o_.shortening;
      return verdict_ = Verdict::rejected;
    }
    cap_ = 0.5 * cfl_;
    cfl_ *= o_.back_off;
    share_ = 0.0, shortened_ = 0, ++bad_in_a_row_;
    retry_ = true;
    cfl_of_matrix_ = 0.0;
    if (++in_a_row_ > 12 || cfl_ < o_.cfl_least) {
      why_ = "no pseudo-step was small enough";
      return verdict_ = Verdict::failed;
    }
    return verdict_ = Verdict::rejected;
  }
  density_ = density, mass_ = std::sqrt(n.mass / n.cells);
  if (fresh) {
    first_ = std::max(density, reference_), first_mean_ = std::max(n.mean, reference_mean_),
    first_model_ = std::max(n.model, reference_model_);
    if (reference_ > 0.0) cfl_ = std::clamp(o_.cfl_start * first_ / density, cfl_, std::max(cfl_, o_.cfl_max));
  }
  first_ = std::max(first_, density);  // what an impulsive start stirs up counts as the start
  if (!fresh && !retry_) {
    in_a_row_ = bad_in_a_row_ = 0;
    // Full steps let the number grow by what the residual fell, and by a little where it did not rise much; shortened ones hold
    // it. So does a linear system that was hardly solved: its solution is no Newton step, and larger ones would be worse.
    if (share_ < 1.0)
      cfl_ *= std::max(0.3, share_), cap_ = cfl_;
    else if (linear_drop_ > 0.9)
      cfl_ *= 0.6;
    else if (fraction_ > 0.99 && linear_drop_ < 0.7)
      cfl_ *= std::clamp(ratio < 1.0 ? std::max(1.3, 1.0 / ratio) : 1.3 / (ratio * ratio), 0.5, o_.growth);
    else if (fraction_ < 0.3)
      cfl_ *= 0.5;
    if (cap_ > 0.0) {
      cap_ *= 1.15;
      cfl_ = std::min(cfl_, cap_);
    }
    if (total < low_ || low_ == 0.0)
      low_ = total, since_low_ = 0;
    else if (++since_low_ > 10 && total > 3.0 * low_)
      cfl_ *= 0.3, low_ = total, since_low_ = 0, cap_ = cfl_;
    cfl_ = std::clamp(cfl_, o_.cfl_least, o_.cfl_max);
  }
  retry_ = false;
  share_ = 1.0, shortened_ = 0;
  before_ = total, mean_ = n.mean, model_ = n.model;
  if (o_.matrix_free_below > 0.0) matrix_free_ = density <= o_.matrix_free_below * first_;
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
    const bool settled = o_.load_settled == 0.0 || swing(3) <= o_.load_settled;
    if (o_.by_balance && balance_drop() <= o_.drop && settled) return done("the flux balance fell by the drop asked for");
    if (!o_.by_balance && density <= o_.drop * first_ && settled) return done("the density residual fell by the drop asked for");
    if (density <= o_.absolute) return done("the density residual is below the absolute limit");
    if (o_.load_change > 0.0 && int(loads_.size()) > o_.load_window && swing(o_.load_window) <= o_.load_change)
      return done("the loads have settled");
  }
  if (steps_ > last_step_) {
    spent_ = true;
    if (o_.drop > 0.0) ++unconverged_;  // with none asked for all steps are meant
    return done("the number of pseudo-steps is spent");
  }
  return verdict_ = Verdict::go_on;
}

void March::updated(double fraction, int krylov, double linear_drop) {
  linear_drop_ = linear_drop;
  if (refresh_) drop_of_matrix_ = linear_drop;
  fraction_ = fraction;
  krylov_ = krylov;
  krylov_total_ += krylov;
}

}  // namespace spindrift::aero
