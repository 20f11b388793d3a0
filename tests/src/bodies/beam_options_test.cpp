// What a scene may say about beams, what is refused and in which words. SPDX-License-Identifier: Apache-2.0
#include "src/bodies/beam_options.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "kernels/base/constants.hpp"
#include "src/bodies/linearise.hpp"
#include "src/bodies/statics.hpp"
#include "src/scene/error.hpp"
#include "tests/src/bodies/examples.hpp"

using namespace spindrift;
using namespace spindrift::bodies;
using Catch::Matchers::Contains;

namespace {

/// A table of properties in a file of its own, for a beam of 100 m.
struct TowerTable {
  std::string path;
  BeamOptions options;
  explicit TowerTable(const std::string& text)
      : path((std::filesystem::temp_directory_path() / "spindrift_beam_table.csv").string()) {
    std::ofstream(path) << text;
    options.end_m = {0, 0, 100.0};
    options.properties = path;
  }
  ~TowerTable() { std::filesystem::remove(path); }
};

}  // namespace

TEST_CASE("a tube's mass and stiffness follow from its diameter and wall", "[bodies][fast]") {
  const TowerTable table("distance_m, diameter_m, thickness_m\n0, 8, 0.04\n60, 8, 0.04\n60, 8, 0.03\n100, 5, 0.02\n");
  const beam::Properties p = read_properties(table.options);
  REQUIRE(p.position.size() == 4);
  const double area = pi * (8.0 - 0.04) * 0.04, inertia = pi / 64.0 * (std::pow(8.0, 4) - std::pow(7.92, 4));
  CHECK(p.mass[0] == Approx(8500.0 * area));
  CHECK(p.bending_x[0] == Approx(210e9 * inertia));
  CHECK(p.bending_y[0] == p.bending_x[0]);
  CHECK(p.axial[0] == Approx(210e9 * area));
  CHECK(p.torsion[0] == Approx(80.8e9 * 2.0 * inertia));
}

TEST_CASE("a table of mass and stiffness without extension and twist takes those of a thin tube", "[bodies][fast]") {
  const TowerTable table("distance_m, mass_kg_m, stiffness_x_N_m2\n0, 4000, 1e12\n100, 2000, 5e11\n");
  const beam::Properties p = read_properties(table.options);
  CHECK(p.axial[1] == Approx(210e9 / 8500.0 * 2000.0));
  CHECK(p.torsion[1] == Approx(80.8 / 210.0 * 2.0 * 5e11));
  CHECK(p.bending_y == p.bending_x);
}

TEST_CASE("tables that are no beam are refused with file, line and reason", "[bodies][fast]") {
  const auto refuses = [](const std::string& text, const std::string& why) {
    const TowerTable table(text);
    CHECK_THROWS_WITH(read_properties(table.options), Contains(why) && Contains("spindrift_beam_table.csv"));
  };
  const std::string head = "distance_m, diameter_m, thickness_m\n";
  refuses(head + "0, 8, 0.04\n90, 8, 0.04\n", "distance_m ends at 90, the beam is 100 m long");
  refuses(head + "1, 8, 0.04\n100, 8, 0.04\n", "must be 0 at the beam's start");
  refuses(head + "0, 8, 0.04\n60, 8, 0.04\n50, 8, 0.04\n100, 8, 0.04\n", "is less than the one before");
  refuses(head + "0, 8, 0.04\n60, 8, 0.04\n60, 7, 0.04\n60, 6, 0.04\n100, 8, 0.04\n", "stands three times");
  refuses(head + "0, 8, 0.04\n0, 7, 0.04\n100, 8, 0.04\n", "repeats at an end");
  refuses(head + "0, 8, 5\n100, 8, 0.04\n", "does not fit into a diameter");
  refuses(head + "0, 8, -0.04\n100, 8, 0.04\n", "must be above zero");
  refuses("distance_m, mass_kg_m, diameter_m, stiffness_x_N_m2\n0, 1, 1, 1\n100, 1, 1, 1\n", "must have either");
  refuses("distance_m, mass_kg_m, flap\n0, 1, 1\n100, 1, 1\n", "flap");
}

TEST_CASE("the tower of the DTU 10 MW turbine weighs 628 t and vibrates as its report says", "[bodies][fast]") {
  BeamOptions tower;
  tower.end_m = {0, 0, 115.63};
  tower.properties = SPINDRIFT_SOURCE_DIR "/inputs/turbines/dtu_10mw/tower.csv";
  const beam::Properties p = read_properties(tower);
  const auto body = [](const char* name, double mass, const Eigen::Vector3d& inertia, const Eigen::Vector3d& at) {
    Body b;
    b.name = name;
    b.mass = mass;
    b.inertia = inertia.asDiagonal();
    b.initial.position = at;
    return b;
  };
  // Nacelle and rotor as in inputs/validation/dtu_tower.
  const std::vector<Body> bodies{body("nacelle", 446036.0, {4.1e6, 7.3e6, 7.3e6}, {2.687, 0, 118.08}),
                                 body("rotor", 227962.0, {1.56e8, 7.84e7, 7.84e7}, {-7.073, 0, 119.0})};
  Joint shaft;
  shaft.type = JointType::fixed;
  shaft.i = 0, shaft.j = 1;
  const Beam beam = make_beams({{.name = "tower", .start = tower.start_m, .end = tower.end_m, .properties = p}}, bodies,
                               std::span(&shaft, 1))[0];
  double mass = 0.0;
  for (const beam::Station& s : beam.link.stations) mass += s.mass;
  CHECK(mass == Approx(628443.0).epsilon(1e-3));
  System system(bodies, {shaft}, {gravity_source(bodies, 9.81), beam_source({beam}, {0, 0, -9.81})});
  const Equilibrium rest = find_equilibrium(system, examples::start(system), 0.0);
  REQUIRE(rest.problem == "");
  std::vector<double> frequencies;  // slowest first
  for (const Mode& mode : linearise(system, rest.state, 0.0).modes)
    frequencies.push_back(std::abs(mode.eigenvalue.imag()) / (2.0 * pi));
  std::sort(frequencies.begin(), frequencies.end());
  REQUIRE(frequencies.size() == 6);
  INFO(frequencies[0] << ' ' << frequencies[1] << ' ' << frequencies[2] << ' ' << frequencies[3] << ' ' << frequencies[4] << ' '
                      << frequencies[5]);
  // OpenFAST 3.3 on the land-based turbine, linearised at standstill: side-side 0.246, fore-aft 0.248 Hz; Bak et al. (2013): 0.25
  // Hz.
  CHECK(frequencies[0] == Approx(0.246).epsilon(0.02));
  CHECK(frequencies[1] == Approx(0.248).epsilon(0.02));
  CHECK(frequencies[0] == Approx(0.25).epsilon(0.02));
  CHECK(frequencies[1] == Approx(0.25).epsilon(0.02));
}
