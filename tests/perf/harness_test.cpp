// Laws of perf/harness.hpp: order statistics, alternation of pairs, and the lines that perf/run reads.
// SPDX-License-Identifier: Apache-2.0
#include "perf/harness.hpp"

#include <catch2/catch.hpp>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

using namespace spindrift::perf;

TEST_CASE("quantiles interpolate between neighbours of the sorted samples", "[perf][fast]") {
  const std::vector<double> samples{5, 1, 3, 2, 4};
  CHECK(quantile(samples, 0.0) == 1.0);
  CHECK(quantile(samples, 0.5) == 3.0);
  CHECK(quantile(samples, 0.625) == 3.5);
  CHECK(spread(samples).quartile_1 == 2.0);
  CHECK(spread(samples).max == 5.0);
  CHECK(spread({7.0}).median == 7.0);
}

TEST_CASE("one outlier does not move the median", "[perf][fast]") { CHECK(spread({1, 1, 1, 1, 1e9}).median == 1.0); }

TEST_CASE("pairs are measured in alternating order after one warm-up of each", "[perf][fast]") {
  std::string order;
  const Spread ratio = paired_ratio([&] { order += 'n'; }, [&] { order += 'd'; }, 3);
  CHECK(order ==
        "nd"
        "nd"
        "dn"
        "nd");
  CHECK(ratio.samples == 3);
}

TEST_CASE("a measurement repeats its body until a sample is long enough", "[perf][fast]") {
  long calls = 0;
  const Spread times = measure([&] { ++calls; }, {.samples = 3, .warm_ups = 2, .sample_s = 1e-4});
  CHECK(calls > 100);  // an empty body takes nanoseconds
  CHECK(times.median < 1e-6);
}

TEST_CASE("figures and points are written as one JSON object a line", "[perf][fast]") {
  const std::string file = std::string(SPINDRIFT_BINARY_DIR) + "/harness_test.jsonl";
  std::string flag = "--figures", path = file, program = "perf_x";
  char* argv[] = {program.data(), flag.data(), path.data()};
  {
    Group group("x", 3, argv);
    group.at_most("time \"quoted\" \\", 1.5, "us", 2.0, Ceiling::stream, "note");
    group.figure("not finite", std::nan(""), "-");
    group.point("METG", "ours", 1, "task [us]", 0.5, "efficiency [-]");
  }
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  const auto first = nlohmann::json::parse(line);
  CHECK(first["name"] == "time \"quoted\" \\");
  CHECK(first["value"] == 1.5);
  CHECK(first["sense"] == "at most");
  CHECK(first["bar"] == 2.0);
  CHECK(first["ceiling"] == "stream");
  std::getline(in, line);
  const auto second = nlohmann::json::parse(line);
  CHECK(second["value"].is_null());
  CHECK(second["bar"].is_null());
  std::getline(in, line);
  CHECK(nlohmann::json::parse(line)["series"] == "ours");
  std::remove(file.c_str());
}

TEST_CASE("an unknown argument of a group is refused", "[perf][fast]") {
  std::string flag = "--figure", program = "perf_x";
  char* argv[] = {program.data(), flag.data()};
  CHECK_THROWS_WITH(Group("x", 2, argv), Catch::Contains("usage: perf_x [--figures FILE]"));
}
