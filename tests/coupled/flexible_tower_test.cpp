// Scenes with a flexible tower: the DTU 10 MW turbine on land (inputs/validation/dtu_tower) and afloat.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/coupled/runs.hpp"

using namespace spindrift;
using namespace spindrift::coupling;
using namespace spindrift::coupling::test;

namespace {

/// Frequency [1/s] from the first to the last upward crossing of the mean.
double frequency_of(std::span<const double> time, std::span<const double> value) {
  double mean = 0.0, first = 0.0, last = 0.0;
  int crossings = 0;
  for (const double v : value) mean += v / double(value.size());
  for (std::size_t i = 1; i < value.size(); ++i) {
    const double a = value[i - 1] - mean, b = value[i] - mean;
    if (a > 0.0 || b <= 0.0) continue;
    last = time[i - 1] - a / (b - a) * (time[i] - time[i - 1]);
    if (crossings++ == 0) first = last;
  }
  return (crossings - 1) / (last - first);
}

}  // namespace

TEST_CASE("the DTU tower on land sways at a quarter of a hertz and its foot carries what is above", "[coupled][fast]") {
  const Folder folder("dtu_tower");
  REQUIRE(run_scene(input("validation/dtu_tower/dtu_tower.toml"), {}, folder.path()).exit_code == 0);
  const scene::Columns history = scene::read_columns((folder.path() / "history.csv").string());
  const auto time = history["time_s"], fore = history["tower.deflection_x_m"], side = history["tower.deflection_y_m"];
  CHECK(frequency_of(time, fore) == Approx(0.248).epsilon(0.02));
  CHECK(frequency_of(time, side) == Approx(0.246).epsilon(0.02));
  double weight = 0.0;
  for (const double f : history["tower.start_fz_N"]) weight -= f / double(time.size());
  CHECK(weight == Approx(9.81 * (446036.0 + 227962.0 + 628443.0)).epsilon(0.01));
}
