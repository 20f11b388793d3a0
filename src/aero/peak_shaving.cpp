// SPDX-License-Identifier: Apache-2.0
#include "src/aero/peak_shaving.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/base/constants.hpp"
#include "kernels/base/interpolation.hpp"
#include "kernels/base/root.hpp"

namespace spindrift::aero {

namespace {

constexpr double wind_step = 0.5;         // of the table [m/s]
constexpr double speed_tolerance = 1e-5;  // of rated speed
constexpr double pitch_tolerance = 1e-5;  // [rad]

/// The rotor under its controller in steady wind.
class Steady {
 public:
  Steady(const SteadyLoad& load, const ControllerDtu& law, const Operation& operation)
      : load_(load), law_(law), below_(operation.below_rated()) {}

  double base_pitch(double wind) const {
    return below_.pitch.empty() ? 0.0 : interpolate_linear(below_.wind, below_.pitch, wind);
  }

  /// Where the generator's least torque balances the blades', within the limits of speed.
  double speed(double wind, double pitch) const {
    const auto excess = [&](double speed) {
      const double tracked = std::min(speed, law_.open_share * law_.rated_speed);
      return load_(wind, speed, pitch).torque - law_.torque_gain * tracked * tracked;
    };
    const double at_rated = excess(law_.rated_speed);
    if (at_rated >= 0.0) return law_.rated_speed;
    const double at_least = excess(law_.min_speed);
    if (at_least <= 0.0) return law_.min_speed;
    return bracketed_root(excess, law_.min_speed, at_least, law_.rated_speed, at_rated, speed_tolerance * law_.rated_speed).x;
  }
  double thrust(double wind, double pitch) const { return load_(wind, speed(wind, pitch), pitch).thrust; }

  /// Pitch of operation: the least one, or above rated wind the one that holds rated power.
  double pitch(double wind) const {
    const double least = base_pitch(wind), rated = law_.rated_power / law_.rated_speed;
    const auto excess = [&](double pitch) { return load_(wind, law_.rated_speed, pitch).torque - rated; };
    const double at_least = excess(least), at_most = excess(law_.max_pitch);
    if (at_least <= 0.0 || at_most >= 0.0) return least;
    return bracketed_root(excess, least, at_least, law_.max_pitch, at_most, pitch_tolerance).x;
  }

  /// Least pitch whose thrust is within the limit.
  double shaved_pitch(double wind, double limit) const {
    const auto excess = [&](double pitch) { return thrust(wind, pitch) - limit; };
    double low = base_pitch(wind), at_low = excess(low);
    if (at_low <= 0.0) return low;
    double high = std::max(pitch(wind), low), at_high = excess(high);
    constexpr double step = 2.0 * radians_per_degree;
    while (at_high > 0.0 && high < law_.max_pitch) low = high, at_low = at_high, high += step, at_high = excess(high);
    return at_high > 0.0 ? high : bracketed_root(excess, low, at_low, high, at_high, pitch_tolerance).x;
  }

 private:
  const SteadyLoad& load_;
  const ControllerDtu& law_;
  Operation below_;
};

}  // namespace

double PeakShaving::least_pitch(double wind_m_s) const { return interpolate_linear(wind, pitch, wind_m_s); }

PeakShaving shave_peak(const SteadyLoad& load, const ControllerDtu& law, const Operation& operation, double share) {
  const Steady rotor(load, law, operation);
  PeakShaving shaving;
  const double first = operation.wind.front(), last = operation.wind.back();
  const int steps = std::max(1, int(std::ceil((last - first) / wind_step)));
  const auto look = [&](double wind) {
    const double thrust = rotor.thrust(wind, rotor.pitch(wind));
    if (thrust > shaving.largest) shaving.largest = thrust, shaving.largest_at = wind;
  };
  for (int n = 0; n <= steps; ++n) shaving.wind.push_back(first + (last - first) * n / steps);
  for (const double wind : shaving.wind) look(wind);
  // The peak is a corner, where the blades begin to pitch: between two rows of the table.
  constexpr int finer = 20;
  const double about = shaving.largest_at;
  for (int n = 1 - finer; n < finer; ++n) look(std::clamp(about + wind_step * n / finer, first, last));
  shaving.limit = share * shaving.largest;
  for (const double wind : shaving.wind) {
    shaving.pitch.push_back(rotor.shaved_pitch(wind, shaving.limit));
    const double farther = shaving.pitch.back() - rotor.pitch(wind);
    if (farther < 10.0 * pitch_tolerance) continue;
    if (shaving.farthest == 0.0) shaving.from = wind;
    shaving.to = wind, shaving.farthest = std::max(shaving.farthest, farther);
  }
  if (shaving.farthest == 0.0) return shaving;
  for (double wind = shaving.from - wind_step; wind < shaving.to + wind_step; wind += wind_step / finer)
    shaving.farthest = std::max(shaving.farthest, shaving.least_pitch(wind) - rotor.pitch(wind));
  return shaving;
}

}  // namespace spindrift::aero
