// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/resolved_air.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "kernels/base/failure.hpp"
#include "src/aero/resolved_rotor.hpp"
#include "src/coupling/air_file.hpp"
#include "src/coupling/flow_scene.hpp"
#include "src/coupling/machine.hpp"

namespace spindrift::coupling {

namespace {

Eigen::Quaterniond hub_attitude(const aero::RotorState& s) {
  Eigen::Matrix3d frame;
  frame << s.axis, s.up.cross(s.axis), s.up;
  return Eigen::Quaterniond(frame);
}

/// The rotor where it is, upright as the scene describes it: an equilibrium leans it, and steady flow wants the wind along the
/// axis.
aero::RotorState upright(const Machine& machine, aero::RotorState now) {
  std::vector<Motion> described;
  for (const auto& body : machine.scenario().bodies) described.push_back(described_motion(body.options));
  const aero::RotorState as_described = machine.rotor()->state(0.0, described);
  now.axis = as_described.axis, now.up = as_described.up;
  return now;
}

/// The scene's rotor in this state. Azimuth counts from the upright that the grid's frame has by itself.
aero::ResolvedRotorSetup setup_at(const Machine& machine, const aero::RotorState& now) {
  aero::ResolvedRotorSetup setup = resolved_rotor_setup(machine.scenario());
  setup.rotor.hub_m = now.hub, setup.rotor.axis = now.axis, setup.rotor.speed = now.speed, setup.rotor.azimuth = 0.0;
  const Eigen::Quaterniond own = aero::hub_pose(setup.rotor).hub.attitude;
  const Eigen::Vector3d up = own.conjugate() * now.up;
  setup.rotor.azimuth = now.azimuth + std::atan2(-up.y(), up.z());
  if (machine.scenario().time.window_s > 0.0 && is_strong(machine.scenario().coupling.scheme))
    setup.dt /= machine.scenario().coupling.samples;
  return setup;
}

class ResolvedAir final : public AirSide {
 public:
  ResolvedAir(const Machine& machine, const aero::RotorState& now, const runtime::World& world)
      : machine_(machine),
        world_(world),
        first_(upright(machine, now)),
        setup_(setup_at(machine, first_)),
        rotor_(setup_, world.size, world.rank),
        file_(rotor_.solver(), rotor_.store()),
        state_(now) {
    rotor_.solver().start_uniform();
    aero::RotorState before = now;
    before.hub -= setup_.dt * now.hub_velocity, before.azimuth -= setup_.dt * now.speed;
    rotor_.place(pose(before), pose(now));
    runtime::Graph geometry(world.comm);
    rotor_.solver().record_geometry(geometry);
    runtime::Executor(std::move(geometry), {.threads = 1}).run();
    spdlog::info("air: {} cells in {} tiles, {:.0f} MB", rotor_.solver().cells(), rotor_.store().tiling().size(),
                 1e-6 * double(rotor_.solver().bytes() + rotor_.store().bytes()) * world.size);
  }

  aero::RotorLoad begin(double t, const aero::RotorState& now) override {
    aim(t, 0.0, now);
    if (const int steps = machine_.scenario().start.air_steps; steps > 0) settle(steps);
    return load_ = ramped(load_);
  }

  void aim(double t, double dt, const aero::RotorState& at_end) override {
    t_ = t, state_ = at_end;
    if (dt == 0.0) return;
    rotor_.solver().next_time_step(dt);
    rotor_.move_to(pose(at_end));
    rotor_.solver().clear_rows();
  }

  bool record(runtime::Graph& graph) override {
    rotor_.solver().record(graph);
    return true;
  }

  void forget_tasks() override { rotor_.solver().forget_graphs(); }

  aero::RotorLoad answer() override {
    const aero::March& march = rotor_.solver().march();
    if (march.verdict() == aero::Verdict::failed)
      throw NumericalFailure(
          fmt::format("t = {:g} s: aero: {} (pseudo-step {}, CFL {:.3g}){}; try aero.flow.cfl_max below {:g}", t_, march.why(),
                      march.steps(), march.cfl(), rotor_.solver().trouble(), setup_.flow.cfl_max),
          "aero/rotor", long(rotor_.solver().time_steps()), t_);
    return load_ = ramped(leant(rotor_.load()));
  }
  const aero::RotorLoad* written() const override { return &load_; }

  void keep(Note note) override { notes_[note].emplace(rotor_.snapshot(), load_); }
  void back(Note note) override {
    rotor_.restore(notes_[note]->air);
    load_ = notes_[note]->load;
  }

  void save(io::CheckpointWriter& file) const override { file_.write(file); }
  void restore(const io::CheckpointReader& file) override { file_.read(file); }

