// A small deck of our own: a spar of two members with a three-bladed rotor, WAMIT files and two lines, written here in the
// layouts of OpenFAST, and what becomes of it. SPDX-License-Identifier: Apache-2.0
#include "src/import/openfast.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <catch2/catch.hpp>

#include <unistd.h>

#include <fstream>
#include <map>
#include <sstream>

#include "kernels/base/constants.hpp"
#include "src/aero/flexible_blades.hpp"
#include "src/aero/turbine.hpp"
#include "src/bodies/linearise.hpp"
#include "src/coupling/floating_system.hpp"
#include "src/coupling/start.hpp"
#include "src/import/openfast_parts.hpp"
#include "src/scene/document.hpp"
#include "src/scene/error.hpp"
#include "src/sea/wamit.hpp"

using namespace spindrift;

namespace {

/// The deck in a folder of this process; files can be changed before it is imported.
struct SmallDeck {
  std::filesystem::path folder = std::filesystem::temp_directory_path() / ("spindrift_import_" + std::to_string(getpid()));
  std::map<std::string, std::string> files;

  SmallDeck() {
    files["main.fst"] =
        "------ OpenFAST INPUT FILE ------\nsmall\n\"FATAL\" AbortLevel - x\n100 TMax - s\n0.01 DT\n1 CompElast\n1 CompInflow\n2 "
        "CompAero\n"
        "0 CompServo\n1 CompSeaSt\n1 CompHydro\n0 CompSub\n1 CompMooring\n0 CompIce\n9.80665 Gravity\n1.225 AirDens\n1025 "
        "WtrDens\n"
        "200 WtrDpth\n0 MSL2SWL\n\"srv.dat\" ServoFile\n\"ed.dat\" EDFile\n\"ifw.dat\" InflowFile\n\"ad.dat\" "
        "AeroFile\n\"sea.dat\" "
        "SeaStFile\n\"hd.dat\" HydroFile\n"
        "\"map.dat\" MooringFile\n";
    files["ed.dat"] =
        "--- ElastoDyn\nFalse FlapDOF1\nFalse TwFADOF1\nFalse GenDOF\nTrue PtfmSgDOF\nTrue PtfmSwDOF\nTrue PtfmHvDOF\nTrue "
        "PtfmRDOF\n"
        "True PtfmPDOF\nTrue PtfmYDOF\n3 BlPitch(1)\n3 BlPitch(2)\n3 BlPitch(3)\n10 RotSpeed\n2 PtfmHeave\n5 PtfmPitch\n3 "
        "NumBl\n40 TipRad\n"
        "2 HubRad\n-3 PreCone(1)\n-3 PreCone(2)\n-3 PreCone(3)\n0 HubCM\n-4 OverHang\n-6 ShftTilt\n1 NacCMxn\n0 NacCMyn\n1 "
        "NacCMzn\n"
        "2 Twr2Shft\n60 TowerHt\n10 TowerBsHt\n-50 PtfmCMzt\n0 TipMass(1)\n0 TipMass(2)\n0 TipMass(3)\n20000 HubMass\n50000 "
        "HubIner\n"
        "100 GenIner\n100000 NacMass\n500000 NacYIner\n3000000 PtfmMass\n2e9 PtfmRIner\n2e9 PtfmPIner\n5e7 PtfmYIner\n"
        "\"blade.dat\" BldFile(1)\n\"blade.dat\" BldFile(2)\n\"blade.dat\" BldFile(3)\n50 GBRatio\n\"tower.dat\" TwrFile\n";
    files["srv.dat"] =
        "---\n0 PCMode\n0 VSContrl\n95 GenEff\n100 HSSBrTqF\n\"lib.so\" DLL_FileName\n\"DISCON.IN\" DLL_InFile\n\"DISCON\" "
        "DLL_ProcName\n"
        "0.025 DLL_DT\n1 Ptch_Cntrl\n90 Ptch_Max\n8 PtchRate_Max\n2.3 Gain_OM\n1200 GenSpd_Dem\n0 DLL_NumTrq\n";
    files["blade.dat"] =
        "--- BLADE\n2 NBlInpSt\n1.0 AdjBlMs\nBlFract StrcTwst BMassDen FlpStff EdgStff\n(-) (deg) (kg/m) (Nm^2) (Nm^2)\n"
        "0 0 300 1 1\n1 0 100 1 1\n";
    files["tower.dat"] =
        "--- TOWER\n2 NTwInpSt\n1.0 AdjTwMa\nHtFract TMassDen TwFAStif TwSSStif\n(-) (kg/m) (Nm^2) (Nm^2)\n0 4000 1 1\n1 2000 1 "
        "1\n";
    files["ifw.dat"] = "---\n1 WindType\n0 PropagationDir\n9.0 HWindSpeed\n62 RefHt\n0.1 PLexp\n";
    files["ad.dat"] =
        "---\n1 Wake_Mod\n0 TwrPotent\n0 TwrShadow\nFalse TwrAero\n0 UA_Mod\n1 InCol_Alfa\n2 InCol_Cl\n3 InCol_Cd\n4 InCol_Cm\n"
        "2 NumAFfiles\n\"root.dat\" AFNames\n\"foil.dat\"\n\"adblade.dat\" ADBlFile(1)\n\"adblade.dat\" ADBlFile(2)\n"
        "\"adblade.dat\" ADBlFile(3)\n";
    files["adblade.dat"] =
        "---\n===\n4 NumBlNds\nBlSpn BlCrvAC BlSwpAC BlCrvAng BlTwist BlChord BlAFID\n(m) (m) (m) (deg) (deg) (m) (-)\n"
        "0 0 0 0 12 2.5 1\n10 0.1 0 0 10 3 2\n25 0.5 0 0 4 2.5 2\n38 1.0 0.2 0 0 1 2\n";
    files["root.dat"] = "! a cylinder\n1 NumTabs\n3 NumAlf\n! Alpha Cl Cd Cm\n-180 0 0.5 0\n0 0 0.5 0\n180 0 0.5 0\n";
    files["foil.dat"] =
        "! a flat plate\n1 NumTabs\n5 NumAlf\n! Alpha Cl Cd Cm\n! (deg) (-) (-) (-)\n-180 0 0.02 0\n-15 -1.2 0.1 0\n0 0.3 0.01 "
        "0\n"
        "15 1.4 0.1 0\n180 0 0.02 0\n";
    files["sea.dat"] = "---\n1 WaveMod\n2.5 WaveHs\n9 WaveTp\n30 WaveDir\n0 CurrMod\n";
    files["hd.dat"] =
        "---\n1 PotMod\n1 RdtnMod\n30 RdtnTMax\n1 NBody\n\"wamit/spar\" PotFile\n1 WAMITULEN\n4000 PtfmVol0\n0 PtfmCOBxt\n0 "
        "PtfmCOByt\n"
        "0 MnDrift\n0 NewmanApp\n0 DiffQTF\n0 SumQTF\n0 AddF0\n0\n0\n0\n0\n0\n0 0 0 0 0 0 AddCLin\n0 0 0 0 0 0\n0 0 0 0 0 0\n0 0 "
        "0 0 0 0\n"
        "0 0 0 0 0 0\n0 0 0 0 0 5e7\n1e4 0 0 0 0 0 AddBLin\n0 1e4 0 0 0 0\n0 0 2e4 0 0 0\n0 0 0 0 0 0\n0 0 0 0 0 0\n0 0 0 0 0 "
        "1e6\n"
        "0 0 0 0 0 0 AddBQuad\n0 0 0 0 0 0\n0 0 0 0 0 0\n0 0 0 0 0 0\n0 0 0 0 0 0\n0 0 0 0 0 0\n1 NAxCoef\nAxCoefID AxCd AxCa "
        "AxCp\n(-) (-) (-) (-)\n"
        "1 0.5 0 1\n3 NJoints\nJointID Jointxi Jointyi Jointzi JointAxID JointOvrlp\n(-) (m) (m) (m) (-) (-)\n1 0 0 -80 1 0\n2 0 "
        "0 -5 1 0\n3 0 0 10 1 0\n"
        "2 NPropSets\nPropSetID PropD PropThck\n(-) (m) (m)\n1 8 0.01\n2 6 0.01\n\nSimplCd SimplCdMG SimplCa SimplCaMG\n(-) (-) "
        "(-) (-)\n0.7 0 0.9 0\n"
        "2 NMembers\nMemberID MJointID1 MJointID2 MPropSetID1 MPropSetID2 MDivSize MCoefMod PropPot\n(-) (-) (-) (-) (-) (m) (-) "
        "(-)\n"
        "1 1 2 1 1 4 1 TRUE\n2 2 3 1 2 4 1 TRUE\n";
    files["wamit/spar.1"] = "-1 1 1 4000\n0 1 1 3900\n0 3 3 120\n20 1 1 4100 10\n20 3 3 120 1\n5 1 1 3800 200\n5 3 3 120 2\n";
    files["wamit/spar.3"] = "20 0 1 1 0 1 0\n20 90 1 1 0 1 0\n5 0 1 1 0 2 0\n5 90 1 1 0 2 0\n";
    files["wamit/spar.hst"] = "3 3 28.27\n4 4 -90000\n5 5 -90000\n";
    files["map.dat"] =
        "--- LINE DICTIONARY ---\nLineType Diam MassDenInAir EA CB CIntDamp Ca Cdn Cdt\n(-) (m) (kg/m) (N) (-) (Pa-s) (-) (-) "
        "(-)\n"
        "chain 0.1 100 4e8 0.5 1 1 1 1\n--- NODE PROPERTIES ---\nNode Type X Y Z M B FX FY FZ\n(-) (-) (m) (m) (m) (kg) (mB) (N) "
        "(N) (N)\n"
        "1 fix 500 0 depth 0 0 # # #\n2 Vessel 4 0 -30 0 0 # # #\n--- LINE PROPERTIES ---\nLine LineType UnstrLen NodeAnch "
        "NodeFair Flags\n"
        "(-) (-) (m) (-) (-) (-)\n1 chain 540 1 2 plot\n--- SOLVER OPTIONS ---\nOption\n(-)\nrepeat 120 240\n";
  }
  ~SmallDeck() { std::filesystem::remove_all(folder); }

