// Two stages: pressure by algebraic multigrid, then block ILU of each tile for what is left,
//   z = p + ILU^-1 (v - A p),   p = AMG(A_pp)^-1 (w . v)
// with the pressure equation of a cell made by that combination w of its five rows which the inverse of its diagonal block gives:
// velocities and temperature of the cell are eliminated (SIMPLE's Schur complement cell by cell; "alternate block factorisation"
// of Bank et al. 1989, "constrained pressure residual" of Wallis 1983). What is elliptic in a flow at low Mach numbers is global
// and goes to multigrid, what is carried by the flow is local and goes to ILU. Turbulence unknowns stay with ILU. Called by
// make_preconditioner(); tested in tests/src/aero/flow/coarse_correction_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "src/aero/flow/preconditioner.hpp"

namespace spindrift::aero {

std::unique_ptr<Preconditioner> make_pressure_amg(const PreconditionerOptions& options);

}  // namespace spindrift::aero
