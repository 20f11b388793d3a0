// SPDX-License-Identifier: Apache-2.0
#include "kernels/gas/flux_roe.hpp"
#include "src/aero/flow/sweep_convective.hpp"

namespace spindrift::aero {
ConvectiveSweep convective_roe(std::string_view limiter) { return sweep_of_limiter<gas::Roe>(limiter); }
}  // namespace spindrift::aero
