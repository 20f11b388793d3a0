// Loads of src/sea/engineering_sea.hpp: Archimedes, Morison's limits, the split of Froude-Krylov and buoyancy, the mass matrix.
// SPDX-License-Identifier: Apache-2.0
#include "src/sea/engineering_sea.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "kernels/base/random.hpp"

using namespace spindrift;
using namespace spindrift::sea;
using Eigen::Vector3d;

namespace {

const SeaEnvironment tank{1025.0, 20.6, 9.81};

SeaOptions model(const char* name) {
  SeaOptions options;
  options.model = name;
  return options;
}

/// A free cylinder on the z axis from the keel up, its centre of mass at the origin.
SeaBody spar(double keel, double top, double radius) {
  return {"spar", {}, {{"column", {{0, 0, keel}, {0, 0, top}, radius, radius}}}};
}

/// The paper's platform (Leble & Barakos 2016, Table 3 and derived geometry), described about where it floats: centre of mass of
/// the whole turbine z above the keel.
SeaBody platform(double centre_above_keel) {
  SeaBody body{"platform", {.position = {0.0, 0.0, centre_above_keel - 14.5}}, {}};
  for (int i = 0; i < 3; ++i) {
    const double angle = 2.0 * pi / 3.0 * i, x = 46.7 * std::cos(angle), y = 46.7 * std::sin(angle);
    body.cylinders.push_back(
        {"float_" + std::to_string(i + 1), {{x, y, -centre_above_keel}, {x, y, 20.0 - centre_above_keel}, 5.625, 5.625}});
  }
  return body;
}

Wrench load(const EngineeringSea& sea, const Motion& motion, double t = 0.0) {
  Wrench w;
  w.point = motion.position;
  sea.add_loads(t, {&motion, 1}, {&w, 1});
  return w;
}
Matrix6 added_mass(const EngineeringSea& sea, const Motion& motion, double t = 0.0) {
  Matrix6 m = Matrix6::Zero();
  sea.add_added_mass(t, {&motion, 1}, {&m, 1});
  return m;
}
SeaLoads parts(const EngineeringSea& sea, const Motion& motion, double t = 0.0) {
  SeaLoads loads;
  sea.loads_by_part(t, {&motion, 1}, {&loads, 1});
  return loads;
}
Motion at(double x, double y, double z) {
  Motion m;
  m.position = {x, y, z};
  return m;
}

}  // namespace

TEST_CASE("the paper's platform floats at a draft of 14.565 m with its textbook stiffness in heave and pitch", "[sea][fast]") {
  const double mass = 4451900.0, radius = 5.625, waterplane = 3.0 * pi * radius * radius, centre = 14.565 + 21.795;
  const EngineeringSea sea(model("hydrostatic"), {}, tank, {platform(centre)});
  double low = 0.0, high = centre;  // of the centre of mass over still water: draft = centre - z
  for (int i = 0; i < 60; ++i) {
    const double z = 0.5 * (low + high);
    (load(sea, at(0, 0, z)).force.z() > mass * 9.81 ? low : high) = z;
  }
  const double draft = centre - low;
  CHECK(draft == Approx(14.565).margin(5e-4));
  CHECK(draft == Approx(mass / 1025.0 / waterplane).epsilon(1e-12));

  const double d = 1e-4;
  const auto heave = [&](double dz) { return load(sea, at(0, 0, low + dz)).force.z(); };
  CHECK((heave(-d) - heave(d)) / (2 * d) == Approx(1025.0 * 9.81 * waterplane).epsilon(1e-9));
  const auto pitch = [&](double angle) {
    Motion m = at(0, 0, low);
    m.attitude = Eigen::AngleAxisd(angle, Vector3d::UnitY());
    return load(sea, m).moment.y();
  };
  const double second_moment = 3.0 * pi / 4.0 * std::pow(radius, 4) + pi * radius * radius * 1.5 * 46.7 * 46.7;
  const double stiffness = 1025.0 * 9.81 * (second_moment + mass / 1025.0 * (-draft / 2 - low));
  CHECK((pitch(-d) - pitch(d)) / (2 * d) == Approx(stiffness).epsilon(1e-6));
  CHECK(stiffness == Approx(2.03e9).epsilon(0.01));
}

TEST_CASE("the hydrostatic rung is buoyancy alone: no added mass, no drag, no current", "[sea][fast]") {
  const EngineeringSea sea(model("hydrostatic"), {}, tank, {spar(-10, 5, 2)});
  Motion m = at(3, 4, 1);
  m.velocity = {1, 2, 3};
  m.omega = {0.1, 0.2, 0.3};
  const Wrench w = load(sea, m);
  CHECK((w.force - Vector3d(0, 0, 1025.0 * 9.81 * 9.0 * 4.0 * pi)).norm() < 1e-6);
  CHECK(w.moment.norm() < 1e-6);
  CHECK(added_mass(sea, m).norm() == 0.0);
  CHECK_FALSE(sea.has_added_mass());
}

