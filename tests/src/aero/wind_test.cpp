// The wind over time at a point: steps, ramps, gusts, tables and boxes that blow past.
// SPDX-License-Identifier: Apache-2.0
#include "src/aero/wind.hpp"

#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>

#include "kernels/base/constants.hpp"
#include "kernels/rotor/turbulence_kaimal.hpp"
#include "src/aero/turbulence_box.hpp"
#include "src/scene/error.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using Catch::Contains;

namespace {
const Eigen::Vector3d hub(3.0, -2.0, 119.0);
const WindSite site{hub, 178.0};
double speed(const Wind& wind, double t) { return wind.at(t, hub).norm(); }
double direction(const Wind& wind, double t) {
  const Eigen::Vector3d v = wind.at(t, hub);
  return std::atan2(v.y(), v.x()) / radians_per_degree;
}
}  // namespace

TEST_CASE("before every event the wind is the steady one", "[aero][fast]") {
  const auto what = GENERATE(WindEvent::step, WindEvent::ramp, WindEvent::eog, WindEvent::ecd, WindEvent::edc,
                             WindEvent::ews_vertical, WindEvent::ews_horizontal);
  const WindOptions steady{.speed_m_s = 11.0, .direction = 0.3, .law = WindLaw::power, .reference_height_m = 119.0};
  WindOptions options = steady;
  options.event = WindEventOptions{.what = what, .start_s = 20.0, .speed_change_m_s = 2.0};
  const Eigen::Vector3d point = hub + Eigen::Vector3d(0.0, 30.0, 50.0);
  CHECK((wind_of(options, site).at(19.9, point) - wind_of(steady, site).at(0.0, point)).norm() < 1e-12);
  CHECK((wind_of(options, site).at(25.0, point) - wind_of(steady, site).at(0.0, point)).norm() > 0.1);
}

TEST_CASE("a wind that blows upwards does so in all that changes", "[aero][fast]") {
  WindOptions options{.speed_m_s = 10.0, .direction = 0.3, .incidence = 8.0 * radians_per_degree};
  const double rise = std::sin(options.incidence);
  const Wind steady = wind_of(options, site);
  CHECK(steady.at(0.0, hub).z() == Approx(10.0 * rise));
  options.event = WindEventOptions{.what = WindEvent::step, .start_s = 20.0, .speed_change_m_s = 2.0};
  const Wind step = wind_of(options, site);
  CHECK((step.at(1.0, hub) - steady.at(1.0, hub)).norm() < 1e-12);
  CHECK((step.common(1.0, hub) - steady.at(1.0, hub)).norm() < 1e-12);
  CHECK(speed(step, 21.0) == Approx(12.0));
  CHECK(step.at(21.0, hub).z() == Approx(12.0 * rise));
}

TEST_CASE("a step steps, a ramp ramps, both turn the wind as asked", "[aero][fast]") {
  WindOptions options{.speed_m_s = 10.0};
  options.event = WindEventOptions{.what = WindEvent::ramp,
                                   .start_s = 10.0,
                                   .speed_change_m_s = 4.0,
                                   .direction_change = 20.0 * radians_per_degree,
                                   .duration_s = 8.0};
  const Wind ramp = wind_of(options, site);
  CHECK(speed(ramp, 14.0) == Approx(12.0));
  CHECK(direction(ramp, 14.0) == Approx(10.0));
  CHECK(speed(ramp, 100.0) == Approx(14.0));
  options.event->what = WindEvent::step;
  CHECK(speed(wind_of(options, site), 10.1) == Approx(14.0));
}

TEST_CASE("vertical shear of the event is none at the hub and opposite above and below", "[aero][fast]") {
  WindOptions options{.speed_m_s = 12.0};
  options.event = WindEventOptions{.what = WindEvent::ews_vertical, .start_s = 0.0};
  const Wind wind = wind_of(options, site);
  const double above = wind.at(6.0, hub + 80.0 * Eigen::Vector3d::UnitZ()).x() - 12.0;
  CHECK(above > 2.0);
  CHECK(wind.at(6.0, hub - 80.0 * Eigen::Vector3d::UnitZ()).x() - 12.0 == Approx(-above));
  CHECK(speed(wind, 6.0) == Approx(12.0));
}

TEST_CASE("a table in time is joined by straight lines and begins the wind", "[aero][fast]") {
  const std::string path =
      (std::filesystem::temp_directory_path() / ("spindrift_wind_" + std::to_string(getpid()) + ".csv")).string();
  std::ofstream(path) << "time_s,speed_m_s,direction_deg,vertical_m_s\n0,8,0,0\n10,12,20,1\n";
  WindOptions options;
  options.table = path;
  CHECK(starting_speed(options) == 8.0);
  const Wind wind = wind_of(options, site);
  CHECK(wind.at(5.0, hub).z() == Approx(0.5));
  CHECK(wind.at(5.0, hub).head<2>().norm() == Approx(10.0));
  CHECK(direction(wind, 5.0) == Approx(10.0));
  CHECK(wind.at(99.0, hub).head<2>().norm() == Approx(12.0));
  CHECK(turns(options));

  std::ofstream(path) << "time_s,speed_m_s,direction_deg\n0,8,30\n10,12,30\n";  // which direction_deg need not say
  CHECK(starting_direction(options) == Approx(30.0 * radians_per_degree));
  CHECK((wind_of(options, site).velocity - wind_of(options, site).at(0.0, hub)).norm() < 1e-12);
  CHECK(!turns(options));

  std::ofstream(path) << "time_s,speed_m_s,direction_deg\n0,8,359\n10,8,1\n";  // across north
  CHECK_THROWS_WITH(wind_of(options, site), Contains(":3: direction_deg goes from 359 to 1") && Contains("write 361"));
  std::ofstream(path) << "time_s,speed_m_s,direction_deg\n0,8,359\n10,8,361\n";
  CHECK(direction(wind_of(options, site), 5.0) == Approx(0.0).margin(1e-9));
  std::filesystem::remove(path);
}

