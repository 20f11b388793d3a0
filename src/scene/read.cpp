// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "src/scene/printed.hpp"
#include "src/scene/reader.hpp"

namespace spindrift::scene {

namespace {

/// The parameter's sentence as an aside: "(length of a coupling window)".
std::string aside(const Parameter& p) {
  std::string text = p.help;
  while (!text.empty() && text.back() == '.') text.pop_back();
  const bool sentence_case =
      text.size() > 1 && std::isupper(static_cast<unsigned char>(text[0])) && !std::isupper(static_cast<unsigned char>(text[1]));
  if (sentence_case) text[0] = char(std::tolower(static_cast<unsigned char>(text[0])));
  return text.empty() ? "" : " (" + text + ")";
}

std::string in_unit(const Parameter& p) { return p.unit.empty() || p.unit == "-" ? "" : " in " + p.unit; }

std::string section_label(const std::string& name) { return "[" + name + "]"; }

std::string sizes(const Parameter& p) {
  if (p.min_size == p.max_size) return fmt::format("{}", p.min_size);
  if (p.max_size == std::numeric_limits<std::size_t>::max()) return fmt::format("at least {}", p.min_size);
  return fmt::format("{} to {}", p.min_size, p.max_size);
}

/// "model is "morison" or "potential""
std::string words(const Condition& c) { return fmt::format("{} is {}", c.key, joined(c.values, " or ")); }

/// A default that its unit cannot express exactly is moved to the nearest value that it can, so that the echo reads back
/// to the same bits.
void round_default(const Parameter& p, void* options) {
  if (p.scale == 1.0 || (p.optional && !p.member.has(options))) return;
  const Slot slot = p.member.slot(options);
  const auto round = [&](double& x) { x = to_key_unit(x, p.scale) * p.scale; };
  if (auto* x = std::get_if<double*>(&slot)) round(**x);
  if (auto* x = std::get_if<std::span<double>>(&slot))
    for (double& one : *x) round(one);
  if (auto* x = std::get_if<std::vector<double>*>(&slot))
    for (double& one : **x) round(one);
}

}  // namespace

bool Reader::section(const SectionBase& section, const Value* table, const std::string& name, void* options) {
  const std::size_t before = document_.problems_.size();
  if (table && !table->is_table()) {
    wrong(*table, name, fmt::format("must be a section, {}, not {}", section_label(name), table->found()));
    return false;
  }
  Names bad;
  for (const Parameter& p : section.parameters()) {
    const std::size_t so_far = document_.problems_.size();
    const std::string key = name + "." + p.key;
    if (const Value* value = table ? table->find(p.key) : nullptr)
      parameter(p, *value, key, options);
    else if (p.kind == Kind::table && !p.optional)
      this->section(*p.nested, nullptr, key, p.member.element(options, 0));
    else
      round_default(p, options);
    if (document_.problems_.size() != so_far) bad.insert(p.key);
  }
  if (table) unknown_keys(section, *table, name);
  conditions(section, table, name, options, bad);
  if (bad.empty()) alternatives(section, table, name, options);
  if (document_.problems_.size() == before) rules(section, table, name, options);
  return document_.problems_.size() == before;
}

void Reader::parameter(const Parameter& p, const Value& value, const std::string& key, void* options) {
  switch (p.kind) {
    case Kind::table:
      section(*p.nested, &value, key, p.member.element(options, 0));
      return;
    case Kind::rows:
    case Kind::tables:
      list(p, value, key, options);
      return;
    case Kind::choice:
      choice(p, value, key, options);
      return;
    default:
      leaf(p, value, key, p.member.slot(options));
  }
}

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
  const fs::path path = (fs::path(document_.sources_[std::size_t(value.where.source)].directory) / value.text).lexically_normal();
  std::error_code error;
  if (!fs::exists(path, error)) return wrong(value, key, fmt::format("no such file: {}{}", path.string(), aside(p)));
  if (fs::is_directory(path, error))
    return wrong(value, key, fmt::format("is a directory, not a file: {}{}", path.string(), aside(p)));
  if (!std::ifstream(path)) return wrong(value, key, fmt::format("cannot be read: {}{}", path.string(), aside(p)));
  out = path.string();
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

void Reader::unknown_keys(const SectionBase& section, const Value& table, const std::string& name) {
  std::vector<std::string> known;
  for (const Parameter& p : section.parameters()) known.push_back(p.key);
  for (const Value& child : table.children) {
    if (section.find(child.key)) continue;
    const std::string near = nearest(child.key, known);
    const std::string hint = near.empty() ? fmt::format("{} has: {}", section_label(name), joined(known, ", "))
                                          : fmt::format("did you mean '{}'?", near);
    wrong(child, name + "." + toml_key(child.key), "unknown key; " + hint);
    if (near.empty()) document_.strays_.emplace_back(document_.problems_.size() - 1, child.key);
  }
}

void Reader::conditions(const SectionBase& section, const Value* table, const std::string& name, const void* options,
                        const Names& bad) {
  for (const Parameter& p : section.parameters()) {
    const Value* value = table ? table->find(p.key) : nullptr;
    const Condition* unmet = nullptr;
    bool doubtful = bad.count(p.key) > 0;
    for (const Condition& c : p.conditions) {
      const Parameter* on = section.find(c.key);
      doubtful = doubtful || !on || bad.count(c.key) > 0;
      if (!unmet && !holds(section, c, options)) unmet = &c;
    }
    if (doubtful) continue;
    if (value && unmet) {
      const Parameter& on = *section.find(unmet->key);
      wrong(*value, name + "." + p.key,
            fmt::format("has no effect here: only where {}, and {} is {}{}", words(*unmet), unmet->key, plain_value(on, options),
                        aside(p)));
    } else if (!value && !unmet && p.required) {
      missing(table, name + "." + p.key, "is missing and has no default" + aside(p));
    }
  }
}

void Reader::alternatives(const SectionBase& section, const Value* table, const std::string& name, const void* options) {
  for (const SectionBase::Exclusive& group : section.exclusives()) {
    std::vector<std::string> allowed;
    std::vector<const Value*> given;
    for (const std::string& key : group.keys) {
      const Parameter* p = section.find(key);
      if (!p || !has_effect(section, *p, options)) continue;
      allowed.push_back(key);
      if (const Value* value = table ? table->find(key) : nullptr) given.push_back(value);
    }
    if (given.size() > 1)
      wrong(*given[1], name + "." + given[1]->key,
            fmt::format("cannot stand beside {}; give one of: {}", given[0]->key, joined(allowed, ", ")));
    if (given.empty() && !group.at_most && !allowed.empty())
      missing(table, name, fmt::format("give exactly one of: {}", joined(allowed, ", ")));
  }
}

void Reader::rules(const SectionBase& section, const Value* table, const std::string& name, const void* options) {
  for (const auto& check : section.checks())
    check(options, [&](std::string_view key, std::string message) {
      const Value* value = table && !key.empty() ? table->find(key) : nullptr;
      const std::string full = key.empty() ? name : name + "." + std::string(key);
      if (value)
        wrong(*value, full, std::move(message));
      else
        missing(table, full, std::move(message));
    });
}

void Reader::wrong(const Value& at, const std::string& key, std::string message) {
  document_.add(&at, key, at.is_table() || at.is_list_of_tables() ? "" : at.written(), std::move(message));
}

void Reader::missing(const Value* table, const std::string& key, std::string message) {
  document_.add(table, key, "", std::move(message));
}

}  // namespace spindrift::scene
