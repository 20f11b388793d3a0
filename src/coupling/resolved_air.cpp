// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/resolved_air.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "kernels/base/constants.hpp"
#include "kernels/base/failure.hpp"
#include "runtime/trace/ledger.hpp"
#include "src/aero/resolved_rotor.hpp"
#include "src/coupling/air_march.hpp"
#include "src/coupling/flow_scene.hpp"
#include "src/coupling/grid_progress.hpp"

namespace spindrift::coupling {

namespace {

Eigen::Quaterniond hub_attitude(const aero::RotorState& s) {
  Eigen::Matrix3d frame;
  frame << s.axis, s.up.cross(s.axis), s.up;
  return Eigen::Quaterniond(frame);
}

/// The rotor where it is, upright as the scene describes it: an equilibrium leans it, and steady flow wants the wind along the
/// axis.
aero::RotorState upright(const FloatingSystem& floating, aero::RotorState now) {
  std::vector<Motion> described;
  for (const auto& body : floating.scenario().bodies) described.push_back(described_motion(body.options));
  const aero::RotorState as_described = floating.rotor()->state(0.0, described);
  now.axis = as_described.axis, now.up = as_described.up;
  return now;
}

/// The scene's rotor in this state. Azimuth counts from the upright that the grid's frame has by itself.
aero::ResolvedRotorSetup setup_at(const FloatingSystem& floating, const aero::RotorState& now) {
  aero::ResolvedRotorSetup setup = resolved_rotor_setup(floating.scenario());
  setup.rotor.hub_m = now.hub, setup.rotor.axis = now.axis, setup.rotor.speed = now.speed, setup.rotor.azimuth = 0.0;
  const Eigen::Quaterniond own = aero::hub_pose(setup.rotor).hub.attitude;
  const Eigen::Vector3d up = own.conjugate() * now.up;
  setup.rotor.azimuth = now.azimuth + std::atan2(-up.y(), up.z());
  setup.dt = step_of(floating.scenario());
  return setup;
}

/// Where the grid goes with the rotor, all of it or one sector. That stays on the axis it has at the start.
struct GridFrame {
  aero::RotorState start;  ///< upright
  bool whole = true;

  aero::RotorPose pose(const aero::RotorState& s) const {
    aero::RotorPose pose;
    pose.azimuth = s.azimuth, pose.speed = s.speed;
    if (whole) {
      pose.hub.position = s.hub, pose.hub.attitude = hub_attitude(s);
    } else {
      pose.hub.position = start.hub + (s.hub - start.hub).dot(start.axis) * start.axis, pose.hub.attitude = hub_attitude(start);
    }
    return pose;
  }
  /// Of one sector thrust and torque are along the axis as it is now.
  aero::RotorLoad on_bodies(aero::RotorLoad load, const aero::RotorState& now) const {
    if (!whole) load.force = load.thrust * now.axis, load.moment = load.torque * now.axis;
    return load;
  }
};

class ResolvedAir final : public MarchingAir {
 public:
  ResolvedAir(const FloatingSystem& floating, const aero::RotorState& now, const runtime::World& world)
      : MarchingAir(floating, now, world),
        frame_{upright(floating, now), scenario().aero.grid->sectors == "all"},
        setup_(setup_at(floating, frame_.start)),
        size_(aero::resolved_rotor_size(setup_)) {
    loads_.computed.blades.resize(std::size_t(size_.sectors));
  }

  aero::RotorLoad begin(double t, const aero::RotorState& now) override {
    const runtime::Span span("aero/start");
    prepare(t, 0.0, now);
    if (rotor_) {  // restored, for windows of another length or by another scheme: the grid stands where the last prediction had
                   // put it
      place_at(state_, restored_dt_);
      return loads_.on_bodies;
    }
    const StartOptions& start = scenario().start;
    const bool settles = start.air_steps > 0;
    if (automatic()) {  // in the wind as it comes, before anything settles: so a scene that names the outcome runs alike
      const std::shared_ptr<const aero::MadeRotorGrid> made = grid();
      make_timed();
      choose();
      if (settles) solver_ = nullptr, rotor_.reset(), grid_ = made;
    }
    const aero::TileStates steady = settles ? settled([this](int retry) { return settled_air(retry); }) : aero::TileStates();
    if (!rotor_) make_timed();
    tell_size();
    solver_->restart().load_tiles(steady);  // the past stays empty: the first step is of first order
    if (!start.air.empty())
      start_from_saved_air();
    else if (settles)
      add_what_is_not_steady(settling_wind());
    return update_load_on_bodies();
  }

