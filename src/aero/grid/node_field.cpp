// SPDX-License-Identifier: Apache-2.0
#include "src/aero/grid/node_field.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "src/aero/grid/index_map.hpp"
#include "src/aero/grid/wall_distance.hpp"
#include "src/aero/hypre/multigrid.hpp"

namespace spindrift::aero {

namespace node_field_parts {

struct Edge {
  int a, b;  ///< numbers of its ends, a < b
  double weight;
};

/// Which nodes of all blocks are one: across connections (periodic ones too), and at the ends of edges without length.
class SameNodes {
 public:
  explicit SameNodes(const MultiBlockGrid& grid) : grid_(grid) {
    for (const Block& b : grid.blocks) {
      first_.push_back(int(parent_.size()));
      parent_.resize(parent_.size() + b.nodes.size());
    }
    std::iota(parent_.begin(), parent_.end(), 0);
    for (const Connection& c : grid.connections) join(c);
    for (int b = 0; b < int(grid.blocks.size()); ++b) join_collapsed(b);
    if (grid.planar)
      for (int b = 0; b < int(grid.blocks.size()); ++b) join_layers(b);
    number();
  }
  int operator()(int block, std::size_t node) const { return numbers_[std::size_t(first_[std::size_t(block)]) + node]; }
  int count() const { return count_; }

 private:
  int root(int n) {
    while (parent_[std::size_t(n)] != n) n = parent_[std::size_t(n)] = parent_[std::size_t(parent_[std::size_t(n)])];
    return n;
  }
  void join(int block_a, std::size_t a, int block_b, std::size_t b) {
    const int p = root(first_[std::size_t(block_a)] + int(a)), q = root(first_[std::size_t(block_b)] + int(b));
    parent_[std::size_t(std::max(p, q))] = std::min(p, q);
  }
  void join(const Connection& c) {
    const Block &a = grid_.blocks[std::size_t(c.from.block)], &b = grid_.blocks[std::size_t(c.to.block)];
    IndexMap nodes = cell_map(c, grid_);  // of cells; nodes where a direction runs backwards are one further
    for (int d = 0; d < 3; ++d)
      if (nodes.sign(d) < 0) nodes.offset[std::size_t(nodes.target(d))] += 1;
    for_window(c.from, a, [&](const Index& n) {
      const Index m = nodes(n);
      join(c.from.block, a.node(n[2], n[1], n[0]), c.to.block, b.node(m[2], m[1], m[0]));
    });
  }
  void join_collapsed(int block) {
    const Block& b = grid_.blocks[std::size_t(block)];
    for (int k = 0; k <= b.nk; ++k)
      for (int j = 0; j <= b.nj; ++j)
        for (int i = 0; i <= b.ni; ++i)
          for (int d = 0; d < 3; ++d) {
            const int k2 = k + (d == 2), j2 = j + (d == 1), i2 = i + (d == 0);
            if (k2 > b.nk || j2 > b.nj || i2 > b.ni) continue;
            if (b.nodes[b.node(k, j, i)] == b.nodes[b.node(k2, j2, i2)]) join(block, b.node(k, j, i), block, b.node(k2, j2, i2));
          }
  }
  void join_layers(int block) {
    const Block& b = grid_.blocks[std::size_t(block)];
    for (int j = 0; j <= b.nj; ++j)
      for (int i = 0; i <= b.ni; ++i) join(block, b.node(0, j, i), block, b.node(1, j, i));
  }
  void number() {
    numbers_.assign(parent_.size(), -1);
    for (int n = 0; n < int(parent_.size()); ++n) {
      const int r = root(n);  // the first of its kind
      numbers_[std::size_t(n)] = r == n ? count_++ : numbers_[std::size_t(r)];
    }
  }

