// [moorings.NAME]: what is read, and what is refused with which words.
// SPDX-License-Identifier: Apache-2.0
#include "src/moorings/options.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "kernels/base/constants.hpp"
#include "src/moorings/doubts.hpp"
#include "src/moorings/table_file.hpp"
#include "src/scene/document.hpp"

using namespace spindrift;
using namespace spindrift::moorings;
using Catch::Matchers::Contains;

namespace {

const std::vector<std::string> bodies{"platform", "buoy"};
const std::string ends = "body = 'platform'\nfairlead_m = [-46.7, 0, -7]\nanchor_m = [-162.6, 0, -20.6]\n";
const std::string spring = ends + "rest_length_m = 116.73\n";
const std::string catenary = ends + "model = 'catenary'\nrest_length_m = 130\nweight_N_m = 1e3\naxial_stiffness_N = 4e8\n";

LineOptions read(const std::string& keys) {
  scene::Document doc = scene::parse("[moorings.line_1]\n" + keys, "test.toml", std::filesystem::temp_directory_path());
  auto lines = doc.read_named(line_section());
  const auto junctions = doc.read_named(junction_section());
  check_lines(doc, lines, junctions, bodies);
  doc.finish();
  place_at_junctions(lines, junctions, 200.0);
  return lines.at(0).options;
}

}  // namespace

TEST_CASE("the declarations of mooring lines and junctions are sound in themselves", "[moorings][fast]") {
  CHECK(line_section().faults().empty());
  CHECK(junction_section().faults().empty());
}

TEST_CASE("stiffness is given as EA or per metre, and the scene says which", "[moorings][fast]") {
  CHECK(read(spring + "axial_stiffness_N = 4e8\n").axial_stiffness_N == 4e8);
  CHECK(read(spring + "stiffness_N_m = 3.4e6\ndamping_N_s_m = 4e4\ntension_only = true\n").stiffness_N_m == 3.4e6);
  CHECK_THROWS_WITH(read(spring), Contains("axial_stiffness_N") && Contains("stiffness_N_m"));
  CHECK_THROWS_WITH(read(spring + "axial_stiffness_N = 4e8\nstiffness_N_m = 3.4e6\n"),
                    Contains("axial_stiffness_N") && Contains("stiffness_N_m"));
  CHECK_THROWS_WITH(read(spring + "stiffness = 3.4e6\n"), Contains("stiffness_N_m"));
}

TEST_CASE("a malformed mooring line is refused with what is wrong", "[moorings][fast]") {
  struct Case {
    std::string keys, message;
  };
  const auto c = GENERATE(
      Case{"body = 'platfrom'\nfairlead_m = [0, 0, 0]\nanchor_m = [1, 0, 0]\nrest_length_m = 1\nstiffness_N_m = 1\n",
           "names body \"platfrom\", which is not in [bodies]; known: platform, buoy"},
      Case{"body = 'earth'\nfairlead_m = [0, 0, 0]\nanchor_m = [1, 0, 0]\nrest_length_m = 1\nstiffness_N_m = 1\n",
           "fairlead must be on a body"},
      Case{"body = 'platform'\nanchor_m = [1, 0, 0]\nrest_length_m = 1\nstiffness_N_m = 1\n", "fairlead_m: is required"},
      Case{"body = 'platform'\nfairlead_m = [1, 0, 0]\nrest_length_m = 1\nstiffness_N_m = 1\n", "anchor_m: is required"},
      Case{spring + "stiffness_N_m = 1\nanchor_body = 'seabed'\n", "names body \"seabed\""},
      Case{spring + "stiffness_N_m = 1\nanchor_body = 'platform'\n", "ties two different things"},
      Case{"body = 'platform'\nfairlead_m = [1, 2, 3]\nanchor_m = [1, 2, 3]\nrest_length_m = 1\nstiffness_N_m = 1\n",
           "no direction"},
      Case{ends + "rest_length_m = -1\nstiffness_N_m = 1\n", "rest_length_m"},
      Case{ends + "stiffness_N_m = 1\n", "rest_length_m"}, Case{spring + "stiffness_N_m = 1\nweight_N_m = 100\n", "weight_N_m"},
      Case{catenary + "stiffness_N_m = 1\n", "stiffness_N_m"}, Case{catenary + "tension_only = true\n", "tension_only"},
      Case{catenary + "anchor_body = 'buoy'\n", "must be false for a line between two bodies"},
      Case{catenary + "bed_contact = false\nbed_friction = 0.5\n", "bed_friction"},
      Case{catenary + "bed_friction = -0.5\n", "bed_friction"}, Case{ends + "model = 'table'\n", "table"},
      Case{ends + "model = 'table'\ntable = 'nowhere.csv'\n", "nowhere.csv"}, Case{ends + "model = 'lumped'\n", "catenary"});
  CHECK_THROWS_WITH(read(c.keys), Contains(c.message));
}

