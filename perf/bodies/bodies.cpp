// Cost of the bodies' step: platform and rotor on a driven bearing, without loads but weight. An engineering run of 150 s at 0.05
// s that is to go 200 times faster than real time has 62 us for each of its four right-hand sides, loads included.
// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "perf/harness.hpp"
#include "src/bodies/loads.hpp"
#include "src/bodies/system.hpp"

using namespace spindrift;
using namespace spindrift::bodies;

namespace {

System turbine(Integrator integrator) {
  Body platform, rotor;
  platform.name = "platform";
  platform.mass = 4.2e6;
  platform.inertia = Eigen::Vector3d(2.03e10, 2.03e10, 2.8e9).asDiagonal();
  rotor.name = "rotor";
  rotor.mass = 2.3e5;
  rotor.inertia = Eigen::Vector3d(1.56e8, 7.8e7, 7.8e7).asDiagonal();
  rotor.initial.position = {0, 0, 119};
  Joint bearing;
  bearing.name = "bearing";
  bearing.i = 0;
  bearing.j = 1;
  bearing.point = {0, 0, 119};
  bearing.rotation = PrescribedMotion{.rate = 0.92};
  return System({platform, rotor}, {bearing}, {gravity_source(std::array{platform, rotor}, 9.81)}, integrator);
}

}  // namespace

int main(int argc, char** argv) {
  perf::Group group("bodies", argc, argv);
  for (const Integrator integrator : {Integrator::rk4, Integrator::symplectic, Integrator::explicit_euler}) {
    System system = turbine(integrator);
    BodiesState state = system.assemble().state;
    const double step_us = 1e6 * perf::measure([&] {
                                   StepReport report = system.advance(state, 1e-3, 1);
                                   perf::keep(report.trouble);
                                 }).median;
    const std::string name = "platform_rotor_" + std::string(spindrift::name(integrator));
    if (integrator == Integrator::rk4)
      group.at_most(name, step_us / 4, "us/rhs", 10.0, perf::Ceiling::fma_double, "a step over its four right-hand sides");
    else
      group.figure(name, step_us, "us/step");
  }
}
