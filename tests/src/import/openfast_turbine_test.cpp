// Tower, blades, polars and wind of a deck. SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <sstream>

#include "kernels/base/constants.hpp"
#include "src/aero/flexible_blades.hpp"
#include "src/aero/turbine.hpp"
#include "src/coupling/floating_system.hpp"
#include "src/coupling/start.hpp"
#include "src/import/elastodyn.hpp"
#include "src/scene/document.hpp"
#include "tests/src/import/small_deck.hpp"

using namespace spindrift;

TEST_CASE("blades of BeamDyn have their own masses, and the generator's inertia is the shaft's alone", "[import][fast]") {
  SmallDeck deck;
  const bodies::BodyOptions light = deck.scenario().bodies[0].options;
  deck.replace("ed.dat", "100 GenIner", "1e6 GenIner");
  CHECK(deck.scenario().bodies[0].options.inertia_kg_m2 == light.inertia_kg_m2);
  deck.replace("main.fst", "1 CompElast",
               "2 CompElast\n\"bd.dat\" BDBldFile(1)\n\"bd.dat\" BDBldFile(2)\n\"bd.dat\" BDBldFile(3)");
  deck.replace("ed.dat", "\"blade.dat\" BldFile(1)", "\"unused\" BldFile(1)");
  deck.files["bd.dat"] = "---\n\"bdblade.dat\" BldFile - properties\n";
  std::string stations = "--- BLADE\n2 station_total\n---- DISTRIBUTED PROPERTIES ----\n";
  for (const auto& [share, mass] : {std::pair{"0", "400"}, std::pair{"1", "200"}}) {
    stations += std::string(share) + "\n";
    for (int row = 0; row < 6; ++row) stations += "1e9 0 0 0 0 0\n";
    stations += std::string("\n") + mass + " 0 0 0 0 0\n";
    for (int row = 1; row < 6; ++row) stations += "0 0 0 0 0 0\n";
    stations += "\n";
  }
  deck.files["bdblade.dat"] = stations;
  CHECK(deck.scenario().bodies[0].options.mass_kg - light.mass_kg == Approx(3.0 * 38.0 * 100.0));
  deck.replace("bdblade.dat", "2 station_total", "3 station_total");
  CHECK(deck.refusal().find("bdblade.dat") != std::string::npos);
}

TEST_CASE("a tower that bends in the deck is a beam of the same mass", "[import][fast]") {
  const SmallDeck deck = deck_that_bends();
  CHECK(SmallDeck().scenario().beams.empty());  // its tower is rigid
  const bodies::BodyOptions whole = SmallDeck().scenario().bodies[0].options;
  const decks::Imported imported = deck.import();
  CHECK(has_word(imported.carried, "tower: flexible, 50 m"));
  CHECK_FALSE(has_word(imported.left_out, "TwFADOF1"));
  const coupling::Scenario s = deck.scenario();
  REQUIRE(s.bodies.size() == 2);
  REQUIRE(s.beams.size() == 1);
  const bodies::BeamOptions& beam = s.beams[0].options;
  CHECK(s.rotor.body == "nacelle");
  // Of the deck's 1 and 2 %, which are of the tower alone, with 4000 to 2000 kg/m: shares of its 50 m that move with the modes.
  const double carried = s.bodies[1].options.mass_kg, first = 50.0 * (4000.0 / 5 - 2000.0 / 6),
               second = 50.0 * (4000.0 * (9.0 / 7 - 12.0 / 6 + 4.0 / 5) - 2000.0 * (9.0 / 8 - 12.0 / 7 + 4.0 / 6));
  CHECK(beam.damping[0] == Approx(0.01 * std::sqrt(first / (first + carried))).epsilon(1e-3));
  CHECK(beam.damping[1] == Approx(0.02 * std::sqrt(second / (second + carried))).epsilon(1e-2));
  CHECK(beam.start_m.z() == 10.0);
  const beam::Properties tower = bodies::read_properties(beam);
  CHECK(tower.bending_x[0] == Approx(3e11));
  CHECK(tower.bending_y[1] == Approx(2e11));
  CHECK(s.bodies[0].options.mass_kg + s.bodies[1].options.mass_kg + 50.0 * 3000.0 == Approx(whole.mass_kg));
  // Both bodies start as parts of one rigid turbine.
  const Motion platform = start_motion(s.bodies[0].options), nacelle = start_motion(s.bodies[1].options);
  const Eigen::Vector3d foot = beam.start_m - s.bodies[0].options.centre_m, top = beam.end_m - s.bodies[1].options.centre_m;
  CHECK((platform.attitude.conjugate() * (nacelle.point(top) - platform.point(foot)) - Eigen::Vector3d(0, 0, 50.0)).norm() <
        1e-6);
}

