// SPDX-License-Identifier: Apache-2.0
#include "kernels/gas/flux_roe_low_mach.hpp"
#include "src/aero/flow/sweep_convective.hpp"

namespace spindrift::aero {
ConvectiveSweep convective_roe_low_mach(std::string_view limiter) { return sweep_of_limiter<gas::RoeLowMach>(limiter); }
}  // namespace spindrift::aero
