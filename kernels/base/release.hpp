// Giving memory back before a name goes out of scope. Used where large arrays are passed on; tested through the memory of what
// uses it. SPDX-License-Identifier: Apache-2.0
#pragma once

namespace spindrift {

/// Gives the memory of containers back; an assignment of {} only empties a vector.
template <class... Containers>
void release(Containers&... containers) {
  ((containers = Containers()), ...);
}

}  // namespace spindrift
