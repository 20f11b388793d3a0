// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "kernels/base/interpolation.hpp"
#include "kernels/grid/spacing.hpp"
#include "kernels/grid/spline.hpp"
#include "src/aero/grid/generators/box.hpp"
#include "src/aero/grid/generators/plane_cases.hpp"

namespace spindrift::aero {

MultiBlockGrid cylinder(const CylinderOptions& o) {
  const double thickness = o.far - o.radius;
  const SinhLaw law(o.first_cell > 0 ? o.first_cell * o.outward * 64.0 / o.around / thickness : 1.0);
  const auto radius = [&](double s) {
    return o.first_cell > 0 ? o.radius + thickness * law(s) : o.radius * std::pow(o.far / o.radius, s);
  };
  MultiBlockGrid grid;
  grid.planar = true;
  grid.blocks.push_back(mapped_block("ring", o.around, o.outward, 1, [&](double u, double v, double w) {
    const double angle = u < 1.0 ? -2.0 * std::numbers::pi * u : 0.0;  // from downstream, clockwise; the seam closes exactly
    return Eigen::Vector3d(radius(v) * std::cos(angle), -o.width * w, radius(v) * std::sin(angle));
  }));
  grid.connections = {{{0, Side::i_max, {0, 0}, {o.outward, 1}}, {0, Side::i_min, {0, 0}, {o.outward, 1}}, {1, 2, 3}, {}}};
  grid.boundaries = {{{0, Side::j_min, {0, 0}, {o.around, 1}}, "wall"}, {{0, Side::j_max, {0, 0}, {o.around, 1}}, "farfield"}};
  return grid;
}

double naca0012_half_thickness(double x) {
  // NASA TMR: the standard polynomial scaled so that it closes at its own root and the chord is 1 again.
  return 0.594689181 * (0.298222773 * std::sqrt(x) - 0.127125232 * x - 0.357907906 * x * x + 0.291984971 * x * x * x -
                        0.105174606 * x * x * x * x);
}

namespace {

/// The aerofoil seen from parabolic coordinates w = X + iY = sqrt(z - z0), z0 half the nose radius behind the leading edge: the
/// surface is a shallow bump Y = S(X) on the wake's line Y = 0, and lines of constant X and Y are orthogonal everywhere.
class UnrolledAerofoil {
 public:
  UnrolledAerofoil() {
    const double nose = 0.594689181 * 0.298222773;
    z0_ = 0.25 * nose * nose;  // the nose radius is half the square of the square root's factor
    edge_ = std::sqrt(1.0 - z0_);
  }
  static constexpr bool symmetric = true;
  double edge() const { return edge_; }  ///< X of the trailing edge, of the lower side with its sign turned
  std::complex<double> trailing_edge() const { return 1.0; }
  std::complex<double> focus() const { return z0_; }

  /// Surface height over X in [-edge, edge].
  double height(double x) const { return upper_height(std::abs(x)); }
  double slope(double x) const { return x < 0.0 ? -upper_slope(-x) : upper_slope(x); }

 private:
  /// w of the upper surface at chord position t^2.
  std::complex<double> at(double t) const {
    const double thickness = t >= 1.0 ? 0.0 : naca0012_half_thickness(t * t);
    std::complex<double> w = std::sqrt(std::complex<double>(t * t - z0_, thickness));
    return t == 0.0 ? std::complex<double>(0.0, std::sqrt(z0_)) : w;
  }
  double upper_height(double x) const {
    if (x >= edge_) return 0.0;
    double low = 0.0, high = 1.0;
    for (int n = 0; n < 60; ++n) (at(0.5 * (low + high)).real() < x ? low : high) = 0.5 * (low + high);
    return at(0.5 * (low + high)).imag();
  }
  double upper_slope(double x) const {
    if (x <= 0.0) return 0.0;
    constexpr double h = 1e-4;
    const double a = std::max(x - h, 0.0), b = std::min(x + h, edge_);
    return (upper_height(b) - upper_height(a)) / (b - a);
  }

