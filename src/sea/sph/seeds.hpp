// The particles a sea starts with, in the order of their identities. A stream makes them anew at each visit, so that no rank has
// to hold those of all others: it visits all and keeps its own. Called by tank.cpp, sea_sph.cpp, ordering.cpp and boundary.hpp;
// tested in tests/src/sea/sph/tank_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
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

template <int dim>
class SeedStream {
 public:
  using Visit = std::function<void(std::size_t id, const Seed<dim>&)>;
  using Source = std::function<void(const Visit&)>;

  SeedStream() = default;
  /// `source` visits `size` seeds with the identities 0, 1, 2 ..., the same at every call.
  SeedStream(std::size_t size, Source source) : size_(size), source_(std::move(source)) {}
  /// Of seeds that lie in memory, which must outlive the stream.
  SeedStream(std::span<const Seed<dim>> seeds)  // NOLINT: a span is a stream
      : SeedStream(seeds.size(), [seeds](const Visit& visit) {
          for (std::size_t id = 0; id < seeds.size(); ++id) visit(id, seeds[id]);
        }) {}
  SeedStream(const std::vector<Seed<dim>>& seeds) : SeedStream(std::span<const Seed<dim>>(seeds)) {}  // NOLINT: likewise

  std::size_t size() const { return size_; }
  void for_each(const Visit& visit) const {
    if (size_ > 0) source_(visit);
  }
  /// All of them in memory: for small seas.
  std::vector<Seed<dim>> all() const {
    std::vector<Seed<dim>> seeds;
    seeds.reserve(size_);
    for_each([&](std::size_t, const Seed<dim>& seed) { seeds.push_back(seed); });
    return seeds;
  }

 private:
  std::size_t size_ = 0;
  Source source_;
};

}  // namespace spindrift::sph
