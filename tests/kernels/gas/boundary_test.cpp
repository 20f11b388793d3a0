// Boundary states: a stream passes unchanged, waves leave, walls hold, reservoirs obey their laws, Mach 1e-5 keeps its digits.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/gas/boundary.hpp"

#include <catch2/catch.hpp>

#include "kernels/gas/flux_osher.hpp"
#include "tests/kernels/gas/states.hpp"

using namespace spindrift;
using namespace spindrift::gas;
using namespace spindrift::gas::testing;

namespace {
bool same(const Primitive<double>& a, const Primitive<double>& b) {
  return a.p == b.p && a.u == b.u && a.v == b.v && a.w == b.w && a.T == b.T;
}
}  // namespace

TEST_CASE("a uniform stream passes the far field bit by bit, at any reference speed", "[gas][fast]") {
  const IdealGas gas = gauge_air();
  Generator g;
  double worst = 0;
  for (int n = 0; n < 200; ++n) {
    const auto q = g.state(gas);
    const auto f = g.face();
    const auto b = far_field(gas, q, q, f, g.between(1e-3, 2.0) * sound_speed(gas, q));
    CHECK(b.p == q.p);
    CHECK(b.T == q.T);
    worst = std::max(worst, std::abs(b.u - q.u) / sound_speed(gas, q));
  }
  CHECK(worst < 1e-15);
}

TEST_CASE("sound that leaves passes the far field, sound that would enter does not arise", "[gas][fast]") {
  const IdealGas gas = gauge_air();
  const Face<double> f{1.0, 0.0, 0.0, 1.0, 0.0};
  const Primitive<double> stream{0.0, 100.0, 0.0, 0.0, 0.0};
  const double rho = density(gas, stream), c = sound_speed(gas, stream), dp = 1.0;
  auto leaving = stream, entering = stream;
  leaving.p += dp, leaving.u += dp / (rho * c), leaving.T += dp / (rho * gas.cp());
  entering.p += dp, entering.u -= dp / (rho * c), entering.T += dp / (rho * gas.cp());
  const auto out = far_field(gas, leaving, stream, f);
  CHECK(out.p == Approx(leaving.p).epsilon(1e-4));
  CHECK(out.u == Approx(leaving.u).epsilon(1e-8));
  CHECK(far_field(gas, entering, stream, f).p == Approx(0.0).margin(1e-4));
  // An entropy wave leaves with the gas and does not come in.
  auto hot = stream;
  hot.T += 5.0;
  CHECK(far_field(gas, hot, stream, f).T == Approx(5.0));
  CHECK(far_field(gas, hot, stream, reversed(f)).T == Approx(0.0).margin(1e-12));
}

TEST_CASE("supersonic far fields are one side alone, on faces that move too", "[gas][fast]") {
  const IdealGas gas = gauge_air();
  const Primitive<double> in{1e3, 500.0, 20.0, 0.0, 10.0}, ex{0.0, 480.0, 0.0, 0.0, 0.0};
  const auto out = far_field(gas, in, ex, {1.0, 0.0, 0.0, 1.0, 0.0}), into = far_field(gas, in, ex, {-1.0, 0.0, 0.0, 1.0, 0.0});
  CHECK(out.p == Approx(in.p));
  CHECK(out.u == Approx(in.u));
  CHECK(out.v == in.v);
  CHECK(out.T == Approx(in.T));
  CHECK(same(into, ex));
  // The same flow at rest in the far field, face flying through it.
  CHECK(far_field(gas, in, ex, {1.0, 0.0, 0.0, 1.0, 490.0}).p != Approx(in.p));
  CHECK(same(far_field(gas, in, ex, {1.0, 0.0, 0.0, 1.0, 1200.0}), ex));
}

// Preconditioned pseudo-time at Mach 1e-3: its outgoing wave carries dp = rho a+ du with a+ ~ 1.6 u, not rho c. The physical
// characteristics send nearly all of it back.
TEST_CASE("the preconditioned far field does not reflect the waves of the preconditioned pseudo-time", "[gas][fast]") {
  const IdealGas gas = gauge_air();
  for (const double mach : {1e-1, 1e-3, 1e-5}) {
    const double c = sound_speed(gas, Primitive<double>{}), U = mach * c;
    const Primitive<double> stream{0.0, U, 0.0, 0.0, 0.0};
    const Face<double> f{1.0, 0.0, 0.0, 1.0, 0.0};
    const double rho = density(gas, stream), c2 = c * c, r2 = U * U;
    const auto s = preconditioned_speeds(U, c2, r2);
    const double minus = rho * (s.slow - U * r2 / c2);
    const double dp = 1e-4 * rho * U * U;
    // The right-running wave keeps p + rho a- u (and is seen in p + rho a+ u).
    auto wave = stream;
    wave.p += dp, wave.u -= dp / minus, wave.T += dp / (rho * gas.cp());
    const auto incoming = [&](const Primitive<double>& b) {  // what of the state on the face is a left-running wave
      return std::abs((b.p - stream.p) + minus * (b.u - stream.u)) / dp;
    };
    const auto passed = far_field(gas, wave, stream, f, U);
    CHECK(passed.p == Approx(wave.p).epsilon(1e-3));
    CHECK(incoming(passed) < 1e-3);
    if (mach < 1e-2) CHECK(incoming(far_field(gas, wave, stream, f)) > 0.5);
  }
}

