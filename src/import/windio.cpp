// Keys and units: windIO 1.x, windIO/turbine/IEAontology_schema.yaml (lengths in m, angles in rad, spans over the blade's
// length). SPDX-License-Identifier: Apache-2.0
#include "src/import/windio.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>

#include "kernels/base/constants.hpp"
#include "kernels/base/interpolation.hpp"
#include "src/import/deck_import.hpp"
#include "src/import/windio_file.hpp"
#include "src/import/windio_tower.hpp"

namespace spindrift::decks {

namespace {

/// The monotone cubic through thicknesses, by which WISDEM blends polars between the positions of two.
std::vector<double> monotone_at(const Curve& c, const std::vector<double>& x) {
  std::vector<double> slope(c.x.size()), values;
  monotone_slopes(c.x, c.y, slope);
  for (const double s : x) values.push_back(interpolate_hermite(c.x, c.y, slope, s).value);
  return values;
}

/// Where one polar holds or begins to give way to the next one.
struct Position {
  double span;
  std::string airfoil;
  double place;  ///< thickness_pct or number of the turbine file
};

struct Foil {
  Key key;
  double thickness;
};

/// The polars of each stretch of one name, told apart by their thickness where it falls from root to tip, else by number.
bool place_by_thickness(std::vector<Position>& positions, const std::map<std::string, Foil>& foils) {
  bool falls = true;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    positions[i].place = 100.0 * foils.at(positions[i].airfoil).thickness;
    if (i > 0 && positions[i].airfoil != positions[i - 1].airfoil) falls &= positions[i].place < positions[i - 1].place;
  }
  if (falls) return true;
  int number = 1;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (i > 0 && positions[i].airfoil != positions[i - 1].airfoil) ++number;
    positions[i].place = number;
  }
  return false;
}

/// Of a section, by Reynolds number; zero where there is one polar. A map, for nodes of YAML must not be assigned to each other.
/// Of several configurations, such as free and fixed transition, the first counts.
std::map<double, Key> polars_of(const Foil& foil) {
  const std::vector<Key> entries = foil.key.at("polars").entries();
  std::map<double, Key> polars;
  for (const Key& entry : entries) {
    const double reynolds = entries.size() == 1 ? 0.0 : entry.at("re").positive();
    const auto [first, added] = polars.try_emplace(reynolds, entry);
    if (!added && (!entry.has("configuration") || !first->second.has("configuration") ||
                   entry.at("configuration").text() == first->second.at("configuration").text()))
      entry.at("re").fail("is the Reynolds number of another polar of this airfoil");
  }
  if (polars.size() == 1) return {{0.0, polars.begin()->second}};
  return polars;
}

void write_polar(const Key& polar, const std::filesystem::path& file, const std::string& head) {
  Curve lift = curve(polar.at("c_l")), drag = curve(polar.at("c_d"));
  for (const auto& [curve, name] : {std::pair{&lift, "c_l"}, std::pair{&drag, "c_d"}}) {
    constexpr double rounding = 2e-3;  // files have -3.141 to 3.141
    if (std::abs(curve->x.front() + pi) > rounding || std::abs(curve->x.back() - pi) > rounding)
      polar.at(name).at("grid").fail(
          fmt::format("must go from -pi to pi rad, goes from {:g} to {:g}", curve->x.front(), curve->x.back()));
    curve->x.front() = -pi, curve->x.back() = pi;
  }
  for (std::size_t i = 0; i < drag.y.size(); ++i)
    if (drag.y[i] < 0.0) polar.at("c_d").at("values").entries()[i].fail("drag must not be negative");
  std::vector<double> angles;
  std::set_union(lift.x.begin(), lift.x.end(), drag.x.begin(), drag.x.end(), std::back_inserter(angles));
  std::ofstream csv(file);
  csv << head << "alpha_deg,cl,cd\n";
  for (const double a : angles) csv << fmt::format("{:.9g},{:.9g},{:.9g}\n", a / radians_per_degree, lift.at(a), drag.at(a));
}

struct Operating {
  double rated_wind = 0.0;  ///< where the greatest speed is reached at the tip-speed ratio, or rated power before [m/s]
  double least = 0.0, most = 0.0, ratio = 0.0;  ///< speeds of the rotor [rad/s]; tip speed over wind
  double cut_in = 0.0;                          ///< [m/s]
  bool ends_at_power = false;
};

