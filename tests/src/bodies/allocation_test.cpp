// A step does not allocate: malloc is counted while one runs.
// SPDX-License-Identifier: Apache-2.0
#include <cstddef>

#include "tests/src/bodies/platform.hpp"

#if defined(__GLIBC__) && !defined(SPINDRIFT_SANITIZED)  // sanitizers have a malloc of their own

namespace {
long allocations = 0;  // tests run one at a time
}

extern "C" void* __libc_malloc(std::size_t size);  // NOLINT: glibc's own, which malloc below stands in for
extern "C" void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}

using namespace spindrift;
using namespace spindrift::bodies;

TEST_CASE("a step of any integrator runs without allocation", "[bodies][fast]") {
  const auto integrator = GENERATE(Integrator::rk4, Integrator::explicit_euler, Integrator::symplectic);
  System system = examples::Platform{.thrust = 1.5e6}.system(integrator);
  BodiesState state = examples::start(system);
  examples::run(system, state, 1e-3, 2);  // the first steps size the work space
  const long before = allocations;
  for (int n = 0; n < 100; ++n) system.advance(state, 1e-3, 1);
  CHECK(allocations - before == 0);
  CHECK(before > 0);  // counting works
}

#endif
