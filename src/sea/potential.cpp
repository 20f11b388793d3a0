// SPDX-License-Identifier: Apache-2.0
#include "src/sea/potential.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "kernels/rigid/rotation.hpp"
#include "kernels/waves/cummins.hpp"
#include "kernels/waves/morison.hpp"
#include "src/scene/error.hpp"

namespace spindrift::sea {

namespace {

/// A 6x6 matrix of [force; moment] about a point, moved to the centre of mass; `arm`: from the centre to the point, earth axes.
Matrix6 moved(const Matrix6& about_point, const Eigen::Vector3d& arm) {
  Matrix6 to_point = Matrix6::Identity();  // motion of the centre to that of the point
  to_point.topRightCorner<3, 3>() = -waves::cross_matrix(arm);
  return to_point.transpose() * about_point * to_point;
}

double root_mean_square(const std::vector<double>& values) {
  double sum = 0.0;
  for (double v : values) sum += v * v;
  return std::sqrt(sum / double(values.size()));
}

/// Of so many of the series' values at some 400 of them, which is what the fit can bear; its error is that of all values.
waves::RadiationPoles fit_some(const std::vector<double>& series, std::size_t count, double step, double tolerance) {
  constexpr std::size_t most = 400;
  const std::size_t every = std::max<std::size_t>(1, (count - 1) / most);
  std::vector<double> samples, off;
  for (std::size_t n = 0; n < count; n += every) samples.push_back(series[n]);
  waves::RadiationPoles poles = waves::fit_radiation_poles(samples, double(every) * step, tolerance);
  for (std::size_t n = 0; n < series.size(); ++n) off.push_back(series[n] - poles.at(double(n) * step));
  poles.error = root_mean_square(off);
  return poles;
}

/// Where samples of a long series miss what happens between them, those of its part that has not died away.
waves::RadiationPoles fit_poles(const std::vector<double>& series, double step, double tolerance) {
  constexpr std::size_t least = 400;
  waves::RadiationPoles poles = fit_some(series, series.size(), step, tolerance);
  if (poles.error <= tolerance || series.size() <= least) return poles;
  std::size_t lives = series.size();
  for (double rest = 0.0; lives > least; --lives)
    if ((rest += series[lives - 1] * series[lives - 1]) > 0.1 * tolerance * tolerance * double(series.size())) break;
  waves::RadiationPoles shorter = fit_some(series, lives, step, tolerance);
  return shorter.error < poles.error ? shorter : poles;
}

[[noreturn]] void refuse(const std::string& file, const std::string& key, const std::string& value, const std::string& message) {
  throw scene::SceneError({{file, 0, key, value, message}});
}

/// The largest added mass or damping of a mode by itself; zero where it is noise, as of modes that have next to none beside the
/// others of their kind (yaw of what is round).
double size(const std::vector<Matrix6>& all, int i) {
  constexpr double noise = 1e-4;
  const auto largest = [&](int mode) {
    double most = 0.0;
    for (const Matrix6& m : all) most = std::max(most, std::abs(m(mode, mode)));
    return most;
  };
  const int first = i < 3 ? 0 : 3;
  const double own = largest(i), of_kind = std::max({largest(first), largest(first + 1), largest(first + 2)});
  return own > noise * of_kind ? own : 0.0;
}

/// Added mass at infinite frequency and damping of a mode by itself are energy and its loss: neither is below zero, round-off and
/// irregular frequencies aside.
void require_passive(const PotentialOptions& o, const WamitRadiation& radiation, const Matrix6& infinite) {
  constexpr double much = 0.5;
  for (int i = 0; i < 6; ++i) {
    const double damping = size(radiation.damping, i), mass = size(radiation.added_mass, i);
    for (std::size_t k = 0; k < radiation.omega.size(); ++k)
      if (damping > 0.0 && radiation.damping[k](i, i) < -much * damping)
        refuse(
            o.radiation_file, "", "",
            fmt::format("damping of mode {} is below zero at the period of {:g} s: such waves would drive the body; look at its "
                        "sign, or leave out what irregular frequencies spoil",
                        i + 1, 2.0 * pi / radiation.omega[k]));
    if (mass > 0.0 && infinite(i, i) < -much * mass)
      refuse(
          o.radiation_file, "", "",
          fmt::format("added mass of mode {} at infinite frequency is below zero: water at rest would give energy; look at its "
                      "sign, or give the row of period 0",
                      i + 1));
  }
}

/// Turns force and moment, or displacement and rotation, about the vertical.
Vector6 yawed(const Vector6& v, double yaw) {
  const Eigen::AngleAxisd turn(yaw, Eigen::Vector3d::UnitZ());
  Vector6 turned;
  turned << turn * v.head<3>(), turn * v.tail<3>();
  return turned;
}

}  // namespace

PoseOfPoint pose_of(const Motion& now, const Motion& initial, const Eigen::Vector3d& point) {
  PoseOfPoint pose;
  pose.point = now.point(point);
  pose.displacement << pose.point - initial.point(point), tilt_and_yaw(now.attitude * initial.attitude.conjugate());
  pose.velocity << now.point_velocity(point), now.omega_earth();
  return pose;
}

PotentialBody::PotentialBody(const PotentialOptions& o, const SeaEnvironment& environment, const Motion& initial,
                             const std::vector<waves::Component>& waves, double step_s)
    : environment_(environment),
      initial_(initial),
      point_(initial.attitude.conjugate() * (o.point_m - initial.position)),
      step_(step_s) {
  const WamitScale scale{o.length_m, environment.water_density, environment.gravity};
  make_radiation(o, read_radiation(o.radiation_file, scale));
  if (!o.hydrostatics_file.empty()) {
    linear_hydrostatics_ = true;
    stiffness_ = read_hydrostatics(o.hydrostatics_file, scale);
    const double lift = environment.water_density * environment.gravity * *o.volume_m3;
    const Eigen::Vector3d at(o.buoyancy_centre_m[0], o.buoyancy_centre_m[1], 0.0);  // its height is in the stiffness
    buoyancy_ << 0.0, 0.0, lift, (at - Eigen::Vector3d(o.point_m.x(), o.point_m.y(), 0.0)).cross(Eigen::Vector3d(0.0, 0.0, lift));
  }
  if (waves.empty()) return;
  if (o.drift != "none" || !o.sum_frequency_file.empty()) second_order_.emplace(o, scale, waves);
  const WamitExcitation excitation = read_excitation(o.excitation_file, scale);
  require_headings(o.excitation_file, excitation.heading, waves);
  for (std::size_t k = excitation.omega.size(); k-- > 0;)  // some files begin with rows of zeros
    if (const double heave = std::abs(excitation.force[k * excitation.heading.size()][2]); heave > 0.0)
      long_waves_ = {excitation.omega[k], heave};
  double energy = 0.0, lost = 0.0;
  for (const waves::Component& wave : waves) {
    energy += wave.amplitude * wave.amplitude;
    if (wave.angular_frequency > excitation.omega.back() * (1.0 + 1e-9)) lost += wave.amplitude * wave.amplitude;
  }
  unexcited_ = {energy > 0.0 ? lost / energy : 0.0, 2.0 * pi / excitation.omega.back()};
  if (constexpr double most = 0.5; unexcited_.share > most)
    refuse(
        "", "waves.period_s", "",
        fmt::format("{:.0f} % of the waves' energy is in shorter waves than any of {}, whose shortest is {:.4g} s: they would "
                    "press on nothing",
                    100.0 * unexcited_.share, std::filesystem::path(o.excitation_file).filename().string(), unexcited_.period_s));
  for (const waves::Component& wave : waves) {
    const double along = std::cos(wave.direction) * o.point_m.x() + std::sin(wave.direction) * o.point_m.y();
    exciting_.push_back({wave.angular_frequency, wave.phase + wave.wave_number * along,
                         wave.amplitude * excitation.at(wave.angular_frequency, wave.direction)});
  }
}

/// Where a mode's damping ends before it has died out the memory lacks a part, and what the file has at infinite frequency no
/// longer goes with it.
void PotentialBody::note_cut_damping(const WamitRadiation& radiation) {
  for (int i = 0; i < 6; ++i)
    if (const double most = size(radiation.damping, i); most > 0.0)
      if (const double share = std::abs(radiation.damping.back()(i, i)) / most; share > cut_damping_.share)
        cut_damping_ = {i, share, radiation.omega.back()};
}

/// Added mass at infinite frequency, and the memory: of each pair of modes that the file's damping is more than round-off for.
void PotentialBody::make_radiation(const PotentialOptions& o, const WamitRadiation& radiation) {
  const std::size_t steps = o.radiation == "none" ? 0 : std::size_t(std::lround(o.memory_s / step_));
  if (o.radiation != "none" && steps < 2)
    refuse("", "sea.potential.memory_s", fmt::format("{:g}", o.memory_s),
           fmt::format("must be at least two steps of {:g} s: the water would remember nothing, as with radiation none", step_));
  note_cut_damping(radiation);
  const bool whole = radiation.infinite && cut_damping_.share <= died_out;
  std::vector<double> damping(radiation.omega.size()), added_mass(radiation.omega.size());
  std::vector<RetardationSeries> all;
  std::vector<StateSpaceMemory::Fit> fits;
  Matrix6 sizes = Matrix6::Zero();
  double largest[6] = {};
  for (const Matrix6& b : radiation.damping)
    for (int i = 0; i < 6; ++i) largest[i] = std::max(largest[i], std::abs(b(i, i)));
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      double most = 0.0;
      for (std::size_t k = 0; k < damping.size(); ++k) {
        damping[k] = 0.5 * (radiation.damping[k](i, j) + radiation.damping[k](j, i));
        added_mass[k] = 0.5 * (radiation.added_mass[k](i, j) + radiation.added_mass[k](j, i));
        most = std::max(most, std::abs(damping[k]));
      }
      // Below this share of the modes' own damping a coefficient is the boundary elements' round-off.
      constexpr double noise = 1e-6;
      const bool remembers = steps > 0 && most > noise * std::sqrt(largest[i] * largest[j]) && most > 0.0;
      infinite_(i, j) =
          radiation.infinite ? 0.5 * ((*radiation.infinite)(i, j) + (*radiation.infinite)(j, i)) : added_mass.back();
      if (!remembers) continue;
      RetardationSeries series{i, j, std::vector<double>(steps + 1)};
      for (std::size_t n = 0; n <= steps; ++n) series.values[n] = waves::retardation(radiation.omega, damping, double(n) * step_);
      if (i == j) note_cut(i, series.values);
      if (!whole) infinite_(i, j) = waves::infinite_added_mass(radiation.omega, added_mass, series.values, step_);
      all.push_back(std::move(series));
    }
  require_passive(o, radiation, infinite_);
  if (steps == 0) return;
  if (o.radiation == "convolution") {
    memory_.emplace<ConvolutionMemory>(std::move(all), steps, step_);
    return;
  }
  for (const RetardationSeries& s : all)
    if (s.i == s.j) sizes(s.i, s.i) = root_mean_square(s.values);
  for (const RetardationSeries& s : all) {
    // The other half of a pair has the same memory. A pair is as large as its modes' own memory lets it be.
    const auto mirror = std::ranges::find_if(fits, [&](const auto& f) { return f.i == s.j && f.j == s.i; });
    const double size = std::sqrt(sizes(s.i, s.i) * sizes(s.j, s.j));
    StateSpaceMemory::Fit fit{s.i, s.j, {}};
    if (mirror != fits.end())
      fit.poles = mirror->poles;
    else
      fit.poles = fit_poles(s.values, step_, o.fit_tolerance * size);
    if (!(fit.poles.error <= o.fit_tolerance * size))
      refuse(o.radiation_file, "", "",
             "the memory of modes " + std::to_string(s.i + 1) + " and " + std::to_string(s.j + 1) + " is off by " +
                 std::to_string(fit.poles.error / size) +
                 " of itself with 24 poles: take sea.potential.radiation \"convolution\", or a larger fit_tolerance");
    if (!fit.poles.pole.empty()) fits.push_back(std::move(fit));
  }
  memory_.emplace<StateSpaceMemory>(std::move(fits));
}

