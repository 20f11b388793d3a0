// GMRES and GCG on small dense systems: the exact solution after n steps, and the same residuals as each other on the way.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/linear/krylov.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

using namespace spindrift::linear;

namespace {

/// Solves a x = b as the tasks of the flow solver do, and gives the residual norm after each step.
std::vector<double> gmres(const Eigen::MatrixXd& a, const Eigen::VectorXd& b, Eigen::VectorXd& x, int steps) {
  Gmres method;
  std::vector<Eigen::VectorXd> v{b / b.norm()};
  std::vector<double> norms;
  method.start(b.norm());
  for (int j = 0; j < steps; ++j) {
    Eigen::VectorXd w = a * v.back();
    std::vector<double> dots;
    for (const auto& u : v) dots.push_back(w.dot(u));
    dots.push_back(w.dot(w));
    method.append(dots);
    norms.push_back(method.residual_norm());
    for (int r = 0; r <= j; ++r) w -= method.projections()[std::size_t(r)] * v[std::size_t(r)];
    v.push_back(w * method.next_scale());
  }
  std::vector<double> y(static_cast<std::size_t>(steps));
  method.solve(y);
  x.setZero(b.size());
  for (int j = 0; j < steps; ++j) x += y[std::size_t(j)] * v[std::size_t(j)];
  return norms;
}

std::vector<double> gcg(const Eigen::MatrixXd& a, const Eigen::VectorXd& b, Eigen::VectorXd& x, int steps) {
  Gcg method;
  std::vector<Eigen::VectorXd> p, q;
  std::vector<double> norms;
  Eigen::VectorXd residual = b;
  x.setZero(b.size());
  method.start(b.norm());
  for (int j = 0; j < steps; ++j) {
    Eigen::VectorXd z = residual, w = a * z;
    std::vector<double> dots;
    for (const auto& u : q) dots.push_back(w.dot(u));
    dots.push_back(w.dot(w));
    dots.push_back(residual.dot(w));
    method.append(dots);
    for (int r = 0; r < j; ++r) {
      z -= method.projections()[std::size_t(r)] * p[std::size_t(r)];
      w -= method.projections()[std::size_t(r)] * q[std::size_t(r)];
    }
    p.push_back(z * method.scale()), q.push_back(w * method.scale());
    x += method.alpha() * p.back(), residual -= method.alpha() * q.back();
    norms.push_back(method.residual_norm());
  }
  return norms;
}

}  // namespace

TEST_CASE("GMRES and GCG take the same steps and end at the solution", "[linear][fast]") {
  std::srand(3);
  const int n = 12;
  Eigen::MatrixXd a = Eigen::MatrixXd::Random(n, n) + 3.0 * Eigen::MatrixXd::Identity(n, n);
  const Eigen::VectorXd b = Eigen::VectorXd::Random(n);
  for (const int steps : {4, 8, n}) {
    Eigen::VectorXd x, y;
    const auto first = gmres(a, b, x, steps), second = gcg(a, b, y, steps);
    CHECK((b - a * x).norm() == Approx(first.back()).margin(1e-9));
    CHECK((b - a * y).norm() == Approx(first.back()).margin(1e-6));
    for (std::size_t s = 0; s + 1 < first.size(); ++s) CHECK(second[s] == Approx(first[s]).margin(1e-6));
    if (steps == n) CHECK((b - a * x).norm() < 1e-8);
  }
}

TEST_CASE("a direction that brings nothing new ends a cycle", "[linear][fast]") {
  Gmres method;
  method.start(1.0);
  method.append(std::vector<double>{2.0, 4.0});  // w = 2 v_0
  CHECK(method.breakdown());
  CHECK(method.residual_norm() == Approx(0.0).margin(1e-12));
  std::vector<double> y(1);
  method.solve(y);
  CHECK(y[0] == Approx(0.5));
}

TEST_CASE("a cycle that ends for want of digits does not count as solved", "[linear][fast]") {
  Gmres method;
  method.start(1.0);
  method.append(std::vector<double>{2.0, 4.0 + 4e-7});  // all but a few ten thousandths of w along v_0
  CHECK(method.breakdown());
  CHECK(method.residual_norm() == Approx(std::sqrt(1e-7)).epsilon(1e-3));
}
