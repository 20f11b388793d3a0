// Cost of exact buoyancy and of one evaluation of the engineering sea on the paper's platform (three floats, four strips each).
// Bars: 0.3 us per cylinder at any attitude; a few microseconds per evaluation, so that hundreds of times real time stay
// possible. SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>
#include <vector>

#include "kernels/base/random.hpp"
#include "kernels/waves/wetted_cylinder.hpp"
#include "kernels/waves/wetted_frustum.hpp"
#include "perf/harness.hpp"
#include "src/sea/engineering_sea.hpp"

using namespace spindrift;
using namespace spindrift::perf;
using Eigen::Vector3d;

namespace {

struct Axis {
  Vector3d start, end;
};

/// Axes of 6 m whose angle from the vertical lies between two limits [rad], all of them cutting the surface or near it.
std::vector<Axis> axes(double least_tilt, double most_tilt) {
  Random random(1);
  std::vector<Axis> result;
  for (int i = 0; i < 1024; ++i) {
    const double tilt = least_tilt + (most_tilt - least_tilt) * random.uniform(), turn = 2.0 * pi * random.uniform();
    const Vector3d axis(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), std::cos(tilt));
    const Vector3d middle(0, 0, 2.0 * random.uniform() - 1.0);
    result.push_back({middle - 3.0 * axis, middle + 3.0 * axis});
  }
  return result;
}

template <class Kernel>
double nanoseconds(const std::vector<Axis>& set, Kernel&& kernel) {
  double sum = 0.0;
  const double time = measure([&] {
                        for (const Axis& a : set) sum += kernel(a).volume;
                      }).median;
  keep(sum);
  return 1e9 * time / double(set.size());
}

double microseconds(const char* model, const char* wave, bool second_order = false) {
  sea::SeaBody platform{"platform", {}, {}};
  for (int i = 0; i < 3; ++i) {
    const double angle = 2.0 * pi / 3.0 * i, x = 46.7 * std::cos(angle), y = 46.7 * std::sin(angle);
    platform.cylinders.push_back({"float", {{x, y, -30}, {x, y, -10}, 5.625, 5.625}});
  }
  sea::SeaOptions options;
  options.model = model;
  sea::WavesOptions waves;
  waves.model = wave, waves.height_m = 1.88, waves.period_s = 8.8, waves.second_order = second_order;
  const sea::EngineeringSea water(options, waves, {1025.0, 20.6, 9.81}, {platform});
  Motion motion;
  motion.position = {0.2, 0, 15.4};
  motion.attitude = Eigen::AngleAxisd(0.09, Vector3d::UnitY());
  Wrench load;
  load.point = motion.position;
  sea::Matrix6 mass = sea::Matrix6::Zero();
  double t = 0.0;
  const double time = measure([&] { water.add(t += 0.01, {&motion, 1}, {&load, 1}, {&mass, 1}); }).median;
  keep(load.force.x());
  return 1e6 * time;
}

}  // namespace

int main(int argc, char** argv) {
  Group group("sea_engineering", argc, argv);
  const waves::WaterPlane still;
  const auto cylinder = [&](const Axis& a) { return waves::wetted_cylinder(a.start, a.end, 1.0, still); };
  const auto frustum = [&](const Axis& a) { return waves::wetted_frustum(a.start, a.end, 1.0, 0.6, still); };
  group.at_most("cylinder_upright", nanoseconds(axes(0.0, 0.1), cylinder), "ns", 300.0, Ceiling::fma_double);
  group.at_most("cylinder_any", nanoseconds(axes(0.0, pi), cylinder), "ns", 300.0, Ceiling::fma_double);
  group.at_most("cylinder_lying", nanoseconds(axes(0.5 * pi, 0.5 * pi + 1e-3), cylinder), "ns", 300.0, Ceiling::fma_double);
  group.figure("frustum_any", nanoseconds(axes(0.0, pi), frustum), "ns");
  group.at_most("hydrostatic", microseconds("hydrostatic", "none"), "us", 1.0, Ceiling::fma_double);
  group.at_most("morison_still", microseconds("morison", "none"), "us", 5.0, Ceiling::fma_double, "with added mass");
  group.at_most("morison_stokes2", microseconds("morison", "stokes2"), "us", 10.0, Ceiling::fma_double, "with added mass");
  group.figure("morison_jonswap_200", microseconds("morison", "jonswap"), "us", "with added mass, 200 harmonics");
  group.figure("morison_jonswap_200_second_order", microseconds("morison", "jonswap", true), "us", "the same with bound waves");
}
