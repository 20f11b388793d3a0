// SPDX-License-Identifier: Apache-2.0
#include "src/import/hydrodyn_members.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include "kernels/base/constants.hpp"

namespace spindrift::decks {

namespace {

/// A table of HydroDyn: the line with its count, then heading, units and rows. Absent: no rows.
struct Table {
  const Deck& file;
  std::size_t heading = 0, count = 0;

  Table(const Deck& deck, const std::vector<std::string>& names) : file(deck) {
    const auto line = deck.find(names);
    if (!line) return;
    const int rows = deck.integer(names, 0);
    if (rows < 0) deck.fail(line, "has a negative number of rows");
    heading = *line + 1, count = std::size_t(rows);
  }
  std::size_t line(std::size_t row) const { return heading + 2 + row; }
  const std::string& text(std::size_t row, const char* name) const {
    const std::size_t column = file.column(heading, {name});
    const auto& words = file.words(line(row));
    if (words.size() <= column) file.fail(line(row), fmt::format("has no value for {}", name));
    return words[column];
  }
  double number(std::size_t row, const char* name) const { return file.to_number(text(row, name), line(row)); }
  double not_negative(std::size_t row, const char* name) const {
    const double value = number(row, name);
    if (value < 0.0) file.fail(line(row), fmt::format("has {} = {:g}, which is negative", name, value));
    return value;
  }
  double positive(std::size_t row, const char* name) const {
    const double value = number(row, name);
    if (!(value > 0.0)) file.fail(line(row), fmt::format("has {} = {:g}: more than 0 is wanted", name, value));
    return value;
  }
  /// Puts an entry into its map.
  template <class T>
  void enter(std::size_t row, std::map<std::string, T>& entries, const char* id, T entry) const {
    number(row, id);
    if (!entries.emplace(text(row, id), std::move(entry)).second)
      file.fail(line(row), fmt::format("has {} {} of a row before", id, text(row, id)));
  }
  bool has(const char* name) const {
    const auto& words = file.words(heading);
    return std::find(words.begin(), words.end(), name) != words.end();
  }
};

struct Across {
  double drag = 1.0, added_mass = 1.0;
  bool diffracts = false;
};

/// The word MCF in the place of C_a: waves as MacCamy and Fuchs have it, motions of the member with C_a = 1.
Across across(double drag, const std::string& added, const Deck& file, std::size_t line) {
  if (drag < 0.0) file.fail(line, fmt::format("has a drag coefficient of {:g}, which is negative", drag));
  if (added == "MCF" || added == "mcf") return {drag, 1.0, true};
  const double mass = file.to_number(added, line);
  if (mass < 0.0) file.fail(line, fmt::format("has an added-mass coefficient of {:g}, which is negative", mass));
  return {drag, mass};
}
struct Disc {
  double drag = 0.0, added_mass = 0.0;
};
struct Section {
  double diameter, thickness;
};
struct Joint {
  Eigen::Vector3d at;
  Disc disc;
};

/// Columns of a row whose names begin so, without those of marine growth, must be 1 where strips have the waves' loads: the
/// wave's pressure as it is.
void tell_pressures(const Deck& hd, std::size_t heading, std::size_t line, const std::string& name, bool loads,
                    std::vector<std::string>& left_out) {
  const auto &names = hd.words(heading), &row = hd.words(line);
  for (std::size_t c = 0; c < std::min(names.size(), row.size()); ++c) {
    if (names[c].rfind(name, 0) != 0 || names[c].find("MG") != std::string::npos) continue;
    if (hd.to_number(row[c], line) != 1.0 && loads)
      left_out.push_back(fmt::format("{} {}: the wave's pressure acts whole here, as with 1", names[c], row[c]));
  }
}

template <class Value>
const Value& look_up(const std::map<std::string, Value>& table, const std::string& id, const Deck& file, std::size_t line,
                     const char* what) {
  const auto it = table.find(id);
  if (it == table.end()) file.fail(line, fmt::format("names {} {}, which is in no table", what, id));
  return it->second;
}

/// `loads`: the strips have the waves' loads, not drag alone.
std::map<std::string, Joint> read_joints(const Deck& hd, bool loads, std::vector<std::string>& left_out) {
  std::map<std::string, Disc> discs;
  const Table axial(hd, {"NAxCoef"});
  for (std::size_t n = 0; n < axial.count; ++n) {
    axial.enter(n, discs, "AxCoefID", Disc{0.5 * axial.not_negative(n, "AxCd"), axial.not_negative(n, "AxCa")});
    tell_pressures(hd, axial.heading, axial.line(n), "AxCp", loads, left_out);
    const auto given = [&](const char* name, double otherwise) {
      if (!axial.has(name) || hd.words(axial.line(n)).size() <= hd.column(axial.heading, {name})) return otherwise;
      return axial.number(n, name);
    };
    if (given("AxFDMod", 0.0) != 0.0)
      left_out.push_back(fmt::format("AxFDMod 1 of axial coefficients {}: ends have drag in both directions here", n + 1));
    if (given("AxVnCOff", -1.0) > 0.0 && given("AxFDLoFSc", 1.0) != 1.0)
      left_out.push_back(
          fmt::format("AxVnCOff and AxFDLoFSc of axial coefficients {}: drag of ends is that of the whole velocity "
                      "here",
                      n + 1));
  }
  std::map<std::string, Joint> joints;
  const Table table(hd, {"NJoints"});
  for (std::size_t n = 0; n < table.count; ++n)
    table.enter(n, joints, "JointID",
                Joint{{table.number(n, "Jointxi"), table.number(n, "Jointyi"), table.number(n, "Jointzi")},
                      look_up(discs, table.text(n, "JointAxID"), hd, table.line(n), "axial coefficients")});
  return joints;
}

/// Coefficients across the members: for all (MCoefMod 1), by depth (2) or of each (3).
class Coefficients {
 public:
  Coefficients(const Deck& hd, bool loads, std::vector<std::string>& left_out)
      : depths_(hd, {"NCoefDpthCyl", "NCoefDpth"}), members_(hd, {"NCoefMembersCyl", "NCoefMembers"}) {
    for (std::size_t n = 0; n < hd.size(); ++n) {
      if (hd.words(n).empty() || (hd.words(n)[0] != "SimplCd" && hd.words(n)[0] != "SimplCd1")) continue;
      hd.rows(n + 2, 1, 4);
      simple_ = across(hd.to_number(hd.words(n + 2)[0], n + 2), hd.words(n + 2)[2], hd, n + 2);
      tell_pressures(hd, n, n + 2, "SimplCp", loads, left_out);
      break;
    }
    for (std::size_t n = 0; n < depths_.count; ++n)
      tell_pressures(hd, depths_.heading, depths_.line(n), "DpthCp", loads, left_out);
    for (std::size_t n = 0; n < members_.count; ++n)
      tell_pressures(hd, members_.heading, members_.line(n), "MemberCp", loads, left_out);
  }
  /// Of the member's start (1) and end (2).
  Across of(int mode, const std::string& member, const Eigen::Vector3d& at, char end, std::size_t line) const {
    if (mode == 1) return simple_;
    return mode == 2 ? at_depth(-at.z(), line) : of_member(member, end, line);
  }

