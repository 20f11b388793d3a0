// SPDX-License-Identifier: Apache-2.0
#include "src/aero/wind.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "kernels/base/constants.hpp"
#include "kernels/base/interpolation.hpp"
#include "kernels/base/smooth_step.hpp"
#include "kernels/rotor/gusts_iec.hpp"
#include "src/aero/turbulence_box.hpp"
#include "src/scene/columns.hpp"
#include "src/scene/error.hpp"

namespace spindrift::aero {

/// A wind in time from a file.
struct WindTable {
  std::vector<double> time, speed, direction, vertical;
};

namespace {

WindTable read_wind_table(const std::string& path) {
  const scene::Columns file = scene::read_columns(path);
  file.allow_only({"time_s", "speed_m_s", "direction_deg", "vertical_m_s"});
  file.require_rows(2);
  file.require_increasing("time_s", "time");
  const auto column = [&](const char* name, double unit) {
    std::vector<double> values;
    if (file.has(name))
      for (double v : file[name]) values.push_back(unit * v);
    return values;
  };
  for (std::size_t i = 0; i < file.rows(); ++i)
    if (file["speed_m_s"][i] < 0.0) file.fail(int(i), "speed_m_s must not be negative");
  if (file.has("direction_deg"))  // straight lines know no full circle
    for (std::size_t i = 1; i < file.rows(); ++i)
      if (const double from = file["direction_deg"][i - 1], to = file["direction_deg"][i]; std::abs(to - from) > 180.0)
        file.fail(int(i),
                  fmt::format("direction_deg goes from {:g} to {:g}, by more than half a circle: write {:g} to go the short "
                              "way, or rows between to go the long one",
                              from, to, to + std::copysign(360.0 * std::round(std::abs(from - to) / 360.0), from - to)));
  return {column("time_s", 1.0), column("speed_m_s", 1.0), column("direction_deg", radians_per_degree),
          column("vertical_m_s", 1.0)};
}

bool rises(const WindTable& table) {
  return std::ranges::any_of(table.vertical, [](double v) { return v != 0.0; });
}

}  // namespace

class WindInTime {
 public:
  WindInTime(const WindOptions& options, const WindSite& site)
      : speed_(starting_speed(options)), direction_(starting_direction(options)), incidence_(options.incidence), site_(site) {
    if (!options.table.empty()) table_ = read_wind_table(options.table);
    if (options.event) {
      event_ = *options.event;
      iec_ = {speed_ * wind_profile(options).share(site.hub.z()), site.hub.z(), site.diameter, event_->reference_wind_m_s,
              event_->reference_intensity};
    }
    if (options.turbulence) make_box(*options.turbulence, options), take_means(wind_profile(options));
  }

  Eigen::Vector3d at(double t, const Eigen::Vector3d& point, const WindProfile& profile) const {
    const Uniform u = uniform(t);
    const double added = u.added + shear(t, u.direction, point);
    if (!has_box()) return (profile.share(point.z()) * u.speed + added) * blowing(u.direction, incidence_) + u.vertical * up();
    const Eigen::Vector3d gust = box_.at(time_in_box(t, point), across(direction_).dot(point - site_.hub), point.z());
    const double mean = box_.has_mean ? 0.0 : profile.share(point.z()) * u.speed + added;
    return (mean + gust.x()) * along(u.direction) + gust.y() * across(u.direction) + (u.vertical + gust.z()) * up();
  }

  Eigen::Vector3d common(double t, const Eigen::Vector3d& point, const WindProfile& profile) const {
    const Uniform u = uniform(t);
    const double z = point.z(), side = across(u.direction).dot(point - site_.hub);
    const double added = u.added + share_beside(side, z) * shear(t, u.direction, held_inside(side, z, u.direction));
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    if (has_box()) mean = mean_of_planes_.at(time_in_box(t, site_.hub), 0.0, 0.0);
    return (profile.share(z) * u.speed + added + mean.x()) * blowing(u.direction, incidence_) + mean.y() * across(u.direction) +
           (u.vertical + mean.z()) * up();
  }

