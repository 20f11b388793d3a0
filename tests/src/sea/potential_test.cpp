// Cummins' equation with a memory that has a closed form: a heaving body decays as the eigenvalues of the equivalent fourth-order
// system say, and answers waves as the frequency domain says.
// SPDX-License-Identifier: Apache-2.0
#include "src/sea/potential.hpp"

#include <catch2/catch.hpp>

#include <unistd.h>

#include <Eigen/Eigenvalues>
#include <complex>
#include <filesystem>
#include <fstream>
#include <iomanip>

#include "kernels/rigid/rotation.hpp"
#include "src/bodies/loads.hpp"
#include "src/bodies/system.hpp"
#include "src/scene/error.hpp"
#include "src/sea/engineering_sea.hpp"
#include "tests/order.hpp"

using namespace spindrift;
using namespace spindrift::sea;

namespace {

// K = k exp(-a t) (cos bt - a/b sin bt) in heave, of which B + i w (A - A(inf)) = i w k / ((i w + a)^2 + b^2); m, A(inf), c.
constexpr double k = 2.0e5, a = 0.2, b = 0.6, infinite = 3.0e5, mass = 1.0e6, stiffness = 4.0e5, density = 1000.0;

std::complex<double> radiation_of(double w) {
  const std::complex<double> s(0.0, w);
  return s * k / ((s + a) * (s + a) + b * b);
}

struct Files {
  std::filesystem::path folder = std::filesystem::temp_directory_path() / ("spindrift_potential_" + std::to_string(getpid()));
  /// With frequencies up to `last` [rad/s], and the row of an infinite one.
  explicit Files(double last = 60.0, bool has_infinite = true) {
    std::filesystem::create_directories(folder);
    std::ofstream radiation(folder / "body.1"), excitation(folder / "body.3");
    radiation.precision(12), excitation.precision(12);
    if (has_infinite) radiation << "0.0 3 3 " << infinite / density << "\n";
    for (int n = 1; n <= int(std::lround(last / 0.02)); ++n) {
      const double w = 0.02 * n;
      const std::complex<double> r = radiation_of(w);
      radiation << 2.0 * pi / w << " 3 3 " << (infinite + r.imag() / w) / density << " " << r.real() / (density * w) << "\n";
    }
    for (double period : {2.0, 60.0})
      for (int mode = 1; mode <= 6; ++mode)
        excitation << period << " 0 " << mode << " 0 0 " << (mode == 3 ? 10.0 : 0.0) << " " << (mode == 3 ? 5.0 : 0.0) << "\n";
    std::ofstream(folder / "body.hst") << "3 3 " << stiffness / (density * 10.0) << "\n";
  }
  ~Files() { std::filesystem::remove_all(folder); }
  PotentialOptions options() const {
    PotentialOptions o;
    o.body = "body", o.radiation_file = folder / "body.1", o.excitation_file = folder / "body.3";
    o.hydrostatics_file = folder / "body.hst", o.volume_m3 = mass / density, o.memory_s = 60.0;
    return o;
  }
};

struct Heave {
  std::vector<double> z;
  double step;
};

Heave move(const Files& files, double start, double end, double step, const std::vector<waves::Component>& waves = {},
           const std::string& radiation = "convolution", int pieces = 1) {
  const Motion initial;
  PotentialOptions options = files.options();
  options.radiation = radiation;
  PotentialBody water(options, {density, 100.0, 10.0}, initial, waves, step);
  const bodies::Body body{.name = "body", .mass = mass, .inertia = 1e8 * Eigen::Matrix3d::Identity(), .initial = initial};
  bodies::LoadSource sea{
      "sea", [&](double t, std::span<const Motion> m, std::span<Wrench> w) { w[0] += water.load(t, 1.0, m[0]); },
      [&](double, std::span<const Motion> m, std::span<bodies::Matrix6> added) { water.add_added_mass(m[0], added[0]); }};
  sea.memory = {water.memory_size(),
                [&](double t, std::span<const Motion> m, std::span<double> memory) { water.begin(t, m[0], memory); },
                [&](std::span<const double> memory) { water.recall(memory); },
                [&](double t, double, std::span<const Motion> m, std::span<double> memory) { water.remember(t, m[0], memory); }};
  bodies::System system({body}, {}, {bodies::gravity_source(std::span(&body, 1), 10.0), sea});
  bodies::BodiesState state = system.assemble().state;
  state.motions[0].position.z() = start;
  system.begin(state, 0.0);
  Heave heave{{start}, step};
  for (int n = 0; n < int(std::lround(end / step)); ++n) {
    REQUIRE(system.advance(state, step, 1, pieces).ok());
    heave.z.push_back(state.motions[0].position.z());
  }
  return heave;
}

/// z of (m + A) z'' + k q' + c z = 0, q'' + 2a q' + (a^2 + b^2) q = z', from rest at z = 1.
double exact_decay(double t) {
  Eigen::Matrix4d system;  // z, z', q, q'
  system << 0, 1, 0, 0, -stiffness / (mass + infinite), 0, 0, -k / (mass + infinite), 0, 0, 0, 1, 0, 1, -(a * a + b * b),
      -2.0 * a;
  const Eigen::EigenSolver<Eigen::Matrix4d> eigen(system);
  const Eigen::Vector4cd share = eigen.eigenvectors().inverse() * Eigen::Vector4cd(1.0, 0.0, 0.0, 0.0);
  std::complex<double> z = 0.0;
  for (int i = 0; i < 4; ++i) z += eigen.eigenvectors()(0, i) * share[i] * std::exp(eigen.eigenvalues()[i] * t);
  return z.real();
}

}  // namespace