  void replace(const std::string& file, const std::string& from, const std::string& to) {
    std::string& text = files[file];
    REQUIRE(text.find(from) != std::string::npos);
    text.replace(text.find(from), from.size(), to);
  }
  /// Pitch and torque are those of a library.
  void turn_by_library() {
    replace("main.fst", "0 CompServo", "1 CompServo");
    replace("ed.dat", "False GenDOF", "True GenDOF");
    replace("srv.dat", "0 PCMode\n0 VSContrl", "5 PCMode\n5 VSContrl");
    files["lib.so"] = "none", files["DISCON.IN"] = "1.0";
  }
  decks::Imported import(decks::ImportedTower tower = decks::ImportedTower::as_in_deck,
                         decks::ImportedLines lines = decks::ImportedLines::as_in_deck) const {
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder / "deck/wamit");
    for (const auto& [name, text] : files) std::ofstream(folder / "deck" / name) << text;
    return decks::import_openfast(folder / "deck/main.fst", folder / "scene", tower, decks::ImportedBlades::as_in_deck, lines);
  }
  coupling::Scenario scenario(decks::ImportedTower tower = decks::ImportedTower::as_in_deck,
                              decks::ImportedLines lines = decks::ImportedLines::as_in_deck) const {
    scene::Document document = scene::load(import(tower, lines).scene.string());
    return coupling::read_scenario(document);
  }
  std::string refusal() const {
    try {
      import();
    } catch (const scene::SceneError& e) { return e.what(); }
    return "";
  }
};

bool has_word(const std::vector<std::string>& sentences, const std::string& word) {
  return std::ranges::any_of(sentences, [&](const std::string& s) { return s.find(word) != std::string::npos; });
}

}  // namespace