TEST_CASE("a scene without water or without cylinders feels nothing", "[sea][fast]") {
  CHECK(load(EngineeringSea(model("none"), {}, tank, {spar(-10, 5, 2)}), at(0, 0, 0)).force.norm() == 0.0);
  CHECK(load(EngineeringSea(model("morison"), {}, tank, {SeaBody{"rotor", {}, {}}}), at(0, 0, 0)).force.norm() == 0.0);
}

TEST_CASE("both rungs agree on a body at rest in still water, at any attitude", "[sea][fast]") {
  const EngineeringSea hydrostatic(model("hydrostatic"), {}, tank, {platform(30.0)}),
      morison(model("morison"), {}, tank, {platform(30.0)});
  for (int i = 0; i < 50; ++i) {
    Motion m = at(1.0 * i, -2.0, 25.0 - i);
    m.attitude = Eigen::AngleAxisd(0.13 * i, Vector3d(1, 0.3 * i, -0.2).normalized());
    const Wrench a = load(hydrostatic, m), b = load(morison, m);
    REQUIRE((a.force - b.force).norm() <= 1e-11 * a.force.norm());
    REQUIRE((a.moment - b.moment).norm() <= 1e-11 * (a.force.norm() * 50.0));
  }
}

TEST_CASE("linear damping opposes the velocity of its point, in body axes", "[sea][fast]") {
  SeaOptions options = model("hydrostatic");
  options.damping.push_back({"spar", {1e5, 2e5, 3e5}, {4e6, 5e6, 6e6}, Vector3d(0, 0, 10)});
  SeaBody body = spar(-10, 5, 2);
  body.initial.position = {0, 0, 2};  // the point is 8 m above the centre of mass
  const EngineeringSea sea(options, {}, tank, {body});
  Motion m = at(50, 60, 2);
  m.attitude = Eigen::AngleAxisd(pi / 2, Vector3d::UnitZ());  // body x is earth y
  m.velocity = {0, 1, 0};
  m.omega = {0, 0.1, 0};  // the point moves 0.8 m/s more along body x
  const Wrench w = parts(sea, m).damping;
  CHECK((w.force - Vector3d(0, -1.8e5, 0)).norm() < 1e-6);
  CHECK((w.moment - Vector3d(8.0 * 1.8e5 + 5e5, 0, 0)).norm() < 1e-5);
}

TEST_CASE("stiffness of matrices acts about axes of the earth however the body has yawed", "[sea][fast]") {
  SeaOptions options = model("hydrostatic");
  options.matrices.push_back({.body = "spar", .stiffness = {6, std::array<double, 6>{}}});
  for (std::size_t i = 3; i < 6; ++i) options.matrices[0].stiffness[i][i] = double(i) * 1e6;
  const EngineeringSea sea(options, {}, tank, {spar(-10, 5, 2)});
  Motion m;
  m.attitude = Eigen::AngleAxisd(0.1, Vector3d::UnitX()) * Eigen::AngleAxisd(0.5, Vector3d::UnitZ());
  CHECK((parts(sea, m).damping.moment - Vector3d(-0.3e6, 0, -2.5e6)).norm() < 1e-6);
}

TEST_CASE("a column in a current feels drag on its wetted side, and none when it drifts along", "[sea][fast]") {
  SeaOptions options = model("morison");
  options.current_m_s = {1.5, 0, 0};
  options.drag_coefficient = 0.7;
  const EngineeringSea sea(options, {}, tank, {spar(-10, 5, 2)});
  const double drag = 0.5 * 1025.0 * 0.7 * 4.0 * 10.0 * 1.5 * 1.5;
  const SeaLoads fixed = parts(sea, at(0, 0, 0));
  CHECK(fixed.drag.force.x() == Approx(drag));
  CHECK(fixed.drag.moment.y() == Approx(-5.0 * drag));      // at half draft
  CHECK(fixed.drag.force.z() == Approx(0.0).margin(1e-9));  // the keel is parallel to the current
  CHECK(fixed.inertia.force.norm() == Approx(0.0).margin(1e-9));
  Motion drifting = at(0, 0, 0);
  drifting.velocity = {1.5, 0, 0};
  CHECK(parts(sea, drifting).drag.force.norm() == Approx(0.0).margin(1e-9));
  Motion sinking = at(0, 0, 0);
  sinking.velocity = {1.5, 0, -0.8};
  CHECK(parts(sea, sinking).drag.force.z() == Approx(0.5 * 1025.0 * 1.0 * 4.0 * pi * 0.64));  // one end, axial coefficient 1
}