TEST_CASE("a malformed line of sections is refused with what is wrong", "[moorings][fast]") {
  const std::string row = ends + "model = 'composite_catenary'\n",
                    two = row +
                          "sections = [{rest_length_m = 60, weight_N_m = 1e3, axial_stiffness_N = 4e8}, {rest_length_m = "
                          "70, weight_N_m = 200, axial_stiffness_N = 5e7}]\n";
  const LineOptions line = read(two + "bed_friction = 0.5\nclumps = [{distance_m = 60, mass_kg = 1e3}]\n");
  CHECK((line.sections.size() == 2 && line.sections[1].weight_N_m == 200.0 && line.length_m() == 130.0));
  CHECK(line.series_stiffness_N_m() == Approx(1.0 / (60.0 / 4e8 + 70.0 / 5e7)));
  struct Case {
    std::string keys, message;
  };
  const auto c = GENERATE_COPY(
      Case{row, "sections"}, Case{row + "sections = []\n", "must have at least 1"},
      Case{row + "sections = [{rest_length_m = 60, weight_N_m = 1e3}]\n", "sections[0].axial_stiffness_N"},
      Case{row + "sections = [{rest_length_m = 60, weight_N_m = -1, axial_stiffness_N = 4e8}]\n", "sections[0].weight_N_m"},
      Case{row + "sections = [{rest_length_m = 0, weight_N_m = 1, axial_stiffness_N = 4e8}]\n", "sections[0].rest_length_m"},
      Case{row + "sections = [{rest_length_m = 60, weight_N_m = 1, axial_stiffness_N = 'chain'}]\n",
           "sections[0].axial_stiffness_N"},
      Case{row + "sections = [{rest_length_m = 60, weight_N_m = 1, axial_stiffness_N = 4e8, diameter_m = 0.1}]\n",
           "sections[0].diameter_m"},
      Case{two + "rest_length_m = 130\n", "rest_length_m"}, Case{two + "weight_N_m = 1e3\n", "weight_N_m"},
      Case{two + "axial_stiffness_N = 1e8\n", "axial_stiffness_N"}, Case{two + "segments = 20\n", "segments"},
      Case{two + "bed_contact = false\nbed_friction = 0.5\n", "bed_friction"},
      Case{two + "clumps = [{distance_m = 130, mass_kg = 1e3}]\n", "where the line of 130 m has ended"},
      Case{two + "clumps = [{distance_m = 60, mass_kg = 0}]\n", "without mass and volume"},
      Case{two + "clumps = [{distance_m = 60, mass_kg = 1e3, drag_area_m2 = 2}]\n", "have no effect on composite_catenary"},
      Case{two + "anchor_body = 'buoy'\n", "must be false for a line between two bodies"},
      Case{catenary + "sections = [{rest_length_m = 60, weight_N_m = 1e3, axial_stiffness_N = 4e8}]\n", "sections"},
      Case{"body = 'crow'\nanchor_m = [-162.6, 0, -20.6]\n" + two.substr(ends.size()) +
               "[moorings.leg]\nbody = 'platform'\nfairlead_m = [-46.7, 0, -7]\nanchor_body = 'crow'\nmodel = 'lumped_mass'\n"
               "rest_length_m = 130\naxial_stiffness_N = 4e8\ndiameter_m = 0.1\nmass_kg_m = 100\n[junctions.crow]\nposition_m = "
               "[-80, 0, -15]\n",
           "not composite_catenary; sections one after another are a composite_catenary"});
  CHECK_THROWS_WITH(read(c.keys), Contains(c.message));
}

TEST_CASE("a line of sections is doubted as others are, and where a float would fly", "[moorings][fast]") {
  LineOptions line;
  line.model = "composite_catenary", line.body = "platform";
  line.fairlead_m = {0, 0, -7}, line.anchor_m = {400, 0, -54};
  line.sections = {{200.0, 1e3, 5e8}, {210.0, 400.0, 2e8}}, line.clumps = {{300.0, 100.0, 5.0}};
  const LineSurroundings around{54.0, 1e8};
  const auto of = [&](const std::string& key) {
    std::string said;
    for (const auto& doubt : line_doubts({{"a", line}}, around))
      if (doubt.key == "moorings.a." + key) said += doubt.what;
    return said;
  };
  CHECK(line_doubts({{"a", line}}, around).empty());
  line.clumps[0].volume_m3 = 200.0;
  CHECK_THAT(of("clumps"), Contains("the float at 300 m is") && Contains("above the surface"));
  line.clumps.clear(), line.sections[1].weight_N_m = 40.0;
  CHECK_THAT(of("sections[1].weight_N_m"), Contains("40 N/m in water"));
  line.sections[1] = {100.0, 400.0, 2e8};
  CHECK_THAT(of("sections"), Contains("300 m for ends 402.8 m apart"));
}

