// Keys and units: windIO 1.x, windIO/turbine/IEAontology_schema.yaml (lengths in m, angles in rad, spans over the blade's
// length). SPDX-License-Identifier: Apache-2.0
#include "src/import/windio.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>

#include "kernels/base/constants.hpp"
#include "kernels/base/interpolation.hpp"
#include "src/scene/error.hpp"

namespace spindrift::decks {

namespace {

/// A value of the file with its name from the top, for messages.
class Key {
 public:
  Key(std::filesystem::path file, YAML::Node node, std::string name = {})
      : file_(std::move(file)), node_(std::move(node)), name_(std::move(name)) {}

  [[noreturn]] void fail(const std::string& what) const {
    const YAML::Mark mark = node_.Mark();
    std::string value = node_.IsScalar() ? node_.Scalar() : "";
    throw scene::SceneError({{file_.string(), mark.is_null() ? 0 : mark.line + 1, name_, value.substr(0, 60), what}});
  }
  bool has(const std::string& key) const {
    require_map();
    return bool(node_[key]) && !node_[key].IsNull();
  }
  Key at(const std::string& key) const {
    if (!has(key)) fail(fmt::format("has no \"{}\"", key));
    return {file_, node_[key], name_.empty() ? key : name_ + "." + key};
  }
  std::vector<Key> entries() const {
    if (!node_.IsSequence() || node_.size() == 0) fail("must be a list of at least one entry");
    std::vector<Key> all;
    for (std::size_t i = 0; i < node_.size(); ++i) all.push_back({file_, node_[i], fmt::format("{}[{}]", name_, i)});
    return all;
  }
  double number() const {
    double value = 0.0;
    if (!node_.IsScalar() || !YAML::convert<double>::decode(node_, value) || !std::isfinite(value)) fail("must be a number");
    return value;
  }
  double positive() const {
    const double value = number();
    if (value <= 0.0) fail("must be > 0");
    return value;
  }
  /// An angle [rad] within a quarter of a turn: files of windIO 2 have degrees.
  double angle() const {
    const double value = number();
    if (std::abs(value) > 0.5 * pi) fail("must be an angle in radians, within -pi/2 and pi/2 (windIO 1.x)");
    return value;
  }
  int count() const {
    const double value = number();
    if (value < 1.0 || value > 12.0 || value != std::floor(value)) fail("must be a whole number from 1 to 12");
    return int(value);
  }
  std::string text() const {
    if (!node_.IsScalar()) fail("must be a word");
    return node_.Scalar();
  }

 private:
  void require_map() const {
    if (!node_.IsMap()) fail("must be a table of keys");
  }
  std::filesystem::path file_;
  YAML::Node node_;
  std::string name_;
};

struct Curve {
  std::vector<double> x, y;
};

std::vector<double> numbers(const Key& list) {
  std::vector<double> values;
  for (const Key& entry : list.entries()) values.push_back(entry.number());
  return values;
}

void require_increasing(const Key& grid, const std::vector<double>& x) {
  if (x.size() < 2) grid.fail("must have at least two entries");
  for (std::size_t i = 1; i < x.size(); ++i)
    if (x[i] <= x[i - 1]) grid.entries()[i].fail(fmt::format("must be more than the entry before it, {:g}", x[i - 1]));
}

Curve curve(const Key& key) {
  Curve c{numbers(key.at("grid")), numbers(key.at("values"))};
  require_increasing(key.at("grid"), c.x);
  if (c.x.size() != c.y.size()) key.at("values").fail(fmt::format("has {} entries, grid has {}", c.y.size(), c.x.size()));
  return c;
}

/// Along the blade, from 0 at the root to 1 at the tip.
void require_whole_span(const Key& grid, const std::vector<double>& x) {
  if (x.front() != 0.0 || x.back() != 1.0)
    grid.fail(fmt::format("must go from 0 to 1, goes from {:g} to {:g}", x.front(), x.back()));
}

Curve along_blade(const Key& key) {
  Curve c = curve(key);
  require_whole_span(key.at("grid"), c.x);
  return c;
}

double at(const Curve& c, double x) { return interpolate_linear(c.x, c.y, x); }

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
  double label;  ///< thickness_pct of the turbine file
};

struct Foil {
  Key key;
  double thickness;
};

/// The polars of each stretch of one name, told apart by their thickness where it falls from root to tip, else by a label.
bool label_by_thickness(std::vector<Position>& positions, const std::map<std::string, Foil>& foils) {
  bool falls = true;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    positions[i].label = 100.0 * foils.at(positions[i].airfoil).thickness;
    if (i > 0 && positions[i].airfoil != positions[i - 1].airfoil) falls &= positions[i].label < positions[i - 1].label;
  }
  if (falls) return true;
  std::size_t stretch = 0;
  const auto stretches = std::size_t(1 + std::count_if(positions.begin() + 1, positions.end(),
                                                       [](const Position& p) { return p.airfoil != (&p - 1)->airfoil; }));
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (i > 0 && positions[i].airfoil != positions[i - 1].airfoil) ++stretch;
    positions[i].label = 100.0 - 80.0 * double(stretch) / double(std::max<std::size_t>(stretches - 1, 1));
  }
  return false;
}

