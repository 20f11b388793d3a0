// Rotor grids over the space of sizes, pitches and first cells: sound, unfolded, as good as stated; nested and similar families;
// the same bits for any number of threads. SPDX-License-Identifier: Apache-2.0
#include "src/aero/rotor_grid/rotor_grid.hpp"

#include <omp.h>

#include <Eigen/Geometry>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "kernels/base/constants.hpp"
#include "kernels/base/failure.hpp"
#include "src/aero/grid/checks.hpp"
#include "src/aero/rotor_grid/coarsen.hpp"
#include "src/aero/rotor_grid/options.hpp"
#include "src/aero/rotor_grid/sections.hpp"
#include "tests/src/aero/rotor_grid/example.hpp"

using namespace spindrift;
using namespace spindrift::aero;

namespace {

struct Limits {
  double jacobian, skewed_percent, off_orthogonal_deg, growth, aspect;
};

void check_grid(const RotorGridSpec& spec, const Limits& limits) {
  const MultiBlockGrid grid = make_rotor_grid(dtu(), spec);
  const std::vector<std::string> faults = grid_faults(grid);
  INFO((faults.empty() ? "" : faults.front()));
  CHECK(faults.empty());
  const RotorGridQuality q = rotor_grid_quality(grid, blade_walls());
  INFO(describe_quality(grid, q));
  CHECK(q.folded == 0);
  CHECK(q.general.min_volume.value > 0.0);
  CHECK(q.interface_gap < (spec.whole ? 1e-14 : 2e-12));
  CHECK(q.general.scaled_jacobian.value >= limits.jacobian);
  CHECK(100.0 * double(q.skewed) / double(q.general.cells) <= limits.skewed_percent);
  CHECK(q.general.non_orthogonality.value <= limits.off_orthogonal_deg);
  CHECK(q.general.aspect_ratio.value <= limits.aspect);
  double growth = 0.0;  // of the O round the section, all along
  for (const Block& b : grid.blocks)
    if (b.name.starts_with("ring"))
      for (int k = 0; k <= b.nk; ++k)
        for (int j = 0; j <= b.nj; ++j)
          for (int i = 1; i < b.ni; ++i) {
            const double last = (b.nodes[b.node(k, j, i)] - b.nodes[b.node(k, j, i - 1)]).norm();
            const double next = (b.nodes[b.node(k, j, i + 1)] - b.nodes[b.node(k, j, i)]).norm();
            growth = std::max({growth, next / last, last / next});
          }
  CHECK(growth <= limits.growth);
  require_quality(grid, q);
}

}  // namespace

// The prototype's figures for these grids are the limits: scaled Jacobian, share below 0.4, angle, growth, aspect ratio.
TEST_CASE("rotor grids of 48 k cells are as good as stated", "[rotor_grid][fast]") {
  check_grid(spec_of(1.0, 1e-3, 0.0, true), {0.34, 0.05, 56.0, 2.9, 9e3});
}
TEST_CASE("by default the far sides stand at ten to twelve tip radii, on few cells", "[rotor_grid][fast]") {
  const RotorGridSpec spec = rotor_grid_spec({.resolution = 1.0, .sectors = "one"}, dtu(), 0.0, 0.925, 11.0);
  CHECK(spec.sizes.cells() <= 20000);
  const MultiBlockGrid grid = make_rotor_grid(dtu(), spec);
  double radius = 0.0, upstream = 0.0, downstream = 0.0;
  for (const Block& b : grid.blocks)
    for (const Eigen::Vector3d& x : b.nodes)
      radius = std::max(radius, x.tail<2>().norm()), upstream = std::max(upstream, -x.x()),
      downstream = std::max(downstream, x.x());
  const double tip = 88.935;  // coned and prebent
  CHECK(radius == Approx(12.0 * tip).epsilon(0.005));
  CHECK(upstream == Approx(10.0 * tip).epsilon(0.005));
  CHECK(downstream == Approx(12.0 * tip).epsilon(0.005));
}

namespace {
/// The turbine with the trailing edges of its aerofoils up to 40 % thick drawn together to this share of their gap.
Turbine with_thinner_edges(double share) {
  Turbine turbine = dtu();
  for (Aerofoil& a : turbine.aerofoils) {
    if (a.thickness > 0.4) continue;
    const Eigen::Vector2d half_gap = 0.5 * (1.0 - share) * (a.outline.front() - a.outline.back());
    std::size_t nose = 0;
    for (std::size_t i = 0; i < a.outline.size(); ++i)
      if (a.outline[i].x() < a.outline[nose].x()) nose = i;
    for (std::size_t i = 0; i < a.outline.size(); ++i)
      a.outline[i] -= (i < nose ? 1.0 : -1.0) * std::pow(a.outline[i].x(), 3) * half_gap;
    if (share == 0.0) a.outline.back() = a.outline.front();
  }
  return turbine;
}
}  // namespace

