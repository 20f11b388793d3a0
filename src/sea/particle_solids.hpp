// The bodies of a scene and its paddle among the particles: where they are, and what the water and contacts do to them, in the
// numbers of the scene (of a width in 2-D, of both halves of what is symmetrical). Used by particle_sea.cpp; tested in
// tests/coupled/particle_sea_test.cpp and sea_motion_test.cpp there. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kernels/base/failure.hpp"
#include "kernels/base/in_words.hpp"
#include "src/sea/particle_sea.hpp"
#include "src/sea/sph/sea_sph.hpp"

namespace spindrift::sea {

/// By body of the scene: where they are, and loads and contacts of the last evaluation about the places of the centres then.
struct SolidsState {
  std::vector<Motion> motions;
  std::vector<Wrench> loads, contacts;
};

template <int dim, class Real>
class ParticleSolids {
 public:
  /// Declares the bodies with particles, and the paddle, to the sea, which must outlive this.
  ParticleSolids(sph::SeaSph<dim, Real>& sea, const ParticlePlan& plan, std::span<const Motion> start,
                 const sph::TankParticles<dim>& tank, std::optional<sph::Wavemaker> wavemaker)
      : sea_(sea),
        share_(plan.share()),
        in_plane_(plan.cut() != sph::Cut::space),
        wavemaker_(std::move(wavemaker)),
        owner_of_body_(plan.bodies.size(), 0),
        state_{{start.begin(), start.end()}, std::vector<Wrench>(plan.bodies.size()), std::vector<Wrench>(plan.bodies.size())} {
    if (tank.paddle) {
      paddle_ = *tank.paddle;
      sea_.add_body(paddle_, wavemaker_->at_rest());
    }
    std::size_t shaped = 0;
    for (std::size_t b = 0; b < plan.bodies.size(); ++b) {
      names_.push_back(plan.bodies[b].name);
      if (plan.bodies[b].shapes.empty()) continue;
      owner_of_body_[b] = tank.bodies[shaped++];
      sea_.add_body(owner_of_body_[b], start[b], plan.bodies[b].mass / share_);
    }
  }

  const SolidsState& state() const { return state_; }
  void set(const SolidsState& state) { state_ = state; }
  /// Of a body of the scene; 0: it has no particles.
  std::uint16_t owner(std::size_t body) const { return owner_of_body_[body]; }
  std::uint16_t owner_of_paddle() const { return paddle_; }
  sph::Wavemaker::Stroke paddle(double t_s) const {
    return wavemaker_ ? wavemaker_->stroke(t_s) : sph::Wavemaker::Stroke{0.0, 0.0};
  }