/// Of a section's polars that whose Reynolds number is nearest, by their ratio.
Key nearest_polar(const Foil& foil, double reynolds) {
  const std::vector<Key> polars = foil.key.at("polars").entries();
  if (polars.size() == 1) return polars[0];
  std::size_t best = 0;
  std::vector<double> distance;
  for (const Key& polar : polars) distance.push_back(std::abs(std::log(polar.at("re").positive() / reynolds)));
  for (std::size_t i = 1; i < distance.size(); ++i)
    if (distance[i] < distance[best]) best = i;
  return polars[best];
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
  for (const double a : angles) csv << fmt::format("{:.9g},{:.9g},{:.9g}\n", a / radians_per_degree, at(lift, a), at(drag, a));
}

struct Operating {
  double rated_wind = 0.0;                      ///< where the greatest speed is reached at the tip-speed ratio [m/s]
  double least = 0.0, most = 0.0, ratio = 0.0;  ///< speeds of the rotor [rad/s]; tip speed over wind
  double cut_in = 0.0;                          ///< [m/s]
};

Operating read_operating(const Key& control, double tip_radius) {
  const Key torque = control.at("torque"), supervisory = control.at("supervisory");
  Operating o;
  o.least = torque.at("VS_minspd").positive(), o.most = torque.at("VS_maxspd").positive(), o.ratio = torque.at("tsr").positive();
  o.cut_in = supervisory.at("Vin").positive();
  if (o.most <= o.least) torque.at("VS_maxspd").fail(fmt::format("must be more than VS_minspd = {:g}", o.least));
  o.rated_wind = o.most * tip_radius / o.ratio;
  if (o.rated_wind <= o.cut_in)
    supervisory.at("Vin").fail(
        fmt::format("must be below the wind at which the greatest speed is reached, {:g} m/s", o.rated_wind));
  return o;
}

YAML::Node load_yaml(const std::filesystem::path& file) {
  std::error_code none;
  if (std::filesystem::is_directory(file, none)) throw scene::SceneError({{file.string(), 0, "", "", "is a directory"}});
  try {
    return YAML::LoadFile(file.string());
  } catch (const YAML::BadFile&) {
    throw scene::SceneError({{file.string(), 0, "", "", "cannot be read"}});
  } catch (const YAML::ParserException& e) {
    throw scene::SceneError({{file.string(), e.mark.line + 1, "", "", "is no YAML: " + e.msg}});
  }
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
          .chord = along_blade(shape.at("chord")),
          .twist = along_blade(shape.at("twist")),
          .out = along_blade(axis.at("z")),
          .bend = along_blade(axis.at("x")),
          .sweep = along_blade(axis.at("y")),
          .positions = read_positions(shape.at("airfoil_position"), foils)};
  for (std::size_t i = 0; i < b.chord.y.size(); ++i)
    if (b.chord.y[i] <= 0.0) shape.at("chord").at("values").entries()[i].fail("a chord must be > 0 m");
  for (std::size_t i = 0; i < b.twist.y.size(); ++i) shape.at("twist").at("values").entries()[i].angle();
  for (std::size_t i = 1; i < b.out.y.size(); ++i)
    if (b.out.y[i] <= b.out.y[i - 1]) axis.at("z").at("values").entries()[i].fail("must be more than the entry before it");
  b.by_thickness = label_by_thickness(b.positions, foils);
  return b;
}

