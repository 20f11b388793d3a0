// What a scene may give at the sides of the air: temperatures of walls and the turbulence of the wind.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>

#include "kernels/turbulence/model_sa.hpp"
#include "src/aero/grid/wall_distance.hpp"
#include "tests/src/aero/flow/flows.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using namespace spindrift::aero::testing;

namespace {

/// A cell's value of an unknown.
double value(const FlowTile& tile, int unknown, int j = 0) {
  return tile.state.data()[unknown * tile.cells.component + tile.cells.at(0, j, 0)];
}

/// A march of wind through a box from a state in which turbulence is still the wind's; what it carries in the end.
std::array<double, 2> carried(const std::string& closure, std::optional<double> eddy, std::optional<double> intensity) {
  FlowSetting s = air(0.1);
  s.viscous = true, s.turbulence = closure, s.wind_eddy_viscosity = eddy, s.wind_intensity = intensity;
  s.march.max_steps = 3;
  const BoxOptions box{.ni = 8, .nj = 8, .nk = 8};
  const PatchCondition open{Condition::far_field, false};
  Case c(cartesian_box(box), s,
         {{"i_min", open}, {"i_max", open}, {"j_min", open}, {"j_max", open}, {"k_min", open}, {"k_max", open}});
  c.prepare();
  c.run();
  const FlowTile& tile = c.solver->tiles().front();
  return {value(tile, mean_unknowns), tile.turbulence > 1 ? value(tile, mean_unknowns + 1) : 0.0};
}

}  // namespace

TEST_CASE("air at rest between walls held at two temperatures conducts heat by Fourier's law", "[flow][fast]") {
  constexpr int cells = 16;
  const double low = 258.15, high = 318.15;
  FlowSetting s = air(0.01);
  s.stream = {};
  s.viscous = true, s.preconditioned = false;
  s.gas.viscosity.mu0 = 0.1;
  s.march.drop = 1e-8, s.march.max_steps = 200;
  const BoxOptions box{.ni = 4, .nj = cells, .periodic = {true, false, false}};
  Case c(planar_box(box), s,
         {{"j_min", {.condition = Condition::no_slip, .temperature = low}},
          {"j_max", {.condition = Condition::no_slip, .temperature = high}}});
  c.prepare();
  c.run();
  CHECK(c.solver->march().verdict == Verdict::converged);
  // The flux, conductivity times slope, is the same at every height, so the integral of viscosity over temperature is linear.
  const auto integral = [&](double T) {
    double sum = 0.0;
    constexpr int parts = 200;
    for (int n = 0; n < parts; ++n) sum += gas::viscosity(s.gas, low + (n + 0.5) / parts * (T - low)) * (T - low) / parts;
    return sum;
  };
  double largest = 0.0, fastest = 0.0;
  for (const FlowTile& tile : c.solver->tiles()) {
    const TileGeometry& g = *tile.geometry;
    for_rows(tile.box, [&](int k, int j) {
      for (int i = 0; i < tile.box.ni; ++i) {
        const std::ptrdiff_t at = tile.cells.at(k, j, i);
        const double z = g.centre_data.data()[g.cell_box.at(k, j, i) + 2 * g.cell_box.component];
        const double T = s.gas.temperature_reference + tile.state.data()[at + 4 * tile.cells.component];
        largest = std::max(largest, std::abs(integral(T) / integral(high) - z));
        fastest = std::max(fastest, std::abs(tile.state.data()[at + 3 * tile.cells.component]));
      }
    });
  }
  CHECK(largest < 1e-3);
  CHECK(fastest < 1e-3);
}

