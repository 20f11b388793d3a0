// SPDX-License-Identifier: Apache-2.0
#include "src/bodies/mode_names.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "kernels/linear/dense.hpp"

namespace spindrift::bodies {

namespace {

/// What a direction moves of a body, with the inertia that moves with it; earth axes.
struct Moving {
  double mass = 0.0;
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  Eigen::Vector3d linear = Eigen::Vector3d::Zero(), spin = Eigen::Vector3d::Zero();
};

std::vector<Moving> moving(const System& system, const BodiesState& state, const Eigen::VectorXd& velocity) {
  std::vector<Moving> all;
  for (std::size_t b = 0; b < system.bodies().size(); ++b) {
    const Body& body = system.bodies()[b];
    const Eigen::Matrix3d axes = state.motions[b].attitude.toRotationMatrix();
    all.push_back({body.mass, axes * body.inertia * axes.transpose(), velocity.segment<3>(Eigen::Index(6 * b)),
                   axes * velocity.segment<3>(Eigen::Index(6 * b + 3))});
  }
  return all;
}

/// A body on a beam's end belongs to the body that carries the beam; its own is what the beam's deformation adds.
void carry(const Beam& beam, const BodiesState& state, std::vector<Moving>& all) {
  if (beam.i == earth) return;
  Moving &base = all[std::size_t(beam.i)], &top = all[std::size_t(beam.j)];
  const Eigen::Vector3d arm = state.motions[std::size_t(beam.j)].position - state.motions[std::size_t(beam.i)].position;
  top.linear -= base.linear + base.spin.cross(arm);
  top.spin -= base.spin;
  base.mass += top.mass;
  base.inertia += top.inertia + top.mass * (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());
}

/// Beams on the end of another come before it: what they carry moves with their start, and belongs to it, before that is taken
/// apart. Of a ring any is the first.
std::vector<const Beam*> from_the_top(std::span<const Beam> beams) {
  std::vector<const Beam*> left, order;
  for (const Beam& beam : beams) left.push_back(&beam);
  while (!left.empty()) {
    const auto carries = [&](const Beam* beam) { return std::ranges::find(left, beam->j, &Beam::i) != left.end(); };
    auto next = std::ranges::find_if_not(left, carries);
    if (next == left.end()) next = left.begin();
    order.push_back(*next);
    left.erase(next);
  }
  return order;
}

/// How a beam deforms where its end's body moves so against its start, by that body's kinetic energy.
std::string deformation_name(const Beam& beam, const BodiesState& state, const Moving& top) {
  constexpr std::array<const char*, 4> names{"bending in x", "bending in y", "stretching", "torsion"};
  const Eigen::Quaterniond& attitude = state.motions[std::size_t(beam.j)].attitude;
  const Eigen::Matrix3d axes = attitude * beam.end_axes;
  const Eigen::Vector3d shift = axes.transpose() * (top.linear + top.spin.cross(attitude * beam.end)),
                        turn = axes.transpose() * top.spin, along = axes.col(2);
  const std::array<double, 4> energy{top.mass * shift.x() * shift.x(), top.mass * shift.y() * shift.y(),
                                     top.mass * shift.z() * shift.z(), along.dot(top.inertia * along) * turn.z() * turn.z()};
  return names[std::size_t(std::ranges::max_element(energy) - energy.begin())] + (" of " + beam.name);
}

/// Share of the energy of the whole moving as one that a beam's deformation has where the mode is the beam's. A base that rolls
/// under a top that stands still, as in a tower's second mode, has the energy of both; the deformation has the top's alone.
constexpr double undone = 0.3;

std::string name_of(const System& system, const BodiesState& state, const Eigen::VectorXd& chart_direction,
                    std::span<const Beam> beams) {
  std::vector<Moving> all = moving(system, state, system.motion_of_freedoms() * chart_direction);
  for (const Beam* beam : from_the_top(beams)) carry(*beam, state, all);
  const auto beam_of = [&](std::size_t b) {
    return std::ranges::find_if(beams, [b](const Beam& beam) { return std::size_t(beam.j) == b; });
  };
  double most = -1.0;
  std::size_t mover = 0, axis = 0;
  for (std::size_t b = 0; b < all.size(); ++b) {
    const Moving& m = all[b];
    for (int k = 0; k < 6; ++k) {
      const double own = k < 3 ? m.mass * m.linear[k] * m.linear[k] : m.inertia(k - 3, k - 3) * m.spin[k - 3] * m.spin[k - 3];
      const double energy = beam_of(b) != beams.end() ? own / undone : own;
      if (energy > most * (1.0 + 1e-9)) most = energy, mover = b, axis = std::size_t(k);
    }
  }
  const auto bent = beam_of(mover);
  if (bent != beams.end()) return deformation_name(*bent, state, all[mover]);
  return freedom_names[axis] + (" of " + system.bodies()[mover].name);
}

}  // namespace

bool stretches_or_twists(std::string_view mode) { return mode.starts_with("stretching of ") || mode.starts_with("torsion of "); }

void name_modes(Linearisation& linearisation, System& system, const BodiesState& state, std::span<const Beam> beams) {
  if (beams.empty() || linearisation.modes.empty()) return;
  // As linearise has it: equal eigenvalues are the same mode.
  const dense::Eigenpairs eigen = dense::eigenpairs(linearisation.matrix);
  const Eigen::Index n = linearisation.matrix.rows() / 2;
  std::vector<bool> taken(std::size_t(2 * n), false);
  for (Mode& mode : linearisation.modes)
    for (Eigen::Index k = 0; k < 2 * n; ++k) {
      if (taken[std::size_t(k)] || eigen.values[k] != mode.eigenvalue) continue;
      taken[std::size_t(k)] = true;
      const Eigen::VectorXcd shape = eigen.vectors.col(k).head(n);
      Eigen::Index leading;
      shape.cwiseAbs().maxCoeff(&leading);
      mode.name = name_of(system, state, (shape / shape[leading]).real(), beams);
      break;
    }
}

}  // namespace spindrift::bodies
