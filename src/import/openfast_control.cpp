// [control] of a scene from ServoDyn.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "kernels/base/constants.hpp"
#include "src/import/openfast_sections.hpp"

namespace spindrift::decks {

namespace {

/// A library with Bladed's interface, where the deck has it: it may look for files beside itself.
ImportedControl library(DeckImport& run, const Deck& deck, const Deck& ed, const RotorFrame& rotor, TimeSteps bodies) {
  const auto absolute = [](const std::filesystem::path& path) {
    return std::filesystem::absolute(path).lexically_normal().string();
  };
  const double gear = ed.number({"GBRatio"}, 1.0), generator = generator_inertia(ed);
  ImportedControl control;
  std::string& text = control.text;
  text = "\n[control]\nmodel = \"library\"\nlibrary = \"" + absolute(deck.path({"DLL_FileName"})) + "\"\n";
  if (const std::string input = deck.text({"DLL_InFile"}); std::filesystem::is_regular_file(deck.beside(input)))
    text += "input_file = \"" + absolute(deck.beside(input)) + "\"\n";
  else
    run.leave_out(fmt::format("DLL_InFile {} is not there: the library is given no file", input));
  if (deck.has("DLL_ProcName")) text += "procedure = \"" + deck.text({"DLL_ProcName"}) + "\"\n";
  if (deck.integer({"Ptch_Cntrl"}, 0) == 1) text += "individual_pitch = true\n";
  struct Record {
    int record;
    const char* name;
    double unit;
  };
  const double rate = deck.number({"PtchRate_Max"}, 0.0);
  std::string records;
  for (const Record& r :
       {Record{5, "Ptch_SetPnt", radians_per_degree}, Record{6, "Ptch_Min", radians_per_degree},
        Record{7, "Ptch_Max", radians_per_degree}, Record{8, "PtchRate_Min", radians_per_degree},
        Record{9, "PtchRate_Max", radians_per_degree}, Record{13, "GenPwr_Dem", 1.0}, Record{16, "Gain_OM", 1.0},
        Record{17, "GenSpd_MinOM", rad_s_per_rpm}, Record{18, "GenSpd_MaxOM", rad_s_per_rpm},
        Record{19, "GenSpd_Dem", rad_s_per_rpm}, Record{22, "GenTrq_Dem", 1.0}, Record{37, "NacYaw_North", -radians_per_degree}})
    if (const double value = deck.number({r.name}, 0.0); value != 0.0)
      records += fmt::format("[[control.records]]\nrecord = {}\nvalue = {:.9g}\n", r.record, r.unit * value);
  text += records + "[control.drive_train]\n" +
          fmt::format("rotor_inertia_kg_m2 = {:.9g}\ngenerator_inertia_kg_m2 = {:.9g}\ngear_ratio = {:.9g}\n",
                      rotor_inertia(ed, rotor), generator, gear);
  if (const double efficiency = deck.number({"GenEff"}, 100.0); efficiency != 100.0)
    text += fmt::format("generator_efficiency = {:.9g}\n", 0.01 * efficiency);
  if (const double brake = deck.number({"HSSBrTqF"}, 0.0); brake > 0.0)
    text += fmt::format("brake_torque_N_m = {:.9g}\n", gear * brake);
  if (rate > 0.0) text += fmt::format("max_pitch_rate_deg_s = {:.9g}\n", rate);
  if (ed.flag({"DrTrDOF"}, false) && generator > 0.0) {
    text += fmt::format("shaft_stiffness_N_m_rad = {:.9g}\nshaft_damping_N_m_s_rad = {:.9g}\n", ed.number({"DTTorSpr"}),
                        ed.number({"DTTorDmp"}, 0.0));
    run.carry("shaft: its twist");
    control.shaft_twists = true;
  }
  run.carry(fmt::format("control: {}", deck.path({"DLL_FileName"}).filename().string()));
  const double interval = deck.number({"DLL_DT"}, 0.0), steps = interval > 0.0 ? window / interval : 0.0;
  if (steps >= 1.0 && std::abs(steps - std::round(steps)) < 1e-6 * steps && interval <= bodies.longest * (1.0 + 1e-9))
    control.step = interval;
  else
    run.leave_out(fmt::format("DLL_DT: the library is called every {} s, the bodies' step", bodies.step));
  if (deck.integer({"DLL_NumTrq"}, 0) > 0) run.leave_out("the table of torque over speed for the library (DLL_NumTrq)");
  if (deck.flag({"EXavrSWAP_Enable"}, false)) run.leave_out("records from 1000 on (EXavrSWAP_Enable)");
  if (deck.flag({"DLL_Ramp"}, false)) run.leave_out("DLL_Ramp: pitch is asked for in steps");
  if (ed.number({"GBoxEff"}, 100.0) != 100.0) run.leave_out("GBoxEff: the gear has no loss");
  run.leave_out("moments of the blades' roots and of the hub are 0 to the library (records 30 to 32, 69 to 78)");
  return control;
}

/// Times from which ServoDyn does what a scene does by control.events.
void list_times(DeckImport& run, const Deck& servodyn, double end_s) {
  for (const auto& [key, what] : {std::pair{"TPitManS(1)", "the pitch manoeuvre"}, std::pair{"TimGenOf", "the generator's stop"},
                                  std::pair{"THSSBrDp", "the brake"}, std::pair{"TYawManS", "the yaw manoeuvre"}})
    if (servodyn.number({key}, end_s) < end_s) run.leave_out(fmt::format("{}: {}; see control.events", key, what));
  for (const char* key : {"TPCOn", "TimGenOn", "TYCOn"})
    if (const double from = servodyn.number({key}, 0.0); from > 0.0 && from < end_s)
      run.leave_out(fmt::format("{} {:g} s: control acts from the start", key, from));
}

}  // namespace

ImportedControl import_control(DeckImport& run, const Deck& ed, const RotorFrame& rotor, bool has_rotor, TimeSteps bodies) {
  const bool turns = ed.flag({"GenDOF"}, false);
  if (run.main.integer({"CompServo"}, 0) != 1) {
    if (turns) run.leave_out_part("GenDOF without ServoDyn: the rotor keeps its speed");
    return {};
  }
  const Deck deck(run.main.path({"ServoFile"}));
  deck.require({{"PCMode", 0, 5},
                {"VSContrl", 0, 5},
                {"GenEff", 1, 100},
                not_negative("HSSBrTqF"),
                not_negative("DLL_DT"),
                {"Ptch_Cntrl", 0, 1},
                angle("Ptch_SetPnt"),
                angle("Ptch_Min"),
                angle("Ptch_Max"),
                not_negative("PtchRate_Max"),
                not_negative("GenPwr_Dem"),
                not_negative("Gain_OM"),
                not_negative("GenSpd_MinOM"),
                not_negative("GenSpd_MaxOM"),
                not_negative("GenSpd_Dem"),
                not_negative("GenTrq_Dem"),
                not_negative("DLL_NumTrq"),
                angle("NacYaw_North")});
  if (deck.has("Ptch_Min") && deck.number({"Ptch_Max"}, 90.0) < deck.number({"Ptch_Min"}, 0.0))
    deck.fail(deck.find({"Ptch_Min"}), "Ptch_Min is more than Ptch_Max");
  for (const char* key : {"YCMode", "HSSBrMode", "AfCmode", "CCmode", "NumBStC", "NumNStC", "NumTStC", "NumSStC"})
    if (const int mode = deck.integer({key}, 0); mode != 0) run.leave_out(fmt::format("ServoDyn's {} {}", key, mode));
  list_times(run, deck, run.main.number({"TMax"}));
  std::string why;
  if (!has_rotor)
    why = "there are no aerodynamics";
  else if (!turns)
    why = "GenDOF is off";
  else if (deck.integer({"PCMode"}, 0) != 5 || deck.integer({"VSContrl"}, 0) != 5)
    why = "pitch and torque are not both those of a library (PCMode and VSContrl 5)";
  else if (const std::filesystem::path library = deck.path({"DLL_FileName"}); !std::filesystem::exists(library))
    why = fmt::format("its library {} is not there", library.string());
  if (why.empty()) return library(run, deck, ed, rotor, bodies);
  run.leave_out_part(
      fmt::format("ServoDyn ({}): the rotor keeps its speed and pitch; give [control] (about the shaft the rotor has {:.6g} kg "
                  "m2, which then come off the body's inertia, the generator {:.6g})",
                  why, rotor_inertia(ed, rotor), generator_inertia(ed)));
  return {};
}

}  // namespace spindrift::decks