TEST_CASE("stiffness tuned by modes is the beam's where it is one", "[import][fast]") {
  SmallDeck deck = deck_that_bends();
  deck.replace("tower.dat", "0.5 FAStTunr(2)", "0.6 FAStTunr(2)");
  CHECK(has_word(deck.import().left_out, "FAStTunr(2) 0.6"));
}

TEST_CASE("a nacelle with a rotor that a controller turns is a body that can be", "[import][fast]") {
  SmallDeck deck = deck_that_bends();
  deck.replace("ed.dat", "500000 NacYIner", "5e6 NacYIner");
  deck.import();
  const decks::Deck elastodyn(deck.folder / "deck/ed.dat");
  const Eigen::Vector3d inertia = decks::top_masses(elastodyn, decks::rotor_frame(elastodyn), true).inertia().diagonal();
  CHECK(2.0 * inertia.maxCoeff() <= inertia.sum() * (1.0 + 1e-9));  // as bodies::BodyOptions are checked
}

TEST_CASE("a tower that bends in the deck is rigid where that is asked for", "[import][fast]") {
  const SmallDeck deck = deck_that_bends();
  CHECK(has_word(deck.import(decks::ImportedTower::rigid).left_out, "bending of the tower"));
  const coupling::Scenario s = deck.scenario(decks::ImportedTower::rigid);
  CHECK(s.beams.empty());
  CHECK(s.bodies.at(0).options.mass_kg == SmallDeck().scenario().bodies.at(0).options.mass_kg);
}

TEST_CASE("modes of the tower that the deck turns off are told", "[import][fast]") {
  SmallDeck deck = deck_that_bends();
  deck.replace("ed.dat", "True TwSSDOF2", "False TwSSDOF2");
  CHECK(has_word(deck.import().left_out, "TwSSDOF2: not all are on"));
}

TEST_CASE("a flexible tower on land is clamped to the earth, where the deck's platform may have no mass", "[import][fast]") {
  SmallDeck deck = deck_that_bends();
  deck.replace("main.fst", "1 CompHydro", "0 CompHydro");
  deck.replace("ed.dat", "3000000 PtfmMass", "0 PtfmMass");
  const coupling::Scenario s = deck.scenario();
  REQUIRE(s.bodies.size() == 1);
  CHECK(s.bodies[0].name == "nacelle");
  CHECK(s.beams.at(0).options.bodies == std::vector<std::string>{"earth", "nacelle"});
  coupling::FloatingSystem standing(s);
  const coupling::Start start = make_start(standing);
  // Weight on the top: it rests where the tower carries it.
  CHECK((start.state.motions.at(0).position - s.bodies[0].options.centre_m).norm() < 0.1);
  // On a foundation of SubDyn the members of the deck are in the water: a platform that is held.
  deck.replace("main.fst", "0 CompHydro", "1 CompHydro");
  deck.replace("main.fst", "0 CompSub", "1 CompSub");
  const coupling::Scenario wet = deck.scenario();
  CHECK(wet.bodies.size() == 2);
  CHECK(wet.joints.size() == 1);
}

