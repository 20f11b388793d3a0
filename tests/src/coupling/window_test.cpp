// The coupled window of a small floating system: what a scene may ask for, repeatability, failure that leaves the state where it
// was, cutting. SPDX-License-Identifier: Apache-2.0
#include "src/coupling/window.hpp"

#include <catch2/catch.hpp>

#include "tests/src/coupling/scenes.hpp"
#include "tests/src/coupling/windows.hpp"

using namespace spindrift;
using namespace spindrift::coupling;
using namespace spindrift::coupling::test;

namespace {

const std::string floater = std::string(buoy) + R"(
[aero]
model = "thrust_curve"
thrust_coefficient = 0.8
[rotor]
body = "buoy"
hub_m = [0.0, 0.0, 10.0]
diameter_m = 6.0
speed_rpm = 30.0
[wind]
speed_m_s = 11.0
)";

std::string problem_of(const std::vector<std::string>& overrides, const std::string& text = floater) {
  try {
    scenario(text, overrides);
  } catch (const scene::SceneError& e) { return e.what(); }
  return "";
}

}  // namespace

TEST_CASE("options of [coupling] act where they stand, and are refused elsewhere", "[coupling][fast]") {
  CHECK(problem_of({}) == "");
  CHECK(problem_of({"coupling.scheme=cps2"}) == "");
  CHECK(problem_of({"coupling.scheme=cps2", "coupling.tolerance=1e-3"}).find("coupling.tolerance") != std::string::npos);
  CHECK(problem_of({"coupling.scheme=aitken", "coupling.reuse_windows=2"}).find("coupling.reuse_windows") != std::string::npos);
  CHECK(problem_of({"coupling.scheme=ibqn_ls", "coupling.composition=parallel"}).find("coupling.composition") !=
        std::string::npos);
  CHECK(problem_of({"coupling.scheme=aitken", "coupling.samples=2"}).find("must divide the window's 5 steps") !=
        std::string::npos);
  CHECK(problem_of({"coupling.scheme=aitken", "coupling.samples=5", "coupling.interpolation=cubic"}) == "");
  CHECK(problem_of({"coupling.scheme=aitken", "coupling.interpolation=cubic"}).find("coupling.interpolation") !=
        std::string::npos);
  CHECK(problem_of({"coupling.scheme=cps"}, buoy).find("aero.model is none") != std::string::npos);
}

TEST_CASE("a window is a pure function of state and history", "[coupling][fast]") {
  const std::string scheme =
      GENERATE("cps", "cps2", "css", "aitken", "iqn_ils", "ibqn_ls", "interface_gmres", "newton", "steepest_descent");
  INFO(scheme);
  FloatingSystem floating(scenario(floater, {"coupling.scheme=" + scheme}));
  CoupledWindow window(floating);
  bodies::BodiesState state = make_start(floating).state;
  window.begin(state);
  for (int n = 0; n < 4; ++n) REQUIRE(window.advance(state).ok());
  const std::vector<double> history = window.history();
  bodies::BodiesState once = state, again = state;
  REQUIRE(window.advance(once).ok());
  const std::vector<double> after = window.history();
  REQUIRE(window.restore(history));
  REQUIRE(window.advance(again).ok());
  CHECK(window.history() == after);
  std::vector<double> a(once.packed_size()), b(a.size());
  once.pack(a), again.pack(b);
  CHECK(a == b);
  CHECK_FALSE(window.restore(std::vector<double>(history.begin(), history.end() - 1)));
}

TEST_CASE("a window that fails says why and leaves state and history as they were", "[coupling][fast]") {
  FloatingSystem floating(scenario(floater, {"coupling.scheme=relaxation", "coupling.relaxation=0.01",
                                             "coupling.max_evaluations=3", "coupling.max_cuts=0", "coupling.tolerance=1e-12"}));
  CoupledWindow window(floating);
  bodies::BodiesState state = make_start(floating).state;
  window.begin(state);
  const std::vector<double> history = window.history();
  std::vector<double> before(state.packed_size()), after(before);
  state.pack(before);
  const WindowReport report = window.advance(state);
  state.pack(after);
  CHECK_FALSE(report.ok());
  CHECK(report.failure.find("evaluation limit") != std::string::npos);
  CHECK(report.failure.find("try a smaller coupling.relaxation") != std::string::npos);
  CHECK(before == after);
  CHECK(history == window.history());
}

TEST_CASE("the tower's drag pushes what carries the rotor in every scheme as in the monolithic one", "[coupling][fast]") {
  const std::string tower =
      floater + "[aero.tower]\nstations = [[2.0, 1.0, 1.0], [9.0, 1.0, 1.0]]\n[start]\nequilibrium = false\nramp_s = 1.0\n";
  const std::string scheme = GENERATE("cps", "cps2", "css", "aitken", "iqn_ils");
  INFO(scheme);
  // Without a load of the rotor all schemes are the same.
  const auto pushed = [&](const std::string& by, const std::string& drag) {
    FloatingSystem floating(
        scenario(tower, {"coupling.scheme=" + by, "aero.tower.has_drag=" + drag, "aero.thrust_coefficient=1e-9"}));
    bodies::BodiesState state = make_start(floating).state;
    std::optional<CoupledWindow> window;
    if (floating.has_interface()) window.emplace(floating).begin(state);
    for (int n = 0; n < 4; ++n) {
      if (window) REQUIRE(window->advance(state).ok());
      for (int step = 0; !window && step < 5; ++step)
        REQUIRE(floating.multibody().advance(state, floating.timeline().tick_s(), 1).ok());
    }
    return state.motions[0].velocity.x();
  };
  const double whole = pushed("monolithic", "true"), without = pushed("monolithic", "false");
  CHECK(whole - without > 1e-4);
  CHECK(pushed(scheme, "true") - pushed(scheme, "false") == Approx(whole - without).epsilon(1e-6));
}

TEST_CASE("the rotor is asked once per window by loose schemes, and its load balances what the body feels", "[coupling][fast]") {
  FloatingSystem floating(scenario(floater, {"coupling.scheme=cps"}));
  CoupledWindow window(floating);
  bodies::BodiesState state = make_start(floating).state;
  window.begin(state);
  const aero::RotorLoad first = floating.rotor()->load(0.0, floating.rotor()->state(0.0, state.motions));
  for (int n = 0; n < 3; ++n) REQUIRE(window.advance(state).ok());
  CHECK(window.totals().rotor_calls == 3);
  CHECK(window.totals().body_steps == 15);
  CHECK(first.thrust > 0.0);
  // What the bodies feel at the end of the window is what the rotor answered: same force, moment about the centre of mass from
  // the hub.
  const bodies::Evaluation& now = floating.multibody().evaluate(state, 0.3);
  const std::size_t rotor = floating.multibody().loads().size() - 1;
  REQUIRE(floating.multibody().loads()[rotor].name == "rotor");
  const Wrench& w = now.by_source[rotor][0];
  const aero::RotorState hub = floating.rotor()->state(0.3, state.motions);
  CHECK((w.moment - (hub.hub - state.motions[0].position).cross(w.force)).norm() < 1e-9 * w.moment.norm());
}
