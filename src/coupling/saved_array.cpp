// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/saved_array.hpp"

#include <utility>

namespace spindrift::coupling {

void write(io::CheckpointWriter& file, const SavedArray& array) {
  std::vector<io::Slice<const double>> slices;
  for (const SavedArray::Piece& piece : array.pieces) slices.push_back({piece.offset, std::span<const double>(piece.values)});
  file.write<double>(array.name, array.total, slices);
}

void write(io::CheckpointCopy& copy, std::vector<SavedArray> arrays) {
  for (SavedArray& a : arrays) copy.add([array = std::move(a)](io::CheckpointWriter& file) { write(file, array); });
}

void write(io::CheckpointCopy& copy, const runtime::Parts& parts, int part, std::vector<SavedArray> arrays) {
  runtime::Packer names;
  for (const SavedArray& a : arrays) names.put(std::span<const char>(a.name)), names.put_one(a.total);
  const runtime::Bytes all = parts.share(part, names.take());
  if (!parts.has(part)) {
    arrays.clear();
    for (runtime::Unpacker from(all); !from.done();) {
      SavedArray& a = arrays.emplace_back();
      const std::vector<char> name = from.many<char>();
      a.name.assign(name.begin(), name.end());
      a.total = from.one<std::int64_t>();
    }
  }
  write(copy, std::move(arrays));
}

}  // namespace spindrift::coupling
