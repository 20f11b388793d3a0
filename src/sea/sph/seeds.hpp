// The particles a sea starts with, in the order of their identities. A stream makes them anew at each visit, so that no rank has
// to hold those of all others, and in parts, so that a rank need not visit what cannot be its own. Called by tank.cpp,
// sea_sph.cpp, ordering.cpp and boundary.hpp; tested in tests/src/sea/sph/tank_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace spindrift::sph {

/// One particle as scenes make them, before they are in a store.
template <int dim>
struct Seed {
  std::array<double, dim> position, velocity{};
  double deviation = 0.0;   ///< rho - rho0 [kg/m3]
  std::uint16_t owner = 0;  ///< 0 water, 1 + n the solid n
  /// Of a particle of a modified boundary: from it to its ghost node, its mirror image in the water; zero for a dynamic one [m].
  std::array<double, dim> ghost{};
};

/// Seeds with the identities [first, last), none outside the box in x and y.
template <int dim>
struct SeedPart {
  std::size_t first = 0, last = 0;
  std::array<double, dim> low = filled(-std::numeric_limits<double>::infinity()),
                          high = filled(std::numeric_limits<double>::infinity());
  std::uint16_t largest_owner = 0;
  bool has_ghosts = false;

  static std::array<double, dim> filled(double x) {
    std::array<double, dim> all;
    all.fill(x);
    return all;
  }
};

template <int dim>
class SeedStream {
 public:
  using Visit = std::function<void(std::size_t id, const Seed<dim>&)>;
  using Source = std::function<void(std::size_t part, const Visit&)>;

  SeedStream() = default;
  /// `source` visits the seeds of a part in the order of their identities, the same at every call; parts follow each other.
  SeedStream(std::vector<SeedPart<dim>> parts, Source source) : parts_(std::move(parts)), source_(std::move(source)) {}
  /// Of seeds that lie in memory, which must outlive the stream: one part.
  SeedStream(std::span<const Seed<dim>> seeds)  // NOLINT: a span is a stream
      : SeedStream({part_of(seeds)}, [seeds](std::size_t, const Visit& visit) {
          for (std::size_t id = 0; id < seeds.size(); ++id) visit(id, seeds[id]);
        }) {}
  SeedStream(const std::vector<Seed<dim>>& seeds) : SeedStream(std::span<const Seed<dim>>(seeds)) {}  // NOLINT: likewise

  std::size_t size() const { return parts_.empty() ? 0 : parts_.back().last; }
  /// With that of the water.
  int owners() const {
    int largest = 0;
    for (const SeedPart<dim>& part : parts_) largest = std::max<int>(largest, part.largest_owner);
    return largest + 1;
  }
  void for_each(const Visit& visit) const {
    for_each(visit, [](const SeedPart<dim>&) { return true; });
  }
  /// Those of the parts for which `wanted` is true.
  template <class Wanted>
  void for_each(const Visit& visit, Wanted&& wanted) const {
    for (std::size_t n = 0; n < parts_.size(); ++n)
      if (parts_[n].last > parts_[n].first && wanted(parts_[n])) source_(n, visit);
  }
  /// Dealt out to ranks: each part is one rank's.
  void for_each_of_rank(int rank, int ranks, const Visit& visit) const {
    for_each(visit, [&](const SeedPart<dim>& part) { return part.first * std::size_t(ranks) / size() == std::size_t(rank); });
  }
  /// All of them in memory: for small seas.
  std::vector<Seed<dim>> all() const {
    std::vector<Seed<dim>> seeds;
    seeds.reserve(size());
    for_each([&](std::size_t, const Seed<dim>& seed) { seeds.push_back(seed); });
    return seeds;
  }

 private:
  static SeedPart<dim> part_of(std::span<const Seed<dim>> seeds) {
    SeedPart<dim> part{.last = seeds.size()};
    for (const Seed<dim>& seed : seeds) {
      part.largest_owner = std::max(part.largest_owner, seed.owner);
      part.has_ghosts = part.has_ghosts || seed.ghost != std::array<double, dim>{};
    }
    return part;
  }
  std::vector<SeedPart<dim>> parts_;
  Source source_;
};

}  // namespace spindrift::sph
