// The Chrome trace read back by a JSON parser: slices, rows, arrows, counters.
// SPDX-License-Identifier: Apache-2.0
#include "runtime/trace/chrome.hpp"

#include <unistd.h>
#include <zlib.h>
#include <catch2/catch.hpp>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/runtime/trace/synthetic.hpp"

using namespace spindrift::runtime;
using namespace spindrift::runtime::testing;
using nlohmann::json;

namespace {

std::vector<json> events_of(const std::vector<RankTrace>& traces, const std::string& phase, ChromeOptions options = {}) {
  const std::string path = std::string(SPINDRIFT_BINARY_DIR) + "/chrome_test_" + std::to_string(getpid()) +
                           ".json";  // tests of one file may run side by side
  write_chrome_trace(traces, path, options);
  const json all = json::parse(std::ifstream(path));
  std::remove(path.c_str());
  std::vector<json> events;
  for (const json& event : all.at("traceEvents"))
    if (event.at("ph") == phase) events.push_back(event);
  return events;
}

}  // namespace

TEST_CASE("every record is a slice at its rank, row and time, its module as category", "[trace][fast]") {
  const auto slices = events_of(one_message(), "X");
  REQUIRE(slices.size() == 6);  // a, send, receive, b and two waits
  std::map<std::string, json> by_name;
  for (const json& slice : slices) by_name[slice["name"]] = slice;
  const json& b = by_name["sea/b"];
  CHECK(b["cat"] == "sea");
  CHECK(b["pid"] == 1);
  CHECK(b["tid"] == 0);
  CHECK(b["ts"].get<double>() == Approx(7.0));
  CHECK(b["dur"].get<double>() == Approx(5.0));
  CHECK(b["args"]["replay"] == 0);
  CHECK(by_name["aero/receive"]["tid"] == 10000);
  CHECK(by_name["aero/receive"]["args"]["peer"] == 0);
  CHECK(by_name["aero/receive"]["args"]["bytes"] == 64);
  CHECK(by_name["waiting"]["cat"] == "runtime");
}

TEST_CASE("arrows lead from a send to its receive and from module to module", "[trace][fast]") {
  const auto starts = events_of(one_message(), "s"), ends = events_of(one_message(), "f");
  REQUIRE(starts.size() == 2);
  REQUIRE(ends.size() == 2);
  for (std::size_t n = 0; n < 2; ++n) {
    CHECK(starts[n]["id"] == ends[n]["id"]);
    CHECK(ends[n]["bp"] == "e");
    CHECK(starts[n]["ts"].get<double>() <= ends[n]["ts"].get<double>());
  }
  CHECK(starts[0]["id"] != starts[1]["id"]);
  const auto message = starts[0]["name"] == "message" ? 0 : 1;
  CHECK(starts[message]["pid"] == 0);
  CHECK(starts[message]["ts"].get<double>() == Approx(4.0));
  CHECK(ends[message]["pid"] == 1);
  CHECK(ends[message]["ts"].get<double>() == Approx(6.999));
  CHECK(starts[1 - message]["name"] == "data between modules");  // aero/receive -> sea/b
  CHECK(ends[1 - message]["ts"].get<double>() == Approx(7.0));
}

TEST_CASE("data that a loop passes to another module has an arrow too", "[trace][fast]") {
  SyntheticRank rank(0);
  const auto loop = rank.node("sea/substeps", NodeKind::loop), x = rank.node("sea/x", NodeKind::task, loop),
             b = rank.node("bodies/b");
  rank.edge(loop, b);
  rank.ran(x, 0, 1, 0, 0, 0), rank.ran(x, 1, 2, 0, 0, 1), rank.ran(b, 2, 3);
  const auto starts = events_of({rank.trace(3)}, "s");
  REQUIRE(starts.size() == 1);
  CHECK(starts[0]["ts"].get<double>() == Approx(1.999));
}

TEST_CASE("messages that overlap get rows of their own", "[trace][fast]") {
  SyntheticRank rank(0);
  for (const int n : {0, 1, 2}) rank.ran(rank.message("m/r/" + std::to_string(n), NodeKind::receive, 0, n), n, n + 1.5);
  std::set<int> rows;
  for (const json& slice : events_of({rank.trace(5)}, "X")) rows.insert(slice["tid"].get<int>());
  CHECK(rows == std::set{10000, 10001});  // the third begins after the first ended
}

TEST_CASE("counters hold the busy time of each module", "[trace][fast]") {
  const auto counters = events_of(one_message(), "C", {.counter_bins = 24});
  double aero_us = 0, sea_us = 0;
  for (const json& counter : counters)
    if (counter["name"] == "busy threads") {
      aero_us += 0.5 * counter["args"].value("aero", 0.0);
      sea_us += 0.5 * counter["args"].value("sea", 0.0);
    }
  CHECK(aero_us == Approx(4.0));
  CHECK(sea_us == Approx(5.0));
}

TEST_CASE("labels are escaped and an empty trace is valid", "[trace][fast]") {
  SyntheticRank rank(0);
  rank.ran(rank.node("m/\"x\"\\\n"), 0, 1);
  CHECK(events_of({rank.trace(1)}, "X")[0]["name"] == "m/\"x\"\\ ");
  CHECK(events_of({}, "X").empty());
}

TEST_CASE("a path that ends with .gz gets the same text compressed", "[trace][fast]") {
  const std::string path = std::string(SPINDRIFT_BINARY_DIR) + "/chrome_test_" + std::to_string(getpid()) + ".json";
  const auto text = [&](const std::string& name) {
    write_chrome_trace(one_message(), name);
    std::string all(1 << 20, ' ');
    const gzFile file = gzopen(name.c_str(), "rb");  // reads text as it is
    const int size = gzread(file, all.data(), unsigned(all.size()));
    const bool compressed = gzdirect(file) == 0;
    gzclose(file);
    CHECK(compressed == name.ends_with(".gz"));
    std::remove(name.c_str());
    return all.substr(0, std::size_t(std::max(size, 0)));
  };
  const std::string plain = text(path);
  CHECK(json::accept(plain));
  CHECK(text(path + ".gz") == plain);
}

TEST_CASE("a file that cannot be written is an error that names it", "[trace][fast]") {
  CHECK_THROWS_WITH(write_chrome_trace({}, "/nonexistent/trace.json"), Catch::Contains("/nonexistent/trace.json: No such file"));
  CHECK_THROWS_WITH(write_chrome_trace(one_message(), "/dev/full"), Catch::Contains("/dev/full: No space left"));
}
