// The linear solver's choices: the Krylov methods see the same residuals and end in the same flow, preconditioners change the way
// and not the end, one with a coarse level of all tiles is the same as by tile, matrices kept over pseudo-steps are counted, and
// all of it to the bit on any threads and ranks. SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <map>
#include <thread>

#include "tests/src/aero/flow/flows.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using namespace spindrift::aero::testing;

namespace {

constexpr KrylovMethod methods[]{KrylovMethod::gmres, KrylovMethod::fgmres, KrylovMethod::gcg};

FlowSetting turbulent_air() {
  FlowSetting s = air(0.3, {1.0, 0.4, 0.2});
  s.viscous = true;
  s.turbulence = "sa";
  s.gas.viscosity.mu0 = 1e-2;
  s.march.drop = 1e-6;
  s.march.max_steps = 60;
  return s;
}

/// A bump in a skewed box of eight tiles, that leaves.
Case leaving_bump(const FlowSetting& setting, int ranks = 1, int rank = 0,
                  std::unique_ptr<Preconditioner> preconditioner = nullptr) {
  const BoxOptions box{.ni = 8, .nj = 8, .nk = 8};
  Case c(perturbed(cartesian_box(box), box, 0.04), setting, {}, {.across_j = 4, .across_k = 4, .normal = 8}, ranks, rank);
  if (preconditioner) c.solver->use(std::move(preconditioner));
  for (FlowTile& tile : c.solver->tiles()) std::ranges::fill(tile.geometry->wall_distance_data.span(), 0.1);
  c.solver->start([&](const Eigen::Vector3d& x) {
    gas::Primitive<double> q = setting.stream;
    const double height = std::exp(-20.0 * (x - Eigen::Vector3d::Constant(0.5)).squaredNorm());
    q.p += 2000.0 * height, q.T += 3.0 * height, q.v += 10.0 * height;
    return q;
  });
  return c;
}
Case marched(const FlowSetting& setting, std::unique_ptr<Preconditioner> preconditioner = nullptr) {
  Case c = leaving_bump(setting, 1, 0, std::move(preconditioner));
  c.prepare();
  c.run();
  return c;
}

/// Block ILU of each tile, its vectors carried through a coarse level as a library's multigrid would have them.
class ThroughCoarse final : public Preconditioner {
 public:
  void attach(GridStore&, std::span<FlowTile> tiles) override {
    for (const FlowTile& tile : tiles) gathered_[tile.index].resize(tile.vector_size());
  }
  std::ptrdiff_t refresh(FlowTile& tile) override {
    ++refreshed_;
    return each_->refresh(tile);
  }
  bool has_coarse_level() const override { return true; }
  void refresh_coarse_level(MPI_Comm comm) override {
    CHECK(comm != MPI_COMM_NULL);
    CHECK(refreshed_ == int(gathered_.size()));
    refreshed_ = 0;
  }
  void gather(FlowTile& tile, const float* v) override { std::copy_n(v, tile.vector_size(), gathered_.at(tile.index).data()); }
  void solve_coarse_level(MPI_Comm) override { handed_ = gathered_; }
  void apply(const Piece& piece) override { each_->apply({piece.tile, handed_.at(piece.tile->index).data(), piece.z}); }

 private:
  std::unique_ptr<Preconditioner> each_ = make_preconditioner("block_ilu");
  std::map<int, std::vector<float>> gathered_, handed_;
  std::atomic<int> refreshed_ = 0;
};

}  // namespace