 private:
  Across at_depth(double depth, std::size_t line) const {
    const Table& t = depths_;
    if (t.count == 0) t.file.fail(line, "has MCoefMod 2, but there is no table over depth");
    const auto row = [&](std::size_t n) { return across(t.number(n, "DpthCd"), t.text(n, "DpthCa"), t.file, t.line(n)); };
    if (depth <= t.number(0, "Dpth")) return row(0);
    for (std::size_t n = 1; n < t.count; ++n) {
      const double above = t.number(n - 1, "Dpth"), below = t.number(n, "Dpth");
      if (below <= above) t.file.fail(t.line(n), "depths must increase");
      if (depth > below) continue;
      const double x = (depth - above) / (below - above);
      const Across a = row(n - 1), b = row(n);
      return {(1.0 - x) * a.drag + x * b.drag, (1.0 - x) * a.added_mass + x * b.added_mass, a.diffracts};
    }
    return row(t.count - 1);
  }
  Across of_member(const std::string& member, char end, std::size_t line) const {
    const std::string drag = std::string("MemberCd") + end, added = std::string("MemberCa") + end;
    for (std::size_t n = 0; n < members_.count; ++n)
      if (members_.text(n, "MemberID") == member)
        return across(members_.number(n, drag.c_str()), members_.text(n, added.c_str()), members_.file, members_.line(n));
    members_.file.fail(line, fmt::format("has MCoefMod 3, but no coefficients are given for member {}", member));
  }

