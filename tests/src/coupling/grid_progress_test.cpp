// What a user hears while a large grid is made. SPDX-License-Identifier: Apache-2.0
#include "src/coupling/grid_progress.hpp"

#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <catch2/catch.hpp>
#include <sstream>

namespace spindrift::coupling {

TEST_CASE("a grid that takes long says every ten seconds what is made and what is left, a small one nothing",
          "[coupling][fast]") {
  std::ostringstream said;
  const std::shared_ptr<spdlog::logger> before = spdlog::default_logger();
  const auto logger = std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_st>(said));
  logger->set_pattern("%v");
  spdlog::set_default_logger(logger);
  double now = 100.0;
  const aero::GridProgress told = grid_progress([&now] { return now; });
  told("rotor grid", 0.5);
  now = 109.0, told("rotor grid", 0.9);
  CHECK(said.str().empty());
  now = 110.0, told("rotor grid", 0.25);
  now = 119.0, told("rotor grid", 0.4);
  CHECK(said.str() == "air: rotor grid, 25 % made, about 0:30 left\n");
  now = 121.0, told("tiles", 0.0);
  now = 131.0, told("wall distances", 0.1);
  now = 141.0, told("wall distances", 0.2);
  spdlog::set_default_logger(before);
  CHECK(said.str() ==
        "air: rotor grid, 25 % made, about 0:30 left\nair: tiles\nair: wall distances\nair: wall distances, 20 % made, about "
        "0:40 left\n");
}

}  // namespace spindrift::coupling
