// The elliptic problem on tiles: second order on curvilinear blocks, exact distance between plates, refusals, the same bits on
// any threads and in reruns, the same solution on two ranks. SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/poisson.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "kernels/base/constants.hpp"
#include "src/aero/grid/generators/box.hpp"

using namespace spindrift;
using namespace spindrift::aero;

namespace {

GridStore store_of(const MultiBlockGrid& grid, int ranks = 1, int rank = 0, const std::vector<std::string>& walls = {},
                   int across = 8) {
  Tiling tiling = make_tiling(
      grid, walls, {.across_j = across, .across_k = across, .planar_across = across, .normal = 16, .planar_normal = 16});
  std::vector<int> rank_of_tile(std::size_t(tiling.size()), 0);
  for (std::size_t t = 0; t < rank_of_tile.size(); ++t) rank_of_tile[t] = int(t) * ranks / int(rank_of_tile.size());
  GridStore store(std::move(tiling), std::move(rank_of_tile), rank);
  store.build_all(grid);
  return store;
}

/// sin sin cos: no flux through the sides across z, given on the others.
double exact(const Eigen::Vector3d& x) {
  return std::sin(pi * x[0] + 0.3) * std::sin(2.0 * pi * x[1] + 0.2) * std::cos(pi * x[2]);
}

template <class Body>
void for_cells(const GridStore& store, Body&& body) {
  for (const int t : store.owned()) {
    const BoxLayout& box = store[t].inner_box;
    for (int k = 0; k < box.nk; ++k)
      for (int j = 0; j < box.nj; ++j)
        for (int i = 0; i < box.ni; ++i)
          body(t, k, j, i,
               Eigen::Vector3d(store[t].centre()(0, k, j, i), store[t].centre()(1, k, j, i), store[t].centre()(2, k, j, i)));
  }
}

MultiBlockGrid curved_box(int n) {
  const BoxOptions box{.ni = n, .nj = n, .nk = n};
  return perturbed(cartesian_box(box), box, 0.04);
}
std::vector<bool> all_but_z(const GridStore& store) {
  std::vector<bool> given;
  for (const std::string& patch : store.tiling().patches) given.push_back(patch[0] != 'k');
  return given;
}
std::vector<double> solution(GridStore& store, MPI_Comm comm, int threads, double drop) {
  Poisson problem(store, all_but_z(store));
  problem.set_source([](const Eigen::Vector3d& x) { return 6.0 * pi * pi * exact(x); });
  problem.set_boundary(exact);
  problem.solve({.drop = drop}, comm, threads);
  std::vector<double> phi;
  for_cells(store, [&](int t, int k, int j, int i, const Eigen::Vector3d&) { phi.push_back(problem.phi(t, k, j, i)); });
  return phi;
}

}  // namespace

TEST_CASE("Poisson's equation on a curvilinear box is solved to second order", "[poisson][fast]") {
  std::vector<double> error;
  for (const int n : {8, 16, 32}) {
    GridStore store = store_of(curved_box(n));
    const std::vector<double> phi = solution(store, MPI_COMM_SELF, 1, 1e-7);
    double sum = 0.0, volume = 0.0;
    std::size_t at = 0;
    for_cells(store, [&](int t, int k, int j, int i, const Eigen::Vector3d& x) {
      const double off = phi[at++] - exact(x), v = store[t].volume()(0, k, j, i);
      sum += v * off * off, volume += v;
    });
    error.push_back(std::sqrt(sum / volume));
  }
  CAPTURE(error);
  CHECK(std::log2(error[0] / error[1]) > 1.8);
  CHECK(std::log2(error[1] / error[2]) > 1.9);
}

TEST_CASE("threads and reruns leave every bit of Poisson's solution", "[poisson][fast]") {
  GridStore store = store_of(curved_box(16));
  const std::vector<double> first = solution(store, MPI_COMM_SELF, 1, 1e-6);
  CHECK(solution(store, MPI_COMM_SELF, 1, 1e-6) == first);
  CHECK(solution(store, MPI_COMM_SELF, 3, 1e-6) == first);
}

TEST_CASE("the distance of Poisson's kind is exact between plates, to second order", "[poisson][fast]") {
  std::vector<double> worst;
  for (const int n : {8, 16}) {
    const BoxOptions box{.ni = n, .nj = 4, .nk = 1, .high = {2.0, 1.0, 1.0}};
    const std::vector<std::string> walls{"i_min", "i_max"};
    MultiBlockGrid grid = planar_box(box);
    deform(grid, [](const Eigen::Vector3d& x) {
      return Eigen::Vector3d(x[0] - 0.2 * std::sin(pi * x[0]), x[1], x[2]);
    });  // thin at both walls
    GridStore store = store_of(grid, 1, 0, walls);
    fill_wall_distance_by_poisson(store, walls, MPI_COMM_SELF);
    double largest = 0.0;
    for_cells(store, [&](int t, int k, int j, int i, const Eigen::Vector3d& x) {
      const double wanted = std::min(x[0], 2.0 - x[0]);
      largest = std::max(largest, std::abs(store[t].wall_distance()(0, k, j, i) - wanted));
    });
    worst.push_back(largest);
  }
  CAPTURE(worst);
  CHECK(worst[1] < 0.01);
  CHECK(worst[1] < 0.3 * worst[0]);
}

TEST_CASE("Poisson problems without a given value, or not solved in the corrections allowed, are refused", "[poisson][fast]") {
  GridStore store = store_of(curved_box(8));
  CHECK_THROWS_WITH(Poisson(store, std::vector<bool>(store.tiling().patches.size(), false)),
                    Catch::Contains("no boundary has a given value"));
  Poisson problem(store, all_but_z(store));
  problem.set_source([](const Eigen::Vector3d&) { return 1.0; });
  CHECK_THROWS_WITH(problem.solve({.drop = 1e-12, .most = 2}, MPI_COMM_SELF), Catch::Contains("in 2 corrections"));
  fill_wall_distance_by_poisson(store, {}, MPI_COMM_SELF);
  for_cells(store,
            [&](int t, int k, int j, int i, const Eigen::Vector3d&) { CHECK(std::isinf(store[t].wall_distance()(0, k, j, i))); });
}

TEST_CASE("Poisson's solution on two ranks is that on one to tolerance", "[poisson][mpi2]") {
  int rank;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  const MultiBlockGrid grid = curved_box(16);
  GridStore whole = store_of(grid), part = store_of(grid, 2, rank);
  const std::vector<double> one = solution(whole, MPI_COMM_SELF, 1, 1e-10), two = solution(part, MPI_COMM_WORLD, 2, 1e-10);
  const std::size_t first = rank == 0 ? 0 : one.size() - two.size();
  double apart = 0.0;
  for (std::size_t n = 0; n < two.size(); ++n) apart = std::max(apart, std::abs(two[n] - one[first + n]));
  CHECK(apart < 1e-8);
}