  Eigen::Vector3d fluctuation(double t, const Eigen::Vector3d& point, const WindProfile& profile) const {
    if (!has_box()) return Eigen::Vector3d::Zero();
    const double z = point.z(), side = across(direction_).dot(point - site_.hub), share = share_beside(side, z);
    if (share == 0.0) return Eigen::Vector3d::Zero();
    const double time = time_in_box(t, point),
                 mean = box_.has_mean ? profile.share(std::clamp(z, bottom(), top())) * speed_ : 0.0;
    const Eigen::Vector3d gust = box_.at(time, side, z) - mean_of_planes_.at(time, 0.0, 0.0);
    return share * ((gust.x() - mean) * along(direction_) + gust.y() * across(direction_) + gust.z() * up());
  }

  bool has_box() const { return !box_.values.empty(); }
  double carrier() const { return box_.wind; }

  std::string spread() const {
    if (asked_ == 0.0) return "";
    double sum = 0.0;  // of a mean of zero
    for (std::size_t n = 0; n < box_.values.size(); n += 3) sum += double(box_.values[n]) * box_.values[n];
    const double has = std::sqrt(3.0 * sum / double(box_.values.size()));
    if (std::abs(has / asked_ - 1.0) <= 0.02) return "";
    return fmt::format(
        "standard deviation along the wind {:.4g} m/s, asked for {:.4g}: the box has nothing slower than duration_s or faster "
        "than two step_s",
        has, asked_);
  }

 private:
  static Eigen::Vector3d along(double direction) { return blowing(direction, 0.0); }
  static Eigen::Vector3d across(double direction) { return {-std::sin(direction), std::cos(direction), 0.0}; }
  static Eigen::Vector3d up() { return Eigen::Vector3d::UnitZ(); }

  /// What events and tables make of the wind, the same everywhere.
  struct Uniform {
    double speed, direction, vertical, added;
  };
  Uniform uniform(double t) const {
    Uniform u{speed_, direction_, 0.0, 0.0};
    if (!table_.time.empty()) {
      u.speed = interpolate_linear(table_.time, table_.speed, t);
      if (!table_.direction.empty()) u.direction = interpolate_linear(table_.time, table_.direction, t);
      if (!table_.vertical.empty()) u.vertical = interpolate_linear(table_.time, table_.vertical, t);
    }
    if (!event_) return u;
    const double since = t - event_->start_s, sense = event_->reversed ? -1.0 : 1.0;
    switch (event_->what) {
      case WindEvent::step:
        if (since >= 0.0) u.speed += event_->speed_change_m_s, u.direction += event_->direction_change;
        break;
      case WindEvent::ramp: {
        const double share = std::clamp(since / event_->duration_s, 0.0, 1.0);
        u.speed += share * event_->speed_change_m_s, u.direction += share * event_->direction_change;
        break;
      }
      case WindEvent::eog:
        u.added = iec::eog(iec_, since);
        break;
      case WindEvent::ecd:
        u.added = iec::ecd_speed(since), u.direction += sense * iec::ecd_direction(iec_, since);
        break;
      case WindEvent::edc:
        u.direction += sense * iec::edc_direction(iec_, since);
        break;
      case WindEvent::ews_vertical:
      case WindEvent::ews_horizontal:
        break;
    }
    return u;
  }
  bool is_shear() const {
    return event_ && (event_->what == WindEvent::ews_vertical || event_->what == WindEvent::ews_horizontal);
  }
  /// Extreme shear: added to the speed.
  double shear(double t, double direction, const Eigen::Vector3d& point) const {
    if (!is_shear()) return 0.0;
    const Eigen::Vector3d from_hub = point - site_.hub;
    const double offset = event_->what == WindEvent::ews_vertical ? from_hub.z() : across(direction).dot(from_hub);
    return (event_->reversed ? -1.0 : 1.0) * iec::ews(iec_, offset, t - event_->start_s);
  }
  /// Frozen turbulence: what is downwind passed earlier.
  double time_in_box(double t, const Eigen::Vector3d& point) const {
    const double later = along(direction_).dot(point - origin_) / box_.wind;
    return t + start_ + lead_ / box_.wind - later;
  }
  /// Sides, bottom and top of what varies over the rotor [m].
  double half_width() const { return has_box() ? 0.5 * box_.width() : 0.55 * site_.diameter; }
  double bottom() const { return has_box() ? box_.bottom : site_.hub.z() - half_width(); }
  double top() const { return has_box() ? box_.top() : site_.hub.z() + half_width(); }
  /// Of what varies over the rotor: one there, none a quarter of the diameter beside it.
  double share_beside(double side, double z) const {
    const double beside = std::max({std::abs(side) - half_width(), bottom() - z, z - top(), 0.0});
    return smooth_step(1.0 - beside / (0.25 * site_.diameter));
  }
  Eigen::Vector3d held_inside(double side, double z, double direction) const {
    const Eigen::Vector3d middle(site_.hub.x(), site_.hub.y(), std::clamp(z, bottom(), top()));
    return middle + std::clamp(side, -half_width(), half_width()) * across(direction);
  }

