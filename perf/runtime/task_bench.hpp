// The 1-D stencil of Task Bench (Slaughter et al., SC 2020) for any runtime: each step, a point reads itself and its neighbours
// of the step before, and checks that these are what they should be. METG(50 %): time per task and core at which half of it is
// work. Used by the programs of perf/runtime. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <vector>

#include "perf/runtime/grain.hpp"

namespace spindrift::perf {

constexpr int threads = 2;  ///< of every runtime; of MPI, ranks

/// Neighbours of each point, itself among them.
using Neighbours = std::vector<std::vector<int>>;

inline Neighbours line(int n) {
  Neighbours all(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i)
    for (int j = std::max(0, i - 1); j <= std::min(n - 1, i + 1); ++j) all[std::size_t(i)].push_back(j);
  return all;
}

/// What tasks hand on: who made it and when. Two steps are kept.
class Points {
 public:
  struct alignas(64) Cell {
    std::int64_t step = 0, point = 0, wrong = 0;
  };

  explicit Points(Neighbours neighbours) : neighbours_(std::move(neighbours)) {
    for (auto& half : cells_) half.resize(neighbours_.size());
    begin();
  }
  const Neighbours& neighbours() const { return neighbours_; }
  std::size_t size() const { return neighbours_.size(); }
  /// Of an odd step (`half` 1) or an even one.
  Cell& cell(int half, std::size_t i) { return cells_[std::size_t(half)][i]; }

  void begin() {
    for (const int half : {0, 1})
      for (std::size_t i = 0; i < size(); ++i) cell(half, i) = {half - 2, std::int64_t(i), 0};
  }
  /// A task of the next even or odd step, with n iterations of work.
  void work(int half, std::size_t i, long n) {
    Cell& mine = cell(half, i);
    mine.step += 2;
    for (const int j : neighbours_[i]) {
      const Cell& input = cell(1 - half, std::size_t(j));
      mine.wrong += input.step != mine.step - 1 || input.point != j;
    }
    grain(n);
  }
  /// After `steps` steps since `begin`, an even number. Throws std::runtime_error where a task read what it should not have.
  void require_right(int steps, std::size_t first, std::size_t end) {
    for (const int half : {0, 1})
      for (std::size_t i = first; i < end; ++i)
        if (cell(half, i).wrong != 0 || cell(half, i).step != steps - 2 + half)
          throw std::runtime_error("a task of point " + std::to_string(i) + " read wrong data, or was not run");
  }
  void require_right(int steps) { require_right(steps, 0, size()); }

 private:
  Neighbours neighbours_;
  std::array<std::vector<Cell>, 2> cells_;
};

/// Runs at least this even number of steps of tasks with n iterations of work; how many it made.
using Runner = std::function<int(long n, int steps)>;

/// Core-nanoseconds per task.
inline double per_task(const Runner& run, std::size_t points, long n, int steps, int samples = 7) {
  const int made = run(n, steps);
  std::vector<double> times;
  for (int s = 0; s < samples; ++s) times.push_back(seconds([&] { run(n, steps); }));
  return quantile(times, 0.5) * threads / double(points) / made * 1e9;
}

/// Time per task and core at half efficiency [us]: the median of three bisections in the logarithm of the work. `iteration_ns`:
/// of grain with all cores at it, measured anew for each step of them. `agreed`: what several processes take for the time of
/// each.
inline double metg_us(
    const Runner& run, std::size_t points, const std::function<double()>& iteration_ns,
    const std::function<double(double)>& agreed = [](double time) { return time; }) {
  std::vector<double> found;
  for (int again = 0; again < 3; ++again) {
    double low = 1, high = 1e5, at_half = 0;
    for (int n = 0; n < 9; ++n) {
      const double work = std::sqrt(low * high), ns = iteration_ns();
      const auto iterations = std::max(1L, std::lround(work));
      const int steps = 2 * std::max(50, int(4e6 / (double(points) * (ns * double(iterations) + 500))));
      const double time = agreed(per_task(run, points, iterations, steps, 5));
      (double(iterations) * ns / time < 0.5 ? low : high) = work;
      at_half = time;
    }
    found.push_back(at_half / 1000);
  }
  return quantile(found, 0.5);
}

/// Nanoseconds of an iteration of grain with all threads at it.
inline double iteration_ns_of_threads() {
  const auto all = [] {
#pragma omp parallel num_threads(threads)
    grain(2'000'000);
  };
  return measure(all, {.samples = 9, .warm_ups = 2, .sample_s = 0.001}).median / 2e6 * 1e9;
}

/// Loss [%] of 64 points of tasks of 20 us against the same work without a runtime, in alternating order: the clock rate drifts.
inline double loss_at_20_us(const Runner& run) {
  constexpr int points = 64;
  const long n = grain_of(20000);
  const int steps = run(n, 50);
  const auto bare = [&] {
#pragma omp parallel num_threads(threads)
    for (int i = 0; i < points * steps / threads; ++i) grain(n);
  };
  return 100 * (paired_ratio([&] { run(n, steps); }, bare, 15).median - 1);
}

/// What is told of a peer on a line of `width` points; `steps`: of a measurement of empty tasks.
inline void figures_of_peer(Group& group, const std::string& peer, const Runner& run, int width, int steps) {
  const auto points = static_cast<std::size_t>(width);
  group.figure("metg_50/width_" + std::to_string(width) + "/" + peer, metg_us(run, points, iteration_ns_of_threads), "us");
  if (width != 64) return;
  group.figure("overhead/stencil_1d/" + peer, per_task(run, points, 0, steps), "core-ns");
  group.figure("loss_at_20_us/" + peer, loss_at_20_us(run), "%");
}

}  // namespace spindrift::perf
