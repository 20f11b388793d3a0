// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "src/aero/flow/sweep.hpp"
#include "src/aero/flow_options.hpp"
#include "src/aero/grid/cgns.hpp"
#include "src/aero/grid/checks.hpp"
#include "src/aero/grid/coarsen.hpp"
#include "src/aero/grid/generators/box.hpp"
#include "src/aero/grid/generators/plane_cases.hpp"
#include "src/aero/grid/join.hpp"
#include "src/aero/grid/neutral_map.hpp"
#include "src/aero/grid/plot3d.hpp"
#include "src/aero/turbine.hpp"
#include "src/scene/error.hpp"
#include "src/scene/section.hpp"

namespace spindrift::aero {

namespace {

std::array<std::vector<double>, 3> box_nodes(const GenerateOptions& g) {
  std::array<std::vector<double>, 3> nodes;
  for (std::size_t d = 0; d < 3; ++d)
    nodes[d] = stretched_nodes(g.low_m[d], g.core_low_m[d], g.core_high_m[d], g.high_m[d], g.cell_m, g.growth);
  return nodes;
}

void check_stretched_box(const GenerateOptions& o, const scene::Report& report) {
  constexpr double least_cells = 4.0;  // between the core and a side that it does not reach
  for (std::size_t d = 0; d < 3; ++d) {
    const char axis = "xyz"[d];
    if (o.core_high_m[d] <= o.core_low_m[d])
      report("core_high_m", fmt::format("must be above core_low_m along each axis; along {} it is {} and {}", axis,
                                        o.core_high_m[d], o.core_low_m[d]));
    const auto check_side = [&](const char* key, double side, double beyond) {
      if (beyond == 0.0 || beyond >= least_cells * o.cell_m) return;
      report(key, fmt::format("must be where the box ends, at {} m along {}, or {:g} cells inside, {} m; found {} m of room",
                              side, axis, least_cells, least_cells * o.cell_m, beyond));
    };
    check_side("core_low_m", o.low_m[d], o.core_low_m[d] - o.low_m[d]);
    check_side("core_high_m", o.high_m[d], o.high_m[d] - o.core_high_m[d]);
  }
}

void check_box(const GenerateOptions& o, const scene::Report& report) {
  if (o.kind == "stretched_box") check_stretched_box(o, report);
  if (o.kind != "box") return;
  for (std::size_t d = 0; d < 3; ++d) {
    if (o.cells[d] != std::floor(o.cells[d])) report("cells", fmt::format("must be whole numbers; found {}", o.cells[d]));
    if (o.high_m[d] <= o.low_m[d])
      report("high_m",
             fmt::format("must be above low_m along each axis; along {} it is {} and {}", "xyz"[d], o.high_m[d], o.low_m[d]));
  }
  for (const std::string& axis : o.periodic) {
    if (axis != "x" && axis != "y" && axis != "z")
      report("periodic", fmt::format("names axes: \"x\", \"y\", \"z\"; found \"{}\"", axis));
    if (axis == "y" && o.cells[1] == 1.0) report("periodic", "\"y\" has no meaning in a planar box (one cell along y)");
  }
}

MultiBlockGrid make_box(const GenerateOptions& g) {
  const auto repeats = [&](const char* axis) {
    return std::find(g.periodic.begin(), g.periodic.end(), axis) != g.periodic.end();
  };
  const auto point = [](const std::array<double, 3>& a) { return Eigen::Vector3d(a[0], a[1], a[2]); };
  BoxOptions box{.low = point(g.low_m), .high = point(g.high_m)};
  const int x = int(g.cells[0]), y = int(g.cells[1]), z = int(g.cells[2]);
  if (y == 1) {  // i along x, j along z
    box.ni = x, box.nj = z, box.nk = 1;
    box.periodic = {repeats("x"), repeats("z"), false};
    box.patches = {"x_min", "x_max", "z_min", "z_max", "", ""};
    return planar_box(box);
  }
  box.ni = x, box.nj = y, box.nk = z;
  box.periodic = {repeats("x"), repeats("y"), repeats("z")};
  box.patches = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};
  return cartesian_box(box);
}

MultiBlockGrid section_grid(const GenerateOptions& g, double width, bool inviscid) {
  constexpr double first_cell_inviscid = 1e-3;  // chords; finer ones march for hundreds of steps and show nothing more
  AerofoilOptions o{.n = g.refinement, .far = g.far_m, .width = width};
  if (inviscid) o.first_cell = first_cell_inviscid;
  if (g.first_cell_m > 0.0) o.first_cell = g.first_cell_m;
  constexpr int points = 200;  // on either side: .01 mm of a chord of 1 m beside the formula
  if (g.coordinates.empty() && !g.naca) return naca0012(o);
  try {
    return aerofoil(g.naca ? NacaSection(*g.naca).outline(points, g.trailing_edge) : read_outline(g.coordinates), o);
  } catch (const std::invalid_argument& e) {
    if (g.naca) throw scene::SceneError({{.key = "aero.flow.generate.naca", .value = *g.naca, .message = e.what()}});
    throw scene::SceneError({scene::Problem{g.coordinates, 0, "", "", e.what()}});
  }
}

MultiBlockGrid generated(const GenerateOptions& g, double width, bool inviscid) {
  if (g.kind == "box") return make_box(g);
  if (g.kind == "stretched_box")
    return cartesian_box(box_nodes(g), {.patches = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"}});
  if (g.kind == "flat_plate") return flat_plate(g.refinement, width);
  if (g.kind == "naca0012" || g.kind == "aerofoil") return section_grid(g, width, inviscid);
  if (g.kind == "wing") return extruded(section_grid(g, width, inviscid), g.span_cells, g.span_m, false);
  if (g.kind == "bump") {
    BumpOptions o{.n = g.refinement, .width = width};
    if (g.first_cell_m > 0.0) o.first_cell = g.first_cell_m;
    return bump_channel(o);
  }
  return cylinder({.around = g.around,
                   .outward = g.outward,
                   .radius = g.radius_m,
                   .far = g.far_m,
                   .first_cell = g.first_cell_m,
                   .width = width});
}

/// A grid of three dimensions has its own width, also where it is one cell wide.
void check_width(const FlowOptions& o, const MultiBlockGrid& grid) {
  if (!o.width_m) return;
  const Block& first = grid.blocks.front();
  const double width = grid.planar ? (first.nodes[first.node(1, 0, 0)] - first.nodes[0]).norm() : 0.0;
  if (grid.planar && std::abs(width - *o.width_m) <= 1e-9 * width) return;
  throw scene::SceneError({{.key = "aero.flow.width_m",
                            .value = fmt::format("{}", *o.width_m),
                            .message = fmt::format("has no effect: {} has three dimensions{}", o.grid,
                                                   grid.planar ? fmt::format(" and is {:g} m wide", width) : "")}});
}

bool is_cgns(const std::string& file) { return std::filesystem::path(file).extension() == ".cgns"; }

}  // namespace

const scene::Section<GenerateOptions>& generate_section() {
  using scene::above, scene::between;
  static const auto section =
      scene::Section<GenerateOptions>("generate", "A grid made by the program. Families: every member samples one smooth law.")
          .choice("kind", &GenerateOptions::kind,
                  {{"box", "a box of equal cells; patches x_min ... z_max"},
                   {"stretched_box", "a box with a core of equal cells that grow beyond it: rotor and wake; the same patches"},
                   {"flat_plate", "NASA's flat plate from x = 0 to 2 m; patches inflow, outflow, symmetry, wall, top"},
                   {"cylinder", "an O round a circular cylinder along y; patches wall, farfield"},
                   {"naca0012", "a C round NACA 0012, chord 1 m from x = 0; patches wall, farfield, outflow"},
                   {"aerofoil", "a C round the section of `naca` or the outline of `coordinates`, likewise"},
                   {"wing", "one of these two drawn out along y; patch sides beside those"},
                   {"bump", "NASA's bump in a channel; patches inflow, outflow, symmetry, wall, top"}},
                  "Shape.")
          .required()
          .at_most_one_of({"coordinates", "naca"})
          .path("coordinates", &GenerateOptions::coordinates,
                "Outline from the trailing edge along the upper side to the nose and back, over the chord: CSV with columns x_c, "
                "y_c, "
                "or .dat with a title and two numbers a line (Selig or Lednicer). The trailing edge may lie off the x axis (a "
                "flap): axes stay those of the file. A wing with neither it nor `naca` has NACA 0012.")
          .only_if("kind", {"aerofoil", "wing"})
          .text("naca", &GenerateOptions::naca,
                "Digits of the section in place of coordinates, four or five: \"4412\" (camber in %, its place in tenths of the "
                "chord, thickness in %), \"23012\" or, with a mean line that bends back, \"23112\".")
          .only_if("kind", {"aerofoil", "wing"})
          .choice<TrailingEdge>("trailing_edge", &GenerateOptions::trailing_edge,
                                {{"closed", TrailingEdge::closed, "sharp by the formula: last coefficient -.1036"},
                                 {"open", TrailingEdge::open,
                                  "the printed ordinates (-.1015); the grid draws their edge together, by a shift as the cube of "
                                  "x, as of coordinates"}},
                                "Trailing edge of `naca`.")
          .only_if("kind", {"aerofoil", "wing"})
          .integer("refinement", &GenerateOptions::refinement, "-",
                   "Member of the family: 34 n x 24 n cells (flat_plate), 112 n x 32 n (naca0012, aerofoil, wing), 44 n x 20 n "
                   "(bump).",
                   between(1, 32))
          .only_if("kind", {"flat_plate", "naca0012", "aerofoil", "wing", "bump"})
          .integer("around", &GenerateOptions::around, "-", "Cells round the cylinder.", between(8, 1e5))
          .only_if("kind", {"cylinder"})
          .integer("outward", &GenerateOptions::outward, "-", "Cells from the cylinder to the far field.", between(4, 512))
          .only_if("kind", {"cylinder"})
          .number("radius_m", &GenerateOptions::radius_m, "m", "Radius of the cylinder.", above(0.0).up_to(1e4))
          .only_if("kind", {"cylinder"})
          .number("far_m", &GenerateOptions::far_m, "m", "Distance of the far field (cylinder: its radius).",
                  above(0.0).up_to(1e6))
          .only_if("kind", {"cylinder", "naca0012", "aerofoil", "wing"})
          .number("first_cell_m", &GenerateOptions::first_cell_m, "m",
                  "Height of the first cell at the wall, of refinement 2 or 64 cells around and in proportion for others; 0: the "
                  "generator's own "
                  "(aerofoil 3.6e-6, without friction 1e-3; bump 1e-5; cylinder: radii in geometric progression).",
                  between(0.0, 1e3))
          .only_if("kind", {"cylinder", "naca0012", "aerofoil", "wing", "bump"})
          .number("span_m", &GenerateOptions::span_m, "m", "Span of the wing.", above(0.0).up_to(1e4))
          .only_if("kind", {"wing"})
          .integer("span_cells", &GenerateOptions::span_cells, "-", "Cells along the span.", between(2, 1e4))
          .only_if("kind", {"wing"})
          .vector("cells", &GenerateOptions::cells, "-", "Cells of the box along x, y, z; one along y makes it planar.",
                  between(1, 4096))
          .only_if("kind", {"box"})
          .vector("low_m", &GenerateOptions::low_m, "m", "Lowest corner of the box.")
          .only_if("kind", {"box", "stretched_box"})
          .vector("high_m", &GenerateOptions::high_m, "m", "Highest corner of the box.")
          .only_if("kind", {"box", "stretched_box"})
          .number("cell_m", &GenerateOptions::cell_m, "m", "Cells of the core.", above(0.0).up_to(1e5))
          .only_if("kind", {"stretched_box"})
          .vector("core_low_m", &GenerateOptions::core_low_m, "m", "Lowest corner of the core.")
          .only_if("kind", {"stretched_box"})
          .vector("core_high_m", &GenerateOptions::core_high_m, "m", "Highest corner of the core.")
          .only_if("kind", {"stretched_box"})
          .number("growth", &GenerateOptions::growth, "-", "Most that a cell beyond the core is longer than the one before it.",
                  above(1.0).up_to(2.0))
          .only_if("kind", {"stretched_box"})
          .texts("periodic", &GenerateOptions::periodic, "Axes along which the box repeats, of \"x\", \"y\", \"z\".")
          .only_if("kind", {"box"})
          .check([](const GenerateOptions& o, const scene::Report& report) {
            check_box(o, report);
            if (o.kind == "cylinder" && o.far_m <= 2.0 * o.radius_m)
              report("far_m", fmt::format("must be above 2 radius_m = {}; found {}", 2.0 * o.radius_m, o.far_m));
            if (o.kind == "aerofoil" && o.coordinates.empty() && !o.naca)
              report("naca", "must be the digits of the section, or `coordinates` the file of its outline");
            if (!o.naca && o.trailing_edge == TrailingEdge::open)
              report("trailing_edge", "needs `naca`: coordinates have the edge that is in the file");
            try {
              if (o.naca) NacaSection{*o.naca};
            } catch (const std::invalid_argument& e) { report("naca", e.what()); }
            if ((o.kind == "naca0012" || o.kind == "aerofoil" || o.kind == "wing") && o.far_m < 5.0)
              report("far_m", fmt::format("must be at least 5 chords; found {}", o.far_m));
          });
  return section;
}

GeneratedSize generated_size(const GenerateOptions& g) {
  const double n2 = double(g.refinement) * g.refinement;
  if (g.kind == "box") return {g.cells[0] * g.cells[1] * g.cells[2], "aero.flow.generate.cells"};
  if (g.kind == "stretched_box") {
    double cells = 1.0;
    for (std::size_t d = 0; d < 3; ++d) {  // before the nodes themselves, which might not fit
      const double beyond = std::max(0.0, g.core_low_m[d] - g.low_m[d]) + std::max(0.0, g.high_m[d] - g.core_high_m[d]);
      cells *= (g.core_high_m[d] - g.core_low_m[d]) / g.cell_m +
               2.0 * std::log1p(beyond / g.cell_m * (g.growth - 1.0)) / std::log(g.growth);
    }
    return {cells, "aero.flow.generate.cell_m"};
  }
  if (g.kind == "cylinder") return {double(g.around) * g.outward, "aero.flow.generate.around"};
  if (g.kind == "wing") return {112.0 * 32.0 * n2 * g.span_cells, "aero.flow.generate.span_cells"};
  const double base = g.kind == "flat_plate" ? 34.0 * 24.0 : g.kind == "bump" ? 44.0 * 20.0 : 112.0 * 32.0;
  return {base * n2, "aero.flow.generate.refinement"};
}

std::optional<Corners> box_corners(const FlowOptions& o) {
  if (!o.generate || !o.generate->kind.ends_with("box")) return {};
  const auto corner = [](const std::array<double, 3>& x) { return Eigen::Vector3d(x[0], x[1], x[2]); };
  return Corners{corner(o.generate->low_m), corner(o.generate->high_m)};
}

MultiBlockGrid flow_grid(const FlowOptions& o) {
  MultiBlockGrid grid;
  if (o.generate) {
    grid = generated(*o.generate, planar_width(o), o.viscous == "none");
  } else if (is_cgns(o.grid)) {
    grid = read_cgns(o.grid, planar_width(o));
  } else {
    grid = read_plot3d(o.grid, planar_width(o));
    read_neutral_map(grid, o.map);
  }
  if (!o.generate) check_width(o, grid);
  require_sound(grid, o.generate ? "aero.flow.generate" : o.grid);
  grid = join_cuts(std::move(grid), longest_row);
  if (const std::string why = o.coarse_steps.value_or(0) > 0 ? why_not_halved(grid) : std::string(); !why.empty())
    throw scene::SceneError(
        {{.key = "aero.flow.coarse_steps",
          .value = fmt::format("{}", *o.coarse_steps),
          .message = fmt::format("needs a grid whose every second node makes a grid; {}, an odd number or too few", why)}});
  return grid;
}

std::string describe_flow_grid(const FlowOptions& o) {
  if (!o.generate) return o.grid;
  return "made: " + o.generate->kind + (o.generate->naca ? ", NACA " + *o.generate->naca : "");
}

}  // namespace spindrift::aero
