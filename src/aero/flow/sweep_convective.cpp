// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/sweep_convective.hpp"

namespace spindrift::aero {

ConvectiveSweep convective_sweep(std::string_view flux, std::string_view limiter) {
  if (flux == "osher") return convective_osher(limiter);
  if (flux == "osher_reversed") return convective_osher_reversed(limiter);
  if (flux == "roe") return convective_roe(limiter);
  if (flux == "rusanov") return convective_rusanov(limiter);
  return convective_roe_low_mach(limiter);
}

}  // namespace spindrift::aero
