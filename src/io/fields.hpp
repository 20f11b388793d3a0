// Fields for ParaView: named values with components on curvilinear multi-block grids and on particles, as time series.
// One HDF5 file per output (fields/NAME_TICK.h5; positions in double, values in single precision) and one fields/NAME.xdmf to
// open. Each rank hands in what it owns. Called by the coupling at output times. Tested in tests/src/io/fields_test.cpp (read
// back by h5py). SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mpi.h>

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace spindrift::io {

struct Field {
  std::string name, unit;
  int components = 1;  ///< 1 scalar, 3 vector, 6 symmetric tensor (xx xy xz yy yz zz), 9 tensor
};

/// Where a series begins: before everything, or after the restart's time.
inline constexpr double from_the_start = -std::numeric_limits<double>::infinity();

/// A block of ni x nj x nk cells; nk = 0: a surface of ni x nj faces. Arrays have i fastest, then j, then k; components of one
/// place lie together.
struct GridBlock {
  std::string name;
  int ni, nj, nk;
};

class GridFields {
 public:
  struct Values {
    int block;                                    ///< index into the list of all blocks
    std::span<const double> points;               ///< corners, 3 (ni+1)(nj+1)(nk+1) coordinates [m]
    std::vector<std::span<const double>> fields;  ///< in the order declared, components x ni nj nk each, at cell centres
  };

  /// Collective. `blocks` is the list of all ranks' blocks, the same everywhere. Where the grid does not move its points are
  /// stored once.
  GridFields(MPI_Comm comm, std::filesystem::path folder, std::string name, std::vector<GridBlock> blocks,
             std::vector<Field> fields, bool moves, double resume_s = from_the_start);
  ~GridFields();

  /// Collective. Each block comes from one rank.
  void write(std::int64_t tick, double time_s, std::span<const Values> mine);

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

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spindrift::io