TEST_CASE("added mass of an upright column is that of the textbook, symmetric and never negative", "[sea][fast]") {
  const double radius = 2.0, draft = 10.0, m = 1025.0 * pi * radius * radius * draft;
  SeaOptions options = model("morison");
  options.added_mass_coefficient = 0.9;
  options.axial_added_mass_coefficient = 0.64;
  const EngineeringSea sea(options, {}, tank, {spar(-draft, 5, radius)});
  const Matrix6 a = added_mass(sea, at(0, 0, 0));
  CHECK(a(0, 0) == Approx(0.9 * m));
  CHECK(a(1, 1) == Approx(0.9 * m));
  CHECK(a(2, 2) == Approx(0.64 * 1025.0 * 2.0 / 3.0 * pi * 8.0));
  CHECK(a(0, 4) == Approx(-0.5 * draft * 0.9 * m));         // surge force of pitch acceleration: arm to mid-draft
  CHECK(a(4, 4) == Approx(0.9 * m * draft * draft / 3.0));  // two Gauss points per strip are exact
  CHECK(a(5, 5) == Approx(0.0).margin(1e-6));
  CHECK((a - a.transpose()).norm() < 1e-9 * a.norm());
  Motion tilted = at(0, 0, -1);
  tilted.attitude = Eigen::AngleAxisd(1.0, Vector3d(1, 2, 3).normalized());
  const Matrix6 b = added_mass(sea, tilted);
  CHECK((b - b.transpose()).norm() < 1e-9 * b.norm());
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    Eigen::Matrix<double, 6, 1> q;
    for (double& x : q) x = random.uniform() - 0.5;
    REQUIRE(q.dot(b * q) > 0.0);  // kinetic energy of the water
  }
}

TEST_CASE("a joint between members is no end, and coefficients may differ by member", "[sea][fast]") {
  SeaBody body{"spar", {}, {{"lower", {{0, 0, -20}, {0, 0, -8}, 3.0, 3.0}}, {"upper", {{0, 0, -8}, {0, 0, 4}, 3.0, 3.0}}}};
  SeaOptions options = model("morison");
  const double keel = 0.64 * 1025.0 * 2.0 / 3.0 * pi * 27.0;
  CHECK(added_mass(EngineeringSea(options, {}, tank, {body}), at(0, 0, 0))(2, 2) == Approx(keel));
  options.coefficients.push_back({"lower", 0.0, 2.0, {}, {}, {}, {}});
  const EngineeringSea sea(options, {}, tank, {body});
  CHECK(added_mass(sea, at(0, 0, 0))(0, 0) == Approx(1025.0 * pi * 9.0 * (2.0 * 12.0 + 8.0)));
  Motion m = at(0, 0, 0);
  m.velocity = {1, 0, 0};
  CHECK(parts(sea, m).drag.force.x() == Approx(-0.5 * 1025.0 * 6.0 * 8.0));  // of the upper member alone
  // A wider member below leaves a ring open: 4^2 - 3^2 of the disc, 4^3 - 3^3 of the hemisphere.
  body.cylinders[0].shape.start_radius = body.cylinders[0].shape.end_radius = 4.0;
  options.coefficients.clear();
  CHECK(added_mass(EngineeringSea(options, {}, tank, {body}), at(0, 0, 0))(2, 2) ==
        Approx(0.64 * 1025.0 * 2.0 / 3.0 * pi * (64.0 + (64.0 - 27.0))));
  options.axial_added_mass_coefficient = 0.0;
  Motion sinking = at(0, 0, 0);
  sinking.velocity = {0, 0, -1};
  CHECK(parts(EngineeringSea(options, {}, tank, {body}), sinking).drag.force.z() == Approx(0.5 * 1025.0 * pi * (16.0 + 7.0)));
}

TEST_CASE("ends that share a point at an angle add as vectors", "[sea][fast]") {
  // A column of radius 3 m down to a pontoon of radius 2 m along x, deep under water: its end looks down, the pontoon's to -x.
  const SeaBody body{
      "hull", {}, {{"pontoon", {{0, 0, -20}, {15, 0, -20}, 2.0, 2.0}}, {"column", {{0, 0, 4}, {0, 0, -20}, 3.0, 3.0}}}};
  SeaOptions options = model("morison");
  options.drag_coefficient = options.added_mass_coefficient = 0.0;
  options.axial_drag_coefficient = options.axial_added_mass_coefficient = 1.0;
  const EngineeringSea sea(options, {}, tank, {body});
  const Vector3d area(-4.0 * pi, 0, -9.0 * pi), cube(-8.0, 0, -27.0);
  const Matrix6 mass = added_mass(sea, at(0, 0, 0));
  const double hemisphere = 1025.0 * 2.0 / 3.0 * pi;
  CHECK(mass(2, 2) == Approx(hemisphere * 27.0 * 27.0 / cube.norm()));
  CHECK(mass(0, 2) == Approx(hemisphere * 8.0 * 27.0 / cube.norm()));
  CHECK(mass(0, 0) == Approx(hemisphere * (64.0 / cube.norm() + 8.0)));  // and the pontoon's far end
  Motion sinking = at(0, 0, 0);
  sinking.velocity = {0, 0, -1};
  const double along = Vector3d(0, 0, -1).dot(area.normalized());
  const Vector3d drag = -0.5 * 1025.0 * along * along * area;
  CHECK((parts(sea, sinking).drag.force - drag).norm() < 1e-9 * drag.norm());
}

