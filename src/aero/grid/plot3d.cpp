// SPDX-License-Identifier: Apache-2.0
#include "src/aero/grid/plot3d.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "src/aero/grid/index_map.hpp"
#include "src/scene/error.hpp"

namespace spindrift::aero {

namespace {

[[noreturn]] void refuse(const std::filesystem::path& file, int line, const std::string& value, const std::string& message) {
  throw scene::SceneError({{file.string(), line, "", value, message}});
}

[[noreturn]] void refuse_hole(const std::filesystem::path& file, int line, std::size_t node, std::size_t block) {
  refuse(file, line, "", fmt::format("node {} of block {} is blanked out (iblank 0): holes are not read", node + 1, block + 1));
}

constexpr long largest_dimension = 100'000'000;

/// How a file may be laid out: block count given or not, coordinates per node, an integer per node behind them or not.
struct Arrangement {
  bool counted;
  int dimensions;
  bool blanked;
};
constexpr Arrangement arrangements[] = {{true, 3, false}, {true, 2, false}, {false, 3, false}, {false, 2, false},
                                        {true, 3, true},  {true, 2, true},  {false, 3, true},  {false, 2, true}};

/// Node counts of each block, or nothing where the header makes no sense. `integer(n)` is the header's n-th number, -1 past its
/// end.
template <class Header>
std::vector<Index> block_nodes(const Arrangement& a, const Header& integer) {
  const long blocks = a.counted ? integer(0) : 1;
  if (blocks < 1 || blocks > 1'000'000) return {};
  std::vector<Index> nodes;
  long at = a.counted ? 1 : 0;
  for (long b = 0; b < blocks; ++b) {
    Index n{1, 1, 1};
    double total = 1;
    for (int d = 0; d < a.dimensions; ++d) {
      const long value = integer(at++);
      if (value < 1 || value > largest_dimension) return {};
      n[d] = int(value), total *= double(value);
    }
    if (total > 4e9) return {};
    nodes.push_back(n);
  }
  return nodes;
}
std::size_t count(const Index& n) { return std::size_t(n[0]) * n[1] * n[2]; }
std::size_t header_size(const Arrangement& a, std::size_t blocks) { return (a.counted ? 1 : 0) + blocks * a.dimensions; }

/// Coordinates of one block: x of all nodes, y of all, z of all.
void add_block(MultiBlockGrid& grid, const std::filesystem::path& file, const Index& n, int dimensions, double width,
               std::span<const double> x) {
  const std::size_t nodes = count(n);
  Block block{fmt::format("{}", grid.blocks.size() + 1), n[0] - 1, n[1] - 1, dimensions == 2 ? 1 : n[2] - 1, {}};
  if (block.ni < 1 || block.nj < 1 || block.nk < 1)
    refuse(
        file, 0, "",
        fmt::format("block {} has {} x {} x {} nodes: at least 2 are needed each way", grid.blocks.size() + 1, n[0], n[1], n[2]));
  if (dimensions == 3) {
    for (std::size_t p = 0; p < nodes; ++p) block.nodes.push_back({x[p], x[nodes + p], x[2 * nodes + p]});
  } else {
    // The same way for all, so that neighbours meet: blocks whose (i, j) turn clockwise seen from -y are left-handed.
    for (const double y : {0.0, -width})
      for (std::size_t p = 0; p < nodes; ++p) block.nodes.push_back({x[p], y, x[nodes + p]});
  }
  grid.planar = dimensions == 2;
  grid.blocks.push_back(std::move(block));
}

// ---- one cell wide ----

/// A direction of one cell between planes that are alike but for a step along one axis.
struct Thin {
  int direction = 0, axis = 0;
  double step = 0.0;
};

constexpr double alike = 1e-6;  // steps that differ by less, for their size: files of single precision

std::optional<Thin> thin(const Block& b) {
  for (int d = 0; d < 3; ++d) {
    if (b.cells()[d] != 1 || b.cells()[(d + 1) % 3] == 1 || b.cells()[(d + 2) % 3] == 1) continue;
    const std::size_t across = d == 0 ? b.node(0, 0, 1) : d == 1 ? b.node(0, 1, 0) : b.node(1, 0, 0);
    const Eigen::Vector3d first = b.nodes[across] - b.nodes[0];
    for (const int axis : {1, 2}) {
      const Eigen::Vector3d step = first[axis] * Eigen::Vector3d::Unit(axis);
      bool same = step.norm() > 0.0;
      for (int k = 0; k <= (d == 2 ? 0 : b.nk) && same; ++k)
        for (int j = 0; j <= (d == 1 ? 0 : b.nj) && same; ++j)
          for (int i = 0; i <= (d == 0 ? 0 : b.ni) && same; ++i) {
            const Eigen::Vector3d& x = b.nodes[b.node(k, j, i)];
            same = (b.nodes[b.node(k, j, i) + across] - x - step).norm() <= alike * step.norm();
          }
      if (same) return Thin{d, axis, std::abs(first[axis])};
    }
  }
  return {};
}

/// As the neutral map's reader expects a planar block: the two directions that are left keep their order.
Block section_of(const Block& b, const Thin& t) {
  const int u = t.direction == 0 ? 1 : 0, v = t.direction == 2 ? 1 : 2;
  Block flat{b.name, b.cells()[u], b.cells()[v], 1, {}};
  for (const double y : {0.0, -t.step})
    for (int j = 0; j <= flat.nj; ++j)
      for (int i = 0; i <= flat.ni; ++i) {
        Index at{};
        at[u] = i, at[v] = j;
        const Eigen::Vector3d& x = b.nodes[b.node(at[2], at[1], at[0])];
        flat.nodes.push_back({x.x(), y, t.axis == 1 ? x.z() : x.y()});
      }
  return flat;
}

/// Planar where all blocks are one cell wide, along one axis; else the grid as it is.
MultiBlockGrid flattened(MultiBlockGrid grid) {
  if (grid.planar) return grid;
  std::vector<Thin> ways;
  for (const Block& b : grid.blocks) {
    const std::optional<Thin> way = thin(b);
    if (!way) return grid;
    ways.push_back(*way);
    if (way->axis != ways[0].axis || std::abs(way->step - ways[0].step) > alike * ways[0].step) return grid;
    ways.back().step = ways[0].step;
  }
  for (std::size_t b = 0; b < ways.size(); ++b) grid.blocks[b] = section_of(grid.blocks[b], ways[b]);
  grid.planar = true;
  return grid;
}

// ---- formatted ----

struct Number {
  double value;
  int line;
};

std::vector<Number> numbers_of(const std::filesystem::path& file, const std::string& text) {
  std::vector<Number> numbers;
  int line = 1;
  const auto space = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == ','; };
  const auto parse = [&](const char* first, const char* last) {
    char buffer[64];
    if (last - first >= long(sizeof buffer)) refuse(file, line, std::string(first, 60) + "...", "is not a number");
    const char* end = std::transform(first, last, buffer, [](char c) { return c == 'D' || c == 'd' ? 'e' : c; });
    const char* start = buffer[0] == '+' ? buffer + 1 : buffer;
    double value = 0;
    const auto [stop, error] = std::from_chars(start, end, value);
    if (error != std::errc() || stop != end || !std::isfinite(value))
      refuse(file, line, std::string(first, last), "is not a finite number");
    return value;
  };
  const char *at = text.data(), *end = at + text.size();
  while (at < end) {
    if (space(*at)) {
      line += *at++ == '\n';
      continue;
    }
    const char* last = std::find_if(at, end, space);
    const char* star = std::find(at, last, '*');
    long repeat = 1;
    if (star != last) {
      const auto [stop, error] = std::from_chars(at, star, repeat);
      if (error != std::errc() || stop != star || repeat < 1 || repeat > largest_dimension)
        refuse(file, line, std::string(at, last), "is not a repeated number");
      at = star + 1;
    }
    const double value = parse(at, last);
    numbers.insert(numbers.end(), std::size_t(repeat), {value, line});
    at = last;
  }
  return numbers;
}

MultiBlockGrid formatted(const std::filesystem::path& file, const std::string& text, double width) {
  const auto numbers = numbers_of(file, text);
  const auto integer = [&](long n) {
    return n < long(numbers.size()) && numbers[n].value == std::floor(numbers[n].value) && std::abs(numbers[n].value) < 1e9
               ? long(numbers[n].value)
               : -1L;
  };
  std::string tried;
  for (const Arrangement& a : arrangements) {
    const auto blocks = block_nodes(a, integer);
    if (blocks.empty()) continue;
    std::size_t expected = header_size(a, blocks.size());
    const std::size_t header = expected;
    for (const Index& n : blocks) expected += count(n) * (a.dimensions + a.blanked);
    if (!a.blanked)
      tried += fmt::format("{}{}-D {} {} block{} would be {} numbers", tried.empty() ? "" : ", ", a.dimensions,
                           a.counted ? "with block count," : "without,", blocks.size(), blocks.size() > 1 ? "s" : "", expected);
    if (expected != numbers.size()) continue;
    MultiBlockGrid grid;
    std::size_t at = header;
    std::vector<double> x;
    for (const Index& n : blocks) {
      x.clear();
      for (std::size_t p = 0; p < count(n) * a.dimensions; ++p) { x.push_back(numbers[at + p].value); }
      for (std::size_t p = 0; a.blanked && p < count(n); ++p)
        if (const Number& blank = numbers[at + x.size() + p]; blank.value == 0)
          refuse_hole(file, blank.line, p, grid.blocks.size());
      at += count(n) * (a.dimensions + a.blanked);
      add_block(grid, file, n, a.dimensions, width, x);
    }
    return grid;
  }
  refuse(file, numbers.empty() ? 1 : numbers.back().line, "",
         fmt::format("no Plot3D grid has these {} numbers{}{}", numbers.size(), tried.empty() ? "" : ": read as ", tried));
}

// ---- binary ----

template <class T>
T from_bytes(const char* at, bool swapped) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, at, sizeof(T));
  if (swapped) std::reverse(bytes, bytes + sizeof(T));
  return std::bit_cast<T>(bytes);
}

