// What scenes take: src/coupling/memory_limits.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/memory_limits.hpp"

#include <catch2/catch.hpp>

#include "src/scene/document.hpp"
#include "src/scene/error.hpp"

using namespace spindrift;
using namespace spindrift::coupling;
using Catch::Contains;

namespace {
Scenario scenario(const std::string& scene, const std::vector<std::string>& overrides = {}) {
  scene::Document document = scene::load(std::string(SPINDRIFT_SOURCE_DIR) + "/inputs/" + scene, overrides);
  return read_scenario(document);
}
void require(const std::string& scene, const std::vector<std::string>& overrides, double memory = 16e9) {
  require_memory(scenario(scene, overrides), memory);
}
}  // namespace

TEST_CASE("what no machine holds is named with the number that would fit", "[coupling][fast]") {
  const std::string tank = "validation/dam_break/koshizuka_oka.toml", platform = "leble_barakos/case3_engineering.toml";
  CHECK_NOTHROW(require(tank, {}));
  CHECK_NOTHROW(require(platform, {}));
  CHECK_THROWS_WITH(require(tank, {"sea.particles.spacing_m=1e-9"}), Contains("sea.particles.spacing_m") && Contains("at least"));
  CHECK_THROWS_WITH(require(tank, {"sea.tank.top_m=1e12"}), Contains("sea.tank.top_m") && Contains("at most"));
  CHECK_THROWS_WITH(require(tank, {"sea.particles.spacing_m=2e-6"}, 1e16), Contains("at most 4e+09 can be told apart"));
  CHECK_THROWS_WITH(require(platform, {"sea.strip_length_m=1e-12"}), Contains("sea.strip_length_m") && Contains("at least"));
  CHECK_THROWS_WITH(require("validation/cylinder_low_mach/cylinder.toml", {}, 1e6), Contains("aero.flow.generate.around"));
}

TEST_CASE("the number that would fit does", "[coupling][fast]") {
  const Scenario tank = scenario("validation/dam_break/koshizuka_oka.toml", {"sea.particles.spacing_m=1e-6"});
  const Demand demand = demands_of(tank, 16e9).at(0);
  REQUIRE(demand.that_fits.starts_with("at least "));
  CHECK_NOTHROW(require("validation/dam_break/koshizuka_oka.toml", {"sea.particles.spacing_m=" + demand.that_fits.substr(9)}));
}
