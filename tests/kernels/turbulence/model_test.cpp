// Laws of every turbulence model over generated points: rotation, units, Jacobians, lanes, bounds.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/turbulence/model.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <tuple>

#include "kernels/turbulence/model_k_omega.hpp"
#include "kernels/turbulence/model_les.hpp"
#include "kernels/turbulence/model_sa_des.hpp"
#include "kernels/turbulence/model_sst.hpp"
#include "tests/kernels/gas/states.hpp"

using namespace spindrift;
using namespace spindrift::turbulence;
using gas::testing::Generator;

namespace {

using Transported = std::tuple<Sa, SaNeg, Des97, Ddes, Sst, Sst2003Vm, Sst1994, SstV, SstVm, KOmega, KOmega1988>;
using All = std::tuple<Sa, SaNeg, Des97, Ddes, Sst, Sst2003Vm, Sst1994, SstV, SstVm, KOmega, KOmega1988, Smagorinsky, Wale>;

template <class Model>
struct Point {
  Flow<double> flow;
  Turbulence<double, Model::equations> t;
};

Vector<double> vector(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
Eigen::Vector3d vector(const Vector<double>& v) { return {v.x, v.y, v.z}; }

/// A point of a boundary layer in air or its surroundings.
template <class Model>
Point<Model> point(Generator& g) {
  Point<Model> p;
  const double nu = 1.5e-5, d = std::pow(10.0, g.between(-5, 0)), rate = std::pow(10.0, g.between(-1, 5));
  p.flow = {1.2, 1.2 * nu, d, vector(rate * g.direction()), vector(rate * g.direction()), vector(rate * g.direction())};
  p.flow.density_gradient = vector(0.1 * g.direction());
  if (Model::sees_grid) p.flow.longest_side = std::pow(10.0, g.between(-4, 0)), p.flow.width = 0.3 * p.flow.longest_side;
  const double nu_t = nu * std::pow(10.0, g.between(-2, 3));
  if constexpr (Model::equations == 1) {
    p.t.q[0] = nu_t;
    p.t.gradient[0] = vector(nu_t / d * g.direction());
  } else if constexpr (Model::equations == 2) {
    const double omega = std::pow(10.0, g.between(1, 5));
    p.t.q[0] = nu_t * omega, p.t.q[1] = omega;
    p.t.gradient[0] = vector(p.t.q[0] / d * g.direction()), p.t.gradient[1] = vector(omega / d * g.direction());
  }
  return p;
}

/// In other units of length and time, and of mass per volume.
template <class Model>
Point<Model> scaled(Point<Model> p, double length, double time, double density) {
  const auto times = [](Vector<double>& v, double s) { v.x *= s, v.y *= s, v.z *= s; };
  const double nu = length * length / time;
  p.flow.rho *= density, p.flow.mu *= density * nu, p.flow.distance *= length;
  p.flow.longest_side *= length, p.flow.width *= length;
  for (auto* v : {&p.flow.u, &p.flow.v, &p.flow.w}) times(*v, 1.0 / time);
  times(p.flow.density_gradient, density / length);
  const double unit[] = {Model::equations == 1 ? nu : nu / time, 1.0 / time};
  for (int k = 0; k < Model::equations; ++k) p.t.q[k] *= unit[k], times(p.t.gradient[k], unit[k] / length);
  return p;
}

/// Sum of the sizes of terms, to compare differences with: from the state with production alone and destruction alone.
template <class Model>
double size(const Point<Model>& p, int row) {
  auto flow = p.flow;
  const double q = p.t.q[row];
  const double rate =
      vorticity(flow) + strain(flow) + std::abs(p.t.q[0]) / (flow.distance * flow.distance) + (row == 1 ? q : 0.0);
  return flow.rho * std::abs(q) * rate;
}

}  // namespace

TEMPLATE_LIST_TEST_CASE("turbulence does not know the axes", "[turbulence][fast]", All) {
  Generator g;
  for (int n = 0; n < 100; ++n) {
    const auto p = point<TestType>(g);
    auto turned = p;
    const Eigen::Matrix3d R = gas::testing::random_rotation(g);
    Eigen::Matrix3d G;  // G_ij = du_i/dx_j
    G << p.flow.u.x, p.flow.u.y, p.flow.u.z, p.flow.v.x, p.flow.v.y, p.flow.v.z, p.flow.w.x, p.flow.w.y, p.flow.w.z;
    const Eigen::Matrix3d H = R * G * R.transpose();
    turned.flow.u = vector(Eigen::Vector3d(H.row(0))), turned.flow.v = vector(Eigen::Vector3d(H.row(1)));
    turned.flow.w = vector(Eigen::Vector3d(H.row(2)));
    turned.flow.density_gradient = vector(Eigen::Vector3d(R * vector(p.flow.density_gradient)));
    for (int k = 0; k < TestType::equations; ++k) turned.t.gradient[k] = vector(Eigen::Vector3d(R * vector(p.t.gradient[k])));
    const auto ca = TestType{}.closure(p.flow, p.t), cb = TestType{}.closure(turned.flow, turned.t);
    CHECK(ca.eddy_viscosity == Approx(cb.eddy_viscosity).epsilon(1e-11));
    if constexpr (TestType::equations > 0) {
      const auto a = TestType{}.source(p.flow, p.t), b = TestType{}.source(turned.flow, turned.t);
      for (int k = 0; k < TestType::equations; ++k) {
        CHECK(a.rate[k] == Approx(b.rate[k]).epsilon(1e-9).margin(1e-9 * size(p, k)));
        CHECK(ca.diffusivity[k] == Approx(cb.diffusivity[k]).epsilon(1e-11));
      }
    }
  }
}

// The floor of SST's cross diffusion has units; it is far below what these points have.
TEMPLATE_LIST_TEST_CASE("turbulence does not know the units", "[turbulence][fast]", All) {
  Generator g;
  for (int n = 0; n < 100; ++n) {
    auto p = point<TestType>(g);
    if constexpr (TestType::equations == 2) p.t.gradient[1] = p.t.gradient[0];  // cross diffusion of positive sign
    if constexpr (TestType::equations == 2) {
      const double s = p.t.q[1] / p.t.q[0];
      p.t.gradient[1].x *= s, p.t.gradient[1].y *= s, p.t.gradient[1].z *= s;
    }
    const double length = 20.0, time = 3.0, density = 0.7;
    const auto q = scaled(p, length, time, density);
    CHECK(TestType{}.closure(q.flow, q.t).eddy_viscosity ==
          Approx(TestType{}.closure(p.flow, p.t).eddy_viscosity * density * length * length / time).epsilon(1e-10));
    if constexpr (TestType::equations > 0) {
      const auto a = TestType{}.source(p.flow, p.t), b = TestType{}.source(q.flow, q.t);
      const double unit[] = {TestType::equations == 1 ? length * length / time : length * length / (time * time), 1.0 / time};
      for (int k = 0; k < TestType::equations; ++k)
        CHECK(b.rate[k] == Approx(a.rate[k] * density * unit[k] / time).epsilon(1e-9).margin(1e-9 * size(q, k)));
    }
  }
}

TEMPLATE_LIST_TEST_CASE("exact Jacobians of sources agree with finite differences, implicit ones never feed growth",
                        "[turbulence][fast]", Transported) {
  constexpr int n = TestType::equations;
  Generator g;
  int agree = 0, points = 0;
  for (int sample = 0; sample < 200; ++sample) {
    auto p = point<TestType>(g);
    if (std::is_same_v<TestType, SaNeg> && sample % 2 == 0) p.t.q[0] *= -1.0;
    const auto J = exact_source_jacobian(TestType{}, p.flow, p.t);
    const auto safe = TestType{}.source_jacobian(p.flow, p.t);
    for (int row = 0; row < n; ++row) {
      CHECK(safe.m[row][row] <= 0.0);
      for (int column = 0; column < n; ++column) {
        const double h = 1e-4 * p.t.q[column];
        const auto at = [&](double factor) {
          auto moved = p.t;
          moved.q[column] += factor * h;
          return TestType{}.source(p.flow, moved).rate[row];
        };
        const double slope = (8.0 * (at(1) - at(-1)) - (at(2) - at(-2))) / 12.0;
        ++points;
        // Points within 2e-4 of a bend (limiters) may differ; there are few.
        agree += std::abs(slope - J.m[row][column] * h) <= 1e-6 * (1e-4 * size(p, row));
      }
    }
    if (n == 1)
      CHECK(safe.m[0][0] == Approx(std::min(J.m[0][0], 0.0)).epsilon(1e-3).margin(1e-2 * size(p, 0) / std::abs(p.t.q[0])));
  }
  CHECK(agree > 0.98 * points);
}

TEMPLATE_LIST_TEST_CASE("lanes have the turbulence of one point", "[turbulence][fast]", All) {
  using V = Wide<double, 8>;
  constexpr int n = TestType::equations;
  Generator g;
  for (int sample = 0; sample < 50; ++sample) {
    Point<TestType> p[V::size];
    for (auto& q : p) q = point<TestType>(g);
    if (std::is_same_v<TestType, SaNeg>) p[1].t.q[0] *= -1.0;
    const auto lanes = [&](auto&& get) {
      double x[V::size];
      for (int k = 0; k < V::size; ++k) x[k] = get(p[k]);
      return V::load(x);
    };
    const auto vectors = [&](auto&& get) {
      return Vector<V>{lanes([&](auto& q) { return get(q).x; }), lanes([&](auto& q) { return get(q).y; }),
                       lanes([&](auto& q) { return get(q).z; })};
    };
    const Flow<V> flow{lanes([](auto& q) { return q.flow.rho; }),
                       lanes([](auto& q) { return q.flow.mu; }),
                       lanes([](auto& q) { return q.flow.distance; }),
                       vectors([](auto& q) { return q.flow.u; }),
                       vectors([](auto& q) { return q.flow.v; }),
                       vectors([](auto& q) { return q.flow.w; }),
                       vectors([](auto& q) { return q.flow.density_gradient; }),
                       lanes([](auto& q) { return q.flow.longest_side; }),
                       lanes([](auto& q) { return q.flow.width; })};
    Turbulence<V, n> t;
    for (int k = 0; k < n; ++k)
      t.q[k] = lanes([&](auto& q) { return q.t.q[k]; }), t.gradient[k] = vectors([&](auto& q) { return q.t.gradient[k]; });
    const auto c = TestType{}.closure(flow, t);
    for (int lane = 0; lane < V::size; ++lane)
      CHECK(c.eddy_viscosity[lane] == Approx(TestType{}.closure(p[lane].flow, p[lane].t).eddy_viscosity).epsilon(1e-13));
    if constexpr (n > 0) {
      const auto s = TestType{}.source(flow, t);
      const auto J = TestType{}.source_jacobian(flow, t);
      for (int lane = 0; lane < V::size; ++lane) {
        const auto one = TestType{}.source(p[lane].flow, p[lane].t);
        for (int k = 0; k < n; ++k) {
          CHECK(s.rate[k][lane] == Approx(one.rate[k]).epsilon(1e-12).margin(1e-12 * size(p[lane], k)));
          CHECK(J.m[k][k][lane] == Approx(TestType{}.source_jacobian(p[lane].flow, p[lane].t).m[k][k])
                                       .epsilon(1e-10)
                                       .margin(1e-12 * size(p[lane], k) / std::abs(p[lane].t.q[k])));
        }
      }
    }
  }
}

TEMPLATE_LIST_TEST_CASE("turbulence is finite where nothing moves", "[turbulence][fast]", All) {
  Generator g;
  auto p = point<TestType>(g);
  const Vector<double> none{0, 0, 0};
  p.flow.u = p.flow.v = p.flow.w = p.flow.density_gradient = none;
  for (auto& v : p.t.gradient) v = none;
  for (const double q : {0.0, 1e-30, 1e-5}) {
    p.t.q[0] = q;
    const auto c = TestType{}.closure(p.flow, p.t);
    if constexpr (TestType::equations > 0) {
      const auto s = TestType{}.source(p.flow, p.t);
      const auto J = TestType{}.source_jacobian(p.flow, p.t);
      for (int k = 0; k < TestType::equations; ++k) {
        CHECK(std::isfinite(s.rate[k]));
        CHECK(std::isfinite(J.m[k][k]));
        CHECK(c.diffusivity[k] >= p.flow.mu);
      }
    }
    CHECK(c.eddy_viscosity >= 0.0);
    CHECK(std::isfinite(c.eddy_viscosity));
  }
}

TEMPLATE_LIST_TEST_CASE("an eddy viscosity is finite and not negative, and none on a wall", "[turbulence][fast]", All) {
  Generator g;
  for (int sample = 0; sample < 200; ++sample) {
    auto p = point<TestType>(g);
    const auto c = TestType{}.closure(p.flow, p.t);
    CHECK(c.eddy_viscosity >= 0.0);
    CHECK(std::isfinite(c.eddy_viscosity));
    for (int k = 0; k < TestType::equations; ++k) CHECK(c.diffusivity[k] >= p.flow.mu);
    if constexpr (TestType::equations > 0) {
      const auto on_wall = TestType{}.wall(p.flow.distance, p.flow.mu / p.flow.rho);
      for (int k = 0; k < TestType::equations; ++k) p.t.q[k] = on_wall[std::size_t(k)];
      CHECK(TestType{}.closure(p.flow, p.t).eddy_viscosity == 0.0);
    }
  }
}

TEST_CASE("scalars go with the mass and down their gradient", "[turbulence][fast]") {
  CHECK(convected(2.0, 3.0, 5.0) == 6.0);
  CHECK(convected(-2.0, 3.0, 5.0) == -10.0);
  const gas::Face<double> f{0.6, 0.8, 0.0, 2.0, 0.0};
  CHECK(diffused(0.5, Vector<double>{1.0, 1.0, 7.0}, f) == Approx(-1.4));
}
