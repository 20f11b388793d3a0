// The motion of a paddle that makes given waves: a sum of harmonics, each with the stroke that linear theory asks for (Biesel),
// for a second-order piston Madsen's second harmonic, grown over a ramp. Equations: docs/theory/waves.md, section 5.
// Called by particle_sea.cpp, which moves the paddle's particles; tested in tests/src/sea/sph/wave_tank_parts_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "kernels/rigid/motion.hpp"
#include "kernels/waves/components.hpp"

namespace spindrift::sph {

struct Paddle {
  bool flap = false;
  double x = 0.0;      ///< of its wet face at rest [m]
  double hinge = 0.0;  ///< height of a flap's hinge [m]
  double bed = 0.0;    ///< height of the bed at the paddle, minus the depth [m]
  double start_s = 0.0, ramp_s = 0.0;
  bool in_waves = false;  ///< the water starts in the waves, and so does a paddle without a ramp
};

class Wavemaker {
 public:
  /// One harmonic of the paddle: amplitude sin(omega t + phase), at still water [m].
  struct Harmonic {
    double amplitude, omega, phase;
  };
  /// Makes the free waves among `components` (those that travel along x, with the wave numbers over the paddle's bed);
  /// second_order: the first one is a regular wave whose bound harmonic is to come out bound. stroke > 0 replaces that of the
  /// first harmonic [m].
  Wavemaker(const Paddle& paddle, std::span<const waves::Component> components, bool second_order, double stroke = 0.0);

  /// Displacement and velocity at still water [m], [m/s]. Without a ramp a paddle in still water goes on from rest by what the
  /// harmonics do since the start.
  struct Stroke {
    double displacement, velocity;
  };
  Stroke stroke(double t) const;
  /// Of the paddle as a rigid body: position of the point (x, 0, hinge) that a flap turns about.
  Motion motion(double t) const;
  Motion at_rest() const;
  /// Bound on the displacement of the face from rest, at still water [m].
  double reach() const;
  std::span<const Harmonic> harmonics() const { return harmonics_; }
  const Paddle& paddle() const { return paddle_; }

 private:
  Stroke of_harmonics(double t) const;

  Paddle paddle_;
  double before_ = 0.0;  ///< displacement until the start [m]
  double offset_ = 0.0;  ///< of the harmonics from it at the start [m]
  std::vector<Harmonic> harmonics_;
};

}  // namespace spindrift::sph