TEST_CASE("flexible GMRES and GCG reduce a linear system as GMRES does, with either operator", "[flow][fast]") {
  for (const double matrix_free_below : {0.0, 2.0}) {
    std::vector<double> drop;
    std::vector<std::vector<double>> state;
    for (const KrylovMethod method : methods) {
      FlowSetting s = turbulent_air();
      s.krylov = method;
      s.march = {.cfl_start = 50.0,
                 .drop = 0.0,
                 .max_steps = 1,
                 .krylov_steps = 8,
                 .krylov_drop = 0.0,
                 .matrix_free_below = matrix_free_below};
      const Case c = marched(s);
      drop.push_back(c.solver->march().last.linear_drop);
      state.push_back(state_of(*c.solver));
      CHECK(c.solver->march().last.krylov == 8);
    }
    CAPTURE(drop);
    CHECK(drop[0] < 0.1);
    double change = 0.0, apart = 0.0;
    const std::vector<double> before = state_of(*leaving_bump(turbulent_air()).solver);
    for (std::size_t m = 1; m < 3; ++m) {
      CHECK(drop[m] == Approx(drop[0]).epsilon(0.02));
      for (std::size_t n = 0; n < before.size(); ++n) {
        change = std::max(change, std::abs(state[0][n] - before[n]));
        apart = std::max(apart, std::abs(state[m][n] - state[0][n]));
      }
    }
    CHECK(apart < 2e-3 * change);
  }
}

TEST_CASE("every method and preconditioner ends in the same flow, the better ones in fewer iterations", "[flow][fast]") {
  std::vector<long> iterations;
  for (const char* preconditioner : {"block_ilu", "block_jacobi", "identity"})
    for (const KrylovMethod method : methods) {
      FlowSetting s = turbulent_air();
      s.krylov = method, s.preconditioner = preconditioner;
      s.march.cfl_max = 20.0, s.march.krylov_drop = 0.05, s.march.krylov_steps = 40;
      const Case c = marched(s);
      CAPTURE(preconditioner, int(method));
      CHECK(c.solver->march().verdict == Verdict::converged);
      CHECK_FALSE(c.solver->march().spent);
      CHECK(stream_deviation(*c.solver) < 1e-5);
      iterations.push_back(c.solver->march().krylov_total);
    }
  CAPTURE(iterations);
  for (std::size_t m = 0; m < 3; ++m) {
    CHECK(iterations[m] < iterations[3 + m]);
    CHECK(iterations[3 + m] < iterations[6 + m]);
  }
}

TEST_CASE("block ILU through a coarse level of all tiles gives the bits of the same one by tile", "[flow][fast]") {
  for (const KrylovMethod method : methods) {
    FlowSetting s = turbulent_air();
    s.krylov = method, s.march.max_steps = 6;
    const Case by_tile = marched(s), at_once = marched(s, std::make_unique<ThroughCoarse>());
    CHECK(fingerprint(*by_tile.solver) == fingerprint(*at_once.solver));
    CHECK(state_of(*by_tile.solver) == state_of(*at_once.solver));
  }
}

TEST_CASE("while the coarse level of a preconditioner runs, other threads go on with the sea", "[flow][fast]") {
  std::atomic<int> sea = 0, met = 0, calls = 0;
  /// Block ILU whose first coarse levels last until a task of the sea has run beside them.
  class Waiting final : public Preconditioner {
   public:
    Waiting(std::atomic<int>& sea, std::atomic<int>& met, std::atomic<int>& calls) : sea_(sea), met_(met), calls_(calls) {}
    std::ptrdiff_t refresh(FlowTile& tile) override { return each_->refresh(tile); }
    void apply(const Piece& piece) override { each_->apply(piece); }
    bool has_coarse_level() const override { return true; }
    void solve_coarse_level(MPI_Comm) override {
      if (calls_ == 3) return;
      const int before = sea_;
      const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
      while (sea_ == before && std::chrono::steady_clock::now() < end) std::this_thread::yield();
      met_ += sea_ > before, ++calls_;
    }

   private:
    std::unique_ptr<Preconditioner> each_ = make_preconditioner("block_ilu");
    std::atomic<int>&sea_, &met_, &calls_;
  };
  FlowSetting s = turbulent_air();
  s.march.max_steps = 1;
  Case c = leaving_bump(s, 1, 0, std::make_unique<Waiting>(sea, met, calls));
  runtime::Graph graph;
  c.solver->record(graph);
  const runtime::Datum waves = graph.datum();
  graph.loop("sea/steps", {.min = 1, .max = 1000000}, [&] {  // for as long as it is waited for
    graph.task("sea/step", {runtime::updates(waves)},
               [&sea] { std::this_thread::sleep_for(std::chrono::milliseconds(1)), ++sea; });
    graph.until("sea/enough", {runtime::reads(waves)}, [&calls, &sea] { return calls == 3 || sea > 20000; });
  });
  runtime::Executor(std::move(graph), {.threads = 2}).run();
  CHECK(met == 3);
}

