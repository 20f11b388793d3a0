// Fields for ParaView: named values with components on curvilinear multi-block grids and on particles, as time series.
// One HDF5 file per output (fields/NAME_TICK.h5; positions in double, values in the precision of their field) and one NAME.xdmf
// to open. Each rank hands in what it owns, of grids boxes of whole blocks. Called by the coupling at output times. Tested in
// tests/src/io/fields_test.cpp (read back by h5py). SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mpi.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace spindrift::io {

/// Bytes of a stored number.
enum class Precision : int { single = 4, full = 8 };

struct Field {
  std::string name, unit;
  int components = 1;                       ///< 1 scalar, 3 vector, 6 symmetric tensor (xx xy xz yy yz zz), 9 tensor
  Precision precision = Precision::single;  ///< full where what counts is a small difference of large numbers
};

/// Where a series begins: before everything, or after the restart's time.
inline constexpr double from_the_start = -std::numeric_limits<double>::infinity();

/// A block of ni x nj x nk cells; nk = 0: a surface of ni x nj faces. Arrays have i fastest, then j, then k; components of one
/// place lie together. In the file each block has an array of points and one for each field, BLOCK/points and BLOCK/FIELD.
struct GridBlock {
  std::string name;
  int ni, nj, nk;
};

class GridFields {
 public:
  /// A box of a block's cells.
  struct Values {
    int block;                                    ///< index into the list of all blocks
    std::array<int, 3> low, high;                 ///< cells [low, high) along i, j, k; of a surface k is 0 and 0
    std::span<const double> points;               ///< corners, 3 coordinates [m] of each of one more than the cells
    std::vector<std::span<const double>> fields;  ///< in the order declared, all components of each cell, at its centre
  };

  /// Collective. `blocks` are the same everywhere. Where the grid does not move its points are stored once; the attribute
  /// points_file of every file names the one that has them.
  GridFields(MPI_Comm comm, std::filesystem::path folder, std::string name, std::vector<GridBlock> blocks,
             std::vector<Field> fields, bool moves, double resume_s = from_the_start);
  ~GridFields();

  /// Collective. The boxes of all ranks cover each block once, cut anyhow. Corners that boxes share are taken from the one whose
  /// cells begin there.
  void write(std::int64_t tick, double time_s, std::span<const Values> mine);

  /// Collective. Whether the last output of the series is that of this time.
  bool ends_with(double time_s) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

class ParticleFields {
 public:
  /// Collective.
  ParticleFields(MPI_Comm comm, std::filesystem::path folder, std::string name, std::vector<Field> fields,
                 double resume_s = from_the_start);
  ~ParticleFields();

  /// Collective. This rank's particles: identities, positions (3 each, [m]) and each field's values. They are stored rank after
  /// rank.
  void write(std::int64_t tick, double time_s, std::span<const std::int64_t> ids, std::span<const double> positions,
             std::span<const std::span<const double>> fields);
  /// As GridFields::ends_with.
  bool ends_with(double time_s) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spindrift::io
