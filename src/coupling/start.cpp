// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/start.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "kernels/rigid/rotation.hpp"
#include "src/bodies/mode_names.hpp"
#include "src/coupling/limits.hpp"
#include "src/coupling/onsets.hpp"
#include "src/coupling/out_of_place.hpp"
#include "src/coupling/recorder.hpp"

namespace spindrift::coupling {

namespace {

/// A start that the joints do not allow: a spin across a hinge, a speed without the turning that belongs to it.
void require_kept(const FloatingSystem& floating, std::string key, const Eigen::Vector3d& given, const Eigen::Vector3d& found) {
  constexpr double relative = 1e-3;  // what is written with four digits
  if ((found - given).norm() <= relative * given.norm() || given.isZero(0.0)) return;
  const auto words = [](const Eigen::Vector3d& v) { return fmt::format("[{:.5g}, {:.5g}, {:.5g}]", v.x(), v.y(), v.z()); };
  refuse(
      floating, std::move(key), words(given),
      fmt::format("is not possible with the joints of this body, which leave {} of it: give all bodies that they tie velocities "
                  "and spins that go together, or leave it out",
                  words(found)));
}

/// A place or an attitude that the joints do not allow: a float that is fixed to the earth, a rotor lifted off its tower. What
/// the scene does not give follows from the rest.
void require_moved(const FloatingSystem& floating, std::size_t b, const Motion& found) {
  constexpr double relative = 1e-3;  // what is written with four digits
  const auto& [name, o] = floating.scenario().bodies[b];
  const std::string section = "bodies." + name;
  const ReferenceMotion left = reference_motion(floating, b, found);
  const auto refuse_lost = [&](const std::string& key, const Eigen::Vector3d& given, const Eigen::Vector3d& is) {
    const auto words = [](const Eigen::Vector3d& v) { return fmt::format("[{:.5g}, {:.5g}, {:.5g}]", v.x(), v.y(), v.z()); };
    refuse(
        floating, section + key, words(given),
        fmt::format("is not possible with the joints of this body, which leave {} of it: displace and turn all bodies that they "
                    "tie together, or leave it out",
                    words(is)));
  };
  if ((left.displacement - o.displacement_m).norm() > relative * o.displacement_m.norm() && !o.displacement_m.isZero(0.0))
    refuse_lost(".displacement_m", o.displacement_m, left.displacement);
  const Eigen::Quaterniond given = attitude(o.rotation);
  if (given.angularDistance(found.attitude) > relative * given.angularDistance(Eigen::Quaterniond::Identity()) &&
      !o.rotation.isZero(0.0))
    refuse_lost(".rotation_deg", o.rotation / radians_per_degree, left.angles / radians_per_degree);
}

/// Moves the bodies from where the scene describes them to how they start, as far as their joints allow.
void move_to_start(FloatingSystem& floating, bodies::BodiesState& state) {
  const bodies::NamedBodies& bodies = floating.scenario().bodies;
  bool moved = false;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const bodies::BodyOptions& o = bodies[b].options;
    if (o.displacement_m.isZero(0.0) && o.rotation.isZero(0.0) && o.velocity_m_s.isZero(0.0) && o.omega_rad_s.isZero(0.0))
      continue;
    state.motions[b] = start_motion(o);
    moved = true;
  }
  if (!moved) return;
  const bodies::Assembly assembly = floating.multibody().assemble_from(state, 0.0);
  if (!assembly.contradiction.empty()) refuse(floating, "bodies", "", "with these displacements: " + assembly.contradiction);
  state = assembly.state;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const auto& [name, o] = bodies[b];
    require_moved(floating, b, state.motions[b]);
    require_kept(floating, "bodies." + name + ".velocity_m_s", o.velocity_m_s, state.motions[b].velocity);
    require_kept(floating, "bodies." + name + ".omega_rad_s", o.omega_rad_s, state.motions[b].omega_earth());
  }
}

