// SPDX-License-Identifier: Apache-2.0
#include "src/run/flow_columns.hpp"

#include <fmt/format.h>

#include <cmath>

#include "kernels/base/constants.hpp"

namespace spindrift::run {

FlowColumns::FlowColumns(io::History& history, const aero::ResolvedRotor* rotor, const aero::GridMotion* motion, bool steady)
    : rotor_(rotor), motion_(motion), steady_(steady) {
  if (rotor_) add_rotor(history);
  if (motion_) add_motion(history);
  const char* axes[3] = {"x", "y", "z"};
  for (std::size_t d = 0; d < 3; ++d)
    force_[d] = history.add({fmt::format("flow.f{}_N", axes[d]), "N",
                             "Force of the air on the patches with loads, pressure above the undisturbed one."});
  if (!rotor_)
    lift_ = history.add({"flow.lift_coefficient", "-",
                         "Force across the wind in its vertical plane, on dynamic pressure and aero.flow.reference_area_m2."});
  if (!rotor_) drag_ = history.add({"flow.drag_coefficient", "-", "Force along the wind, likewise."});
  residual_ = history.add({"flow.density_residual", "kg/(m3 s)", "Root mean square over the cells."});
  momentum_ =
      history.add({"flow.scaled_residual", "-", "Norm of the residual of the mean flow in units of the undisturbed one."});
  model_ = history.add({"flow.turbulence_residual", "-", "The same of the turbulence model."});
  cfl_ = history.add({"flow.cfl", "-", "CFL number of the pseudo-step."});
  krylov_ = history.add({"flow.krylov_steps", "-", "Iterations of the linear solver in the pseudo-step before."});
  steps_ = history.add({"flow.pseudo_steps", "-", "Pseudo-steps: so far (steady), of the window (unsteady)."});
  fraction_ =
      history.add({"flow.update_fraction", "-", "Of the last update what was made: less than 1 where a cell's was too large."});
  balance_ = history.add({"flow.balance_drop", "-", "Norm of all scaled flux balances over that of the start."});
  if (!steady_)
    unconverged_ =
        history.add({"flow.unconverged_windows", "-", "Windows so far that spent their pseudo-steps without the drop."});
}

void FlowColumns::add_rotor(io::History& history) {
  thrust_ = history.add({"rotor.thrust_N", "N", "Force of the air on the blades along the rotor axis, positive downwind."});
  torque_ = history.add(
      {"rotor.torque_N_m", "N m", "Moment of the air on the blades about the rotor axis, positive where it drives the rotor."});
  power_ = history.add({"rotor.power_W", "W", "Torque times rotor speed."});
  azimuth_ = history.add({"rotor.azimuth_deg", "deg", "Of blade 1 from upright, 0 to 360."});
  rpm_ = history.add({"rotor.rpm", "rpm", "Rotor speed."});
  for (int b = 1; b <= rotor_->grid_blades(); ++b)
    blades_.push_back(
        {history.add({fmt::format("rotor.blade_{}.thrust_N", b), "N", "Of one blade of the grid: its force along the axis."}),
         history.add(
             {fmt::format("rotor.blade_{}.torque_N_m", b), "N m", "Of one blade of the grid: its moment about the axis."})});
}

void FlowColumns::fill_rotor(std::span<double> row, const aero::PseudoRow& p) const {
  const aero::RotorLoad load = rotor_->load(p);
  const double turns = rotor_->pose().azimuth / (2.0 * pi);
  row[thrust_] = load.thrust, row[torque_] = load.torque, row[power_] = load.power;
  row[azimuth_] = 360.0 * (turns - std::floor(turns)), row[rpm_] = rotor_->pose().speed * 30.0 / pi;
  for (std::size_t b = 0; b < blades_.size(); ++b) {
    const aero::RotorLoad blade = rotor_->blade_load(int(b) + 1, p);
    row[blades_[b][0]] = blade.thrust, row[blades_[b][1]] = blade.torque;
  }
}

void FlowColumns::add_motion(io::History& history) {
  pitch_ = history.add({"flow.pitch_deg", "deg", "Angle of the walls that move, about their axis."});
  for (std::size_t d = 0; d < 3; ++d) heave_[d] = history.add({fmt::format("flow.heave_{}_m", "xyz"[d]), "m", "Their shift."});
}

void FlowColumns::fill_motion(std::span<double> row, double time) const {
  const aero::TurnAndShift now = motion_->at(time);
  row[pitch_] = now.turn.dot(motion_->axis()) / radians_per_degree;
  for (std::size_t d = 0; d < 3; ++d) row[heave_[d]] = now.shift[Eigen::Index(d)];
}

void FlowColumns::fill(std::span<double> row, double time, const aero::FlowSetting& s, const aero::PseudoRow& p,
                       const aero::FlowOptions& o, const Eigen::Vector3d& wind, long unconverged) const {
  if (motion_) fill_motion(row, time);
  const Eigen::Vector3d f(p.force[0], p.force[1], p.force[2]), along = wind.normalized();
  Eigen::Vector3d across = Eigen::Vector3d::UnitZ() - along.z() * along;
  if (across.norm() > 0.0) across.normalize();
  const double unit = 0.5 * gas::density(s.gas, s.stream) * s.speed * s.speed * o.reference_area_m2;
  for (std::size_t d = 0; d < 3; ++d) row[force_[d]] = p.force[d];
  if (rotor_)
    fill_rotor(row, p);
  else
    row[lift_] = f.dot(across) / unit, row[drag_] = f.dot(along) / unit;
  row[residual_] = p.density_residual, row[momentum_] = p.mean_residual, row[model_] = p.model_residual;
  row[cfl_] = p.cfl, row[krylov_] = p.krylov, row[steps_] = p.step + 1, row[fraction_] = p.fraction,
  row[balance_] = p.balance_drop;
  if (!steady_) row[unconverged_] = double(unconverged);
}

}  // namespace spindrift::run
