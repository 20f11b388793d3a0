// Heave decay of the OC3 Hywind spar (Jonkman 2010, NREL/TP-500-47535) with the engineering sea and elastic catenaries, against
// OpenFAST 5.0: inputs/validation/oc3_heave_decay/reference.csv. One degree of freedom, integrated here.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <fstream>
#include <string>
#include <vector>

#include "kernels/mooring/line_catenary.hpp"
#include "src/sea/engineering_sea.hpp"

using namespace spindrift;
using namespace spindrift::sea;

namespace {

constexpr double gravity = 9.80665, density = 1025.0;
// Platform, tower (integrated from its table), nacelle, hub, three blades: the deck's masses, the blades summed over the
// seventeen elements that OpenFAST cuts them into (the 17,740 kg of the definition would lower the rest position by 18 mm).
constexpr double mass = 7466330.0 + 249718.0 + 240000.0 + 56780.0 + 3 * 17536.6;

/// The spar in axes whose origin is its point at still water; heave does not ask for the centre of mass.
EngineeringSea oc3_sea() {
  SeaOptions options;
  options.model = "morison";
  options.drag_coefficient = 0.6;
  options.axial_drag_coefficient = 0.0;
  // Added mass in heave at the natural period, WAMIT file of the deck: 245.2 m3 x density, on the hemisphere of the keel.
  options.axial_added_mass_coefficient = 245.2 / (2.0 / 3.0 * pi * 4.7 * 4.7 * 4.7);
  options.damping.push_back({"spar", {1e5, 1e5, 1.3e5}, {0, 0, 1.3e7}, {}});  // AddBLin of the deck
  const SeaBody spar{"spar",
                     {},
                     {{"lower", {{0, 0, -120}, {0, 0, -12}, 4.7, 4.7}},
                      {"taper", {{0, 0, -12}, {0, 0, -4}, 4.7, 3.25}},
                      {"upper", {{0, 0, -4}, {0, 0, 10}, 3.25, 3.25}}}};
  return EngineeringSea(options, {}, {density, 320.0, gravity}, {spar});
}

/// Downward pull [N] of the three lines of the deck on fairleads 70 m below and 5.2 m off the axis.
double mooring_pull(double heave) {
  constexpr double weight = (77.7066 - density * pi / 4.0 * 0.09 * 0.09) * gravity;
  const LineCatenary line{.length = 902.2, .weight_per_m = weight, .axial_stiffness = 384.243e6, .bed_friction = 0.001};
  return 3.0 * line.solve(853.87 - 5.2, 320.0 - 70.0 + heave).vertical;
}

struct Sample {
  double time, heave;
};

std::vector<Sample> reference() {
  std::ifstream file(SPINDRIFT_SOURCE_DIR "/inputs/validation/oc3_heave_decay/reference.csv");
  std::vector<Sample> rows;
  for (std::string line; std::getline(file, line);)
    if (!line.empty() && (std::isdigit(line[0]) || line[0] == '-'))
      rows.push_back({std::stod(line), std::stod(line.substr(line.find(',') + 1))});
  return rows;
}

/// Extremes of the decay from 2 m, by a parabola through three steps of RK4.
std::vector<Sample> decay(const EngineeringSea& sea) {
  const auto acceleration = [&](double z, double v) {
    Motion m;
    m.position.z() = z, m.velocity.z() = v;
    Wrench w;
    w.point = m.position;
    Matrix6 added = Matrix6::Zero();
    sea.add(0.0, {&m, 1}, {&w, 1}, {&added, 1});
    return (w.force.z() - mass * gravity - mooring_pull(z)) / (mass + added(2, 2));
  };
  const double dt = 0.1;
  std::vector<double> heave = {2.0};
  std::vector<Sample> extremes = {{0.0, 2.0}};
  double z = 2.0, v = 0.0;
  for (int n = 1; n <= 1420; ++n) {
    const double a1 = acceleration(z, v), v2 = v + 0.5 * dt * a1;
    const double a2 = acceleration(z + 0.5 * dt * v, v2), v3 = v + 0.5 * dt * a2;
    const double a3 = acceleration(z + 0.5 * dt * v2, v3), v4 = v + dt * a3;
    const double a4 = acceleration(z + dt * v3, v4);
    z += dt / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4);
    v += dt / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
    heave.push_back(z);
    if (n < 2) continue;
    const double a = heave[std::size_t(n) - 2], b = heave[std::size_t(n) - 1];
    if ((b - a) * (z - b) > 0.0) continue;
    const double curve = a - 2.0 * b + z, slope = 0.5 * (z - a);
    extremes.push_back({(n - 1 - slope / curve) * dt, b - 0.5 * slope * slope / curve});
  }
  return extremes;
}

}  // namespace

TEST_CASE("the OC3 spar displaces the volume of its definition", "[sea][fast]") {
  const EngineeringSea sea = oc3_sea();
  SeaLoads loads;
  const Motion rest;
  sea.loads_by_part(0.0, {&rest, 1}, {&loads, 1});
  CHECK(loads.buoyancy.force.z() / (density * gravity) == Approx(8029.21).margin(0.05));
}

TEST_CASE("heave of the OC3 spar decays as OpenFAST has it", "[sea][fast]") {
  const auto ours = decay(oc3_sea()), theirs = reference();
  REQUIRE(ours.size() == theirs.size());
  REQUIRE(theirs.size() == 10);
  CHECK((ours[8].time - ours[0].time) / 4.0 == Approx(30.87).epsilon(0.002));
  for (std::size_t i = 1; i < ours.size(); ++i) {
    CHECK(ours[i].time == Approx(theirs[i].time).epsilon(0.002));
    CHECK(ours[i].heave == Approx(theirs[i].heave).epsilon(0.005));
  }
}
