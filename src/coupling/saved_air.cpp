// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/saved_air.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <span>
#include <sstream>
#include <string_view>

#include "kernels/base/constants.hpp"
#include "src/aero/rotor_grid/options.hpp"
#include "src/coupling/air_file.hpp"
#include "src/coupling/saved_start.hpp"
#include "src/io/machine_failure.hpp"
#include "src/scene/printed.hpp"

namespace spindrift::coupling {

namespace {

constexpr const char *settings_name = "air/settings", *pose_name = "air/pose", *load_name = "air/load", *wind_name = "air/wind",
                     *rotor_load_name = "air/answer", *grid_name = "air/grid", *places_name = "air/places";

/// The parameters of a section as lines "heading.key = value"; of all keys where none are named.
void add_lines(std::string& lines, const scene::SectionBase& section, const std::string& heading, const void* options,
               std::initializer_list<std::string_view> keys = {}) {
  for (const scene::Parameter& p : section.parameters()) {
    if (keys.size() > 0 && std::find(keys.begin(), keys.end(), p.key) == keys.end()) continue;
    if (const std::string value = scene::printed(p, options); !value.empty())
      lines += fmt::format("{}.{} = {}\n", heading, p.key, value);
  }
}

/// Not how the march goes, only what flow it goes to.
std::string settings_of(const Scenario& s) {
  std::string lines = fmt::format("rotor.turbine = {}\n", std::filesystem::path(s.rotor.turbine).filename().string());
  add_lines(lines, aero::rotor_section(), "rotor", &s.rotor, {"blade_pitch_deg"});
  add_lines(lines, aero::wind_section(), "wind", &s.wind, {"speed_m_s", "direction_deg"});
  add_lines(lines, environment_section(), "environment", &s.environment, {"air_density_kg_m3"});
  add_lines(lines, aero::rotor_grid_section(), "aero.grid", &*s.aero.grid);
  add_lines(lines, aero::flow_section(), "aero.flow", &*s.aero.flow,
            {"blades", "temperature_K", "viscosity_Pa_s", "viscous", "turbulence", "flux", "limiter", "upwinding",
             "physical_far_field", "first_order_turbulence"});
  return lines;
}

/// What of the wind is not the same at all heights and times, one a line; nothing where it is.
std::string changes_of(const aero::WindOptions& wind) {
  std::string lines = "\n";  // an array of a file is not empty
  if (wind.law != WindLaw::uniform)
    add_lines(lines, aero::wind_section(), "wind", &wind,
              {"profile", "reference_height_m", "shear_exponent", "roughness_m", "least_height_m"});
  if (!wind.table.empty()) lines += "wind.table\n";
  if (wind.event) lines += "wind.event\n";
  if (wind.turbulence) lines += "wind.turbulence\n";
  return lines;
}

std::string read_lines(const io::CheckpointReader& file, const char* name) {
  const std::vector<std::byte> bytes = file.read<std::byte>(name);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// The first line of `a` that `b` has not, empty where there is none.
std::string missing(const std::string& a, const std::string& b) {
  std::istringstream lines(a);
  for (std::string line; std::getline(lines, line);)
    if (("\n" + b).find("\n" + line + "\n") == std::string::npos) return line;
  return "";
}

std::vector<double> moments_of(const aero::ResolvedRotor& rotor) {
  const auto& moments = rotor.made().moments;
  return {moments.begin(), moments.end()};
}

constexpr std::size_t load_numbers = 9;
void append(std::vector<double>& to, const aero::RotorLoad& l) {
  to.insert(to.end(),
            {l.thrust, l.torque, l.power, l.force.x(), l.force.y(), l.force.z(), l.moment.x(), l.moment.y(), l.moment.z()});
}
aero::RotorLoad load_at(const double* l) {
  return {.thrust = l[0], .torque = l[1], .power = l[2], .force = {l[3], l[4], l[5]}, .moment = {l[6], l[7], l[8]}};
}

/// Velocities of a tile's state, component by component, turned.
void turn(std::span<double> state, std::size_t cells, const Eigen::Matrix3d& by) {
  for (std::size_t i = 0; i < cells; ++i) {
    const Eigen::Vector3d v = by * Eigen::Vector3d(state[cells + i], state[2 * cells + i], state[3 * cells + i]);
    for (std::size_t d = 0; d < 3; ++d) state[(d + 1) * cells + i] = v[Eigen::Index(d)];
  }
}

}  // namespace

void write_air_settings(io::CheckpointCopy& copy, const Scenario& scenario) {
  const std::string lines = settings_of(scenario), wind = changes_of(scenario.wind);
  copy.write<std::byte>(settings_name, std::as_bytes(std::span(lines)));
  copy.write<std::byte>(wind_name, std::as_bytes(std::span(wind)));
}

ComputedLoads computed_loads(const aero::ResolvedRotor& rotor) {
  ComputedLoads computed{rotor.load(), {}};
  for (int b = 1; b <= rotor.made().blades(); ++b) computed.blades.push_back(rotor.blade_load(b));
  return computed;
}

SavedArray computed_loads_array(const ComputedLoads& computed, int rank) {
  std::vector<double> loads;
  append(loads, computed.rotor);
  for (const aero::RotorLoad& blade : computed.blades) append(loads, blade);
  SavedArray array{load_name, std::int64_t(loads.size()), {}};
  if (rank == 0) array.pieces.push_back({0, std::move(loads)});
  return array;
}

std::vector<SavedArray> rotor_arrays(const aero::ResolvedRotor& rotor, const ComputedLoads& computed, int rank) {
  const Eigen::Matrix3d attitude = rotor.pose().attitude().toRotationMatrix();
  std::vector<double> pose(attitude.data(), attitude.data() + 9);
  pose.push_back(rotor.pose().speed);
  std::vector<SavedArray> arrays{computed_loads_array(computed, rank)};
  for (auto& [name, values] : {std::pair{pose_name, pose}, std::pair{grid_name, moments_of(rotor)}}) {
    arrays.push_back({name, std::int64_t(values.size()), {}});
    if (rank == 0) arrays.back().pieces.push_back({0, values});
  }
  return arrays;
}

ComputedLoads computed_loads_in(const io::CheckpointReader& file, int blades) {
  std::vector<aero::RotorLoad> loads;
  const std::vector<double> saved = file.read<double>(load_name);
  for (std::size_t n = 0; n + load_numbers <= saved.size(); n += load_numbers) loads.push_back(load_at(saved.data() + n));
  if (loads.size() != 1 + std::size_t(blades))
    throw io::InputError(file.path().string() + ": has loads of another number of blades");
  return {loads[0], {loads.begin() + 1, loads.end()}};
}

SavedArray rotor_load_array(const SavedRotorLoad& saved, int rank) {
  std::vector<double> values;
  append(values, saved.load);
  values.push_back(saved.dt);
  SavedArray array{rotor_load_name, load_numbers + 1, {}};
  if (rank == 0) array.pieces.push_back({0, std::move(values)});
  return array;
}
SavedRotorLoad rotor_load_in(const io::CheckpointReader& file) {
  const std::vector<double> values = file.read<double>(rotor_load_name);
  return {load_at(values.data()), values[load_numbers]};
}

SavedArray rotor_places_array(const aero::ResolvedRotor& rotor, int rank) {
  std::vector<double> values;
  std::vector<const aero::RotorPlace*> places{&rotor.before(), &rotor.now()};
  if (rotor.solver().setting().time_order > 2) places.push_back(&rotor.long_before());
  for (const aero::RotorPlace* place : places) {
    const aero::RotorPose& p = place->pose;
    const Eigen::Vector4d q = p.hub.attitude.coeffs();
    values.insert(values.end(), p.hub.position.data(), p.hub.position.data() + 3);
    values.insert(values.end(), q.data(), q.data() + 4);
    values.insert(values.end(), {p.azimuth, p.speed, double(place->pitches.size())});
    values.insert(values.end(), place->pitches.begin(), place->pitches.end());
  }
  SavedArray array{places_name, std::int64_t(values.size()), {}};
  if (rank == 0) array.pieces.push_back({0, std::move(values)});
  return array;
}
std::optional<RotorPlaces> rotor_places_in(const io::CheckpointReader& file) {
  if (!file.has(places_name)) return {};
  const std::vector<double> values = file.read<double>(places_name);
  const double* from = values.data();
  RotorPlaces places;
  for (aero::RotorPlace* place : {&places.before, &places.now, &places.long_before}) {
    if (from == values.data() + values.size()) {
      *place = places.before;
      continue;
    }
    place->pose.hub.position = Eigen::Map<const Eigen::Vector3d>(from);
    place->pose.hub.attitude.coeffs() = Eigen::Map<const Eigen::Vector4d>(from + 3);
    place->pose.azimuth = from[7], place->pose.speed = from[8];
    const auto pitches = std::size_t(from[9]);
    place->pitches.assign(from + 10, from + 10 + pitches);
    from += 10 + pitches;
  }
  return places;
}

bool is_of_plain_wind(const io::CheckpointReader& file) { return read_lines(file, wind_name) == changes_of({}); }

namespace {
[[noreturn]] void refuse_air(const io::CheckpointReader& file, const Scenario& scenario, const std::string& why) {
  refuse_saved(scenario, {"start.air", scenario.start.air}, fmt::format("{}: {}", file.path().string(), why));
}
}  // namespace

io::CheckpointReader open_air(MPI_Comm comm, const Scenario& scenario) {
  io::CheckpointReader file = open_saved(comm, scenario, {"start.air", scenario.start.air});
  const auto refuse = [&](const std::string& why) { refuse_air(file, scenario, why); };
  if (!file.has(settings_name) || !file.has(wind_name) || !file.has(pose_name)) refuse("has no air of a resolved rotor");
  const auto require_alike = [&](const std::string& theirs, const std::string& ours, const char* otherwise) {
    if (const std::string there = missing(theirs, ours), here = missing(ours, theirs); !there.empty() || !here.empty())
      refuse(fmt::format("its air was made with {}, this scene has {}", there.empty() ? otherwise : there,
                         here.empty() ? otherwise : here));
  };
  require_alike(read_lines(file, settings_name), settings_of(scenario), "the default");
  if (!is_of_plain_wind(file)) require_alike(read_lines(file, wind_name), changes_of(scenario.wind), "none");
  return file;
}

ComputedLoads start_from(const io::CheckpointReader& file, const Scenario& scenario, aero::ResolvedRotor& rotor,
                         const aero::RotorPose& start) {
  const auto refuse = [&](const std::string& why) { refuse_air(file, scenario, why); };
  const std::vector<double> grid = file.read<double>(grid_name), mine = moments_of(rotor);
  for (std::size_t n = 0; n < mine.size(); ++n)
    if (!(std::abs(grid[n] - mine[n]) <= 1e-9 * std::abs(mine[2])) || grid[0] != mine[0])
      refuse(
          fmt::format("its grid is another one ({:.0f} nodes, here {:.0f}) although [aero.grid] is the same: the turbine's file "
                      "or the rotor's speed differs",
                      grid[0], mine[0]));
  require_same_tiles(file, rotor.store().tiling());
  const std::vector<double> pose = file.read<double>(pose_name);
  if (std::abs(pose[9] - start.speed) > 0.01 * std::abs(start.speed))
    refuse(fmt::format("its rotor turned at {:.4g} rpm, this one turns at {:.4g}", pose[9] / rad_s_per_rpm,
                       start.speed / rad_s_per_rpm));

  if (const std::optional<RotorPlaces> places = rotor_places_in(file)) {
    // Beyond, the flow that was saved does not fit the blades that it meets here.
    constexpr double most = 1.0 * radians_per_degree;
    for (const double pitch : places->now.pitches)
      if (std::abs(pitch) > most)
        refuse(fmt::format("its blades were pitched by {:.3g} degrees from where their grid is made, beyond {:g}",
                           pitch / radians_per_degree, most / radians_per_degree));
  }

  const Eigen::Matrix3d now = start.attitude().toRotationMatrix(), saved = Eigen::Map<const Eigen::Matrix3d>(pose.data());
  const bool turned = now != saved;  // where it is not, not a bit changes
  const Eigen::Matrix3d by = now * saved.transpose();
  aero::FlowSolver& solver = rotor.solver();
  const std::vector<aero::Tile>& tiling = rotor.store().tiling().tiles;
  std::int64_t cells = 0;
  std::vector<std::int64_t> first;
  for (const aero::Tile& tile : tiling) first.push_back(cells), cells += tile.count();
  const std::int64_t per_cell = file.size("flow/tiles") / cells;  // with its past, if it has one
  for (int n = 0; n < int(solver.tiles().size()); ++n) {
    const aero::FlowTile& tile = solver.tiles()[std::size_t(n)];
    const auto count = std::size_t(tile.box.count()), unknowns = std::size_t(tile.unknowns());
    std::vector<double> values(solver.restart().size(n), 0.0);
    const io::Slice<double> slice{first[std::size_t(tile.index)] * per_cell, std::span(values).first(count * unknowns)};
    file.read<double>("flow/tiles", std::span(&slice, 1));
    if (turned) turn(values, count, by);
    solver.restart().load(n, values);
  }
  solver.forget();
  ComputedLoads computed = computed_loads_in(file, rotor.made().blades());
  if (turned) {
    computed.rotor.force = by * computed.rotor.force, computed.rotor.moment = by * computed.rotor.moment;
    for (aero::RotorLoad& blade : computed.blades) blade.force = by * blade.force, blade.moment = by * blade.moment;
  }
  return computed;
}

}  // namespace spindrift::coupling
