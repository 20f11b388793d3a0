// SPDX-License-Identifier: Apache-2.0
#include "tests/src/import/small_deck.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>

#include "src/scene/document.hpp"
#include "src/scene/error.hpp"

namespace spindrift {

SmallDeck::SmallDeck() : folder(std::filesystem::temp_directory_path() / ("spindrift_import_" + std::to_string(getpid()))) {
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

void SmallDeck::replace(const std::string& file, const std::string& from, const std::string& to) {
  std::string& text = files[file];
  REQUIRE(text.find(from) != std::string::npos);
  text.replace(text.find(from), from.size(), to);
}

void SmallDeck::turn_by_library() {
  replace("main.fst", "0 CompServo", "1 CompServo");
  replace("ed.dat", "False GenDOF", "True GenDOF");
  replace("srv.dat", "0 PCMode\n0 VSContrl", "5 PCMode\n5 VSContrl");
  files["lib.so"] = "none", files["DISCON.IN"] = "1.0";
}

decks::Imported SmallDeck::import(decks::ImportedTower tower, decks::ImportedLines lines) const {
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder / "deck/wamit");
  for (const auto& [name, text] : files) std::ofstream(folder / "deck" / name) << text;
  return decks::import_openfast(folder / "deck/main.fst", folder / "scene", tower, decks::ImportedBlades::as_in_deck, lines);
}

coupling::Scenario SmallDeck::scenario(decks::ImportedTower tower, decks::ImportedLines lines) const {
  scene::Document document = scene::load(import(tower, lines).scene.string());
  return coupling::read_scenario(document);
}

std::string SmallDeck::refusal() const {
  try {
    import();
  } catch (const scene::SceneError& e) { return e.what(); }
  return "";
}

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

bool has_word(const std::vector<std::string>& sentences, const std::string& word) {
  return std::ranges::any_of(sentences, [&](const std::string& s) { return s.find(word) != std::string::npos; });
}

}  // namespace spindrift