Operating read_operating(const Key& control, double tip_radius, std::optional<double> rated_wind) {
  const Key torque = control.at("torque"), supervisory = control.at("supervisory");
  Operating o;
  o.least = torque.at("VS_minspd").number(), o.most = torque.at("VS_maxspd").positive(), o.ratio = torque.at("tsr").positive();
  o.cut_in = supervisory.at("Vin").positive();
  if (o.least < 0.0) torque.at("VS_minspd").fail("must not be negative");
  if (o.most <= o.least) torque.at("VS_maxspd").fail(fmt::format("must be more than VS_minspd = {:g}", o.least));
  // Some files have limits of their own under supervisory, and a ceiling that is never reached above.
  const auto limit = [&](const char* key) {
    return supervisory.has(key) ? std::optional<double>(supervisory.at(key).positive()) : std::nullopt;
  };
  o.least = std::max(o.least, limit("minOmega").value_or(0.0));
  o.most = std::min(o.most, limit("maxOmega").value_or(o.most));
  o.most = std::min(o.most, limit("maxTS").value_or(o.most * tip_radius) / tip_radius);
  if (o.most <= o.least)
    supervisory.fail(fmt::format("speeds must be from {:g} rad/s up, of which maxOmega and maxTS leave {:g}", o.least, o.most));
  o.rated_wind = o.most * tip_radius / o.ratio;
  if (rated_wind && *rated_wind < o.rated_wind) o.rated_wind = *rated_wind, o.ends_at_power = true;
  if (o.rated_wind <= o.cut_in)
    supervisory.at("Vin").fail(
        fmt::format("must be below the wind at which the greatest speed is reached, {:g} m/s", o.rated_wind));
  return o;
}

/// What the blade is made of, along its span from 0 at the root to 1 at the tip.
struct Blade {
  int count = 3;
  double hub_radius = 0.0, cone = 0.0;   ///< [m], [rad]
  Curve chord, twist, out, bend, sweep;  ///< [m], [rad], the axis's z, x and y [m]
  std::vector<Position> positions;
  bool by_thickness = true;

  /// Of the tip from the shaft [m]. A windIO blade bends upwind with negative x, and cone leans it there.
  double tip_radius() const { return (hub_radius + out.y.back()) * std::cos(cone) + bend.y.back() * std::sin(cone); }
};

/// The rotor's place and the air round it.
struct Site {
  double hub_height = 0.0, overhang = 0.0, tilt = 0.0;  ///< [m], [m], [rad]
  double density = 0.0, viscosity = 0.0;                ///< [kg/m3], [Pa s]
};

void require_upwind(const Key& assembly) {
  if (!assembly.has("rotor_orientation")) return;
  const Key side = assembly.at("rotor_orientation");
  if (side.text() != "Upwind" && side.text() != "upwind") side.fail("must be Upwind");
}

std::map<std::string, Foil> read_foils(const Key& list) {
  std::map<std::string, Foil> foils;
  for (const Key& foil : list.entries()) {
    const double thickness = foil.at("relative_thickness").positive();
    if (thickness > 1.0) foil.at("relative_thickness").fail("must be at most 1: over the chord");
    if (!foils.try_emplace(foil.at("name").text(), Foil{foil, thickness}).second) foil.at("name").fail("is there twice");
  }
  return foils;
}

std::vector<Position> read_positions(const Key& where, const std::map<std::string, Foil>& foils) {
  const std::vector<Key> labels = where.at("labels").entries();
  const std::vector<double> spans = numbers(where.at("grid"));
  require_increasing(where.at("grid"), spans), require_whole_span(where.at("grid"), spans);
  if (labels.size() != spans.size())
    where.at("labels").fail(fmt::format("has {} entries, grid has {}", labels.size(), spans.size()));
  std::vector<Position> positions;
  for (std::size_t i = 0; i < spans.size(); ++i) {
    if (!foils.contains(labels[i].text())) labels[i].fail("is the name of no entry of airfoils");
    positions.push_back({spans[i], labels[i].text(), 0.0});
  }
  return positions;
}

