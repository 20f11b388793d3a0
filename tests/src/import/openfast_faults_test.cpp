// Decks with something wrong, and what is said of them. SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/src/import/small_deck.hpp"

using namespace spindrift;

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

TEST_CASE("other versions and names of other case are refused by what the deck has", "[import][fast]") {
  struct Case {
    const char *file, *from, *to, *said;
  };
  const auto c =
      GENERATE(Case{"ad.dat", "1 Wake_Mod", "11 WakeMod", "ad.dat:2: WakeMod is 11: 0 to 3 are known; give 1"},
               Case{"ad.dat", "0 TwrShadow", "False TwrShadow",
                    "ad.dat:4: TwrShadow is 'False', as in AeroDyn of FAST 8: decks of OpenFAST, versions 3 to 5"},
               Case{"ed.dat", "60 TowerHt", "high TowerHt", "TowerHt: 'high' is not a number"},
               Case{"main.fst", "\"ad.dat\" AeroFile", "\"AD.dat\" AeroFile", "AD.dat: cannot be read: ad.dat stands beside"});
  SmallDeck deck;
  deck.replace(c.file, c.from, c.to);
  CHECK_THAT(deck.refusal(), Catch::Contains(c.said));
}

TEST_CASE("a column whose name has the module behind it is found", "[import][fast]") {
  SmallDeck deck;
  deck.replace("hd.dat", "\nMemberID MJointID1", "\nMemberID_HydC MJointID1");
  CHECK(deck.refusal().empty());
}
