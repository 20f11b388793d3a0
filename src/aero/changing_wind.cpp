// SPDX-License-Identifier: Apache-2.0
#include "src/aero/changing_wind.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "src/aero/largest_of_cells.hpp"
#include "src/scene/error.hpp"

namespace spindrift::aero {

namespace {

constexpr double cells_of_width = 2.0;
constexpr double cells_of_wave = 8.0;  ///< of the shortest that the scheme of second order carries over a diameter

Eigen::Vector3d way_of(const WindOptions& wind) { return blowing(starting_direction(wind), 0.0); }

/// Longest extent along the normal of the cells that the plane passes through within a radius; zero where there are none.
double longest_at(const GridStore& store, const InflowPlane& plane, double radius, MPI_Comm comm) {
  return largest_of_cells(store, comm, [&](const TileGeometry& g, int k, int j, int i, const Eigen::Vector3d& centre) {
    const Eigen::Vector3d arm = centre - plane.centre;
    const double along = arm.dot(plane.normal), extent = extent_along(g, plane.normal, k, j, i);
    return std::abs(along) <= 0.5 * extent && (arm - along * plane.normal).norm() <= radius ? extent : 0.0;
  });
}

constexpr const char* plane_key = "wind.turbulence.inflow_plane_m";

/// So far upwind of the hub, or by a diameter where nothing is given.
Eigen::Vector3d inflow_plane_centre(const WindOptions& wind, const WindSite& site) {
  const std::optional<double> upwind = wind.turbulence ? wind.turbulence->inflow_plane_m : std::nullopt;
  return site.hub - upwind.value_or(site.diameter) * way_of(wind);
}

/// The box must last until what passes the plane at the end.
WindSite with_plane(const WindOptions& wind, WindSite site) {
  if (wind.turbulence) site.upwind = wind.turbulence->inflow_plane_m.value_or(site.diameter);
  return site;
}

}  // namespace

std::string why_inflow_plane_outside(const WindOptions& wind, const WindSite& site, const Corners& grid) {
  if (!wind.turbulence) return {};
  const Eigen::Vector3d centre = inflow_plane_centre(wind, site);
  for (int d = 0; d < 3; ++d)
    if (centre[d] < grid.low[d] || centre[d] > grid.high[d])
      return fmt::format(
          "puts the plane where turbulence enters, {:.4g} m upwind of the hub, out of the grid, which goes from {:g} to "
          "{:g} m along {}",
          (centre - site.hub).norm(), grid.low[d], grid.high[d], "xyz"[d]);
  return {};
}

void require_inflow_plane_inside(const MultiBlockGrid& grid, const WindOptions& wind, const WindSite& site) {
  if (const std::string why = why_inflow_plane_outside(wind, site, corners(grid)); !why.empty())
    throw scene::SceneError({scene::Problem{.key = plane_key, .message = why}});
}

ChangingWind::ChangingWind(const WindOptions& wind, const WindSite& site)
    : wind_(wind_of(wind, with_plane(wind, site))), site_(site), plane_{inflow_plane_centre(wind, site), way_of(wind), 1.0, {}} {}

void ChangingWind::place(const GridStore& store, MPI_Comm comm) {
  if (!has_plane()) return;
  const double cell = longest_at(store, plane_, 0.5 * site_.diameter, comm);
  if (!(cell > 0.0))
    throw scene::SceneError({scene::Problem{
        .key = plane_key, .message = "puts the plane where turbulence enters out of the grid, which has no cells there"}});
  plane_.width = cells_of_width * cell;
}

UndisturbedWind ChangingWind::until(double t) const {
  if (wind_.steady()) return {};
  const auto common = [wind = wind_, t](const Eigen::Vector3d& place, double ago) { return wind.common(t - ago, place); };
  if (!has_plane()) return {common, {}};
  InflowPlane plane = plane_;
  // The head that takes air from the speed at which it comes to what it is to have, by momentum that it takes along.
  plane.push = [wind = wind_, t, normal = plane_.normal](const Eigen::Vector3d& place) -> Eigen::Vector3d {
    const Eigen::Vector3d gust = wind.fluctuation(t, place);
    return (wind.common(t, place).dot(normal) + 0.5 * gust.dot(normal)) * gust;
  };
  return {common, plane};
}

UndisturbedWind ChangingWind::at_start() const {
  if (wind_.steady()) return {};
  return {[wind = wind_](const Eigen::Vector3d& place, double) { return wind.common(0.0, place); }, {}};
}

void ChangingWind::begin(std::span<FlowTile> tiles,
                         const std::function<Eigen::Vector3d(const Eigen::Vector3d& place)>& from) const {
  if (wind_.steady()) return;
  add_velocity(tiles, [&](const Eigen::Vector3d& x) -> Eigen::Vector3d { return wind_.common(0.0, x) - from(x); });
}

void ChangingWind::begin(FlowSolver& solver) const {
  const FlowSetting& s = solver.setting();
  begin(solver.tiles(), [&s](const Eigen::Vector3d& x) -> Eigen::Vector3d {
    const gas::Primitive<double> stream = stream_at(s.stream, s.profile, x.z());
    return {stream.u, stream.v, stream.w};
  });
}

std::string ChangingWind::description() const {
  if (!has_plane()) return {};
  const double shortest = cells_of_wave / cells_of_width * plane_.width, upwind = (site_.hub - plane_.centre).norm();
  std::string text =
      fmt::format("turbulence enters {:.4g} m upwind of the hub, spread over {:.3g} m, and comes to it after {:.3g} s", upwind,
                  plane_.width, upwind / wind_.carrier());
  if (shortest > site_.diameter)
    text += fmt::format("; the cells there are wide: of waves shorter than {:.3g} m little comes to the rotor", shortest);
  return text;
}

}  // namespace spindrift::aero