Blade read_blade(const Key& top, const std::map<std::string, Foil>& foils) {
  const Key shape = top.at("components").at("blade").at("outer_shape_bem"), axis = shape.at("reference_axis"),
            hub = top.at("components").at("hub");
  Blade b{.count = top.at("assembly").at("number_of_blades").count(),
          .hub_radius = 0.5 * hub.at("diameter").positive(),
          .cone = hub.at("cone_angle").angle(),
          .chord = along_span(shape.at("chord")),
          .twist = along_span(shape.at("twist")),
          .out = along_span(axis.at("z")),
          .bend = along_span(axis.at("x")),
          .sweep = along_span(axis.at("y")),
          .positions = read_positions(shape.at("airfoil_position"), foils)};
  for (std::size_t i = 0; i < b.chord.y.size(); ++i)
    if (b.chord.y[i] <= 0.0) shape.at("chord").at("values").entries()[i].fail("a chord must be > 0 m");
  for (std::size_t i = 0; i < b.twist.y.size(); ++i) shape.at("twist").at("values").entries()[i].angle();
  for (std::size_t i = 1; i < b.out.y.size(); ++i)
    if (b.out.y[i] <= b.out.y[i - 1]) axis.at("z").at("values").entries()[i].fail("must be more than the entry before it");
  b.by_thickness = place_by_thickness(b.positions, foils);
  return b;
}

Site read_site(const Key& top) {
  const Key train = top.at("components").at("nacelle").at("drivetrain"), air = top.at("environment");
  return {.hub_height = top.at("assembly").at("hub_height").positive(),
          .overhang = train.at("overhang").positive(),
          .tilt = train.at(train.has("uptilt_angle") ? "uptilt_angle" : "uptilt").angle(),
          .density = air.at("air_density").positive(),
          .viscosity = air.at("air_dyn_viscosity").positive()};
}

/// Where any of the curves has an entry, which a file may have on grids of their own, and where polars stand.
std::vector<double> stations_of(const Blade& b) {
  std::vector<double> stations;
  for (const Curve* c : {&b.chord, &b.twist, &b.out, &b.bend, &b.sweep})
    stations.insert(stations.end(), c->x.begin(), c->x.end());
  for (const Position& p : b.positions) stations.push_back(p.span);
  std::sort(stations.begin(), stations.end());
  constexpr double same = 1e-6;  // of the blade's length
  stations.erase(std::unique(stations.begin(), stations.end(), [](double x, double y) { return y - x < same; }), stations.end());
  stations.back() = 1.0;
  return stations;
}

/// Sweep in the file is positive towards the trailing edge, in the planform towards the leading one.
void write_planform(const Blade& b, const std::vector<double>& stations, const std::filesystem::path& file,
                    const std::string& head) {
  Curve along;
  for (const Position& p : b.positions) along.x.push_back(p.span), along.y.push_back(p.place);
  const std::vector<double> place = monotone_at(along, stations);
  std::ofstream planform(file);
  planform << head << "span_m,chord_m,twist_deg," << (b.by_thickness ? "thickness_pct" : "polar") << ",prebend_m,sweep_m\n";
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const double s = stations[i];
    planform << fmt::format("{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", b.hub_radius + b.out.at(s), b.chord.at(s),
                            b.twist.at(s) / radians_per_degree, place[i], b.bend.at(s), -b.sweep.at(s));
  }
}

/// Writes the blade's polars, one file to a Reynolds number of a stretch of one airfoil. Returns the lines that name them in the
/// turbine file.
std::string write_polars(const Blade& b, const std::map<std::string, Foil>& foils, const std::filesystem::path& folder,
                         const std::string& head) {
  std::string lines;
  int stretches = 0;
  for (std::size_t i = 0; i < b.positions.size(); ++i) {
    const Position& here = b.positions[i];
    if (i > 0 && here.airfoil == b.positions[i - 1].airfoil) continue;
    ++stretches;
    const std::map<double, Key> polars = polars_of(foils.at(here.airfoil));
    const bool one = polars.size() == 1;
    int n = 0;
    for (const auto& [reynolds, polar] : polars) {
      const std::string name = one ? fmt::format("polar_{}.csv", stretches) : fmt::format("polar_{}_{}.csv", stretches, ++n);
      write_polar(polar, folder / name, fmt::format("{}# {}.\n", head, here.airfoil));
      lines += fmt::format("  {{ {} = {:.9g}, {}file = \"{}\" }},\n", b.by_thickness ? "thickness_pct" : "number", here.place,
                           one ? "" : fmt::format("reynolds = {:.9g}, ", reynolds), name);
    }
  }
  return lines;
}

/// Some airfoil of the blade has polars at several Reynolds numbers.
bool depends_on_reynolds(const Blade& b, const std::map<std::string, Foil>& foils) {
  return std::ranges::any_of(b.positions, [&](const Position& p) { return polars_of(foils.at(p.airfoil)).size() > 1; });
}

