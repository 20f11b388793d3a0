// Records the march of the air as tasks (tasks.cpp). Called by FlowSolver. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <memory>
#include <vector>

#include "runtime/graph/graph.hpp"
#include "src/aero/flow/flow_residual.hpp"
#include "src/aero/flow/implicit_system.hpp"
#include "src/aero/flow/judgement.hpp"
#include "src/aero/flow/physical_time.hpp"
#include "src/aero/flow/tile_arrays.hpp"
#include "src/aero/flow/tile_motion.hpp"
#include "src/aero/flow/time_error.hpp"

namespace spindrift::aero {

/// What the tasks of a march work on.
struct MarchParts {
  TileArrays& arrays;
  PhysicalTime& time;
  TileMotion& motion;
  FlowResidual& residual;
  ImplicitSystem& system;
  Judgement& judgement;
  TimeError& time_error;
};

/// What the tasks of recorded graphs refer to; to live as long as their executors.
struct RecordedGraphs {
  std::vector<std::shared_ptr<void>> pieces;
  std::deque<std::vector<double>> double_buffers;
  std::deque<std::vector<float>> float_buffers;
  bool empty() const { return pieces.empty(); }
};

/// One march: a steady solution, or one physical step.
void record_march(runtime::Graph& graph, const MarchParts& parts, RecordedGraphs& recorded);
/// The tile that a recorded task works on, by its label; -1 where it is no tile's.
int tile_of(const runtime::Node& task);
/// What fills ghost volumes and centres from other ranks.
void record_geometry(runtime::Graph& graph, TileArrays& arrays, const TileMotion& motion, RecordedGraphs& recorded);
/// The same, and what fills ghosts and gradients of the state as it is.
void record_gradients(runtime::Graph& graph, const MarchParts& parts, RecordedGraphs& recorded);

}  // namespace spindrift::aero
