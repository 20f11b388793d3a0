// How particles lie in memory: clusters of 16 near neighbours, one lane each, several planes of 16 numbers per cluster side by
// side; clusters stand in the order of the groups (columns of cells) of the scene. Why so: docs/developer/notes/sea.md.
// Called by every file of src/sea/sph; tested in tests/src/sea/sph/ordering_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <new>
#include <vector>

namespace spindrift::sph {

inline constexpr int cluster_size = 16;  ///< a float register of AVX-512; measured against 8 in docs/developer/notes/sea.md
inline constexpr std::uint32_t no_particle = std::numeric_limits<std::uint32_t>::max();  ///< id of an empty lane
inline constexpr double empty_lane_offset_m =
    1e9;  ///< position of an empty lane: outside every support, its square finite in float

/// Starts on a cache line and leaves new elements uninitialised, which lets the thread that first writes a page own it.
template <class T>
struct CacheLineAllocator {
  using value_type = T;
  CacheLineAllocator() = default;
  template <class U>
  CacheLineAllocator(const CacheLineAllocator<U>&) {}
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), std::align_val_t(64))); }
  void deallocate(T* p, std::size_t) { ::operator delete(p, std::align_val_t(64)); }
  template <class U>
  void construct(U* p) {
    ::new (static_cast<void*>(p)) U;
  }
  template <class U, class... Args>
  void construct(U* p, Args&&... args) {
    ::new (static_cast<void*>(p)) U(static_cast<Args&&>(args)...);
  }
  template <class U>
  bool operator==(const CacheLineAllocator<U>&) const {
    return true;
  }
};
template <class T>
using Array = std::vector<T, CacheLineAllocator<T>>;

/// Clusters [fluid, solid) are water, [solid, end) walls and bodies. A group is the unit of work, of colouring and of ownership.
struct Group {
  std::uint32_t fluid = 0, solid = 0, end = 0;
};

}  // namespace spindrift::sph
