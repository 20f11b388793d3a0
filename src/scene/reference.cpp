// SPDX-License-Identifier: Apache-2.0
#include "src/scene/reference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "src/scene/error.hpp"
#include "src/scene/printed.hpp"

namespace spindrift::scene {

namespace {

/// A section under the heading it has in a scene, nested ones after the one that holds them.
struct Entry {
  const SectionBase* section;
  std::string heading;   ///< "time", "bodies.NAME", "bodies.NAME.cylinders"
  std::string brackets;  ///< "[time]", "[[bodies.NAME.cylinders]]"
  std::string help;
};

void collect(std::vector<Entry>& all, const SectionBase& section, std::string heading, bool list, std::string help) {
  all.push_back({&section, heading, (list ? "[[" : "[") + heading + (list ? "]]" : "]"), std::move(help)});
  for (const Parameter& p : section.parameters())
    if (p.nested) collect(all, *p.nested, heading + "." + p.key, p.kind == Kind::tables, p.help);
}

std::vector<Entry> entries(std::span<const SectionBase* const> sections) {
  std::vector<Entry> all;
  for (const SectionBase* s : sections) collect(all, *s, s->name() + (s->is_named() ? ".NAME" : ""), false, s->help());
  return all;
}

std::string type_of(const Parameter& p, const void* options) {
  switch (p.kind) {
    case Kind::number:
      return "number";
    case Kind::integer:
      return "integer";
    case Kind::flag:
      return "true or false";
    case Kind::text:
      return "text";
    case Kind::choice:
      return "choice";
    case Kind::path:
      return "file";
    case Kind::vector: {
      const auto defaults =
          p.optional ? std::size_t(0) : std::get<std::span<double>>(p.member.slot(const_cast<void*>(options))).size();
      return defaults ? fmt::format("{} numbers", defaults) : "numbers";
    }
    case Kind::symmetric:
      return "3 diagonal numbers or 3x3";
    case Kind::numbers:
      return "list of numbers";
    case Kind::texts:
      return "list of texts";
    case Kind::values:
      return "list of values";
    case Kind::rows:
      return "list of rows of numbers";
    case Kind::table:
      return "section";
    case Kind::tables:
      return "list of sections";
  }
  return "";
}

std::string default_of(const Parameter& p, const void* options) {
  if (p.required) return "required";
  const std::string value = p.nested ? "" : printed(p, options);
  return value.empty() ? "none" : value;
}

/// "> 0 s", "2 to 5 entries", "only if model is morison".
std::vector<std::string> limits(const Parameter& p) {
  std::vector<std::string> all;
  if (p.range.bounded()) all.push_back(p.range.describe(""));
  const bool unlimited = p.max_size == std::numeric_limits<std::size_t>::max();
  if (p.min_size > 0 || !unlimited)
    all.push_back(unlimited ? fmt::format("at least {} entries", p.min_size)
                            : fmt::format("{} to {} entries", p.min_size, p.max_size));
  for (const Condition& c : p.conditions) all.push_back(fmt::format("only if {} is {}", c.key, joined(c.values, " or ")));
  return all;
}

std::vector<std::string> alternatives(const SectionBase& section) {
  std::vector<std::string> all;
  for (const auto& group : section.exclusives())
    all.push_back(fmt::format("{} one of: {}.", group.at_most ? "At most" : "Exactly", joined(group.keys, ", ")));
  return all;
}

/// A bar would end the cell.
std::string cell(std::string text) {
  for (std::size_t i = 0; (i = text.find('|', i)) != std::string::npos; i += 2) text.replace(i, 1, "\\|");
  return text;
}

std::string in_code(const std::string& text) { return "`" + text + "`"; }

void plain(std::string& out, const Entry& entry, const Parameter& p) {
  const auto options = entry.section->default_options();
  std::vector<std::string> facts = {type_of(p, options.get())};
  if (!p.unit.empty() && p.unit != "-") facts.push_back(p.unit);
  for (const std::string& limit : limits(p)) facts.push_back(limit);
  const std::string by_default = default_of(p, options.get());
  facts.push_back(p.required ? by_default : "default " + by_default);
  out += fmt::format("  {}  ({})\n      {}\n", p.key, joined(facts, "; "), p.help);
  for (const Choice& c : p.choices) out += fmt::format("      {}: {}\n", toml_quoted(c.name), c.help);
}

void plain(std::string& out, const Entry& entry) {
  out += fmt::format("{}  {}\n", entry.brackets, entry.help);
  for (const Parameter& p : entry.section->parameters()) plain(out, entry, p);
  for (const std::string& rule : alternatives(*entry.section)) out += "  " + rule + "\n";
  out += "\n";
}

}  // namespace

std::string reference_markdown(std::span<const SectionBase* const> sections) {
  std::string out;
  for (const Entry& entry : entries(sections)) {
    const auto options = entry.section->default_options();
    out += fmt::format("\n## `{}`\n\n{}\n\n", entry.brackets, entry.help);
    for (const std::string& rule : alternatives(*entry.section)) out += rule + "\n\n";
    out += "| key | type | unit | default | allowed | meaning |\n|---|---|---|---|---|---|\n";
    for (const Parameter& p : entry.section->parameters()) {
      std::string meaning = p.help;
      for (const Choice& c : p.choices) meaning += fmt::format("<br>{}: {}", in_code(toml_quoted(c.name)), c.help);
      const std::string by_default = default_of(p, options.get());
      const bool word = by_default == "none" || by_default == "required";
      out += fmt::format("| {} | {} | {} | {} | {} | {} |\n", in_code(p.key), type_of(p, options.get()), p.unit,
                         word ? by_default : cell(in_code(by_default)), cell(joined(limits(p), "; ")), cell(meaning));
    }
  }
  return out;
}

namespace {

/// Keys with these words, whatever their case, in their name ("wind speed" in wind.speed_m_s), and then those with them in their
/// sentence or those of their choices; the first few.
std::vector<std::string> speaking_of(std::span<const SectionBase* const> sections, std::string_view words) {
  constexpr std::size_t most = 8;
  const auto plain = [](std::string text) {
    for (char& c : text) c = c == '.' || c == '_' ? ' ' : char(std::tolower(static_cast<unsigned char>(c)));
    return text;
  };
  const std::string wanted = plain(std::string(words));
  const auto has = [&](const std::string& text) { return plain(text).find(wanted) != std::string::npos; };
  std::vector<std::string> named, told;
  for (const Entry& entry : entries(sections))
    for (const Parameter& p : entry.section->parameters()) {
      const std::string key = entry.heading + "." + p.key;
      if (has(key))
        named.push_back(key);
      else if (has(p.help) || std::ranges::any_of(p.choices, [&](const Choice& c) { return has(c.name) || has(c.help); }))
        told.push_back(key);
    }
  named.insert(named.end(), told.begin(), told.end());
  if (named.size() > most) named.resize(most), named.push_back("...");
  return named;
}

/// "bodies.NAME.mass_kg" of "bodies.platform.mass_kg"; all else as it is.
std::string with_placeholder(std::span<const SectionBase* const> sections, std::string_view topic) {
  const std::size_t first = topic.find('.'), second = topic.find('.', first + 1);
  if (first == std::string_view::npos) return std::string(topic);
  const bool named = std::ranges::any_of(
      sections, [&](const SectionBase* section) { return section->is_named() && section->name() == topic.substr(0, first); });
  return !named ? std::string(topic)
                : fmt::format("{}.NAME{}", topic.substr(0, first),
                              second == std::string_view::npos ? std::string_view() : topic.substr(second));
}

}  // namespace

std::string reference_text(std::span<const SectionBase* const> sections, std::string_view topic) {
  while (topic.starts_with('[')) topic.remove_prefix(1);
  while (topic.ends_with(']')) topic.remove_suffix(1);
  std::string out;
  std::vector<std::string> known;
  for (const Entry& entry : entries(sections)) {
    const std::string& name = entry.section->name();
    known.push_back(name);
    if (topic.empty() || topic == name || topic == entry.heading ||
        (entry.heading.starts_with(topic) && entry.heading[topic.size()] == '.')) {
      plain(out, entry);
      continue;
    }
    for (const Parameter& p : entry.section->parameters()) {
      known.push_back(p.key);
      known.push_back(entry.heading + "." + p.key);
      if (topic != p.key && topic != known.back() && topic != name + "." + p.key) continue;
      out += entry.brackets + "\n";
      plain(out, entry, p);
    }
  }
  if (!out.empty()) return out;
  const std::string general = with_placeholder(sections, topic);
  std::string near = nearest(topic, known);
  if (general != topic) {
    for (const Entry& entry : entries(sections))
      for (const Parameter& p : entry.section->parameters()) {
        if (entry.heading + "." + p.key == general) return reference_text(sections, general);
        if (entry.heading == general && nearest(topic.substr(topic.rfind('.') + 1), {p.key}) == p.key) near = p.key;
      }
    const bool heads = std::ranges::any_of(entries(sections), [&](const Entry& e) { return e.heading == general; });
    if (near.empty() && heads) return reference_text(sections, general);
    if (near.empty()) near = nearest(general, known);
  }
  std::string message = "no such section or key" + (near.empty() ? std::string() : "; did you mean '" + near + "'?");
  if (const std::vector<std::string> keys = speaking_of(sections, topic); near.empty() && !keys.empty())
    message += "; keys that speak of it: " + joined(keys, ", ");
  throw SceneError({Problem{"command line", 0, std::string(topic), "", std::move(message)}});
}

}  // namespace spindrift::scene
