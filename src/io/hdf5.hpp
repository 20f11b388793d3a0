// Owners of HDF5 ids and its error messages as exceptions. Only for the .cpp files of this folder that write or read HDF5.
// The library is not thread-safe: one call at a time in a process.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>

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

/// Metadata in the newest format that HDF5 1.10 writes, because that is checksummed.
File create(const std::filesystem::path& path);
/// For reading.
File open(const std::filesystem::path& path);
/// To disk, then closed; where that fails the file is abandoned.
void finish(File file, const std::filesystem::path& path);
/// Closes a file that is not wanted any more, also one on a disk that takes nothing: HDF5 1.10 keeps the id of a file that it
/// cannot flush and ends in a segmentation fault at MPI_Finalize. So its last writes go to memory instead.
void abandon(File file) noexcept;

/// Reads `count` values of a one-dimensional dataset from index `offset` on.
void read(hid_t dataset, hid_t memory_type, std::int64_t offset, std::int64_t count, void* values, const std::string& what);

void set_attribute(hid_t object, const char* name, hid_t type, const void* value);
void set_attribute(hid_t object, const char* name, const std::string& text);
/// Throws where it is missing.
void get_attribute(hid_t object, const char* name, hid_t type, void* value);
/// Reads every attribute of an object to no end but that damage in one, which HDF5 sees when it reads, is met here.
void read_attributes(hid_t object);
std::string get_text_attribute(hid_t object, const char* name);

}  // namespace spindrift::io::hdf5
