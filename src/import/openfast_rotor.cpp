// [wind], [aero] and [rotor] of a scene from AeroDyn, and how its blades bend from ElastoDyn.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "kernels/base/constants.hpp"
#include "src/import/openfast_sections.hpp"
#include "src/import/openfast_turbine.hpp"

namespace spindrift::decks {

namespace {

std::string tower_wake(DeckImport& run, const Deck& ad, const RotorFrame& rotor) {
  const bool changes_wind = ad.integer({"TwrPotent"}, 0) > 0, drag = ad.flag({"TwrAero"}, false);
  const int wake = ad.integer({"TwrShadow"}, 0);
  if (wake > 0 && !changes_wind)
    run.leave_out("the tower's wake on a downwind rotor (TwrShadow), which comes with its flow (TwrPotent)");
  if (wake > 1 && changes_wind) run.leave_out("the wake of TwrShadow 2: that of TwrShadow 1 takes its place");
  if (wake == 0 && changes_wind && rotor.hub.x() * rotor.axis.x() > 0.0)
    run.leave_out("TwrShadow 0: the wake of the tower comes with its flow (TwrPotent) where the rotor is behind it");
  if (ad.integer({"TwrPotent"}, 0) > 1) run.leave_out("Bak's correction of the flow round the tower (TwrPotent 2)");
  const std::size_t count = std::size_t(ad.integer({"NumTwrNds"}, 0));
  if (!(changes_wind || drag) || count < 2) return "";
  std::string text = "\n[aero.tower]\nstations = [\n";
  double before = -std::numeric_limits<double>::infinity();
  for (std::size_t n = *ad.find({"NumTwrNds"}) + 3; count > 0 && n < *ad.find({"NumTwrNds"}) + 3 + count; ++n) {
    const std::vector<double> row = ad.numbers(n, 3);
    if (row[0] <= before) ad.fail(n, fmt::format("has a height of {:g} m, not above the row before", row[0]));
    if (!(row[1] > 0.0)) ad.fail(n, fmt::format("has a diameter of {:g} m: more than 0 is wanted", row[1]));
    if (row[2] < 0.0) ad.fail(n, fmt::format("has a drag coefficient of {:g}: at least 0 is wanted", row[2]));
    before = row[0];
    text += fmt::format("  [{:.9g}, {:.9g}, {:.9g}],\n", row[0], row[1], row[2]);
  }
  text += "]\n";
  if (!changes_wind) text += "changes_wind = false\n";
  if (!drag) text += "has_drag = false\n";
  run.carry("tower: " + std::string(changes_wind ? "its flow round the blades" : "") + (changes_wind && drag ? ", " : "") +
            (drag ? "drag" : ""));
  return text;
}

/// Settings of the balance of blades and wake that differ from those of this program.
void list_balance(DeckImport& run, const Deck& ad) {
  constexpr double factor = 15.0 * pi / 32.0;
  const int skew = ad.integer({"SkewMod"}, ad.has("AFAeroMod") ? 2 : 1);
  // Decks of version 3 have 2 for Pitt and Peters' model, later ones 1 with SkewRedistr_Mod 1.
  if (skew != (ad.has("AFAeroMod") ? 2 : 1) || ad.integer({"SkewRedistrMod"}, 1) != 1)
    run.leave_out(fmt::format("SkewMod {}: the wake of a rotor across the wind is skewed after Pitt and Peters", skew));
  if (const double given = ad.number({"SkewModFactor", "SkewRedistrFactor"}, factor); std::abs(given - factor) > 1e-3 * factor)
    run.leave_out(fmt::format("SkewModFactor {:g}: it is 15 pi / 32", given));
  for (const auto& [key, what] :
       {std::pair{"TipLoss", "blades lose lift at their tips"}, std::pair{"HubLoss", "blades lose lift at the hub"},
        std::pair{"TanInd", "the air is turned by the rotor"}, std::pair{"AIDrag", "drag is in the axial balance"},
        std::pair{"TIDrag", "drag is in the tangential balance"}})
    if (!ad.flag({key}, true)) run.leave_out(fmt::format("{} False: {}", key, what));
  if (ad.integer({"BEM_Mod"}, 1) == 2)
    run.leave_out("BEM_Mod 2: the balance of momentum on a polar grid, which differs on rotors with much cone");
  if (ad.flag({"SectAvg"}, false)) run.leave_out("SectAvg: a blade meets the wind of its place, not the mean of a sector");
  if (ad.integer({"DBEMT_Mod"}, 0) == -1) run.leave_out("the frozen wake (DBEMT_Mod -1)");
}

/// What takes time in the flow. Decks of version 3 have Wake_Mod 2 for the dynamic wake and AFAeroMod 2 for the unsteady
/// aerofoils besides.
std::string unsteady_flow(DeckImport& run, const Deck& ad, const WrittenTurbine& turbine, int wake) {
  std::string text;
  const int filter = ad.integer({"DBEMT_Mod"}, 0);
  const bool knows = !ad.has("AFAeroMod"), stalls = knows || ad.integer({"AFAeroMod"}, 1) == 2;
  if (filter > 0 && (wake == 2 || (wake == 1 && knows))) {
    text += "dynamic_inflow = \"oye\"\n";
    if (filter != 2) ad.require({positive("tau1_const")});
    if (filter != 2) text += fmt::format("inflow_time_s = {:.9g}\n", ad.number({"tau1_const"}));
    run.carry("dynamic inflow after Oye");
  }
  if (const int model = ad.integer({"UA_Mod", "UAMod"}, 0); model > 0 && stalls) {
    // 1 to 3, 4 and 5: kinds of Beddoes and Leishman's model; 6: Oye's.
    const bool leishman = model <= 5;
    text += fmt::format("dynamic_stall = \"{}\"\n", leishman ? "beddoes_leishman" : "oye");
    if (leishman)
      text += fmt::format("speed_of_sound_m_s = {:.9g}\n", run.main.number({"SpdSound"}, ad.number({"SpdSound"}, 340.0)));
    if (model == 6) text += fmt::format("stall_lag_chords = {:.9g}\n", 0.5 * turbine.separation_lag);
    if (model == 6 && turbine.lags_differ)
      run.leave_out(fmt::format("T_f0 of each aerofoil: all have the {:g} of the outermost", turbine.separation_lag));
    if (model == 4)
      run.leave_out("UA_Mod 4 has no vortex from the leading edge: Beddoes and Leishman's model here has one");
    else if (model != 6)
      run.leave_out(fmt::format("what the dynamic stall model of UA_Mod {} has beside {}{}", model,
                                leishman ? "Beddoes and Leishman's" : "Oye's",
                                model <= 3 ? ": time constants that change within a stall, of each polar" : ""));
    run.leave_out_unless(ad, {{"UAStartRad", "sections stall dynamically from the root on"},
                              {"UAEndRad", "sections stall dynamically up to the tip", 1.0}});
    run.carry(leishman ? "dynamic stall after Beddoes and Leishman" : "dynamic stall after Oye");
  }
  return text;
}

/// Keys that follow [rotor].
ImportedRotor bending_keys(DeckImport& run, const Deck& ed, const RotorFrame& rotor, ImportedBlades blades) {
  ImportedRotor keys;
  if (!any_on(ed, {"FlapDOF1", "FlapDOF2", "EdgeDOF"})) return keys;
  if (blades == ImportedBlades::rigid) {
    run.leave_out_part("bending of the blades: they are rigid (--rigid-blades)");
    return keys;
  }
  if (!rotor.beamdyn_blades.empty()) {
    run.leave_out_part("bending of BeamDyn's blades: they are rigid");
    return keys;
  }
  const ImportedBending bending = blade_bending(ed, rotor, run.left_out);
  // Half a radian of the fastest mode to a step, whole steps to a window.
  const double turning = ed.number({"RotSpeed"}) * rad_s_per_rpm, fastest = std::hypot(bending.fastest, 2.0 * turning);
  keys.longest_step = window / std::ceil(window * fastest / 0.5);
  std::ofstream(run.folder / "blade_structure.csv") << bending.structure;
  keys.text = fmt::format("blade_structure = \"blade_structure.csv\"\nblade_damping = [{:.9g}, {:.9g}, {:.9g}]\n",
                          bending.damping[0], bending.damping[1], bending.damping[2]);
  run.carry("blades that bend, two modes flapwise and one edgewise, from their mass and stiffness");
  if (!any_on(ed, {"FlapDOF1"}) || !any_on(ed, {"FlapDOF2"}) || !any_on(ed, {"EdgeDOF"}))
    run.leave_out("FlapDOF1, FlapDOF2, EdgeDOF: not all are on, the blades here bend in all three");
  if (ed.number({"TipMass(1)", "TipMass1"}, 0.0) != 0.0) run.leave_out("TipMass in the bending of the blades");
  if (!bending.alike) run.leave_out("differences between the blades: all bend as blade 1");
  return keys;
}

}  // namespace

namespace {

/// FAST 8 has flags where OpenFAST has models; models of wakes beyond 3 are those of other programs' own versions.
void refuse_other_versions(const Deck& ad) {
  if (const auto line = ad.find({"TwrShadow"}); line && !number_in(ad.words(*line)[0]))
    ad.fail(line, fmt::format(
                      "TwrShadow is '{}', as in AeroDyn of FAST 8: decks of OpenFAST, versions 3 to 5, have 0 to 2 and are read",
                      ad.words(*line)[0]));
  const std::vector<std::string> names{"Wake_Mod", "WakeMod"};
  const int wake = ad.integer(names, 1);
  if (wake >= 0 && wake <= 3) return;
  const auto line = ad.find(names);
  ad.fail(line,
          fmt::format("{} is {}: 0 to 3 are known; give 1 for blade element momentum, 2 (or DBEMT_Mod) for its dynamic wake",
                      ad.name_in(names, *line), wake));
}

}  // namespace

ImportedRotor import_rotor(DeckImport& run, const Deck& ed, const RotorFrame& rotor, const ImportedSystem& system,
                           ImportedBlades blades) {
  const bool blows = run.main.integer({"CompInflow"}, 0) == 1, aero = run.main.integer({"CompAero"}, 0) == 2;
  if (run.main.integer({"CompAero"}, 0) == 1)
    run.leave_out_part("AeroDyn 14 or AeroDisk (CompAero 1): no aerodynamics in the scene");
  if (!aero || !blows) {
    run.carry("no aerodynamics");
    if (any_on(ed, {"FlapDOF1", "FlapDOF2", "EdgeDOF"}))
      run.leave_out_part("bending of the blades: they are rigid without aerodynamics");
    return {};
  }
  const Deck ad(run.main.path({"AeroFile"}));
  refuse_other_versions(ad);
  ad.require({{"TwrPotent", 0, 2},
              {"TwrShadow", 0, 2},
              {"DBEMT_Mod", -1, 3},
              {"UA_Mod", 0, 7},
              {"UAMod", 0, 7},
              {"AFAeroMod", 1, 2},
              positive("KinVisc"),
              positive("SpdSound"),
              positive("AirDens"),
              {"NumTwrNds", 0, 1e5},
              {"InCol_Alfa", 1, 100},
              {"InCol_Cl", 1, 100},
              {"InCol_Cd", 1, 100},
              {"InCol_Cm", 0, 100},
              {"NumAFfiles", 1, 1e5}});
  for (const auto& [key, what] : {std::pair{"TFinAero", "the tail fin"}, std::pair{"NacelleDrag", "drag of the nacelle"}})
    if (ad.flag({key}, false)) run.leave_out(fmt::format("{}: {}", key, what));
  const auto blade_file = [&](int blade) {
    const std::string key = fmt::format("ADBlFile({})", blade);
    return ad.has(key) ? ad.text({key}) : std::string();
  };
  for (int b = 2; b <= rotor.blades; ++b)
    if (const std::string file = blade_file(b); !file.empty() && file != blade_file(1))
      run.leave_out(fmt::format("ADBlFile({}) {}: all blades are the first", b, file));
  WrittenTurbine turbine = write_turbine(ad, rotor, run.folder);
  for (std::string& what : turbine.left_out) run.leave_out(std::move(what));
  std::string text = import_wind(run, Deck(run.main.path({"InflowFile"})), rotor.hub.z());
  if (ad.integer({"Wake_Mod", "WakeMod"}, 1) == 0)
    run.leave_out_part("no induction (Wake_Mod 0): blades are in balance with their wake");
  const int wake = ad.integer({"Wake_Mod", "WakeMod"}, 1);
  if (wake > 2) run.leave_out_part("the free-vortex wake (Wake_Mod 3): blade element momentum");
  text += "\n[aero]\nmodel = \"bem\"\ninduction = \"buhl\"\n";
  if (turbine.by_reynolds) {
    text += fmt::format("kinematic_viscosity_m2_s = {:.9g}\n", ad.number({"KinVisc"}, run.main.number({"KinVisc"})));
    run.carry("polars at several Reynolds numbers (AFTabMod 2)");
  }
  list_balance(run, ad);
  if (!ad.flag({"SkewMomCorr"}, false)) text += "skew_momentum = false\n";
  text += unsteady_flow(run, ad, turbine, wake);
  text += tower_wake(run, ad, rotor);
  text += fmt::format("\n[rotor]\nbody = \"{}\"\nturbine = \"turbine.toml\"\n", system.tower_bends ? "nacelle" : "platform");
  text += "hub_m = " + toml_vector(rotor.hub) + "\naxis = " + toml_vector(rotor.axis) + "\n";
  const double pitch = ed.number({"BlPitch(1)", "BlPitch1"}, 0.0);
  text += fmt::format("speed_rpm = {:.9g}\nblade_pitch_deg = {:.9g}\n", ed.number({"RotSpeed"}), pitch);
  for (int b = 2; b <= rotor.blades; ++b)
    if (const std::string key = fmt::format("BlPitch({})", b); ed.number({key, fmt::format("BlPitch{}", b)}, pitch) != pitch)
      run.leave_out(key + ": all blades have the pitch of the first");
  if (ed.number({"AzimB1Up"}, 0.0) != 0.0) run.leave_out("AzimB1Up: the azimuth is 0 where blade 1 is up");
  if (const double azimuth = ed.number({"Azimuth"}, 0.0); azimuth != 0.0) text += fmt::format("azimuth_deg = {:.9g}\n", azimuth);
  const ImportedRotor bending = bending_keys(run, ed, rotor, blades);
  run.carry(fmt::format("rotor: {} blades, {:.4g} rpm, blade pitch {:.4g} deg", rotor.blades, ed.number({"RotSpeed"}), pitch));
  return {text + bending.text, bending.longest_step};
}

}  // namespace spindrift::decks
