// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/resolved_air.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "kernels/base/failure.hpp"
#include "runtime/trace/ledger.hpp"
#include "src/aero/resolved_rotor.hpp"
#include "src/coupling/air_file.hpp"
#include "src/coupling/air_march.hpp"
#include "src/coupling/air_output.hpp"
#include "src/coupling/columns.hpp"
#include "src/coupling/floating_system.hpp"
#include "src/coupling/flow_scene.hpp"
#include "src/coupling/grid_progress.hpp"
#include "src/coupling/retries.hpp"
#include "src/coupling/saved_air.hpp"

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
  if (floating.scenario().time.window_s > 0.0 && is_strong(floating.scenario().coupling.scheme))
    setup.dt /= floating.scenario().coupling.samples;
  return setup;
}

class ResolvedAir final : public AirSide {
 public:
  ResolvedAir(const FloatingSystem& floating, const aero::RotorState& now, const runtime::World& world)
      : floating_(floating),
        world_(world),
        first_(upright(floating, now)),
        setup_(setup_at(floating, first_)),
        wind_(changing_wind(floating.scenario())),
        state_(now),
        size_(aero::resolved_rotor_size(setup_)),
        computed_{{}, std::vector<aero::RotorLoad>(std::size_t(size_.sectors))} {}

  void settle_in(const io::RunDirectory& directory) override { directory_ = &directory; }

  aero::RotorLoad begin(double t, const aero::RotorState& now) override {
    const runtime::Span span("aero/start");
    prepare(t, 0.0, now);
    if (rotor_) {  // restored, for windows of another length or by another scheme: the grid stands where the last prediction had
                   // put it
      place_at(state_, saved_dt_);
      return load_;
    }
    const StartOptions& start = floating_.scenario().start;
    if (automatic()) choose(start.air_steps > 0);
    const aero::TileStates settled = start.air_steps > 0 ? settled_air(start.air_steps) : aero::TileStates();
    if (!rotor_) make();
    tell_size();
    rotor_->solver().restart().load_tiles(settled);  // the past stays empty: the first step is of first order
    // A profile is no steady flow for turning blades: what settled has the hub's wind, and the rest of the profile is added to
    // its flow.
    if (!settled.empty() && !setup_.profile.uniform())
      aero::add_velocity(rotor_->solver().tiles(), [&](const Eigen::Vector3d& x) -> Eigen::Vector3d {
        return (setup_.profile.share(x.z()) - share_at_hub()) * setup_.wind;
      });
    if (!start.air.empty()) start_from_saved_air(start.air);
    return load_ = ramped(along_axis(computed_.rotor), floating_, t_);
  }

  void prepare(double t, double dt, const aero::RotorState& at_end) override {
    t_ = t, state_ = at_end;
    if (dt == 0.0) return;
    rotor_->solver().set_time_step(dt);
    rotor_->solver().set_wind(wind_until(wind_, t));
    rotor_->move_to(pose(at_end));
    rotor_->solver().judgement().rows.all.clear();
  }

  Tasks record(runtime::Graph& graph) override {
    rotor_->solver().record(graph);
    return Tasks::many;
  }

  void forget_tasks() override { rotor_->solver().forget_graphs(); }

  aero::RotorLoad load_at_end() override {
    require_good_step(rotor_->solver(), floating_, t_, log_lines_);
    computed_ = computed_loads(*rotor_);
    return load_ = ramped(along_axis(computed_.rotor), floating_, t_);
  }
  void ease(int retry) override {
    if (rotor_) rotor_->solver().judgement().march.ease(share_of_cfl(retry));
  }
  const aero::RotorLoad* written() const override { return &load_; }

  void take_snapshot(Snapshot slot) override { snapshots_[slot].emplace(rotor_->snapshot(), load_, computed_); }
  void return_to(Snapshot slot) override {
    rotor_->restore(snapshots_[slot]->air);
    load_ = snapshots_[slot]->load, computed_ = snapshots_[slot]->computed;
  }

  std::vector<SavedArray> saved() const override {
    std::vector<SavedArray> arrays = file_->arrays();
    for (SavedArray& array : rotor_arrays(*rotor_, computed_, world_.rank)) arrays.push_back(std::move(array));
    arrays.push_back(rotor_load_array({load_, setup_.dt}, world_.rank));
    if (floating_.scenario().aero.flow->preconditioner == "auto")
      arrays.push_back(choice_array(setup_.flow.preconditioner, world_.rank));
    return arrays;
  }
  void restore(const io::CheckpointReader& file) override {
    const runtime::Span span("aero/start");
    if (const std::optional<std::string> named = choice_in(file); automatic() && named) {
      setup_.flow.preconditioner = *named;
      log_lines_.push_back(fmt::format("air: preconditioner \"{}\" (as before the restart)", *named));
    }
    make();
    tell_size();
    file_->read(file);
    if (automatic()) choose_for_rotor();  // the run that left it had named one
    computed_ = computed_loads_in(file, size_.sectors);
    const SavedRotorLoad saved = rotor_load_in(file);
    load_ = saved.load, saved_dt_ = saved.dt;
  }

