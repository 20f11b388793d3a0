// Eddy viscosities of large-eddy simulation: Smagorinsky's drains what the inertial range brings, WALE's knows walls and
// rotation. SPDX-License-Identifier: Apache-2.0
#include "kernels/turbulence/model_les.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using namespace spindrift;
using namespace spindrift::turbulence;

namespace {
const Vector<double> zero{0, 0, 0};
Flow<double> flow_of(const Vector<double>& u, const Vector<double>& v, const Vector<double>& w, double width) {
  return {1.2, 1.8e-5, 1.0, u, v, w, zero, width, width};
}
template <class Model>
double eddy(const Flow<double>& f) {
  return Model{}.closure(f, {}).eddy_viscosity;
}
}  // namespace

// Lilly (1967): with E = C eps^(2/3) k^(-5/3) up to pi / Delta, 2 S:S = 3/2 C eps^(2/3) (pi / Delta)^(4/3), and nu_t 2 S:S is
// eps.
TEST_CASE("Smagorinsky's eddy viscosity drains the inertial range at the rate it is fed", "[turbulence][fast]") {
  for (const double eps : {1e-2, 1.0, 50.0})
    for (const double width : {1e-3, 0.1}) {
      const double rate = std::sqrt(1.5 * 1.5 * std::pow(eps, 2.0 / 3.0) * std::pow(std::numbers::pi / width, 4.0 / 3.0));
      const double drained = eddy<Smagorinsky>(flow_of({0.0, rate, 0.0}, zero, zero, width)) / 1.2 * rate * rate;
      CHECK(drained == Approx(eps).epsilon(0.01));
    }
}

TEST_CASE("WALE is none in pure shear and sees rotation, Smagorinsky the other way round", "[turbulence][fast]") {
  const auto shear = flow_of({0.0, 1e4, 0.0}, zero, zero, 1e-2);
  CHECK(eddy<Wale>(shear) <= 1e-12 * eddy<Smagorinsky>(shear));
  CHECK(eddy<Smagorinsky>(shear) > 0.0);
  const auto turning = flow_of({0.0, -50.0, 0.0}, {50.0, 0.0, 0.0}, zero, 1e-2);
  CHECK(eddy<Smagorinsky>(turning) == Approx(0.0).margin(1e-12));
  CHECK(eddy<Wale>(turning) > 0.0);
}

// u ~ y, v ~ y^2, w ~ y near a wall: nu_t ~ y^3 (their eq. 14 ff.).
TEST_CASE("WALE falls with the cube of the distance at a wall", "[turbulence][fast]") {
  const auto at = [](double y) {
    const double a = 200.0, b = 3e4, c = 90.0;  // u = a y (1 + x), v = b y^2 (1 + z), w = c y (1 + x)
    return eddy<Wale>(flow_of({a * y, a, 0.0}, {0.0, 2.0 * b * y, b * y * y}, {c * y, c, 0.0}, 1e-3));
  };
  const double order = std::log(at(2e-7) / at(1e-7)) / std::log(2.0);
  CHECK(order == Approx(3.0).margin(0.05));
}

TEST_CASE("WALE and Smagorinsky grow with the square of the width and with the rate", "[turbulence][fast]") {
  const Vector<double> u{3.0, 1.0, -2.0}, v{0.5, -1.0, 4.0}, w{1.0, 2.0, -2.0};
  const auto scaled = [](const Vector<double>& a) { return Vector<double>{7.0 * a.x, 7.0 * a.y, 7.0 * a.z}; };
  const auto one = flow_of(u, v, w, 0.1), wide = flow_of(u, v, w, 0.2), fast = flow_of(scaled(u), scaled(v), scaled(w), 0.1);
  CHECK(eddy<Wale>(wide) == Approx(4.0 * eddy<Wale>(one)));
  CHECK(eddy<Wale>(fast) == Approx(7.0 * eddy<Wale>(one)));
  CHECK(eddy<Smagorinsky>(wide) == Approx(4.0 * eddy<Smagorinsky>(one)));
  CHECK(eddy<Smagorinsky>(fast) == Approx(7.0 * eddy<Smagorinsky>(one)));
  // By its printed form.
  double g[3][3] = {{u.x, u.y, u.z}, {v.x, v.y, v.z}, {w.x, w.y, w.z}}, square[3][3]{}, sd = 0, ss = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) square[i][j] += g[i][k] * g[k][j];
  const double trace = square[0][0] + square[1][1] + square[2][2];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      sd += std::pow(0.5 * (square[i][j] + square[j][i]) - (i == j ? trace / 3.0 : 0.0), 2);
      ss += std::pow(0.5 * (g[i][j] + g[j][i]), 2);
    }
  const double nu = std::pow(0.5 * 0.1, 2) * std::pow(sd, 1.5) / (std::pow(ss, 2.5) + std::pow(sd, 1.25));
  CHECK(eddy<Wale>(one) == Approx(1.2 * nu).epsilon(1e-12));
}
