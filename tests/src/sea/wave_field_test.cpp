// The undisturbed sea of a scene: models, stretching, ramp, refusals.
// SPDX-License-Identifier: Apache-2.0
#include "src/sea/wave_field.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "kernels/waves/stokes.hpp"

using namespace spindrift;
using namespace spindrift::sea;

namespace {

const SeaEnvironment water{1025.0, 20.6, 9.81};

WavesOptions regular(const char* model) {
  WavesOptions options;
  options.model = model;
  options.height_m = 1.88;
  options.period_s = 8.8;
  return options;
}

}  // namespace

TEST_CASE("a wave travels in its direction from a crest at the origin", "[sea][fast]") {
  WavesOptions options = regular("airy");
  options.direction = 0.5 * pi;
  const WaveField sea(options, water);
  CHECK(sea.elevation(0.0, 0.0, 0.0) == Approx(0.94));
  CHECK(sea.elevation(8.8, 17.0, 0.0) == Approx(0.94));
  const double c = waves::wave_properties(8.8, 20.6, 9.81).phase_speed;
  CHECK(sea.elevation(2.0, 5.0, 2.0 * c) == Approx(0.94));
  CHECK(sea.surface(1.0, 0.0, 3.0).slope_x == Approx(0.0).margin(1e-15));
}

TEST_CASE("the surface slope is the derivative of the elevation", "[sea][fast]") {
  WavesOptions options = regular("jonswap");
  options.direction = 0.7;
  const WaveField sea(options, water);
  const double d = 1e-4, t = 31.0, x = 12.0, y = -4.0;
  const waves::Surface s = sea.surface(t, x, y);
  CHECK(s.slope_x == Approx((sea.elevation(t, x + d, y) - sea.elevation(t, x - d, y)) / (2 * d)).epsilon(1e-6));
  CHECK(s.slope_y == Approx((sea.elevation(t, x, y + d) - sea.elevation(t, x, y - d)) / (2 * d)).epsilon(1e-6));
}

TEST_CASE("an irregular sea is the plain sum of its harmonics", "[sea][fast]") {
  WavesOptions options = regular("jonswap");
  options.components = 101;  // a part-filled group of lanes
  options.stretching = "extrapolated";
  options.direction = -0.4;
  const WaveField sea(options, water);
  const double t = 100.0, x = 7.0, y = 3.0, z = -4.0;
  double eta = 0.0;
  Eigen::Vector3d u(0, 0, 0), a(0, 0, 0);
  for (const waves::Component& c : sea.components()) {
    const double k = c.wave_number, w = c.angular_frequency, bx = std::cos(c.direction), by = std::sin(c.direction);
    const double psi = k * (x * bx + y * by) - w * t + c.phase;
    const double C = std::cosh(k * (z + 20.6)) / std::sinh(k * 20.6), S = std::sinh(k * (z + 20.6)) / std::sinh(k * 20.6);
    const double h = c.amplitude * w * C * std::cos(psi), dh = c.amplitude * w * w * C * std::sin(psi);
    eta += c.amplitude * std::cos(psi);
    u += Eigen::Vector3d(h * bx, h * by, c.amplitude * w * S * std::sin(psi));
    a += Eigen::Vector3d(dh * bx, dh * by, -c.amplitude * w * w * S * std::cos(psi));
  }
  const waves::Kinematics k = sea.kinematics(t, {x, y, z}, sea.elevation(t, x, y));
  CHECK(sea.components().size() == 101);
  CHECK(sea.elevation(t, x, y) == Approx(eta).epsilon(1e-12));
  CHECK((k.velocity - u).norm() < 1e-13);
  CHECK((k.acceleration - a).norm() < 1e-13);
}

