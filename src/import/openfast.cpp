// SPDX-License-Identifier: Apache-2.0
#include "src/import/openfast.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>

#include "kernels/base/constants.hpp"
#include "src/import/hydrodyn_members.hpp"
#include "src/import/openfast_parts.hpp"
#include "src/scene/error.hpp"

namespace spindrift::decks {

namespace {

std::string vector(const Eigen::Vector3d& v) {
  // Round-off of sines and cosines is nothing that a reader should see.
  const auto clean = [&](double x) { return std::abs(x) < 1e-9 * std::max(1.0, v.norm()) ? 0.0 : x; };
  return fmt::format("[{:.10g}, {:.10g}, {:.10g}]", clean(v.x()), clean(v.y()), clean(v.z()));
}

/// One deck on its way to a scene.
class Importer {
 public:
  Importer(const std::filesystem::path& main_file, const std::filesystem::path& folder, ImportedTower tower,
           ImportedBlades blades)
      : main_(main_file), folder_(folder), tower_(tower), blades_(blades) {}

  Imported run() {
    if (!main_.has("EDFile"))
      main_.fail(std::nullopt, "has no line for EDFile: this is not an OpenFAST main file (version 3 to 5)");
    main_.require({positive("TMax"),
                   positive("Gravity"),
                   positive("KinVisc"),
                   positive("SpdSound"),
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
    if (main_.integer({"CompElast"}, 1) == 3) main_.fail(main_.find({"CompElast"}), "is 3: simplified ElastoDyn is not known");
    if (const auto line = main_.find({"MHK"}); line && (main_.words(*line)[0] == "1" || main_.words(*line)[0] == "2"))
      main_.fail(line, "has MHK: a rotor in the water is not known");
    elastodyn_.emplace(main_.path({"EDFile"}));
    std::filesystem::create_directories(folder_);
    rotor_ = rotor_frame(*elastodyn_);
    if (main_.integer({"CompElast"}, 1) == 2)
      for (int b = 1; b <= rotor_.blades; ++b)
        rotor_.beamdyn_blades.push_back(Deck(main_.path({fmt::format("BDBldFile({})", b)})).path({"BldFile"}));
    bends_ = tower_ == ImportedTower::as_in_deck && tower_moves();
    if (bends_) step_ = flexible_step;
    wet_ = main_.integer({"CompHydro"}, 0) == 1;
    floats_ = wet_ && main_.integer({"CompSub"}, 0) == 0;
    environment();
    if (wet_) hydro();
    body();
    wind_and_rotor();
    if (floats_) moorings();
    servo();
    structure();
    write();
    return {folder_ / "scene.toml", left_out_, carried_};
  }

 private:
  void leave_out(std::string what) { left_out_.push_back(std::move(what)); }
  void carry(std::string what) { carried_.push_back(std::move(what)); }

  /// Of the main file, or, in decks before version 3, of the module that uses it.
  double given(const char* name, const char* file, double otherwise) const {
    return main_.has(name) ? main_.number({name}, otherwise) : Deck(main_.path({file})).number({name}, otherwise);
  }

  void environment() {
    gravity_ = main_.number({"Gravity"}, elastodyn_->number({"Gravity"}, 9.80665));
    scene_ << fmt::format("\n[environment]\ngravity_m_s2 = {:.9g}\n", gravity_);
    if (main_.integer({"CompAero"}, 0) == 2) main_.require({positive("AirDens")});
    if (main_.integer({"CompAero"}, 0) == 2)
      scene_ << fmt::format("air_density_kg_m3 = {:.9g}\n", given("AirDens", "AeroFile", 1.225));
    if (!wet_) return;
    main_.require({positive("WtrDens"), positive("WtrDpth")});
    depth_ = given("WtrDpth", "HydroFile", 200.0), water_density_ = given("WtrDens", "HydroFile", 1025.0);
    scene_ << fmt::format("water_density_kg_m3 = {:.9g}\nwater_depth_m = {:.9g}\n", water_density_, depth_);
    if (given("MSL2SWL", "HydroFile", 0.0) != 0.0) leave_out("MSL2SWL: still water is at the mean level");
  }

  bool tower_moves() const {
    return std::ranges::any_of(tower_freedoms, [&](const char* f) { return elastodyn_->flag({f}, false); });
  }

  /// Mass, inertia and centre of a body, as a scene has them.
  void mass_keys(const MassSum& sum) {
    Eigen::Matrix3d inertia = sum.inertia();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        if (std::abs(inertia(i, j)) < 1e-9 * inertia.trace()) inertia(i, j) = 0.0;
    scene_ << fmt::format("mass_kg = {:.10g}\ninertia_kg_m2 = [\n", sum.mass());
    for (int i = 0; i < 3; ++i)
      scene_ << fmt::format("  [{:.10g}, {:.10g}, {:.10g}],\n", inertia(i, 0), inertia(i, 1), inertia(i, 2));
    scene_ << "]\ncentre_m = " << vector(sum.centre()) << "\n";
  }

  /// Nacelle, hub and blades on the tower's top; `moved` and `turned` (degrees) are the platform's, about `reference`.
  void flexible_tower(const Eigen::Vector3d& moved, const Eigen::Vector3d& turned, const Eigen::Vector3d& reference) {
    const MassSum top = top_masses(*elastodyn_, rotor_);
    const ImportedBeam beam = tower_beam(*elastodyn_);
    scene_ << "\n[bodies.nacelle]                        # nacelle, hub and blades\n";
    mass_keys(top);
    if (floats_ && (moved.norm() > 0.0 || turned.norm() > 0.0)) {
      const Eigen::Vector3d angle = radians_per_degree * turned, arm = top.centre() - reference;
      const Eigen::Matrix3d turn =
          (Eigen::AngleAxisd(angle.z(), Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(angle.y(), Eigen::Vector3d::UnitY()) *
           Eigen::AngleAxisd(angle.x(), Eigen::Vector3d::UnitX()))
              .toRotationMatrix();
      scene_ << "displacement_m = " << vector(moved + turn * arm - arm) << "\nrotation_deg = " << vector(turned) << "\n";
    }
    std::ofstream(folder_ / "tower.csv") << beam.properties;
    scene_ << "\n[beams.tower]\nbodies = [\"" << (has_platform() ? "platform" : "earth")
           << "\", \"nacelle\"]\nstart_m = " << vector({0.0, 0.0, beam.base}) << "\nend_m = " << vector({0.0, 0.0, beam.top})
           << "\nproperties = \"tower.csv\"\n"
           << fmt::format("damping = [{:.9g}, {:.9g}]\n", beam.damping[0], beam.damping[1]);
    carry(fmt::format(
        "tower: flexible, {:.6g} m, two modes fore-aft and two side-side of its mass and stiffness, damping {:.3g} and "
        "{:.3g} % of critical",
        beam.top - beam.base, 100.0 * beam.damping[0], 100.0 * beam.damping[1]));
    leave_out("the file's shapes of the tower's modes: they are computed; its extension and twist are those of a steel tube");
  }

  /// A flexible tower on land is clamped to the earth.
  bool has_platform() const { return wet_ || !bends_; }

  void body() {
    const Deck& ed = *elastodyn_;
    if (!has_platform()) {
      flexible_tower(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
      return carry(fmt::format("nacelle, hub and blades: {:.6g} kg", top_masses(ed, rotor_).mass()));
    }
    int free = 0;
    for (const char* freedom : {"PtfmSgDOF", "PtfmSwDOF", "PtfmHvDOF", "PtfmRDOF", "PtfmPDOF", "PtfmYDOF"})
      free += ed.flag({freedom}, false);
    const bool held = !floats_ || free == 0;
    MassSum sum = bends_ ? platform_masses(ed) : all_masses(ed, rotor_);
    if (ballast_.mass() > 0.0) {
      sum.add(ballast_);
      carry(fmt::format("ballast: {:.6g} kg in filled members", ballast_.mass()));
    }
    if (held && sum.mass() == 0.0)  // as of a foundation of SubDyn: nothing that the scene needs
      sum.add(1.0, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity());
    for (const char* product : {"PtfmXYIner", "PtfmYZIner", "PtfmXZIner"})
      if (ed.number({product}, 0.0) != 0.0) leave_out(fmt::format("the platform's product of inertia {}", product));
    scene_ << (bends_
                   ? "\n[bodies.platform]\n"
                   : "\n[bodies.platform]                       # platform, tower, nacelle, hub and blades as one rigid body\n");
    mass_keys(sum);
    const Eigen::Vector3d reference(ed.number({"PtfmRefxt"}, 0.0), ed.number({"PtfmRefyt"}, 0.0), ed.number({"PtfmRefzt"}, 0.0));
    scene_ << "reference_m = " << vector(reference) << "\n";
    const Eigen::Vector3d moved(ed.number({"PtfmSurge"}, 0.0), ed.number({"PtfmSway"}, 0.0), ed.number({"PtfmHeave"}, 0.0));
    const Eigen::Vector3d turned(ed.number({"PtfmRoll"}, 0.0), ed.number({"PtfmPitch"}, 0.0), ed.number({"PtfmYaw"}, 0.0));
    if (floats_ && moved.norm() > 0.0) scene_ << "displacement_m = " << vector(moved) << "\n";
    if (floats_ && turned.norm() > 0.0) scene_ << "rotation_deg = " << vector(turned) << "\n";
    scene_ << cylinders_;
    if (bends_) flexible_tower(moved, turned, reference);
    carry(fmt::format("body: {:.6g} kg, centre {}", sum.mass(), vector(sum.centre())));
    if (floats_ && free > 0 && free < 6)
      leave_out(fmt::format("{} of the platform's six motions are held in the deck; here all are free", 6 - free));
    if (held)
      scene_ << "\n[joints.foundation]\ntype = \"fixed\"\nbodies = [\"earth\", \"platform\"]\npoint_m = [0.0, 0.0, 0.0]\n";
  }

  // Wind and rotor.

  std::string wind(const Deck& w) {
    w.require({{"WindType", 1, 7}, not_negative("HWindSpeed"), {"PLexp", -1, 1}, angle("PropagationDir"), {"VFlowAng", -90, 90}});
    const int type = w.integer({"WindType"}, 1);
    if (type == 1) w.require({positive("RefHt")});
    std::string text = "\n[wind]\n";
    const double speed = w.number({"HWindSpeed"}, 0.0), height = w.number({"RefHt"}, rotor_.hub.z()),
                 exponent = w.number({"PLexp"}, 0.0);
    if (type == 1) {
      text += fmt::format("speed_m_s = {:.9g}\n", speed);
      if (exponent != 0.0)
        text += fmt::format("profile = \"power_law\"\nreference_height_m = {:.9g}\nshear_exponent = {:.9g}\n", height, exponent);
      carry(fmt::format("wind: steady {:.4g} m/s", speed));
    } else if (type == 3) {
      const std::filesystem::path box = w.path({"FileName_BTS", "Filename"});
      copy(box);
      text += fmt::format("[wind.turbulence]\nmodel = \"bts\"\nfile = \"{}\"\n", box.filename().string());
      carry("wind: " + box.filename().string());
    } else if (type == 5) {
      text += mann(w);
    } else if (type == 2) {
      text += uniform(w);
    } else {
      leave_out(fmt::format("wind of WindType {}: there is none in the scene", type));
      text += "speed_m_s = 0.0\n";
    }
    if (const double to = w.number({"PropagationDir"}, 0.0); to != 0.0) {
      // InflowWind counts clockwise seen from above, the scene from x towards y.
      const std::size_t at = text.find("[wind]\n") + 7;
      text.insert(at, fmt::format("direction_deg = {:.9g}\n", -to));
    }
    if (w.number({"VFlowAng"}, 0.0) != 0.0) leave_out("VFlowAng: the wind is level");
    return text;
  }

  std::string mann(const Deck& w) {
    w.require({positive("URef"),
               {"nx", 2, 1e6},
               {"ny", 2, 1e6},
               {"nz", 2, 1e6},
               positive("dx"),
               positive("dy"),
               positive("dz"),
               {"ScaleMethod", 0, 2}});
    std::string files;
    for (const char* name : {"FileName_u", "FileName_v", "FileName_w"}) {
      const std::filesystem::path path = w.path({name});
      copy(path);
      files += fmt::format("{}\"{}\"", files.empty() ? "" : ", ", path.filename().string());
    }
    if (w.integer({"ScaleMethod"}, 0) != 0) leave_out("ScaleMethod: the Mann box is not scaled");
    carry("wind: Mann box");
    return fmt::format(
        "speed_m_s = {:.9g}\n[wind.turbulence]\nmodel = \"mann\"\nfiles = [{}]\npoints = [{}, {}, {}]\nspacing_m = [{:.9g}, "
        "{:.9g}, "
        "{:.9g}]\n",
        w.number({"URef"}), files, w.integer({"nx"}, 0), w.integer({"ny"}, 0), w.integer({"nz"}, 0), w.number({"dx"}),
        w.number({"dy"}), w.number({"dz"}));
  }

  /// Uniform wind in time: time, speed, direction, vertical speed, shears, gust.
  std::string uniform(const Deck& w) {
    const Deck file(w.path({"FileName_Uni", "Filename"}), '!');
    std::ofstream out(folder_ / "wind.csv");
    out << "# From " << file.file().filename().string() << ".\ntime_s,speed_m_s,direction_deg,vertical_m_s\n";
    double shear = 0.0, before = -std::numeric_limits<double>::infinity();
    bool sheared = false, changes = false;
    for (std::size_t n = 0; n < file.size(); ++n) {
      if (file.words(n).empty()) continue;
      const std::vector<double> row = file.numbers(n, 8);
      if (row[1] < 0.0) file.fail(n, fmt::format("has a wind of {:g} m/s: the second column is a speed, not negative", row[1]));
      if (row[0] <= before) file.fail(n, fmt::format("has a time of {:g} s, not later than the row before", row[0]));
      before = row[0];
      out << fmt::format("{:.9g},{:.9g},{:.9g},{:.9g}\n", row[0], row[1] + row[7], -row[2], row[3]);
      if (n > 0 && row[5] != shear) changes = true;
      shear = row[5];
      sheared = sheared || row[4] != 0.0 || row[6] != 0.0;
    }
    if (sheared) leave_out("horizontal and linear vertical shear of the uniform wind file");
    if (changes) leave_out("changes of the power law's exponent in the uniform wind file: the last is used");
    carry("wind: " + file.file().filename().string());
    std::string text = "table = \"wind.csv\"\n";
    if (shear != 0.0)
      text += fmt::format("profile = \"power_law\"\nreference_height_m = {:.9g}\nshear_exponent = {:.9g}\n",
                          w.number({"RefHt_Uni", "RefHt"}, rotor_.hub.z()), shear);
    return text;
  }

  std::string tower(const Deck& ad) {
    const bool changes_wind = ad.integer({"TwrPotent"}, 0) > 0, drag = ad.flag({"TwrAero"}, false);
    const int wake = ad.integer({"TwrShadow"}, 0);
    if (wake > 0 && !changes_wind)
      leave_out("the tower's wake on a downwind rotor (TwrShadow), which comes with its flow (TwrPotent)");
    if (wake > 1 && changes_wind) leave_out("the wake of TwrShadow 2: that of TwrShadow 1 takes its place");
    if (wake == 0 && changes_wind && rotor_.hub.x() * rotor_.axis.x() > 0.0)
      leave_out("TwrShadow 0: the wake of the tower comes with its flow (TwrPotent) where the rotor is behind it");
    if (ad.integer({"TwrPotent"}, 0) > 1) leave_out("Bak's correction of the flow round the tower (TwrPotent 2)");
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
    carry("tower: " + std::string(changes_wind ? "its flow round the blades" : "") + (changes_wind && drag ? ", " : "") +
          (drag ? "drag" : ""));
    return text;
  }

  /// What takes time in the flow. Decks of version 3 have Wake_Mod 2 for the dynamic wake and AFAeroMod 2 for the unsteady
  /// aerofoils besides.
  std::string unsteady(const Deck& ad, int wake) {
    std::string text;
    const int filter = ad.integer({"DBEMT_Mod"}, 0);
    const bool knows = !ad.has("AFAeroMod"), stalls = knows || ad.integer({"AFAeroMod"}, 1) == 2;
    if (filter > 0 && (wake == 2 || (wake == 1 && knows))) {
      text += "dynamic_inflow = \"oye\"\n";
      if (filter != 2) ad.require({positive("tau1_const")});
      if (filter != 2) text += fmt::format("inflow_time_s = {:.9g}\n", ad.number({"tau1_const"}));
      carry("dynamic inflow after Oye");
    }
    if (const int model = ad.integer({"UA_Mod", "UAMod"}, 0); model > 0 && stalls) {
      // 1 to 3, 4 and 5: kinds of Beddoes and Leishman's model; 6: Oye's.
      const bool leishman = model <= 5;
      text += fmt::format("dynamic_stall = \"{}\"\n", leishman ? "beddoes_leishman" : "oye");
      if (leishman)
        text += fmt::format("speed_of_sound_m_s = {:.9g}\n", main_.number({"SpdSound"}, ad.number({"SpdSound"}, 340.0)));
      if (model != 6)
        leave_out(fmt::format("what the dynamic stall model of UA_Mod {} has beside {}{}", model,
                              leishman ? "Beddoes and Leishman's" : "Oye's",
                              model <= 3 ? ": time constants that change within a stall, of each polar" : ""));
      carry(leishman ? "dynamic stall after Beddoes and Leishman" : "dynamic stall after Oye");
    }
    return text;
  }

  void wind_and_rotor() {
    const Deck& ed = *elastodyn_;
    const bool blows = main_.integer({"CompInflow"}, 0) == 1, aero = main_.integer({"CompAero"}, 0) == 2;
    if (main_.integer({"CompAero"}, 0) == 1) leave_out("AeroDyn 14 or AeroDisk (CompAero 1): no aerodynamics in the scene");
    if (!aero || !blows) {
      carry("no aerodynamics");
      if (any({"FlapDOF1", "FlapDOF2", "EdgeDOF"})) leave_out("bending of the blades: they are rigid without aerodynamics");
      return;
    }
    const Deck ad(main_.path({"AeroFile"}));
    ad.require({{"Wake_Mod", 0, 3},
                {"WakeMod", 0, 3},
                {"TwrPotent", 0, 2},
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
    WrittenTurbine turbine = write_turbine(ad, rotor_, folder_);
    for (std::string& what : turbine.left_out) leave_out(std::move(what));
    scene_ << wind(Deck(main_.path({"InflowFile"})));
    if (ad.integer({"Wake_Mod", "WakeMod"}, 1) == 0)
      leave_out("no induction (Wake_Mod 0): blades are in balance with their wake");
    const int wake = ad.integer({"Wake_Mod", "WakeMod"}, 1);
    if (wake > 2) leave_out("the free-vortex wake (Wake_Mod 3): blade element momentum");
    scene_ << "\n[aero]\nmodel = \"bem\"\ninduction = \"buhl\"\n";
    if (turbine.by_reynolds) {
      scene_ << fmt::format("kinematic_viscosity_m2_s = {:.9g}\n", ad.number({"KinVisc"}, main_.number({"KinVisc"})));
      carry("polars at several Reynolds numbers (AFTabMod 2)");
    }
    scene_ << unsteady(ad, wake) << tower(ad);
    scene_ << fmt::format("\n[rotor]\nbody = \"{}\"\nturbine = \"turbine.toml\"\n", bends_ ? "nacelle" : "platform");
    scene_ << "hub_m = " << vector(rotor_.hub) << "\naxis = " << vector(rotor_.axis) << "\n";
    scene_ << fmt::format("speed_rpm = {:.9g}\nblade_pitch_deg = {:.9g}\n", ed.number({"RotSpeed"}),
                          ed.number({"BlPitch(1)", "BlPitch1"}, 0.0));
    if (const double azimuth = ed.number({"Azimuth"}, 0.0); azimuth != 0.0)
      scene_ << fmt::format("azimuth_deg = {:.9g}\n", azimuth);
    blade_bending();
    carry(fmt::format("rotor: {} blades, {:.4g} rpm, blade pitch {:.4g} deg", rotor_.blades, ed.number({"RotSpeed"}),
                      ed.number({"BlPitch(1)", "BlPitch1"}, 0.0)));
  }

  bool any(std::initializer_list<const char*> freedoms) const {
    return std::any_of(freedoms.begin(), freedoms.end(), [&](const char* f) { return elastodyn_->flag({f}, false); });
  }

  /// Follows [rotor].
  void blade_bending() {
    if (!any({"FlapDOF1", "FlapDOF2", "EdgeDOF"})) return;
    if (blades_ == ImportedBlades::rigid) return leave_out("bending of the blades: they are rigid (--rigid-blades)");
    if (!rotor_.beamdyn_blades.empty()) return leave_out("bending of BeamDyn's blades: they are rigid");
    const ImportedBending bending = decks::blade_bending(*elastodyn_, rotor_);
    // Half a radian of the fastest mode to a step, whole steps to a window.
    const double turning = elastodyn_->number({"RotSpeed"}) * rad_s_per_rpm, fastest = std::hypot(bending.fastest, 2.0 * turning);
    longest_step_ = window / std::ceil(window * fastest / 0.5);
    step_ = std::min(step_, longest_step_);
    std::ofstream(folder_ / "blade_structure.csv") << bending.structure;
    scene_ << fmt::format("blade_structure = \"blade_structure.csv\"\nblade_damping = [{:.9g}, {:.9g}, {:.9g}]\n",
                          bending.damping[0], bending.damping[1], bending.damping[2]);
    carry("blades that bend, two modes flapwise and one edgewise, from their mass and stiffness");
    if (!any({"FlapDOF1"}) || !any({"FlapDOF2"}) || !any({"EdgeDOF"}))
      leave_out("FlapDOF1, FlapDOF2, EdgeDOF: not all are on, the blades here bend in all three");
    if (elastodyn_->number({"TipMass(1)", "TipMass1"}, 0.0) != 0.0) leave_out("TipMass in the bending of the blades");
    if (!bending.alike) leave_out("differences between the blades: all bend as blade 1");
  }

  void servo() {
    const bool turns = elastodyn_->flag({"GenDOF"}, false);
    if (main_.integer({"CompServo"}, 0) != 1) {
      if (turns) leave_out("GenDOF without ServoDyn: the rotor keeps its speed");
      return;
    }
    const Deck deck(main_.path({"ServoFile"}));
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
      if (const int mode = deck.integer({key}, 0); mode != 0) leave_out(fmt::format("ServoDyn's {} {}", key, mode));
    const bool rotor = scene_.str().find("[rotor]") != std::string::npos;
    std::string why;
    if (!rotor)
      why = "there are no aerodynamics";
    else if (!turns)
      why = "GenDOF is off";
    else if (deck.integer({"PCMode"}, 0) != 5 || deck.integer({"VSContrl"}, 0) != 5)
      why = "pitch and torque are not both those of a library (PCMode and VSContrl 5)";
    else if (const std::filesystem::path library = deck.path({"DLL_FileName"}); !std::filesystem::exists(library))
      why = fmt::format("its library {} is not there", library.string());
    if (why.empty()) return library(deck);
    leave_out(fmt::format(
        "ServoDyn ({}): the rotor keeps its speed and pitch; give [control] (inertia of rotor and generator about the "
        "shaft: {:.6g} kg m2)",
        why, rotor_inertia(*elastodyn_, rotor_)));
  }

  /// A library with Bladed's interface, where the deck has it: it may look for files beside itself.
  void library(const Deck& deck) {
    const auto absolute = [](const std::filesystem::path& path) {
      return std::filesystem::absolute(path).lexically_normal().string();
    };
    const double gear = elastodyn_->number({"GBRatio"}, 1.0), generator = gear * gear * elastodyn_->number({"GenIner"}, 0.0);
    scene_ << "\n[control]\nmodel = \"library\"\nlibrary = \"" << absolute(deck.path({"DLL_FileName"})) << "\"\n";
    if (const std::string input = deck.text({"DLL_InFile"}); std::filesystem::is_regular_file(deck.beside(input)))
      scene_ << "input_file = \"" << absolute(deck.beside(input)) << "\"\n";
    else
      leave_out(fmt::format("DLL_InFile {} is not there: the library is given no file", input));
    if (deck.has("DLL_ProcName")) scene_ << "procedure = \"" << deck.text({"DLL_ProcName"}) << "\"\n";
    if (deck.integer({"Ptch_Cntrl"}, 0) == 1) scene_ << "individual_pitch = true\n";
    struct Record {
      int record;
      const char* name;
      double unit;
    };
    const double rate = deck.number({"PtchRate_Max"}, 0.0);
    std::string records;
    for (const Record& r : {Record{5, "Ptch_SetPnt", radians_per_degree}, Record{6, "Ptch_Min", radians_per_degree},
                            Record{7, "Ptch_Max", radians_per_degree}, Record{8, "PtchRate_Min", radians_per_degree},
                            Record{9, "PtchRate_Max", radians_per_degree}, Record{13, "GenPwr_Dem", 1.0},
                            Record{16, "Gain_OM", 1.0}, Record{17, "GenSpd_MinOM", rad_s_per_rpm},
                            Record{18, "GenSpd_MaxOM", rad_s_per_rpm}, Record{19, "GenSpd_Dem", rad_s_per_rpm},
                            Record{22, "GenTrq_Dem", 1.0}, Record{37, "NacYaw_North", -radians_per_degree}})
      if (const double value = deck.number({r.name}, 0.0); value != 0.0)
        records += fmt::format("[[control.records]]\nrecord = {}\nvalue = {:.9g}\n", r.record, r.unit * value);
    scene_ << records << "[control.drive_train]\n"
           << fmt::format("rotor_inertia_kg_m2 = {:.9g}\ngenerator_inertia_kg_m2 = {:.9g}\ngear_ratio = {:.9g}\n",
                          rotor_inertia(*elastodyn_, rotor_) - generator, generator, gear);
    if (const double efficiency = deck.number({"GenEff"}, 100.0); efficiency != 100.0)
      scene_ << fmt::format("generator_efficiency = {:.9g}\n", 0.01 * efficiency);
    if (const double brake = deck.number({"HSSBrTqF"}, 0.0); brake > 0.0)
      scene_ << fmt::format("brake_torque_N_m = {:.9g}\n", gear * brake);
    if (rate > 0.0) scene_ << fmt::format("max_pitch_rate_deg_s = {:.9g}\n", rate);
    if (elastodyn_->flag({"DrTrDOF"}, false) && generator > 0.0) {
      scene_ << fmt::format("shaft_stiffness_N_m_rad = {:.9g}\nshaft_damping_N_m_s_rad = {:.9g}\n",
                            elastodyn_->number({"DTTorSpr"}), elastodyn_->number({"DTTorDmp"}, 0.0));
      carry("shaft: its twist");
      shaft_twists_ = true;
    }
    carry(fmt::format("control: {}", deck.path({"DLL_FileName"}).filename().string()));
    const double interval = deck.number({"DLL_DT"}, 0.0), steps = interval > 0.0 ? window / interval : 0.0;
    if (steps >= 1.0 && std::abs(steps - std::round(steps)) < 1e-6 * steps && interval <= longest_step_ * (1.0 + 1e-9))
      step_ = interval;
    else
      leave_out(fmt::format("DLL_DT: the library is called every {} s, the bodies' step", step_));
    if (deck.integer({"DLL_NumTrq"}, 0) > 0) leave_out("the table of torque over speed for the library (DLL_NumTrq)");
    if (deck.flag({"EXavrSWAP_Enable"}, false)) leave_out("records from 1000 on (EXavrSWAP_Enable)");
    if (deck.flag({"DLL_Ramp"}, false)) leave_out("DLL_Ramp: pitch is asked for in steps");
    if (elastodyn_->number({"GBoxEff"}, 100.0) != 100.0) leave_out("GBoxEff: the gear has no loss");
    leave_out("moments of the blades' roots and of the hub are 0 to the library (records 30 to 32, 69 to 78)");
  }

  void structure() {
    if (tower_moves() && !bends_) leave_out("bending of the tower: it is rigid (--rigid-tower)");
    if (bends_ && !std::ranges::all_of(tower_freedoms, [&](const char* f) { return elastodyn_->flag({f}, false); }))
      leave_out("TwFADOF1, TwFADOF2, TwSSDOF1, TwSSDOF2: not all are on, the tower here bends in all four modes");
    if (any({"YawDOF", "TeetDOF"})) leave_out("motion of yaw bearing and teeter");
    if (any({"DrTrDOF"}) && !shaft_twists_) leave_out("twist of the shaft: it is rigid where no controller turns the rotor");
    for (const auto& [part, name] :
         {std::pair{"CompSub", "SubDyn: what stands on it is fixed"}, std::pair{"CompIce", "ice"}, std::pair{"CompSoil", "soil"}})
      if (main_.integer({part}, 0) != 0) leave_out(name);
  }

  // Water.

  void copy(const std::filesystem::path& file) {
    if (!std::filesystem::exists(file)) main_.fail(std::nullopt, fmt::format("names {}, which is not there", file.string()));
    std::filesystem::copy_file(file, folder_ / file.filename(), std::filesystem::copy_options::overwrite_existing);
  }

  void hydro() {
    const Deck hd(main_.path({"HydroFile"}));
    const bool old = !main_.has("SeaStFile");
    std::optional<Deck> sea_state;
    if (!old && main_.integer({"CompSeaSt"}, 1) == 1) sea_state.emplace(main_.path({"SeaStFile"}));
    const Deck& waves = sea_state ? *sea_state : hd;
    waves.require({not_negative("WaveHs"),
                   angle("WaveDir"),
                   {"WavePkShp", 0, 7},
                   {"WaveDirMod", 0, 1},
                   {"ConstWaveMod", 0, 2},
                   not_negative("CrestTime"),
                   not_negative("WvHiCOff"),
                   {"CurrMod", 0, 2},
                   not_negative("CurrSSV0"),
                   not_negative("CurrNSV0"),
                   not_negative("CurrNSRef"),
                   not_negative("CurrDIV"),
                   angle("CurrSSDir"),
                   angle("CurrNSDir"),
                   angle("CurrDIDir")});
    const int model = wave_model(waves);
    if ((model < 0 || model > 7) && model != 10)
      waves.fail(waves.find({"WaveMod"}), fmt::format("WaveMod is {}: 0 to 7, or 1P and a phase, is wanted", model));
    if (model == 1 || model == 2 || model == 10) waves.require({positive("WaveTp")});
    if (model == 2 && waves.integer({"ConstWaveMod"}, 0) != 0) waves.require({positive("CrestHmax")});
    if (waves.integer({"WaveDirMod"}, 0) == 1) waves.require({positive("WaveDirSpread"), {"WaveDirRange", 0, 360}});
    hd.require({{"PotMod", 0, 2},
                {"RdtnMod", 0, 2},
                not_negative("RdtnTMax"),
                {"NBody", 1, 1e5},
                positive("WAMITULEN"),
                not_negative("PtfmVol0")});
    if (hd.integer({"NBody"}, 1) > 1) hd.fail(hd.find({"NBody"}), "has several bodies: one is carried over");
    const bool potential = hd.integer({"PotMod"}, 0) == 1;
    if (hd.integer({"PotMod"}, 0) == 2) leave_out("FIT (PotMod 2)");
    const bool still = model == 0;

    std::string sea = fmt::format("\n[sea]\nmodel = \"{}\"\n", potential ? "potential" : "morison");
    sea += current(waves) + members(hd, potential, !still);
    if (potential)
      sea += potential_flow(hd, still);
    else
      for (const char* key : {"MnDrift", "NewmanApp", "DiffQTF", "SumQTF"})
        if (hd.integer({key}, 0) != 0) leave_out(fmt::format("{} without PotMod 1", key));
    sea += matrices(hd);
    water_ = sea + wave_section(waves);
    carry(fmt::format("sea: {}", potential ? "potential flow with drag of strips" : "Morison strips"));
  }

  std::string potential_flow(const Deck& hd, bool still) {
    const std::filesystem::path root = hd.beside(hd.text({"PotFile"}));
    const auto with = [&](const char* ending) { return std::filesystem::path(root.string() + ending); };
    copy(with(".1")), copy(with(".hst"));
    const std::string name = root.filename().string();
    std::string text = fmt::format(
        "\n[sea.potential]\nbody = \"platform\"\nradiation_file = \"{}.1\"\nhydrostatics_file = \"{}.hst\"\n", name, name);
    if (std::filesystem::exists(with(".3")))
      copy(with(".3")), text += fmt::format("excitation_file = \"{}.3\"\n", name);
    else if (!still)
      copy(with(".3"));
    else
      leave_out(name + ".3 is not there: the scene has no excitation, and no waves");
    const Eigen::Vector3d origin = potential_origin(hd);
    if (origin.norm() > 0.0) text += "point_m = " + vector(origin) + "\n";
    if (hd.number({"PtfmRefztRot"}, 0.0) != 0.0) hd.fail(hd.find({"PtfmRefztRot"}), "is not 0: turned WAMIT axes are not known");
    text += fmt::format("length_m = {:.9g}\nvolume_m3 = {:.9g}\nbuoyancy_centre_m = [{:.9g}, {:.9g}]\n",
                        hd.number({"WAMITULEN"}, 1.0), hd.number({"PtfmVol0"}), hd.number({"PtfmCOBxt"}, 0.0),
                        hd.number({"PtfmCOByt"}, 0.0));
    if (hd.integer({"RdtnMod"}, 1) == 0) text += "radiation = \"none\"\n";
    if (hd.integer({"RdtnMod"}, 1) == 1) text += fmt::format("memory_s = {:.9g}\n", hd.number({"RdtnTMax"}, 60.0));
    if (hd.integer({"RdtnMod"}, 1) == 2) {
      leave_out("the matrices of the radiation's state space (RdtnMod 2, .ss): convolution with the .1 file instead");
    }
    return text + second_order(hd, with, name, still);
  }

  /// Drift and sums of frequencies: a number in the deck is the ending of WAMIT's file.
  template <class With>
  std::string second_order(const Deck& hd, const With& with, const std::string& name, bool still) {
    std::string text;
    for (const auto& [key, drift] : {std::pair{"MnDrift", "mean"}, std::pair{"NewmanApp", "newman"}, std::pair{"DiffQTF", "full"},
                                     std::pair{"SumQTF", ""}}) {
      const int kind = hd.integer({key}, 0);
      if (kind == 0) continue;
      const bool pairs = key == std::string("DiffQTF") || key == std::string("SumQTF");
      if (kind < (pairs ? 10 : 7) || kind > 12)
        hd.fail(hd.find({key}), fmt::format("is {}: {} are known", kind, pairs ? "0, 10, 11 and 12" : "0 and 7 to 12"));
      if (still) {
        leave_out(fmt::format("{} {}: there are no waves", key, kind));
        continue;
      }
      const std::string ending = fmt::format(".{}{}", kind, kind < 10 ? "" : drift[0] == '\0' ? "s" : "d");
      copy(with(ending.c_str()));
      text += drift[0] == '\0' ? fmt::format("sum_frequency_file = \"{}{}\"\n", name, ending)
                               : fmt::format("drift = \"{}\"\ndrift_file = \"{}{}\"\n", drift, name, ending);
    }
    return text;
  }

  std::string matrices(const Deck& hd) {
    std::string text;
    bool any = false;
    text += "\n[[sea.matrices]]\nbody = \"platform\"\n";
    if (const Eigen::Vector3d origin = potential_origin(hd); origin.norm() > 0.0) text += "point_m = " + vector(origin) + "\n";
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
    // One value per line, with the name on the first.
    if (const auto line = hd.find({"AddF0"})) {
      Eigen::Matrix<double, 6, 1> load;
      for (std::size_t i = 0; i < 6; ++i) load[Eigen::Index(i)] = hd.numbers(*line + i, 1)[0];
      if (load.norm() > 0.0)
        cylinders_ += fmt::format("\n[[bodies.platform.forces]]\npoint_m = {}\nforce_N = {}\nmoment_N_m = {}\n",
                                  vector(potential_origin(hd)), vector(load.head<3>()), vector(load.tail<3>()));
    }
    return any ? text : "";
  }

  static Eigen::Vector3d potential_origin(const Deck& hd) {
    return {hd.number({"PtfmRefxt"}, 0.0), hd.number({"PtfmRefyt"}, 0.0), hd.number({"PtfmRefzt"}, 0.0)};
  }

  /// Members as cylinders of the body. [sea] has the coefficients of the first, [[sea.coefficients]] those that differ.
  std::string members(const Deck& hd, bool potential, bool linear_waves) {
    const std::vector<Member> all = read_members(hd, depth_, left_out_);
    ballast_ = read_ballast(hd, all, water_density_);
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
      cylinders_ += fmt::format("\n[[bodies.platform.cylinders]]\nname = \"{}\"\nstart_m = {}\nend_m = {}\ndiameter_m = {:.9g}\n",
                                m.name, vector(m.start.at), vector(m.end.at), m.start.diameter);
      if (m.start.diameter != m.end.diameter) cylinders_ += fmt::format("end_diameter_m = {:.9g}\n", m.end.diameter);
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
    if (!outside.empty()) leave_out("buoyancy and inertia of members outside the potential flow (PropPot false): " + outside);
    return text;
  }

  /// SeaState's standard current: the sum of a power law of 1/7 over the depth, a part of the uppermost metres, and one that is
  /// the same at all depths.
  std::string current(const Deck& waves) {
    if (waves.integer({"CurrMod"}, 0) == 0) return "";
    if (waves.integer({"CurrMod"}, 0) != 1) {
      leave_out("the current of a routine (CurrMod 2)");
      return "";
    }
    const auto part = [&](const char* speed, const char* direction, double otherwise) {
      const double v = waves.number({speed}, 0.0), towards = waves.number({direction}, otherwise) * radians_per_degree;
      return Eigen::Vector2d(v * std::cos(towards), v * std::sin(towards));
    };
    const Eigen::Vector2d below = part("CurrSSV0", "CurrSSDir", waves.number({"WaveDir"}, 0.0)),
                          near_surface = part("CurrNSV0", "CurrNSDir", 0.0), uniform = part("CurrDIV", "CurrDIDir", 0.0);
    std::string text;
    if (uniform.norm() > 0.0) text += "current_m_s = " + vector({uniform.x(), uniform.y(), 0.0}) + "\n";
    if (below.norm() + near_surface.norm() > 0.0) {
      const double reach = near_surface.norm() > 0.0 ? waves.number({"CurrNSRef"}) : 0.0;
      text += "current_profile = [\n";
      std::vector<double> levels;
      constexpr int rows = 24;  // denser towards the bed, where the power law is steep
      for (int i = 0; i <= rows; ++i) levels.push_back(depth_ * (std::pow(double(i) / rows, 3.0) - 1.0));
      if (reach > 0.0 && reach < depth_) levels.push_back(-reach);
      std::ranges::sort(levels);
      levels.erase(std::ranges::unique(levels).begin(), levels.end());
      for (const double z : levels) {
        const Eigen::Vector2d v = below * std::pow(std::max(0.0, (z + depth_) / depth_), 1.0 / 7.0) +
                                  near_surface * (reach > 0.0 ? std::max(0.0, (z + reach) / reach) : 0.0);
        text += fmt::format("  [{:.9g}, {:.9g}, {:.9g}],\n", z, v.x(), v.y());
      }
      text += "]\n";
    }
    if (!text.empty()) carry(fmt::format("current: {:.4g} m/s at the surface", (below + near_surface + uniform).norm()));
    return text;
  }

  /// 10 where "1P90" stands: a regular wave of given phase.
  static int wave_model(const Deck& waves) {
    const auto line = waves.find({"WaveMod"});
    if (line && waves.words(*line)[0].rfind("1P", 0) == 0) return 10;
    return waves.integer({"WaveMod"}, 0);
  }

  std::string wave_section(const Deck& waves) {
    const int model = wave_model(waves);
    if (model == 0) return "";
    const double height = waves.number({"WaveHs"}, 0.0), period = waves.number({"WaveTp"}, 0.0);
    if (model == 5) return waves_of_file(waves);
    if (model != 1 && model != 2 && model != 10) {
      leave_out(fmt::format("waves of WaveMod {}", model));
      return "";
    }
    std::string text = fmt::format("\n[waves]\nmodel = \"{}\"\nheight_m = {:.9g}\nperiod_s = {:.9g}\ndirection_deg = {:.9g}\n",
                                   model == 2 ? "jonswap" : "airy", height, period, waves.number({"WaveDir"}, 0.0));
    if (model == 10) {
      const std::size_t line = *waves.find({"WaveMod"});
      // HydroDyn's phase runs with time, the scene's with x.
      text += fmt::format("phase_deg = {:.9g}\n", 0.0 - waves.to_number(waves.words(line)[0].substr(2), line));
    }
    if (model == 1) leave_out("the phase of the regular wave: a crest is at the origin at the start");
    if (model == 2) {
      text += fmt::format("seed = {}\n", std::abs(waves.integer({"WaveSeed(1)", "WaveSeed1"}, 1)));
      if (const double peak = waves.number({"WavePkShp"}, 0.0); peak > 0.0)
        text += fmt::format("peak_enhancement = {:.9g}\n", peak);
      leave_out("the phases of the irregular waves: those of the seed are others than HydroDyn's");
    }
    text += spreading(waves, model);
    if (const int kind = waves.integer({"ConstWaveMod"}, 0); kind != 0 && model == 2) {
      if (kind != 1) leave_out("the trough of the constrained wave (ConstWaveMod 2): half of CrestHmax is its crest");
      text += fmt::format("crest_height_m = {:.9g}\ncrest_time_s = {:.9g}\ncrest_place_m = [{:.9g}, {:.9g}]\n",
                          0.5 * waves.number({"CrestHmax"}), waves.number({"CrestTime"}), waves.number({"CrestXi"}, 0.0),
                          waves.number({"CrestYi"}, 0.0));
      carry(fmt::format("constrained crest of {:.4g} m", 0.5 * waves.number({"CrestHmax"})));
    }
    carry(fmt::format("waves: {} {:.4g} m, {:.4g} s", model == 2 ? "JONSWAP" : "regular", height, period));
    return text;
  }

  std::string spreading(const Deck& waves, int model) {
    if (waves.integer({"WaveDirMod"}, 0) == 0) return "";
    if (model != 2 && model != 5) {
      leave_out("directional spreading of a regular wave");
      return "";
    }
    carry("directional spreading");
    return fmt::format("spreading_exponent = {:.9g}\nspreading_range_deg = {:.9g}\n", waves.number({"WaveDirSpread"}),
                       waves.number({"WaveDirRange"}));
  }

  /// WaveMod 5: an elevation in time, in two columns after lines of heading.
  std::string waves_of_file(const Deck& waves) {
    const Deck file(waves.beside(waves.text({"WvKinFile"}) + ".Elev"), '!');
    std::ofstream out(folder_ / "elevation.csv");
    out << "# From " << file.file().filename().string() << ".\ntime_s,elevation_m\n";
    std::size_t rows = 0;
    for (std::size_t n = 0; n < file.size(); ++n) {
      if (file.words(n).empty()) continue;
      const std::string& first = file.words(n)[0];
      const bool number = first.find_first_not_of("0123456789+-.eEdD") == std::string::npos;
      if (rows == 0 && !number) continue;
      const std::vector<double> row = file.numbers(n, 2);
      out << fmt::format("{:.9g},{:.9g}\n", row[0], row[1]), ++rows;
    }
    if (rows == 0) file.fail(std::nullopt, "has no row of time and elevation");
    carry(fmt::format("waves: {} elevations of {}", rows, file.file().filename().string()));
    std::string text = fmt::format("\n[waves]\nmodel = \"elevation\"\nfile = \"elevation.csv\"\ndirection_deg = {:.9g}\n",
                                   waves.number({"WaveDir"}, 0.0));
    if (const double highest = waves.number({"WvHiCOff"}, 0.0); highest > 0.0)
      text += fmt::format("highest_Hz = {:.9g}\n", highest / (2.0 * pi));
    return text + spreading(waves, 5);
  }

  void moorings() {
    const int kind = main_.integer({"CompMooring"}, 0);
    if (kind == 0) return;
    if (kind != 1 && kind != 3) return leave_out(fmt::format("mooring lines of CompMooring {}", kind));
    const Deck file(main_.path({"MooringFile"}));
    const auto [lines, junctions] = kind == 1 ? read_map(file, depth_, left_out_) : read_moordyn(file, depth_, left_out_);
    if (kind == 3 && file.integer({"WaveKin", "WaterKin"}, 0) == 0 && water_.find("[waves]") != std::string::npos)
      leave_out("MoorDyn's still water round the lines (WaveKin 0): here they feel the scene's waves");
    for (std::size_t n = 0; n < lines.size(); ++n) {
      const ImportedLine& l = lines[n];
      const double weight = gravity_ * (l.mass_per_m - water_density_ * 0.25 * pi * l.diameter * l.diameter);
      if (!(weight > 0.0) || !(l.axial_stiffness > 0.0)) {
        leave_out(fmt::format("line {}: it has no weight in water or no stiffness", n + 1));
        continue;
      }
      const bool meets = !l.at_anchor.empty() || !l.at_fairlead.empty();
      const bool on_bed = !l.at_anchor.empty() || l.anchor.z() <= -depth_ + 1e-6 * depth_;
      scene_ << fmt::format("\n[moorings.line_{}]\nmodel = \"{}\"\n", n + 1, meets || l.dynamics ? "lumped_mass" : "catenary")
             << (l.at_fairlead.empty() ? "body = \"platform\"\nfairlead_m = " + vector(l.fairlead)
                                       : "body = \"" + l.at_fairlead + "\"")
             << (l.at_anchor.empty() ? "\nanchor_m = " + vector(l.anchor) : "\nanchor_body = \"" + l.at_anchor + "\"")
             << fmt::format("\nrest_length_m = {:.9g}\naxial_stiffness_N = {:.9g}\n", l.length, l.axial_stiffness);
      if (const auto& d = l.dynamics) {
        scene_ << fmt::format("mass_kg_m = {:.9g}\ndiameter_m = {:.9g}\nsegments = {}\ndamping_ratio = {:.9g}\n", l.mass_per_m,
                              l.diameter, d->segments, d->damping_ratio)
               << fmt::format("drag_coefficient = {:.9g}\naxial_drag_coefficient = {:.9g}\n", d->drag, d->axial_drag)
               << fmt::format("added_mass_coefficient = {:.9g}\naxial_added_mass_coefficient = {:.9g}\n", d->added_mass,
                              d->axial_added_mass);
        if (on_bed)
          scene_ << fmt::format("bed_stiffness_Pa_m = {:.9g}\nbed_damping_Pa_s_m = {:.9g}\n", d->bed_stiffness, d->bed_damping);
      } else if (meets) {
        scene_ << fmt::format("mass_kg_m = {:.9g}\ndiameter_m = {:.9g}\n", l.mass_per_m, l.diameter);
      } else {
        scene_ << fmt::format("weight_N_m = {:.9g}\n", weight);
      }
      if (!on_bed)
        scene_ << "bed_contact = false\n";
      else if (l.bed_friction > 0.0)
        scene_ << fmt::format("bed_friction = {:.9g}\n", l.bed_friction);
    }
    for (const ImportedJunction& j : junctions)
      scene_ << fmt::format("\n[junctions.{}]\nposition_m = {}\nmass_kg = {:.9g}\nvolume_m3 = {:.9g}\ndrag_area_m2 = {:.9g}\n",
                            j.name, vector(j.at), j.mass, j.volume, j.drag_area)
             << fmt::format("added_mass_coefficient = {:.9g}\n", j.added_mass);
    carry(fmt::format("moorings: {} lines", lines.size()) +
          (junctions.empty() ? "" : fmt::format(", {} junctions", junctions.size())));
  }

  void write() {
    const double end = window * std::max(1.0, std::round(main_.number({"TMax"}) / window));
    std::ofstream out(folder_ / "scene.toml");
    out << fmt::format("# From the OpenFAST deck {}, by spindrift import.\n", main_.file().filename().string());
    if (!left_out_.empty()) out << "# Left out:\n";
    for (const std::string& what : left_out_) out << "# - " << what << "\n";
    out << fmt::format("[time]\nend_s = {:.9g}\nwindow_s = {}\nstep_s = {}\n", end, window, step_) << scene_.str() << water_;
    out << fmt::format("\n[output]\ntitle = \"{}\"\n", main_.file().stem().string());
    if (!out.flush()) throw std::runtime_error((folder_ / "scene.toml").string() + ": cannot be written");
  }

  static constexpr double window = 0.1;
  static constexpr std::array tower_freedoms{"TwFADOF1", "TwFADOF2", "TwSSDOF1", "TwSSDOF2"};
  Deck main_;
  std::filesystem::path folder_;
  double step_ = 0.05;                           // a rigid platform's shortest period is some seconds
  double longest_step_ = window;                 // that blades which bend can follow
  static constexpr double flexible_step = 0.01;  // a tower's extension is the fastest: some periods to a second
  std::optional<Deck> elastodyn_;
  RotorFrame rotor_;
  double gravity_ = 9.80665, depth_ = 0.0, water_density_ = 1025.0;
  ImportedTower tower_;
  ImportedBlades blades_;
  bool bends_ = false;         ///< the tower, in the scene
  bool shaft_twists_ = false;  ///< in the scene
  bool wet_ = false, floats_ = false;
  MassSum ballast_;
  std::ostringstream scene_;
  std::string cylinders_, water_;
  std::vector<std::string> left_out_, carried_;
};

}  // namespace

Imported import_openfast(const std::filesystem::path& main_file, const std::filesystem::path& folder, ImportedTower tower,
                         ImportedBlades blades) {
  return Importer(main_file, folder, tower, blades).run();
}

}  // namespace spindrift::decks
