// Lines of MAP++ and MoorDyn. SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "kernels/base/constants.hpp"
#include "src/bodies/linearise.hpp"
#include "src/coupling/floating_system.hpp"
#include "src/coupling/start.hpp"
#include "tests/src/import/small_deck.hpp"

using namespace spindrift;

TEST_CASE("lines of MAP++ that omit contact do not meet the bed", "[import][fast]") {
  SmallDeck deck;
  CHECK(deck.scenario().moorings[0].options.bed_contact);
  deck.replace("map.dat", "1 chain 540 1 2 plot", "1 chain 540 1 2 plot OMIT_CONTACT");
  CHECK_FALSE(deck.scenario().moorings[0].options.bed_contact);
}

TEST_CASE("points of a MoorDyn body are where its axes put them, and those of a free body are refused", "[import][fast]") {
  SmallDeck deck;
  deck.replace("main.fst", "1 CompMooring", "3 CompMooring");
  deck.files["map.dat"] =
      "--- LINE TYPES ---\nName Diam MassDen EA BA/-zeta EI Cd Ca CdAx CaAx\n(-) (m) (kg/m) (N) (N-s/-) (-) (-) (-) (-) (-)\n"
      "chain 0.1 100 4e8 -1 0 1 1 0 0\n---- BODIES ----\nID Attachment X0 Y0 Z0 r0 p0 y0 Mass CG I Volume CdA Ca\n"
      "(#) (-) (m) (m) (m) (deg) (deg) (deg) (kg) (m) (kg-m^2) (m^3) (m^2) (-)\n1 Coupled 0 0 -10 0 0 0 0 0 0 0 0 0\n"
      "---- POINTS ----\nID Attachment X Y Z M V CdA CA\n(#) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)\n"
      "1 Fixed 500 0 -200 0 0 0 0\n2 Body1 4 0 -20 0 0 0 0\n---- LINES ----\nID LineType AttachA AttachB UnstrLen NumSegs "
      "Outputs\n(#) (name) (#) (#) (m) (-) (-)\n1 chain 1 2 540 20 -\n---- OPTIONS ----\n0.001 dtM\n";
  CHECK(deck.scenario().moorings[0].options.fairlead_m->z() == -30.0);
  deck.replace("map.dat", "1 Coupled 0", "1 Free 0");
  CHECK_THAT(deck.refusal(), Catch::Contains("map.dat") && Catch::Contains("is a point of Body1, which is free"));
}

TEST_CASE("MoorDyn's lines and older names are read too", "[import][fast]") {
  SmallDeck deck;
  deck.replace("main.fst", "1 CompMooring", "3 CompMooring");
  deck.replace("ad.dat", "1 Wake_Mod", "1 WakeMod");
  deck.files["map.dat"] =
      "--- LINE TYPES ---\nName Diam MassDen EA BA/-zeta EI Cd Ca CdAx CaAx\n(-) (m) (kg/m) (N) (N-s/-) (-) (-) (-) (-) (-)\n"
      "chain 0.1 100 4e8 -1 0 1 1 0 0\n---- POINTS ----\nID Attachment X Y Z M V CdA CA\n(#) (-) (m) (m) (m) (kg) (m^3) (m^2) "
      "(-)\n"
      "1 Fixed 500 0 -200 0 0 0 0\n2 Vessel 4 0 -30 0 0 0 0\n---- LINES ----\nID LineType AttachA AttachB UnstrLen NumSegs "
      "Outputs\n"
      "(#) (name) (#) (#) (m) (-) (-)\n1 chain 1 2 540 20 -\n---- OPTIONS ----\n0.001 dtM\n";
  const coupling::Scenario s = deck.scenario();
  REQUIRE(s.moorings.size() == 1);
  const moorings::LineOptions& line = s.moorings[0].options;
  CHECK(line.model == "lumped_mass");
  CHECK(line.rest_length_m == 540.0);
  CHECK(line.fairlead_m->z() == -30.0);
  CHECK((line.segments == 20 && line.mass_kg_m == 100.0 && line.diameter_m == 0.1 && line.damping_ratio == 1.0));
  CHECK((line.drag_coefficient == 1.0 && line.added_mass_coefficient == 1.0 && line.axial_drag_coefficient == 0.0));
}

