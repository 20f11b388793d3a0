// SPDX-License-Identifier: Apache-2.0
#include "src/scene/value.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <utility>

namespace spindrift::scene {

bool Value::is_list_of_tables() const {
  return kind == Kind::array && std::any_of(children.begin(), children.end(), [](const Value& v) { return v.is_table(); });
}

const Value* Value::find(std::string_view name) const {
  if (!is_table()) return nullptr;
  const auto at = std::find_if(children.begin(), children.end(), [&](const Value& v) { return v.key == name; });
  return at == children.end() ? nullptr : &*at;
}

Value* Value::find(std::string_view name) { return const_cast<Value*>(std::as_const(*this).find(name)); }

bool Value::erase(std::string_view name) {
  return std::erase_if(children, [&](const Value& v) { return v.key == name; }) > 0;
}

namespace {
/// TOML text, given up soon after `enough` characters.
void write(std::string& out, const Value& value, std::size_t enough) {
  switch (value.kind) {
    case Value::Kind::flag:
      out += value.flag ? "true" : "false";
      return;
    case Value::Kind::integer:
      out += std::to_string(value.integer);
      return;
    case Value::Kind::number:
      out += toml_number(value.number);
      return;
    case Value::Kind::text:
      out += toml_quoted(value.text);
      return;
    case Value::Kind::date:
      out += value.text;
      return;
    case Value::Kind::array:
    case Value::Kind::table:
      break;
  }
  out += value.is_table() ? '{' : '[';
  for (const Value& child : value.children) {
    if (out.size() > enough) return;
    if (&child != &value.children.front()) out += ", ";
    if (value.is_table()) out += toml_key(child.key) + " = ";
    write(out, child, enough);
  }
  out += value.is_table() ? '}' : ']';
}
}  // namespace

std::string Value::toml() const {
  std::string text;
  write(text, *this, std::string::npos);
  return text;
}

std::string Value::written() const {
  constexpr std::size_t longest = 60;
  std::string text;
  write(text, *this, longest);
  if (text.size() > longest) {
    std::size_t cut = longest - 4;
    while (cut > 0 && (static_cast<unsigned char>(text[cut]) & 0xc0) == 0x80) --cut;  // not inside a UTF-8 character
    text = text.substr(0, cut) + " ...";
  }
  return text;
}

std::string Value::found() const {
  switch (kind) {
    case Kind::flag:
      return "true or false";
    case Kind::integer:
      return "an integer";
    case Kind::number:
      return "a number with a decimal point";
    case Kind::text:
      return "a text";
    case Kind::date:
      return "a date or time";
    case Kind::array:
      return fmt::format("a list of {}", children.size());
    case Kind::table:
      return "a table";
  }
  return "";
}

std::string joined(const std::vector<std::string>& words, std::string_view between) {
  std::string text;
  for (const std::string& word : words) {
    if (&word != &words.front()) text += between;
    text += word;
  }
  return text;
}

std::string toml_quoted(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      quoted += '\\', quoted += c;
    else if (c == '\n')
      quoted += "\\n";
    else if (c == '\t')
      quoted += "\\t";
    else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      quoted += fmt::format("\\u{:04X}", static_cast<unsigned char>(c));
    else
      quoted += c;
  }
  return quoted + '"';
}

std::string toml_number(double x) {
  if (std::isnan(x)) return "nan";
  if (std::isinf(x)) return x > 0 ? "inf" : "-inf";
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, x).ptr;
  std::string text(buffer, end);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  if (const std::size_t e = text.find('e'); e != std::string::npos) {  // 4e8 rather than 4e+08
    std::size_t digits = e + 1 + (text[e + 1] == '-');
    while (text[digits] == '+' || (text[digits] == '0' && digits + 1 < text.size())) text.erase(digits, 1);
  }
  return text;
}

std::string toml_key(std::string_view key) {
  const bool bare = !key.empty() && std::all_of(key.begin(), key.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
  return bare ? std::string(key) : toml_quoted(key);
}

namespace {
/// Levenshtein distance, with a swap of neighbours as one edit (optimal string alignment).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), row(b.size() + 1), next(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    next[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      next[j] = std::min({row[j] + 1, next[j - 1] + 1, row[j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) next[j] = std::min(next[j], before[j - 2] + 1);
    }
    before.swap(row);
    row.swap(next);
  }
  return row[b.size()];
}
}  // namespace

namespace {
/// RK4 is meant for rk4.
std::string lowered(std::string_view word) {
  std::string small(word);
  for (char& c : small)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  return small;
}
}  // namespace

std::string nearest(std::string_view word, const std::vector<std::string>& known) {
  constexpr std::size_t longest = 100;  // no slip of the hand is longer; keeps the quadratic distance cheap
  if (word.size() > longest) return "";
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const std::string& candidate : known) {
    // The commonest slip: the unit forgotten, `end` for `end_s`.
    const bool unit_forgotten =
        word.size() > 1 && candidate.size() > word.size() && candidate.starts_with(word) && candidate[word.size()] == '_';
    const std::size_t distance = unit_forgotten ? 1 : edit_distance(lowered(word), lowered(candidate));
    if (distance < best_distance) best = candidate, best_distance = distance;
  }
  if (!best.empty()) return best;
  // A word too many before it, `significant_height_m` for `height_m`, or one too few, `length_m` for `rest_length_m`.
  int longer = 0;
  for (const std::string& candidate : known) {
    if (candidate.size() > best.size() && word.ends_with("_" + candidate)) best = candidate;
    longer += candidate.ends_with(fmt::format("_{}", word));
  }
  if (best.empty() && longer == 1 && word.size() > 3)
    best = *std::ranges::find_if(known, [&](const std::string& c) { return c.ends_with(fmt::format("_{}", word)); });
  return best;
}

std::string absent_file(const std::filesystem::path& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  // The documents name scenes as seen from the top of the sources; an installation has them beside its program.
  const fs::path installed = fs::read_symlink("/proc/self/exe", error).parent_path() / "../share/spindrift" / path;
  if (path.is_relative() && fs::is_regular_file(installed, error))
    return "no such file here; the installed one is " + fs::canonical(installed, error).string();
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, error))
    return "no such file: there is no folder " + fs::absolute(folder).lexically_normal().string();
  std::vector<std::string> names;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end && names.size() < 10'000; entry.increment(error))
    if (std::error_code of_entry; !entry->is_directory(of_entry) && entry->path().extension() == path.extension())
      names.push_back(entry->path().stem().string());
  std::sort(names.begin(), names.end());
  const std::string near = nearest(path.stem().string(), names);
  return near.empty() ? "no such file in " + fs::canonical(folder, error).string()
                      : "no such file; did you mean '" + (path.parent_path() / near).string() + path.extension().string() + "'?";
}

}  // namespace spindrift::scene
