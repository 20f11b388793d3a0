// SPDX-License-Identifier: Apache-2.0
#include "src/aero/grid/cgns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "src/aero/grid/connect.hpp"
#include "src/aero/grid/index_map.hpp"
#include "src/aero/grid/neutral_map.hpp"
#include "src/scene/error.hpp"

#ifdef SPINDRIFT_CGNS
#include <cgnslib.h>
#endif

namespace spindrift::aero {

namespace {
[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& message) {
  throw scene::SceneError({{file.string(), 0, "", "", message}});
}
}  // namespace

#ifndef SPINDRIFT_CGNS

bool cgns_available() { return false; }
MultiBlockGrid read_cgns(const std::filesystem::path& file, double) {
  refuse(file, "this program was built without CGNS (Debian: libcgns-dev); Plot3D with a neutral map file always works");
}
void write_cgns(const MultiBlockGrid&, const std::filesystem::path& file) {
  refuse(file, "this program was built without CGNS (Debian: libcgns-dev); Plot3D with a neutral map file always works");
}

#else

namespace {

/// An open file; calls say what they were doing where the library reports an error.
class File {
 public:
  File(const std::filesystem::path& path, int mode) : path_(path) { check(cg_open(path.c_str(), mode, &number_), "opening"); }
  ~File() {
    if (number_ >= 0) cg_close(number_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  void close() {
    const int number = number_;
    number_ = -1;
    check(cg_close(number), "closing");
  }
  int number() const { return number_; }
  void check(int status, const std::string& doing) const {
    if (status != CG_OK) refuse(path_, fmt::format("CGNS: {} failed: {}", doing, cg_get_error()));
  }

 private:
  std::filesystem::path path_;
  int number_ = -1;
};

constexpr int base = 1;
constexpr const char* coordinate_names[] = {"CoordinateX", "CoordinateY", "CoordinateZ"};
using Name = char[33];

class CgnsReader {
 public:
  CgnsReader(const std::filesystem::path& path, double width) : path_(path), file_(path, CG_MODE_READ), width_(width) {}

  MultiBlockGrid run() {
    const int zones = find_base();
    Name name{};
    int physical = 0;
    call(cg_base_read(file_.number(), base_, name, &dimensions_, &physical), "reading the base");
    if (dimensions_ != physical || dimensions_ < 2)
      refuse(path_, fmt::format("base \"{}\" has cells of dimension {} in {} dimensions: 3 in 3 or 2 in 2 are read", name,
                                dimensions_, physical));
    grid_.planar = dimensions_ == 2;
    for (int z = 1; z <= zones; ++z) nodes(z);
    for (int z = 1; z <= zones; ++z) connections(z), boundaries(z);
    if (grid_.connections.empty() && grid_.boundaries.empty()) connect_by_coordinates(grid_);
    make_right_handed(grid_);
    return std::move(grid_);
  }

 private:
  void call(int status, const std::string& doing) const { file_.check(status, doing); }

  /// The one base with zones, else the first; how many these are.
  int find_base() {
    int bases = 0, zones = 0;
    call(cg_nbases(file_.number(), &bases), "counting bases");
    if (bases < 1) refuse(path_, "has no base");
    for (int b = 1; b <= bases; ++b) {
      int more = 0;
      call(cg_nzones(file_.number(), b, &more), "counting zones");
      if (zones > 0 && more > 0) refuse(path_, "has more than one base with zones: put one alone into a file");
      if (more > 0) base_ = b, zones = more;
    }
    return zones;
  }

  /// The unit of a coordinate [m]: the one stated nearest to it, else the metre.
  double unit_of(int zone, const char* coordinate) const {
    LengthUnits_t unit = Meter;
    const auto look = [&](int went) {
      MassUnits_t mass;
      LengthUnits_t length;
      TimeUnits_t time;
      TemperatureUnits_t temperature;
      AngleUnits_t angle;
      if (went == CG_OK && cg_units_read(&mass, &length, &time, &temperature, &angle) == CG_OK && length != LengthUnitsNull)
        unit = length;
    };
    look(cg_goto(file_.number(), base_, "end"));
    look(cg_goto(file_.number(), base_, "Zone_t", zone, "end"));
    look(cg_goto(file_.number(), base_, "Zone_t", zone, "GridCoordinates_t", 1, "end"));
    look(cg_goto(file_.number(), base_, "Zone_t", zone, "GridCoordinates_t", 1, coordinate, 0, "end"));
    switch (unit) {
      case Meter:
        return 1.0;
      case Centimeter:
        return 1e-2;
      case Millimeter:
        return 1e-3;
      case Foot:
        return 0.3048;
      case Inch:
        return 0.0254;
      case LengthUnitsNull:
      case LengthUnitsUserDefined:
        break;
    }
    refuse(path_, fmt::format("{} of zone {} is in a unit of its own: metres, centimetres, millimetres, feet and inches are read",
                              coordinate, zone));
  }

  void nodes(int zone) {
    Name name{};
    cgsize_t size[9] = {};
    ZoneType_t type;
    call(cg_zone_type(file_.number(), base_, zone, &type), "reading a zone's type");
    call(cg_zone_read(file_.number(), base_, zone, name, size), "reading a zone");
    if (type != Structured) refuse(path_, fmt::format("zone \"{}\" is not structured", name));
    Index n{2, 2, 2};
    for (int d = 0; d < dimensions_; ++d) n[d] = int(size[d]);
    for (int d = 0; d < 3; ++d)
      if (n[d] < 2) refuse(path_, fmt::format("zone \"{}\" has {} nodes in {}: at least 2 are needed", name, n[d], "ijk"[d]));
    Block block{name, n[0] - 1, n[1] - 1, n[2] - 1, {}};
    const std::size_t count = std::size_t(n[0]) * n[1] * (dimensions_ == 3 ? n[2] : 1);
    std::vector<double> x[3];
    const cgsize_t first[3] = {1, 1, 1}, last[3] = {n[0], n[1], n[2]};
    for (int c = 0; c < dimensions_; ++c) {
      x[c].resize(count);
      call(cg_coord_read(file_.number(), base_, zone, coordinate_names[c], RealDouble, first, last, x[c].data()),
           fmt::format("reading {} of zone \"{}\"", coordinate_names[c], name));
      const double unit = unit_of(zone, coordinate_names[c]);
      for (double& length : x[c]) length *= unit;
    }
    if (dimensions_ == 3) {
      for (std::size_t p = 0; p < count; ++p) block.nodes.push_back({x[0][p], x[1][p], x[2][p]});
    } else {
      for (const double y : {0.0, -width_})
        for (std::size_t p = 0; p < count; ++p) block.nodes.push_back({x[0][p], y, x[1][p]});
    }
    number_[name] = int(grid_.blocks.size());
    grid_.blocks.push_back(std::move(block));
  }

  /// A window from a range of nodes: the side is where both ends are the same.
  Window window(int block, const cgsize_t* range, const std::string& what) const {
    const Index cells = grid_.blocks[block].cells();
    Window w{block, Side::i_min, {0, 0}, {1, 1}};
    int across = -1;
    for (int d = 0; d < dimensions_; ++d)
      if (range[d] == range[dimensions_ + d] && (range[d] == 1 || range[d] == cells[d] + 1)) across = d;
    if (across < 0) refuse(path_, fmt::format("{}: its range lies on no side of zone \"{}\"", what, grid_.blocks[block].name));
    w.side = Side(2 * across + (range[across] != 1));
    const auto directions = along(w.side);
    for (int s = 0; s < 2; ++s) {
      const int d = directions[s];
      if (d >= dimensions_) continue;
      w.low[s] = int(std::min(range[d], range[dimensions_ + d])) - 1,
      w.high[s] = int(std::max(range[d], range[dimensions_ + d])) - 1;
      if (w.low[s] < 0 || w.high[s] > cells[d] || w.low[s] == w.high[s])
        refuse(path_, fmt::format("{}: nodes {} to {} of {} in {}", what, w.low[s] + 1, w.high[s] + 1, cells[d] + 1, "ijk"[d]));
    }
    return w;
  }

  void connections(int zone) {
    int count = 0;
    call(cg_n1to1(file_.number(), base_, zone, &count), "counting connections");
    for (int n = 1; n <= count; ++n) {
      Name name{}, donor{};
      cgsize_t range[6] = {}, donor_range[6] = {};
      int transform[3] = {1, 2, 3};
      call(cg_1to1_read(file_.number(), base_, zone, n, name, donor, range, donor_range, transform), "reading a connection");
      const std::string what = fmt::format("connection \"{}\"", name);
      const auto other = number_.find(donor);
      if (other == number_.end()) refuse(path_, fmt::format("{} names zone \"{}\", which is not there", what, donor));
      Connection c{window(zone - 1, range, what),
                   window(other->second, donor_range, what),
                   {transform[0], transform[1], dimensions_ == 3 ? transform[2] : 3},
                   {}};
      // A connection stands with both its zones; ours once.
      const auto same = [](const Window& a, const Window& b) {
        return a.block == b.block && a.side == b.side && a.low == b.low && a.high == b.high;
      };
      bool known = false;
      for (const Connection& k : grid_.connections) known = known || (same(k.from, c.to) && same(k.to, c.from));
      if (known) continue;
      for (const int d : c.orientation)
        if (d == 0 || std::abs(d) > 3) refuse(path_, fmt::format("{} has a transform of {}", what, d));
      const double apart = find_periodic_map(grid_, c);
      if (apart > 0)
        refuse(path_, fmt::format("{}: the windows' nodes lie up to {:.3g} m apart under any rigid motion", what, apart));
      grid_.connections.push_back(c);
    }
  }

  void boundaries(int zone) {
    int count = 0;
    call(cg_nbocos(file_.number(), base_, zone, &count), "counting boundaries");
    for (int n = 1; n <= count; ++n) {
      Name name{}, family{};
      BCType_t type;
      PointSetType_t set;
      DataType_t normals;
      cgsize_t points = 0, normal_size = 0;
      int normal[3] = {}, data_sets = 0;
      call(cg_boco_info(file_.number(), base_, zone, n, name, &type, &set, &points, normal, &normal_size, &normals, &data_sets),
           "reading a boundary");
      GridLocation_t location = Vertex;
      cg_boco_gridlocation_read(file_.number(), base_, zone, n, &location);
      if (set != PointRange || points != 2 || location != Vertex)
        refuse(path_, fmt::format("boundary \"{}\" is not given as a range of nodes", name));
      cgsize_t range[6] = {};
      call(cg_boco_read(file_.number(), base_, zone, n, range, nullptr), "reading a boundary's range");
      std::string patch = name;
      if (type == FamilySpecified && cg_goto(file_.number(), base_, "Zone_t", zone, "ZoneBC_t", 1, "BC_t", n, "end") == CG_OK &&
          cg_famname_read(family) == CG_OK)
        patch = family;
      grid_.boundaries.push_back({window(zone - 1, range, fmt::format("boundary \"{}\"", name)), patch});
    }
  }

  const std::filesystem::path& path_;
  File file_;
  double width_;
  int base_ = 1, dimensions_ = 3;
  MultiBlockGrid grid_;
  std::map<std::string, int> number_;
};

/// Names of at most 32 characters, each once.
std::string zone_name(const MultiBlockGrid& grid, int b) { return fmt::format("{:.24}_{}", grid.blocks[b].name, b + 1); }

void write_range(const MultiBlockGrid& grid, const Window& w, int dimensions, cgsize_t* range) {
  const Index cells = grid.blocks[w.block].cells();
  const auto directions = along(w.side);
  for (int s = 0; s < 2; ++s)
    if (directions[s] < dimensions) range[directions[s]] = w.low[s] + 1, range[dimensions + directions[s]] = w.high[s] + 1;
  const int across = direction_of(w.side);
  range[across] = range[dimensions + across] = at_end(w.side) ? cells[across] + 1 : 1;
}

}  // namespace

bool cgns_available() { return true; }

MultiBlockGrid read_cgns(const std::filesystem::path& file, double planar_width) {
  if (!std::filesystem::exists(file)) refuse(file, "cannot be opened");
  return CgnsReader(file, planar_width).run();
}

void write_cgns(const MultiBlockGrid& grid, const std::filesystem::path& path) {
  const int dimensions = grid.planar ? 2 : 3;
  File file(path, CG_MODE_WRITE);
  int number = 0;
  file.check(cg_base_write(file.number(), "Base", dimensions, dimensions, &number), "writing the base");
  for (int b = 0; b < int(grid.blocks.size()); ++b) {
    const Block& block = grid.blocks[b];
    cgsize_t size[9] = {};
    for (int d = 0; d < dimensions; ++d) size[d] = block.cells()[d] + 1, size[dimensions + d] = block.cells()[d];
    int zone = 0, c = 0;
    file.check(cg_zone_write(file.number(), base, zone_name(grid, b).c_str(), size, Structured, &zone), "writing a zone");
    std::vector<double> x(block.nodes.size() / (grid.planar ? 2 : 1));
    for (int d = 0; d < dimensions; ++d) {
      for (std::size_t p = 0; p < x.size(); ++p) x[p] = block.nodes[p][grid.planar && d == 1 ? 2 : d];
      file.check(cg_coord_write(file.number(), base, zone, RealDouble, coordinate_names[d], x.data(), &c), "writing coordinates");
    }
  }
  const auto connect = [&](const Window& from, const Window& to, const IndexMap& map, int n) {
    cgsize_t range[6] = {}, donor[6] = {};
    write_range(grid, from, dimensions, range), write_range(grid, to, dimensions, donor);
    int transform[3], id = 0;
    for (int d = 0; d < 3; ++d) {
      transform[d] = map.axes[d];
      // The donor's range begins where the range's first node is.
      const int t = map.target(d);
      if (d < dimensions && map.sign(d) < 0) std::swap(donor[t], donor[dimensions + t]);
    }
    file.check(cg_1to1_write(file.number(), base, from.block + 1, fmt::format("connection_{}", n).c_str(),
                             zone_name(grid, to.block).c_str(), range, donor, transform, &id),
               "writing a connection");
  };
  int n = 0;
  for (const Connection& c : grid.connections) {
    const IndexMap map{c.orientation, {}};
    connect(c.from, c.to, map, ++n), connect(c.to, c.from, map.inverse(), ++n);
  }
  std::map<std::string, std::string> families;  // of patches; names of at most 32 characters, each once
  for (const Boundary& b : grid.boundaries) {
    int id = 0;
    const auto taken = [&](const std::string& name) {
      return std::ranges::any_of(families, [&](const auto& f) { return f.first != b.patch && f.second == name; });
    };
    const auto [known, added] = families.try_emplace(b.patch, fmt::format("{:.32}", b.patch));
    std::string& family = known->second;
    for (int k = 2; taken(family); ++k) family = fmt::format("{:.24}_{}", b.patch, k);
    if (added) file.check(cg_family_write(file.number(), base, family.c_str(), &id), "writing a family");
    cgsize_t range[6] = {};
    write_range(grid, b.where, dimensions, range);
    file.check(cg_boco_write(file.number(), base, b.where.block + 1, fmt::format("boundary_{}", ++n).c_str(), FamilySpecified,
                             PointRange, 2, range, &id),
               "writing a boundary");
    file.check(cg_goto(file.number(), base, "Zone_t", b.where.block + 1, "ZoneBC_t", 1, "BC_t", id, "end"), "finding a boundary");
    file.check(cg_famname_write(family.c_str()), "writing a family's name");
  }
  file.close();
}

#endif

}  // namespace spindrift::aero
