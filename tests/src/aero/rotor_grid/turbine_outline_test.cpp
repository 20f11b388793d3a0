// Outlines of a turbine file: what is read, what is refused with which words.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "kernels/base/failure.hpp"
#include "tests/src/aero/data_file.hpp"
#include "tests/src/aero/rotor_grid/example.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using Catch::Matchers::Contains;

namespace {

std::string planform() {
  return data_file("rg_planform.csv", R"(span_m,chord_m,twist_deg,thickness_pct,prebend_m
2,1,10,30,0
20,0.5,0,30,0
)");
}

std::string polar() { return data_file("rg_polar.csv", "alpha_deg,cl,cd\n-180,0,0\n180,0,0\n"); }

const std::string diamond =
    "x_c,y_c\n1,0.002\n0.75,0.08\n0.5,0.15\n0.25,0.08\n0,0\n0.25,-0.08\n0.5,-0.15\n0.75,-0.08\n1,-0.002\n";

std::string turbine(const std::string& outline, double thickness, const std::string& planform_file = planform()) {
  const std::string file = data_file("rg_outline.csv", outline);
  return data_file("rg_turbine.toml", "[turbine]\nhub_radius_m = 2\nplanform = '" + planform_file +
                                          "'\npolars = [{ thickness_pct = 30, file = '" + polar() +
                                          "' }]\naerofoils = [{ thickness_pct = " + std::to_string(thickness) + ", file = '" +
                                          file + "' }]\n");
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  return text.replace(text.find(what), what.size(), by);
}

}  // namespace

TEST_CASE("outlines are read with the turbine", "[rotor_grid][fast]") {
  const Turbine t = read_turbine(turbine(diamond, 30));
  REQUIRE(t.aerofoils.size() == 1);
  CHECK(t.aerofoils[0].outline.size() == 9);
  CHECK(t.aerofoils[0].thickness == Approx(0.3));
  CHECK(dtu().aerofoils.size() == 6);
}

TEST_CASE("an outline in Lednicer's order is that in Selig's", "[rotor_grid][fast]") {
  const std::string selig = data_file("rg_selig.dat",
                                      "DIAMOND\n1 0.002\n0.75 0.08\n0.5 0.15\n0.25 0.08\n0 0\n0.25 -0.08\n0.5 -0.15\n"
                                      "0.75 -0.08\n1 -0.002\n"),
                    lednicer = data_file("rg_lednicer.dat",
                                         "DIAMOND\n 5. 5.\n\n0 0\n0.25 0.08\n0.5 0.15\n0.75 0.08\n1 0.002\n\n0 0\n0.25 -0.08\n"
                                         "0.5 -0.15\n0.75 -0.08\n1 -0.002\n");
  CHECK(read_outline(lednicer) == read_outline(selig));
  CHECK(read_outline(selig).size() == 9);
}

TEST_CASE("outlines that no surface can be made from are refused by file and line", "[rotor_grid][fast]") {
  CHECK_THROWS_WITH(read_turbine(turbine(replaced(diamond, "0.25,-0.08", "0.25,0.3"), 30)),
                    Contains("crosses itself") && Contains("rg_outline.csv"));
  CHECK_THROWS_WITH(read_turbine(turbine(diamond, 24)), Contains("the outline is 30.0 % thick"));
  CHECK_THROWS_WITH(read_turbine(turbine(replaced(diamond, "1,0.002", "0.9,0.002"), 30)),
                    Contains("begins and ends at the trailing edge"));
  CHECK_THROWS_WITH(read_turbine(turbine(replaced(diamond, "0.5,0.15", "1.5,0.15"), 30)), Contains("off the chord"));
  CHECK_THROWS_WITH(read_turbine(turbine("x_c,y_c\n1,0\n0,0\n1,0\n", 30)), Contains("rows"));
  const std::string upside =
      "x_c,y_c\n1,-0.002\n0.75,-0.08\n0.5,-0.15\n0.25,-0.08\n0,0\n0.25,0.08\n0.5,0.15\n0.75,0.08\n1,0.002\n";
  CHECK_THROWS_WITH(read_turbine(turbine(upside, 30)), Contains("pressure side first"));
}

TEST_CASE("a planform whose sections have no outline, or do not go outward, is refused", "[rotor_grid][fast]") {
  const std::string thick =
      data_file("rg_thick.csv", "span_m,chord_m,twist_deg,thickness_pct,prebend_m\n2,1,10,80,0\n20,0.5,0,30,0\n");
  CHECK_THROWS_WITH(read_turbine(turbine(diamond, 30, thick)), Contains("no outline for the section 80.0 % thick at span 2 m"));
  const std::string back =
      data_file("rg_back.csv", "span_m,chord_m,twist_deg,thickness_pct,prebend_m\n2,1,10,30,0\n1.5,0.5,0,30,0\n");
  CHECK_THROWS_WITH(read_turbine(turbine(diamond, 30, back)), Contains("span_m"));
  Turbine bare = dtu();
  bare.aerofoils.clear();
  CHECK_THROWS_WITH(make_rotor_grid(bare, spec_of(1.0, 1e-3)), Contains("turbine.aerofoils"));
}
