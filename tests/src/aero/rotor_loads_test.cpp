// Laws of src/aero/rotor_loads.hpp: where the rotor is, how it turns, and where its load goes.
// SPDX-License-Identifier: Apache-2.0
#include "src/aero/rotor_loads.hpp"

#include <catch2/catch.hpp>

#include "kernels/base/constants.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using Eigen::Quaterniond;
using Eigen::Vector3d;

namespace {

/// Platform (0) and rotor (1) of the paper's turbine; the rotor's centre of mass 2 m upwind of the hub, its axes not the earth's.
std::vector<Motion> start() {
  Motion platform, rotor;
  platform.position = {0, 0, -4};
  platform.attitude = Eigen::AngleAxisd(0.2, Vector3d(0, 1, 1).normalized());
  rotor.position = {-2, 0, 119};
  rotor.attitude = Eigen::AngleAxisd(1.1, Vector3d(1, -2, 0.5).normalized());
  return {platform, rotor};
}

/// The pair after the platform has pitched about the origin and the rotor has turned in its bearing.
std::vector<Motion> moved(double pitch, double azimuth, double speed, double pitch_rate) {
  auto bodies = start();
  const Quaterniond tilt(Eigen::AngleAxisd(pitch, Vector3d::UnitY())), spin(Eigen::AngleAxisd(azimuth, Vector3d::UnitX()));
  for (Motion& b : bodies) b.position = tilt * b.position;
  bodies[0].attitude = tilt * bodies[0].attitude;
  bodies[1].attitude = tilt * spin * bodies[1].attitude;
  const Vector3d rate = pitch_rate * Vector3d::UnitY(), rotor_rate = rate + speed * (tilt * Vector3d::UnitX());
  bodies[0].omega = bodies[0].attitude.conjugate() * rate;
  bodies[1].omega = bodies[1].attitude.conjugate() * rotor_rate;
  for (Motion& b : bodies) b.velocity = rate.cross(b.position);
  return bodies;
}

const RotorPlacement bearing{.body = 1, .support = 0, .hub = {0, 0, 119}, .axis = {2, 0, 0}};
const WindSite site{{0, 0, 119}, 178.33};

std::vector<Wrench> loads(const RotorLoads& rotor, double t, const std::vector<Motion>& bodies, double ramp = 1.0) {
  std::vector<Wrench> w(bodies.size());
  for (std::size_t i = 0; i < w.size(); ++i) w[i].point = bodies[i].position;
  rotor.add_loads(t, bodies, w, ramp);
  rotor.add_tower_drag(t, bodies, w, ramp);
  return w;
}

AeroOptions constant_thrust() {
  AeroOptions o;
  o.model = "prescribed", o.thrust_N = 1.5e6, o.torque_N_m = 1e7;
  return o;
}

AeroOptions analytic_law() {
  AeroOptions o;
  o.model = "thrust_curve", o.thrust_coefficient = 0.8;
  return o;
}

RotorOptions turbine() {
  RotorOptions o;
  o.body = "rotor", o.joint = "bearing", o.diameter_m = 178.33;
  return o;
}

}  // namespace

TEST_CASE("thrust acts at the hub along the axis and follows the tilt of the tower", "[aero][fast]") {
  const RotorLoads rotor(constant_thrust(), turbine(), {}, 1.225, bearing, start());
  const double pitch = GENERATE(0.0, 0.09, -0.5), azimuth = GENERATE(0.0, 2.5);
  const auto bodies = moved(pitch, azimuth, 0.9, 0.01);
  const auto w = loads(rotor, 3.0, bodies);
  const Vector3d axis(std::cos(pitch), 0, -std::sin(pitch));
  CHECK((w[1].force - 1.5e6 * axis).norm() < 1e-6);
  CHECK((w[1].moment - 1e7 * axis).norm() < 1e-4);  // the hub is on the rotor's axis: thrust has no arm about its centre
  CHECK(w[0].force == Vector3d::Zero());
  CHECK(w[1].about(Vector3d::Zero()).moment.y() == Approx(119 * 1.5e6));
}

