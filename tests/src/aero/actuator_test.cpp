// Actuator disc and lines in the resolved air: what blades take the air loses, to the last bits; the DTU 10 MW rotor against
// blade elements and momentum theory; what scenes may say. SPDX-License-Identifier: Apache-2.0
#include "src/aero/actuator.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>

#include "src/aero/flow_options.hpp"
#include "src/aero/options.hpp"
#include "src/aero/wind.hpp"
#include "src/scene/document.hpp"
#include "tests/src/aero/flow/flows.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using namespace spindrift::aero::testing;
using Catch::Matchers::Contains;

namespace {

const Turbine& dtu() {
  static const Turbine turbine = read_turbine(SPINDRIFT_SOURCE_DIR "/inputs/turbines/dtu_10mw.toml");
  return turbine;
}
double tip_radius() {
  static const double radius = BladeElementMomentum(dtu(), "madsen", 1.225).tip_radius();
  return radius;
}

DiscMotion turning(double rpm, double azimuth = 0.0) {
  const double speed = rpm * rad_s_per_rpm;
  return {.hub_velocity = Eigen::Vector3d::Zero(),
          .omega = {speed, 0.0, 0.0},
          .axis = Eigen::Vector3d::UnitX(),
          .up = Eigen::Vector3d::UnitZ(),
          .azimuth = azimuth,
          .blade_pitch = 0.0,
          .hub = Eigen::Vector3d::Zero()};
}

/// Air of 1.225 kg/m3 in a box round the rotor, of so many cells to the radius; sides in radii.
struct Wind8 {
  double speed = 8.0, cells = 4.0, upstream = 3.0, downstream = 4.0, side = 3.0, core_upstream = 0.75, core_downstream = 1.0;
  double core = 1.25, growth = 1.3;
};
std::vector<double> axial_nodes(const Wind8& o) {
  const double R = tip_radius();
  return stretched_nodes(-o.upstream * R, -o.core_upstream * R, o.core_downstream * R, o.downstream * R, R / o.cells, o.growth);
}
/// Of steady flow in large boxes, from the wind.
FlowSetting steady_march(double drop, int most_steps) {
  FlowSetting s;
  s.preconditioner = "coarse";
  s.march.drop = drop, s.march.max_steps = most_steps, s.march.cfl_start = 20.0, s.march.matrix_free_below = 1.0;
  return s;
}

std::unique_ptr<Case> box(const Wind8& o, FlowSetting s, int ranks = 1, int rank = 0) {
  const double R = tip_radius(), cell = R / o.cells, growth = o.growth, core = o.core * R;
  s.gas.temperature_reference = 288.15;
  s.gas.pressure_reference = 1.225 * s.gas.gas_constant * 288.15;
  s.stream = {0.0, o.speed, 0.0, 0.0, 0.0}, s.speed = o.speed;
  const auto across = stretched_nodes(-o.side * R, -core, core, o.side * R, cell, growth);
  const std::array<std::vector<double>, 3> nodes{axial_nodes(o), across, across};
  const PatchCondition open{Condition::far_field, false};
  std::vector<std::pair<std::string, PatchCondition>> sides;
  for (const char* side : {"i_min", "i_max", "j_min", "j_max", "k_min", "k_max"}) sides.emplace_back(side, open);
  return std::make_unique<Case>(cartesian_box(nodes, BoxOptions()), s, sides, TilingOptions(), ranks, rank);
}

std::shared_ptr<Actuator> act_in(Case& c, Actuator::Kind kind, const DiscMotion& motion, double cells,
                                 const ActuatorOptions& options = {}) {
  auto actuator = std::make_shared<Actuator>(dtu(), kind, options, 1.225, tip_radius() / cells);
  actuator->place(motion);
  c.solver->set_body_force(actuator);
  return actuator;
}

/// Sums of the source over all cells: momentum [N] and power [W].
std::array<double, 4> source_sums(const FlowSolver& solver) {
  std::array<double, 4> sums{};
  for (const FlowTile& tile : solver.tiles()) {
    if (tile.source.size() == 0) continue;
    const TileGeometry& g = *tile.geometry;
    for_rows(tile.box, [&](int k, int j) {
      for (int i = 0; i < tile.box.ni; ++i)
        for (int c = 0; c < 4; ++c)
          sums[std::size_t(c)] += g.volume_data.data()[g.cell_box.at(k, j, i)] *
                                  tile.source.data()[tile.inner.at(k, j, i) + (1 + c) * tile.inner.component];
    });
  }
  return sums;
}

double blade_element_thrust(double wind, double rpm) {
  return BladeElementMomentum(dtu(), "madsen", 1.225)(Eigen::Vector3d(wind, 0.0, 0.0), turning(rpm)).force.x();
}

}  // namespace

