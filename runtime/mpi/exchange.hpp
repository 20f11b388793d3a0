// Bytes of any size from every rank to every rank at once: for rare, irregular traffic (migration, structure of halos), inside a
// collective task or between runs. Regular traffic goes through Graph::send and receive.
// Used by src/sea/sph; tested in tests/runtime/exchange_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mpi.h>

#include <cstddef>
#include <cstring>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <vector>

namespace spindrift::runtime {

using Bytes = std::vector<std::byte>;

/// Gives parcel r to rank r; returns what came from each rank. Collective. Parcels of ranks that get nothing are empty.
std::vector<Bytes> exchange(MPI_Comm comm, const std::vector<Bytes>& to);
/// Gives the same parcel to all ranks; returns those of all ranks, in the order of ranks.
std::vector<Bytes> exchange_all(MPI_Comm comm, const Bytes& mine);

int rank_in(MPI_Comm comm);
int ranks_in(MPI_Comm comm);

/// Puts values and arrays one after the other into a parcel.
class Packer {
 public:
  template <class T>
  void put(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    put_one(values.size());
    const auto bytes = std::as_bytes(values);
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }
  template <class T>
  void put_one(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto bytes = std::as_bytes(std::span(&value, 1));
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }
  bool empty() const { return bytes_.empty(); }
  Bytes take() { return std::move(bytes_); }

 private:
  Bytes bytes_;
};

/// Takes them out again, in the same order.
class Unpacker {
 public:
  explicit Unpacker(std::span<const std::byte> bytes) : left_(bytes) {}
  bool done() const { return left_.empty(); }
  template <class T>
  T one() {
    T value;
    std::memcpy(&value, next(sizeof(T)).data(), sizeof(T));
    return value;
  }
  template <class T>
  std::vector<T> many() {
    std::vector<T> values(one<std::size_t>());
    const auto from = next(values.size() * sizeof(T));
    if (!values.empty()) std::memcpy(values.data(), from.data(), from.size());
    return values;
  }

 private:
  std::span<const std::byte> next(std::size_t count) {
    if (count > left_.size()) throw std::logic_error("exchange: a parcel ends early");
    const auto first = left_.first(count);
    left_ = left_.subspan(count);
    return first;
  }
  std::span<const std::byte> left_;
};

}  // namespace spindrift::runtime
