// Lift, drag and stall of a blade element: the turbine's polars on both sides of its place along the blade, at the Reynolds
// numbers that they are given for. Equations: docs/theory/rotor_engineering.md. Used by bem.cpp; tested in
// tests/src/aero/section_polars_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "kernels/base/constants.hpp"
#include "kernels/base/half_turn.hpp"
#include "kernels/base/interpolation.hpp"
#include "kernels/rotor/blade_element.hpp"
#include "kernels/rotor/dynamic_stall_beddoes_leishman.hpp"
#include "kernels/rotor/dynamic_stall_oye.hpp"
#include "src/aero/turbine.hpp"

namespace spindrift::aero {

class SectionPolars {
 public:
  /// One polar of the element, with what it says of stall.
  struct Table {
    double reynolds = 0.0;  ///< 0: holds at any
    std::vector<double> attack, lift, drag;
    DynamicStallOye oye;
    DynamicStallBeddoesLeishman leishman;

    /// At any angle of attack [rad].
    SectionForce operator()(double attack) const;
  };

  /// The polar at one Reynolds number: straight in its logarithm between two tables. Holds as long as the SectionPolars do.
  class InUse {
   public:
    explicit InUse(const Table& only) : low_(&only), high_(&only) {}
    InUse(const Table& low, const Table& high, double share) : low_(&low), high_(&high), share_(share) {}

    SectionForce operator()(double attack) const {
      const SectionForce low = (*low_)(attack);
      if (share_ == 0.0) return low;
      const SectionForce high = (*high_)(attack);
      return {low.lift + share_ * (high.lift - low.lift), low.drag + share_ * (high.drag - low.drag)};
    }
    /// Angles, slopes and critical forces of stall go with the Reynolds number as lift does; a table without stall has none
    /// anywhere between it and its neighbours.
    DynamicStallOye oye() const;
    DynamicStallBeddoesLeishman leishman() const;

   private:
    const Table *low_, *high_;
    double share_ = 0.0;  ///< of the high one
  };

  /// `polars` by increasing place, those of one place by increasing Reynolds number. Between two places both have their share, on
  /// the angles and at the Reynolds numbers of both; beyond the first and the last place these hold.
  SectionPolars(std::span<const Polar> polars, double place);

  bool depend_on_reynolds() const { return tables_.size() > 1; }
  /// Of polars that do not depend on it.
  InUse at_any() const { return InUse(tables_.front()); }
  /// Below the least and above the greatest of the tables these hold.
  InUse at(double reynolds) const;
  double least_reynolds() const { return tables_.front().reynolds; }
  double greatest_reynolds() const { return tables_.back().reynolds; }
  std::span<const Table> tables() const { return tables_; }

 private:
  std::vector<Table> tables_;  ///< by increasing Reynolds number
};

inline SectionForce SectionPolars::Table::operator()(double angle) const {
  const double a = within_half_turn(angle);
  const std::size_t i = interval(attack, a);
  const double s = std::clamp((a - attack[i]) / (attack[i + 1] - attack[i]), 0.0, 1.0);
  return {(1.0 - s) * lift[i] + s * lift[i + 1], (1.0 - s) * drag[i] + s * drag[i + 1]};
}

}  // namespace spindrift::aero