  void declare(io::History& history) override {
    column_ = history.add({"air.pseudo_steps", "-", "pseudo-steps of the window's last physical step"});
    history.add({"air.density_residual", "kg/(m3 s)", "root mean square over the cells after them"});
    history.add({"air.residual_drop", "-", "the same over its largest in that step"});
    history.add({"air.cfl", "-", "CFL number of the last pseudo-step"});
  }
  void put(std::span<double> row) const override {
    const aero::March& march = rotor_.solver().march();
    row[column_] = march.steps() - 1, row[column_ + 1] = march.density_residual();
    row[column_ + 2] = march.first_density_residual() > 0.0 ? march.density_residual() / march.first_density_residual() : 0.0;
    row[column_ + 3] = march.cfl();
  }

 private:
  struct Noted {
    Noted(aero::ResolvedRotor::Snapshot a, const aero::RotorLoad& l) : air(std::move(a)), load(l) {}
    aero::ResolvedRotor::Snapshot air;
    aero::RotorLoad load;
  };

  /// Where the grid is to be. One sector stays on the axis it has at the start.
  aero::RotorPose pose(const aero::RotorState& s) const {
    aero::RotorPose pose;
    pose.azimuth = s.azimuth, pose.speed = s.speed;
    if (rotor_.whole()) {
      pose.hub.position = s.hub, pose.hub.attitude = hub_attitude(s);
    } else {
      pose.hub.position = first_.hub + (s.hub - first_.hub).dot(first_.axis) * first_.axis,
      pose.hub.attitude = hub_attitude(first_);
    }
    return pose;
  }
  /// Thrust and torque of one sector along the axis as it is now.
  aero::RotorLoad leant(aero::RotorLoad load) const {
    if (!rotor_.whole()) load.force = load.thrust * state_.axis, load.moment = load.torque * state_.axis;
    return load;
  }
  aero::RotorLoad ramped(aero::RotorLoad load) const {
    const double ramp = machine_.ramp(t_);
    load.thrust *= ramp, load.torque *= ramp, load.power *= ramp, load.force *= ramp, load.moment *= ramp;
    return load;
  }

  /// A steady march seen from the turning rotor, hub held where it starts, upright; the physical steps go on from its flow, which
  /// does not know of a lean that an equilibrium gave the rotor.
  void settle(int steps) {
    aero::ResolvedRotorSetup steady = setup_;
    steady.dt = 0.0;
    steady.flow.time = "steady", steady.flow.max_pseudo_steps = steps, steady.flow.drop = 1e-9, steady.flow.load_change = 0.0;
    // A profile is no steady flow for turning blades: the march has the hub's wind, and the rest of the profile is added to its flow.
    const double at_hub = setup_.profile.share(first_.hub.z());
    steady.profile = {}, steady.wind *= at_hub;
    aero::ResolvedRotor held(steady, world_.size, world_.rank);
    held.solver().start_uniform();
    held.prepare(world_.comm);
    held.run();
    const aero::March& march = held.solver().march();
    if (march.verdict() == aero::Verdict::failed)
      throw NumericalFailure(fmt::format("aero: while the air settles (start.air_steps): {} (pseudo-step {}, CFL {:.3g}){}",
                                         march.why(), march.steps(), march.cfl(), held.solver().trouble()),
                             "aero/rotor", march.steps(), 0.0);
    load_ = leant(held.load());
    const auto& rows = held.solver().rows();
    constexpr std::size_t look_back = 20;
    const std::string change =
        rows.size() > look_back + 1
            ? fmt::format(", {:+.2g} % in the last {}",
                          100.0 * (load_.thrust / held.load(rows[rows.size() - 1 - look_back]).thrust - 1.0), look_back)
            : std::string();
    spdlog::info("air settled by {} pseudo-steps: thrust {:.4g} kN{}, density residual fallen by {:.2g}", march.steps() - 1,
                 1e-3 * load_.thrust, change, march.density_residual() / march.first_density_residual());
    rotor_.solver().start_from(held.solver());
    if (!setup_.profile.uniform())
      rotor_.solver().add_velocity(
          [&](const Eigen::Vector3d& x) -> Eigen::Vector3d { return (setup_.profile.share(x.z()) - at_hub) * setup_.wind; });
  }

  const Machine& machine_;
  const runtime::World world_;
  aero::RotorState first_;  ///< at the start, upright
  aero::ResolvedRotorSetup setup_;
  aero::ResolvedRotor rotor_;
  AirFile file_;
  double t_ = 0.0;
  aero::RotorState state_;  ///< of the last aim
  aero::RotorLoad load_;    ///< the last answer
  std::array<std::optional<Noted>, 2> notes_;
  std::size_t column_ = 0;
};

}  // namespace

std::unique_ptr<AirSide> make_resolved_air(const Machine& machine, const aero::RotorState& now, const runtime::World& world) {
  return std::make_unique<ResolvedAir>(machine, now, world);
}

}  // namespace spindrift::coupling
