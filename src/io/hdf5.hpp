// Owners of HDF5 ids and its error messages as exceptions. Only for the .cpp files of this folder that write or read HDF5.
// The library is not thread-safe and its calls on a file are collective: one HDF5 task at a time in a process, in the same order on all ranks.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hdf5.h>
#include <mpi.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace spindrift::io::hdf5 {

/// Owns an id that Close releases; a moved-from owner is empty.
template <herr_t (*Close)(hid_t)>
class Owned {
 public:
  Owned() = default;
  explicit Owned(hid_t id) : id_(id) {}
  Owned(Owned&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)) {}
  Owned& operator=(Owned&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~Owned() {
    if (id_ >= 0) Close(id_);
  }
  hid_t get() const { return id_; }
  hid_t release() { return std::exchange(id_, H5I_INVALID_HID); }

 private:
  hid_t id_ = H5I_INVALID_HID;
};

using File = Owned<H5Fclose>;
using Dataset = Owned<H5Dclose>;
using Space = Owned<H5Sclose>;
using Attribute = Owned<H5Aclose>;
using Type = Owned<H5Tclose>;
using Properties = Owned<H5Pclose>;

/// The library's own words on its last failure, innermost first; clears them.
std::string last_error();

/// `result` where it is not negative, else throws MachineFailure("WHAT: library's message").
hid_t checked(hid_t result, const std::string& what);

/// Collective. By MPI where there is more than one rank. Metadata in the newest format that HDF5 1.10 writes, because that is checksummed.
File create(MPI_Comm comm, const std::filesystem::path& path);
/// Collective, for reading.
File open(MPI_Comm comm, const std::filesystem::path& path);
/// To disk, then closed. Where either fails the id is given up so that no destructor tries again. Collective; throws on the failing rank only.
void finish(File file, const std::filesystem::path& path);

/// A run of elements of a dataset seen as one long row, and where they are in memory.
struct Piece {
  std::int64_t offset, count;
  void* data;  ///< only read where written from
};

/// Collective over `comm`: every rank writes its pieces (none is fine), in as many rounds as the rank with the most needs.
/// `extents` is the shape of the dataset; pieces of a dataset of more than one dimension are whole multiples of its last ones.
void write_pieces(MPI_Comm comm, hid_t dataset, hid_t memory_type, std::span<const Piece> pieces, const std::string& what);

/// Not collective.
void read_piece(hid_t dataset, hid_t memory_type, const Piece& piece, const std::string& what);

void set_attribute(hid_t object, const char* name, hid_t type, const void* value);
void set_attribute(hid_t object, const char* name, const std::string& text);
/// Throws where it is missing.
void get_attribute(hid_t object, const char* name, hid_t type, void* value);
std::string get_text_attribute(hid_t object, const char* name);

}  // namespace spindrift::io::hdf5
