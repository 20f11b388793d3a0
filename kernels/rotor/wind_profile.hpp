// Wind over height: uniform, by the power law, by the logarithmic law; as a share of the wind at a reference height (IEC 61400-1
// ed. 3, 6.3.1.2: V(z) = V_hub (z / z_hub)^alpha; over a rough surface V(z) = V_ref ln(z / z0) / ln(z_ref / z0)). Below a least
// height the share stays what it is there. Used by src/aero/wind.hpp and the far field of src/aero/flow; tested in
// tests/kernels/rotor/wind_profile_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace spindrift {

enum class WindLaw : std::uint8_t { uniform, power, logarithmic };

struct WindProfile {
  WindLaw law = WindLaw::uniform;
  double reference_height = 1.0;  ///< where the share is 1 [m above still water]
  double least_height = 1.0;      ///< [m], above zero, and above the roughness
  double exponent = 0.14;         ///< of the power law
  double roughness = 2e-4;        ///< of the logarithmic law [m]

  bool uniform() const { return law == WindLaw::uniform; }
  /// Wind at a height [m above still water] over that at the reference height.
  double share(double height) const {
    const double z = std::max(height, least_height);
    switch (law) {
      case WindLaw::power:
        return std::pow(z / reference_height, exponent);
      case WindLaw::logarithmic:
        return std::log(z / roughness) / std::log(reference_height / roughness);
      case WindLaw::uniform:
        break;
    }
    return 1.0;
  }
};

}  // namespace spindrift