TEST_CASE("the wind's eddy viscosity and intensity are what its turbulence carries", "[flow][fast]") {
  const FlowSetting s = air(0.1);
  const double nu = gas::viscosity(s.gas, s.gas.temperature_reference) / gas::density(s.gas, s.stream);
  for (const double ratio : {0.01, 0.21, 10.0, 1000.0}) {
    const double chi = carried("sa", ratio, {})[0] / nu;
    CHECK(chi * turbulence::SaConstants::fv1(chi) == Approx(ratio).epsilon(1e-6));
  }
  const double k = 1.5 * 0.01 * 0.01 * s.speed * s.speed;
  const auto both = carried("sst", 10.0, 0.01);
  CHECK(both[0] == Approx(k).epsilon(0.02));  // what decays on the way through the box
  CHECK(both[0] / both[1] == Approx(10.0 * nu).epsilon(0.02));
}

TEST_CASE("a wall with a wall function, or no wall, is not held at a temperature", "[flow][fast]") {
  const BoxOptions box{.ni = 8, .nj = 8, .nk = 8};
  const PatchCondition warm{.condition = Condition::slip, .temperature = 300.0};
  CHECK_THROWS_AS(Case(cartesian_box(box), air(0.1), {{"i_min", warm}}), std::invalid_argument);
}

TEST_CASE("on a wall held at a temperature turbulence has the viscosity of that temperature", "[flow][fast]") {
  const double wall = 358.15;
  for (const char* closure : {"sa", "sst"}) {
    FlowSetting s = air(0.1);
    s.viscous = true, s.turbulence = closure;
    const PatchCondition open{Condition::far_field, false};
    Case c(
        planar_box({.ni = 8, .nj = 8}), s,
        {{"i_min", open}, {"i_max", open}, {"j_max", open}, {"j_min", {.condition = Condition::no_slip, .temperature = wall}}});
    fill_wall_distance(*c.store, wall_surface(c.grid, std::vector<std::string>{"j_min"}));
    FlowTile& tile = c.solver->tiles().front();
    double* state = tile.state.data();
    const PhysicalTime steady;
    const ModelSweeps& model = model_sweeps(closure);
    const FlowResidual residual(s, model, steady);
    residual.fill_ghosts(tile, state), residual.gradients(tile, state), residual.fill_gradient_ghosts(tile, state);
    const double mu = gas::viscosity(s.gas, wall), nu = mu * s.gas.gas_constant * wall / s.gas.pressure_reference;
    for (const FlowBoundary& boundary : tile.boundaries) {
      if (!boundary.temperature) continue;
      const Side side = boundary.where.side;
      const int d = direction_of(side), out = at_end(side) ? 1 : -1;
      for_window(tile, side, boundary.where.low, boundary.where.high, [&](int k, int j, int i) {
        const auto on_face = [&](const double* of, const BoxLayout& box) {
          const std::ptrdiff_t cell = box.at(k, j, i);
          return 0.5 * (of[cell] + of[cell + out * box.stride(d)]);
        };
        const BoxLayout& box = tile.gradient_box;
        for (int t = 0; t < model.equations; ++t)
          CHECK(on_face(tile.gradients.data() + (eddy_component(model.equations) + 2 + t) * box.component, box) ==
                Approx(model.wall_spread[std::size_t(t)] * mu).epsilon(1e-12));
        if (model.equations == 2)  // Menter (1994), eq. A12, at a first centre 1/16 m from the wall
          CHECK(on_face(state + (mean_unknowns + 1) * tile.cells.component, tile.cells) ==
                Approx(60.0 / 0.075 * nu * 256.0).epsilon(1e-9));
      });
    }
  }
}