TEST_CASE("a sharp outline is no circle: nose and trailing edge have their own spacing", "[rotor_grid][fast]") {
  constexpr int n = 100;
  Aerofoil sharp, circle, blunt;
  for (int m = n; m >= -n; --m) {  // the suction side first
    const double a = pi * m / n, x = 0.5 * (1.0 - std::cos(a));
    sharp.outline.emplace_back(x, (m < 0 ? -0.3 : 0.3) * std::sqrt(x) * (1.0 - x));
    circle.outline.emplace_back(x, 0.5 * std::sin(a));
    if (x < 0.97) blunt.outline.emplace_back(x, 0.12 * std::sin(a));
  }
  CHECK_FALSE(is_round(sharp.outline));
  CHECK_FALSE(is_round(blunt.outline));
  CHECK(is_round(circle.outline));
  const auto edge = GENERATE(2, 4);
  const SectionSpacing spacing{.round = 80, .edge = edge, .leading_edge = 0.006, .trailing_edge = 0.009};
  const std::vector<Eigen::Vector2d> nodes = resample_outline(sharp, spacing);
  const auto cell = [&](int i) { return (nodes[std::size_t((i + 81) % 80)] - nodes[std::size_t((i + 80) % 80)]).norm(); };
  CHECK((nodes[0] - Eigen::Vector2d(1, 0)).norm() < 1e-12);
  CHECK(nodes[40].norm() < 1e-4);
  CHECK(signed_area(nodes) < 0.0);
  for (int i = -edge / 2; i < edge / 2; ++i) CHECK(cell(i) == Approx(0.0009).epsilon(1e-6));
  for (const int i : {edge / 2, -edge / 2 - 1}) CHECK(cell(i) == Approx(0.009).epsilon(0.3));
  CHECK(cell(40) == Approx(0.006).epsilon(0.2));
  for (int i = 1; i < 40; ++i)
    CHECK((nodes[std::size_t(i)] - Eigen::Vector2d(nodes[std::size_t(80 - i)].x(), -nodes[std::size_t(80 - i)].y())).norm() <
          1e-6);
}

TEST_CASE("thin and sharp trailing edges are opened to what their cells can be", "[rotor_grid][fast]") {
  const double share = GENERATE(0.0, 0.1);
  const Turbine turbine = with_thinner_edges(share);
  double before = 1.0;
  for (const double n : {1.0, 2.0}) {
    const RotorGridSpec spec = spec_of(n, 1e-3 / n);
    const MultiBlockGrid grid = make_rotor_grid(turbine, spec);
    const RotorGridQuality q = rotor_grid_quality(grid, blade_walls());
    INFO(describe_quality(grid, q));
    CHECK_NOTHROW(require_quality(grid, q));
    CHECK(q.general.stretch.value < 14.0);
    CHECK(q.general.scaled_jacobian.value > 0.2);
    const Block& ring = grid.blocks[0];
    const int k = ring.nk / 3;  // a section of 25 to 36 %
    const auto length = [&](int j) { return (ring.nodes[ring.node(k, j + 1, 0)] - ring.nodes[ring.node(k, j, 0)]).norm(); };
    const double edge = length(0), beside = length(spec.sizes.edge);
    CHECK(edge > 0.06 * beside);
    CHECK(edge < 0.5 * before);  // finer cells come nearer to the outline
    before = edge;
  }
}

TEST_CASE("rotor grids of 255 k cells are as good as stated, for wall functions and for y+ of 1", "[rotor_grid][fast]") {
  check_grid(spec_of(2.04, 2.6e-4), {0.36, 0.03, 59.0, 2.1, 7e3});
  check_grid(spec_of(2.04, 1e-5), {0.33, 0.03, 60.0, 2.9, 2e5});
}
TEST_CASE("rotor grids of 1.5 M cells are as good as stated", "[rotor_grid][nightly]") {
  RotorGridSpec spec = spec_of(3.0, 2.6e-4, 0.0, true);
  spec.sizes = medium_sizes();
  check_grid(spec, {0.3, 0.02, 64.0, 1.5, 3e3});  // the O grows fastest far outside the tip, where the rays are farthest apart
  spec.radial_extent = 3.0, spec.upstream_extent = 3.0, spec.downstream_extent = 6.0;  // of the prototype
  check_grid(spec, {0.3, 0.02, 64.0, 1.36, 3e3});
  spec.first_cell_chords = 1e-5;
  check_grid(spec, {0.3, 0.03, 66.0, 1.57, 8e4});
}
TEST_CASE("the paper's grid of 7.7 M cells is as good as stated", "[rotor_grid][nightly]") {
  RotorGridSpec spec = spec_of(6.0, 1e-5, 0.0, true);
  spec.sizes = paper_sizes();
  check_grid(spec, {0.31, 0.01, 69.0, 1.37, 5e4});
}