void write_operation(const Operating& o, double tip_radius, const std::filesystem::path& file, const std::string& head) {
  std::ofstream table(file);
  table << head << "# Tip-speed ratio " << fmt::format("{:g}", o.ratio)
        << " between the least and the greatest speed, up to the wind at which "
        << (o.ends_at_power ? "blade elements have rated power" : "that is reached") << ".\nwind_m_s,speed_rpm,blade_pitch_deg\n";
  constexpr int rows = 32;
  for (int n = 0; n <= rows; ++n) {
    const double wind = o.cut_in + (o.rated_wind - o.cut_in) * n / rows,
                 speed = std::clamp(o.ratio * wind / tip_radius, o.least, o.most);
    table << fmt::format("{:.9g},{:.9g},0\n", wind, speed / rad_s_per_rpm);
  }
}

/// The shaft of an upwind rotor points down the wind and down: its axis leans by the tilt.
void write_scene(const Site& site, const Operating& o, bool by_reynolds, const std::string& tower,
                 const std::filesystem::path& file, const std::string& head) {
  std::ofstream scene(file);
  scene << head << "# The rotor stands in the wind at which "
        << (o.ends_at_power ? "it has rated power" : "its greatest speed is reached") << ".\n"
        << "[time]\nend_s = 10.0\nwindow_s = 0.5\nstep_s = 0.05\n\n"
        << "[bodies.turbine]  # it does not move: its mass does not matter\nmass_kg = 1e6\ninertia_kg_m2 = [1e9, 1e9, 1e9]\n"
        << fmt::format("centre_m = [0.0, 0.0, {:.9g}]\n\n", site.hub_height)
        << "[joints.foundation]\ntype = \"fixed\"\nbodies = [\"earth\", \"turbine\"]\npoint_m = [0.0, 0.0, 0.0]\n\n"
        << fmt::format("[environment]\nair_density_kg_m3 = {:.9g}\n\n[wind]\nspeed_m_s = {:.9g}\n\n", site.density, o.rated_wind)
        << "[aero]\nmodel = \"bem\"\n"
        << (by_reynolds ? fmt::format("kinematic_viscosity_m2_s = {:.9g}\n", site.viscosity / site.density) : "") << tower << "\n"
        << fmt::format(
               "[rotor]\nbody = \"turbine\"\nturbine = \"turbine.toml\"\nhub_m = [{:.9g}, 0.0, {:.9g}]\n"
               "axis = [{:.9g}, 0.0, {:.9g}]\noperating_point = \"table\"\n",
               -site.overhang, site.hub_height, std::cos(site.tilt), -std::sin(site.tilt));
}

/// What the rotor may take for the generator's rated power, over the gear's losses.
std::optional<double> rated_power(const Key& top) {
  const Key assembly = top.at("assembly"), control = top.at("control").at("supervisory");
  if (!assembly.has("rated_power") && !control.has("rated_power")) return std::nullopt;
  const double power = (assembly.has("rated_power") ? assembly : control).at("rated_power").positive();
  const Key train = top.at("components").at("nacelle").at("drivetrain");
  return train.has("gearbox_efficiency") ? power / train.at("gearbox_efficiency").positive() : power;
}

bool has_shape(const Key& tower) { return tower.has("outer_shape_bem"); }

void tell_left_out(const Key& top, const Blade& b, const std::map<std::string, Foil>& foils, std::vector<std::string>& left_out) {
  if (std::ranges::any_of(b.positions, [&](const Position& p) {
        const Foil& foil = foils.at(p.airfoil);
        return polars_of(foil).size() < foil.key.at("polars").entries().size();
      }))
    left_out.push_back("polars of an airfoil at the Reynolds number of one before: each has its first configuration");
  const Key assembly = top.at("assembly"), parts = top.at("components");
  if (assembly.has("rotor_diameter")) {
    const double said = assembly.at("rotor_diameter").positive();
    if (std::abs(2.0 * b.tip_radius() / said - 1.0) > 1e-3)
      left_out.push_back(fmt::format("assembly.rotor_diameter {:g} m: the blade's axis, hub and cone give {:.2f} m", said,
                                     2.0 * b.tip_radius()));
  }
  if (std::ranges::any_of(b.sweep.y, [](double y) { return y != 0.0; }))
    left_out.push_back("sweep of the blades stands in the planform; blade elements do not use it");
  left_out.push_back("outlines of the airfoils and their pitch axis: a resolved blade needs [turbine] aerofoils");
  left_out.push_back("masses of blades, hub and nacelle, and what bends: the rotor stands in the scene");
  left_out.push_back("pitch above rated wind and the controller: the file gives no pitch table");
  for (const char* part : {"pitch", "torque", "supervisory"})
    if (const Key control = top.at("control"); control.has(part) && control.at(part).has("ps_percent"))
      if (const double share = control.at(part).at("ps_percent").positive(); share < 1.0)
        left_out.push_back(
            fmt::format("peak shaving, ps_percent {:g}: thrust near rated wind is that of unpitched blades", share));
  if (parts.has("tower") && !has_shape(parts.at("tower"))) left_out.push_back("components.tower, which has no outer_shape_bem");
  for (const char* part : {"monopile", "floating_platform", "mooring"})
    if (parts.has(part)) left_out.push_back(fmt::format("components.{}", part));
}

