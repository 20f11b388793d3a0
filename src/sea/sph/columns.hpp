// The groups of a scene: vertical columns on a regular horizontal grid, at least one support wide, so that a particle meets only
// its own column and the eight (in 2-D: two) round it. Depends on the scene alone, never on ranks, threads or the state.
// Called by ordering.cpp and sweep_pairs.hpp; tested in tests/src/sea/sph/ordering_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace spindrift::sph {

/// The box that particles may be in, earth frame [m]; horizontal axes may be periodic, the vertical (last) one is not.
template <int dim>
struct Domain {
  std::array<double, dim> low, high;
  std::array<bool, dim> periodic{}, open{};  ///< open: without a wall there
  bool mirrored = false;                     ///< in 3-D: the side low[1] is a plane of symmetry
  /// Where the walls' first rows of particles end, where there are walls, and the height of their upper edge. Water beyond is in
  /// a wall, where it would fall between the rows and come out anywhere: over the edge it has left, below it is lost.
  std::array<double, dim> wall_low = everywhere(-1.0), wall_high = everywhere(1.0);
  double edge = std::numeric_limits<double>::infinity();
  double beside_open = 0.0;  ///< what is lost so near to an open side has fallen past the end of the bed there, and has left [m]
  bool contains(const std::array<double, dim>& x) const {
    for (int k = 0; k < dim; ++k)
      if (!(x[k] >= low[k] && x[k] < high[k]) && !periodic[k]) return false;  // also catches NaN
    return true;
  }
  static std::array<double, dim> everywhere(double sign) {
    std::array<double, dim> x;
    x.fill(sign * std::numeric_limits<double>::infinity());
    return x;
  }
  bool in_wall(const std::array<double, dim>& x) const {
    for (int k = 0; k < dim; ++k)
      if (x[k] < wall_low[k] || x[k] > wall_high[k]) return true;
    return false;
  }
  /// The mirror image in the plane of symmetry.
  double image(double y) const { return 2.0 * low[1] - y; }
  /// How a particle that is no more in the tank left it.
  enum class Exit { lost, over_edge, open_side };
  Exit exit_of(const std::array<double, dim>& x) const {
    for (int k = 0; k < dim - 1; ++k)
      if (open[k] && (x[k] < low[k] + beside_open || x[k] >= high[k] - beside_open)) return Exit::open_side;
    const bool over_top = x[dim - 1] >= high[dim - 1] && std::isfinite(edge) && std::isfinite(x[dim - 1]);
    return over_top || (in_wall(x) && x[dim - 1] > edge) ? Exit::over_edge : Exit::lost;
  }
};

/// A neighbouring column, and what to add to its positions so that they are beside the first one (periodic sides) [m].
template <int dim>
struct Neighbour {
  int group = -1;
  std::array<double, dim> shift{};
  bool in_next_row = false;  ///< rows of columns stand along the last horizontal axis
};

template <int dim>
class Columns {
 public:
  Columns() = default;
  /// reach: support plus what particles may drift between two sorts; `width`: wanted edge of a column, at least reach [m].
  Columns(const Domain<dim>& domain, double reach, double width) : domain_(domain) {
    for (int k = 0; k < dim - 1; ++k) {
      const double length = domain.high[k] - domain.low[k];
      count_[k] = std::max(1, int(length / std::max(width, reach)));
      edge_[k] = length / count_[k];
      if (domain.periodic[k] && count_[k] < 3)
        throw std::invalid_argument("sph: a periodic side needs at least three supports of width");
    }
  }

  int groups() const { return dim == 2 ? count_[0] : count_[0] * count_[1]; }
  /// With the images of the groups beside the plane of symmetry, which have the numbers from groups() on. Nobody owns these, and
  /// no pair of two of them is anybody's.
  int groups_and_images() const { return groups() + (domain_.mirrored ? count_[0] : 0); }
  bool is_image(int group) const { return group >= groups(); }
  /// Of which group it is the image.
  int source(int image) const { return (image - groups()) * count_[dim - 2]; }
  /// Column of a position inside the domain.
  int group(const std::array<double, dim>& x) const {
    int index = 0;
    for (int k = 0; k < dim - 1; ++k) {
      int cell = int(std::floor((x[k] - domain_.low[k]) / edge_[k]));
      cell = domain_.periodic[k] ? ((cell % count_[k]) + count_[k]) % count_[k] : std::clamp(cell, 0, count_[k] - 1);
      index = index * count_[k] + cell;
    }
    return index;
  }
  const Domain<dim>& domain() const { return domain_; }
  double edge(int axis) const { return edge_[axis]; }

