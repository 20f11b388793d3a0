// SPDX-License-Identifier: Apache-2.0
#include "kernels/mooring/line_composite.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/base/root.hpp"

namespace spindrift {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

double sign(double v) { return v > 0.0 ? 1.0 : v < 0.0 ? -1.0 : 0.0; }

/// Means over a piece along which the vertical pull goes from a to b in equal steps, under the horizontal pull h:
/// of 1/T, H^2/T^3, H v/T^3 and v/T, the first three the derivatives of the last and of H/T (theory page, eqs. 24-26).
struct Means {
  double inverse, flat, cross, rise;
};
Means means(double h, double a, double b) {
  const double ta = std::hypot(h, a), tb = std::hypot(h, b);
  Means m{infinite, 0.0, 0.0, (a + b) / (ta + tb)};
  if (h == 0.0 && a * b <= 0.0) {  // folded down and up again: both halves vertical
    m.flat = (sign(b) - sign(a)) / (b - a);
    return m;
  }
  // (b Ta - a Tb) / ((b - a) H^2), without cancellation where a and b have one sign.
  const double r = a * b > 0.0 ? (a + b) / (b * ta + a * tb) : (b * ta - a * tb) / ((b - a) * h * h);
  const double y = (b - a) * r;
  m.inverse = y == 0.0 ? r : std::asinh(y) / y * r;
  m.flat = h * h * r / (ta * tb);
  m.cross = h * m.rise / (ta * tb);
  return m;
}

}  // namespace

/// All of the line as if it lay flat, then what hangs in place of what lies.
struct CatenaryChain::Sums {
  double x = 0.0, z = 0.0, x_h = 0.0, x_v = 0.0, z_h = 0.0, z_v = 0.0;
  double on_bed = 0.0;
  double v = 0.0, horizontal = 0.0, vertical = 0.0;  ///< V; pull on the lower end
  Eigen::Matrix2d lower_by_upper = Eigen::Matrix2d::Identity();
  int evaluations = 0;
  bool converged = true;

  void add(double h, const CatenarySection& s, double length, double a, double b) {
    const Means m = means(h, a, b);
    const double stretch = length / s.axial_stiffness;
    x += h == 0.0 ? -length : length * (h * m.inverse - 1.0);
    x_h += length * (m.inverse - m.flat);
    x_v -= length * m.cross, z_h -= length * m.cross;
    z += length * m.rise + 0.5 * stretch * (a + b);
    z_v += length * m.flat + stretch;
    on_bed -= length;
  }
};

CatenaryChain::CatenaryChain(std::vector<CatenarySection> from_below, const std::vector<double>& hung, double bed_friction,
                             bool bed_contact)
    : friction_(bed_friction), bed_(bed_contact) {
  double above = 0.0;
  for (std::size_t i = from_below.size(); i-- > 0;) {
    if (i < hung.size()) {
      above += hung[i];
      if (hung[i] < 0.0) floats_.push_back(i + 1);
    }
    const CatenarySection& s = from_below[i];
    parts_.push_back({s, above + s.weight_per_m * s.length, above});
    least_above_ = std::min(least_above_, above);
    above = parts_.back().above_lower;
    length_ += s.length, compliance_ += s.length / s.axial_stiffness;
  }
  std::reverse(parts_.begin(), parts_.end()), std::reverse(floats_.begin(), floats_.end());
}

template <class Piece>
CatenaryChain::Foot CatenaryChain::hang(std::size_t lowest, std::size_t highest, double carried, const Piece& piece) const {
  const auto whole = [&](std::size_t i) {
    piece(i, parts_[i].of.length, carried - parts_[i].above_lower, carried - parts_[i].above_upper);
  };
  for (std::size_t i = lowest; i < highest; ++i) whole(i);
  for (std::size_t i = highest; i < parts_.size(); ++i) {  // falls towards its upper foot
    const Part& p = parts_[i];
    if (carried >= p.above_lower) break;
    if (carried > p.above_upper) {
      piece(i, (p.above_lower - carried) / p.of.weight_per_m, carried - p.above_lower, 0.0);
      break;
    }
    whole(i);
  }
  for (std::size_t i = lowest; i-- > 0;) {
    const Part& p = parts_[i];
    if (bed_ && carried <= p.above_upper) return {int(i), p.of.length};
    if (bed_ && carried < p.above_lower) {
      const double length = (carried - p.above_upper) / p.of.weight_per_m;
      piece(i, length, 0.0, carried - p.above_upper);
      return {int(i), p.of.length - length};
    }
    whole(i);
  }
  return {-1, 0.0};
}

void CatenaryChain::sum(double h, std::size_t lowest, std::size_t highest, double carried, Sums& sums) const {
  hang(lowest, highest, carried,
       [&](std::size_t i, double length, double a, double b) { sums.add(h, parts_[i].of, length, a, b); });
}

