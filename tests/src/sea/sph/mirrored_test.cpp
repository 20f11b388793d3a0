// A plane of symmetry: half a sea does what the half of a whole one does, sweep by sweep, with walls, bodies and every scheme;
// the same bits on any number of threads and ranks. SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include <map>

#include "src/sea/sph/lattice.hpp"
#include "src/sea/sph/sea_sph.hpp"
#include "tests/src/sea/sph/scenes.hpp"

using namespace spindrift;
using namespace spindrift::sph;

namespace {

constexpr double half_spacing = 0.05, plane_y = 0.3;
constexpr std::uint16_t half_body = 2;

/// Water in motion beside walls at both ends, on the bed and at the upper y, and half a box that the plane cuts.
struct HalfSea {
  Parameters p;
  std::vector<Seed<3>> seeds;
  Domain<3> domain{{-0.4, plane_y, -0.4}, {1.6, 1.2, 1.4}};
  Motion box;

  HalfSea() {
    p.spacing = half_spacing, p.eos = {1000.0, 25.0}, p.h_over_d = 1.3;
    domain.mirrored = true;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    const auto in_box = [](double x, double y, double z) { return x > 0.4 && x < 0.7 && y < plane_y + 0.15 && z > 0.3; };
    const auto place = [&](const std::array<int, 3>& index) {
      return std::array{half_spacing * (index[0] + 0.5), plane_y + half_spacing * (index[1] + 0.5),
                        half_spacing * (index[2] + 0.5)};
    };
    for_lattice<3>({0, 0, 0}, {22, 8, 9}, [&](const std::array<int, 3>& index) {
      Seed<3> seed{.position = place(index)};
      if (in_box(seed.position[0], seed.position[1], seed.position[2])) return;
      seed.deviation = p.eos.hydrostatic_deviation(0.45 - seed.position[2], p.gravity);
      for (int k = 0; k < 3; ++k) seed.position[k] += 0.2 * half_spacing * unit(random), seed.velocity[k] = unit(random);
      seeds.push_back(seed);
    });
    seeds[3].velocity[1] = -8.0;  // through the plane within a few steps
    for_lattice<3>({-2, 0, -2}, {24, 10, 14}, [&](const std::array<int, 3>& index) {
      if (index[0] >= 0 && index[0] < 22 && index[1] < 8 && index[2] >= 0) return;
      seeds.push_back({.position = place(index), .owner = 1});
    });
    for_lattice<3>({8, 0, 6}, {14, 3, 12},
                   [&](const std::array<int, 3>& index) { seeds.push_back({.position = place(index), .owner = half_body}); });
    box.position = {0.55, plane_y, 0.45};
  }
};

std::array<double, 3> image_in_plane(std::array<double, 3> x) { return {x[0], 2.0 * plane_y - x[1], x[2]}; }

/// The same with its images: each owner's behind its own. Identity of each particle of the half in it.
struct WholeSea {
  std::vector<Seed<3>> seeds;
  std::vector<std::uint32_t> id;
  Domain<3> domain;

