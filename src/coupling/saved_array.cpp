// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/saved_array.hpp"

namespace spindrift::coupling {

void write(io::CheckpointWriter& file, const SavedArray& array) {
  std::vector<io::Slice<const double>> slices;
  for (const SavedArray::Piece& piece : array.pieces) slices.push_back({piece.offset, std::span<const double>(piece.values)});
  file.write<double>(array.name, array.total, slices);
}

void write(io::CheckpointWriter& file, const runtime::Parts& parts, int part, std::vector<SavedArray> arrays) {
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
  for (const SavedArray& a : arrays) write(file, a);
}

}  // namespace spindrift::coupling
