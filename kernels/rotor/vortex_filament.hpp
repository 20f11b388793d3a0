// Velocities that straight vortex segments induce, and how their cores grow: law of Biot and Savart in the form of van Garrel
// (2003), ECN-C--03-079, eq. 2.13, with the core of Vatistas et al. (1991), n = 2; growth by Bhagwat & Leishman (2002), J. Am.
// Helicopter Soc. 47, 191. Many points side by side, each with its sum in the order of the segments: the same bits on any
// processor. Equations: docs/theory/rotor_engineering.md. Used by free_vortex_wake.cpp; tested in
// tests/kernels/rotor/vortex_filament_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "kernels/base/constants.hpp"
#include "kernels/base/wide.hpp"

namespace spindrift {

/// Radius of a vortex core [m] of this age [s] that began with `radius`; circulation [m2/s], kinematic viscosity [m2/s].
inline double core_radius(double radius, double age, double circulation, double viscosity) {
  constexpr double oseen = 1.25643, squire = 2e-4;  // Squire's parameter a_1, Bhagwat & Leishman (2002)
  return std::sqrt(radius * radius + 4.0 * oseen * (viscosity + squire * std::abs(circulation)) * age);
}

/// From an end of a segment to the point where the velocity is asked for.
template <class Real>
struct Reach {
  Real x, y, z, length;

  SPINDRIFT_INLINE static Reach of(const Real& x, const Real& y, const Real& z) {
    constexpr double least = 1e-24;  // m2: a point at the end itself has no velocity of the segment, and no division by zero
    const Real square = x * x + y * y + z * z;
    return {x, y, z, sqrt(Real(square + Real(least)))};
  }
};

template <class Real>
struct InducedVelocity {
  Real x, y, z;
};

/// Adds what a segment induces between its ends `a` and `b`. `strength`: circulation over 4 pi; `core`: (core radius times length
/// of the segment)^4.
template <class Real>
SPINDRIFT_INLINE void add_segment(const Reach<Real>& a, const Reach<Real>& b, double strength, double core,
                                  InducedVelocity<Real>& sum) {
  const Real x = a.y * b.z - a.z * b.y, y = a.z * b.x - a.x * b.z, z = a.x * b.y - a.y * b.x;
  const Real square = x * x + y * y + z * z, dot = a.x * b.x + a.y * b.y + a.z * b.z, lengths = a.length * b.length;
  // Where the law has 1 / (lengths + dot), expanded by (lengths - dot): finite on the segment, with |r1 x r2|^2 below.
  const Real above = Real(strength) * Real(Real(a.length + b.length) * Real(lengths - dot));
  const Real share = above / Real(lengths * sqrt(Real(square * square + Real(core))));
  sum.x += share * x, sum.y += share * y, sum.z += share * z;
}

/// Chains of segments.
class VortexFilaments {
 public:
  void begin(const Eigen::Vector3d& at) { push(at, 0.0, 0.0); }
  /// By a segment from the last end to here; its direction is that of positive circulation [m2/s]. core: its radius [m].
  void extend(const Eigen::Vector3d& to, double circulation, double core) {
    constexpr double least = 1e-60;  // no core at all: the line itself has no velocity
    const double length = std::sqrt((to.x() - x_.back()) * (to.x() - x_.back()) + (to.y() - y_.back()) * (to.y() - y_.back()) +
                                    (to.z() - z_.back()) * (to.z() - z_.back()));
    const double square = core * length * core * length;
    push(to, circulation / (4.0 * pi), square * square + least);
  }
  std::size_t segments() const { return x_.size(); }

  /// Adds what all of them induce at the points [m/s].
  void add_velocities(std::span<const Eigen::Vector3d> points, std::span<Eigen::Vector3d> velocities) const {
    using Real = LineWide<double>;
    constexpr std::size_t lanes = std::size_t(Real::size);
    for (std::size_t first = 0; first < points.size(); first += lanes) {
      double at[3][lanes];
      for (std::size_t lane = 0; lane < lanes; ++lane)
        for (std::size_t c = 0; c < 3; ++c) at[c][lane] = points[std::min(first + lane, points.size() - 1)][Eigen::Index(c)];
      const Real x = Real::load(at[0]), y = Real::load(at[1]), z = Real::load(at[2]);
      InducedVelocity<Real> sum{0.0, 0.0, 0.0};
      Reach<Real> last{};
      for (std::size_t i = 0; i < x_.size(); ++i) {
        const auto here = Reach<Real>::of(x - Real(x_[i]), y - Real(y_[i]), z - Real(z_[i]));
        if (strength_[i] != 0.0) add_segment(last, here, strength_[i], core_[i], sum);
        last = here;
      }
      sum.x.store(at[0]), sum.y.store(at[1]), sum.z.store(at[2]);
      for (std::size_t lane = 0; lane < lanes && first + lane < points.size(); ++lane)
        velocities[first + lane] += Eigen::Vector3d(at[0][lane], at[1][lane], at[2][lane]);
    }
  }

