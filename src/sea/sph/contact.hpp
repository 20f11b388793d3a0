// Contact of bodies with walls and with each other as a sweep: forces between solid particles of different owners that come
// closer than a spacing (kernels/sph/contact.hpp). A group finds the pairs inside itself and with its forward neighbours, in the
// order of clusters and lanes, so sums over groups in order are the same bits for any number of threads. Clusters are tested
// only where the box round a body reaches them: a body afloat far from walls costs one test per cluster of wall. Called by
// tasks.cpp; tested in tests/src/sea/sph/contact_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/sph/contact.hpp"
#include "src/sea/sph/parameters.hpp"
#include "src/sea/sph/solids.hpp"

namespace spindrift::sph {

/// What one solid does to another where they touch; moment about the origin of the earth frame.
struct Touch {
  std::uint16_t on = 0, of = 0;  ///< owners, on < of; the opposite acts on `of`
  Wrench wrench;
};

/// The box round a body now, earth frame [m].
template <int dim>
struct BodyBox {
  std::uint16_t owner;
  std::array<double, dim> low, high;
};
template <int dim>
BodyBox<dim> box_of(const Solid& solid, const Motion& motion) {
  BodyBox<dim> box{.owner = solid.owner, .low = {}, .high = {}};
  box.low.fill(1e300), box.high.fill(-1e300);
  for (int corner = 0; corner < 8; ++corner) {
    Eigen::Vector3d local;
    for (int k = 0; k < 3; ++k) local[k] = corner >> k & 1 ? solid.high[k] : solid.low[k];
    const auto x = from_earth<dim>(motion.point(local));
    for (int k = 0; k < dim; ++k) box.low[k] = std::min(box.low[k], x[k]), box.high[k] = std::max(box.high[k], x[k]);
  }
  return box;
}

inline Contact contact_law(const Parameters& p, int dim) {
  return {p.spacing, p.mass(dim), p.eos.c0, p.contact_stiffness, p.contact_damping, p.contact_friction};
}

/// Appends the contacts that a group has to compute. Positions are those of the planes, which all ranks beside have; velocities
/// those of the bodies' motions; whatever is no body rests.
template <int dim, class Real>
void find_contacts(const Store<dim, Real>& store, const Columns<dim>& columns, const std::vector<Solid>& solids,
                   const std::vector<BodyBox<dim>>& bodies, const Contact& law, int group, std::vector<Touch>& touches) {
  const auto is_body = [&](std::uint16_t owner) {
    return std::any_of(bodies.begin(), bodies.end(), [&](const auto& body) { return body.owner == owner; });
  };
  const auto velocity = [&](std::uint16_t owner, const Vec<double, dim>& at) {
    Vec<double, dim> v{};
    for (const Solid& solid : solids) {
      if (solid.owner != owner) continue;
      std::array<double, dim> x;
      for (int k = 0; k < dim; ++k) x[k] = at[k];
      const Motion& m = solid.motion;
      const auto u = from_earth<dim>(m.velocity + m.omega_earth().cross(to_earth<dim>(x) - m.position));
      for (int k = 0; k < dim; ++k) v[k] = u[k];
    }
    return v;
  };
  const auto reached = [&](std::uint32_t cluster) {  // by the box of another body
    for (const BodyBox<dim>& body : bodies) {
      bool near = body.owner != store.owner[cluster];
      for (int k = 0; k < dim && near; ++k)
        near = columns.domain().periodic[k] || (store.corner[k] + store.low[k][cluster] < body.high[k] + 1.01 * law.spacing &&
                                                store.corner[k] + store.high[k][cluster] > body.low[k] - 1.01 * law.spacing);
      if (near) return true;
    }
    return false;
  };
  const auto reached_in = [&](const Group& range) {
    std::vector<std::uint32_t> found;
    for (std::uint32_t cluster = range.solid; cluster < range.end; ++cluster)
      if (reached(cluster)) found.push_back(cluster);
    return found;
  };
  const auto add = [&](std::uint32_t i, std::uint32_t j, const Vec<double, dim>& at, const Vec<double, dim>& f) {
    const bool ordered = store.owner[i] < store.owner[j];
    const std::uint16_t on = ordered ? store.owner[i] : store.owner[j], of = ordered ? store.owner[j] : store.owner[i];
    auto touch = std::find_if(touches.begin(), touches.end(), [&](const Touch& t) { return t.on == on && t.of == of; });
    if (touch == touches.end()) touch = touches.insert(touches.end(), Touch{on, of, {}});
    std::array<double, dim> force, place;
    for (int k = 0; k < dim; ++k) force[k] = ordered ? f[k] : -f[k], place[k] = at[k];
    touch->wrench.add_force(to_earth<dim>(force), to_earth<dim>(place));
  };
  double share = 1.0;  // of two that meet across a plane of symmetry each meets the other's image: half a contact each
  const auto meet = [&](std::uint32_t i, std::uint32_t j, const std::array<double, dim>& shift) {
    for (int k = 0; k < dim; ++k) {
      const float gap = float(1.01 * law.spacing);
      if (store.low[k][i] - float(shift[k]) > store.high[k][j] + gap) return;
      if (store.high[k][i] - float(shift[k]) < store.low[k][j] - gap) return;
    }
    for (int a = 0; a < cluster_size && store.id[i * cluster_size + a] != no_particle; ++a)
      for (int b = 0; b < cluster_size && store.id[j * cluster_size + b] != no_particle; ++b) {
        Vec<double, dim> x, v, at;
        for (int k = 0; k < dim; ++k) {
          const double offset_i = store.pack_of(i)[k * cluster_size + a], offset_j = store.pack_of(j)[k * cluster_size + b];
          x[k] = (store.anchor[k][i] - store.anchor[k][j] - shift[k]) + (offset_i - offset_j);
          at[k] = store.anchor[k][i] + offset_i - 0.5 * x[k];
        }
        if (dot(x, x) >= law.spacing * law.spacing) continue;
        Vec<double, dim> beside = at;  // where the other one sees it
        for (int k = 0; k < dim; ++k) beside[k] -= shift[k];
        v = velocity(store.owner[i], at) - velocity(store.owner[j], beside);
        const Vec<double, dim> force = share * law.force(x, v);
        if (dot(force, force) > 0.0) add(i, j, at, force);
      }
  };

  const Group& own = store.groups[group];
  if (own.solid == own.end) return;
  const std::vector<std::uint32_t> mine = reached_in(own);
  // A pair matters where one of the two is reached by the box of the other, a body.
  const auto meet_all = [&](const Group& other, const std::vector<std::uint32_t>& theirs, const std::array<double, dim>& shift,
                            bool same) {
    for (std::uint32_t i : mine)
      for (std::uint32_t j = other.solid; j < other.end; ++j)
        if (store.owner[i] != store.owner[j] && is_body(store.owner[j]) && !(same && is_body(store.owner[i]) && j < i))
          meet(i, j, shift);
    for (std::uint32_t j : theirs)  // reached walls and bodies of the other group against this group's bodies, unless met above
      for (std::uint32_t i = own.solid; i < own.end; ++i)
        if (store.owner[i] != store.owner[j] && is_body(store.owner[i]) && !is_body(store.owner[j])) meet(i, j, shift);
  };
  meet_all(own, {}, {}, true);
  columns.for_forward(group, [&](const Neighbour<dim>& near) {
    const Group& other = store.groups[near.group];
    if (other.solid == other.end) return;
    share = columns.is_image(near.group) ? 0.5 : 1.0;
    meet_all(other, reached_in(other), near.shift, false);
  });
}

}  // namespace spindrift::sph