TEST_CASE("a dynamic line says what it weighs, and is refused where it would float", "[moorings][fast]") {
  const std::string dynamic = ends + "model = 'lumped_mass'\nrest_length_m = 130\naxial_stiffness_N = 4e8\n";
  const LineOptions line = read(dynamic + "diameter_m = 0.1\nmass_kg_m = 100\n");
  CHECK(line.segments == 20);
  CHECK(weight_in_water(line, 1025.0, 10.0) == Approx(10.0 * (100.0 - 1025.0 * 0.25 * pi * 0.01)));
  struct Case {
    std::string keys, message;
  };
  const auto c = GENERATE(
      Case{"diameter_m = 0.1\n", "mass_kg_m"}, Case{"mass_kg_m = 100\n", "diameter_m"},
      Case{"diameter_m = 0.4\nmass_kg_m = 100\n", "must be above the 128.8 kg/m of the water that diameter_m = 0.4 displaces"},
      Case{"diameter_m = 0.1\nmass_kg_m = 100\nsegments = 1\n", "segments"},
      Case{"diameter_m = 0.1\nmass_kg_m = 100\ndamping_ratio = 1.5\n", "damping_ratio"},
      Case{"diameter_m = 0.1\nmass_kg_m = 100\nweight_N_m = 1e3\n", "weight_N_m"},
      Case{"diameter_m = 0.1\nmass_kg_m = 100\nbed_contact = false\nbed_stiffness_Pa_m = 1e6\n", "bed_stiffness_Pa_m"},
      Case{"diameter_m = 0.1\nmass_kg_m = 100\nclumps = [{distance_m = 200, mass_kg = 1e3}]\n",
           "where the line of 130 m has ended"},
      Case{"diameter_m = 0.1\nmass_kg_m = 100\nclumps = [{distance_m = 20, mass_kg = 0}]\n", "without mass and volume"},
      Case{"diameter_m = 0.1\nmass_kg_m = 100\nanchor_body = 'buoy'\n", "must be false for a line between two bodies"});
  CHECK_THROWS_WITH(read(dynamic + c.keys), Contains(c.message));
}

namespace {

const std::string of_chain =
    "model = 'lumped_mass'\nrest_length_m = 130\naxial_stiffness_N = 4e8\ndiameter_m = 0.1\nmass_kg_m = 100\n";
const std::string to_anchor = "body = 'crow'\nanchor_m = [-162.6, 0, -20.6]\n" + of_chain;
const std::string leg = "[moorings.leg]\nbody = 'platform'\nfairlead_m = [-46.7, 0, -7]\nanchor_body = 'crow'\n" + of_chain;
const std::string crow = "[junctions.crow]\nposition_m = [-80, 0, -15]\n";

}  // namespace

TEST_CASE("an end at a junction is placed there, its line's bed where its anchor is, else at the water's depth",
          "[moorings][fast]") {
  const LineOptions line = read(to_anchor + leg + crow);
  CHECK(line.fairlead_m->x() == -80.0);
  CHECK(line.bed_level_m == -20.6);
  CHECK(read("anchor_body = 'crow'\nbody = 'platform'\nfairlead_m = [0, 0, -7]\n" + of_chain + crow + "mass_kg = 9e3\n")
            .bed_level_m == -200.0);
  CHECK_FALSE(read(ends + of_chain).bed_level_m);
  CHECK(read(to_anchor + crow + "volume_m3 = 20\n").body == "crow");  // a float
}

