// Checkpoints: one HDF5 file of named arrays (double, 64-bit integer, byte) and values, whole or not there, verified before it is
// trusted. The arrays are global: their layout in the file knows no ranks, so that a run goes on with any number of them. Written
// by the coupling at window ends, read by it at a restart. Tested in tests/src/io/checkpoint_test.cpp and
// checkpoint_faults_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mpi.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "src/io/machine_failure.hpp"

namespace spindrift::io {

/// This rank's values of a global array from index `offset` on.
template <class T>
struct Slice {
  std::int64_t offset;
  std::span<T> values;
};

/// All members are collective: every rank calls them in the same order with the same names. They throw on all ranks alike.
class CheckpointWriter {
 public:
  /// Writes beside `path`; nothing is there until commit().
  CheckpointWriter(MPI_Comm comm, std::filesystem::path path);
  ~CheckpointWriter();
  CheckpointWriter(const CheckpointWriter&) = delete;
  CheckpointWriter& operator=(const CheckpointWriter&) = delete;

  /// An array of `total` values of which each rank gives its slices (blocks, say); together they are the whole, each value once.
  /// T: double, std::int64_t or std::byte. A name may be a path: "sea/position".
  template <class T>
  void write(const std::string& name, std::int64_t total, std::span<const Slice<const T>> slices);
  /// An array that is the same on every rank; rank 0's is written.
  template <class T>
  void write(const std::string& name, std::span<const T> values);

  void set(const std::string& name, double value);
  void set(const std::string& name, std::int64_t value);
  void set(const std::string& name, const std::string& value);

  /// To disk, then renamed to its place.
  void commit();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// What is to stand in a checkpoint, copied, so that it may be written while the state goes on. Filled as a CheckpointWriter is,
/// without a message between ranks.
class CheckpointCopy {
 public:
  template <class Value>
  void set(const std::string& name, const Value& value) {
    add([name, value](CheckpointWriter& file) { file.set(name, value); });
  }
  /// An array that is the same on every rank.
  template <class T>
  void write(const std::string& name, std::span<const T> values) {
    add([name, copy = std::vector<T>(values.begin(), values.end())](CheckpointWriter& file) {
      file.write(name, std::span<const T>(copy));
    });
  }
  /// A part of it: holds what it writes.
  void add(std::function<void(CheckpointWriter&)> part) { parts_.push_back(std::move(part)); }
  /// Collective.
  void write_to(CheckpointWriter& file) const {
    for (const auto& part : parts_) part(file);
  }

 private:
  std::vector<std::function<void(CheckpointWriter&)>> parts_;
};

/// A file that is no whole checkpoint: truncated, changed, or something else. Other failures to read one say nothing of the file.
class DamagedFile : public MachineFailure {
 public:
  using MachineFailure::MachineFailure;
};

/// A checkpoint whose every checksum was right when it was opened. What the file has not is an InputError (another scene wrote
/// it).
class CheckpointReader {
 public:
  /// Collective; reads all of it once. Throws DamagedFile where it is truncated, damaged or incomplete, InputError where this
  /// process may not read it or another version of the program wrote it.
  CheckpointReader(MPI_Comm comm, const std::filesystem::path& path);
  CheckpointReader(CheckpointReader&&) noexcept;
  ~CheckpointReader();

  const std::filesystem::path& path() const;
  bool has(const std::string& name) const;
  std::int64_t size(const std::string& name) const;

  /// This rank's slices, any part of the array. Not collective.
  template <class T>
  void read(const std::string& name, std::span<const Slice<T>> slices) const;
  /// The whole array, on the calling rank.
  template <class T>
  std::vector<T> read(const std::string& name) const;

  double number(const std::string& name) const;
  std::int64_t integer(const std::string& name) const;
  std::string text(const std::string& name) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// What --restart is refused with where no checkpoint of a run's folder of them verifies.
InputError only_damaged(const std::filesystem::path& folder);

/// The checkpoints of a run: a folder of files named by tick, of which the last few are kept.
class CheckpointSeries {
 public:
  /// `identity`: what the run is made of, kept in each checkpoint; empty: none.
  CheckpointSeries(MPI_Comm comm, std::filesystem::path folder, int keep, std::string identity = {});

  /// Collective. Has `fill` write a checkpoint of this tick of simulated time, commits it, then removes those beyond `keep`.
  void save(std::int64_t tick, const std::function<void(CheckpointWriter&)>& fill);

  /// Collective. The newest that verifies; damaged ones are renamed to *.damaged with a warning (or, in the folder of another
  /// run, left alone). Empty where none is left.
  enum class Damaged { set_aside, leave };
  std::optional<CheckpointReader> newest(Damaged damaged = Damaged::set_aside);

  /// Collective. The identity of the newest checkpoint that has a whole one, without verifying the rest; empty where none has.
  std::string newest_identity() const;

  std::filesystem::path path(std::int64_t tick) const;
  const std::filesystem::path& folder() const { return folder_; }

 private:
  MPI_Comm comm_;
  std::filesystem::path folder_;
  int keep_;
  std::string identity_;
};

}  // namespace spindrift::io
