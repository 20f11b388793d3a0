// What a recording holds, and that it comes back from its file as it was. SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <catch2/catch.hpp>
#include <fstream>
#include <nlohmann/json.hpp>

#include "runtime/executor/executor.hpp"
#include "runtime/graph/sizes.hpp"
#include "runtime/replay/recording_file.hpp"
#include "runtime/trace/ledger.hpp"
#include "tests/runtime/random_program.hpp"
#include "tests/runtime/replay/graphs.hpp"

using namespace spindrift::runtime;
using namespace spindrift::runtime::testing;
using Catch::Contains;
using nlohmann::json;

namespace {

std::string file(const std::string& name) {
  return std::string(SPINDRIFT_BINARY_DIR) + "/" + name + "_" + std::to_string(getpid()) + ".jsonl";
}

/// A loop that ends by itself after five iterations, with a loop of two in it.
Graph small(int& left, MPI_Comm comm = MPI_COMM_SELF) {
  Graph g(comm);
  const Datum x = g.datum(0.25F), y = g.datum();
  g.task("aero/start", {writes(x), writes(y)}, [&left] { left = 5; });
  g.loop("sea/checks", {.min = 1, .urgency = 3}, [&] {
    g.task("sea/step", {updates(y)}, [&left] { --left; });
    g.repeat("sea/inner", 2, [&] { g.task("sea/inner/t", {updates(y)}, [] {}); });
    g.until("sea/until", {reads(y)}, [&left] { return left == 0; });
  });
  g.task("aero/end", {reads(x), reads(y)}, [] {});
  set_bytes(g, x, 640);
  return g;
}

}  // namespace

TEST_CASE("the windows asked for are recorded, every execution of every node in them", "[replay][fast]") {
  int left = 0;
  Ledger ledger;
  Executor executor(small(left), {.threads = 2, .records = 10000});
  for (int window = 1; window <= 5; ++window) {
    ledger.begin_window(window, window >= 2 && window <= 4 ? Ledger::Keep::runs : Ledger::Keep::nothing);
    ledger.on_all(window);
    executor.run();
    ledger.end_window();
  }
  const RankRecording rank = ledger.recording(0);
  REQUIRE(ledger.windows().size() == 3);
  CHECK(ledger.windows()[2].on_all_ns == 4);
  REQUIRE(rank.graphs.size() == 1);
  REQUIRE(rank.runs.size() == 3);
  const GraphRecord& graph = rank.graphs[0];
  for (std::size_t r = 0; r < 3; ++r) {
    const RunRecord& run = rank.runs[r];
    CHECK(run.window == std::int64_t(r) + 2);
    CHECK(run.replays == 1);
    std::int64_t sum = 0;
    for (std::size_t n = 0; n < graph.nodes.size(); ++n) {
      const std::string& label = graph.nodes[n].label;
      const std::size_t runs = label == "sea/step" ? 5 : label == "sea/inner/t" ? 10 : label == "sea/until" ? 5 : 1;
      if (graph.nodes[n].kind != NodeKind::loop) CHECK(run.ns[n].size() == runs);
      if (label == "sea/checks") CHECK(run.iterations[n] == std::vector<std::uint32_t>{5});
      if (label == "sea/inner") CHECK(run.iterations[n] == std::vector<std::uint32_t>(5, 2));
      for (const std::int64_t ns : run.ns[n]) sum += ns;
    }
    CHECK(run.task_ns == sum);
    CHECK(run.task_ns + run.idle_ns + run.poll_ns + run.overhead_ns == 2 * run.wall_ns);
    CHECK(run.wall_ns <= ledger.windows()[r].wall_ns);
  }
}

TEST_CASE("windows of which a record was lost are left out", "[replay][fast]") {
  int left = 0;
  Ledger ledger;
  Executor executor(small(left), {.threads = 1, .records = 60});  // of 22 tasks and some waits in each window
  for (int window = 1; window <= 5; ++window) {
    ledger.begin_window(window, Ledger::Keep::runs);
    executor.run();
    ledger.end_window();
  }
  const RankRecording rank = ledger.recording(0);
  CHECK(rank.runs.size() >= 1);
  CHECK(rank.runs.size() <= 2);
  for (const RunRecord& run : rank.runs) CHECK(run.ns[0].size() == 1);
}

