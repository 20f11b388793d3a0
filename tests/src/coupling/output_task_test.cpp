// What outputs hand on is written beside the next replay, once and in order, and its failure is told afterwards.
// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/output_task.hpp"

#include <catch2/catch.hpp>

#include "runtime/executor/executor.hpp"
#include "src/io/machine_failure.hpp"

namespace spindrift::coupling {

namespace {

struct Replayed {
  OutputTask output;
  std::vector<int> written;
  runtime::Executor executor;
  explicit Replayed(int threads) : executor(graph(), {.threads = threads}) {}
  runtime::Graph graph() {
    runtime::Graph g;
    output.record(g);
    g.task("aero/step", {runtime::updates(g.datum())}, [] {});
    return g;
  }
  Writing write(int n) {
    return [this, n] { written.push_back(n); };
  }
};

}  // namespace

TEST_CASE("what outputs hand on is written in the next replay, once and in order", "[coupling][fast]") {
  Replayed run(GENERATE(1, 2));
  run.executor.run();
  CHECK(run.written.empty());
  run.output.hand_on(run.write(1)), run.output.hand_on({}), run.output.hand_on(run.write(2));
  CHECK(run.written.empty());
  run.executor.run();
  CHECK(run.written == std::vector<int>{1, 2});
  run.executor.run();
  run.output.write_now();
  CHECK(run.written == std::vector<int>{1, 2});
  run.output.hand_on(run.write(3));
  run.output.write_now();
  CHECK(run.written == std::vector<int>{1, 2, 3});
}

TEST_CASE("no task of a window waits for its output", "[coupling][fast]") {
  Replayed run(1);
  for (const runtime::Edge& e : run.executor.graph().edges()) CHECK(e.from == e.to);
}

TEST_CASE("output that fails leaves the window whole and the other outputs written, and is told after it", "[coupling][fast]") {
  Replayed run(2);
  run.output.hand_on([] { throw io::MachineFailure("no space left"); });
  run.output.hand_on([] { throw io::MachineFailure("nor here"); });
  run.output.hand_on(run.write(1));
  CHECK_NOTHROW(run.executor.run());
  CHECK(run.written == std::vector<int>{1});
  CHECK_THROWS_WITH(run.output.write_now(), "no space left");
  CHECK_NOTHROW(run.output.write_now());
}

}  // namespace spindrift::coupling