TEST_CASE("azimuth and speed are those of the bearing, whatever the platform does", "[aero][fast]") {
  RotorOptions options = turbine();
  options.azimuth = 0.25;
  const RotorLoads rotor(constant_thrust(), options, {}, 1.225, bearing, start());
  const double azimuth = GENERATE(0.0, 1.0, 3.5, 6.0, -1.0, 40.0);
  const RotorState now = rotor.state(7.0, moved(0.3, azimuth, 0.9, 0.2));
  CHECK(std::remainder(now.azimuth - (azimuth + 0.25), 2 * pi) == Approx(0.0).margin(1e-12));
  CHECK(now.azimuth >= 0.0);
  CHECK(now.azimuth < 2 * pi);
  CHECK(now.speed == Approx(0.9));
  CHECK((now.hub_velocity - Vector3d(0, 0.2, 0).cross(now.hub)).norm() < 1e-12);
}

TEST_CASE("a tower's drag is on what carries the rotor, not on a rotor that turns in its bearing", "[aero][fast]") {
  AeroOptions aero = analytic_law();
  aero.tower.emplace().stations = {{0.0, 8.3, 1.0}, {115.0, 5.5, 0.9}};
  aero.tower->foot_m = {7.0, 0.0};
  const WindOptions wind{.speed_m_s = 11.0, .direction = pi / 6};
  const auto load_of = [&](const RotorPlacement& place) {
    return loads(RotorLoads(aero, turbine(), wind_of(wind, site), 1.225, place, start()), 0.0, start());
  };
  const auto turned = load_of(bearing);
  CHECK(std::abs(turned[1].moment.x()) < 1e-6);
  CHECK(turned[1].force.y() == Approx(0.0).margin(1e-6));
  CHECK(turned[0].force.y() > 1e4);
  RotorPlacement on_earth = bearing;
  on_earth.support = RotorPlacement::earth;
  const auto alone = load_of(on_earth);
  CHECK(alone[0].force.norm() == 0.0);
  CHECK((alone[1].force - turned[1].force).norm() < 1e-6);
  const auto whole = load_of({.body = 0, .support = std::nullopt, .hub = bearing.hub});
  CHECK((whole[0].force - turned[0].force - turned[1].force).norm() < 1e-6);
}

TEST_CASE("a rotor without a body of its own turns by its given speed", "[aero][fast]") {
  RotorOptions options = turbine();
  options.joint = "", options.speed = 0.9, options.azimuth = 1.0;
  AeroOptions aero = constant_thrust();
  aero.thrust_cosine_N = {1e5};
  const RotorLoads rotor(aero, options, {}, 1.225, {.body = 0, .support = std::nullopt, .hub = {0, 0, 119}}, start());
  const auto w = loads(rotor, 10.0, start());
  CHECK(w[0].force.x() == Approx(1.5e6 + 1e5 * std::cos(10.0)));  // azimuth 1 + 0.9 * 10
  CHECK(w[1].force == Vector3d::Zero());
  CHECK(rotor.load(0.0, rotor.state(0.0, start())).power == Approx(0.9e7));
}

TEST_CASE("a hub that moves downwind feels less wind and less thrust: damping of pitch by dT/dU", "[aero][fast]") {
  const WindOptions wind{.speed_m_s = 11.0};
  const RotorLoads rotor(analytic_law(), turbine(), wind_of(wind, site), 1.225, bearing, start());
  const double still = loads(rotor, 0.0, moved(0.0, 0.0, 0.9, 0.0))[1].force.x();
  const double rate = 1e-4, forward = loads(rotor, 0.0, moved(0.0, 0.0, 0.9, rate))[1].force.x();
  const double area = pi / 4 * 178.33 * 178.33;
  CHECK(still == Approx(0.5 * 1.225 * area * 0.8 * 121.0));
  CHECK((forward - still) / (119 * rate) == Approx(-1.225 * area * 0.8 * 11.0).epsilon(1e-3));
}

