// SPDX-License-Identifier: Apache-2.0
#include "runtime/trace/processor_share.hpp"

#include <algorithm>
#include <cstdio>
#include <ctime>

namespace spindrift::runtime {

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

double processor_share(double processor_s, double busy_s) {
  constexpr double least_s = 0.5;  // below, one wait for a disk is a large part
  return busy_s < least_s ? 1.0 : std::min(1.0, processor_s / busy_s);
}

std::string told_share(double share) {
  constexpr double least = 0.9;
  if (!(share < least)) return "";
  char text[128];
  std::snprintf(text, sizeof text, "others used the computer: this run had %.0f %% of its cores; times tell little",
                100.0 * share);
  return text;
}

}  // namespace spindrift::runtime
