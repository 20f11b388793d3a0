// Single values of a scene against their parameters: type, range, size, files. See reader.hpp.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cctype>
#include <filesystem>
#include <fstream>

#include "src/scene/identity.hpp"
#include "src/scene/reader.hpp"

namespace spindrift::scene {

std::string aside(const Parameter& p) {
  std::string text = p.help;
  while (!text.empty() && text.back() == '.') text.pop_back();
  const bool sentence_case =
      text.size() > 1 && std::isupper(static_cast<unsigned char>(text[0])) && !std::isupper(static_cast<unsigned char>(text[1]));
  if (sentence_case) text[0] = char(std::tolower(static_cast<unsigned char>(text[0])));
  return text.empty() ? "" : " (" + text + ")";
}

namespace {

std::string in_unit(const Parameter& p) { return p.unit.empty() || p.unit == "-" ? "" : " in " + p.unit; }

std::string sizes(const Parameter& p) {
  if (p.min_size == p.max_size) return fmt::format("{}", p.min_size);
  if (p.max_size == std::numeric_limits<std::size_t>::max()) return fmt::format("at least {}", p.min_size);
  return fmt::format("{} to {}", p.min_size, p.max_size);
}

}  // namespace

void Reader::leaf(const Parameter& p, const Value& value, const std::string& key, const Slot& slot) {
  const auto must_be = [&](const char* what) {
    wrong(value, key, fmt::format("must be {}, not {}{}", what, value.found(), aside(p)));
  };
  if (auto* x = std::get_if<double*>(&slot)) {
    number(p, value, key, **x);
  } else if (std::holds_alternative<int*>(slot) || std::holds_alternative<std::int64_t*>(slot)) {
    integer(p, value, key, slot);
  } else if (auto* x = std::get_if<bool*>(&slot)) {
    if (value.kind == Value::Kind::flag)
      **x = value.flag;
    else
      must_be("true or false");
  } else if (auto* x = std::get_if<std::string*>(&slot)) {
    if (p.kind == Kind::path)
      path(p, value, key, **x);
    else if (value.kind == Value::Kind::text)
      **x = value.text;
    else
      must_be("a text in quotes");
  } else if (auto* x = std::get_if<std::span<double>>(&slot)) {
    if (p.kind == Kind::symmetric) return symmetric(p, value, key, *x);
    if (value.kind != Value::Kind::array || value.children.size() != x->size())
      return wrong(value, key,
                   fmt::format("must be a list of {} numbers{}, not {}{}", x->size(), in_unit(p), value.found(), aside(p)));
    for (std::size_t i = 0; i < x->size(); ++i) number(p, value.children[i], fmt::format("{}[{}]", key, i), (*x)[i]);
  } else if (auto* x = std::get_if<std::vector<double>*>(&slot)) {
    if (!is_list(p, value, key)) return;
    (*x)->assign(value.children.size(), 0.0);
    for (std::size_t i = 0; i < (*x)->size(); ++i) number(p, value.children[i], fmt::format("{}[{}]", key, i), (**x)[i]);
  } else if (auto* x = std::get_if<std::vector<std::string>*>(&slot)) {
    if (!is_list(p, value, key)) return;
    (*x)->assign(value.children.size(), "");
    for (std::size_t i = 0; i < (*x)->size(); ++i) {
      const std::string entry = fmt::format("{}[{}]", key, i);
      if (p.kind == Kind::values)
        (**x)[i] = value.children[i].toml();
      else if (p.kind == Kind::path)
        path(p, value.children[i], entry, (**x)[i]);
      else if (value.children[i].kind == Value::Kind::text)
        (**x)[i] = value.children[i].text;
      else
        wrong(value.children[i], entry, fmt::format("must be a text in quotes, not {}{}", value.children[i].found(), aside(p)));
    }
  }
}

bool Reader::is_list(const Parameter& p, const Value& value, const std::string& key) {
  if (value.kind != Value::Kind::array) {
    const bool texts = p.kind == Kind::texts || p.kind == Kind::path;
    const std::string what = p.kind == Kind::tables   ? "tables, [[" + key + "]]"
                             : texts                  ? "texts"
                             : p.kind == Kind::values ? "values"
                             : p.kind == Kind::rows   ? "rows"
                                                      : "numbers" + in_unit(p);
    return wrong(value, key, fmt::format("must be a list of {}, not {}{}", what, value.found(), aside(p))), false;
  }
  const std::size_t n = value.children.size();
  if (n >= p.min_size && n <= p.max_size) return true;
  return wrong(value, key, fmt::format("must have {} entries, not {}{}", sizes(p), n, aside(p))), false;
}

void Reader::list(const Parameter& p, const Value& value, const std::string& key, void* options) {
  if (!is_list(p, value, key)) return;
  p.member.resize(options, value.children.size());
  for (std::size_t i = 0; i < value.children.size(); ++i) {
    const Value& child = value.children[i];
    const std::string entry = fmt::format("{}[{}]", key, i);
    if (p.kind == Kind::rows)
      leaf(p, child, entry, p.member.row(options, i));
    else
      section(*p.nested, &child, entry, p.member.element(options, i));
  }
}

bool Reader::number(const Parameter& p, const Value& value, const std::string& key, double& out) {
  if (value.kind != Value::Kind::number && value.kind != Value::Kind::integer)
    return wrong(value, key, fmt::format("must be a number{}, not {}{}", in_unit(p), value.found(), aside(p))), false;
  const double x = value.kind == Value::Kind::number ? value.number : double(value.integer);
  if (!p.range.contains(x)) return wrong(value, key, fmt::format("must be {}{}", p.range.describe(p.unit), aside(p))), false;
  out = x * p.scale;
  return true;
}

void Reader::integer(const Parameter& p, const Value& value, const std::string& key, const Slot& slot) {
  if (value.kind != Value::Kind::integer)
    return wrong(value, key, fmt::format("must be an integer, not {}{}", value.found(), aside(p)));
  auto* small = std::get_if<int*>(&slot);
  const bool fits =
      !small || (value.integer >= std::numeric_limits<int>::min() && value.integer <= std::numeric_limits<int>::max());
  if (!p.range.contains(double(value.integer)) || !fits)
    return wrong(value, key,
                 fmt::format("must be {}{}", fits ? p.range.describe(p.unit) : "an integer of at most 31 bits", aside(p)));
  if (small)
    **small = int(value.integer);
  else
    *std::get<std::int64_t*>(slot) = value.integer;
}

void Reader::choice(const Parameter& p, const Value& value, const std::string& key, void* options) {
  std::vector<std::string> names;
  for (const Choice& c : p.choices) names.push_back(c.name);
  for (std::size_t i = 0; i < names.size(); ++i)
    if (value.kind == Value::Kind::text && value.text == names[i]) return p.member.resize(options, i);
  const std::string near = value.kind == Value::Kind::text ? nearest(value.text, names) : "";
  const std::string hint = near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near);
  wrong(value, key, fmt::format("must be one of \"{}\"{}{}", joined(names, "\", \""), hint, aside(p)));
}

