// Members, potential flow and waves of a deck. SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "kernels/base/constants.hpp"
#include "src/sea/wamit.hpp"
#include "tests/src/import/small_deck.hpp"

using namespace spindrift;

TEST_CASE("members have the coefficients that the deck gives them, and the ballast in them has mass", "[import][fast]") {
  SmallDeck deck;
  const double empty = deck.scenario().bodies[0].options.mass_kg;
  deck.replace("hd.dat", "1 NAxCoef", "2 NAxCoef");
  deck.replace("hd.dat", "1 0.5 0 1\n", "1 0.5 0 1\n2 9.6 0 1\n");
  deck.replace("hd.dat", "1 0 0 -80 1 0", "1 0 0 -80 2 0");
  deck.replace("hd.dat", "1 1 2 1 1 4 1", "1 1 2 1 1 4 3");
  deck.replace("hd.dat", "2 2 3 1 2 4 1", "2 2 3 1 2 4 2");
  deck.replace(
      "hd.dat", "2 NMembers",
      "2 NCoefDpth\nDpth DpthCd DpthCdMG DpthCa\n(m) (-) (-) (-)\n0 0.4 0 1\n10 0.8 0 1\n"
      "1 NCoefMembers\nMemberID MemberCd1 MemberCd2 MemberCa1 MemberCa2\n(-) (-) (-) (-) (-)\n1 0.6 0.6 0.8 0.8\n2 NMembers");
  deck.files["hd.dat"] += "1 NFillGroups\nFillNumM FillMList FillFSLoc FillDens\n(-) (-) (m) (kg/m^3)\n1 1 -70 2000\n";
  const coupling::Scenario s = deck.scenario();
  CHECK(s.sea.drag_coefficient == 0.6);
  CHECK(s.sea.axial_drag_coefficient == 4.8);
  REQUIRE(s.sea.coefficients.size() == 2);
  CHECK(s.sea.coefficients[0].end_axial_drag_coefficient.value() == 0.25);
  CHECK(s.sea.coefficients[1].drag_coefficient.value() == Approx(0.5));  // 0.6 at 5 m of depth, 0.4 in the air
  const double ballast = 2000.0 * pi * 3.99 * 3.99 * 10.0;
  const bodies::BodyOptions& body = s.bodies[0].options;
  CHECK(body.mass_kg - empty == Approx(ballast));
  const bodies::BodyOptions light = SmallDeck().scenario().bodies[0].options;
  CHECK(body.centre_m.z() == Approx((empty * light.centre_m.z() - 75.0 * ballast) / (empty + ballast)));
}

TEST_CASE("what stands in the bed or on a structure of SubDyn is fixed, and feels no water below the bed", "[import][fast]") {
  SmallDeck deck;
  deck.replace("main.fst", "0 CompSub", "1 CompSub");
  deck.replace("main.fst", "200 WtrDpth", "60 WtrDpth");
  deck.replace("hd.dat", "1 PotMod", "0 PotMod");
  const coupling::Scenario s = deck.scenario();
  REQUIRE(s.joints.size() == 1);
  CHECK(s.bodies[0].options.cylinders.at(0).start_m.z() == -60.0);
}

TEST_CASE("yaw, current, phase and a constant force of the deck are the scene's", "[import][fast]") {
  SmallDeck deck;
  deck.replace("ed.dat", "10 RotSpeed", "10 RotSpeed\n30 NacYaw");
  deck.replace("sea.dat", "1 WaveMod", "1P40 WaveMod");
  deck.replace("sea.dat", "0 CurrMod", "1 CurrMod\n0 CurrSSV0\n0 CurrNSV0\n2 CurrDIV\n90 CurrDIDir");
  deck.replace("hd.dat", "0 AddF0", "1e5 AddF0");
  deck.replace("hd.dat", "1 WAMITULEN", "1 WAMITULEN\n-12 PtfmRefzt");
  const coupling::Scenario s = deck.scenario();
  const double yaw = 30.0 * radians_per_degree;
  CHECK(s.rotor.axis.y() == Approx(std::sin(yaw) * std::cos(6.0 * radians_per_degree)));
  CHECK(s.rotor.hub_m.y() == Approx(-4.0 * s.rotor.axis.y()));
  CHECK(s.waves.phase == Approx(-40.0 * radians_per_degree));  // HydroDyn's runs with time, the scene's with x
  CHECK(s.sea.current_m_s.y() == Approx(2.0));
  CHECK(s.sea.potential->point_m.z() == -12.0);
  CHECK(s.sea.matrices.at(0).point_m.z() == -12.0);
  REQUIRE(s.bodies[0].options.forces.size() == 1);
  CHECK(s.bodies[0].options.forces[0].force_N.x() == 1e5);
}