TEST_CASE("a file that ends before its damping has died out keeps the body's answer to longer waves, and is told",
          "[sea][fast]") {
  const Files files(1.0, GENERATE(true, false));
  const double w = GENERATE(0.4, 0.5), amplitude = 0.5;
  const waves::Component wave{.wave_number = w * w / 10.0, .angular_frequency = w, .amplitude = amplitude, .phase = 0.0};
  const Heave heave = move(files, 0.0, 400.0, 0.1, {wave});
  const std::complex<double> iw(0.0, w);
  const std::complex<double> answer = amplitude * density * 10.0 * std::complex<double>(10.0, 5.0) /
                                      (stiffness - w * w * (mass + infinite) + iw * radiation_of(w));
  double largest = 0.0;
  for (std::size_t n = heave.z.size() - 200; n < heave.z.size(); ++n) largest = std::max(largest, std::abs(heave.z[n]));
  CHECK(largest == Approx(std::abs(answer)).epsilon(0.05));
  const PotentialBody water(files.options(), {density, 100.0, 10.0}, Motion{}, {}, 0.1);
  CHECK(water.cut_damping().mode == 2);
  CHECK(water.cut_damping().omega == Approx(1.0));
  CHECK(water.cut_damping().share > PotentialBody::died_out);
  const Files whole;
  CHECK(PotentialBody(whole.options(), {density, 100.0, 10.0}, Motion{}, {}, 0.1).cut_damping().share < PotentialBody::died_out);
}

TEST_CASE("waves shorter than those of the excitation's file are counted, and refused where they are most", "[sea][fast]") {
  const Files files;
  const auto wave = [](double period, double height) {
    const double w = 2.0 * pi / period;
    return waves::Component{.wave_number = w * w / 10.0, .angular_frequency = w, .amplitude = 0.5 * height, .phase = 0.0};
  };
  const auto made = [&](const std::vector<waves::Component>& waves) {
    return PotentialBody(files.options(), {density, 100.0, 10.0}, Motion{}, waves, 0.1);
  };
  CHECK(made({wave(2.0, 1.0), wave(8.0, 1.0)}).unexcited().share == 0.0);
  const PotentialBody body = made({wave(8.0, 3.0), wave(1.0, 1.0)});
  CHECK(body.unexcited().share == Approx(0.1));
  CHECK(body.unexcited().period_s == Approx(2.0));
  CHECK_THROWS_WITH(made({wave(1.9, 1.0)}), Catch::Contains("waves.period_s") && Catch::Contains("whose shortest is 2 s"));
}

TEST_CASE("free decay with memory is the exact one within 1 % of the start over ten periods", "[sea][fast]") {
  const Files files;
  const Heave heave = move(files, 1.0, 110.0, 0.05);
  double worst = 0.0;
  for (std::size_t n = 0; n < heave.z.size(); ++n) worst = std::max(worst, std::abs(heave.z[n] - exact_decay(double(n) * 0.05)));
  CHECK(worst < 0.01);
}