TEST_CASE("a pile to the bed has water only on its sides: nothing lifts it, in still water or in waves", "[sea][fast]") {
  const double radius = 3.0, weight = 1025.0 * 9.81 * pi * radius * radius;
  for (const char* rung : {"hydrostatic", "morison"}) {
    const EngineeringSea still(model(rung), {}, tank, {spar(-20.6, 8, radius)});
    const Wrench w = load(still, at(0, 0, 0));
    CHECK(w.force.norm() < 1e-9 * weight * 20.6);
    CHECK(w.moment.norm() < 1e-9 * weight * 20.6 * radius);
    // A footing that is wider up to -15 m is pressed down on its shoulder.
    const SeaBody stepped{
        "spar", {}, {{"footing", {{0, 0, -20.6}, {0, 0, -15}, 5.0, 5.0}}, {"shaft", {{0, 0, -15}, {0, 0, 8}, radius, radius}}}};
    CHECK(load(EngineeringSea(model(rung), {}, tank, {stepped}), at(0, 0, 0)).force.z() ==
          Approx(-1025.0 * 9.81 * pi * (25.0 - 9.0) * 15.0));
  }
  // Of the pile that ends a metre over the bed the water carries the whole volume.
  CHECK(load(EngineeringSea(model("morison"), {}, tank, {spar(-19.6, 8, radius)}), at(0, 0, 0)).force.z() ==
        Approx(weight * 19.6));
  WavesOptions waves;
  waves.model = "airy", waves.height_m = 0.1, waves.period_s = 9.0;
  const EngineeringSea sea(model("morison"), waves, tank, {spar(-20.6, 8, radius)}),
      over_bed(model("morison"), waves, tank, {spar(-20.5, 8, radius)});
  double most = 0.0;
  for (double t = 0.0; t < 9.0; t += 1.5) {
    CHECK(std::abs(load(sea, at(0, 0, 0), t).force.z()) < 0.01 * weight * 0.05);
    most = std::max(most, std::abs(load(over_bed, at(0, 0, 0), t).force.z() - weight * 20.5));
    CHECK(load(sea, at(0, 0, 0), t).force.x() == Approx(load(over_bed, at(0, 0, 0), t).force.x()).epsilon(0.01).margin(10.0));
  }
  CHECK(most > 0.5 * weight * 0.05);
  CHECK(added_mass(sea, at(0, 0, 0))(2, 2) == 0.0);
  Motion sinking = at(0, 0, 0);
  sinking.velocity = {0, 0, -1};
  CHECK(parts(EngineeringSea(model("morison"), {}, tank, {spar(-20.6, 8, radius)}), sinking).drag.force.z() == 0.0);
}

TEST_CASE("the two ends of a member may differ in drag and added mass", "[sea][fast]") {
  // Deep under water, so that both ends are wet.
  const SeaBody body{"pontoon", {}, {{"member", {{-5, 0, -20}, {5, 0, -20}, 2.0, 2.0}}}};
  SeaOptions options = model("morison");
  options.drag_coefficient = options.added_mass_coefficient = 0.0;
  options.axial_drag_coefficient = options.axial_added_mass_coefficient = 0.0;
  CoefficientsOptions own{"member", {}, {}, 3.0, 1.0, 0.0, 0.5};
  Motion m = at(0, 0, 0);
  m.velocity = {1, 0, 0};
  const double disc = pi * 4.0, hemisphere = 2.0 / 3.0 * pi * 8.0;
  for (const double length : {5.0, 100.0}) {  // several strips, and one that has both ends
    options.strip_length_m = length;
    options.coefficients = {own};
    const EngineeringSea sea(options, {}, tank, {body});
    CHECK(parts(sea, m).drag.force.x() == Approx(-0.5 * 1025.0 * 3.0 * disc));
    CHECK(added_mass(sea, m)(0, 0) == Approx(1025.0 * hemisphere * 1.5));
    options.coefficients[0].end_axial_drag_coefficient.reset();
    CHECK(parts(EngineeringSea(options, {}, tank, {body}), m).drag.force.x() == Approx(-1025.0 * 3.0 * disc));
  }
}

TEST_CASE("a spinning body feels the centripetal part of the relative acceleration", "[sea][fast]") {
  // One float 10 m off the axis: its points accelerate inwards by omega^2 r, the water at rest pushes outwards.
  SeaBody body{"arm", {}, {{"float", {{10, 0, -6}, {10, 0, 2}, 1.0, 1.0}}}};
  const EngineeringSea sea(model("morison"), {}, tank, {body});
  Motion m = at(0, 0, 0);
  m.omega = {0, 0, 0.5};
  CHECK(parts(sea, m).inertia.force.x() == Approx(1025.0 * pi * 6.0 * 0.25 * 10.0));
}

