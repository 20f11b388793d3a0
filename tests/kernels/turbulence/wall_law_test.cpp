// Closures' own laws of the wall: against what is published of them, linear at the wall, logarithmic away from it, inverted to
// rounding. SPDX-License-Identifier: Apache-2.0
#include "kernels/turbulence/wall_law.hpp"

#include <catch2/catch.hpp>
#include <tuple>
#include <vector>

#include "kernels/turbulence/model_k_omega.hpp"
#include "kernels/turbulence/model_sa_des.hpp"
#include "kernels/turbulence/model_sst.hpp"
#include "kernels/turbulence/wall_layer.hpp"

using namespace spindrift::turbulence;

namespace {

using OneEquation = std::tuple<Sa, SaNeg, Des97, Ddes>;
using TwoEquations = std::tuple<Sst, Sst2003Vm, Sst1994, SstV, SstVm, KOmega, KOmega1988>;
using Transported = std::tuple<Sa, SaNeg, Des97, Ddes, Sst, Sst2003Vm, Sst1994, SstV, SstVm, KOmega, KOmega1988>;

template <class Model>
const WallLayer<Model>& layer() {
  static const WallLayer<Model> of;
  return of;
}
template <class Model>
const WallLaw& law() {
  static const WallLaw of = layer<Model>().law();
  return of;
}

/// Spalart-Allmaras in the layer of constant stress: Allmaras, Johnson & Spalart (2012), ICCFD7-1902, eq. 39 and its constants.
double allmaras(double y) {
  const double a1 = 8.148221580024245, a2 = -6.9287093849022945, b1 = 7.4600876082527945, b2 = 7.468145790401841;
  return 5.0333908790505579 + 2.5496773539754747 * std::log((y + a1) * (y + a1) + b1 * b1) -
         1.3301651588535228 * std::log((y + a2) * (y + a2) + b2 * b2) - 3.599459109332379 * std::atan2(b1, y + a1) -
         3.6397531868684494 * std::atan2(b2, y + a2);
}

}  // namespace

TEMPLATE_LIST_TEST_CASE("Spalart-Allmaras and its kin have the published law of the wall", "[turbulence][fast]", OneEquation) {
  for (double y = 0.01; y < 3e4; y *= 1.17) {
    CAPTURE(y);
    CHECK(law<TestType>().velocity(y) == Approx(allmaras(y)).epsilon(2e-4));
  }
}

// NASA's Turbulence Modeling Resource, flat plate, SST-V, x = 0.97 (flatplate_u+y+_sstv.dat, 545 x 385 nodes). The plate's stress
// falls away from the wall, by some per cent at y+ 100: the layer of constant stress lies below by as much.
TEST_CASE("SST has the law of the wall that codes find on a flat plate", "[turbulence][fast]") {
  const std::pair<double, double> published[]{{0.92, .922642},  {2.15, 2.15143},  {4.95, 4.85054},
                                              {8.48, 7.42862},  {15.94, 10.2625}, {29.51, 12.5261},
                                              {48.15, 14.0888}, {69.47, 15.1748}, {100.19, 16.2138}};
  for (const auto& [y, u] : published) {
    CAPTURE(y);
    CHECK(law<SstV>().velocity(y) == Approx(u).epsilon(0.01));
  }
}

TEMPLATE_LIST_TEST_CASE("every closure's layer converges and is logarithmic away from the wall", "[turbulence][fast]",
                        Transported) {
  const WallLaw& w = law<TestType>();
  CAPTURE(TestType::name, layer<TestType>().health.steps);
  CHECK(layer<TestType>().health.change < 1e-10);
  for (const double y : {1e-3, 0.1, 1.0}) CHECK(w.velocity(y) == Approx(y).epsilon(2e-3));
  const double kappa = 1.0 / (w.velocity(1e4) - w.velocity(1e3)) * std::log(10.0);
  CHECK(kappa == Approx(0.405).margin(0.01));
  for (const double y : {1e3, 1e4, 1e6}) CHECK(y * w.slope(y) * kappa == Approx(1.0).epsilon(0.03));  // k-omega: 6 % at 200 still
  double before = 0.0;
  for (double y = 1e-4; y < 1e6; y *= 1.03) {
    CHECK(w.velocity(y) > before);
    before = w.velocity(y);
  }
}

TEMPLATE_LIST_TEST_CASE("k and omega of the logarithmic layer and of the sublayer are the known ones", "[turbulence][fast]",
                        TwoEquations) {
  const WallLaw& w = law<TestType>();
  CAPTURE(TestType::name);
  for (const double y : {1e3, 1e4, 1e5}) {
    CHECK(w.k(y) == Approx(1.0 / 0.3).epsilon(0.01));
    // Stress: k / omega times the slope is 1, but for the laminar share.
    CHECK(w.k(y) / w.omega(y) * w.slope(y) == Approx(1.0).epsilon(0.01));
  }
  for (const double y : {0.01, 0.1, 0.5}) CHECK(w.omega(y) == Approx(6.0 / (TestType::wall_beta * y * y)).epsilon(0.02));
  CHECK(std::log(w.k(0.4) / w.k(0.2)) / std::log(2.0) == Approx(3.23).margin(0.1));  // Wilcox: k ~ y^3.23
}

TEST_CASE("the law of the wall is tabulated to within a fifth of its step squared", "[turbulence][fast]") {
  // Against the published solution, which is exact; the layer is discretised to second order.
  const double h = WallLaw::step();
  double worst = 0.0;
  for (double y = 1.0; y < 1e4; y *= 1.1) worst = std::max(worst, std::abs(law<Sa>().velocity(y) / allmaras(y) - 1.0));
  CAPTURE(worst, h);
  CHECK(worst < 0.2 * h * h);
}

TEST_CASE("the slope of the law of the wall is that of its values", "[turbulence][fast]") {
  for (const WallLaw* w : {&law<Sa>(), &law<SstVm>(), &law<KOmega>()})
    for (const double y : {1e-3, 0.03, 0.1, 1.0, 5.0, 12.0, 40.0, 300.0, 9e3, 2e4}) {
      const double d = 1e-5 * y;
      CHECK(w->slope(y) == Approx((w->velocity(y + d) - w->velocity(y - d)) / (2.0 * d)).epsilon(1e-6));
    }
}

TEST_CASE("friction follows from speed and distance as the law says, in the sublayer and far out", "[turbulence][fast]") {
  const double nu = 1.5e-5;
  for (const WallLaw* w : {&law<Sa>(), &law<SstVm>(), &law<KOmega>()}) {
    for (const double u : {1e-12, 0.05, 1.0, 4.0})
      for (const double y_plus : {1e-6, 0.1, 3.0, 12.0, 60.0, 3000.0, 1e6}) {
        const double distance = y_plus * nu / u, speed = u * w->velocity(y_plus);
        CHECK(friction_velocity(*w, speed, distance, nu) == Approx(u).epsilon(1e-12));
        CHECK(wall_viscosity(*w, speed, distance, 1.2, 1.2 * nu) * speed / distance == Approx(1.2 * u * u).epsilon(1e-12));
        CHECK(wall_law_rate(*w, speed, distance, nu) == Approx(u * u / nu * w->slope(y_plus)).epsilon(1e-9));
      }
    CHECK(wall_viscosity(*w, 0.0, 1e-3, 1.2, 1.8e-5) == 1.8e-5);
    CHECK(friction_velocity(*w, 0.0, 1e-3, 1.5e-5) == 0.0);
  }
}