TEST_CASE("a recording comes back from its file as it was", "[replay][fast]") {
  Ledger ledger;
  RandomProgram program(7, 12, 14, 2);
  Graph g;
  program.record(g);
  set_on_all(g, 3), set_in_parts(g, 4);
  Executor executor(std::move(g), {.threads = 2, .records = 100000});
  for (int window = 1; window <= 3; ++window) {
    ledger.begin_window(window, Ledger::Keep::runs);
    executor.run();
    ledger.end_window();
  }
  Recording recording{.scene = "a \"scene\"", .program = "test", .threads = 2, .windows = ledger.windows()};
  recording.windows.at(1).on_all_ns = 17;
  recording.ranks.push_back(ledger.recording(0));
  const std::string path = file("recording");
  write_recording(recording, path, MPI_COMM_SELF);
  const Recording back = read_recording(path);
  std::remove(path.c_str());
  CHECK(back.scene == recording.scene);
  CHECK(back.threads == 2);
  REQUIRE(back.windows.size() == 3);
  CHECK(back.windows[2].wall_ns == recording.windows[2].wall_ns);
  CHECK(back.windows[1].on_all_ns == 17);
  REQUIRE(back.ranks.size() == 1);
  REQUIRE(back.ranks[0].runs.size() == 3);
  for (std::size_t r = 0; r < 3; ++r) {
    CHECK(back.ranks[0].runs[r].ns == recording.ranks[0].runs[r].ns);
    CHECK(back.ranks[0].runs[r].iterations == recording.ranks[0].runs[r].iterations);
    CHECK(back.ranks[0].runs[r].overhead_ns == recording.ranks[0].runs[r].overhead_ns);
  }
  const GraphRecord &before = recording.ranks[0].graphs[0], &after = back.ranks[0].graphs[0];
  REQUIRE(after.nodes.size() == before.nodes.size());
  CHECK((before.nodes[3].on_all && std::ranges::count(before.nodes, true, &NodeRecord::on_all) == 1));
  CHECK((before.nodes[4].in_parts && std::ranges::count(before.nodes, true, &NodeRecord::in_parts) == 1));
  auto edges = before.edges;
  std::ranges::stable_sort(edges, {}, &Edge::to);
  CHECK(after.edges == edges);
  for (std::size_t n = 0; n < before.nodes.size(); ++n) {
    const NodeRecord &a = before.nodes[n], &b = after.nodes[n];
    CHECK((a.label == b.label && a.kind == b.kind && a.loop == b.loop && a.place == b.place && a.on_all == b.on_all &&
           a.in_parts == b.in_parts));
    CHECK((a.limits.min == b.limits.min && a.limits.max == b.limits.max && a.limits.urgency == b.limits.urgency));
    REQUIRE(a.uses.size() == b.uses.size());
    for (std::size_t u = 0; u < a.uses.size(); ++u)
      CHECK((a.uses[u].datum == b.uses[u].datum && a.uses[u].how == b.uses[u].how && a.uses[u].bytes == b.uses[u].bytes));
  }
}

TEST_CASE("lines say urgency, mean and spread over the windows, and bytes of edges", "[replay][fast]") {
  int left = 0;
  Graph graph = small(left);
  const Executor executor(std::move(graph), {.threads = 1, .watchdog_s = 0});
  Recording recording{.scene = "s", .program = "p"};
  RankRecording& rank = recording.ranks.emplace_back();
  rank.graphs.push_back(graph_record(executor.team()));
  const std::size_t nodes = rank.graphs[0].nodes.size();
  for (const std::int64_t ns : {100, 300}) {  // windows
    RunRecord& run = rank.runs.emplace_back();
    run.ns.resize(nodes), run.iterations.resize(nodes);
    run.ns[0] = {ns, ns};
  }
  const std::string path = file("lines");
  write_recording(recording, path, MPI_COMM_SELF);
  std::ifstream in(path);
  std::map<std::string, json> by_label;
  json header;
  for (std::string line; std::getline(in, line);) {
    const json object = json::parse(line);
    if (object.contains("format")) header = object;
    if (object.contains("label")) by_label[object["label"]] = object;
  }
  std::remove(path.c_str());
  CHECK(header["version"] == 2);
  const json& start = by_label.at("aero/start");
  CHECK(start["runs"] == 4);
  CHECK(start["mean_ns"] == 200.0);
  CHECK(start["spread_ns"] == 141.0);  // of 100 and 300: 200 / sqrt(2)
  CHECK(start["module"] == "aero");
  CHECK(start["urgency"] == 0);
  CHECK(start["place"] == 0.25);
  CHECK(by_label.at("sea/inner/t")["urgency"] == 3);
  CHECK(by_label.at("sea/inner/t")["mean_ns"] == 0.0);
  // aero/end waits for aero/start, of which it reads 640 bytes, and for the loop.
  CHECK(by_label.at("aero/end")["after"] == json::parse("[[0,0,640],[1,0,0]]"));
}

