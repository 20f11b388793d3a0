// [wind]: the undisturbed wind over height and time, [wind.event], [wind.turbulence]. Declared in wind_options.cpp; read by
// src/coupling; made into a Wind by wind.cpp; tested in tests/src/aero/wind_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kernels/rotor/wind_profile.hpp"

namespace spindrift::scene {
template <class Options>
class Section;
}

namespace spindrift::aero {

enum class WindEvent { step, ramp, eog, ecd, edc, ews_vertical, ews_horizontal };

/// [wind.event]
struct WindEventOptions {
  WindEvent what = WindEvent::step;
  double start_s = 0.0;
  double speed_change_m_s = 0.0, direction_change = 0.0;  ///< of a step or ramp [m/s], [rad]
  double duration_s = 10.0;                               ///< of a ramp
  double reference_wind_m_s = 50.0, reference_intensity = 0.16;
  bool reversed = false;
};

enum class TurbulenceModel { kaimal, bts, mann };

/// [wind.turbulence]
struct TurbulenceOptions {
  TurbulenceModel model = TurbulenceModel::kaimal;
  std::string file;                ///< path of a .bts
  std::vector<std::string> files;  ///< paths of u, v, w of a Mann box
  std::array<double, 3> points{0, 0, 0}, spacing_m{0, 0, 0};
  double start_s = 0.0;  ///< time in the box at t = 0
  std::int64_t seed = 1;
  double reference_intensity = 0.14;
  bool extreme = false;
  double reference_wind_m_s = 50.0;
  std::optional<double> sigma_m_s;
  int points_across = 15, points_up = 15;
  std::optional<double> width_m;
  double duration_s = 600.0, step_s = 0.2;
  std::optional<double> inflow_plane_m;  ///< in resolved air, upwind of the hub
};

/// [wind]
struct WindOptions {
  double speed_m_s = 0.0;  ///< at the reference height
  double direction = 0.0;  ///< where it blows to, from +x towards +y [rad]
  double incidence = 0.0;  ///< by which it blows upwards: aero.flow.incidence_deg [rad]
  WindLaw law = WindLaw::uniform;
  std::optional<double> reference_height_m;
  double least_height_m = 10.0, shear_exponent = 0.14, roughness_m = 2e-4;
  std::string table;  ///< path
  std::optional<WindEventOptions> event;
  std::optional<TurbulenceOptions> turbulence;

  bool steady() const { return table.empty() && !event && !turbulence; }
  /// By more than its profile: turbulence or extreme shear.
  bool varies_over_rotor() const {
    return turbulence || (event && (event->what == WindEvent::ews_vertical || event->what == WindEvent::ews_horizontal));
  }
};

const scene::Section<WindOptions>& wind_section();

}  // namespace spindrift::aero