 private:
  void push(const Eigen::Vector3d& at, double strength, double core) {
    x_.push_back(at.x()), y_.push_back(at.y()), z_.push_back(at.z()), strength_.push_back(strength), core_.push_back(core);
  }
  std::vector<double> x_, y_, z_;        ///< ends [m]
  std::vector<double> strength_, core_;  ///< as add_segment has them, of the segment that ends there; none where a chain begins
};

/// Circle through three points that follow each other; none where they are in line.
struct Bend {
  double radius = 0.0;                               ///< [m]; 0: in line
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< of its plane, by the right hand

  static Bend through(const Eigen::Vector3d& before, const Eigen::Vector3d& here, const Eigen::Vector3d& after) {
    constexpr double straight = 1e-6;  // angle between the segments
    const Eigen::Vector3d in = here - before, out = after - here, across = in.cross(out);
    const double twice_area = across.norm(), lengths = in.norm() * out.norm();
    if (!(twice_area > straight * lengths)) return {};
    return {lengths * (after - before).norm() / (2.0 * twice_area), across / twice_area};
  }
};

/// A chain of segments in the direction of positive circulation: `ends` has one more than the others.
struct Filament {
  std::span<const Eigen::Vector3d> ends;      ///< [m]
  std::span<const double> circulation, core;  ///< of each segment [m2/s], [m]
};

/// What a curved filament induces on itself at an inner end [m/s], beyond what its straight segments have there: that of an arc
/// in place of those segments on either side that end there, or are so near that their core blots them out. The core ends the
/// logarithm so that a ring with the core of Vatistas (n = 2) has the speed of Saffman (1992), chapter 10, Gamma/(4 pi R) (log(8
/// R/r_c) - 1/2). Bhagwat & Leishman (2014), J. Am. Helicopter Soc. 59.
inline Eigen::Vector3d self_induction(const Filament& f, std::size_t at) {
  constexpr double widest = 1.0;  // angle of an arc; beyond, a wake is no circle
  const Eigen::Vector3d& here = f.ends[at];
  Bend bend = Bend::through(f.ends[at - 1], here, f.ends[at + 1]);
  if (bend.radius == 0.0) return Eigen::Vector3d::Zero();
  // A segment at the angle phi is R phi^2 / 2 aside: from two cores on it has 97 % of its velocity.
  const double angle = std::min(widest, std::sqrt(4.0 * f.core[at] / bend.radius));
  const double wanted = std::ceil(angle * bend.radius / (f.ends[at + 1] - here).norm());
  const std::size_t half = std::clamp<std::size_t>(std::size_t(wanted), 1, std::min(at, f.circulation.size() - at));
  const std::size_t first = at - half, last = at + half;
  Eigen::Vector3d straight = Eigen::Vector3d::Zero();
  if (half > 1) {  // those that end here have none
    bend = Bend::through(f.ends[first], here, f.ends[last]);
    if (bend.radius == 0.0) return Eigen::Vector3d::Zero();
    VortexFilaments segments;
    segments.begin(f.ends[first]);
    for (std::size_t i = first; i < last; ++i) segments.extend(f.ends[i + 1], f.circulation[i], f.core[i]);
    segments.add_velocities(std::span(&here, 1), std::span(&straight, 1));
  }
  const auto arc = [&](const Eigen::Vector3d& end, double core) {  // log of tan(angle / 4) between core and end
    const double cut = core / (8.0 * bend.radius) * std::exp(0.5);
    const double sine = std::min(1.0, 0.5 * (end - here).norm() / bend.radius);
    return std::max(0.0, std::log(sine / (1.0 + std::sqrt(1.0 - sine * sine)) / cut));
  };
  const double sum =
      f.circulation[at - 1] * arc(f.ends[first], f.core[at - 1]) + f.circulation[at] * arc(f.ends[last], f.core[at]);
  return sum / (8.0 * pi * bend.radius) * bend.normal - straight;
}

/// What lies beyond the end of a wake: a cylinder of vortex rings without end, which acts outside of itself as a sink spread over
/// its mouth. Exact on its axis.
struct VortexTail {
  Eigen::Vector3d mouth = Eigen::Vector3d::Zero();  ///< its middle [m]
  double radius = 1.0;                              ///< [m]
  double flux = 0.0;                                ///< into it [m3/s]: circulation per length times area

  Eigen::Vector3d velocity(const Eigen::Vector3d& at) const {
    const Eigen::Vector3d from = at - mouth;
    const double distance = std::max(from.norm(), 1e-9 * radius);
    return -flux / (2.0 * pi * radius * radius) * (1.0 - distance / std::hypot(distance, radius)) / distance * from;
  }
};

}  // namespace spindrift