TEST_CASE("a state space of few numbers decays as the exact one and as the convolution within 1 %", "[sea][fast]") {
  const Files files;
  const Heave fitted = move(files, 1.0, 110.0, 0.05, {}, "state_space"), convolved = move(files, 1.0, 110.0, 0.05);
  double exact = 0.0, apart = 0.0;
  for (std::size_t n = 0; n < fitted.z.size(); ++n)
    exact = std::max(exact, std::abs(fitted.z[n] - exact_decay(double(n) * 0.05))),
    apart = std::max(apart, std::abs(fitted.z[n] - convolved.z[n]));
  CHECK(exact < 0.01);
  CHECK(apart < 0.01);
  PotentialOptions options = files.options();
  options.radiation = "state_space";
  const PotentialBody body(options, {density, 100.0, 10.0}, Motion{}, {}, 0.05);
  CHECK(body.states() >= 1);
  CHECK(body.states() < 12);
  CHECK(body.memory_size() == 7 + 2 * body.states());
}

TEST_CASE("the state space converges with the step at second order, and answers waves as the convolution within 1 %",
          "[sea][order][fast]") {
  const Files files;
  std::vector<double> h, error;
  const double fine = move(files, 1.0, 12.0, 0.0125, {}, "state_space").z.back();
  for (double step : {0.4, 0.2, 0.1})
    h.push_back(step), error.push_back(std::abs(move(files, 1.0, 12.0, step, {}, "state_space").z.back() - fine));
  CHECK(observed_order(h, error) > 1.7);
  const waves::Component wave{.wave_number = 0.049, .angular_frequency = 0.7, .amplitude = 0.5, .phase = 0.3};
  const Heave fitted = move(files, 0.0, 100.0, 0.1, {wave}, "state_space"), convolved = move(files, 0.0, 100.0, 0.1, {wave});
  double apart = 0.0, most = 0.0;
  for (std::size_t n = 0; n < fitted.z.size(); ++n)
    apart = std::max(apart, std::abs(fitted.z[n] - convolved.z[n])), most = std::max(most, std::abs(convolved.z[n]));
  CHECK(apart < 0.01 * most);
}

TEST_CASE("a memory that 24 poles cannot follow is refused by its modes", "[sea][fast]") {
  const Files files;
  PotentialOptions options = files.options();
  options.radiation = "state_space", options.fit_tolerance = 1e-14;
  CHECK_THROWS_WITH(PotentialBody(options, {density, 100.0, 10.0}, Motion{}, {}, 0.05), Catch::Contains("modes 3 and 3"));
}

TEST_CASE("what the end of the memory cuts off is known by its mode", "[sea][fast]") {
  const Files files;
  PotentialOptions options = files.options();
  const auto cut = [&](double memory_s) {
    options.memory_s = memory_s;
    return PotentialBody(options, {density, 100.0, 10.0}, {}, {}, 0.05).cut();
  };
  CHECK(cut(60.0).share < 1e-3);
  // K / k is cos bt - a/b sin bt by exp(-a t): at most hypot(1, a/b) exp(-a t) over the last tenth, where it swings once at most.
  const double swing = std::hypot(1.0, a / b);
  for (const double memory : {6.0, 12.0}) {
    const PotentialBody::Cut found = cut(memory);
    CHECK(found.mode == 2);
    CHECK(found.share < swing * std::exp(-a * 0.9 * memory));
    CHECK(found.share > 0.5 * swing * std::exp(-a * memory));
  }
}

TEST_CASE("radiation that would give energy is refused by its mode, the noise of modes that have none is not", "[sea][fast]") {
  const auto refusal = [](int mode, double added_mass, double damping) {
    const Files files;
    std::ofstream(files.folder / "body.1", std::ios::app) << "0.0 " << mode << " " << mode << " " << added_mass << "\n6.0 "
                                                          << mode << " " << mode << " " << added_mass << " " << damping << "\n";
    try {
      PotentialBody(files.options(), {density, 100.0, 10.0}, Motion{}, {}, 0.05);
    } catch (const scene::SceneError& e) { return std::string(e.what()); }
    return std::string();
  };
  const double some = infinite / density;
  CHECK_THAT(refusal(1, -some, some), Catch::Contains("added mass of mode 1 at infinite frequency is below zero"));
  CHECK_THAT(refusal(2, some, -some), Catch::Contains("damping of mode 2 is below zero at the period of 6 s"));
  CHECK(refusal(1, some, some).empty());
  CHECK(refusal(1, -1e-6 * some, -1e-6 * some).empty());
}

