// NACA sections by digits: the published ordinates, what a mean line of five digits was made for, and digits that name none.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/grid/naca.hpp"

#include <array>
#include <catch2/catch.hpp>

using namespace spindrift;
using Catch::Matchers::Contains;

namespace {

/// Ordinate in % at a station in %, of the upper side (the first half of the points) or the lower one.
double ordinate(const std::vector<Eigen::Vector2d>& outline, bool upper, double station) {
  const int half = int(outline.size()) / 2, last = int(outline.size()) - 1;
  for (int n = 0; n < half; ++n) {
    const Eigen::Vector2d &a = outline[std::size_t(upper ? n : last - n)],
                          &b = outline[std::size_t(upper ? n + 1 : last - n - 1)];
    const double x = 0.01 * station;
    if (b.x() <= x && (x <= a.x() || n == 0)) return 100.0 * (b.y() + (a.y() - b.y()) * (x - b.x()) / (a.x() - b.x()));
  }
  return 1e9;
}

constexpr std::array stations{1.25, 2.5, 5.0, 7.5, 10.0, 15.0, 20.0, 25.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 90.0, 95.0, 100.0};
using Ordinates = std::array<double, stations.size()>;

void check_ordinates(const char* digits, bool upper, const Ordinates& printed, double bar) {
  const std::vector<Eigen::Vector2d> outline = NacaSection(digits).outline(2000, TrailingEdge::open);
  for (std::size_t n = 0; n < stations.size(); ++n) {
    INFO("NACA " << digits << (upper ? ", upper side" : ", lower side") << " at " << stations[n] << " %");
    CHECK(ordinate(outline, upper, stations[n]) == Approx(printed[n]).margin(bar));
  }
}

}  // namespace

// Abbott & von Doenhoff (1959), Theory of Wing Sections, appendix III. Bars: 0012 is printed to .001 %, 4412 to .01 %; 23012 was
// drawn up by hand in 1935, and its own rounding is up to .03 % off the formula that the same report gives.
TEST_CASE("sections by their digits have the published ordinates", "[grid][fast]") {
  check_ordinates(
      "0012", true,
      {1.894, 2.615, 3.555, 4.200, 4.683, 5.345, 5.737, 5.941, 6.002, 5.803, 5.294, 4.563, 3.664, 2.623, 1.448, 0.807, 0.126},
      0.001);
  check_ordinates("4412", true,
                  {2.44, 3.39, 4.73, 5.76, 6.59, 7.89, 8.80, 9.41, 9.76, 9.80, 9.19, 8.14, 6.69, 4.89, 2.71, 1.47, 0.13}, 0.012);
  check_ordinates(
      "4412", false,
      {-1.43, -1.95, -2.49, -2.74, -2.86, -2.88, -2.74, -2.50, -2.26, -1.80, -1.40, -1.00, -0.65, -0.39, -0.22, -0.16, -0.13},
      0.012);
  check_ordinates("23012", true,
                  {2.67, 3.61, 4.91, 5.80, 6.43, 7.19, 7.50, 7.60, 7.55, 7.14, 6.41, 5.47, 4.36, 3.08, 1.68, 0.92, 0.13}, 0.031);
  check_ordinates(
      "23012", false,
      {-1.23, -1.71, -2.26, -2.61, -2.92, -3.50, -3.97, -4.28, -4.46, -4.48, -4.17, -3.67, -3.00, -2.16, -1.23, -0.70, -0.13},
      0.031);
}

TEST_CASE("a closed trailing edge is one point, an open one .0021 of the thickness wide", "[grid][fast]") {
  for (const char* digits : {"0012", "4415", "23012", "24118"}) {
    const std::vector<Eigen::Vector2d> closed = NacaSection(digits).outline(50, TrailingEdge::closed);
    CHECK((closed.front() - closed.back()).norm() == 0.0);
    CHECK(closed.front().x() == Approx(1.0).margin(1e-12));
    CHECK(std::abs(closed.front().y()) < 1e-12);
  }
  const std::vector<Eigen::Vector2d> open = NacaSection("0012").outline(50, TrailingEdge::open);
  CHECK((open.front() - open.back()).norm() == Approx(0.00252));
}

// Thin-aerofoil theory: A_n = 2/pi int dy/dx cos(n theta), design lift pi A_1, moment about the quarter chord -pi/4 (A_1 - A_2).
// The report's constants are rounded to three or four figures: 3 % of the lift; those that bend back were chosen for no moment.
TEST_CASE("mean lines of five digits have the design lift of their first digit, those that bend back no moment", "[grid][fast]") {
  for (const std::string line : {"10", "20", "30", "40", "50", "21", "31", "41", "51"})
    for (const int first : {2, 4}) {
      const NacaSection section(std::to_string(first) + line + "12");
      const int points = 20000;
      double a1 = 0.0, a2 = 0.0;
      for (int n = 0; n < points; ++n) {
        const double theta = pi * (n + 0.5) / points, slope = section.mean_line(0.5 * (1.0 - std::cos(theta))).slope;
        a1 += 2.0 / points * slope * std::cos(theta), a2 += 2.0 / points * slope * std::cos(2.0 * theta);
      }
      INFO("line " << first << line);
      CHECK(pi * a1 == Approx(0.15 * first).epsilon(0.03));
      if (line[1] == '1') CHECK(std::abs(0.25 * pi * (a1 - a2)) < 0.005 * 0.15 * first * 2.0);
    }
}

TEST_CASE("the slope of a mean line is that of its height, and both meet where its parts do", "[grid][fast]") {
  for (const char* digits : {"4412", "2612", "23012", "25112"}) {
    const NacaSection section(digits);
    for (double x = 0.01; x < 0.99; x += 0.007) {
      constexpr double h = 1e-6;
      CHECK((section.mean_line(x + h).height - section.mean_line(x - h).height) / (2.0 * h) ==
            Approx(section.mean_line(x).slope).margin(1e-5));
    }
    CHECK(section.mean_line(0.0).height == Approx(0.0).margin(1e-15));
    CHECK(section.mean_line(1.0).height == Approx(0.0).margin(1e-15));
  }
}

TEST_CASE("digits that name no section are refused with what they would have to be", "[grid][fast]") {
  for (const char* text : {"NACA 0012", "44a2", "-412", "44.12"}) CHECK_THROWS_WITH(NacaSection(text), Contains("digits alone"));
  for (const char* text : {"", "012", "230121"}) CHECK_THROWS_WITH(NacaSection(text), Contains("four or five digits"));
  for (const char* text : {"0400", "2400", "2441", "23099"}) CHECK_THROWS_WITH(NacaSection(text), Contains("thickness in %"));
  for (const char* text : {"2012", "0412"}) CHECK_THROWS_WITH(NacaSection(text), Contains("both are 0, or neither"));
  for (const char* text : {"03012", "20012", "26012", "23212", "21112"})
    CHECK_THROWS_WITH(NacaSection(text), Contains("name a mean line"));
}