TEST_CASE("turning body, waves and current about the vertical turns the loads", "[sea][fast]") {
  const double angle = 0.9;
  const Eigen::Quaterniond q(Eigen::AngleAxisd(angle, Vector3d::UnitZ()));
  WavesOptions waves;
  waves.model = "airy", waves.height_m = 1.88, waves.period_s = 8.8, waves.direction = 0.2;
  SeaOptions options = model("morison");
  options.current_m_s = {0.5, -0.2, 0};
  Motion m = at(12, 5, 18);
  m.attitude = Eigen::AngleAxisd(0.2, Vector3d(1, -1, 0.5).normalized());
  m.velocity = {0.4, 0.3, -0.5};
  m.omega = {0.02, -0.03, 0.01};
  const EngineeringSea first(options, waves, tank, {platform(30.0)});
  waves.direction += angle;
  options.current_m_s = q * options.current_m_s;
  const EngineeringSea second(options, waves, tank, {platform(30.0)});
  Motion turned = m;
  turned.position = q * m.position, turned.attitude = q * m.attitude, turned.velocity = q * m.velocity;
  const Wrench a = load(first, m, 3.0), b = load(second, turned, 3.0);
  CHECK((q * a.force - b.force).norm() < 1e-9 * a.force.norm());
  CHECK((q * a.moment - b.moment).norm() < 1e-9 * (a.moment.norm() + a.force.norm()));
}

TEST_CASE("a slender pile standing on the bottom feels Morison's inertia force", "[sea][fast]") {
  // Linear theory: (1 + Ca) rho A (integral of du/dt over the depth) = (1 + Ca) rho A a omega^2 / k sin(omega t).
  const double radius = 0.5, height = 0.02;
  WavesOptions waves;
  waves.model = "airy", waves.height_m = height, waves.period_s = 8.8;
  const EngineeringSea sea(model("morison"), waves, tank, {spar(-20.6, 5, radius)});
  const auto w = waves::wave_properties(8.8, 20.6, 9.81);
  const double amplitude =
      2.0 * 1025.0 * pi * radius * radius * 0.5 * height * w.angular_frequency * w.angular_frequency / w.wave_number;
  CHECK(parts(sea, at(0, 0, 0), -2.2).inertia.force.x() == Approx(amplitude).epsilon(2e-3));  // a quarter period before the crest
  CHECK(parts(sea, at(0, 0, 0), 0.0).inertia.force.x() == Approx(0.0).margin(1e-3 * amplitude));
}

TEST_CASE("heave force on a float is the pressure on its keel: buoyancy and Froude-Krylov do not count twice", "[sea][fast]") {
  const double radius = 0.5, draft = 8.0, a = 0.01, area = pi * radius * radius;
  WavesOptions waves;
  waves.model = "airy", waves.height_m = 2 * a, waves.period_s = 6.0;
  SeaOptions options = model("morison");
  options.axial_added_mass_coefficient = 0.0;
  const EngineeringSea sea(options, waves, tank, {spar(-draft, 5, radius)});
  const double k = waves::wave_properties(6.0, 20.6, 9.81).wave_number;
  const double expected = 1025.0 * 9.81 * a * std::cosh(k * (20.6 - draft)) / std::cosh(k * 20.6) * area;
  const double still = 1025.0 * 9.81 * area * draft;
  CHECK(load(sea, at(0, 0, 0), 0.0).force.z() - still == Approx(expected).epsilon(0.01));
  CHECK(load(sea, at(0, 0, 0), 3.0).force.z() - still == Approx(-expected).epsilon(0.01));
  CHECK(expected < 0.5 * 1025.0 * 9.81 * a * area);  // well below the rise of the surface alone
}

TEST_CASE("waves that run past a wide float turn it by their slope at its keel", "[sea][fast]") {
  // Pressure on the sides of an upright cylinder has no arm about its axis but height: what is left is rho g I d eta/dx of the
  // keel.
  const double radius = 5.0, draft = 8.0, a = 0.01;
  WavesOptions waves;
  waves.model = "airy", waves.height_m = 2 * a, waves.period_s = 8.0;
  SeaOptions options = model("morison");
  options.added_mass_coefficient = options.axial_added_mass_coefficient = 0.0;
  options.drag_coefficient = options.axial_drag_coefficient = 0.0, options.strip_length_m = 0.25;
  const EngineeringSea sea(options, waves, tank, {spar(-draft, 5, radius)});
  const double k = waves::wave_properties(8.0, 20.6, 9.81).wave_number, quarter = 2.0;
  const double force = 1025.0 * pi * radius * radius * a * 9.81 / std::cosh(k * 20.6) *
                       (std::sinh(k * 20.6) - std::sinh(k * (20.6 - draft)));  // of Froude and Krylov, along x
  const double arm = (draft * std::sinh(k * 20.6) - (std::cosh(k * 20.6) - std::cosh(k * (20.6 - draft))) / k) /
                         (std::sinh(k * 20.6) - std::sinh(k * (20.6 - draft))) -
                     draft;
  const double keel =
      1025.0 * 9.81 * 0.25 * pi * std::pow(radius, 4) * a * k * std::cosh(k * (20.6 - draft)) / std::cosh(k * 20.6);
  const Wrench w = load(sea, at(0, 0, 0), -quarter).about(Eigen::Vector3d::Zero());
  CHECK(w.force.x() == Approx(force).epsilon(5e-3));
  CHECK(w.moment.y() == Approx(force * arm + keel).epsilon(2e-3));
}