TEST_CASE("wind across the axis makes no thrust, wind from behind makes it negative", "[aero][fast]") {
  WindOptions wind{.speed_m_s = 11.0, .direction = GENERATE(0.0, 0.4, 0.5 * pi, pi)};
  const RotorLoads rotor(analytic_law(), turbine(), wind_of(wind, site), 1.225, bearing, start());
  const double along = 11.0 * std::cos(wind.direction);
  CHECK(rotor.state(0.0, start()).relative_wind == Approx(along).margin(1e-12));
  const double expected = 0.5 * 1.225 * pi / 4 * 178.33 * 178.33 * 0.8 * along * std::abs(along);
  CHECK(loads(rotor, 0.0, start())[1].force.x() == Approx(expected).margin(1e-6));
}

TEST_CASE("a hub feels the wind of its height, and blades that of theirs: shear lifts the rotor's nose", "[aero][fast]") {
  const WindOptions uniform{.speed_m_s = 11.0};
  WindOptions low{.speed_m_s = 11.0};
  low.law = GENERATE(WindLaw::power, WindLaw::logarithmic), low.reference_height_m = 30.0;
  const double share = wind_profile(low).share(119.0);
  CHECK(share > 1.05);
  CHECK(RotorLoads(analytic_law(), turbine(), wind_of(low, site), 1.225, bearing, start()).state(0.0, start()).relative_wind ==
        Approx(11.0 * share));

  AeroOptions aero;
  aero.model = "bem";
  RotorOptions options = turbine();
  options.turbine = SPINDRIFT_SOURCE_DIR "/inputs/turbines/dtu_10mw.toml";
  WindOptions sheared{.speed_m_s = 11.0};
  sheared.law = low.law, sheared.reference_height_m = 119.0;
  const RotorLoads even(aero, options, wind_of(uniform, site), 1.225, bearing, start()),
      over_height(aero, options, wind_of(sheared, site), 1.225, bearing, start());
  Vector3d force[2] = {Vector3d::Zero(), Vector3d::Zero()}, moment[2] = {Vector3d::Zero(), Vector3d::Zero()};
  constexpr int azimuths = 8;
  for (int n = 0; n < azimuths; ++n) {
    const auto bodies = moved(0.0, 2.0 * pi / 3.0 * n / azimuths, 0.925, 0.0);
    int which = 0;
    for (const RotorLoads* rotor : {&even, &over_height}) {
      const RotorLoad load = rotor->load(0.0, rotor->state(0.0, bodies));
      force[which] += load.force / azimuths, moment[which++] += load.moment / azimuths;
    }
  }
  CHECK(std::abs(moment[0].y()) < 1e-3 * moment[0].x());
  CHECK(moment[1].y() > 0.02 * moment[1].x());                // more wind above the hub: a moment that pitches the nose up
  CHECK(force[1].x() == Approx(force[0].x()).epsilon(0.03));  // what the top gains the bottom loses
}

TEST_CASE("a ramp scales load and power, and no model means no load", "[aero][fast]") {
  const RotorLoads rotor(constant_thrust(), turbine(), {}, 1.225, bearing, start());
  const auto bodies = moved(0.1, 0.5, 0.9, 0.0);
  CHECK((loads(rotor, 0.0, bodies, 0.25)[1].force - 0.25 * loads(rotor, 0.0, bodies)[1].force).norm() < 1e-9);
  const RotorLoad load = rotor.load(0.0, rotor.state(0.0, bodies), 0.25);
  CHECK(load.thrust == Approx(0.25 * 1.5e6));
  CHECK(load.power == Approx(0.25 * 1e7 * 0.9));
  const RotorLoads idle({}, turbine(), {}, 1.225, bearing, start());
  CHECK(loads(idle, 0.0, bodies)[1].force == Vector3d::Zero());
}