  double z0_, edge_;
};

/// The same of an outline through points, by a cubic spline of the height over X.
class UnrolledOutline {
 public:
  /// From the trailing edge along the upper side to the nose and back; about one chord long. The trailing edge may lie off the
  /// axis, as that of a flap does.
  explicit UnrolledOutline(std::span<const Eigen::Vector2d> outline) {
    std::vector<std::complex<double>> z = closed_at_the_edge(outline);
    const std::complex<double> end = trailing_edge_ = z.front();
    const std::size_t nose = farthest_from_edge(z);
    focus_ = z[nose] + 0.5 * nose_radius(z, nose) * (end - z[nose]) / std::abs(end - z[nose]);
    edge_ = std::sqrt(std::abs(end - focus_));
    turn_ = std::sqrt((end - focus_) / std::abs(end - focus_));  // the trailing edge comes to lie on the real axis
    x_.resize(z.size()), height_.resize(z.size()), slope_.resize(z.size());
    std::complex<double> last(edge_, 0.0);
    for (std::size_t i = 0; i < z.size(); ++i) {
      std::complex<double> w = std::sqrt(z[i] - focus_) / turn_;
      if (std::abs(w + last) < std::abs(w - last)) w = -w;  // the branch goes on round the nose
      last = w;
      x_[z.size() - 1 - i] = w.real(), height_[z.size() - 1 - i] = w.imag();
    }
    height_.front() = height_.back() = 0.0;
    for (std::size_t i = 1; i < x_.size(); ++i)
      if (x_[i] <= x_[i - 1])
        throw std::invalid_argument("the outline folds back on itself seen from its nose, or points lie on top of each other");
    std::vector<double> work(x_.size());
    spline_slopes(x_, height_, slope_, work);
  }
  static constexpr bool symmetric = false;
  double edge() const { return edge_; }
  std::complex<double> trailing_edge() const { return trailing_edge_; }
  std::complex<double> focus() const { return focus_; }
  std::complex<double> turn() const { return turn_; }
  double height(double x) const { return std::abs(x) >= edge_ ? 0.0 : interpolate_hermite(x_, height_, slope_, x).value; }
  double slope(double x) const { return std::abs(x) >= edge_ ? 0.0 : interpolate_hermite(x_, height_, slope_, x).slope; }

 private:
  /// In lengths from the origin to the middle of the two ends, where the trailing edge then lies: each side of an open one is
  /// shifted by half the gap, times the cube of the place along that line.
  static std::vector<std::complex<double>> closed_at_the_edge(std::span<const Eigen::Vector2d> outline) {
    if (outline.size() < 9) throw std::invalid_argument("an outline has at least nine points");
    std::vector<std::complex<double>> z;
    for (const Eigen::Vector2d& p : outline) z.emplace_back(p.x(), p.y());
    const std::complex<double> middle = 0.5 * (z.front() + z.back());
    const double length = std::abs(middle);
    if (!(length > 0.0)) throw std::invalid_argument("the outline begins and ends at the origin, where its nose belongs");
    if (std::abs(z.front() - z.back()) > 0.03 * length)
      throw std::invalid_argument("the trailing edge is more than 3 % of the chord thick: this grid closes it to a sharp one");
    for (std::complex<double>& p : z) p /= length;
    const std::complex<double> edge = middle / length, half_gap = 0.5 * (z.front() - z.back());
    z.front() = z.back() = edge;
    const std::size_t nose = farthest_from_edge(z);
    for (std::size_t i = 1; i + 1 < z.size(); ++i) {
      const double along = (z[i] * std::conj(edge)).real();
      z[i] -= (i < nose ? half_gap : -half_gap) * along * along * std::abs(along);
    }
    return z;
  }
  static std::size_t farthest_from_edge(std::span<const std::complex<double>> z) {
    std::size_t best = 0;
    for (std::size_t i = 0; i < z.size(); ++i)
      if (std::abs(z[i] - z.front()) > std::abs(z[best] - z.front())) best = i;
    return best;
  }
  /// Of the circle through the nose and a point on either side, some hundredth of the chord away.
  static double nose_radius(std::span<const std::complex<double>> z, std::size_t nose) {
    std::size_t before = nose, after = nose;
    while (before > 0 && std::abs(z[before] - z[nose]) < 0.01) --before;
    while (after + 1 < z.size() && std::abs(z[after] - z[nose]) < 0.01) ++after;
    const double a = std::abs(z[before] - z[nose]), b = std::abs(z[after] - z[nose]), c = std::abs(z[after] - z[before]);
    const double twice = std::abs(std::imag(std::conj(z[before] - z[nose]) * (z[after] - z[nose])));
    if (!(twice > 0.0)) throw std::invalid_argument("the nose is flat or a point: give points round it");
    return a * b * c / (2.0 * twice);
  }

