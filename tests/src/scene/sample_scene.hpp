// Random scenes made from declarations: every kind of parameter, values in range, conditions and alternatives respected.
// What only a section's own checks know is not: such scenes may be refused. Used by the tests of echoes.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>

#include "src/scene/section.hpp"
#include "src/scene/value.hpp"

namespace spindrift::scene {

class SampleScene {
 public:
  /// `file`: an existing file that paths may name.
  SampleScene(unsigned seed, std::string file) : random_(seed), file_(std::move(file)) {}

  /// "[time]\nend_s = ..." or "[bodies.a]\n...".
  std::string section(const SectionBase& section) {
    const std::string heading = section.name() + (section.is_named() ? ".a" : "");
    return "[" + heading + "]\n" + keys(section, heading);
  }

 private:
  double uniform() { return std::uniform_real_distribution(0.0, 1.0)(random_); }
  std::size_t below(std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_); }

  double number(const Range& r) {
    const double power = std::ldexp(1.0, int(below(8)) - 3);  // powers of two are often multiples of each other, as steps must be
    if (uniform() < 0.5 && r.contains(power)) return power;
    const double size = std::exp(20.0 * uniform() - 10.0);
    if (std::isfinite(r.low) && std::isfinite(r.high)) return r.low + (r.high - r.low) * (0.01 + 0.98 * uniform());
    if (std::isfinite(r.low)) return r.low + size;
    if (std::isfinite(r.high)) return r.high - size;
    return uniform() < 0.5 ? size : -size;
  }
  std::string list(std::size_t n, const Range& r) {
    std::string text = "[";
    for (std::size_t i = 0; i < n; ++i) text += (i ? ", " : "") + toml_number(number(r));
    return text + "]";
  }
  std::size_t length(const Parameter& p) { return p.min_size + below(std::min<std::size_t>(p.max_size - p.min_size, 3) + 1); }

  /// TOML text of one value; `options` are defaults to ask for sizes.
  std::string value(const Parameter& p, void* options) {
    const std::vector<std::string> texts = {"\"\"", "\"a b\"", "\"tab\\t and \\\"quotes\\\"\"", "'\\'", "\"\\u00e9\""};
    switch (p.kind) {
      case Kind::number:
        return toml_number(number(p.range));
      case Kind::integer:
        return std::to_string(std::llround(std::ceil(std::clamp(number(p.range), -1e9, 1e9))));
      case Kind::flag:
        return uniform() < 0.5 ? "true" : "false";
      case Kind::text:
        return texts[below(texts.size())];
      case Kind::choice:
        return toml_quoted(p.choices[below(p.choices.size())].name);
      case Kind::path:
        return toml_quoted(file_);
      case Kind::vector:
        return list(std::get<std::span<double>>(p.member.slot(options)).size(), p.range);
      case Kind::symmetric:
        return uniform() < 0.5 ? "[3.0, 4.0, 5.0]" : "[[3.0, 0.1, -0.25], [0.1, 4.0, 0.0], [-0.25, 0.0, 5.0]]";
      case Kind::numbers:
        return list(length(p), p.range);
      case Kind::texts: {
        std::string text = "[";
        for (std::size_t i = 0, n = length(p); i < n; ++i) text += (i ? ", " : "") + texts[below(texts.size())];
        return text + "]";
      }
      case Kind::values:
        return "[1, 2.5, \"x\", [true]]";
      case Kind::rows: {
        p.member.resize(options, 1);
        std::string text = "[";
        for (std::size_t i = 0, n = length(p); i < n; ++i)
          text += (i ? ", " : "") + list(p.member.row(options, 0).size(), p.range);
        return text + "]";
      }
      case Kind::table:
      case Kind::tables:
        break;
    }
    return "";
  }

  /// Do its conditions hold, given what was written and what defaults say?
  static bool has_effect(const SectionBase& section, const Parameter& p, const std::map<std::string, std::string>& plain) {
    return std::all_of(p.conditions.begin(), p.conditions.end(), [&](const Condition& c) {
      return has_effect(section, *section.find(c.key), plain) && std::count(c.values.begin(), c.values.end(), plain.at(c.key));
    });
  }

  static std::string default_of(const Parameter& p, void* options) {
    if (p.kind == Kind::choice) return p.choices.at(p.member.size(options)).name;
    if (p.kind == Kind::flag && !p.optional) return *std::get<bool*>(p.member.slot(options)) ? "true" : "false";
    if (p.kind == Kind::text && !p.optional) return *std::get<std::string*>(p.member.slot(options));
    return "";
  }

  std::string keys(const SectionBase& section, const std::string& heading) {
    const auto options = section.default_options();
    std::map<std::string, std::string> plain;  // what conditions compare
    std::string here, below_here;
    std::vector<const SectionBase::Exclusive*> settled;
    for (const Parameter& p : section.parameters()) {
      if (p.kind == Kind::choice || p.kind == Kind::flag || p.kind == Kind::text) plain[p.key] = default_of(p, options.get());
      if (!has_effect(section, p, plain) || !wanted(section, p, settled)) continue;
      if (p.kind == Kind::table) {
        below_here += "[" + heading + "." + p.key + "]\n" + keys(*p.nested, heading + "." + p.key);
      } else if (p.kind == Kind::tables) {
        for (std::size_t i = 0, n = length(p); i < n; ++i)
          below_here += "[[" + heading + "." + p.key + "]]\n" + keys(*p.nested, heading + "." + p.key);
      } else {
        const std::string text = value(p, options.get());
        here += p.key + " = " + text + "\n";
        if (plain.count(p.key)) plain[p.key] = p.kind == Kind::flag ? text : text.substr(1, text.size() - 2);
      }
    }
    return here + below_here;
  }

  /// Required: always. Of alternatives the first that comes with luck, or nothing: then the scene may be refused. Else: mostly.
  bool wanted(const SectionBase& section, const Parameter& p, std::vector<const SectionBase::Exclusive*>& settled) {
    bool give = p.required || uniform() < 0.7;
    for (const auto& group : section.exclusives()) {
      if (!std::count(group.keys.begin(), group.keys.end(), p.key)) continue;
      if (std::count(settled.begin(), settled.end(), &group)) return false;
      if (give) settled.push_back(&group);
    }
    return give;
  }

  std::mt19937 random_;
  std::string file_;
};

}  // namespace spindrift::scene
