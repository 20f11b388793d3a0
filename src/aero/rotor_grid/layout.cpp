// SPDX-License-Identifier: Apache-2.0
#include "src/aero/rotor_grid/layout.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/base/constants.hpp"
#include "kernels/grid/spacing.hpp"
#include "kernels/grid/stretching.hpp"

namespace spindrift::aero {

namespace {

int even(double x) { return 2 * std::max(1, int(std::lround(0.5 * x))); }
int whole(double x) { return std::max(2, int(std::lround(x))); }

double smooth_min(double a, double b) {
  constexpr double sharpness = 6.0;
  return std::pow(std::pow(a, -sharpness) + std::pow(b, -sharpness), -1.0 / sharpness);
}

/// Mean of f over [r - width, r + width] with a raised cosine as weight.
template <class F>
auto smoothed(double r, double width, F&& f) {
  constexpr int samples = 24;
  decltype(f(r)) sum = 0.0 * f(r);
  for (int m = 1 - samples; m < samples; ++m)
    sum += (0.5 + 0.5 * std::cos(pi * m / samples)) / samples * f(r + width * m / samples);
  return sum;
}

constexpr double smoothing_radii = 0.045;   // half-width of the smoothing along the span, in tip radii: 4 m of 89
constexpr double last_chord_radii = 0.955;  // the box follows the chord up to here, and beyond has this one's
constexpr double thinnest_radii =
    0.98;  // the first cell follows the chord up to here: the last piece is short and would be the thinnest
constexpr double outboard_growth = 0.15;  // of the box's scale per length beyond the tip

}  // namespace

long RotorGridSizes::cells() const {
  const long plane = long(axial()) * across() - long(box) * box_chordwise() + long(round) * layers;
  return plane * radial() + long(edge) * chordwise() * outboard;
}

// Ten layers and eight cells upstream are what 18 000 cells of one sector need: with eight and seven, layers grow 2.3-fold and
// the wind slows too early, a tenth of the power at 6 and 20 m/s (docs/verification/rotor.md).
RotorGridSizes sizes_of(double n) {
  RotorGridSizes s;
  s.round = even(40 * n), s.edge = even(n), s.box = whole(0.25 * s.round), s.layers = whole(10 * n), s.beside = whole(6 * n);
  s.upstream = whole(8 * n), s.downstream = whole(9 * n), s.span = whole(12 * n), s.outboard = whole(8 * n);
  return s;
}

SectionSpacing section_spacing(const RotorGridSizes& sizes, bool rounded_edge) {
  SectionSpacing spacing;
  spacing.round = sizes.round, spacing.edge = sizes.edge, spacing.round_off = rounded_edge;
  spacing.leading_edge = 0.004 * 120.0 / sizes.round, spacing.trailing_edge = 0.006 * 120.0 / sizes.round;
  return spacing;
}

double first_cell_for(double y_plus, double speed_m_s, double chord_m, double kinematic_viscosity) {
  const double reynolds = std::max(1e4, speed_m_s * 0.5 * chord_m / kinematic_viscosity);
  const double friction_speed = speed_m_s * std::sqrt(0.5 * 0.026 * std::pow(reynolds, -1.0 / 7.0));
  return 2.0 * y_plus * kinematic_viscosity / friction_speed;
}

RotorLayout::RotorLayout(const BladeSurface& blade, const RotorGridSpec& spec, int blades, int roll)
    : blade_(blade), spec_(spec), blades_(blades), roll_(roll), reach_(0.75 * blade.tip_radius()) {
  const RotorGridSizes& n = spec.sizes;
  const double tip = blade.tip_radius(), length = tip - spec.hub_radius_m, outer = spec.radial_extent * tip;
  // Finer at the tip than in proportion: coarse grids would stretch too fast outboard, fine ones should see the closure.
  const double tip_size = 4.3 * blade.closure() * std::pow(12.0 / n.span, 1.5);
  const VinokurLaw law(0.9, tip_size * n.span / length);
  for (int k = 0; k < n.span; ++k) radii_.push_back(spec.hub_radius_m + length * law(double(k) / n.span));
  radii_.push_back(tip);
  std::vector<double> size(std::size_t(n.outboard));
  geometric_sizes(tip_size, outer - tip, size);
  for (const double s : size) radii_.push_back(radii_.back() + s);
  radii_.back() = outer;
}

double RotorLayout::sector(double r) const { return pi * r / blades_; }

double RotorLayout::first_cell(int k) const {
  const int tip = spec_.sizes.span;
  const double r = radii_[std::size_t(std::min(k, tip))], chord = blade_.chord(std::min(r, thinnest_radii * blade_.tip_radius()));
  double h = spec_.first_cell_m > 0.0 ? spec_.first_cell_m : spec_.first_cell_chords * chord;
  if (spec_.y_plus > 0.0)
    h = first_cell_for(spec_.y_plus, std::hypot(spec_.rotor_speed * r, spec_.wind_m_s), chord, spec_.kinematic_viscosity);
  if (k <= tip) return h;
  const std::size_t above = std::min(std::size_t(k) + 1, radii_.size() - 1);
  const double radial = radii_[above] - radii_[above - 1];
  return std::min(h * std::pow(1.0 + 1.25 / spec_.resolution(), k - tip),
                  std::max({h, 0.02 * blade_.tip_chord(), radial / 1500.0}));
}

double RotorLayout::smoothed_chord(double r) const {
  const double tip = blade_.tip_radius(), width = smoothing_radii * tip;
  return smoothed(r, width, [&](double at) {
    return blade_.chord(std::clamp(at, spec_.hub_radius_m, last_chord_radii * tip)) + outboard_growth * std::max(0.0, at - tip);
  });
}

RotorLayout::Box RotorLayout::box(double r) const {
  const double tip = blade_.tip_radius(), scale = smoothed_chord(r);
  const auto centre = [&](double at) {
    const SurfacePoint p = blade_.centre(std::clamp(at, spec_.hub_radius_m, tip));
    return Eigen::Vector2d(p.s / std::clamp(at, spec_.hub_radius_m, tip), p.x);
  };
  Eigen::Vector2d middle = centre(r);
  middle = smoothed(r, smoothing_radii * tip, [&](double at) -> Eigen::Vector2d { return centre(at); });
  const double half_s = smooth_min(1.35 * scale, 0.78 * sector(r));
  return {middle[0] * r, middle[1], half_s, smooth_min(1.15 * scale, 1.35 * half_s)};
}

}  // namespace spindrift::aero
