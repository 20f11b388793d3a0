// Loose coupling: one evaluation of each part per window. F takes motion x and returns loads y, S takes loads and returns motion.
//   cps   both at once, each on what the other had at the window's start (Leble & Barakos 2016, section 2.5): order 1
//   cps2  both at once, each on data of the other extrapolated linearly from its last two windows: order 2
//   css   S first, on loads extrapolated to order 0, 1 or 2, then F on the new motion (Farhat & Lesoinne 2000; Piperno & Farhat
//   2001)
// Limits of stability with added mass: loose_limits.hpp. Used by src/coupling/window.cpp; orders tested in
// tests/verification/coupling. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <tuple>

#include "kernels/coupling/extrapolation.hpp"

namespace spindrift::coupling {

struct Staggering {
  bool serial = false;   ///< S first, then F on its result
  int load_order = 0;    ///< of the loads that S sees
  int motion_order = 0;  ///< of the motion that F sees; serial: the new motion, no prediction

  /// F runs beside S, on the motion of the window's start or on that carried on from earlier windows.
  bool holds_motion() const { return !serial && motion_order == 0; }
  bool extrapolates_motion() const { return !serial && motion_order > 0; }
  bool operator==(const Staggering&) const = default;

  static Staggering cps() { return {false, 0, 0}; }
  static Staggering cps2() { return {false, 1, 1}; }
  static Staggering css(int order) { return {true, order, 0}; }
};

/// The staggered march. Parts, over a window [begin, end]:
///   Vector move(load, begin, end)    S advanced under loads load.at(t); the motion at the end
///   Vector load(motion, begin, end)  F advanced under motion(t); the loads at the end
/// and, where they can advance at once, std::pair<Vector, Vector> both(load, motion, begin, end): motion and loads at the end
class Staggered {
 public:
  explicit Staggered(Staggering scheme) : scheme_(scheme), motion_(std::max(1, scheme.motion_order)), load_(scheme.load_order) {}

  /// Motion and loads at the start.
  void begin(double t, Vector motion, Vector load) { motion_.add(t, std::move(motion)), load_.add(t, std::move(load)); }

  /// One window; false where a part's result is not finite (nothing is kept then).
  template <class Parts>
  bool advance(Parts& parts, double begin, double end) {
    const Vector x_start = motion_.last();
    Vector x, y;
    if (scheme_.serial) {
      x = parts.move(load_, begin, end);
      if (!x.allFinite()) return false;
      y = parts.load(Waveform(Interpolation::linear, {begin, end}, {x_start, x}), begin, end);
    } else {
      const Waveform motion = scheme_.motion_order == 0
                                  ? Waveform::held(x_start)
                                  : Waveform(Interpolation::linear, {begin, end}, {x_start, motion_.at(end)});
      if constexpr (requires { parts.both(load_, motion, begin, end); })
        std::tie(x, y) = parts.both(load_, motion, begin, end);
      else
        x = parts.move(load_, begin, end), y = parts.load(motion, begin, end);
    }
    if (!x.allFinite() || !y.allFinite()) return false;
    const Vector assumed = load_.at(end);
    mismatch_ = y - assumed;
    apart_ = mismatch_.norm() > far_apart * std::max(y.norm(), assumed.norm()) ? apart_ + 1 : 0;
    motion_.add(end, x), load_.add(end, std::move(y));
    return true;
  }

  /// Loads that F returned less those that S had assumed at the last window's end: what the scheme neglects, to the order it has.
  const Vector& mismatch() const { return mismatch_; }
  /// Windows in a row, up to now, whose loads came out apart from those assumed by more than `far_apart` of the larger: where the
  /// scheme is unstable each reacts to the one before. A ramp that begins with the square of time has no more than three.
  static constexpr double far_apart = 0.45;
  int apart() const { return apart_; }
  const Staggering& scheme() const { return scheme_; }
  /// Loads by now, and what S is going to see of them.
  const Extrapolation& load() const { return load_; }
  const Extrapolation& motion() const { return motion_; }
  void visit(auto& v) { motion_.visit(v), load_.visit(v), v(mismatch_), v(apart_); }

 private:
  Staggering scheme_;
  Extrapolation motion_, load_;
  Vector mismatch_;
  int apart_ = 0;
};

}  // namespace spindrift::coupling
