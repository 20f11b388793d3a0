// What a side of a window records. Used by air_side.hpp and body_side.hpp. SPDX-License-Identifier: Apache-2.0
#pragma once

namespace spindrift::coupling {

/// `single`: one task after the other, for which a team of threads would only cost time; `many`: worth all threads.
enum class Tasks { none, single, many };

}  // namespace spindrift::coupling
