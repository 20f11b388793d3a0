// SPDX-License-Identifier: Apache-2.0
#include "src/aero/bem.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "kernels/base/failure.hpp"

namespace spindrift::aero {

namespace {

/// Elements as sections of lifting lines; where two meet, in the middle between their ends.
template <class Place>
LiftingLines lifting_lines(const std::vector<Place>& places, const DiscMotion& rotor, int blades) {
  LiftingLines lines{{}, {}, rotor.sense};
  const std::size_t sections = places.size() / std::size_t(blades);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Place& at = places[i];
    const Eigen::Vector3d half = 0.5 * at.element.length * rotor.sense * at.ahead.cross(at.normal);
    const Eigen::Vector3d middle = rotor.hub + at.arm, inner = middle - half;
    lines.middles.push_back(middle);
    if (i % sections == 0)
      lines.ends.push_back(inner);
    else
      lines.ends.back() = 0.5 * (lines.ends.back() + inner);
    lines.ends.push_back(middle + half);
  }
  return lines;
}

/// By the lift of its polar, where the wake induces this velocity [m2/s].
template <class Place>
double circulation(const Place& at, const Eigen::Vector3d& induced) {
  const double normal = at.normal_wind + induced.dot(at.normal), tangential = at.tangential_wind - induced.dot(at.ahead);
  const double attack = std::atan2(normal, tangential) - at.ring.setting;
  return 0.5 * std::hypot(normal, tangential) * at.ring.chord * at.polars(attack).lift;
}

/// Share of the induction by the tip-speed ratio: blades that hardly turn are no disc that all air of their annuli meets.
/// AeroDyn's limits and blend (OpenFAST, AeroDyn/src/BEMT.f90, BEMT_lowerBoundTSR and BEMT_upperBoundTSR).
double share_of_turning(double tip_speed, double wind) {
  constexpr double none_up_to = 1.0, all_from = 2.0;
  if (tip_speed >= all_from * wind) return 1.0;
  const double ratio = tip_speed / wind;
  return ratio <= none_up_to ? 0.0 : 0.5 * (1.0 - std::cos(pi * (ratio - none_up_to) / (all_from - none_up_to)));
}

NumericalFailure unsettled_wake(double t) {
  return {
      fmt::format("t = {:g} s: aero: the circulation along the blades and what their wake of filaments induces do not settle on "
                  "each other; try a smaller aero.wake_step_deg or another aero.dynamic_inflow",
                  t),
      "aero/rotor", 0, t};
}

}  // namespace

BladeElementMomentum::BladeElementMomentum(const Turbine& turbine, const std::string& induction, double air_density,
                                           const UnsteadyFlow& unsteady, double kinematic_viscosity, bool skew_momentum)
    : unsteady_(unsteady),
      blades_(turbine.blades),
      skew_momentum_(skew_momentum),
      air_density_(air_density),
      kinematic_viscosity_(kinematic_viscosity) {
  if (induction == InductionBuhl::name) induction_ = InductionBuhl();
  const Planform& p = turbine.planform;
  const double cone_sine = std::sin(turbine.precone), cone_cosine = std::cos(turbine.precone);
  const auto radius = [&](std::size_t i) { return p.span[i] * cone_cosine + p.prebend[i] * cone_sine; };
  hub_radius_ = radius(0), tip_radius_ = radius(p.span.size() - 1);
  for (const BladePiece& piece : blade_pieces(turbine)) {
    const double across = std::hypot(piece.outward, piece.downwind);
    elements_.push_back(
        {{piece.radius, piece.axial, -piece.downwind / across, piece.outward / across, piece.length, piece.chord, piece.twist},
         SectionPolars(turbine.polars, piece.place)});
  }
  if (!unsteady.wake) return;
  std::vector<double> chords;
  for (const Element& e : elements_) chords.push_back(e.chord);
  wake_.emplace(*unsteady.wake, chords, blades_, tip_radius_);
}

Annulus BladeElementMomentum::annulus(const Element& e, double blade_pitch) const {
  return {e.radius, hub_radius_, tip_radius_, blades_, e.chord, e.twist + blade_pitch};
}