  Across simple_;
  Table depths_, members_;
};

MemberEnd between(const MemberEnd& a, const MemberEnd& b, double x) {
  const auto mix = [&](double p, double q) { return (1.0 - x) * p + x * q; };
  return {(1.0 - x) * a.at + x * b.at, mix(a.diameter, b.diameter), mix(a.thickness, b.thickness), mix(a.drag, b.drag),
          mix(a.added_mass, b.added_mass)};
}

/// No water acts on what is in the bed.
bool clip_at_bed(Member& member, double depth) {
  MemberEnd &a = member.start, &b = member.end;
  if (a.at.z() <= -depth && b.at.z() <= -depth) return false;
  if (a.at.z() >= -depth && b.at.z() >= -depth) return true;
  MemberEnd cut = between(a, b, (-depth - a.at.z()) / (b.at.z() - a.at.z()));
  cut.at.z() = -depth;
  (a.at.z() < -depth ? a : b) = cut;
  return true;
}

bool is_true(const std::string& word) { return !word.empty() && std::tolower(static_cast<unsigned char>(word[0])) == 't'; }

}  // namespace

std::vector<Member> read_members(const Deck& hd, double depth, bool potential, std::vector<std::string>& left_out) {
  const Table table(hd, {"NMembers"});
  if (table.count == 0) return {};
  const std::map<std::string, Joint> joints = read_joints(hd, !potential, left_out);
  std::map<std::string, Section> sections;
  const Table sets(hd, {"NPropSetsCyl", "NPropSets"});
  for (std::size_t n = 0; n < sets.count; ++n)
    sets.enter(n, sections, "PropSetID", Section{sets.positive(n, "PropD"), sets.not_negative(n, "PropThck")});
  const Coefficients coefficients(hd, !potential, left_out);
  std::vector<Member> members;
  for (std::size_t n = 0; n < table.count; ++n) {
    const std::size_t line = table.line(n);
    const std::string id = table.text(n, "MemberID");
    table.number(n, "MemberID");
    if (table.has("MSecGeom") && table.number(n, "MSecGeom") != 1.0)
      hd.fail(line, "is a member of rectangular section; cylinders are known");
    if (!potential && table.has("MHstLMod") && table.number(n, "MHstLMod") == 0.0)
      hd.fail(line, "has MHstLMod 0, a member that still water does not lift: cylinders of a scene displace water");
    const double mode = table.number(n, "MCoefMod");
    if (mode != 1.0 && mode != 2.0 && mode != 3.0) hd.fail(line, fmt::format("has MCoefMod {}: 1, 2 and 3 are known", mode));
    bool diffracts = false;
    const auto end = [&](const char* joint, const char* set, char which) {
      const Joint& j = look_up(joints, table.text(n, joint), hd, line, "joint");
      const Section& s = look_up(sections, table.text(n, set), hd, line, "property set");
      const Across c = coefficients.of(int(mode), id, j.at, which, line);
      diffracts = c.diffracts;
      return MemberEnd{j.at, s.diameter, s.thickness, c.drag, c.added_mass, j.disc.drag, j.disc.added_mass};
    };
    Member member{"member_" + id,
                  end("MJointID1", "MPropSetID1", '1'),
                  end("MJointID2", "MPropSetID2", '2'),
                  table.positive(n, "MDivSize"),
                  !table.has("PropPot") || is_true(table.text(n, "PropPot")),
                  false};
    member.diffracts = diffracts;
    if ((member.end.at - member.start.at).norm() == 0.0)
      hd.fail(line, fmt::format("is member {} between joints that are in one place", id));
    if (std::ranges::any_of(members, [&](const Member& m) { return m.name == member.name; }))
      hd.fail(line, fmt::format("has MemberID {} of a row before", id));
    if (!clip_at_bed(member, depth)) continue;
    const auto differ = [](double a, double b) { return std::abs(a - b) > 1e-9 * (std::abs(a) + std::abs(b)); };
    if (differ(member.start.drag, member.end.drag) || differ(member.start.added_mass, member.end.added_mass))
      left_out.push_back(fmt::format("coefficients that change along member {}: their mean is used", id));
    members.push_back(std::move(member));
  }
  if (hd.integer({"NMGDepths"}, 0) > 0) left_out.push_back("marine growth");
  return members;
}

MassSum read_ballast(const Deck& hd, const std::vector<Member>& members, double water_density) {
  MassSum sum;
  const Table groups(hd, {"NFillGroups"});
  for (std::size_t n = 0; n < groups.count; ++n) {
    const std::size_t line = groups.line(n);
    const auto& words = hd.words(line);
    const double listed = words.empty() ? 0.0 : hd.to_number(words[0], line);
    if (!(listed >= 0.0 && listed <= 1e6)) hd.fail(line, fmt::format("lists {} members", listed));
    const auto count = std::size_t(listed);
    hd.rows(line, 1, count + 3);
    std::string density = words[count + 2];
    std::transform(density.begin(), density.end(), density.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    const double level = hd.to_number(words[count + 1], line),
                 per_m3 = density == "default" ? water_density : hd.to_number(density, line);
    for (std::size_t k = 1; k <= count; ++k) {
      const auto member =
          std::find_if(members.begin(), members.end(), [&](const Member& m) { return m.name == "member_" + words[k]; });
      if (member == members.end()) continue;  // in the bed
      MemberEnd low = member->start, high = member->end;
      if (low.at.z() > high.at.z()) std::swap(low, high);
      if (level <= low.at.z()) continue;
      if (level < high.at.z()) high = between(low, high, (level - low.at.z()) / (high.at.z() - low.at.z()));
      const double length = (high.at - low.at).norm();
      const Eigen::Vector3d axis = (high.at - low.at) / length;
      constexpr int slices = 32;
      for (int s = 0; s < slices; ++s) {
        const MemberEnd here = between(low, high, (s + 0.5) / slices);
        const double radius = std::max(0.5 * here.diameter - here.thickness, 0.0), thickness = length / slices;
        const double mass = per_m3 * pi * radius * radius * thickness;
        const double across = mass * (0.25 * radius * radius + thickness * thickness / 12.0);
        const Eigen::Matrix3d along = axis * axis.transpose();
        sum.add(mass, here.at, 0.5 * mass * radius * radius * along + across * (Eigen::Matrix3d::Identity() - along));
      }
    }
  }
  return sum;
}

}  // namespace spindrift::decks
