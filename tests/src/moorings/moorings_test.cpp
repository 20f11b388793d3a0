// Laws of src/moorings/moorings.hpp: lines load the bodies they are tied to, and only those.
// SPDX-License-Identifier: Apache-2.0
#include "src/moorings/moorings.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "kernels/base/constants.hpp"
#include "kernels/base/failure.hpp"
#include "src/moorings/composite.hpp"

using namespace spindrift;
using namespace spindrift::moorings;
using Eigen::Vector3d;

namespace {

const std::vector<std::string> names{"platform", "buoy"};

std::vector<Motion> start() {
  Motion platform, buoy;
  platform.position = {0, 0, -4};
  buoy.position = {-80, 10, -1};
  buoy.attitude = Eigen::AngleAxisd(0.4, Vector3d(1, 2, 3).normalized());  // points are carried whatever the initial attitude
  return {platform, buoy};
}

std::vector<Wrench> loads(const Moorings& m, const std::vector<Motion>& motions) {
  std::vector<Wrench> w(motions.size());
  for (std::size_t i = 0; i < w.size(); ++i) w[i].point = motions[i].position;
  m.add_loads(0.0, motions, w);
  return w;
}

LineOptions paper_line(double azimuth) {
  // Leble & Barakos (2016), Table 3: fairleads on a circle of 46.7 m at z = -7, anchors at z = -20.6 where the lines of
  // 116.73 m are relaxed, 162.635 m out (0.035 m less, by rounding the radius to 0.1 m, is 0.12 MN in each line).
  const Vector3d out(std::cos(azimuth), std::sin(azimuth), 0);
  LineOptions line;
  line.body = "platform";
  line.fairlead_m = 46.7 * out - Vector3d(0, 0, 7.0), line.anchor_m = 162.635 * out - Vector3d(0, 0, 20.6);
  line.rest_length_m = 116.73, line.axial_stiffness_N = 4e8, line.damping_N_s_m = 4e4;
  line.tension_only = false;
  return line;
}

Moorings paper_lines() {
  Moorings m(names, start());
  for (int i : {0, 1, 2}) m.add("line_" + std::to_string(i + 1), paper_line(120 * i * radians_per_degree));
  return m;
}

}  // namespace

TEST_CASE("the paper's lines under its mean displacement carry the thrust of 1500 kN", "[moorings][fast]") {
  // Surge 0.215 m of the point z = -4.1 m, heave -0.603 m, pitch 5.2 deg (Leble & Barakos 2016, figs. 14, 16; centre taken at z =
  // -4).
  const Moorings m = paper_lines();
  auto motions = start();
  const double pitch = 5.2 * radians_per_degree;
  motions[0].attitude = Eigen::AngleAxisd(pitch, Vector3d::UnitY());
  motions[0].position = Vector3d(0.215, 0, -4.1 - 0.603) - motions[0].attitude * Vector3d(0, 0, -0.1);
  const auto w = loads(m, motions);
  CHECK(-w[0].force.x() == Approx(1.5e6).epsilon(0.03));
  CHECK(w[0].force.y() == Approx(0.0).margin(1.0));
  CHECK(w[1].force == Vector3d::Zero());
  CHECK(m.tensions(motions)[0].fairlead == Approx(-0.77e6).epsilon(0.05));  // the downwind line pushes, the two upwind pull
  CHECK(m.tensions(motions)[1].fairlead == Approx(0.74e6).epsilon(0.05));
}