Start start_without_memory(FloatingSystem& floating) {
  require_bending_blades(floating);
  if (floating.multibody().bodies().empty()) return {};  // water alone
  bodies::Assembly assembly = floating.multibody().assemble();
  if (!assembly.contradiction.empty()) refuse(floating, "joints", "", assembly.contradiction);
  Start start{std::move(assembly.state), assembly.degrees_of_freedom, std::move(assembly.redundant), {}};
  move_to_start(floating, start.state);
  if (!floating.scenario().start.equilibrium) return start;
  if (!has_level_water(floating.scenario()))
    refuse(floating, "start.equilibrium", "true",
           "is found in water that is level at z = 0 from side to side, and that of [[sea.water]] is not: give the bodies their "
           "places, or fill the tank to z = 0");

  const MeanLoads mean(floating);
  start.equilibrium = find_equilibrium(floating.multibody(), start.state, 0.0);
  const bodies::Equilibrium& found = *start.equilibrium;
  if (!found.problem.empty()) refuse(floating, "start.equilibrium", "true", found.problem);
  for (const std::string& direction : found.free_directions)
    start.notes.push_back(
        fmt::format("{}: neither load nor stiffness; the equilibrium leaves it where the scene puts it", direction));
  if (!found.unstable.empty()) start.notes.push_back(fmt::format("the equilibrium is unstable: {}", found.unstable));
  start.state = found.state;
  return start;
}

}  // namespace

Start make_start(FloatingSystem& floating) {
  Start start = start_without_memory(floating);
  floating.multibody().watch(line_onsets(floating, start.state));
  floating.multibody().begin(start.state, 0.0);
  return start;
}

Stability stability(FloatingSystem& floating, const bodies::BodiesState& state) {
  if (state.motions.empty()) return {{}, {std::numeric_limits<double>::infinity(), "", {}}};
  const MeanLoads mean(floating);
  bodies::System& system = floating.multibody();
  const auto about = [&](const bodies::BodiesState& there) {
    bodies::Linearisation found = linearise(system, there, 0.0);
    name_modes(found, system, there, floating.beams());
    return found;
  };
  Stability result{about(state), {}};
  result.limit = step_limit(system.integrator(), result.linearisation);
  if (floating.beams().empty() || floating.scenario().start.equilibrium) return result;
  if (!has_level_water(floating.scenario())) return result;
  result.rest = find_equilibrium(system, state, 0.0);
  if (result.rest->problem.empty()) result.at_rest = about(result.rest->state);
  return result;
}

namespace {

/// Particles choose their step where the scene does not: the bodies' limit joins theirs. A given step must keep to both.
void require_stable_particles(FloatingSystem& floating, const Stability& stability) {
  if (!stability.linearisation.report.ok())
    refuse(floating, "bodies", "",
           "the start cannot be evaluated: " + floating.multibody().describe(stability.linearisation.report));
  constexpr double margin = 0.9;  // the water adds stiffness that the linearisation does not have
  const double bodies = margin * stability.limit.step_s;
  if (bodies == 0.0)
    refuse(floating, "time.integrator", std::string(name(floating.multibody().integrator())),
           fmt::format("is unstable at any step for {}, which is not damped; use rk4 or symplectic", stability.limit.mode));
  floating.body_step_limit_s = bodies;
  const std::optional<double>& step = floating.scenario().time.step_s;
  if (!step) return;
  const sph::Parameters& p = floating.particle_plan()->parameters;
  const double sound = p.cfl * p.h() / p.eos.c0;
  if (*step > sound)
    refuse(
        floating, "time.step_s", fmt::format("{}", *step),
        fmt::format(
            "is above the limit of {:.4g} s that the speed of sound of {:.4g} m/s sets (sea.particles.cfl {}); leave it out and "
            "the sea takes the largest step that is stable",
            sound, p.eos.c0, p.cfl));
  if (*step > bodies)
    refuse(floating, "time.step_s", fmt::format("{}", *step),
           fmt::format("is above the limit of {:.4g} s of {}", bodies, stability.limit.mode));
}

}  // namespace

void require_stable(FloatingSystem& floating, const Stability& stability) {
  if (floating.particle_plan()) return require_stable_particles(floating, stability);
  const double step = floating.timeline().tick_s();
  const bodies::StepLimit& limit = stability.limit;
  if (!stability.linearisation.report.ok())
    refuse(floating, "bodies", "",
           "the start cannot be evaluated: " + floating.multibody().describe(stability.linearisation.report));
  if (step <= limit.step_s) return;
  const std::string integrator(name(floating.multibody().integrator()));
  if (limit.step_s == 0.0)
    refuse(
        floating, "time.integrator", integrator,
        fmt::format("is unstable at any step for {}, which is not damped (eigenvalue {:.3g}{:+.3g}i 1/s); use rk4 or symplectic",
                    limit.mode, limit.eigenvalue.real(), limit.eigenvalue.imag()));
  refuse(floating, "time.step_s", fmt::format("{}", step),
         fmt::format("is above the limit of {:.4g} s that {} has for {} (eigenvalue {:.3g}{:+.3g}i 1/s)", limit.step_s,
                     integrator, limit.mode, limit.eigenvalue.real(), limit.eigenvalue.imag()));
}

}  // namespace spindrift::coupling
