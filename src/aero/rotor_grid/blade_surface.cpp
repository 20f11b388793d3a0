// SPDX-License-Identifier: Apache-2.0
#include "src/aero/rotor_grid/blade_surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kernels/base/constants.hpp"
#include "kernels/base/failure.hpp"
#include "kernels/base/interpolation.hpp"

namespace spindrift::aero {

namespace {

constexpr double plate_half_thickness = 0.01;  // of the closed tip, over the chord
constexpr double closure_chords = 0.36;        // length of the closure in tip chords

/// The planform's columns as monotone cubics of the span; constant beyond the root and the tip.
class Along {
 public:
  Along(const std::vector<double>& span, const std::vector<double>& value) : span_(span), value_(value), slope_(span.size()) {
    monotone_slopes(span_, value_, slope_);
  }
  double operator()(double at) const {
    return interpolate_hermite(span_, value_, slope_, std::clamp(at, span_.front(), span_.back())).value;
  }

 private:
  const std::vector<double>&span_, &value_;
  std::vector<double> slope_;
};

/// Thins a section of chord 1 towards a plate about its mean line, square at both ends so that the plug beyond the tip fits on
/// it.
void close_tip(double weight, int edge, std::span<Eigen::Vector2d> nodes) {
  const int round = int(nodes.size()), half = round / 2, end = edge / 2;
  const auto mean = [&](int i) -> Eigen::Vector2d {
    return 0.5 * (nodes[std::size_t(i)] + nodes[std::size_t((round - i) % round)]);
  };
  const Eigen::Vector2d nose = mean(half - end);
  std::vector<Eigen::Vector2d> lower(std::size_t(half) + 1), upper(std::size_t(half) + 1);
  for (int i = 0; i <= half; ++i) {
    const Eigen::Vector2d m = i >= half - end ? nose : mean(i);
    const double ramp = std::min(1.0, double(std::min(i, half - i)) / end);
    const Eigen::Vector2d t(0.0, plate_half_thickness * ramp);
    lower[std::size_t(i)] = m - t, upper[std::size_t(i)] = m + t;
  }
  for (int i = 0; i <= half; ++i) {
    Eigen::Vector2d& low = nodes[std::size_t(i)];
    low = (1.0 - weight) * low + weight * lower[std::size_t(i)];
    if (i == 0 || i == half) continue;
    Eigen::Vector2d& high = nodes[std::size_t(round - i)];
    high = (1.0 - weight) * high + weight * upper[std::size_t(i)];
  }
}

/// Stations along the span, closer in the last part, where the tip closes; a little beyond both ends, since a coaxial surface
/// cuts the sections at different spans.
std::vector<double> stations(double begin, double dense, double end) {
  std::vector<double> span;
  for (int m = 0; m < 900; ++m) span.push_back(begin + (dense - begin) * m / 900.0);
  for (int m = 0; m <= 300; ++m) span.push_back(dense + (end - dense) * m / 300.0);
  return span;
}

}  // namespace

SurfacePoint BladeSurface::Line::at(double radius) const {
  const double angle = interpolate_hermite(r, theta, slope_theta, radius).value;
  return {radius * angle, interpolate_hermite(r, x, slope_x, radius).value};
}

BladeSurface::BladeSurface(const Turbine& turbine, const BladeSettings& settings)
    : round_(settings.spacing.round), lines_(std::size_t(settings.spacing.round)) {
  const Planform& p = turbine.planform;
  const Along chord(p.span, p.chord), twist(p.span, p.twist), thickness(p.span, p.thickness), prebend(p.span, p.prebend),
      sweep(p.span, p.sweep);
  const Sections sections(turbine.aerofoils, settings.spacing);
  const double tip = p.span.back(), root_chord = chord(settings.hub_radius);
  tip_chord_ = p.chord.back(), closure_ = closure_chords * tip_chord_;
  const double reach = 0.75 * root_chord, inner = settings.hub_radius * settings.hub_radius - reach * reach;
  const std::vector<double> span = stations(0.9 * std::sqrt(std::max(inner, 0.0)), tip - 2.0 * closure_, tip + 0.06 * tip_chord_);

  const double cone_cos = std::cos(turbine.precone), cone_sin = std::sin(turbine.precone);
  const double pitch_cos = std::cos(settings.pitch), pitch_sin = std::sin(settings.pitch);
  const auto place = [&](Line& line, double at, double in_plane, double out_of_plane) {
    const double t = in_plane * pitch_cos + out_of_plane * pitch_sin, n = out_of_plane * pitch_cos - in_plane * pitch_sin;
    const double outward = at * cone_cos + n * cone_sin;
    line.r.push_back(std::hypot(outward, t));
    line.theta.push_back(std::atan2(t, outward));
    line.x.push_back(n * cone_cos - at * cone_sin);
  };
  std::vector<Eigen::Vector2d> section(std::size_t(settings.spacing.round));
  for (const double at : span) {
    const double c = chord(at), beta = twist(at);
    sections.blend(thickness(at), beta + settings.pitch - settings.roll, section);
    const double zeta = std::clamp((at - (tip - closure_)) / closure_, 0.0, 1.0);
    if (zeta > 0.0) close_tip(zeta * zeta, settings.spacing.edge, section);
    for (std::size_t i = 0; i < section.size(); ++i) {
      const double ahead = (0.5 - section[i].x()) * c, up = section[i].y() * c;  // towards leading edge, suction side
      place(lines_[i], at, sweep(at) + ahead * std::cos(beta) + up * std::sin(beta),
            prebend(at) - ahead * std::sin(beta) + up * std::cos(beta));
    }
    place(middle_, at, sweep(at), prebend(at));
    chord_.push_back(c);
  }
  const auto finish = [&](Line& line, const std::string& what) {
    for (std::size_t m = 1; m < span.size(); ++m)
      if (!(line.r[m] > line.r[m - 1]))
        throw NumericalFailure(
            fmt::format("blade surface: {} does not move outward between span {:.3f} and {:.3f} m: the sections there "
                        "pass through each other (precone {:.1f} deg, pitch {:.1f} deg)",
                        what, span[m - 1], span[m], turbine.precone / radians_per_degree, settings.pitch / radians_per_degree),
            "blade surface", 0, 0.0);
    line.slope_theta.resize(span.size()), line.slope_x.resize(span.size());
    monotone_slopes(line.r, line.theta, line.slope_theta);
    monotone_slopes(line.r, line.x, line.slope_x);
  };
  for (std::size_t i = 0; i < lines_.size(); ++i) finish(lines_[i], fmt::format("node {} of the sections", i));
  finish(middle_, "the half-chord line");
  slope_chord_.resize(span.size());
  monotone_slopes(middle_.r, chord_, slope_chord_);
  Line end;
  place(end, tip, sweep(tip), prebend(tip));
  tip_radius_ = end.r.front();
}

double BladeSurface::chord(double r) const {
  return interpolate_hermite(middle_.r, chord_, slope_chord_, std::clamp(r, middle_.r.front(), tip_radius_)).value;
}

SurfacePoint BladeSurface::centre(double r) const {
  const double inside = std::clamp(r, middle_.r.front(), tip_radius_);
  const SurfacePoint p = middle_.at(inside);
  return {p.s * r / inside, p.x};
}

void BladeSurface::cut(double r, std::span<SurfacePoint> nodes) const {
  for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i] = lines_[i].at(r);
}

Eigen::Vector2d BladeSurface::tip_chord_direction() const {
  const SurfacePoint nose = lines_[std::size_t(round_ / 2)].at(tip_radius_), tail = lines_[0].at(tip_radius_);
  return Eigen::Vector2d(nose.s - tail.s, nose.x - tail.x).normalized();
}

}  // namespace spindrift::aero
