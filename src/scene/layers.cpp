// SPDX-License-Identifier: Apache-2.0
#include "src/scene/layers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "src/scene/toml_reader.hpp"

namespace spindrift::scene {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t most_files = 64;  // in one scene, bases of bases counted; more is a mistake

bool is_bare(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

/// Whole content of a file, or the reason why not.
std::optional<std::string> read_file(const fs::path& path, std::string& why_not) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) return why_not = error && error.value() != ENOENT ? error.message() : "no such file", std::nullopt;
  if (fs::is_directory(status)) return why_not = "is a directory, not a scene file", std::nullopt;
  std::ifstream in(path, std::ios::binary);
  if (!in) return why_not = fmt::format("cannot be opened: {}", std::strerror(errno)), std::nullopt;
  std::string text;
  constexpr std::size_t enough = 5u << 20;  // more than read_toml accepts; keeps /dev/zero finite
  char block[1 << 16];
  while (text.size() < enough && (in.read(block, sizeof block), in.gcount() > 0)) text.append(block, std::size_t(in.gcount()));
  if (in.bad()) return why_not = fmt::format("cannot be read: {}", std::strerror(errno)), std::nullopt;
  return text;
}

class FileReader {
 public:
  explicit FileReader(Layers& layers) : layers_(layers) {}

  /// `path` is opened, `name` shown; `named_by` is the base entry that asks for it.
  Value file(const fs::path& path, const std::string& name, const Value* named_by) {
    std::string why_not;
    const std::optional<std::string> text = read_file(path, why_not);
    if (!text) {
      if (!named_by) throw SceneError({Problem{name, 0, "", "", why_not}});
      stop(*named_by, fmt::format("{}: {}", name, why_not));
    }
    const std::string canonical = fs::weakly_canonical(fs::absolute(path)).string();
    if (const auto again = std::find(chain_.begin(), chain_.end(), canonical); again != chain_.end()) {
      std::vector<std::string> names(again, chain_.end());
      for (std::string& link : names) link = fs::path(link).filename().string();
      stop(*named_by, fmt::format("the base files form a cycle: {} -> {}", joined(names, " -> "), names.front()));
    }
    chain_.push_back(canonical);
    Value value = this->text(*text, name, fs::absolute(path).parent_path().string());
    chain_.pop_back();
    return value;
  }

  Value text(std::string_view text, const std::string& name, const std::string& directory) {
    const int source = int(layers_.sources.size());
    layers_.sources.push_back({name, directory});
    if (layers_.sources.size() > most_files)
      throw SceneError({Problem{name, 0, "", "", fmt::format("the scene is based on more than {} files", most_files)}});
    Value own = read_toml(text, source, name);
    Value result;
    result.where = own.where;
    for (const Value& base : take_texts(own, "base")) {
      const fs::path shown = fs::path(name).parent_path() / base.text;  // as short as the user's own name of the scene
      overlay(result, file(fs::path(directory) / base.text, shown.lexically_normal().string(), &base));
    }
    for (const Value& key : take_texts(own, "without")) remove(layers_, result, key);
    overlay(result, std::move(own));
    return result;
  }

  /// Takes a text or a list of texts out of the top of a file.
  std::vector<Value> take_texts(Value& root, std::string_view name) {
    const Value* at = root.find(name);
    if (!at) return {};
    const Value value = *at;
    root.erase(name);
    const std::vector<Value> texts = value.kind == Value::Kind::array ? value.children : std::vector{value};
    for (const Value& text : texts)
      if (text.kind != Value::Kind::text)
        stop(value, fmt::format("must be a text or a list of texts, not {}", text.found()), text.written());
    std::vector<Value> named = texts;
    for (Value& text : named) text.key = std::string(name);
    return named;
  }

  static void remove(Layers& layers, Value& root, const Value& key) {
    const auto steps = parse_key(key.text);
    Value* at = &root;
    bool gone = false;
    if (steps) {
      for (std::size_t i = 0; at && i + 1 < steps->size(); ++i)
        at = (*steps)[i].indices.empty() ? at->find((*steps)[i].name) : nullptr;
      gone = at && steps->back().indices.empty() && at->is_table() && at->erase(steps->back().name);
    }
    if (!gone)
      layers.problems.push_back({layers.sources[std::size_t(key.where.source)].name, key.where.line, key.key, key.written(),
                                 "names a key that the base does not have"});
  }

 private:
  [[noreturn]] void stop(const Value& at, std::string message, std::string value = "") {
    throw SceneError({Problem{layers_.sources[std::size_t(at.where.source)].name, at.where.line, at.key,
                              value.empty() ? at.written() : value, std::move(message)}});
  }

  Layers& layers_;
  std::vector<std::string> chain_;  // canonical paths of the files being read, outermost first
};

void mark(Value& value, int source) {
  value.where = {source, 0};
  for (Value& child : value.children) mark(child, source);
}

/// The value of an override: TOML, or a bare word taken as text.
std::optional<Value> override_value(std::string_view text, int source, std::string& why_not) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return why_not = "has no value; write KEY=VALUE", std::nullopt;
  std::string why_not_toml;
  try {
    Value root = read_toml("value = " + std::string(text), source, "");
    if (root.children.size() == 1 && root.children[0].key == "value" && !text.starts_with('.')) {
      mark(root, source);
      return std::move(root.children[0]);
    }
    why_not_toml = "is more than one value";
  } catch (const SceneError& error) { why_not_toml = error.problems().front().message; }
  const char c = text[first];
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

void overlay(Value& under, Value over) {
  if (!under.is_table() || !over.is_table()) {
    under = std::move(over);
    return;
  }
  under.where = over.where;
  for (Value& child : over.children) {
    if (Value* same = under.find(child.key))
      overlay(*same, std::move(child));
    else
      under.children.push_back(std::move(child));
  }
}

void add_file(Layers& layers, const std::string& path) { overlay(layers.root, FileReader(layers).file(path, path, nullptr)); }

void add_text(Layers& layers, std::string_view text, const std::string& name, const std::string& directory) {
  overlay(layers.root, FileReader(layers).text(text, name, directory));
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
      for (const Value& gone : FileReader(layers).take_texts(root, key)) FileReader::remove(layers, layers.root, gone);
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
