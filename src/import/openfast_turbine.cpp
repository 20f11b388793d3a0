// SPDX-License-Identifier: Apache-2.0
#include "src/import/openfast_turbine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <map>

#include "kernels/base/constants.hpp"
#include "kernels/grid/aerofoil.hpp"

namespace spindrift::decks {

namespace {

/// What AFTabMod makes of aerofoil files with several tables.
enum class Tables { first, by_reynolds, by_property };

Tables tables_named(const Deck& ad) {
  const int mode = ad.integer({"AFTabMod"}, 1);
  if (mode < 1 || mode > 3) ad.fail(ad.find({"AFTabMod"}), fmt::format("AFTabMod is {}: 1, 2 or 3 is known", mode));
  return Tables(mode - 1);
}

struct BladeNode {
  double span, bend, sweep, twist, chord;
  int polar;         ///< number of its aerofoil file
  std::size_t line;  ///< of the file
};

std::vector<BladeNode> read_nodes(const Deck& blade) {
  blade.require({{"NumBlNds", 2, 1e5}});
  const int nodes = blade.integer({"NumBlNds"}, 0);
  if (nodes == 0) blade.fail(std::nullopt, "has no line for NumBlNds");
  const std::size_t heading = *blade.find({"NumBlNds"}) + 1, first = heading + 2;
  const auto column = [&](const char* name) { return blade.column(heading, {name}); };
  std::vector<BladeNode> read;
  std::size_t line = first;
  for (const auto& row : blade.rows(first, std::size_t(nodes), column("BlAFID") + 1)) {
    const auto at = [&](const char* name) { return blade.to_number(row[column(name)], line); };
    for (std::size_t c = 0; c < std::min(row.size(), blade.words(heading).size()); ++c) blade.to_number(row[c], line);
    const double id = at("BlAFID");
    if (id < 1.0 || id > 1e6 || id != std::floor(id))
      blade.fail(line, fmt::format("has BlAFID {:g}: a whole number from 1 is wanted", id));
    const BladeNode node{at("BlSpn"), at("BlCrvAC"), at("BlSwpAC"), at("BlTwist"), at("BlChord"), int(id), line};
    if (node.span < 0.0 || (!read.empty() && node.span <= read.back().span))
      blade.fail(line, fmt::format("has BlSpn {:g}: it is wanted from 0 on, and beyond the row before", node.span));
    if (!(node.chord > 0.0)) blade.fail(line, fmt::format("has BlChord {:g}: more than 0 is wanted", node.chord));
    read.push_back(node);
    ++line;
  }
  return read;
}

/// The tables of an aerofoil file, each with the lines above it.
std::vector<Deck> split_tables(const Deck& file, int count) {
  std::vector<Deck> tables;
  for (std::size_t begin = 0; int(tables.size()) < count;) {
    const Deck rest = file.part(begin, file.size());
    const auto line = rest.find({"NumAlf"});
    if (!line) file.fail(file.find({"NumTabs"}), fmt::format("NumTabs is {}, but {} tables are there", count, tables.size()));
    const int rows = rest.integer({"NumAlf"}, 0);
    if (rows < 2) rest.fail(line, fmt::format("NumAlf is {}: at least 2 rows make a polar", rows));
    rest.rows(*line + 1, std::size_t(rows), 1);
    const std::size_t end = begin + *line + 1 + std::size_t(rows);
    tables.push_back(file.part(begin, end));
    begin = end;
  }
  return tables;
}

/// Reynolds numbers of the tables, which files have in millions.
std::vector<double> reynolds_of(const std::vector<Deck>& tables) {
  std::vector<double> numbers;
  for (const Deck& table : tables) {
    const double number = 1e6 * table.number({"Re"});
    if (number <= 0.0) table.fail(table.find({"Re"}), "Re must be > 0 (millions)");
    if (!numbers.empty() && number <= numbers.back())
      table.fail(table.find({"Re"}),
                 fmt::format("Re must be more than {:g}, that of the table before it (AFTabMod 2)", 1e-6 * numbers.back()));
    numbers.push_back(number);
  }
  return numbers;
}

/// Columns of angle, lift, drag and moment, which is not carried over.
struct Columns {
  std::size_t alpha, lift, drag, moment;
};
Columns polar_columns(const Deck& ad) {
  return {std::size_t(ad.number({"InCol_Alfa"}, 1) - 1), std::size_t(ad.number({"InCol_Cl"}, 2) - 1),
          std::size_t(ad.number({"InCol_Cd"}, 3) - 1), std::size_t(ad.number({"InCol_Cm"}, 0) - 1)};
}

/// Lift and drag are the same at all angles: AeroDyn has no dynamic stall there, whatever InclUAdata says.
bool is_constant(const Deck& table, const Columns& column) {
  const std::size_t first = *table.find({"NumAlf"}) + 1, count = std::size_t(table.number({"NumAlf"}));
  const auto rows = table.rows(first, count, std::max(column.lift, column.drag) + 1);
  for (std::size_t k = 1; k < count; ++k)
    for (const std::size_t c : {column.lift, column.drag})
      if (table.to_number(rows[k][c], first + k) != table.to_number(rows[0][c], first)) return false;
  return true;
}

/// T_f0 of the first table, in half chords; AeroDyn's default where the file has no such data.
double separation_lag(const Deck& foil) {
  foil.require({positive("T_f0")});
  return foil.flag({"InclUAdata"}, false) ? foil.number({"T_f0"}, 3.0) : 3.0;
}

/// What the Beddoes-Leishman models of AeroDyn (UA_Mod 1 to 3) are told of a polar, as a turbine file has it. Nothing
/// where AeroDyn finds it from the polar, as the program does (Leishman & Beddoes 1989; Damiani & Hayman 2019,
/// NREL/TP-5000-66347).
std::string stall_of(const Deck& table, const Columns& column) {
  if (is_constant(table, column)) return ", stall = { normal_slope = 0.0 }";
  if (!table.flag({"InclUAdata"}, false)) return "";
  for (const char* name : {"C_nalpha", "alpha0", "Cd0", "Cn1", "Cn2"}) {
    std::string word = table.text({name});
    std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    if (word == "default") return "";
  }
  return fmt::format(
      ", stall = {{ normal_slope = {:.9g}, zero_lift_deg = {:.9g}, drag_0 = {:.9g}, critical_normal = {:.9g}, "
      "critical_normal_low = {:.9g} }}",
      std::min(table.number({"C_nalpha"}), 20.0), table.number({"alpha0"}), std::max(table.number({"Cd0"}), 0.0),
      std::max(table.number({"Cn1"}), 1e-3), std::min(table.number({"Cn2"}), 0.0));
}

/// Returns whether some drag was negative.
bool write_table(const Deck& table, const Columns& column, const std::filesystem::path& file, const std::string& head) {
  const std::size_t first = *table.find({"NumAlf"}) + 1, count = std::size_t(table.number({"NumAlf"}));
  std::ofstream csv(file);
  csv << head << "alpha_deg,cl,cd\n";
  bool pushes = false;
  double before = -1e9;
  for (std::size_t k = first; k < first + count; ++k) {
    const auto row = table.rows(k, 1, std::max({column.alpha, column.lift, column.drag}) + 1)[0];
    const auto at = [&](std::size_t c) { return table.to_number(row[c], k); };
    if (column.moment < row.size()) at(column.moment);
    const double alpha = at(column.alpha), lift = at(column.lift), drag = at(column.drag);
    pushes |= drag < 0.0;
    if (std::abs(alpha) > 360.0) table.fail(k, fmt::format("has an angle of {:g} degrees: -360 to 360 is wanted", alpha));
    if (alpha < before) table.fail(k, fmt::format("has an angle of {:g} degrees, below the row before", alpha));
    if (alpha == before) continue;  // a doubled row closes the circle
    csv << fmt::format("{:.9g},{:.9g},{:.9g}\n", alpha, lift, std::max(drag, 0.0));
    before = alpha;
  }
  return pushes;
}

/// Writes the polars of one aerofoil file. Returns what the turbine file says of each, after its number.
std::vector<std::string> write_foil(const Deck& ad, const Deck& file, const std::string& name,
                                    const std::filesystem::path& folder, std::vector<std::string>& left_out) {
  const Tables mode = tables_named(ad);
  const std::string title = file.file().filename().string();
  const int given = file.integer({"NumTabs"}, 1);
  if (given < 1) file.fail(file.find({"NumTabs"}), fmt::format("NumTabs is {}: at least one table makes a polar", given));
  if (given > 1 && mode == Tables::by_property)
    ad.fail(ad.find({"AFTabMod"}),
            fmt::format("AFTabMod is 3, and {} has {} tables: a property that a controller changes (flaps) is not known; "
                        "AFTabMod 1 takes the first table",
                        title, given));
  if (given > 1 && mode == Tables::first)
    left_out.push_back(fmt::format("{}: the first of its {} tables is used, as AFTabMod 1 has it", title, given));
  const std::vector<Deck> tables = split_tables(file, mode == Tables::by_reynolds ? given : 1);
  const std::vector<double> reynolds = tables.size() > 1 ? reynolds_of(tables) : std::vector<double>();
  const Columns column = polar_columns(ad);
  const bool unsteady = !ad.has("AFAeroMod") || ad.integer({"AFAeroMod"}, 1) == 2;  // older decks have a switch of their own
  const int model = ad.integer({"UA_Mod", "UAMod"}, 0);
  std::vector<std::string> said, stall;
  bool pushes = false, tells = unsteady && model >= 1 && model <= 3;
  for (std::size_t n = 0; n < tables.size(); ++n) {
    const std::string csv = reynolds.empty() ? name + ".csv" : fmt::format("{}_{}.csv", name, n + 1);
    pushes |= write_table(tables[n], column, folder / csv, fmt::format("# From {}.\n", title));
    said.push_back((reynolds.empty() ? "" : fmt::format("reynolds = {:.9g}, ", reynolds[n])) + fmt::format("file = \"{}\"", csv));
    if (tells) stall.push_back(stall_of(tables[n], column));
    if (tells && stall.back().empty()) tells = false;  // all tables of a section say something of stall or none does
  }
  for (std::size_t n = 0; tells && n < said.size(); ++n) said[n] += stall[n];
  if (pushes) left_out.push_back(fmt::format("{}: negative drag is taken as none", title));
  return said;
}

/// The outline of a section as a turbine file has it: from the trailing edge along the suction side to the nose and back.
struct Outline {
  std::vector<Eigen::Vector2d> points{};
  double thickness_pct = 0.0;
  std::string fault{};  ///< why these points are none
};

/// Of an aerofoil file's NumCoords: the points follow, after one that is the section's reference, or @ names a file where they
/// do.
Outline outline_of(const Deck& foil) {
  const auto line = foil.find({"NumCoords"});
  const std::string word = line ? foil.words(*line)[0] : "0";
  const bool apart = word.starts_with('@');
  const std::filesystem::path path = apart ? foil.beside(word.substr(1)) : foil.file();
  if (!std::filesystem::exists(path)) return {.fault = fmt::format("{} is not there", path.filename().string())};
  const Deck file = apart ? Deck(path, "!") : foil;
  const auto head = file.find({"NumCoords"});
  const int count = head ? file.integer({"NumCoords"}, 0) : 0;
  if (count < 10) return {.fault = "the aerofoil file has no coordinates"};
  Outline outline;
  for (std::size_t row = *head + 2; row < *head + 1 + std::size_t(count); ++row) {  // past the reference
    const std::vector<std::string> words = file.rows(row, 1, 2)[0];
    const Eigen::Vector2d point(file.to_number(words[0], row), file.to_number(words[1], row));
    if (outline.points.empty() || point != outline.points.back()) outline.points.push_back(point);
  }
  std::vector<Eigen::Vector2d> loop = outline.points;
  if ((loop.front() - loop.back()).norm() < 1e-9) loop.pop_back();
  if (signed_area(loop) < 0.0) std::ranges::reverse(outline.points), std::ranges::reverse(loop);
  for (const Eigen::Vector2d& end : {outline.points.front(), outline.points.back()})
    if (std::abs(end.x() - 1.0) > 0.02) outline.fault = "its coordinates do not begin and end at the trailing edge";
  for (const Eigen::Vector2d& p : loop)
    if (p.x() < -0.05 || p.x() > 1.05) outline.fault = "its coordinates leave the chord";
  if (outline.fault.empty() && first_crossing(loop).first >= 0) outline.fault = "its outline crosses itself";
  outline.thickness_pct = std::min(100.0, std::round(1e4 * outline_thickness(loop)) / 1e2);
  return outline;
}

/// The outlines of the sections that resolved blades need, by aerofoil file; empty where one of them has none.
std::map<int, Outline> outlines_of(const std::map<int, Deck>& foils, std::vector<std::string>& left_out) {
  std::map<int, Outline> outlines;
  for (const auto& [number, foil] : foils) {
    Outline outline = outline_of(foil);
    if (!outline.fault.empty()) {
      left_out.push_back(fmt::format("outlines of the sections, which resolved blades need: {}: {}",
                                     foil.file().filename().string(), outline.fault));
      return {};
    }
    // Blades are blended by thickness: sections as thick as each other are one.
    for (const auto& [other, before] : outlines)
      if (std::abs(before.thickness_pct - outline.thickness_pct) < 0.2) outline.thickness_pct = before.thickness_pct;
    outlines[number] = std::move(outline);
  }
  return outlines;
}

/// Writes an outline of each thickness, the first one, and returns what the turbine file says of them.
std::string write_outlines(const std::map<int, Outline>& outlines, const std::filesystem::path& folder) {
  std::string said;
  std::vector<double> written;
  for (const auto& [number, outline] : outlines) {
    if (std::ranges::find(written, outline.thickness_pct) != written.end()) continue;
    written.push_back(outline.thickness_pct);
    const std::string name = fmt::format("aerofoil_{}.csv", number);
    std::ofstream csv(folder / name);
    csv << "x_c,y_c\n";
    for (const Eigen::Vector2d& p : outline.points) csv << fmt::format("{:.9g},{:.9g}\n", p.x(), p.y());
    said += fmt::format("  {{ thickness_pct = {:.9g}, file = \"{}\" }},\n", outline.thickness_pct, name);
  }
  return said;
}

}  // namespace

WrittenTurbine write_turbine(const Deck& ad, const RotorFrame& r, const std::filesystem::path& folder) {
  WrittenTurbine written;
  const Deck blade(ad.path({"ADBlFile(1)", "ADBlFile1"}));
  const std::vector<BladeNode> nodes = read_nodes(blade);

  const auto files = std::size_t(ad.number({"NumAFfiles"}));
  const std::size_t names = *ad.find({"NumAFfiles"}) + 1;
  std::map<int, Deck> decks;
  for (const BladeNode& n : nodes) {
    if (n.polar < 1 || std::size_t(n.polar) > files)
      blade.fail(n.line, fmt::format("names polar {}; {} has {}", n.polar, ad.file().filename().string(), files));
    if (!decks.contains(n.polar)) decks.emplace(n.polar, Deck(ad.beside(ad.words(names + std::size_t(n.polar) - 1)[0]), "!"));
  }
  const std::map<int, Outline> outlines = outlines_of(decks, written.left_out);

  // Each stretch of one aerofoil has a number, so that an element between two stations has the mean of theirs.
  std::ofstream planform(folder / "planform.csv");
  planform << "# From " << blade.file().filename().string() << ".\nspan_m,chord_m,twist_deg,polar,prebend_m,sweep_m"
           << (outlines.empty() ? "" : ",thickness_pct") << "\n";
  std::vector<int> stretches;
  for (const BladeNode& n : nodes) {
    if (stretches.empty() || stretches.back() != n.polar) stretches.push_back(n.polar);
    planform << fmt::format("{:.9g},{:.9g},{:.9g},{},{:.9g},{:.9g}", n.span + r.hub_radius, n.chord, n.twist, stretches.size(),
                            n.bend, -n.sweep)  // BlSwpAC: positive against the rotation
             << (outlines.empty() ? "" : fmt::format(",{:.9g}", outlines.at(n.polar).thickness_pct)) << "\n";
  }

  std::ofstream turbine(folder / "turbine.toml");
  turbine << "# From " << ad.file().filename().string() << ".\n[turbine]\n"
          << fmt::format("blades = {}\nhub_radius_m = {:.9g}\nprecone_deg = {:.9g}\nplanform = \"planform.csv\"\n{}polars = [\n",
                         r.blades, nodes[0].span + r.hub_radius, -r.precone / radians_per_degree,
                         nodes.size() > 2 ? "elements = \"at_stations\"   # as AeroDyn sums over its nodes\n" : "");
  std::map<int, std::vector<std::string>> foils;
  for (std::size_t n = 0; n < stretches.size(); ++n) {
    const int polar = stretches[n];
    if (!foils.contains(polar))
      foils[polar] = write_foil(ad, decks.at(polar), fmt::format("polar_{}", polar), folder, written.left_out);
    written.by_reynolds |= foils[polar].size() > 1;
    for (const std::string& said : foils[polar]) turbine << fmt::format("  {{ number = {}, {} }},\n", n + 1, said);
  }
  turbine << "]\n";
  std::optional<double> inner;
  for (const int polar : ad.integer({"UA_Mod", "UAMod"}, 0) == 6 ? stretches : std::vector<int>()) {
    const Deck& foil = decks.at(polar);
    if (is_constant(split_tables(foil, 1)[0], polar_columns(ad))) continue;
    written.separation_lag = separation_lag(foil);
    written.lags_differ |= inner.value_or(written.separation_lag) != written.separation_lag;
    inner = written.separation_lag;
  }
  if (!outlines.empty()) turbine << "aerofoils = [\n" << write_outlines(outlines, folder) << "]\n";
  return written;
}

}  // namespace spindrift::decks