TEST_CASE("matrices kept over some pseudo-steps are fewer and end in the same flow", "[flow][fast]") {
  FlowSetting s = turbulent_air();
  s.march.matrix_free_below = 2.0, s.march.cfl_start = 20.0, s.march.cfl_max = 20.0;
  const Case each = marched(s);
  s.march.refresh_every = 4;
  const Case kept = marched(s);
  CHECK(each.solver->march().verdict == Verdict::converged);
  CHECK(kept.solver->march().verdict == Verdict::converged);
  CHECK(stream_deviation(*kept.solver) < 1e-5);
  CHECK(each.solver->rows().back().matrices == each.solver->march().steps - 1);
  CHECK(2 * kept.solver->rows().back().matrices < kept.solver->march().steps);
}

TEST_CASE("threads leave every bit of flexible GMRES and GCG with matrices kept", "[flow][fast]") {
  for (const KrylovMethod method : {KrylovMethod::fgmres, KrylovMethod::gcg}) {
    FlowSetting s = turbulent_air();
    s.krylov = method, s.march.refresh_every = 3, s.march.matrix_free_below = 2.0, s.march.max_steps = 6;
    std::vector<double> rows, state;
    for (const int threads : {1, 3}) {
      Case c = leaving_bump(s);
      runtime::ExecutorOptions options{.threads = threads};
      if (threads > 1) options.random_schedule = 7;
      c.prepare(MPI_COMM_SELF, options);
      c.run();
      if (rows.empty()) rows = fingerprint(*c.solver), state = state_of(*c.solver);
      CHECK(fingerprint(*c.solver) == rows);
      CHECK(state_of(*c.solver) == state);
    }
  }
}

TEST_CASE("a physical step begins with a new matrix, so a march restarted between steps goes on with the same bits",
          "[flow][fast]") {
  FlowSetting s = turbulent_air();
  s.krylov = KrylovMethod::gcg;
  s.time_order = 2, s.dt = 1e-3, s.march.drop = 1e-3, s.march.refresh_every = 5, s.march.matrix_free_below = 2.0;
  Case whole = leaving_bump(s), first = leaving_bump(s), second = leaving_bump(s);
  for (Case* c : {&whole, &first, &second}) c->prepare();
  for (int n = 0; n < 4; ++n) whole.run();
  for (int n = 0; n < 2; ++n) first.run();
  carry_over(*first.solver, *second.solver);
  for (int n = 0; n < 2; ++n) second.run();
  CHECK(state_of(*whole.solver) == state_of(*second.solver));
}

namespace {
void same_bits_on(int ranks) {
  int rank;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  for (const KrylovMethod method : methods)
    for (const bool at_once : {false, true}) {
      FlowSetting s = turbulent_air();
      s.krylov = method, s.march.refresh_every = 2, s.march.max_steps = 6;
      const auto preconditioner = [&] { return at_once ? std::make_unique<ThroughCoarse>() : nullptr; };
      Case whole = leaving_bump(s, 1, 0, preconditioner()), part = leaving_bump(s, ranks, rank, preconditioner());
      whole.prepare();
      whole.run();
      part.prepare(MPI_COMM_WORLD, {.threads = 2});
      part.run();
      CHECK(fingerprint(*whole.solver) == fingerprint(*part.solver));
    }
}
}  // namespace

TEST_CASE("two ranks give every Krylov method the bits of one", "[flow][mpi2]") { same_bits_on(2); }
TEST_CASE("four ranks give every Krylov method the bits of one", "[flow][mpi4]") { same_bits_on(4); }
