// Files of MoorDyn, versions 1 and 2: dynamic lines. SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "src/import/line_points.hpp"

namespace spindrift::decks {

namespace {

/// A rule with its title, in capitals.
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

class MoorDynReader {
 public:
  MoorDynReader(const Deck& file, double depth, std::vector<std::string>& left_out)
      : file_(file), depth_(depth), name_(file.file().filename().string()), left_out_(left_out) {}
  ImportedMoorings read();

 private:
  struct Type {
    double diameter, mass, stiffness, damping;  ///< damping: BA [N s], or -zeta
    ImportedLine::Dynamics dynamics;
  };
  /// Points of a body have its axes. Those that are part of the platform or the bed, unturned, are known.
  struct LineBody {
    bool known = false;
    std::string kind;
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
  };

  void note_other_tables();
  void note_options();
  void note_own(const std::string& what, std::size_t first, std::size_t table, const std::vector<std::string>& words);
  void leave_out(const std::string& what) { left_out_.push_back(name_ + ": " + what); }
  std::optional<std::size_t> section_if(std::initializer_list<const char*> titles) const;
  std::size_t section(std::initializer_list<const char*> titles) const;
  void read_types();
  void read_bodies();
  void read_points();
  LinePoint read_point(std::size_t table, std::size_t n, const std::vector<std::string>& words);
  std::vector<ImportedLine> read_lines();
  void meet_bed(ImportedLine& line, const std::string& id);
  void damp(ImportedLine& line, const Type& type, const std::string& id);

