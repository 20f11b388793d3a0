// SPDX-License-Identifier: Apache-2.0
#include "src/io/checkpoint.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <type_traits>

#include "src/io/checksum.hpp"
#include "src/io/collective.hpp"
#include "src/io/machine_failure.hpp"
#include "src/io/shared_hdf5.hpp"

namespace spindrift::io {

namespace fs = std::filesystem;

namespace {

constexpr const char* format_name = "spindrift-checkpoint";
constexpr std::int64_t format_version = 2;
/// The names of all arrays, one per line: an array that is gone is noticed.
constexpr const char* manifest_name = "manifest";

template <class T>
hid_t type_of() {
  if constexpr (std::is_same_v<T, double>) return H5T_NATIVE_DOUBLE;
  if constexpr (std::is_same_v<T, std::int64_t>) return H5T_NATIVE_INT64;
  if constexpr (std::is_same_v<T, std::byte>) return H5T_NATIVE_UINT8;
}

std::uint64_t summed(MPI_Comm comm, std::uint64_t part) {
  MPI_Allreduce(MPI_IN_PLACE, &part, 1, MPI_UINT64_T, MPI_SUM, comm);
  return part;
}

}  // namespace

struct CheckpointWriter::Impl {
  hdf5::SharedFile file;
  std::string manifest;

  template <class Value>
  void set(const std::string& name, hid_t type, const Value* value) {
    file.on_root([&](hid_t id) { hdf5::set_attribute(id, name.c_str(), type, value); });
  }
};

CheckpointWriter::CheckpointWriter(MPI_Comm comm, fs::path path) : impl_(new Impl{{comm, std::move(path)}, {}}) {
  set("format", std::string(format_name));
  set("format_version", format_version);
}

CheckpointWriter::~CheckpointWriter() = default;

template <class T>
void CheckpointWriter::write(const std::string& name, std::int64_t total, std::span<const Slice<const T>> slices) {
  const MPI_Comm comm = impl_->file.comm();
  std::uint64_t sum = 0;
  std::int64_t count = 0;
  for (const auto& slice : slices) {
    count += static_cast<std::int64_t>(slice.values.size());
    sum += checksum<T>(slice.offset, slice.values);
  }
  MPI_Allreduce(MPI_IN_PLACE, &count, 1, MPI_INT64_T, MPI_SUM, comm);
  if (count != total)
    throw std::logic_error("checkpoint array " + name + ": slices hold " + std::to_string(count) + " of " +
                           std::to_string(total));
  sum = summed(comm, sum);

  const hdf5::SharedFile::Array array{name, type_of<T>(), {static_cast<hsize_t>(total)}, [&](hid_t dataset) {
                                        hdf5::set_attribute(dataset, "checksum", H5T_NATIVE_UINT64, &sum);
                                      }};
  const std::int64_t place = impl_->file.add({&array, 1})[0];
  together(comm, [&] {
    for (const auto& slice : slices)
      impl_->file.write(place + slice.offset * static_cast<std::int64_t>(sizeof(T)), std::as_bytes(slice.values));
  });
  impl_->manifest += name + "\n";
}

template <class T>
void CheckpointWriter::write(const std::string& name, std::span<const T> values) {
  const Slice<const T> all{0, values};
  const std::size_t mine = rank_of(impl_->file.comm()) == 0 ? 1 : 0;
  write<T>(name, static_cast<std::int64_t>(values.size()), std::span<const Slice<const T>>(&all, mine));
}

void CheckpointWriter::set(const std::string& name, double value) { impl_->set(name, H5T_NATIVE_DOUBLE, &value); }
void CheckpointWriter::set(const std::string& name, std::int64_t value) { impl_->set(name, H5T_NATIVE_INT64, &value); }
void CheckpointWriter::set(const std::string& name, const std::string& value) {
  impl_->file.on_root([&](hid_t id) { hdf5::set_attribute(id, name.c_str(), value); });
}

void CheckpointWriter::commit() {
  const std::string names = impl_->manifest;
  write<std::byte>(manifest_name, std::as_bytes(std::span(names)));
  impl_->file.commit();
}

struct CheckpointReader::Impl {
  MPI_Comm comm;
  fs::path path;
  hdf5::File file;