TEST_CASE("uniform wind of a deck blows where file and PropagationDir say, and stays when the file has one row",
          "[import][fast]") {
  SmallDeck deck;
  deck.replace("ifw.dat", "1 WindType\n0 PropagationDir", "2 WindType\n20 PropagationDir\n\"uniform.wnd\" FileName_Uni");
  deck.files["uniform.wnd"] = "! time speed direction vertical shears gust\n0 9 10 0 0 0.2 0 1\n";
  const decks::Imported imported = deck.import();
  CHECK(has_word(imported.left_out, "gust column"));
  const coupling::Scenario s = deck.scenario();
  for (const double t : {0.0, 50.0}) {
    const Eigen::Vector3d wind = aero::wind_of(s.wind, {{0, 0, 62}, 80.0}).at(t, {0, 0, 62});
    CHECK(std::atan2(wind.y(), wind.x()) == Approx(-30.0 * radians_per_degree));
  }
  scene::Document twice = scene::load(imported.scene.string(), {"wind.direction_deg=5"});
  CHECK_THROWS_WITH(coupling::read_scenario(twice), Catch::Contains("wind.direction_deg") && Catch::Contains("no effect"));
  deck.replace("uniform.wnd", "0.2 0 1", "0.2 0 0");
  CHECK_FALSE(has_word(deck.import().left_out, "gust column"));
}

TEST_CASE("the upflow angle of a deck's uniform wind turns speed, gust and vertical speed upwards", "[import][fast]") {
  SmallDeck deck;
  deck.replace("ifw.dat", "1 WindType", "2 WindType\n\"uniform.wnd\" FileName_Uni");
  deck.files["uniform.wnd"] = "! time speed direction vertical shears gust upflow\n0 9 0 2 0 0 0 1 8\n100 9 0 2 0 0 0 1 8 x\n";
  const auto blows = [&] { return aero::wind_of(deck.scenario().wind, {{0, 0, 62}, 80.0}).at(50.0, {0, 0, 62}); };
  const double angle = 8.0 * radians_per_degree, c = std::cos(angle), s = std::sin(angle);
  CHECK((blows() - Eigen::Vector3d(10.0 * c - 2.0 * s, 0.0, 10.0 * s + 2.0 * c)).norm() < 1e-8);
  CHECK_FALSE(has_word(deck.import().left_out, "upflow"));
  deck.replace("uniform.wnd", "0 9 0 2 0 0 0 1 8", "0 9 0 2 0 0.2 0 1 8");
  CHECK(has_word(deck.import().left_out, "upflow"));
  // A first row without the angle: the file has none, whatever follows.
  deck.files["uniform.wnd"] = "0 9 0 2 0 0 0 1\n100 9 0 2 0 0 0 1 8\n";
  CHECK((blows() - Eigen::Vector3d(10.0, 0.0, 2.0)).norm() < 1e-8);
  deck.files["uniform.wnd"] = "0 9 0 0 0 0 0 0 100\n";
  CHECK(deck.refusal().find("uniform.wnd:1") != std::string::npos);
  deck.files["uniform.wnd"] = "0 9 0 0 0 0 0 -10\n";
  CHECK_THAT(deck.refusal(), Catch::Contains("uniform.wnd:1") && Catch::Contains("gust of -10 m/s"));
}

TEST_CASE("the mean wind of a deck's Mann box is the scene's", "[import][fast]") {
  SmallDeck deck;
  const double hub = 62.0 - 4.0 * std::sin(-6.0 * radians_per_degree);
  deck.replace("ifw.dat", "1 WindType",
               "5 WindType\n\"u.bin\" FileName_u\n\"u.bin\" FileName_v\n\"u.bin\" FileName_w\n2 nx\n2 ny\n2 nz\n100 dx\n"
               "100 dy\n100 dz\n9 URef\n0 WindProfile\n0.2 PLExp_Hawc\n0.03 Z0\n" +
                   std::to_string(hub) + " RefHt_Hawc\n0 XOffset");
  deck.files["u.bin"] = std::string(32, '\0');
  const auto scene = [&] {
    const decks::Imported imported = deck.import();
    CHECK_FALSE(has_word(imported.left_out, "RefHt_Hawc"));
    std::ostringstream text;
    text << std::ifstream(imported.scene).rdbuf();
    return text.str();
  };
  using Catch::Contains;
  CHECK_THAT(scene(), !Contains("profile = "));
  deck.replace("ifw.dat", "0 WindProfile", "1 WindProfile");
  CHECK_THAT(scene(), Contains("profile = \"logarithmic\"") && Contains("roughness_m = 0.03"));
  deck.replace("ifw.dat", "1 WindProfile", "2 WindProfile");
  CHECK_THAT(scene(), Contains("profile = \"power_law\"") && Contains("shear_exponent = 0.2"));
  CHECK_THAT(scene(), !Contains("start_s"));
  deck.replace("ifw.dat", "0 XOffset", "-20 XOffset");  // of a box of 200 m that repeats, in 9 m/s
  CHECK_THAT(scene(), Contains("start_s = 20\n"));
  deck.replace("ifw.dat", std::to_string(hub), "100");
  CHECK(has_word(deck.import().left_out, "RefHt_Hawc 100"));
}