  /// Mean of each plane of the box along and across the wind, without the wind that the profile has there. Up there is none: what
  /// rises or sinks over the whole grid would have to come out of the ground, and slowed the wind on its way to the rotor.
  void take_means(const WindProfile& profile) {
    mean_of_planes_ = {.across = 1, .up = 1, .steps = box_.steps, .step_s = box_.step_s, .periodic = box_.periodic};
    const std::size_t points = std::size_t(box_.across) * std::size_t(box_.up);
    double carried = 0.0;
    for (int row = 0; box_.has_mean && row < box_.up; ++row)
      carried += speed_ * profile.share(box_.bottom + row * box_.up_m) / box_.up;
    for (int step = 0; step < box_.steps; ++step) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (std::size_t p = 0; p < points; ++p)
        for (std::size_t c = 0; c < 3; ++c) sum[Eigen::Index(c)] += box_.values[(std::size_t(step) * points + p) * 3 + c];
      sum /= double(points), sum.x() -= carried;
      for (const double mean : {sum.x(), sum.y(), 0.0}) mean_of_planes_.values.push_back(float(mean));
    }
  }

  /// Blades of a rotor that faces the wind's side reach upwind by its radius.
  void require_box_until_end() const {
    const double before = start_ + (lead_ + site_.upwind + 0.5 * site_.diameter) / box_.wind,
                 last = (box_.steps - 1) * box_.step_s;
    constexpr double float_rounding = 1e-6;  // of the file's step
    if (box_.periodic || before + site_.t_end <= last * (1.0 + float_rounding)) return;
    throw scene::SceneError(
        {{"", 0, "wind.turbulence.file", "",
          fmt::format(
              "ends after {:.6g} s and does not repeat (format 7): at t = 0 the wind is {:.4g} s into it, by start_s, half "
              "its width and what is upwind of the hub, so time.end_s = {:g} must be at most {:.6g}, or make a longer or "
              "periodic file",
              last, before, site_.t_end, std::max(last - before, 0.0))}});
  }

  void make_box(const TurbulenceOptions& o, const WindOptions& wind) {
    start_ = o.start_s, origin_ = site_.hub;
    const double hub_wind = speed_ * wind_profile(wind).share(site_.hub.z());
    const auto refuse = [](const std::string& what) { throw scene::SceneError({{"", 0, "wind.turbulence", "", what}}); };
    if (o.model != TurbulenceModel::bts && !(hub_wind > 0.0)) refuse("needs wind.speed_m_s above zero, which carries the box");
    switch (o.model) {
      case TurbulenceModel::bts:
        box_ = box_of(read_bts(o.file));
        break;
      case TurbulenceModel::mann:
        box_ =
            read_mann({o.files[0], o.files[1], o.files[2]},
                      {{int(o.points[0]), int(o.points[1]), int(o.points[2])}, {o.spacing_m[0], o.spacing_m[1], o.spacing_m[2]}},
                      hub_wind, site_.hub.z());
        break;
      case TurbulenceModel::kaimal: {
        const double round = 1.1 * site_.diameter, width = o.width_m.value_or(round + site_.across),
                     height = o.width_m.value_or(round + site_.up);
        const double sigma = o.extreme ? iec::sigma_extreme(hub_wind, o.reference_intensity, 0.2 * o.reference_wind_m_s)
                                       : iec::sigma_normal(hub_wind, o.reference_intensity);
        asked_ = o.sigma_m_s.value_or(sigma);
        box_ = kaimal_box({o.points_across, o.points_up, width, height, o.duration_s, o.step_s, hub_wind, site_.hub.z(), asked_,
                           std::uint64_t(o.seed)});
        break;
      }
    }
    // Periodic files as InflowWind has them. Else half the width ahead of the hub, so that no time is below zero.
    const bool at_first_plane = o.model != TurbulenceModel::kaimal && box_.periodic;
    if (at_first_plane) origin_.setZero();
    lead_ = at_first_plane ? 0.0 : 0.5 * box_.width();
    const double radius = 0.5 * site_.diameter, above = radius + 0.5 * site_.up;
    if (0.5 * box_.width() < radius + 0.5 * site_.across || box_.bottom > site_.hub.z() - above ||
        box_.top() < site_.hub.z() + above)
      refuse(fmt::format(
          "the box is {:.4g} m wide and goes from z = {:.4g} to {:.4g} m: it does not cover the rotor{} of {:.4g} m "
          "at {:.4g} m{}",
          box_.width(), box_.bottom, box_.top(), site_.across + site_.up > 0.0 ? "s" : "", site_.diameter, site_.hub.z(),
          site_.across > 0.0 ? fmt::format(", whose hubs are {:.4g} m apart across the wind", site_.across) : ""));
    require_box_until_end();
  }