TEST_CASE("a rigid shift of everything changes no load", "[moorings][fast]") {
  Moorings m(names, start());
  LineOptions line = paper_line(2.0);
  line.anchor_body = "buoy";
  line.anchor_m = {-79, 12, 0.5};
  line.model = GENERATE("spring_damper", "catenary");
  line.weight_N_m = 800.0, line.bed_contact = false, line.rest_length_m = 60.0;
  m.add("tether", line);
  auto motions = start();
  motions[0].velocity = {1, 2, 3};
  const auto before = loads(m, motions);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.8, Vector3d::UnitZ()));  // about the vertical: weight keeps its direction
  auto moved = motions;
  for (Motion& b : moved)
    b.position = turn * b.position + Vector3d(5, -7, 2), b.attitude = turn * b.attitude, b.velocity = turn * b.velocity;
  const auto after = loads(m, moved);
  for (int i : {0, 1}) {
    CHECK((after[i].force - turn * before[i].force).norm() < 1e-6);
    CHECK((after[i].moment - turn * before[i].moment).norm() < 1e-4);
  }
  CHECK(before[1].force.norm() > 1e3);
}

TEST_CASE("a line between two bodies neither pushes nor turns the pair", "[moorings][fast]") {
  Moorings m(names, start());
  LineOptions line = paper_line(2.0);
  line.anchor_body = "buoy";
  line.anchor_m = {-79, 12, 0.5};
  m.add("tether", line);
  auto motions = start();
  motions[1].omega = {0.3, -0.2, 0.1};
  const auto w = loads(m, motions);
  CHECK((w[0].force + w[1].force).norm() < 1e-9 * w[0].force.norm());
  const Vector3d origin = Vector3d::Zero();
  CHECK((w[0].about(origin).moment + w[1].about(origin).moment).norm() < 1e-9 * w[0].about(origin).moment.norm());
}

TEST_CASE("lines of all models take no energy from a body that moves in a circle, dampers take some", "[moorings][fast]") {
  const std::string table = (std::filesystem::temp_directory_path() / "spindrift_moorings_test.csv").string();
  std::ofstream(table) << "distance_m,tension_N\n100,0\n112,2e5\n118,9e5\n125,4e6\n";
  const auto work = [&](LineOptions line) {
    Moorings m(names, start());
    m.add("line", line);
    double sum = 0.0, largest = 0.0;
    constexpr int steps = 4000;
    for (int i = 0; i < steps; ++i) {
      const double phase = 2 * pi * i / steps;
      auto motions = start();
      motions[0].position += Vector3d(2 * std::cos(phase), std::sin(phase), 3 * std::sin(phase));
      motions[0].velocity = Vector3d(-2 * std::sin(phase), std::cos(phase), 3 * std::cos(phase));
      const double power = loads(m, motions)[0].force.dot(motions[0].velocity);
      sum += power * 2 * pi / steps, largest = std::max(largest, std::abs(power));
    }
    return sum / largest;
  };
  LineOptions line = paper_line(2.0);
  CHECK(work(line) < -1e-3);
  line.damping_N_s_m = 0.0;
  CHECK(std::abs(work(line)) < 1e-10);
  line.model = "table", line.table = table;
  CHECK(std::abs(work(line)) < 1e-6);  // the table's cubics are smooth to first derivative only
  line = paper_line(2.0);
  line.model = "catenary", line.weight_N_m = 2e3;
  CHECK(std::abs(work(line)) < 1e-5);  // passes slack, touching and taut
  line.model = "composite_catenary", line.rest_length_m = 0.0, line.weight_N_m = 0.0, line.axial_stiffness_N.reset();
  line.sections = {{60.0, 2e3, 4e8}, {56.73, 3e3, 2e8}}, line.clumps = {{50.0, 2e3, 0.5}, {90.0, 100.0, 4.0}};
  CHECK(std::abs(work(line)) < 1e-5);
}