 public:
  /// body(node) for the nodes of a window.
  template <class Body>
  static void for_window(const Window& w, const Block& b, Body&& body) {
    const int across = direction_of(w.side);
    const auto [u, v] = along(w.side);
    Index n{};
    n[std::size_t(across)] = at_end(w.side) ? b.cells()[std::size_t(across)] : 0;
    for (n[std::size_t(v)] = w.low[1]; n[std::size_t(v)] <= w.high[1]; ++n[std::size_t(v)])
      for (n[std::size_t(u)] = w.low[0]; n[std::size_t(u)] <= w.high[0]; ++n[std::size_t(u)]) body(n);
  }

 private:
  const MultiBlockGrid& grid_;
  std::vector<int> first_, parent_, numbers_;
  int count_ = 0;
};

}  // namespace node_field_parts
using namespace node_field_parts;

struct NodeField::Work {
  const MultiBlockGrid& grid;
  std::vector<std::string> given;
  NodeFieldOptions options;
  MPI_Comm comm;
  SameNodes same;
  std::vector<int> patch;           ///< by number: of `given`; -1 where free
  std::vector<Eigen::Vector3d> at;  ///< by number: of given nodes
  std::vector<int> unknown;         ///< by number: -1 where given
  std::vector<Edge> edges;          ///< each pair once, by a, then b
  std::vector<double> diagonal;     ///< by unknown
  int free = 0, first = 0, last = 0, cycles = 0;
  std::optional<Multigrid> multigrid;

  Work(const MultiBlockGrid& g, std::vector<std::string> p, std::span<const std::string> stiff, const NodeFieldOptions& o,
       MPI_Comm c)
      : grid(g), given(std::move(p)), options(o), comm(c), same(g) {
    mark_given();
    add_edges(stiff);
    diagonal.assign(std::size_t(free), 0.0);
    for (const Edge& e : edges)
      for (const int end : {e.a, e.b})
        if (const int u = unknown[std::size_t(end)]; u >= 0) diagonal[std::size_t(u)] += e.weight;
    if (std::ranges::any_of(diagonal, [](double d) { return !(d > 0.0) || !std::isfinite(d); }))
      throw std::runtime_error("node field: a node has no edge of finite length");
    if (free > 0) set_up();
  }

  void mark_given() {
    patch.assign(std::size_t(same.count()), -1), at.resize(patch.size());
    bool any = false;
    for (int p = int(given.size()); p-- > 0;)  // the first has the last word
      for (const Boundary& b : grid.boundaries) {
        if (b.patch != given[std::size_t(p)]) continue;
        const Block& block = grid.blocks[std::size_t(b.where.block)];
        SameNodes::for_window(b.where, block, [&](const Index& n) {
          const std::size_t node = block.node(n[2], n[1], n[0]);
          const int number = same(b.where.block, node);
          patch[std::size_t(number)] = p, at[std::size_t(number)] = block.nodes[node];
          any = true;
        });
      }
    if (!any) throw std::invalid_argument("node field: no patch has given values");
    unknown.assign(patch.size(), -1);
    for (std::size_t n = 0; n < patch.size(); ++n)
      if (patch[n] < 0) unknown[n] = free++;
  }

