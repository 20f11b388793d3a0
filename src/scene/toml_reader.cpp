// SPDX-License-Identifier: Apache-2.0
#include "src/scene/toml_reader.hpp"

#include <fmt/format.h>

// What toml++ takes for impossible in its own state must end in a message, not in abort(): fuzzing found texts that get there.
namespace spindrift::scene {
struct ParserLost {};
}  // namespace spindrift::scene
#define TOML_ASSERT(condition) ((condition) ? static_cast<void>(0) : throw ::spindrift::scene::ParserLost{})
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wterminate"  // some of its functions are noexcept
#include <toml++/toml.h>
#pragma GCC diagnostic pop

#include <algorithm>
#include <sstream>

#include "src/scene/error.hpp"
#include "src/scene/text_check.hpp"

namespace spindrift::scene {

namespace {

constexpr std::size_t largest_scene = 4u << 20;  // bytes; series and tables belong in files of their own

int line_of(std::string_view text, std::size_t offset) {
  return 1 + int(std::count(text.begin(), text.begin() + std::ptrdiff_t(offset), '\n'));
}

[[noreturn]] void fail(const std::string& name, int line, std::string message) {
  throw SceneError({Problem{name, line, "", "", std::move(message)}});
}

Value convert(const toml::node& node, int source);

Value convert_table(const toml::table& table, int source) {
  Value value;
  std::vector<std::pair<toml::source_position, Value>> entries;
  for (const auto& [key, child] : table) {
    Value entry = convert(child, source);
    entry.key = std::string(key.str());
    entry.where = {source, int(key.source().begin.line)};
    entries.emplace_back(key.source().begin, std::move(entry));
  }
  std::stable_sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (auto& [position, entry] : entries) value.children.push_back(std::move(entry));
  return value;
}

Value convert(const toml::node& node, int source) {
  Value value;
  if (const toml::table* table = node.as_table()) value = convert_table(*table, source);
  value.where = {source, int(node.source().begin.line)};
  if (const auto* array = node.as_array()) {
    value.kind = Value::Kind::array;
    for (const toml::node& child : *array) value.children.push_back(convert(child, source));
  } else if (const auto* flag = node.as_boolean()) {
    value.kind = Value::Kind::flag, value.flag = flag->get();
  } else if (const auto* integer = node.as_integer()) {
    value.kind = Value::Kind::integer, value.integer = integer->get();
  } else if (const auto* number = node.as_floating_point()) {
    value.kind = Value::Kind::number, value.number = number->get();
  } else if (const auto* text = node.as_string()) {
    value.kind = Value::Kind::text, value.text = text->get();
  } else if (!node.is_table()) {
    std::ostringstream written;
    node.visit([&](const auto& leaf) { written << leaf; });
    value.kind = Value::Kind::date, value.text = written.str();
  }
  return value;
}

/// What to write instead, for the mistakes that people make most.
std::string_view advice(std::string_view said) {
  const auto has = [said](std::string_view words) { return said.find(words) != std::string_view::npos; };
  if (has("could not determine value type")) return "; a text stands in quotes: model = \"morison\"";
  if (has("expected 'true'") || has("expected 'false'")) return "; write true or false, in small letters";
  if (has("expected '=', saw ':'")) return "; write KEY = VALUE";
  if (has("saw ','")) return "; decimals have a point (10.5), lists have brackets: [1.0, 2.0]";
  if (has("saw '{'")) return "; sections are [NAME], keys KEY = VALUE: docs/user/scenes.md";
  return "";
}

}  // namespace

Value read_toml(std::string_view text, int source, const std::string& name) {
  if (text.size() > largest_scene)
    fail(name, 0,
         fmt::format("has {} bytes; a scene has at most {} (put long tables into files of their own)", text.size(),
                     largest_scene));
  if (const auto bad = refuse(text)) fail(name, line_of(text, bad->offset), bad->why);
  try {
    return convert_table(toml::parse(text, std::string_view(name)), source);
  } catch (const toml::parse_error& error) {
    fail(name, int(error.source().begin.line),
         fmt::format("is not TOML: {}{}", error.description(), advice(error.description())));
  } catch (const ParserLost&) {
    fail(name, 0, "is not TOML, in a way that the parser cannot place; take out half of the file at a time to find the line");
  }
}

}  // namespace spindrift::scene
