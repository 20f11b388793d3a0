// Whether a run had its cores for itself: the times of tasks are by a clock on the wall, which goes on while other programs have
// the core. Used by src/run and `spindrift profile`; tested in tests/runtime/trace/processor_share_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace spindrift::runtime {

/// Processor time of all threads of this process so far [s].
double processor_seconds();

/// Processor time over the core-seconds of tasks, which threads that wait have no part in; 1 of runs too short to tell.
double processor_share(double processor_s, double busy_s);

/// A sentence where that is below 0.9, else nothing.
std::string told_share(double share);

}  // namespace spindrift::runtime
