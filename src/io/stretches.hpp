// Boxes of large arrays, each box on some rank, brought together so that every rank writes one stretch of the arrays: few large
// writes, whoever has which box. The arrays stand behind each other in one row of elements, which the ranks share out evenly.
// Used by fields.cpp; tested in tests/src/io/fields_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mpi.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "src/io/shared_hdf5.hpp"

namespace spindrift::io {

class Stretches {
 public:
  using Index = std::array<std::int64_t, 3>;  ///< (i, j, k); i is fastest
  /// Elements [low, high) of an array.
  struct Box {
    int array;
    Index low, high;
  };
  /// Where a box's values are: that at its `low` first, then `row` elements on from j to j + 1, `plane` from k to k + 1.
  struct Source {
    std::span<const double> values;
    std::int64_t row, plane;
  };
  /// Less is not worth a write of its own: 256 kB of single precision.
  static constexpr std::int64_t shortest = 1 << 16;

  /// Collective. `extents` of all arrays, the same everywhere; `mine` are this rank's boxes. All ranks' boxes cover each array
  /// once. A rank's boxes have fewer than 2^31 elements.
  Stretches(MPI_Comm comm, std::vector<Index> extents, std::vector<Box> mine);

  /// Collective. Writes a field of so many components to the places of its arrays in the file [bytes]. Stored: float or double.
  /// `sources`: of this rank's boxes.
  template <class Stored>
  void write(hdf5::SharedFile& file, std::span<const std::int64_t> places, int components, std::span<const Source> sources);

 private:
  std::int64_t begin(int rank) const { return std::min(rank * share_, first_.back()); }
  /// Calls visit(rank, i, j, k, at, count): elements of a box from (i, j, k) on, which begin at `at` of all elements and are in
  /// that rank's stretch. In the order of the array, so that both ends of a message know the order in it.
  template <class Visit>
  void for_pieces(const Box& box, Visit&& visit) const;
  void check(std::span<const Box> boxes) const;

  /// Elements by other rank, and where those of a rank begin in a message.
  struct Shares {
    std::vector<int> count, at;
    std::int64_t find_places();  ///< from the counts; returns their sum
  };

  MPI_Comm comm_;
  std::vector<Index> extents_;
  std::vector<std::int64_t> first_;  ///< by array, then the end: place in the row of all elements
  std::int64_t share_;               ///< of a rank
  std::vector<Box> mine_, taken_;    ///< the boxes here; those of other ranks that reach into this rank's stretch
  Shares sent_, received_;
  std::vector<std::byte> out_, in_, stretch_;  ///< as large as the largest field so far: fresh memory costs more than the copying
};

}  // namespace spindrift::io