namespace {

/// One line of MoorDyn from this anchor and with these rows beside it.
SmallDeck deck_of_moordyn(const std::string& anchor, const std::string& rows, const std::string& options) {
  SmallDeck deck;
  deck.replace("main.fst", "1 CompMooring", "3 CompMooring");
  deck.files["map.dat"] =
      "--- MoorDyn input ---\nof a test\n--- LINE TYPES ---\nName Diam MassDen EA BA/-zeta EI Cd Ca CdAx CaAx Cl\n(-) (m) (kg/m) "
      "(N) (N-s/-) (-) (-) (-) (-) (-) (-)\nchain 0.1 100 4e8 -1 0 1 1 0 0 0.5\n---- POINTS ----\nID Attachment X Y Z M V CdA "
      "CA\n(#) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)\n1 Fixed 500 0 " +
      anchor + " 0 0 0 0\n\n2 Vessel 4 0 -30 50e3 10 0 1  # a clump\n---- LINES ----\n" +
      "ID LineType AttachA AttachB UnstrLen NumSegs Outputs\n(#) (name) (#) (#) (m) (-) (-)\n1 chain 1 2 540 20 -\n" + rows +
      "---- OPTIONS ----\n0.001 dtM\n" + options;
  return deck;
}

}  // namespace

TEST_CASE("headings of MAP++ may begin with ID, tables of MoorDyn with the number of their rows", "[import][fast]") {
  SmallDeck deck;
  const std::size_t lines = deck.scenario().moorings.size();
  deck.replace("map.dat", "Node Type X", "ID Attachment X");
  deck.replace("map.dat", "Line LineType", "ID LineType");
  CHECK(deck.scenario().moorings.size() == lines);
  SmallDeck counted = deck_of_moordyn("-200", "", "");
  counted.replace("map.dat", "LINE TYPES ---\n", "LINE TYPES ---\n1 NTypes - number of line types\n");
  counted.replace("map.dat", "LINES ----\n", "LINES ----\n1 NLines - number of lines\n");
  CHECK(counted.scenario().moorings.size() == 1);
}

TEST_CASE("comments and blank lines of MoorDyn are none of its rows", "[import][fast]") {
  const coupling::Scenario s = deck_of_moordyn("-200", "\n#2 chain 1 2 560 20 -\n! 3 chain 1 2 570 20 -\n", "").scenario();
  CHECK(s.moorings.size() == 1);
}

TEST_CASE("a line of MoorDyn meets the bed at its anchor's level, unless that is high over the bed", "[import][fast]") {
  const auto contact = [](const std::string& anchor) {
    const SmallDeck deck = deck_of_moordyn(anchor, "", "");
    CHECK(has_word(deck.import().left_out, "m under the anchor of line 1") == (anchor != "-200" && anchor != "SeaBed"));
    return deck.scenario().moorings[0].options.bed_contact;
  };
  CHECK(contact("-200"));
  CHECK(contact("SeaBed"));
  CHECK(contact("-198"));
  CHECK_FALSE(contact("-150"));
}

TEST_CASE("what MoorDyn has beside its lines is carried or named", "[import][fast]") {
  const SmallDeck deck = deck_of_moordyn(
      "-200",
      "---- EXTERNAL LOADS ----\nID Object Fext Blin Bquad CSys\n(#) (name) (N) (Ns/m) (Ns2/m2) (-)\n1 Point2 -1e6 0 0 G\n",
      "SEASTATE WaterKin\n0.7 mu_kT\n0.6 mu_kA\n\"bathy.txt\" WtrDpth\n");
  CHECK(deck.scenario().moorings[0].options.bed_friction == 0.6);
  const std::vector<std::string> left_out = deck.import().left_out;
  for (const char* what : {"the table EXTERNAL LOADS", "WtrDpth bathy.txt", "mu_kT 0.7", "lift of vortices", "M, V of point 2"}) {
    CAPTURE(what);
    CHECK(has_word(left_out, what));
  }
  CHECK_FALSE(has_word(left_out, "MOORDYN INPUT"));
  CHECK_FALSE(has_word(left_out, "round the lines"));
  SmallDeck still = deck;
  still.replace("map.dat", "SEASTATE WaterKin\n", "\"wk.dat\" WaterKin\n");
  CHECK(has_word(still.import().left_out, "wk.dat round the lines"));
  SmallDeck fixed = deck;
  fixed.replace("main.fst", "1 CompHydro", "0 CompHydro");
  CHECK(has_word(fixed.import().left_out, "mooring lines: what they hold does not float"));
}

