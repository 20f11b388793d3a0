// SPDX-License-Identifier: Apache-2.0
#include "src/aero/wind.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "kernels/base/constants.hpp"
#include "kernels/base/interpolation.hpp"
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
  return {column("time_s", 1.0), column("speed_m_s", 1.0), column("direction_deg", radians_per_degree),
          column("vertical_m_s", 1.0)};
}

}  // namespace

class WindInTime {
 public:
  WindInTime(const WindOptions& options, const WindSite& site)
      : speed_(starting_speed(options)), direction_(options.direction), site_(site) {
    if (!options.table.empty()) table_ = read_wind_table(options.table);
    if (options.event) {
      event_ = *options.event;
      iec_ = {speed_ * wind_profile(options).share(site.hub.z()), site.hub.z(), site.diameter, event_->reference_wind_m_s,
              event_->reference_intensity};
    }
    if (options.turbulence) make_box(*options.turbulence, options);
  }

  Eigen::Vector3d at(double t, const Eigen::Vector3d& point, const WindProfile& profile) const {
    double speed = speed_, direction = direction_, vertical = 0.0, added = 0.0;
    if (!table_.time.empty()) {
      speed = interpolate_linear(table_.time, table_.speed, t);
      if (!table_.direction.empty()) direction = interpolate_linear(table_.time, table_.direction, t);
      if (!table_.vertical.empty()) vertical = interpolate_linear(table_.time, table_.vertical, t);
    }
    const Eigen::Vector3d from_hub = point - site_.hub;
    if (event_) {
      const double since = t - event_->start_s, sense = event_->reversed ? -1.0 : 1.0;
      switch (event_->what) {
        case WindEvent::step:
          if (since >= 0.0) speed += event_->speed_change_m_s, direction += event_->direction_change;
          break;
        case WindEvent::ramp: {
          const double share = std::clamp(since / event_->duration_s, 0.0, 1.0);
          speed += share * event_->speed_change_m_s, direction += share * event_->direction_change;
          break;
        }
        case WindEvent::eog:
          added = iec::eog(iec_, since);
          break;
        case WindEvent::ecd:
          added = iec::ecd_speed(since), direction += sense * iec::ecd_direction(iec_, since);
          break;
        case WindEvent::edc:
          direction += sense * iec::edc_direction(iec_, since);
          break;
        case WindEvent::ews_vertical:
          added = sense * iec::ews(iec_, from_hub.z(), since);
          break;
        case WindEvent::ews_horizontal:
          added = sense * iec::ews(iec_, across(direction).dot(from_hub), since);
          break;
      }
    }
    if (box_.values.empty()) return (profile.share(point.z()) * speed + added) * along(direction) + vertical * up();
    // Frozen turbulence: what is downwind passed the hub earlier. Half the width ahead, so that no time is below zero.
    const double later = along(direction_).dot(from_hub) / box_.wind;
    const Eigen::Vector3d gust =
        box_.at(t + start_ + 0.5 * box_.width() / box_.wind - later, across(direction_).dot(from_hub), point.z());
    const double mean = box_.has_mean ? 0.0 : profile.share(point.z()) * speed + added;
    return (mean + gust.x()) * along(direction) + gust.y() * across(direction) + (vertical + gust.z()) * up();
  }

 private:
  static Eigen::Vector3d along(double direction) { return {std::cos(direction), std::sin(direction), 0.0}; }
  static Eigen::Vector3d across(double direction) { return {-std::sin(direction), std::cos(direction), 0.0}; }
  static Eigen::Vector3d up() { return Eigen::Vector3d::UnitZ(); }

  void make_box(const TurbulenceOptions& o, const WindOptions& wind) {
    start_ = o.start_s;
    const double hub_wind = speed_ * wind_profile(wind).share(site_.hub.z());
    const auto refuse = [](const std::string& key, const std::string& what) {
      throw scene::SceneError({{"", 0, "wind.turbulence" + key, "", what}});
    };
    if (o.model != TurbulenceModel::bts && !(hub_wind > 0.0))
      refuse("", "needs wind.speed_m_s above zero, which carries the box");
    switch (o.model) {
      case TurbulenceModel::bts:
        box_ = box_of(read_bts(o.file));
        if (wind.speed_m_s > 0.0 && std::abs(wind.speed_m_s / box_.wind - 1.0) > 0.01)
          refuse(".file", fmt::format("has a mean wind of {:.4g} m/s, wind.speed_m_s is {:.4g}: leave that out", box_.wind,
                                      wind.speed_m_s));
        break;
      case TurbulenceModel::mann:
        box_ =
            read_mann({o.files[0], o.files[1], o.files[2]},
                      {{int(o.points[0]), int(o.points[1]), int(o.points[2])}, {o.spacing_m[0], o.spacing_m[1], o.spacing_m[2]}},
                      hub_wind, site_.hub.z());
        break;
      case TurbulenceModel::kaimal: {
        const double side = o.width_m.value_or(1.1 * site_.diameter);
        const double sigma = o.extreme ? iec::sigma_extreme(hub_wind, o.reference_intensity, 0.2 * o.reference_wind_m_s)
                                       : iec::sigma_normal(hub_wind, o.reference_intensity);
        box_ = kaimal_box({o.points_across, o.points_up, side, side, o.duration_s, o.step_s, hub_wind, site_.hub.z(),
                           o.sigma_m_s.value_or(sigma), std::uint64_t(o.seed)});
        break;
      }
    }
    const double radius = 0.5 * site_.diameter;
    if (0.5 * box_.width() < radius || box_.bottom > site_.hub.z() - radius || box_.top() < site_.hub.z() + radius)
      refuse("",
             fmt::format("the box is {:.4g} m wide and goes from z = {:.4g} to {:.4g} m: it does not cover the rotor of {:.4g} m "
                         "at {:.4g} m",
                         box_.width(), box_.bottom, box_.top(), site_.diameter, site_.hub.z()));
  }

  double speed_, direction_, start_ = 0.0;
  WindSite site_;
  WindTable table_;
  std::optional<WindEventOptions> event_;
  iec::Site iec_;
  TurbulenceBox box_;
};

Eigen::Vector3d Wind::changing(double t, const Eigen::Vector3d& point) const { return in_time->at(t, point, profile); }

double starting_speed(const WindOptions& wind) {
  if (!wind.table.empty()) return read_wind_table(wind.table).speed.front();
  if (wind.turbulence && wind.turbulence->model == TurbulenceModel::bts) return read_bts(wind.turbulence->file).wind;
  return wind.speed_m_s;
}

bool turns(const WindOptions& wind) {
  if (wind.event &&
      (wind.event->what == WindEvent::ecd || wind.event->what == WindEvent::edc || wind.event->direction_change != 0.0))
    return true;
  if (wind.table.empty()) return false;
  const WindTable table = read_wind_table(wind.table);
  const auto changes = [](const std::vector<double>& column, double from) {
    return std::ranges::any_of(column, [from](double v) { return v != from; });
  };
  return changes(table.direction, wind.direction) || changes(table.vertical, 0.0);
}

Wind wind_of(const WindOptions& wind, const WindSite& site) {
  Wind made{starting_speed(wind) * Eigen::Vector3d(std::cos(wind.direction), std::sin(wind.direction), 0.0), wind_profile(wind)};
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
