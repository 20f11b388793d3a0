// SPDX-License-Identifier: Apache-2.0
#include "src/aero/first_cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "kernels/base/failure.hpp"
#include "kernels/base/interpolation.hpp"
#include "src/aero/flow/flow_solver.hpp"
#include "src/aero/flow/sweep_model.hpp"
#include "src/aero/flow_options.hpp"
#include "src/aero/grid/index_map.hpp"
#include "src/aero/grid/line_growth.hpp"
#include "src/aero/resolved_rotor_setup.hpp"
#include "src/aero/rotor_grid/options.hpp"
#include "src/aero/rotor_grid/rotor_grid.hpp"
#include "src/aero/turbine.hpp"
#include "src/scene/error.hpp"

namespace spindrift::aero {

namespace {

struct WallFace {
  const Boundary* of = nullptr;
  Index cell{};  ///< at it
  Condition condition = Condition::no_slip;
  double area = 0.0, distance = 0.0, along = 0.0;  ///< of the first cell's centre from the wall; of the face along the wind
};

using FaceCorners = std::array<Eigen::Vector3d, 4>;

/// Of the face of a cell at a boundary, or of the one `depth` cells further in.
FaceCorners face_corners(const Boundary& b, const MultiBlockGrid& grid, const Index& cell, int depth) {
  const Block& block = grid.blocks[std::size_t(b.where.block)];
  const std::size_t d = std::size_t(direction_of(b.where.side));
  const auto [u, v] = along(b.where.side);
  FaceCorners x;
  for (int n = 0; n < 4; ++n) {
    Index node = cell;
    node[d] += at_end(b.where.side) ? 1 - depth : depth;
    node[std::size_t(u)] += n == 1 || n == 2, node[std::size_t(v)] += n >= 2;
    x[std::size_t(n)] = block.nodes[block.node(node[2], node[1], node[0])];
  }
  return x;
}
Eigen::Vector3d middle(const FaceCorners& x) { return 0.25 * (x[0] + x[1] + x[2] + x[3]); }

/// Faces of a boundary, seen from the cells at it.
void add_faces_of(const Boundary& b, const MultiBlockGrid& grid, Condition condition, const Eigen::Vector3d& wind,
                  std::vector<WallFace>& faces) {
  const std::size_t d = std::size_t(direction_of(b.where.side));
  const auto [u, v] = along(b.where.side);
  Index at{};
  at[d] = at_end(b.where.side) ? grid.blocks[std::size_t(b.where.block)].cells()[d] - 1 : 0;
  for (at[std::size_t(v)] = b.where.low[1]; at[std::size_t(v)] < b.where.high[1]; ++at[std::size_t(v)])
    for (at[std::size_t(u)] = b.where.low[0]; at[std::size_t(u)] < b.where.high[0]; ++at[std::size_t(u)]) {
      const FaceCorners wall = face_corners(b, grid, at, 0), next = face_corners(b, grid, at, 1);
      const Eigen::Vector3d normal = 0.5 * (wall[2] - wall[0]).cross(wall[3] - wall[1]);
      const double area = normal.norm();
      if (area == 0.0) continue;
      const double height = std::abs((middle(next) - middle(wall)).dot(normal)) / area;
      faces.push_back({&b, at, condition, area, 0.5 * height, middle(wall).dot(wind)});
    }
}

/// FirstCell::growth, by the distances of faces' middles.
double growth_from(const WallFace& face, const MultiBlockGrid& grid, double y_plus) {
  const Window& where = face.of->where;
  const int layers = grid.blocks[std::size_t(where.block)].cells()[std::size_t(direction_of(where.side))];
  LineGrowth growth(reach_of_growth(y_plus, face.distance));
  Eigen::Vector3d last = middle(face_corners(*face.of, grid, face.cell, 0));
  for (int n = 1; n <= layers && !growth.done(); ++n) {
    const Eigen::Vector3d next = middle(face_corners(*face.of, grid, face.cell, n));
    growth.add((next - last).norm());
    last = next;
  }
  return growth.largest();
}

/// White's plate at x from its edge.
double plate_y_plus(double speed, double x, double nu, double distance) {
  const double cf = 0.027 / std::pow(std::max(speed * x / nu, 1.0), 1.0 / 7.0);
  return speed * std::sqrt(0.5 * cf) * distance / nu;
}

/// What blades meet, and what their grid is made to. A rotor whose speed is not known turns at a tip-speed ratio of 7.
struct BladeFlow {
  BladeFlow(const ResolvedRotorSetup& setup, const Turbine& turbine)
      : wind(setup.wind.norm()),
        turning(setup.rotor.speed != 0.0 ? std::abs(setup.rotor.speed) : 7.0 * wind / turbine.planform.span.back()),
        nu(setup.flow.viscosity_Pa_s / setup.air_density),
        spec(rotor_grid_spec(setup.grid, turbine, setup.rotor.blade_pitch, turning, wind)) {}
  double speed(double r) const { return std::hypot(turning * r, wind); }