TEST_CASE("every pitch from 0 to 90 degrees gives a grid without folds, for thick and thin first cells", "[rotor_grid][fast]") {
  const auto pitch = GENERATE(0.0, 23.0, 45.0, 90.0);
  check_grid(spec_of(1.0, 2e-3, pitch), {0.3, 0.1, 66.0, 2.7, 4.5e3});
  check_grid(spec_of(1.0, 1e-5, pitch), {0.3, 0.1, 66.0, 6.2, 4e5});
}

TEST_CASE("every pitch gives a grid without folds at middle and large sizes", "[rotor_grid][nightly]") {
  // Thin first cells make the weakest grids. Neighbouring pitches at neighbouring sizes differ in the roll of the box by a cell,
  // not in kind, so sizes take turns: each has every second pitch, each pitch half the sizes.
  const std::array<double, 8> pitches{0.0, 10.0, 23.0, 35.0, 45.0, 60.0, 75.0, 90.0};
  const std::array<double, 6> sizes{1.3, 1.6, 2.0, 2.5, 3.0, 4.0};
  for (std::size_t n = 0; n < sizes.size(); ++n)
    for (std::size_t p = n % 2; p < pitches.size(); p += 2) {
      CAPTURE(sizes[n], pitches[p]);
      check_grid(spec_of(sizes[n], 1e-5, pitches[p]), {0.02, 0.8, 75.0, 5.5, 4e5});
      if (sizes[n] < 2.5) check_grid(spec_of(sizes[n], 2.6e-4, pitches[p]), {0.02, 0.8, 75.0, 5.5, 4e5});
    }
}
// The grids that were farthest off orthogonal before the layers of neighbouring rays were made alike (79.9 and 76.7 degrees).
TEST_CASE("layers leave the nose evenly where they double and more from one to the next", "[rotor_grid][fast]") {
  const auto pitch = GENERATE(23.0, 35.0);
  check_grid(spec_of(1.6, 1e-5, pitch), {0.1, 0.6, 72.0, 5.5, 4e5});
}
TEST_CASE("the paper's grid is without folds at every pitch", "[rotor_grid][nightly]") {
  const auto pitch = GENERATE(23.0, 45.0, 90.0);
  RotorGridSpec spec = spec_of(6.0, 1e-5, pitch);
  spec.sizes = paper_sizes();
  check_grid(spec, {0.1, 0.3, 75.0, 1.6, 6e4});
}

TEST_CASE("other numbers of blades, hubs, extents and rounded edges give sound grids", "[rotor_grid][fast]") {
  RotorGridSpec spec = spec_of(1.0, 1e-3);
  spec.rounded_edge = true;
  check_grid(spec, {0.3, 0.1, 66.0, 3.0, 4e3});
  spec = spec_of(1.0, 1e-3, 5.0, true);
  spec.hub_radius_m = 4.6, spec.radial_extent = 5.0, spec.upstream_extent = 2.0, spec.downstream_extent = 10.0;
  check_grid(spec, {0.2, 0.2, 70.0, 3.0, 5e3});
  Turbine two = dtu();
  two.blades = 2;
  const MultiBlockGrid grid = make_rotor_grid(two, spec);
  CHECK(grid.blocks.size() == 20);
  CHECK(grid_faults(grid).empty());
  require_quality(grid, rotor_grid_quality(grid, blade_walls()));
}

TEST_CASE("one sector with rotational periodicity is a third of the rotor", "[rotor_grid][fast]") {
  const MultiBlockGrid all = make_rotor_grid(dtu(), spec_of(1.0, 2e-3, 0.0, true)),
                       one = make_rotor_grid(dtu(), spec_of(1.0, 2e-3));
  CHECK(all.blocks.size() == 30);
  CHECK(one.blocks.size() == 10);
  const GridQuality a = grid_quality(all), b = grid_quality(one);
  CHECK(a.cells == 3 * b.cells);
  CHECK(a.volume == Approx(3.0 * b.volume).epsilon(1e-12));
  // All but the blades: a cylinder ring as long as 22 tip radii; its polygons lose 2 % on so coarse a grid.
  const double R = 88.935, ring = pi * (144.0 * R * R - 25.0) * 22.0 * R;
  CHECK(a.volume == Approx(ring).epsilon(0.03));
  CHECK(a.volume < ring);
}

