// Judging the runs of a study: the error of a history against a reference, the front of error against cost, and the
// cheapest run that is good enough. Plain functions of numbers, called by `spindrift study` (src/app).
// Tested in tests/src/scene/study_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "src/scene/study.hpp"

namespace spindrift::scene {

/// A history column: times ascending, in seconds.
struct Series {
  std::span<const double> time_s, value;
};

/// The metric's error of `run` against `reference`, which is interpolated linearly to the run's times within the range that both
/// histories cover; means are integrals over time (trapezoidal), so uneven steps weigh rightly. Nothing where fewer than two
/// times of the run lie in the range, or a value in it is not finite.
std::optional<double> metric_error(const MetricOptions& metric, Series run, Series reference);

/// Largest of error / target over the metrics that have a target: good enough at 1 or below. Nothing where an error with a target
/// is missing, or no metric has a target.
std::optional<double> shortfall(std::span<const Named<MetricOptions>> metrics, std::span<const std::optional<double>> errors);

struct Judged {
  double error = 0.0, cost = 0.0;
};

/// Indices of the runs that no other one beats in both error and cost, cheapest first. Runs equal in both stay together.
std::vector<std::size_t> front(std::span<const Judged> runs);

/// The cheapest run with error at most `target`; of equally cheap ones the more accurate.
std::optional<std::size_t> cheapest(std::span<const Judged> runs, double target);

}  // namespace spindrift::scene