ElementState BladeElementMomentum::solve(std::size_t element, double normal_wind, double tangential_wind,
                                         double blade_pitch) const {
  const Element& e = elements_[element];
  const SectionPolars::InUse section = in_use(e, normal_wind, tangential_wind);
  return std::visit(
      [&](const auto& induction) {
        return solve_element(annulus(e, blade_pitch), normal_wind, tangential_wind, induction, section);
      },
      induction_);
}

template <class Visit>
void BladeElementMomentum::for_each_place(const Wind& wind, const DiscMotion& rotor, double t, const Visit& visit) const {
  const Eigen::Vector3d at_hub = wind.at(t, rotor.hub) - rotor.hub_velocity, side = rotor.ahead(rotor.up);
  const Eigen::Vector3d in_disc = at_hub - at_hub.dot(rotor.axis) * rotor.axis;
  const double across = in_disc.norm(), skew = std::atan2(across, std::abs(at_hub.dot(rotor.axis)));
  const Eigen::Vector3d downstream = across > 0.0 ? Eigen::Vector3d(in_disc / across) : Eigen::Vector3d::Zero();
  const double turning = share_of_turning(std::abs(rotor.omega.dot(rotor.axis)) * tip_radius_, at_hub.norm());
  std::size_t index = 0;
  for (int b = 0; b < blades_; ++b) {
    const double azimuth = rotor.azimuth + 2.0 * pi * b / blades_;
    const Eigen::Vector3d out = std::cos(azimuth) * rotor.up + std::sin(azimuth) * side, ahead = rotor.ahead(out);
    const double pitch = rotor.pitch(b);
    const BladeAxes axes = rotor.bent ? blade_axes(rotor, out, rotor.bent->precone, pitch) : BladeAxes{};
    for (const Element& e : elements_) {
      Eigen::Vector3d arm = e.axial * rotor.axis + e.radius * out;
      Eigen::Vector3d normal = e.normal_axial * rotor.axis + e.normal_radial * out;
      Eigen::Vector3d own = rotor.hub_velocity;
      Annulus ring = annulus(e, pitch);
      if (rotor.bent) {
        bend(*rotor.bent, axes, b, std::size_t(&e - elements_.data()), arm, normal, own);
        ring.radius = arm.dot(out), ring.tip_radius += ring.radius - e.radius;
      }
      Eigen::Vector3d air = wind.at(t, rotor.hub + arm);
      if (rotor.tower) air = rotor.tower->disturbed(rotor.tower_frame, air, rotor.hub + arm);
      const Eigen::Vector3d relative = air - own, met = relative - rotor.omega.cross(arm);
      const double normal_wind = met.dot(normal), tangential_wind = -met.dot(ahead);
      visit(Place{index++, e, ring, arm, normal, ahead, normal_wind, tangential_wind, skew,
                  e.radius / tip_radius_ * out.dot(downstream), skew_momentum_ ? across : 0.0, turning,
                  in_use(e, normal_wind, tangential_wind)});
    }
  }
}

void BladeElementMomentum::bend(const BentBlades& bent, const BladeAxes& axes, int blade, std::size_t element,
                                Eigen::Vector3d& arm, Eigen::Vector3d& normal, Eigen::Vector3d& velocity) {
  const BentBlades::Section& s = bent.sections[element];
  const Eigen::Vector3d q = bent.amplitude(blade), rate = bent.rate(blade), inward = s.shortening * q;
  const Eigen::Vector2d displacement = s.value * q, swing = s.value * rate, slope = s.slope * q;
  arm += displacement.x() * axes.x + displacement.y() * axes.y - 0.5 * q.dot(inward) * axes.along;
  velocity += swing.x() * axes.x + swing.y() * axes.y - rate.dot(inward) * axes.along;
  normal = (normal - normal.dot(slope.x() * axes.x + slope.y() * axes.y) * axes.along).normalized();
}

ElementState BladeElementMomentum::balance(const Place& at) const {
  const ElementState whole = std::visit(
      [&](const auto& induction) {
        return solve_element(at.ring, at.normal_wind, at.tangential_wind, induction, at.polars, at.cross_wind);
      },
      induction_);
  if (at.turning == 1.0 || !whole.balanced) return whole;
  const auto part = [&](double undisturbed, double met) { return undisturbed + at.turning * (met - undisturbed); };
  ElementState state = element_forces(at.ring, part(at.normal_wind, whole.speed * std::sin(whole.inflow)),
                                      part(at.tangential_wind, whole.speed * std::cos(whole.inflow)), at.polars);
  state.axial_induction = at.turning * whole.axial_induction;
  state.tangential_induction = at.turning * whole.tangential_induction, state.balanced = true;
  return state;
}