TEST_CASE("the decay converges with the step at second order", "[sea][order][fast]") {
  const Files files;
  std::vector<double> h, error;
  const double fine = move(files, 1.0, 12.0, 0.0125).z.back();
  for (double step : {0.4, 0.2, 0.1}) h.push_back(step), error.push_back(std::abs(move(files, 1.0, 12.0, step).z.back() - fine));
  CHECK(observed_order(h, error) > 1.7);
}

TEST_CASE("steps in pieces decay as whole ones within 1 %: the convolution's samples stay a step apart", "[sea][fast]") {
  const Files files;
  const Heave whole = move(files, 1.0, 60.0, 0.1), pieces = move(files, 1.0, 60.0, 0.1, {}, "convolution", 4);
  double apart = 0.0;
  for (std::size_t n = 0; n < whole.z.size(); ++n) apart = std::max(apart, std::abs(whole.z[n] - pieces.z[n]));
  CHECK(apart < 0.01);
}

TEST_CASE("headings that the excitation does not have are refused by key, with the file's range", "[sea][fast]") {
  const Files files;  // of the heading 0 alone
  const auto refusal = [&](std::initializer_list<double> degrees) -> std::string {
    std::vector<waves::Component> waves;
    for (const double d : degrees)
      waves.push_back({.wave_number = 0.05, .angular_frequency = 0.7, .amplitude = 1.0, .direction = d * pi / 180.0});
    try {
      PotentialBody(files.options(), {density, 100.0, 10.0}, Motion{}, waves, 0.05);
    } catch (const scene::SceneError& e) { return e.what(); }
    return "";
  };
  CHECK(refusal({360.0}).empty());
  CHECK_THAT(refusal({20.0}), Catch::Contains("waves.direction_deg = 20") && Catch::Contains("heading 0 alone"));
  CHECK_THAT(refusal({0.0, 5.0}), Catch::Contains("waves.spreading_range_deg") && Catch::Contains("towards 5 degrees"));
}

namespace {

/// An upright column of 10 m diameter and draft in potential flow without exciting force, drag or memory.
EngineeringSea column(const Files& files, bool linear) {
  std::ofstream(files.folder / "column.3") << "2.0 0 3 0 0 0 0\n60.0 0 3 0 0 0 0\n";
  const double area = pi * 25.0;
  std::ofstream(files.folder / "column.hst") << std::setprecision(15) << "3 3 " << area << "\n";
  SeaOptions options;
  options.model = "potential", options.drag_coefficient = options.axial_drag_coefficient = 0.0;
  options.potential = files.options();
  options.potential->excitation_file = files.folder / "column.3", options.potential->radiation = "none";
  options.potential->hydrostatics_file.clear(), options.potential->volume_m3.reset();
  if (linear) options.potential->hydrostatics_file = files.folder / "column.hst", options.potential->volume_m3 = area * 10.0;
  WavesOptions waves;
  waves.model = "airy", waves.height_m = 2.0, waves.period_s = 10.0;
  return EngineeringSea(options, waves, {density, 100.0, 10.0}, {{"body", {}, {{"column", {{0, 0, -10}, {0, 0, 10}, 5.0, 5.0}}}}},
                        0.05);
}

Wrench load_on(const EngineeringSea& sea, double t, const Eigen::Vector3d& position, double pitch = 0.0) {
  Motion m;
  m.position = position, m.attitude = Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY());
  Wrench w;
  w.point = position;
  sea.add_loads(t, {&m, 1}, {&w, 1});
  return w;
}

}  // namespace

TEST_CASE("without exciting force waves leave a body in potential flow to still water", "[sea][fast]") {
  const Files files;
  const EngineeringSea sea = column(files, false);
  const Wrench rest = load_on(sea, 0.0, {3.0, 0.0, 0.2}, 0.05);
  CHECK(load_on(sea, 0.0, Eigen::Vector3d::Zero()).force.z() == Approx(density * 10.0 * pi * 25.0 * 10.0));
  CHECK(rest.moment.y() != 0.0);
  for (double t = 0.5; t < 10.0; t += 0.5) {
    const Wrench now = load_on(sea, t, {3.0, 0.0, 0.2}, 0.05);
    CHECK(now.force == rest.force);
    CHECK(now.moment == rest.moment);
  }
}

TEST_CASE("cylinders and the stiffness of the same column carry it alike in waves", "[sea][fast]") {
  const Files files;
  const EngineeringSea cylinders = column(files, false), linear = column(files, true);
  for (double t = 0.0; t < 10.0; t += 1.0)
    for (const double z : {-0.5, 0.0, 0.8})
      CHECK(load_on(cylinders, t, {0.0, 0.0, z}).force.z() == Approx(load_on(linear, t, {0.0, 0.0, z}).force.z()).epsilon(1e-9));
}

