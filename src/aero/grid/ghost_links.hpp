// Filling ghost cells: copies described by GhostLink, on one rank (copy_ghosts) or through a buffer (pack on the donor's rank,
// unpack on the receiver's). Vectors, tensors and points are carried by the map of a periodic link. Called by the tasks of
// src/aero/flow and by store.cpp; tested in tests/src/aero/grid/ghost_links_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "kernels/grid/layout.hpp"
#include "src/aero/grid/tiling.hpp"

namespace spindrift::aero {

/// The periodic maps of a grid that moved as a whole from where they were found: motion, after the map, after motion's inverse.
/// Needed where the motion does more than turn about the axis of rotational periodicity.
inline std::vector<RigidMap> moved_maps(std::span<const RigidMap> maps, const RigidMap& motion) {
  std::vector<RigidMap> moved;
  for (const RigidMap& m : maps) {
    const Eigen::Matrix3d rotation = motion.rotation * m.rotation * motion.rotation.transpose();
    moved.push_back({rotation, motion.rotation * m.translation + motion.translation - rotation * motion.translation});
  }
  return moved;
}

/// What components mean, one after the other, so that rotational periodicity can turn them.
enum class Quantity : unsigned char {
  scalar,  ///< 1 component
  vector,  ///< 3
  point,   ///< 3: a place, moved as well as turned
  tensor   ///< 9: row by row; the gradient of a vector, t(3r + c) = d v_r / d x_c
};
constexpr int components_of(Quantity quantity) { return quantity == Quantity::scalar ? 1 : quantity == Quantity::tensor ? 9 : 3; }
constexpr int components_of(std::span<const Quantity> quantities) {
  int sum = 0;
  for (const Quantity q : quantities) sum += components_of(q);
  return sum;
}

/// Numbers that one link carries.
inline std::size_t packed_size(const GhostLink& link, int components, int layers) {
  return std::size_t(link.faces()) * components * layers;
}

namespace detail {
/// Calls body(offset in the receiver, offset in the donor, count, donor's stride) for each run of ghost cells, in one fixed
/// order: the receiver's smallest strides innermost. Runs go along the receiver's row where the window lies along i.
template <class Body>
void for_ghosts(const GhostLink& link, const BoxLayout& to, const BoxLayout& from, int layers, Body&& body) {
  const int across = direction_of(link.side);
  const auto [a, b] = along(link.side);
  const int extent = across == 0 ? to.ni : across == 1 ? to.nj : to.nk;
  const auto donor_step = [&](int d) { return link.donor.sign(d) * from.stride(link.donor.target(d)); };
  const bool end = at_end(link.side);
  const std::ptrdiff_t step_a = donor_step(a), to_a = to.stride(a);
  for (int layer = 0; layer < layers; ++layer) {
    for (int v = link.low[1]; v < link.high[1]; ++v) {
      Index ghost{};
      ghost[across] = end ? extent + layer : -1 - layer;
      ghost[a] = link.low[0], ghost[b] = v;
      const Index donor = link.donor(ghost);
      body(to.at(ghost[2], ghost[1], ghost[0]), from.at(donor[2], donor[1], donor[0]), link.high[0] - link.low[0], to_a, step_a);
    }
  }
}
/// Turns the components of one cell, `stride` apart.
template <class T>
void carry(const RigidMap& map, Quantity quantity, T* value, std::ptrdiff_t stride) {
  const auto at = [&](int n) -> T& { return value[n * stride]; };
  if (quantity == Quantity::vector || quantity == Quantity::point) {
    const Eigen::Vector3d x(at(0), at(1), at(2));
    Eigen::Vector3d y = map.rotation * x;
    if (quantity == Quantity::point) y += map.translation;
    for (int n = 0; n < 3; ++n) at(n) = T(y[n]);
  } else if (quantity == Quantity::tensor) {
    Eigen::Matrix3d t;
    for (int n = 0; n < 9; ++n) t(n / 3, n % 3) = at(n);
    const Eigen::Matrix3d turned = map.rotation * t * map.rotation.transpose();
    for (int n = 0; n < 9; ++n) at(n) = T(turned(n / 3, n % 3));
  }
}
/// Turns the ghost cells of a link in place.
template <class T>
void carry_ghosts(const GhostLink& link, std::span<const RigidMap> maps, std::span<const Quantity> quantities, int layers,
                  BoxView<T> to) {
  if (link.periodic < 0) return;
  int c = 0;
  for (const Quantity q : quantities) {
    if (q != Quantity::scalar) {
      T* first = to.data + c * to.layout.component;
      for_ghosts(link, to.layout, to.layout, layers, [&](auto ghost, auto, int count, auto step, auto) {
        for (int n = 0; n < count; ++n) carry(maps[link.periodic], q, first + ghost + n * step, to.layout.component);
      });
    }
    c += components_of(q);
  }
}
}  // namespace detail

/// Fills the ghost cells of one link where both tiles are on this rank.
template <class T>
void copy_ghosts(const GhostLink& link, std::span<const RigidMap> maps, std::span<const Quantity> quantities, int layers,
                 BoxView<const T> from, BoxView<T> to) {
  for (int c = 0; c < components_of(quantities); ++c) {
    T* out = to.data + c * to.layout.component;
    const T* in = from.data + c * from.layout.component;
    detail::for_ghosts(link, to.layout, from.layout, layers,
                       [&](auto ghost, auto donor, int count, auto to_step, auto from_step) {
                         for (int n = 0; n < count; ++n) out[ghost + n * to_step] = in[donor + n * from_step];
                       });
  }
  detail::carry_ghosts(link, maps, quantities, layers, to);
}

/// Writes what one link carries into `buffer` and returns its end. `to` is the receiver's layout (it fixes the order).
template <class T>
T* pack(const GhostLink& link, int components, int layers, BoxView<const T> from, const BoxLayout& to, T* buffer) {
  for (int c = 0; c < components; ++c) {
    const T* in = from.data + c * from.layout.component;
    detail::for_ghosts(link, to, from.layout, layers, [&](auto, auto donor, int count, auto, auto from_step) {
      for (int n = 0; n < count; ++n) *buffer++ = in[donor + n * from_step];
    });
  }
  return buffer;
}

/// Reads what `pack` wrote into the ghost cells of `to` and returns the end of what it read.
template <class T>
const T* unpack(const GhostLink& link, std::span<const RigidMap> maps, std::span<const Quantity> quantities, int layers,
                const T* buffer, BoxView<T> to) {
  for (int c = 0; c < components_of(quantities); ++c) {
    T* out = to.data + c * to.layout.component;
    detail::for_ghosts(link, to.layout, to.layout, layers, [&](auto ghost, auto, int count, auto to_step, auto) {
      for (int n = 0; n < count; ++n) out[ghost + n * to_step] = *buffer++;
    });
  }
  detail::carry_ghosts(link, maps, quantities, layers, to);
  return buffer;
}

/// A ghost layout needs the donor's cells, not its ghosts: for tile t with the given ghost layers (none in k where planar).
inline BoxLayout cell_layout(const Tile& tile, int ghosts, bool planar) {
  return BoxLayout(tile.ni, tile.nj, tile.nk, {ghosts, ghosts, planar ? 0 : ghosts});
}

}  // namespace spindrift::aero
