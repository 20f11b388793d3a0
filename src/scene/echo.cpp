// Options printed as TOML: the echo of a run, and the texts of defaults and conditions. See printed.hpp.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "src/scene/printed.hpp"

namespace spindrift::scene {

namespace {

/// Accessors take a pointer to mutable options because the reader fills through them; printing only looks.
void* looked_at(const void* options) { return const_cast<void*>(options); }

template <class Range, class Print>
std::string bracketed(const Range& range, Print print) {
  std::string text = "[";
  for (const auto& x : range) text += (text.size() > 1 ? ", " : "") + print(x);
  return text + "]";
}

std::string numbers(std::span<const double> x, double scale) {
  return bracketed(x, [&](double one) { return toml_number(to_key_unit(one, scale)); });
}

std::string symmetric(std::span<const double> m) {
  const bool diagonal = m[1] == 0.0 && m[2] == 0.0 && m[3] == 0.0 && m[5] == 0.0 && m[6] == 0.0 && m[7] == 0.0;
  if (diagonal) return numbers(std::vector<double>{m[0], m[4], m[8]}, 1.0);
  return fmt::format("[{}, {}, {}]", numbers(m.subspan(0, 3), 1.0), numbers(m.subspan(3, 3), 1.0), numbers(m.subspan(6, 3), 1.0));
}

std::string comment(const Parameter& p) {
  std::string text;
  if (!p.unit.empty() && p.unit != "-") text += p.unit + "; ";
  for (const Choice& c : p.choices) text += c.name + (&c == &p.choices.back() ? "; " : " | ");
  return text + p.help;
}

/// Keys first, then the tables below them: TOML's order.
void render(std::string& out, const SectionBase& section, const std::string& heading, const void* options, const Value* given) {
  const auto is_given = [&](const Parameter& p) { return given && given->find(p.key); };
  const auto alternative = [&](const Parameter& p) {
    for (const auto& group : section.exclusives())
      for (const std::string& key : group.keys)
        if (key == p.key) return true;
    return false;
  };
  for (const Parameter& p : section.parameters()) {
    if (p.kind == Kind::table || (p.kind == Kind::tables && p.member.size(options) > 0)) continue;
    if (!has_effect(section, p, options) || (alternative(p) && !is_given(p))) continue;
    if (const std::string value = printed(p, options); !value.empty())
      out += fmt::format("{} = {}  # {}\n", p.key, value, comment(p));
  }
  for (const Parameter& p : section.parameters()) {
    if (!p.nested || !has_effect(section, p, options) || (p.optional && !p.member.has(options))) continue;
    const Value* below = given ? given->find(p.key) : nullptr;
    const std::string name = heading + "." + p.key;
    if (p.kind == Kind::table) {
      out += fmt::format("\n[{}]  # {}\n", name, p.help);
      render(out, *p.nested, name, p.member.element(looked_at(options), 0), below);
      continue;
    }
    for (std::size_t i = 0; i < p.member.size(options); ++i) {
      out += fmt::format("\n[[{}]]\n", name);
      const Value* entry = below && i < below->children.size() ? &below->children[i] : nullptr;
      render(out, *p.nested, name, p.member.element(looked_at(options), i), entry);
    }
  }
}

}  // namespace

double to_key_unit(double x, double scale) {
  if (scale == 1.0 || !std::isfinite(x)) return x;
  const double quotient = x / scale;
  char text[40];
  for (int digits = 1; digits <= 17; ++digits) {
    std::snprintf(text, sizeof text, "%.*g", digits, quotient);
    if (const double candidate = std::strtod(text, nullptr); candidate * scale == x) return candidate;
  }
  double up = quotient, down = quotient;
  for (int ulps = 1; ulps <= 3; ++ulps) {
    up = std::nextafter(up, HUGE_VAL), down = std::nextafter(down, -HUGE_VAL);
    if (up * scale == x) return up;
    if (down * scale == x) return down;
  }
  return quotient;  // x is no multiple of the unit in double; the reader rounds defaults so that this does not happen
}

std::string printed(const Parameter& p, const void* options) {
  void* o = looked_at(options);
  if (p.kind == Kind::tables) return p.member.size(options) == 0 ? "[]" : "";
  if (p.nested || (p.optional && !p.member.has(options))) return "";
  if (p.kind == Kind::choice) {
    const std::size_t i = p.member.size(options);
    return i < p.choices.size() ? toml_quoted(p.choices[i].name) : "";
  }
  if (p.kind == Kind::rows) {
    std::string text;
    for (std::size_t i = 0; i < p.member.size(options); ++i) text += (i ? ", " : "") + numbers(p.member.row(o, i), p.scale);
    return "[" + text + "]";
  }
  const Slot slot = p.member.slot(o);
  if (auto* x = std::get_if<double*>(&slot)) return toml_number(to_key_unit(**x, p.scale));
  if (auto* x = std::get_if<int*>(&slot)) return std::to_string(**x);
  if (auto* x = std::get_if<std::int64_t*>(&slot)) return std::to_string(**x);
  if (auto* x = std::get_if<bool*>(&slot)) return **x ? "true" : "false";
  if (auto* x = std::get_if<std::string*>(&slot)) return p.kind == Kind::path && (*x)->empty() ? "" : toml_quoted(**x);
  if (auto* x = std::get_if<std::span<double>>(&slot)) return p.kind == Kind::symmetric ? symmetric(*x) : numbers(*x, p.scale);
  if (auto* x = std::get_if<std::vector<double>*>(&slot)) return numbers(**x, p.scale);
  if (auto* x = std::get_if<std::vector<std::string>*>(&slot))
    return bracketed(**x, [&](const std::string& s) { return p.kind == Kind::values ? s : toml_quoted(s); });
  return "";
}

std::string plain_value(const Parameter& p, const void* options) {
  if (p.kind == Kind::choice && p.member.size(options) < p.choices.size()) return p.choices[p.member.size(options)].name;
  if (p.kind == Kind::text && !(p.optional && !p.member.has(options)))
    return *std::get<std::string*>(p.member.slot(looked_at(options)));
  return printed(p, options);
}

bool holds(const SectionBase& section, const Condition& c, const void* options) {
  const Parameter* on = section.find(c.key);
  const auto among = [&](const std::string& value) { return std::ranges::find(c.values, value) != c.values.end(); };
  if (!on || has_effect(section, *on, options)) return on && among(plain_value(*on, options));
  return on->kind == Kind::flag && among("false");  // what has no effect is switched off
}

bool has_effect(const SectionBase& section, const Parameter& p, const void* options) {
  return std::all_of(p.conditions.begin(), p.conditions.end(), [&](const Condition& c) { return holds(section, c, options); });
}

std::string rendered(const SectionBase& section, const std::string& heading, const void* options, const Value* given) {
  std::string out = fmt::format("\n# {}\n[{}]\n", section.help(), heading);
  render(out, section, heading, options, given);
  return out;
}

}  // namespace spindrift::scene