namespace {

/// A hull of roll and pitch stiffness with its buoyancy 2 m aside: the moment of still water about its point, at the origin.
struct Hull {
  Files files;
  PotentialBody water;
  Hull(double roll, double pitch) : water(options(files, roll, pitch), {density, 100.0, 10.0}, Motion{}, {}, 0.05) {}
  static PotentialOptions options(const Files& files, double roll, double pitch) {
    std::ofstream(files.folder / "hull.hst") << "4 4 " << roll << "\n5 5 " << pitch << "\n";
    PotentialOptions o = files.options();
    o.hydrostatics_file = files.folder / "hull.hst", o.radiation = "none";
    return o;
  }
  Eigen::Vector3d moment(const Eigen::Quaterniond& attitude) const {
    Motion m;
    m.attitude = attitude;
    return water.load(0.0, 0.0, m).moment;
  }
};

Eigen::Quaterniond turned(double tilt_x, double tilt_y, double yaw) {
  return rotation_exp({tilt_x, tilt_y, 0.0}) * rotation_exp({0.0, 0.0, yaw});
}

}  // namespace

TEST_CASE("a round hull in potential flow is righted alike whatever its yaw, a barge by the stiffness of its own axes",
          "[sea][fast]") {
  const double yaw = pi / 6.0, scale = density * 10.0;
  const Hull round(100.0, 100.0), barge(100.0, 900.0);
  const Eigen::Vector3d straight = round.moment(turned(0.1, -0.2, 0.0));
  CHECK((straight - scale * 100.0 * Eigen::Vector3d(-0.1, 0.2, 0.0)).norm() < 1e-12 * scale * 100.0);
  CHECK((round.moment(turned(0.1, -0.2, yaw)) - straight).norm() < 1e-12 * straight.norm());
  // Tilted about its own x axis, and its own y axis.
  const Eigen::Vector3d x(std::cos(yaw), std::sin(yaw), 0.0), y(-std::sin(yaw), std::cos(yaw), 0.0);
  CHECK((barge.moment(turned(0.1 * x.x(), 0.1 * x.y(), yaw)) + scale * 10.0 * x).norm() < 1e-12 * scale * 10.0);
  CHECK((barge.moment(turned(0.1 * y.x(), 0.1 * y.y(), yaw)) + scale * 90.0 * y).norm() < 1e-12 * scale * 90.0);
}

TEST_CASE("still water does no work on a yawed hull in potential flow round a closed path of tilt", "[sea][fast]") {
  const double pitch = GENERATE(100.0, 300.0), yaw = GENERATE(0.5, 1.5), tilt = 0.02;
  const Hull hull(100.0, pitch);
  constexpr int steps = 400;
  double work = 0.0;
  const auto at = [&](double n) {
    return turned(tilt * std::cos(2.0 * pi * n / steps), tilt * std::sin(2.0 * pi * n / steps), yaw);
  };
  for (int n = 0; n < steps; ++n) {
    const Eigen::Quaterniond step = at(n + 1) * at(n).conjugate();  // earth axes
    work += hull.moment(at(n + 0.5)).dot(2.0 * step.vec());
  }
  CHECK(std::abs(work) < 2e-3 * density * 10.0 * pitch * tilt * tilt);
}

TEST_CASE("in regular waves heave settles on X / (c - w^2 (m + A) + i w B) of the frequency domain within 1 %", "[sea][fast]") {
  const Files files;
  const double w = GENERATE(0.4, 0.7), amplitude = 0.5;
  const waves::Component wave{.wave_number = w * w / 10.0, .angular_frequency = w, .amplitude = amplitude, .phase = 0.3};
  const Heave heave = move(files, 0.0, 260.0, 0.1, {wave});
  const double scale = density * 10.0;
  const std::complex<double> force = amplitude * scale * std::complex<double>(10.0, 5.0) * std::polar(1.0, -0.3), iw(0.0, w);
  const std::complex<double> answer = force / (stiffness - w * w * (mass + infinite) + iw * radiation_of(w));
  double worst = 0.0;
  for (std::size_t n = heave.z.size() - 200; n < heave.z.size(); ++n)
    worst = std::max(worst, std::abs(heave.z[n] - (answer * std::polar(1.0, w * double(n) * 0.1)).real()));
  CHECK(worst < 0.01 * std::abs(answer));
}