BladeElementMomentum::Induced BladeElementMomentum::steady(const Place& at) const {
  const ElementState s = balance(at);
  if (!s.has_inductions())
    return {s.speed * std::sin(s.inflow) - at.normal_wind, s.speed * std::cos(s.inflow) - at.tangential_wind};
  return {-s.axial_induction * at.normal_wind, s.tangential_induction * at.tangential_wind};
}

/// With these induced velocities of the level disc, skewed.
template <class Section>
ElementState BladeElementMomentum::forces(const Place& at, const Induced& induced, const Section& section) const {
  ElementState level = element_forces(at.ring, at.normal_wind + induced.normal, at.tangential_wind + induced.tangential, section);
  if (wake_) level.balanced = true;
  if (wake_ || at.normal_wind == 0.0 || at.tangential_wind == 0.0) return level;
  level.axial_induction = -induced.normal / at.normal_wind;
  level.tangential_induction = induced.tangential / at.tangential_wind, level.balanced = true;
  return skewed(at.ring, level, at.normal_wind, at.tangential_wind, at.skew, at.across, section);
}

template <class Visit>
void BladeElementMomentum::for_each_force(const Wind& wind, const DiscMotion& rotor, double t, std::span<const double> memory,
                                          const Visit& visit) const {
  for_each_place(wind, rotor, t, [&](const Place& at) {
    const Element& e = at.element;
    const SectionPolars::InUse& section = at.polars;
    const bool leishman = unsteady_.stall == UnsteadyFlow::Stall::beddoes_leishman;
    ElementState s;
    if (memory.empty() && !leishman) {
      s = skewed(at.ring, balance(at), at.normal_wind, at.tangential_wind, at.skew, at.across, section);
    } else if (memory.empty()) {
      const Induced induced = steady(at);
      const double beta = prandtl_glauert(flow(at, induced).speed);
      const DynamicStallBeddoesLeishman stall = section.leishman();
      s = forces(at, induced, [&](double a) { return stall.still(within_half_turn(a), beta, section); });
    } else {
      const Past past = recalled(memory, at.index);
      const Induced induced = unsteady_.inflow || wake_ ? Induced{past.normal.now, past.tangential.now} : steady(at);
      const double beta = leishman ? prandtl_glauert(flow(at, induced).speed) : 1.0;
      s = forces(at, induced, [&](double a) {
        const double attack = within_half_turn(a);
        if (leishman) return section.leishman().force(past.leishman, attack, beta, section);
        SectionForce f = section(a);
        if (unsteady_.stall == UnsteadyFlow::Stall::oye) f.lift = section.oye().lift(attack, f.lift, past.separation);
        return f;
      });
    }
    const double pressure = 0.5 * air_density_ * s.speed * s.speed * e.chord * e.length;
    const Eigen::Vector3d force = pressure * (s.normal * at.normal + s.tangential * at.ahead);
    visit(at, force, s.balanced);
  });
}

DiscLoad BladeElementMomentum::operator()(const Wind& wind, const DiscMotion& rotor, double t, std::span<const double> memory,
                                          std::span<Wrench> roots) const {
  DiscLoad sum;
  for_each_force(wind, rotor, t, memory, [&](const Place& at, const Eigen::Vector3d& force, bool balanced) {
    sum.force += force, sum.moment += at.arm.cross(force), sum.unbalanced += !balanced;
    add_root_load(at, force, roots);
  });
  return sum;
}

DiscLoad BladeElementMomentum::on_modes(const Wind& wind, const DiscMotion& rotor, double t, std::span<const double> memory,
                                        std::span<double> modal, std::span<Wrench> roots) const {
  DiscLoad sum;
  std::ranges::fill(modal, 0.0);
  int blade = -1;
  BladeAxes axes;
  for_each_force(wind, rotor, t, memory, [&](const Place& at, const Eigen::Vector3d& force, bool balanced) {
    sum.force += force, sum.moment += at.arm.cross(force), sum.unbalanced += !balanced;
    add_root_load(at, force, roots);
    if (const int b = int(at.index / elements_.size()); b != blade)
      blade = b, axes = blade_axes(rotor, blade_direction(rotor, b, blades_), rotor.bent->precone, rotor.pitch(b));
    const BentBlades::Section& s = rotor.bent->sections[at.index % elements_.size()];
    Eigen::Map<Eigen::Vector3d>(modal.data() + beam::BladeModes::count * blade) +=
        s.value.transpose() * Eigen::Vector2d(force.dot(axes.x), force.dot(axes.y)) -
        force.dot(axes.along) * s.shortening * rotor.bent->amplitude(blade);
  });
  return sum;
}

