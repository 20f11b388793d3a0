// A turbine of windIO 1.x: values carried over, polars by their place on the span, refusals by file, line and key.
// SPDX-License-Identifier: Apache-2.0
#include "src/import/windio.hpp"

#include <catch2/catch.hpp>

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "src/scene/error.hpp"

namespace {

namespace fs = std::filesystem;

struct WindioFolder {
  fs::path path = fs::temp_directory_path() / ("spindrift_windio_" + std::to_string(getpid()));
  WindioFolder() { fs::create_directories(path); }
  ~WindioFolder() { fs::remove_all(path); }
};

const std::string small_turbine = R"(assembly: {number_of_blades: 3, hub_height: 90.0, rotor_orientation: Upwind}
components:
  hub: {diameter: 4.0, cone_angle: 0.1}
  nacelle: {drivetrain: {uptilt: 0.05, overhang: 5.0}}
  blade:
    outer_shape_bem:
      airfoil_position: {grid: [0.0, 0.2, 1.0], labels: [root, root, tip]}
      chord: {grid: [0.0, 1.0], values: [3.0, 1.0]}
      twist: {grid: [0.0, 1.0], values: [0.2, 0.0]}
      reference_axis:
        x: {grid: [0.0, 1.0], values: [0.0, -2.0]}
        y: {grid: [0.0, 1.0], values: [0.0, 0.5]}
        z: {grid: [0.0, 1.0], values: [0.0, 50.0]}
  tower: {}
airfoils:
  - name: root
    relative_thickness: 1.0
    polars: [{re: 1e6, c_l: {grid: [-3.141, 3.141], values: [0.0, 0.0]}, c_d: {grid: [-3.141, 3.141], values: [0.5, 0.5]}}]
  - name: tip
    relative_thickness: 0.2
    polars: [{re: 1e6, c_l: {grid: [-3.141, 0.0, 3.141], values: [0.0, 0.4, 0.0]}, c_d: {grid: [-3.141, 3.141], values: [0.01, 0.01]}}]
control:
  torque: {VS_minspd: 0.5, VS_maxspd: 1.2, tsr: 7.0}
  supervisory: {Vin: 3.0}
environment: {air_density: 1.225, air_dyn_viscosity: 1.8e-5}
)";

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

TEST_CASE("a windIO turbine is carried over with its axes and polars", "[fast]") {
  const WindioFolder folder;
  std::ofstream(folder.path / "t.yaml") << small_turbine;
  const auto imported = spindrift::decks::import_windio(folder.path / "t.yaml", folder.path / "out");
  const std::string planform = text_of(folder.path / "out/planform.csv"), turbine = text_of(folder.path / "out/turbine.toml");
  CHECK(planform.find("\n2,3,11.4591559,100,0,-0\n") != std::string::npos);
  CHECK(planform.find("\n52,1,0,20,-2,-0.5\n") != std::string::npos);
  CHECK(turbine.find("blades = 3\nhub_radius_m = 2\nprecone_deg = 5.72957795\n") != std::string::npos);
  CHECK(turbine.find("thickness_pct = 100, file = \"polar_1.csv\"") != std::string::npos);
  CHECK(turbine.find("thickness_pct = 20, file = \"polar_2.csv\"") != std::string::npos);
  CHECK(text_of(folder.path / "out/polar_2.csv").find("\n0,0.4,0.01\n") != std::string::npos);
  CHECK(text_of(imported.scene).find("hub_m = [-5, 0.0, 90]\n") != std::string::npos);
  CHECK(text_of(imported.scene).find("axis = [0.99875026, 0.0, -0.0499791693]\n") !=
        std::string::npos);  // down the wind and down
  CHECK(std::ranges::count(imported.left_out, "components.tower") == 1);
}

TEST_CASE("of several polars that of the nearest Reynolds number is carried over, and told", "[fast]") {
  // At rated wind the tip meets 62 m/s with a chord of 2 m half way out: some 8 million.
  const std::string others =
      R"({re: 2e4, c_l: {grid: [-3.141, 3.141], values: [9.0, 9.0]}, c_d: {grid: [-3.141, 3.141], values: [0.3, 0.3]}},)";
  const WindioFolder folder;
  std::ofstream(folder.path / "t.yaml") << replaced("polars: [{re: 1e6, c_l: {grid: [-3.141, 0.0, 3.141]",
                                                    "polars: [" + others + "{re: 1e6, c_l: {grid: [-3.141, 0.0, 3.141]");
  const auto imported = spindrift::decks::import_windio(folder.path / "t.yaml", folder.path / "out");
  const std::string polar = text_of(folder.path / "out/polar_2.csv");
  CHECK(polar.find("\n0,0.4,0.01\n") != std::string::npos);
  CHECK(polar.find(",9,") == std::string::npos);
  CHECK(std::ranges::any_of(imported.left_out, [](const std::string& note) {
    return note.find("airfoil tip") == 0 && note.find("of 2 polars that of Reynolds number 1e+06") != std::string::npos;
  }));
}

TEST_CASE("malformed windIO files are refused by line and key", "[fast]") {
  struct Fault {
    std::string from, to, key;
    int line;
  };
  const std::string shape = "components.blade.outer_shape_bem.";
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
      {"relative_thickness: 1.0", "relative_thickness: 24", "airfoils[0].relative_thickness", 17},
      {"name: tip", "name: root", "airfoils[1].name", 19},
      {"[0.01, 0.01]", "[0.01, -0.01]", "airfoils[1].polars[0].c_d.values[1]", 21},
      {"[-3.141, 0.0, 3.141]", "[-3.141, 4.0, 3.141]", "airfoils[1].polars[0].c_l.grid[2]", 21},
      {"[-3.141, 0.0, 3.141]", "[-1.0, 0.0, 3.141]", "airfoils[1].polars[0].c_l.grid", 21},
      {"VS_maxspd: 1.2", "VS_maxspd: 0.2", "control.torque.VS_maxspd", 23},
      {"Vin: 3.0", "Vin: 30.0", "control.supervisory.Vin", 24},
      {"air_density: 1.225, ", "", "environment", 25},
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