Site read_site(const Key& top) {
  const Key train = top.at("components").at("nacelle").at("drivetrain"), air = top.at("environment");
  return {.hub_height = top.at("assembly").at("hub_height").positive(),
          .overhang = train.at("overhang").positive(),
          .tilt = train.at("uptilt").angle(),
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
  Curve label;
  for (const Position& p : b.positions) label.x.push_back(p.span), label.y.push_back(p.label);
  const std::vector<double> thickness = monotone_at(label, stations);
  std::ofstream planform(file);
  planform << head << (b.by_thickness ? "" : "# thickness_pct tells polars apart: it is a label, not a thickness.\n")
           << "span_m,chord_m,twist_deg,thickness_pct,prebend_m,sweep_m\n";
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const double s = stations[i];
    planform << fmt::format("{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", b.hub_radius + at(b.out, s), at(b.chord, s),
                            at(b.twist, s) / radians_per_degree, thickness[i], at(b.bend, s), -at(b.sweep, s));
  }
}

/// The blade's polars, one file to a stretch of one airfoil. Returns the lines that name them in the turbine file.
std::string write_polars(const Blade& b, const std::map<std::string, Foil>& foils, const Operating& operating, const Site& site,
                         const std::filesystem::path& folder, const std::string& head, std::vector<std::string>& left_out) {
  std::string lines;
  for (std::size_t i = 0, polars = 0; i < b.positions.size(); ++i) {
    if (i > 0 && b.positions[i].airfoil == b.positions[i - 1].airfoil) continue;
    std::size_t last = i;
    while (last + 1 < b.positions.size() && b.positions[last + 1].airfoil == b.positions[i].airfoil) ++last;
    const Foil& foil = foils.at(b.positions[i].airfoil);
    const double middle = 0.5 * (b.positions[i].span + b.positions[last].span),
                 speed = std::hypot(operating.most * (b.hub_radius + at(b.out, middle)), operating.rated_wind),
                 reynolds = site.density * speed * at(b.chord, middle) / site.viscosity;
    const Key polar = nearest_polar(foil, reynolds);
    if (const std::size_t given = foil.key.at("polars").entries().size(); given > 1)
      left_out.push_back(fmt::format(
          "airfoil {} at span {:.2f}: of {} polars that of Reynolds number {:.3g} is used, the nearest to {:.3g} at rated wind",
          b.positions[i].airfoil, middle, given, polar.at("re").number(), reynolds));
    const std::string name = fmt::format("polar_{}.csv", ++polars);
    write_polar(polar, folder / name, fmt::format("{}# {}.\n", head, b.positions[i].airfoil));
    lines += fmt::format("  {{ thickness_pct = {:.9g}, file = \"{}\" }},\n", b.positions[i].label, name);
  }
  return lines;
}

void write_operation(const Operating& o, double tip_radius, const std::filesystem::path& file, const std::string& head) {
  std::ofstream table(file);
  table << head << "# Tip-speed ratio " << fmt::format("{:g}", o.ratio)
        << " between the least and the greatest speed, up to the wind at which that is "
           "reached.\nwind_m_s,speed_rpm,blade_pitch_deg\n";
  constexpr int rows = 32;
  for (int n = 0; n <= rows; ++n) {
    const double wind = o.cut_in + (o.rated_wind - o.cut_in) * n / rows,
                 speed = std::clamp(o.ratio * wind / tip_radius, o.least, o.most);
    table << fmt::format("{:.9g},{:.9g},0\n", wind, speed / rad_s_per_rpm);
  }
}