  void add_edges(std::span<const std::string> stiff) {
    const WallSurface surface = wall_surface(grid, stiff);
    const bool graded = options.stiffness > 0.0 && !surface.empty();
    const int directions = grid.planar ? 2 : 3;
    for (int block = 0; block < int(grid.blocks.size()); ++block) {
      const Block& b = grid.blocks[std::size_t(block)];
      const auto node = [&](int k, int j, int i) -> const Eigen::Vector3d& { return b.nodes[b.node(k, j, i)]; };
      // k V of the cells, shared out to the edges of each direction.
      std::vector<double> share(std::size_t(b.ni) * std::size_t(b.nj) * std::size_t(b.nk));
      std::size_t cell = 0;
      for (int k = 0; k < b.nk; ++k)
        for (int j = 0; j < b.nj; ++j)
          for (int i = 0; i < b.ni; ++i, ++cell) {
            Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
            Eigen::Vector3d centre = Eigen::Vector3d::Zero();
            for (int n = 0; n < 8; ++n) {
              const std::array<int, 3> off{n % 2, n / 2 % 2, n / 4};
              const Eigen::Vector3d& x = node(k + off[2], j + off[1], i + off[0]);
              centre += 0.125 * x;
              for (int d = 0; d < 3; ++d) mean.col(d) += (off[std::size_t(d)] ? 0.25 : -0.25) * x;
            }
            share[cell] = std::abs(mean.determinant()) / (directions == 3 ? 4.0 : 2.0);
            if (graded) share[cell] *= std::pow(surface.distance(centre), -options.stiffness);
          }
      const std::array<int, 3> n{b.ni, b.nj, b.nk};
      const auto share_at = [&](const std::array<int, 3>& c) {
        for (std::size_t d = 0; d < 3; ++d)
          if (c[d] < 0 || c[d] >= n[d]) return 0.0;
        return share[(std::size_t(c[2]) * std::size_t(b.nj) + std::size_t(c[1])) * std::size_t(b.ni) + std::size_t(c[0])];
      };
      for (int d = 0; d < directions; ++d)
        for (int k = 0; k <= (grid.planar ? 0 : b.nk); ++k)
          for (int j = 0; j <= b.nj; ++j)
            for (int i = 0; i <= b.ni; ++i) {
              const std::array<int, 3> from{i, j, k};
              if (from[std::size_t(d)] == n[std::size_t(d)]) continue;
              std::array<int, 3> to = from;
              ++to[std::size_t(d)];
              const int u = d == 0 ? 1 : 0, v = d == 2 ? 1 : 2;
              double sum = 0.0;
              for (const int below_v : {1, 0})
                for (const int below_u : {1, 0}) {
                  if (grid.planar && below_v) continue;
                  std::array<int, 3> c = from;
                  c[std::size_t(u)] -= below_u, c[std::size_t(v)] -= below_v;
                  sum += share_at(c);
                }
              const int a = same(block, b.node(from[2], from[1], from[0])), z = same(block, b.node(to[2], to[1], to[0]));
              if (a == z) continue;
              const double length = (node(to[2], to[1], to[0]) - node(from[2], from[1], from[0])).squaredNorm();
              edges.push_back({std::min(a, z), std::max(a, z), sum / length});
            }
    }
    std::ranges::stable_sort(edges, [](const Edge& x, const Edge& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; });
    std::size_t kept = 0;
    for (const Edge& e : edges) {
      if (kept > 0 && edges[kept - 1].a == e.a && edges[kept - 1].b == e.b)
        edges[kept - 1].weight += e.weight;
      else
        edges[kept++] = e;
    }
    edges.resize(kept);
  }

  /// Rows of this process among those of all.
  void set_up() {
    const int ranks = runtime::ranks_in(comm), rank = runtime::rank_in(comm);
    first = int(long(free) * rank / ranks), last = int(long(free) * (rank + 1) / ranks);
    std::vector<std::vector<std::pair<int, double>>> row(std::size_t(last - first));
    const auto mine = [&](int u) { return u >= first && u < last; };
    for (const Edge& e : edges) {
      const int a = unknown[std::size_t(e.a)], b = unknown[std::size_t(e.b)];
      if (a < 0 || b < 0) continue;
      if (mine(a)) row[std::size_t(a - first)].emplace_back(b, -e.weight);
      if (mine(b)) row[std::size_t(b - first)].emplace_back(a, -e.weight);
    }
    SparseRows rows;
    rows.first = first;
    for (int u = first; u < last; ++u) {
      rows.columns.push_back(u), rows.values.push_back(diagonal[std::size_t(u)]);
      for (const auto& [column, value] : row[std::size_t(u - first)])
        rows.columns.push_back(column), rows.values.push_back(value);
      rows.begin.push_back(int(rows.columns.size()));
    }
    multigrid.emplace(rows, MultigridOptions{}, comm);
  }

