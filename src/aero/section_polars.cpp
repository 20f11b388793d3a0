// SPDX-License-Identifier: Apache-2.0
#include "src/aero/section_polars.hpp"

#include <iterator>

namespace spindrift::aero {

namespace {

constexpr double StallOptions::*stall_values[] = {&StallOptions::normal_slope, &StallOptions::zero_lift, &StallOptions::drag_0,
                                                  &StallOptions::critical_normal, &StallOptions::critical_normal_low};

/// The polar between two, on the angles of both; mean(value of a, value of b) weighs them.
template <class Mean>
Polar between(const Polar& a, const Polar& b, const Mean& mean) {
  Polar mix;
  if (a.stall && b.stall) {
    mix.stall.emplace();
    for (const auto value : stall_values) (*mix.stall).*value = mean((*a.stall).*value, (*b.stall).*value);
    if (a.stall->normal_slope * b.stall->normal_slope == 0.0) mix.stall->normal_slope = 0.0;
  }
  std::set_union(a.attack.begin(), a.attack.end(), b.attack.begin(), b.attack.end(), std::back_inserter(mix.attack));
  for (const double angle : mix.attack) {
    const auto at = [&](const std::vector<double> Polar::*values) {
      return mean(interpolate_linear(a.attack, a.*values, angle), interpolate_linear(b.attack, b.*values, angle));
    };
    mix.lift.push_back(at(&Polar::lift)), mix.drag.push_back(at(&Polar::drag));
  }
  return mix;
}

/// How far `reynolds` is from `low` to `high`, by their logarithms.
double share_of(double reynolds, double low, double high) { return std::log(reynolds / low) / std::log(high / low); }

/// The polar of one place at a Reynolds number, beyond its tables the nearest.
Polar at_reynolds(std::span<const Polar> tables, double reynolds) {
  const auto above =
      std::find_if(tables.begin(), tables.end(), [&](const Polar& p) { return p.reynolds.value_or(0.0) >= reynolds; });
  if (tables.size() == 1 || above == tables.end()) return tables.back();
  if (above == tables.begin() || *above->reynolds == reynolds) return *above;
  const Polar& below = *(above - 1);
  const double s = share_of(reynolds, *below.reynolds, *above->reynolds);
  return between(below, *above, [s](double x, double y) { return x + s * (y - x); });
}

DynamicStallBeddoesLeishman leishman_of(const Polar& polar) {
  if (!polar.stall) return DynamicStallBeddoesLeishman::of(polar.attack, polar.lift, polar.drag);
  const StallOptions& s = *polar.stall;
  return {s.zero_lift, s.normal_slope, s.drag_0, s.critical_normal, s.critical_normal_low, true};
}

/// Polars of the same place as the first of `from`.
std::span<const Polar> group(std::span<const Polar> from) {
  const auto end = std::find_if(from.begin(), from.end(), [&](const Polar& p) { return p.place != from.front().place; });
  return from.first(std::size_t(end - from.begin()));
}

/// Those of the places next to a place, and how near it is to the upper one; one place beyond the ends.
struct Neighbours {
  std::span<const Polar> below, above;
  double share = 0.0;
};
Neighbours neighbours(std::span<const Polar> polars, double place) {
  std::span<const Polar> below;
  for (std::span<const Polar> rest = polars; !rest.empty();) {
    const std::span<const Polar> here = group(rest);
    if (here.front().place >= place) {
      if (below.empty()) return {here, here};
      const double low = below.front().place;
      return {below, here, (place - low) / (here.front().place - low)};
    }
    below = here, rest = rest.subspan(here.size());
  }
  return {below, below};
}

}  // namespace

SectionPolars::SectionPolars(std::span<const Polar> polars, double place) {
  const Neighbours n = neighbours(polars, place);
  const bool alone = n.below.data() == n.above.data(), mixed = !alone && n.share < 1.0;
  std::vector<double> numbers;
  const auto add = [&](std::span<const Polar> side) {
    if (side.size() > 1)
      for (const Polar& p : side) numbers.push_back(*p.reynolds);
  };
  if (mixed) add(n.below);
  add(n.above);
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  if (numbers.empty()) numbers.push_back(0.0);
  for (const double reynolds : numbers) {
    const Polar above = at_reynolds(n.above, reynolds);
    Polar polar = above;
    if (!alone)
      polar = between(at_reynolds(n.below, reynolds), above, [s = n.share](double x, double y) { return (1.0 - s) * x + s * y; });
    if (!mixed) polar.stall = above.stall;  // at a place of its own a section stalls as its polar says
    Table table{reynolds,          polar.attack, polar.lift, polar.drag, DynamicStallOye::of(polar.attack, polar.lift),
                leishman_of(polar)};
    tables_.push_back(std::move(table));
  }
}

SectionPolars::InUse SectionPolars::at(double reynolds) const {
  const auto above = std::find_if(tables_.begin(), tables_.end(), [&](const Table& t) { return t.reynolds >= reynolds; });
  if (above == tables_.end()) return InUse(tables_.back());
  if (above == tables_.begin() || above->reynolds == reynolds) return InUse(*above);
  const Table& below = *(above - 1);
  return {below, *above, share_of(reynolds, below.reynolds, above->reynolds)};
}

DynamicStallOye SectionPolars::InUse::oye() const {
  DynamicStallOye mix = low_->oye;
  if (share_ == 0.0) return mix;
  const DynamicStallOye& high = high_->oye;
  mix.zero_lift += share_ * (high.zero_lift - mix.zero_lift);
  mix.slope = mix.slope * high.slope == 0.0 ? 0.0 : mix.slope + share_ * (high.slope - mix.slope);
  return mix;
}

DynamicStallBeddoesLeishman SectionPolars::InUse::leishman() const {
  DynamicStallBeddoesLeishman mix = low_->leishman;
  if (share_ == 0.0) return mix;
  using Stall = DynamicStallBeddoesLeishman;
  const Stall& high = high_->leishman;
  const bool stalls = mix.slope * high.slope != 0.0;
  for (const auto value : {&Stall::zero_lift, &Stall::slope, &Stall::drag_0, &Stall::most, &Stall::least})
    mix.*value += share_ * (high.*value - mix.*value);
  if (!stalls) mix.slope = 0.0;
  return mix;
}

}  // namespace spindrift::aero