/// By the last tenth of the memory, which may swing.
void PotentialBody::note_cut(int mode, std::span<const double> values) {
  const auto largest = [](std::span<const double> some) {
    double most = 0.0;
    for (const double k : some) most = std::max(most, std::abs(k));
    return most;
  };
  const double whole = largest(values), end = largest(values.last(values.size() / 10 + 1));
  if (end > cut_.share * whole) cut_ = {mode, end / whole};
}

std::size_t PotentialBody::states() const {
  const auto* fitted = std::get_if<StateSpaceMemory>(&memory_);
  return fitted ? fitted->states() : 0;
}

Wrench PotentialBody::load(double t, double ramp, const Motion& motion) const {
  const PoseOfPoint pose = pose_of(motion, initial_, point_);
  // Still water knows no compass: its stiffness, and the arm of its buoyancy, turn with the hull.
  const double yaw = pose.displacement[5];
  Vector6 force = yawed(buoyancy_ - stiffness_ * yawed(pose.displacement, -yaw), yaw);
  if (recalled_)
    std::visit(
        [&](const auto& memory) {
          if constexpr (requires { memory.force(t, pose.velocity); }) force += memory.force(t, pose.velocity);
        },
        memory_);
  for (const Exciting& e : exciting_) {
    // Re{X exp(i (w t - phase))}
    const double angle = e.omega * t - e.phase, c = std::cos(angle), s = std::sin(angle);
    force += ramp * (e.force.real() * c - e.force.imag() * s);
  }
  if (second_order_ && ramp > 0.0) force += ramp * ramp * second_order_->at(t);
  Wrench load{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), motion.position};
  load.add_force(force.head<3>(), pose.point);
  load.add_moment(force.tail<3>());
  return load;
}

