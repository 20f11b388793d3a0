// SPDX-License-Identifier: Apache-2.0
#include "src/import/openfast_parts.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>

#include "kernels/base/constants.hpp"
#include "kernels/beam/blade.hpp"

namespace spindrift::decks {

void MassSum::add(double mass, const Eigen::Vector3d& at, const Eigen::Matrix3d& inertia) {
  mass_ += mass, first_ += mass * at;
  about_origin_ += inertia + mass * (at.squaredNorm() * Eigen::Matrix3d::Identity() - at * at.transpose());
}

Eigen::Matrix3d MassSum::inertia() const {
  const Eigen::Vector3d c = centre();
  return about_origin_ - mass_ * (c.squaredNorm() * Eigen::Matrix3d::Identity() - c * c.transpose());
}

RotorFrame rotor_frame(const Deck& ed) {
  ed.require({{"NumBl", 1, 12},          positive("TipRad"),       not_negative("HubRad"),     {"ShftTilt", -90, 90},
              {"PreCone(1)", -90, 90},   angle("NacYaw"),          angle("BlPitch(1)"),        angle("Azimuth"),
              not_negative("RotSpeed"),  positive("TowerHt"),      not_negative("TipMass(1)"), not_negative("HubMass"),
              not_negative("HubIner"),   not_negative("GenIner"),  not_negative("NacMass"),    not_negative("NacYIner"),
              not_negative("YawBrMass"), not_negative("PtfmMass"), not_negative("PtfmRIner"),  not_negative("PtfmPIner"),
              not_negative("PtfmYIner"), positive("GBRatio"),      {"GBoxEff", 0, 100},        angle("PtfmRoll"),
              angle("PtfmPitch"),        angle("PtfmYaw")});
  if (ed.number({"TipRad"}) <= ed.number({"HubRad"})) ed.fail(ed.find({"TipRad"}), "TipRad is not more than HubRad");
  if (ed.number({"TowerHt"}) <= ed.number({"TowerBsHt"}, 0.0)) ed.fail(ed.find({"TowerHt"}), "TowerHt is not above TowerBsHt");
  const double tilt = ed.number({"ShftTilt"}) * radians_per_degree, overhang = ed.number({"OverHang"});
  RotorFrame r;
  r.yaw = ed.number({"NacYaw"}, 0.0) * radians_per_degree;
  r.axis = Eigen::Vector3d(std::cos(r.yaw) * std::cos(tilt), std::sin(r.yaw) * std::cos(tilt), std::sin(tilt));
  r.hub = Eigen::Vector3d(0.0, 0.0, ed.number({"TowerHt"}) + ed.number({"Twr2Shft"})) + overhang * r.axis;
  r.blades = ed.integer({"NumBl"}, 3);
  r.hub_radius = ed.number({"HubRad"}), r.tip_radius = ed.number({"TipRad"});
  r.precone = ed.number({"PreCone(1)", "PreCone1"}) * radians_per_degree;
  return r;
}

namespace {

/// Mass per length at shares of a length, straight between them.
struct Density {
  std::vector<double> at, per_m;
};

Density read_density(const Deck& file, const std::vector<std::string>& count, const std::vector<std::string>& share,
                     const std::vector<std::string>& density, const std::vector<std::string>& factor) {
  const int n = file.integer(count, 0);
  if (n < 2 || n > 100000) file.fail(file.find(count), fmt::format("{} is {}: 2 to 100000 stations are wanted", count[0], n));
  // The heading is the first line below that has the column's name.
  std::size_t heading = *file.find(count);
  const auto names = [&](std::size_t line) {
    try {
      file.column(line, density);
      return file.words(line).size() >= 2 && file.words(line)[0] != "-";
    } catch (const std::exception&) { return false; }
  };
  const auto is_value = [&](std::size_t line) { return file.words(line).size() > 2 && file.words(line)[2] == "-"; };
  for (++heading; heading < file.size() && (!names(heading) || is_value(heading)); ++heading) {}
  if (heading == file.size()) file.fail(std::nullopt, "has no table of " + density[0]);
  const std::size_t a = file.column(heading, share), m = file.column(heading, density);
  const double scale = file.number(factor, 1.0);
  Density result;
  std::size_t line = heading + 2;
  for (const auto& row : file.rows(line, std::size_t(n), std::max(a, m) + 1)) {
    const double at = file.to_number(row[a], line), value = file.to_number(row[m], line);
    if (at < 0.0 || at > 1.0 + 1e-6) file.fail(line, fmt::format("has {} = {:g}: 0 to 1 is wanted", share[0], at));
    if (!result.at.empty() && at <= result.at.back())
      file.fail(line, fmt::format("has {} = {:g}, not beyond the row before", share[0], at));
    if (value < 0.0 && density[0] != "StrcTwst")
      file.fail(line, fmt::format("has {} = {:g}, which is negative", density[0], value));
    result.at.push_back(at), result.per_m.push_back(scale * value);
    ++line;
  }
  return result;
}

/// BeamDyn's blade: a station is its share of the length, six rows of stiffness, six of mass, the mass per length first.
Density read_beamdyn(const Deck& file) {
  const auto stations = std::size_t(std::clamp(file.number({"station_total"}), 0.0, 1e5));
  std::vector<std::size_t> lines;
  std::size_t line = 0;
  while (line < file.size() && (file.words(line).empty() || file.words(line)[0].find("DISTRIBUTED") == std::string::npos) &&
         (file.words(line).size() < 2 || file.words(line)[1].find("DISTRIBUTED") == std::string::npos))
    ++line;
  for (++line; line < file.size(); ++line)
    if (!file.words(line).empty()) lines.push_back(line);
  if (lines.size() < 13 * stations) file.fail(std::nullopt, fmt::format("ends within the properties of {} stations", stations));
  Density result;
  for (std::size_t s = 0; s < stations; ++s) {
    result.at.push_back(file.numbers(lines[13 * s], 1)[0]);
    result.per_m.push_back(file.numbers(lines[13 * s + 7], 6)[0]);
  }
  return result;
}

/// Calls add(mass, share) for slices of a straight density.
template <class Add>
void slice(const Density& d, double length, const Add& add) {
  constexpr int slices = 16;
  for (std::size_t i = 0; i + 1 < d.at.size(); ++i)
    for (int s = 0; s < slices; ++s) {
      const double x = (s + 0.5) / slices, width = (d.at[i + 1] - d.at[i]) / slices;
      add(((1.0 - x) * d.per_m[i] + x * d.per_m[i + 1]) * width * length, (1.0 - x) * d.at[i] + x * d.at[i + 1]);
    }
}

void add_blades(const Deck& ed, const RotorFrame& r, MassSum& sum) {
  const Eigen::Vector3d up = (Eigen::Vector3d::UnitZ() - r.axis.z() * r.axis).normalized(), side = r.axis.cross(up);
  for (int b = 0; b < r.blades; ++b) {
    const std::string index = std::to_string(b + 1);
    const Density density = r.beamdyn_blades.empty()
                                ? read_density(Deck(ed.path({"BldFile(" + index + ")", "BldFile" + index, "BldFile"})),
                                               {"NBlInpSt"}, {"BlFract"}, {"BMassDen"}, {"AdjBlMs"})
                                : read_beamdyn(Deck(r.beamdyn_blades[std::size_t(b)]));
    const double azimuth = 2.0 * pi * b / r.blades;
    const Eigen::Vector3d out = std::cos(azimuth) * up + std::sin(azimuth) * side;
    const Eigen::Vector3d along = std::cos(r.precone) * out + std::sin(r.precone) * r.axis;
    slice(density, r.tip_radius - r.hub_radius, [&](double mass, double share) {
      sum.add(mass, r.hub + (r.hub_radius + share * (r.tip_radius - r.hub_radius)) * along);
    });
    sum.add(ed.number({"TipMass(" + index + ")", "TipMass" + index}, 0.0), r.hub + r.tip_radius * along);
  }
}

Eigen::Matrix3d about_axis(double inertia, const Eigen::Vector3d& axis) { return inertia * axis * axis.transpose(); }

}  // namespace

namespace {

void add_platform(const Deck& ed, MassSum& sum) {
  Eigen::Matrix3d platform =
      Eigen::Vector3d(ed.number({"PtfmRIner"}, 0.0), ed.number({"PtfmPIner"}, 0.0), ed.number({"PtfmYIner"}, 0.0)).asDiagonal();
  sum.add(ed.number({"PtfmMass"}, 0.0),
          {ed.number({"PtfmCMxt"}, 0.0), ed.number({"PtfmCMyt"}, 0.0), ed.number({"PtfmCMzt"}, 0.0)}, platform);
}

void add_tower(const Deck& ed, MassSum& sum) {
  const double top = ed.number({"TowerHt"}), base = ed.number({"TowerBsHt"}, 0.0);
  const Deck tower(ed.path({"TwrFile"}));
  slice(read_density(tower, {"NTwInpSt", "NTwInptSt"}, {"HtFract"}, {"TMassDen"}, {"AdjTwMa"}), top - base,
        [&](double mass, double share) {
          sum.add(mass, {0.0, 0.0, base + share * (top - base)});
        });
}

void add_top(const Deck& ed, const RotorFrame& r, bool controlled, MassSum& sum) {
  const double top = ed.number({"TowerHt"});
  const Eigen::AngleAxisd yaw(r.yaw, Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d nacelle =
      yaw * Eigen::Vector3d(ed.number({"NacCMxn"}, 0.0), ed.number({"NacCMyn"}, 0.0), top + ed.number({"NacCMzn"}, 0.0));
  const double nacelle_mass = ed.number({"NacMass"}, 0.0);
  const double own_yaw = ed.number({"NacYIner"}, 0.0) - nacelle_mass * nacelle.head<2>().squaredNorm();
  // The deck has no more than that about its yaw axis. A nacelle is long along its shaft: it has as much in pitch.
  const Eigen::Vector3d along = yaw * Eigen::Vector3d::UnitX();
  sum.add(nacelle_mass, nacelle, std::max(own_yaw, 0.0) * (Eigen::Matrix3d::Identity() - along * along.transpose()));
  sum.add(ed.number({"YawBrMass"}, 0.0), {0.0, 0.0, top});
  sum.add(ed.number({"HubMass"}, 0.0), r.hub + ed.number({"HubCM"}, 0.0) * r.axis,
          about_axis(ed.number({"HubIner"}, 0.0), r.axis));
  add_blades(ed, r, sum);
  if (controlled) sum.add(0.0, r.hub, about_axis(-rotor_inertia(ed, r), r.axis));
}

}  // namespace

MassSum all_masses(const Deck& ed, const RotorFrame& r, bool controlled) {
  MassSum sum;
  add_platform(ed, sum);
  add_tower(ed, sum);
  add_top(ed, r, controlled, sum);
  return sum;
}

MassSum platform_masses(const Deck& ed) {
  MassSum sum;
  add_platform(ed, sum);
  return sum;
}

MassSum top_masses(const Deck& ed, const RotorFrame& r, bool controlled) {
  MassSum sum;
  add_top(ed, r, controlled, sum);
  return sum;
}

namespace {

/// What the tuners of an ElastoDyn file's modes make of a stiffness: they are those of modes, not of places.
double tuned(const Deck& file, const std::string& tuner, int modes, std::vector<std::string>& left_out) {
  const auto of_mode = [&](int mode) { return file.number({fmt::format("{}({})", tuner, mode)}, 1.0); };
  if (modes == 2 && of_mode(1) != of_mode(2))
    left_out.push_back(fmt::format("{}: {}(2) {:g}, the stiffness of its second mode: all has that of the first, {:g}",
                                   file.file().filename().string(), tuner, of_mode(2), of_mode(1)));
  return of_mode(1);
}

/// Damping of a mode of the tower with what stands on it. ElastoDyn's is of the tower alone: C = 2 zeta K / omega of the mode
/// without the mass on top (CTFA and FreqTFA in its Coeff), which leaves zeta sqrt(m / (m + top)) of it.
double damping_under(double top, const Deck& file, const Density& mass, double length, const std::string& plane, int mode) {
  std::array<double, 5> shape;  // coefficients of its powers of the height from 2 on; one at the top
  for (std::size_t k = 0; k < shape.size(); ++k) shape[k] = file.number({fmt::format("Tw{}M{}Sh({})", plane, mode, k + 2)});
  double own = 0.0;  // mass of the mode
  slice(mass, length, [&](double part, double share) {
    double sway = 0.0;
    for (std::size_t k = shape.size(); k-- > 0;) sway = sway * share + shape[k];
    own += part * std::pow(sway * share * share, 2);
  });
  return 0.01 * file.number({fmt::format("Twr{}Dmp({})", plane, mode)}, 0.0) * std::sqrt(own / (own + top));
}

}  // namespace

ImportedBeam tower_beam(const Deck& ed, double top_mass, std::vector<std::string>& left_out) {
  const Deck file(ed.path({"TwrFile"}));
  const auto along = [&](const char* column, const char* factor) {
    return read_density(file, {"NTwInpSt", "NTwInptSt"}, {"HtFract"}, {column}, {factor});
  };
  const Density mass = along("TMassDen", "AdjTwMa"), fore_aft = along("TwFAStif", "AdjFASt"),
                side_side = along("TwSSStif", "AdjSSSt");
  const double tuned_fore_aft = tuned(file, "FAStTunr", 2, left_out), tuned_side_side = tuned(file, "SSStTunr", 2, left_out);
  ImportedBeam beam{
      .properties = "# From " + file.file().filename().string() + ".\ndistance_m,mass_kg_m,stiffness_x_N_m2,stiffness_y_N_m2\n",
      .base = ed.number({"TowerBsHt"}, 0.0),
      .top = ed.number({"TowerHt"})};
  for (std::size_t n = 0; n < mass.at.size(); ++n)
    beam.properties += fmt::format("{:.10g},{:.10g},{:.10g},{:.10g}\n", mass.at[n] * (beam.top - beam.base), mass.per_m[n],
                                   tuned_fore_aft * fore_aft.per_m[n], tuned_side_side * side_side.per_m[n]);
  for (int mode = 1; mode <= 2; ++mode)
    for (const char* plane : {"FA", "SS"})
      beam.damping[mode - 1] += 0.5 * damping_under(top_mass, file, mass, beam.top - beam.base, plane, mode);
  return beam;
}

ImportedBending blade_bending(const Deck& ed, const RotorFrame& r, std::vector<std::string>& left_out) {
  const auto path = [&](int blade) {
    const std::string index = std::to_string(blade);
    return ed.path({"BldFile(" + index + ")", "BldFile" + index, "BldFile"});
  };
  const Deck file(path(1));
  const auto along = [&](const char* column, const std::vector<std::string>& factor) {
    return read_density(file, {"NBlInpSt"}, {"BlFract"}, {column}, factor);
  };
  const Density mass = along("BMassDen", {"AdjBlMs"}), flap = along("FlpStff", {"AdjFlSt"}), edge = along("EdgStff", {"AdjEdSt"}),
                twist = along("StrcTwst", {"(no factor)"});
  const double tuned_flap = tuned(file, "FlStTunr", 2, left_out), tuned_edge = tuned(file, "EdStTunr", 1, left_out);
  ImportedBending bending{.structure = "# From " + file.file().filename().string() +
                                       ".\nspan_m,mass_kg_m,flap_N_m2,edge_N_m2,twist_deg\n"};
  beam::BladeTable table;
  for (std::size_t n = 0; n < mass.at.size(); ++n) {
    if (!(mass.per_m[n] > 0.0 && flap.per_m[n] > 0.0 && edge.per_m[n] > 0.0) || (n > 0 && mass.at[n] <= mass.at[n - 1]))
      file.fail(file.find({"NBlInpSt"}),
                fmt::format("has a table whose station {} has no mass or stiffness, or is not farther out "
                            "than the one before",
                            n + 1));
    table.position.push_back((mass.at[n] - mass.at[0]) * (r.tip_radius - r.hub_radius));
    table.mass.push_back(mass.per_m[n]);
    table.flap.push_back(tuned_flap * flap.per_m[n]), table.edge.push_back(tuned_edge * edge.per_m[n]);
    table.twist.push_back(twist.per_m[n] * radians_per_degree);
    bending.structure +=
        fmt::format("{:.10g},{:.10g},{:.10g},{:.10g},{:.10g}\n", r.hub_radius + mass.at[n] * (r.tip_radius - r.hub_radius),
                    mass.per_m[n], table.flap.back(), table.edge.back(), twist.per_m[n]);
  }
  bending.fastest = beam::BladeModes(table).omega().back();
  int k = 0;
  for (const char* name : {"BldFlDmp(1)", "BldEdDmp(1)", "BldFlDmp(2)"}) bending.damping[k++] = 0.01 * file.number({name}, 0.0);
  for (int b = 2; b <= r.blades; ++b) bending.alike = bending.alike && path(b) == path(1);
  return bending;
}

double rotor_inertia(const Deck& ed, const RotorFrame& r) {
  RotorFrame at_origin = r;
  at_origin.hub.setZero();
  MassSum blades;
  add_blades(ed, at_origin, blades);
  const Eigen::Vector3d c = blades.centre();
  const Eigen::Matrix3d about_hub =
      blades.inertia() + blades.mass() * (c.squaredNorm() * Eigen::Matrix3d::Identity() - c * c.transpose());
  return r.axis.dot(about_hub * r.axis) + ed.number({"HubIner"}, 0.0);
}

double generator_inertia(const Deck& ed) {
  const double ratio = ed.number({"GBRatio"}, 1.0);
  return ed.number({"GenIner"}, 0.0) * ratio * ratio;
}

namespace {

/// Line of the first heading of a section below: the one whose first word is this, or "ID" as files have it of late.
std::size_t heading_of(const Deck& file, std::size_t from, const std::string& first_word) {
  for (std::size_t n = from; n < file.size(); ++n)
    if (!file.words(n).empty() && (file.words(n)[0] == first_word || file.words(n)[0] == "ID")) return n;
  file.fail(std::nullopt, "has no table that begins with " + first_word);
}

/// Words of a row of points: those of its heading, name, kind and place at least.
std::size_t words_of_point(const Deck& file, std::size_t heading) { return std::max<std::size_t>(5, file.words(heading).size()); }

/// A table has ended: at the next rule, or at a line without words.
bool ends_table(const Deck& file, std::size_t line) { return file.words(line).empty() || file.is_rule(line); }

template <class Row>
void each_row(const Deck& file, std::size_t heading, const Row& row) {
  for (std::size_t n = heading + 2; n < file.size() && !ends_table(file, n); ++n) row(n, file.words(n));
}

std::string in_lower_case(std::string word) {
  std::ranges::transform(word, word.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return word;
}

/// A point of a line file.
enum class PointKind { fixed, moved, free, unknown };
struct LinePoint {
  std::string type;
  ImportedJunction point;  ///< name and values of a free one
  PointKind kind() const;
};

PointKind LinePoint::kind() const {
  if (type.rfind("fix", 0) == 0 || type == "anchor") return PointKind::fixed;
  if (type.rfind("vessel", 0) == 0 || type.rfind("coupled", 0) == 0 || type.rfind("body", 0) == 0) return PointKind::moved;
  if (type == "connect" || type == "con" || type == "free" || type == "point") return PointKind::free;
  return PointKind::unknown;
}

ImportedJunction free_point(const std::string& id, const Eigen::Vector3d& at) {
  std::string name = "junction_";
  for (const char c : id) name += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  return {name, at};
}

/// Puts an entry of a table into its map.
template <class T>
void enter(const Deck& file, std::size_t line, std::map<std::string, T>& table, const std::string& name, T entry) {
  if (!table.emplace(name, std::move(entry)).second) file.fail(line, fmt::format("has the name {} of a row before", name));
}

double require_not_negative(const Deck& file, std::size_t line, const std::string& what, double value) {
  if (value < 0.0) file.fail(line, fmt::format("has {} = {:g}, which is negative", what, value));
  return value;
}

/// Unstretched length and the two ends of a row of lines.
double length_of(const Deck& file, std::size_t line, const std::string& word, const std::string& a, const std::string& b) {
  const double length = file.to_number(word, line);
  if (!(length > 0.0)) file.fail(line, fmt::format("has a line of {} m: its length must be above zero", word));
  if (a == b) file.fail(line, fmt::format("has a line from {} to itself", a));
  return length;
}

/// Ends of a line: the anchor is what is fixed, the fairlead what moves with the platform; a free point takes the other end.
/// False where the line ties the bed to the bed, the platform to itself, or something unknown.
bool place_ends(ImportedLine& line, LinePoint a, LinePoint b) {
  if (a.kind() == PointKind::moved || b.kind() == PointKind::fixed) std::swap(a, b);
  const PointKind anchor = a.kind(), fairlead = b.kind();
  if (anchor == PointKind::moved || fairlead == PointKind::fixed || anchor == PointKind::unknown ||
      fairlead == PointKind::unknown)
    return false;
  line.anchor = a.point.at, line.fairlead = b.point.at;
  if (anchor == PointKind::free) line.at_anchor = a.point.name;
  if (fairlead == PointKind::free) line.at_fairlead = b.point.name;
  return true;
}

/// The free points that lines end at.
template <class Points>
std::vector<ImportedJunction> junctions_of(const std::vector<ImportedLine>& lines, const Points& points) {
  std::vector<ImportedJunction> found;
  for (const auto& [id, p] : points)
    if (p.kind() == PointKind::free && std::ranges::any_of(lines, [&](const ImportedLine& l) {
          return l.at_anchor == p.point.name || l.at_fairlead == p.point.name;
        }))
      found.push_back(p.point);
  return found;
}

std::string not_tied(const Deck& file, const std::string& line, const LinePoint& a, const LinePoint& b) {
  return fmt::format("{}: line {} ties {} to {}; lines between the bed, the platform and free points alone are carried over",
                     file.file().filename().string(), line, a.type, b.type);
}

}  // namespace

ImportedMoorings read_map(const Deck& file, double depth, std::vector<std::string>& left_out) {
  const std::size_t types = heading_of(file, 0, "LineType"), nodes = heading_of(file, types, "Node"),
                    lines = heading_of(file, nodes + 1, "Line");
  struct Type {
    double diameter, mass, stiffness, friction;
  };
  std::map<std::string, Type> by_name;
  each_row(file, types, [&](std::size_t n, const auto& w) {
    file.rows(n, 1, 5);
    for (std::size_t unused = 5; unused < w.size(); ++unused) file.to_number(w[unused], n);
    enter(file, n, by_name, w[0],
          Type{require_not_negative(file, n, "Diam", file.to_number(w[1], n)),
               require_not_negative(file, n, "MassDenInAir", file.to_number(w[2], n)),
               require_not_negative(file, n, "EA", file.to_number(w[3], n)), file.to_number(w[4], n)});
  });
  const std::string file_name = file.file().filename().string();
  std::map<std::string, LinePoint> by_number;
  each_row(file, nodes, [&](std::size_t n, const auto& w) {
    file.rows(n, 1, words_of_point(file, nodes));
    // "#" marks what MAP++ looks for; a free node's place behind it is where the search begins.
    const auto value = [&](std::size_t column) {
      std::string word = w.size() > column ? w[column] : "0";
      if (!word.empty() && word[0] == '#') word = word.substr(1);
      return word == "depth" ? -depth : word.empty() && column > 4 ? 0.0 : file.to_number(word, n);
    };
    LinePoint node{in_lower_case(w[1]), free_point(w[0], {value(2), value(3), value(4)})};
    const Eigen::Vector3d force(value(7), value(8), value(9));
    node.point.mass = require_not_negative(file, n, "M", value(5)),
    node.point.volume = require_not_negative(file, n, "B", value(6));
    node.point.added_mass = 0.5;  // a sphere's
    if (node.kind() == PointKind::free && force.norm() > 0.0)
      left_out.push_back(fmt::format("{}: the force FX, FY, FZ on node {}", file_name, w[0]));
    enter(file, n, by_number, w[0], node);
  });
  std::vector<ImportedLine> found;
  each_row(file, lines, [&](std::size_t n, const auto& w) {
    file.rows(n, 1, 5);
    if (!by_name.count(w[1])) file.fail(n, fmt::format("names line type '{}', which is not in the dictionary", w[1]));
    for (const std::string& node : {w[3], w[4]})
      if (!by_number.count(node)) file.fail(n, fmt::format("names node {}, which is not in the table of nodes", node));
    const Type& t = by_name[w[1]];
    ImportedLine line{{}, {}, length_of(file, n, w[2], w[3], w[4]), t.diameter, t.mass, t.stiffness, t.friction};
    line.meets_bed = std::none_of(w.begin() + 5, w.end(), [](const auto& flag) { return in_lower_case(flag) == "omit_contact"; });
    const LinePoint &a = by_number.at(w[3]), &b = by_number.at(w[4]);
    if (!place_ends(line, a, b)) return left_out.push_back(not_tied(file, w[0], a, b));
    found.push_back(line);
  });
  std::vector<ImportedJunction> junctions = junctions_of(found, by_number);
  // "repeat 120 240": all lines again, turned about z.
  const std::size_t once = found.size(), points_once = junctions.size();
  std::size_t turns = 0;
  for (std::size_t n = lines; n < file.size(); ++n) {
    const auto& w = file.words(n);
    if (w.empty() || w[0] != "repeat") continue;
    for (std::size_t k = 1; k < w.size(); ++k) {
      const Eigen::Matrix3d turn =
          Eigen::AngleAxisd(file.to_number(w[k], n) * radians_per_degree, Eigen::Vector3d::UnitZ()).toRotationMatrix();
      const auto renamed = [&](const std::string& name) { return name.empty() ? name : fmt::format("{}_{}", name, turns + 2); };
      for (std::size_t l = 0; l < once; ++l) {
        ImportedLine copy = found[l];
        copy.anchor = turn * copy.anchor, copy.fairlead = turn * copy.fairlead;
        copy.at_anchor = renamed(copy.at_anchor), copy.at_fairlead = renamed(copy.at_fairlead);
        found.push_back(copy);
      }
      for (std::size_t j = 0; j < points_once; ++j) {
        ImportedJunction copy = junctions[j];
        copy.at = turn * copy.at, copy.name = renamed(copy.name);
        junctions.push_back(copy);
      }
      ++turns;
    }
  }
  return {found, junctions};
}

namespace {

/// A rule of MoorDyn's with its title, in capitals.
std::string title_of(const Deck& file, std::size_t rule) {
  std::string text;
  for (std::string w : file.words(rule)) {
    for (char& c : w) c = char(std::toupper(static_cast<unsigned char>(c)));
    text += w + " ";
  }
  return text;
}

bool has_one_of(const std::string& text, std::initializer_list<const char*> words) {
  return std::ranges::any_of(words, [&](const char* word) { return text.find(word) != std::string::npos; });
}

/// Tables of MoorDyn that no scene has: rods, loads from outside, lines that a controller moves or that break.
void note_other_tables(const Deck& file, const std::string& name, std::vector<std::string>& left_out) {
  for (std::size_t n = 0; n + 3 < file.size(); ++n) {
    if (!file.is_rule(n) || std::ranges::any_of(std::array{1, 2, 3}, [&](std::size_t k) { return ends_table(file, n + k); }))
      continue;
    std::string title = title_of(file, n);
    if (has_one_of(title, {"LINE", "POINT", "CONNECTION", "BOD", "OPTIONS", "OUTPUT", "INPUT"})) continue;
    std::erase_if(title, [](char c) { return c == '-' || c == '='; });
    const std::size_t from = title.find_first_not_of(' ');
    if (from != std::string::npos)
      left_out.push_back(fmt::format("{}: the table {}", name, title.substr(from, title.find_last_not_of(' ') + 1 - from)));
  }
}

/// Options of MoorDyn that say what the scene's lines meet.
void note_options(const Deck& file, const std::string& name, double depth, std::vector<std::string>& left_out) {
  if (file.find({"WtrDpth"}))
    if (const std::string own = file.text({"WtrDpth"}); number_in(own) != depth)
      left_out.push_back(fmt::format("{}: the bed of its own, WtrDpth {}; here it is {:g} m deep", name, own, depth));
  if (const double across = file.number({"mu_kT"}, 0.0), along = file.number({"mu_kA"}, 0.0); across != along)
    left_out.push_back(
        fmt::format("{}: bed friction across the lines, mu_kT {:g}: it is mu_kA {:g} all round", name, across, along));
}

}  // namespace

ImportedMoorings read_moordyn(const Deck& file, double depth, std::vector<std::string>& left_out) {
  const std::string file_name = file.file().filename().string();
  note_other_tables(file, file_name, left_out);
  note_options(file, file_name, depth, left_out);
  const auto section_if = [&](std::initializer_list<const char*> words) -> std::optional<std::size_t> {
    for (std::size_t n = 0; n + 1 < file.size(); ++n)
      if (file.is_rule(n) && has_one_of(title_of(file, n), words)) {
        const auto& next = file.words(n + 1);  // before OpenFAST 3.3 the number of rows: "3 NLines"
        const bool counts = next.size() > 1 && number_in(next[0]) && in_lower_case(next[1]).rfind("n", 0) == 0;
        return n + (counts ? 2 : 1);
      }
    return std::nullopt;
  };
  const auto section = [&](std::initializer_list<const char*> words) {
    if (const auto found = section_if(words)) return *found;
    file.fail(std::nullopt, fmt::format("has no section {}", *words.begin()));
  };
  struct Type {
    double diameter, mass, stiffness, damping;  ///< damping: BA [N s], or -zeta
    ImportedLine::Dynamics dynamics;
  };
  std::map<std::string, Type> types;
  const std::size_t dictionary = section({"LINE TYPES", "LINE DICTIONARY"});
  const std::vector<std::string>& heading = file.words(dictionary);
  const auto place_of = [&](const char* name) { return std::size_t(std::ranges::find(heading, name) - heading.begin()); };
  const std::size_t bending = place_of("EI"), lift = place_of("Cl");
  // Version 1 calls the coefficients Can, Cat, Cdn, Cdt and has no bending.
  const std::size_t damped = file.column(dictionary, {"BA/-zeta", "BA/-Zeta", "CIntDamp"}),
                    drag = file.column(dictionary, {"Cd", "Cdn"}), added = file.column(dictionary, {"Ca", "Can"}),
                    axial_drag = file.column(dictionary, {"CdAx", "Cdt"}), axial_added = file.column(dictionary, {"CaAx", "Cat"});
  each_row(file, dictionary, [&](std::size_t n, const auto& w) {
    file.rows(n, 1, std::max({damped, drag, added, axial_drag, axial_added, std::size_t(3)}) + 1);
    const auto at = [&](std::size_t column) { return file.to_number(w[column], n); };
    const auto positive = [&](const char* name, std::size_t column) { return require_not_negative(file, n, name, at(column)); };
    enter(file, n, types, w[0],
          Type{positive("Diam", 1),
               positive("MassDen", 2),
               positive("EA", 3),
               at(damped),
               {.drag = positive("Cd", drag),
                .axial_drag = positive("CdAx", axial_drag),
                .added_mass = positive("Ca", added),
                .axial_added_mass = positive("CaAx", axial_added)}});
    if (bending < heading.size() && w.size() > bending && at(bending) != 0.0)
      left_out.push_back(fmt::format("{}: bending stiffness of line type {}", file_name, w[0]));
    if (lift < heading.size() && w.size() > lift && at(lift) != 0.0)
      left_out.push_back(fmt::format("{}: lift of vortices, Cl, of line type {}", file_name, w[0]));
  });
  // The platform is the scene's: what MoorDyn adds to it at a point or a body is not. Without volume the coefficient CA is none.
  const auto note_own = [&](const std::string& what, const std::vector<std::string>& names, const std::vector<std::string>& w) {
    std::vector<std::string> own;
    for (std::size_t column = what.rfind("body", 0) == 0 ? 8 : 5; column < std::min(names.size(), w.size()); ++column)
      if (in_lower_case(names[column]).rfind("ca", 0) != 0 && number_in(w[column]) != 0.0) own.push_back(names[column]);
    if (!own.empty()) left_out.push_back(fmt::format("{}: {} of {} of the platform", file_name, fmt::join(own, ", "), what));
  };
  // Points of a body have its axes. Those that are part of the platform or the bed, unturned, are known.
  struct LineBody {
    bool known = false;
    std::string kind;
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
  };
  std::map<std::string, LineBody> line_bodies;
  if (const auto list = section_if({"BODIES", "BODY LIST", "BODY PROPERTIES"}))
    each_row(file, *list, [&](std::size_t n, const auto& w) {
      file.rows(n, 1, 8);
      const std::vector<double> place = [&] {
        std::vector<double> values;
        for (std::size_t k = 2; k < 8; ++k) values.push_back(file.to_number(w[k], n));
        return values;
      }();
      const PointKind kind = LinePoint{in_lower_case(w[1]), {}}.kind();
      if (kind == PointKind::moved) note_own("body " + w[0], file.words(*list), w);
      line_bodies["body" + w[0]] = {(kind == PointKind::moved || kind == PointKind::fixed) &&
                                        in_lower_case(w[1]).find("pin") == std::string::npos && place[3] == 0.0 &&
                                        place[4] == 0.0 && place[5] == 0.0,
                                    in_lower_case(w[1]),
                                    {place[0], place[1], place[2]}};
    });
  std::map<std::string, LinePoint> points;
  const std::size_t table = section({"POINTS", "CONNECTION PROPERTIES", "POINT PROPERTIES"});
  each_row(file, table, [&](std::size_t n, const auto& w) {
    file.rows(n, 1, words_of_point(file, table));
    const auto at = [&](std::size_t column) { return file.to_number(w[column], n); };
    std::string kind = in_lower_case(w[1]);
    const std::string height = in_lower_case(w[4]);
    Eigen::Vector3d place(at(2), at(3), height == "seabed" || height == "ground" || height == "floor" ? -depth : at(4));
    if (const auto body = line_bodies.find(kind); body != line_bodies.end()) {
      if (!body->second.known)
        file.fail(
            n, fmt::format("is a point of {}, which is {}: bodies that move by themselves, or are turned, are not carried over",
                           w[1], body->second.kind));
      kind = body->second.kind, place += body->second.at;
    }
    LinePoint point{kind, free_point(w[0], {place.x(), place.y(), std::max(place.z(), -depth)})};
    for (std::size_t unused = 5; unused < w.size(); ++unused) at(unused);
    if (point.kind() == PointKind::free) {
      const auto value = [&](const std::vector<std::string>& names) {
        const std::size_t column = file.column(table, names);
        file.rows(n, 1, column + 1);
        return require_not_negative(file, n, names[0], at(column));
      };
      point.point.mass = value({"M", "Mass"}), point.point.volume = value({"V", "Volume", "Vol"});
      point.point.drag_area = value({"CdA"}), point.point.added_mass = value({"CA"});
      const std::vector<std::string>& names = file.words(table);
      for (std::size_t column = 5; column < std::min(names.size(), w.size()); ++column)
        if ((names[column] == "FX" || names[column] == "FY" || names[column] == "FZ") && at(column) != 0.0)
          left_out.push_back(fmt::format("{}: the force {} on point {}", file_name, names[column], w[0]));
    } else if (point.kind() == PointKind::moved) {
      note_own("point " + w[0], file.words(table), w);
    }
    enter(file, n, points, w[0], point);
  });
  const std::size_t lines = section({"LINES", "LINE PROPERTIES"});
  // Version 1 has the segments' number after the length, version 2 the ends before it.
  const std::size_t type = file.column(lines, {"LineType"}), a = file.column(lines, {"AttachA", "NodeAnch"}),
                    b = file.column(lines, {"AttachB", "NodeFair"}), length = file.column(lines, {"UnstrLen"}),
                    segments = file.column(lines, {"NumSegs"});
  std::vector<ImportedLine> found;
  each_row(file, lines, [&](std::size_t n, const auto& w) {
    file.rows(n, 1, std::max({type, a, b, length, segments}) + 1);
    if (!types.count(w[type])) file.fail(n, fmt::format("names line type '{}', which is not among the types", w[type]));
    for (const std::string& point : {w[a], w[b]})
      if (!points.count(point)) file.fail(n, fmt::format("names point {}, which is not in the table of points", point));
    const Type& t = types[w[type]];
    ImportedLine line{{},        {},          length_of(file, n, w[length], w[a], w[b]),          t.diameter,
                      t.mass,    t.stiffness, file.number({"mu_kA", "FrictionCoefficient"}, 0.0), true,
                      t.dynamics};
    const LinePoint &one = points.at(w[a]), &other = points.at(w[b]);
    if (!place_ends(line, one, other)) return left_out.push_back(not_tied(file, w[0], one, other));
    // The bed of a scene's line is at its anchor, where it has one: of an anchor that is part of the bed.
    if (const double above = line.at_anchor.empty() ? depth + line.anchor.z() : 0.0; above > 1e-6 * depth) {
      line.meets_bed = above < 0.05 * depth;
      left_out.push_back(fmt::format("{}: the bed {:.4g} m under the anchor of line {}: {}", file_name, above, w[0],
                                     line.meets_bed ? "it is at the anchor's level" : "the line does not meet it"));
    }
    const double given = file.to_number(w[segments], n), least = std::max(2.0, given);
    if (given != std::floor(given) || given < 1.0 || given > 1000.0)
      file.fail(n, fmt::format("has {} segments: a whole number from 1 to 1000 is wanted", w[segments]));
    line.dynamics->segments = int(least);
    line.dynamics->bed_stiffness = file.number({"kBot", "kb"}, 3e6),
    line.dynamics->bed_damping = file.number({"cBot", "cb"}, 3e5);
    const double critical = line.length / least * std::sqrt(t.stiffness * t.mass);
    line.dynamics->damping_ratio = t.damping <= 0.0 ? -t.damping : t.damping / critical;
    if (line.dynamics->damping_ratio > 1.0) {
      left_out.push_back(fmt::format("{}: internal damping of line {} beyond the critical one of its segments", file_name, w[0]));
      line.dynamics->damping_ratio = 1.0;
    }
    found.push_back(line);
  });
  return {found, junctions_of(found, points)};
}

std::vector<ImportedRow> rows_of(const ImportedMoorings& moorings) {
  const std::vector<ImportedLine>& lines = moorings.lines;
  const auto at = [&](std::size_t l, const std::string& name) {
    return lines[l].at_anchor == name || lines[l].at_fairlead == name;
  };
  std::vector<ImportedRow> found;
  for (std::size_t first = 0; first < lines.size(); ++first) {
    if (!lines[first].at_anchor.empty()) continue;
    ImportedRow row{{first}, {}};
    std::string end = lines[first].at_fairlead;
    while (!end.empty()) {
      std::vector<std::size_t> others;
      for (std::size_t l = 0; l < lines.size(); ++l)
        if (l != row.lines.back() && at(l, end)) others.push_back(l);
      if (others.size() != 1) break;
      const ImportedLine& next = lines[others[0]];
      const bool upwards = next.at_anchor == end;
      if (!upwards && next.at_anchor.empty()) break;  // down to the bed again
      for (std::size_t p = 0; p < moorings.junctions.size(); ++p)
        if (moorings.junctions[p].name == end) row.points.push_back(p);
      row.lines.push_back(others[0]);
      end = upwards ? next.at_fairlead : next.at_anchor;
    }
    if (end.empty()) found.push_back(row);
  }
  return found;
}

}  // namespace spindrift::decks
