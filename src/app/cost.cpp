// SPDX-License-Identifier: Apache-2.0
#include "src/app/cost.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <thread>

#include "src/coupling/memory_limits.hpp"
#include "src/io/progress.hpp"

namespace spindrift::app {

namespace {

std::string bytes_text(double bytes) {
  return bytes < 1e9 ? fmt::format("{:.0f} MB", bytes / 1e6) : fmt::format("{:.2f} GB", bytes / 1e9);
}

/// Of messages [bytes]: what a job has beside a single process, and the pages of segments that other ranks on the same computer
/// pass messages in, by doublings of the ranks: most messages are those of a few neighbours and of reductions. Measured with Open
/// MPI 4.1: 5 MB on 8 ranks, 9 and 11 on 24 and 16, 12 on 56.
constexpr double bytes_of_job = 3e6, bytes_of_doubling = 2.3e6;

}  // namespace

std::vector<std::string> beyond_machine(double bytes, double core_seconds) {
  constexpr double year_s = 365.25 * 86400.0;
  const double memory = coupling::machine_memory(), cores = std::max(1u, std::thread::hardware_concurrency());
  std::vector<std::string> warnings;
  if (bytes > memory)
    warnings.push_back(
        fmt::format("memory: {} where this machine has {}; usual is less: take fewer cells or particles, or more "
                    "machines",
                    bytes_text(bytes), bytes_text(memory)));
  if (core_seconds > year_s * cores)
    warnings.push_back(
        fmt::format("time: {} on the {:.0f} cores of this computer; usual is up to a year: look at time.end_s and "
                    "at the steps, or take fewer cells or particles",
                    io::duration_text(core_seconds / cores), cores));
  return warnings;
}

void print_cost(std::span<const PartCost> parts, double simulated_s, int ranks, const BaseCost& base, bool pseudo_steps) {
  double bytes = 0.0, each = base.bytes, checkpoint = 0.0, per_second = 0.0, before = base.core_seconds;
  fmt::print("\nPredicted cost\n");
  for (const PartCost& p : parts) {
    const double cost = p.work_per_second * p.core_seconds_per_work;
    fmt::print("  {:<22}{:.0f} {}, {}\n", p.name, p.count, p.things, bytes_text(p.bytes + p.bytes_each));
    if (pseudo_steps)
      fmt::print("  {:<22}{:.4g} {} of {:.3g} core-s each ({})\n", "", p.work_per_second * simulated_s, p.work,
                 p.core_seconds_per_work, p.rate);
    else
      fmt::print("  {:<22}{:.4g} {} per simulated second of {:.3g} core-s each ({}): {:.4g} core-s\n", "", p.work_per_second,
                 p.work, p.core_seconds_per_work, p.rate, cost);
    if (p.work_before > 0.0)
      fmt::print("  {:<22}{:.4g} core-s before the first window\n", "", p.work_before * p.core_seconds_per_work);
    bytes += p.bytes, each += p.bytes_each, checkpoint += p.checkpoint_bytes, per_second += cost,
        before += p.work_before * p.core_seconds_per_work;
  }
  const double whole = before + per_second * simulated_s;
  const auto of_a_rank = [&](int n) {
    return bytes / n + each + (n > 1 ? bytes_of_job + bytes_of_doubling * std::log2(n) : 0.0);
  };
  const double now = of_a_rank(ranks);
  fmt::print("  {:<22}{} ({} more while a checkpoint is written); {} rank{}: {} each\n", "memory", bytes_text(now * ranks),
             bytes_text(checkpoint), ranks, ranks == 1 ? "" : "s", bytes_text(now));
  if (pseudo_steps)
    fmt::print("  {:<22}{:.3g} core-hours\n", "predicted core-hours", whole / 3600.0);
  else
    fmt::print("  {:<22}{:.3g} core-hours for {:g} s ({:.4g} core-s per simulated second)\n", "predicted core-hours",
               whole / 3600.0, simulated_s, per_second);
  constexpr std::array cores{1, 2, 8, 16, 64, 128};
  const auto row = [&](const char* what, auto&& text) {
    fmt::print("  {:<22}", what);
    for (const int n : cores) fmt::print("{:>12}", text(n));
    fmt::print("\n");
  };
  row("cores", [](int n) { return fmt::format("{}", n); });
  row("wall time", [&](int n) { return io::duration_text(whole / n); });
  if (!pseudo_steps) row("per simulated second", [&](int n) { return io::duration_text(per_second / n); });
  row("memory of a rank each", [&](int n) { return bytes_text(of_a_rank(n)); });
  for (const std::string& warning : beyond_machine(now * ranks + checkpoint, whole)) fmt::print("  warning: {}\n", warning);
  fmt::print(
      "  Wall times share the work out evenly, without loss to waiting; rates are those of one core alone. Memory is that of "
      "ranks\n"
      "  on one computer.\n");
}

}  // namespace spindrift::app
