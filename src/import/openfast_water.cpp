// [sea] of a scene from HydroDyn: potential flow, strips, matrices, and what they make of the platform.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <optional>

#include "src/import/hydrodyn_members.hpp"
#include "src/import/openfast_sections.hpp"

namespace spindrift::decks {

namespace {

Eigen::Vector3d potential_origin(const Deck& hd) {
  return {hd.number({"PtfmRefxt"}, 0.0), hd.number({"PtfmRefyt"}, 0.0), hd.number({"PtfmRefzt"}, 0.0)};
}

/// Drift and sums of frequencies: a number in the deck is the ending of WAMIT's file.
template <class With>
std::string second_order(DeckImport& run, const Deck& hd, const With& with, const std::string& name, bool still) {
  std::string text;
  for (const auto& [key, drift] :
       {std::pair{"MnDrift", "mean"}, std::pair{"NewmanApp", "newman"}, std::pair{"DiffQTF", "full"}, std::pair{"SumQTF", ""}}) {
    const int kind = hd.integer({key}, 0);
    if (kind == 0) continue;
    const bool pairs = key == std::string("DiffQTF") || key == std::string("SumQTF");
    if (kind < (pairs ? 10 : 7) || kind > 12)
      hd.fail(hd.find({key}), fmt::format("is {}: {} are known", kind, pairs ? "0, 10, 11 and 12" : "0 and 7 to 12"));
    if (still) {
      run.leave_out_part(fmt::format("{} {}: there are no waves", key, kind));
      continue;
    }
    const std::string ending = fmt::format(".{}{}", kind, kind < 10 ? "" : drift[0] == '\0' ? "s" : "d");
    run.copy(with(ending.c_str()));
    text += drift[0] == '\0' ? fmt::format("sum_frequency_file = \"{}{}\"\n", name, ending)
                             : fmt::format("drift = \"{}\"\ndrift_file = \"{}{}\"\n", drift, name, ending);
  }
  return text;
}

/// A file of exciting forces that are zero, for waves that act on the strips alone (ExctnMod 0).
std::string no_excitation(DeckImport& run) {
  std::ofstream out(run.folder / "no_excitation.3");
  for (const int period : {100, 1})
    for (const int heading : {-90, 0, 90, 180}) out << period << " " << heading << " 3 0 0 0 0\n";
  run.carry("no exciting force of the waves (ExctnMod 0): no_excitation.3 is zero");
  return "excitation_file = \"no_excitation.3\"\n";
}

std::string potential_flow(DeckImport& run, const Deck& hd, bool still) {
  const std::filesystem::path root = hd.beside(hd.text({"PotFile"}));
  const auto with = [&](const char* ending) { return std::filesystem::path(root.string() + ending); };
  run.copy(with(".1")), run.copy(with(".hst"));
  const std::string name = root.filename().string();
  std::string text = fmt::format(
      "\n[sea.potential]\nbody = \"platform\"\nradiation_file = \"{}.1\"\nhydrostatics_file = \"{}.hst\"\n", name, name);
  const int excitation = hd.integer({"ExctnMod"}, 1), displaced = hd.integer({"ExctnDisp"}, 0);
  if (excitation == 2) run.leave_out("the state space of the excitation (ExctnMod 2): the .3 file's harmonics instead");
  if (excitation > 0 && displaced > 0 && !still)
    run.leave_out(fmt::format("excitation where the body has moved to (ExctnDisp {}): here it is that at its place", displaced));
  if (excitation == 0) {
    if (!still) text += no_excitation(run);
  } else if (std::filesystem::exists(with(".3")))
    run.copy(with(".3")), text += fmt::format("excitation_file = \"{}.3\"\n", name);
  else if (!still)
    run.copy(with(".3"));
  else
    run.leave_out_part(name + ".3 is not there: the scene has no excitation, and no waves");
  const Eigen::Vector3d origin = potential_origin(hd);
  if (origin.norm() > 0.0) text += "point_m = " + toml_vector(origin) + "\n";
  if (hd.number({"PtfmRefztRot"}, 0.0) != 0.0) hd.fail(hd.find({"PtfmRefztRot"}), "is not 0: turned WAMIT axes are not known");
  text +=
      fmt::format("length_m = {:.9g}\nvolume_m3 = {:.9g}\nbuoyancy_centre_m = [{:.9g}, {:.9g}]\n", hd.number({"WAMITULEN"}, 1.0),
                  hd.number({"PtfmVol0"}), hd.number({"PtfmCOBxt"}, 0.0), hd.number({"PtfmCOByt"}, 0.0));
  if (hd.integer({"RdtnMod"}, 1) == 0) text += "radiation = \"none\"\n";
  if (hd.integer({"RdtnMod"}, 1) == 1) text += fmt::format("memory_s = {:.9g}\n", hd.number({"RdtnTMax"}, 60.0));
  if (hd.integer({"RdtnMod"}, 1) == 2) {
    run.leave_out("the matrices of the radiation's state space (RdtnMod 2, .ss): convolution with the .1 file instead");
  }
  return text + second_order(run, hd, with, name, still);
}

std::string matrices(const Deck& hd) {
  std::string text;
  bool any = false;
  text += "\n[[sea.matrices]]\nbody = \"platform\"\n";
  if (const Eigen::Vector3d origin = potential_origin(hd); origin.norm() > 0.0) text += "point_m = " + toml_vector(origin) + "\n";
  for (const auto& [deck, key] :
       {std::pair{"AddCLin", "stiffness"}, std::pair{"AddBLin", "damping"}, std::pair{"AddBQuad", "quadratic_damping"}}) {
    const auto line = hd.find({deck});
    if (!line) hd.fail(hd.mention(deck), fmt::format("has no row of six numbers before {}", deck));
    std::string rows;
    bool zero = true;
    for (std::size_t i = 0; i < 6; ++i) {
      const std::vector<double> row = hd.numbers(*line + i, 6);
      rows +=
          fmt::format("  [{:.9g}, {:.9g}, {:.9g}, {:.9g}, {:.9g}, {:.9g}],\n", row[0], row[1], row[2], row[3], row[4], row[5]);
      for (double x : row) zero = zero && x == 0.0;
    }
    if (zero) continue;
    any = true;
    text += fmt::format("{} = [\n{}]\n", key, rows);
  }
  return any ? text : "";
}

/// A constant load; one value per line, with the name on the first.
std::string added_force(const Deck& hd) {
  if (const auto line = hd.find({"AddF0"})) {
    Eigen::Matrix<double, 6, 1> load;
    for (std::size_t i = 0; i < 6; ++i) load[Eigen::Index(i)] = hd.numbers(*line + i, 1)[0];
    if (load.norm() > 0.0)
      return fmt::format("\n[[bodies.platform.forces]]\npoint_m = {}\nforce_N = {}\nmoment_N_m = {}\n",
                         toml_vector(potential_origin(hd)), toml_vector(load.head<3>()), toml_vector(load.tail<3>()));
  }
  return "";
}

/// [sea] has the coefficients of the first member, [[sea.coefficients]] those that differ.
std::string coefficients(DeckImport& run, const std::vector<Member>& all, bool potential, bool linear_waves) {
  if (all.empty()) return "";
  struct Keys {
    double drag, added, axial_drag, axial_added, end_axial_drag, end_axial_added;
    explicit Keys(const Member& m)
        : drag(0.5 * (m.start.drag + m.end.drag)),
          added(0.5 * (m.start.added_mass + m.end.added_mass)),
          axial_drag(m.start.axial_drag),
          axial_added(m.start.axial_added_mass),
          end_axial_drag(m.end.axial_drag),
          end_axial_added(m.end.axial_added_mass) {}
  };
  const Keys first(all[0]);
  std::string text = fmt::format("drag_coefficient = {:.9g}\naxial_drag_coefficient = {:.9g}\nstrip_length_m = {:.9g}\n",
                                 first.drag, first.axial_drag, all[0].strip_length);
  if (!potential)
    text +=
        fmt::format("added_mass_coefficient = {:.9g}\naxial_added_mass_coefficient = {:.9g}\n", first.added, first.axial_added);
  std::string outside;
  for (const Member& m : all) {
    const Keys k(m);
    std::string own;
    const auto key = [&](const char* name, double value, double otherwise) {
      if (value != otherwise) own += fmt::format("{} = {:.9g}\n", name, value);
    };
    key("drag_coefficient", k.drag, first.drag);
    key("axial_drag_coefficient", k.axial_drag, first.axial_drag);
    key("end_axial_drag_coefficient", k.end_axial_drag, k.axial_drag);
    if (!potential) {
      key("added_mass_coefficient", k.added, first.added);
      key("axial_added_mass_coefficient", k.axial_added, first.axial_added);
      key("end_axial_added_mass_coefficient", k.end_axial_added, k.axial_added);
      if (m.diffracts && linear_waves) own += "diffraction = \"maccamy_fuchs\"\n";
    }
    if (!own.empty()) text += fmt::format("\n[[sea.coefficients]]\ncylinder = \"{}\"\n{}", m.name, own);
    if (potential && !m.potential) outside += (outside.empty() ? "" : ", ") + m.name;
  }
  if (!outside.empty())
    run.leave_out_part("buoyancy and inertia of members outside the potential flow (PropPot false): " + outside);
  return text;
}

/// Members as cylinders of the body.
std::string cylinders(const std::vector<Member>& members) {
  std::string text;
  for (const Member& m : members) {
    text += fmt::format("\n[[bodies.platform.cylinders]]\nname = \"{}\"\nstart_m = {}\nend_m = {}\ndiameter_m = {:.9g}\n", m.name,
                        toml_vector(m.start.at), toml_vector(m.end.at), m.start.diameter);
    if (m.start.diameter != m.end.diameter) text += fmt::format("end_diameter_m = {:.9g}\n", m.end.diameter);
  }
  return text;
}

void refuse_unknown_water(const Deck& hd, const Deck& waves) {
  waves.require({not_negative("WaveHs"),    angle("WaveDir"),           {"WavePkShp", 0, 7},       {"WaveDirMod", 0, 1},
                 {"ConstWaveMod", 0, 2},    not_negative("CrestTime"),  not_negative("WvHiCOff"),  not_negative("WvLowCOffD"),
                 not_negative("WvHiCOffD"), not_negative("WvLowCOffS"), not_negative("WvHiCOffS"), {"CurrMod", 0, 2},
                 {"WaveStMod", 0, 3},       not_negative("CurrSSV0"),   not_negative("CurrNSV0"),  not_negative("CurrNSRef"),
                 not_negative("CurrDIV"),   angle("CurrSSDir"),         angle("CurrNSDir"),        angle("CurrDIDir")});
  const int model = wave_model(waves);
  if ((model < 0 || model > 7) && model != 10)
    waves.fail(waves.find({"WaveMod"}), fmt::format("WaveMod is {}: 0 to 7, or 1P and a phase, is wanted", model));
  if (model == 1 || model == 2 || model == 10) waves.require({positive("WaveTp")});
  if (model == 2 && waves.integer({"ConstWaveMod"}, 0) != 0) waves.require({positive("CrestHmax")});
  if (waves.integer({"WaveDirMod"}, 0) == 1) waves.require({positive("WaveDirSpread"), {"WaveDirRange", 0, 360}});
  hd.require({{"PotMod", 0, 2},
              {"ExctnMod", 0, 2},
              {"ExctnDisp", 0, 2},
              {"RdtnMod", 0, 2},
              not_negative("RdtnTMax"),
              {"NBody", 1, 1e5},
              positive("WAMITULEN"),
              not_negative("PtfmVol0")});
  if (hd.integer({"NBody"}, 1) > 1) hd.fail(hd.find({"NBody"}), "has several bodies: one is carried over");
}

}  // namespace

ImportedWater import_water(DeckImport& run, double depth, double water_density) {
  const Deck hd(run.main.path({"HydroFile"}));
  const bool old = !run.main.has("SeaStFile");
  std::optional<Deck> sea_state;
  if (!old && run.main.integer({"CompSeaSt"}, 1) == 1) sea_state.emplace(run.main.path({"SeaStFile"}));
  const Deck& waves = sea_state ? *sea_state : hd;
  refuse_unknown_water(hd, waves);
  const bool potential = hd.integer({"PotMod"}, 0) == 1;
  if (hd.integer({"PotMod"}, 0) == 2) run.leave_out_part("FIT (PotMod 2)");
  run.leave_out_unless(
      hd, {{"PtfmRefY", "the yaw about which the loads are taken"}, {"AMMod", "the height up to which added mass counts"}});
  if (waves.flag({"WaveNDAmp"}, false))
    run.leave_out("WaveNDAmp: amplitudes of a sea state that are drawn by lot; they follow the spectrum");
  const bool still = wave_model(waves) == 0;

  const std::vector<Member> all = read_members(hd, depth, potential, run.left_out);
  std::string sea = fmt::format("\n[sea]\nmodel = \"{}\"\n", potential ? "potential" : "morison");
  const MassSum ballast = read_ballast(hd, all, water_density);
  const std::string strips = coefficients(run, all, potential, !still);
  sea += import_current(run, waves, depth) + strips;
  if (potential)
    sea += potential_flow(run, hd, still);
  else
    for (const char* key : {"MnDrift", "NewmanApp", "DiffQTF", "SumQTF"})
      if (hd.integer({key}, 0) != 0) run.leave_out(fmt::format("{} without PotMod 1", key));
  const std::string added = matrices(hd), force = added_force(hd);
  if (!potential && !(added + force).empty())
    run.leave_out("AddF0, AddCLin, AddBLin, AddBQuad: HydroDyn has them with PotMod 1 alone");
  if (potential) sea += added;
  const std::string platform = cylinders(all) + (potential ? force : "");
  const bool diffracts = std::ranges::any_of(all, &Member::diffracts);
  sea += import_waves(run, waves,
                      potential   ? "the sea is potential flow, which is linear in the waves"
                      : diffracts ? "members diffract (MacCamy & Fuchs), which is linear in the waves"
                                  : "");
  run.carry(fmt::format("sea: {}", potential ? "potential flow with drag of strips" : "Morison strips"));
  return {sea, platform, ballast};
}

}  // namespace spindrift::decks
