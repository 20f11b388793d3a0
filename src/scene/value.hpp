// A scene as written: a tree of values that remember file and line, in file order. What is left when TOML's grammar is gone.
// Made by src/scene/toml_reader.cpp, composed by src/scene/layers.cpp, read against declarations by src/scene/read.cpp.
// Tested in tests/src/scene/document_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace spindrift::scene {

struct Where {
  int source = 0;  ///< index into the sources of the document
  int line = 0;    ///< 0: no line (command line)
};

struct Value {
  enum class Kind { flag, integer, number, text, date, array, table };

  std::string key;  ///< its name in the table that holds it; empty in arrays
  Where where;      ///< of the key, or of the value in an array
  Kind kind = Kind::table;
  bool flag = false;
  std::int64_t integer = 0;
  double number = 0.0;
  std::string text = {};             ///< text and dates
  std::vector<Value> children = {};  ///< of arrays and tables, in file order

  bool is_table() const { return kind == Kind::table; }
  bool is_list_of_tables() const;  ///< an array with a table in it
  const Value* find(std::string_view name) const;
  Value* find(std::string_view name);
  bool erase(std::string_view name);

  std::string toml() const;     ///< as TOML writes it on one line
  std::string written() const;  ///< the same for messages, shortened to some 60 characters
  std::string found() const;    ///< "a text", "an integer", "a list of 3"
};

std::string joined(const std::vector<std::string>& words, std::string_view between);
std::string toml_quoted(std::string_view text);  ///< a TOML basic string: quoted, everything unprintable escaped
std::string toml_number(double x);               ///< shortest decimal that reads back to the same bits, always a TOML float
std::string toml_key(std::string_view key);      ///< bare where TOML allows it, quoted elsewhere

/// The known word nearest to `word` (edit distance at most a third of its length), or empty.
std::string nearest(std::string_view word, const std::vector<std::string>& known);
/// What to say of a file that is not there: the file of its folder that was meant, or that there is no such folder.
std::string absent_file(const std::filesystem::path& path);

}  // namespace spindrift::scene