TEST_CASE("the load is the same in every frame of reference that a turned scene stands for", "[aero][fast]") {
  const WindOptions wind{.speed_m_s = 11.0, .direction = 0.3};
  const RotorLoads rotor(analytic_law(), turbine(), wind_of(wind, site), 1.225, bearing, start());
  const auto before = moved(0.1, 0.5, 0.9, 0.02);
  const Quaterniond turn(Eigen::AngleAxisd(0.7, Vector3d::UnitZ()));
  auto after = before;
  for (Motion& b : after) b.position = turn * b.position, b.velocity = turn * b.velocity, b.attitude = turn * b.attitude;
  WindOptions turned = wind;
  turned.direction += 0.7;
  const RotorLoads same(analytic_law(), turbine(), wind_of(turned, site), 1.225, bearing, start());
  const auto w = loads(rotor, 0.0, before), v = loads(same, 0.0, after);
  CHECK((v[1].force - turn * w[1].force).norm() < 1e-6);
  CHECK((v[1].moment - turn * w[1].moment).norm() < 1e-4);
}

TEST_CASE("the same scene with bem in place of a curve: the rotor in its bearing is the rotor by itself", "[aero][fast]") {
  AeroOptions aero;
  aero.model = "bem";
  RotorOptions options = turbine();
  options.turbine = SPINDRIFT_SOURCE_DIR "/inputs/turbines/dtu_10mw.toml";
  options.blade_pitch = 0.02, options.azimuth = 0.3;
  const WindOptions wind{.speed_m_s = 11.0, .direction = 0.1};
  const RotorLoads rotor(aero, options, wind_of(wind, site), 1.225, bearing, start());
  const double speed = 0.925, pitch_rate = 0.02;
  const auto bodies = moved(0.09, 0.7, speed, pitch_rate);
  const Vector3d axis(std::cos(0.09), 0, -std::sin(0.09)), up(std::sin(0.09), 0, std::cos(0.09));
  const BladeElementMomentum alone(read_turbine(options.turbine), "madsen", 1.225);
  const Vector3d hub = 119 * up, rate(0, pitch_rate, 0);
  const DiscLoad disc =
      alone(11.0 * Vector3d(std::cos(0.1), std::sin(0.1), 0), {rate.cross(hub), rate + speed * axis, axis, up, 1.0, 0.02});
  const auto w = loads(rotor, 0.0, bodies);
  CHECK((w[1].force - disc.force).norm() < 1e-6 * disc.force.norm());
  CHECK((w[1].about(hub).moment - disc.moment).norm() < 1e-6 * disc.moment.norm());
  const RotorLoad load = rotor.load(0.0, rotor.state(0.0, bodies));
  CHECK(load.power == Approx(disc.moment.dot(axis) * speed));
  // Without a body of its own the rotor spins by rotor.speed_rpm, with the same load.
  options.joint = "", options.speed = speed, options.azimuth = 1.0;
  const RotorLoads fixed(aero, options, wind_of(wind, site), 1.225, {.body = 0, .support = std::nullopt, .hub = {0, 0, 119}},
                         start());
  CHECK((loads(fixed, 0.0, bodies)[0].force - disc.force).norm() < 1e-6 * disc.force.norm());
}

