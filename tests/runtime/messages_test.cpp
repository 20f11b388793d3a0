// Messages and reductions as tasks, on two and four ranks: the numbers of one rank, without holding a thread.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <numeric>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "runtime/executor/executor.hpp"
#include "runtime/graph/recorded.hpp"

using namespace spindrift::runtime;

namespace {

int rank_of(MPI_Comm comm) {
  int rank;
  MPI_Comm_rank(comm, &rank);
  return rank;
}
int size_of(MPI_Comm comm) {
  int size;
  MPI_Comm_size(comm, &size);
  return size;
}

/// A chain of blocks dealt out to ranks, relaxed in place with the sum of all blocks fed back: messages both ways and a reduction
/// in every step. Gives the values of all blocks.
std::vector<double> relaxed_chain(MPI_Comm comm, int threads, std::uint32_t steps) {
  constexpr int blocks = 24;
  const int rank = rank_of(comm), ranks = size_of(comm);
  const auto owner = [&](int b) { return b * ranks / blocks; };
  std::vector<double> u(blocks), v(blocks), partial;
  std::vector<std::int64_t> mine;
  for (int b = 0; b < blocks; ++b) {
    u[std::size_t(b)] = std::sin(1.0 + b) * std::pow(10.0, b % 7);
    if (owner(b) == rank) mine.push_back(b);
  }
  partial.resize(mine.size());
  double sum = 0;

  Graph g(comm);
  const auto du = g.data(blocks), dv = g.data(blocks), dpartial = g.data(mine.size());
  const Datum dsum = g.datum();
  g.repeat("chain", steps, [&] {
    for (int b = 0; b < blocks; ++b)
      for (const int other : {b - 1, b + 1}) {
        if (other < 0 || other >= blocks || owner(other) == owner(b)) continue;
        const auto s = std::size_t(b);
        if (owner(b) == rank)
          g.send("chain/send/" + std::to_string(b), {reads(du[s])}, {owner(other), b, buffer_of(std::span(&u[s], 1))});
        if (owner(other) == rank)
          g.receive("chain/receive/" + std::to_string(b), {writes(du[s])}, {owner(b), b, buffer_of(std::span(&u[s], 1))});
      }
    for (const std::int64_t b : mine) {
      const auto s = std::size_t(b), before = s == 0 ? s : s - 1, after = s + 1 == blocks ? s : s + 1;
      g.task("chain/relax/" + std::to_string(b), {reads(du[before]), reads(du[s]), reads(du[after]), reads(dsum), writes(dv[s])},
             [&u, &v, &sum, s, before, after] { v[s] = 0.3 * u[before] + 0.4 * u[s] + 0.29 * u[after] + 1e-5 * sum; });
    }
    for (std::size_t n = 0; n < mine.size(); ++n) {
      const auto s = std::size_t(mine[n]);
      g.task("chain/move/" + std::to_string(s), {reads(dv[s]), writes(du[s]), writes(dpartial[n])},
             [&u, &v, &partial, s, n] { u[s] = partial[n] = v[s]; });
    }
    g.reduce("chain/sum", {reads(dpartial), writes(dsum)}, {.partials = partial, .result = {&sum, 1}});
  });
  Executor(std::move(g), {.threads = threads}).run(2);

  for (int b = 0; b < blocks; ++b) MPI_Bcast(&u[std::size_t(b)], 1, MPI_DOUBLE, owner(b), comm);
  u.push_back(sum);
  return u;
}

/// The first `n` ranks; MPI_COMM_NULL on the others.
MPI_Comm first_ranks(int n) {
  MPI_Comm comm;
  MPI_Comm_split(MPI_COMM_WORLD, rank_of(MPI_COMM_WORLD) < n ? 0 : MPI_UNDEFINED, 0, &comm);
  return comm;
}

void same_bits_on(int ranks) {
  const auto expected = relaxed_chain(MPI_COMM_SELF, 1, 30);
  for (int n = 1; n <= ranks; ++n)
    for (const int threads : {1, 2, 4, 8}) {
      if (threads > 2 && n != ranks) continue;  // ranks x threads on the two cores of a small machine
      MPI_Comm comm = first_ranks(n);
      if (comm == MPI_COMM_NULL) continue;
      INFO(n << " ranks, " << threads << " threads");
      CHECK(relaxed_chain(comm, threads, 30) == expected);
      MPI_Comm_free(&comm);
    }
  MPI_Barrier(MPI_COMM_WORLD);
}

}  // namespace