  const Deck& file_;
  const double depth_;
  const std::string name_;
  std::vector<std::string>& left_out_;
  std::map<std::string, Type> types_;
  std::map<std::string, LineBody> bodies_;
  std::map<std::string, LinePoint> points_;
};

ImportedMoorings MoorDynReader::read() {
  note_other_tables();
  note_options();
  read_types();
  read_bodies();
  read_points();
  const std::vector<ImportedLine> lines = read_lines();
  return {lines, junctions_of(lines, points_)};
}

/// Tables that no scene has: rods, loads from outside, lines that a controller moves or that break.
void MoorDynReader::note_other_tables() {
  for (std::size_t n = 0; n + 3 < file_.size(); ++n) {
    if (!file_.is_rule(n) || std::ranges::any_of(std::array{1, 2, 3}, [&](std::size_t k) { return ends_table(file_, n + k); }))
      continue;
    std::string title = title_of(file_, n);
    if (has_one_of(title, {"LINE", "POINT", "CONNECTION", "BOD", "OPTIONS", "OUTPUT", "INPUT"})) continue;
    std::erase_if(title, [](char c) { return c == '-' || c == '='; });
    const std::size_t from = title.find_first_not_of(' ');
    if (from != std::string::npos) leave_out("the table " + title.substr(from, title.find_last_not_of(' ') + 1 - from));
  }
}

/// Options that say what the scene's lines meet.
void MoorDynReader::note_options() {
  if (file_.find({"WtrDpth"}))
    if (const std::string own = file_.text({"WtrDpth"}); number_in(own) != depth_)
      leave_out(fmt::format("the bed of its own, WtrDpth {}; here it is {:g} m deep", own, depth_));
  if (const double across = file_.number({"mu_kT"}, 0.0), along = file_.number({"mu_kA"}, 0.0); across != along)
    leave_out(fmt::format("bed friction across the lines, mu_kT {:g}: it is mu_kA {:g} all round", across, along));
}

/// The platform is the scene's: what MoorDyn adds to it at a point or a body, in the columns from `first` on, is not. Without
/// volume the coefficient CA is none.
void MoorDynReader::note_own(const std::string& what, std::size_t first, std::size_t table,
                             const std::vector<std::string>& words) {
  const std::vector<std::string>& names = file_.words(table);
  std::vector<std::string> own;
  for (std::size_t column = first; column < std::min(names.size(), words.size()); ++column)
    if (in_lower_case(names[column]).rfind("ca", 0) != 0 && number_in(words[column]) != 0.0) own.push_back(names[column]);
  if (!own.empty()) leave_out(fmt::format("{} of {} of the platform", fmt::join(own, ", "), what));
}

/// Line of the heading of the first table with one of these titles.
std::optional<std::size_t> MoorDynReader::section_if(std::initializer_list<const char*> titles) const {
  for (std::size_t n = 0; n + 1 < file_.size(); ++n)
    if (file_.is_rule(n) && has_one_of(title_of(file_, n), titles)) {
      const auto& next = file_.words(n + 1);  // before OpenFAST 3.3 the number of rows: "3 NLines"
      const bool counts = next.size() > 1 && number_in(next[0]) && in_lower_case(next[1]).rfind("n", 0) == 0;
      return n + (counts ? 2 : 1);
    }
  return std::nullopt;
}

std::size_t MoorDynReader::section(std::initializer_list<const char*> titles) const {
  if (const auto found = section_if(titles)) return *found;
  file_.fail(std::nullopt, fmt::format("has no section {}", *titles.begin()));
}

void MoorDynReader::read_types() {
  const std::size_t table = section({"LINE TYPES", "LINE DICTIONARY"});
  const std::vector<std::string>& heading = file_.words(table);
  // Version 1 calls the coefficients Can, Cat, Cdn, Cdt and has no bending.
  const std::size_t damped = file_.column(table, {"BA/-zeta", "BA/-Zeta", "CIntDamp"}), drag = file_.column(table, {"Cd", "Cdn"}),
                    added = file_.column(table, {"Ca", "Can"}), axial_drag = file_.column(table, {"CdAx", "Cdt"}),
                    axial_added = file_.column(table, {"CaAx", "Cat"});
  each_row(file_, table, [&](std::size_t n, const auto& w) {
    file_.rows(n, 1, std::max({damped, drag, added, axial_drag, axial_added, std::size_t(3)}) + 1);
    const auto at = [&](std::size_t column) { return file_.to_number(w[column], n); };
    const auto positive = [&](const char* name, std::size_t column) { return require_not_negative(file_, n, name, at(column)); };
    enter(file_, n, types_, w[0],
          Type{positive("Diam", 1),
               positive("MassDen", 2),
               positive("EA", 3),
               at(damped),
               {.drag = positive("Cd", drag),
                .axial_drag = positive("CdAx", axial_drag),
                .added_mass = positive("Ca", added),
                .axial_added_mass = positive("CaAx", axial_added)}});
    const auto note = [&](const char* name, const char* what) {
      const std::size_t column = std::size_t(std::ranges::find(heading, name) - heading.begin());
      if (column < heading.size() && w.size() > column && at(column) != 0.0)
        leave_out(fmt::format("{} of line type {}", what, w[0]));
    };
    note("EI", "bending stiffness");
    note("Cl", "lift of vortices, Cl,");
  });
}

void MoorDynReader::read_bodies() {
  const auto table = section_if({"BODIES", "BODY LIST", "BODY PROPERTIES"});
  if (!table) return;
  each_row(file_, *table, [&](std::size_t n, const auto& w) {
    file_.rows(n, 1, 8);
    const auto at = [&](std::size_t column) { return file_.to_number(w[column], n); };
    const Eigen::Vector3d place(at(2), at(3), at(4)), turn(at(5), at(6), at(7));
    const std::string type = in_lower_case(w[1]);
    const PointKind kind = LinePoint{type, {}}.kind();
    if (kind == PointKind::moved) note_own("body " + w[0], 8, *table, w);
    bodies_["body" + w[0]] = {(kind == PointKind::moved || kind == PointKind::fixed) && type.find("pin") == std::string::npos &&
                                  turn == Eigen::Vector3d::Zero(),
                              type, place};
  });
}

void MoorDynReader::read_points() {
  const std::size_t table = section({"POINTS", "CONNECTION PROPERTIES", "POINT PROPERTIES"});
  each_row(file_, table, [&](std::size_t n, const auto& w) { enter(file_, n, points_, w[0], read_point(table, n, w)); });
}

LinePoint MoorDynReader::read_point(std::size_t table, std::size_t n, const std::vector<std::string>& w) {
  file_.rows(n, 1, words_of_point(file_, table));
  const auto at = [&](std::size_t column) { return file_.to_number(w[column], n); };
  std::string kind = in_lower_case(w[1]);
  const std::string height = in_lower_case(w[4]);
  Eigen::Vector3d place(at(2), at(3), height == "seabed" || height == "ground" || height == "floor" ? -depth_ : at(4));
  if (const auto body = bodies_.find(kind); body != bodies_.end()) {
    if (!body->second.known)
      file_.fail(n,
                 fmt::format("is a point of {}, which is {}: bodies that move by themselves, or are turned, are not carried over",
                             w[1], body->second.kind));
    kind = body->second.kind, place += body->second.at;
  }
  LinePoint point{kind, free_point(w[0], {place.x(), place.y(), std::max(place.z(), -depth_)})};
  for (std::size_t unused = 5; unused < w.size(); ++unused) at(unused);
  if (point.kind() == PointKind::free) {
    const auto value = [&](const std::vector<std::string>& names) {
      const std::size_t column = file_.column(table, names);
      file_.rows(n, 1, column + 1);
      return require_not_negative(file_, n, names[0], at(column));
    };
    point.point.mass = value({"M", "Mass"}), point.point.volume = value({"V", "Volume", "Vol"});
    point.point.drag_area = value({"CdA"}), point.point.added_mass = value({"CA"});
    const std::vector<std::string>& names = file_.words(table);
    for (std::size_t column = 5; column < std::min(names.size(), w.size()); ++column)
      if ((names[column] == "FX" || names[column] == "FY" || names[column] == "FZ") && at(column) != 0.0)
        leave_out(fmt::format("the force {} on point {}", names[column], w[0]));
  } else if (point.kind() == PointKind::moved) {
    note_own("point " + w[0], 5, table, w);
  }
  return point;
}

std::vector<ImportedLine> MoorDynReader::read_lines() {
  const std::size_t table = section({"LINES", "LINE PROPERTIES"});
  // Version 1 has the segments' number after the length, version 2 the ends before it.
  const std::size_t type = file_.column(table, {"LineType"}), a = file_.column(table, {"AttachA", "NodeAnch"}),
                    b = file_.column(table, {"AttachB", "NodeFair"}), length = file_.column(table, {"UnstrLen"}),
                    segments = file_.column(table, {"NumSegs"});
  std::vector<ImportedLine> found;
  each_row(file_, table, [&](std::size_t n, const auto& w) {
    file_.rows(n, 1, std::max({type, a, b, length, segments}) + 1);
    if (!types_.count(w[type])) file_.fail(n, fmt::format("names line type '{}', which is not among the types", w[type]));
    for (const std::string& point : {w[a], w[b]})
      if (!points_.count(point)) file_.fail(n, fmt::format("names point {}, which is not in the table of points", point));
    const Type& t = types_[w[type]];
    ImportedLine line{{},        {},          length_of(file_, n, w[length], w[a], w[b]),          t.diameter,
                      t.mass,    t.stiffness, file_.number({"mu_kA", "FrictionCoefficient"}, 0.0), true,
                      t.dynamics};
    const LinePoint &one = points_.at(w[a]), &other = points_.at(w[b]);
    if (!place_ends(line, one, other)) return left_out_.push_back(not_tied(file_, w[0], one, other));
    meet_bed(line, w[0]);
    const double given = file_.to_number(w[segments], n);
    if (given != std::floor(given) || given < 1.0 || given > 1000.0)
      file_.fail(n, fmt::format("has {} segments: a whole number from 1 to 1000 is wanted", w[segments]));
    line.dynamics->segments = int(std::max(2.0, given));
    damp(line, t, w[0]);
    found.push_back(line);
  });
  return found;
}

/// The bed of a scene's line is at its anchor, where it has one: of an anchor that is part of the bed.
void MoorDynReader::meet_bed(ImportedLine& line, const std::string& id) {
  line.dynamics->bed_stiffness = file_.number({"kBot", "kb"}, 3e6);
  line.dynamics->bed_damping = file_.number({"cBot", "cb"}, 3e5);
  const double above = line.at_anchor.empty() ? depth_ + line.anchor.z() : 0.0;
  if (above <= 1e-6 * depth_) return;
  line.meets_bed = above < 0.05 * depth_;
  leave_out(fmt::format("the bed {:.4g} m under the anchor of line {}: {}", above, id,
                        line.meets_bed ? "it is at the anchor's level" : "the line does not meet it"));
}

/// By the critical damping of its segments.
void MoorDynReader::damp(ImportedLine& line, const Type& type, const std::string& id) {
  const double critical = line.length / line.dynamics->segments * std::sqrt(type.stiffness * type.mass);
  line.dynamics->damping_ratio = type.damping <= 0.0 ? -type.damping : type.damping / critical;
  if (line.dynamics->damping_ratio <= 1.0) return;
  leave_out(fmt::format("internal damping of line {} beyond the critical one of its segments", id));
  line.dynamics->damping_ratio = 1.0;
}

}  // namespace

ImportedMoorings read_moordyn(const Deck& file, double depth, std::vector<std::string>& left_out) {
  return MoorDynReader(file, depth, left_out).read();
}

}  // namespace spindrift::decks
