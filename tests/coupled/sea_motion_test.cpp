// The paper's check of its communication, on the side of the water (the air's is in resolved_air_test.cpp): a sea of particles
// driven by bodies whose motion was read from a file gives bit for bit what it gave when the bodies moved under its loads.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include <omp.h>

#include <iomanip>

#include "runtime/executor/executor.hpp"
#include "src/coupling/sea_window.hpp"
#include "src/coupling/start.hpp"
#include "tests/coupled/runs.hpp"

using namespace spindrift;
using namespace spindrift::coupling;

namespace {

constexpr int first_tag = 64;
const runtime::World alone{MPI_COMM_SELF, 0, 1};

void write(std::ostream& file, double number) { file << std::setprecision(17) << number << ' '; }
void write(std::ostream& file, const std::vector<Motion>& motions) {
  write(file, double(motions.size()));
  for (const Motion& m : motions) {
    for (const Eigen::Vector3d& v : {m.position, m.velocity, m.omega})
      for (const double x : v) write(file, x);
    for (const double x : m.attitude.coeffs()) write(file, x);
  }
  file << '\n';
}
double number_in(std::istream& file) {
  double x = 0.0;
  REQUIRE(file >> x);
  return x;
}
std::vector<Motion> motions_in(std::istream& file) {
  std::vector<Motion> motions(std::size_t(number_in(file)));
  for (Motion& m : motions) {
    for (Eigen::Vector3d* v : {&m.position, &m.velocity, &m.omega})
      for (double& x : *v) x = number_in(file);
    for (double& x : m.attitude.coeffs()) x = number_in(file);
  }
  return motions;
}

/// Passes everything on, and writes down how the bodies moved.
class Heard final : public sea::WindowDriver {
 public:
  explicit Heard(std::ostream& file) : file_(file) {}
  sea::WindowDriver& between(sea::WindowDriver& bodies) {
    bodies_ = &bodies;
    return *this;
  }
  Steps choose(double limit, int most) override {
    const Steps steps = bodies_->choose(limit, most);
    write(file_, steps.dt), write(file_, double(steps.last));
    return steps;
  }
  double move(bool to_end, std::vector<Motion>& motions) override {
    const double t = bodies_->move(to_end, motions);
    write(file_, t), write(file_, motions);
    return t;
  }

 private:
  std::ostream& file_;
  sea::WindowDriver* bodies_ = nullptr;
};

/// There are no bodies: what the file says.
class Read final : public sea::WindowDriver {
 public:
  explicit Read(std::istream& file) : file_(file) {}
  Steps choose(double limit, int) override {
    const double dt = number_in(file_);
    CHECK(dt <= limit);
    return {dt, number_in(file_) == 1.0};
  }
  double move(bool, std::vector<Motion>& motions) override {
    const double t = number_in(file_);
    motions = motions_in(file_);
    return t;
  }

 private:
  std::istream& file_;
};

struct Seen {
  std::vector<Wrench> loads;
  double kinetic_energy;
};
Seen seen(const sea::ParticleSea& sea) { return {{sea.loads().begin(), sea.loads().end()}, sea.extent().kinetic_energy}; }

std::unique_ptr<FloatingSystem> platform() {
  scene::Document document = scene::load(test::input("leble_barakos/case1_demo.toml"),
                                         {"sea.particles.spacing_m=4.0", "sea.initial.settle_s=0.1", "time.end_s=0.3"});
  return std::make_unique<FloatingSystem>(read_scenario(document));
}

}  // namespace

TEST_CASE("bodies' motion from a file gives the sea's bits of moving bodies", "[coupled][sea][fast]") {
  const test::Folder folder("sea_motion");
  std::filesystem::create_directories(folder.path());
  omp_set_num_threads(2);  // room for as many is made when tasks are recorded; OMP_NUM_THREADS may say one
  std::vector<Seen> moved;
  {
    std::ofstream file(folder.path() / "motion.txt");
    const std::unique_ptr<FloatingSystem> floating = platform();
    bodies::BodiesState state = make_start(*floating).state;
    floating->fill_sea(state.motions, alone);
    state.tick = floating->timeline().first_tick();
    Heard heard(file);
    const std::unique_ptr<BodySide> side = make_particle_side(
        *floating, [&heard](sea::WindowDriver& bodies) -> sea::WindowDriver& { return heard.between(bodies); });
    runtime::Graph graph;
    REQUIRE(side->record(graph) != Tasks::none);
    runtime::Executor executor(std::move(graph), {.threads = 2});
    for (int n = 0; n < 4; ++n) {
      REQUIRE_FALSE(side->outdated());
      write(file, double(state.tick) * floating->timeline().tick_s()), write(file, double(state.tick < 0)),
          write(file, state.motions);
      side->prepare(state, state.tick + floating->timeline().steps_per_window());
      executor.run();
      state = side->finish();
      moved.push_back(seen(*floating->particles()));
    }
    CHECK(state.motions[0].velocity.norm() > 1e-3);  // they do move
  }
  std::ifstream file(folder.path() / "motion.txt");
  const std::unique_ptr<FloatingSystem> floating = platform();
  floating->fill_sea(make_start(*floating).state.motions, alone);
  sea::ParticleSea& sea = *floating->particles();
  Read read(file);
  runtime::Graph graph;
  sea.record(graph, read, first_tag);
  runtime::Executor executor(std::move(graph), {.threads = 1});
  for (const Seen& expected : moved) {
    const double t = number_in(file);
    const bool held = number_in(file) == 1.0;
    sea.open(t, motions_in(file), held);
    executor.run();
    sea.close();
    const Seen now = seen(sea);
    CHECK(now.kinetic_energy == expected.kinetic_energy);
    REQUIRE(now.loads.size() == expected.loads.size());
    for (std::size_t b = 0; b < now.loads.size(); ++b) {
      CHECK(now.loads[b].force == expected.loads[b].force);
      CHECK(now.loads[b].moment == expected.loads[b].moment);
    }
  }
  CHECK(moved.back().loads[0].force.z() > 3e7);
}