std::optional<ReynoldsReach> BladeElementMomentum::reynolds(const Wind& wind, const DiscMotion& rotor, double t) const {
  ReynoldsReach reach;
  for_each_place(wind, rotor, t, [&](const Place& at) {
    const SectionPolars& polars = at.element.polars;
    if (!polars.depend_on_reynolds()) return;
    const double number = reynolds(at.element, at.normal_wind, at.tangential_wind);
    const auto widen = [](bool first, double low, double high, double& least, double& greatest) {
      least = first ? low : std::min(least, low), greatest = first ? high : std::max(greatest, high);
    };
    widen(reach.elements++ == 0, number, number, reach.least, reach.greatest);
    if (number < polars.least_reynolds() || number > polars.greatest_reynolds())
      widen(reach.outside++ == 0, polars.least_reynolds(), polars.greatest_reynolds(), reach.table_least, reach.table_greatest);
  });
  return reach.elements > 0 ? std::optional(reach) : std::nullopt;
}

std::size_t BladeElementMomentum::memory_size() const {
  const bool remembers = unsteady_.inflow || wake_ || unsteady_.stall != UnsteadyFlow::Stall::none;
  return (remembers ? past_size() * elements_.size() * std::size_t(blades_) : 0) + (wake_ ? wake_->memory_size() : 0);
}

BladeElementMomentum::Past BladeElementMomentum::recalled(std::span<const double> memory, std::size_t index) const {
  const auto m = memory.subspan(past_size() * index, past_size());
  Past past{{m[0], m[1], m[2]}, {m[3], m[4], m[5]}, m[6], m[7], {}};
  if (past_size() == short_past) return past;
  std::array<double, DynamicStallBeddoesLeishman::state_size> values;
  std::copy(m.begin() + short_past, m.end(), values.begin());
  past.leishman = std::bit_cast<DynamicStallBeddoesLeishman::State>(values);
  return past;
}

void BladeElementMomentum::store(const Past& p, std::span<double> memory, std::size_t index) const {
  const double values[short_past] = {p.normal.steady,     p.normal.middle,  p.normal.now, p.tangential.steady,
                                     p.tangential.middle, p.tangential.now, p.separation, p.still_separation};
  const auto m = memory.subspan(past_size() * index, past_size());
  std::copy(std::begin(values), std::end(values), m.begin());
  if (past_size() == short_past) return;
  const auto more = std::bit_cast<std::array<double, DynamicStallBeddoesLeishman::state_size>>(p.leishman);
  std::copy(more.begin(), more.end(), m.begin() + short_past);
}

BladeElementMomentum::Flow BladeElementMomentum::flow(const Place& at, const Induced& induced) const {
  const ElementState s = forces(at, induced, [](double) { return SectionForce{}; });
  return {within_half_turn(s.attack), s.speed};
}

double BladeElementMomentum::prandtl_glauert(double speed) const {
  const double mach = std::min(speed / unsteady_.speed_of_sound, 0.8);
  return std::sqrt(1.0 - mach * mach);
}

