// What a solver of a coarse level (elimination, multigrid) throws where its matrix has no inverse: numerical trouble that the
// preconditioner turns into a rejected pseudo-step (ilu_after_coarse.hpp). Tested in
// tests/src/aero/flow/linear_solver_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>

namespace spindrift::aero {

struct SingularMatrix : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace spindrift::aero
