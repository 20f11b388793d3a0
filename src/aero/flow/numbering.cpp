// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/numbering.hpp"

#include <algorithm>

namespace spindrift::aero {

int Numbering::rank_of(int number) const {
  return int(std::upper_bound(first_of_rank.begin(), first_of_rank.end(), number) - first_of_rank.begin()) - 1;
}

Numbering number_points(const GridStore& grid, const std::function<int(const Tile&)>& points) {
  const Tiling& tiling = grid.tiling();
  const std::span<const int> ranks = grid.rank_of_tile();
  int highest = grid.rank();
  for (const int r : ranks) highest = std::max(highest, r);
  std::vector<int> counts(std::size_t(highest) + 1);
  for (std::size_t t = 0; t < ranks.size(); ++t) counts[std::size_t(ranks[t])] += points(tiling.tiles[t]);
  Numbering n;
  n.first_of_rank.push_back(0);
  for (const int count : counts) n.first_of_rank.push_back(n.first_of_rank.back() + count);
  n.begin = n.first_of_rank[std::size_t(grid.rank())], n.end = n.first_of_rank[std::size_t(grid.rank()) + 1];
  std::vector<int> next(n.first_of_rank.begin(), n.first_of_rank.end() - 1);
  for (std::size_t t = 0; t < ranks.size(); ++t) {
    int& at = next[std::size_t(ranks[t])];
    n.first.push_back(at);
    at += points(tiling.tiles[t]);
  }
  return n;
}

int OutsideValues::want(int number) {
  wanted_.emplace_back(number, count_);
  return count_++;
}

void OutsideValues::fetch(const Numbering& numbering, std::span<const double> mine, int width, std::vector<double>& values,
                          MPI_Comm comm) {
  const int ranks = runtime::ranks_in(comm);
  if (ranks == 1) return;
  if (!agreed_) {
    agreed_ = true;
    std::ranges::sort(wanted_);
    taken_.resize(std::size_t(ranks)), given_.resize(std::size_t(ranks));
    std::vector<std::vector<int>> asked(static_cast<std::size_t>(ranks));
    for (const auto& [number, position] : wanted_) {
      const auto rank = std::size_t(numbering.rank_of(number));
      asked[rank].push_back(number), taken_[rank].push_back(position);
    }
    std::vector<runtime::Bytes> to;
    for (const auto& numbers : asked) {
      runtime::Packer p;
      p.put(std::span<const int>(numbers));
      to.push_back(p.take());
    }
    const auto from = runtime::exchange(comm, to);
    for (std::size_t r = 0; r < from.size(); ++r) {
      given_[r] = runtime::Unpacker(from[r]).many<int>();
      for (int& number : given_[r]) number -= numbering.begin;
    }
  }
  std::vector<runtime::Bytes> to(std::size_t(ranks), runtime::Bytes{});
  for (std::size_t r = 0; r < to.size(); ++r) {
    if (given_[r].empty()) continue;
    std::vector<double> out;
    for (const int offset : given_[r])
      out.insert(out.end(), mine.begin() + std::ptrdiff_t(offset) * width, mine.begin() + std::ptrdiff_t(offset + 1) * width);
    runtime::Packer p;
    p.put(std::span<const double>(out));
    to[r] = p.take();
  }
  const auto from = runtime::exchange(comm, to);
  values.resize(std::size_t(count_) * std::size_t(width));
  for (std::size_t r = 0; r < from.size(); ++r) {
    if (taken_[r].empty()) continue;
    const std::vector<double> in = runtime::Unpacker(from[r]).many<double>();
    for (std::size_t n = 0; n < taken_[r].size(); ++n)
      std::copy_n(in.begin() + std::ptrdiff_t(n) * width, width, values.begin() + std::ptrdiff_t(taken_[r][n]) * width);
  }
}

}  // namespace spindrift::aero