TEST_CASE("a chain with messages and sums has the same bits on 1 and 2 ranks with 1 to 8 threads", "[runtime][mpi2]") {
  same_bits_on(2);
}

TEST_CASE("a chain with messages and sums has the same bits on 1 to 4 ranks with 1 to 8 threads", "[runtime][mpi4]") {
  same_bits_on(4);
}

TEST_CASE("a long task that polls lets a large message pass meanwhile", "[runtime][mpi2]") {
  const int other = 1 - rank_of(MPI_COMM_WORLD);
  std::vector<double> out(1 << 20, other), in(1 << 20, -1);  // 8 MB: not sent before the receiver takes part
  Graph g(MPI_COMM_WORLD);
  const Datum dout = g.datum(), din = g.datum(), dlong = g.datum();
  bool came = false, came_during_task = false;
  g.send("exchange/send", {reads(dout)}, {other, 1, buffer_of(std::span(out))});
  g.receive("exchange/receive", {writes(din)},
            {other, 1, buffer_of(std::span(in)), [&](std::size_t bytes) { came = bytes == 8u << 20; }});
  g.task("long", {writes(dlong)}, [&] {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (!came && std::chrono::steady_clock::now() < end) poll_messages();
    came_during_task = came;
  });
  Executor executor(std::move(g), {.threads = 1});
  executor.run();
  CHECK(came_during_task);
  CHECK(in == std::vector<double>(1 << 20, 1 - other));
  CHECK(executor.bytes(1) == 8u << 20);
}