TEST_CASE("sections and clumps of a scene are cut into one row, from the anchor up", "[moorings][fast]") {
  LineOptions line;
  line.sections = {{300.0, 1e3, 5e8}, {200.0, 400.0, 2e8}};
  line.clumps = {{420.0, 500.0, 2.0}, {100.0, 1e3, 0.0}, {300.0, 0.0, 1.0}, {300.0, 2e3, 0.0}};
  const CompositeParts parts = composite_parts(line, 1000.0, 10.0);
  REQUIRE(parts.sections.size() == 4);
  const double lengths[] = {100.0, 200.0, 120.0, 80.0}, weights[] = {1e3, 1e3, 400.0, 400.0};
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(parts.sections[i].length == lengths[i]);
    CHECK(parts.sections[i].weight_per_m == weights[i]);
  }
  CHECK(parts.hung == std::vector<double>{1e4, 1e4, -1.5e4});
  CHECK(parts.joints == std::vector<double>{100.0, 300.0, 420.0});
}

TEST_CASE("a line of sections loads its body as the catenary of one does, and a weight on it as statics have it",
          "[moorings][fast]") {
  LineOptions one, row;
  one.model = "catenary", row.model = "composite_catenary", one.body = row.body = "platform";
  one.fairlead_m = row.fairlead_m = Vector3d(0, 0, -4), one.anchor_m = row.anchor_m = Vector3d(300, 250, -54);
  one.rest_length_m = 400.0, one.weight_N_m = 3e3, one.axial_stiffness_N = 1.6e9, one.bed_friction = row.bed_friction = 0.4;
  row.sections = {{150.0, 3e3, 1.6e9}, {250.0, 3e3, 1.6e9}};
  Moorings a(names, start()), b(names, start()), hung(names, start());
  a.add("line", one), b.add("line", row);
  const Wrench plain = loads(a, start())[0];
  CHECK((loads(b, start())[0].force - plain.force).norm() < 1e-9 * plain.force.norm());
  CHECK((loads(b, start())[0].moment - plain.moment).norm() < 1e-9 * plain.force.norm());
  CHECK(b.tensions(start())[0].anchor == Approx(a.tensions(start())[0].anchor).epsilon(1e-9));
  CHECK(b.memory_size() == 0);
  row.bed_contact = false, row.bed_friction = 0.0, row.clumps = {{300.0, 2e3, 0.5}};  // all of its weight is at its two ends
  hung.add("line", row);
  const LineForces f = composite_line(composite_parts(row, 1025.0, 9.80665), row).forces(row.span(), Vector3d::Zero());
  CHECK(f.on_fairlead.z() + f.on_anchor.z() == Approx(-(400.0 * 3e3 + 9.80665 * (2e3 - 0.5 * 1025.0))));
  CHECK((loads(hung, start())[0].force - f.on_fairlead).norm() < 1e-6);
}

TEST_CASE("tensions are those of the force that the body feels", "[moorings][fast]") {
  const Moorings m = paper_lines();
  auto motions = start();
  motions[0].position.x() += 1.0;
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < m.size(); ++i) {
    const LineOptions line = paper_line(120 * double(i) * radians_per_degree);
    const Vector3d chord = (-line.span() - Vector3d(1, 0, 0)).normalized();
    sum += m.tensions(motions)[i].fairlead * chord;
  }
  CHECK((sum - loads(m, motions)[0].force).norm() < 1e-6);
  CHECK(m.name(2) == "line_3");
}

namespace {

LineOptions chain() {
  LineOptions line;
  line.model = "lumped_mass", line.body = "platform";
  line.fairlead_m = {0, 0, -4}, line.anchor_m = {400, 0, -54}, line.rest_length_m = 410.0;
  line.axial_stiffness_N = 1.674e9, line.diameter_m = 0.252, line.mass_kg_m = 390.0;
  return line;
}

/// The platform heaves by 2 m at 10 s.
std::vector<Motion> heaved(double t) {
  auto motions = start();
  const double omega = 2.0 * pi / 10.0;
  motions[0].position.z() += 2.0 * std::sin(omega * t), motions[0].velocity.z() = 2.0 * omega * std::cos(omega * t);
  return motions;
}

}  // namespace

