// SPDX-License-Identifier: Apache-2.0
#include "src/aero/rotor_grid/rotor_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "kernels/base/constants.hpp"
#include "kernels/base/failure.hpp"
#include "src/aero/rotor_grid/coarsen.hpp"
#include "src/aero/rotor_grid/plane.hpp"

namespace spindrift::aero {

namespace {

enum BlockOfSector { ring, plug, sw, w, nw, s, n, se, e, ne, blocks_of_sector };

/// Cells of the H lines that an H block takes: [J0, J1) along s, [I0, I1) along x.
struct Part {
  const char* name;
  int J0, J1, I0, I1;
};

std::array<Part, 8> parts(const RotorGridSizes& z) {
  const int J1 = z.beside, J2 = J1 + z.box_chordwise(), J3 = J2 + z.beside, I1 = z.upstream, I2 = I1 + z.box,
            I3 = I2 + z.downstream;
  return {{{"sw", 0, J1, 0, I1},
           {"w", J1, J2, 0, I1},
           {"nw", J2, J3, 0, I1},
           {"s", 0, J1, I1, I2},
           {"n", J2, J3, I1, I2},
           {"se", 0, J1, I2, I3},
           {"e", J1, J2, I2, I3},
           {"ne", J2, J3, I2, I3}}};
}

/// Blocks and connections of one sector after another, of the layers [first, last) of cells; windows are given as whole sides or
/// parts of them.
class Assembly {
 public:
  Assembly(const RotorGridSpec& spec, const RotorLayout& layout, int blades, int first, int last)
      : z_(spec.sizes),
        layout_(layout),
        blades_(blades),
        sectors_(spec.whole ? blades : 1),
        first_(first),
        last_(last),
        inboard_(std::clamp(z_.span, first, last) - first) {}

  /// Without nodes where there is no blade.
  MultiBlockGrid make(const BladeSurface* blade) {
    nodes_ = blade != nullptr;
    lay_out_first_sector();
    if (nodes_) make_first_sector(*blade);
    for (int b = 1; b < sectors_; ++b) turn_sector(b);
    if (sectors_ > 1 && nodes_) join_sides();
    for (int b = 0; b < sectors_; ++b) connect(b);
    return std::move(grid_);
  }

 private:
  Block& block(int sector, int which) { return grid_.blocks[std::size_t(sector * blocks_of_sector + which)]; }
  Block empty(const std::string& name, int ni, int nj, int nk) const {
    Block b{.name = name, .ni = ni, .nj = nj, .nk = nk};
    if (nodes_ && nk > 0) b.nodes.resize(std::size_t(ni + 1) * std::size_t(nj + 1) * std::size_t(nk + 1));
    return b;
  }

  static Eigen::Vector3d point(double r, const Eigen::Vector2d& p) {
    const double theta = p.x() / r;
    return {p.y(), -r * std::sin(theta), r * std::cos(theta)};
  }

  void lay_out_first_sector() {
    const int nk = last_ - first_;
    grid_.blocks.push_back(empty("ring_1", z_.layers, z_.round, nk));
    grid_.blocks.push_back(empty("plug_1", z_.chordwise(), z_.edge, nk - inboard_));
    for (const Part& p : parts(z_)) grid_.blocks.push_back(empty(fmt::format("{}_1", p.name), p.J1 - p.J0, p.I1 - p.I0, nk));
  }

  void make_first_sector(const BladeSurface& blade) {
    const int nk = last_ - first_;
#pragma omp parallel for schedule(dynamic)
    for (int k = 0; k <= nk; ++k) fill_plane(make_plane(blade, layout_, first_ + k), k);
  }

  void fill_plane(const Plane& plane, int k) {
    Block& o = block(0, ring);
    for (int j = 0; j <= z_.round; ++j)
      for (int i = 0; i <= z_.layers; ++i) o.nodes[o.node(k, j, i)] = point(plane.r, plane.ring_nodes[plane.ring.at(j, i)]);
    if (Block& inside = block(0, plug); k >= inboard_ && inside.nk > 0) {
      for (int j = 0; j <= inside.nj; ++j)
        for (int i = 0; i <= inside.ni; ++i) inside.nodes[inside.node(k - inboard_, j, i)] = point(plane.r, plane.plug(i, j));
    }
    const auto all = parts(z_);
    for (int m = 0; m < 8; ++m) {
      Block& h = block(0, sw + m);
      for (int j = 0; j <= h.nj; ++j)
        for (int i = 0; i <= h.ni; ++i)
          h.nodes[h.node(k, j, i)] = point(plane.r, plane.h(all[std::size_t(m)].J0 + i, all[std::size_t(m)].I0 + j));
    }
  }

