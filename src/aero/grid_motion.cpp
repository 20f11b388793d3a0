// SPDX-License-Identifier: Apache-2.0
#include "src/aero/grid_motion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernels/base/constants.hpp"
#include "src/aero/grid/checks.hpp"
#include "src/aero/grid/node_field.hpp"
#include "src/aero/grid/wall_distance.hpp"
#include "src/scene/error.hpp"
#include "src/scene/section.hpp"

namespace spindrift::aero {

namespace {

Eigen::Vector3d vector_of(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }
[[noreturn]] void refuse(const std::string& key, const std::string& why) {
  throw scene::SceneError({{.key = "aero.flow.motion" + key, .message = why}});
}

}  // namespace

const scene::Section<GridMotionOptions>& grid_motion_section() {
  using scene::above, scene::between;
  static const auto section =
      scene::Section<GridMotionOptions>(
          "motion",
          "Walls that turn about an axis and heave, and the grid with them: pitch_deg + pitch_amplitude_deg sin(2 pi t / "
          "period_s) about "
          "centre_m, heave_amplitude_m sin(2 pi t / period_s + heave_phase_deg). In steady flow pitch_deg alone.")
          .texts("patches", &GridMotionOptions::patches, "Patches that move.")
          .required()
          .choice("grid", &GridMotionOptions::grid,
                  {{"elliptic",
                    "nodes take a share of the motion: 1 on what moves, 0 on what is held, an elliptic problem between "
                    "(multigrid by hypre)"},
                   {"rigid", "all of the grid moves as one"}},
                  "How nodes follow. Held are the patches with conditions that let air through and walls that do not move; those "
                  "of symmetry keep to their plane.")
          .number("stiffness", &GridMotionOptions::stiffness, "-",
                  "Power of the inverse distance from what moves by which the share keeps to 1 near it; 0: the same everywhere.",
                  between(0.0, 3.0))
          .only_if("grid", {"elliptic"})
          .vector("centre_m", &GridMotionOptions::centre_m, "m", "A point of the axis, before heaving.")
          .vector("axis", &GridMotionOptions::axis, "-", "Direction of the axis; about y positive angles lift what is upwind.")
          .degrees("pitch_deg", &GridMotionOptions::pitch, "Mean angle.", between(-180.0, 180.0))
          .degrees("pitch_amplitude_deg", &GridMotionOptions::pitch_amplitude, "Amplitude of the angle.", between(0.0, 180.0))
          .vector("heave_amplitude_m", &GridMotionOptions::heave_m, "m", "Amplitude of the shift.")
          .degrees("heave_phase_deg", &GridMotionOptions::heave_phase, "Phase of the shift before the angle.",
                   between(-360.0, 360.0))
          .number("period_s", &GridMotionOptions::period_s, "s", "Period of both.", above(0.0).up_to(1e6))
          .check([](const GridMotionOptions& o, const scene::Report& report) {
            if (o.patches.empty()) report("patches", "must name a patch at least");
            if (vector_of(o.axis).norm() == 0.0) report("axis", "must not be zero");
          });
  return section;
}

Eigen::Vector3d moved(const TurnAndShift& m, double share, const Eigen::Vector3d& x) {
  if (share == 0.0) return x;
  const double angle = m.turn.norm();
  Eigen::Vector3d to = x;
  if (angle > 0.0) to = m.centre + Eigen::AngleAxisd(share * angle, m.turn / angle) * (x - m.centre);
  return to + share * m.shift;
}

GridMotion::GridMotion(const MultiBlockGrid& grid, const GridMotionOptions& options, const std::vector<std::string>& held,
                       const std::vector<std::string>& sliding)
    : grid_(grid), options_(options) {
  std::vector<std::string> known;
  for (const Boundary& b : grid.boundaries)
    if (std::ranges::find(known, b.patch) == known.end()) known.push_back(b.patch);
  for (const std::string& p : options.patches)
    if (std::ranges::find(known, p) == known.end())
      refuse(".patches", fmt::format("the grid has no patch \"{}\"; it has: {}", p, fmt::join(known, ", ")));
  if (std::ranges::any_of(grid.connections, [](const Connection& c) { return c.periodic.has_value(); }))
    refuse("", "does not go with a grid that repeats itself: its periods would have to move with it");
  if (grid.planar) check_plane();
  if (options.grid == "rigid") return;
  check_patches(sliding);
  if (!held.empty()) {
    std::vector<std::string> given = options.patches;
    given.insert(given.end(), held.begin(), held.end());
    // Each rank solves all of it: multigrid's bits depend on how many share a problem.
    NodeField field(grid, given, options.patches, {.stiffness = options.stiffness});
    const int moving = int(options.patches.size());
    shares_ = field.solve([moving](int patch, const Eigen::Vector3d&) { return patch < moving ? 1.0 : 0.0; });
    unknowns_ = field.unknowns(), cycles_ = field.cycles();
  }
  const double quarter = 0.25 * options.period_s;
  check_cells(0.0);
  if (options.oscillates())
    for (int n = 1; n < 8; ++n) check_cells(0.5 * n * quarter);
}

/// A planar grid keeps to its plane, the x-z plane.
void GridMotion::check_plane() const {
  const Eigen::Vector3d axis = this->axis(), heave = vector_of(options_.heave_m);
  if ((options_.pitch != 0.0 || options_.pitch_amplitude != 0.0) && std::hypot(axis.x(), axis.z()) > 1e-6)
    refuse(".axis", "must be along y: the grid is two-dimensional and lies in the x-z plane");
  if (std::abs(heave.y()) > 1e-6 * heave.norm())
    refuse(".heave_amplitude_m", "must have no y component: the grid is two-dimensional and lies in the x-z plane");
}

/// A patch that keeps to its plane must see no motion across it.
void GridMotion::check_patches(const std::vector<std::string>& sliding) const {
  const Eigen::Vector3d axis = vector_of(options_.axis).normalized(), heave = vector_of(options_.heave_m);
  const bool turns = options_.pitch != 0.0 || options_.pitch_amplitude != 0.0;
  for (const Boundary& b : grid_.boundaries) {
    if (std::ranges::find(sliding, b.patch) == sliding.end()) continue;
    const WallSurface surface = wall_surface(grid_, std::vector<std::string>{b.patch});
    for (const WallSurface::Face& f : surface.faces()) {
      const Eigen::Vector3d normal = (f[2] - f[0]).cross(f[3] - f[1]).normalized();
      if ((turns && normal.cross(axis).norm() > 1e-6) || std::abs(normal.dot(heave)) > 1e-6 * heave.norm())
        refuse(".patches",
               fmt::format("the motion would take patch \"{}\" out of its plane, which its condition \"symmetry\" does not allow",
                           b.patch));
    }
  }
}

void GridMotion::check_cells(double t) const {
  const std::vector<std::string> faults = grid_faults(moved_grid(t), {.examples = 1});
  if (faults.empty()) return;
  const TurnAndShift m = at(t);
  refuse("", fmt::format("cells fold at an angle of {:.4g} deg and a shift of {:.4g} m: {}; hold patches further away, change "
                         "stiffness (now {:g}) or take grid = \"rigid\"",
                         m.turn.norm() / radians_per_degree, m.shift.norm(), faults[0], options_.stiffness));
}

Eigen::Vector3d GridMotion::axis() const { return vector_of(options_.axis).normalized(); }

TurnAndShift GridMotion::at(double t) const {
  const double phase = 2.0 * std::numbers::pi * t / options_.period_s;
  const double angle = options_.pitch + options_.pitch_amplitude * std::sin(phase);
  return {angle * axis(), vector_of(options_.centre_m), std::sin(phase + options_.heave_phase) * vector_of(options_.heave_m)};
}

std::vector<BlockPose> GridMotion::poses(double t) const {
  const TurnAndShift motion = at(t);
  if (shares_.empty()) {
    BlockPose pose;
    const double angle = motion.turn.norm();
    if (angle > 0.0) pose.map.rotation = Eigen::AngleAxisd(angle, motion.turn / angle).toRotationMatrix();
    pose.map.translation = motion.centre - pose.map.rotation * motion.centre + motion.shift;
    return {pose};
  }
  std::vector<BlockPose> poses(grid_.blocks.size());
  for (std::size_t b = 0; b < poses.size(); ++b)
    poses[b].shape_at = [this, motion, b](const Index& n, const Eigen::Vector3d& x) {
      return moved(motion, shares_[b][grid_.blocks[b].node(n[2], n[1], n[0])], x);
    };
  return poses;
}

MultiBlockGrid GridMotion::moved_grid(double t) const {
  const TurnAndShift motion = at(t);
  MultiBlockGrid grid = grid_;
  for (std::size_t b = 0; b < grid.blocks.size(); ++b)
    for (std::size_t n = 0; n < grid.blocks[b].nodes.size(); ++n) {
      Eigen::Vector3d& x = grid.blocks[b].nodes[n];
      x = moved(motion, shares_.empty() ? 1.0 : shares_[b][n], x);
    }
  return grid;
}

std::string GridMotion::description() const {
  if (shares_.empty()) return "the grid moves as one";
  return fmt::format("the grid follows {}: {} nodes by {} cycles of multigrid", fmt::join(options_.patches, ", "), unknowns_,
                     cycles_);
}

}  // namespace spindrift::aero