TEST_CASE("a dynamic line at rest pulls as the catenary does, with memory and without", "[moorings][fast]") {
  Moorings m(names, start());
  m.add("line", chain());
  const Vector3d still = loads(m, start())[0].force;  // no memory: the catenary
  std::vector<double> memory(m.memory_size());
  m.begin(0.0, start(), memory);
  CHECK((loads(m, start())[0].force - still).norm() < 0.01 * still.norm());
  CHECK(m.tensions(start())[0].fairlead == Approx(991.6e3).epsilon(0.015));
  CHECK(m.tensions(start())[0].anchor == Approx(826.2e3).epsilon(0.015));
  for (int n = 1; n <= 200; ++n) m.remember(0.05 * n, 0.05, start(), memory);
  m.recall(memory);
  CHECK((loads(m, start())[0].force - still).norm() < 0.01 * still.norm());
}

TEST_CASE("the bed does not push an anchor that lies under it", "[moorings][fast]") {
  const std::vector<double> side{-2000.0, 2000.0};
  const LineEnvironment flat{.bed = std::make_shared<const Bed>(side, side, std::vector<double>(4, chain().anchor_m->z()))};
  const auto tension = [&](double deeper) {
    Moorings m(names, start(), flat);
    LineOptions line = chain();
    line.anchor_m->z() -= deeper;
    m.add("line", line);
    std::vector<double> memory(m.memory_size());
    m.begin(0.0, start(), memory);
    return m.tensions(start())[0].anchor;
  };
  CHECK(tension(0.1) == Approx(tension(0.0)).epsilon(0.01));
}

TEST_CASE("a weight on a dynamic line pulls on its body, at rest and in the equilibrium that looks for it", "[moorings][fast]") {
  Moorings plain(names, start()), heavy(names, start());
  LineOptions line = chain();
  plain.add("line", line);
  line.clumps = {{350.0, 2e4, 2.0, 0.0, 0.5}};
  heavy.add("line", line);
  const Vector3d steady = loads(heavy, start())[0].force;
  CHECK(-steady.z() > -loads(plain, start())[0].force.z() + 5e4);
  std::vector<double> memory(heavy.memory_size());
  heavy.begin(0.0, start(), memory);
  CHECK((loads(heavy, start())[0].force - steady).norm() < 1e-3 * steady.norm());
}

TEST_CASE("beyond its table a line goes on with a slope, also one that softens", "[moorings][fast]") {
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "spindrift_softening_line.csv";
  std::ofstream(file) << "distance_m,tension_N\n100,0\n101,3000\n110,3500\n";
  LineOptions line;
  line.model = "table", line.body = "platform", line.table = file.string();
  line.fairlead_m = {0, 0, -4}, line.anchor_m = {0, 119, -4};
  Moorings m(names, start());
  m.add("line", line);
  CHECK(m.tensions(start())[0].fairlead == Approx(4000.0));
}

TEST_CASE("a dynamic line is a function of its memory alone: the same bits after a restart", "[moorings][fast]") {
  const auto go = [](Moorings& m, std::vector<double>& memory, int from, int to) {
    for (int n = from; n < to; ++n) m.recall(memory), m.remember(0.05 * (n + 1), 0.05, heaved(0.05 * (n + 1)), memory);
  };
  Moorings whole(names, start()), second(names, start());
  whole.add("line", chain()), second.add("line", chain());
  std::vector<double> memory(whole.memory_size());
  whole.begin(0.0, heaved(0.0), memory);
  go(whole, memory, 0, 150);
  std::vector<double> saved = memory;
  go(whole, memory, 150, 300);
  go(second, saved, 150, 300);
  CHECK(saved == memory);
}

