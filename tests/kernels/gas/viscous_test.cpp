// Viscous terms: gradients exact for linear fields on skewed cells, fluxes of known flows, laws of stress.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/gas/viscous.hpp"

#include <catch2/catch.hpp>

#include "tests/kernels/gas/states.hpp"

using namespace spindrift;
using namespace spindrift::gas;
using namespace spindrift::gas::testing;

namespace {
Vector<double> vector(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
Gradients<double> gradients(const Eigen::Matrix3d& G, const Eigen::Vector3d& T) {  // G_ij = du_i/dx_j
  return {vector(G.row(0)), vector(G.row(1)), vector(G.row(2)), vector(T)};
}
}  // namespace

TEST_CASE("Green-Gauss over a closed cell gives the gradient of a linear field", "[gas][fast]") {
  // A parallelepiped of edges a, b, c; face areas are cross products, face values those of the field at the face centres.
  const Eigen::Vector3d a(1.0, 0.2, -0.1), b(-0.3, 0.5, 0.2), c(0.1, 0.4, 2.0), slope(3.0, -2.0, 0.7);
  const Eigen::Vector3d area[] = {b.cross(c), c.cross(a), a.cross(b)}, edge[] = {a, b, c};
  Vector<double> gradient{0, 0, 0};
  for (int d = 0; d < 3; ++d)
    add_face_pair(gradient, 5.0 - 0.5 * slope.dot(edge[d]), vector(area[d]), 5.0 + 0.5 * slope.dot(edge[d]), vector(area[d]));
  const double volume = a.dot(b.cross(c));
  CHECK(gradient.x / volume == Approx(3.0));
  CHECK(gradient.y / volume == Approx(-2.0));
  CHECK(gradient.z / volume == Approx(0.7));
}

TEST_CASE("the face gradient keeps linear fields on skewed faces and sees odd from even cells", "[gas][fast]") {
  Generator g;
  for (int n = 0; n < 100; ++n) {
    const auto f = g.face();
    const Eigen::Vector3d normal(f.nx, f.ny, f.nz), d = 0.1 * (normal + 0.8 * g.direction()), slope = 10.0 * g.direction();
    const auto line = face_line(vector(d), f);
    const auto exact = face_gradient(vector(slope), vector(slope), slope.dot(d), line);
    CHECK(exact.x == Approx(slope.x()).margin(1e-12));
    CHECK(exact.y == Approx(slope.y()).margin(1e-12));
    CHECK(exact.z == Approx(slope.z()).margin(1e-12));
    // Along the line of centres the gradient is the direct difference, whatever the cells' own gradients say.
    const auto odd = face_gradient(vector(slope), vector(-slope), 0.3, line);
    CHECK(odd.x * d.x() + odd.y * d.y() + odd.z * d.z() == Approx(0.3));
  }
}

TEST_CASE("shear, expansion and conduction give Newton's and Fourier's fluxes", "[gas][fast]") {
  const Face<double> up{0.0, 1.0, 0.0, 2.0, 0.0};
  const Transport<double> t{3.0, 5.0};
  Eigen::Matrix3d shear = Eigen::Matrix3d::Zero();
  shear(0, 1) = 7.0;  // du/dy
  const auto couette = viscous_flux(t, gradients(shear, {0, 11.0, 0}), 13.0, 0.0, 0.0, up);
  CHECK(couette.rho == 0.0);
  CHECK(couette.mx == Approx(-2.0 * 3.0 * 7.0));
  CHECK(couette.my == Approx(0.0).margin(1e-15));
  CHECK(couette.E == Approx(-2.0 * (3.0 * 7.0 * 13.0 + 5.0 * 11.0)));
  // Uniform expansion has no stress (Stokes), nor has rigid rotation.
  const auto expansion = viscous_flux(t, gradients(4.0 * Eigen::Matrix3d::Identity(), {0, 0, 0}), 1.0, 2.0, 3.0, up);
  CHECK(expansion.my == Approx(0.0).margin(1e-13));
  Eigen::Matrix3d spin = Eigen::Matrix3d::Zero();
  spin(0, 1) = -2.0, spin(1, 0) = 2.0;
  CHECK(viscous_flux(t, gradients(spin, {0, 0, 0}), 1.0, 2.0, 3.0, up).mx == Approx(0.0).margin(1e-15));
  // 2/3 rho k acts as a pressure.
  CHECK(viscous_flux(t, gradients(spin, {0, 0, 0}), 0.0, 0.0, 0.0, up, 0.5).my == Approx(2.0 * 0.5));
}

TEST_CASE("viscous fluxes turn with the axes, change sign with the face, and drain energy", "[gas][fast]") {
  Generator g;
  const IdealGas gas;
  for (int n = 0; n < 100; ++n) {
    const auto f = g.face();
    Eigen::Matrix3d G;
    for (int k = 0; k < 9; ++k) G(k) = g.between(-100, 100);
    const Eigen::Vector3d T = 50 * g.direction(), u = 100 * g.direction();
    const auto t = transport(gas, 1.8e-5, g.between(0, 1e-3));
    const Eigen::Matrix3d R = random_rotation(g);
    const auto flux = viscous_flux(t, gradients(G, T), u.x(), u.y(), u.z(), f);
    const Eigen::Vector3d Ru = R * u;
    const auto turned = viscous_flux(t, gradients(R * G * R.transpose(), R * T), Ru.x(), Ru.y(), Ru.z(), rotated(f, R));
    const auto back = viscous_flux(t, gradients(G, T), u.x(), u.y(), u.z(), reversed(f));
    const Conserved<double> scale{1.0, 1.0, 1.0, 1.0, 100.0};
    CHECK(difference(rotated(flux, R), turned, scale) < 1e-11);
    CHECK(difference(flux, -1.0 * back, scale) < 1e-14);
    // Stress times gradient is never negative: mechanical energy only falls.
    double power = 0;
    for (int row = 0; row < 3; ++row) {
      const Face<double> axis{row == 0 ? 1.0 : 0.0, row == 1 ? 1.0 : 0.0, row == 2 ? 1.0 : 0.0, 1.0, 0.0};
      const auto s = viscous_flux(t, gradients(G, T), 0.0, 0.0, 0.0, axis);
      power -= s.mx * G(0, row) + s.my * G(1, row) + s.mz * G(2, row);
    }
    CHECK(power >= 0.0);
  }
}

TEST_CASE("the thin layer sees what varies across a face", "[gas][fast]") {
  const IdealGas gas;
  const Primitive<double> l{0, 0, 0, 0, 300}, r{0, 2.0, 0, 0, 310};
  const Face<double> up{0.0, 1.0, 0.0, 1.0, 0.0};
  const auto line = face_line(Vector<double>{0.3, 0.1, 0.0}, up);
  const auto thin = thin_layer_gradients(l, r, line);
  CHECK(thin.u.y == Approx(20.0));
  CHECK(thin.u.x == 0.0);
  CHECK(thin.T.y == Approx(100.0));
  const Gradients<double> none{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  CHECK(face_gradients(none, none, l, r, line).u.y == Approx(20.0));
  const auto t = transport(gas, 2e-5, 1e-4);
  CHECK(t.mu == Approx(1.2e-4));
  CHECK(t.conductivity == Approx(gas.cp() * (2e-5 / 0.72 + 1e-4 / 0.9)));
}