TEST_CASE("short-crested seas, constrained crests and currents over depth of the deck are the scene's", "[import][fast]") {
  SmallDeck deck;
  deck.replace("sea.dat", "1 WaveMod",
               "2 WaveMod\n1 WaveDirMod\n4 WaveDirSpread\n90 WaveDirRange\n1 ConstWaveMod\n6 CrestHmax\n60 CrestTime\n5 "
               "CrestXi\n-2 CrestYi");
  deck.replace(
      "sea.dat", "0 CurrMod",
      "1 CurrMod\n1 CurrSSV0\n\"DEFAULT\" CurrSSDir\n20 CurrNSRef\n0.5 CurrNSV0\n90 CurrNSDir\n0.3 CurrDIV\n180 CurrDIDir");
  const coupling::Scenario s = deck.scenario();
  CHECK(s.waves.spreading_exponent == 4.0);
  CHECK(s.waves.spreading_range == Approx(0.5 * pi));
  CHECK(s.waves.crest_height_m == 3.0);
  CHECK(s.waves.crest_time_s == 60.0);
  CHECK(s.waves.crest_place_m == std::array{5.0, -2.0});
  CHECK(s.sea.current_m_s.x() == Approx(-0.3));
  // At the surface the power law along the waves (30 degrees), and the part near the surface along y.
  REQUIRE(s.sea.current_profile.size() > 10);
  const auto& top = s.sea.current_profile.back();
  CHECK(top[0] == 0.0);
  CHECK(top[1] == Approx(std::cos(30.0 * radians_per_degree)));
  CHECK(top[2] == Approx(std::sin(30.0 * radians_per_degree) + 0.5));
  const auto& bed = s.sea.current_profile.front();
  CHECK(bed[0] == -200.0);
  CHECK(std::hypot(bed[1], bed[2]) == Approx(0.0).margin(1e-12));
}

