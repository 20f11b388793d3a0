// The values a parameter may take, in the unit of its key: an interval, and the words that describe it.
// Used in declarations (src/scene/section.hpp): scene::positive(), scene::above(0.0).up_to(1000.0), scene::between(0.0, 1.0).
// Tested in tests/src/scene/section_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>

namespace spindrift::scene {

/// An interval of finite numbers, each end open or closed. Not-a-number and infinities are never in it.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false, high_open = false;

  constexpr Range up_to(double limit) const { return {low, limit, low_open, false}; }
  constexpr Range below(double limit) const { return {low, limit, low_open, true}; }

  bool bounded() const;                                 ///< false where any finite number will do
  bool contains(double x) const;                        ///< x finite and inside
  std::string describe(const std::string& unit) const;  ///< "> 0 and <= 1000 s"; "a finite number" where unbounded
};

constexpr Range any() { return {}; }
constexpr Range between(double low, double high) { return {low, high, false, false}; }  ///< both ends allowed
constexpr Range above(double low) { return Range{.low = low, .low_open = true}; }
constexpr Range at_least(double low) { return Range{.low = low}; }
constexpr Range below(double high) { return Range{.high = high, .high_open = true}; }
constexpr Range at_most(double high) { return Range{.high = high}; }
constexpr Range positive() { return above(0.0); }
constexpr Range not_negative() { return at_least(0.0); }

}  // namespace spindrift::scene
