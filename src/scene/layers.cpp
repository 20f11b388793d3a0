// SPDX-License-Identifier: Apache-2.0
#include "src/scene/layers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "src/scene/identity.hpp"
#include "src/scene/toml_reader.hpp"

namespace spindrift::scene {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t most_files = 64;  // in one scene, bases of bases counted; more is a mistake

/// Whole content of a file, or the reason why not.
std::optional<std::string> read_file(const fs::path& path, std::string& why_not) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) return why_not = error && error.value() != ENOENT ? error.message() : absent_file(path), std::nullopt;
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

[[noreturn]] void stop(const Layers& layers, const Value& at, std::string message) {
  throw SceneError(
      {Problem{layers.sources[std::size_t(at.where.source)].name, at.where.line, at.key, at.written(), std::move(message)}});
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
      stop(layers_, *named_by, fmt::format("{}: {}", name, why_not));
    }
    const std::string canonical = fs::weakly_canonical(fs::absolute(path)).string();
    if (const auto again = std::find(chain_.begin(), chain_.end(), canonical); again != chain_.end()) {
      std::vector<std::string> names(again, chain_.end());
      for (std::string& link : names) link = fs::path(link).filename().string();
      stop(layers_, *named_by, fmt::format("the base files form a cycle: {} -> {}", joined(names, " -> "), names.front()));
    }
    chain_.push_back(canonical);
    if (named_by) FileRecord::note(canonical);
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
    for (const Value& base : take_texts(layers_, own, "base")) {
      const fs::path shown = fs::path(name).parent_path() / base.text;  // as short as the user's own name of the scene
      overlay(result, file(fs::path(directory) / base.text, shown.lexically_normal().string(), &base));
    }
    for (const Value& key : take_texts(layers_, own, "without")) take_away(layers_, result, key);
    overlay(result, std::move(own));
    return result;
  }

 private:
  Layers& layers_;
  std::vector<std::string> chain_;  // canonical paths of the files being read, outermost first
};

}  // namespace

std::vector<Value> take_texts(const Layers& layers, Value& root, std::string_view name) {
  const Value* at = root.find(name);
  if (!at) return {};
  const Value value = *at;
  root.erase(name);
  std::vector<Value> texts = value.kind == Value::Kind::array ? value.children : std::vector{value};
  for (Value& text : texts) {
    text.key = std::string(name);
    if (text.kind != Value::Kind::text)
      stop(layers, text, fmt::format("must be a text or a list of texts, not {}", text.found()));
  }
  return texts;
}

void take_away(Layers& layers, Value& root, const Value& key) {
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

}  // namespace spindrift::scene