TEST_CASE("waves of second order of the deck are the scene's where it has the same, and told where it has not",
          "[import][fast]") {
  SmallDeck deck;
  deck.replace("sea.dat", "1 WaveMod", "2 WaveMod");
  deck.replace("hd.dat", "1 PotMod", "0 PotMod");
  deck.files["sea.dat"] += "True WvDiffQTF\nTrue WvSumQTF\n0 WvLowCOffD\n3.5 WvHiCOffD\n0.1 WvLowCOffS\n7.0 WvHiCOffS\n";
  CHECK(deck.scenario().waves.second_order);
  const decks::Imported whole = deck.import();
  CHECK(has_word(whole.carried, "waves of second order"));
  CHECK_FALSE((has_word(whole.left_out, "COff") || has_word(whole.left_out, "QTF")));
  const auto with = [&](const std::string& file, const std::string& from, const std::string& to) {
    SmallDeck other = deck;
    other.replace(file, from, to);
    const bool bound = other.scenario().waves.second_order;
    return std::pair{bound, other.import().left_out};
  };
  // A band without the pairs of small energy, and one without those of the peak (9 s: 0.7 rad/s).
  const auto [narrow, told] = with("sea.dat", "7.0 WvHiCOffS", "3.5 WvHiCOffS");
  CHECK((narrow && has_word(told, "0.1 and 3.5 rad/s (WvLowCOffS, WvHiCOffS)")));
  struct Case {
    std::string file, from, to, said;
  };
  for (const Case& c :
       {Case{"sea.dat", "7.0 WvHiCOffS", "1.2 WvHiCOffS",
             "(WvDiffQTF, WvSumQTF): its cut-offs leave out pairs of the spectrum's peak"},
        Case{"sea.dat", "True WvSumQTF", "False WvSumQTF", "(WvDiffQTF): a scene has those at sums and differences together"},
        Case{"sea.dat", "True WvDiffQTF", "False WvDiffQTF", "(WvSumQTF): a scene has"},
        Case{"sea.dat", "2 WaveMod", "1 WaveMod", "waves of WaveMod 1 have none in the scene"},
        Case{"hd.dat", "0 PotMod", "1 PotMod", "the sea is potential flow"},
        Case{"sea.dat", "True WvDiffQTF", "1 WaveDirMod\n2 WaveDirSpread\n90 WaveDirRange\nTrue WvDiffQTF",
             "the sea is short-crested"}}) {
    CAPTURE(c.to);
    const auto [bound, left_out] = with(c.file, c.from, c.to);
    CHECK_FALSE(bound);
    CHECK(has_word(left_out, c.said));
  }
  for (const auto& [from, to] : {std::pair{"7.0 WvHiCOffS", "-7.0 WvHiCOffS"}, std::pair{"True WvSumQTF", "maybe WvSumQTF"}}) {
    SmallDeck other = deck;
    other.replace("sea.dat", from, to);
    CHECK(other.refusal().find("sea.dat:") != std::string::npos);
  }
}

TEST_CASE("an elevation in time of the deck is the scene's sea", "[import][fast]") {
  SmallDeck deck;
  deck.replace("sea.dat", "1 WaveMod", "5 WaveMod\n\"measured\" WvKinFile");
  std::string record = "! elevation\nTime Elev\n(s) (m)\n";
  for (int i = 0; i < 200; ++i) record += std::to_string(0.5 * i) + " " + std::to_string(std::sin(2.0 * pi * i / 20.0)) + "\n";
  deck.files["measured.Elev"] = record;
  const coupling::Scenario s = deck.scenario();
  CHECK(s.waves.model == "elevation");
  CHECK(s.waves.file.ends_with("elevation.csv"));
  CHECK(s.waves.direction == Approx(30.0 * radians_per_degree));
}

TEST_CASE("settings of HydroDyn and SeaState that the scene has not are told, and waves reach the surface as in the deck",
          "[import][fast]") {
  SmallDeck deck;
  const std::vector<std::string> plain = deck.import().left_out;
  for (const char* word : {"AxCp", "SimplCp", "AxFDMod", "AxVnCOff", "ExctnDisp", "ExctnMod", "WaveStMod"})
    CHECK_FALSE(has_word(plain, word));
  for (const auto& [number, way] : {std::pair{"1", "vertical"}, std::pair{"2", "extrapolated"}, std::pair{"3", "wheeler"}}) {
    SmallDeck stretched;
    stretched.files["sea.dat"] += std::string(number) + " WaveStMod\n";
    CHECK(stretched.scenario().waves.stretching == way);
    CHECK_FALSE(has_word(stretched.import().left_out, "WaveStMod"));
  }
  deck.files["sea.dat"] += "0 WaveStMod\n";
  deck.replace("hd.dat", "1 NBody", "1 ExctnMod\n2 ExctnDisp\n1 NBody");
  deck.replace("hd.dat", "AxCp\n(-) (-) (-) (-)\n1 0.5 0 1\n",
               "AxCp AxFDMod AxVnCOff AxFDLoFSc\n(-) (-) (-) (-) (-) (Hz) (-)\n"
               "1 0.5 0 0 1 0.1 0.5\n");
  deck.replace("hd.dat", "SimplCaMG\n(-) (-) (-) (-)\n0.7 0 0.9 0\n",
               "SimplCaMG SimplCp SimplCpMG\n(-) (-) (-) (-) (-) (-)\n"
               "0.7 0 0.9 0 0 0\n");
  for (const char* word : {"ExctnDisp 2", "WaveStMod 0", "AxFDMod 1", "AxVnCOff"}) CHECK(has_word(deck.import().left_out, word));
  CHECK_FALSE(has_word(deck.import().left_out, "Cp"));  // strips have drag alone
  deck.replace("hd.dat", "1 PotMod", "0 PotMod");
  for (const char* word : {"AxCp 0", "SimplCp 0"}) CHECK(has_word(deck.import().left_out, word));
}