TEST_CASE("coarsening keeps every second node and its grid is sound", "[rotor_grid][fast]") {
  RotorGridSpec spec = spec_of(2.0, 1e-3, 10.0);
  spec.sizes.edge = 4;
  const MultiBlockGrid fine = make_rotor_grid(dtu(), spec);
  spec.coarsen = 1;
  const MultiBlockGrid coarse = make_rotor_grid(dtu(), spec);
  CHECK(grid_faults(coarse).empty());
  CHECK(grid_quality(coarse).cells * 8 == grid_quality(fine).cells);
  CHECK(grid_quality(coarse).scaled_jacobian.value > 0.0);
  spec.sizes.layers = 17, spec.coarsen = 1;
  CHECK_THROWS_WITH(make_rotor_grid(dtu(), spec), Catch::Contains("ring_1") && Catch::Contains("odd index 17"));
}

TEST_CASE("grids of one family are similar: sizes go with 1/n", "[rotor_grid][fast]") {
  // Sizes of cells at places that both grids have, n = 1 and 2, 2 and 4: the ratio of volumes is near eight all over.
  const auto compare = [](double n) {
    const RotorGridSpec coarse = spec_of(n, 2e-3 / n), fine = spec_of(2.0 * n, 1e-3 / n);
    const MultiBlockGrid a = make_rotor_grid(dtu(), coarse), b = make_rotor_grid(dtu(), fine);
    double sum = 0.0, squares = 0.0;
    long count = 0;
    for (const std::size_t block : {0, 3, 5, 8})
      for (int k = 1; k < a.blocks[block].nk; ++k)
        for (int j = 1; j < a.blocks[block].nj; ++j)
          for (int i = 1; i < a.blocks[block].ni; ++i) {
            const Block &p = a.blocks[block], &q = b.blocks[block];
            const auto volume = [](const Block& g, int kk, int jj, int ii) {
              const Eigen::Vector3d o = g.nodes[g.node(kk, jj, ii)];
              return (g.nodes[g.node(kk, jj, ii + 1)] - o)
                  .cross(g.nodes[g.node(kk, jj + 1, ii)] - o)
                  .dot(g.nodes[g.node(kk + 1, jj, ii)] - o);
            };
            const double ratio = std::log2(volume(p, k, j, i) / volume(q, 2 * k, 2 * j, 2 * i));
            sum += ratio, squares += ratio * ratio, ++count;
          }
    const double mean = sum / double(count);
    return std::pair(mean, std::sqrt(squares / double(count) - mean * mean));
  };
  const auto [mean1, spread1] = compare(1.0);
  const auto [mean2, spread2] = compare(2.0);
  INFO("volume ratio 2^p: p = " << mean1 << " +- " << spread1 << ", " << mean2 << " +- " << spread2);
  CHECK(mean1 == Approx(3.0).margin(0.3));  // the tip's spacing goes with n^-1.5
  CHECK(mean2 == Approx(3.0).margin(0.3));
  CHECK(spread2 < spread1);
}

TEST_CASE("grids are the same bits for any number of threads", "[rotor_grid][fast]") {
  const int before = omp_get_max_threads();
  omp_set_num_threads(1);
  const MultiBlockGrid one = make_rotor_grid(dtu(), spec_of(1.7, 1e-4, 7.0, true));
  omp_set_num_threads(3);
  const MultiBlockGrid three = make_rotor_grid(dtu(), spec_of(1.7, 1e-4, 7.0, true));
  omp_set_num_threads(before);
  for (std::size_t b = 0; b < one.blocks.size(); ++b)
    CHECK(std::memcmp(one.blocks[b].nodes.data(), three.blocks[b].nodes.data(),
                      one.blocks[b].nodes.size() * sizeof(Eigen::Vector3d)) == 0);
}

TEST_CASE("first cells have the height asked for, or that of the y+ asked for", "[rotor_grid][fast]") {
  RotorGridSpec spec = spec_of(1.0, 0.0);
  spec.first_cell_m = 2e-4;
  RotorGridQuality q = rotor_grid_quality(make_rotor_grid(dtu(), spec), blade_walls());
  CHECK(q.first_cell_low > 1e-4);
  CHECK(q.first_cell_low < 2.2e-4);
  // White's law at 70 m/s, 3.4 m of chord, half of it run: Re 8.2e6, c_f 0.00268, u_tau 2.56 m/s, so y+ = 1 at 5.7e-6 m.
  CHECK(0.5 * first_cell_for(1.0, 70.0, 3.4, 1.46e-5) == Approx(5.7e-6).epsilon(0.01));
}
