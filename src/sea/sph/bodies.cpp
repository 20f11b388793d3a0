// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/bodies.hpp"

#include <algorithm>
#include <array>

#include "runtime/mpi/exchange.hpp"

namespace spindrift::sph {

template <int dim, class Real>
void add_body(SeaState<dim, Real>& sea, std::uint16_t owner, const Motion& motion, double mass, MPI_Comm comm) {
  sea.solids.push_back(solid_from(sea.store, owner, motion, comm));
  if (mass <= 0.0) return;
  const Solid& solid = sea.solids.back();
  if (sea.p.own_mass) {
    sea.store.weights.resize(std::size_t(sea.store.owners), 1.0);
    sea.store.weights[owner] = relative_weight(solid, mass, sea.p, dim);
  }
  sea.free.push_back(box_of<dim>(solid, motion));
  sea.body_limit = std::min(sea.body_limit, body_step_limit(solid, mass, sea.p, dim));
}

template <int dim, class Real>
void place_body(SeaState<dim, Real>& sea, std::uint16_t owner, const Motion& motion) {
  for (Solid& solid : sea.solids) {
    if (solid.owner != owner) continue;
    sea.set_motion(solid, motion);
    for (const int g : sea.subdomain.own) place(sea.store, sea.columns.domain(), solid, g);
  }
}

template <int dim, class Real>
Wrench load_on(const SeaState<dim, Real>& sea, std::uint16_t owner, const Eigen::Vector3d& about, MPI_Comm comm) {
  struct Part {
    int group;
    std::array<double, 6> load;
  };
  runtime::Packer mine;
  for (const int g : sea.subdomain.own) {
    const Wrench w = load(sea.store, owner, sea.p.mass(dim), about, g);
    if (w.force != Eigen::Vector3d::Zero() || w.moment != Eigen::Vector3d::Zero())
      mine.put_one(Part{g, {w.force[0], w.force[1], w.force[2], w.moment[0], w.moment[1], w.moment[2]}});
  }
  std::vector<Part> parts;
  for (const runtime::Bytes& bytes : runtime::exchange_all(comm, mine.take()))
    for (runtime::Unpacker from(bytes); !from.done();) parts.push_back(from.one<Part>());
  std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.group < b.group; });
  Wrench total{.point = about};
  for (const Part& part : parts)
    for (int k = 0; k < 3; ++k) total.force[k] += part.load[std::size_t(k)], total.moment[k] += part.load[std::size_t(3 + k)];
  return total;
}

template <int dim, class Real>
std::vector<Touch> all_contacts(const SeaState<dim, Real>& sea, MPI_Comm comm) {
  std::vector<Touch> contacts;
  if (!sea.has_contacts()) return contacts;
  struct Part {
    int group;
    std::uint16_t on, of;
    std::array<double, 6> load;
  };
  runtime::Packer mine;
  for (const int g : sea.subdomain.own)
    for (const Touch& touch : sea.touches[std::size_t(g)]) {
      const Eigen::Vector3d &f = touch.wrench.force, &m = touch.wrench.moment;
      mine.put_one(Part{g, touch.on, touch.of, {f[0], f[1], f[2], m[0], m[1], m[2]}});
    }
  std::vector<Part> parts;
  for (const runtime::Bytes& bytes : runtime::exchange_all(comm, mine.take()))
    for (runtime::Unpacker from(bytes); !from.done();) parts.push_back(from.one<Part>());
  std::stable_sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.group < b.group; });
  for (const Part& part : parts) {
    auto known =
        std::find_if(contacts.begin(), contacts.end(), [&](const Touch& t) { return t.on == part.on && t.of == part.of; });
    if (known == contacts.end()) known = contacts.insert(known, Touch{part.on, part.of, {}});
    for (int k = 0; k < 3; ++k)
      known->wrench.force[k] += part.load[std::size_t(k)], known->wrench.moment[k] += part.load[std::size_t(3 + k)];
  }
  return contacts;
}

// One dimension and one precision at a time: SPINDRIFT_SPH_DIM and _REAL come from CMakeLists.txt, which compiles this file for
// each.
template void add_body(SeaState<SPINDRIFT_SPH_DIM, SPINDRIFT_SPH_REAL>&, std::uint16_t, const Motion&, double, MPI_Comm);
template void place_body(SeaState<SPINDRIFT_SPH_DIM, SPINDRIFT_SPH_REAL>&, std::uint16_t, const Motion&);
template Wrench load_on(const SeaState<SPINDRIFT_SPH_DIM, SPINDRIFT_SPH_REAL>&, std::uint16_t, const Eigen::Vector3d&, MPI_Comm);
template std::vector<Touch> all_contacts(const SeaState<SPINDRIFT_SPH_DIM, SPINDRIFT_SPH_REAL>&, MPI_Comm);

}  // namespace spindrift::sph