/// The one whose feet are level.
CatenaryChain::Arch CatenaryChain::raise(double h, std::size_t lowest, std::size_t highest) const {
  double base = infinite;
  for (const std::size_t joint : floats_)
    if (joint >= lowest && joint <= highest) base = std::min(base, parts_[joint - 1].above_upper);
  double most = -infinite;
  for (std::size_t i = lowest; i <= highest; ++i) most = std::max(most, parts_[i].above_lower);
  Sums last;
  const Root root = increasing_root(
      [&](double u) {
        last = Sums();
        sum(h, lowest, highest, base + u, last);
        return ValueAndSlope{last.z, last.z_v};
      },
      0.5 * (most - base));
  last = Sums();
  const double carried = base + root.x;
  sum(h, lowest, highest, carried, last);
  return {lowest, highest, carried, last.z_v > 0.0 ? -last.z_h / last.z_v : 0.0, carried <= parts_.back().above_upper};
}

/// Pools floats whose arches would overlap: isotonic regression by adjacent violators.
std::vector<CatenaryChain::Arch> CatenaryChain::arches(double h) const {
  std::vector<Arch> found;
  if (!bed_) return found;
  for (const std::size_t joint : floats_) {
    found.push_back(raise(h, joint, joint));
    while (found.size() > 1 && found[found.size() - 2].carried < found.back().carried) {
      const std::size_t highest = found.back().highest;
      found.pop_back();
      found.back() = raise(h, found.back().lowest, highest);
    }
  }
  return found;
}

/// What friction takes from the tension of the part that lies at the lower end, and from its stretch.
void CatenaryChain::rub(double h, double carried, const Foot& foot, double by_horizontal, bool top, Sums& sums) const {
  double loss = 0.0;
  for (int i = foot.part; i >= 0; --i) {
    const Part& p = parts_[std::size_t(i)];
    const double length = i == foot.part ? foot.lying : p.of.length, rate = friction_ * p.of.weight_per_m;
    const double before = friction_ * std::max(0.0, p.above_lower - p.of.weight_per_m * length - carried);
    const double left = std::max(0.0, h - before);
    const double gripped = rate * length < left ? length : left / rate;
    sums.x += (gripped * (left - 0.5 * rate * gripped) - h * length) / p.of.axial_stiffness;
    sums.x_h += (gripped * (1.0 + friction_ * by_horizontal) - length) / p.of.axial_stiffness;
    if (top) sums.x_v += friction_ * gripped / p.of.axial_stiffness;
    loss = friction_ * (p.above_lower - carried);
  }
  sums.horizontal = std::max(0.0, h - loss);
}

CatenaryChain::Sums CatenaryChain::sums(double h, double v, const std::vector<Arch>& arches) const {
  Sums sums;
  sums.v = v;
  sums.x = length_ + h * compliance_, sums.x_h = compliance_, sums.on_bed = length_;
  std::size_t left = arches.size(), lowest = parts_.size();  // arches that the part which hangs at the top has not taken in
  while (left > 0 && arches[left - 1].carried < v) lowest = arches[--left].lowest;
  Foot foot = hang(lowest, parts_.size(), v,
                   [&](std::size_t i, double length, double a, double b) { sums.add(h, parts_[i].of, length, a, b); });
  double carried = v, by_horizontal = 0.0;
  for (std::size_t k = left; k-- > 0;) {
    Sums own;
    foot = hang(arches[k].lowest, arches[k].highest, arches[k].carried,
                [&](std::size_t i, double length, double a, double b) { own.add(h, parts_[i].of, length, a, b); });
    carried = arches[k].carried, by_horizontal = arches[k].by_horizontal;
    sums.x += own.x, sums.on_bed += own.on_bed;
    sums.x_h += own.x_h + own.x_v * by_horizontal;  // its rise stays zero
  }
  const bool top = left == 0;
  if (foot.part < 0) {
    sums.horizontal = h, sums.vertical = carried - weight();
    if (!top) sums.lower_by_upper << 1.0, 0.0, by_horizontal, 0.0;
    return sums;
  }
  sums.horizontal = h;
  if (friction_ > 0.0) rub(h, carried, foot, by_horizontal, top, sums);
  sums.lower_by_upper << 1.0 + friction_ * by_horizontal, top ? friction_ : 0.0, 0.0, 0.0;
  if (sums.horizontal == 0.0) sums.lower_by_upper.setZero();
  return sums;
}

CatenaryChain::Sums CatenaryChain::at_height(double h, double z, double guess) const {
  const std::vector<Arch> raised = arches(h);
  double base = least_above_;
  if (bed_) base = !raised.empty() && raised.back().to_the_top ? std::min(0.0, raised.back().carried) : 0.0;
  if (bed_ && z <= 0.0) return sums(h, base, raised);
  const Root root = increasing_root(
      [&](double u) {
        const Sums s = sums(h, base + u, raised);
        return ValueAndSlope{s.z - z, s.z_v};
      },
      guess > base ? guess - base : 0.5 * (std::abs(weight()) - base) + 1e-3 * length_ * parts_.back().of.weight_per_m);
  Sums found = sums(h, base + root.x, raised);
  found.evaluations = root.evaluations, found.converged = root.converged;
  return found;
}

