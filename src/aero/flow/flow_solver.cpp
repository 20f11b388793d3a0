// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/flow_solver.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "runtime/executor/executor.hpp"

namespace spindrift::aero {

FlowSolver::FlowSolver(GridStore& grid, const FlowSetting& setting, std::vector<PatchCondition> conditions)
    : setting_(setting),
      time_{.order = setting.time_order, .levels = setting.past_levels(), .dt = setting.dt},
      residual_(setting, model_sweeps(setting.turbulence), time_),
      arrays_(grid, setting, conditions, residual_.model()),
      motion_(arrays_, time_),
      system_(setting, arrays_, residual_),
      judgement_(setting, std::move(conditions), arrays_),
      time_error_(setting, arrays_, time_, residual_),
      restart_(arrays_, motion_, time_, judgement_.march, system_, setting.coarse.common_steps) {}

void FlowSolver::gather_bands(LoadBands bands) {
  if (!recorded_.empty()) throw std::logic_error("flow: bands of loads come before the march is recorded");
  judgement_.gather_bands(std::move(bands));
}

void FlowSolver::set_body_force(std::shared_ptr<BodyForce> force) {
  if (!recorded_.empty()) throw std::logic_error("flow: a body force comes before the march is recorded");
  judgement_.set_body_force(std::move(force));
}

void FlowSolver::start_uniform() {
  start([this](const Eigen::Vector3d& x) { return stream_at(setting_.stream, setting_.profile, x.z()); });
}

void FlowSolver::start_from(const FlowSolver& other) {
  const auto require_same = [](bool same) {
    if (!same) throw std::invalid_argument("flow: another solver's state is on other tiles");
  };
  require_same(other.tiles().size() == tiles().size());
  for (std::size_t n = 0; n < tiles().size(); ++n) {
    const FlowTile& from = other.tiles()[n];
    FlowTile& to = tiles()[n];
    require_same(to.index == from.index && to.state.size() == from.state.size());
    std::copy_n(from.state.data(), to.state.size(), to.state.data());
  }
  forget();
}

void FlowSolver::set_time_step(double dt, std::optional<double> before) {
  setting_.dt = time_.dt = dt;
  residual_.set_dt(dt);
  if (before) time_.before.fill(*before);
}

void FlowSolver::record(runtime::Graph& graph) {
  record_march(graph, {arrays_, time_, motion_, residual_, system_, judgement_, time_error_}, recorded_);
}

void FlowSolver::fill_geometry(MPI_Comm comm) {
  runtime::Graph graph(comm);
  record_geometry(graph, arrays_, motion_, recorded_);
  runtime::Executor(std::move(graph), {.threads = 1}).run();
}

void FlowSolver::fill_gradients(MPI_Comm comm) {
  runtime::Graph graph(comm);
  record_gradients(graph, {arrays_, time_, motion_, residual_, system_, judgement_, time_error_}, recorded_);
  runtime::Executor(std::move(graph), {.threads = 1}).run();
}

}  // namespace spindrift::aero