/// The four-byte integer there, -1 past the end.
long word_at(const std::string& bytes, std::size_t at, bool swapped) {
  return at + 4 <= bytes.size() ? long(from_bytes<std::int32_t>(bytes.data() + at, swapped)) : -1L;
}

/// The first record, of one to three integers, between two marks of its size: then all of the file is records.
bool begins_with_record(const std::string& bytes, bool swapped) {
  const long size = word_at(bytes, 0, swapped);
  return (size == 4 || size == 8 || size == 12) && word_at(bytes, 4 + std::size_t(size), swapped) == size;
}

MultiBlockGrid binary(const std::filesystem::path& file, const std::string& bytes, double width) {
  for (const bool swapped : {false, true})
    for (const bool records : {true, false})
      for (const Arrangement& a : arrangements) {
        if (!records && begins_with_record(bytes, swapped)) continue;
        const auto word = [&](std::size_t at) { return word_at(bytes, at, swapped); };
        // Where records are marked, the count and the dimensions are a record each.
        const std::size_t first = records ? 4 : 0, second = records && a.counted ? 8 : 0;
        const auto integer = [&](long n) { return word(first + 4 * std::size_t(n) + (n >= (a.counted ? 1 : 0) ? second : 0)); };
        if (records && word(0) != (a.counted ? 4 : 4 * a.dimensions)) continue;
        const auto blocks = block_nodes(a, integer);
        if (blocks.empty()) continue;
        const std::size_t marks = records ? 8 : 0;
        const std::size_t header = 4 * header_size(a, blocks.size()) + marks * (a.counted ? 2 : 1);
        std::size_t nodes = 0;
        for (const Index& n : blocks) nodes += count(n);
        for (const std::size_t real : {8, 4}) {
          if (bytes.size() != header + nodes * (a.dimensions * real + (a.blanked ? 4 : 0)) + marks * blocks.size()) continue;
          MultiBlockGrid grid;
          std::size_t at = header;
          std::vector<double> x;
          for (const Index& n : blocks) {
            const std::size_t size = count(n) * (a.dimensions * real + (a.blanked ? 4 : 0));
            if (records && std::size_t(std::uint32_t(word(at))) != (size & 0xffffffffu))
              refuse(file, 0, "",
                     fmt::format("the record of block {} says {} bytes instead of {}", grid.blocks.size() + 1, word(at), size));
            const char* data = bytes.data() + at + marks / 2;
            x.clear();
            for (std::size_t p = 0; p < count(n) * a.dimensions; ++p) {
              x.push_back(real == 8 ? from_bytes<double>(data + 8 * p, swapped) : from_bytes<float>(data + 4 * p, swapped));
              if (!std::isfinite(x.back()))
                refuse(file, 0, "", fmt::format("coordinate {} of block {} is not finite", p, grid.blocks.size() + 1));
            }
            for (std::size_t p = 0; a.blanked && p < count(n); ++p)
              if (from_bytes<std::int32_t>(data + real * x.size() + 4 * p, swapped) == 0)
                refuse_hole(file, 0, p, grid.blocks.size());
            at += size + marks;
            add_block(grid, file, n, a.dimensions, width, x);
          }
          return grid;
        }
      }
  refuse(file, 0, "",
         fmt::format("its {} bytes are no Plot3D grid, formatted or binary (tried 2-D and 3-D, one block and many, with and "
                     "without record marks and iblank, both byte orders and precisions)",
                     bytes.size()));
}

}  // namespace