TEST_CASE("the deck's platform, rotor, water, lines and waves are the scene's", "[import][fast]") {
  const SmallDeck deck;
  const coupling::Scenario s = deck.scenario();
  REQUIRE(s.bodies.size() == 1);
  const bodies::BodyOptions& body = s.bodies[0].options;
  const double blade = 38.0 * 200.0, tower = 50.0 * 3000.0;
  CHECK(body.mass_kg == Approx(3e6 + tower + 1e5 + 2e4 + 3.0 * blade));
  // The tower's centre is 4/9 of its length up: density falls from 4000 to 2000 kg/m.
  const double hub_height = 60.0 + 2.0 + 4.0 * std::sin(6.0 * radians_per_degree);
  const double moment = 3e6 * -50.0 + tower * (10.0 + 50.0 * 4.0 / 9.0) + 1e5 * 61.0 + 2e4 * hub_height;
  CHECK(body.centre_m.z() == Approx((moment + 3.0 * blade * hub_height) / body.mass_kg).margin(0.1));
  CHECK(body.displacement_m.z() == 2.0);
  CHECK(body.rotation.y() == Approx(5.0 * radians_per_degree));
  CHECK(s.rotor.hub_m.z() == Approx(hub_height));
  CHECK(s.rotor.axis.z() == Approx(-std::sin(6.0 * radians_per_degree)));
  CHECK(s.rotor.speed == Approx(10.0 * rad_s_per_rpm));
  CHECK(s.rotor.blade_pitch == Approx(3.0 * radians_per_degree));
  const aero::Planform planform = aero::read_turbine(s.rotor.turbine).planform;
  CHECK(planform.prebend.back() == 1.0);
  CHECK(planform.sweep.back() == -0.2);  // BlSwpAC is positive against the rotation, sweep_m with it
  CHECK(s.wind.speed_m_s == 9.0);
  CHECK(s.wind.shear_exponent == 0.1);
  CHECK(s.sea.model == "potential");
  CHECK(s.sea.drag_coefficient == 0.7);
  CHECK(s.sea.axial_drag_coefficient == 0.25);  // AxCd counts a quarter of density times area, ours a half
  CHECK(s.sea.matrices.at(0).stiffness.at(5)[5] == 5e7);
  CHECK(s.sea.matrices.at(0).damping.at(2)[2] == 2e4);
  CHECK(body.cylinders.at(1).end_diameter_m.value() == 6.0);
  CHECK(s.waves.model == "airy");
  CHECK(s.waves.ramp_s == 0.0);
  CHECK(s.waves.direction == Approx(30.0 * radians_per_degree));
  REQUIRE(s.moorings.size() == 3);
  const moorings::LineOptions& line = s.moorings[1].options;
  CHECK(line.weight_N_m == Approx(9.80665 * (100.0 - 1025.0 * 0.25 * pi * 0.01)));
  CHECK(line.anchor_m->x() == Approx(500.0 * std::cos(120.0 * radians_per_degree)));
  CHECK(line.anchor_m->z() == -200.0);
}

TEST_CASE("a scene may stand in the folder of its deck", "[import][fast]") {
  SmallDeck deck;
  deck.replace("hd.dat", "wamit/spar", "spar");
  for (const char* ending : {".1", ".3", ".hst"})
    deck.files[std::string("spar") + ending] = deck.files[std::string("wamit/spar") + ending];
  deck.import();
  const std::filesystem::path folder = deck.folder / "deck";
  CHECK(std::filesystem::exists(decks::import_openfast(folder / "main.fst", folder).scene));
  CHECK(std::filesystem::file_size(folder / "spar.1") == deck.files["spar.1"].size());
}

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

TEST_CASE("an imported scene is a turbine that stands and moves", "[import][fast]") {
  const SmallDeck deck;
  coupling::FloatingSystem floating(deck.scenario());
  coupling::Start start = make_start(floating);
  REQUIRE(floating.rotor());
  for (int n = 0; n < 20; ++n) REQUIRE(floating.multibody().advance(start.state, floating.timeline().tick_s(), 1).ok());
}

namespace {

/// The small deck with a tower that bends.
SmallDeck deck_that_bends() {
  SmallDeck deck;
  deck.replace("ed.dat", "False TwFADOF1", "True TwFADOF1\nTrue TwFADOF2\nTrue TwSSDOF1\nTrue TwSSDOF2");
  deck.replace(
      "tower.dat", "1.0 AdjTwMa",
      "1.0 AdjTwMa\n1.0 TwrFADmp(1)\n2.0 TwrFADmp(2)\n1.0 TwrSSDmp(1)\n2.0 TwrSSDmp(2)\n2.0 AdjFASt\n0.5 FAStTunr(1)\n0.5 "
      "FAStTunr(2)");
  for (const char* plane : {"FA", "SS"})  // h2, and 3 h3 - 2 h2
    for (int mode = 1; mode <= 2; ++mode)
      for (int power = 2; power <= 6; ++power) {
        const int value = mode == 1 ? (power == 2) : power == 2 ? -2 : power == 3 ? 3 : 0;
        deck.files["tower.dat"] += fmt::format("{} Tw{}M{}Sh({})\n", value, plane, mode, power);
      }
  deck.replace("tower.dat", "0 4000 1 1", "0 4000 3e11 4e11");
  deck.replace("tower.dat", "1 2000 1 1", "1 2000 1e11 2e11");
  return deck;
}

}  // namespace

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

TEST_CASE("what the scene cannot say is told", "[import][fast]") {
  SmallDeck deck;
  deck.replace("ed.dat", "False FlapDOF1", "False FlapDOF1\nTrue YawDOF");
  deck.replace("ad.dat", "0 UA_Mod", "3 UA_Mod");
  deck.replace("main.fst", "0 CompServo", "1 CompServo");
  std::string all;
  for (const std::string& what : deck.import().left_out) all += what + "\n";
  for (const char* word :
       {"motion of yaw bearing and teeter", "the dynamic stall model of UA_Mod 3 has", "ServoDyn (GenDOF is off)"})
    CHECK(all.find(word) != std::string::npos);
  std::ostringstream scene;
  scene << std::ifstream(deck.folder / "scene/scene.toml").rdbuf();
  CHECK(scene.str().find("# - motion of yaw bearing") != std::string::npos);
  SmallDeck smooth, vortex;
  smooth.replace("ad.dat", "0 UA_Mod", "4 UA_Mod");
  vortex.replace("ad.dat", "0 UA_Mod", "5 UA_Mod");
  CHECK(has_word(smooth.import().left_out, "UA_Mod 4 has no vortex from the leading edge"));
  CHECK(has_word(vortex.import().left_out, "UA_Mod 5 has beside"));
}