std::vector<std::string> carried_over(const Blade& b, std::size_t stations, const Site& site, const Operating& o,
                                      bool by_reynolds) {
  std::vector<std::string> carried{
      fmt::format("{} blades of {} stations from {:g} to {:g} m, cone {:g} degrees, prebend {:g} m", b.count, stations,
                  b.hub_radius, b.hub_radius + b.out.y.back(), b.cone / radians_per_degree, b.bend.y.back()),
      fmt::format("hub {:g} m above the sea, {:g} m ahead of the tower, tilt {:g} degrees", site.hub_height, site.overhang,
                  site.tilt / radians_per_degree),
      fmt::format("operation at tip-speed ratio {:g} from {:g} to {:.4g} m/s, where {}", o.ratio, o.cut_in, o.rated_wind,
                  o.ends_at_power ? "blade elements have rated power" : "its greatest speed is reached")};
  if (by_reynolds) carried.push_back("polars at all their Reynolds numbers");
  if (!b.by_thickness)
    carried.push_back("polars by number, which column polar of the planform names: thickness does not fall from root to tip");
  return carried;
}

}  // namespace

Imported import_windio(const std::filesystem::path& file, const std::filesystem::path& folder, ImportedTower tower,
                       std::optional<double> rated_wind) {
  const Key top = load_windio(file), blade_key = top.at("components").at("blade");
  if (blade_key.has("outer_shape"))
    blade_key.at("outer_shape").fail("is windIO 2.x; files of windIO 1.x (outer_shape_bem) are read");
  require_upwind(top.at("assembly"));
  const std::map<std::string, Foil> foils = read_foils(top.at("airfoils"));
  const Blade blade = read_blade(top, foils);
  const Site site = read_site(top);
  const Operating operating = read_operating(top.at("control"), blade.tip_radius(), rated_wind);
  const std::vector<double> stations = stations_of(blade);

  Imported result;
  result.scene = folder / "scene.toml";
  std::filesystem::create_directories(folder);
  const std::string head = fmt::format("# From {}.\n", file.filename().string());
  write_planform(blade, stations, folder / "planform.csv", head);
  const bool by_reynolds = depends_on_reynolds(blade, foils);
  const Key parts = top.at("components");
  const bool stands = parts.has("tower") && has_shape(parts.at("tower"));
  const std::string tower_keys = stands ? tower_in_the_air(parts.at("tower"), result.left_out) : "";
  const bool layered = stands && parts.at("tower").has("internal_structure_2d_fem");
  const bool bends = tower == ImportedTower::as_in_deck && layered;
  if (bends) std::ofstream(folder / "tower.csv") << head << tower_table(top);
  const std::string polars = write_polars(blade, foils, folder, head);
  std::ofstream(folder / "turbine.toml") << head
                                         << fmt::format(
                                                "[turbine]\nblades = {}\nhub_radius_m = {:.9g}\nprecone_deg = {:.9g}\n"
                                                "operation = \"operation.csv\"\nplanform = \"planform.csv\"\npolars = [\n{}]\n",
                                                blade.count, blade.hub_radius, blade.cone / radians_per_degree, polars);
  write_operation(operating, blade.tip_radius(), folder / "operation.csv", head);
  write_scene(site, operating, by_reynolds, tower_keys, result.scene, head);
  result.rating = {rated_power(top), operating.cut_in, operating.rated_wind};
  result.carried = carried_over(blade, stations.size(), site, operating, by_reynolds);
  if (stands) result.carried.push_back("tower: its flow round the blades, and its drag");
  if (bends)
    result.carried.push_back(
        "tower.csv: mass and stiffness of the tower, for [beams.NAME] properties of a scene with the masses on it");
  if (tower == ImportedTower::rigid && layered) result.left_out.push_back("layers of the tower's wall (--rigid-tower)");
  tell_left_out(top, blade, foils, result.left_out);
  if (!result.left_out.empty()) std::ofstream(result.scene, std::ios::app) << "\n[output]\n" << toml_remarks(result.left_out, {});
  return result;
}

}  // namespace spindrift::decks