TEST_CASE("a rank that only waits for another's task waits, and does not complete messages", "[runtime][mpi2]") {
  const int rank = rank_of(MPI_COMM_WORLD);
  double value = 0.0;
  std::chrono::microseconds takes{0};
  Graph g(MPI_COMM_WORLD);
  const Datum d = g.datum();
  if (rank == 0) {
    g.task("work", {writes(d)}, [&takes] { std::this_thread::sleep_for(takes); });
    g.send("send", {reads(d)}, {1, 1, buffer_of(std::span(&value, 1))});
  } else {
    g.receive("receive", {writes(d)}, {0, 1, buffer_of(std::span(&value, 1))});
  }
  Executor executor(std::move(g), {.threads = 1});
  // Long enough to sleep between polls, and short enough to poll all the time. Medians: a busy machine takes processors away.
  for (const auto& [us, windows] : {std::pair(50'000, 9), std::pair(900, 101)}) {
    takes = std::chrono::microseconds(us);
    std::vector<double> waiting, completing;
    for (int window = 0; window < windows; ++window) {
      MPI_Barrier(MPI_COMM_WORLD);
      const ThreadTimes before = executor.times(0);
      executor.run();
      const ThreadTimes& now = executor.times(0);
      const double wall = double(now.wall_ns - before.wall_ns);
      waiting.push_back(double(now.idle_ns - before.idle_ns) / wall);
      completing.push_back(double(now.poll_ns - before.poll_ns) / wall);
    }
    if (rank == 0) continue;
    std::ranges::sort(waiting), std::ranges::sort(completing);
    INFO("a task of " << us << " us");
    CHECK(waiting[waiting.size() / 2] > 0.90);
    CHECK(completing[completing.size() / 2] < 0.05);
    CHECK(completing.front() > 0.0);  // one message came in each
  }
}

TEST_CASE("collective calls of a module run in the order of recording on every rank, whatever the schedule", "[runtime][mpi2]") {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    int sums[3] = {0, 0, 0};
    Graph g(MPI_COMM_WORLD);
    const auto d = g.data(3);
    for (std::size_t n = 0; n < 3; ++n)
      g.collective("library/" + std::to_string(n), {writes(d[n])}, [&sums, n](MPI_Comm comm) {
        const int mine = int(n) + 1;
        MPI_Allreduce(&mine, &sums[n], 1, MPI_INT, MPI_SUM, comm);
      });
    Executor(std::move(g), {.threads = 2, .random_schedule = seed + 100 * std::uint64_t(rank_of(MPI_COMM_WORLD))}).run(3);
    CHECK(sums[0] == 2);
    CHECK(sums[1] == 4);
    CHECK(sums[2] == 6);
  }
}

/// Two modules, each a loop of calls after work of random length, on ranks of one thread: calls in both orders are ready on
/// different ranks at once.
void calls_of_two_modules(std::uint64_t seed) {
  constexpr int steps = 12;
  std::vector<std::string> made;
  int sums[2] = {0, 0}, calls[2] = {0, 0};
  Graph g(MPI_COMM_WORLD);
  const int rank = rank_of(MPI_COMM_WORLD);
  std::minstd_rand draw(unsigned(seed * 31 + std::uint64_t(rank) + 1));
  const std::string modules[2] = {"air", "sea"};
  for (std::size_t m = 0; m < 2; ++m) {
    const Datum d = g.datum();
    g.repeat(modules[m] + "/steps", steps, [&] {
      g.task(modules[m] + "/work", {updates(d)}, [&draw, &calls, m] {
        ++calls[m];
        const auto end = std::chrono::steady_clock::now() + std::chrono::microseconds(draw() % 200);
        while (std::chrono::steady_clock::now() < end) {}
      });
      g.collective(
          modules[m] + "/library", {updates(d)},
          [&, m](MPI_Comm comm) {
            made.push_back(modules[m]);
            MPI_Allreduce(&calls[m], &sums[m], 1, MPI_INT, MPI_SUM, comm);
          },
          [&calls, m] { return calls[m] % 3 != 0; });
    });
  }
  for (const Edge& edge : g.edges()) CHECK(g.nodes()[edge.from].module() == g.nodes()[edge.to].module());
  Executor(std::move(g), {.threads = 1}).run(2);
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  CHECK(sums[0] == ranks * (2 * steps - 1));
  CHECK(sums[1] == ranks * (2 * steps - 1));
  CHECK(made.size() == 2 * 2 * steps * 2 / 3);
  // All ranks made them in one order.
  std::string order;
  for (const std::string& module : made) order += module[0];
  std::string first = order;
  MPI_Bcast(first.data(), int(first.size()), MPI_CHAR, 0, MPI_COMM_WORLD);
  CHECK(order == first);
}

TEST_CASE("collective calls of two modules find one order, and nothing else ties the modules together", "[runtime][mpi2]") {
  for (std::uint64_t seed = 0; seed < 20; ++seed) calls_of_two_modules(seed);
}
TEST_CASE("the same on four ranks", "[runtime][mpi4]") {
  for (std::uint64_t seed = 0; seed < 5; ++seed) calls_of_two_modules(seed);
}

TEST_CASE("a message may change its size from step to step", "[runtime][mpi2]") {
  const int rank = rank_of(MPI_COMM_WORLD);
  std::vector<double> particles(100);
  std::vector<std::size_t> sizes;
  std::size_t n = 0;
  Graph g(MPI_COMM_WORLD);
  const Datum d = g.datum();
  if (rank == 0) {
    g.task("count", {updates(d)}, [&] { ++n; });
    g.send("send", {reads(d)}, {1, 5, [&] { return std::as_writable_bytes(std::span(particles).first(n)); }});
  } else {
    g.receive("receive", {writes(d)},
              {0, 5, buffer_of(std::span(particles)), [&](std::size_t bytes) { sizes.push_back(bytes / 8); }});
  }
  Executor(std::move(g), {.threads = 2}).run(5);
  if (rank == 1) CHECK(sizes == std::vector<std::size_t>{1, 2, 3, 4, 5});
}

TEST_CASE("a reduction does not know the order of its parts", "[runtime][fast]") {
  const auto reduced = [](std::vector<double> partials, Reduction::Operation operation) {
    double result = 0;
    Graph g;
    const Datum d = g.datum();
    g.reduce("sum", {writes(d)}, {operation, partials, {&result, 1}});
    Executor(std::move(g), {.threads = 1}).run();
    return result;
  };
  using enum Reduction::Operation;
  std::vector<double> values = {-1e16, 1.0, 1.0, 1e16};
  do {
    CHECK(reduced(values, sum) == 2.0);
    CHECK(reduced(values, min) == -1e16);
    CHECK(reduced(values, max) == 1e16);
  } while (std::next_permutation(values.begin(), values.end()));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto operation : {sum, min, max})
    for (const std::vector<double>& bad : {std::vector{nan, 1.0, 2.0}, std::vector{1.0, nan, 2.0}, std::vector{1.0, 2.0, nan}})
      CHECK(std::isnan(reduced(bad, operation)));
  for (const std::vector<double>& zeros : {std::vector{0.0, -0.0}, std::vector{-0.0, 0.0}}) {
    CHECK(std::signbit(reduced(zeros, min)));
    CHECK_FALSE(std::signbit(reduced(zeros, max)));
  }
}

