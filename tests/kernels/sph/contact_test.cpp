// Laws of kernels/sph/contact.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/sph/contact.hpp"

#include <catch2/catch.hpp>

using namespace spindrift::sph;
using V = Vec<double, 3>;

TEST_CASE("contact starts at one spacing, pushes along the line of centres, never pulls", "[sph][fast]") {
  const Contact contact(0.1, 1.0, 20.0, 1.0, 0.5, 0.0);
  CHECK(contact.stiffness == Approx(4e4));
  CHECK(dot(contact.force(V{0.1, 0, 0}, V{}), V{1, 1, 1}) == 0.0);
  CHECK(contact.force(V{0.09, 0, 0}, V{})[0] == Approx(400.0));
  CHECK(contact.force(V{-0.09, 0, 0}, V{})[0] == Approx(-400.0));
  CHECK(contact.force(V{0.09, 0, 0}, V{100, 0, 0})[0] == 0.0);           // parting faster than the spring follows
  CHECK(contact.force(V{0.09, 0, 0}, V{-1, 0, 0})[0] == Approx(600.0));  // c = 200
  CHECK(contact.force(V{0.09, 0, 0}, V{0, 3, 0})[1] == 0.0);             // no friction
  CHECK(std::isfinite(contact.force(V{}, V{1, 1, 1})[0]));
}

TEST_CASE("friction is Coulomb's at speed, against the sliding, smooth at rest", "[sph][fast]") {
  const Contact contact(0.1, 1.0, 20.0, 1.0, 0.5, 0.3);
  CHECK(contact.force(V{0.09, 0, 0}, V{0, 10, 0})[1] == Approx(-0.3 * 400.0));
  CHECK(contact.force(V{0.09, 0, 0}, V{0, 1e-3, 0})[1] == Approx(-200.0 * 1e-3));
  CHECK(contact.force(V{0.09, 0, 0}, V{})[1] == 0.0);
  const V a = contact.force(V{0.05, 0.03, 0.01}, V{1, 2, 3}), b = contact.force(V{-0.05, -0.03, -0.01}, V{-1, -2, -3});
  for (int k = 0; k < 3; ++k) CHECK(a[k] == -b[k]);
}
