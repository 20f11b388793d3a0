// SPDX-License-Identifier: Apache-2.0
#include "src/aero/bem.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "kernels/base/interpolation.hpp"

namespace spindrift::aero {

namespace {

/// Polar of a thickness between two of the turbine's, on the angles of both; outside them the nearest.
Polar blend(const std::vector<Polar>& polars, double thickness) {
  const auto above = std::find_if(polars.begin(), polars.end(), [&](const Polar& p) { return p.thickness >= thickness; });
  if (above == polars.end()) return polars.back();
  if (above == polars.begin()) return polars.front();
  const Polar &thick = *above, &thin = *(above - 1);
  const double s = (thickness - thin.thickness) / (thick.thickness - thin.thickness);
  Polar mix{thickness, {}, {}, {}};
  std::set_union(thin.attack.begin(), thin.attack.end(), thick.attack.begin(), thick.attack.end(),
                 std::back_inserter(mix.attack));
  for (const double a : mix.attack) {
    const auto at = [&](const std::vector<double> Polar::*values) {
      return (1.0 - s) * interpolate_linear(thin.attack, thin.*values, a) +
             s * interpolate_linear(thick.attack, thick.*values, a);
    };
    mix.lift.push_back(at(&Polar::lift)), mix.drag.push_back(at(&Polar::drag));
  }
  return mix;
}

}  // namespace

BladeElementMomentum::BladeElementMomentum(const Turbine& turbine, const std::string& induction, double air_density)
    : blades_(turbine.blades), air_density_(air_density) {
  if (induction == InductionBuhl::name) induction_ = InductionBuhl();
  const Planform& p = turbine.planform;
  const double cone_sine = std::sin(turbine.precone), cone_cosine = std::cos(turbine.precone);
  const auto radius = [&](std::size_t i) { return p.span[i] * cone_cosine + p.prebend[i] * cone_sine; };
  const auto axial = [&](std::size_t i) { return p.prebend[i] * cone_cosine - p.span[i] * cone_sine; };
  hub_radius_ = radius(0), tip_radius_ = radius(p.span.size() - 1);
  for (std::size_t i = 0; i + 1 < p.span.size(); ++i) {
    const auto middle = [&](const std::vector<double>& values) { return 0.5 * (values[i] + values[i + 1]); };
    const double outward = radius(i + 1) - radius(i), downwind = axial(i + 1) - axial(i), length = std::hypot(outward, downwind);
    const Polar polar = blend(turbine.polars, middle(p.thickness));
    elements_.push_back({0.5 * (radius(i) + radius(i + 1)), 0.5 * (axial(i) + axial(i + 1)), -downwind / length, outward / length,
                         length, middle(p.chord), middle(p.twist), attack_.size(), polar.attack.size()});
    attack_.insert(attack_.end(), polar.attack.begin(), polar.attack.end());
    lift_.insert(lift_.end(), polar.lift.begin(), polar.lift.end());
    drag_.insert(drag_.end(), polar.drag.begin(), polar.drag.end());
  }
}

SectionForce BladeElementMomentum::polar(const Element& e, double attack) const {
  const double a = std::remainder(attack, 2.0 * pi);
  const std::span<const double> angles(attack_.data() + e.first, e.rows);
  const std::size_t i = interval(angles, a), j = e.first + i;
  const double s = std::clamp((a - angles[i]) / (angles[i + 1] - angles[i]), 0.0, 1.0);
  return {(1.0 - s) * lift_[j] + s * lift_[j + 1], (1.0 - s) * drag_[j] + s * drag_[j + 1]};
}

Annulus BladeElementMomentum::annulus(const Element& e, double blade_pitch) const {
  return {e.radius, hub_radius_, tip_radius_, blades_, e.chord, e.twist + blade_pitch};
}

ElementState BladeElementMomentum::solve(std::size_t element, double normal_wind, double tangential_wind,
                                         double blade_pitch) const {
  const Element& e = elements_[element];
  const auto section = [&](double a) { return polar(e, a); };
  return std::visit(
      [&](const auto& induction) {
        return solve_element(annulus(e, blade_pitch), normal_wind, tangential_wind, induction, section);
      },
      induction_);
}

DiscLoad BladeElementMomentum::operator()(const Wind& wind, const DiscMotion& rotor, double t) const {
  return std::visit([&](const auto& induction) { return load(wind, rotor, t, induction); }, induction_);
}

template <class Induction>
DiscLoad BladeElementMomentum::load(const Wind& wind, const DiscMotion& rotor, double t, const Induction& induction) const {
  const Eigen::Vector3d at_hub = wind.at(t, rotor.hub) - rotor.hub_velocity, side = rotor.axis.cross(rotor.up);
  const Eigen::Vector3d in_disc = at_hub - at_hub.dot(rotor.axis) * rotor.axis;
  const double across = in_disc.norm(), skew = std::atan2(across, std::abs(at_hub.dot(rotor.axis)));
  const Eigen::Vector3d downstream = across > 0.0 ? Eigen::Vector3d(in_disc / across) : Eigen::Vector3d::Zero();
  DiscLoad sum;
  for (int b = 0; b < blades_; ++b) {
    const double azimuth = rotor.azimuth + 2.0 * pi * b / blades_;
    const Eigen::Vector3d out = std::cos(azimuth) * rotor.up + std::sin(azimuth) * side, ahead = rotor.axis.cross(out);
    const double pitch = rotor.pitches.empty() ? rotor.blade_pitch : rotor.pitches[std::size_t(b)];
    for (const Element& e : elements_) {
      const Eigen::Vector3d arm = e.axial * rotor.axis + e.radius * out;
      Eigen::Vector3d air = wind.at(t, rotor.hub + arm);
      if (rotor.tower) air = rotor.tower->disturbed(rotor.tower_frame, air, rotor.hub + arm);
      const Eigen::Vector3d relative = air - rotor.hub_velocity;
      const Eigen::Vector3d normal = e.normal_axial * rotor.axis + e.normal_radial * out, met = relative - rotor.omega.cross(arm);
      const double normal_wind = met.dot(normal), tangential_wind = -met.dot(ahead);
      const auto section = [&](double a) { return polar(e, a); };
      const Annulus ring = annulus(e, pitch);
      ElementState s = solve_element(ring, normal_wind, tangential_wind, induction, section);
      s = skewed(ring, s, normal_wind, tangential_wind, skew, e.radius / tip_radius_ * out.dot(downstream), section);
      const double pressure = 0.5 * air_density_ * s.speed * s.speed * e.chord * e.length;
      const Eigen::Vector3d force = pressure * (s.normal * normal + s.tangential * ahead);
      sum.force += force, sum.moment += arm.cross(force), sum.unbalanced += !s.balanced;
    }
  }
  return sum;
}

}  // namespace spindrift::aero
