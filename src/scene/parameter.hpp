// One declared parameter, with its type erased: what the reader, the echo and the reference need to know of it.
// Made by src/scene/section.hpp; read by src/scene/read.cpp, echo.cpp, reference.cpp.
// Tested in tests/src/scene/section_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "src/scene/range.hpp"

namespace spindrift::scene {

class SectionBase;

enum class Kind {
  number,     ///< double; an integer in the file is accepted
  integer,    ///< int or std::int64_t; 1.0 in the file is not accepted
  flag,       ///< bool
  text,       ///< std::string
  choice,     ///< one of named values: std::string or an enum
  path,       ///< existing file, relative to the scene file that names it; absolute in the options
  vector,     ///< fixed number of doubles: Eigen::Vector3d, std::array<double, N>
  symmetric,  ///< Eigen::Matrix3d: three diagonal numbers, or three rows
  numbers,    ///< std::vector<double>
  texts,      ///< std::vector<std::string>
  values,     ///< std::vector<std::string> of values of any type, each as TOML writes it
  rows,       ///< std::vector of fixed numbers: [[0.0, 1.0], [2.0, 5.0]]
  table,      ///< nested options: [sea.grid]
  tables,     ///< std::vector of nested options: [[bodies.platform.cylinders]]
};

struct Choice {
  std::string name, help;
};

/// "Only if `key` is one of `values`": elsewhere the parameter has no effect, and giving it is an error.
struct Condition {
  std::string key;
  std::vector<std::string> values;
};

/// The place in an options struct that a value goes to.
using Slot = std::variant<std::monostate, double*, int*, std::int64_t*, bool*, std::string*, std::span<double>,
                          std::vector<double>*, std::vector<std::string>*>;

/// Access to one member of an options struct behind a void pointer. What a kind does not need is empty.
struct Member {
  std::function<bool(const void*)> has;                      ///< std::optional members: is there a value?
  std::function<Slot(void*)> slot;                           ///< creates the value of an absent optional
  std::function<std::size_t(const void*)> size;              ///< rows, tables: how many; choice: which
  std::function<void(void*, std::size_t)> resize;            ///< rows, tables; choice: choose
  std::function<void*(void*, std::size_t)> element;          ///< tables: the nested options; table: index 0
  std::function<std::span<double>(void*, std::size_t)> row;  ///< rows
};

struct Parameter {
  std::string key;  ///< within its section; names its unit: "window_s"
  Kind kind = Kind::number;
  std::string unit;    ///< "-" for dimensionless numbers, empty where a unit makes no sense
  std::string help;    ///< one sentence
  Range range;         ///< of each number, in the key's unit
  double scale = 1.0;  ///< member = value in the file * scale (degrees and rpm are SI in the options)
  std::size_t min_size = 0, max_size = std::numeric_limits<std::size_t>::max();  ///< of lists
  bool required = false;
  bool optional = false;  ///< a std::optional member: has no default
  std::vector<Choice> choices = {};
  std::vector<Condition> conditions = {};
  const SectionBase* nested = nullptr;  ///< declaration of table and tables
  Member member = {};
};

}  // namespace spindrift::scene
