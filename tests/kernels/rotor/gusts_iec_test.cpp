// IEC's wind events: continuous, of the height that the standard says, gone when they are over; Kaimal's spectra integrate.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/rotor/gusts_iec.hpp"

#include <catch2/catch.hpp>

#include "kernels/rotor/turbulence_kaimal.hpp"

using namespace spindrift;

namespace {
const iec::Site nrel5mw{
    .hub_wind = 11.4, .hub_height = 90.0, .diameter = 126.0, .reference_wind = 50.0, .reference_intensity = 0.16};
}

TEST_CASE("events begin and end without a jump", "[rotor][fast]") {
  const double h = 1e-7;
  for (const double period : {iec::eog_period, iec::ecd_period, iec::edc_period, iec::ews_period})
    for (const double t : {0.0, period}) {
      CHECK(std::abs(iec::eog(nrel5mw, t + h) - iec::eog(nrel5mw, t - h)) < 1e-4);
      CHECK(std::abs(iec::ecd_speed(t + h) - iec::ecd_speed(t - h)) < 1e-4);
      CHECK(std::abs(iec::edc_direction(nrel5mw, t + h) - iec::edc_direction(nrel5mw, t - h)) < 1e-4);
      CHECK(std::abs(iec::ews(nrel5mw, 60.0, t + h) - iec::ews(nrel5mw, 60.0, t - h)) < 1e-4);
    }
}

TEST_CASE("an operating gust dips, peaks by .74 of its height in the middle, and is gone after 10.5 s", "[rotor][fast]") {
  CHECK(iec::eog(nrel5mw, 0.5 * iec::eog_period) == Approx(0.74 * iec::eog_height(nrel5mw)));
  CHECK(iec::eog(nrel5mw, 0.2 * iec::eog_period) < 0.0);
  CHECK(iec::eog(nrel5mw, iec::eog_period + 1.0) == 0.0);
}

TEST_CASE("numbers of the standard at 11.4 m/s, class IA, 126 m at 90 m", "[rotor][fast]") {
  // By hand from eqs. 11, 17, 21, 24: sigma = .16 (.75 x 11.4 + 5.6), Lambda = 42 m.
  CHECK(iec::sigma_normal(11.4, 0.16) == Approx(2.264));
  CHECK(iec::eog_height(nrel5mw) == Approx(3.3 * 2.264 / 1.3));
  CHECK(iec::edc_direction(nrel5mw, 6.0) == Approx(4.0 * std::atan(2.264 / (11.4 * 1.3))));
  CHECK(iec::ecd_direction(nrel5mw, 10.0) == Approx(720.0 / 11.4 * radians_per_degree));
  CHECK(iec::ecd_speed(10.0) == 15.0);
  CHECK(iec::ews(nrel5mw, 63.0, 6.0) == Approx(2.5 + 1.28 * 2.264 * std::pow(3.0, 0.25)));
  CHECK(iec::sigma_extreme(11.4, 0.16, 10.0) == Approx(2.0 * 0.16 * (0.072 * 8.0 * 1.7 + 10.0)));
}

TEST_CASE("Kaimal's spectrum integrates to the variance and the coherence falls from one", "[rotor][fast]") {
  const double sigma = 1.7, length = 340.0, wind = 12.0;
  double sum = 0.0, low = 1e-7;
  while (low < 1e4) {  // trapezia, a fiftieth of a decade each
    const double high = low * std::pow(10.0, 0.02);
    sum += 0.5 * (high - low) * (kaimal::density(low, sigma, length, wind) + kaimal::density(high, sigma, length, wind));
    low = high;
  }
  CHECK(sum == Approx(sigma * sigma).epsilon(2e-3));
  CHECK(kaimal::coherence(0.1, 0.0, length, wind) == 1.0);
  CHECK(kaimal::coherence(0.0, 100.0, length, wind) == Approx(std::exp(-12.0 * 0.12 * 100.0 / length)));
  CHECK(kaimal::coherence(0.1, 20.0, length, wind) < kaimal::coherence(0.1, 10.0, length, wind));
}