TEST_CASE("what the blades take the air loses: force and power to round-off", "[rotor][fast]") {
  const auto kind = GENERATE(Actuator::Kind::disc, Actuator::Kind::lines);
  FlowSetting s;
  s.time_order = kind == Actuator::Kind::lines ? 1 : 0, s.dt = 0.3, s.march.max_steps = 3;
  const auto c = box({}, s);
  const auto actuator = act_in(*c, kind, turning(6.4257, 0.7), 4.0);
  c->prepare();
  c->run();
  REQUIRE(c->solver->march().verdict != Verdict::failed);
  // The box's own cells at the disc, though longer ones begin three quarters of a radius upstream.
  CHECK(cell_at_rotor(*c->store, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX(), tip_radius(), MPI_COMM_SELF) ==
        Approx(tip_radius() / 4.0).epsilon(1e-9));
  const RotorLoad load = actuator->load(c->solver->rows().back());
  const std::array<double, 4> sums = source_sums(*c->solver);
  CHECK(load.thrust > 1e5);
  for (int d = 0; d < 3; ++d) CHECK(sums[std::size_t(d)] == Approx(-load.force[d]).margin(1e-12 * load.thrust));
  double power = 0.0;  // what the air does on the blades at the velocities that they sampled
  for (const Actuator::Point& p : actuator->points()) power += p.force.dot(p.sampled);
  CHECK(sums[3] == Approx(-power).epsilon(1e-12));
  // A uniform stream is sampled exactly, so it was so in the first pseudo-step.
  const double first = actuator->load(c->solver->rows().front()).thrust;
  CHECK(first != load.thrust);
}

TEST_CASE("without a correction blades in an undisturbed stream have the loads of their polars there", "[rotor][fast]") {
  const auto c = box({.cells = 3.0}, FlowSetting());
  Actuator actuator(dtu(), Actuator::Kind::lines, {.correction = "none"}, 1.225, tip_radius() / 3.0);
  actuator.attach(c->solver->tiles().size());
  actuator.place(turning(6.4257));
  std::vector<double> sums(actuator.sums(), 0.0), part(actuator.sums());
  for (std::size_t n = 0; n < c->solver->tiles().size(); ++n) {
    actuator.sample(n, c->solver->tiles()[n], part);
    for (std::size_t m = 0; m < sums.size(); ++m) sums[m] += part[m];
  }
  actuator.act(sums);
  const BladeElementMomentum sections(dtu(), "madsen", 1.225);
  for (const Actuator::Point& p : actuator.points()) {
    CHECK(p.weight == Approx(1.0).epsilon(0.01));
    CHECK(p.sampled.x() == Approx(8.0).epsilon(1e-13));
    const double speed = 6.4257 * rad_s_per_rpm * sections.section(p.element).radius;
    CHECK(p.tangential_wind == Approx(speed).epsilon(1e-12));
  }
  const DiscMotion still{.hub_velocity = {8.0, 0.0, 0.0},
                         .omega = Eigen::Vector3d::Zero(),
                         .axis = Eigen::Vector3d::UnitX(),
                         .up = Eigen::Vector3d::UnitZ(),
                         .azimuth = 0.0,
                         .blade_pitch = 0.0};
  actuator.place(still);  // a hub that goes with the wind meets none
  for (std::size_t n = 0; n < c->solver->tiles().size(); ++n) actuator.sample(n, c->solver->tiles()[n], part);
  actuator.act(sums);
  for (const double load : actuator.loads()) CHECK(std::abs(load) < 1e-9);
}