TEST_CASE("the tower's wake comes with its flow, and decks that mean otherwise are told", "[import][fast]") {
  const auto told = [](const char* flow, const char* wake, const char* overhang, const char* what) {
    SmallDeck deck;
    deck.replace("ad.dat", "0 TwrPotent", std::string(flow) + " TwrPotent");
    deck.replace("ad.dat", "0 TwrShadow", std::string(wake) + " TwrShadow");
    deck.replace("ad.dat", "False TwrAero", "True TwrAero\n2 NumTwrNds\nTwrElev TwrDiam TwrCd\n(m) (m) (-)\n10 6 1\n60 4 1");
    deck.replace("ed.dat", "-4 OverHang", std::string(overhang) + " OverHang");
    const std::vector<std::string> left_out = deck.import().left_out;
    return std::ranges::any_of(left_out, [&](const std::string& line) { return line.find(what) != std::string::npos; });
  };
  CHECK(!told("1", "1", "4", "TwrShadow"));
  CHECK(!told("1", "0", "-4", "TwrShadow"));  // before the tower there is none
  CHECK(told("1", "0", "4", "TwrShadow 0"));
  CHECK(told("1", "2", "4", "TwrShadow 2"));
  CHECK(told("0", "1", "4", "comes with its flow"));
}

TEST_CASE("blades that bend in the deck bend in the scene, in steps that follow them", "[import][fast]") {
  SmallDeck deck;
  deck.replace("ed.dat", "False FlapDOF1", "True FlapDOF1\nTrue FlapDOF2\nTrue EdgeDOF");
  deck.replace("blade.dat", "1.0 AdjBlMs\n", "1.0 AdjBlMs\n2.0 AdjFlSt\n1.5 BldFlDmp(1)\n2.5 BldFlDmp(2)\n3.5 BldEdDmp(1)\n");
  deck.replace("blade.dat", "0 0 300 1 1\n1 0 100 1 1\n", "0 9 300 1e9 3e9\n0.5 6 200 3e8 1e9\n1 0 100 1e7 1e8\n");
  deck.replace("blade.dat", "2 NBlInpSt", "3 NBlInpSt");
  const coupling::Scenario s = deck.scenario();
  const aero::Turbine turbine = aero::read_turbine(s.rotor.turbine);
  CHECK(turbine.elements_at_stations);
  const aero::BladeStructure structure = aero::read_blade_structure(turbine, s.rotor.blade_structure);
  CHECK(structure.masses.span == std::vector{2.0, 21.0, 40.0});
  CHECK(structure.masses.mass == std::vector{300.0, 200.0, 100.0});
  CHECK(structure.flap == std::vector{2e9, 6e8, 2e7});
  CHECK(structure.edge == std::vector{3e9, 1e9, 1e8});
  CHECK(structure.twist[1] == Approx(6.0 * radians_per_degree));
  for (std::size_t mode = 0; mode < 3; ++mode)  // flapwise, edgewise, second flapwise
    CHECK(s.rotor.blade_damping[mode] == Approx(std::array{.015, .035, .025}[mode]));
  const double fastest = aero::FlexibleBlades(turbine, structure, s.rotor.blade_damping).omega().back();
  CHECK(s.time.step() * fastest <= .5);
  CHECK(s.time.window_s / s.time.step() == Approx(std::round(s.time.window_s / s.time.step())));
}