  explicit WholeSea(const HalfSea& half) : id(half.seeds.size()), domain(half.domain) {
    for (const std::uint16_t owner : {std::uint16_t(0), std::uint16_t(1), half_body}) {
      for (std::size_t n = 0; n < half.seeds.size(); ++n)
        if (half.seeds[n].owner == owner) id[n] = std::uint32_t(seeds.size()), seeds.push_back(half.seeds[n]);
      for (Seed<3> seed : half.seeds) {
        if (seed.owner != owner) continue;
        seed.position = image_in_plane(seed.position), seed.velocity[1] = -seed.velocity[1];
        seeds.push_back(seed);
      }
    }
    domain.mirrored = false, domain.low[1] = 2.0 * plane_y - domain.high[1];
  }
};

using HalfState = std::array<double, 7>;
template <class Real>
std::map<std::uint32_t, HalfState> half_states(const SeaSph<3, Real>& sea, MPI_Comm comm = MPI_COMM_SELF) {
  runtime::Packer mine;
  const auto& store = sea.store();
  for (std::size_t slot = 0; slot < store.slots(); ++slot) {
    if (store.id[slot] == no_particle) continue;
    HalfState s;
    for (int k = 0; k < 3; ++k) s[std::size_t(k)] = store.x[k][slot], s[std::size_t(3 + k)] = store.v[k][slot];
    s[6] = store.deviation[slot];
    mine.put_one(store.id[slot]), mine.put_one(s);
  }
  std::map<std::uint32_t, HalfState> all;
  for (const runtime::Bytes& bytes : runtime::exchange_all(comm, mine.take()))
    for (runtime::Unpacker from(bytes); !from.done();) {
      const auto id = from.one<std::uint32_t>();
      all[id] = from.one<HalfState>();
    }
  return all;
}

/// A body that falls in the plane_y, pushed by the water.
MoveBodies falling_in_plane(double mass) {
  return [mass](const HalfStep& half, std::span<const Wrench> loads, std::span<Motion> motions) {
    const double dt = 0.5 * half.dt;
    for (std::size_t n = 0; n < motions.size(); ++n) {
      Eigen::Vector3d force = loads[n].force;
      force.y() = 0.0;
      motions[n].velocity += dt * (force / mass + Eigen::Vector3d(0, 0, -9.81));
      motions[n].position += dt * motions[n].velocity;
      motions[n].omega.y() += dt * 1e-2 * loads[n].moment.y();
      motions[n].attitude =
          (motions[n].attitude * Eigen::Quaterniond(1.0, 0.0, 0.5 * dt * motions[n].omega.y(), 0.0)).normalized();
    }
  };
}

}  // namespace

TEST_CASE("half a sea beside a plane of symmetry moves as the half of a whole one, with every scheme", "[sph][fast]") {
  HalfSea half;
  const int scheme = GENERATE(0, 1, 2, 3);
  if (scheme == 0) half.p.boundary = BoundaryChoice::extrapolated, half.p.diffusion = DiffusionChoice::fourtakas;
  if (scheme == 1) half.p.step = StepChoice::verlet;  // dynamic walls
  if (scheme == 2) {
    half.p.boundary = BoundaryChoice::extrapolated, half.p.wall = WallChoice::no_slip;
    half.p.viscosity = ViscosityChoice::laminar_sps, half.p.nu = half.p.nu_solid = 1e-2;
  }
  if (scheme == 3) half.p.filter = FilterChoice::mls, half.p.filter_every = 3, half.p.shifting = 2.0;
  const WholeSea whole(half);
  SeaSph<3, double> one(half.p, half.domain, half.seeds), both(half.p, whole.domain, whole.seeds);
  one.add_body(half_body, half.box), both.add_body(half_body, half.box);
  bool crossed = false;
  for (int step = 0; step < 12; ++step) {
    const double dt = one.step(1e300);
    CHECK(both.step(1e300) == Approx(dt).epsilon(1e-9));
    if (scheme == 3) continue;  // shifting leaves no sums
    const Wrench load = one.load_on(half_body, half.box.position), all = both.load_on(half_body, half.box.position);
    const double scale = all.force.norm();
    CHECK(2.0 * load.force.x() == Approx(all.force.x()).margin(1e-8 * scale));
    CHECK(2.0 * load.force.z() == Approx(all.force.z()).margin(1e-8 * scale));
    CHECK(2.0 * load.moment.y() == Approx(all.moment.y()).margin(1e-8 * scale));
    CHECK(std::abs(load.force.y()) > 1e-3 * scale);  // which the other half takes
  }
  one.sort();
  const auto mine = half_states(one), theirs = half_states(both);
  REQUIRE(mine.size() == half.seeds.size());
  double farthest = 0.0, fastest = 0.0, densest = 0.0;
  for (const auto& [id, a] : mine) {
    HalfState b = theirs.at(whole.id[id]);
    CHECK(a[1] > plane_y);
    if (b[1] < plane_y) crossed = true, b[1] = 2.0 * plane_y - b[1], b[4] = -b[4];
    for (std::size_t k = 0; k < 3; ++k) farthest = std::max(farthest, std::abs(a[k] - b[k]));
    for (std::size_t k = 3; k < 6; ++k) fastest = std::max(fastest, std::abs(a[k] - b[k]));
    densest = std::max(densest, std::abs(a[6] - b[6]));
  }
  CHECK(crossed);
  CHECK(farthest < 1e-9 * half_spacing);
  CHECK(fastest < 1e-9 * half.p.eos.c0);
  CHECK(densest < 1e-9 * half.p.eos.rho0);
}