TEST_CASE("a recording says which reductions and calls were not needed", "[replay][fast]") {
  int iteration = 0;
  double partial = 1.0, sum = 0.0;
  const auto every_third = [&iteration] { return iteration % 3 == 0; };
  Graph g;
  const Datum count = g.datum(), total = g.datum(), made = g.datum();
  g.repeat("a/loop", 7, [&] {
    g.task("a/count", {updates(count)}, [&iteration] { ++iteration; });
    g.reduce("a/sum", {reads(count), writes(total)}, {.partials = {&partial, 1}, .result = {&sum, 1}, .active = every_third});
    g.collective(
        "a/call", {reads(count), writes(made)}, [](MPI_Comm) {}, every_third);
    g.reduce("a/always", {reads(count), reads(total)}, {.partials = {&partial, 1}, .result = {&sum, 1}});
  });
  Ledger ledger;
  Executor executor(std::move(g), {.threads = 1, .records = 1000});
  ledger.begin_window(1, Ledger::Keep::runs);
  executor.run();
  ledger.end_window();
  Recording recording{.scene = "s", .program = "p", .windows = ledger.windows()};
  recording.ranks.push_back(ledger.recording(0));
  const std::string path = file("skipped");
  write_recording(recording, path, MPI_COMM_SELF);
  const Recording back = read_recording(path);
  const std::map<std::uint32_t, std::vector<std::uint32_t>> expected{{2, {0, 1, 3, 4, 6}}, {3, {0, 1, 3, 4, 6}}};
  REQUIRE(recording.ranks[0].runs.size() == 1);
  CHECK(recording.ranks[0].runs[0].skipped == expected);
  CHECK(back.ranks[0].runs.at(0).skipped == expected);
  CHECK(back.ranks[0].runs[0].skips(2, 4));
  CHECK_FALSE(back.ranks[0].runs[0].skips(2, 5));
  CHECK_FALSE(back.ranks[0].runs[0].skips(4, 0));

  // A file of version 1 has no list: calls that took no time were skipped.
  std::ifstream in(path);
  std::string old;
  for (std::string line; std::getline(in, line);) {
    json object = json::parse(line);
    if (object.contains("format")) object["version"] = 1;
    object.erase("skipped");
    old += object.dump() + '\n';
  }
  std::ofstream(path) << old;
  const std::map<std::uint32_t, std::vector<std::uint32_t>> calls{{3, {0, 1, 3, 4, 6}}};
  CHECK(read_recording(path).ranks[0].runs.at(0).skipped == calls);
  std::remove(path.c_str());
}