TEST_CASE("a box blows past: what is downwind by a distance was at the hub that distance over the wind ago", "[aero][fast]") {
  WindOptions options{.speed_m_s = 10.0, .direction = 0.4};
  options.turbulence = TurbulenceOptions{.seed = 3, .points_across = 4, .points_up = 4, .duration_s = 40.0, .step_s = 0.5};
  const Wind wind = wind_of(options, site);
  const Eigen::Vector3d along(std::cos(0.4), std::sin(0.4), 0.0);
  for (double t : {5.0, 11.3, 27.0}) CHECK((wind.at(t, hub) - wind.at(t + 2.5, hub + 25.0 * along)).norm() < 1e-6);
  CHECK((wind.at(1.0, hub) - wind.at(41.0, hub)).norm() < 1e-6);
  CHECK((wind.at(1.0, hub) - 10.0 * along).norm() > 1e-2);
}

TEST_CASE("a box whose standard deviation is not the one asked for says so", "[aero][fast]") {
  WindOptions options{.speed_m_s = 10.0};
  const WindSite small{hub, 2.0};  // over which all points have one gust
  options.turbulence =
      TurbulenceOptions{.seed = 3, .sigma_m_s = 1.5, .points_across = 2, .points_up = 2, .duration_s = 600.0, .step_s = 0.5};
  double lines = 0.0;  // from 1 / duration_s to 1 / (2 step_s)
  for (int k = 1; k < 600; ++k) lines += kaimal::density(k / 600.0, 1.5, 8.1 * 42.0, 10.0) / 600.0;
  const std::string said = wind_of(options, small).spread(), before = "standard deviation along the wind ";
  CHECK_THAT(said, Contains(before) && Contains("asked for 1.5:"));
  CHECK(std::stod(said.substr(before.size())) ==
        Approx(std::sqrt(lines)).epsilon(0.02));  // the first point has them, the others scatter
  options.turbulence->duration_s = 8000.0, options.turbulence->step_s = 0.1;
  CHECK(wind_of(options, small).spread().empty());
  options.turbulence.reset();
  CHECK(wind_of(options, small).spread().empty());
}

TEST_CASE("a box that does not cover the rotor is refused", "[aero][fast]") {
  WindOptions options{.speed_m_s = 10.0};
  options.turbulence = TurbulenceOptions{.points_across = 3, .points_up = 3, .width_m = 100.0, .duration_s = 20.0, .step_s = 0.5};
  CHECK_THROWS_AS(wind_of(options, site), scene::SceneError);
}

TEST_CASE("a .bts that does not repeat is refused where it ends before the run, a periodic one is not", "[aero][fast]") {
  const std::string path =
      (std::filesystem::temp_directory_path() / ("spindrift_wind_" + std::to_string(getpid()) + ".bts")).string();
  BtsFile file{.id = 7, .up = 3, .across = 3, .steps = 41, .up_m = 100, .across_m = 100, .step_s = 0.5f, .wind = 10};
  file.hub_height = 119, file.bottom = 19;
  file.grid.resize(3 * 3 * 3 * 41, 10);
  write_bts(file, path);
  WindOptions options;
  options.turbulence = TurbulenceOptions{.model = TurbulenceModel::bts, .file = path, .start_s = 1.0};
  // 20 s less start_s, half the width (100 m) and the radius (89 m) over 10 m/s.
  const auto for_run = [&](double t_end, double upwind = 0.0) {
    return wind_of(options, {.hub = hub, .diameter = 178.0, .upwind = upwind, .t_end = t_end});
  };
  CHECK_NOTHROW(for_run(0.099));
  CHECK_THROWS_WITH(for_run(0.2), Contains("wind.turbulence.file") && Contains("must be at most 0.1"));
  options.turbulence->start_s = 0.0;
  CHECK_NOTHROW(for_run(0.2));
  CHECK_THROWS_WITH(for_run(0.2, 15.0), Contains("wind.turbulence.file"));
  // At the start the first plane is half the width downwind of the hub; of a file that repeats it is at x = 0.
  options.turbulence->start_s = 1.0;
  file.grid[3 * 9 * 2 + 12] = 16;  // the middle of the plane at 1 s
  for (const int id : {7, 8}) {
    file.id = std::int16_t(id);
    write_bts(file, path);
    const Wind wind = for_run(id == 8 ? 1000.0 : 0.0);
    const Eigen::Vector3d first = id == 8 ? Eigen::Vector3d(0.0, hub.y(), hub.z()) : hub + Eigen::Vector3d(100.0, 0.0, 0.0);
    CHECK(wind.at(0.0, first).x() == 16.0);
    CHECK(wind.at(0.0, first + Eigen::Vector3d(5.0, 0.0, 0.0)).x() == 10.0);
    CHECK(wind.at(0.0, first - Eigen::Vector3d(2.5, 0.0, 0.0)).x() == Approx(13.0));
  }
  std::filesystem::remove(path);
}