namespace {

/// Circulation at the points of lines in a stream of 8 m/s, no correction [m2/s].
std::vector<double> circulation_in_stream(const Turbine& turbine, double kinematic_viscosity) {
  Actuator actuator(turbine, Actuator::Kind::lines, {.correction = "none"}, 1.225, tip_radius() / 3.0, kinematic_viscosity);
  actuator.place(turning(6.4257));
  std::vector<double> sums(actuator.sums(), 0.0), all;
  for (std::size_t n = 0; n < sums.size(); n += 4) sums[n] = 1.0, sums[n + 1] = 8.0;
  actuator.act(sums);
  for (const Actuator::Point& p : actuator.points()) all.push_back(p.circulation);
  return all;
}

/// Each polar at two Reynolds numbers, at the higher one with 1.2 times the lift.
Turbine lifting_more(double low, double high) {
  Turbine turbine = dtu();
  turbine.polars.clear();
  for (Polar polar : dtu().polars) {
    polar.reynolds = low, turbine.polars.push_back(polar);
    polar.reynolds = high, turbine.polars.push_back(polar);
    for (double& lift : turbine.polars.back().lift) lift *= 1.2;
  }
  return turbine;
}

}  // namespace

TEST_CASE("points of an actuator have the polars of the Reynolds number that they meet", "[rotor][fast]") {
  constexpr double nu = 1.5e-5;
  const std::vector<double> one = circulation_in_stream(dtu(), nu);
  CHECK(circulation_in_stream(lifting_more(1e9, 1e10), nu) == one);  // all below the first table
  const std::vector<double> above = circulation_in_stream(lifting_more(1.0, 2.0), nu);
  for (std::size_t n = 0; n < one.size(); ++n) CHECK(above[n] == Approx(1.2 * one[n]).epsilon(1e-12));
  // Of one point, whose Reynolds number is the geometric mean of the tables', the mean.
  Actuator actuator(dtu(), Actuator::Kind::lines, {.correction = "none"}, 1.225, tip_radius() / 3.0);
  const std::size_t n = actuator.points().size() / 6, element = actuator.points()[n].element;
  const std::vector<SpanLoad> along = actuator.span_loads();
  const double arm = along[element].radius * 6.4257 * rad_s_per_rpm;
  actuator.place(turning(6.4257));
  const double normal = 8.0 * actuator.points()[n].normal.x(), reynolds = std::hypot(normal, arm) * along[element].chord / nu;
  CHECK(circulation_in_stream(lifting_more(0.25 * reynolds, 4.0 * reynolds), nu)[n] == Approx(1.1 * one[n]).epsilon(1e-12));
}