MultiBlockGrid read_plot3d(const std::filesystem::path& file, double planar_width) {
  std::ifstream in(file, std::ios::binary);
  if (!in) refuse(file, 0, "", "cannot be opened");
  const std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  if (bytes.empty()) refuse(file, 0, "", "is empty");
  const auto head = std::string_view(bytes).substr(0, 4096);
  const bool text =
      std::all_of(head.begin(), head.end(), [](unsigned char c) { return (c >= 32 && c < 127) || (c >= 9 && c <= 13); });
  return flattened(text ? formatted(file, bytes, planar_width) : binary(file, bytes, planar_width));
}

void write_plot3d(const MultiBlockGrid& grid, const std::filesystem::path& file, Plot3dForm form) {
  std::ofstream out(file, std::ios::binary);
  if (!out) refuse(file, 0, "", "cannot be written");
  const int dimensions = grid.planar ? 2 : 3;
  const auto coordinate = [&](int c, const Eigen::Vector3d& x) { return grid.planar && c == 1 ? x.z() : x[c]; };
  const auto nodes_of = [&](const Block& b) { return std::size_t(b.ni + 1) * (b.nj + 1) * (grid.planar ? 1 : b.nk + 1); };
  if (form == Plot3dForm::formatted) {
    std::string text = fmt::format("{}\n", grid.blocks.size());
    for (const Block& b : grid.blocks)
      text += grid.planar ? fmt::format("{} {}\n", b.ni + 1, b.nj + 1) : fmt::format("{} {} {}\n", b.ni + 1, b.nj + 1, b.nk + 1);
    for (const Block& b : grid.blocks) {
      int column = 0;
      for (int c = 0; c < dimensions; ++c)
        for (std::size_t p = 0; p < nodes_of(b); ++p) {
          text += fmt::format("{:.17g}", coordinate(c, b.nodes[p]));
          text += ++column % 3 == 0 ? '\n' : ' ';
        }
      text += '\n';
      out << text;
      text.clear();
    }
  } else {
    const auto put = [&](const auto& value) { out.write(reinterpret_cast<const char*>(&value), sizeof value); };
    put(std::int32_t(4)), put(std::int32_t(grid.blocks.size())), put(std::int32_t(4));
    const std::int32_t size = std::int32_t(4 * dimensions * grid.blocks.size());
    put(size);
    for (const Block& b : grid.blocks)
      for (int d = 0; d < dimensions; ++d) put(std::int32_t(b.cells()[d] + 1));
    put(size);
    for (const Block& b : grid.blocks) {
      const std::uint32_t record = std::uint32_t(8 * dimensions * nodes_of(b));
      put(record);
      for (int c = 0; c < dimensions; ++c)
        for (std::size_t p = 0; p < nodes_of(b); ++p) put(coordinate(c, b.nodes[p]));
      put(record);
    }
  }
  if (!out.flush()) refuse(file, 0, "", "could not be written to the end (disk full?)");
}

}  // namespace spindrift::aero