  /// What this process found, made known to all.
  void spread(std::span<const double> mine, std::vector<double>& all) const {
    if (runtime::ranks_in(comm) == 1) {
      std::ranges::copy(mine, all.begin());
      return;
    }
    runtime::Packer parcel;
    parcel.put(mine);
    auto to = all.begin();
    for (const runtime::Bytes& bytes : runtime::exchange_all(comm, parcel.take()))
      to = std::ranges::copy(runtime::Unpacker(bytes).many<double>(), to).out;
  }

  /// By number.
  std::vector<double> solve(const std::function<double(int, const Eigen::Vector3d&)>& value) {
    std::vector<double> f(patch.size(), 0.0), residual(static_cast<std::size_t>(free)), change(static_cast<std::size_t>(free)),
        step(std::size_t(last - first));
    double low = 0.0, high = 0.0, sum = 0.0;
    long count = 0;
    for (std::size_t n = 0; n < f.size(); ++n) {
      if (patch[n] < 0) continue;
      f[n] = value(patch[n], at[n]);
      if (!std::isfinite(f[n])) throw std::invalid_argument("node field: a given value is not finite");
      low = count == 0 ? f[n] : std::min(low, f[n]), high = count == 0 ? f[n] : std::max(high, f[n]);
      sum += f[n], ++count;
    }
    for (std::size_t n = 0; n < f.size(); ++n)
      if (patch[n] < 0) f[n] = std::clamp(sum / double(count), low, high);  // where nothing differs, this is it
    const double wanted = options.tolerance * std::max(high - low, 1e-3 * std::max(std::abs(low), std::abs(high)));
    for (cycles = 0;; ++cycles) {
      std::ranges::fill(residual, 0.0);
      for (const Edge& e : edges) {
        const double flow = e.weight * (f[std::size_t(e.b)] - f[std::size_t(e.a)]);
        if (const int u = unknown[std::size_t(e.a)]; u >= 0) residual[std::size_t(u)] += flow;
        if (const int u = unknown[std::size_t(e.b)]; u >= 0) residual[std::size_t(u)] -= flow;
      }
      double largest = 0.0;
      for (std::size_t u = 0; u < residual.size(); ++u) largest = std::max(largest, std::abs(residual[u]) / diagonal[u]);
      if (largest <= wanted) return f;
      if (cycles == options.most)
        throw std::runtime_error("node field: after " + std::to_string(cycles) +
                                 " cycles of multigrid a node would still move by " + std::to_string(largest / (high - low)) +
                                 " of the range given");
      multigrid->cycle(std::span<const double>(residual).subspan(std::size_t(first), step.size()), step);
      spread(step, change);
      for (std::size_t n = 0; n < f.size(); ++n)
        if (unknown[n] >= 0) f[n] += change[std::size_t(unknown[n])];
    }
  }
};

NodeField::NodeField(const MultiBlockGrid& grid, std::vector<std::string> given, std::span<const std::string> stiff,
                     const NodeFieldOptions& options, MPI_Comm comm)
    : work_(std::make_unique<Work>(grid, std::move(given), stiff, options, comm)) {}
NodeField::~NodeField() = default;

NodeField::Values NodeField::solve(const std::function<double(int, const Eigen::Vector3d&)>& value) {
  const std::vector<double> f = work_->solve(value);
  Values values;
  for (int b = 0; b < int(work_->grid.blocks.size()); ++b) {
    std::vector<double>& of_block = values.emplace_back(work_->grid.blocks[std::size_t(b)].nodes.size());
    for (std::size_t n = 0; n < of_block.size(); ++n) of_block[n] = f[std::size_t(work_->same(b, n))];
  }
  return values;
}
int NodeField::unknowns() const { return work_->free; }
int NodeField::cycles() const { return work_->cycles; }

}  // namespace spindrift::aero
