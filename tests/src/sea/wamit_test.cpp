// WAMIT's files: what their numbers mean, and that malformed ones are refused by line.
// SPDX-License-Identifier: Apache-2.0
#include "src/sea/wamit.hpp"

#include <catch2/catch.hpp>

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "kernels/base/constants.hpp"
#include "src/scene/error.hpp"

using namespace spindrift;
using namespace spindrift::sea;

namespace {

struct TextFile {
  std::string path;
  TextFile(const std::string& name, const std::string& text)
      : path((std::filesystem::temp_directory_path() / ("spindrift_wamit_" + std::to_string(getpid()) + name)).string()) {
    std::ofstream(path) << text;
  }
  ~TextFile() { std::filesystem::remove(path); }
};

const WamitScale scale{2.0, 1000.0, 10.0};

std::string refusal(auto read, const std::string& text) {
  const TextFile file(".bad", text);
  try {
    read(file.path, scale);
  } catch (const scene::SceneError& e) { return e.what(); }
  return "";
}

}  // namespace

TEST_CASE("added mass is rho L^k Abar, damping rho L^k w Bbar, with the limits of frequency apart", "[sea][fast]") {
  const TextFile file(".1",
                      "-1.0 1 1 4.0\n0.0 1 1 3.0\n6.283185307179586 1 1 2.0 0.5\n 6.283185307179586 1 5 1.0 0.25\n"
                      "3.141592653589793 1 1 1.0 0.125\n3.141592653589793 5 5 1.0 1.0\n");
  const WamitRadiation r = read_radiation(file.path, scale);
  REQUIRE(r.omega.size() == 2);
  CHECK(r.omega[0] == Approx(1.0));
  CHECK(r.added_mass[0](0, 0) == Approx(2.0 * 1000.0 * 8.0));
  CHECK(r.damping[0](0, 0) == Approx(0.5 * 1000.0 * 8.0));
  CHECK(r.added_mass[0](0, 4) == Approx(1.0 * 1000.0 * 16.0));
  CHECK(r.damping[1](4, 4) == Approx(2.0 * 1000.0 * 32.0));
  CHECK((*r.infinite)(0, 0) == Approx(3.0 * 8000.0));
  CHECK((*r.zero)(0, 0) == Approx(4.0 * 8000.0));
}

TEST_CASE("a file with one triangle of the couplings has them whole on both sides", "[sea][fast]") {
  const std::string diagonal = "0.0 1 1 3.0\n6.0 1 1 2.0 0.5\n3.0 1 1 1.0 0.125\n",
                    upper = "0.0 1 5 0.75\n6.0 1 5 1.0 0.25\n3.0 1 5 0.5 0.125\n";
  const TextFile file(".1", diagonal + upper);
  const WamitRadiation r = read_radiation(file.path, scale);
  for (const Matrix6& m : {r.added_mass[0], r.added_mass[1], r.damping[0], r.damping[1], *r.infinite}) {
    CHECK(m(0, 4) > 0.0);
    CHECK(m(4, 0) == m(0, 4));
  }
}

TEST_CASE("exciting forces are rho g L^m X, linear between frequencies and headings", "[sea][fast]") {
  std::string text;
  for (double period : {2.0 * pi, pi})
    for (double heading : {0.0, 90.0})
      for (int mode = 1; mode <= 6; ++mode)
        text += std::to_string(period) + " " + std::to_string(heading) + " " + std::to_string(mode) + " 0 0 " +
                std::to_string(mode + heading) + " " + std::to_string(period < 4.0 ? 1.0 : 3.0) + "\n";
  const TextFile file(".3", text);
  const WamitExcitation x = read_excitation(file.path, scale);
  CHECK(x.at(1.0, 0.0)[0].real() == Approx(1e4 * 4.0));
  CHECK(x.at(1.0, 0.0)[3].real() == Approx(4.0 * 1e4 * 8.0));
  CHECK(x.at(1.0, 0.25 * pi)[0].real() == Approx(46.0 * 4e4));
  CHECK(x.at(1.5, 0.0)[0].imag() == Approx(2.0 * 4e4).epsilon(1e-5));
  CHECK(x.at(1.0, 2.0 * pi)[0].real() == Approx(1e4 * 4.0));
  CHECK(x.at(0.5, 0.0)[0].real() == Approx(1e4 * 4.0));
  CHECK(x.at(2.1, 0.0)[0] == 0.0);
}

