// Polars at several Reynolds numbers and by number: what a section has between, at and beyond its tables, what a rotor makes of
// it, and the turbine files that are refused. SPDX-License-Identifier: Apache-2.0
#include "src/aero/section_polars.hpp"

#include <catch2/catch.hpp>

#include "src/aero/bem.hpp"
#include "src/aero/options.hpp"
#include "src/scene/document.hpp"
#include "src/scene/error.hpp"
#include "tests/src/aero/data_file.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using Catch::Matchers::Contains;

namespace {

const Turbine& dtu_10mw() {
  static const Turbine turbine = read_turbine(SPINDRIFT_SOURCE_DIR "/inputs/turbines/dtu_10mw.toml");
  return turbine;
}

/// A section of lift scale * (0 at -180, -1 at -15, 1 at 15, 0 at 180 degrees) and constant drag.
Polar kite(double place, std::optional<double> reynolds, double scale, double drag) {
  const double d = radians_per_degree;
  return {place, reynolds, {-pi, -15 * d, 15 * d, pi}, {0.0, -scale, scale, 0.0}, {drag, drag, drag, drag}, {}};
}

/// The rotor with each polar at both Reynolds numbers, lift and drag of the second times `more`.
Turbine at_two_reynolds(double low, double high, double more) {
  Turbine turbine = dtu_10mw();
  turbine.polars.clear();
  for (const Polar& polar : dtu_10mw().polars)
    for (const double reynolds : {low, high}) {
      Polar& p = turbine.polars.emplace_back(polar);
      p.reynolds = reynolds;
      if (reynolds == high)
        for (auto values : {&Polar::lift, &Polar::drag})
          for (double& v : p.*values) v *= more;
    }
  return turbine;
}

DiscMotion dtu_turning(double rpm) {
  return {Eigen::Vector3d::Zero(),
          rpm * rad_s_per_rpm * Eigen::Vector3d::UnitX(),
          Eigen::Vector3d::UnitX(),
          Eigen::Vector3d::UnitZ(),
          0.3,
          0.0};
}

}  // namespace

TEST_CASE("a section has its polar at a table's Reynolds number, straight in the logarithm between, the ends beyond",
          "[aero][fast]") {
  const std::vector<Polar> polars{kite(0.2, 1e6, 1.0, 0.01), kite(0.2, 4e6, 1.5, 0.008), kite(0.2, 9e6, 1.6, 0.006)};
  const SectionPolars section(polars, 0.2);
  const double a = 7.5 * radians_per_degree;
  const auto [reynolds, lift, drag] = GENERATE(table<double, double, double>(
      {{1e6, 0.5, 0.01}, {4e6, 0.75, 0.008}, {9e6, 0.8, 0.006}, {1e3, 0.5, 0.01}, {0.0, 0.5, 0.01}, {1e9, 0.8, 0.006}}));
  const SectionForce f = section.at(reynolds)(a);
  CHECK(f.lift == Approx(lift).epsilon(1e-14));
  CHECK(f.drag == drag);                                           // at a table to the bit
  CHECK(section.at(2e6)(a).lift == Approx(0.625).epsilon(1e-14));  // the geometric mean of 1 and 4 million
  CHECK(section.at(6e6)(a).drag == Approx(0.007).epsilon(1e-14));
  CHECK(section.least_reynolds() == 1e6);
  CHECK(section.greatest_reynolds() == 9e6);
}

TEST_CASE("between two sections each has its own tables' Reynolds numbers", "[aero][fast]") {
  const std::vector<Polar> polars{kite(0.2, 1e6, 1.0, 0.01), kite(0.2, 8e6, 1.6, 0.004), kite(0.3, 2e6, 0.8, 0.02),
                                  kite(0.3, 3e6, 0.9, 0.01), kite(0.4, {}, 0.3, 0.3)};
  const SectionPolars thin(polars, 0.2), thick(polars, 0.3), round(polars, 0.4);
  const double reynolds = GENERATE(5e5, 1e6, 1.5e6, 2e6, 2.6e6, 5e6, 8e6, 2e7), a = 0.2;
  const auto mean = [&](double share, const SectionPolars& x, const SectionPolars& y) {
    return (1.0 - share) * x.at(reynolds)(a).lift + share * y.at(reynolds)(a).lift;
  };
  CHECK(SectionPolars(polars, 0.225).at(reynolds)(a).lift == Approx(mean(0.25, thin, thick)).epsilon(1e-13));
  CHECK(SectionPolars(polars, 0.39).at(reynolds)(a).lift == Approx(mean(0.9, thick, round)).epsilon(1e-13));
  CHECK(!round.depend_on_reynolds());
  CHECK(SectionPolars(polars, 0.1).at(reynolds)(a).lift == thin.at(reynolds)(a).lift);
}

