// SPDX-License-Identifier: Apache-2.0
#include "src/scene/section.hpp"

#include <algorithm>
#include <cctype>

#include "kernels/base/assert.hpp"
#include "src/scene/printed.hpp"
#include "src/scene/value.hpp"

namespace spindrift::scene {

const Parameter* SectionBase::find(std::string_view key) const {
  const auto at = std::find_if(parameters_.begin(), parameters_.end(), [&](const Parameter& p) { return p.key == key; });
  return at == parameters_.end() ? nullptr : &*at;
}

Parameter& SectionBase::last() {
  SPINDRIFT_ASSERT(!parameters_.empty(), "a modifier needs a parameter before it");
  return parameters_.back();
}

namespace {

/// "kg/m3" -> "_kg_m3": how a key names its unit.
std::string unit_suffix(const std::string& unit) {
  if (unit.empty() || unit == "-") return "";
  std::string suffix = "_";
  for (const char c : unit)
    if (std::isalnum(static_cast<unsigned char>(c)))
      suffix += c;
    else if (c == ' ' || c == '/')
      suffix += '_';
  return suffix;
}

bool takes_numbers(Kind kind) {
  return kind == Kind::number || kind == Kind::integer || kind == Kind::vector || kind == Kind::numbers || kind == Kind::rows ||
         kind == Kind::symmetric;
}

bool in_range(const Parameter& p, void* options) {
  const auto good = [&](double x) { return p.range.contains(x / p.scale); };
  if (p.kind == Kind::rows) {
    for (std::size_t i = 0; i < p.member.size(options); ++i)
      for (const double x : p.member.row(options, i))
        if (!good(x)) return false;
    return true;
  }
  const Slot slot = p.member.slot(options);
  if (auto* x = std::get_if<double*>(&slot)) return good(**x);
  if (auto* x = std::get_if<int*>(&slot)) return good(**x);
  if (auto* x = std::get_if<std::int64_t*>(&slot)) return good(double(**x));
  if (auto* x = std::get_if<std::span<double>>(&slot)) return std::all_of(x->begin(), x->end(), good);
  if (auto* x = std::get_if<std::vector<double>*>(&slot)) return std::all_of((*x)->begin(), (*x)->end(), good);
  return true;
}

}  // namespace

std::vector<std::string> SectionBase::faults() const {
  std::vector<std::string> faults;
  const auto options = default_options();
  const auto fault = [&](const Parameter& p, const std::string& what) { faults.push_back(name_ + "." + p.key + ": " + what); };
  if (help_.empty()) faults.push_back(name_ + ": has no sentence");
  for (const Parameter& p : parameters_) {
    if (find(p.key) != &p) fault(p, "is declared twice");
    if (p.help.empty() || p.help.back() != '.') fault(p, "needs a sentence that ends with a full stop");
    if (takes_numbers(p.kind) && p.unit.empty()) fault(p, "needs a unit, '-' where it has none");
    if (!p.key.ends_with(unit_suffix(p.unit))) fault(p, "does not name its unit " + p.unit);
    if (takes_numbers(p.kind) && !p.required && !p.optional && !in_range(p, options.get()))
      fault(p, "has a default outside its range: " + printed(p, options.get()));
    if (p.kind == Kind::choice && p.member.size(options.get()) == p.choices.size()) fault(p, "has a default that is no choice");
    for (const Choice& c : p.choices)
      if (c.help.empty()) fault(p, "has no words for the choice " + c.name);
    for (const Condition& c : p.conditions) {
      const Parameter* on = find(c.key);
      if (!on || (on->kind != Kind::choice && on->kind != Kind::text && on->kind != Kind::flag))
        fault(p, "depends on " + c.key + ", which is no choice, text or flag");
      else if (on >= &p)
        fault(p, "must be declared after " + c.key + ", which it depends on");
      else if (on->kind == Kind::choice)
        for (const std::string& value : c.values)
          if (std::none_of(on->choices.begin(), on->choices.end(), [&](const Choice& x) { return x.name == value; }))
            fault(p, "depends on " + c.key + " = " + value + ", which is no choice of it");
    }
    if (p.nested)
      for (const std::string& inner : p.nested->faults()) faults.push_back(name_ + "." + inner);
  }
  for (const Exclusive& group : exclusives_)
    for (const std::string& key : group.keys)
      if (!find(key)) faults.push_back(name_ + ": an exclusive group names " + key + ", which is no key");
  return faults;
}

}  // namespace spindrift::scene