TEST_CASE("a dynamic line feels the water's motion", "[moorings][fast]") {
  LineEnvironment around;
  around.water = [](double, const Vector3d&) { return LineWater{{0.0, 1.0, 0.0}, Vector3d::Zero(), 0.0}; };
  Moorings m(names, start(), around);
  m.add("line", chain());
  std::vector<double> memory(m.memory_size());
  m.begin(0.0, start(), memory);
  for (int n = 1; n <= 400; ++n) m.recall(memory), m.remember(0.1 * n, 0.1, start(), memory);
  m.recall(memory);
  CHECK(loads(m, start())[0].force.y() > 1e3);
}

namespace {

/// A chain from the bed to a junction with a weight, two sagging legs of the same chain from there to the platform.
Moorings bridle() {
  Moorings m(names, start());
  m.add_junction("crow", {.position_m = {60, 0, -20}, .mass_kg = 2e3, .volume_m3 = 0.2, .drag_area_m2 = 1.0});
  LineOptions main = chain(), leg = chain();
  main.body = "crow", main.fairlead_m = Vector3d(60, 0, -20), main.rest_length_m = 350.0, main.bed_level_m = -54.0;
  main.segments = 60;
  leg.anchor_body = "crow", leg.anchor_m = main.fairlead_m, leg.rest_length_m = 62.0, leg.bed_contact = false, leg.segments = 16;
  m.add("main", main);
  for (const double side : {-5.0, 5.0}) {
    leg.fairlead_m = Vector3d(0, side, -4);
    m.add(side < 0.0 ? "left" : "right", leg);
  }
  return m;
}

/// Its rest between elastic catenaries (Jonkman 2007), the junction by Newton's method with differences: computed apart from this
/// code. The junction sinks by 17 m under the chains; sag makes the legs so soft that yaw finds a lever of 20.8 m where taut legs
/// would have 70.6 m, and a platform that comes nearer makes the junction sink and go the other way.
namespace by_catenaries {
const Vector3d junction(51.8964, 0.0, -36.9951), force(829.709e3, 0.0, -741.205e3);
const Vector3d junction_per_surge(-0.12623, 0.0, -1.64337);
constexpr double yaw_rad = 0.02, moment_z = -345.442e3;
}  // namespace by_catenaries

}  // namespace

TEST_CASE("legs of a bridle load their body, at rest as in the equilibrium that looks for it, and hold it in yaw",
          "[moorings][fast]") {
  Moorings m = bridle();
  const Wrench steady = loads(m, start())[0];
  CHECK((steady.force - by_catenaries::force).norm() < 3e-3 * by_catenaries::force.norm());
  auto turned = start();
  turned[0].attitude = Eigen::AngleAxisd(by_catenaries::yaw_rad, Vector3d::UnitZ());
  CHECK(loads(m, turned)[0].moment.z() == Approx(by_catenaries::moment_z).epsilon(0.01));
  const Vector3d place = m.junction_motions(start())[0].position;
  CHECK((place - by_catenaries::junction).norm() < 0.05);
  std::vector<double> memory(m.memory_size());
  m.begin(0.0, start(), memory);
  CHECK((loads(m, start())[0].force - steady.force).norm() < 1e-3 * steady.force.norm());
  CHECK((m.junction_motions(start())[0].position - place).norm() < 1e-6);
  for (int n = 1; n <= 200; ++n) m.recall(memory), m.remember(0.05 * n, 0.05, start(), memory);
  m.recall(memory);
  CHECK((m.junction_motions(start())[0].position - place).norm() < 1e-3);
  CHECK((loads(m, start())[0].force - steady.force).norm() < 1e-3 * steady.force.norm());
}

TEST_CASE("a junction follows bodies that move at the start", "[moorings][fast]") {
  Moorings m = bridle();
  auto moving = start();
  moving[0].velocity = {0.5, 0.0, 0.0};
  std::vector<double> memory(m.memory_size());
  m.begin(0.0, moving, memory);
  CHECK((m.junction_motions(moving)[0].velocity - 0.5 * by_catenaries::junction_per_surge).norm() < 0.01);
}

