// `spindrift --version [--verbose]`: which program this is; with --verbose all that its speed depends on.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gnu/libc-version.h>
#include <omp.h>
#include <sched.h>
#include <unistd.h>

#include "kernels/base/wide.hpp"
#include "src/app/commands.hpp"
#include "src/io/build_info.hpp"

namespace spindrift::app {
namespace {

/// Processors this process may run on, as "0-3,8".
std::string affinity() {
  cpu_set_t allowed;
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) return "unknown";
  std::string list;
  for (int first = 0; first < CPU_SETSIZE; ++first) {
    if (!CPU_ISSET(first, &allowed)) continue;
    int last = first;
    while (last + 1 < CPU_SETSIZE && CPU_ISSET(last + 1, &allowed)) ++last;
    list += fmt::format("{}{}", list.empty() ? "" : ",", first);
    if (last > first) list += fmt::format("-{}", last);
    first = last;
  }
  return fmt::format("{} ({} of {})", list, CPU_COUNT(&allowed), sysconf(_SC_NPROCESSORS_ONLN));
}

}  // namespace

std::string version(bool verbose) {
  const io::BuildInfo& build = io::build_info();
  std::string text = fmt::format("spindrift {} ({}, {})", build.version, build.commit, build.compiler);
  if (!verbose) return text;
  const auto line = [&text](std::string_view what, const std::string& is) { text += fmt::format("\n{:14}{}", what, is); };
  line("build", build.build_type);
  line("flags", build.flags);
  line("vector width", fmt::format("{} bit; the same results at any", 8 * register_bytes));
  line("processors", affinity());
  line("threads", fmt::format("{} (OMP_NUM_THREADS)", omp_get_max_threads()));
  for (const auto& [library, number] : build.libraries) line(library, number);
  line("C library", gnu_get_libc_version());
  return text;
}

}  // namespace spindrift::app
