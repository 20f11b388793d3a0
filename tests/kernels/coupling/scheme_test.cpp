// Schemes on six linear rows: evaluations against their theory, history saved and restored bit for bit.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "tests/kernels/coupling/linear_window.hpp"

using namespace spindrift::coupling;
using namespace spindrift::coupling::test;

namespace {

constexpr double relaxation = 0.1;
const IterationLimits tight{.relative = 1e-6, .max_evaluations = 200, .diverged = 1e8, .fallback_steps = 0};

template <Scheme S>
WindowLog run(double r, S scheme, const IterationLimits& limits = tight) {
  LinearWindow window(r);
  return solve_window(window, scheme, limits);
}

/// Two windows, with the history of the scheme carried through `carry` at the given evaluation of the second.
template <Scheme S, class Carry>
std::vector<double> residuals(S scheme, int at, const Carry& carry) {
  LinearWindow window(3.0);
  solve_window(window, scheme, tight);
  window.load(0.3);
  std::vector<double> norms;
  scheme.begin_window();
  Vector x = window.guess();
  for (int k = 0; k < 12; ++k) {
    if (k == at) scheme = carry(scheme);
    Vector output;
    if constexpr (requires { scheme.evaluate(window, x); })
      output = scheme.evaluate(window, x);
    else
      output = window.evaluate(x);
    norms.push_back((output - x).norm());
    if (norms.back() < 1e-9) break;
    x = scheme.next(x, output - x);
  }
  return norms;
}

template <Scheme S>
void check_history(const S& fresh) {
  const auto keep = [](const S& s) { return s; };
  const auto through_data = [&fresh](S& s) {
    std::vector<double> data;
    save_history(s, data);
    S other = fresh;
    std::span<const double> in = data;
    REQUIRE(restore_history(other, in));
    REQUIRE(in.empty());
    std::span<const double> cut = std::span<const double>(data).first(data.size() - (data.empty() ? 0 : 1));
    S broken = fresh;
    CHECK(restore_history(broken, cut) == data.empty());  // a shorter record is noticed
    return other;
  };
  for (int at : {0, 1, 2, 4}) CHECK(residuals(fresh, at, keep) == residuals(fresh, at, through_data));
}

}  // namespace

TEST_CASE("six linear rows take at most eight evaluations at full rank, whatever the added mass", "[coupling][fast]") {
  const double r = GENERATE(0.5, 1.0, 3.0, 10.0, 30.0, 100.0);
  INFO("r = " << r);
  const WindowLog iqn = run(r, IqnIls(relaxation, {})), newton = run(r, Newton(1e-3));
  CHECK(iqn.ok());
  CHECK(iqn.evaluations <= 8);
  CHECK(newton.ok());
  CHECK(newton.evaluations <= 8);
  const WindowLog ibqn = run(r, IbqnLs(relaxation, {})), gmres = run(r, InterfaceGmres(relaxation, {}));
  CHECK(ibqn.ok());
  CHECK(ibqn.evaluations <= 8);
  CHECK(gmres.ok());
  CHECK(gmres.evaluations <= 8 + 4);  // each of its Newton steps, at one tenth of the residual, is evaluated
}

TEST_CASE("a full model from the window before solves the next one at once", "[coupling][fast]") {
  LinearWindow window(10.0);
  IqnIls scheme(relaxation, {.reuse = 1});
  CHECK(solve_window(window, scheme, tight).ok());
  CHECK(scheme.columns() == 6);
  window.again(), window.load(0.5);
  CHECK(solve_window(window, scheme, tight).evaluations <= 2);
  IqnIls forgetful(relaxation, {.reuse = 0});
  window.again();
  CHECK(solve_window(window, forgetful, tight).ok());
  CHECK(forgetful.columns() == 0);
}

TEST_CASE("Aitken and steepest descent beat constant relaxation on a heavy fluid", "[coupling][fast]") {
  const double r = 20.0;
  const WindowLog constant = run(r, RelaxationConstant(1.9 / (1.0 + 1.4 * r))), aitken = run(r, RelaxationAitken(relaxation)),
                  descent = run(r, RelaxationSteepestDescent(0.01));
  CHECK(constant.ok());
  CHECK(aitken.ok());
  CHECK(descent.ok());
  CHECK(aitken.evaluations < constant.evaluations);
  CHECK(descent.evaluations - descent.probes < constant.evaluations);
}

TEST_CASE("Aitken solves one linear row exactly in three evaluations", "[coupling][fast]") {
  RelaxationAitken aitken(0.1);
  aitken.begin_window();
  Vector x = Vector::Zero(1);
  const auto residual = [](const Vector& z) { return Vector(Vector::Constant(1, 5.0) - 8.0 * z); };
  for (int k = 0; k < 2; ++k) x = aitken.next(x, residual(x));
  CHECK(x[0] == Approx(5.0 / 8.0).epsilon(1e-14));
}

TEST_CASE("two parts iterated at once and in turn reach the same window", "[coupling][fast]") {
  LinearWindow parts(2.0);
  Vector serial = Vector::Zero(6), parallel = Vector::Zero(12);
  IqnIls a(relaxation, {}), b(relaxation, {});
  a.begin_window(), b.begin_window();
  for (int k = 0; k < 30; ++k) {
    if (Vector r = parts.evaluate(serial) - serial; r.norm() > 1e-12) serial = a.next(serial, r);
    if (Vector r = evaluate_parallel(parts, parallel, 6) - parallel; r.norm() > 1e-12) parallel = b.next(parallel, r);
  }
  CHECK((parallel.head(6) - serial).norm() < 1e-10);
  CHECK((parallel.tail(6) - parts.first(serial)).norm() < 1e-10);
}

TEST_CASE("a scheme's history goes through plain data bit for bit, in the middle of a window too", "[coupling][fast]") {
  check_history(RelaxationConstant(relaxation));
  check_history(RelaxationAitken(relaxation));
  check_history(RelaxationSteepestDescent(0.05));
  check_history(IqnIls(relaxation, {.reuse = 3}));
  check_history(IbqnLs(relaxation, {.reuse = 3}));
  check_history(InterfaceGmres(relaxation, {.reuse = 3}));
  check_history(Newton(1e-3));
}

TEST_CASE("columns that repeat others or do not move are dropped, the newest first kept", "[coupling][fast]") {
  Differences d({.reuse = 1, .filter = 1e-3});
  const Vector e1{{1.0, 0.0, 0.0}}, e2{{0.0, 1.0, 0.0}}, near{{1.0, 1e-4, 0.0}};
  d.add(e1, 2.0 * e1);
  d.add(e2, 3.0 * e2);
  d.add(Vector::Zero(3), e1);
  d.add(Vector::Constant(3, std::nan("")), e1);
  CHECK(d.columns() == 2);
  CHECK((d.map(e1 + e2) - (2.0 * e1 + 3.0 * e2)).norm() < 1e-14);
  d.add(near, 5.0 * e1);
  CHECK(d.columns() == 2);  // e1 adds a ten-thousandth to it
  CHECK((d.map(near) - 5.0 * e1).norm() < 1e-13);
  d.end_window();
  CHECK(d.columns() == 2);
  d.end_window();
  CHECK(d.columns() == 0);
}