void BladeElementMomentum::begin(const Wind& wind, const DiscMotion& rotor, double t, std::span<double> memory) const {
  std::vector<Place> places;
  for_each_place(wind, rotor, t, [&](const Place& at) { places.push_back(at); });
  std::vector<Induced> induced;
  for (const Place& at : places) induced.push_back(steady(at));
  if (wake_) {
    std::vector<double> bound;
    double slowed = 0.0, area = 0.0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Place& at = places[i];
      bound.push_back(circulation(at, induced[i].normal * at.normal - induced[i].tangential * at.ahead));
      slowed -= at.ring.radius * at.element.length * induced[i].normal, area += at.ring.radius * at.element.length;
    }
    const Eigen::Vector3d met = wind.at(t, rotor.hub) - rotor.hub_velocity;
    const double along = met.dot(rotor.axis), induction = along > 0.0 ? std::clamp(slowed / (area * along), 0.0, 0.4) : 0.0;
    std::vector<Eigen::Vector3d> by_wake(places.size());
    const bool settled = wake_->begin(
        lifting_lines(places, rotor, blades_), {rotor.hub, rotor.omega, rotor.axis, met, induction, bound},
        [&](std::size_t i, const Eigen::Vector3d& velocity) { return circulation(places[i], velocity); },
        memory.last(wake_->memory_size()), by_wake);
    if (!settled) throw unsettled_wake(t);
    for (std::size_t i = 0; i < places.size(); ++i)
      induced[i] = {by_wake[i].dot(places[i].normal), -by_wake[i].dot(places[i].ahead)};
  }
  for (const Place& at : places) {
    const auto [normal, tangential] = induced[at.index];
    const auto [attack, speed] = flow(at, induced[at.index]);
    const double f = at.polars.oye().separation(attack, at.polars(attack).lift);
    Past past{{normal, normal, normal}, {tangential, tangential, tangential}, f, f, {}};
    if (past_size() == long_past) past.leishman = at.polars.leishman().settled(attack, prandtl_glauert(speed), at.polars);
    store(past, memory, at.index);
  }
}

void BladeElementMomentum::remember(const Wind& wind, const DiscMotion& rotor, double t, double h,
                                    std::span<double> memory) const {
  const Eigen::Vector3d met = wind.at(t, rotor.hub) - rotor.hub_velocity;
  // Mean induction over the disc, of the wake as it was.
  const double along = met.dot(rotor.axis);
  double slowed = 0.0, area = 0.0;
  for (std::size_t k = 0; k < elements_.size() * std::size_t(blades_); ++k) {
    const Element& e = elements_[k % elements_.size()];
    slowed -= e.radius * e.length * recalled(memory, k).normal.now, area += e.radius * e.length;
  }
  const double induction = along > 0.0 ? slowed / (area * along) : 0.0;
  std::vector<Eigen::Vector3d> by_wake;
  if (wake_) {
    const std::span<double> filaments = memory.last(wake_->memory_size());
    if (const double step = wake_->due(h, rotor.omega.norm(), met.norm(), filaments); step > 0.0) {
      std::vector<Place> places;
      for_each_place(wind, rotor, t, [&](const Place& at) { places.push_back(at); });
      by_wake.resize(places.size());
      const bool settled = wake_->advance(
          lifting_lines(places, rotor, blades_), [&](const auto& point) { return wind.at(t - step, point); }, step,
          [&](std::size_t i, const Eigen::Vector3d& velocity) { return circulation(places[i], velocity); }, filaments, by_wake);
      if (!settled) throw unsettled_wake(t);
    }
  }
  for_each_place(wind, rotor, t, [&](const Place& at) {
    Past past = recalled(memory, at.index);
    const auto settle = [&past](const Induced& now) {
      past.normal = {now.normal, now.normal, now.normal}, past.tangential = {now.tangential, now.tangential, now.tangential};
    };
    if (wake_) {
      if (!by_wake.empty()) settle({by_wake[at.index].dot(at.normal), -by_wake[at.index].dot(at.ahead)});
    } else if (unsteady_.inflow) {
      const auto [normal, tangential] = steady(at);
      const auto wake = unsteady_.inflow_time ? DynamicInflowOye::of(at.ring.radius, tip_radius_, *unsteady_.inflow_time)
                                              : DynamicInflowOye::at(at.ring.radius, tip_radius_, std::abs(along), induction);
      past.normal = wake.advance(past.normal, normal, h), past.tangential = wake.advance(past.tangential, tangential, h);
    } else {
      settle(steady(at));
    }
    const auto [attack, speed] = flow(at, {past.normal.now, past.tangential.now});
    const double still = at.polars.oye().separation(attack, at.polars(attack).lift);
    past.separation =
        DynamicStallOye::advance(past.separation, past.still_separation, still, h, at.ring.chord, speed, unsteady_.stall_lag);
    past.still_separation = still;
    if (past_size() == long_past)
      past.leishman =
          at.polars.leishman().advance(past.leishman, attack, prandtl_glauert(speed), h, at.ring.chord, speed, at.polars);
    store(past, memory, at.index);
  });
}

}  // namespace spindrift::aero