TEST_CASE("a drive train that air computed elsewhere turns does what it does under the same load of its own model",
          "[aero][fast]") {
  RotorOptions options = turbine();
  options.joint = "", options.speed = 0.8, options.blade_pitch = 0.05;
  options.operation = SPINDRIFT_SOURCE_DIR "/inputs/turbines/dtu_10mw_operation.csv";
  ControlOptions control;
  control.model = ControlModel::dtu, control.file = SPINDRIFT_SOURCE_DIR "/inputs/turbines/dtu_10mw_controller.toml";
  const WindOptions wind{.speed_m_s = 12.0};
  const RotorPlacement place{.body = 0, .support = std::nullopt, .hub = {0, 0, 119}};
  const auto bodies = moved(0.09, 0.0, 0.0, 0.02);
  RotorLoads own(constant_thrust(), options, wind_of(wind, site), 1.225, place, start(), control, 0.05),
      other({}, options, wind_of(wind, site), 1.225, place, start(), control, 0.05);
  const Vector3d axis = own.state(0.0, bodies).axis;
  const HubLoad air{1.5e6 * axis, 1e7 * axis};
  other.turn_by([&](double) { return air.moment; });
  std::vector<double> a(own.memory_size()), b(other.memory_size());
  own.begin(0.0, bodies, a), other.begin(0.0, bodies, b);
  for (int n = 1; n <= 40; ++n) {
    own.recall(a), other.recall(b);
    own.remember(0.05 * n, 0.05, bodies, a), other.remember(0.05 * n, 0.05, bodies, b);
  }
  own.recall(a), other.recall(b);
  const RotorState now = own.state(2.0, bodies);
  CHECK(std::abs(now.speed - 0.8) > 1e-3);
  CHECK(other.state(2.0, bodies).speed == Approx(now.speed).epsilon(1e-12));
  CHECK(other.drive().generator_torque == Approx(own.drive().generator_torque).epsilon(1e-12));
  std::vector<Wrench> w(bodies.size());
  for (std::size_t i = 0; i < w.size(); ++i) w[i].point = bodies[i].position;
  other.add_air_load(2.0, bodies, w, air, 0.5);
  const auto expected = loads(own, 2.0, bodies, 0.5);
  CHECK((w[0].force - expected[0].force).norm() < 1e-6);
  CHECK((w[0].moment - expected[0].moment).norm() < 1e-3);
  // Half the shaft's torque acts on the body, the whole of the air's turns the rotor.
  const double half = own.load(2.0, now, 0.5).moment.dot(axis), whole = own.load(2.0, now, 1.0).moment.dot(axis);
  CHECK(half == Approx(0.5 * whole));
}

TEST_CASE("mean loads of a controlled rotor have its gyroscopic moment once, as a spinning body has it", "[aero][fast]") {
  RotorOptions options = turbine();
  options.joint = "", options.speed = 0.8;
  options.operation = SPINDRIFT_SOURCE_DIR "/inputs/turbines/dtu_10mw_operation.csv";
  ControlOptions control;
  control.model = ControlModel::dtu, control.file = SPINDRIFT_SOURCE_DIR "/inputs/turbines/dtu_10mw_controller.toml";
  const RotorPlacement place{.body = 0, .support = std::nullopt, .hub = {0, 0, 119}};
  const RotorLoads rotor(constant_thrust(), options, {}, 1.225, place, start(), control, 0.05);
  const auto mean_moment = [&](double pitch_rate) {
    const auto bodies = moved(0.0, 0.0, 0.0, pitch_rate);
    std::vector<Wrench> w(bodies.size());
    for (std::size_t i = 0; i < w.size(); ++i) w[i].point = bodies[i].position;
    rotor.add_mean_loads(0.0, bodies, w);
    return w[0].moment;
  };
  const double rate = 0.02;
  const Vector3d momentum = rotor.control()->drive_train().rotor_inertia_kg_m2 * 0.8 * Vector3d::UnitX();
  const Vector3d gyroscopic = -rate * Vector3d::UnitY().cross(momentum);
  CHECK((mean_moment(rate) - mean_moment(0.0) - gyroscopic).norm() < 1e-9 * gyroscopic.norm());
}