TEST_CASE("a malformed junction is refused with what is wrong", "[moorings][fast]") {
  struct Case {
    std::string scene, message;
  };
  const auto c =
      GENERATE(Case{ends + of_chain + crow, "junctions.crow: is named by no end of a line"},
               Case{to_anchor + leg, "names body \"crow\", which is not in [bodies]"},
               Case{to_anchor + leg + "[junctions.craw]\nposition_m = [0, 0, 0]\n",
                    "names body \"crow\", which is not in [bodies] or [junctions]; known: platform, buoy, craw"},
               Case{to_anchor + leg + "[junctions.crow]\n", "junctions.crow.position_m"},
               Case{to_anchor + leg + crow + "mass_kg = -5\n", "junctions.crow.mass_kg"},
               Case{to_anchor + leg + crow + "volume_m3 = -5\n", "junctions.crow.volume_m3"},
               Case{to_anchor + leg + crow + "drag_area_m2 = -1\n", "junctions.crow.drag_area_m2"},
               Case{to_anchor + leg + crow + "weight = 1\n", "weight"},
               Case{to_anchor + "fairlead_m = [0, 0, 0]\n" + leg + crow, "must be left out: the end is at junction \"crow\""},
               Case{"body = 'crow'\nanchor_body = 'crow'\n" + of_chain + leg + crow, "ties two different things"},
               Case{"body = 'crow'\nanchor_m = [-162.6, 0, -20.6]\nmodel = 'catenary'\nrest_length_m = 130\nweight_N_m = 1e3\n"
                    "axial_stiffness_N = 4e8\n" +
                        leg + crow,
                    "names junction \"crow\": of the models of lines only lumped_mass has nodes that move with it, "
                    "not "
                    "catenary"},
               Case{"body = 'crow'\nanchor_body = 'nest'\n" + of_chain + crow + "[junctions.nest]\nposition_m = [0, 0, -30]\n",
                    "junctions.nest: is held by nothing"},
               Case{to_anchor + crow, "junctions.crow: is the loose end of one line"});
  CHECK_THROWS_WITH(read(c.scene), Contains(c.message));
}

TEST_CASE("a junction that begins under the bed is doubted", "[moorings][fast]") {
  CHECK(junction_doubts({{"crow", {.position_m = {0, 0, -210}}}}, {200.0}).size() == 1);
  CHECK(junction_doubts({{"crow", {.position_m = {0, 0, -190}}}}, {200.0}).empty());
}

TEST_CASE("a catenary between two bodies is legal where it does not ask for a bed", "[moorings][fast]") {
  CHECK_FALSE(read(catenary + "anchor_body = 'buoy'\nbed_contact = false\n").bed_contact);
}

TEST_CASE("a table must be one that a line can follow", "[moorings][fast]") {
  const auto with = [](const std::string& text) {
    std::ofstream(std::filesystem::temp_directory_path() / "spindrift_line_test.csv") << text;
    return read(ends + "model = 'table'\ntable = 'spindrift_line_test.csv'\n").table;
  };
  CHECK(read_line_table(with("distance_m,tension_N\n100,0\n110,1e5\n")).tension[1] == 1e5);
  CHECK_THROWS_WITH(with("distance_m,tension_N\n100,0\n"), Contains("at least 2 rows"));
  CHECK_THROWS_WITH(with("distance_m,tension_N\n100,0\n100,1\n"), Contains(".csv:3") && Contains("must be above 100"));
  CHECK_THROWS_WITH(with("distance_m,tension_N\n100,5\n110,4\n"), Contains("unstable"));
  CHECK_THROWS_WITH(with("distance_m,tension_N\n-1,5\n110,6\n"), Contains("must not be negative"));
  CHECK_THROWS_WITH(with("distance_m,force_N\n100,5\n110,6\n"), Contains("force_N"));
}

TEST_CASE("too few segments, and a step too long for a light body, are doubted", "[moorings][fast]") {
  LineOptions line = read(
      "model = 'lumped_mass'\nbody = 'platform'\nfairlead_m = [0, 0, 0]\nanchor_m = [400, 0, -50]\nrest_length_m = 410\n"
      "axial_stiffness_N = 1.674e9\ndiameter_m = 0.252\nmass_kg_m = 390\n");
  const auto keys = [&](double mass_kg) {
    std::string all;
    for (const scene::Doubt& doubt : line_doubts({{"line_1", line}}, {50.0, 1e9, 1025.0, 9.80665, 0.02, {{"platform", mass_kg}}}))
      all += doubt.key + " ";
    return all;
  };
  CHECK(keys(8e6).empty());
  CHECK(keys(2e4) == "time.step_s ");
  line.segments = 3;  // 137 m each where the chain is bent to 251 m
  CHECK(keys(8e6) == "moorings.line_1.segments ");
}

