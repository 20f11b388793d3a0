// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/halo_tasks.hpp"

#include <algorithm>

namespace spindrift::sph {

using runtime::Context;
using runtime::Datum;
using runtime::reads;
using runtime::updates;
using runtime::Uses;
using runtime::writes;

namespace {

/// Clusters of a group.
struct Part {
  std::uint32_t begin, end;
  std::size_t clusters() const { return end - begin; }
};
Part part_of(const Group& group, HaloOf what) {
  return {what == HaloOf::solids ? group.solid : group.fluid, what == HaloOf::water ? group.solid : group.end};
}

/// Data of a group that hold what is sent. Packing writes those of planes and of walls.
template <int dim, class Real>
std::vector<const GroupData*> data_of(const StepRecording<dim, Real>& r, HaloOf what) {
  switch (what) {
    case HaloOf::water:
      return {&r.planes};
    case HaloOf::solids:
      return {&r.walls};
    case HaloOf::stress:
      return {&r.stress};
    case HaloOf::planes:
      break;
  }
  return {&r.planes, &r.walls};
}

/// What a group that is not own is given.
template <int dim, class Real>
Uses given(const StepRecording<dim, Real>& r, HaloOf what, int group) {
  Uses uses;
  for (const GroupData* data : data_of(r, what)) uses.push_back(writes((*data)[std::size_t(group)]));
  return uses;
}

/// Copies planes of 16 numbers, those that change their sign in a mirror with the other one.
template <class Real>
void copy_mirrored(const Real* from, Real* to, int planes, int odd, int also_odd) {
  for (int plane = 0; plane < planes; ++plane)
    for (int lane = 0; lane < cluster_size; ++lane, ++from, ++to) *to = plane == odd || plane == also_odd ? -*from : *from;
}

/// Position and velocity along the second axis, or the stresses xy and yz, are those that turn round.
template <int dim, class Real>
void mirror(Store<dim, Real>& store, const Group& of, const Group& image, HaloOf what) {
  const Part source = part_of(of, what), target = part_of(image, what);
  for (std::size_t n = 0; n < source.clusters(); ++n) {
    const std::size_t from = source.begin + n, to = target.begin + n;
    if (what == HaloOf::stress) {
      const std::size_t size = std::size_t(store.stress_planes) * cluster_size;
      using Tensor = SymmetricTensor<Real, dim>;
      copy_mirrored<Real>(store.stress.data() + from * size, store.stress.data() + to * size, store.stress_planes,
                          Tensor::place(0, 1), Tensor::place(1, dim - 1));
    } else {
      copy_mirrored<Real>(store.pack_of(from), store.pack_of(to), pack_planes<dim>, 1, dim + 1);
      set_box(store, to);
    }
  }
}

}  // namespace

template <int dim, class Real>
void HaloTasks<dim, Real>::record_images(StepRecording<dim, Real>& recording, const std::string& label, HaloOf what) {
  auto& r = recording;
  for (const int image : r.sea.subdomain.images) {
    const int source = r.sea.columns.source(image);
    Uses uses = given(r, what, image);
    uses.push_back(reads(r.order)), uses.push_back(reads(r.plan));
    for (const GroupData* data : data_of(r, what)) uses.push_back(reads((*data)[std::size_t(source)]));
    r.graph.task(task_name(label + "/image", std::size_t(image)), uses, r.if_active([&store = r.sea.store, image, source, what] {
      mirror(store, store.groups[std::size_t(source)], store.groups[std::size_t(image)], what);
    }));
  }
}

template <int dim, class Real>
void HaloTasks<dim, Real>::record(StepRecording<dim, Real>& recording, const std::string& label, HaloOf what) {
  auto& r = recording;
  const bool stress = what == HaloOf::stress;
  Store<dim, Real>& store = r.sea.store;
  const std::size_t size = std::size_t(stress ? store.stress_planes : pack_planes<dim>) * cluster_size;
  const auto values = [&store, size, stress](std::uint32_t cluster) {
    return (stress ? store.stress.data() : store.pack.data()) + cluster * size;
  };
  const auto sizes = [&store, size, what](const std::vector<int>& groups) {
    std::size_t clusters = 0;
    for (const int g : groups) clusters += part_of(store.groups[std::size_t(g)], what).clusters();
    return clusters * size;
  };
  for (const Subdomain::Border& border : r.sea.subdomain.borders) {
    const auto rank = std::size_t(border.rank);
    Message& message = messages_.emplace_back();
    const Datum out = r.graph.datum(), in = r.graph.datum();
    Uses gather = {reads(r.order), reads(r.plan), writes(out), writes(in)};
    for (const GroupData* data : data_of(r, what))
      for (const int g : border.sent) gather.push_back(reads((*data)[std::size_t(g)]));
    const auto fill = r.if_active([&store, &message, &border, sizes, values, what] {
      message.out.resize(sizes(border.sent)), message.in.resize(sizes(border.received));
      Real* to = message.out.data();
      for (const int g : border.sent) {
        const Part part = part_of(store.groups[std::size_t(g)], what);
        to = std::copy(values(part.begin), values(part.end), to);
      }
    });
    r.graph.task(task_name(label + "/gather", rank), gather, [&message, fill](const Context& context) {
      message.out.clear(), message.in.clear();  // nothing to say in steps that are not made
      fill(context);
    });
    const int tag = next_tag_;
    r.graph.send(task_name(label + "/send", rank), {reads(out)},
                 {border.rank, tag, [&message] { return std::as_writable_bytes(std::span(message.out)); }});
    r.graph.receive(task_name(label + "/receive", rank), {updates(in)},
                    {border.rank, tag, [&message] { return std::as_writable_bytes(std::span(message.in)); }});
    Uses scatter = {reads(r.order), reads(r.plan), reads(in)};
    for (const int g : border.received) {
      const Uses written = given(r, what, g);
      scatter.insert(scatter.end(), written.begin(), written.end());
    }
    r.graph.task(task_name(label + "/scatter", rank), scatter,
                 r.if_active([&store, &message, &border, size, stress, values, what] {
                   const Real* from = message.in.data();
                   for (const int g : border.received) {
                     const Group& group = store.groups[std::size_t(g)];
                     const Part part = part_of(group, what);
                     for (std::uint32_t cluster = part.begin; cluster < part.end; ++cluster, from += size) {
                       std::copy(from, from + size, values(cluster));
                       if (!stress) set_box(store, cluster);
                     }
                   }
                 }));
  }
  ++next_tag_;
  record_images(r, label, what);
}

template class HaloTasks<SPINDRIFT_SPH_DIM, SPINDRIFT_SPH_REAL>;

}  // namespace spindrift::sph
