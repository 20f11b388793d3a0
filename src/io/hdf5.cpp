// SPDX-License-Identifier: Apache-2.0
#include "src/io/hdf5.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "src/io/machine_failure.hpp"

namespace spindrift::io::hdf5 {

namespace {

/// The library prints its error stack unless told not to; ours goes into exceptions.
void be_silent() {
  static const bool done = [] { return H5open() >= 0 && H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr) >= 0; }();
  (void)done;
}

herr_t keep_innermost(unsigned position, const H5E_error2_t* error, void* text) {
  if (position == 0 && error->desc != nullptr) *static_cast<std::string*>(text) = error->desc;
  return 0;
}

Properties access() {
  be_silent();
  Properties properties(checked(H5Pcreate(H5P_FILE_ACCESS), "HDF5 file access"));
  checked(H5Pset_libver_bounds(properties.get(), H5F_LIBVER_V110, H5F_LIBVER_V110), "HDF5 file format");
  return properties;
}

}  // namespace

std::string last_error() {
  std::string text;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_innermost, &text);
  H5Eclear2(H5E_DEFAULT);
  return text.empty() ? "HDF5 gives no reason" : text;
}

hid_t checked(hid_t result, const std::string& what) {
  if (result < 0) throw MachineFailure(what + ": " + last_error());
  return result;
}

File create(const std::filesystem::path& path) {
  const Properties properties = access();
  return File(checked(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, properties.get()), "cannot create " + path.string()));
}

File open(const std::filesystem::path& path) {
  const Properties properties = access();
  H5Pset_file_locking(properties.get(), false, true);  // who looks at the file meanwhile does not make it unreadable
  return File(checked(H5Fopen(path.c_str(), H5F_ACC_RDONLY, properties.get()), "cannot open " + path.string()));
}

void finish(File file, const std::filesystem::path& path) {
  if (H5Fflush(file.get(), H5F_SCOPE_GLOBAL) < 0) {
    const std::string reason = last_error();
    abandon(std::move(file));
    throw MachineFailure("cannot write " + path.string() + ": " + reason);
  }
  checked(H5Fclose(file.release()), "cannot close " + path.string());
}

void abandon(File file) noexcept {
  if (file.get() < 0) return;
  void* descriptor = nullptr;
  if (H5Fget_vfd_handle(file.get(), H5P_DEFAULT, &descriptor) >= 0) {
    const int memory = ::memfd_create("spindrift", MFD_CLOEXEC);
    if (memory >= 0) {
      ::dup2(memory, *static_cast<int*>(descriptor));
      ::close(memory);
    }
  }
  H5Fclose(file.release());
  H5Eclear2(H5E_DEFAULT);
}

void read(hid_t dataset, hid_t memory_type, std::int64_t offset, std::int64_t count, void* values, const std::string& what) {
  if (count == 0) return;
  const Space file_space(H5Dget_space(dataset));
  const auto start = static_cast<hsize_t>(offset), length = static_cast<hsize_t>(count);
  const Space memory_space(H5Screate_simple(1, &length, nullptr));
  checked(H5Sselect_hyperslab(file_space.get(), H5S_SELECT_SET, &start, nullptr, &length, nullptr), "cannot read " + what);
  checked(H5Dread(dataset, memory_type, memory_space.get(), file_space.get(), H5P_DEFAULT, values), "cannot read " + what);
}

void set_attribute(hid_t object, const char* name, hid_t type, const void* value) {
  const Space scalar(H5Screate(H5S_SCALAR));
  const Attribute attribute(checked(H5Acreate2(object, name, type, scalar.get(), H5P_DEFAULT, H5P_DEFAULT), name));
  checked(H5Awrite(attribute.get(), type, value), name);
}

void set_attribute(hid_t object, const char* name, const std::string& text) {
  const Type type(H5Tcopy(H5T_C_S1));
  H5Tset_size(type.get(), text.size() + 1);
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  set_attribute(object, name, type.get(), text.c_str());
}

void get_attribute(hid_t object, const char* name, hid_t type, void* value) {
  const Attribute attribute(checked(H5Aopen(object, name, H5P_DEFAULT), std::string("attribute ") + name));
  checked(H5Aread(attribute.get(), type, value), std::string("attribute ") + name);
}

std::string get_text_attribute(hid_t object, const char* name) {
  const Attribute attribute(checked(H5Aopen(object, name, H5P_DEFAULT), std::string("attribute ") + name));
  const Type type(checked(H5Aget_type(attribute.get()), name));
  std::string text(H5Tget_size(type.get()), '\0');
  checked(H5Aread(attribute.get(), type.get(), text.data()), std::string("attribute ") + name);
  text.resize(std::min(text.find('\0'), text.size()));
  return text;
}

void read_attributes(hid_t object) {
  H5O_info_t info;
  checked(H5Oget_info2(object, &info, H5O_INFO_NUM_ATTRS), "attributes");
  std::vector<std::byte> value;
  for (hsize_t n = 0; n < info.num_attrs; ++n) {
    const Attribute attribute(
        checked(H5Aopen_by_idx(object, ".", H5_INDEX_NAME, H5_ITER_NATIVE, n, H5P_DEFAULT, H5P_DEFAULT), "an attribute"));
    const Type type(checked(H5Aget_type(attribute.get()), "type of an attribute"));
    value.resize(std::max<std::size_t>(H5Aget_storage_size(attribute.get()), H5Tget_size(type.get())));
    checked(H5Aread(attribute.get(), type.get(), value.data()), "an attribute");
  }
}

}  // namespace spindrift::io::hdf5