  aero::RotorLoad load_at_end() override {
    if (solver_->march().verdict != aero::Verdict::stopped) require_pitch();  // first: the grid did not follow
    return MarchingAir::load_at_end();
  }

  void take_snapshot(Snapshot slot) override { snapshots_[slot] = Saved{rotor_->snapshot(), loads_}; }
  void return_to(Snapshot slot) override {
    rotor_->restore(snapshots_[slot]->air);
    loads_ = snapshots_[slot]->loads;
  }
  void restore(const io::CheckpointReader& file) override {
    MarchingAir::restore(file);
    restored_dt_ = rotor_load_in(file).dt;
    if (const std::optional<RotorPlaces> places = rotor_places_in(file))
      rotor_->place(places->long_before, places->before, places->now);
    tell_size();
  }

 private:
  struct Saved {
    aero::ResolvedRotor::Snapshot air;
    Loads loads;
  };

  /// The rotor in the wind as it comes, placed for the first step.
  void make() override {
    setup_.flow.preconditioner = preconditioner_;
    (void)grid();
    rotor_ = aero::ResolvedRotor::on(world_, setup_, 0, std::move(grid_), grid_progress(), rank_of_tile_);
    solver_ = &rotor_->solver();
    solver_->start_uniform();
    wind().begin(*solver_);
    place_at(state_, setup_.dt);
    solver_->fill_geometry(world_.comm);
    place_wind();
  }
  void make_anew(const Send& send) override {
    snapshots_ = {};
    aero::ResolvedRotor::Snapshot state = rotor_->snapshot();
    solver_ = nullptr, rotor_.reset();
    state.air = send(std::move(state.air));
    make();
    rotor_->restore(state);
  }
  void move() override { rotor_->move_to({frame_.pose(state_), changes(state_)}); }
  ComputedLoads computed() const override { return computed_loads(*rotor_); }
  std::vector<SavedArray> computed_arrays() const override {
    std::vector<SavedArray> arrays = rotor_arrays(*rotor_, loads_.computed, world_.rank);
    if (is_pitched()) arrays.push_back(rotor_places_array(*rotor_, world_.rank));
    return arrays;
  }
  std::vector<aero::SpanLoad> span_loads() const override { return rotor_->span_loads(); }
  aero::RotorLoad on_bodies(const aero::RotorLoad& load) const override { return frame_.on_bodies(load, state_); }

  bool is_pitched() const { return floating_.rotor()->control() != nullptr; }
  /// Pitch of each sector's blade beyond that of the grid, as far as the grid follows.
  std::vector<double> changes(const aero::RotorState& s) const {
    constexpr double most = aero::BladePitching::most_change;
    std::vector<double> changes;
    for (std::size_t b = 0; b < std::min(s.pitches.size(), std::size_t(size_.sectors)); ++b)
      changes.push_back(std::clamp(s.pitches[b] - setup_.rotor.blade_pitch, -most, most));
    return changes;
  }
  /// Throws NumericalFailure where a blade is pitched beyond what the grid follows.
  void require_pitch() const {
    constexpr double most = aero::BladePitching::most_change, degree = radians_per_degree;
    const double made = setup_.rotor.blade_pitch;
    for (std::size_t b = 0; b < state_.pitches.size(); ++b)
      if (const double pitch = state_.pitches[b]; !(std::abs(pitch - made) <= most))
        throw NumericalFailure(
            fmt::format("t = {:g} s: aero: blade {} is pitched to {:.4g} degrees, {:.4g} from where its grid is made; it follows "
                        "within {:g} degrees: give a rotor.blade_pitch_deg (now {:.4g}) nearer to where the blades go",
                        t_, b + 1, pitch / degree, std::abs(pitch - made) / degree, most / degree, made / degree),
            "aero/rotor", long(solver_->time_steps()), t_, most);
  }

  double share_at_hub() const { return setup_.profile.share(frame_.start.hub.z()); }
  /// Of the wind of t = 0 at the hub what blows along the axis: seen from the turning rotor no other flow is steady.
  Eigen::Vector3d settling_wind() const {
    if (wind().steady()) return share_at_hub() * setup_.wind;
    const Eigen::Vector3d& axis = frame_.start.axis;
    return axis.dot(wind().at_start().velocity(frame_.start.hub, 0.0)) * axis;
  }

  /// A profile is no steady flow for turning blades: air that settled did so in the wind `from`, and the rest is added to its
  /// flow.
  void add_what_is_not_steady(const Eigen::Vector3d& from) {
    if (!wind().steady())
      wind().begin(solver_->tiles(), [&](const Eigen::Vector3d&) { return from; });
    else if (!setup_.profile.uniform())
      aero::add_velocity(solver_->tiles(), [&](const Eigen::Vector3d& x) -> Eigen::Vector3d {
        return setup_.profile.share(x.z()) * setup_.wind - from;
      });
  }

