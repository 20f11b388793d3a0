// Turbulence in resolved air: parts of the wind that make up the whole at the rotor; air that has passed the
// plane of forces against the box that it was given. SPDX-License-Identifier: Apache-2.0
#include "src/aero/changing_wind.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "kernels/base/constants.hpp"

#include "src/scene/error.hpp"
#include "tests/src/aero/flow/flows.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using namespace spindrift::aero::testing;
using Eigen::Vector3d;

namespace {

const WindSite site{Vector3d(3.0, -2.0, 119.0), 160.0};

WindOptions turbulent(double speed) {
  WindOptions o{.speed_m_s = speed, .law = WindLaw::power, .reference_height_m = 119.0};
  o.turbulence = TurbulenceOptions{.seed = 3, .points_across = 7, .points_up = 7, .duration_s = 200.0, .step_s = 2.0};
  return o;
}
WindOptions sheared(double speed, WindEvent what) {
  WindOptions o{.speed_m_s = speed};
  o.event = WindEventOptions{.what = what, .start_s = 2.0};
  return o;
}

}  // namespace

TEST_CASE("what drives all air and what enters at the plane are the wind at the rotor", "[aero][fast]") {
  for (const WindOptions& o :
       {turbulent(10.0), sheared(10.0, WindEvent::ews_vertical), sheared(10.0, WindEvent::ews_horizontal)}) {
    const Wind wind = wind_of(o, site);
    CHECK(wind.turbulent() == o.turbulence.has_value());
    for (const double t : {0.0, 5.0, 7.3})
      for (const Vector3d& arm : {Vector3d(0.0, 0.0, 0.0), Vector3d(0.0, 60.0, -40.0), Vector3d(0.0, -30.0, 79.0)}) {
        const Vector3d x = site.hub + arm;
        CHECK((wind.common(t, x) + wind.fluctuation(t, x) - wind.at(t, x)).norm() <
              1e-5);  // planes have means of single precision
        // What drives all air is the same along the wind; the rest is carried: what passes the hub now was upwind before.
        const double ago = 11.0;
        const Vector3d upwind = x - Vector3d(ago * 10.0, 0.0, 0.0);
        CHECK((wind.common(t, x) - wind.common(t, upwind)).norm() == 0.0);
        CHECK((wind.fluctuation(t, x) - wind.fluctuation(t - ago, upwind)).norm() < 1e-9);
      }
    // Beside the rotor the profile is left.
    const Vector3d far(0.0, 200.0, 0.0), farther(0.0, 2000.0, 0.0);
    CHECK(wind.fluctuation(5.0, site.hub + far).norm() == 0.0);
    CHECK((wind.common(5.0, site.hub + far) - wind.common(5.0, site.hub + farther)).norm() == 0.0);
  }
}

TEST_CASE("planes of turbulence have no mean but what drives all air", "[aero][fast]") {
  const Wind wind = wind_of(turbulent(10.0), site);
  const double side = 1.1 * site.diameter;
  for (const double t : {1.0, 33.0}) {
    Vector3d sum = Vector3d::Zero();
    double most = 0.0;
    for (int row = 0; row < 7; ++row)
      for (int column = 0; column < 7; ++column) {
        const Vector3d u = wind.fluctuation(t, site.hub + side * Vector3d(0.0, column / 6.0 - 0.5, row / 6.0 - 0.5));
        sum += u / 49.0, most = std::max(most, u.norm());
      }
    CHECK(sum.head<2>().norm() < 1e-5);
    CHECK(wind.common(t, site.hub).z() == 0.0);  // the ground lets no air through
    CHECK(std::abs(sum.z()) > 1e-3);
    CHECK(most > 0.5);
  }
}

namespace {

/// A box of Mann's format without divergence: u = d psi / dy - d chi / dz, v = -d psi / dx, w = d chi / dx of two waves that end
/// with the box.
WindOptions solenoidal(double speed) {
  constexpr int nx = 64, ny = 25, nz = 25;
  constexpr double d = 8.0, length = nx * d, width = (ny - 1) * d, amplitude = 1.0;  // [m], [m/s]
  const double kx = 2.0 * pi * 2.0 / length, ky = 2.0 * pi / width;
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "spindrift_solenoidal";
  std::filesystem::create_directories(folder);
  std::array<std::vector<float>, 3> field;
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j)
      for (int k = 0; k < nz; ++k) {
        const double x = -kx * d * i, y = ky * (0.5 * width - d * j), z = ky * (d * k - 0.5 * width);
        const double u = amplitude * (std::cos(x) * std::sin(y) - std::sin(x) * std::sin(z));
        const double v = -amplitude * kx / ky * std::sin(x) * std::cos(y), w = -amplitude * kx / ky * std::cos(x) * std::cos(z);
        field[0].push_back(float(u)), field[1].push_back(float(v)), field[2].push_back(float(w));
      }
  WindOptions o{.speed_m_s = speed};
  o.turbulence = TurbulenceOptions{.model = TurbulenceModel::mann, .points = {nx, ny, nz}, .spacing_m = {d, d, d}};
  for (int c = 0; c < 3; ++c) {
    o.turbulence->files.push_back((folder / std::string(1, "uvw"[c])).string());
    std::ofstream(o.turbulence->files.back(), std::ios::binary)
        .write(reinterpret_cast<const char*>(field[std::size_t(c)].data()), std::streamsize(4 * field[std::size_t(c)].size()));
  }
  return o;
}