  double wind, turning, nu;
  RotorGridSpec spec;
};

/// Of both sides of a blade from the hub to where the tip is closed, by the grid's description.
std::vector<FirstCell> blade_cells(const ResolvedRotorSetup& setup, const Turbine& turbine) {
  constexpr double outer = 0.985;
  constexpr int sections = 24, along_chord = 10;
  const Planform& blade = turbine.planform;
  const BladeFlow flow(setup, turbine);
  const RotorGridSpec& spec = flow.spec;
  const double length = (outer * blade.span.back() - spec.hub_radius_m) / sections;
  std::vector<FirstCell> cells;
  for (int n = 0; n < sections; ++n) {
    const double r = spec.hub_radius_m + (n + 0.5) * length, chord = interpolate_linear(blade.span, blade.chord, r);
    const double speed = flow.speed(r);
    double height = spec.first_cell_m > 0.0 ? spec.first_cell_m : spec.first_cell_chords * chord;
    if (spec.y_plus > 0.0) height = first_cell_for(spec.y_plus, speed, chord, spec.kinematic_viscosity);
    for (int i = 0; i < along_chord; ++i)
      cells.push_back({2.0 * chord / along_chord * length,
                       plate_y_plus(speed, (i + 0.5) / along_chord * chord, flow.nu, 0.5 * height * (1 << spec.coarsen))});
  }
  return cells;
}

/// Area of one side between two radii.
double planform_between(const Planform& blade, double low, double high) {
  constexpr int pieces = 16;
  double sum = 0.0;
  for (int n = 0; n < pieces; ++n) sum += interpolate_linear(blade.span, blade.chord, low + (n + 0.5) / pieces * (high - low));
  return sum / pieces * (high - low);
}

/// By the nodes of some coaxial surfaces, each for the part of a blade about it: growth too. Throws NumericalFailure where they
/// cannot be made.
std::vector<FirstCell> blade_lines(const ResolvedRotorSetup& setup, const Turbine& turbine) {
  constexpr int most_surfaces = 6;
  const BladeFlow flow(setup, turbine);
  const RotorGridMaker maker(turbine, flow.spec);
  const int step = 1 << flow.spec.coarsen, span = flow.spec.sizes.span / step, surfaces = std::min(span, most_surfaces);
  std::vector<FirstCell> cells;
  for (int n = 0; n < surfaces; ++n) {
    const int low = span * n / surfaces, high = span * (n + 1) / surfaces;
    const Plane surface = maker.surface((low + high) / 2);
    const double both_sides = 2.0 * planform_between(turbine.planform, maker.radius(low), maker.radius(high)),
                 speed = flow.speed(surface.r);
    const int round = surface.ring.round / step, layers = surface.ring.layers / step;
    const auto node = [&](int i, int j) { return surface.ring_nodes[surface.ring.at(i * step, j * step)]; };
    const Eigen::Vector2d nose = node(round / 2, 0), to_tail = node(0, 0) - nose;
    const double chord = to_tail.norm();
    double perimeter = 0.0;
    for (int i = 0; i < round; ++i) perimeter += (node(i + 1, 0) - node(i, 0)).norm();
    for (int i = 0; i < round; ++i) {
      const auto height = [&](int j) { return (node(i, j + 1) - node(i, j)).norm(); };
      const double x = std::max((node(i, 0) - nose).dot(to_tail) / chord, 0.01 * chord), centre = 0.5 * height(0);
      const double y_plus = plate_y_plus(speed, x, flow.nu, centre);
      LineGrowth growth(reach_of_growth(y_plus, centre));
      for (int j = 0; j < layers && !growth.done(); ++j) growth.add(height(j));
      cells.push_back({(node(i + 1, 0) - node(i, 0)).norm() / perimeter * both_sides, y_plus, growth.largest()});
    }
  }
  return cells;
}

}  // namespace

FirstCells expected_first_cells(const MultiBlockGrid& grid, const FlowOptions& options, const FlowSetting& s) {
  if (s.turbulence == "none" || !(s.speed > 0.0)) return {};
  const Eigen::Vector3d wind = Eigen::Vector3d(s.stream.u, s.stream.v, s.stream.w) / s.speed;
  std::vector<WallFace> faces;
  for (const Boundary& b : grid.boundaries)
    for (const PatchOptions& o : options.boundaries)
      if (o.patch == b.patch && sticks(o.condition)) add_faces_of(b, grid, o.condition, wind, faces);
  FirstCells cells;
  if (faces.empty()) return cells;
  const auto [first, last] = std::ranges::minmax_element(faces, {}, &WallFace::along);
  const double start = first->along, length = last->along - start;
  const double nu = gas::viscosity(s.gas, gas::absolute_temperature(s.gas, s.stream)) / gas::density(s.gas, s.stream);
  for (const WallFace& f : faces) {
    const double y_plus = plate_y_plus(s.speed, std::max(f.along - start, 0.01 * length), nu, f.distance);
    (of(f.condition).wall_law ? cells.by_law : cells.resolved).push_back({f.area, y_plus, growth_from(f, grid, y_plus)});
  }
  return cells;
}

FirstCells expected_first_cells(const ResolvedRotorSetup& setup) {
  const FlowOptions& o = setup.flow;
  if (o.viscous == "none" || o.turbulence == "none") return {};
  Condition condition = o.blades;
  for (const PatchOptions& b : o.boundaries)
    if (b.patch == "blade_1") condition = b.condition;
  if (!sticks(condition)) return {};
  const Turbine turbine = read_turbine(setup.rotor.turbine);
  if (of(condition).wall_law) return {.resolved = {}, .by_law = blade_cells(setup, turbine)};
  try {
    return {.resolved = blade_lines(setup, turbine), .by_law = {}};
  } catch (const NumericalFailure& failure) {
    throw scene::SceneError({{setup.rotor.turbine, 0, "aero.grid", "", failure.what()}});
  }
}

bool suits_wall_law(const ResolvedRotorSetup& setup) {
  constexpr double least = 10.0;
  const FlowOptions& o = setup.flow;
  if (o.viscous == "none" || o.turbulence == "none" || model_sweeps(o.turbulence).equations == 0) return false;
  if (setup.wind.norm() == 0.0 && setup.rotor.speed == 0.0) return false;
  const std::vector<FirstCell> cells = blade_cells(setup, read_turbine(setup.rotor.turbine));
  return share_outside(cells, least, std::numeric_limits<double>::infinity()) < 0.5;
}

namespace {

template <class Which>
double share_of(const std::vector<FirstCell>& cells, Which&& which) {
  double area = 0.0, share = 0.0;
  for (const FirstCell& c : cells) area += c.area, share += which(c) ? c.area : 0.0;
  return area > 0.0 ? share / area : 0.0;
}

std::string middle_and_most(std::vector<FirstCell> cells, double FirstCell::*value) {
  std::ranges::sort(cells, {}, value);
  return cells.empty() ? "none"
                       : fmt::format("{:.3g} in the middle, {:.3g} at most", cells[cells.size() / 2].*value, cells.back().*value);
}

}  // namespace

double share_outside(const std::vector<FirstCell>& cells, double least, double most) {
  return share_of(cells, [&](const FirstCell& c) { return c.y_plus < least || c.y_plus > most; });
}
double share_growing(const std::vector<FirstCell>& cells, double most) {
  return share_of(cells, [&](const FirstCell& c) { return c.growth > most; });
}

std::string describe(const std::vector<FirstCell>& cells) { return middle_and_most(cells, &FirstCell::y_plus); }
std::string describe_growth(const std::vector<FirstCell>& cells) { return middle_and_most(cells, &FirstCell::growth); }

std::string more_layers(const FlowOptions& o) {
  if (!o.generate) return fmt::format("take a grid with more layers than aero.flow.grid = \"{}\"", o.grid);
  if (o.generate->kind == "box") return "raise aero.flow.generate.cells";
  if (o.generate->kind == "stretched_box") return "lower aero.flow.generate.growth";
  if (o.generate->kind == "cylinder") return "raise aero.flow.generate.outward";
  return "raise aero.flow.generate.refinement";
}

std::vector<std::string> doubts_of(const FirstCells& cells, const std::string& remedy) {
  struct Treatment {
    const char* walls;
    const std::vector<FirstCell>& cells;
    double least, most;
  };
  std::vector<std::string> doubts;
  for (const Treatment& t : {Treatment{"resolved", cells.resolved, 0.0, 5.0}, {"wall-function", cells.by_law, 15.0, 1000.0}}) {
    const double off = share_outside(t.cells, t.least, t.most);
    if (off > 0.1)
      doubts.push_back(
          fmt::format("y+ of first cells is {}; {} walls want {:g} to {:g}, which {:.0f} % of their area does not "
                      "have: friction is not to be trusted",
                      describe(t.cells), t.walls, t.least, t.most, 100.0 * off));
  }
  if (const double off = share_growing(cells.resolved, doubted_growth); off > 0.1)
    doubts.push_back(fmt::format(
        "cells grow from layer to layer off resolved walls by {}, up to y+ {:g}; a boundary layer wants 1.2 to 1.3, and "
        "{:.0f} % of the walls' area has more than {:g}: drag is not to be trusted; {}",
        describe_growth(cells.resolved), wall_layer_y_plus, 100.0 * off, doubted_growth, remedy));
  return doubts;
}

}  // namespace spindrift::aero