TEST_CASE("what is known of stall goes with the Reynolds number as lift does", "[aero][fast]") {
  std::vector<Polar> polars{kite(0.2, 1e6, 1.0, 0.01), kite(0.2, 4e6, 1.5, 0.02)};
  const double slope = 1.0 / (15 * radians_per_degree);
  CHECK(SectionPolars(polars, 0.2).at(1e6).oye().slope == Approx(slope));
  CHECK(SectionPolars(polars, 0.2).at(2e6).oye().slope == Approx(1.25 * slope));
  polars[0].stall = StallOptions{.normal_slope = 5.0, .zero_lift = 0.0, .drag_0 = 0.01, .critical_normal = 1.0};
  polars[1].stall = StallOptions{.normal_slope = 6.0, .zero_lift = -0.1, .drag_0 = 0.02, .critical_normal = 2.0};
  const auto stall = SectionPolars(polars, 0.2).at(2e6).leishman();
  CHECK(stall.slope == Approx(5.5));
  CHECK(stall.zero_lift == Approx(-0.05));
  CHECK(stall.drag_0 == Approx(0.015));
  CHECK(stall.most == Approx(1.5));
  CHECK(stall.limits);
  polars[1].stall->normal_slope = 0.0;  // a table without stall has none on its way to the next
  CHECK(SectionPolars(polars, 0.2).at(2e6).leishman().slope == 0.0);
  CHECK(SectionPolars(polars, 0.2).at(1e6).leishman().slope == 5.0);
  // Nor has a section without stall on its way to the next one, which stalls as its own polar says.
  std::vector<Polar> both{kite(1, {}, 1.0, 0.01), kite(2, {}, 1.5, 0.02)};
  both[0].stall = StallOptions{.normal_slope = 0.0}, both[1].stall = StallOptions{.normal_slope = 6.0};
  CHECK(SectionPolars(both, 1.5).at_any().leishman().slope == 0.0);
  CHECK(SectionPolars(both, 2.0).at_any().leishman().slope == 6.0);
}

TEST_CASE("two equal tables are one, to the bit, with every model of wake and stall", "[aero][fast]") {
  using Stall = UnsteadyFlow::Stall;
  const Turbine twice = at_two_reynolds(1e6, 3e7, 1.0);
  for (const UnsteadyFlow& unsteady :
       {UnsteadyFlow{}, UnsteadyFlow{.inflow = true, .stall = Stall::oye}, UnsteadyFlow{.stall = Stall::beddoes_leishman}}) {
    const BladeElementMomentum one(dtu_10mw(), "madsen", 1.225, unsteady), two(twice, "madsen", 1.225, unsteady);
    const auto loads = [&](const BladeElementMomentum& bem) {
      std::vector<double> memory(bem.memory_size());
      const Wind wind{{11, 1, 0}}, gust{{13, 1, 0}};
      if (!memory.empty()) bem.begin(wind, dtu_turning(8.8), 0.0, memory);
      if (!memory.empty()) bem.remember(gust, dtu_turning(8.8), 0.1, 0.1, memory);
      return bem(gust, dtu_turning(8.8), 0.1, memory);
    };
    CHECK(loads(one).force == loads(two).force);
    CHECK(loads(one).moment == loads(two).moment);
  }
}

TEST_CASE("an element at the geometric mean of two Reynolds numbers is one with the mean of their polars", "[aero][fast]") {
  // V = 40 m/s without induction on a chord c: Re = V c / nu.
  Turbine mean = dtu_10mw();
  for (Polar& p : mean.polars)
    for (auto values : {&Polar::lift, &Polar::drag})
      for (double& v : p.*values) v *= 1.1;
  const std::size_t e = GENERATE(5, 20, 35);
  const double chord = BladeElementMomentum(mean, "madsen", 1.225).section(e).chord, nu = 2e-5, reynolds = 40.0 * chord / nu;
  const BladeElementMomentum bem(at_two_reynolds(0.25 * reynolds, 4.0 * reynolds, 1.2), "madsen", 1.225, {}, nu);
  const ElementState got = bem.solve(e, 9.6, std::sqrt(40.0 * 40.0 - 9.6 * 9.6), 0.0),
                     expected =
                         BladeElementMomentum(mean, "madsen", 1.225).solve(e, 9.6, std::sqrt(40.0 * 40.0 - 9.6 * 9.6), 0.0);
  CHECK(got.normal == Approx(expected.normal).epsilon(1e-10));
  CHECK(got.tangential == Approx(expected.tangential).epsilon(1e-10));
  CHECK(got.axial_induction == Approx(expected.axial_induction).epsilon(1e-10));
  // Below all tables the first, above them the last.
  CHECK(bem.solve(e, 0.5, 1.0, 0.0).normal == BladeElementMomentum(dtu_10mw(), "madsen", 1.225).solve(e, 0.5, 1.0, 0.0).normal);
}