TEST_CASE("columns beside a plane of symmetry meet each image once, and those of one colour add to no common sums",
          "[sph][fast]") {
  const bool periodic = GENERATE(false, true);
  const int nx = GENERATE(3, 4, 5, 7), ny = GENERATE(1, 3, 4);
  Domain<3> domain{{0, 0, 0}, {double(nx), double(ny), 1}, {periodic, false, false}};
  domain.mirrored = true;
  const Columns<3> columns(domain, 1.0, 1.0);
  REQUIRE(columns.groups_and_images() == nx * ny + nx);
  std::vector<std::multiset<int>> writes(std::size_t(columns.groups()));
  for (int g = 0; g < columns.groups(); ++g) {
    writes[std::size_t(g)].insert(g);
    columns.for_forward(g, [&](const Neighbour<3>& n) { writes[std::size_t(g)].insert(n.group); });
  }
  const auto sums = [&](int g) {  // what is carried to the next row apart; those of images nobody reads
    std::multiset<std::pair<int, bool>> of{{g, false}};
    columns.for_forward(g, [&](const Neighbour<3>& n) {
      if (!columns.is_image(n.group)) of.insert({n.group, n.in_next_row});
    });
    return of;
  };
  for (int a = 0; a < columns.groups(); ++a) {
    REQUIRE(columns.colour(a) < columns.colours());
    for (int b = 0; b < a; ++b)
      if (columns.colour(a) == columns.colour(b))
        for (const auto& one : sums(a)) REQUIRE(sums(b).count(one) == 0);
    for (int row = 0; row < nx; ++row) {
      const int dx = std::abs(a / ny - row);
      const bool beside = a % ny == 0 && std::min(dx, periodic ? nx - dx : dx) <= 1;
      REQUIRE(columns.source(columns.groups() + row) == row * ny);
      REQUIRE(writes[std::size_t(a)].count(columns.groups() + row) == (beside ? 1u : 0u));
    }
  }
}

namespace {

void same_bits_beside_the_plane() {
  HalfSea half;
  half.p.boundary = BoundaryChoice::extrapolated, half.p.filter = FilterChoice::shepard, half.p.filter_every = 5;
  const auto run = [&](Resources resources) {
    const MPI_Comm comm = resources.comm;
    SeaSph<3, float> sea(half.p, half.domain, half.seeds, std::move(resources));
    sea.add_body(half_body, half.box, 8.0);
    sea.set_bodies(falling_in_plane(8.0));
    for (int window = 0; window < 3; ++window) sea.advance(0.01);
    CHECK(sea.store().lost.empty());
    return half_states(sea, comm);
  };
  const auto expected = run({.threads = 1});
  CHECK((run({.threads = 2, .random_schedule = 3}) == expected));
  const MPI_Comm world = MPI_COMM_WORLD;
  const int ranks = runtime::ranks_in(world);
  if (ranks == 1) return;
  CHECK((run({.comm = world, .threads = 2}) == expected));
  const SeaSph<3, float> probe(half.p, half.domain, half.seeds, {.threads = 1});
  std::vector<int> striped(std::size_t(probe.state().columns.groups()));
  for (std::size_t g = 0; g < striped.size(); ++g) striped[g] = int(g % std::size_t(ranks));
  CHECK((run({.comm = world, .threads = 1, .repartition_above = 1e9, .rank_of_group = striped}) == expected));
}

}  // namespace

TEST_CASE("half a sea has the same bits on any threads", "[sph][tasks][fast]") { same_bits_beside_the_plane(); }
TEST_CASE("half a sea has the same bits on two ranks", "[sph][tasks][mpi2]") { same_bits_beside_the_plane(); }
TEST_CASE("half a sea has the same bits on four ranks", "[sph][tasks][mpi4]") { same_bits_beside_the_plane(); }