  Eigen::Matrix3d turn(int sectors) const {
    const double angle = 2.0 * pi * sectors / blades_;
    Eigen::Matrix3d r = Eigen::Matrix3d::Identity();
    r(1, 1) = r(2, 2) = std::cos(angle), r(1, 2) = -std::sin(angle), r(2, 1) = std::sin(angle);
    return r;
  }

  void turn_sector(int sector) {
    const Eigen::Matrix3d rotation = turn(sector);
    for (int m = 0; m < blocks_of_sector; ++m) {
      Block b = block(0, m);
      b.name = fmt::format("{}_{}", b.name.substr(0, b.name.find('_')), sector + 1);
#pragma omp parallel for
      for (std::size_t p = 0; p < b.nodes.size(); ++p) b.nodes[p] = rotation * b.nodes[p];
      grid_.blocks.push_back(std::move(b));
    }
  }

  /// Turned sectors meet to rounding; their common nodes are made the same.
  void join_sides() {
    for (int b = 0; b < sectors_; ++b)
      for (int m = 0; m < 3; ++m) {
        const std::array<int, 3> high{nw, n, ne}, low{sw, s, se};
        const Block& from = block(b, high[std::size_t(m)]);
        Block& to = block((b + 1) % sectors_, low[std::size_t(m)]);
        for (int k = 0; k <= to.nk; ++k)
          for (int j = 0; j <= to.nj; ++j) to.nodes[to.node(k, j, 0)] = from.nodes[from.node(k, j, from.ni)];
      }
  }

  Window side(int sector, int which, Side where) {
    const std::array<int, 3> n = block(sector, which).cells();
    const int d = direction_of(where), a = d == 0 ? 1 : 0, b = d == 2 ? 1 : 2;
    return {sector * blocks_of_sector + which, where, {0, 0}, {n[std::size_t(a)], n[std::size_t(b)]}};
  }
  static Window part(Window window, int along, int low, int high) {
    window.low[std::size_t(along)] = low, window.high[std::size_t(along)] = high;
    return window;
  }
  void join(const Window& from, const Window& to, const std::array<int, 3>& orientation = {1, 2, 3}) {
    grid_.connections.push_back({from, to, orientation, {}});
  }

  void connect(int b) {
    join(side(b, ring, Side::j_max), side(b, ring, Side::j_min));
    if (has_plug()) connect_plug(b);
    connect_box(b);
    const auto rows = [&](int low, int high) { join(side(b, low, Side::j_max), side(b, high, Side::j_min)); };
    const auto columns = [&](int low, int high) { join(side(b, low, Side::i_max), side(b, high, Side::i_min)); };
    columns(sw, w), columns(w, nw), columns(se, e), columns(e, ne);
    rows(sw, s), rows(s, se), rows(nw, n), rows(n, ne);
    const int next = (b + 1) % sectors_;
    const std::array<int, 3> high{nw, n, ne}, low{sw, s, se};
    for (int m = 0; m < 3; ++m) {
      join(side(b, high[std::size_t(m)], Side::i_max), side(next, low[std::size_t(m)], Side::i_min));
      if (sectors_ == 1 && blades_ > 1) grid_.connections.back().periodic = RigidMap{turn(-1), Eigen::Vector3d::Zero()};
    }
    bound(b);
  }

  /// Ring beyond the tip, round the plug; the plug's tail is met by the ring's first and last cells.
  void connect_plug(int b) {
    const Window inner = part(side(b, ring, Side::i_min), 1, inboard_, last_ - first_);
    const int half = z_.round / 2, end = z_.edge / 2;
    const auto tail = side(b, plug, Side::i_min);
    join(part(inner, 0, 0, end), part(tail, 0, 0, end), {-1, -2, 3});
    join(part(inner, 0, end, half - end), side(b, plug, Side::j_min), {-2, 1, 3});
    join(part(inner, 0, half - end, half + end), side(b, plug, Side::i_max), {1, 2, 3});
    join(part(inner, 0, half + end, z_.round - end), side(b, plug, Side::j_max), {2, -1, 3});
    join(part(inner, 0, z_.round - end, z_.round), part(tail, 0, end, z_.edge), {-1, -2, 3});
  }