/// The shaft of an upwind rotor points down the wind and down: its axis leans by the tilt.
void write_scene(const Site& site, double wind, const std::filesystem::path& file, const std::string& head) {
  std::ofstream scene(file);
  scene << head << "# The rotor stands in the wind at which its greatest speed is reached.\n"
        << "[time]\nend_s = 10.0\nwindow_s = 0.5\nstep_s = 0.05\n\n"
        << "[bodies.turbine]  # it does not move: its mass does not matter\nmass_kg = 1e6\ninertia_kg_m2 = [1e9, 1e9, 1e9]\n"
        << fmt::format("centre_m = [0.0, 0.0, {:.9g}]\n\n", site.hub_height)
        << "[joints.foundation]\ntype = \"fixed\"\nbodies = [\"earth\", \"turbine\"]\npoint_m = [0.0, 0.0, 0.0]\n\n"
        << fmt::format("[environment]\nair_density_kg_m3 = {:.9g}\n\n[wind]\nspeed_m_s = {:.9g}\n\n", site.density, wind)
        << "[aero]\nmodel = \"bem\"\n\n"
        << fmt::format(
               "[rotor]\nbody = \"turbine\"\nturbine = \"turbine.toml\"\nhub_m = [{:.9g}, 0.0, {:.9g}]\n"
               "axis = [{:.9g}, 0.0, {:.9g}]\noperating_point = \"table\"\n",
               -site.overhang, site.hub_height, std::cos(site.tilt), -std::sin(site.tilt));
}

void tell_left_out(const Key& top, const Blade& b, std::vector<std::string>& left_out) {
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
  left_out.push_back("masses and stiffness of blades, hub, nacelle and tower: the rotor stands in the scene");
  left_out.push_back("pitch above rated wind and the controller: the file gives no pitch table");
  for (const char* part : {"tower", "monopile", "floating_platform", "mooring"})
    if (parts.has(part)) left_out.push_back(fmt::format("components.{}", part));
}

std::vector<std::string> carried_over(const Blade& b, std::size_t stations, const Site& site, const Operating& o) {
  std::vector<std::string> carried{
      fmt::format("{} blades of {} stations from {:g} to {:g} m, cone {:g} degrees, prebend {:g} m", b.count, stations,
                  b.hub_radius, b.hub_radius + b.out.y.back(), b.cone / radians_per_degree, b.bend.y.back()),
      fmt::format("hub {:g} m above the sea, {:g} m ahead of the tower, tilt {:g} degrees", site.hub_height, site.overhang,
                  site.tilt / radians_per_degree),
      fmt::format("operation at tip-speed ratio {:g} from {:g} to {:.4g} m/s", o.ratio, o.cut_in, o.rated_wind)};
  if (!b.by_thickness)
    carried.push_back(
        "polars by position: thickness_pct of the turbine file is a label, since thickness does not fall from root to tip");
  return carried;
}

}  // namespace

Imported import_windio(const std::filesystem::path& file, const std::filesystem::path& folder) {
  const Key top(file, load_yaml(file)), blade_key = top.at("components").at("blade");
  if (blade_key.has("outer_shape"))
    blade_key.at("outer_shape").fail("is windIO 2.x; files of windIO 1.x (outer_shape_bem) are read");
  require_upwind(top.at("assembly"));
  const std::map<std::string, Foil> foils = read_foils(top.at("airfoils"));
  const Blade blade = read_blade(top, foils);
  const Site site = read_site(top);
  const Operating operating = read_operating(top.at("control"), blade.tip_radius());
  const std::vector<double> stations = stations_of(blade);

  Imported result;
  result.scene = folder / "scene.toml";
  std::filesystem::create_directories(folder);
  const std::string head = fmt::format("# From {}.\n", file.filename().string());
  write_planform(blade, stations, folder / "planform.csv", head);
  const std::string polars = write_polars(blade, foils, operating, site, folder, head, result.left_out);
  std::ofstream(folder / "turbine.toml") << head
                                         << fmt::format(
                                                "[turbine]\nblades = {}\nhub_radius_m = {:.9g}\nprecone_deg = {:.9g}\n"
                                                "operation = \"operation.csv\"\nplanform = \"planform.csv\"\npolars = [\n{}]\n",
                                                blade.count, blade.hub_radius, blade.cone / radians_per_degree, polars);
  write_operation(operating, blade.tip_radius(), folder / "operation.csv", head);
  write_scene(site, operating.rated_wind, result.scene, head);
  result.carried = carried_over(blade, stations.size(), site, operating);
  tell_left_out(top, blade, result.left_out);
  return result;
}

}  // namespace spindrift::decks
