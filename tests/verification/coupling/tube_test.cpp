// The flexible tube against computed references (VALIDATION of the project, section 7): displacement after 100 steps, evaluations
// by scheme. SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "kernels/coupling/ibqn_ls.hpp"
#include "kernels/coupling/interface_gmres.hpp"
#include "kernels/coupling/iqn_ils.hpp"
#include "kernels/coupling/newton.hpp"
#include "kernels/coupling/relaxation_aitken.hpp"
#include "kernels/coupling/relaxation_steepest_descent.hpp"
#include "tests/verification/coupling/tube.hpp"

using namespace spindrift::coupling;
using namespace spindrift::coupling::test;

namespace {

constexpr double relaxation = 0.05;
constexpr double reference = 2.6129721e-5, reference_light = 9.64217e-6, reference_fine = 8.4454381e-5;  // m
// Schemes stop at 1e-6 of the first residual and then differ by up to 2e-6 of the displacement.
constexpr double tolerance = 4e-6;

void check(const TubeRun& run, double evaluations, double displacement = reference) {
  CHECK(run.steps == 100);
  CHECK(run.largest == Approx(displacement).epsilon(tolerance));
  CHECK(run.mean_with_probes == Approx(evaluations).epsilon(0.15));
}

}  // namespace

TEST_CASE("quasi-Newton, Krylov and Aitken schemes need the evaluations known for the tube, in that order", "[coupling][fast]") {
  const TubeProblem tube;
  const double iqn[3] = {12.3, 4.3, 3.6}, ibqn[3] = {11.9, 4.2, 3.5}, gmres[3] = {16.9, 9.8, 8.0};
  const int reuse[3] = {0, 5, 10};
  const TubeRun aitken = run_tube(tube, RelaxationAitken(relaxation));
  check(aitken, 38.0);
  for (int i = 0; i < 3; ++i) {
    const LearningOptions learning{.reuse = reuse[i]};
    const TubeRun a = run_tube(tube, IqnIls(relaxation, learning)), b = run_tube(tube, IbqnLs(relaxation, learning)),
                  c = run_tube(tube, InterfaceGmres(relaxation, learning));
    INFO("reuse " << reuse[i]);
    check(a, iqn[i]), check(b, ibqn[i]), check(c, gmres[i]);
    CHECK(std::max(a.mean_evaluations, b.mean_evaluations) < c.mean_with_probes);
    CHECK(c.mean_with_probes < aitken.mean_evaluations);
  }
}

TEST_CASE("Newton with a Jacobian by differences takes three iterations a step on the tube", "[coupling][fast]") {
  const TubeRun newton = run_tube({}, Newton(1e-9), 30, 1000);
  CHECK(newton.steps == 30);
  CHECK(newton.mean_evaluations == Approx(3.0).epsilon(0.15));
}

TEST_CASE("a light wall and a short step leave the tube's displacement where it is known", "[coupling][fast]") {
  const auto scheme = IqnIls(relaxation, {.reuse = 5});
  const TubeRun light = run_tube({.wall_density = 120.0}, scheme), fine = run_tube({.step = 1e-5}, scheme);
  CHECK(light.largest == Approx(reference_light).epsilon(1e-6));
  CHECK(fine.largest == Approx(reference_fine).epsilon(1e-6));
}

TEST_CASE("the undamped fixed point diverges on the tube and is reported; a factor of 0.05 never converges, 0.02 does",
          "[coupling][fast]") {
  const TubeRun undamped = run_tube({}, RelaxationConstant(1.0), 2);
  CHECK(undamped.steps < 2);
  CHECK((undamped.bound == Bound::divergence || undamped.bound == Bound::not_finite));
  const TubeRun fast = run_tube({}, RelaxationConstant(0.05), 1, 1000);
  CHECK(fast.steps == 0);
  CHECK_FALSE(converged(fast.bound));
  const TubeRun slow = run_tube({}, RelaxationConstant(0.02), 5, 1000);
  CHECK(slow.steps == 5);
  CHECK(slow.mean_evaluations > 100.0);
}

TEST_CASE("slow schemes reach the same displacement of the tube", "[coupling][nightly]") {
  const TubeRun constant = run_tube({}, RelaxationConstant(0.02), 100, 1000);
  const TubeRun descent = run_tube({}, RelaxationSteepestDescent(0.02), 100, 1000),
                newton = run_tube({}, Newton(1e-9), 100, 1000);
  for (const TubeRun& run : {constant, descent, newton}) {
    CHECK(run.steps == 100);
    CHECK(run.largest == Approx(reference).epsilon(tolerance));
  }
}
