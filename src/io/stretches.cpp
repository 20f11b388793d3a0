// SPDX-License-Identifier: Apache-2.0
#include "src/io/stretches.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "src/io/collective.hpp"

namespace spindrift::io {

namespace {

/// Of so many bytes, freed by its owner.
struct ElementType {
  MPI_Datatype type{};
  explicit ElementType(std::size_t bytes) {
    MPI_Type_contiguous(static_cast<int>(bytes), MPI_BYTE, &type);
    MPI_Type_commit(&type);
  }
  ElementType(const ElementType&) = delete;
  ElementType& operator=(const ElementType&) = delete;
  ~ElementType() { MPI_Type_free(&type); }
};

/// Room for so many values in a buffer that never shrinks.
template <class Stored>
std::span<Stored> room_in(std::vector<std::byte>& buffer, std::int64_t count) {
  const auto values = static_cast<std::size_t>(count);
  if (buffer.size() < values * sizeof(Stored)) buffer.resize(values * sizeof(Stored));
  return {reinterpret_cast<Stored*>(buffer.data()), values};
}

}  // namespace

std::int64_t Stretches::Shares::find_places() {
  std::int64_t sum = 0;
  at.clear();
  for (const int n : count) at.push_back(static_cast<int>(sum)), sum += n;
  return sum;
}

template <class Visit>
void Stretches::for_pieces(const Box& box, Visit&& visit) const {
  const Index& n = extents_[static_cast<std::size_t>(box.array)];
  for (std::int64_t k = box.low[2]; k < box.high[2]; ++k)
    for (std::int64_t j = box.low[1]; j < box.high[1]; ++j)
      for (std::int64_t i = box.low[0]; i < box.high[0];) {
        const std::int64_t at = first_[static_cast<std::size_t>(box.array)] + (k * n[1] + j) * n[0] + i;
        const int rank = static_cast<int>(at / share_);
        const std::int64_t count = std::min(box.high[0] - i, begin(rank + 1) - at);
        visit(rank, i, j, k, at, count);
        i += count;
      }
}

void Stretches::check(std::span<const Box> boxes) const {
  for (const Box& b : boxes)
    for (std::size_t d = 0; d < 3; ++d)
      if (b.low[d] < 0 || b.high[d] > extents_.at(static_cast<std::size_t>(b.array))[d])
        throw std::logic_error(fmt::format("a box has elements {} to {} along {} of an array with {}", b.low[d], b.high[d],
                                           "ijk"[d], extents_[static_cast<std::size_t>(b.array)][d]));
}

Stretches::Stretches(MPI_Comm comm, std::vector<Index> extents, std::vector<Box> mine)
    : comm_(comm), extents_(std::move(extents)), first_{0}, mine_(std::move(mine)) {
  const auto size = static_cast<std::size_t>(size_of(comm_));
  const int me = rank_of(comm_);
  for (const Index& n : extents_) first_.push_back(first_.back() + n[0] * n[1] * n[2]);
  share_ = std::max(shortest, (first_.back() + size_of(comm_) - 1) / size_of(comm_));

  std::vector<Box> boxes;
  Shares given, taken;   // boxes
  std::int64_t own = 0;  // elements that stay here
  together(comm_, [&] {
    check(mine_);
    std::vector<std::vector<Box>> for_rank(size);
    sent_.count.assign(size, 0);
    for (const Box& box : mine_) {
      int before = -1;
      for_pieces(box, [&](int rank, auto, auto, auto, auto, std::int64_t count) {
        if (rank == me) {
          own += count;
          return;
        }
        if (rank != before) for_rank[static_cast<std::size_t>(rank)].push_back(box);
        before = rank;
        sent_.count[static_cast<std::size_t>(rank)] += static_cast<int>(count);
      });
    }
    for (const auto& list : for_rank) {
      given.count.push_back(static_cast<int>(list.size()));
      boxes.insert(boxes.end(), list.begin(), list.end());
    }
    sent_.find_places(), given.find_places();
    taken.count.resize(size);
  });
  MPI_Alltoall(given.count.data(), 1, MPI_INT, taken.count.data(), 1, MPI_INT, comm_);
  together(comm_, [&] { taken_.resize(static_cast<std::size_t>(taken.find_places())); });
  const ElementType type(sizeof(Box));
  MPI_Alltoallv(boxes.data(), given.count.data(), given.at.data(), type.type, taken_.data(), taken.count.data(), taken.at.data(),
                type.type, comm_);
  together(comm_, [&] {
    received_.count.assign(size, 0);
    for (std::size_t rank = 0, n = 0; rank < size; ++rank)
      for (const std::size_t last = n + static_cast<std::size_t>(taken.count[rank]); n < last; ++n)
        for_pieces(taken_[n], [&](int owner, auto, auto, auto, auto, std::int64_t count) {
          if (owner == me) received_.count[rank] += static_cast<int>(count);
        });
    const std::int64_t covered = own + received_.find_places(), expected = begin(me + 1) - begin(me);
    if (covered != expected) throw std::logic_error(fmt::format("boxes give {} elements of a stretch of {}", covered, expected));
  });
}

template <class Stored>
void Stretches::write(hdf5::SharedFile& file, std::span<const std::int64_t> places, int components,
                      std::span<const Source> sources) {
  const int me = rank_of(comm_);
  const std::int64_t low = begin(me), high = begin(me + 1), width = components;
  std::span<Stored> out, in, stretch;
  together(comm_, [&] {
    out = room_in<Stored>(out_, (sent_.at.back() + sent_.count.back()) * width);
    in = room_in<Stored>(in_, (received_.at.back() + received_.count.back()) * width);
    stretch = room_in<Stored>(stretch_, (high - low) * width);
    std::vector<std::int64_t> next(sent_.at.begin(), sent_.at.end());
    for (std::size_t n = 0; n < mine_.size(); ++n) {
      const Index& first = mine_[n].low;
      const Source& s = sources[n];
      for_pieces(mine_[n], [&](int rank, auto i, auto j, auto k, std::int64_t at, std::int64_t count) {
        const std::int64_t from = (k - first[2]) * s.plane + (j - first[1]) * s.row + (i - first[0]);
        std::int64_t& to = next[static_cast<std::size_t>(rank)];
        const auto place = rank == me ? stretch.begin() + (at - low) * width : out.begin() + to * width;
        std::copy_n(s.values.begin() + from * width, count * width, place);
        if (rank != me) to += count;
      });
    }
  });
  const ElementType type(static_cast<std::size_t>(components) * sizeof(Stored));
  MPI_Alltoallv(out.data(), sent_.count.data(), sent_.at.data(), type.type, in.data(), received_.count.data(),
                received_.at.data(), type.type, comm_);
  together(comm_, [&] {
    auto from = in.begin();
    for (const Box& box : taken_)
      for_pieces(box, [&](int rank, auto, auto, auto, std::int64_t at, std::int64_t count) {
        if (rank != me) return;
        std::copy_n(from, count * width, stretch.begin() + (at - low) * width);
        from += count * width;
      });
    for (std::size_t a = 0; a < extents_.size(); ++a) {
      const std::int64_t begins = std::max(low, first_[a]), ends = std::min(high, first_[a + 1]);
      if (begins >= ends) continue;
      const auto part =
          stretch.subspan(static_cast<std::size_t>((begins - low) * width), static_cast<std::size_t>((ends - begins) * width));
      file.write(places[a] + (begins - first_[a]) * width * static_cast<std::int64_t>(sizeof(Stored)), std::as_bytes(part));
    }
  });
}

template void Stretches::write<float>(hdf5::SharedFile&, std::span<const std::int64_t>, int, std::span<const Source>);
template void Stretches::write<double>(hdf5::SharedFile&, std::span<const std::int64_t>, int, std::span<const Source>);

}  // namespace spindrift::io