  /// Between steps: puts bodies and paddle where they are at a time.
  void place(double t_s, std::span<const Motion> bodies) {
    state_.motions.assign(bodies.begin(), bodies.end());
    for (std::size_t b = 0; b < bodies.size(); ++b)
      if (owner_of_body_[b]) place_body(sea_.state(), owner_of_body_[b], bodies[b]);
    if (wavemaker_) place_body(sea_.state(), paddle_, wavemaker_->motion(t_s));
  }
  /// Between steps: takes the loads of the last evaluation.
  void take_loads() {
    for (std::size_t b = 0; b < owner_of_body_.size(); ++b) {
      const Eigen::Vector3d& at = state_.motions[b].position;
      state_.loads[b] = state_.contacts[b] = Wrench{.point = at};
      if (!owner_of_body_[b]) continue;
      state_.loads[b] = of_scene(sea_.load_on(owner_of_body_[b], at));
      state_.contacts[b] = of_scene(contact_on(sea_.contacts(), owner_of_body_[b], at));
    }
  }
  /// Throws NumericalFailure where a body has come over a side without a wall. Where that repeats its particles would go round,
  /// one by one, and turn it from the other side; where it is open they would leave, and be counted as water.
  void require_inside(double t_s) const {
    const sph::Domain<dim>& domain = sea_.state().columns.domain();
    const auto walled = [&](int k) { return !domain.periodic[k] && !domain.open[k]; };
    if (walled(0) && walled(dim - 2)) return;
    for (const sph::Solid& solid : sea_.state().solids) {
      const auto body = std::ranges::find(owner_of_body_, solid.owner) - owner_of_body_.begin();
      if (body == std::ssize(owner_of_body_)) continue;  // the paddle
      std::array<double, dim> low, high;
      low.fill(1e300), high.fill(-1e300);
      for (const Eigen::Vector3d& local : solid.local) {
        const auto x = sph::from_earth<dim>(state_.motions[std::size_t(body)].point(local));
        for (int k = 0; k < dim; ++k) low[k] = std::min(low[k], x[k]), high[k] = std::max(high[k], x[k]);
      }
      for (int k = 0; k < dim - 1; ++k) {
        if (walled(k) || (low[k] >= domain.low[k] && high[k] <= domain.high[k])) continue;
        const bool below = low[k] < domain.low[k];
        const double limit = below ? domain.low[k] : domain.high[k];
        const std::string axis(1, "xy"[k]), name = names_[std::size_t(body)];
        throw NumericalFailure("t = " + in_words(t_s) + " s: body " + name + " reaches " + axis + " = " +
                                   in_words(below ? low[k] : high[k]) + " m, over the side at " + in_words(limit) + " m " +
                                   side_without_wall(domain.open[k], k) + "; set the sides farther off, or moor it",
                               "bodies." + name, long(sea_.state().work.steps), t_s, limit);
      }
    }
  }
  /// Both, within a window: takes loads, asks the driver for the places, sets those of the sea's solids. What the driver throws
  /// ends the window.
  void move(WindowDriver& driver, const sph::HalfStep& half, std::span<const Wrench> loads, std::span<Motion> solids) {
    const std::vector<sph::Solid>& known = sea_.state().solids;
    for (std::size_t b = 0; b < owner_of_body_.size(); ++b) {
      const Eigen::Vector3d& at = state_.motions[b].position;
      state_.loads[b] = state_.contacts[b] = Wrench{.point = at};
      if (!owner_of_body_[b]) continue;
      for (std::size_t s = 0; s < known.size(); ++s)
        if (known[s].owner == owner_of_body_[b]) state_.loads[b] = of_scene(loads[s]);
      for (const sph::Touch& touch : half.contacts) {
        if (touch.on != owner_of_body_[b] && touch.of != owner_of_body_[b]) continue;
        Wrench w = touch.wrench.about(at);
        if (touch.of == owner_of_body_[b]) w.force = -w.force, w.moment = -w.moment;
        const Wrench all = of_scene(w);
        state_.contacts[b].force += all.force, state_.contacts[b].moment += all.moment;
      }
    }
    double t = half.to;
    try {
      t = driver.move(half.half == 1 || sea_.parameters().step == sph::StepChoice::verlet, state_.motions);
    } catch (const NumericalFailure& failure) {
      sea_.state().plan.failure = failure;
      return;
    }
    for (std::size_t s = 0; s < known.size(); ++s) {
      if (wavemaker_ && known[s].owner == paddle_) solids[s] = wavemaker_->motion(t);
      for (std::size_t b = 0; b < state_.motions.size(); ++b)
        if (known[s].owner == owner_of_body_[b]) solids[s] = state_.motions[b];
    }
  }

 private:
  Wrench of_scene(Wrench load) const {
    if (in_plane_) load.force[1] = 0.0, load.moment[0] = load.moment[2] = 0.0;  // no sway, no roll, no yaw
    load.force *= share_, load.moment *= share_;
    return load;
  }

  sph::SeaSph<dim, Real>& sea_;
  double share_;
  bool in_plane_;  ///< a sea of the plane, or symmetrical about one
  std::optional<sph::Wavemaker> wavemaker_;
  std::uint16_t paddle_ = 0;
  std::vector<std::uint16_t> owner_of_body_;
  std::vector<std::string> names_;  ///< of the scene's bodies
  SolidsState state_;
};

}  // namespace spindrift::sea
