// SPDX-License-Identifier: Apache-2.0
#include "kernels/gas/flux_osher.hpp"
#include "src/aero/flow/sweep_convective.hpp"

namespace spindrift::aero {
ConvectiveSweep convective_osher_reversed(std::string_view limiter) { return sweep_of_limiter<gas::Osher<gas::OsherOrder::inverse>>(limiter); }
}  // namespace spindrift::aero