TEST_CASE("stretching brings linear kinematics to the surface by the rule that is named", "[sea][fast]") {
  WavesOptions options = regular("airy");
  const auto at = [&](const char* rule, double z) {
    options.stretching = rule;
    const WaveField sea(options, water);
    return sea.kinematics(0.0, {0, 0, z}, 0.94).velocity.x();
  };
  const double level = at("extrapolated", 0.0), crest = at("extrapolated", 0.94), bottom = at("extrapolated", -20.6);
  CHECK(at("wheeler", 0.94) == Approx(level));
  CHECK(at("wheeler", -20.6) == Approx(bottom));
  CHECK(at("wheeler", -5.0) == Approx(at("extrapolated", -5.94 * 20.6 / 21.54)));
  CHECK(at("vertical", 0.94) == Approx(level));
  CHECK(at("vertical", -5.0) == Approx(at("extrapolated", -5.0)));
  CHECK(crest > level);
  // Above the surface and below the bottom there is no water: the nearest is taken.
  CHECK(at("extrapolated", 3.0) == Approx(crest));
  CHECK(at("extrapolated", -25.0) == Approx(bottom));
  // With Wheeler's rule the total pressure at the surface is zero to first order at the surface itself: p = rho g eta there.
  options.stretching = "wheeler";
  CHECK(WaveField(options, water).kinematics(0.0, {0, 0, 0.94}, 0.94).pressure_over_density == Approx(9.81 * 0.94));
}

TEST_CASE("waves of a scene that does not say how they grow do so over two periods", "[sea][fast]") {
  WavesOptions options = regular("airy");
  CHECK(growth_time(options) == 2.0 * options.period_s);
  // A crest at a given time is whole, with the wave before it.
  options.crest_height_m = 1.0, options.crest_time_s = 0.0;
  CHECK(growth_time(options) == 0.0);
  options.crest_time_s = 2.5 * options.period_s;
  CHECK(growth_time(options) == Approx(1.5 * options.period_s));
  options.crest_time_s = 30.0 * options.period_s;
  CHECK(growth_time(options) == 2.0 * options.period_s);
  WavesOptions measured;
  measured.model = "elevation";
  CHECK(growth_time(measured) == 0.0);
}

TEST_CASE("waves grow smoothly from nothing over the ramp", "[sea][fast]") {
  WavesOptions options = regular("stokes2");
  options.ramp_s = 10.0;
  const WaveField sea(options, water);
  options.ramp_s = 0.0;
  const WaveField full(options, water);
  CHECK(sea.elevation(0.0, 0, 0) == 0.0);
  CHECK(sea.elevation(-1.0, 0, 0) == 0.0);
  CHECK(sea.elevation(5.0, 0, 0) == Approx(0.5 * full.elevation(5.0, 0, 0)));
  CHECK(sea.kinematics(5.0, {0, 0, -3}, 0).acceleration.x() ==
        Approx(0.5 * full.kinematics(5.0, {0, 0, -3}, 0).acceleration.x()));
  CHECK(sea.elevation(10.0, 0, 0) == full.elevation(10.0, 0, 0));
  CHECK(full.elevation(0.0, 0, 0) > 0.94);  // Stokes crest
}

TEST_CASE("no waves are still water", "[sea][fast]") {
  CHECK(WaveField().still());
  CHECK(WaveField(WavesOptions{}, water).still());
}

TEST_CASE("a wave that would break, and a Stokes wave outside its theory, are refused by name", "[sea][fast]") {
  CHECK(wave_problems(WavesOptions{}, water).empty());
  CHECK(wave_problems(regular("stokes2"), water).empty());
  WavesOptions steep = regular("airy");
  steep.height_m = 15.0;
  REQUIRE(wave_problems(steep, water).size() == 1);
  CHECK(wave_problems(steep, water)[0].key == "waves.height_m");
  CHECK(wave_problems(steep, water)[0].what.find("breaks above") != std::string::npos);
  WavesOptions shallow = regular("stokes2");
  shallow.period_s = 25.0;
  shallow.height_m = 6.0;
  REQUIRE(wave_problems(shallow, water).size() == 1);
  CHECK(wave_problems(shallow, water)[0].key == "waves.model");
}

TEST_CASE("a steady wave of any height has its height, its period and a sharp crest", "[sea][fast]") {
  WavesOptions options = regular("stream_function");
  options.height_m = 6.0;
  options.direction = 0.3;
  CHECK(wave_problems(options, water).empty());
  const WaveField sea(options, water);
  const double crest = sea.elevation(0.0, 0.0, 0.0), trough = sea.elevation(4.4, 0.0, 0.0);
  CHECK(crest - trough == Approx(6.0).epsilon(1e-4));
  CHECK(crest > 1.2 * -trough);
  CHECK(sea.elevation(8.8, 0.0, 0.0) == Approx(crest));
  // It travels without changing.
  const double c = sea.components()[0].angular_frequency / sea.components()[0].wave_number;
  CHECK(sea.elevation(1.7, 1.7 * c * std::cos(0.3), 1.7 * c * std::sin(0.3)) == Approx(crest));
  options.height_m = 12.2;  // Miche has 12.4 m
  REQUIRE(wave_problems(options, water).size() == 1);
  CHECK(wave_problems(options, water)[0].key == "waves.height_m");
}

