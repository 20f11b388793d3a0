// SPDX-License-Identifier: Apache-2.0
#include "src/aero/grid/neutral_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "kernels/grid/metrics.hpp"
#include "src/aero/grid/connect.hpp"
#include "src/aero/grid/index_map.hpp"
#include "src/aero/grid/split.hpp"
#include "src/scene/error.hpp"

namespace spindrift::aero {

namespace {

struct Line {
  int number;
  std::vector<std::string> words;
};

class MapReader {
 public:
  MapReader(MultiBlockGrid& grid, const std::filesystem::path& file) : grid_(grid), file_(file) {}

  void run() {
    std::ifstream in(file_);
    if (!in) refuse(0, "", "cannot be opened");
    std::vector<Line> lines;
    std::string text;
    for (int number = 1; std::getline(in, text); ++number)
      if (Line line{number, words(text)}; !line.words.empty()) lines.push_back(std::move(line));
    if (lines.empty()) refuse(0, "", "has no lines but comments");
    const int blocks = integer(lines[0], 0, "the number of blocks");
    if (blocks != int(grid_.blocks.size()))
      refuse(lines[0].number, lines[0].words[0], fmt::format("blocks, but the grid has {}", grid_.blocks.size()));
    if (int(lines.size()) < 1 + blocks)
      refuse(lines.back().number, "", fmt::format("ends before the dimensions of {} blocks", blocks));
    order_.resize(blocks);
    nodes_.resize(blocks);
    for (int b = 0; b < blocks; ++b) dimensions(lines[1 + b]);
    for (std::size_t l = 1 + blocks; l < lines.size(); ++l) window_line(lines[l]);
    make_right_handed(grid_);
  }

 private:
  [[noreturn]] void refuse(int line, const std::string& value, const std::string& message) const {
    throw scene::SceneError({{file_.string(), line, "", value, message}});
  }

  /// Words of a line; quotes hold a word together, # starts a comment, a backslash (line continuation) is left out.
  static std::vector<std::string> words(const std::string& text) {
    std::vector<std::string> found;
    std::string word;
    char quote = 0;
    const auto finish = [&] {
      if (!word.empty()) found.push_back(word);
      word.clear();
    };
    for (const char c : text) {
      if (quote != 0) {
        if (c == quote)
          quote = 0, finish();
        else
          word += c;
      } else if (c == '\'' || c == '"') {
        finish();
        quote = c;
      } else if (c == '#' || c == '!') {
        break;
      } else if (c == ' ' || c == '\t' || c == '\r' || c == ',' || c == '\\') {
        finish();
      } else {
        word += c;
      }
    }
    finish();
    return found;
  }

  int integer(const Line& line, std::size_t at, const std::string& what) const {
    if (at >= line.words.size()) refuse(line.number, "", fmt::format("ends before {}", what));
    const std::string& word = line.words[at];
    int value = 0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || stop != word.data() + word.size())
      refuse(line.number, word, fmt::format("is not a whole number ({})", what));
    return value;
  }

  /// Which of our directions each direction of the file is. They differ for planar grids only.
  void dimensions(const Line& line) {
    const int b = integer(line, 0, "a block's number") - 1;
    if (b < 0 || b >= int(grid_.blocks.size()))
      refuse(line.number, line.words[0], fmt::format("is no block of 1 to {}", grid_.blocks.size()));
    Index n;
    for (int d = 0; d < 3; ++d) n[d] = integer(line, 1 + d, "a block's three dimensions");
    const Index cells = grid_.blocks[b].cells();
    const Index orders[] = {{0, 1, 2}, {2, 0, 1}, {0, 2, 1}};
    for (const Index& order : orders) {
      if (&order != orders && !grid_.planar) break;
      bool fits = true;
      for (int d = 0; d < 3; ++d) fits = fits && (n[d] == cells[order[d]] + 1 || (grid_.planar && order[d] == 2 && n[d] == 1));
      if (!fits) continue;
      order_[b] = order;
      nodes_[b] = n;
      return;
    }
    refuse(line.number, fmt::format("{} {} {}", n[0], n[1], n[2]),
           fmt::format("nodes, but block {} of the grid has {} x {} x {}", b + 1, cells[0] + 1, cells[1] + 1, cells[2] + 1));
  }