void Reader::path(const Parameter& p, const Value& value, const std::string& key, std::string& out) {
  namespace fs = std::filesystem;
  if (value.kind != Value::Kind::text || value.text.empty() || value.text.find('\0') != std::string::npos)
    return wrong(value, key, fmt::format("must be the name of a file{}", aside(p)));
  const fs::path given = fs::path(findings_.sources[std::size_t(value.where.source)].directory) / value.text;
  fs::path path = given.lexically_normal();
  std::error_code error;
  // Behind a link to a folder, ".." is the folder above the one that it leads to, as for bases.
  if (!fs::equivalent(path, given, error)) path = fs::weakly_canonical(given.parent_path(), error) / given.filename();
  if (!fs::exists(path, error)) return wrong(value, key, fmt::format("{}: {}{}", path.string(), absent_file(path), aside(p)));
  if (fs::is_directory(path, error))
    return wrong(value, key, fmt::format("is a directory, not a file: {}{}", path.string(), aside(p)));
  if (!fs::is_regular_file(path, error))
    return wrong(value, key, fmt::format("is a device or a pipe, not a file: {}{}", path.string(), aside(p)));
  if (!std::ifstream(path)) return wrong(value, key, fmt::format("cannot be read: {}{}", path.string(), aside(p)));
  out = path.string();
  FileRecord::note(out);
}

void Reader::symmetric(const Parameter& p, const Value& value, const std::string& key, std::span<double> out) {
  const auto& rows = value.children;
  const bool list = value.kind == Value::Kind::array && rows.size() == 3;
  const bool matrix = list && rows[0].kind == Value::Kind::array;
  if (!list)
    return wrong(
        value, key,
        fmt::format("must be three diagonal numbers or three rows of three{}, not {}{}", in_unit(p), value.found(), aside(p)));
  for (double& x : out) x = 0.0;
  if (!matrix) {
    for (std::size_t i = 0; i < 3; ++i) number(p, rows[i], fmt::format("{}[{}]", key, i), out[4 * i]);
    return;
  }
  bool well = true;
  for (std::size_t i = 0; i < 3; ++i) {
    if (rows[i].kind != Value::Kind::array || rows[i].children.size() != 3)
      return wrong(rows[i], fmt::format("{}[{}]", key, i),
                   fmt::format("must be a row of 3 numbers, not {}{}", rows[i].found(), aside(p)));
    for (std::size_t j = 0; j < 3; ++j)
      well = number(p, rows[i].children[j], fmt::format("{}[{}][{}]", key, i, j), out[3 * i + j]) && well;
  }
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < i && well; ++j)
      if (out[3 * i + j] != out[3 * j + i])
        return wrong(value, key, fmt::format("must be symmetric; entries [{1}][{0}] and [{0}][{1}] differ{2}", i, j, aside(p)));
}

}  // namespace spindrift::scene
