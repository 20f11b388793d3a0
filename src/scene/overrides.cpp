// Overrides of the command line and of studies, "a.b[1].c=value", put into the tree of a scene. See layers.hpp.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cctype>
#include <charconv>

#include "src/scene/layers.hpp"
#include "src/scene/toml_reader.hpp"

namespace spindrift::scene {

namespace {

bool is_bare(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

void mark(Value& value, int source) {
  value.where = {source, 0};
  for (Value& child : value.children) mark(child, source);
}

/// The value of an override: TOML, or a bare word taken as text.
std::optional<Value> override_value(std::string_view text, int source, std::string& why_not) {
  constexpr std::string_view white = " \t";
  const std::size_t first = text.find_first_not_of(white);
  if (first == std::string_view::npos) return why_not = "has no value; write KEY=VALUE", std::nullopt;
  text = text.substr(first, text.find_last_not_of(white) - first + 1);
  std::string why_not_toml;
  try {
    Value root = read_toml("value = " + std::string(text), source, "");
    if (root.children.size() == 1 && root.children[0].key == "value") {
      mark(root, source);
      return std::move(root.children[0]);
    }
    why_not_toml = "is more than one value";
  } catch (const SceneError& error) { why_not_toml = error.problems().front().message; }
  const char c = text.front();
  const bool word = std::isalpha(static_cast<unsigned char>(c)) || c == '_' || c == '/' ||
                    (c == '.' && text.size() > 1 && !std::isdigit(static_cast<unsigned char>(text[1])));
  if (!word || text.find('\n') != std::string_view::npos)
    return why_not = why_not_toml + " (texts may go without quotes if they begin with a letter)", std::nullopt;
  Value value;
  value.kind = Value::Kind::text;
  value.text = std::string(text);
  value.where = {source, 0};
  return value;
}

/// Follows one override down the tree and puts its value there.
std::string set_value(Value& root, const std::vector<KeyStep>& steps, Value value) {
  Value* at = &root;
  for (const KeyStep& step : steps) {
    if (!at->is_table()) *at = Value{.key = at->key, .where = value.where};
    Value* next = at->find(step.name);
    if (!next) {
      at->children.push_back(Value{.key = step.name, .where = value.where});
      next = &at->children.back();
    }
    for (const std::size_t index : step.indices) {
      if (next->kind != Value::Kind::array) return fmt::format("'{}' is not a list in the scene", step.name);
      if (index >= next->children.size())
        return fmt::format("'{}' has {} entries, numbered from 0", step.name, next->children.size());
      next = &next->children[index];
    }
    at = next;
  }
  if (at->is_table() && value.is_table())
    overlay(*at, std::move(value));
  else {
    value.key = at->key;
    *at = std::move(value);
  }
  return "";
}

}  // namespace

std::optional<std::vector<KeyStep>> parse_key(std::string_view text) {
  std::vector<KeyStep> steps;
  std::size_t i = 0;
  constexpr std::size_t deepest = 32;
  while (steps.size() < deepest) {
    KeyStep step;
    if (i < text.size() && (text[i] == '"' || text[i] == '\'')) {
      const std::size_t end = text.find(text[i], i + 1);
      if (end == std::string_view::npos) return std::nullopt;
      step.name = std::string(text.substr(i + 1, end - i - 1));
      i = end + 1;
    } else {
      while (i < text.size() && is_bare(text[i])) step.name += text[i++];
      if (step.name.empty()) return std::nullopt;
    }
    while (i < text.size() && text[i] == '[') {
      std::size_t index = 0;
      const auto [end, error] = std::from_chars(text.data() + i + 1, text.data() + text.size(), index);
      if (error != std::errc() || end == text.data() + text.size() || *end != ']') return std::nullopt;
      step.indices.push_back(index);
      i = std::size_t(end - text.data()) + 1;
    }
    steps.push_back(std::move(step));
    if (i == text.size()) return steps;
    if (text[i++] != '.') return std::nullopt;
  }
  return std::nullopt;
}

void add_overrides(Layers& layers, const std::vector<std::string>& overrides, const Source& from) {
  if (overrides.empty()) return;
  const int source = int(layers.sources.size());
  layers.sources.push_back(from);
  for (const std::string& text : overrides) {
    const std::size_t equals = text.find('=');
    std::string key = text.substr(0, equals);
    while (key.ends_with(' ')) key.pop_back();
    const auto steps = parse_key(key);
    const auto complain = [&](std::string about, std::string value, std::string message) {
      layers.problems.push_back({from.name, 0, std::move(about), std::move(value), std::move(message)});
    };
    if (equals == std::string::npos || !steps) {
      complain(text, "", "is no override; write SECTION.KEY=VALUE or bodies.NAME.KEY=VALUE");
      continue;
    }
    std::string why_not;
    const std::string_view written = std::string_view(text).substr(equals + 1);
    std::optional<Value> value = override_value(written, source, why_not);
    if (!value) {
      complain(key, std::string(written), why_not);
      continue;
    }
    if (key == "base") {
      complain(key, value->written(), "base files are named in scene files only");
    } else if (key == "without") {
      Value root;
      value->key = key;
      root.children.push_back(std::move(*value));
      for (const Value& gone : take_texts(layers, root, key)) take_away(layers, layers.root, gone);
    } else {
      Value changed = layers.root;
      if (const std::string problem = set_value(changed, *steps, *value); problem.empty())
        layers.root = std::move(changed);
      else
        complain(key, value->written(), problem);
    }
  }
}

}  // namespace spindrift::scene