TEST_CASE("free points of MoorDyn are junctions of the scene", "[import][fast]") {
  const bool first_version = GENERATE(true, false);
  SmallDeck deck;
  deck.replace("main.fst", "1 CompMooring", "3 CompMooring");
  const std::string units = "(#) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)\n";
  deck.files["map.dat"] =
      first_version
          ? "--- LINE DICTIONARY ---\nLineType Diam MassDenInAir EA BA/-zeta Can Cat Cdn Cdt\n(-) (m) (kg/m) (N) (N-s/-) (-) (-) "
            "(-) "
            "(-)\nchain 0.1 100 4e8 -1 1 0 1 0\n---- CONNECTION PROPERTIES ----\nNode Type X Y Z M V FX FY FZ CdA CA\n(#) (-) "
            "(m) (m) "
            "(m) (kg) (m^3) (kN) (kN) (kN) (m^2) (-)\n1 Fixed 500 0 -200 0 0 0 0 0 0 0\n2 Vessel 4 5 -30 0 0 0 0 0 0 0\n3 Vessel "
            "4 -5 "
            "-30 0 0 0 0 0 0 0\n4 Connect 50 0 -60 1000 0.5 0 0 3 2.5 0.7\n5 Connect 0 0 -60 1 0 0 0 0 0 0\n---- LINE PROPERTIES "
            "----\nLine LineType UnstrLen NumSegs NodeAnch NodeFair Outputs\n(#) (name) (m) (-) (#) (#) (-)\n1 chain 490 20 1 4 "
            "-\n2 "
            "chain 56 5 4 2 -\n3 chain 56 5 3 4 -\n---- SOLVER OPTIONS ----\n0.001 dtM\n"
          : "--- LINE TYPES ---\nName Diam MassDen EA BA/-zeta EI Cd Ca CdAx CaAx\n(-) (m) (kg/m) (N) (N-s/-) (-) (-) (-) (-) "
            "(-)\n"
            "chain 0.1 100 4e8 -1 0 1 1 0 0\n---- POINTS ----\nID Attachment X Y Z M V CdA CA\n" +
                units +
                "1 Fixed 500 0 -200 0 0 0 0\n2 Coupled 4 5 -30 0 0 0 0\n3 Vessel 4 -5 -30 0 0 0 0\n4 Free 50 0 -60 1000 0.5 2.5 "
                "0.7\n5 Free 0 0 -60 1 0 0 0\n---- LINES ----\nID LineType AttachA AttachB UnstrLen NumSegs Outputs\n(#) (name) "
                "(#) "
                "(#) (m) (-) (-)\n1 chain 1 4 490 20 -\n2 chain 4 2 56 5 -\n3 chain 3 4 56 5 -\n---- OPTIONS ----\n0.001 dtM\n";
  const coupling::Scenario s = deck.scenario();
  REQUIRE(s.junctions.size() == 1);  // a point that no line names is none
  CHECK(s.junctions[0].name == "junction_4");
  const moorings::JunctionOptions& point = s.junctions[0].options;
  CHECK(point.position_m == Eigen::Vector3d(50, 0, -60));
  CHECK((point.mass_kg == 1000.0 && point.volume_m3 == 0.5 && point.drag_area_m2 == 2.5 && point.added_mass_coefficient == 0.7));
  REQUIRE(s.moorings.size() == 3);
  CHECK((s.moorings[0].options.body == "junction_4" && s.moorings[0].options.anchor_body == "earth"));
  for (const int leg : {1, 2}) {
    const moorings::LineOptions& line = s.moorings[std::size_t(leg)].options;
    CHECK((line.body == "platform" && line.anchor_body == "junction_4" && line.segments == 5));
    CHECK(line.fairlead_m->y() == (leg == 1 ? 5.0 : -5.0));
  }
  if (first_version) CHECK(has_word(deck.import().left_out, "the force FZ on point 4"));
  coupling::FloatingSystem floating(s);
  coupling::Start start = make_start(floating);
  for (int n = 0; n < 20; ++n) REQUIRE(floating.multibody().advance(start.state, floating.timeline().tick_s(), 1).ok());
}