TEST_CASE("lines that meet are a function of their memory alone, and others do not change for them", "[moorings][fast]") {
  const auto go = [](Moorings& m, std::vector<double>& memory, int from, int to) {
    for (int n = from; n < to; ++n) m.recall(memory), m.remember(0.05 * (n + 1), 0.05, heaved(0.05 * (n + 1)), memory);
  };
  Moorings whole = bridle(), second = bridle(), alone(names, start());
  whole.add("line", chain()), second.add("line", chain()), alone.add("line", chain());
  std::vector<double> memory(whole.memory_size()), of_line(alone.memory_size());
  whole.begin(0.0, heaved(0.0), memory), alone.begin(0.0, heaved(0.0), of_line);
  go(whole, memory, 0, 60), go(alone, of_line, 0, 120);
  std::vector<double> saved = memory;
  go(whole, memory, 60, 120), go(second, saved, 60, 120);
  CHECK(saved == memory);
  whole.recall(memory), alone.recall(of_line);
  CHECK(whole.tensions(heaved(6.0))[3].fairlead == alone.tensions(heaved(6.0))[0].fairlead);
}

TEST_CASE("a body on a dynamic line is stable up to half the time in which the line's waves stop it", "[moorings][fast]") {
  // What `check` doubts: M / sqrt(EA m'). A body of mass M falls along its own line into it, force extrapolated from step to
  // step.
  const double share = GENERATE(0.5, 3.0), mass = 5e4;
  LineOptions line = chain();
  line.anchor_m = {100, 0, -4}, line.rest_length_m = 100.2, line.bed_contact = false;
  Moorings m({names.data(), 1}, std::vector<Motion>{start()[0]});
  m.add("line", line);
  const double h = share * mass / std::sqrt(*line.axial_stiffness_N * line.mass_kg_m);
  std::vector<Motion> body{start()[0]};
  std::vector<double> memory(m.memory_size());
  m.begin(0.0, body, memory);
  const double rest = loads(m, {body[0], start()[1]})[0].force.x();
  body[0].velocity.x() = -0.5;
  double largest = 0.0, early = 0.0;
  for (int n = 0; n < 400; ++n) {
    m.recall(memory);
    std::vector<Wrench> w(1);
    m.add_loads((n + 0.5) * h, body, w);
    body[0].velocity.x() += h / mass * (w[0].force.x() - rest), body[0].position.x() += h * body[0].velocity.x();
    try {
      m.remember((n + 1) * h, h, body, memory);
    } catch (const NumericalFailure&) {  // which names the line
      largest = 1e99;
      break;
    }
    largest = std::max(largest, std::abs(body[0].velocity.x()));
    if (n < 100) early = largest;
  }
  INFO(share << ": " << early << " " << largest);
  if (share < 1.0)
    CHECK(largest < 0.6);
  else
    CHECK_FALSE(largest < 5.0);
}

TEST_CASE("a line that cannot be advanced stops the run by its name", "[moorings][fast]") {
  Moorings m(names, start());
  LineOptions line = chain();
  line.axial_stiffness_N = 1.674e21;  // as if in N per m2
  m.add("line", line);
  std::vector<double> memory(m.memory_size());
  CHECK_THROWS_WITH((m.begin(0.0, start(), memory), m.remember(0.05, 0.05, start(), memory)), Catch::Contains("substeps"));
}

TEST_CASE("a line whose end is torn away ends in numbers or in a refusal with its name", "[moorings][fast]") {
  Moorings m(names, start());
  m.add("line", chain());
  std::vector<double> memory(m.memory_size());
  m.begin(0.0, start(), memory);
  auto far = start();
  far[0].position.x() -= 200.0, far[0].velocity.x() = -4000.0;
  try {
    m.remember(0.05, 0.05, far, memory);
    for (double x : memory) CHECK(std::isfinite(x));
  } catch (const NumericalFailure& failure) { CHECK(failure.place == "moorings.line"); }
}