TEST_CASE("what takes time in AeroDyn's flow is turned on as the deck says", "[import][fast]") {
  const auto [wake, filter, stall] = GENERATE(table<std::string, std::string, std::string>({{"1 Wake_Mod", "0", "0 UA_Mod"},
                                                                                            {"1 Wake_Mod", "2", "3 UA_Mod"},
                                                                                            {"1 Wake_Mod", "1", "5 UA_Mod"},
                                                                                            {"1 Wake_Mod", "1", "6 UA_Mod"}}));
  SmallDeck deck;
  deck.replace("ad.dat", "1 Wake_Mod", wake + "\n" + filter + " DBEMT_Mod\n12.5 tau1_const");
  deck.replace("ad.dat", "0 UA_Mod", stall);
  const coupling::Scenario s = deck.scenario();
  CHECK(s.aero.dynamic_inflow == (filter == "0" ? "none" : "oye"));
  CHECK(s.aero.inflow_time_s.value_or(0.0) == (filter == "1" ? 12.5 : 0.0));
  CHECK(s.aero.dynamic_stall == (stall == "0 UA_Mod" ? "none" : stall == "6 UA_Mod" ? "oye" : "beddoes_leishman"));
  CHECK(s.aero.stall_lag_chords == (stall == "6 UA_Mod" ? 1.5 : 4.0));
}

TEST_CASE("separation lags as the aerofoil files of a deck with Oye's model say", "[import][fast]") {
  SmallDeck deck;
  deck.replace("ad.dat", "0 UA_Mod", "6 UA_Mod");
  deck.replace("foil.dat", "! a flat plate\n", "True InclUAdata\n5 T_f0\n");
  CHECK(deck.scenario().aero.stall_lag_chords == 2.5);
  CHECK_FALSE(has_word(deck.import().left_out, "T_f0"));  // a cylinder has no stall
  deck.replace("root.dat", "0 0 0.5 0", "0 0.1 0.5 0");
  CHECK(deck.scenario().aero.stall_lag_chords == 2.5);
  CHECK(has_word(deck.import().left_out, "T_f0"));
  deck.replace("foil.dat", "5 T_f0", "\"Default\" T_f0");
  CHECK(deck.scenario().aero.stall_lag_chords == 1.5);
  deck.replace("foil.dat", "\"Default\" T_f0", "0 T_f0");
  CHECK(deck.refusal().find("foil.dat:2") != std::string::npos);
}

TEST_CASE("what AeroDyn is told of stall is the turbine's, its polars stay whole", "[import][fast]") {
  SmallDeck deck;
  deck.replace("ad.dat", "0 UA_Mod", "3 UA_Mod");
  deck.replace("main.fst", "1.225 AirDens", "1.225 AirDens\n335 SpdSound");
  const std::string numbers = "! a flat plate\nTrue InclUAdata\n-2 alpha0\n6.1 C_nalpha\n1.5 Cn1\n-0.9 Cn2\n0.011 Cd0\n";
  deck.replace("foil.dat", "! a flat plate\n", numbers);
  const coupling::Scenario s = deck.scenario();
  CHECK(s.aero.speed_of_sound_m_s == 335.0);
  const aero::Turbine turbine = aero::read_turbine(s.rotor.turbine);
  REQUIRE(turbine.polars.size() == 2);
  const aero::Polar& foil = turbine.polars[1];  // after the root's
  REQUIRE(foil.stall);
  CHECK((foil.stall->normal_slope == 6.1 && foil.stall->drag_0 == 0.011 && foil.stall->critical_normal == 1.5));
  CHECK(foil.stall->zero_lift == Approx(-2.0 * radians_per_degree));
  CHECK(foil.stall->critical_normal_low == -0.9);
  CHECK(foil.lift[3] == 1.4);
  CHECK(turbine.polars[0].stall->normal_slope == 0.0);
  // What AeroDyn finds by itself is left to the polar; a number that is none is refused by its line.
  deck.replace("foil.dat", "6.1 C_nalpha", "\"Default\" C_nalpha");
  CHECK(!aero::read_turbine(deck.scenario().rotor.turbine).polars[1].stall);
  deck.replace("foil.dat", "\"Default\" C_nalpha", "steep C_nalpha");
  CHECK(deck.refusal().find("foil.dat:4") != std::string::npos);
  // So it is where the file has none of them; what does not change with the angle has no dynamic stall.
  deck.replace("foil.dat", "True InclUAdata", "False InclUAdata");
  deck.replace("root.dat", "! a cylinder\n", "! a cylinder\nTrue InclUAdata\n");
  const aero::Turbine found = aero::read_turbine(deck.scenario().rotor.turbine);
  CHECK(!found.polars[1].stall);
  REQUIRE(found.polars[0].stall);
  CHECK(found.polars[0].stall->normal_slope == 0.0);
}