TEST_CASE("the first cell in a corner of walls with a wall function has the friction of each and the mean turbulence of both",
          "[flow][fast]") {
  FlowSetting s = air(0.1, {2.0, 0.3, 1.0});  // faster along j_min than along k_min
  s.viscous = true, s.turbulence = "sst", s.limiter = "first_order", s.wind_eddy_viscosity = 1000.0, s.wind_intensity = 0.01;
  // The corner cell's face on k_min is twice as large as that on j_min.
  const BoxOptions box{.ni = 1, .nj = 2, .nk = 4};
  struct Corner {
    double k, omega;                             ///< residual of k; omega of the law
    std::array<double, 2> friction{}, y_plus{};  ///< of the faces on j_min and k_min
  };
  const auto corner = [&](Condition on_j, Condition on_k) {
    const PatchCondition open{Condition::far_field, false};
    Case c(cartesian_box(box), s,
           {{"i_min", open}, {"i_max", open}, {"j_max", open}, {"k_max", open}, {"j_min", {on_j}}, {"k_min", {on_k}}});
    std::vector<std::string> walls;
    if (sticks(on_j)) walls.push_back("j_min");
    if (sticks(on_k)) walls.push_back("k_min");
    fill_wall_distance(*c.store, wall_surface(c.grid, walls));
    FlowTile& tile = c.solver->tiles().front();
    double* state = tile.state.data();
    const PhysicalTime steady;
    const FlowResidual residual(s, model_sweeps(s.turbulence), steady);
    residual.fill_ghosts(tile, state), residual.gradients(tile, state), residual.fill_gradient_ghosts(tile, state);
    residual.evaluate(tile, state, tile.residual.data());
    const double* at = tile.residual.data() + tile.inner.at(0, 0, 0) + mean_unknowns * tile.inner.component;
    const double mass = tile.geometry->volume_data.data()[tile.geometry->cell_box.at(0, 0, 0)] * gas::density(s.gas, s.stream);
    const double omega = value(tile, mean_unknowns + 1);  // below the law's; at[c] = mass law (omega - law)
    Corner corner{at[0], 0.5 * (omega + std::sqrt(omega * omega - 4.0 * at[tile.inner.component] / mass)), {}, {}};
    for (const WallPoint& p : c.solver->wall_points(tile))  // the corner cell's centre is at y = 1/4, z = 1/8
      for (const auto& [n, name, place] :
           {std::tuple{0, "j_min", Eigen::Vector3d(0.5, 0.0, 0.125)}, std::tuple{1, "k_min", Eigen::Vector3d(0.5, 0.25, 0.0)}})
        if (p.patch == c.store->tiling().patch(name) && (Eigen::Vector3d(p.place.data()) - place).norm() < 1e-9) {
          corner.friction[std::size_t(n)] = Eigen::Vector3d(p.traction.data()).norm();
          corner.y_plus[std::size_t(n)] = p.y_plus;
        }
    return corner;
  };
  const Corner j = corner(Condition::wall_function, Condition::slip), k = corner(Condition::slip, Condition::wall_function),
               both = corner(Condition::wall_function, Condition::wall_function);
  CAPTURE(j.k, k.k, both.k, j.omega, k.omega, both.omega);
  CHECK(std::abs(j.omega - k.omega) > 0.01 * k.omega);
  CHECK(both.omega == Approx((j.omega + 2.0 * k.omega) / 3.0).epsilon(1e-9));
  CHECK(both.k == Approx((j.k + 2.0 * k.k) / 3.0).epsilon(1e-9));
  // Each face has the friction of its wall alone, by its own distance.
  for (const std::size_t n : {std::size_t(0), std::size_t(1)}) {
    const Corner& alone = n == 0 ? j : k;
    CHECK(alone.friction[n] > 0.0);
    CHECK(both.friction[n] == Approx(alone.friction[n]).epsilon(1e-9));
    CHECK(both.y_plus[n] == Approx(alone.y_plus[n]).epsilon(1e-9));
  }
}