  /// Looked through once for the solver that settles and the one that moves: ten core-seconds at the paper's size.
  const std::shared_ptr<const aero::MadeRotorGrid>& grid() {
    if (!grid_) grid_ = made_rotor_grid(setup_, world_.comm, grid_progress());
    return grid_;
  }

  /// A steady march in the rotor's turning frame, hub held at its start, upright; the physical steps go on from its flow, which
  /// does not know of a lean that an equilibrium gave the rotor. Its solver is gone before the moving one is made: two would not
  /// fit where one does.
  aero::TileStates settled_air(int retry) {
    const int steps = scenario().start.air_steps;
    aero::ResolvedRotorSetup steady = setup_;
    steady.dt = 0.0;
    steady.flow.preconditioner = preconditioner_;
    steady.flow.time = "steady", steady.flow.max_pseudo_steps = steps, steady.flow.drop = 0.0, steady.flow.load_change = 0.0;
    steady.profile = {}, steady.wind = settling_wind();
    const int piece = settling_piece(double(size_.cells), steps);  // a large grid shows life in the log
    const std::unique_ptr<aero::ResolvedRotor> held = aero::ResolvedRotor::on(world_, steady, piece, grid(), grid_progress());
    spdlog::info("air settles for {} pseudo-steps round the held hub: {} cells", steps, held->solver().cells());
    held->solver().judgement().bands_of_every_row = false;  // nothing reads them while it settles
    held->solver().start_uniform();
    held->prepare(world_.comm, {.watchdog_s = scenario().runtime.watchdog_s});
    settle({.solver = held->solver(),
            .run = [&] { held->run(); },
            .thrust = [&](const aero::PseudoRow& row) { return held->load(row).thrust; }},
           retry);
    loads_.computed = computed_loads(*held);
    return held->solver().restart().save_tiles();
  }

  /// The grid where the rotor is, with last steps of `dt` at its velocity, in which blades pitched as they did in the last one.
  void place_at(const aero::RotorState& now, double dt) {
    const std::vector<double> pitches = changes(now);
    const std::vector<double> was = rotor_->before().pitches, is = rotor_->now().pitches;
    const auto steps_ago = [&](int steps) {
      aero::RotorState then = now;
      for (int n = 0; n < steps; ++n) then.hub -= dt * now.hub_velocity, then.azimuth -= dt * now.speed;
      std::vector<double> pitched = pitches;
      for (std::size_t b = 0; b < std::min({pitches.size(), was.size(), is.size()}); ++b)
        for (int n = 0; n < steps; ++n) pitched[b] -= is[b] - was[b];
      return aero::RotorPlace{frame_.pose(then), pitched};
    };
    rotor_->place(steps_ago(2), steps_ago(1), steps_ago(0));
  }

  void tell_size() {
    log_lines_.push_back(fmt::format("air: {} cells in {} tiles, {:.0f} MB", solver_->cells(), solver_->grid().tiling().size(),
                                     1e-6 * double(solver_->bytes() + solver_->grid().bytes()) * world_.size));
    tell_wind();
    if (const std::string note = aero::far_side_note(setup_.grid); !note.empty()) log_lines_.push_back("air: " + note);
  }

  /// The flow that another run left, carried to where the blades start, upright.
  void start_from_saved_air() {
    const io::CheckpointReader saved = open_air(world_.comm, scenario());
    loads_.computed = start_from(saved, scenario(), *rotor_, aero::hub_pose(setup_.rotor));
    if (is_of_plain_wind(saved)) add_what_is_not_steady(setup_.wind);
    log_lines_.push_back(
        fmt::format("air taken from {}: thrust {:.4g} kN", saved.path().string(), 1e-3 * loads_.computed.rotor.thrust));
  }

  const GridFrame frame_;
  aero::ResolvedRotorSetup setup_;
  const aero::ResolvedRotorSize size_;
  std::shared_ptr<const aero::MadeRotorGrid> grid_;  ///< until rotor_ is made of it
  std::unique_ptr<aero::ResolvedRotor> rotor_;       ///< made by begin() or restore()
  double restored_dt_ = 0.0;                         ///< step of the run that left the restored state
  std::array<std::optional<Saved>, 2> snapshots_;
};

}  // namespace

std::unique_ptr<AirSide> make_resolved_air(const FloatingSystem& floating, const aero::RotorState& now,
                                           const runtime::World& world) {
  return std::make_unique<ResolvedAir>(floating, now, world);
}

}  // namespace spindrift::coupling