  /// One side's window: block, face (1 k_min, 2 k_max, 3 i_min, 4 i_max, 5 j_min, 6 j_max), node ranges of the two directions
  /// that follow the face's own in the order i, j, k, i, j. `reversed` where a range runs down. Nothing for the sides of k of
  /// planar grids.
  struct FileWindow {
    Window window;
    std::array<int, 2> directions{};  // ours, in the file's order
    std::array<bool, 2> reversed{};
    bool ignored = false;
  };
  FileWindow window(const Line& line, std::size_t at) const {
    FileWindow w;
    const int b = integer(line, at, "a block") - 1;
    if (b < 0 || b >= int(grid_.blocks.size()))
      refuse(line.number, line.words[at], fmt::format("is no block of 1 to {}", grid_.blocks.size()));
    const int face = integer(line, at + 1, "a face");
    if (face < 1 || face > 6)
      refuse(line.number, line.words[at + 1], "is no face (1 k_min, 2 k_max, 3 i_min, 4 i_max, 5 j_min, 6 j_max)");
    const int own = face <= 2 ? 2 : face <= 4 ? 0 : 1;
    const int across = order_[b][own];
    w.window.block = b;
    w.window.side = Side(2 * across + (face % 2 == 0));
    w.ignored = grid_.planar && across == 2;
    for (int s = 0; s < 2; ++s) {
      const int theirs = (own + 1 + s) % 3;
      const int d = order_[b][theirs];
      int first = integer(line, at + 2 + 2 * s, "a range of nodes"), last = integer(line, at + 3 + 2 * s, "a range of nodes");
      if (first < 1 || last < 1 || first > nodes_[b][theirs] || last > nodes_[b][theirs])
        refuse(line.number, fmt::format("{} {}", first, last),
               fmt::format("is beyond nodes 1 to {} of {}", nodes_[b][theirs], "ijk"[theirs]));
      w.directions[s] = d;
      w.reversed[s] = first > last;
      if (first > last) std::swap(first, last);
      if (grid_.planar && d == 2) first = 1, last = 2, w.reversed[s] = false;  // written as one plane or as two, either way round
      if (first == last) refuse(line.number, fmt::format("{} {}", first, last), "covers no face");
      const int slot = along(w.window.side)[0] == d ? 0 : 1;
      w.window.low[slot] = first - 1;
      w.window.high[slot] = last - 1;
    }
    return w;
  }

  void window_line(const Line& line) {
    std::string type = line.words[0];
    std::string lower = type;
    std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return c == '_' ? '-' : char(std::tolower(c)); });
    const FileWindow a = window(line, 1);
    if (lower != "one-to-one") {
      if (!a.ignored) grid_.boundaries.push_back({a.window, type});
      return;
    }
    const FileWindow b = window(line, 7);
    if (a.ignored && b.ignored) return;
    const std::string swap = line.words.size() > 13 ? line.words[13] : "false";
    const bool swapped = swap == "true" || swap == "TRUE" || swap == "T" || swap == ".true." || swap == "True";
    if (!swapped && swap != "false" && swap != "FALSE" && swap != "F" && swap != ".false." && swap != "False")
      refuse(line.number, swap, "must be true or false (whether the directions of the two windows are exchanged)");
    Connection c{a.window, b.window, {}, {}};
    for (int s = 0; s < 2; ++s) {
      const int t = swapped ? 1 - s : s;
      c.orientation[a.directions[s]] = (a.reversed[s] != b.reversed[t] ? -1 : 1) * (b.directions[t] + 1);
      const auto length = [](const FileWindow& w, int n) {
        const int slot = along(w.window.side)[0] == w.directions[n] ? 0 : 1;
        return w.window.high[slot] - w.window.low[slot];
      };
      if (length(a, s) != length(b, t))
        refuse(line.number, "",
               fmt::format("joins {} cells to {}: the windows must match cell by cell", length(a, s), length(b, t)));
    }
    const int from = direction_of(a.window.side), to = direction_of(b.window.side);
    c.orientation[from] = (at_end(a.window.side) != at_end(b.window.side) ? 1 : -1) * (to + 1);
    const double apart = find_periodic_map(grid_, c);
    if (apart > 0)
      refuse(line.number, "",
             fmt::format("the windows' nodes lie up to {:.3g} m apart under any rigid motion: not one-to-one", apart));
    grid_.connections.push_back(c);
  }

  MultiBlockGrid& grid_;
  const std::filesystem::path& file_;
  std::vector<Index> order_, nodes_;
};

