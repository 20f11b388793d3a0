// SPDX-License-Identifier: Apache-2.0
#include "src/scene/document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "src/scene/layers.hpp"
#include "src/scene/printed.hpp"
#include "src/scene/reader.hpp"

namespace spindrift::scene {

Document::Document(Value root, std::vector<Source> sources, std::vector<Problem> problems)
    : root_(std::move(root)), findings_{std::move(sources), std::move(problems), {}}, given_sources_(findings_.sources.size()) {}

bool Document::announce(const SectionBase& section) {
  if (std::find(known_.begin(), known_.end(), &section) == known_.end()) known_.push_back(&section);
  return root_.find(section.name()) != nullptr;
}

bool Document::is_section(const SectionBase& section) const {
  const Value* value = root_.find(section.name());
  return !value || value->is_table();
}

void Document::read_into(const SectionBase& section, void* options) {
  announce(section);
  const Value* table = root_.find(section.name());
  if (Reader(findings_).section(section, table, section.name(), options))
    echo_ += rendered(section, section.name(), options, table);
}

std::vector<std::string> Document::names(const SectionBase& section) {
  announce(section);
  std::vector<std::string> names;
  const Value* all = root_.find(section.name());
  if (!all) return names;
  const std::string form = fmt::format("[{}.NAME]", section.name());
  if (!all->is_table()) {
    findings_.add(all, section.name(), all->is_list_of_tables() ? "" : all->written(), "must be sections " + form);
    return names;
  }
  for (const Value& one : all->children) {
    const std::string key = section.name() + "." + toml_key(one.key);
    if (!one.is_table())
      findings_.add(&one, key, one.is_list_of_tables() ? "" : one.written(), "must stand in a section " + form);
    else if (toml_key(one.key) != one.key)
      findings_.add(&one, key, "", "a name has letters, digits, '_' and '-' only");  // names go into columns and file names
    else
      names.push_back(one.key);
  }
  return names;
}

void Document::read_named_into(const SectionBase& section, const std::string& name, void* options) {
  const Value* table = root_.find(section.name())->find(name);
  const std::string heading = section.name() + "." + name;
  if (Reader(findings_).section(section, table, heading, options)) echo_ += rendered(section, heading, options, table);
}

void Document::read_any(const SectionBase& section) {
  if (!section.is_named()) return read_into(section, section.default_options().get());
  for (const std::string& name : names(section)) read_named_into(section, name, section.default_options().get());
}

std::pair<const Value*, bool> Document::locate(std::string_view key) const {
  const auto steps = parse_key(key);
  const Value* at = &root_;
  if (!steps) return {nullptr, false};
  for (const KeyStep& step : *steps) {
    const Value* next = at->find(step.name);
    if (!next) return {at == &root_ ? nullptr : at, false};
    at = next;
    for (const std::size_t index : step.indices) {
      if (at->kind != Value::Kind::array || index >= at->children.size()) return {at, false};
      at = &at->children[index];
    }
  }
  return {at, true};
}

namespace {
/// Is `key` the same as `other`, or something inside it?
bool within(std::string_view key, std::string_view other) {
  return key.starts_with(other) && (key.size() == other.size() || key[other.size()] == '.' || key[other.size()] == '[');
}
}  // namespace

void Document::add_defaults(const std::vector<std::string>& values) {
  std::vector<std::string> left_out;
  for (const std::string& value : values) {
    const std::string key = value.substr(0, value.find('='));
    const auto [around, found] = locate(key);
    if (!found && (!around || around->is_table())) left_out.push_back(value);
  }
  const Source program{"defaults of the program", directory()};
  Layers layers{std::move(root_), std::move(findings_.sources), std::move(findings_.problems)};
  add_overrides(layers, left_out, program);
  root_ = std::move(layers.root), findings_.sources = std::move(layers.sources), findings_.problems = std::move(layers.problems);
}

void Document::problem(std::string_view key, std::string message, std::string follows_from) {
  for (const Problem& p : findings_.problems)
    if (within(key, p.key) || within(p.key, key)) return;  // a consequence: the options hold a default there
  const auto [at, found] = locate(key);
  const bool shown = found && !at->is_table() && !at->is_list_of_tables();
  findings_.add(at, std::string(key), shown ? at->written() : "", std::move(message));
  findings_.problems.back().follows_from = std::move(follows_from);
}

SceneError Document::located(const SceneError& late) const {
  std::vector<Problem> problems = late.problems();
  for (Problem& p : problems) {
    if (p.line != 0 || p.key.empty() || (!p.source.empty() && p.source != source())) continue;
    p.source = source();
    const Value* at = locate(p.key).first;
    if (!at || std::size_t(at->where.source) >= given_sources_) continue;  // the program's own defaults have no place
    p.source = findings_.sources[std::size_t(at->where.source)].name, p.line = at->where.line;
  }
  return SceneError(std::move(problems));
}

void Findings::add(const Value* at, std::string key, std::string value, std::string message) {
  const Where where = at ? at->where : Where{};
  problems.push_back({sources[std::size_t(where.source)].name, where.line, std::move(key), std::move(value), std::move(message)});
}

std::string Document::home_of(std::string_view key) const {
  for (const SectionBase* section : known_)
    if (section->find(key))
      return fmt::format(" ({} is a key of [{}{}])", key, section->name(), section->is_named() ? ".NAME" : "");
  return "";
}

namespace {
/// What is wrong only because of a key that is wrong itself is no second mistake.
void drop_consequences(std::vector<Problem>& problems) {
  std::vector<std::string> wrong;
  for (const Problem& p : problems)
    if (p.follows_from.empty()) wrong.push_back(p.key);
  std::erase_if(problems, [&](const Problem& p) {
    return !p.follows_from.empty() && std::ranges::find(wrong, p.follows_from) != wrong.end();
  });
}

/// A body or line that only an override names, beside one of nearly that name: "; no file has bodies.plattform: did you mean
/// bodies.platform?"
std::string meant(const Value& root, const Problem& p) {
  const auto steps = p.line == 0 && p.message.starts_with("is missing") ? parse_key(p.key) : std::nullopt;
  if (!steps || steps->size() < 3) return "";
  const Value* named = root.find((*steps)[0].name);
  std::vector<std::string> others;
  if (named && named->is_table())
    for (const Value& other : named->children)
      if (other.key != (*steps)[1].name) others.push_back(other.key);
  const std::string near = nearest((*steps)[1].name, others);
  return near.empty() ? ""
                      : fmt::format("; no file has {0}.{1}: did you mean {0}.{2}?", (*steps)[0].name, (*steps)[1].name, near);
}
}  // namespace

void Document::finish() {
  for (const auto& [problem, key] : findings_.strays) findings_.problems[problem].message += home_of(key);
  findings_.strays.clear();
  drop_consequences(findings_.problems);
  for (Problem& p : findings_.problems) p.message += meant(root_, p);
  std::vector<std::string> known;
  for (const SectionBase* section : known_) known.push_back(section->name());
  for (const Value& top : root_.children) {
    if (std::find(known.begin(), known.end(), top.key) != known.end()) continue;
    const std::string near = nearest(top.key, known);
    const std::string hint =
        near.empty() ? fmt::format("a scene has: {}", joined(known, ", ")) : fmt::format("did you mean [{}]?", near);
    if (top.is_table() || top.is_list_of_tables())
      findings_.add(&top, toml_key(top.key), "", "unknown section; " + hint);
    else
      findings_.add(&top, toml_key(top.key), top.written(), "unknown key outside any section; " + hint + home_of(top.key));
  }
  if (findings_.problems.empty()) return;
  const auto order = [&](const Problem& p) {
    const auto at =
        std::find_if(findings_.sources.begin(), findings_.sources.end(), [&](const Source& s) { return s.name == p.source; });
    return std::pair(at - findings_.sources.begin(), p.line);
  };
  std::stable_sort(findings_.problems.begin(), findings_.problems.end(),
                   [&](const Problem& a, const Problem& b) { return order(a) < order(b); });
  throw SceneError(findings_.problems);
}

std::string Document::echo() const { return "# The scene as run, every default spelled out.\n" + echo_; }

namespace {
Document compose(Layers layers, const std::vector<std::string>& overrides, const Source& overrider) {
  add_overrides(layers, overrides, overrider);
  return Document(std::move(layers.root), std::move(layers.sources), std::move(layers.problems));
}
}  // namespace

Source command_line() { return {"command line", std::filesystem::current_path().string()}; }

Document load(const std::string& path, const std::vector<std::string>& overrides, const Source& overrider) {
  Layers layers;
  add_file(layers, path);
  return compose(std::move(layers), overrides, overrider);
}

Document parse(std::string_view text, const std::string& name, const std::string& directory,
               const std::vector<std::string>& overrides, const Source& overrider) {
  Layers layers;
  add_text(layers, text, name, directory);
  return compose(std::move(layers), overrides, overrider);
}

}  // namespace spindrift::scene