TEST_CASE("a rotor says which Reynolds numbers its blades have outside of the tables", "[aero][fast]") {
  const Wind wind{{11, 0, 0}};
  CHECK(!BladeElementMomentum(dtu_10mw(), "madsen", 1.225).reynolds(wind, dtu_turning(8.836), 0.0));
  const BladeElementMomentum wide(at_two_reynolds(1e4, 1e8, 1.1), "madsen", 1.225),
      low(at_two_reynolds(1e4, 1e7, 1.1), "madsen", 1.225);
  const ReynoldsReach inside = *wide.reynolds(wind, dtu_turning(8.836), 0.0), over = *low.reynolds(wind, dtu_turning(8.836), 0.0);
  CHECK(inside.outside == 0);
  CHECK(inside.elements == 3 * int(wide.elements()));
  CHECK(over.outside > 0);
  CHECK(over.table_greatest == 1e7);
  // The DTU 10-MW report has some 16 million at most, of wind and rotation together.
  CHECK(inside.greatest == Approx(1.7e7).epsilon(0.2));
  CHECK(over.greatest == inside.greatest);
}

namespace {

const std::string columns = "span_m,chord_m,twist_deg,prebend_m,polar\n";

Turbine read_polars(const std::string& planform, const std::string& polars) {
  const std::string plan = data_file("polars_planform.csv", planform);
  return read_turbine(
      data_file("polars_turbine.toml", "[turbine]\nhub_radius_m = 2\nplanform = '" + plan + "'\npolars = [\n" + polars + "]\n"));
}

/// An entry of `polars`: a plate whose lift is `lift` at all angles between -170 and 170 degrees.
std::string entry(const std::string& keys, double lift = 1.0) {
  const std::string file = data_file(
      "polars_" + std::to_string(int(100 * lift)) + ".csv",
      "alpha_deg,cl,cd\n-180,0,0.1\n-170," + std::to_string(lift) + ",0.1\n170," + std::to_string(lift) + ",0.1\n180,0,0.1\n");
  return "  { " + keys + ", file = '" + file + "' },\n";
}

scene::Problem refused_polars(const std::string& planform, const std::string& polars) {
  try {
    read_polars(planform, polars);
  } catch (const scene::SceneError& e) { return e.problems().at(0); }
  FAIL("not refused:\n" << planform << polars);
  return {};
}

const std::string by_thickness = "span_m,chord_m,twist_deg,thickness_pct,prebend_m\n2,5,14,30,0\n80,1,0,24,-1\n";

}  // namespace

TEST_CASE("sections of one thickness are told apart by number along the planform", "[aero][fast]") {
  // 1 to the third station, half of 1 and half of 2 in the fourth element, 2, and 3, the file of 1 again, at the tip.
  const Turbine turbine =
      read_polars(columns + "2,5,0,0,1\n10,5,0,0,1\n20,5,0,0,1\n30,4,0,0,2\n40,4,0,0,2\n50,3,0,0,2.5\n60,2,0,0,3\n",
                  entry("number = 2", 2.0) + entry("number = 1", 1.0) + entry("number = 3", 1.0));
  CHECK(turbine.planform.thickness.empty());
  const BladeElementMomentum bem(turbine, "madsen", 1.225);
  const std::vector<double> lift{1.0, 1.0, 1.5, 2.0, 1.75, 1.25};
  REQUIRE(bem.elements() == lift.size());
  for (std::size_t e = 0; e < lift.size(); ++e) CHECK(bem.polars(e, 10.0)(0.1).lift == Approx(lift[e]).epsilon(1e-14));
}