  /// The neighbours whose pairs with `group` are this group's to compute: half of the ring, so that each pair of columns occurs
  /// once; and the images beside it.
  template <class Visit>
  void for_forward(int group, Visit&& visit) const {
    if constexpr (dim == 2) {
      visit_cell({group + 1}, visit, true);
    } else {
      const int a = group / count_[1], b = group % count_[1];
      visit_cell({a, b + 1}, visit);
      for (int step = -1; step <= 1; ++step) visit_cell({a + 1, b + step}, visit, true);
      if (domain_.mirrored && b == 0)
        for (int step = -1; step <= 1; ++step) visit_image(a + step, visit);
    }
  }

  /// All columns that a box [low, high] touches, images too, each with the shift that puts it beside the box.
  template <class Visit>
  void for_overlapping(const std::array<double, dim>& low, const std::array<double, dim>& high, Visit&& visit) const {
    std::array<int, dim - 1> first, last;
    for (int k = 0; k < dim - 1; ++k) {
      first[k] = int(std::floor((low[k] - domain_.low[k]) / edge_[k]));
      last[k] = int(std::floor((high[k] - domain_.low[k]) / edge_[k]));
      if (domain_.periodic[k])
        last[k] = std::min(last[k], first[k] + count_[k] - 1);
      else
        first[k] = std::clamp(first[k], k == 1 && domain_.mirrored ? -1 : 0, count_[k] - 1),
        last[k] = std::clamp(last[k], 0, count_[k] - 1);
    }
    if constexpr (dim == 2) {
      for (int a = first[0]; a <= last[0]; ++a) visit_cell({a}, visit);
    } else {
      for (int a = first[0]; a <= last[0]; ++a)
        for (int b = first[1]; b <= last[1]; ++b) {
          if (b < 0 && domain_.mirrored)
            visit_image(a, visit);
          else
            visit_cell({a, b}, visit);
        }
    }
  }

  /// Each group adds to sums of itself and of its forward neighbours; to those of the next row apart from what that row adds
  /// itself (Store::carried), so rows do not disturb each other. Groups of one colour add to different sums and may run at once.
  /// The colours of a row run in order, hence every sum has one order of terms whatever the threads do.
  int colours() const { return dim == 2 ? 1 : axis_colours(1); }
  int colour(int group) const { return dim == 2 ? 0 : axis_colour(1, group % count_[dim - 2]); }

 private:
  /// A group adds to columns up to one on either side of its own in the next row: three cells on, the next may do so.
  static constexpr int period = 3;
  // A periodic ring whose length is no multiple of the period gives its last cells colours of their own.
  int axis_colours(int axis) const { return period + (domain_.periodic[axis] ? count_[axis] % period : 0); }
  int axis_colour(int axis, int cell) const {
    const int rest = domain_.periodic[axis] ? count_[axis] % period : 0;
    return cell >= count_[axis] - rest ? period + cell - (count_[axis] - rest) : cell % period;
  }

  template <class Visit>
  void visit_cell(std::array<int, dim - 1> cell, Visit&& visit, bool in_next_row = false) const {
    Neighbour<dim> neighbour{.in_next_row = in_next_row};
    int index = 0;
    for (int k = 0; k < dim - 1; ++k) {
      if (cell[k] < 0 || cell[k] >= count_[k]) {
        if (!domain_.periodic[k]) return;
        const int turn = cell[k] < 0 ? -1 : 1;
        cell[k] -= turn * count_[k];
        neighbour.shift[k] = turn * (domain_.high[k] - domain_.low[k]);
      }
      index = index * count_[k] + cell[k];
    }
    neighbour.group = index;
    visit(neighbour);
  }

  /// The image beside the plane of symmetry in this row of columns.
  template <class Visit>
  void visit_image(int row, Visit&& visit) const {
    Neighbour<dim> neighbour;
    if (row < 0 || row >= count_[0]) {
      if (!domain_.periodic[0]) return;
      const int turn = row < 0 ? -1 : 1;
      row -= turn * count_[0];
      neighbour.shift[0] = turn * (domain_.high[0] - domain_.low[0]);
    }
    neighbour.group = groups() + row;
    visit(neighbour);
  }

  Domain<dim> domain_;
  std::array<int, dim> count_{};
  std::array<double, dim> edge_{};
};

}  // namespace spindrift::sph