namespace {

// Everything as seen in a mirror, the plane y = 0: vectors, and what turns.
Vector3d mirrored(const Vector3d& v) { return {v.x(), -v.y(), v.z()}; }
Vector3d mirrored_turn(const Vector3d& v) { return {-v.x(), v.y(), -v.z()}; }
std::vector<Motion> mirrored(std::vector<Motion> bodies) {
  for (Motion& b : bodies) {
    b.position = mirrored(b.position), b.velocity = mirrored(b.velocity), b.omega = mirrored_turn(b.omega);
    b.attitude = {b.attitude.w(), -b.attitude.x(), b.attitude.y(), -b.attitude.z()};
  }
  return bodies;
}

/// A motion of the pair that is the same in no mirror: it pitches, rolls and drifts.
std::vector<Motion> swinging(double t) {
  const Quaterniond tilt(Eigen::AngleAxisd(0.08 * std::sin(0.5 * t), Vector3d(0.3, 1, 0.2).normalized())),
      spin(Eigen::AngleAxisd(0.9 * t, Vector3d::UnitX()));
  const Vector3d rate = tilt * Vector3d(0.04 * std::cos(0.5 * t) * Vector3d(0.3, 1, 0.2).normalized()), drift(0.5, 0.3, -0.1);
  auto bodies = start();
  for (Motion& b : bodies) {
    b.position = tilt * b.position + t * drift;
    b.velocity = drift + rate.cross(b.position - t * drift);
  }
  bodies[0].attitude = tilt * bodies[0].attitude, bodies[1].attitude = tilt * spin * bodies[1].attitude;
  bodies[0].omega = bodies[0].attitude.conjugate() * rate;
  bodies[1].omega = bodies[1].attitude.conjugate() * (rate + tilt * Vector3d(0.9, 0, 0));
  return bodies;
}

}  // namespace

TEST_CASE("a model of stall that does not exist is refused, not left out", "[aero][fast]") {
  AeroOptions aero;
  aero.model = "bem";
  RotorOptions options = turbine();
  options.turbine = SPINDRIFT_SOURCE_DIR "/inputs/turbines/dtu_10mw.toml";
  CHECK_NOTHROW(BladeLoads(aero, options, 1.225));
  aero.dynamic_stall = "oyee";
  CHECK_THROWS_WITH(BladeLoads(aero, options, 1.225), Catch::Contains("oyee"));
}

