// An array on 64-byte lines that owns its numbers. Allocated pages are touched first by whoever fills them, so a task that
// builds a tile puts it into the memory of its own processor.
// Used throughout src/aero; tested through tests/src/aero/grid.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <new>
#include <span>

namespace spindrift::aero {

template <class T>
class AlignedArray {
 public:
  AlignedArray() = default;
  /// All zero: padding and unused ghosts are read by wide loads and must be finite.
  explicit AlignedArray(std::size_t size) : data_(static_cast<T*>(::operator new(size * sizeof(T), line))), size_(size) {
    std::fill_n(data_.get(), size, T(0));
  }
  T* data() { return data_.get(); }
  const T* data() const { return data_.get(); }
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return size_ * sizeof(T); }
  std::span<T> span() { return {data(), size_}; }
  std::span<const T> span() const { return {data(), size_}; }

 private:
  static constexpr std::align_val_t line{64};
  struct Release {
    void operator()(T* data) const { ::operator delete(data, line); }
  };
  std::unique_ptr<T, Release> data_;
  std::size_t size_ = 0;
};

}  // namespace spindrift::aero