TEST_CASE("lines of MAP++ one after another are one line of sections", "[import][fast]") {
  SmallDeck deck;
  deck.replace("map.dat", "chain 0.1 100 4e8 0.5 1 1 1 1\n", "chain 0.1 100 4e8 0.5 1 1 1 1\nrope 0.08 20 1e8 0.2 1 1 1 1\n");
  deck.replace("map.dat", "2 Vessel 4 0 -30 0 0 # # #\n",
               "2 Vessel 4 0 -30 0 0 # # #\n3 Connect #350 #0 #-190 1000 0.5 0 0 0\n4 Connect #200 #0 #-120 0 0 0 0 0\n");
  // The rows in any order, the middle one from above.
  deck.replace("map.dat", "1 chain 540 1 2 plot\n", "1 rope 250 4 2 plot\n2 chain 180 1 3\n3 rope 130 4 3\n");
  const coupling::Scenario s = deck.scenario();
  REQUIRE(s.moorings.size() == 3);
  CHECK(s.junctions.empty());
  for (const auto& [name, line] : s.moorings) {
    CHECK(line.model == "composite_catenary");
    REQUIRE(line.sections.size() == 3);
    CHECK((line.sections[0].rest_length_m == 180.0 && line.sections[1].rest_length_m == 130.0));
    CHECK(line.sections[2].rest_length_m == 250.0);
    CHECK(line.sections[0].axial_stiffness_N == 4e8);
    CHECK(line.sections[2].weight_N_m == Approx(9.80665 * (20.0 - 1025.0 * 0.25 * pi * 0.0064)));
    CHECK((line.bed_contact && line.bed_friction == 0.5 && line.anchor_m->z() == -200.0));
    REQUIRE(line.clumps.size() == 1);
    CHECK((line.clumps[0].distance_m == 180.0 && line.clumps[0].mass_kg == 1000.0 && line.clumps[0].volume_m3 == 0.5));
  }
  CHECK(s.moorings[1].options.fairlead_m->y() == Approx(4.0 * std::sin(120.0 * radians_per_degree)));
  const std::vector<std::string> left_out = deck.import().left_out;
  CHECK(has_word(left_out, "bed friction of line 3"));
  CHECK_FALSE(has_word(left_out, "dynamic here"));
  deck.replace("map.dat", "rope 0.08 20", "rope 0.8 20");
  CHECK(has_word(deck.import().left_out, "line 3: it has no weight in water or no stiffness, nor come the lines in a row"));
}

TEST_CASE("a line cut in two in the deck holds its platform as the whole one does", "[import][fast]") {
  SmallDeck deck;
  const auto rates = [&] {
    coupling::FloatingSystem floating(deck.scenario());
    const coupling::Start start = make_start(floating);
    std::vector<double> found;
    for (const bodies::Mode& mode : bodies::linearise(floating.multibody(), start.state, 0.0).modes)
      found.push_back(std::abs(mode.eigenvalue));
    return found;
  };
  const std::vector<double> whole = rates();
  deck.replace("map.dat", "2 Vessel 4 0 -30 0 0 # # #\n", "2 Vessel 4 0 -30 0 0 # # #\n3 Connect #200 #0 #-120 0 0 0 0 0\n");
  deck.replace("map.dat", "1 chain 540 1 2 plot\n", "1 chain 340 1 3 plot\n2 chain 200 3 2 plot\n");
  const std::vector<double> cut = rates();
  REQUIRE(cut.size() == whole.size());
  CHECK(cut.size() >= 6);
  for (std::size_t n = 0; n < cut.size(); ++n) CHECK(cut[n] == Approx(whole[n]).epsilon(1e-5).margin(1e-6));
}