  std::vector<io::Column> columns() const override {
    std::vector<io::Column> columns;
    for (const auto& c : march_columns()) columns.push_back({fmt::format("air.{}", c.name), c.unit, c.meaning});
    for (const auto& c : mass_columns()) columns.push_back({fmt::format("air.{}", c.name), c.unit, c.meaning});
    for (int b = 1; b <= size_.sectors; ++b)
      for (const auto& c : blade_columns()) columns.push_back({fmt::format("rotor.blade_{}.{}", b, c.name), c.unit, c.meaning});
    return columns;
  }
  std::vector<double> values() const override {
    std::vector<double> values;
    for (const auto& c : march_columns()) values.push_back(c.value(rotor_->solver().march()));
    for (const auto& c : mass_columns()) values.push_back(c.value(rotor_->solver().judgement().mass()));
    for (const aero::RotorLoad& blade : computed_.blades)
      for (const auto& c : blade_columns()) values.push_back(c.value(blade));
    return values;
  }

  void open_output(const io::RunDirectory& directory, double resume_s) override {
    directory_ = &directory;
    if (floating_.scenario().aero.flow->preconditioner == "auto" && world_.rank == 0)
      write_choice(directory, setup_.flow.preconditioner);
    output_ = std::make_unique<AirOutput>(world_.comm, rotor_->solver(), rotor_->store(), directory.fields(),
                                          AirOutput::Choice{.walls = setup_.flow.surfaces, .moves = true, .resume_s = resume_s});
  }
  Writing copy_fields(std::int64_t number, double t) override { return output_->copy(number, t); }
  void write_span() override { coupling::write_span(world_, rotor_->span_loads(), *directory_); }
  std::vector<std::string> log_lines() override { return std::exchange(log_lines_, {}); }

 private:
  std::optional<SettlingFile> settling_file() const {
    const double interval_s = floating_.scenario().checkpoint.wall_interval_s;
    if (!directory_ || interval_s <= 0.0) return {};
    return SettlingFile(*directory_, world_, interval_s);
  }

  struct Saved {
    Saved(aero::ResolvedRotor::Snapshot a, const aero::RotorLoad& l, const ComputedLoads& f)
        : air(std::move(a)), load(l), computed(f) {}
    aero::ResolvedRotor::Snapshot air;
    aero::RotorLoad load;
    ComputedLoads computed;
  };

  /// Whether the preconditioner is still to be chosen.
  bool automatic() const { return setup_.flow.preconditioner == "auto"; }
  /// By trial on the flow of the moving rotor as it is.
  void choose_for_rotor() { choose_preconditioner(rotor_->solver(), setup_.flow, world_.comm, log_lines_); }
  /// In the wind as it comes, before anything settles: so a scene that names the outcome runs alike. The rotor stays unless one
  /// is to settle first.
  void choose(bool settles) {
    const std::shared_ptr<const aero::MadeRotorGrid> made = grid();
    make();
    choose_for_rotor();
    if (settles) file_.reset(), rotor_.reset(), grid_ = made;
  }

  double share_at_hub() const { return setup_.profile.share(first_.hub.z()); }
  bool whole() const { return setup_.grid.sectors == "all"; }
  /// Where the grid is to be. One sector stays on the axis it has at the start.
  aero::RotorPose pose(const aero::RotorState& s) const {
    aero::RotorPose pose;
    pose.azimuth = s.azimuth, pose.speed = s.speed;
    if (whole()) {
      pose.hub.position = s.hub, pose.hub.attitude = hub_attitude(s);
    } else {
      pose.hub.position = first_.hub + (s.hub - first_.hub).dot(first_.axis) * first_.axis,
      pose.hub.attitude = hub_attitude(first_);
    }
    return pose;
  }
  /// Thrust and torque of one sector along the axis as it is now.
  aero::RotorLoad along_axis(aero::RotorLoad load) const {
    if (!whole()) load.force = load.thrust * state_.axis, load.moment = load.torque * state_.axis;
    return load;
  }

  /// Made once for the solver that settles and the one that moves: minutes at the paper's size.
  const std::shared_ptr<const aero::MadeRotorGrid>& grid() {
    if (!grid_) grid_ = made_rotor_grid(setup_, grid_progress());
    return grid_;
  }

  /// Tried again where it fails.
  aero::TileStates settled_air(int steps) {
    for (int retry = 0;; ++retry) try {
        return settle(steps, retry);
      } catch (const NumericalFailure& failure) {
        if (retry == most_retries) throw;
        spdlog::warn("{}; retry {} of {} from a CFL number {:g} as large", failure.what(), retry + 1, most_retries,
                     share_of_cfl(retry + 1));
      }
  }