CompositeState CatenaryChain::solve(double x, double z) const {
  Sums now = at_height(0.0, z, 0.0);
  double h = 0.0;
  int evaluations = now.evaluations;
  bool converged = now.converged;
  const bool slack = x <= std::max(now.on_bed, 0.0) || x <= 1e-12 * length_;
  if (!slack) {
    double guess = now.v;
    const Root root = increasing_root(
        [&](double pull) {
          const Sums s = at_height(pull, z, guess);
          guess = s.v, evaluations += s.evaluations;
          return ValueAndSlope{s.x - x, s.z_v > 0.0 ? s.x_h - s.x_v * s.z_h / s.z_v : s.x_h};
        },
        first_pull(x, z));
    h = root.x;
    now = at_height(h, z, guess);
    converged = root.converged && now.converged;
  }
  CompositeState s{.horizontal = h,
                   .vertical = now.v,
                   .lower_horizontal = now.horizontal,
                   .lower_vertical = now.vertical,
                   .on_bed = bed_ ? std::max(now.on_bed, 0.0) : 0.0,
                   .lower_by_upper = now.lower_by_upper,
                   .evaluations = evaluations,
                   .converged = converged};
  s.compliance << now.x_h, now.x_v, now.z_h, now.z_v;
  if (s.on_bed > 1e-12 * length_) s.regime = slack ? CatenaryRegime::slack : CatenaryRegime::grounded;
  return s;
}

std::vector<double> CatenaryChain::heights(const CompositeState& s) const {
  std::vector<double> at(parts_.size(), 0.0);
  const auto rise = [&](std::size_t i, double length, double a, double b) {
    at[i] += length * (means(s.horizontal, a, b).rise + 0.5 * (a + b) / parts_[i].of.axial_stiffness);
  };
  const std::vector<Arch> raised = arches(s.horizontal);
  std::size_t left = raised.size(), lowest = parts_.size();
  while (left > 0 && raised[left - 1].carried < s.vertical) lowest = raised[--left].lowest;
  hang(lowest, parts_.size(), s.vertical, rise);
  for (std::size_t k = 0; k < left; ++k) hang(raised[k].lowest, raised[k].highest, raised[k].carried, rise);
  for (std::size_t i = 1; i < at.size(); ++i) at[i] += at[i - 1];
  return at;
}

/// Of the line whose sections are all alike, with the same length, weight and stretch.
double CatenaryChain::first_pull(double x, double z) const {
  const double heavy = std::max(weight(), 1e-3 * length_ * parts_.back().of.weight_per_m);
  const LineCatenary alike{length_, heavy / length_, length_ / compliance_, 0.0, bed_};
  return std::max(alike.solve(x, z).horizontal, 1e-6 * heavy);
}

namespace {

std::vector<CatenarySection> reversed(std::vector<CatenarySection> sections) {
  std::reverse(sections.begin(), sections.end());
  return sections;
}
std::vector<double> reversed(std::vector<double> hung) {
  std::reverse(hung.begin(), hung.end());
  return hung;
}

}  // namespace

LineComposite::LineComposite(const std::vector<CatenarySection>& from_anchor, const std::vector<double>& hung,
                             double bed_friction, bool bed_contact)
    : upright(from_anchor, hung, bed_friction, bed_contact),
      upside_down(reversed(from_anchor), reversed(hung), bed_friction, bed_contact) {}

LineForces LineComposite::forces(const Eigen::Vector3d& span, const Eigen::Vector3d& /*rate*/) const {
  const CompositeState s = (span.z() >= 0.0 ? upright : upside_down).solve(std::hypot(span.x(), span.y()), std::abs(span.z()));
  return pulls_in_space(span, {s.horizontal, s.vertical}, {s.lower_horizontal, s.lower_vertical});
}

Eigen::Matrix3d LineComposite::stiffness(const Eigen::Vector3d& span) const {
  const bool below = span.z() < 0.0;
  const CompositeState s = (below ? upside_down : upright).solve(std::hypot(span.x(), span.y()), std::abs(span.z()));
  const Eigen::Matrix2d& c = s.compliance;
  Eigen::Matrix2d plane = Eigen::Matrix2d::Zero();
  if (s.regime == CatenaryRegime::slack || std::isinf(c(0, 0)))
    plane(1, 1) = c(1, 1) > 0.0 ? 1.0 / c(1, 1) : 0.0;
  else if (c(1, 1) > 0.0)
    plane = c.inverse();
  else
    plane(0, 0) = 1.0 / c(0, 0);  // flat on the bed: V ~ sqrt(z)
  if (below) {
    plane = (s.lower_by_upper * plane).eval();
    plane(0, 1) = -plane(0, 1), plane(1, 0) = -plane(1, 0);
  }
  return plane_in_space(span, plane, below ? s.lower_horizontal : s.horizontal);
}

std::vector<double> LineComposite::joint_heights(const Eigen::Vector3d& span) const {
  const bool below = span.z() < 0.0;
  const CatenaryChain& chain = below ? upside_down : upright;
  std::vector<double> at = chain.heights(chain.solve(std::hypot(span.x(), span.y()), std::abs(span.z())));
  at.pop_back();
  if (!below) return at;
  std::reverse(at.begin(), at.end());
  for (double& z : at) z += span.z();
  return at;
}

}  // namespace spindrift