TEST_CASE("water turns no round member about its own axis, however wet it is", "[sea][fast]") {
  WavesOptions waves;
  waves.model = "airy", waves.height_m = 0.2, waves.period_s = 12.0;
  const SeaEnvironment deep{1025.0, 400.0, 9.81};
  const double radius = 2.5, half_length = 10.0, k = waves::wave_properties(12.0, 400.0, 9.81).wave_number;
  SeaOptions inviscid = model("morison");
  inviscid.drag_coefficient = inviscid.axial_drag_coefficient = 0.0;
  // Pressure is square to a round wall, so either part alone turns it and both together do not, but for what waves change by
  // over a radius: k R.
  for (const double height : {-1.5, 0.0, 1.5})
    for (const Vector3d& axis : {Vector3d(0, 1, 0), Vector3d(0.5, std::sqrt(0.75), 0), Vector3d(0, 0.9, std::sqrt(0.19))}) {
      const Vector3d half = half_length * axis;
      const EngineeringSea sea(inviscid, waves, deep, {{"tube", {}, {{"tube", {-half, half, radius, radius}}}}});
      double both = 0.0, one = 0.0;
      for (const double t : {0.0, 1.5, 3.0, 4.5, 6.0}) {
        const SeaLoads loads = parts(sea, at(0, 0, height), t);
        both = std::max(both, std::abs(axis.dot(loads.buoyancy.moment + loads.inertia.moment)));
        one = std::max(one, std::abs(axis.dot(loads.buoyancy.moment)));
      }
      INFO("axis " << axis.transpose() << " at " << height << " m");
      CHECK(one > 1000.0);  // N m
      CHECK(both < k * radius * one);
    }
}

TEST_CASE("in long waves a float follows the surface: the loads give it just the acceleration of the water", "[sea][fast]") {
  // A buoy that moves and leans with the water needs force = mass (g + a) and no moment. Relative residual: of the order of k T
  // and k R.
  const double radius = 1.0, draft = 2.0, a = 0.5;
  for (const double period : {20.0, 40.0}) {
    WavesOptions waves;
    waves.model = "airy", waves.height_m = 2 * a, waves.period_s = period;
    const SeaEnvironment deep{1025.0, 4000.0, 9.81};
    const EngineeringSea sea(model("morison"), waves, deep, {spar(-draft, 3, radius)});
    const double mass = 1025.0 * pi * radius * radius * draft, k = waves::wave_properties(period, 4000.0, 9.81).wave_number;
    for (const double t : {0.0, 0.1 * period, 0.25 * period, 0.6 * period}) {
      const waves::Surface s = sea.waves().surface(t, 0, 0);
      const waves::Kinematics water = sea.waves().kinematics(t, {0, 0, s.elevation}, s.elevation);
      Motion m = at(0, 0, s.elevation);
      m.attitude = Eigen::AngleAxisd(-std::atan(s.slope_x), Vector3d::UnitY());  // the axis along the surface normal
      m.velocity = water.velocity;
      Eigen::Matrix<double, 6, 1> acceleration = Eigen::Matrix<double, 6, 1>::Zero();
      acceleration.head<3>() = water.acceleration;
      const Eigen::Matrix<double, 6, 1> water_inertia = added_mass(sea, m, t) * acceleration;
      const Vector3d residual =
          load(sea, m, t).force - water_inertia.head<3>() - mass * (water.acceleration + Vector3d(0, 0, 9.81));
      CHECK(residual.norm() < 4.0 * k * draft * mass * k * a * 9.81);  // against the wave force itself, rho V g k a
    }
  }
}

TEST_CASE("wave loads do not depend on the strip length to a ten-thousandth", "[sea][fast]") {
  WavesOptions waves;
  waves.model = "stokes2", waves.height_m = 1.88, waves.period_s = 8.8;
  const auto with = [&](double strip) {
    SeaOptions options = model("morison");
    options.strip_length_m = strip;
    return load(EngineeringSea(options, waves, tank, {platform(30.0)}), at(3, 0, 16), 2.0);
  };
  const Wrench exact = with(0.25);
  for (const double strip : {2.5, 5.0, 10.0}) CHECK((with(strip).force - exact.force).norm() < 1e-4 * 1e6);  // wave force: 1 MN
}

TEST_CASE("the parts add to the whole, and loads and added mass are the same together and apart", "[sea][fast]") {
  WavesOptions waves;
  waves.model = "jonswap", waves.height_m = 2.0, waves.period_s = 9.0;
  const EngineeringSea sea(model("morison"), waves, tank, {platform(30.0)});
  Motion m = at(3, 1, 16);
  m.velocity = {0.3, -0.2, 0.4};
  m.omega = {0.01, 0.02, -0.03};
  const SeaLoads p = parts(sea, m, 12.0);
  Wrench sum = p.buoyancy;
  sum += p.inertia, sum += p.drag, sum += p.damping;
  const Wrench whole = load(sea, m, 12.0);
  CHECK((sum.force - whole.force).norm() < 1e-12 * whole.force.norm());
  CHECK((sum.moment - whole.moment).norm() < 1e-12 * whole.force.norm());
  Wrench together;
  together.point = m.position;
  Matrix6 mass = Matrix6::Zero();
  sea.add(12.0, {&m, 1}, {&together, 1}, {&mass, 1});
  CHECK(together.force == whole.force);
  CHECK(mass == added_mass(sea, m, 12.0));
  CHECK(sea.elevation(3.0, 1.0, 12.0) == sea.waves().elevation(12.0, 3.0, 1.0));
}