  /// Outer side of the ring, cell by cell of the box's four sides, from the ring's cut onwards.
  void connect_box(int b) {
    struct Meeting {
      int which;
      Side where;
      std::array<int, 3> orientation;
      int cells;
      bool backwards;
    };
    const std::array<Meeting, 4> sides{{{w, Side::j_max, {-2, 1, 3}, z_.box_chordwise(), false},
                                        {n, Side::i_min, {1, 2, 3}, z_.box, false},
                                        {e, Side::j_min, {2, -1, 3}, z_.box_chordwise(), true},
                                        {s, Side::i_max, {-1, -2, 3}, z_.box, true}}};
    const Window outer = side(b, ring, Side::i_max);
    int begin = z_.box / 2 + layout_.roll();
    for (const Meeting& m : sides) {
      const int low = ((begin % z_.round) + z_.round) % z_.round, first = std::min(m.cells, z_.round - low);
      const auto piece = [&](int from, int to, int at) {  // cells [from, to) of the side, which the ring meets from `at`
        if (from == to) return;
        const Window there = side(b, m.which, m.where);
        join(part(outer, 0, at, at + to - from),
             m.backwards ? part(there, 0, m.cells - to, m.cells - from) : part(there, 0, from, to), m.orientation);
      };
      piece(0, first, low);
      piece(first, m.cells, 0);
      begin += m.cells;
    }
  }

  void bound(int b) {
    const auto patch = [&](const Window& where, const std::string& name) { grid_.boundaries.push_back({where, name}); };
    const std::string wall = fmt::format("blade_{}", b + 1);
    const std::string inner = first_ == 0 ? "hub" : "cut", outer = last_ == z_.radial() ? "far" : "cut";
    if (inboard_ > 0) patch(part(side(b, ring, Side::i_min), 1, 0, inboard_), wall);
    if (has_plug()) patch(side(b, plug, Side::k_min), first_ <= z_.span ? wall : "cut"), patch(side(b, plug, Side::k_max), outer);
    for (int m = 0; m < blocks_of_sector; ++m)
      if (m != plug) patch(side(b, m, Side::k_min), inner), patch(side(b, m, Side::k_max), outer);
    for (const int m : {sw, w, nw}) patch(side(b, m, Side::j_min), "inflow");
    for (const int m : {se, e, ne}) patch(side(b, m, Side::j_max), "outflow");
  }

  bool has_plug() const { return inboard_ < last_ - first_; }

  const RotorGridSizes& z_;
  const RotorLayout& layout_;
  int blades_, sectors_;
  int first_, last_;
  int inboard_;  ///< layers of these that lie inboard of the tip
  bool nodes_ = false;
  MultiBlockGrid grid_;
};

/// By how many nodes round the section the grid is turned after a pitched blade.
int roll_of(const RotorGridSpec& spec) {
  const int fit = 1 << spec.coarsen;
  return fit * int(std::lround(spec.sizes.round * spec.pitch / (2.0 * pi * fit)));
}

BladeSettings blade_settings(const Turbine& turbine, const RotorGridSpec& spec) {
  if (turbine.aerofoils.empty())
    throw NumericalFailure("rotor grid: the turbine file has no turbine.aerofoils, the outlines that a surface is made from",
                           "turbine", 0, 0.0);
  BladeSettings settings;
  settings.spacing = section_spacing(spec.sizes, spec.rounded_edge);
  settings.hub_radius = spec.hub_radius_m, settings.pitch = spec.pitch,
  settings.roll = 2.0 * pi * roll_of(spec) / spec.sizes.round;
  return settings;
}

}  // namespace

RotorGridMaker::RotorGridMaker(const Turbine& turbine, const RotorGridSpec& spec)
    : spec_(spec),
      blades_(turbine.blades),
      blade_(turbine, blade_settings(turbine, spec)),
      layout_(blade_, spec, turbine.blades, roll_of(spec)),
      described_(fine(0, spec.sizes.radial(), false)) {
  for (int m = 0; m < spec_.coarsen; ++m) described_ = coarsened(described_);
}

MultiBlockGrid RotorGridMaker::fine(int first, int last, bool nodes) const {
  return Assembly(spec_, layout_, blades_, first, last).make(nodes ? &blade_ : nullptr);
}

GridLayers RotorGridMaker::make(int first, int last, bool compared) const {
  const int end = std::min(layers(), compared ? last + 1 : last), tip = spec_.sizes.span >> spec_.coarsen;
  GridLayers part;
  part.grid = fine(first << spec_.coarsen, end << spec_.coarsen, true);
  for (int m = 0; m < spec_.coarsen; ++m) part.grid = coarsened(part.grid);
  for (std::size_t b = 0; b < part.grid.blocks.size(); ++b) {
    const int begins = b % blocks_of_sector == plug ? tip : 0, from = std::max(first, begins);
    part.first.push_back(from - begins), part.count.push_back(std::max(0, last - from));
  }
  return part;
}

MultiBlockGrid make_rotor_grid(const Turbine& turbine, const RotorGridSpec& spec) {
  const RotorGridMaker maker(turbine, spec);
  return maker.make(0, maker.layers()).grid;
}

}  // namespace spindrift::aero