TEST_CASE("friction of a wall function is along the wall, the turbulence's push counts as pressure", "[flow][fast]") {
  FlowSetting s = air(0.1);
  s.viscous = true, s.turbulence = "sst", s.wind_eddy_viscosity = 100.0, s.wind_intensity = 0.1;
  s.march.max_steps = 3;
  const PatchCondition open{Condition::far_field, false};
  Case c(planar_box({.ni = 8, .nj = 8}), s,
         {{"i_min", open}, {"i_max", open}, {"j_max", open}, {"j_min", {.condition = Condition::wall_function, .loads = true}}});
  fill_wall_distance(*c.store, wall_surface(c.grid, std::vector<std::string>{"j_min"}));
  c.prepare();
  c.run();
  double push = 0.0, gas_push = 0.0, drag = 0.0;
  for (const FlowTile& tile : c.solver->tiles()) {
    for (const WallPoint& p : c.solver->wall_points(tile)) {
      REQUIRE(std::hypot(p.traction[0], p.traction[1]) > 0.0);
      CHECK(std::abs(p.traction[2]) < 1e-12 * std::abs(p.traction[0]));
      push += p.pressure * p.area, drag += p.traction[0] * p.area;
    }
    for (const FlowBoundary& b : tile.boundaries)
      if (of(Condition::wall_function).name == b.condition->name)
        for_window(tile, b.where.side, b.where.low, b.where.high, [&](int k, int j, int i) {
          gas_push += wall_pressure(tile, tile.state.data(), b.where.side, k, j, i) *
                      outward_face(*tile.geometry, b.where.side, k, j, i).area;
        });
  }
  CHECK(push > gas_push + 1e-3 * std::abs(drag));
  const PatchLoads loads = c.solver->judgement().patch(c.store->tiling().patch("j_min"));
  CHECK(std::abs(loads.pressure_force[2]) == Approx(std::abs(push)));
  CHECK(loads.viscous_force[0] == Approx(drag));
  CHECK(std::abs(loads.viscous_force[2]) < 1e-12 * std::abs(drag));
}

TEST_CASE("what modelled turbulence pushes on a slip wall counts as pressure", "[flow][fast]") {
  FlowSetting s = air(0.1, {1.0, 0.0, 0.0});
  s.viscous = true, s.turbulence = "sst", s.wind_eddy_viscosity = 100.0, s.wind_intensity = 0.1;
  const PatchCondition open{Condition::far_field, false};
  Case c(planar_box({.ni = 8, .nj = 8}), s,
         {{"i_min", open}, {"i_max", open}, {"j_max", open}, {"j_min", {.condition = Condition::slip, .loads = true}}});
  FlowTile& tile = c.solver->tiles().front();
  const PhysicalTime steady;
  const FlowResidual residual(s, model_sweeps(s.turbulence), steady);
  double* state = tile.state.data();
  residual.fill_ghosts(tile, state), residual.gradients(tile, state), residual.fill_gradient_ghosts(tile, state);
  const double push = 2.0 / 3.0 * gas::density(s.gas, s.stream) * 1.5 * 0.1 * 0.1 * s.speed * s.speed;
  std::vector<double> sums(std::size_t(load_components) * c.store->tiling().patches.size());
  double area = 0.0;
  for (const WallPoint& p : c.solver->wall_points(tile)) {
    CHECK(p.pressure == Approx(push));
    CHECK(std::hypot(p.traction[0], p.traction[1], p.traction[2]) == 0.0);
    CHECK(p.y_plus == 0.0);
    area += p.area;
  }
  add_loads(tile, state, residual.viscous(), {}, sums, {});
  const PatchLoads loads = patch_loads(sums, c.store->tiling().patch("j_min"));
  CHECK(loads.pressure_force[2] == Approx(-push * area));
}

TEST_CASE("an inflow faster than sound brings its pressure too", "[flow][fast]") {
  FlowSetting s = air(2.0);
  s.march.drop = 1e-8;
  Case c(planar_box({.ni = 8, .nj = 8}), s,
         {{"i_min", {Condition::inflow}},
          {"i_max", {Condition::outflow}},
          {"j_min", {Condition::symmetry}},
          {"j_max", {Condition::symmetry}}});
  c.solver->start([&](const Eigen::Vector3d&) {
    gas::Primitive<double> q = s.stream;
    q.p += 3e4, q.T += 20.0;
    return q;
  });
  c.prepare();
  c.run();
  CHECK(c.solver->march().verdict == Verdict::converged);
  CAPTURE(c.solver->march().steps);
  CHECK(stream_deviation(*c.solver) < 1e-6);
}