void PotentialBody::add_added_mass(const Motion& motion, Matrix6& mass) const {
  mass += moved(infinite_, motion.point(point_) - motion.position);
}

std::size_t PotentialBody::memory_size() const {
  return std::visit(
      [](const auto& memory) -> std::size_t {
        if constexpr (requires { memory.size(); })
          return memory.size();
        else
          return 0;
      },
      memory_);
}

void PotentialBody::begin(double t, const Motion& motion, std::span<double> memory) const {
  const Vector6 velocity = pose_of(motion, initial_, point_).velocity;
  std::visit(
      [&](const auto& kind) {
        if constexpr (requires { kind.size(); }) kind.begin(t, velocity, memory);
      },
      memory_);
}

void PotentialBody::recall(std::span<const double> memory) {
  recalled_ = !memory.empty();
  if (!recalled_) return;
  std::visit(
      [&](auto& kind) {
        if constexpr (requires { kind.size(); }) kind.recall(memory);
      },
      memory_);
}

void PotentialBody::remember(double t, const Motion& motion, std::span<double> memory) const {
  const Vector6 velocity = pose_of(motion, initial_, point_).velocity;
  std::visit(
      [&](const auto& kind) {
        if constexpr (requires { kind.size(); }) kind.remember(t, velocity, memory);
      },
      memory_);
}

}  // namespace spindrift::sea
