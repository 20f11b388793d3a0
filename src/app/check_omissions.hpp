// What `check --columns` says could be left out of a scene, with its price in these columns. Called by check.cpp; what is tried
// is leave_out.cpp's. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "src/app/commands.hpp"

namespace spindrift::app {

/// Nothing where no columns are asked for.
void print_omissions(const CheckArguments& arguments);

}  // namespace spindrift::app