TEST_CASE("a rotor that turns the other way is the mirror image of one that does not", "[aero][fast]") {
  const bool in_bearing = GENERATE(true, false), bends = GENERATE(false, true), controlled = GENERATE(false, true);
  if (in_bearing && (bends || controlled)) return;
  AeroOptions aero;
  aero.model = "bem", aero.dynamic_inflow = "oye", aero.dynamic_stall = "beddoes_leishman";
  aero.tower.emplace().foot_m = {7.0, 1.0};
  aero.tower->stations = {{0.0, 8.3, 1.0}, {115.0, 5.5, 0.9}};
  AeroOptions aero_seen = aero;
  aero_seen.tower->foot_m[1] = -1.0;
  RotorOptions options = turbine();
  options.turbine = SPINDRIFT_SOURCE_DIR "/inputs/turbines/dtu_10mw.toml";
  options.azimuth = 0.3, options.blade_pitch = 0.02, options.speed = 0.9;
  const std::string table = SPINDRIFT_SOURCE_DIR "/inputs/turbines/dtu_10mw/";
  (bends ? options.blade_structure : options.blade_masses) = table + (bends ? "blade_structure.csv" : "blade_masses.csv");
  ControlOptions control;
  if (controlled)
    control.model = ControlModel::dtu, control.file = SPINDRIFT_SOURCE_DIR "/inputs/turbines/dtu_10mw_controller.toml";
  options.operation = SPINDRIFT_SOURCE_DIR "/inputs/turbines/dtu_10mw_operation.csv";
  const Vector3d weight(0, 0, -9.81);
  WindOptions wind{.speed_m_s = 11.0, .direction = 0.2};
  wind.law = WindLaw::power, wind.reference_height_m = 119.0;
  WindOptions wind_seen = wind;
  wind_seen.direction = -0.2;
  RotorPlacement place{.body = in_bearing ? 1 : 0, .support = {}, .hub = {0, 0, 119}, .axis = {1, 0, 0}};
  if (in_bearing) place.support = 0;
  RotorPlacement place_seen = place;
  place_seen.sense = -1.0;
  const double h = 0.02;
  RotorLoads rotor(aero, options, wind_of(wind, site), 1.225, place, start(), control, h, weight),
      seen(aero_seen, options, wind_of(wind_seen, site), 1.225, place_seen, mirrored(start()), control, h, weight);
  std::vector<double> memory(rotor.memory_size()), memory_seen(seen.memory_size());
  rotor.begin(0.0, swinging(0.0), memory), seen.begin(0.0, mirrored(swinging(0.0)), memory_seen);
  double t = 0.0;
  for (int n = 1; n <= 20; ++n) {
    t = n * h;
    rotor.remember(t, h, swinging(t), memory), seen.remember(t, h, mirrored(swinging(t)), memory_seen);
    rotor.recall(memory), seen.recall(memory_seen);
  }
  const auto bodies = swinging(t), bodies_seen = mirrored(bodies);
  const RotorState a = rotor.state(t, bodies), b = seen.state(t, bodies_seen);
  CHECK(b.speed == Approx(a.speed).epsilon(1e-12));
  CHECK(a.speed > 0.5);
  CHECK(b.azimuth == Approx(a.azimuth).epsilon(1e-12));
  CHECK((b.omega - mirrored_turn(a.omega)).norm() < 1e-12);
  const RotorLoad load = rotor.load(t, a), load_seen = seen.load(t, b);
  CHECK(load.torque > 1e6);
  CHECK(load_seen.thrust == Approx(load.thrust).epsilon(1e-10));
  CHECK(load_seen.torque == Approx(load.torque).epsilon(1e-9));
  CHECK(load_seen.power == Approx(load.power).epsilon(1e-9));
  CHECK((load_seen.force - mirrored(load.force)).norm() < 1e-10 * load.force.norm());
  CHECK((load_seen.moment - mirrored_turn(load.moment)).norm() < 1e-9 * load.moment.norm());
  CHECK(std::abs(load.force.y()) > 1e-3 * load.force.norm());  // the motion is no mirror image of itself
  const Vector3d accelerates(0.3, 0.2, -0.1), turns(0.01, 0.02, 0.03);
  const auto roots = rotor.root_loads(t, bodies, accelerates, turns, weight),
             roots_seen = seen.root_loads(t, bodies_seen, mirrored(accelerates), mirrored_turn(turns), weight);
  REQUIRE(roots.size() == 3);
  for (std::size_t n = 0; n < 3; ++n) {
    CHECK(roots_seen[n].downwind == Approx(roots[n].downwind).epsilon(1e-9));
    CHECK(roots_seen[n].ahead == Approx(roots[n].ahead).epsilon(1e-9));
    CHECK(roots_seen[n].outward == Approx(roots[n].outward).epsilon(1e-9));
    CHECK(roots_seen[n].flap == Approx(roots[n].flap).epsilon(1e-9));
    CHECK(roots_seen[n].edge == Approx(roots[n].edge).epsilon(1e-9));
  }
  if (bends) {
    const auto tips = rotor.tips(t, bodies), tips_seen = seen.tips(t, bodies_seen);
    for (std::size_t n = 0; n < 3; ++n) CHECK((tips_seen[n] - tips[n]).norm() < 1e-9);
    Eigen::Matrix<double, 6, 6> added[2] = {Eigen::Matrix<double, 6, 6>::Zero(), Eigen::Matrix<double, 6, 6>::Zero()};
    rotor.add_added_mass(t, bodies, std::span(&added[0], 1)), seen.add_added_mass(t, bodies_seen, std::span(&added[1], 1));
    Eigen::Matrix<double, 6, 1> mirror;
    mirror << 1, -1, 1, -1, 1, -1;
    CHECK((mirror.asDiagonal() * added[0] * mirror.asDiagonal() - added[1]).norm() < 1e-9 * added[0].norm());
  }
  if (controlled) CHECK(seen.drive().generator_torque == Approx(rotor.drive().generator_torque).epsilon(1e-10));
}
