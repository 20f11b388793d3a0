// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/sensor_tasks.hpp"

#include <algorithm>
#include <utility>

#include "runtime/mpi/exchange.hpp"

namespace spindrift::sph {

using runtime::Context;
using runtime::Datum;
using runtime::reads;
using runtime::updates;
using runtime::writes;

template <int dim, class Real>
SensorTasks<dim, Real>::SensorTasks(StepRecording<dim, Real>& recording, bool bodies_move, const std::vector<int>& body_groups)
    : recording_(recording) {
  const SeaState<dim, Real>& sea = recording.sea;
  std::size_t sums = 0;
  for (const Patch& patch : sea.patches) {
    sums += sums_of(patch);
    if (body_of(patch, sea.solids) && bodies_move)
      groups_.insert(groups_.end(), body_groups.begin(), body_groups.end());
    else
      for (const int g : groups_near(patch, sea.solids, sea.columns, sea.p.reach() + 2.0 * sea.p.drift()))
        if (sea.subdomain.owns(g)) groups_.push_back(g);
  }
  std::sort(groups_.begin(), groups_.end());
  groups_.erase(std::unique(groups_.begin(), groups_.end()), groups_.end());
  partial_data_ = recording.graph.data(groups_.size());
  records_ = recording.graph.datum();
  total_.resize(sums);
  partial_.resize(sums * groups_.size());
}

template <int dim, class Real>
void SensorTasks<dim, Real>::record() {
  auto& r = recording_;
  if (r.sea.patches.empty()) return;
  SeaState<dim, Real>& sea = r.sea;
  for (std::size_t n = 0; n < groups_.size(); ++n) {
    const auto g = std::size_t(groups_[n]);
    r.graph.task(task_name("sensors", g),
                 {reads(r.order), reads(r.plan), reads(r.loads), reads(r.planes[g]), reads(r.sums[g]), writes(partial_data_[n])},
                 r.if_active([this, &sea, g, n] {
                   std::span<double> mine = std::span(partial_).subspan(n * total_.size());
                   for (const Patch& patch : sea.patches) {
                     read_patch(sea.store, sea.p, sea.columns.domain(), patch, sea.solids, int(g), mine.first(sums_of(patch)));
                     mine = mine.subspan(sums_of(patch));
                   }
                 }));
  }
  const Datum sum = r.graph.datum();
  r.sum("sea/sensors", partial_data_, sum, partial_, total_);
  r.graph.task("sea/sensors/note", {reads(sum), reads(r.plan), updates(records_)},
               r.if_active([this, &sea](const Context&, int step) {
                 std::span<const double> sums = total_;
                 for (std::size_t n = 0; n < sea.patches.size(); ++n) {
                   const std::size_t size = sums_of(sea.patches[n]);
                   sea.records[n].add(sea.plan.dt_of(step), reading_of(sea.patches[n], sums.first(size)));
                   sums = sums.subspan(size);
                 }
               }));
}

template <int dim, class Real>
void read_sensors(SeaState<dim, Real>& sea, MPI_Comm comm) {
  for (std::size_t n = 0; n < sea.patches.size(); ++n) {
    if (!sea.records[n].empty()) continue;
    const Patch& patch = sea.patches[n];
    runtime::Packer mine;
    std::vector<double> part(sums_of(patch)), sums(part.size(), 0.0);
    for (const int g : groups_near(patch, sea.solids, sea.columns, sea.p.reach() + 2.0 * sea.p.drift())) {
      if (!sea.subdomain.owns(g)) continue;
      read_patch(sea.store, sea.p, sea.columns.domain(), patch, sea.solids, g, std::span<double>(part));
      mine.put_one(g), mine.put(std::span<const double>(part));
    }
    std::vector<std::pair<int, std::vector<double>>> parts;
    for (const runtime::Bytes& bytes : runtime::exchange_all(comm, mine.take()))
      for (runtime::Unpacker from(bytes); !from.done();) {
        const int g = from.one<int>();
        parts.emplace_back(g, from.many<double>());
      }
    std::sort(parts.begin(), parts.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [g, values] : parts)
      for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += values[k];
    sea.records[n].add(0.0, reading_of(patch, sums));
  }
}

template void read_sensors(SeaState<SPINDRIFT_SPH_DIM, SPINDRIFT_SPH_REAL>&, MPI_Comm);
template class SensorTasks<SPINDRIFT_SPH_DIM, SPINDRIFT_SPH_REAL>;

}  // namespace spindrift::sph
