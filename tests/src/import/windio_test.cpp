// A turbine of windIO 1.x: values carried over, polars by their place on the span, refusals by file, line and key.
// SPDX-License-Identifier: Apache-2.0
#include "src/import/windio.hpp"

#include <catch2/catch.hpp>

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <sstream>

#include "kernels/base/constants.hpp"
#include "src/aero/turbine.hpp"
#include "src/coupling/scenario.hpp"
#include "src/scene/columns.hpp"
#include "src/scene/document.hpp"
#include "src/scene/error.hpp"
#include "tests/src/import/windio_sample.hpp"

using spindrift::testing::small_turbine;

namespace {

namespace fs = std::filesystem;

struct WindioFolder {
  fs::path path = fs::temp_directory_path() / ("spindrift_windio_" + std::to_string(getpid()));
  WindioFolder() { fs::create_directories(path); }
  ~WindioFolder() { fs::remove_all(path); }
};

std::string text_of(const fs::path& file) {
  std::ostringstream all;
  all << std::ifstream(file).rdbuf();
  return all.str();
}

std::string replaced(const std::string& from, const std::string& to) {
  std::string text = small_turbine;
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

spindrift::scene::Problem windio_refusal(const std::string& text) {
  const WindioFolder folder;
  std::ofstream(folder.path / "t.yaml") << text;
  try {
    spindrift::decks::import_windio(folder.path / "t.yaml", folder.path / "out");
  } catch (const spindrift::scene::SceneError& e) { return e.problems().at(0); }
  FAIL("not refused:\n" << text);
  return {};
}

}  // namespace

TEST_CASE("a windIO turbine turns within all speed limits of its file, up to the wind that is asked for", "[fast]") {
  const WindioFolder folder;
  const auto last_row = [&](const std::string& supervisory, std::optional<double> wind = {}) {
    std::ofstream(folder.path / "t.yaml") << replaced("{Vin: 3.0}", supervisory);
    spindrift::decks::import_windio(folder.path / "t.yaml", folder.path / "out", spindrift::decks::ImportedTower::as_in_deck,
                                    wind);
    const std::string table = text_of(folder.path / "out/operation.csv");
    const std::size_t from = table.find_last_of('\n', table.size() - 2) + 1;
    double wind_m_s = 0.0, rpm = 0.0;
    char comma = 0;
    std::istringstream(table.substr(from)) >> wind_m_s >> comma >> rpm;
    return std::pair(wind_m_s, rpm * spindrift::rad_s_per_rpm);
  };
  // Tip at 52 cos .1 - 2 sin .1 = 51.54 m, ratio 7.
  CHECK(last_row("{Vin: 3.0}").second == Approx(1.2));
  CHECK(last_row("{Vin: 3.0, maxOmega: 1.1}").second == Approx(1.1));
  CHECK(last_row("{Vin: 3.0, maxTS: 50.0}").first == Approx(50.0 / 7.0));
  CHECK(last_row("{Vin: 3.0, maxTS: 70.0}").second == Approx(1.2));
  CHECK(last_row("{Vin: 3.0}", 5.0).first == Approx(5.0));
  CHECK(last_row("{Vin: 3.0}", 50.0).second == Approx(1.2));
  CHECK(windio_refusal(replaced("{Vin: 3.0}", "{Vin: 3.0, minOmega: 1.0, maxTS: 50.0}")).key == "control.supervisory");
}

TEST_CASE("of a windIO turbine the rotor's rated power is the generator's over the gear's losses", "[fast]") {
  const WindioFolder folder;
  const auto power = [&](const std::string& text) {
    std::ofstream(folder.path / "t.yaml") << text;
    return spindrift::decks::import_windio(folder.path / "t.yaml", folder.path / "out").rating.power_W;
  };
  CHECK_FALSE(power(small_turbine));
  CHECK(power(replaced("hub_height", "rated_power: 2.0e6, hub_height")) == 2.0e6);
  std::string geared = replaced("Vin: 3.0", "Vin: 3.0, rated_power: 3.0e6");
  CHECK(power(geared) == 3.0e6);
  geared.replace(geared.find("uptilt: 0.05"), 12, "uptilt: 0.05, gearbox_efficiency: 0.75");
  CHECK(power(geared) == 4.0e6);
}

TEST_CASE("a windIO turbine is carried over with its axes and polars", "[fast]") {
  const WindioFolder folder;
  std::ofstream(folder.path / "t.yaml") << small_turbine;
  const auto imported = spindrift::decks::import_windio(folder.path / "t.yaml", folder.path / "out");
  const std::string planform = text_of(folder.path / "out/planform.csv"), turbine = text_of(folder.path / "out/turbine.toml");
  CHECK(text_of(imported.scene).find("[output]\nnotes = [\n") != std::string::npos);
  CHECK(planform.find("\n2,3,11.4591559,100,0,-0\n") != std::string::npos);
  CHECK(planform.find("\n52,1,0,20,-2,-0.5\n") != std::string::npos);
  CHECK(turbine.find("blades = 3\nhub_radius_m = 2\nprecone_deg = 5.72957795\n") != std::string::npos);
  CHECK(turbine.find("thickness_pct = 100, file = \"polar_1.csv\"") != std::string::npos);
  CHECK(turbine.find("thickness_pct = 20, file = \"polar_2.csv\"") != std::string::npos);
  CHECK(text_of(folder.path / "out/polar_2.csv").find("\n0,0.4,0.01\n") != std::string::npos);
  CHECK(text_of(imported.scene).find("hub_m = [-5, 0.0, 90]\n") != std::string::npos);
  CHECK(text_of(imported.scene).find("axis = [0.99875026, 0.0, -0.0499791693]\n") !=
        std::string::npos);  // down the wind and down
}

TEST_CASE("the shaft's tilt has the one name or the other", "[fast]") {
  const WindioFolder folder;
  std::ofstream(folder.path / "t.yaml") << replaced("uptilt: 0.05", "uptilt_angle: 0.05");
  const auto imported = spindrift::decks::import_windio(folder.path / "t.yaml", folder.path / "out");
  CHECK(text_of(imported.scene).find("axis = [0.99875026, 0.0, -0.0499791693]\n") != std::string::npos);
}

TEST_CASE("all Reynolds numbers of an airfoil are carried over, with the viscosity of the air", "[fast]") {
  // In the file the larger one first; the tip's 0.4 at 1 million and 0.9 at 4 million.
  const std::string other =
      R"({re: 4e6, c_l: {grid: [-3.141, 0.0, 3.141], values: [0.0, 0.9, 0.0]}, c_d: {grid: [-3.141, 3.141], values: [0.3, 0.3]}},)";
  const WindioFolder folder;
  std::ofstream(folder.path / "t.yaml") << replaced("polars: [{re: 1e6, c_l: {grid: [-3.141, 0.0, 3.141]",
                                                    "polars: [" + other + "{re: 1e6, c_l: {grid: [-3.141, 0.0, 3.141]");
  const auto imported = spindrift::decks::import_windio(folder.path / "t.yaml", folder.path / "out");
  const std::string turbine = text_of(folder.path / "out/turbine.toml"), scene = text_of(imported.scene);
  CHECK(turbine.find("{ thickness_pct = 100, file = \"polar_1.csv\" }") != std::string::npos);
  CHECK(turbine.find("{ thickness_pct = 20, reynolds = 1000000, file = \"polar_2_1.csv\" },\n"
                     "  { thickness_pct = 20, reynolds = 4000000, file = \"polar_2_2.csv\" }") != std::string::npos);
  CHECK(text_of(folder.path / "out/polar_2_1.csv").find("\n0,0.4,0.01\n") != std::string::npos);
  CHECK(text_of(folder.path / "out/polar_2_2.csv").find("\n0,0.9,0.3\n") != std::string::npos);
  CHECK(scene.find("kinematic_viscosity_m2_s = 1.46938776e-05\n") != std::string::npos);  // 1.8e-5 / 1.225
  const spindrift::aero::Turbine read = spindrift::aero::read_turbine((folder.path / "out/turbine.toml").string());
  CHECK(read.polars.size() == 3);
  CHECK(spindrift::aero::depends_on_reynolds(read));
}

TEST_CASE("of several configurations of an airfoil the first is taken, and least speeds may be nothing", "[fast]") {
  const std::string polar = "re: 1e6, c_l: {grid: [-3.141, 0.0, 3.141], values: [0.0, ",
                    rest =
                        ", 0.0]}, c_d: {grid: [-3.141, 3.141], "
                        "values: [0.01, 0.01]}";
  const auto text = [&](const std::string& other) {
    std::string all = replaced("[{" + polar + "0.4" + rest + "}]",
                               "[{configuration: clean, " + polar + "0.4" + rest + "}, {" + other + polar + "0.3" + rest + "}]");
    const std::size_t at = all.find("VS_minspd: 0.5");
    return all.replace(at, 14, "VS_minspd: 0.0");
  };
  CHECK(windio_refusal(text("")).message.find("is the Reynolds number of another polar") != std::string::npos);
  const WindioFolder folder;
  std::ofstream(folder.path / "t.yaml") << text("configuration: rough, ");
  const auto imported = spindrift::decks::import_windio(folder.path / "t.yaml", folder.path / "out");
  CHECK(std::ranges::any_of(imported.left_out, [](const auto& s) { return s.find("first configuration") != std::string::npos; }));
  const auto turbine = spindrift::aero::read_turbine((folder.path / "out/turbine.toml").string());
  CHECK(turbine.blades == 3);
}

TEST_CASE("airfoils whose thickness does not fall along the span are told apart by number", "[fast]") {
  std::string text = replaced("relative_thickness: 1.0", "relative_thickness: 0.2");
  text.replace(text.find("[root, root, tip]"), 17, "[tip, root, tip]");
  const WindioFolder folder;
  std::ofstream(folder.path / "t.yaml") << text;
  spindrift::decks::import_windio(folder.path / "t.yaml", folder.path / "out");
  const spindrift::aero::Turbine read = spindrift::aero::read_turbine((folder.path / "out/turbine.toml").string());
  REQUIRE(read.polars.size() == 3);
  CHECK(read.planform.polar == std::vector<double>{1.0, 2.0, 3.0});
  CHECK(read.planform.span[1] == 12.0);
  CHECK(read.polars[1].drag[0] == 0.5);
  CHECK(read.polars[2].lift == read.polars[0].lift);
}

TEST_CASE("a windIO tower is what the wind meets, and the table of a beam", "[fast]") {
  const WindioFolder folder;
  std::ofstream(folder.path / "t.yaml") << small_turbine;
  spindrift::decks::import_windio(folder.path / "t.yaml", folder.path / "rigid", spindrift::decks::ImportedTower::rigid);
  CHECK(!fs::exists(folder.path / "rigid/tower.csv"));
  const auto imported = spindrift::decks::import_windio(folder.path / "t.yaml", folder.path / "out");
  spindrift::scene::Document document = spindrift::scene::load(imported.scene.string());
  const auto scene = spindrift::coupling::read_scenario(document);
  REQUIRE(scene.aero.tower);
  // Foot, the step at 40 m over a millionth of the height, top: height, diameter and drag.
  const auto& stations = scene.aero.tower->stations;
  REQUIRE(stations.size() == 4);
  CHECK(stations[0] == std::array<double, 3>{10.0, 8.0, 0.5});
  CHECK(stations[1] == std::array<double, 3>{40.0, 8.0, 0.58});
  CHECK(stations[2][0] == Approx(40.0).margin(1e-4));
  CHECK(stations[2][1] == 6.0);
  CHECK(stations[3] == std::array<double, 3>{85.0, 5.0, 0.7});

  const auto table = spindrift::scene::read_columns((folder.path / "out/tower.csv").string());
  REQUIRE(table.rows() == 4);
  CHECK(table["distance_m"][3] == 75.0);
  // At the foot a tube of steel from 8 to 7.9 m in diameter, in it one of wood to 7.7 m; the mass with a tenth more.
  const double pi = 3.14159265358979, steel = pi / 4 * (8.0 * 8.0 - 7.9 * 7.9), wood = pi / 4 * (7.9 * 7.9 - 7.7 * 7.7),
               bent_steel = pi / 64 * (std::pow(8.0, 4) - std::pow(7.9, 4)),
               bent_wood = pi / 64 * (std::pow(7.9, 4) - std::pow(7.7, 4));
  CHECK(table["mass_kg_m"][0] == Approx(1.1 * (7800 * steel + 500 * wood)).epsilon(1e-8));
  CHECK(table["axial_N"][0] == Approx(2e11 * steel + 1e10 * wood).epsilon(1e-8));
  CHECK(table["stiffness_x_N_m2"][0] == Approx(2e11 * bent_steel + 1e10 * bent_wood).epsilon(1e-8));
  CHECK(table["stiffness_y_N_m2"][0] == table["stiffness_x_N_m2"][0]);
  CHECK(table["torsion_N_m2"][0] == Approx(2 * (7.9e10 * bent_steel + 4e9 * bent_wood)).epsilon(1e-8));
  // A file without the shape of its tower has none in the scene.
  std::string bare = small_turbine;
  bare.replace(bare.find("  tower:\n"), bare.find("materials:") - bare.find("  tower:\n"), "  tower: {}\n");
  std::ofstream(folder.path / "t.yaml") << bare;
  const auto none = spindrift::decks::import_windio(folder.path / "t.yaml", folder.path / "bare");
  CHECK(std::ranges::count(none.left_out, "components.tower, which has no outer_shape_bem") == 1);
  CHECK(text_of(none.scene).find("[aero.tower]") == std::string::npos);
}

TEST_CASE("malformed windIO files are refused by line and key", "[fast]") {
  struct Fault {
    std::string from, to, key;
    int line;
  };
  const std::string shape = "components.blade.outer_shape_bem.", tower = "components.tower.";
  const std::vector<Fault> faults = {
      {"hub_height: 90.0", "hub_height: tall", "assembly.hub_height", 1},
      {"hub_height: 90.0", "hub_height: .nan", "assembly.hub_height", 1},
      {"hub_height: 90.0", "hub_height: -1", "assembly.hub_height", 1},
      {"hub_height: 90.0, ", "", "assembly", 1},
      {"number_of_blades: 3", "number_of_blades: 2.5", "assembly.number_of_blades", 1},
      {"Upwind", "Downwind", "assembly.rotor_orientation", 1},
      {"cone_angle: 0.1", "cone_angle: 4.0", "components.hub.cone_angle", 3},
      {"diameter: 4.0", "diameter: 0", "components.hub.diameter", 3},
      {"overhang: 5.0", "overhang: []", "components.nacelle.drivetrain.overhang", 4},
      {"[root, root, tip]", "[root, tip]", shape + "airfoil_position.labels", 7},
      {"[root, root, tip]", "[root, root, top]", shape + "airfoil_position.labels[2]", 7},
      {"[0.0, 0.2, 1.0]", "[0.0, 1.2, 1.0]", shape + "airfoil_position.grid[2]", 7},
      {"[3.0, 1.0]", "[3.0, -1.0]", shape + "chord.values[1]", 8},
      {"[3.0, 1.0]", "[3.0]", shape + "chord.values", 8},
      {"[0.2, 0.0]", "[11.0, 0.0]", shape + "twist.values[0]", 9},
      {"[0.0, 50.0]", "[50.0, 0.0]", shape + "reference_axis.z.values[1]", 13},
      {"relative_thickness: 1.0", "relative_thickness: 24", "airfoils[0].relative_thickness", 32},
      {"name: tip", "name: root", "airfoils[1].name", 34},
      {"{re: 1e6, c_l: {grid: [-3.141, 0.0, 3.141]", "{re: 1e6}, {re: 1e6, c_l: {grid: [-3.141, 0.0, 3.141]",
       "airfoils[1].polars[1].re", 36},
      {"{re: 1e6, c_l: {grid: [-3.141, 0.0, 3.141]", "{re: 1e6}, {re: -1, c_l: {grid: [-3.141, 0.0, 3.141]",
       "airfoils[1].polars[1].re", 36},
      {"{re: 1e6, c_l: {grid: [-3.141, 0.0, 3.141]", "{re: 1e6}, {c_l: {grid: [-3.141, 0.0, 3.141]", "airfoils[1].polars[1]", 36},
      {"[0.01, 0.01]", "[0.01, -0.01]", "airfoils[1].polars[0].c_d.values[1]", 36},
      {"[-3.141, 0.0, 3.141]", "[-3.141, 4.0, 3.141]", "airfoils[1].polars[0].c_l.grid[2]", 36},
      {"[-3.141, 0.0, 3.141]", "[-1.0, 0.0, 3.141]", "airfoils[1].polars[0].c_l.grid", 36},
      {"VS_maxspd: 1.2", "VS_maxspd: 0.2", "control.torque.VS_maxspd", 38},
      {"Vin: 3.0", "Vin: 30.0", "control.supervisory.Vin", 39},
      {"[10.0, 85.0]", "[85.0, 10.0]", tower + "outer_shape_bem.reference_axis.z.values[1]", 19},
      {"[8.0, 8.0, 6.0, 5.0]", "[8.0, 8.0, 6.0, 0.0]", tower + "outer_shape_bem.outer_diameter.values[3]", 20},
      {"[8.0, 8.0, 6.0, 5.0]", "[8.0, 8.0, 6.0]", tower + "outer_shape_bem.outer_diameter.values", 20},
      {"[0.5, 0.7]", "[0.5, -0.7]", tower + "outer_shape_bem.drag_coefficient.values[1]", 21},
      {"outfitting_factor: 1.1", "outfitting_factor: none", tower + "internal_structure_2d_fem.outfitting_factor", 23},
      {"material: wood", "material: cork", tower + "internal_structure_2d_fem.layers[1].material", 26},
      {"values: [0.1, 0.1]", "values: [0.1, 4.1]", tower + "internal_structure_2d_fem.layers", 25},
      {"rho: 7800", "rho: heavy", "materials[0].rho", 28},
      {"air_density: 1.225, ", "", "environment", 40},
  };
  for (const Fault& f : faults) {
    INFO(f.from << " -> " << f.to);
    const auto problem = windio_refusal(replaced(f.from, f.to));
    CHECK(problem.key == f.key);
    CHECK(problem.line == f.line);
    CHECK(fs::path(problem.source).filename() == "t.yaml");
  }
  CHECK(windio_refusal(replaced("outer_shape_bem:", "outer_shape:")).key.find("components.blade") == 0);
  CHECK(windio_refusal("a: [1, 2").line > 0);
  CHECK(windio_refusal("").message == "must be a table of keys");
  const WindioFolder folder;
  CHECK_THROWS_AS(spindrift::decks::import_windio(folder.path, folder.path / "out"), spindrift::scene::SceneError);
  CHECK_THROWS_AS(spindrift::decks::import_windio(folder.path / "none.yaml", folder.path / "out"), spindrift::scene::SceneError);
}
