// An HDF5 file that all ranks fill: rank 0 lays it out, each rank writes its values to their places in it.
// Only rank 0 calls the HDF5 library; the others (and it) write by plain file operations at the offsets that the layout gives.
// The file is ordinary HDF5. Why not HDF5 over MPI-IO: with HDF5 1.10 and Open MPI 4.1 a full disk leaves ranks waiting for each
// other for ever, in collective transfers as in the flush of metadata; here each rank has its own error and all of them share it
// (collective.hpp). Used by checkpoint.cpp and fields.cpp. Tested through them. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mpi.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "src/io/atomic_file.hpp"
#include "src/io/hdf5.hpp"

namespace spindrift::io::hdf5 {

class SharedFile {
 public:
  struct Array {
    std::string name;  ///< a path; groups are made
    hid_t type;        ///< a native type: values are stored as they are in memory
    std::vector<hsize_t> extents;
    std::function<void(hid_t dataset)> describe;  ///< rank 0 sets attributes; may be empty
  };

  /// Collective. Written beside `path`; nothing is there until commit().
  SharedFile(MPI_Comm comm, std::filesystem::path path);
  ~SharedFile();
  SharedFile(const SharedFile&) = delete;
  SharedFile& operator=(const SharedFile&) = delete;

  MPI_Comm comm() const { return comm_; }
  /// Collective. Makes room for arrays and gives the offset in the file of each [bytes]; that of an empty array means nothing.
  std::vector<std::int64_t> add(std::span<const Array> arrays);
  /// Not collective: throws on this rank only, so call it within together().
  void write(std::int64_t offset, std::span<const std::byte> bytes) { raw_.write_at(offset, bytes); }
  /// Collective; `work` runs on rank 0 with the file's id.
  void on_root(const std::function<void(hid_t file)>& work);
  /// Collective. To disk on every rank, then to its place.
  void commit();

 private:
  MPI_Comm comm_;
  std::filesystem::path path_, temporary_;
  File file_;  // rank 0
  OutputFile raw_;
  std::int64_t bytes_ = 0;
};

}  // namespace spindrift::io::hdf5