TEST_CASE("a pontoon rises out of the water without a jump in its loads", "[sea][fast]") {
  // Lying, then nearly lying: every kind of cut is passed; steps of 1 mm may change the load by no more than a smooth change
  // would.
  for (const double tilt : {0.0, 1e-6, 0.01, 0.3}) {
    const Vector3d axis(std::cos(tilt), 0, std::sin(tilt));
    SeaOptions options = model("morison");
    options.current_m_s = {0.3, 0.8, 0};
    const EngineeringSea sea(options, {}, tank, {SeaBody{"pontoon", {}, {{"p", {-6.0 * axis, 6.0 * axis, 1.0, 1.0}}}}});
    Wrench before = load(sea, at(0, 0, -4));
    for (double z = -4.0 + 1e-3; z < 4.0; z += 1e-3) {
      const Wrench now = load(sea, at(0, 0, z));
      REQUIRE((now.force - before.force).norm() < 1025.0 * 9.81 * 30.0 * 1e-3);
      REQUIRE((now.moment - before.moment).norm() < 1025.0 * 9.81 * 200.0 * 1e-3);
      before = now;
    }
    CHECK(before.force.norm() == 0.0);
  }
}

TEST_CASE("names that do not exist and options without effect are told", "[sea][fast]") {
  const std::vector<SeaBody> bodies = {platform(30.0)};
  SeaOptions options = model("hydrostatic");
  WavesOptions waves;
  CHECK(sea_problems(options, waves, bodies).empty());
  CHECK(sea_problems(model("none"), waves, {}).empty());
  waves.model = "airy";
  options.coefficients.push_back({"flaot_1", 1.0, {}, {}, {}});
  options.damping.push_back({"plattform", {}, {}, {}});
  const auto problems = sea_problems(options, waves, bodies);
  REQUIRE(problems.size() == 3);
  CHECK(problems[0].key == "waves.model");
  CHECK(problems[1].key == "sea.coefficients[0].cylinder");
  CHECK(problems[1].what.find("known: float_1, float_2, float_3") != std::string::npos);
  CHECK(problems[2].key == "sea.damping[0].body");
  CHECK(sea_problems(model("morison"), {}, {SeaBody{"rotor", {}, {}}}).size() == 1);
}

TEST_CASE("coefficients of strips have no effect in potential flow without cylinders", "[sea][fast]") {
  SeaOptions options = model("potential");
  options.potential.emplace().body = "hull";
  options.potential->hydrostatics_file = "hull.hst";
  const auto keys = [&](const SeaBody& hull) {
    std::vector<std::string> found;
    for (const OptionProblem& p : sea_problems(options, {}, {hull}))
      if (p.what.rfind("has no effect", 0) == 0) found.push_back(p.key);
    return found;
  };
  CHECK(keys({"hull", {}, {}}).empty());
  options.drag_coefficient = 1.2, options.axial_drag_coefficient = 0.5, options.strip_length_m = 2.0;
  CHECK(keys({"hull", {}, {}}) ==
        std::vector<std::string>{"sea.drag_coefficient", "sea.axial_drag_coefficient", "sea.strip_length_m"});
  SeaBody spar_hull = spar(-10.0, 5.0, 1.0);
  spar_hull.name = "hull";
  CHECK(keys(spar_hull).empty());
}

TEST_CASE("a cylinder below the sea bed or without length is told", "[sea][fast]") {
  const SeaEnvironment deep{1025.0, 40.0, 9.81};
  SeaBody floating = platform(14.0);
  CHECK(shape_problems(tank, {floating}).empty());
  floating.initial.position.z() = -8.0;  // keel at -22 m in 20.6 m of water
  REQUIRE(shape_problems(tank, {floating}).size() == 3);
  CHECK(shape_problems(tank, {floating})[2].key == "bodies.platform.cylinders[2]");
  CHECK(shape_problems(deep, {floating}).empty());
  floating.cylinders[1].shape.end = floating.cylinders[1].shape.start;
  REQUIRE(shape_problems(deep, {floating}).size() == 1);
  CHECK(shape_problems(deep, {floating})[0].what.find("no length") != std::string::npos);
}

TEST_CASE("the sections of the scene are well declared", "[sea][fast]") {
  for (const std::string& fault : sea_section().faults()) FAIL_CHECK(fault);
  for (const std::string& fault : waves_section().faults()) FAIL_CHECK(fault);
}

