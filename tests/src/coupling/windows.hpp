// A floating system marched by its coupling scheme in memory, for tests that compare schemes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <memory>

#include "kernels/rigid/rotation.hpp"
#include "src/coupling/start.hpp"
#include "src/coupling/window.hpp"
#include "src/scene/document.hpp"

namespace spindrift::coupling::test {

struct March {
  std::vector<double> pitch;  ///< [rad] of the first body at window ends
  CoupledWindow::Totals totals;
  double mismatch = 0.0;  ///< mean
  int columns = 0;
  std::string failure;
};

inline std::unique_ptr<FloatingSystem> floating_of(const std::string& file, const std::vector<std::string>& overrides) {
  scene::Document document = scene::load(file, overrides);
  return std::make_unique<FloatingSystem>(read_scenario(document));
}

/// To the end of the run, or to the first failure.
inline March march(const std::string& file, const std::vector<std::string>& overrides) {
  const std::unique_ptr<FloatingSystem> floating = floating_of(file, overrides);
  bodies::BodiesState state = make_start(*floating).state;
  const Timeline& t = floating->timeline();
  March m;
  std::optional<CoupledWindow> window;
  if (floating->scenario().coupling.scheme != SchemeKind::monolithic) window.emplace(*floating).begin(state);
  for (std::int64_t n = 0; n < t.windows() && m.failure.empty(); ++n) {
    if (window) {
      const WindowReport report = window->advance(state);
      m.failure = report.failure, m.columns = report.log.columns;
      m.mismatch += report.mismatch / double(t.windows());
    } else {
      for (std::int64_t step = 0; step < t.steps_per_window(); ++step)
        if (!floating->multibody().advance(state, t.tick_s(), 1).ok()) m.failure = "a step failed";
    }
    m.pitch.push_back(euler_angles(state.motions[0].attitude).y());
  }
  if (window) m.totals = window->totals();
  return m;
}

inline double rms_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / double(a.size()));
}

}  // namespace spindrift::coupling::test
