// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/window_sides.hpp"

#include <limits>

#include "kernels/base/failure.hpp"
#include "runtime/mpi/stop_request.hpp"
#include "src/coupling/retries.hpp"

namespace spindrift::coupling {

namespace {

/// Whether tiles of the air are weighed before this window: soon, then now and then. Whatever the clock, ranks and restarts.
constexpr bool weighs_tiles(std::int64_t window) {
  constexpr std::int64_t every = 16;
  return window % every == 0 ? window > 0 : window == 2 || window == 4 || window == 8;
}

}  // namespace

Vector not_finite(Eigen::Index rows) { return Vector::Constant(rows, std::numeric_limits<double>::quiet_NaN()); }

WindowSides::WindowSides(FloatingSystem& floating, Sides sides, MPI_Comm comm, std::size_t records)
    : interface(floating.has_interface() ? std::optional<RotorInterface>(floating) : std::nullopt),
      air_(sides.air   ? std::move(sides.air)
           : interface ? make_engineering_air(floating)
                       : make_no_air()),
      bodies_(sides.bodies ? std::move(sides.bodies) : make_body_side(floating)),
      tasks_(*air_, *bodies_, output_, comm, {.records = records, .watchdog_s = floating.scenario().runtime.watchdog_s}) {}

bool WindowSides::take_motion(bodies::BodiesState& state) {
  bodies_failure_ = {};
  try {
    state = bodies_->finish();
    return true;
  } catch (const NumericalFailure& failure) { bodies_failure_.what = failure.what(); } catch (const runtime::StopAsked&) {
    bodies_failure_.stopped = true;
  }
  return false;
}

Vector WindowSides::take_load() {
  air_failure_ = {};
  ++rotor_calls_;
  try {
    return interface->rows(air_->load_at_end());
  } catch (const LastingFailure& failure) {
    air_failure_.what = failure.what(), air_failure_.lasting = true;
  } catch (const NumericalFailure& failure) { air_failure_.what = failure.what(); } catch (const runtime::StopAsked&) {
    air_failure_.stopped = true;
  }
  return not_finite(RotorInterface::load_rows);
}

bool WindowSides::move(bodies::BodiesState& state, std::int64_t end) {
  bool moved = false;
  tasks_.run(
      Run::bodies,
      {.give = [&] { bodies_->prepare(state, end); }, .take_motion = [&] { moved = take_motion(state); }, .take_load = {}});
  return moved;
}

Vector WindowSides::air_load(double t, double dt, const Vector& motion) {
  Vector load;
  tasks_.run(Run::air, {.give = [&] { air_->prepare(t, dt, interface->state(t, motion)); },
                        .take_motion = {},
                        .take_load = [&] { load = take_load(); }});
  return load;
}

std::pair<bool, Vector> WindowSides::move_beside_air(bodies::BodiesState& state, std::int64_t end, double t, double dt,
                                                     const std::function<Vector()>& motion) {
  std::pair<bool, Vector> result;
  tasks_.run(Run::both, {.give =
                             [&] {
                               bodies_->prepare(state, end);
                               air_->prepare(t, dt, interface->state(t, motion()));
                             },
                         .take_motion = [&] { result.first = take_motion(state); },
                         .take_load = [&] { result.second = take_load(); }});
  return result;
}

void WindowSides::balance(std::int64_t window, std::int64_t windows) {
  bodies_->balance();
  if (!weighs_tiles(window)) return;
  const std::vector<const runtime::Executor*> executors = tasks_.executors();
  const std::optional<aero::TileMove> move = air_->better_ranks({executors, tasks_.windows(), windows - window});
  if (!move) return;
  tasks_.drop();
  air_->move_tiles(*move);
}

void WindowSides::take_snapshot(AirSide::Snapshot slot) { air_->take_snapshot(slot), bodies_->take_snapshot(slot); }

void WindowSides::return_to(AirSide::Snapshot slot, Run sides) {
  air_failure_.what.clear(), air_failure_.lasting = false, bodies_failure_.what.clear();
  if (has_air(sides)) air_->return_to(slot);
  if (has_bodies(sides)) bodies_->return_to(slot);
}

void WindowSides::begin_window(int retry) {
  air_failure_ = bodies_failure_ = {};
  tasks_.begin_window();
  air_->ease(retry), bodies_->ease(retry);
}

}  // namespace spindrift::coupling
