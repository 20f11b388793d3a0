// NACA sections by their digits: four (Jacobs, Ward & Pinkerton 1933, NACA report 460) and five (Jacobs, Pinkerton & Greenberg
// 1936, NACA report 610), coefficients as in Ladson, Brooks, Hill & Sproles (1996), NASA TM 4741. Used by src/aero/flow_grid.cpp;
// tested in tests/kernels/grid/naca_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/base/constants.hpp"

namespace spindrift {

enum class TrailingEdge : std::uint8_t {
  open,   ///< as printed: .0021 of the thickness ratio times the chord, .25 % of the chord at 12 %
  closed  ///< the last coefficient is -.1036 in place of -.1015
};

/// Height and slope of the mean line at a place on the chord.
struct MeanLine {
  double height = 0.0, slope = 0.0;
};

/// A section of chord 1 from x = 0: a mean line, and the thickness laid off at right angles to it.
class NacaSection {
 public:
  /// Of "0012", "4412", "23012", "23112". Throws std::invalid_argument with what is wrong with the digits.
  explicit NacaSection(std::string_view digits);

  MeanLine mean_line(double x) const {
    if (five_digits_) return mean_line_of_five(x);
    if (camber_ == 0.0) return {};
    const double end = x < place_ ? place_ : 1.0 - place_, start = x < place_ ? 0.0 : 1.0 - 2.0 * place_;
    return {camber_ / (end * end) * (start + 2.0 * place_ * x - x * x), 2.0 * camber_ / (end * end) * (place_ - x)};
  }
  double half_thickness(double x, TrailingEdge edge) const {
    const double last = edge == TrailingEdge::open ? 0.1015 : 0.1036;
    return 5.0 * thickness_ * (0.2969 * std::sqrt(x) + x * (-0.1260 + x * (-0.3516 + x * (0.2843 - last * x))));
  }
  /// Points from the trailing edge along the upper side to the nose and back along the lower side, `side` + 1 on either, densest
  /// at the nose.
  std::vector<Eigen::Vector2d> outline(int side, TrailingEdge edge) const {
    std::vector<Eigen::Vector2d> points;
    for (int n = -side; n <= side; ++n) {
      const double x = n == -side || n == side ? 1.0 : 1.0 - std::cos(0.5 * pi * std::abs(n) / side);
      const double t = x == 1.0 && edge == TrailingEdge::closed ? 0.0 : (n < 0 ? 1.0 : -1.0) * half_thickness(x, edge);
      const MeanLine mean = mean_line(x);
      const double length = std::sqrt(1.0 + mean.slope * mean.slope);
      points.emplace_back(x - t * mean.slope / length, mean.height + t / length);
    }
    return points;
  }

 private:
  /// Camber ends at `place_` (the report's m); k2_over_k1 is 0 where the line behind it is straight, else it bends back.
  MeanLine mean_line_of_five(double x) const {
    const double m = place_, r = k2_over_k1_, a = x - m, k = k1_ / 6.0, ahead = x < m ? 1.0 : r;
    const double tilt = r * (1.0 - m) * (1.0 - m) * (1.0 - m) + m * m * m;
    return {k * (ahead * a * a * a - tilt * x + m * m * m), k * (3.0 * ahead * a * a - tilt)};
  }

  double thickness_ = 0.0, camber_ = 0.0, place_ = 0.0;
  bool five_digits_ = false;
  double k1_ = 0.0, k2_over_k1_ = 0.0;
};

inline NacaSection::NacaSection(std::string_view digits) {
  const std::string found(digits);
  for (const char c : digits)
    if (c < '0' || c > '9')
      throw std::invalid_argument("must be digits alone, four or five, as in \"0012\" or \"23012\"; found \"" + found + "\"");
  if (digits.size() != 4 && digits.size() != 5)
    throw std::invalid_argument("must be four or five digits, as in \"0012\" or \"23012\"; found \"" + found +
                                "\" (sections of other series: by `coordinates`)");
  const auto digit = [&](std::size_t n) { return digits[n] - '0'; };
  const std::size_t last = digits.size();
  thickness_ = 0.01 * (10 * digit(last - 2) + digit(last - 1));
  if (thickness_ < 0.01 || thickness_ > 0.40)
    throw std::invalid_argument("the last two digits are the thickness in % of the chord, 01 to 40; found \"" + found + "\"");
  if (digits.size() == 4) {
    camber_ = 0.01 * digit(0), place_ = 0.1 * digit(1);
    if ((digit(0) == 0) != (digit(1) == 0))
      throw std::invalid_argument(
          "the first digit is the camber in %, the second its place in tenths of the chord: both are 0, or "
          "neither; found \"" +
          found + "\"");
    return;
  }
  // Of report 610: for a design lift coefficient of .3, by the second digit (place of the camber, in twentieths).
  struct Line {
    double m, k1, k2_over_k1;
  };
  static constexpr std::array<Line, 5> simple{
      {{0.0580, 361.400, 0.0}, {0.1260, 51.640, 0.0}, {0.2025, 15.957, 0.0}, {0.2900, 6.643, 0.0}, {0.3910, 3.230, 0.0}}};
  static constexpr std::array<Line, 5> reflex{
      {{}, {0.1300, 51.990, 0.000764}, {0.2170, 15.793, 0.00677}, {0.3180, 6.520, 0.0303}, {0.4410, 3.191, 0.1355}}};
  const bool bends_back = digit(2) == 1;
  if (digit(0) == 0 || digit(1) < (bends_back ? 2 : 1) || digit(1) > 5 || digit(2) > 1)
    throw std::invalid_argument(
        "of five digits the first three name a mean line: lift 1 to 9, then 10, 20, 30, 40, 50 or, bent back, "
        "21, 31, 41, 51; found \"" +
        found + "\"");
  const Line line = (bends_back ? reflex : simple)[std::size_t(digit(1) - 1)];
  five_digits_ = true, place_ = line.m, k1_ = line.k1 * digit(0) / 2.0, k2_over_k1_ = line.k2_over_k1;
}

}  // namespace spindrift
