// An array of a side's state to be written into a checkpoint: the side says which arrays there are and hands in its pieces; ranks
// that have another side know neither. Used by air_file.cpp, sides.cpp and src/run; tested in coupled_system_test.py.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runtime/mpi/parts.hpp"
#include "src/io/checkpoint.hpp"

namespace spindrift::coupling {

struct SavedArray {
  struct Piece {
    std::int64_t offset;
    std::vector<double> values;
  };
  std::string name;
  std::int64_t total = 0;
  std::vector<Piece> pieces;  ///< those of this rank; all ranks' together are the whole
};

/// Collective over the file's ranks.
void write(io::CheckpointWriter& file, const SavedArray& array);
void write(io::CheckpointCopy& copy, std::vector<SavedArray> arrays);
/// The arrays that a part of the ranks has; `arrays` are read there alone. Collective over all ranks, which the file is of.
void write(io::CheckpointCopy& copy, const runtime::Parts& parts, int part, std::vector<SavedArray> arrays);

}  // namespace spindrift::coupling