TEST_CASE("a sea from a file has the file's elevation at the origin", "[sea][fast]") {
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "spindrift_elevation_test.csv";
  const auto eta = [](double t) { return 1.2 * std::cos(2.0 * pi * t / 10.0 - 0.4) + 0.5 * std::sin(2.0 * pi * t / 4.0); };
  const auto write = [&](double mean, double late) {
    std::ofstream out(file);
    out << "time_s,elevation_m\n";
    for (int i = 0; i < 400; ++i) out << 5.0 + 0.25 * i + (i == 200 ? late : 0.0) << "," << eta(5.0 + 0.25 * i) + mean << "\n";
  };
  write(0.0, 0.0);
  WavesOptions options;
  options.model = "elevation", options.file = file.string(), options.highest_Hz = 1.0;
  CHECK(wave_problems(options, water).empty());
  const WaveField sea(options, water);
  for (const double t : {5.0, 17.3, 60.0, 104.0}) CHECK(sea.elevation(t, 0.0, 0.0) == Approx(eta(t)).margin(1e-5));
  CHECK(sea.elevation(117.3, 0.0, 0.0) == Approx(eta(17.3)).margin(1e-5));  // it repeats
  options.highest_Hz.reset();
  CHECK(WaveField(options, water).components().size() < 30);  // what holds 99.9 % of the energy
  write(1.0, 0.0);
  REQUIRE(wave_problems(options, water).size() == 1);
  CHECK(wave_problems(options, water)[0].what.find("still water") != std::string::npos);
  write(0.0, 0.1);
  REQUIRE(wave_problems(options, water).size() == 1);
  CHECK(wave_problems(options, water)[0].what.find("equal steps") != std::string::npos);
  std::filesystem::remove(file);
}

TEST_CASE("spreading and a constrained crest change any random sea", "[sea][fast]") {
  WavesOptions options = regular("jonswap");
  options.spreading_exponent = 6.0;
  options.crest_height_m = 2.2, options.crest_time_s = 40.0, options.crest_place_m = {10.0, 5.0};
  const WaveField sea(options, water);
  CHECK(sea.elevation(40.0, 10.0, 5.0) == Approx(2.2));
  double least = 10.0, most = -10.0;
  for (const waves::Component& c : sea.components()) least = std::min(least, c.direction), most = std::max(most, c.direction);
  CHECK(least < -0.5);
  CHECK(most > 0.5);
}

namespace {

/// Root mean square over times of the two conditions at the moving surface: d eta/dt + u . grad eta - w, and p / (rho g) - eta.
std::pair<double, double> surface_residuals(const WaveField& sea) {
  double kinematic = 0.0, dynamic = 0.0;
  const int n = 400;
  for (int i = 0; i < n; ++i) {
    const double t = 1.37 * i, x = 5.0, y = 2.0, d = 1e-4;
    const waves::Surface s = sea.surface(t, x, y);
    const double rate = (sea.elevation(t + d, x, y) - sea.elevation(t - d, x, y)) / (2.0 * d);
    const waves::Kinematics k = sea.kinematics(t, {x, y, s.elevation}, s.elevation);
    kinematic += std::pow(rate + k.velocity.x() * s.slope_x + k.velocity.y() * s.slope_y - k.velocity.z(), 2) / n;
    dynamic += std::pow(k.pressure_over_density / water.gravity - s.elevation, 2) / n;
  }
  return {std::sqrt(kinematic), std::sqrt(dynamic)};
}

WavesOptions bound_sea(double height) {
  WavesOptions options = regular("jonswap");
  options.height_m = height;
  options.components = 61;
  options.direction = 0.5;
  options.second_order = true;
  return options;
}

}  // namespace

