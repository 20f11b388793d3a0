// Laws of src/aero/thrust_curve.hpp, then the DTU 10-MW turbine's operating table.
// SPDX-License-Identifier: Apache-2.0
#include "src/aero/thrust_curve.hpp"

#include <catch2/catch.hpp>

#include "kernels/base/constants.hpp"
#include "src/scene/error.hpp"
#include "tests/src/aero/data_file.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using Catch::Matchers::Contains;

namespace {

constexpr double rho = 1.225;

RotorOptions rotor_of(double diameter = 178.33) {
  RotorOptions r;
  r.diameter_m = diameter;
  return r;
}

ThrustCurve with_curve(const std::string& path, const std::string& interpolation = "linear") {
  AeroOptions o;
  o.curve = path, o.interpolation = interpolation;
  return ThrustCurve(o, rotor_of(), rho);
}

}  // namespace

TEST_CASE("the analytic law goes with area and relative wind squared, and turns round with the wind", "[aero][fast]") {
  AeroOptions o;
  o.thrust_coefficient = 0.814, o.torque_coefficient = 0.0635;
  const ThrustCurve law(o, rotor_of(), rho);
  const double u = GENERATE(-30.0, -2.0, 0.0, 1e-3, 11.0, 50.0), area = pi / 4 * 178.33 * 178.33;
  CHECK(law(u, 1.0, 0.0).thrust == Approx(0.5 * rho * area * 0.814 * std::abs(u) * u));
  CHECK(law(u, 1.0, 0.0).torque == Approx(0.5 * rho * area * 89.165 * 0.0635 * std::abs(u) * u));
  CHECK(law(-u, 1.0, 0.0).thrust == -law(u, 1.0, 0.0).thrust);
  const double slope = (law(u + 1e-3, 1.0, 0.0).thrust - law(u - 1e-3, 1.0, 0.0).thrust) / 2e-3;
  CHECK(slope == Approx(rho * area * 0.814 * std::abs(u)).margin(rho * area * 1e-3));  // dT/dU = rho A C_T |U|
}

TEST_CASE("the DTU 10-MW table gives the 2013 report's thrust and power at its own rotor speed", "[aero][fast]") {
  // Bak et al. (2013), DTU Wind Energy Report-I-0092.
  const auto interpolation = GENERATE("linear", "cubic");
  const ThrustCurve turbine = with_curve(SPINDRIFT_SOURCE_DIR "/inputs/turbines/dtu_10mw_operation.csv", interpolation);
  struct Row {
    double wind, rpm, thrust, power;
  };
  const auto row = GENERATE(Row{4, 6, 225.9e3, 280.2e3}, Row{8, 6.4257, 797.3e3, 3730.7e3}, Row{11, 8.8354, 1507.4e3, 9698.3e3},
                            Row{13, 9.6, 1082.0e3, 10648.5e3}, Row{25, 9.6, 567.2e3, 10635.7e3});
  const AxialLoad load = turbine(row.wind, row.rpm * rad_s_per_rpm, 0.0);
  CHECK(load.thrust == Approx(row.thrust));
  CHECK(load.torque * row.rpm * rad_s_per_rpm == Approx(row.power));
  CHECK(turbine.coefficients(8.0, 1.0, 0.0).thrust == Approx(0.814).epsilon(0.002));
  CHECK(turbine(2.0, 0.6, 0.0).thrust == Approx(225.9e3 / 4));  // below the table as U^2
  CHECK(turbine(50.0, 0.6, 0.0).thrust == Approx(567.2e3 * 4));
  CHECK(turbine(0.0, 0.6, 0.0).thrust == 0.0);
}

TEST_CASE("coefficients against tip-speed ratio and pitch are bilinear, and hold at the edges", "[aero][fast]") {
  const ThrustCurve grid = with_curve(data_file("grid.csv",
                                                "tip_speed_ratio,blade_pitch_deg,ct,cp\n"
                                                "4,0,0.5,0.2\n8,0,0.9,0.4\n4,10,0.3,0.1\n8,10,0.1,0.0\n"));
  const double r = 89.165, degree = radians_per_degree;
  CHECK(grid.coefficients(10.0, 40.0 / r, 0.0).thrust == Approx(0.5));
  CHECK(grid.coefficients(10.0, 60.0 / r, 5 * degree).thrust == Approx(0.45));
  CHECK(grid.coefficients(10.0, 80.0 / r, 0.0).torque == Approx(0.4 / 8));
  CHECK(grid.coefficients(10.0, 10.0 / r, 0.0).thrust == Approx(0.5));
  CHECK(grid.coefficients(0.0, 10.0 / r, 90 * degree).thrust == Approx(0.1));
  CHECK(grid.coefficients(0.0, 0.0, 0.0).thrust == Approx(0.9));
  const ThrustCurve line = with_curve(data_file("line.csv", "tip_speed_ratio,ct\n4,0.5\n8,0.9\n"));
  CHECK(line.coefficients(10.0, 60.0 / r, 1.0).thrust == Approx(0.7));
  CHECK(line.coefficients(10.0, 60.0 / r, 1.0).torque == 0.0);
}

TEST_CASE("a curve that says too little or too much is refused", "[aero][fast]") {
  struct Case {
    const char *text, *message;
  };
  const auto c = GENERATE(
      Case{"wind_m_s,thrust_N,ct\n4,1,1\n5,1,1\n", "both thrust_N and ct"}, Case{"wind_m_s,power_W\n4,1\n5,1\n", "thrust_N, ct"},
      Case{"wind_m_s,ct,cp\n4,1,1\n5,1,1\n", "needs a column \"speed_rpm\""},
      Case{"wind_m_s,ct,cp,speed_rpm\n4,1,1,0\n5,1,1,6\n", "speed_rpm must be positive"},
      Case{"wind_m_s,ct\n0,1\n5,1\n", "must be positive"}, Case{"wind_m_s,ct\n5,1\n4,1\n", "must be above 5"},
      Case{"tip_speed_ratio,blade_pitch_deg,ct\n4,0,1\n8,0,1\n4,5,1\n", "need 4"},
      Case{"tip_speed_ratio,blade_pitch_deg,ct\n4,0,1\n8,0,1\n4,5,1\n4,5,2\n", "repeats a pair"},
      Case{"tip_speed_ratio,ct\n4,1\n", "at least two"}, Case{"tip_speed_ratio,ct,pitch\n4,1,0\n8,1,0\n", "\"pitch\""});
  const std::string path = data_file("bad_curve.csv", c.text);
  CHECK_THROWS_WITH(with_curve(path), Contains(c.message));
}