TEST_CASE("polars that say less or more than one thing of a section are refused by file and key", "[aero][fast]") {
  const std::string plan = columns + "2,5,0,0,1\n80,1,0,0,2\n", two = entry("number = 1") + entry("number = 2");
  CHECK(read_polars(by_thickness, entry("thickness_pct = 24, reynolds = 1e6") + entry("thickness_pct = 30") +
                                      entry("thickness_pct = 24, reynolds = 2e6", 2.0))
            .polars.size() == 3);
  struct Fault {
    std::string planform, polars, key, message;
    int line;
  };
  const std::string stall = ", stall = { normal_slope = 6.0 }";
  const std::vector<Fault> faults{
      {by_thickness, entry("thickness_pct = 24, reynolds = 2e6") + entry("thickness_pct = 24, reynolds = 1e6"),
       "turbine.polars[1].reynolds", "must be more than 2e+06, that of turbine.polars[0], which is 24 % thick too", 6},
      {by_thickness, entry("thickness_pct = 24, reynolds = 2e6") + entry("thickness_pct = 24, reynolds = 2e6"),
       "turbine.polars[1].reynolds", "must be more than 2e+06", 6},
      {by_thickness, entry("thickness_pct = 24, reynolds = -2e6"), "turbine.polars[0].reynolds", "must be > 0", 5},
      {by_thickness, entry("thickness_pct = 24") + entry("thickness_pct = 24"), "turbine.polars[1].reynolds",
       "two polars are 24 % thick, turbine.polars[0] and turbine.polars[1]", 6},
      {by_thickness, entry("thickness_pct = 24") + entry("thickness_pct = 24, reynolds = 1e6"), "turbine.polars[0].reynolds",
       "must be given", 5},
      {plan, entry("number = 1, reynolds = 1e6") + two, "turbine.polars[1].reynolds", "two polars are of number 1", 6},
      {by_thickness, entry("thickness_pct = 24, reynolds = 1e6") + entry("thickness_pct = 24, reynolds = 2e6" + stall),
       "turbine.polars[0].stall", "of the polars 24 % thick all say something of stall or none does", 5},
      {by_thickness, entry("thickness_pct = 24, number = 1"), "turbine.polars[0]", "thickness_pct", 5},
      {plan, entry("number = 1") + entry("thickness_pct = 24"), "turbine.polars[1].thickness_pct", "all by number or all by", 6},
      {plan, entry("thickness_pct = 24"), "", "has a column polar", 1},
      {by_thickness, two, "", "polar", 1},
      {columns + "2,5,0,0,1\n80,1,0,0,3\n", two, "", "polar = 3: the polars of the turbine have numbers from 1 to 2", 3},
      {"span_m,chord_m,twist_deg,prebend_m,thickness_pct,polar\n2,5,0,0,30,1\n80,1,0,0,30,2\n", entry("thickness_pct = 30"), "",
       "has a column polar, but the polars of the turbine file have no number", 1},
  };
  for (const Fault& f : faults) {
    INFO(f.planform << f.polars);
    const scene::Problem p = refused_polars(f.planform, f.polars);
    CHECK_THAT(p.key, Contains(f.key));
    CHECK_THAT(p.message, Contains(f.message));
    CHECK_THAT(p.source, Contains(f.key.empty() ? "polars_planform.csv" : "polars_turbine.toml"));
    if (!f.key.empty() || f.line > 1) CHECK(p.line == f.line);
  }
}

TEST_CASE("the viscosity of the air is asked for where polars depend on the Reynolds number alone", "[aero][fast]") {
  const auto read = [](const std::string& polars) {
    read_polars(by_thickness, polars);
    const std::vector<std::string> bodies{"rotor"}, joints;
    scene::Document doc = scene::parse(
        "[aero]\nmodel = 'bem'\nkinematic_viscosity_m2_s = 1.5e-5\n[rotor]\nbody = 'rotor'\nturbine = "
        "'spindrift_aero_polars_turbine.toml'\n",
        "test.toml", std::filesystem::temp_directory_path());
    const AeroOptions aero = doc.read(aero_section());
    check_rotor(doc, aero, doc.read(rotor_section()), bodies, joints);
    doc.finish();
    return aero.kinematic_viscosity(1.2);
  };
  CHECK(read(entry("thickness_pct = 24, reynolds = 1e6") + entry("thickness_pct = 24, reynolds = 2e6")) == 1.5e-5);
  CHECK_THROWS_WITH(read(entry("thickness_pct = 24, reynolds = 1e6")),
                    Contains("aero.kinematic_viscosity_m2_s") && Contains("has no effect"));
  CHECK(AeroOptions().kinematic_viscosity(1.2) == air_kinematic_viscosity);
}