namespace {

/// Surge per amplitude is the heading's number in this list.
WamitExcitation excitation_of(const std::vector<double>& headings) {
  std::string text;
  for (double period : {6.0, 3.0})
    for (std::size_t n = 0; n < headings.size(); ++n)
      text += std::to_string(period) + " " + std::to_string(headings[n]) + " 1 0 0 " + std::to_string(double(n)) + " 0\n";
  const TextFile file(".3", text);
  return read_excitation(file.path, {1.0, 1.0, 1.0});
}

std::optional<double> surge(const WamitExcitation& x, double degrees) {
  const double direction = degrees * radians_per_degree;
  if (!covers(x.heading, direction)) return std::nullopt;
  return x.at(1.5, direction)[0].real();
}

}  // namespace

TEST_CASE("directions go round to the headings of the file, and between its ends only where these close the circle",
          "[sea][fast]") {
  const WamitExcitation half = excitation_of({0.0, 90.0, 180.0});
  CHECK(surge(half, 45.0).value() == Approx(0.5));
  CHECK(surge(half, -180.0).value() == Approx(2.0));
  CHECK(surge(half, 360.0).value() == Approx(0.0).margin(1e-12));
  CHECK(surge(half, 720.0 + 135.0).value() == Approx(1.5));
  CHECK(surge(half, 180.0 + 1e-9).value() == Approx(2.0));
  CHECK(surge(half, -1e-9).value() == Approx(0.0).margin(1e-12));
  CHECK(!surge(half, -10.0));
  CHECK(!surge(half, 190.0));
  CHECK_THROWS_AS(half.at(1.5, -10.0 * radians_per_degree), std::invalid_argument);
  const WamitExcitation round = excitation_of({0.0, 60.0, 120.0, 180.0, 240.0, 300.0});
  CHECK(surge(round, 330.0).value() == Approx(2.5));
  CHECK(surge(round, -30.0).value() == Approx(2.5));
  CHECK(surge(round, 345.0).value() == Approx(1.25));
  CHECK(surge(excitation_of({-180.0, -90.0, 0.0, 90.0, 180.0}), 270.0).value() == Approx(1.0));
  const WamitExcitation one = excitation_of({30.0});
  CHECK(surge(one, 390.0).value() == Approx(0.0).margin(1e-12));
  CHECK(!surge(one, 31.0));
  CHECK(!surge(excitation_of({0.0, 180.0}), -10.0));
}

TEST_CASE("hydrostatic stiffness is rho g L^k C", "[sea][fast]") {
  const TextFile file(".hst", "3 3 5.0\n4 4 6.0\n3 5 -1.0\n");
  const Matrix6 c = read_hydrostatics(file.path, scale);
  CHECK(c(2, 2) == Approx(5.0 * 1e4 * 4.0));
  CHECK(c(3, 3) == Approx(6.0 * 1e4 * 16.0));
  CHECK(c(2, 4) == Approx(-1e4 * 8.0));
}

TEST_CASE("malformed files are refused by file and line", "[sea][fast]") {
  const std::string good = "6.0 1 1 2.0 0.5\n3.0 1 1 1.0 0.125\n";
  for (const std::string& bad : {std::string("1.0 1 1\n"), std::string("1.0 1 1 2 3 4\n"), std::string("1.0 7 1 2 3\n"),
                                 std::string("1.0 1 0 2 3\n"), std::string("1.0 1.5 1 2 3\n"), std::string("1.0 1 1 nan 3\n"),
                                 std::string("1.0 1 1 x 3\n"), std::string("1.0 1 1 2.0\n"), std::string("1.0 1 1 1e999 3\n")}) {
    CAPTURE(bad);
    CHECK(refusal(read_radiation, good + bad).find(".bad:3") != std::string::npos);
  }
  CHECK(!refusal(read_radiation, "").empty());
  CHECK(!refusal(read_radiation, "6.0 1 1 2.0 0.5\n").empty());
  CHECK(refusal(read_excitation, "6.0 0 1 1 0 1 0\n-6.0 0 1 1 0 1 0\n").find(".bad:2") != std::string::npos);
  CHECK(refusal(read_excitation, "6.0 0 1 1 0 1\n").find(".bad:1") != std::string::npos);
  CHECK(!refusal(read_excitation, "6.0 0 1 1 0 1 0\n6.0 10 1 1 0 1 0\n3.0 0 1 1 0 1 0\n3.0 20 1 1 0 1 0\n").empty());
  CHECK(!refusal(read_excitation, "6.0 0 1 1 0 1 0\n3.0 0 1 1 0 1 0\n3.0 10 1 1 0 1 0\n").empty());
  CHECK(refusal(read_hydrostatics, "3 3\n").find(".bad:1") != std::string::npos);
  CHECK(refusal(read_hydrostatics, "3 9 1.0\n").find(".bad:1") != std::string::npos);
}
