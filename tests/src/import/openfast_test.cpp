// What a deck of OpenFAST becomes as a whole, and what is told of it. SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "kernels/base/constants.hpp"
#include "src/aero/turbine.hpp"
#include "src/coupling/floating_system.hpp"
#include "src/coupling/start.hpp"
#include "src/scene/document.hpp"
#include "tests/src/import/small_deck.hpp"

using namespace spindrift;

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

TEST_CASE("an imported scene is a turbine that stands and moves", "[import][fast]") {
  const SmallDeck deck;
  coupling::FloatingSystem floating(deck.scenario());
  coupling::Start start = make_start(floating);
  REQUIRE(floating.rotor());
  for (int n = 0; n < 20; ++n) REQUIRE(floating.multibody().advance(start.state, floating.timeline().tick_s(), 1).ok());
}

TEST_CASE("what the scene cannot say is told", "[import][fast]") {
  SmallDeck deck;
  deck.replace("ed.dat", "False FlapDOF1", "False FlapDOF1\nTrue YawDOF");
  deck.replace("ad.dat", "0 UA_Mod", "3 UA_Mod");
  deck.replace("main.fst", "0 CompServo", "1 CompServo");
  const decks::Imported imported = deck.import();
  for (const char* word :
       {"motion of yaw bearing and teeter", "the dynamic stall model of UA_Mod 3 has", "ServoDyn (GenDOF is off)"})
    CHECK(has_word(imported.left_out, word));
  CHECK(has_word(deck.scenario().output.notes, "motion of yaw bearing and teeter"));
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
        Setting{"ad.dat", "1 Skew_Mod\n0 SkewRedistr_Mod", "SkewMod 1"},
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

TEST_CASE("what a deck has and the scene has not is in the scene, parts of the model apart from the rest", "[import][fast]") {
  SmallDeck deck = deck_that_bends();
  deck.replace("main.fst", "0 CompServo", "1 CompServo");
  deck.replace("ed.dat", "False FlapDOF1", "False FlapDOF1\nTrue YawDOF");
  const coupling::Scenario s = deck.scenario(decks::ImportedTower::rigid);
  CHECK(has_word(s.output.caveats, "bending of the tower: it is rigid"));
  CHECK(has_word(s.output.caveats, "ServoDyn (GenDOF is off)"));
  CHECK(has_word(s.output.notes, "motion of yaw bearing and teeter"));
  CHECK_FALSE(has_word(s.output.notes, "ServoDyn (GenDOF is off)"));
  CHECK(s.output.caveats.size() + s.output.notes.size() == deck.import(decks::ImportedTower::rigid).left_out.size());
}
