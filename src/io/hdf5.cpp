// SPDX-License-Identifier: Apache-2.0
#include "src/io/hdf5.hpp"

#include <algorithm>

#include "src/io/collective.hpp"
#include "src/io/machine_failure.hpp"

namespace spindrift::io::hdf5 {

namespace {

/// Elements moved by one call: below the 2^31 bytes that MPI implementations count in.
constexpr std::int64_t elements_per_call = 1 << 26;

/// The library prints its error stack unless told not to; ours goes into exceptions.
void be_silent() {
  static const bool done = [] { return H5open() >= 0 && H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr) >= 0; }();
  (void)done;
}

herr_t keep_innermost(unsigned position, const H5E_error2_t* error, void* text) {
  if (position == 0 && error->desc != nullptr) *static_cast<std::string*>(text) = error->desc;
  return 0;
}

Properties access(MPI_Comm comm) {
  be_silent();
  Properties properties(checked(H5Pcreate(H5P_FILE_ACCESS), "HDF5 file access"));
  checked(H5Pset_libver_bounds(properties.get(), H5F_LIBVER_V110, H5F_LIBVER_V110), "HDF5 file format");
  if (size_of(comm) > 1) checked(H5Pset_fapl_mpio(properties.get(), comm, MPI_INFO_NULL), "HDF5 over MPI");
  return properties;
}

Properties transfer(MPI_Comm comm) {
  Properties properties(checked(H5Pcreate(H5P_DATASET_XFER), "HDF5 transfer"));
  if (size_of(comm) > 1) checked(H5Pset_dxpl_mpio(properties.get(), H5FD_MPIO_COLLECTIVE), "HDF5 collective transfer");
  return properties;
}

std::vector<Piece> in_calls(std::span<const Piece> pieces, std::int64_t limit, std::size_t element_bytes) {
  std::vector<Piece> calls;
  for (const Piece& piece : pieces)
    for (std::int64_t done = 0; done < piece.count; done += limit)
      calls.push_back({piece.offset + done, std::min(limit, piece.count - done),
                       static_cast<char*>(piece.data) + static_cast<std::size_t>(done) * element_bytes});
  return calls;
}

/// Selects the piece in a row-major dataset of any rank; pieces of more than one dimension start and end on its first index.
void select(hid_t space, const Piece& piece) {
  hsize_t extents[H5S_MAX_RANK], start[H5S_MAX_RANK] = {}, count[H5S_MAX_RANK];
  const int rank = H5Sget_simple_extent_dims(space, extents, nullptr);
  hsize_t inner = 1;
  for (int d = 1; d < rank; ++d) inner *= count[d] = extents[d];
  start[0] = static_cast<hsize_t>(piece.offset) / inner;
  count[0] = static_cast<hsize_t>(piece.count) / inner;
  checked(H5Sselect_hyperslab(space, H5S_SELECT_SET, start, nullptr, count, nullptr), "HDF5 selection");
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

File create(MPI_Comm comm, const std::filesystem::path& path) {
  const Properties properties = access(comm);
  return File(checked(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, properties.get()), "cannot create " + path.string()));
}

File open(MPI_Comm comm, const std::filesystem::path& path) {
  const Properties properties = access(comm);
  return File(checked(H5Fopen(path.c_str(), H5F_ACC_RDONLY, properties.get()), "cannot open " + path.string()));
}

void finish(File file, const std::filesystem::path& path) {
  const herr_t flushed = H5Fflush(file.get(), H5F_SCOPE_GLOBAL);
  const std::string reason = flushed < 0 ? last_error() : "";
  const herr_t closed = H5Fclose(file.release());
  if (flushed < 0) throw MachineFailure("cannot write " + path.string() + ": " + reason);
  checked(closed, "cannot close " + path.string());
}

void write_pieces(MPI_Comm comm, hid_t dataset, hid_t memory_type, std::span<const Piece> pieces, const std::string& what) {
  const Space shape(H5Dget_space(dataset));
  hsize_t extents[H5S_MAX_RANK];
  const int rank = H5Sget_simple_extent_dims(shape.get(), extents, nullptr);
  std::int64_t inner = 1;
  for (int d = 1; d < rank; ++d) inner *= static_cast<std::int64_t>(extents[d]);
  if (H5Sget_simple_extent_npoints(shape.get()) == 0) return;  // HDF5 refuses collective transfers of nothing at all

  const auto calls = in_calls(pieces, std::max<std::int64_t>(elements_per_call / inner, 1) * inner, H5Tget_size(memory_type));
  int rounds = static_cast<int>(calls.size());
  MPI_Allreduce(MPI_IN_PLACE, &rounds, 1, MPI_INT, MPI_MAX, comm);
  const Properties how = transfer(comm);
  std::string failure;
  for (int round = 0; round < rounds; ++round) {
    const bool mine = round < static_cast<int>(calls.size());
    const Piece piece = mine ? calls[static_cast<std::size_t>(round)] : Piece{0, 0, nullptr};
    const Space file_space(H5Scopy(shape.get()));
    const auto count = static_cast<hsize_t>(std::max<std::int64_t>(piece.count, 1));
    const Space memory_space(H5Screate_simple(1, &count, nullptr));
    if (mine) {
      select(file_space.get(), piece);
    } else {
      H5Sselect_none(file_space.get());
      H5Sselect_none(memory_space.get());
    }
    // Every rank makes every call, whatever failed before: the call is collective.
    const herr_t written = H5Dwrite(dataset, memory_type, memory_space.get(), file_space.get(), how.get(), piece.data);
    if (written < 0 && failure.empty()) failure = last_error();
  }
  if (!failure.empty()) throw MachineFailure("cannot write " + what + ": " + failure);
}

void read_piece(hid_t dataset, hid_t memory_type, const Piece& piece, const std::string& what) {
  for (const Piece& call : in_calls({&piece, 1}, elements_per_call, H5Tget_size(memory_type))) {
    const Space file_space(H5Dget_space(dataset));
    const auto count = static_cast<hsize_t>(call.count);
    const Space memory_space(H5Screate_simple(1, &count, nullptr));
    select(file_space.get(), call);
    checked(H5Dread(dataset, memory_type, memory_space.get(), file_space.get(), H5P_DEFAULT, call.data), "cannot read " + what);
  }
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

}  // namespace spindrift::io::hdf5
