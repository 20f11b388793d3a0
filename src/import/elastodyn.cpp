// SPDX-License-Identifier: Apache-2.0
#include "src/import/elastodyn.hpp"

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

}  // namespace spindrift::decks