namespace {

/// The plate's file with a second table, of half its lift; Reynolds numbers in millions.
void add_second_table(SmallDeck& deck, const std::string& first, const std::string& second) {
  std::string table = deck.files["foil.dat"].substr(deck.files["foil.dat"].find("5 NumAlf"));
  deck.replace("foil.dat", "1 NumTabs\n", "2 NumTabs\n" + first + " Re\n0 UserProp\n");
  table.replace(table.find("15 1.4"), 6, "15 0.7");
  deck.files["foil.dat"] += second + " Re\n0 UserProp\n" + table;
  deck.replace("main.fst", "1.225 AirDens", "1.225 AirDens\n1.5e-5 KinVisc");
}

}  // namespace

TEST_CASE("tables over the Reynolds number are the turbine's where AFTabMod is 2", "[import][fast]") {
  SmallDeck deck;
  add_second_table(deck, "0.75", "5");
  deck.replace("ad.dat", "1 InCol_Alfa", "2 AFTabMod\n1 InCol_Alfa");
  const coupling::Scenario s = deck.scenario();
  CHECK(s.aero.kinematic_viscosity_m2_s == 1.5e-5);
  const aero::Turbine turbine = aero::read_turbine(s.rotor.turbine);
  CHECK(turbine.planform.polar == std::vector<double>{1, 2, 2, 2});
  REQUIRE(turbine.polars.size() == 3);
  CHECK(!turbine.polars[0].reynolds);
  CHECK((turbine.polars[1].reynolds == 0.75e6 && turbine.polars[1].lift[3] == 1.4));
  CHECK((turbine.polars[2].reynolds == 5e6 && turbine.polars[2].lift[3] == 0.7));
  // AeroDyn's own viscosity goes before that of the main file.
  deck.replace("ad.dat", "2 AFTabMod", "1.6e-5 KinVisc\n2 AFTabMod");
  CHECK(deck.scenario().aero.kinematic_viscosity_m2_s == 1.6e-5);
}

TEST_CASE("of several tables the first is used where AFTabMod is 1, and told", "[import][fast]") {
  SmallDeck deck;
  add_second_table(deck, "0.75", "5");
  const std::vector<std::string> notes = deck.import().left_out;
  CHECK(std::count(notes.begin(), notes.end(), "foil.dat: the first of its 2 tables is used, as AFTabMod 1 has it") == 1);
  const coupling::Scenario s = deck.scenario();
  CHECK(!s.aero.kinematic_viscosity_m2_s);
  CHECK(aero::read_turbine(s.rotor.turbine).polars[1].lift[3] == 1.4);
}

