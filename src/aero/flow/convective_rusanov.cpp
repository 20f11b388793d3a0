// SPDX-License-Identifier: Apache-2.0
#include "kernels/gas/flux_rusanov.hpp"
#include "src/aero/flow/sweep_convective.hpp"

namespace spindrift::aero {
ConvectiveSweep convective_rusanov(std::string_view limiter) { return sweep_of_limiter<gas::Rusanov>(limiter); }
}  // namespace spindrift::aero