  hdf5::Dataset dataset(const std::string& name) const {
    hdf5::Dataset found(H5Dopen2(file.get(), name.c_str(), H5P_DEFAULT));
    if (found.get() < 0) {
      hdf5::last_error();
      throw InputError(path.string() + " has no array " + name + "; restart with the scene of the first run");
    }
    return found;
  }
  template <class T>
  void check_type(const hdf5::Dataset& dataset, const std::string& name) const {
    const hdf5::Type type(H5Dget_type(dataset.get()));
    if (H5Tequal(type.get(), type_of<T>()) <= 0) throw InputError(path.string() + ": array " + name + " holds another type");
  }
  template <class T>
  void verify(const std::string& name) const;
  void verify_all() const;
};

namespace {

std::int64_t size_of_dataset(const hdf5::Dataset& dataset) {
  const hdf5::Space space(H5Dget_space(dataset.get()));
  return H5Sget_simple_extent_npoints(space.get());
}

}  // namespace

template <class T>
void CheckpointReader::Impl::verify(const std::string& name) const {
  constexpr std::int64_t at_once = 1 << 20;
  std::uint64_t stored = 0, sum = 0;
  together(comm, [&] {
    const hdf5::Dataset data = dataset(name);
    hdf5::get_attribute(data.get(), "checksum", H5T_NATIVE_UINT64, &stored);
    const std::int64_t total = size_of_dataset(data), rank = rank_of(comm), ranks = size_of(comm);
    const std::int64_t end = total / ranks * (rank + 1) + std::min(total % ranks, rank + 1);
    std::vector<T> values;
    for (std::int64_t from = total / ranks * rank + std::min(total % ranks, rank); from < end; from += at_once) {
      values.resize(static_cast<std::size_t>(std::min(at_once, end - from)));
      hdf5::read(data.get(), type_of<T>(), from, static_cast<std::int64_t>(values.size()), values.data(), path.string());
      sum += checksum<T>(from, values);
    }
  });
  if (summed(comm, sum) != stored) throw DamagedFile(path.string() + ": array " + name + " is damaged (checksum differs)");
}

void CheckpointReader::Impl::verify_all() const {
  together(comm, [&] {
    if (hdf5::get_text_attribute(file.get(), "format") != format_name)
      throw MachineFailure(path.string() + " is not a checkpoint of Spindrift");
  });
  verify<std::byte>(manifest_name);
  const hdf5::Dataset manifest = dataset(manifest_name);
  std::string names(static_cast<std::size_t>(size_of_dataset(manifest)), '\0');
  hdf5::read(manifest.get(), H5T_NATIVE_UINT8, 0, static_cast<std::int64_t>(names.size()), names.data(), path.string());
  for (std::size_t begin = 0, end; (end = names.find('\n', begin)) != std::string::npos; begin = end + 1) {
    const std::string name = names.substr(begin, end - begin);
    const hdf5::Dataset data = dataset(name);
    const hdf5::Type type(H5Dget_type(data.get()));
    if (H5Tequal(type.get(), H5T_NATIVE_DOUBLE) > 0) {
      verify<double>(name);
    } else if (H5Tequal(type.get(), H5T_NATIVE_INT64) > 0) {
      verify<std::int64_t>(name);
    } else {
      verify<std::byte>(name);
    }
  }
}

namespace {

/// Whether this process may read the file at all says nothing of what is in it.
void require_readable(const fs::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor >= 0) {
    ::close(descriptor);
    return;
  }
  if (errno != EACCES && errno != EPERM) throw_errno("cannot open", path, errno);
  throw InputError(path.string() + ": " + std::strerror(errno) + "; give this user the right to read it");
}

/// HDF5 guards attributes by checksums of its own: what it reads is what was written, and where it reads none the file is
/// damaged.
std::int64_t version_of(hid_t file) {
  std::int64_t version = 0;
  hdf5::get_attribute(file, "format_version", H5T_NATIVE_INT64, &version);
  return version;
}

void require_version(std::int64_t version, const fs::path& path) {
  if (version != format_version)
    throw InputError(path.string() + ": has format version " + std::to_string(version) + ", this program reads " +
                     std::to_string(format_version) + "; go on with the version of the program that wrote it");
}

}  // namespace