TEST_CASE("what is no recording is refused by file and line", "[replay][fast]") {
  const auto refused = [](const std::string& text, const std::string& why) {
    const std::string path = file("refused");
    std::ofstream(path) << text;
    CHECK_THROWS_WITH(read_recording(path), Contains(path) && Contains(why));
    std::remove(path.c_str());
  };
  const std::string header =
      R"({"format":"spindrift recording","version":1,"scene":"","program":"","ranks":1,"threads":1,"windows":[]})";
  refused("", "is empty");
  refused("{\"a\": 1}\n", "line 1: is no recording");
  refused(R"({"format":"spindrift recording","version":9})", "version 9");
  refused(header + "\n{\"rank\":0,", "line 2");
  refused(
      header + "\n" + R"({"rank":0,"graph":0,"nodes":1,"data":[]})" + "\n" +
          R"({"rank":0,"graph":0,"node":0,"label":"a","kind":"task","loop":null,"place":null,"uses":[[4,"read"]],"after":[]})",
      "line 3: uses datum 4");
  const std::string graph = header + "\n" + R"({"rank":0,"graph":0,"nodes":1,"data":[]})" + "\n";
  const std::string run =
      R"({"rank":0,"run":0,"window":1,"graph":0,"replays":1,"begin_ns":0,"wall_ns":0,"task_ns":0,"idle_ns":0,)"
      R"("poll_ns":0,"overhead_ns":0,"iterations":[[]],"ns":[[5,5]],"skipped":)";
  refused(graph + run + "[[1,[0]]]}", "line 3: skips node 1");
  refused(graph + run + "[[0,[2]]]}", "line 3: skips executions of node 0");
  refused(graph + run + "[[0,[1,0]]]}", "line 3: skips executions of node 0");
  // Numbers that no integer holds, and counts that the file is too short for.
  refused(R"({"format":"spindrift recording","version":1e36})", "line 1: has the number 1e+36");
  refused(
      R"({"format":"spindrift recording","version":1,"scene":"","program":"","ranks":1000000000000,"threads":1,"windows":[]})",
      "line 1: has 1000000000000 ranks");
  refused(header + "\n" + R"({"rank":0,"graph":4000000000,"nodes":1,"data":[]})", "line 2: has 4000000000 graphs");
  refused(header + "\n" + R"({"rank":0,"graph":0,"nodes":-1,"data":[]})", "line 2: has 18446744073709551615 nodes");
  refused(header + "\n" + std::string(40, '[') + std::string(40, ']'), "line 2: is nested");
  CHECK_THROWS_WITH(read_recording("/nonexistent/x.jsonl"), Contains("/nonexistent/x.jsonl: No such file"));
  CHECK_THROWS_WITH(write_recording({.ranks = {RankRecording{}}}, "/nonexistent/x.jsonl", MPI_COMM_SELF),
                    Contains("/nonexistent/x.jsonl"));
}

TEST_CASE("a recording of two ranks has both, with messages", "[replay][fast][mpi2]") {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  Ledger ledger;
  Graph g(MPI_COMM_WORLD);
  const Datum out = g.datum(), in = g.datum();
  std::vector<double> sent(50, rank), got(50);
  int count = 0;
  double partial = 1.0, sum = 0.0;
  const auto second = [&count] { return count % 2 == 0; };
  const Datum total = g.datum();
  g.task("aero/pack", {writes(out)}, [&count] { ++count; });
  g.send("aero/send", {reads(out)}, {1 - rank, 7, buffer_of(std::span(sent)), {}, second});
  g.receive("aero/receive", {reads(out), writes(in)}, {1 - rank, 7, buffer_of(std::span(got)), {}, second});
  g.reduce("aero/sum", {reads(out), writes(total)}, {.partials = {&partial, 1}, .result = {&sum, 1}, .active = second});
  Executor executor(std::move(g), {.threads = 1, .records = 1000});
  for (int window = 1; window <= 2; ++window) {
    ledger.begin_window(window, Ledger::Keep::runs);
    executor.run();
    ledger.end_window();
  }
  Recording own{.scene = "s", .program = "p", .windows = ledger.windows()};
  own.ranks.push_back(ledger.recording(rank));
  const std::string path = std::string(SPINDRIFT_BINARY_DIR) + "/recording_of_two.jsonl";
  write_recording(own, path, MPI_COMM_WORLD);
  if (rank == 0) {
    const Recording all = read_recording(path);
    std::remove(path.c_str());
    REQUIRE(all.ranks.size() == 2);
    for (int r = 0; r < 2; ++r) {
      REQUIRE(all.ranks[std::size_t(r)].runs.size() == 2);
      const NodeRecord& receive = all.ranks[std::size_t(r)].graphs.at(0).nodes.at(2);
      CHECK(receive.kind == NodeKind::receive);
      CHECK(receive.peer == 1 - r);
      CHECK(receive.tag == 7);
      CHECK(receive.bytes == 400);  // of those that were made: the second window's
      for (const std::uint32_t n : {1u, 2u, 3u}) {
        CHECK(all.ranks[std::size_t(r)].runs[0].skips(n, 0));
        CHECK_FALSE(all.ranks[std::size_t(r)].runs[1].skips(n, 0));
      }
    }
  }
}
