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

template <int dim, class Real>
void HaloTasks<dim, Real>::record(StepRecording<dim, Real>& recording, const std::string& label, HaloOf what) {
  auto& r = recording;
  const bool stress = what == HaloOf::stress;
  Store<dim, Real>& store = r.sea.store;
  const std::size_t size = std::size_t(stress ? store.stress_planes : pack_planes<dim>) * cluster_size;
  const auto values = [&store, size, stress](std::uint32_t cluster) {
    return (stress ? store.stress.data() : store.pack.data()) + cluster * size;
  };
  const auto sizes = [&store, size](const std::vector<int>& groups) {
    std::size_t clusters = 0;
    for (const int g : groups) clusters += store.groups[std::size_t(g)].end - store.groups[std::size_t(g)].fluid;
    return clusters * size;
  };
  for (const Subdomain::Border& border : r.sea.subdomain.borders) {
    const auto rank = std::size_t(border.rank);
    Message& message = messages_.emplace_back();
    const Datum out = r.graph.datum(), in = r.graph.datum();
    Uses gather = of_groups(border.sent, reads, stress ? r.stress : r.planes);
    for (const int g : border.sent) gather.push_back(reads(r.walls[std::size_t(g)]));
    gather.push_back(reads(r.order)), gather.push_back(reads(r.plan)), gather.push_back(writes(out)),
        gather.push_back(writes(in));
    const auto fill = r.if_active([&store, &message, &border, sizes, values] {
      message.out.resize(sizes(border.sent)), message.in.resize(sizes(border.received));
      Real* to = message.out.data();
      for (const int g : border.sent) {
        const Group& group = store.groups[std::size_t(g)];
        to = std::copy(values(group.fluid), values(group.end), to);
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
    for (const int g : border.received)
      for (const GroupData* data : {&r.planes, &r.walls, &r.sums, &r.stress, &r.extra[0], &r.extra[1], &r.extra[2]})
        scatter.push_back(writes((*data)[std::size_t(g)]));
    r.graph.task(task_name(label + "/scatter", rank), scatter, r.if_active([&store, &message, &border, size, stress, values] {
      const Real* from = message.in.data();
      for (const int g : border.received) {
        const Group& group = store.groups[std::size_t(g)];
        for (std::size_t cluster = group.fluid; cluster < group.end; ++cluster, from += size) {
          std::copy(from, from + size, values(std::uint32_t(cluster)));
          if (stress) continue;
          set_box(store, cluster);
          std::fill_n(store.sums_of(cluster), sum_planes<dim> * cluster_size, Real(0));
        }
        if (stress) continue;
        // Sums of the halo are of no use to anybody; they must only stay finite.
        for (std::size_t n = 0; n < store.extra_sums.size(); ++n) {
          const std::size_t extra = std::size_t(store.extra_planes[n]) * cluster_size;
          std::fill_n(store.extra_sums[n].data() + group.fluid * extra, (group.end - group.fluid) * extra, Real(0));
        }
      }
    }));
  }
  ++next_tag_;
}

template class HaloTasks<SPINDRIFT_SPH_DIM, SPINDRIFT_SPH_REAL>;

}  // namespace spindrift::sph
