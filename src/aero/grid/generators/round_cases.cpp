// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "kernels/grid/spacing.hpp"
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
  double edge() const { return edge_; }  ///< X of the trailing edge
  double focus() const { return z0_; }

  /// w of the upper surface at chord position t^2.
  std::complex<double> at(double t) const {
    const double thickness = t >= 1.0 ? 0.0 : naca0012_half_thickness(t * t);
    std::complex<double> w = std::sqrt(std::complex<double>(t * t - z0_, thickness));
    return t == 0.0 ? std::complex<double>(0.0, std::sqrt(z0_)) : w;
  }
  /// Surface height over X in [0, edge].
  double height(double x) const {
    if (x >= edge_) return 0.0;
    double low = 0.0, high = 1.0;
    for (int n = 0; n < 60; ++n) (at(0.5 * (low + high)).real() < x ? low : high) = 0.5 * (low + high);
    return at(0.5 * (low + high)).imag();
  }
  double slope(double x) const {
    if (x <= 0.0) return 0.0;
    constexpr double h = 1e-4;
    const double a = std::max(x - h, 0.0), b = std::min(x + h, edge_);
    return (height(b) - height(a)) / (b - a);
  }

 private:
  double z0_, edge_;
};

// Chosen once for all members; lengths in w unless said otherwise.
constexpr double end_slope = 0.145;   // spacing at the leading and the trailing edge over the mean: as the TMR's grid
constexpr double lean_depth = 0.05;   // lines are normal to the wall up to here
constexpr double edge_width = 0.01;   // over which the wall's slope goes over into the wake's at the trailing edge
constexpr double bump_depth = 0.3;    // over which lines forget the surface's shape
constexpr double wall_depth = 0.05;   // over which heights go over from what the wall asks to the common law
constexpr double wake_growth = 0.75;  // power of the distance behind the trailing edge with which the wake's cells grow in height

}  // namespace

MultiBlockGrid naca0012(const AerofoilOptions& o) {
  const UnrolledAerofoil foil;
  const int half_foil = 32 * o.n, wake = 24 * o.n, ni = 2 * (half_foil + wake), nj = 32 * o.n;
  const double edge = foil.edge(), edge_slope = foil.slope(edge - 2e-4);
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
  std::vector<Line> lines;  // upper half, from the leading edge to the outflow
  for (int i = 0; i <= half_foil + wake; ++i) {
    double x;
    if (i <= half_foil) {
      x = i == half_foil ? edge : edge * along_foil(double(i) / half_foil);
    } else {
      x = std::sqrt(edge * edge + o.far * along_wake(double(i - half_foil) / wake));
    }
    const double height = foil.height(x), speed = std::hypot(x, height);
    const double slope = x < edge - 2e-4 ? foil.slope(x) : edge_slope;
    const double rise = 1.0 - height / bump_depth;  // dY/dt at the wall
    const double lean = slope * rise * 0.5 * (1.0 - std::tanh((x - edge) / edge_width));
    const double behind = std::max(x * x - edge * edge, 0.0);
    lines.push_back({x, height, lean, speed * std::hypot(rise, lean) / std::pow(1.0 + behind, wake_growth)});
  }
  const auto position = [&](const Line& line, double s) {
    const double d = depth * heights(s), common = d / (std::sqrt(1.0 + d) + 1.0);
    const double t = common * (common + wall_depth) / (common + line.sigma * wall_depth);
    const std::complex<double> w(line.x - line.lean * t * std::exp(-t / lean_depth), t + line.height * std::exp(-t / bump_depth));
    return w * w + foil.focus();
  };

  Block block{"aerofoil", ni, nj, 1, {}};
  block.nodes.resize(std::size_t(ni + 1) * (nj + 1) * 2);
  for (int i = 0; i <= half_foil + wake; ++i) {
    for (int j = 0; j <= nj; ++j) {
      std::complex<double> z = position(lines[i], double(j) / nj);
      if (j == 0 && i >= half_foil) z = {i == half_foil ? 1.0 : z.real(), 0.0};  // both sides of the wake are one line
      if (j == 0 && i == 0) z = 0.0;
      if (i == 0) z = {z.real(), 0.0};
      for (int k = 0; k < 2; ++k) {
        const int middle = ni / 2;
        block.nodes[block.node(k, j, middle + i)] = {z.real(), -o.width * k, z.imag()};
        block.nodes[block.node(k, j, middle - i)] = {z.real(), -o.width * k, -z.imag()};
      }
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

}  // namespace spindrift::aero