namespace {

/// Sums, least and greatest of numbers that lose digits in plain sums, dealt out to ranks by `owner`; two modules that reduce at
/// any time, each reduction more than once under way.
std::vector<double> reduced_over(MPI_Comm comm, const std::function<int(int)>& owner) {
  constexpr int parts = 40;
  const int rank = rank_of(comm);
  std::vector<double> partials;
  for (int p = 0; p < parts; ++p)
    if (owner(p) == rank)
      for (int c = 0; c < 3; ++c) partials.push_back(std::sin(3.0 * p + c) * std::pow(10.0, (7 * p + c) % 40 - 20));
  std::vector<double> air(9), sea(9);
  Graph g(comm);
  const Datum a = g.datum(), b = g.datum();
  using enum Reduction::Operation;
  int kind = 0;
  for (const auto operation : {sum, min, max}) {
    const std::string name = std::to_string(kind);
    g.reduce("air/" + name, {writes(a)}, {operation, partials, std::span(air).subspan(std::size_t(3 * kind), 3)});
    g.reduce("sea/" + name, {writes(b)}, {operation, partials, std::span(sea).subspan(std::size_t(3 * kind), 3)});
    ++kind;
  }
  CHECK(g.recorded().reductions_of.size() == 2);  // a communicator for each module, not for each reduction
  Executor(std::move(g), {.threads = 1}).run(50);
  CHECK(air == sea);
  return air;
}

}  // namespace

TEST_CASE("reductions have the same bits on 1 to 4 ranks, however parts are dealt out", "[runtime][mpi4]") {
  const auto expected = reduced_over(MPI_COMM_SELF, [](int) { return 0; });
  for (int ranks = 1; ranks <= 4; ++ranks) {
    MPI_Comm comm = first_ranks(ranks);
    if (comm == MPI_COMM_NULL) continue;
    CHECK(reduced_over(comm, [&](int p) { return p % ranks; }) == expected);
    CHECK(reduced_over(comm, [&](int p) { return p * ranks / 40; }) == expected);
    CHECK(reduced_over(comm, [&](int) { return ranks - 1; }) == expected);  // ranks without parts
    MPI_Comm_free(&comm);
  }
  MPI_Barrier(MPI_COMM_WORLD);
}

TEST_CASE("a message or reduction that nobody reads is not sent", "[runtime][mpi2]") {
  const int rank = rank_of(MPI_COMM_WORLD), other = 1 - rank;
  double out = 0.0, in = -1.0, sum = -1.0;
  std::vector<double> partial{0.0}, came, sums;
  int iteration = 0;
  Graph g(MPI_COMM_WORLD);
  const Datum count = g.datum(), mine = g.datum(), theirs = g.datum(), total = g.datum();
  const auto every_third = [&iteration] { return iteration % 3 == 0; };
  g.repeat("loop", 9, [&] {
    g.task("count", {updates(count), writes(mine)}, [&] { ++iteration, out = partial[0] = 10.0 * iteration + rank; });
    g.send("send", {reads(count), reads(mine)}, {other, 1, buffer_of(std::span(&out, 1)), {}, every_third});
    g.receive("receive", {reads(count), writes(theirs)},
              {other, 1, buffer_of(std::span(&in, 1)), [&](std::size_t) { came.push_back(in); }, every_third});
    g.reduce("sum", {reads(count), reads(mine), writes(total)},
             {.partials = partial, .result = {&sum, 1}, .active = every_third});
    g.task("keep", {reads(count), reads(theirs), reads(total)}, [&] { sums.push_back(sum); });
  });
  Executor(std::move(g), {.threads = 2}).run();
  CHECK(came == std::vector<double>{30.0 + other, 60.0 + other, 90.0 + other});
  CHECK(sums == std::vector<double>{-1.0, -1.0, 61.0, 61.0, 61.0, 121.0, 121.0, 121.0, 181.0});
}
