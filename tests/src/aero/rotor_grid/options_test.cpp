// [aero.grid]: what is read, what follows from one number, what is refused.
// SPDX-License-Identifier: Apache-2.0
#include "src/aero/rotor_grid/options.hpp"

#include <catch2/catch.hpp>
#include <filesystem>

#include "src/aero/options.hpp"
#include "src/scene/document.hpp"
#include "tests/src/aero/rotor_grid/example.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using Catch::Matchers::Contains;

namespace {

AeroOptions read(const std::string& text) {
  scene::Document doc = scene::parse(text, "test.toml", std::filesystem::temp_directory_path());
  const AeroOptions options = doc.read(aero_section());
  doc.finish();
  return options;
}

}  // namespace

TEST_CASE("the declaration of the rotor's grid is sound in itself", "[rotor_grid][fast]") {
  CHECK(rotor_grid_section().faults().empty());
  CHECK_FALSE(read("").grid);
}

TEST_CASE("one number sizes a grid, and each number may be given by itself", "[rotor_grid][fast]") {
  const AeroOptions aero = read("[aero.grid]\nresolution = 3\ncells_span = 50\ny_plus = 40\nsectors = 'one'\n");
  REQUIRE(aero.grid);
  const RotorGridSpec spec = rotor_grid_spec(*aero.grid, dtu(), 0.1, 0.925, 11.0);
  CHECK(spec.sizes.round == 120);
  CHECK(spec.sizes.layers == 30);
  CHECK(spec.sizes.upstream == 24);
  CHECK(spec.sizes.span == 50);
  CHECK(spec.hub_radius_m == Approx(5.0).margin(0.01));
  CHECK_FALSE(spec.whole);
  CHECK(spec.y_plus == 40.0);
  CHECK(spec.pitch == 0.1);
}

TEST_CASE("fewer blades have more cells between them", "[rotor_grid][fast]") {
  Turbine turbine = dtu();
  const auto beside = [&](int blades) {
    turbine.blades = blades;
    return rotor_grid_spec(*read("[aero.grid]\n").grid, turbine, 0.0, 1.0, 11.0).sizes.beside;
  };
  CHECK((beside(3) == 6 && beside(4) == 6 && beside(2) == 9 && beside(1) == 18));
}

TEST_CASE("sizes that no one asked for allow the coarsening asked for", "[rotor_grid][fast]") {
  const AeroOptions aero = read("[aero.grid]\nresolution = 2.3\ncoarsen = 2\nsectors = 'one'\n");
  const MultiBlockGrid grid = make_rotor_grid(dtu(), rotor_grid_spec(*aero.grid, dtu(), 0.2, 0.0, 0.0));
  CHECK(grid_quality(grid).scaled_jacobian.value > 0.0);
}

TEST_CASE("sizes that cannot be are refused", "[rotor_grid][fast]") {
  CHECK_THROWS_WITH(read("[aero.grid]\ncells_round = 41\n"), Contains("cells_round") && Contains("even"));
  CHECK_THROWS_WITH(read("[aero.grid]\ncells_round = 40\ncells_trailing_edge = 12\n"), Contains("quarter"));
  CHECK_THROWS_WITH(read("[aero.grid]\ny_plus = 1\nfirst_cell_m = 1e-5\n"), Contains("y_plus"));
  CHECK_THROWS_WITH(read("[aero.grid]\nresolution = 100\n"), Contains("resolution"));
}