TEST_CASE("MoorDyn's lines are catenaries where that is asked for, several in a row one of sections, but not where they branch",
          "[import][fast]") {
  SmallDeck deck;
  deck.replace("main.fst", "1 CompMooring", "3 CompMooring");
  deck.files["map.dat"] =
      "--- LINE TYPES ---\nName Diam MassDen EA BA/-zeta EI Cd Ca CdAx CaAx\n(-) (m) (kg/m) (N) (N-s/-) (-) (-) (-) (-) (-)\n"
      "chain 0.1 100 4e8 -1 0 1 1 0 0\nrope 0.08 20 1e8 -1 0 1 1 0 0\n---- POINTS ----\nID Attachment X Y Z M V CdA CA\n"
      "(#) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)\n1 Fixed 500 0 -200 0 0 0 0\n2 Vessel 4 5 -30 0 0 0 0\n3 Free 250 0 -180 500 0 0 "
      "0\n"
      "4 Fixed -500 0 -200 0 0 0 0\n5 Vessel -4 0 -30 0 0 0 0\n6 Vessel 4 -5 -30 0 0 0 0\n7 Fixed 0 500 -200 0 0 0 0\n"
      "8 Free 0 50 -60 1000 0 0 0\n---- LINES ----\nID LineType AttachA AttachB UnstrLen NumSegs Outputs\n"
      "(#) (name) (#) (#) (m) (-) (-)\n1 chain 1 3 280 20 -\n2 rope 3 2 260 20 -\n3 chain 4 5 540 20 -\n4 chain 7 8 490 20 -\n"
      "5 chain 8 2 60 5 -\n6 chain 8 6 60 5 -\n---- OPTIONS ----\n0.5 FrictionCoefficient\n";
  const auto models = [&](decks::ImportedLines lines) {
    std::vector<std::string> found;
    for (const auto& [name, line] : deck.scenario(decks::ImportedTower::as_in_deck, lines).moorings)
      found.push_back(name + " " + line.model);
    return found;
  };
  CHECK(models(decks::ImportedLines::as_in_deck).size() == 6);
  CHECK(models(decks::ImportedLines::quasi_static) == std::vector<std::string>{"line_1 composite_catenary", "line_3 catenary",
                                                                               "line_4 lumped_mass", "line_5 lumped_mass",
                                                                               "line_6 lumped_mass"});
  const auto imported = deck.import(decks::ImportedTower::as_in_deck, decks::ImportedLines::quasi_static);
  CHECK(has_word(imported.left_out, "stay dynamic in spite of --quasi-static-lines"));
  CHECK(has_word(imported.carried, "moorings: 5 lines, 1 junctions"));
}

TEST_CASE("free nodes of MAP++ at which several lines meet are junctions, and their lines dynamic", "[import][fast]") {
  SmallDeck deck;
  deck.replace(
      "map.dat", "1 fix 500 0 depth 0 0 # # #\n2 Vessel 4 0 -30 0 0 # # #\n",
      "1 fix 500 0 depth 0 0 # # #\n2 Vessel 4 5 -30 0 0 # # #\n3 Vessel 4 -5 -30 0 0 # # #\n4 Connect #50 #0 #-60 1000 0.5 0 "
      "0 0\n");
  deck.replace("map.dat", "1 chain 540 1 2 plot\n", "1 chain 490 1 4 plot\n2 chain 56 4 2\n3 chain 56 4 3\n");
  const coupling::Scenario s = deck.scenario();
  REQUIRE(s.moorings.size() == 9);
  REQUIRE(s.junctions.size() == 3);
  CHECK((s.junctions[1].name == "junction_4_2" && s.junctions[2].name == "junction_4_3"));
  CHECK(s.junctions[1].options.position_m.x() == Approx(50.0 * std::cos(120.0 * radians_per_degree)));
  CHECK((s.junctions[1].options.mass_kg == 1000.0 && s.junctions[1].options.volume_m3 == 0.5));
  CHECK((s.moorings[3].options.body == "junction_4_2" && s.moorings[3].options.model == "lumped_mass"));
  CHECK((s.moorings[4].options.anchor_body == "junction_4_2" && s.moorings[4].options.body == "platform"));
  CHECK(has_word(deck.import().left_out, "lines that meet at a node with others are dynamic here"));
}