TEST_CASE("a reservoir's gas keeps its total pressure and temperature", "[gas][fast]") {
  const IdealGas gas = gauge_air();
  // TMR flat plate: p0/p = 1.02828, T0/T = 1.008 at Mach 0.2.
  const double p = 101325.0, T = 300.0;
  const Reservoir r{1.02828 * p, 1.008 * T, 1.0, 0.0, 0.0};
  const auto q = inflow_reservoir(gas, Primitive<double>{p - gas.pressure_reference, 1.0, 2.0, 3.0, 4.0}, r);
  CHECK(q.u / sound_speed(gas, q) == Approx(0.2).epsilon(1e-4));
  CHECK(q.v == 0.0);
  CHECK(total_enthalpy(gas, q) + gas.enthalpy_reference() == Approx(gas.cp() * 1.008 * T).epsilon(1e-14));
  CHECK(absolute_temperature(gas, q) == Approx(T).epsilon(1e-4));
  // Low Mach: Bernoulli to six digits.
  const double dynamic = 1e-5;  // Pa
  const Reservoir slow{p + dynamic, T, 0.0, 0.0, 1.0};
  const double exact_p = (p + dynamic) - gas.pressure_reference;  // as stored in the reservoir's number
  const auto b = inflow_reservoir(gas, Primitive<double>{exact_p - 1e-5, 0, 0, 0, 0}, slow);
  CHECK(0.5 * density(gas, b) * b.w * b.w == Approx(1e-5).epsilon(1e-5));
  // Higher pressure inside: the gas stands; a vacuum inside: it comes at Mach 1.
  CHECK(std::abs(inflow_reservoir(gas, Primitive<double>{1e5, 0, 0, 0, 0}, r).u) < 1e-100);
  const auto choked = inflow_reservoir(gas, Primitive<double>{-1e5, 0, 0, 0, 0}, r);
  CHECK(choked.u == Approx(sound_speed(gas, choked)));
}

TEST_CASE("inflow keeps the stream's velocity, outflow the outer pressure, and gas that comes back is the stream's",
          "[gas][fast]") {
  const IdealGas gas = gauge_air();
  const Face<double> f{1.0, 0.0, 0.0, 1.0, 0.0};
  const Primitive<double> in{50.0, 30.0, 4.0, 0.0, 7.0}, ex{0.0, 20.0, 1.0, 0.0, 1.0};
  const Face<double> into = reversed(f);
  CHECK(same(inflow_velocity(gas, in, ex, into), {50.0, 20.0, 1.0, 0.0, 1.0}));
  // Faster than sound nothing of the inside reaches the face, on one that flies into the stream either.
  const Primitive<double> fast{0.0, 480.0, 1.0, 0.0, 1.0};
  CHECK(same(inflow_velocity(gas, in, fast, into), fast));
  CHECK(inflow_velocity(gas, in, fast, {-1.0, 0.0, 0.0, 1.0, -300.0}).p == in.p);
  CHECK(same(inflow_velocity(gas, in, ex, {-1.0, 0.0, 0.0, 1.0, 400.0}), ex));
  CHECK(same(outflow_pressure(gas, in, ex, f), {0.0, 30.0, 4.0, 0.0, 7.0}));
  CHECK(same(outflow_pressure(gas, Primitive<double>{50.0, -3.0, 4.0, 0.0, 7.0}, ex, f), {0.0, -3.0, 0.0, 0.0, 1.0}));
  CHECK(same(outflow_pressure(gas, Primitive<double>{50.0, 700.0, 4.0, 0.0, 7.0}, ex, f), {50.0, 700.0, 4.0, 0.0, 7.0}));
  auto receding = f;
  receding.speed = 50.0;  // relative to the face the gas comes in
  CHECK(outflow_pressure(gas, in, ex, receding).T == 1.0);
}

TEST_CASE("walls let nothing through and push with the pressure, moving or not", "[gas][fast]") {
  const IdealGas gas = gauge_air();
  Generator g;
  for (int n = 0; n < 100; ++n) {
    const auto q = g.state(gas, 0.8);
    const auto f = g.face();
    const auto slip = with_normal_velocity(q, f, f.speed, q.p, q.T), image = mirrored(q, f);
    const auto scale = flux_scale(gas, q, q, f);
    CHECK(difference(physical_flux(gas, slip, f), wall_flux(q.p, f), scale) < 1e-13);
    const auto middle = 0.5 * (image + q);
    CHECK(normal_velocity(middle, f) == Approx(f.speed).margin(1e-10));
    CHECK(kinetic(middle) == Approx(kinetic(slip)).epsilon(1e-10));
    // The exact solution of the mirror problem has no flow through the wall either.
    CHECK(std::abs(OsherP{}(gas, q, image, f).rho) < 1e-12 * scale.rho);
    const Vector<double> wall{f.speed * f.nx, f.speed * f.ny, f.speed * f.nz};
    const Primitive<double> stick{q.p, wall.x, wall.y, wall.z, q.T}, ghost = no_slip_ghost(q, wall);
    CHECK(difference(physical_flux(gas, stick, f), wall_flux(q.p, f), scale) < 1e-13);
    CHECK(0.5 * (ghost.u + q.u) == Approx(wall.x).margin(1e-10));
    CHECK(ghost.T == q.T);
  }
}
