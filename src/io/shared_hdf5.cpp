// SPDX-License-Identifier: Apache-2.0
#include "src/io/shared_hdf5.hpp"

#include "src/io/collective.hpp"
#include "src/io/disk_room.hpp"
#include "src/io/machine_failure.hpp"

namespace spindrift::io::hdf5 {

namespace {

/// For the file's own tables: much more than they take.
constexpr std::int64_t table_bytes = 1 << 20;

std::int64_t bytes_of(const SharedFile::Array& array) {
  auto bytes = static_cast<std::int64_t>(H5Tget_size(array.type));
  for (const hsize_t extent : array.extents) bytes *= static_cast<std::int64_t>(extent);
  return bytes;
}

/// Allocates the array's place at once and never fills it: its values come from the ranks.
std::int64_t lay_out(hid_t file, const SharedFile::Array& array) {
  const Space space(checked(H5Screate_simple(static_cast<int>(array.extents.size()), array.extents.data(), nullptr), array.name));
  const Properties parents(H5Pcreate(H5P_LINK_CREATE)), creation(H5Pcreate(H5P_DATASET_CREATE));
  H5Pset_create_intermediate_group(parents.get(), 1);
  H5Pset_alloc_time(creation.get(), H5D_ALLOC_TIME_EARLY);
  H5Pset_fill_time(creation.get(), H5D_FILL_TIME_NEVER);
  const Dataset dataset(
      checked(H5Dcreate2(file, array.name.c_str(), array.type, space.get(), parents.get(), creation.get(), H5P_DEFAULT),
              "cannot create array " + array.name));
  if (array.describe) array.describe(dataset.get());
  if (bytes_of(array) == 0) return 0;
  const haddr_t offset = H5Dget_offset(dataset.get());
  if (offset == HADDR_UNDEF) throw MachineFailure("HDF5 gives no place to array " + array.name + ": " + last_error());
  return static_cast<std::int64_t>(offset);
}

}  // namespace

SharedFile::SharedFile(MPI_Comm comm, std::filesystem::path path)
    : comm_(comm), path_(std::move(path)), temporary_(temporary_of(path_)) {
  io::on_root(comm_, [&] {
    std::error_code error;
    if (path_.has_parent_path()) std::filesystem::create_directories(path_.parent_path(), error);
    if (error) throw MachineFailure("cannot create " + path_.parent_path().string() + ": " + error.message());
    require_room(temporary_, table_bytes, 0);
    file_ = create(temporary_);
  });
  together(comm_, [&] { raw_ = OutputFile(temporary_, OutputFile::Start::end); });
}

SharedFile::~SharedFile() {
  abandon(std::move(file_));
  std::error_code ignored;
  if (rank_of(comm_) == 0) std::filesystem::remove(temporary_, ignored);  // gone already where committed
}

std::vector<std::int64_t> SharedFile::add(std::span<const Array> arrays) {
  std::int64_t more = 0;
  for (const Array& array : arrays) more += bytes_of(array);
  together(comm_, [&] { require_room(temporary_, bytes_ + more + table_bytes, bytes_); });
  bytes_ += more;
  std::vector<std::int64_t> offsets(arrays.size());
  io::on_root(comm_, [&] {
    for (std::size_t i = 0; i < arrays.size(); ++i) offsets[i] = lay_out(file_.get(), arrays[i]);
  });
  MPI_Bcast(offsets.data(), static_cast<int>(offsets.size()), MPI_INT64_T, 0, comm_);
  return offsets;
}

void SharedFile::on_root(const std::function<void(hid_t)>& work) {
  io::on_root(comm_, [&] { work(file_.get()); });
}

void SharedFile::commit() {
  together(comm_, [&] { raw_.sync(); });
  io::on_root(comm_, [&] {
    finish(std::move(file_), temporary_);
    commit_file(temporary_, path_);
  });
}

}  // namespace spindrift::io::hdf5