CheckpointReader::CheckpointReader(MPI_Comm comm, const fs::path& path) : impl_(std::make_unique<Impl>(Impl{comm, path, {}})) {
  together(comm, [&] { require_readable(path); });
  const auto damage = [](auto&& look) {
    try {
      look();
    } catch (const DamagedFile&) { throw; } catch (const std::exception& error) {
      throw DamagedFile(error.what());  // also a listed array that is not there: damage, not another scene
    }
  };
  std::int64_t version = 0;
  damage([&] {
    together(comm, [&] {
      impl_->file = hdf5::open(path);
      hdf5::read_attributes(impl_->file.get());
      version = version_of(impl_->file.get());
    });
  });
  together(comm, [&] { require_version(version, path); });
  damage([&] { impl_->verify_all(); });
}
CheckpointReader::CheckpointReader(CheckpointReader&&) noexcept = default;
CheckpointReader::~CheckpointReader() = default;

const fs::path& CheckpointReader::path() const { return impl_->path; }

bool CheckpointReader::has(const std::string& name) const {
  try {
    impl_->dataset(name);
    return true;
  } catch (const InputError&) { return false; }
}

std::int64_t CheckpointReader::size(const std::string& name) const { return size_of_dataset(impl_->dataset(name)); }

template <class T>
void CheckpointReader::read(const std::string& name, std::span<const Slice<T>> slices) const {
  const hdf5::Dataset data = impl_->dataset(name);
  impl_->check_type<T>(data, name);
  const std::int64_t total = size_of_dataset(data);
  for (const auto& slice : slices) {
    const auto count = static_cast<std::int64_t>(slice.values.size());
    if (slice.offset < 0 || slice.offset + count > total)
      throw InputError(impl_->path.string() + ": array " + name + " has " + std::to_string(total) +
                       " values, this run asks for " + std::to_string(slice.offset + count) +
                       "; restart with the scene of the first run");
    hdf5::read(data.get(), type_of<T>(), slice.offset, count, slice.values.data(), impl_->path.string());
  }
}

template <class T>
std::vector<T> CheckpointReader::read(const std::string& name) const {
  std::vector<T> values(static_cast<std::size_t>(size(name)));
  const Slice<T> all{0, values};
  read<T>(name, std::span<const Slice<T>>(&all, 1));
  return values;
}

double CheckpointReader::number(const std::string& name) const {
  double value = 0;
  hdf5::get_attribute(impl_->file.get(), name.c_str(), H5T_NATIVE_DOUBLE, &value);
  return value;
}
std::int64_t CheckpointReader::integer(const std::string& name) const {
  std::int64_t value = 0;
  hdf5::get_attribute(impl_->file.get(), name.c_str(), H5T_NATIVE_INT64, &value);
  return value;
}
std::string CheckpointReader::text(const std::string& name) const {
  return hdf5::get_text_attribute(impl_->file.get(), name.c_str());
}

#define SPINDRIFT_CHECKPOINT_TYPE(T)                                                                           \
  template void CheckpointWriter::write<T>(const std::string&, std::int64_t, std::span<const Slice<const T>>); \
  template void CheckpointWriter::write<T>(const std::string&, std::span<const T>);                            \
  template void CheckpointReader::read<T>(const std::string&, std::span<const Slice<T>>) const;                \
  template std::vector<T> CheckpointReader::read<T>(const std::string&) const;
SPINDRIFT_CHECKPOINT_TYPE(double)
SPINDRIFT_CHECKPOINT_TYPE(std::int64_t)
SPINDRIFT_CHECKPOINT_TYPE(std::byte)
#undef SPINDRIFT_CHECKPOINT_TYPE

}  // namespace spindrift::io