  /// A steady march in the rotor's turning frame, hub held at its start, upright; the physical steps go on from its flow, which
  /// does not know of a lean that an equilibrium gave the rotor. Its solver is gone before the moving one is made: two would not
  /// fit where one does.
  aero::TileStates settle(int steps, int retry) {
    aero::ResolvedRotorSetup steady = setup_;
    steady.dt = 0.0;
    steady.flow.time = "steady", steady.flow.max_pseudo_steps = steps, steady.flow.drop = 0.0, steady.flow.load_change = 0.0;
    steady.profile = {}, steady.wind *= share_at_hub();
    const int piece = settling_piece(double(size_.cells), steps);  // a large grid shows life in the log
    aero::ResolvedRotor held(steady, world_.size, world_.rank, piece, grid(), grid_progress());
    spdlog::info("air settles for {} pseudo-steps round the held hub: {} cells", steps, held.solver().cells());
    held.solver().start_uniform();
    held.solver().judgement().march.ease(share_of_cfl(retry));
    held.prepare(world_.comm, {.watchdog_s = floating_.scenario().runtime.watchdog_s});
    const AirFile state(held.solver(), held.store(), world_);
    coupling::settle({.solver = held.solver(),
                      .state = state,
                      .file = settling_file(),
                      .first_try = retry == 0,
                      .run = [&] { held.run(); },
                      .thrust = [&](const aero::PseudoRow& row) { return held.load(row).thrust; }},
                     steps, log_lines_);
    computed_ = computed_loads(held);
    return held.solver().restart().save_tiles();
  }

  /// The grid where the rotor is, with a last step of `dt` at its velocity.
  void place_at(const aero::RotorState& now, double dt) {
    aero::RotorState before = now;
    before.hub -= dt * now.hub_velocity, before.azimuth -= dt * now.speed;
    rotor_->place(pose(before), pose(now));
  }

  /// The rotor in the wind as it comes, placed for the first step.
  void make() {
    rotor_ = std::make_unique<aero::ResolvedRotor>(setup_, world_.size, world_.rank, 0, grid(), grid_progress());
    grid_.reset();
    file_.emplace(rotor_->solver(), rotor_->store(), world_);
    rotor_->solver().start_uniform();
    place_at(state_, setup_.dt);
    runtime::Graph geometry(world_.comm);
    rotor_->solver().record_geometry(geometry);
    runtime::Executor(std::move(geometry), {.threads = 1}).run();
  }
  void tell_size() {
    log_lines_.push_back(fmt::format("air: {} cells in {} tiles, {:.0f} MB", rotor_->solver().cells(),
                                     rotor_->store().tiling().size(),
                                     1e-6 * double(rotor_->solver().bytes() + rotor_->store().bytes()) * world_.size));
    if (const std::string note = aero::far_side_note(setup_.grid); !note.empty()) log_lines_.push_back("air: " + note);
  }

  /// The flow that another run left, carried to where the blades start, upright.
  void start_from_saved_air(const std::string& file) {
    const io::CheckpointReader saved = open_saved(world_.comm, file);
    computed_ = start_from(saved, floating_.scenario(), *rotor_, aero::hub_pose(setup_.rotor));
    log_lines_.push_back(
        fmt::format("air taken from {}: thrust {:.4g} kN", saved.path().string(), 1e-3 * computed_.rotor.thrust));
  }

  const FloatingSystem& floating_;
  const runtime::World world_;
  aero::RotorState first_;  ///< at the start, upright
  aero::ResolvedRotorSetup setup_;
  aero::Wind wind_;                                  ///< where it changes in time
  std::shared_ptr<const aero::MadeRotorGrid> grid_;  ///< until rotor_ has it
  std::unique_ptr<aero::ResolvedRotor> rotor_;       ///< made by begin() or restore()
  std::optional<AirFile> file_;
  double t_ = 0.0, saved_dt_ = 0.0;  ///< of the last prepare(); step of the run that left the restored state
  aero::RotorState state_;           ///< of the last prepare()
  aero::ResolvedRotorSize size_;
  ComputedLoads computed_;  ///< after the last step, as it is
  aero::RotorLoad load_;    ///< the last load_at_end(): along the axis now, ramped
  std::array<std::optional<Saved>, 2> snapshots_;
  std::vector<std::string> log_lines_;
  const io::RunDirectory* directory_ = nullptr;
  std::unique_ptr<AirOutput> output_;
};

}  // namespace

std::unique_ptr<AirSide> make_resolved_air(const FloatingSystem& floating, const aero::RotorState& now,
                                           const runtime::World& world) {
  return std::make_unique<ResolvedAir>(floating, now, world);
}

}  // namespace spindrift::coupling