namespace {
std::vector<double> history(int ranks, int rank, MPI_Comm comm) {
  FlowSetting s;
  s.time_order = 1, s.dt = 0.5, s.march.max_steps = 2;
  const auto c = box({.cells = 3.0}, s, ranks, rank);
  const auto actuator = act_in(*c, Actuator::Kind::lines, turning(6.4257), 3.0);
  c->prepare(comm);
  std::vector<double> all;
  for (int step = 1; step <= 2; ++step) {
    actuator->place(turning(6.4257, 0.3 * step));
    c->run();
    const std::vector<double> loads = actuator->loads(), more = fingerprint(*c->solver);
    all.insert(all.end(), loads.begin(), loads.end()), all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}
}  // namespace

TEST_CASE("two ranks give the bits of one for lines that turn", "[rotor][mpi2]") {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  CHECK(history(2, rank, MPI_COMM_WORLD) == history(1, 0, MPI_COMM_SELF));
}

namespace {
/// Mean loss of total head over dynamic pressure in the plane of cells next to x, where the radius is between two shares of the
/// rotor's.
double head_loss(const FlowSolver& solver, double x, double inner, double outer) {
  const gas::Primitive<double>& stream = solver.setting().stream;
  const double rho = gas::density(solver.setting().gas, stream), q = 0.5 * rho * stream.u * stream.u;
  double nearest = 1e300, sum = 0.0, area = 0.0;
  for (const bool found : {false, true})
    for (const FlowTile& tile : solver.tiles()) {
      const TileGeometry& g = *tile.geometry;
      for_rows(tile.box, [&](int k, int j) {
        for (int i = 0; i < tile.box.ni; ++i) {
          const double* centre = g.centre_data.data() + g.cell_box.at(k, j, i);
          const std::ptrdiff_t c = g.cell_box.component;
          const double off = std::abs(centre[0] - x), radius = std::hypot(centre[c], centre[2 * c]) / tip_radius();
          if (!found) nearest = std::min(nearest, off);
          if (!found || off > nearest + 1e-6 || radius < inner || radius > outer) continue;
          const auto is =
              gas::load_primitive<double>(tile.state.data() + tile.cells.at(k, j, i), std::size_t(tile.cells.component));
          const double volume = g.volume_data.data()[g.cell_box.at(k, j, i)];  // cells of one length
          sum += volume * (1.0 - (is.p + rho * gas::kinetic(is)) / q), area += volume;
        }
      });
    }
  return sum / area;
}
}  // namespace

namespace {
/// Calls visit(flow, area, radius) for the cells of the layer that has x in it, and gives the x of their centres.
template <class Visit>
double each_in_plane(const FlowSolver& solver, const Wind8& o, double x, const Visit& visit) {
  const std::vector<double> nodes = axial_nodes(o);
  const auto above = std::ranges::upper_bound(nodes, x);
  const double low = *(above - 1), high = *above;
  for (const FlowTile& tile : solver.tiles()) {
    const TileGeometry& g = *tile.geometry;
    for_rows(tile.box, [&](int k, int j) {
      for (int i = 0; i < tile.box.ni; ++i) {
        const double* centre = g.centre_data.data() + g.cell_box.at(k, j, i);
        const std::ptrdiff_t c = g.cell_box.component;
        if (centre[0] < low || centre[0] > high) continue;
        visit(gas::load_primitive<double>(tile.state.data() + tile.cells.at(k, j, i), std::size_t(tile.cells.component)),
              g.volume_data.data()[g.cell_box.at(k, j, i)] / (high - low), std::hypot(centre[c], centre[2 * c]));
      }
    });
  }
  return 0.5 * (low + high);
}

/// What the air that passes the plane has lost in momentum and pressure against the stream [N].
double lost_through(const FlowSolver& solver, const Wind8& o, double x) {
  const gas::Primitive<double>& stream = solver.setting().stream;
  double lost = 0.0;
  each_in_plane(solver, o, x, [&](const gas::Primitive<double>& is, double area, double /*radius*/) {
    lost += area * (gas::density(solver.setting().gas, is) * is.u * (stream.u - is.u) + stream.p - is.p);
  });
  return lost;
}

/// Mean axial velocity over what passes the plane within a radius, by area [m/s].
double mean_speed(const FlowSolver& solver, const Wind8& o, double x, double within) {
  double sum = 0.0, all = 0.0;
  each_in_plane(solver, o, x, [&](const gas::Primitive<double>& is, double area, double radius) {
    if (radius < within) sum += area * is.u, all += area;
  });
  return sum / all;
}

/// The same drag on every square metre of a disc in the plane x = 0, smeared over some cells.
class UniformDisc final : public BodyForce {
 public:
  UniformDisc(double per_area, double radius, double width) : per_area_(per_area), radius_(radius), width_(width) {}
  void attach(std::size_t) override {}
  std::size_t sums() const override { return 1; }  // the graph sums one number at least
  void sample(std::size_t, const FlowTile&, std::span<double> part) override { part[0] = 0.0; }
  void act(std::span<const double>) override {}
  void spread(std::size_t, FlowTile& tile) const override {
    if (tile.source.size() == 0) tile.source = AlignedArray<double>(tile.inner.size(tile.unknowns()));
    std::fill_n(tile.source.data(), tile.source.size(), 0.0);
    const TileGeometry& g = *tile.geometry;
    for_rows(tile.box, [&](int k, int j) {
      for (int i = 0; i < tile.box.ni; ++i) {
        const double* centre = g.centre_data.data() + g.cell_box.at(k, j, i);
        const std::ptrdiff_t c = g.cell_box.component;
        const double radius = std::hypot(centre[c], centre[2 * c]), along = centre[0] / width_;
        const double force = -per_area_ * std::exp(-along * along) / (width_ * std::sqrt(pi)) * 0.5 *
                             std::erfc((radius - radius_) / (0.5 * width_));
        double* to = tile.source.data() + tile.inner.at(k, j, i);
        to[tile.inner.component] = force;
        to[4 * tile.inner.component] = force * tile.state.data()[tile.cells.component + tile.cells.at(k, j, i)];
      }
    });
  }
  std::vector<double> loads() const override { return {per_area_ * pi * radius_ * radius_, 0.0, 0.0}; }

