// SPDX-License-Identifier: Apache-2.0
#include "src/scene/study_front.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace spindrift::scene {

namespace {

/// Linear interpolation at t, which lies within the series.
double at(Series s, double t) {
  const auto above = std::lower_bound(s.time_s.begin(), s.time_s.end(), t);
  if (above == s.time_s.begin()) return s.value.front();
  if (above == s.time_s.end()) return s.value.back();
  const auto i = std::size_t(above - s.time_s.begin());
  const double weight = (t - s.time_s[i - 1]) / (s.time_s[i] - s.time_s[i - 1]);
  return (1.0 - weight) * s.value[i - 1] + weight * s.value[i];
}

/// Mean over time of f(difference).
template <class F>
double time_mean(const std::vector<double>& t, const std::vector<double>& difference, F f) {
  double integral = 0.0;
  for (std::size_t i = 1; i < t.size(); ++i) integral += 0.5 * (t[i] - t[i - 1]) * (f(difference[i]) + f(difference[i - 1]));
  return integral / (t.back() - t.front());
}

}  // namespace

std::optional<double> metric_error(const MetricOptions& metric, Series run, Series reference) {
  if (run.time_s.empty() || reference.time_s.empty()) return std::nullopt;
  const double from = std::max(metric.from_s, reference.time_s.front());
  const double until = std::min(metric.until_s.value_or(reference.time_s.back()), reference.time_s.back());
  std::vector<double> t, difference;
  for (std::size_t i = 0; i < run.time_s.size(); ++i) {
    if (run.time_s[i] < from || run.time_s[i] > until) continue;
    t.push_back(run.time_s[i]);
    difference.push_back(run.value[i] - at(reference, run.time_s[i]));
    if (!std::isfinite(difference.back())) return std::nullopt;
  }
  if (t.size() < 2) return std::nullopt;
  double error = 0.0;
  switch (metric.measure) {
    case Measure::rms:
      error = std::sqrt(time_mean(t, difference, [](double d) { return d * d; }));
      break;
    case Measure::max:
      for (const double d : difference) error = std::max(error, std::abs(d));
      break;
    case Measure::mean:
      error = std::abs(time_mean(t, difference, [](double d) { return d; }));
      break;
    case Measure::last:
      error = std::abs(difference.back());
      break;
  }
  return error / metric.divide_by;
}

std::optional<double> shortfall(std::span<const Named<MetricOptions>> metrics, std::span<const std::optional<double>> errors) {
  std::optional<double> worst;
  for (std::size_t i = 0; i < metrics.size(); ++i) {
    if (!metrics[i].options.target) continue;
    if (!errors[i]) return std::nullopt;
    worst = std::max(worst.value_or(0.0), *errors[i] / *metrics[i].options.target);
  }
  return worst;
}

std::vector<std::size_t> front(std::span<const Judged> runs) {
  std::vector<std::size_t> all(runs.size()), best;
  std::iota(all.begin(), all.end(), std::size_t(0));
  for (const std::size_t i : all) {
    const bool beaten = std::any_of(runs.begin(), runs.end(), [&](const Judged& other) {
      return other.error <= runs[i].error && other.cost <= runs[i].cost &&
             (other.error < runs[i].error || other.cost < runs[i].cost);
    });
    if (!beaten && std::isfinite(runs[i].error) && std::isfinite(runs[i].cost)) best.push_back(i);
  }
  std::stable_sort(best.begin(), best.end(), [&](std::size_t a, std::size_t b) { return runs[a].cost < runs[b].cost; });
  return best;
}

std::optional<std::size_t> cheapest(std::span<const Judged> runs, double target) {
  for (const std::size_t i : front(runs))
    if (runs[i].error <= target) return i;
  return std::nullopt;
}

}  // namespace spindrift::scene