/// Air without a rotor behind the plane: cells of a tenth of the diameter round the site, far sides at two diameters.
std::unique_ptr<Case> tunnel(double speed, double dt, double cells) {
  FlowSetting s;
  s.gas.temperature_reference = 288.15;
  s.gas.pressure_reference = 1.225 * s.gas.gas_constant * 288.15;
  s.stream = {0.0, speed, 0.0, 0.0, 0.0}, s.speed = speed;
  s.physical_far_field = true;
  s.time_order = 2, s.dt = dt;
  s.march.drop = 1e-2, s.march.max_steps = 10;
  const double D = site.diameter, cell = D / cells;
  const auto nodes = [&](double middle, double low, double core_low, double core_high, double high) {
    std::vector<double> x = stretched_nodes(low * D, core_low * D, core_high * D, high * D, cell, 1.3);
    for (double& v : x) v += middle;
    return x;
  };
  const std::array<std::vector<double>, 3> at{nodes(site.hub.x(), -2.5, -1.3, 0.3, 1.5),
                                              nodes(site.hub.y(), -1.7, -0.7, 0.7, 1.7),
                                              nodes(site.hub.z(), -1.7, -0.7, 0.7, 1.7)};
  const PatchCondition open{Condition::far_field, false};
  std::vector<std::pair<std::string, PatchCondition>> sides;
  for (const char* side : {"i_min", "i_max", "j_min", "j_max", "k_min", "k_max"}) sides.emplace_back(side, open);
  return std::make_unique<Case>(cartesian_box(at, BoxOptions()), s, sides);
}

/// Of changes of the wind over the cells of the hub's plane within 0.4 diameters and a time: sums for a correlation.
struct Agreement {
  double both = 0.0, ours = 0.0, given = 0.0;
  void add(const Vector3d& u, const Vector3d& v) { both += u.dot(v), ours += u.squaredNorm(), given += v.squaredNorm(); }
  double correlation() const { return both / std::sqrt(ours * given); }
  double ratio() const { return std::sqrt(ours / given); }
};

Agreement compare(const WindOptions& o, double end, double dt, double cells) {
  const double speed = o.speed_m_s;
  const auto run = tunnel(speed, dt, cells);
  const Wind wind = wind_of(o, site);
  ChangingWind changing(o, site);
  changing.place(*run->store, MPI_COMM_SELF);
  run->prepare();
  Agreement sum;
  for (int n = 1; n * dt <= end; ++n) {
    const double t = n * dt;
    run->solver->set_wind(changing.until(t));
    run->run();
    REQUIRE(run->solver->march().verdict != Verdict::failed);
    if (wind.turbulent() && t < 1.2 * site.diameter / speed) continue;  // it has not come yet
    for (const FlowTile& tile : run->solver->tiles()) {
      const TileGeometry& g = *tile.geometry;
      for_rows(tile.box, [&](int k, int j) {
        for (int i = 0; i < tile.box.ni; ++i) {
          const double* x = g.centre_data.data() + g.cell_box.at(k, j, i);
          const Vector3d place(x[0], x[g.cell_box.component], x[2 * g.cell_box.component]), arm = place - site.hub;
          if (std::abs(arm.x()) > 0.5 * site.diameter / cells || std::hypot(arm.y(), arm.z()) > 0.4 * site.diameter) continue;
          const double* at = tile.state.data() + tile.cells.at(k, j, i);
          const std::ptrdiff_t c = tile.cells.component;
          const Vector3d same = wind.turbulent() ? wind.common(t, place) : wind.velocity;
          sum.add(Vector3d(at[c], at[2 * c], at[3 * c]) - same, wind.at(t, place) - same);
        }
      });
    }
  }
  return sum;
}

}  // namespace

TEST_CASE("turbulence given at the plane comes to the rotor", "[aero][fast]") {
  const Agreement a = compare(solenoidal(12.0), 40.0, 0.8, 10.0);
  CAPTURE(a.correlation(), a.ratio());
  CHECK(a.correlation() > 0.97);
  CHECK(a.ratio() > 0.9);
  CHECK(a.ratio() < 1.02);
}

TEST_CASE("the plane raises the head of the air that comes at its height by the gust", "[aero][fast]") {
  const ChangingWind changing(turbulent(10.0), site);
  const Wind wind = wind_of(turbulent(10.0), site);
  const double t = 7.0;
  const UndisturbedWind until = changing.until(t);
  for (const double height : {30.0, 119.0, 190.0}) {
    const Vector3d place = site.hub + Vector3d(-site.diameter, 20.0, height - site.hub.z());
    const double comes = until.velocity(place, 0.0).x(), goes = comes + wind.fluctuation(t, place).x();
    CHECK(std::abs(comes / 10.0 - std::pow(height / 119.0, 0.14)) < 0.1);
    CHECK(until.plane->push(place).x() == Approx(0.5 * (goes * goes - comes * comes)).epsilon(1e-6));
  }
}

TEST_CASE("extreme shear is at the rotor at once", "[aero][fast]") {
  const Agreement a = compare(sheared(12.0, GENERATE(WindEvent::ews_vertical, WindEvent::ews_horizontal)), 14.0, 0.8, 10.0);
  CAPTURE(a.correlation(), a.ratio());
  CHECK(a.correlation() > 0.9999);
  CHECK(a.ratio() == Approx(1.0).margin(1e-3));
}

TEST_CASE("a plane outside the grid is refused by its key", "[aero][fast]") {
  const auto run = tunnel(12.0, 0.8, 4.0);
  WindOptions o = turbulent(12.0);
  o.turbulence->inflow_plane_m = 1000.0;
  CHECK_THROWS_WITH(ChangingWind(o, site).place(*run->store, MPI_COMM_SELF),
                    Catch::Matchers::Contains("wind.turbulence.inflow_plane_m"));
}