 private:
  double per_area_, radius_, width_;
};

/// The settled flow of a disc of this C_T, loaded alike all over.
std::unique_ptr<Case> settled_disc(const Wind8& o, double loading) {
  auto c = box(o, steady_march(1e-4, 100));
  const double R = tip_radius();
  c->solver->set_body_force(std::make_shared<UniformDisc>(loading * 0.5 * 1.225 * o.speed * o.speed, R, 1.5 * R / o.cells));
  c->prepare(MPI_COMM_SELF, {});
  c->run();
  REQUIRE(c->solver->march().verdict == Verdict::converged);
  return c;
}
}  // namespace

TEST_CASE("a disc of the DTU 10 MW rotor at ten cells to the radius has the thrust of blade elements and Froude's wake",
          "[rotor][nightly]") {
  const auto [wind, rpm] = GENERATE(std::pair{8.0, 6.4257}, std::pair{11.0, 8.8354});
  const Wind8 o{.speed = wind, .cells = 10.0, .upstream = 5.0, .downstream = 6.0, .side = 5.0, .core_upstream = 0.5};
  const auto c = box(o, steady_march(5e-4, 80));
  const auto actuator = act_in(*c, Actuator::Kind::disc, turning(rpm), o.cells);
  c->prepare(MPI_COMM_SELF, {});
  c->run();
  REQUIRE(c->solver->march().verdict == Verdict::converged);
  const RotorLoad load = actuator->load(c->solver->rows().back());
  const double expected = blade_element_thrust(wind, rpm);
  CAPTURE(wind, load.thrust, expected, load.power, c->solver->rows().size());
  CHECK(load.thrust == Approx(expected).epsilon(0.03));
  // Froude: along a streamline through the disc the total head falls by the thrust per area; the wake's slowing follows by
  // Bernoulli. Between .35 and .8 of the radius, half a radius behind, where streamlines have moved outward by less than a cell.
  double thrust = 0.0, area = 0.0;
  for (const SpanLoad& span : actuator->span_loads()) {
    if (span.radius < 0.35 * tip_radius() || span.radius > 0.8 * tip_radius()) continue;
    thrust += 3.0 * span.load.normal * span.length, area += 2.0 * pi * span.radius * span.length;
  }
  const double loading = thrust / area / (0.5 * 1.225 * wind * wind);
  for (const double x : {0.5, 1.0}) {
    CAPTURE(x, loading);
    CHECK(head_loss(*c->solver, x * tip_radius(), 0.35, 0.8) == Approx(loading).epsilon(0.04));
    const double lost = lost_through(*c->solver, o, x * tip_radius()) - lost_through(*c->solver, o, -2.0 * tip_radius());
    CHECK(lost == Approx(load.thrust).epsilon(0.02));
  }
}

TEST_CASE(
    "a disc that is loaded alike all over leaves Froude's wake: its thrust is what the air has lost through planes before "
    "and behind it, and far behind the air has slowed by twice as much as in the disc",
    "[rotor][nightly]") {
  const double loading = GENERATE(0.3, 0.6);  // C_T
  const Wind8 o{.speed = 8.0,
                .cells = 8.0,
                .upstream = 12.0,
                .downstream = 12.0,
                .side = 12.0,
                .core_upstream = 0.75,
                .core_downstream = 4.0};
  const auto c = settled_disc(o, loading);
  const double R = tip_radius(), U = o.speed;
  const double thrust = -source_sums(*c->solver)[0];
  CHECK(thrust == Approx(loading * 0.5 * 1.225 * U * U * pi * R * R).epsilon(0.01));
  const double before = lost_through(*c->solver, o, -2.0 * R);
  for (const double x : {1.0, 2.0, 4.0}) {
    CAPTURE(loading, x, before / thrust);
    CHECK(lost_through(*c->solver, o, x * R) - before == Approx(thrust).epsilon(0.02));
  }
  // C_T = 4 a (1 - a); in the disc U (1 - a), in the wake U (1 - 2 a).
  const double a = 0.5 * (1.0 - std::sqrt(1.0 - loading));
  // Inside, where the smeared edge is not met; the layers of cells on either side of the disc's plane.
  const double in_disc =
      1.0 - 0.5 * (mean_speed(*c->solver, o, -0.01 * R, 0.7 * R) + mean_speed(*c->solver, o, 0.01 * R, 0.7 * R)) / U;
  const double behind = 1.0 - mean_speed(*c->solver, o, 4.0 * R, 0.6 * R) / U;
  CAPTURE(a, in_disc, behind);
  CHECK(in_disc == Approx(a).epsilon(0.04));
  CHECK(behind == Approx(2.0 * a).epsilon(0.04));
}

/// What a lightly loaded disc of radius 1 takes from the axial velocity at (x, r), over what it takes in its own plane: the
/// field of a right cylinder of vortex rings that begins at the disc. Branlard & Gaunaa, Wind Energy 18 (2015) 1973, eq. 6.
double slowing_of_vortex_cylinder(double x, double r) {
  const double k = std::sqrt(4.0 * r / ((1.0 + r) * (1.0 + r) + x * x)), at_disc = 4.0 * r / ((1.0 + r) * (1.0 + r));
  return (r < 1.0 ? 1.0 : 0.0) +
         x * k / (2.0 * pi * std::sqrt(r)) * (std::comp_ellint_1(k) + (1.0 - r) / (1.0 + r) * std::comp_ellint_3(k, at_disc));
}

TEST_CASE("a lightly loaded disc slows the air before, in, behind and beside its wake as a cylinder of vortex rings does",
          "[rotor][nightly]") {
  CHECK(slowing_of_vortex_cylinder(2.0, 1e-6) == Approx(1.0 + 2.0 / std::sqrt(5.0)));  // on the axis
  const Wind8 o{.speed = 8.0,
                .cells = 8.0,
                .upstream = 12.0,
                .downstream = 12.0,
                .side = 12.0,
                .core_upstream = 2.0,
                .core_downstream = 4.0,
                .core = 2.0};
  const double R = tip_radius(), U = o.speed, loading = 0.05, a = 0.5 * (1.0 - std::sqrt(1.0 - loading));
  const auto c = settled_disc(o, loading);
  for (const double x : {-1.5, -1.0, -0.5, 0.5, 1.0, 2.0, 3.5}) {
    double worst_inside = 0.0, worst_outside = 0.0;
    const double at = each_in_plane(*c->solver, o, x * R, [](const auto&...) {}) / R;
    each_in_plane(*c->solver, o, x * R, [&](const gas::Primitive<double>& is, double /*area*/, double radius) {
      const double r = radius / R, error = std::abs((1.0 - is.u / U) / a - slowing_of_vortex_cylinder(at, r));
      if (r < 0.7) worst_inside = std::max(worst_inside, error);
      if (r > 1.3 && r < 2.0) worst_outside = std::max(worst_outside, error);
    });
    CAPTURE(x, worst_inside, worst_outside);
    CHECK(worst_inside < 0.03);
    CHECK(worst_outside < 0.03);
  }
}

TEST_CASE("a disc at thirty cells to the radius has the thrust of blade elements, and of ten", "[rotor][long]") {
  const Wind8 o{.speed = 11.0,
                .cells = 30.0,
                .upstream = 20.0,
                .downstream = 20.0,
                .side = 20.0,
                .core_upstream = 0.25,
                .core_downstream = 0.15,
                .core = 1.1,
                .growth = 1.4};
  const auto c = box(o, steady_march(5e-3, 40));
  const auto actuator = act_in(*c, Actuator::Kind::disc, turning(8.8354), o.cells);
  c->prepare(MPI_COMM_SELF, {});
  c->run();
  const double thrust = actuator->load(c->solver->rows().back()).thrust, expected = blade_element_thrust(11.0, 8.8354);
  CHECK(thrust == Approx(expected).epsilon(0.03));
}

namespace {
/// Lines that go on from a disc's flow until their helices fill the first radius of the wake: the load at the end, and the mean
/// axial velocity half a radius behind within .9 of it [m/s], of the lines over the last two thirds of a turn.
struct LinesRun {
  RotorLoad load;
  double behind_disc = 0.0, behind_lines = 0.0;
};
LinesRun run_lines(const Wind8& o, double rpm, int steps, double step) {
  const auto steady = box(o, steady_march(1e-3, 60));
  const auto disc = act_in(*steady, Actuator::Kind::disc, turning(rpm), o.cells);
  steady->prepare(MPI_COMM_SELF, {});
  steady->run();
  UNSCOPED_INFO("disc: " << disc->load(steady->solver->rows().back()).thrust << " N");
  FlowSetting s;
  s.time_order = 2, s.dt = step, s.physical_far_field = true;
  s.march.drop = 1e-2, s.march.max_steps = 10;
  const auto c = box(o, s);
  const auto lines = act_in(*c, Actuator::Kind::lines, turning(rpm), o.cells);
  c->solver->start_from(*steady->solver);
  c->prepare(MPI_COMM_SELF, {});
  const double R = tip_radius(), plane = 0.5 * R;
  const int last = int(std::lround(40.0 / rpm / step));
  LinesRun run;
  run.behind_disc = mean_speed(*steady->solver, o, plane, 0.9 * R);
  for (int n = 1; n <= steps; ++n) {
    lines->place(turning(rpm, n * step * rpm * rad_s_per_rpm));
    c->run();
    REQUIRE(c->solver->march().verdict != Verdict::failed);
    run.load = lines->load(c->solver->rows().back());
    c->solver->judgement().rows.all.clear();
    if (n % 5 == 0) UNSCOPED_INFO(n * step << " s: " << run.load.thrust << " N, " << run.load.power << " W");
    if (n <= steps - last) continue;
    run.behind_lines += mean_speed(*c->solver, o, plane, 0.9 * R) / last;
  }
  return run;
}
}  // namespace

// Far sides nearer than twenty radii hold the wake as the walls of a tunnel would: 3 % more thrust at four radii.
TEST_CASE(
    "lines at ten cells to the radius go on from a disc's flow with the thrust of blade elements, and slow the air as it does",
    "[rotor][nightly]") {
  const auto [wind, rpm] = GENERATE(std::pair{8.0, 6.4257}, std::pair{11.0, 8.8354});
  const Wind8 o{.speed = wind,
                .cells = 10.0,
                .upstream = 20.0,
                .downstream = 20.0,
                .side = 20.0,
                .core_upstream = 0.4,
                .core_downstream = 1.0};
  const LinesRun run = run_lines(o, rpm, 40, 3.3 / wind);
  CHECK(run.load.thrust == Approx(blade_element_thrust(wind, rpm)).epsilon(0.03));
  CAPTURE(run.behind_disc, run.behind_lines);
  CHECK(wind - run.behind_lines == Approx(wind - run.behind_disc).epsilon(0.02));
}

TEST_CASE("lines at thirty cells to the radius go on from a disc's flow with the thrust of blade elements", "[rotor][long]") {
  const Wind8 o{.speed = 11.0,
                .cells = 30.0,
                .upstream = 20.0,
                .downstream = 20.0,
                .side = 20.0,
                .core_upstream = 0.25,
                .core_downstream = 0.5,
                .core = 1.1,
                .growth = 1.4};
  CHECK(run_lines(o, 8.8354, 100, 0.12).load.thrust == Approx(blade_element_thrust(11.0, 8.8354)).epsilon(0.03));
}

TEST_CASE("blades meet the wind less their own motion", "[rotor][fast]") {
  const auto sections_in = [](double wind, double downwind) {
    const auto c = box({.speed = wind, .cells = 4.0}, {});
    DiscMotion rotor = turning(8.8354);
    rotor.hub_velocity.x() = downwind;
    const auto lines = act_in(*c, Actuator::Kind::lines, rotor, 4.0);
    c->prepare();
    std::vector<double> sums(lines->sums(), 0.0), part(lines->sums());
    for (std::size_t n = 0; n < c->solver->tiles().size(); ++n) {
      lines->sample(n, c->solver->tiles()[n], part);
      for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += part[k];
    }
    lines->act(sums);
    CHECK(lines->least_weight() > 0.9);
    return lines->loads();
  };
  const std::vector<double> moving = sections_in(11.0, 1.0), standing = sections_in(10.0, 0.0), faster = sections_in(11.0, 0.0);
  REQUIRE(moving.size() == standing.size());
  for (std::size_t n = 0; n < moving.size(); ++n) CHECK(moving[n] == Approx(standing[n]).epsilon(1e-9).margin(1e-3));
  CHECK(faster[0] > 1.05 * standing[0]);
}

TEST_CASE("the declarations of an actuator are sound in themselves", "[rotor][fast]") {
  CHECK(actuator_section().faults().empty());
}

TEST_CASE("a scene with an actuator says a turbine, a grid and a time that suit it", "[rotor][fast]") {
  const auto problems = [](const std::string& aero, const std::string& rotor) -> std::string {
    scene::Document doc =
        scene::parse("[aero]\n" + aero + "[rotor]\n" + rotor, "test.toml", std::filesystem::temp_directory_path());
    const AeroOptions air = doc.read(aero_section());
    check_actuator(doc, air, doc.read(rotor_section()), "rotor.hub_m");
    try {
      doc.finish();
    } catch (const scene::SceneError& e) { return e.what(); }
    return {};
  };
  const std::string grid = "[aero.flow.generate]\nkind = 'box'\nlow_m = [-200, -200, -200]\nhigh_m = [200, 200, 200]\n",
                    turbine = "turbine = '" SPINDRIFT_SOURCE_DIR "/inputs/turbines/dtu_10mw.toml'\n";
  CHECK(problems("model = 'actuator_disc'\n" + grid, turbine).empty());
  CHECK_THAT(problems("model = 'actuator_disc'\n" + grid, turbine + "hub_m = [0, 0, 119]\n"),
             Contains("rotor.hub_m") && Contains("out of the grid, which goes from -200 to 200 m along z"));
  CHECK_THAT(problems("model = 'actuator_disc'\n" + grid, ""), Contains("rotor.turbine") && Contains("must name a turbine file"));
  CHECK_THAT(problems("model = 'actuator_line'\n" + grid, turbine), Contains("aero.flow.time") && Contains("lines turn"));
  CHECK_THAT(problems("model = 'actuator_disc'\n", turbine), Contains("aero.flow") && Contains("must be given"));
  CHECK_THAT(problems("model = 'actuator_disc'\n[aero.grid]\n[aero.flow]\n", turbine), Contains("has no blades in its grid"));
  CHECK_THAT(problems("model = 'actuator_disc'\n" + grid + "[aero.actuator]\nwidth_cells = 0.5\n", turbine),
             Contains("aero.actuator.width_cells"));
  CHECK_THAT(problems("model = 'bem'\n[aero.actuator]\nwidth_cells = 2.0\n", turbine), Contains("aero.actuator"));
}

TEST_CASE("a rotor that does not fit into the grid is refused with the grid's size", "[rotor][fast]") {
  RotorOptions rotor;
  rotor.turbine = SPINDRIFT_SOURCE_DIR "/inputs/turbines/dtu_10mw.toml";
  rotor.hub_m = {0.0, 0.0, 119.0};
  const auto grid = [](double low) {
    return cartesian_box({.ni = 4, .nj = 4, .nk = 4, .low = {-100.0, -100.0, low}, .high = {100.0, 100.0, 300.0}});
  };
  CHECK_NOTHROW(require_rotor_inside(grid(0.0), rotor, "rotor.hub_m"));
  CHECK_THROWS_WITH(require_rotor_inside(grid(40.0), rotor, "rotor.hub_m"),
                    Contains("rotor.hub_m") && Contains("from 40 to 300 m along z"));
  CHECK_THROWS_WITH(require_rotor_inside(planar_box(BoxOptions()), rotor, "rotor.hub_m"), Contains("three dimensions"));
}
