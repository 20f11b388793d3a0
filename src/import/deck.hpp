// An input file of OpenFAST: lines of words, most of them "value Name - comment". Values are found by name, so that files of
// different versions, with lines added or moved, read alike. Used by openfast.cpp and the sections; tested in
// tests/src/import/deck_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace spindrift::decks {

/// What a value of a file may be.
struct Range {
  const char* name;
  double low, high;
  bool above = false;  ///< `low` itself is refused
};
inline Range positive(const char* name) { return {name, 0.0, std::numeric_limits<double>::infinity(), true}; }
inline Range not_negative(const char* name) { return {name, 0.0, std::numeric_limits<double>::infinity()}; }
inline Range angle(const char* name) { return {name, -360.0, 360.0}; }  ///< [deg]

/// Nothing where the word is no number.
std::optional<double> number_in(std::string word);

/// ": NAME stands beside ..." where a file is not there but one is whose name differs in capitals alone; else empty.
std::string beside_but_for_case(const std::filesystem::path& file);

class Deck {
 public:
  /// Throws scene::SceneError where the file cannot be read. Where there are marks of comments, what a line has from one of these
  /// on is left out, and so are lines without a word.
  explicit Deck(const std::filesystem::path& file, const std::string& comments = "");

  const std::filesystem::path& file() const { return file_; }
  /// Line of the first that has one of these names behind its values; names compare without case, underscores and "(1)".
  std::optional<std::size_t> find(const std::vector<std::string>& names) const;
  bool has(const std::string& name) const { return find({name}).has_value(); }
  /// The first line that has this word anywhere: where a name stands whose values are malformed.
  std::optional<std::size_t> mention(const std::string& word) const;

  // Of the value before the name; several names are those of several versions. They throw, naming file and line, where the name
  // is missing or the value is no number; the second form gives `otherwise` where the name is missing or the value is "default".
  double number(const std::vector<std::string>& names) const;
  double number(const std::vector<std::string>& names, double otherwise) const;
  int integer(const std::vector<std::string>& names, int otherwise) const;
  bool flag(const std::vector<std::string>& names, bool otherwise) const;
  std::string text(const std::vector<std::string>& names) const;
  /// Refuses values outside their ranges by their lines. Names that are missing, and "default", pass.
  void require(std::initializer_list<Range> ranges) const;
  /// A file named relative to this one.
  std::filesystem::path path(const std::vector<std::string>& names) const;
  std::filesystem::path beside(const std::string& name) const;

  // Tables: `count` lines from `first` on, at least so many words each.
  std::vector<std::vector<std::string>> rows(std::size_t first, std::size_t count, std::size_t words) const;
  std::vector<double> numbers(std::size_t line, std::size_t count) const;
  const std::vector<std::string>& words(std::size_t line) const;
  /// "---- FURLING ----": no words in it are keys.
  bool is_rule(std::size_t line) const;
  std::size_t size() const { return lines_.size(); }
  /// Column of a table whose heading is this line; throws where there is none.
  std::size_t column(std::size_t heading, const std::vector<std::string>& names) const;

  /// Lines `first` up to `last`, without the last, as a deck of their own.
  Deck part(std::size_t first, std::size_t last) const;

  /// Which of the names of several versions a line has, as it has it.
  std::string name_in(const std::vector<std::string>& names, std::size_t line) const;
  double to_number(const std::string& word, std::size_t line) const;
  [[noreturn]] void fail(std::optional<std::size_t> line, const std::string& what) const;

 private:
  Deck() = default;
  double value_of(const std::vector<std::string>& names, std::size_t line) const;
  struct Line {
    int number;
    std::vector<std::string> words;
  };
  std::filesystem::path file_;
  std::vector<Line> lines_;
};

}  // namespace spindrift::decks