  double speed_, direction_, incidence_, start_ = 0.0;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();  ///< from where distances along the wind count
  double lead_ = 0.0;                                 ///< from there to the box's first plane at the start [m]
  double asked_ = 0.0;                                ///< standard deviation of a box made here [m/s]
  WindSite site_;
  WindTable table_;
  std::optional<WindEventOptions> event_;
  iec::Site iec_;
  TurbulenceBox box_, mean_of_planes_;
};

Eigen::Vector3d Wind::changing(double t, const Eigen::Vector3d& point) const { return in_time->at(t, point, profile); }
Eigen::Vector3d Wind::common(double t, const Eigen::Vector3d& point) const { return in_time->common(t, point, profile); }
Eigen::Vector3d Wind::fluctuation(double t, const Eigen::Vector3d& point) const {
  return in_time->fluctuation(t, point, profile);
}
bool Wind::turbulent() const { return in_time && in_time->has_box(); }
double Wind::carrier() const { return in_time->carrier(); }
std::string Wind::spread() const { return in_time ? in_time->spread() : ""; }

double starting_speed(const WindOptions& wind) {
  if (!wind.table.empty()) return read_wind_table(wind.table).speed.front();
  if (wind.turbulence && wind.turbulence->model == TurbulenceModel::bts) return read_bts(wind.turbulence->file).wind;
  return wind.speed_m_s;
}

double starting_direction(const WindOptions& wind) {
  if (wind.table.empty()) return wind.direction;
  const std::vector<double> directions = read_wind_table(wind.table).direction;
  return directions.empty() ? wind.direction : directions.front();
}

double greatest_speed(const WindOptions& wind) {
  return wind.table.empty() ? starting_speed(wind) : std::ranges::max(read_wind_table(wind.table).speed);
}

bool has_directions(const WindOptions& wind) { return !wind.table.empty() && !read_wind_table(wind.table).direction.empty(); }

bool rises(const WindOptions& wind) { return !wind.table.empty() && rises(read_wind_table(wind.table)); }

bool turns(const WindOptions& wind) {
  if (wind.event &&
      (wind.event->what == WindEvent::ecd || wind.event->what == WindEvent::edc || wind.event->direction_change != 0.0))
    return true;
  if (wind.table.empty()) return false;
  const WindTable table = read_wind_table(wind.table);
  return rises(table) || std::ranges::any_of(table.direction, [&](double d) { return d != table.direction.front(); });
}

Wind wind_of(const WindOptions& wind, const WindSite& site) {
  Wind made{starting_speed(wind) * blowing(starting_direction(wind), wind.incidence), wind_profile(wind)};
  if (!wind.steady()) made.in_time = std::make_shared<const WindInTime>(wind, site);
  return made;
}

std::string describe_wind(const WindOptions& wind) {
  std::string text = fmt::format("{:.4g} m/s", starting_speed(wind));
  if (!wind.table.empty()) text += ", from there by " + wind.table;
  if (wind.event) {
    constexpr const char* names[]{"step", "ramp", "EOG", "ECD", "EDC", "EWS (vertical)", "EWS (horizontal)"};
    text += fmt::format(", {} at {:g} s", names[std::size_t(wind.event->what)], wind.event->start_s);
  }
  if (wind.turbulence) {
    constexpr const char* names[]{"Kaimal", "TurbSim", "Mann"};
    text += fmt::format(", turbulence ({})", names[std::size_t(wind.turbulence->model)]);
  }
  return text;
}

}  // namespace spindrift::aero