constexpr int file_face[] = {3, 4, 5, 6, 1, 2};  // of our sides

}  // namespace

void read_neutral_map(MultiBlockGrid& grid, const std::filesystem::path& file) { MapReader(grid, file).run(); }

void make_right_handed(MultiBlockGrid& grid) {
  for (int b = 0; b < int(grid.blocks.size()); ++b) {
    const Block& block = grid.blocks[b];
    double volume = 0;
    for (int k = 0; k < block.nk; ++k)
      for (int j = 0; j < block.nj; ++j)
        for (int i = 0; i < block.ni; ++i) {
          Hexahedron h;
          for (int n = 0; n < 8; ++n) h.x[n] = block.nodes[block.node(k + n / 4, j + n / 2 % 2, i + n % 2)];
          volume += hexahedron_volume(h) > 0 ? 1 : -1;
        }
    if (volume < 0) reorient(grid, b, {2, 1, 3});
  }
}

void write_neutral_map(const MultiBlockGrid& grid, const std::filesystem::path& file) {
  std::ofstream out(file);
  if (!out) throw scene::SceneError({{file.string(), 0, "", "", "cannot be written"}});
  std::string text = "# Neutral map file of a Spindrift grid\n# Block  IDIM  JDIM  KDIM\n";
  text += fmt::format("{}\n", grid.blocks.size());
  for (std::size_t b = 0; b < grid.blocks.size(); ++b) {
    const Block& block = grid.blocks[b];
    text += fmt::format("{:6} {:6} {:6} {:6}\n", b + 1, block.ni + 1, block.nj + 1, block.nk + 1);
  }
  text += "# Type  B1 F1  S1 E1  S2 E2   B2 F2  S1 E1  S2 E2  Swap\n";
  /// Ranges in the file's order of directions; `turn` says which run down.
  const auto ranges = [](const Window& w, std::array<bool, 3> turn) {
    const int own = direction_of(w.side);
    std::string result = fmt::format("{:4} {}", w.block + 1, file_face[int(w.side)]);
    for (int s = 1; s <= 2; ++s) {
      const int d = (own + s) % 3, slot = along(w.side)[0] == d ? 0 : 1;
      int first = w.low[slot] + 1, last = w.high[slot] + 1;
      if (turn[d]) std::swap(first, last);
      result += fmt::format(" {:5} {:5}", first, last);
    }
    return result;
  };
  for (const Boundary& b : grid.boundaries) text += fmt::format("'{}' {}\n", b.patch, ranges(b.where, {}));
  for (const Connection& c : grid.connections) {
    const IndexMap map{c.orientation, {}};
    const int from = direction_of(c.from.side), to = direction_of(c.to.side);
    std::array<bool, 3> turn{};
    for (int d = 0; d < 3; ++d)
      if (d != from && map.sign(d) < 0) turn[map.target(d)] = true;
    const bool swapped = map.target((from + 1) % 3) != (to + 1) % 3;
    text += fmt::format("'one-to-one' {} {} {}\n", ranges(c.from, {}), ranges(c.to, turn), swapped ? "true" : "false");
  }
  out << text;
  if (!out.flush()) throw scene::SceneError({{file.string(), 0, "", "", "could not be written to the end (disk full?)"}});
}

}  // namespace spindrift::aero
