// What a graph looks like to who writes one: a Krylov loop and a substep loop, each as it would stand in a book.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "runtime/executor/executor.hpp"

using namespace spindrift::runtime;

namespace {

constexpr std::size_t blocks = 8, cells = 16;  // of each block
using Block = std::vector<double>;
using Field = std::vector<Block>;

std::string tile(const char* what, std::size_t b) { return std::string(what) + "/" + std::to_string(b); }
std::size_t left(std::size_t b) { return b == 0 ? blocks - 1 : b - 1; }
std::size_t right(std::size_t b) { return b + 1 == blocks ? 0 : b + 1; }
double dot(const Block& a, const Block& b) { return std::inner_product(a.begin(), a.end(), b.begin(), 0.0); }
void add(Block& y, double a, const Block& x) {
  for (std::size_t i = 0; i < y.size(); ++i) y[i] += a * x[i];
}

/// q = (2.1 - left - right) p, periodic: the Laplacian shifted by 0.1.
void laplacian(const Field& p, std::size_t b, Block& q) {
  for (std::size_t i = 0; i < cells; ++i) {
    const double before = i == 0 ? p[left(b)].back() : p[b][i - 1];
    const double after = i + 1 == cells ? p[right(b)].front() : p[b][i + 1];
    q[i] = 2.1 * p[b][i] - before - after;
  }
}

/// Conjugate gradients (Hestenes & Stiefel 1952) for laplacian(x) = f, from x = 0.
struct ConjugateGradients {
  Field x, r, p, q;
  std::vector<double> partial_pq = std::vector<double>(blocks), partial_rr = std::vector<double>(blocks);
  double pq = 0, rr = 0, rr_before = 1;

  explicit ConjugateGradients(const Field& f) : x(blocks, Block(cells)), r(f), p(f), q(x) {
    for (const Block& b : f) rr += dot(b, b);
  }

  void record(Graph& g, double tolerance) {
    const auto dx = g.data(blocks), dr = g.data(blocks), dp = g.data(blocks), dq = g.data(blocks), dpq = g.data(blocks),
               drr = g.data(blocks);
    const Datum alpha = g.datum(), beta = g.datum();
    g.loop("air/krylov", {.min = 1, .max = 200, .urgency = 1}, [&] {
      for (std::size_t b = 0; b < blocks; ++b)
        g.task(tile("air/krylov/matvec", b),
               {reads(dp[left(b)]), reads(dp[b]), reads(dp[right(b)]), writes(dq[b]), writes(dpq[b])},
               [this, b] { laplacian(p, b, q[b]), partial_pq[b] = dot(p[b], q[b]); });
      g.reduce("air/krylov/pq", {reads(dpq), writes(alpha)}, {.partials = partial_pq, .result = {&pq, 1}});
      for (std::size_t b = 0; b < blocks; ++b)
        g.task(tile("air/krylov/residual", b),
               {reads(alpha), reads(beta), reads(dq[b]), reads(dp[b]), updates(dr[b]), updates(dx[b]), writes(drr[b])},
               [this, b] { add(r[b], -rr / pq, q[b]), add(x[b], rr / pq, p[b]), partial_rr[b] = dot(r[b], r[b]); });
      g.task("air/krylov/keep", {updates(beta)}, [this] { rr_before = rr; });
      g.reduce("air/krylov/rr", {reads(drr), updates(beta)}, {.partials = partial_rr, .result = {&rr, 1}});
      for (std::size_t b = 0; b < blocks; ++b)
        g.task(tile("air/krylov/direction", b), {reads(beta), reads(dr[b]), updates(dp[b])}, [this, b] {
          for (std::size_t i = 0; i < cells; ++i) p[b][i] = r[b][i] + rr / rr_before * p[b][i];
        });
      g.until("air/krylov/converged", {reads(beta)}, [this, tolerance] { return std::sqrt(rr) < tolerance; });
    });
  }
};

/// Heat equation by explicit substeps: no barrier, a block waits for its neighbours only.
struct Substeps {
  Field u, flux;

  explicit Substeps(const Field& start) : u(start), flux(blocks, Block(cells)) {}

  void record(Graph& g, std::uint32_t n, double step) {
    const auto du = g.data(blocks), dflux = g.data(blocks);
    g.repeat("sea/substeps", n, [&] {
      for (std::size_t b = 0; b < blocks; ++b)
        g.task(tile("sea/flux", b), {reads(du[left(b)]), reads(du[b]), reads(du[right(b)]), writes(dflux[b])},
               [this, b] { laplacian(u, b, flux[b]); });
      for (std::size_t b = 0; b < blocks; ++b)
        g.task(tile("sea/move", b), {reads(dflux[b]), updates(du[b])}, [this, b, step] { add(u[b], -step, flux[b]); });
    });
  }
};

Field wave() {
  Field f(blocks, Block(cells));
  for (std::size_t b = 0; b < blocks; ++b)
    for (std::size_t i = 0; i < cells; ++i) f[b][i] = std::sin(0.3 * double(b * cells + i)) + 0.01 * double(i * b);
  return f;
}

}  // namespace

TEST_CASE("a Krylov loop and a substep loop run side by side, each to its own end", "[runtime][fast]") {
  const Field f = wave();
  Field solution, heat;
  for (const int threads : {1, 2, 4, 8}) {
    ConjugateGradients solver(f);
    Substeps sea(f);
    Graph graph;
    solver.record(graph, 1e-10);
    sea.record(graph, 100, 0.1);
    Executor executor(std::move(graph), {.threads = threads});
    executor.run();

    double error = 0, difference = 0;
    Block q(cells);
    for (std::size_t b = 0; b < blocks; ++b) {
      laplacian(solver.x, b, q);
      for (std::size_t i = 0; i < cells; ++i) error = std::max(error, std::abs(q[i] - f[b][i]));
    }
    CHECK(error < 1e-9);
    CHECK(executor.cost(0).count == 1);

    Field expected = f, flux(blocks, Block(cells));
    for (int n = 0; n < 100; ++n) {
      for (std::size_t b = 0; b < blocks; ++b) laplacian(expected, b, flux[b]);
      for (std::size_t b = 0; b < blocks; ++b) add(expected[b], -0.1, flux[b]);
    }
    for (std::size_t b = 0; b < blocks; ++b)
      for (std::size_t i = 0; i < cells; ++i) difference = std::max(difference, std::abs(sea.u[b][i] - expected[b][i]));
    CHECK(difference == 0);

    if (threads == 1) solution = solver.x, heat = sea.u;
    CHECK(solver.x == solution);
    CHECK(sea.u == heat);
  }
}

TEST_CASE("the solver of one window can be replayed: the next starts from what the last left", "[runtime][fast]") {
  ConjugateGradients solver(wave());
  Graph graph;
  solver.record(graph, 1e-3);
  Executor executor(std::move(graph), {.threads = 2});
  executor.run();
  const double first = solver.rr;
  executor.run();
  CHECK(solver.rr < first);
}