TEST_CASE("a deck without excitation has none in the scene, and members that nothing lifts are refused", "[import][fast]") {
  SmallDeck deck;
  deck.replace("hd.dat", "1 NBody", "0 ExctnMod\n1 NBody");
  const coupling::Scenario s = deck.scenario();
  CHECK(s.sea.potential->excitation_file.find("no_excitation.3") != std::string::npos);
  CHECK(sea::read_excitation(s.sea.potential->excitation_file, {}).at(0.7, 0.5).norm() == 0.0);
  deck.replace("hd.dat", "MCoefMod PropPot\n(-) (-) (-) (-) (-) (m) (-) (-)\n1 1 2 1 1 4 1 TRUE",
               "MCoefMod MHstLMod PropPot\n(-) (-) (-) (-) (-) (m) (-) (-) (-)\n1 1 2 1 1 4 1 0 TRUE");
  deck.replace("hd.dat", "2 2 3 1 2 4 1 TRUE", "2 2 3 1 2 4 1 1 TRUE");
  CHECK(deck.refusal().empty());
  deck.replace("hd.dat", "1 PotMod", "0 PotMod");
  CHECK_THAT(deck.refusal(), Catch::Contains("MHstLMod 0"));
}

TEST_CASE("loads that HydroDyn adds to potential flow are left out without it", "[import][fast]") {
  SmallDeck deck;
  deck.replace("hd.dat", "0 AddF0", "1e6 AddF0");
  CHECK(deck.scenario().sea.matrices.size() == 1);
  CHECK_FALSE(has_word(deck.import().left_out, "AddF0"));
  deck.replace("hd.dat", "1 PotMod", "0 PotMod");
  CHECK(deck.scenario().sea.matrices.empty());
  CHECK(has_word(deck.import().left_out, "AddF0"));
}

TEST_CASE("a deck's drift and sum frequencies are the scene's", "[import][fast]") {
  const auto [line, drift, ending] = GENERATE(table<std::string, std::string, std::string>({{"0 MnDrift", "mean", ".8"},
                                                                                            {"0 NewmanApp", "newman", ".12d"},
                                                                                            {"0 DiffQTF", "full", ".12d"},
                                                                                            {"0 SumQTF", "none", ".12s"}}));
  SmallDeck deck;
  deck.replace("hd.dat", line, (ending == ".8" ? "8" : "12") + line.substr(1));
  deck.files["wamit/spar.8"] = "20 0 0 1 1 0 0.1 0\n5 0 0 1 1 0 0.2 0\n";
  deck.files["wamit/spar.12d"] = deck.files["wamit/spar.12s"] =
      "20 20 0 0 1 1 0 0.1 0\n20 5 0 0 1 1 0 0.1 0.1\n5 5 0 0 1 1 0 0.2 0\n";
  const coupling::Scenario s = deck.scenario();
  CHECK(s.sea.potential->drift == drift);
  const std::string& file = drift == "none" ? s.sea.potential->sum_frequency_file : s.sea.potential->drift_file;
  CHECK(file.substr(file.size() - ending.size()) == ending);
  deck.replace("hd.dat", (ending == ".8" ? "8" : "12") + line.substr(1), "5" + line.substr(1));
  CHECK(deck.refusal().find("hd.dat:") != std::string::npos);
}