  std::complex<double> trailing_edge_, focus_, turn_;
  double edge_ = 0.0;
  std::vector<double> x_, height_, slope_;
};

// Chosen once for all members; lengths in w unless said otherwise.
constexpr double end_slope = 0.145;   // spacing at the leading and the trailing edge over the mean: as the TMR's grid
constexpr double lean_depth = 0.05;   // lines are normal to the wall up to here
constexpr double edge_width = 0.01;   // over which the wall's slope goes over into the wake's at the trailing edge
constexpr double bump_depth = 0.3;    // over which lines forget the surface's shape
constexpr double wall_depth = 0.05;   // over which heights go over from what the wall asks to the common law
constexpr double wake_growth = 0.75;  // power of the distance behind the trailing edge with which the wake's cells grow in height

/// A C round an aerofoil that is seen from parabolic coordinates; patches wall, farfield, outflow.
template <class Foil>
MultiBlockGrid c_grid(const Foil& foil, const AerofoilOptions& o) {
  const int half_foil = 32 * o.n, wake = 24 * o.n, half = half_foil + wake, ni = 2 * half, nj = 32 * o.n;
  const double edge = foil.edge(), before_edge = edge - 2e-4;
  const WaveLaw along_foil(end_slope);
  // The wake begins with the aerofoil's last spacing, 2 X dX, and reaches `far` behind the trailing edge.
  const SinhLaw along_wake(2.0 * edge * (end_slope * edge / 32) * 24 / o.far);
  const double top = std::sqrt(o.far);  // Y of the outer boundary: upstream it lies Y^2 from the focus

  // One law of heights T(s) for all lines far away (Y = T there, so that the outer lines are lines of constant Y); at the wall
  // each line's are T / sigma, which makes the first cells as high as asked: t = T (T + T0) / (T + sigma T0) rises monotonically
  // between the two.
  const double depth = top * top + 2.0 * top;  // of T: d = T^2 + 2 T is a distance where |w| = 1
  const SinhLaw heights(o.first_cell * 64 / depth);

  struct Line {
    double x, height, lean, sigma;  // X; S; -dX/dt at the wall
  };
  std::vector<Line> lines;  // from the lower side's outflow round the nose to the upper side's
  for (int m = -half; m <= half; ++m) {
    const int i = std::abs(m);
    double x;
    if (i <= half_foil) {
      x = i == half_foil ? edge : edge * along_foil(double(i) / half_foil);
    } else {
      x = std::sqrt(edge * edge + o.far * along_wake(double(i - half_foil) / wake));
    }
    const double side = m < 0 ? -1.0 : 1.0;
    const double height = foil.height(side * x), speed = std::hypot(x, height);
    const double slope = foil.slope(side * std::min(x, before_edge));
    const double rise = 1.0 - height / bump_depth;  // dY/dt at the wall
    const double lean = slope * rise * 0.5 * (1.0 - std::tanh((x - edge) / edge_width));
    const double behind = std::max(x * x - edge * edge, 0.0);
    lines.push_back({side * x, height, lean, speed * std::hypot(rise, lean) / std::pow(1.0 + behind, wake_growth)});
  }
  std::complex<double> turned = 1.0;
  if constexpr (!Foil::symmetric) turned = foil.turn() * foil.turn();
  const auto position = [&](const Line& line, double s) {
    const double d = depth * heights(s), common = d / (std::sqrt(1.0 + d) + 1.0);
    const double t = common * (common + wall_depth) / (common + line.sigma * wall_depth);
    const std::complex<double> w(line.x - line.lean * t * std::exp(-t / lean_depth), t + line.height * std::exp(-t / bump_depth));
    if constexpr (Foil::symmetric) return w * w + foil.focus();
    return w * w * turned + foil.focus();
  };

  Block block{"aerofoil", ni, nj, 1, {}};
  block.nodes.resize(std::size_t(ni + 1) * (nj + 1) * 2);
  for (int m = -half; m <= half; ++m) {
    const int i = std::abs(m);
    for (int j = 0; j <= nj; ++j) {
      std::complex<double> z = position(lines[std::size_t(m + half)], double(j) / nj);
      // Both sides of the wake are one line, that of the lower side.
      if (j == 0 && i >= half_foil) {
        z = position(lines[std::size_t(half - i)], 0.0);
        if (i == half_foil) z = foil.trailing_edge();
        if (Foil::symmetric) z = {z.real(), 0.0};
      }
      if (Foil::symmetric && m == 0) z = {j == 0 ? 0.0 : z.real(), 0.0};
      for (int k = 0; k < 2; ++k) block.nodes[block.node(k, j, half + m)] = {z.real(), -o.width * k, z.imag()};
    }
  }
  MultiBlockGrid grid;
  grid.planar = true;
  grid.blocks.push_back(std::move(block));
  grid.connections = {{{0, Side::j_min, {0, 0}, {wake, 1}}, {0, Side::j_min, {ni - wake, 0}, {ni, 1}}, {-1, -2, 3}, {}}};
  grid.boundaries = {{{0, Side::j_min, {wake, 0}, {ni - wake, 1}}, "wall"},
                     {{0, Side::j_max, {0, 0}, {ni, 1}}, "farfield"},
                     {{0, Side::i_min, {0, 0}, {nj, 1}}, "outflow"},
                     {{0, Side::i_max, {0, 0}, {nj, 1}}, "outflow"}};
  return grid;
}

}  // namespace

MultiBlockGrid naca0012(const AerofoilOptions& o) { return c_grid(UnrolledAerofoil(), o); }

MultiBlockGrid aerofoil(std::span<const Eigen::Vector2d> outline, const AerofoilOptions& o) {
  return c_grid(UnrolledOutline(outline), o);
}

}  // namespace spindrift::aero
