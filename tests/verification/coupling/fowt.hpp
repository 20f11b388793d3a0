// A floating turbine of two degrees of freedom, surge and pitch, with a rotor that follows its quasi-steady thrust with a lag:
// the smallest floating system on which coupling schemes show their order. Masses, thrust and slope of Leble & Barakos (2016) and
// of the DTU 10-MW tables; stiffness from the periods of the moored platform (8.3 s and 22.6 s), 5 % of critical damping, waves
// of 8.8 s. Used by fowt_test.cpp and tests/extremes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "kernels/base/constants.hpp"
#include "kernels/coupling/solve_window.hpp"
#include "kernels/coupling/staggered.hpp"

namespace spindrift::coupling::test {

struct Fowt {
  double mass = 8.85e6, inertia = 2.6e10;  // kg, kg m2, with the water's
  double surge_period = 8.3, pitch_period = 22.6, wave_period = 8.8, damping_ratio = 0.05;
  double arm = 125.0, thrust = 1.5e6, slope = 162.5e3;  // m, N, N per m/s
  double lag = 1.0;                                     // s
  double wave_force = 1.0e6, wave_moment = 2.0e7;       // N, N m
  double step = 2e-3;                                   // s of both parts, RK4: its error is far below the coupling's

  /// (surge, pitch, rates) under thrust T.
  Vector body_rates(double t, const Vector& s, double T) const {
    const double w1 = 2 * pi / surge_period, w2 = 2 * pi / pitch_period, w = 2 * pi / wave_period;
    Vector rate(4);
    rate << s[2], s[3], (T + wave_force * std::sin(w * t)) / mass - w1 * w1 * s[0] - 2 * damping_ratio * w1 * s[2],
        (T * arm + wave_moment * std::cos(w * t)) / inertia - w2 * w2 * s[1] - 2 * damping_ratio * w2 * s[3];
    return rate;
  }
  double hub_speed(const Vector& s) const { return s[2] + arm * s[3]; }
  double thrust_rate(double T, double speed) const { return (thrust - slope * speed - T) / lag; }
};

template <class Rates>
void march_rk4(Vector& s, double begin, double end, double step, const Rates& rates) {
  const auto steps = std::max(1L, std::lround((end - begin) / step));
  const double h = (end - begin) / double(steps);
  for (long n = 0; n < steps; ++n) {
    const double t = begin + double(n) * h;
    const Vector a = rates(t, s), b = rates(t + h / 2, s + h / 2 * a), c = rates(t + h / 2, s + h / 2 * b),
                 d = rates(t + h, s + h * c);
    s += h / 6 * (a + 2 * b + 2 * c + d);
  }
}

/// Pitch [rad] at whole multiples of `every`, everything advanced together.
inline std::vector<double> monolithic_pitch(const Fowt& f, double end, double every) {
  Vector s = Vector::Zero(5);
  s[4] = f.thrust;
  std::vector<double> pitch;
  for (long n = 0; n < std::lround(end / every); ++n) {
    march_rk4(s, double(n) * every, double(n + 1) * every, f.step, [&](double t, const Vector& z) {
      Vector rate(5);
      rate << f.body_rates(t, z.head(4), z[4]), f.thrust_rate(z[4], f.hub_speed(z));
      return rate;
    });
    pitch.push_back(s[1]);
  }
  return pitch;
}

/// The two parts: motion is the hub's speed, load the thrust.
struct FowtParts {
  Fowt f;
  Vector body = Vector::Zero(4), rotor;
  explicit FowtParts(const Fowt& fowt) : f(fowt), rotor(Vector::Constant(1, fowt.thrust)) {}

  template <class Load>
  Vector move(const Load& load, double begin, double end) {
    march_rk4(body, begin, end, f.step, [&](double t, const Vector& s) { return f.body_rates(t, s, load.at(t)[0]); });
    return Vector::Constant(1, f.hub_speed(body));
  }
  Vector load(const Waveform& motion, double begin, double end) {
    march_rk4(rotor, begin, end, f.step,
              [&](double t, const Vector& T) { return Vector::Constant(1, f.thrust_rate(T[0], motion.at(t)[0])); });
    return rotor;
  }
};

inline double rms_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / double(a.size()));
}

/// RMS error of pitch [deg] over the run of a loose scheme.
inline double loose_error(const Fowt& f, const Staggering& scheme, double window, double end = 60.0) {
  FowtParts parts(f);
  Staggered march(scheme);
  march.begin(0.0, Vector::Zero(1), parts.rotor);
  std::vector<double> pitch;
  for (long n = 0; n < std::lround(end / window); ++n) {
    if (!march.advance(parts, double(n) * window, double(n + 1) * window)) return std::numeric_limits<double>::infinity();
    pitch.push_back(parts.body[1]);
  }
  return rms_difference(pitch, monolithic_pitch(f, end, window)) / radians_per_degree;
}

/// The same parts iterated: x is the hub's speed at the window's end, linear within.
class FowtWindow {
 public:
  FowtWindow(const Fowt& f, double window) : now_(f), start_(f), window_(window), past_(1) { past_.add(0.0, Vector::Zero(1)); }
  Vector evaluate(const Vector& x) { return evaluate_serial(*this, x); }
  Vector first(const Vector& x) {
    now_ = start_;
    return now_.load(Waveform(Interpolation::linear, {begin(), end()}, {past_.last(), x}), begin(), end());
  }
  Vector second(const Vector& y) {
    const Waveform load(Interpolation::linear, {begin(), end()}, {start_.rotor, y});
    return now_.move(load, begin(), end());
  }
  Vector guess() const { return past_.at(end()); }
  void accept() {
    start_ = now_;
    ++number_;
    past_.add(begin(), Vector::Constant(1, now_.f.hub_speed(now_.body)));
    done_ = true;
  }
  bool done() const { return done_; }
  bool halve() const { return false; }
  void next() { done_ = false; }
  double pitch() const { return start_.body[1]; }

 private:
  double begin() const { return double(number_) * window_; }
  double end() const { return double(number_ + 1) * window_; }
  FowtParts now_, start_;
  double window_;
  Extrapolation past_;
  long number_ = 0;
  bool done_ = false;
};

/// RMS error of pitch [deg] with the window iterated to `relative` of its first residual.
template <Scheme S>
double strong_error(const Fowt& f, S scheme, double window, double relative, double end = 60.0) {
  FowtWindow parts(f, window);
  std::vector<double> pitch;
  for (long n = 0; n < std::lround(end / window); ++n) {
    parts.next();
    if (!solve_window(parts, scheme, {.relative = relative, .absolute = 1e-13}).ok())
      return std::numeric_limits<double>::infinity();
    pitch.push_back(parts.pitch());
  }
  return rms_difference(pitch, monolithic_pitch(f, end, window)) / radians_per_degree;
}

}  // namespace spindrift::coupling::test
