// SPDX-License-Identifier: Apache-2.0
#include "src/run/flow_columns.hpp"

#include <fmt/format.h>

#include <cmath>

#include "kernels/base/constants.hpp"

namespace spindrift::run {

using coupling::Table, io::ColumnOf;

namespace {

Table<aero::PseudoRow> pseudo_step_columns() {
  using Of = const aero::PseudoRow&;
  static constexpr ColumnOf<aero::PseudoRow> table[] = {
      {"fx_N", "N", "force of the air on the patches with loads along x, pressure above the undisturbed one",
       [](Of p) { return p.force[0]; }},
      {"fy_N", "N", "the same along y", [](Of p) { return p.force[1]; }},
      {"fz_N", "N", "the same along z", [](Of p) { return p.force[2]; }},
      {"density_residual", "kg/(m3 s)", "root mean square over the cells", [](Of p) { return p.density_residual; }},
      {"scaled_residual", "-", "norm of the residual of the mean flow in units of the undisturbed one",
       [](Of p) { return p.mean_residual; }},
      {"turbulence_residual", "-", "the same of the turbulence model", [](Of p) { return p.model_residual; }},
      {"cfl", "-", "CFL number of the pseudo-step", [](Of p) { return p.cfl; }},
      {"krylov_steps", "-", "iterations of the linear solver in the pseudo-step before", [](Of p) { return double(p.krylov); }},
      {"pseudo_steps", "-", "pseudo-steps: so far (steady), of the window (unsteady)", [](Of p) { return double(p.step + 1); }},
      {"update_fraction", "-", "part of the last update that was made: less than 1 where a cell's was too large",
       [](Of p) { return p.fraction; }},
      {"limited_cells", "-", "cells whose pressure, temperature or velocity the last update would have changed by too much",
       [](Of p) { return p.limited; }},
      {"clipped_cells", "-", "cells in which the last update of turbulence was shortened to keep it above its bound",
       [](Of p) { return p.clipped; }},
      {"balance_drop", "-", "norm of all scaled flux balances over that of the start", [](Of p) { return p.balance_drop; }}};
  return table;
}

Table<double> unsteady_columns() {
  static constexpr ColumnOf<double> table[] = {{"unconverged_windows", "-",
                                                "windows so far that spent their pseudo-steps without the drop",
                                                [](const double& n) { return n; }}};
  return table;
}

Table<TimeSteps> time_columns() {
  using Of = const TimeSteps&;
  static constexpr ColumnOf<TimeSteps> table[] = {
      {"time_error", "-",
       "largest estimate of a step's error in time, momentum over what the air has beyond the undisturbed stream; 0 where there "
       "are too few steps before it",
       [](Of s) { return s.error; }},
      {"time_steps", "-", "physical steps of the window", [](Of s) { return double(s.count); }}};
  return table;
}

Table<Coefficients> coefficient_columns() {
  using Of = const Coefficients&;
  static constexpr ColumnOf<Coefficients> table[] = {
      {"lift_coefficient", "-",
       "force across the wind in its vertical plane, on dynamic pressure and aero.flow.reference_area_m2",
       [](Of c) { return c.lift; }},
      {"drag_coefficient", "-", "force along the wind, likewise", [](Of c) { return c.drag; }}};
  return table;
}

Table<WallMotion> wall_motion_columns() {
  using Of = const WallMotion&;
  static constexpr ColumnOf<WallMotion> table[] = {
      {"pitch_deg", "deg", "angle of the walls that move, about their axis", [](Of m) { return m.pitch_deg; }},
      {"heave_x_m", "m", "their shift along x", [](Of m) { return m.shift[0]; }},
      {"heave_y_m", "m", "their shift along y", [](Of m) { return m.shift[1]; }},
      {"heave_z_m", "m", "their shift along z", [](Of m) { return m.shift[2]; }}};
  return table;
}

}  // namespace

FlowColumns::FlowColumns(io::History& history, const aero::ResolvedRotor* rotor, const aero::Actuator* actuator,
                         const aero::GridMotion* motion, const aero::FlowSetting& setting)
    : rotor_(rotor),
      actuator_(actuator),
      motion_(motion),
      march_(history, "flow.", pseudo_step_columns()),
      mass_(history, "flow.", coupling::mass_columns()) {
  if (rotor_ || actuator_) {
    rotor_columns_.emplace(history, "rotor.", coupling::rotor_columns());
    for (int b = 1; b <= (rotor_ ? rotor_->made().blades() : actuator_->history_blades()); ++b)
      blades_.emplace_back(history, fmt::format("rotor.blade_{}.", b), coupling::blade_columns());
  } else {
    coefficients_.emplace(history, "flow.", coefficient_columns());
  }
  if (setting.time_order > 0) unsteady_.emplace(history, "flow.", unsteady_columns());
  if (setting.time_tolerance) time_steps_.emplace(history, "flow.", time_columns());
  if (motion_) motion_columns_.emplace(history, "flow.", wall_motion_columns());
}

void FlowColumns::fill(std::span<double> row, double time, const aero::FlowSetting& s, const aero::PseudoRow& p,
                       const aero::FlowOptions& o, const Eigen::Vector3d& wind, long unconverged, const TimeSteps& steps) const {
  march_.fill(row, p);
  mass_.fill(row, p.mass);
  if (unsteady_) unsteady_->fill(row, double(unconverged));
  if (time_steps_) time_steps_->fill(row, steps);
  if (rotor_) {
    const double turns = rotor_->pose().azimuth / (2.0 * pi);
    rotor_columns_->fill(row, {rotor_->load(p), 360.0 * (turns - std::floor(turns)), rotor_->pose().speed * 30.0 / pi});
    for (std::size_t b = 0; b < blades_.size(); ++b) blades_[b].fill(row, rotor_->blade_load(int(b) + 1, p));
  } else if (actuator_) {
    const aero::DiscMotion& now = actuator_->motion();
    const double turns = now.azimuth / (2.0 * pi);
    rotor_columns_->fill(row, {actuator_->load(p), 360.0 * (turns - std::floor(turns)), now.omega.dot(now.axis) * 30.0 / pi});
    for (std::size_t b = 0; b < blades_.size(); ++b) blades_[b].fill(row, actuator_->blade_load(int(b) + 1, p));
  } else {
    const Eigen::Vector3d f(p.force[0], p.force[1], p.force[2]), along = wind.normalized();
    Eigen::Vector3d across = Eigen::Vector3d::UnitZ() - along.z() * along;
    if (across.norm() > 0.0) across.normalize();
    const double unit = 0.5 * gas::density(s.gas, s.stream) * s.speed * s.speed * reference_area(o);
    coefficients_->fill(row, {f.dot(across) / unit, f.dot(along) / unit});
  }
  if (!motion_) return;
  const aero::TurnAndShift now = motion_->at(time);
  motion_columns_->fill(row, {now.turn.dot(motion_->axis()) / radians_per_degree, now.shift});
}

std::vector<io::ColumnSection> all_columns() {
  std::vector<io::ColumnSection> sections = coupling::column_sections();
  sections.push_back(section_of("flow.", "the air alone", pseudo_step_columns()));
  sections.push_back(section_of("flow.", "the air alone: balance of its mass", coupling::mass_columns()));
  sections.push_back(section_of("flow.", "the air alone, unsteady", unsteady_columns()));
  sections.push_back(section_of("flow.", "the air alone, where aero.flow.time_tolerance is given", time_columns()));
  sections.push_back(section_of("flow.", "the air alone, without a rotor", coefficient_columns()));
  sections.push_back(section_of("flow.", "the air alone, with walls that move", wall_motion_columns()));
  return sections;
}

}  // namespace spindrift::run
