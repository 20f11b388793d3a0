// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "src/scene/printed.hpp"
#include "src/scene/reader.hpp"

namespace spindrift::scene {

namespace {

std::string section_label(const std::string& name) { return "[" + name + "]"; }

/// "model is "morison" or "potential""
std::string words(const Condition& c) {
  if (c.values.size() == 1 && c.values[0].empty()) return fmt::format("{} is left out", c.key);
  return fmt::format("{} is {}", c.key, joined(c.values, " or "));
}

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
  const std::size_t before = findings_.problems.size();
  if (table && !table->is_table()) {
    wrong(*table, name, fmt::format("must be a section, {}, not {}", section_label(name), table->found()));
    return false;
  }
  Names bad;
  for (const Parameter& p : section.parameters()) {
    const std::size_t so_far = findings_.problems.size();
    const std::string key = name + "." + p.key;
    if (const Value* value = table ? table->find(p.key) : nullptr)
      parameter(p, *value, key, options);
    else if (p.kind == Kind::table && !p.optional)
      this->section(*p.nested, nullptr, key, p.member.element(options, 0));
    else
      round_default(p, options);
    if (findings_.problems.size() != so_far) bad.insert(p.key);
  }
  if (table) unknown_keys(section, *table, name);
  conditions(section, table, name, options, bad);
  if (bad.empty()) alternatives(section, table, name, options);
  if (findings_.problems.size() == before) rules(section, table, name, options);
  return findings_.problems.size() == before;
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
    case Kind::number:
    case Kind::integer:
    case Kind::flag:
    case Kind::text:
    case Kind::path:
    case Kind::vector:
    case Kind::symmetric:
    case Kind::numbers:
    case Kind::texts:
    case Kind::values:
      leaf(p, value, key, p.member.slot(options));
  }
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
    if (near.empty()) findings_.strays.emplace_back(findings_.problems.size() - 1, child.key);
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
  findings_.add(&at, key, at.is_table() || at.is_list_of_tables() ? "" : at.written(), std::move(message));
}

void Reader::missing(const Value* table, const std::string& key, std::string message) {
  findings_.add(table, key, "", std::move(message));
}

}  // namespace spindrift::scene
