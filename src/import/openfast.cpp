// The main file of a deck, and the order of the parts. SPDX-License-Identifier: Apache-2.0
#include "src/import/openfast.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "src/import/openfast_sections.hpp"

namespace spindrift::decks {

namespace {

constexpr double rigid_step = 0.05;     // a rigid platform's shortest period is some seconds
constexpr double flexible_step = 0.01;  // a tower's extension is the fastest: some periods to a second

void refuse_unknown(const Deck& main) {
  if (!main.has("EDFile")) main.fail(std::nullopt, "has no line for EDFile: this is not an OpenFAST main file (version 3 to 5)");
  main.require({positive("TMax"),
                positive("Gravity"),
                {"CompElast", 1, 3},
                {"CompInflow", 0, 2},
                {"CompAero", 0, 3},
                {"CompServo", 0, 1},
                {"CompSeaSt", 0, 1},
                {"CompHydro", 0, 1},
                {"CompSub", 0, 2},
                {"CompMooring", 0, 4},
                {"CompIce", 0, 2},
                {"MHK", 0, 2}});
  if (main.integer({"CompAero"}, 0) == 2) main.require({positive("KinVisc"), positive("SpdSound")});
  if (main.number({"NRotors"}, 1.0) > 1.0) main.fail(main.find({"NRotors"}), "has NRotors: one rotor is carried over");
  if (main.flag({"MirrorRotor", "MirrorRotor(1)"}, false))
    main.fail(main.find({"MirrorRotor", "MirrorRotor(1)"}), "has MirrorRotor: a rotor that turns the other way is not known");
  if (main.integer({"CompElast"}, 1) == 3) main.fail(main.find({"CompElast"}), "is 3: simplified ElastoDyn is not known");
  if (const auto line = main.find({"MHK"}); line && (main.words(*line)[0] == "1" || main.words(*line)[0] == "2"))
    main.fail(line, "has MHK: a rotor in the water is not known");
}

/// Of the main file, or, in decks before version 3, of the module that uses it.
double given(const Deck& main, const char* name, const char* file, double otherwise) {
  return main.has(name) ? main.number({name}, otherwise) : Deck(main.path({file})).number({name}, otherwise);
}

ImportedEnvironment import_environment(DeckImport& run, const Deck& elastodyn, bool wet) {
  const Deck& main = run.main;
  ImportedEnvironment e{.text = {}, .gravity = main.number({"Gravity"}, elastodyn.number({"Gravity"}, 9.80665))};
  e.text = fmt::format("\n[environment]\ngravity_m_s2 = {:.9g}\n", e.gravity);
  if (main.integer({"CompAero"}, 0) == 2) {
    main.require({positive("AirDens")});
    e.text += fmt::format("air_density_kg_m3 = {:.9g}\n", given(main, "AirDens", "AeroFile", 1.225));
  }
  if (!wet) return e;
  main.require({positive("WtrDens"), positive("WtrDpth")});
  e.depth = given(main, "WtrDpth", "HydroFile", 200.0), e.water_density = given(main, "WtrDens", "HydroFile", 1025.0);
  e.text += fmt::format("water_density_kg_m3 = {:.9g}\nwater_depth_m = {:.9g}\n", e.water_density, e.depth);
  if (given(main, "MSL2SWL", "HydroFile", 0.0) != 0.0) run.leave_out("MSL2SWL: still water is at the mean level");
  return e;
}

/// What moves in the deck and is rigid in the scene, and modules that are not carried over.
void list_rigid_parts(DeckImport& run, const Deck& elastodyn, bool tower_bends, bool shaft_twists) {
  if (any_on(elastodyn, tower_freedoms) && !tower_bends) run.leave_out_part("bending of the tower: it is rigid (--rigid-tower)");
  if (tower_bends && !std::ranges::all_of(tower_freedoms, [&](const char* f) { return elastodyn.flag({f}, false); }))
    run.leave_out("TwFADOF1, TwFADOF2, TwSSDOF1, TwSSDOF2: not all are on, the tower here bends in all four modes");
  if (any_on(elastodyn, {"YawDOF", "TeetDOF"})) run.leave_out("motion of yaw bearing and teeter");
  if (any_on(elastodyn, {"DrTrDOF"}) && !shaft_twists)
    run.leave_out("twist of the shaft: it is rigid where no controller turns the rotor");
  for (const auto& [part, name] :
       {std::pair{"CompSub", "SubDyn: what stands on it is fixed"}, std::pair{"CompIce", "ice"}, std::pair{"CompSoil", "soil"}})
    if (run.main.integer({part}, 0) != 0) run.leave_out_part(name);
}

/// What of the structure has no place in a scene.
void list_structure(DeckImport& run, const Deck& elastodyn, int blades) {
  run.leave_out_unless(elastodyn, {{"OoPDefl", "the blades' deflection at the start"},
                                   {"IPDefl", "the blades' deflection at the start"},
                                   {"TTDspFA", "the tower's deflection at the start"},
                                   {"TTDspSS", "the tower's deflection at the start"}});
  if (blades == 2)
    run.leave_out_unless(elastodyn, {{"UndSling", "the rotor's undersling"}, {"Delta3", "the teeter's delta-3 angle"}});
  if (elastodyn.flag({"Furling"}, false)) run.leave_out("Furling: the rotor does not turn out of the wind");
  const auto cone = [&](int blade) { return elastodyn.number({fmt::format("PreCone({})", blade)}, 0.0); };
  for (int b = 2; b <= blades; ++b)
    if (cone(b) != cone(1)) run.leave_out(fmt::format("PreCone({}) {:g} degrees: all blades have that of the first", b, cone(b)));
}

void write_scene(const DeckImport& run, double step, const std::string& sections) {
  const std::filesystem::path file = run.folder / "scene.toml";
  const double end = window * std::max(1.0, std::round(run.main.number({"TMax"}) / window));
  std::ofstream out(file);
  out << fmt::format("# From the OpenFAST deck {}, by spindrift import.\n", run.main.file().filename().string());
  out << fmt::format("[time]\nend_s = {:.9g}\nwindow_s = {}\nstep_s = {}\n", end, window, step) << sections;
  out << fmt::format("\n[output]\ntitle = \"{}\"\n", run.main.file().stem().string()) << toml_remarks(run.left_out, run.caveats);
  if (!out.flush()) throw std::runtime_error(file.string() + ": cannot be written");
}

}  // namespace

Imported import_openfast(const std::filesystem::path& main_file, const std::filesystem::path& folder, ImportedTower tower,
                         ImportedBlades blades, ImportedLines lines) {
  DeckImport run{Deck(main_file), folder};
  const Deck& main = run.main;
  refuse_unknown(main);
  const Deck elastodyn(main.path({"EDFile"}));
  std::filesystem::create_directories(folder);
  RotorFrame rotor = rotor_frame(elastodyn);
  if (main.integer({"CompElast"}, 1) == 2)
    for (int b = 1; b <= rotor.blades; ++b)
      rotor.beamdyn_blades.push_back(Deck(main.path({fmt::format("BDBldFile({})", b)})).path({"BldFile"}));
  ImportedSystem system;
  system.tower_bends = tower == ImportedTower::as_in_deck && any_on(elastodyn, tower_freedoms);
  system.wet = main.integer({"CompHydro"}, 0) == 1;
  system.floats = system.wet && main.integer({"CompSub"}, 0) == 0;

  const ImportedEnvironment environment = import_environment(run, elastodyn, system.wet);
  const ImportedWater water = system.wet ? import_water(run, environment.depth, environment.water_density) : ImportedWater{};
  const ImportedRotor turbine = import_rotor(run, elastodyn, rotor, system, blades);
  const bool moving_water = water.text.find("[waves]") != std::string::npos || water.text.find("\ncurrent_") != std::string::npos;
  const std::string moorings = system.floats ? import_moorings(run, environment, moving_water, lines) : "";
  if (!system.floats && main.integer({"CompMooring"}, 0) != 0)
    run.leave_out_part("mooring lines: what they hold does not float (CompHydro 0 or CompSub 1)");
  const double step = std::min(system.tower_bends ? flexible_step : rigid_step, turbine.longest_step);
  const ImportedControl control = import_control(run, elastodyn, rotor, !turbine.text.empty(), {step, turbine.longest_step});
  system.controlled = !control.text.empty();
  const std::string bodies = import_bodies(run, elastodyn, rotor, system, water);
  list_rigid_parts(run, elastodyn, system.tower_bends, control.shaft_twists);
  list_structure(run, elastodyn, rotor.blades);
  write_scene(run, control.step.value_or(step), environment.text + bodies + turbine.text + moorings + control.text + water.text);
  return {folder / "scene.toml", run.left_out, run.carried};
}

}  // namespace spindrift::decks
