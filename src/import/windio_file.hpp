// A file of the IEA ontology (windIO 1.x): its keys with their names for messages, and its curves. Used by windio.cpp and
// windio_tower.cpp; tested in tests/src/import/windio_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <string>
#include <vector>

namespace spindrift::decks {

/// A value of the file with its name from the top. What cannot be read throws scene::SceneError by file, line and name.
class Key {
 public:
  Key(std::filesystem::path file, YAML::Node node, std::string name = {})
      : file_(std::move(file)), node_(std::move(node)), name_(std::move(name)) {}

  [[noreturn]] void fail(const std::string& what) const;
  bool has(const std::string& key) const;
  Key at(const std::string& key) const;
  std::vector<Key> entries() const;
  double number() const;
  double positive() const;
  /// An angle [rad] within a quarter of a turn: files of windIO 2 have degrees.
  double angle() const;
  int count() const;
  std::string text() const;

 private:
  void require_map() const;
  std::filesystem::path file_;
  YAML::Node node_;
  std::string name_;
};

/// Straight between its entries, outside of them the nearest.
struct Curve {
  std::vector<double> x, y;
  double at(double position) const;
};

std::vector<double> numbers(const Key& list);
void require_increasing(const Key& grid, const std::vector<double>& x);
/// Of a key with grid and values.
Curve curve(const Key& key);
/// From 0 at one end to 1 at the other.
void require_whole_span(const Key& grid, const std::vector<double>& x);
Curve along_span(const Key& key);

/// The file's top; throws scene::SceneError where it cannot be read or is no YAML.
Key load_windio(const std::filesystem::path& file);

}  // namespace spindrift::decks
