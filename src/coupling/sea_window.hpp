// A window of a scene with a sea of particles: substeps in which water, bodies and moorings go on together (Leble & Barakos 2016,
// section 2.5), recorded as tasks. The bodies take the water's load of t over the first half of a substep, that of its middle
// over the whole of it: second order, with any of their integrators. Made by make_body_side(); tested in
// tests/coupled/particle_sea_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

#include "src/coupling/body_side.hpp"

namespace spindrift::sea {
class WindowDriver;
}

namespace spindrift::coupling {

/// Before t = 0 it holds the bodies where they start. `between` returns what the sea is driven by in place of the bodies it is
/// given, for those who want to hear what passes between the two.
using DriverFunction = std::function<sea::WindowDriver&(sea::WindowDriver& bodies)>;
std::unique_ptr<BodySide> make_particle_side(FloatingSystem& floating, DriverFunction between = {});

/// Puts the water's bodies where the state has them, as the window before left them.
void place_in_particles(FloatingSystem& floating, const bodies::BodiesState& state);

/// Likewise, and evaluates the water's loads on them.
void evaluate_particles(FloatingSystem& floating, const bodies::BodiesState& state);

/// Ticks of the next substep, even, so that what is left of a window is shared out evenly: `left` ticks (even), `limit` in ticks.
/// 0 where the limit is below two ticks.
std::int64_t substep_ticks(std::int64_t left, double limit);

/// Some of the substeps that share out what is left of a window: all of `each` ticks but the last.
struct Substeps {
  int count = 1;
  std::int64_t each = 0, last = 0;  ///< even
  std::int64_t of(int n) const { return n + 1 < count ? each : last; }
  std::int64_t ticks() const { return each * (count - 1) + last; }
};
/// The next substeps of `each` ticks, at most `most`; the one that ends the window is as long as what is left.
Substeps next_substeps(std::int64_t left, std::int64_t each, int most);

}  // namespace spindrift::coupling