TEST_CASE("the surface's conditions hold to the third power of the height with bound waves, to the second without",
          "[sea][order]") {
  const double depth = GENERATE(8.0, 20.6, 300.0);
  const SeaEnvironment here{1025.0, depth, 9.81};
  for (const bool second : {true, false}) {
    std::vector<double> kinematic, dynamic;
    for (const double height : {0.2, 0.1, 0.05}) {  // so low that every harmonic carries bound waves
      WavesOptions options = bound_sea(height);
      options.second_order = second;
      options.stretching = "extrapolated";
      REQUIRE(bound_wave_limit(height, 9.81) > 5.0 * 2.0 * pi / 8.8);
      const auto [a, b] = surface_residuals(WaveField(options, here));
      kinematic.push_back(a), dynamic.push_back(b);
    }
    for (const auto& residual : {kinematic, dynamic})
      for (std::size_t i = 0; i + 1 < residual.size(); ++i)
        CHECK(std::log2(residual[i] / residual[i + 1]) == Approx(second ? 3.0 : 2.0).margin(0.1));
  }
}

TEST_CASE("a sea of second order is the linear sea and its bound waves, which grow by the ramp squared", "[sea][fast]") {
  WavesOptions options = bound_sea(1.5), linear = options;
  linear.second_order = false, linear.stretching = "extrapolated";
  const WaveField first(linear, water), full(options, water);
  options.ramp_s = 80.0;
  const WaveField growing(options, water);
  CHECK(full.components().size() == first.components().size());
  const double r = growing.ramp(30.0);
  const Eigen::Vector3d under(4.0, -3.0, -2.0);
  CHECK(std::abs(full.elevation(30.0, 4.0, -3.0) - first.elevation(30.0, 4.0, -3.0)) > 1e-3);
  const auto bound = [&](const auto& of) { return Eigen::Vector3d(of(full) - of(first)); };
  const auto grown = [&](const auto& of) { return (of(growing) - r * of(first) - r * r * bound(of)).norm(); };
  CHECK(grown([&](const WaveField& sea) {
          const waves::Surface s = sea.surface(30.0, 4.0, -3.0);
          return Eigen::Vector3d(s.elevation, s.slope_x, s.slope_y);
        }) < 1e-12);
  CHECK(grown([&](const WaveField& sea) { return sea.kinematics(30.0, under, 0.0).velocity; }) < 1e-12);
  CHECK(grown([&](const WaveField& sea) { return sea.kinematics(30.0, under, 0.0).acceleration; }) < 1e-12);
  // Above still water the linear waves go on in a straight line, the bound ones stay as they are there.
  const auto speed = [&](double z) { return full.kinematics(30.0, {4.0, -3.0, z}, 2.0).velocity; };
  CHECK((speed(0.6) - 2.0 * speed(0.3) + speed(0.0)).norm() < 1e-13);
  const double d = 1e-4;
  CHECK(
      ((speed(0.3) - speed(0.0)) / 0.3 -
       (first.kinematics(30.0, {4.0, -3.0, d}, 2.0).velocity - first.kinematics(30.0, {4.0, -3.0, -d}, 2.0).velocity) / (2.0 * d))
          .norm() < 1e-6);
}

TEST_CASE("harmonics beyond the limit of the expansion carry no bound waves", "[sea][fast]") {
  // Stansberg (1998): sqrt(2 g / Hs).
  CHECK(bound_wave_limit(2.0, 9.81) == Approx(3.1321).epsilon(1e-4));
  WavesOptions options = regular("jonswap");
  options.height_m = 1.8, options.period_s = 7.0, options.second_order = true;
  const WaveField sea(options, water);
  std::vector<waves::Component> carriers;
  for (const waves::Component& c : sea.components())
    if (c.angular_frequency <= bound_wave_limit(1.8, 9.81)) carriers.push_back(c);
  REQUIRE(carriers.size() < sea.components().size());
  const waves::BoundWaves bound(carriers, water.water_depth, water.gravity);
  options.second_order = false;
  const WaveField linear(options, water);
  CHECK(sea.elevation(17.0, 3.0, 0.0) == Approx(linear.elevation(17.0, 3.0, 0.0) + bound.surface(17.0, 3.0, 0.0).elevation));
}