TEST_CASE("tables that AFTabMod cannot choose among are refused by file and line", "[import][fast]") {
  const auto [mode, first, second, tabs, said] = GENERATE(table<std::string, std::string, std::string, std::string, std::string>({
      {"3", "1", "1", "2 NumTabs", "ad.dat:7"},       // a property that a controller changes
      {"4", "1", "2", "2 NumTabs", "ad.dat:7"},       // no such mode
      {"2", "2", "1", "2 NumTabs", "foil.dat:13"},    // falls
      {"2", "2", "2", "2 NumTabs", "foil.dat:13"},    // the same
      {"2", "-2", "2", "2 NumTabs", "foil.dat:3"},    // negative
      {"2", "many", "2", "2 NumTabs", "foil.dat:3"},  // no number
      {"2", "1", "2", "3 NumTabs", "foil.dat:2"},     // two tables are there
      {"2", "1", "2", "0 NumTabs", "foil.dat:2"},
  }));
  SmallDeck deck;
  add_second_table(deck, first, second);
  deck.replace("foil.dat", "2 NumTabs", tabs);
  deck.replace("ad.dat", "1 InCol_Alfa", mode + " AFTabMod\n1 InCol_Alfa");
  CHECK_THAT(deck.refusal(), Catch::Matchers::Contains(said));
}

TEST_CASE("an aerofoil that comes twice along the blade has a number for each stretch", "[import][fast]") {
  SmallDeck deck;
  deck.replace("adblade.dat", "38 1.0 0.2 0 0 1 2", "38 1.0 0.2 0 0 1 1");
  const aero::Turbine turbine = aero::read_turbine(deck.scenario().rotor.turbine);
  CHECK(turbine.planform.polar == std::vector<double>{1, 2, 2, 3});
  REQUIRE(turbine.polars.size() == 3);
  CHECK(turbine.polars[2].drag == turbine.polars[0].drag);
}

TEST_CASE("outlines of a deck's sections are the turbine's, so that its blades can be resolved", "[import][fast]") {
  SmallDeck deck;
  const auto left_out = [&] {
    std::string all;
    for (const std::string& what : deck.import().left_out) all += what + "\n";
    return all;
  };
  CHECK_THAT(left_out(), Catch::Matchers::Contains("root.dat: the aerofoil file has no coordinates"));
  CHECK(aero::read_turbine(deck.scenario().rotor.turbine).aerofoils.empty());

  // A circle the other way round, in the file itself; a wedge of 30 % in a file beside it.
  std::string circle = "\n 34 NumCoords ! points\n! reference\n0.25 0\n";
  for (int n = 0; n <= 32; ++n) {
    const double angle = 2.0 * pi * n / 32;
    circle += std::to_string(0.5 + 0.5 * std::cos(angle)) + " " + std::to_string(-0.5 * std::sin(angle)) + "\n";
  }
  deck.replace("root.dat", "1 NumTabs", circle + "1 NumTabs");
  deck.files["wedge.txt"] =
      " 12 NumCoords\n! reference\n0.25 0\n1 0.01\n1 0.01\n0.7 0.07\n0.5 0.11\n0.3 0.15\n0.1 0.1\n0 0\n0.1 -0.1\n0.3 "
      "-0.15\n0.6 -0.08\n1 0\n";
  deck.replace("foil.dat", "1 NumTabs", "@\"wedge.txt\" NumCoords\n1 NumTabs");
  CHECK(left_out().find("outlines") == std::string::npos);
  const aero::Turbine turbine = aero::read_turbine(deck.scenario().rotor.turbine);
  REQUIRE(turbine.aerofoils.size() == 2);
  CHECK(turbine.aerofoils[0].thickness == Approx(0.30));
  CHECK(turbine.aerofoils[0].outline.size() == 10);
  CHECK(turbine.aerofoils[1].thickness == Approx(1.0));
  CHECK(turbine.aerofoils[1].outline[8].y() == Approx(0.5));
  CHECK(turbine.planform.thickness == std::vector<double>{1.0, 0.3, 0.3, 0.3});

  deck.replace("wedge.txt", "0.3 -0.15", "0.3 0.16");
  CHECK_THAT(left_out(), Catch::Matchers::Contains("foil.dat: its outline crosses itself"));
  CHECK(aero::read_turbine(deck.scenario().rotor.turbine).aerofoils.empty());
}