TEST_CASE("a current that changes with depth acts level by level", "[sea][fast]") {
  SeaOptions options = model("morison");
  options.drag_coefficient = 0.7, options.axial_drag_coefficient = 0.0, options.strip_length_m = 0.25;
  options.current_m_s = {0.5, 0, 0};
  options.current_profile = {{-10.0, -0.5, 0.0}, {0.0, 1.5, 0.0}};  // 0 at the keel, 2 m/s at the surface, in a straight line
  const EngineeringSea sea(options, {}, tank, {spar(-10, 5, 2)});
  const double unit = 0.5 * 1025.0 * 0.7 * 4.0;
  CHECK(parts(sea, at(0, 0, 0)).drag.force.x() == Approx(unit * 4.0 * 10.0 / 3.0).epsilon(1e-9));  // of v^2 over the depth
  CHECK(sea.water(0.0, {3, 0, -5}).velocity.x() == Approx(1.0));
  CHECK(sea.water(0.0, {3, 0, -15}).velocity.x() == Approx(0.0).margin(1e-15));
  CHECK(sea.water(0.0, {3, 0, 1}).velocity.x() == Approx(2.0));
}

TEST_CASE("waves that scatter at a wide column load it as MacCamy and Fuchs have it", "[sea][fast]") {
  // Force on a column from the bed up: 4 rho g a tanh(kh) / k^2 / |H_1'(ka)| (MacCamy & Fuchs 1954).
  const double radius = 8.0, amplitude = 1e-3, period = 6.0;
  const double k = waves::wave_number(2.0 * pi / period, 20.6, 9.81), ka = k * radius;  // ka = 0.92
  WavesOptions waves;
  waves.model = "airy", waves.height_m = 2.0 * amplitude, waves.period_s = period;
  SeaOptions options = model("morison");
  options.drag_coefficient = 0.0, options.axial_drag_coefficient = 0.0, options.strip_length_m = 0.5;
  CoefficientsOptions own;
  own.cylinder = "column", own.diffraction = "maccamy_fuchs";
  const auto largest = [&] {
    const EngineeringSea sea(options, waves, tank, {spar(-20.599, 5, radius)});
    double most = 0.0;
    for (int i = 0; i < 400; ++i) most = std::max(most, std::abs(parts(sea, at(0, 0, 0), period * i / 400.0).inertia.force.x()));
    return most;
  };
  const double slender = largest();
  options.coefficients = {own};
  const double j = std::cyl_bessel_j(0.0, ka) - std::cyl_bessel_j(1.0, ka) / ka,
               y = std::cyl_neumann(0.0, ka) - std::cyl_neumann(1.0, ka) / ka;
  const double expected = 4.0 * 1025.0 * 9.81 * amplitude * std::tanh(k * 20.6) / (k * k) / std::hypot(j, y);
  CHECK(largest() == Approx(expected).epsilon(2e-3));
  CHECK(slender > 1.1 * expected);  // Morison with 1 + C_a = 2
  // Pressure on an upright wall has no arm but its height: on a pile about the bed that of cosh k(z + h).
  const double depth = 20.6, kh = k * depth, arm = (kh * std::sinh(kh) - std::cosh(kh) + 1.0) / (k * std::sinh(kh));
  const EngineeringSea pile(options, waves, tank, {spar(-depth, 5, radius)});
  const Motion rest = at(0, 0, 0);
  double force = 0.0, overturning = 0.0;
  for (int i = 0; i < 400; ++i) {
    const Wrench w = load(pile, rest, period * i / 400.0);
    force = std::max(force, std::abs(w.force.x()));
    overturning = std::max(overturning, std::abs(w.about(Eigen::Vector3d(0, 0, -depth)).moment.y()));
  }
  CHECK(overturning == Approx(force * arm).epsilon(5e-3));
  // Motion of the column itself has C_a as before.
  const EngineeringSea sea(options, waves, tank, {spar(-20.599, 5, radius)});
  options.coefficients.clear();
  const EngineeringSea plain(options, waves, tank, {spar(-20.599, 5, radius)});
  CHECK((added_mass(sea, at(0, 0, 0)) - added_mass(plain, at(0, 0, 0))).norm() == 0.0);
}

TEST_CASE("diffraction without effect is refused by name", "[sea][fast]") {
  SeaOptions options = model("morison");
  CoefficientsOptions own;
  own.cylinder = "column", own.diffraction = "maccamy_fuchs";
  options.coefficients = {own};
  WavesOptions waves;
  REQUIRE(sea_problems(options, waves, {spar(-10, 5, 2)}).size() == 1);
  CHECK(sea_problems(options, waves, {spar(-10, 5, 2)})[0].key == "sea.coefficients[0].diffraction");
  waves.model = "airy", waves.height_m = 1.0, waves.period_s = 8.0;
  CHECK(sea_problems(options, waves, {spar(-10, 5, 2)}).empty());
  waves.model = "stream_function";
  CHECK(sea_problems(options, waves, {spar(-10, 5, 2)}).size() == 1);
}
