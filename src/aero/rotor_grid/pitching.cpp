// SPDX-License-Identifier: Apache-2.0
#include "src/aero/rotor_grid/pitching.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

#include "kernels/base/constants.hpp"
#include "kernels/base/smooth_step.hpp"

namespace spindrift::aero {

namespace {

/// From 1 at t = 0 to 0 at t = 1, straight but for rounded ends: a bell-shaped slope would shear the middle half as much again.
double fade(double t) {
  constexpr double end = 0.1;
  t = std::clamp(t, 0.0, 1.0);
  if (t < end) return 1.0 - t * t / (2.0 * end * (1.0 - end));
  if (t > 1.0 - end) return (1.0 - t) * (1.0 - t) / (2.0 * end * (1.0 - end));
  return 1.0 - (t - 0.5 * end) / (1.0 - end);
}

double radius(const Eigen::Vector3d& p) { return std::hypot(p.y(), p.z()); }

constexpr double fade_radii = 0.2;    // length over which the turn fades beyond the tip, in tip radii
constexpr double slide_chords = 1.0;  // height above the hub cylinder over which nodes are kept from leaving it, in root chords

}  // namespace

std::vector<double> surface_radii(const Block& ring) {
  std::vector<double> radii;
  for (int k = 0; k <= ring.nk; ++k) radii.push_back(radius(ring.nodes[ring.node(k, 0, 0)]));
  return radii;
}

BladePitching::BladePitching(const MultiBlockGrid& described, std::span<const double> radii, const Turbine& turbine,
                             const RotorGridSpec& spec)
    : blades_(turbine.blades),
      precone_(turbine.precone),
      hub_radius_(spec.hub_radius_m),
      root_chord_(turbine.planform.chord.front()),
      ring_share_(radii.size()),
      span_(spec.sizes.span >> spec.coarsen),
      ring_row_(described.blocks[0].ni + 1) {
  const double tip = radii[std::size_t(span_)];
  for (const double r : radii) outboard_.push_back(1.0 - smooth_step((r - tip) / (fade_radii * tip)));
}

void BladePitching::add_rows(const GridLayers& part, const std::function<bool(int k)>& needed) {
  const Block& ring = part.grid.blocks[0];
  const int first = part.first[0];
  std::vector<double> length(std::size_t(ring.ni) + 1);
  for (int k = 0; k <= ring.nk; ++k) {
    std::vector<double>& row = ring_share_[std::size_t(first + k)];
    if (!row.empty() || (needed && !needed(first + k))) continue;
    for (int j = 0; j <= ring.nj; ++j) {
      for (int i = 1; i <= ring.ni; ++i)
        length[std::size_t(i)] =
            length[std::size_t(i) - 1] + (ring.nodes[ring.node(k, j, i)] - ring.nodes[ring.node(k, j, i - 1)]).norm();
      for (int i = 0; i <= ring.ni; ++i) {
        const double way = length[std::size_t(i)] / length.back();
        row.push_back(i == ring.ni ? 0.0 : fade(way) * outboard_[std::size_t(first + k)]);
      }
    }
  }
}

double BladePitching::share(int block, int k, int j, int i) const {
  if (block % blocks_of_sector == 0) return ring_share_[std::size_t(k)].at(std::size_t(j * ring_row_ + i));
  return block % blocks_of_sector == 1 ? outboard_[std::size_t(k + span_)] : 0.0;
}

Eigen::Vector3d BladePitching::axis(int block) const {
  const double azimuth = 2.0 * pi * (block / blocks_of_sector) / blades_;
  const double c = std::cos(precone_);
  return {-std::sin(precone_), -c * std::sin(azimuth), c * std::cos(azimuth)};
}

Eigen::Vector3d BladePitching::node(int block, int k, int j, int i, double change, const Eigen::Vector3d& as_made) const {
  const double turn = share(block, k, j, i) * change;
  if (turn == 0.0) return as_made;
  const Eigen::Vector3d along = axis(block);
  // Blade 1 points along z and moves towards -y, and so does its nose: upwind, towards -x, it goes by a negative turn about z.
  Eigen::Vector3d p = Eigen::AngleAxisd(-turn, along) * as_made;
  // The turned section of the hub cylinder is no piece of it: slide along the blade's axis, on the root's straight lines, back to
  // the radius the node had; less and less so further out.
  const double r0 = radius(as_made);
  const double keep = 1.0 - smooth_step((r0 - hub_radius_) / (slide_chords * root_chord_));
  if (keep > 0.0) {
    const double target = keep * r0 + (1.0 - keep) * radius(p);
    // |p + t along| = target in the rotor's plane: a quadratic with the root nearest to zero.
    const double a = along.y() * along.y() + along.z() * along.z(), h = p.y() * along.y() + p.z() * along.z();
    const double c = p.y() * p.y() + p.z() * p.z() - target * target;
    p += (-c / (h + std::sqrt(std::max(0.0, h * h - a * c)))) * along;
  }
  return p;
}

void BladePitching::move(Block& b, int block, double change) const {
  for (int k = 0; k <= b.nk; ++k)
    for (int j = 0; j <= b.nj; ++j)
      for (int i = 0; i <= b.ni; ++i) {
        Eigen::Vector3d& x = b.nodes[b.node(k, j, i)];
        x = node(block, k, j, i, change, x);
      }
}

}  // namespace spindrift::aero
