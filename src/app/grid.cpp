// spindrift grid: makes the grid of a scene, a rotor's or that of a flow round walls, prints its quality, writes it as Plot3D
// with a neutral map file or as CGNS. SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <variant>

#include "src/aero/flow_grid.hpp"
#include "src/aero/flow_options.hpp"
#include "src/aero/grid/cgns.hpp"
#include "src/aero/grid/checks.hpp"
#include "src/aero/grid/neutral_map.hpp"
#include "src/aero/grid/plot3d.hpp"
#include "src/aero/grid/quality.hpp"
#include "src/aero/rotor_grid/quality.hpp"
#include "src/aero/rotor_grid/rotor_grid.hpp"
#include "src/app/commands.hpp"
#include "src/app/scene_file.hpp"
#include "src/coupling/rotor_defaults.hpp"
#include "src/coupling/scenario.hpp"
#include "src/scene/document.hpp"

namespace spindrift::app {

namespace {

/// Of a rotor.
struct Wanted {
  aero::RotorGridOptions options;
  aero::Turbine turbine;
  aero::RotorGridSpec spec;
};
using WantedGrid = std::variant<Wanted, aero::FlowOptions>;

/// A scene may be as short as [rotor] turbine and [aero.grid]; what else it has must be right, but need not be all that a run
/// needs.
WantedGrid read(scene::Document& document) {
  coupling::add_rotor_defaults(document);
  const aero::AeroOptions air = document.read(aero::aero_section());
  const aero::RotorOptions rotor = document.read(aero::rotor_section());
  const aero::WindOptions wind = document.read(aero::wind_section());
  for (const scene::SectionBase* section : coupling::all_sections())
    if (section->name() != "aero" && section->name() != "rotor" && section->name() != "wind") document.read_any(*section);
  if (air.flow && (air.flow->generate || !air.flow->grid.empty())) {
    document.finish();
    return *air.flow;
  }
  if (rotor.turbine.empty())
    document.problem("rotor.turbine",
                     "must name a turbine file, round whose blades the grid is made; or a flow has aero.flow.generate");
  const aero::RotorGridOptions options = air.grid.value_or(aero::RotorGridOptions());
  if (options.y_plus && rotor.speed == 0.0 && wind.speed_m_s == 0.0)
    document.problem("aero.grid.y_plus", "needs wind.speed_m_s or rotor.speed_rpm: y+ follows from the speed of the air");
  document.finish();
  aero::Turbine turbine = aero::read_turbine(rotor.turbine);
  const aero::RotorGridSpec spec = rotor_grid_spec(options, turbine, rotor.blade_pitch, rotor.speed, wind.speed_m_s);
  return Wanted{options, std::move(turbine), spec};
}

/// By the ending: .cgns, or .p3d and .xyz (binary), .p3dfmt (formatted), each with a .nmf beside it.
void write(const aero::MultiBlockGrid& grid, const std::filesystem::path& file) {
  if (file.extension() == ".cgns") {
    write_cgns(grid, file);
    fmt::print("written: {}\n", file.string());
    return;
  }
  write_plot3d(grid, file, file.extension() == ".p3dfmt" ? aero::Plot3dForm::formatted : aero::Plot3dForm::binary);
  std::filesystem::path map = file;
  write_neutral_map(grid, map.replace_extension(".nmf"));
  fmt::print("written: {} and {}\n", file.string(), map.string());
}

void make_and_write(const WantedGrid& asked, const GridArguments& arguments) {
  if (const auto* flow = std::get_if<aero::FlowOptions>(&asked)) {
    const aero::MultiBlockGrid grid = flow_grid(*flow);  // sound, or refused
    fmt::print("{}\n{}", describe_flow_grid(*flow), describe(grid_quality(grid), grid));
    for (const std::string& file : arguments.files) write(grid, file);
    return;
  }
  const Wanted& wanted = std::get<Wanted>(asked);
  const aero::MultiBlockGrid grid = make_rotor_grid(wanted.turbine, wanted.spec);
  const aero::RotorGridQuality quality = rotor_grid_quality(grid, {"blade_"});
  fmt::print("{}", describe_quality(grid, quality));
  require_quality(
      grid, quality,
      {.scaled_jacobian = wanted.options.least_scaled_jacobian, .non_orthogonality = wanted.options.most_off_orthogonal_deg});
  require_sound(grid, arguments.scene);
  for (const std::string& file : arguments.files) write(grid, file);
}

}  // namespace

int grid(const GridArguments& arguments, const runtime::World& world) {
  scene::Document document = load_scene(arguments.scene, arguments.overrides);
  by_lines(document, [&] {
    const WantedGrid asked = read(document);
    if (world.rank == 0) make_and_write(asked, arguments);
  });
  return done;
}

}  // namespace spindrift::app