TEST_CASE("a line through its body is doubted, lines beside an outrigger and under a hull are not", "[moorings][fast]") {
  LineSurroundings around;
  const auto said = [&](const Eigen::Vector3d& fairlead_m, const Eigen::Vector3d& anchor_m) {
    LineOptions line;
    line.body = "hull", line.fairlead_m = fairlead_m, line.anchor_m = anchor_m;
    line.rest_length_m = line.span().norm(), line.axial_stiffness_N = 4e8;
    std::string all;
    for (const scene::Doubt& doubt : line_doubts({{"a", line}}, around)) all += doubt.key + " ";
    return all;
  };
  const auto stands = [&](const std::vector<Eigen::AlignedBox3d>& pieces) {
    Eigen::AlignedBox3d box;
    for (const Eigen::AlignedBox3d& piece : pieces) box.extend(piece);
    around.shapes["hull"] = box, around.pieces["hull"] = pieces, around.centres["hull"] = {0, 0, -2};
  };
  const Eigen::AlignedBox3d hull{Eigen::Vector3d(-10, -8, -10), Eigen::Vector3d(10, 8, 5)},
      outrigger{Eigen::Vector3d(58, -2, -10), Eigen::Vector3d(62, 2, 5)};
  const std::string far_side = "moorings.a.anchor_m ";
  stands({hull, outrigger});  // the middle of both is 26 m from that of the hull
  CHECK(said({10, 8, -5}, {200, 200, -60}).empty());
  CHECK(said({60, 2, -5}, {0, 200, -60}).empty());
  CHECK(said({10, 8, -5}, {-100, -200, -60}) == far_side);
  CHECK(said({62, 0, -5}, {-200, 0, -15}) == far_side);
  CHECK(said({62, 0, -5}, {-37, 171, -60}).empty());  // of a turret, 120 degrees from ahead
  stands({hull});
  CHECK(said({10, 0, -5}, {200, 0, -60}).empty());
  CHECK(said({10, 0, -5}, {-200, 0, -60}) == far_side);
  CHECK(said({10, 0, -10}, {-200, 0, -60}).empty());  // crossed lines under a barge
  stands({{Eigen::Vector3d(41, -6, -14), Eigen::Vector3d(52, 6, 12)},
          {Eigen::Vector3d(-29, 35, -14), Eigen::Vector3d(-18, 46, 12)},
          {Eigen::Vector3d(-29, -46, -14), Eigen::Vector3d(-18, -35, 12)}});
  CHECK(said({-23, 40, -7}, {-81, 141, -21}).empty());
  CHECK(said({-23, 40, -7}, {-81, -141, -21}) == far_side);  // between the columns
  std::vector<scene::Named<LineOptions>> spread;
  for (const double x : {-40.0, 40.0})
    for (const double y : {-110.0, 110.0}) {
      LineOptions line;
      line.body = "hull", line.fairlead_m = {x, y, -14}, line.anchor_m = {12 * x, 5 * y, -200};
      line.rest_length_m = line.span().norm(), line.axial_stiffness_N = 1e9;
      spread.emplace_back("line_" + std::to_string(spread.size()), line);
    }
  stands({{Eigen::Vector3d(-47, -112, -20), Eigen::Vector3d(47, -97, 12)},
          {Eigen::Vector3d(-47, 97, -20), Eigen::Vector3d(47, 112, 12)}});
  CHECK(line_doubts(spread, around).empty());
  spread[0].options.anchor_m->y() *= -1.0;  // beside the body
  const scene::Doubts doubts = line_doubts(spread, around);
  REQUIRE(doubts.size() == 1);
  CHECK(doubts[0].key == "moorings.line_0.anchor_m");
}

TEST_CASE("springs out by a thousand are doubted, tendons and soft lines of a model are not", "[moorings][fast]") {
  LineSurroundings around{20.6, 4.37e7};
  around.masses_kg["platform"] = 4.45e6;
  around.shapes["platform"] = {Eigen::Vector3d(-29, -46, -14), Eigen::Vector3d(52, 46, 12)};
  const auto keys = [&](double depth_m, double stiffness_N) {
    LineOptions line;
    line.body = "platform", line.rest_length_m = 116.73, line.axial_stiffness_N = stiffness_N;
    line.fairlead_m = {46.7, 0, -7}, line.anchor_m = {162.63504, 0, -20.6};
    std::string all;
    around.depth_m = depth_m;
    for (const scene::Doubt& doubt : line_doubts({{"a", line}}, around)) all += doubt.key + " ";
    return all;
  };
  for (const double stiffness : {2e6, 4e8, 4e9}) CHECK(keys(20.6, stiffness).empty());  // a tendon of 100 m has 2e9 N
  for (const double stiffness : {4e5, 4e11}) CHECK(keys(20.6, stiffness) == "moorings.a.axial_stiffness_N ");
  for (const double depth : {206.0, 2060.0}) CHECK(keys(depth, 4e8) == "moorings.a.anchor_m ");
  around.shapes.clear();  // nothing that floats
  CHECK(keys(20.6, 4e11).empty());
}
