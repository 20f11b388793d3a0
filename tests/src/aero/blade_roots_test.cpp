// Loads at the roots of rigid blades: weight, turning and wind of the DTU 10 MW rotor. SPDX-License-Identifier: Apache-2.0
#include "src/aero/blade_roots.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "kernels/base/constants.hpp"
#include "src/aero/bem.hpp"
#include "src/scene/error.hpp"
#include "tests/src/aero/data_file.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using Catch::Matchers::Contains;
using Eigen::Vector3d;

namespace {

const Turbine& dtu_turbine() {
  static const Turbine turbine = read_turbine(SPINDRIFT_SOURCE_DIR "/inputs/turbines/dtu_10mw.toml");
  return turbine;
}
const BladeMasses& masses() {
  static const BladeMasses read =
      read_blade_masses(dtu_turbine(), SPINDRIFT_SOURCE_DIR "/inputs/turbines/dtu_10mw/blade_masses.csv");
  return read;
}
const Vector3d downwind = Vector3d::UnitX(), up = Vector3d::UnitZ(), weight(0, 0, -9.81);

BladeRootLoad mass_load(const BladeRoots& roots, const HubMotion& hub, const Vector3d& out) {
  Wrench w;
  w.point = roots.root(downwind, out);
  roots.add_mass_loads(hub, downwind, out, weight, w);
  return BladeRoots::along_blade(w, downwind, out);
}

}  // namespace

TEST_CASE("a level blade at rest bends its root edgewise by its weight times its first moment", "[aero][fast]") {
  const BladeRoots roots(dtu_turbine(), masses());
  const HubMotion still{Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()};
  // 41,722 kg, 1.2069e6 kg m about the rotor's axis (HAWC2 model); azimuth 90 degrees goes down.
  const Vector3d out = downwind.cross(up);
  const BladeRootLoad load = mass_load(roots, still, out);
  const double cone = std::cos(dtu_turbine().precone);
  CHECK(load.ahead == Approx(41722.0 * 9.81).epsilon(2e-3));
  CHECK(load.edge == Approx((1.2069e6 - 2.8 * 41722.0) * 9.81 * cone).epsilon(1e-2));
  const BladeRootLoad standing = mass_load(roots, still, up);
  CHECK(standing.outward == Approx(-41722.0 * 9.81).epsilon(2e-3));
  CHECK(std::abs(standing.edge) < 1e-6 * load.edge);
}

TEST_CASE("a turning blade pulls by its first moment, and its cone bends it back into the plane", "[aero][fast]") {
  const BladeRoots roots(dtu_turbine(), masses());
  const double speed = 1.0;
  const HubMotion turning{weight, speed * downwind, Vector3d::Zero()};  // falls freely: no weight
  const BladeRootLoad load = mass_load(roots, turning, up);
  CHECK(load.outward == Approx(1.2069e6 * speed * speed).epsilon(1e-2));
  CHECK(load.flap > 0.0);  // blades lean upwind
  CHECK(std::abs(load.downwind) < 1e-6 * load.outward);
  const HubMotion starting{weight, Vector3d::Zero(), 0.1 * downwind};
  CHECK(mass_load(roots, starting, up).ahead == Approx(-0.1 * 1.2069e6).epsilon(1e-2));
}

TEST_CASE("the wind's loads at all roots make up the rotor's thrust and torque", "[aero][fast]") {
  const BladeElementMomentum bem(dtu_turbine(), "madsen", 1.225);
  const BladeRoots roots(dtu_turbine(), masses());
  const DiscMotion rotor{Vector3d::Zero(), 0.9 * downwind, downwind, up, 0.3, 0.0};
  const Wind wind{Vector3d(11.0, 0, 0)};
  const DiscLoad all = bem(wind, rotor);
  std::vector<Wrench> at_root(3);
  for (int b = 0; b < 3; ++b) at_root[std::size_t(b)].point = roots.root(downwind, blade_direction(rotor, b, 3));
  bem(wind, rotor, 0.0, {}, at_root);
  Wrench sum;
  for (const Wrench& w : at_root) sum += w.about(Vector3d::Zero());
  CHECK((sum.force - all.force).norm() < 1e-9 * all.force.norm());
  CHECK((sum.moment - all.moment).norm() < 1e-9 * all.moment.norm());
  for (int b = 0; b < 3; ++b) {
    const BladeRootLoad load = BladeRoots::along_blade(at_root[std::size_t(b)], downwind, blade_direction(rotor, b, 3));
    CHECK(load.downwind == Approx(all.force.x() / 3.0).epsilon(1e-6));
    CHECK(load.flap > 50.0 * load.downwind);  // two thirds of the span and more
    CHECK(load.edge > 0.0);
  }
}

TEST_CASE("masses that are not of the blade are refused", "[aero][fast]") {
  const std::string path = data_file("blade_masses.csv", "span_m, mass_kg_m\n2.8, 1000\n50, 100\n");
  CHECK_THROWS_WITH(read_blade_masses(dtu_turbine(), path), Contains("must be the tip of the planform"));
}
