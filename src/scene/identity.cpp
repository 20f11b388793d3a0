// SPDX-License-Identifier: Apache-2.0
#include "src/scene/identity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <sstream>
#include <utility>

#include "src/scene/toml_reader.hpp"

namespace spindrift::scene {

namespace {

FileRecord* recording = nullptr;  // the scene is read by one thread, before anything runs

using Keys = std::vector<std::pair<std::string, const Value*>>;

/// Every value under its full key: "bodies.platform.cylinders[1].diameter_m".
void flatten(const Value& value, const std::string& key, Keys& out) {
  if (value.is_table())
    for (const Value& child : value.children) flatten(child, key.empty() ? child.key : key + "." + child.key, out);
  else if (value.is_list_of_tables())
    for (std::size_t n = 0; n < value.children.size(); ++n) flatten(value.children[n], fmt::format("{}[{}]", key, n), out);
  else
    out.emplace_back(key, &value);
}

const FileDigest* find_file(const Identity& identity, const Value& value) {
  if (value.kind != Value::Kind::text) return nullptr;
  const auto found = std::ranges::find(identity.files, value.text, &FileDigest::path);
  return found == identity.files.end() ? nullptr : &*found;
}

bool same(const FileDigest& a, const FileDigest& b) { return a.bytes == b.bytes && a.digest == b.digest; }

std::string shown(const FileDigest& file) { return fmt::format("{} bytes, digest {:016x}", file.bytes, file.digest); }

/// Is `what` the same as `key`, or something within it?
bool within(const std::string& what, const std::string& key) {
  return what == key || (what.starts_with(key) && (what[key.size()] == '.' || what[key.size()] == '['));
}

}  // namespace

FileRecord::FileRecord() { recording = this; }
FileRecord::~FileRecord() { recording = nullptr; }

void FileRecord::note(const std::string& path) {
  if (!recording) return;
  std::vector<std::string>& files = path.ends_with(".h5") ? recording->states_ : recording->files_;
  if (std::ranges::find(files, path) == files.end()) files.push_back(path);
}

FileDigest digest_of(const std::string& path) {
  FileDigest file{path, 0, 0xcbf29ce484222325ULL};
  std::ifstream in(path, std::ios::binary);
  if (!in) return {path, 0, 0};
  char block[1 << 16];
  while (in.read(block, sizeof block), in.gcount() > 0) {
    for (const char byte : std::string_view(block, std::size_t(in.gcount())))
      file.digest = (file.digest ^ static_cast<unsigned char>(byte)) * 0x100000001b3ULL;
    file.bytes += in.gcount();
  }
  return file;
}

Identity Identity::of(std::string echo, const std::vector<std::string>& files) {
  Identity identity{std::move(echo), {}};
  for (const std::string& file : files) identity.files.push_back(digest_of(file));
  return identity;
}

std::string Identity::text() const {
  std::string text;
  for (const FileDigest& file : files) text += fmt::format("file {:016x} {} {}\n", file.digest, file.bytes, file.path);
  return text + "\n" + echo;
}

Identity Identity::parsed(const std::string& text) {
  Identity identity;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line) && !line.empty();) {
    std::istringstream words(line.substr(line.find(' ') + 1));
    FileDigest file;
    words >> std::hex >> file.digest >> std::dec >> file.bytes;
    words.ignore(1);
    std::getline(words, file.path);
    identity.files.push_back(std::move(file));
  }
  std::ostringstream rest;
  rest << in.rdbuf();
  identity.echo = std::move(rest).str();
  return identity;
}

bool names_part_of(const Identity& identity, const std::string& name) {
  const Value root = read_toml(identity.echo, 0, "scene");
  Keys keys;
  flatten(root, "", keys);
  return std::ranges::any_of(keys, [&](const auto& key) { return within(key.first, name); }) ||
         std::ranges::find(identity.files, name, &FileDigest::path) != identity.files.end();
}

std::vector<Difference> differences(const Identity& before, const Identity& now, std::span<const std::string> free) {
  const Value then_root = read_toml(before.echo, 0, "checkpoint"), now_root = read_toml(now.echo, 0, "scene");
  Keys then_keys, now_keys;
  flatten(then_root, "", then_keys), flatten(now_root, "", now_keys);
  const auto is_free = [&](const std::string& what) {
    return std::ranges::any_of(free, [&](const std::string& key) { return within(what, key); });
  };
  const auto find = [](const Keys& keys, const std::string& key) {
    const auto found = std::ranges::find(keys, key, &Keys::value_type::first);
    return found == keys.end() ? nullptr : found->second;
  };
  std::vector<Difference> all;
  std::vector<std::string> renamed;  // files of keys that name another file now
  const auto compare = [&](const std::string& key, const Value* then, const Value* here) {
    const FileDigest *old_file = then ? find_file(before, *then) : nullptr, *new_file = here ? find_file(now, *here) : nullptr;
    const std::string old_text = then ? then->toml() : "", new_text = here ? here->toml() : "";
    if (old_text == new_text) return;
    for (const FileDigest* file : {old_file, new_file})
      if (file) renamed.push_back(file->path);
    if (is_free(key) || (old_file && new_file && same(*old_file, *new_file))) return;
    const auto said = [](const Value* value, const FileDigest* file) {
      if (!value) return std::string("absent");
      return value->written() + (file ? " (" + shown(*file) + ")" : "");
    };
    all.push_back({key, said(then, old_file), said(here, new_file)});
  };
  for (const auto& [key, value] : then_keys) compare(key, value, find(now_keys, key));
  for (const auto& [key, value] : now_keys)
    if (!find(then_keys, key)) compare(key, nullptr, value);

  // Files of the same name, and those that other files name.
  for (const FileDigest& file : before.files) {
    const auto here = std::ranges::find(now.files, file.path, &FileDigest::path);
    const bool gone = here == now.files.end();
    if (is_free(file.path) || std::ranges::find(renamed, file.path) != renamed.end()) continue;
    const bool moved = gone && std::ranges::any_of(now.files, [&](const FileDigest& other) { return same(file, other); });
    if (moved || (!gone && same(file, *here))) continue;
    all.push_back({file.path, shown(file), gone ? "not read" : shown(*here)});
  }
  for (const FileDigest& file : now.files)
    if (std::ranges::find(before.files, file.path, &FileDigest::path) == before.files.end() && !is_free(file.path) &&
        std::ranges::find(renamed, file.path) == renamed.end() &&
        std::ranges::none_of(before.files, [&](const FileDigest& other) { return same(file, other); }))
      all.push_back({file.path, "not read", shown(file)});
  return all;
}

}  // namespace spindrift::scene
