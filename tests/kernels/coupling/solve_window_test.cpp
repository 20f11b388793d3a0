// The driver of a window: which limit ended it, what the fallback does, when a window is cut.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "tests/kernels/coupling/linear_window.hpp"

using namespace spindrift::coupling;
using namespace spindrift::coupling::test;

namespace {

/// One row whose fluid weighs `heavy` times the length of the piece; may be cut down to `least`.
struct Cuttable {
  double heavy, least = 0.0, begin = 0.0, length = 1.0;
  std::vector<double> ends{};
  Vector evaluate(const Vector& x) { return Vector::Constant(1, 1.0) - heavy * length * x; }
  Vector guess() const { return Vector::Zero(1); }
  void accept() { ends.push_back(begin += length); }
  bool done() const { return begin >= 1.0; }
  bool halve() {
    if (length / 2 < least) return false;
    length /= 2;
    return true;
  }
};

}  // namespace

TEST_CASE("a window that does not converge is cut until it does, and every piece is accepted in turn", "[coupling][fast]") {
  Cuttable window{3.0};
  RelaxationConstant fixed_point(1.0);
  const WindowLog log = solve_window(window, fixed_point, {.relative = 1e-8, .max_evaluations = 100, .fallback_steps = 2});
  CHECK(log.ok());
  CHECK(log.cuts == 2);  // 3, 1.5, 0.75
  CHECK(log.retries == 2);
  CHECK(window.ends == std::vector<double>{0.25, 0.5, 0.75, 1.0});
}

TEST_CASE("a window that may not be cut, or not often enough, fails and says what ended it", "[coupling][fast]") {
  Cuttable whole{3.0, 1.0};
  RelaxationConstant fixed_point(1.0);
  const WindowLog stiff = solve_window(whole, fixed_point, {.max_evaluations = 10, .diverged = 1e9, .fallback_steps = 2});
  CHECK_FALSE(stiff.ok());
  CHECK(stiff.bound == Bound::evaluations);
  CHECK(stiff.cuts == 0);
  CHECK(whole.ends.empty());
  CHECK(stiff.evaluations == 10 + 2 + 10);
  Cuttable often{100.0};
  const WindowLog diverged = solve_window(often, fixed_point, {.max_evaluations = 100, .fallback_steps = 0, .max_cuts = 2});
  CHECK(diverged.bound == Bound::divergence);
  CHECK(diverged.cuts == 2);
}

TEST_CASE("the log names the tolerance that was met", "[coupling][fast]") {
  LinearWindow window(0.1);
  IqnIls scheme(1.0, {});
  const WindowLog relative = solve_window(window, scheme, {.relative = 1e-3, .absolute = 0.0});
  CHECK(relative.bound == Bound::relative);
  CHECK(relative.residual <= 1e-3 * relative.first_residual);
  window.again();
  const WindowLog of_output = solve_window(window, scheme, {.relative = 0.0, .of_output = 1e-3});
  CHECK(of_output.bound == Bound::absolute);
  window.again();
  const WindowLog absolute = solve_window(window, scheme, {.relative = 0.0, .absolute = 1e-3});
  CHECK(absolute.bound == Bound::absolute);
  CHECK(absolute.residual <= 1e-3);
}

TEST_CASE("what is returned is as large as the window says, where it says so", "[coupling][fast]") {
  struct Turning {  // a load of 1 that converges, beside an angle of a thousand turns that is right from the start
    Vector evaluate(const Vector& x) { return Eigen::Vector2d(1.0 - 0.5 * x[0], 6283.0); }
    Vector guess() const { return Eigen::Vector2d(0.6, 6283.0); }
    void accept() { ended = true; }
    bool done() const { return ended; }
    bool halve() { return false; }
    double size_of(const Vector& output) const { return std::abs(output[0]); }
    bool ended = false;
  } window;
  RelaxationConstant fixed_point(1.0);
  const WindowLog log = solve_window(window, fixed_point, {.relative = 0.0, .of_output = 1e-3});
  CHECK(log.ok());
  CHECK(log.residual <= 1e-3);
  CHECK(log.evaluations > 3);
}

TEST_CASE("clearing and relaxing rescues a scheme that learned from a part in trouble", "[coupling][fast]") {
  struct Troubled : LinearWindow {
    using LinearWindow::LinearWindow;
    int calls = 0;
    Vector evaluate(const Vector& x) {  // for six calls its results jump
      const Vector output = LinearWindow::evaluate(x);
      return ++calls <= 6 ? Vector(output * (calls % 2 ? -3.0 : 2.0)) : output;
    }
  };
  Troubled window(5.0);
  IqnIls scheme(0.1, {});
  const WindowLog log =
      solve_window(window, scheme, {.relative = 1e-6, .max_evaluations = 9, .fallback_relaxation = 0.1, .fallback_steps = 3});
  CHECK(log.ok());
  CHECK(log.retries == 1);
}