TEST_CASE("settings of a deck that the scene has not, and that change its loads, are told", "[import][fast]") {
  struct Setting {
    const char *file, *line, *told;
  };
  for (const auto& [file, line, told] :
       {Setting{"ad.dat", "0 Skew_Mod", "SkewMod 0"}, Setting{"ad.dat", "1 AFAeroMod\n1 SkewMod", "SkewMod 1"},
        Setting{"ad.dat", "1 Skew_Mod\n0 SkewRedistr_Mod", "SkewMod 1"}, Setting{"ad.dat", "True SkewMomCorr", "SkewMomCorr"},
        Setting{"ad.dat", "0.7 SkewModFactor", "SkewModFactor 0.7"}, Setting{"ad.dat", "False TipLoss", "TipLoss"},
        Setting{"ad.dat", "False HubLoss", "HubLoss"}, Setting{"ad.dat", "False TanInd", "TanInd"},
        Setting{"ad.dat", "False AIDrag", "AIDrag"}, Setting{"ad.dat", "False TIDrag", "TIDrag"},
        Setting{"ad.dat", "-1 DBEMT_Mod", "DBEMT_Mod -1"}, Setting{"ad.dat", "2 BEM_Mod", "BEM_Mod 2"},
        Setting{"ad.dat", "True SectAvg", "SectAvg"}, Setting{"ed.dat", "90 AzimB1Up", "AzimB1Up"}}) {
    SmallDeck deck;
    INFO(line);
    CHECK_FALSE(has_word(deck.import().left_out, told));
    deck.files[file] += std::string(line) + "\n";
    CHECK(has_word(deck.import().left_out, told));
  }
  SmallDeck same;
  same.files["ad.dat"] +=
      "1 AFAeroMod\n2 SkewMod\n\"default\" SkewModFactor\nTrue TipLoss\nTrue HubLoss\nTrue TanInd\n0 DBEMT_Mod\n"
      "1 BEM_Mod\nFalse SectAvg\n";
  for (const char* word : {"Skew", "Loss", "TanInd", "DBEMT_Mod", "BEM_Mod", "SectAvg"})
    CHECK_FALSE(has_word(same.import().left_out, word));
  same.replace("ed.dat", "3 BlPitch(3)", "5 BlPitch(3)");
  CHECK(has_word(same.import().left_out, "BlPitch(3)"));
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

TEST_CASE("loads that HydroDyn adds to potential flow are left out without it", "[import][fast]") {
  SmallDeck deck;
  deck.replace("hd.dat", "0 AddF0", "1e6 AddF0");
  CHECK(deck.scenario().sea.matrices.size() == 1);
  CHECK_FALSE(has_word(deck.import().left_out, "AddF0"));
  deck.replace("hd.dat", "1 PotMod", "0 PotMod");
  CHECK(deck.scenario().sea.matrices.empty());
  CHECK(has_word(deck.import().left_out, "AddF0"));
}

TEST_CASE("what a deck has and no scene is named, or refused where it turns the rotor round", "[import][fast]") {
  SmallDeck deck;
  deck.replace("ed.dat", "2 HubRad",
               "2 HubRad\n0.5 OoPDefl\n---------------------- FURLING ----------------------\nTrue Furling");
  deck.replace("ed.dat", "-3 PreCone(2)", "-4 PreCone(2)");
  deck.replace("ad.dat", "False TwrAero", "False TwrAero\nTrue TFinAero");
  deck.replace("sea.dat", "0 CurrMod", "0 CurrMod\nTrue WaveNDAmp");
  deck.replace("main.fst", "0 CompServo", "1 CompServo");
  deck.replace("srv.dat", "0 PCMode", "0 PCMode\n50 TimGenOf\n9999.9 TYawManS");
  const std::vector<std::string> left_out = deck.import().left_out;
  for (const char* what : {"OoPDefl 0.5", "Furling", "PreCone(2)", "TFinAero", "WaveNDAmp", "TimGenOf"}) {
    CAPTURE(what);
    CHECK(has_word(left_out, what));
  }
  CHECK_FALSE(has_word(left_out, "TYawManS"));
  for (const char* key : {"2 NRotors", "True MirrorRotor"}) {
    SmallDeck other;
    other.replace("main.fst", "100 TMax - s", std::string("100 TMax - s\n") + key);
    CHECK(other.refusal().find(std::string(key).substr(std::string(key).find(' ') + 1)) != std::string::npos);
  }
  // Viscosity and speed of sound are AeroDyn's, and a title is no key.
  SmallDeck still;
  still.replace("main.fst", "2 CompAero", "0 CompAero");
  still.replace("main.fst", "1.225 AirDens", "0 AirDens\n0 KinVisc\n0 SpdSound");
  still.replace("main.fst", "INPUT FILE ------\nsmall\n", "INPUT FILE ------\nFloating MHK turbine\n");
  CHECK(still.refusal() == "");
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

TEST_CASE("a controller library of a deck is the scene's, with its drive train and its numbers", "[import][fast]") {
  SmallDeck deck;
  deck.turn_by_library();
  const decks::Imported imported = deck.import();
  scene::Document document = scene::load(imported.scene.string(), {"control.library='" SPINDRIFT_TEST_CONTROLLER "'"});
  const coupling::Scenario s = coupling::read_scenario(document);
  REQUIRE(s.control.model == aero::ControlModel::library);
  CHECK(s.control.input_file == (deck.folder / "deck/DISCON.IN").string());
  CHECK(s.control.individual_pitch);
  CHECK(s.time.step_s.value() == 0.025);
  const aero::DriveTrainOptions& drive = *s.control.drive_train;
  CHECK((drive.gear_ratio == 50.0 && drive.generator_efficiency == 0.95 && drive.brake_torque_N_m == 5000.0));
  CHECK(drive.generator_inertia_kg_m2 == 100.0 * 50.0 * 50.0);
  CHECK(drive.rotor_inertia_kg_m2 > 50000.0);
  CHECK(drive.max_pitch_rate == Approx(8.0 * radians_per_degree));
  // About the shaft the body has nothing of the rotor, which does not follow it there.
  const Eigen::Matrix3d off = SmallDeck().scenario().bodies[0].options.inertia_kg_m2 - s.bodies[0].options.inertia_kg_m2,
                        turning = drive.rotor_inertia_kg_m2 * s.rotor.axis * s.rotor.axis.transpose();
  CHECK((off - turning).norm() < 1e-6 * turning.norm());
  const auto record = [&](int number) {
    for (const aero::RecordOptions& r : s.control.records)
      if (r.record == number) return r.value;
    return 0.0;
  };
  CHECK(record(7) == Approx(0.5 * pi));
  CHECK(record(16) == 2.3);
  CHECK(record(19) == Approx(1200.0 * rad_s_per_rpm));
  CHECK(!drive.shaft_stiffness_N_m_rad);
  deck.replace("ed.dat", "True GenDOF", "True GenDOF\nTrue DrTrDOF\n8.7e8 DTTorSpr\n6.2e6 DTTorDmp");
  const decks::Imported twisting = deck.import();
  scene::Document again = scene::load(twisting.scene.string(), {"control.library='" SPINDRIFT_TEST_CONTROLLER "'"});
  const aero::DriveTrainOptions shaft = *coupling::read_scenario(again).control.drive_train;
  CHECK((shaft.shaft_stiffness_N_m_rad == 8.7e8 && shaft.shaft_damping_N_m_s_rad == 6.2e6));
  deck.replace("srv.dat", "lib.so", "other.dll");
  std::string all;
  for (const std::string& what : deck.import().left_out) all += what + "\n";
  CHECK(all.find("other.dll is not there") != std::string::npos);
  deck.replace("srv.dat", "other.dll", "lib.so");
  deck.replace("srv.dat", "\"DISCON.IN\" DLL_InFile", "\"none.in\" DLL_InFile");
  all.clear();
  for (const std::string& what : deck.import().left_out) all += what + "\n";
  CHECK(all.find("none.in is not there") != std::string::npos);
  deck.replace("srv.dat", "90 Ptch_Max", "wide Ptch_Max");
  CHECK(deck.refusal().find("srv.dat:11") != std::string::npos);
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

namespace {

/// Line files with a bridle; words in place of others, and what must be said.
struct Fault {
  std::string from, to, said;
};
const std::vector<Fault> moordyn_faults = {
    {"--- LINE TYPES", "--- TYPES", "has no section"},
    {"---- POINTS", "---- PLACES", "has no section"},
    {"---- LINES", "---- ROPES", "has no section"},
    {"BA/-zeta", "damping", ":2"},
    {" CdAx", " axial", ":2"},
    {"chain 0.1 100", "chain wide 100", ":4"},
    {"chain 0.1 100", "chain -0.1 100", ":4"},
    {"100 4e8 -1", "100 4e8|2e8 -1", ":4"},
    {"4e8 -1 0 1 1 0 0", "4e8 -1 0 1 1 0", ":4"},
    {"4e8 -1 0 1 1 0 0", "4e8 -1 0 -1 1 0 0", ":4"},
    {"0 1 1 0 0\n", "0 1 1 0 0\nchain 0.1 100 4e8 -1 0 1 1 0 0\n", ":5"},
    {"Attachment X Y Z M V CdA CA", "Attachment X Y Z M V CA", ":6"},
    {"1 Fixed 500", "1 Fixed far", ":8"},
    {" X Y Z M V CdA CA\n(#) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)\n1 Fixed 500 0 -200 0 0 0 0", "\n(#) (-)\n1 Fixed", ":8"},
    {"2 Vessel 4 0 -30", "2 Vessel 4 0", ":9"},
    {"2 Vessel", "1 Vessel", ":9"},
    {"-60 1000 0.5", "-60 -1000 0.5", ":10"},
    {"1000 0.5 2.5 0.7", "1000 0.5 2.5", ":10"},
    {"1000 0.5 2.5 0.7", "1000 0.5 inf 0.7", ":10"},
    {"ID LineType AttachA", "ID LineType From", ":12"},
    {"1 chain 1 3 490 20", "1 rope 1 3 490 20", ":14"},
    {"1 chain 1 3 490 20", "1 chain 1 9 490 20", ":14"},
    {"1 chain 1 3 490 20", "1 chain 3 3 490 20", ":14"},
    {"1 chain 1 3 490 20", "1 chain 1 3 -490 20", ":14"},
    {"1 chain 1 3 490 20", "1 chain 1 3 490 2.5", ":14"},
    {"1 chain 1 3 490 20", "1 chain 1 3 490 0", ":14"},
    {"2 chain 3 2 56 5 -", "2 chain 3 2 56", ":15"},
    {"3e6 kBot", "stiff kBot", ":17"},
};
const std::vector<Fault> map_faults = {
    {"LineType Diam", "Type Diam", "LineType"},
    {"Node Type", "Nodes Type", "Node"},
    {"Line LineType", "Lines LineType", "Line"},
    {"chain 0.1 100", "chain wide 100", ":4"},
    {"chain 0.1 100", "chain -0.1 100", ":4"},
    {"chain 0.1 100", "chain 0.1 -100", ":4"},
    {"100 4e8 0.5", "100 nan 0.5", ":4"},
    {"4e8 0.5 1 1 1 1", "4e8", ":4"},
    {"4e8 0.5 1 1 1 1", "4e8 0.5 one 1 1 1", ":4"},
    {"0.5 1 1 1 1\n", "0.5 1 1 1 1\nchain 0.1 100 4e8 0.5 1 1 1 1\n", ":5"},
    {"1 fix 500 0 depth", "1 fix 500 0 deep", ":8"},
    {"1 fix 500 0 depth", "1 fix # 0 depth", ":8"},
    {"2 Vessel 4 0 -30", "2 Vessel 4 0", ":9"},
    {"2 Vessel", "1 Vessel", ":9"},
    {"#-60 1000 0.5", "#-60 -1000 0.5", ":10"},
    {"#-60 1000 0.5", "#-60 1000 -0.5", ":10"},
    {"#-60 1000 0.5", "#low 1000 0.5", ":10"},
    {"1 chain 490 1 3", "1 rope 490 1 3", ":14"},
    {"1 chain 490 1 3", "1 chain 490 1 9", ":14"},
    {"1 chain 490 1 3", "1 chain 490 3 3", ":14"},
    {"1 chain 490 1 3", "1 chain 0 1 3", ":14"},
    {"1 chain 490 1 3", "1 chain 1e999 1 3", ":14"},
    {"Node Type X Y Z M B FX FY FZ\n(-) (-) (m) (m) (m) (kg) (mB) (N) (N) (N)\n1 fix 500 0 depth 0 0 # # #", "Node\n(-)\n1",
     ":8"},
    {"2 chain 56 3 2", "2 chain 56", ":15"},
    {"repeat 120 240", "repeat 120 twice", ":19"},
};
const std::string moordyn_bridle =
    "--- LINE TYPES ---\nName Diam MassDen EA BA/-zeta EI Cd Ca CdAx CaAx\n(-) (m) (kg/m) (N) (N-s/-) (-) (-) (-) (-) (-)\n"
    "chain 0.1 100 4e8 -1 0 1 1 0 0\n---- POINTS ----\nID Attachment X Y Z M V CdA CA\n(#) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)\n"
    "1 Fixed 500 0 -200 0 0 0 0\n2 Vessel 4 0 -30 0 0 0 0\n3 Free 50 0 -60 1000 0.5 2.5 0.7\n---- LINES ----\n"
    "ID LineType AttachA AttachB UnstrLen NumSegs Outputs\n(#) (name) (#) (#) (m) (-) (-)\n1 chain 1 3 490 20 -\n2 chain 3 2 56 "
    "5 -\n"
    "---- OPTIONS ----\n3e6 kBot\n";
const std::string map_bridle =
    "--- LINE DICTIONARY ---\nLineType Diam MassDenInAir EA CB CIntDamp Ca Cdn Cdt\n(-) (m) (kg/m) (N) (-) (Pa-s) (-) (-) (-)\n"
    "chain 0.1 100 4e8 0.5 1 1 1 1\n--- NODE PROPERTIES ---\nNode Type X Y Z M B FX FY FZ\n(-) (-) (m) (m) (m) (kg) (mB) (N) (N) "
    "(N)\n"
    "1 fix 500 0 depth 0 0 # # #\n2 Vessel 4 0 -30 0 0 # # #\n3 Connect #50 #0 #-60 1000 0.5 0 0 0\n--- LINE PROPERTIES ---\n"
    "Line LineType UnstrLen NodeAnch NodeFair Flags\n(-) (-) (m) (-) (-) (-)\n1 chain 490 1 3 plot\n2 chain 56 3 2 plot\n"
    "--- SOLVER OPTIONS ---\nOption\n(-)\nrepeat 120 240\n";

}  // namespace

TEST_CASE("malformed line files are refused by file and line", "[import][fast]") {
  const bool moordyn = GENERATE(true, false);
  SmallDeck deck;
  if (moordyn) deck.replace("main.fst", "1 CompMooring", "3 CompMooring");
  deck.files["map.dat"] = moordyn ? moordyn_bridle : map_bridle;
  CHECK(deck.refusal().empty());
  for (const Fault& fault : moordyn ? moordyn_faults : map_faults) {
    CAPTURE(fault.from, fault.to, fault.said);
    SmallDeck damaged = deck;
    damaged.replace("map.dat", fault.from, fault.to);
    const std::string said = damaged.refusal();
    CHECK(said.find("map.dat" + (fault.said[0] == ':' ? fault.said + ":" : std::string())) != std::string::npos);
    CHECK(said.find(fault.said) != std::string::npos);
  }
}

namespace {

/// One that is read for all its files: bending tower and blades, a controller library.
SmallDeck deck_with_all() {
  SmallDeck deck = deck_that_bends();
  deck.replace("ed.dat", "False FlapDOF1", "True FlapDOF1");
  deck.replace("blade.dat", "0 0 300 1 1\n1 0 100 1 1\n", "0 9 300 1e9 3e9\n1 0 100 1e7 1e8\n");
  deck.turn_by_library();
  return deck;
}

/// What numbers of a deck's file the import reads: with a word in their place it must name file and line.
struct Swept {
  int refused = 0;
  std::vector<std::string> taken;  ///< names, or the row, of those that are never read
};
Swept sweep(const SmallDeck& deck, const std::string& file) {
  Swept swept;
  const std::string& text = deck.files.at(file);
  const std::string name = std::filesystem::path(file).filename().string();
  int line = 1;
  for (std::size_t at = 0; at < text.size();) {
    if (text[at] == '\n') ++line;
    const std::size_t end = text.find_first_of(" \n", at);
    const std::size_t size = (end == std::string::npos ? text.size() : end) - at;
    const std::string word = text.substr(at, size);
    char* rest = nullptr;
    std::strtod(word.c_str(), &rest);
    if (size > 0 && *rest == '\0') {
      for (const char* wrong : {"1.5.2", "x1y", "nan", "1e999"}) {
        SmallDeck damaged = deck;
        damaged.files[file].replace(at, size, wrong);
        const std::string said = damaged.refusal(), row = text.substr(text.rfind('\n', at) + 1);
        if (said.find(name + ":" + std::to_string(line) + ":") != std::string::npos)
          ++swept.refused;
        else
          swept.taken.push_back(std::to_string(line) + ": " + word + " in '" + row.substr(0, row.find('\n')) + "' " + said);
      }
    }
    at += std::max<std::size_t>(size, 1);
    if (size > 0 && at < text.size() && text[at] == '\n') continue;
  }
  return swept;
}

}  // namespace

TEST_CASE("a word in place of any number that a deck's files are read for is refused by file and line", "[import][fast]") {
  const SmallDeck deck = deck_with_all();
  struct Case {
    std::string file;
    int least;                        ///< of numbers that are refused
    std::vector<std::string> unread;  ///< beginnings of what is left of a line
  };
  for (const Case& c : std::vector<Case>{
           {"main.fst", 48, {"0.01 DT"}},
           {"ed.dat", 124, {"BlPitch(2)", "BlPitch(3)", "PreCone(2)", "PreCone(3)"}},
           {"srv.dat", 44, {}},
           {"blade.dat", 40, {}},
           {"tower.dat", 36, {}},
           {"ifw.dat", 20, {}},
           {"ad.dat", 36, {}},
           {"adblade.dat", 100, {}},
           {"foil.dat", 80, {}},
           {"sea.dat", 20, {}},
           // JointOvrlp and what marine growth changes
           {"hd.dat", 400, {"0 in '1 0 0 -80 1 0'", "0 in '2 0 0 -5 1 0'", "0 in '3 0 0 10 1 0'", "0 in '0.7 0 0.9 0'"}}}) {
    const Swept swept = sweep(deck, c.file);
    CAPTURE(c.file);
    CHECK(swept.refused >= c.least);
    for (const std::string& taken : swept.taken) {
      CAPTURE(taken);
      CHECK(std::ranges::any_of(c.unread, [&](const std::string& u) { return taken.find(u) != std::string::npos; }));
    }
  }
}

TEST_CASE("values of a deck that no turbine has are refused by file and line", "[import][fast]") {
  struct Impossible {
    std::string file, from, to;
  };
  const SmallDeck deck = deck_with_all();
  for (const auto& [file, from, to] : std::vector<Impossible>{{"main.fst", "100 TMax", "0 TMax"},
                                                              {"main.fst", "1 CompElast", "7 CompElast"},
                                                              {"main.fst", "9.80665 Gravity", "-9.81 Gravity"},
                                                              {"main.fst", "1.225 AirDens", "0 AirDens"},
                                                              {"main.fst", "1025 WtrDens", "-1025 WtrDens"},
                                                              {"main.fst", "200 WtrDpth", "0 WtrDpth"},
                                                              {"main.fst", "1 CompMooring", "9 CompMooring"},
                                                              {"main.fst", "0 CompSub", "5 CompSub"},
                                                              {"main.fst", "1 CompHydro", "2 CompHydro"},
                                                              {"ed.dat", "3 NumBl", "0 NumBl"},
                                                              {"ed.dat", "40 TipRad", "1 TipRad"},
                                                              {"ed.dat", "2 HubRad", "-2 HubRad"},
                                                              {"ed.dat", "60 TowerHt", "-60 TowerHt"},
                                                              {"ed.dat", "60 TowerHt", "5 TowerHt"},
                                                              {"ed.dat", "20000 HubMass", "-20000 HubMass"},
                                                              {"ed.dat", "100 GenIner", "-100 GenIner"},
                                                              {"ed.dat", "100000 NacMass", "-1 NacMass"},
                                                              {"ed.dat", "3000000 PtfmMass", "-3 PtfmMass"},
                                                              {"ed.dat", "2e9 PtfmRIner", "-2e9 PtfmRIner"},
                                                              {"ed.dat", "50 GBRatio", "0 GBRatio"},
                                                              {"ed.dat", "10 RotSpeed", "-10 RotSpeed"},
                                                              {"ed.dat", "-6 ShftTilt", "-600 ShftTilt"},
                                                              {"ed.dat", "3 BlPitch(1)", "900 BlPitch(1)"},
                                                              {"ed.dat", "5 PtfmPitch", "500 PtfmPitch"},
                                                              {"ed.dat", "0 TipMass(1)", "-5 TipMass(1)"},
                                                              {"blade.dat", "1 0 100 1e7 1e8", "1.2 0 100 1e7 1e8"},
                                                              {"blade.dat", "1 0 100 1e7 1e8", "0 0 100 1e7 1e8"},
                                                              {"blade.dat", "0 9 300", "0 9 -300"},
                                                              {"blade.dat", "2 NBlInpSt", "1 NBlInpSt"},
                                                              {"blade.dat", "2 NBlInpSt", "2.5 NBlInpSt"},
                                                              {"tower.dat", "0 4000", "0 -4000"},
                                                              {"tower.dat", "1 2000", "0 2000"},
                                                              {"tower.dat", "2 NTwInpSt", "1 NTwInpSt"},
                                                              {"ifw.dat", "1 WindType", "9 WindType"},
                                                              {"ifw.dat", "9.0 HWindSpeed", "-9.0 HWindSpeed"},
                                                              {"ifw.dat", "62 RefHt", "0 RefHt"},
                                                              {"ifw.dat", "0.1 PLexp", "10 PLexp"},
                                                              {"ifw.dat", "0 PropagationDir", "900 PropagationDir"},
                                                              {"ad.dat", "1 Wake_Mod", "8 Wake_Mod"},
                                                              {"ad.dat", "0 TwrPotent", "7 TwrPotent"},
                                                              {"ad.dat", "0 TwrShadow", "-1 TwrShadow"},
                                                              {"ad.dat", "False TwrAero", "No TwrAero"},
                                                              {"ad.dat", "0 UA_Mod", "11 UA_Mod"},
                                                              {"ad.dat", "1 InCol_Alfa", "0 InCol_Alfa"},
                                                              {"ad.dat", "3 InCol_Cd", "-3 InCol_Cd"},
                                                              {"ad.dat", "2 NumAFfiles", "0 NumAFfiles"},
                                                              {"adblade.dat", "4 NumBlNds", "1 NumBlNds"},
                                                              {"adblade.dat", "4 NumBlNds", "4.5 NumBlNds"},
                                                              {"adblade.dat", "10 0.1 0 0 10 3 2", "-10 0.1 0 0 10 3 2"},
                                                              {"adblade.dat", "10 0.1 0 0 10 3 2", "10 0.1 0 0 10 -3 2"},
                                                              {"adblade.dat", "10 0.1 0 0 10 3 2", "10 0.1 0 0 10 3 1.5"},
                                                              {"adblade.dat", "10 0.1 0 0 10 3 2", "10 0.1 0 0 10 3 9"},
                                                              {"adblade.dat", "25 0.5 0", "9 0.5 0"},
                                                              {"foil.dat", "15 1.4 0.1 0", "-90 1.4 0.1 0"},
                                                              {"foil.dat", "15 1.4 0.1 0", "1500 1.4 0.1 0"},
                                                              {"foil.dat", "5 NumAlf", "1 NumAlf"},
                                                              {"foil.dat", "1 NumTabs", "0 NumTabs"},
                                                              {"sea.dat", "1 WaveMod", "9 WaveMod"},
                                                              {"sea.dat", "2.5 WaveHs", "-2.5 WaveHs"},
                                                              {"sea.dat", "9 WaveTp", "0 WaveTp"},
                                                              {"sea.dat", "30 WaveDir", "3000 WaveDir"},
                                                              {"sea.dat", "0 CurrMod", "5 CurrMod"},
                                                              {"hd.dat", "1 PotMod", "4 PotMod"},
                                                              {"hd.dat", "1 RdtnMod", "3 RdtnMod"},
                                                              {"hd.dat", "30 RdtnTMax", "-30 RdtnTMax"},
                                                              {"hd.dat", "1 WAMITULEN", "0 WAMITULEN"},
                                                              {"hd.dat", "4000 PtfmVol0", "-4000 PtfmVol0"},
                                                              {"hd.dat", "1 0.5 0 1", "1 -0.5 0 1"},
                                                              {"hd.dat", "2 0 0 -5 1 0", "1 0 0 -5 1 0"},
                                                              {"hd.dat", "1 8 0.01", "1 -8 0.01"},
                                                              {"hd.dat", "1 8 0.01", "1 8 -0.01"},
                                                              {"hd.dat", "2 6 0.01", "1 6 0.01"},
                                                              {"hd.dat", "0.7 0 0.9 0", "-0.7 0 0.9 0"},
                                                              {"hd.dat", "0.7 0 0.9 0", "0.7 0 -0.9 0"},
                                                              {"hd.dat", "1 1 2 1 1 4 1 TRUE", "1 1 1 1 1 4 1 TRUE"},
                                                              {"hd.dat", "1 1 2 1 1 4 1 TRUE", "1 1 2 1 1 0 1 TRUE"},
                                                              {"hd.dat", "1 1 2 1 1 4 1 TRUE", "1 1 2 1 1 4 7 TRUE"},
                                                              {"hd.dat", "2 2 3 1 2 4 1 TRUE", "1 2 3 1 2 4 1 TRUE"},
                                                              {"hd.dat", "3 NJoints", "-3 NJoints"},
                                                              {"srv.dat", "5 PCMode", "8 PCMode"},
                                                              {"srv.dat", "5 VSContrl", "-1 VSContrl"},
                                                              {"srv.dat", "95 GenEff", "0.95 GenEff"},
                                                              {"srv.dat", "100 HSSBrTqF", "-100 HSSBrTqF"},
                                                              {"srv.dat", "0.025 DLL_DT", "-0.025 DLL_DT"},
                                                              {"srv.dat", "1 Ptch_Cntrl", "2 Ptch_Cntrl"},
                                                              {"srv.dat", "90 Ptch_Max", "9000 Ptch_Max"},
                                                              {"srv.dat", "8 PtchRate_Max", "-8 PtchRate_Max"},
                                                              {"srv.dat", "1200 GenSpd_Dem", "-1200 GenSpd_Dem"},
                                                              {"srv.dat", "2.3 Gain_OM", "-2.3 Gain_OM"}}) {
    SmallDeck damaged = deck;
    damaged.replace(file, from, to);
    const std::string& good = deck.files.at(file);
    const auto line = 1 + std::count(good.begin(), good.begin() + std::ptrdiff_t(good.find(from)), '\n');
    const std::string said = damaged.refusal();
    CAPTURE(file, from, to, said);
    CHECK(said.find(file + ":" + std::to_string(line) + ":") != std::string::npos);
  }
}

TEST_CASE("a deck with something wrong is refused by file and line", "[import][fast]") {
  const auto [file, from, to, said] = GENERATE(table<std::string, std::string, std::string, std::string>({
      {"main.fst", "\"ed.dat\" EDFile", "\"none.dat\" EDFile", "none.dat"},
      {"main.fst", "\"ed.dat\" EDFile\n", "", "EDFile"},
      {"ed.dat", "-4 OverHang", "x OverHang", "ed.dat:24"},
      {"ed.dat", "60 TowerHt\n", "", "TowerHt"},
      {"blade.dat", "1 0 100 1 1", "1 0", "blade.dat:7"},
      {"blade.dat", "2 NBlInpSt", "3 NBlInpSt", "blade.dat"},
      {"tower.dat", "0 4000", "0 q", "tower.dat:6"},
      {"adblade.dat", "10 0.1 0 0 10 3 2", "10 0.1 0 0 10 3 9", "polar 9"},
      {"adblade.dat", "BlChord", "Chords", "adblade.dat:4"},
      {"foil.dat", "15 1.4 0.1 0", "15 one 0.1 0", "foil.dat:9"},
      {"hd.dat", "1 NBody", "2 NBody", "hd.dat:5"},
      {"hd.dat", "1 1 2 1 1 4", "1 1 7 1 1 4", "joint 7"},
      {"hd.dat", "1 1 2 1 1 4", "1 1 2 1 5 4", "property set 5"},
      {"hd.dat", "1 0 0 -80 1 0", "1 0 0 -80 4 0", "axial coefficients 4"},
      {"hd.dat", "1 1 2 1 1 4 1", "1 1 2 1 1 4 3", "member 1"},
      {"hd.dat", "1 1 2 1 1 4 1", "1 1 2 1 1 4 2", "no table over depth"},
      {"main.fst", "0 CompSub", "0 CompSub\n2 MHK", "main.fst:13"},
      {"main.fst", "1 CompElast", "3 CompElast", "main.fst:6"},
      {"hd.dat", "wamit/spar", "wamit/none", "none.1"},
      {"map.dat", "1 chain 540 1 2", "1 rope 540 1 2", "map.dat:13"},
      {"map.dat", "1 chain 540 1 2", "1 chain 540 1 9", "node 9"},
      {"map.dat", "chain 0.1 100", "chain wide 100", "map.dat:4"},
      {"map.dat", "Line LineType", "Lines LineType", "Line"},
      {"ifw.dat", "9.0 HWindSpeed", "fast HWindSpeed", "ifw.dat:4"},
      {"main.fst", "100 TMax - s\n", "", "TMax"},
  }));
  SmallDeck deck;
  deck.replace(file, from, to);
  CAPTURE(file, from, to);
  CHECK(deck.refusal().find(said) != std::string::npos);
}
