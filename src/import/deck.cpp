// SPDX-License-Identifier: Apache-2.0
#include "src/import/deck.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>

#include "src/scene/error.hpp"

namespace spindrift::decks {

namespace {

/// Without case, underscores and an index: "BldFile(1)" and "BldFile1" are the same.
std::string plain(const std::string& name) {
  std::string result;
  for (const char c : name)
    if (std::isalnum(static_cast<unsigned char>(c))) result += char(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> words;
  std::string word;
  char quote = '\0';
  bool quoted = false;
  const auto end = [&] {
    if (!word.empty() || quoted) words.push_back(word);
    word.clear(), quoted = false;
  };
  for (const char c : text) {
    if (quote != '\0') {
      if (c == quote)
        quote = '\0';
      else
        word += c;
    } else if (c == '"' || c == '\'') {
      quote = c, quoted = true;
    } else if (std::isspace(static_cast<unsigned char>(c)) || c == ',') {
      end();
    } else {
      word += c;
    }
  }
  end();
  return words;
}

}  // namespace

std::optional<double> number_in(std::string word) {
  std::replace(word.begin(), word.end(), 'D', 'E');
  std::replace(word.begin(), word.end(), 'd', 'e');
  std::size_t used = 0;
  try {
    const double value = std::stod(word, &used);
    if (used == word.size() && std::isfinite(value)) return value;
  } catch (const std::exception&) {}
  return std::nullopt;
}

std::string beside_but_for_case(const std::filesystem::path& file) {
  const auto small = [](std::string name) {
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return name;
  };
  std::error_code error;
  if (std::filesystem::exists(file, error)) return "";
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (small(entry->path().filename().string()) == small(file.filename().string()))
      return fmt::format(": {} stands beside, and case counts in names of files", entry->path().filename().string());
  return "";
}

Deck::Deck(const std::filesystem::path& file, const std::string& comments) : file_(file) {
  std::ifstream in(file);
  if (!in || std::filesystem::is_directory(file)) fail(std::nullopt, "cannot be read" + beside_but_for_case(file));
  std::string text;
  for (int number = 1; std::getline(in, text); ++number) {
    std::vector<std::string> words = split(text.substr(0, text.find_first_of(comments)));
    if (!comments.empty() && words.empty()) continue;
    lines_.push_back({number, std::move(words)});
  }
}

std::optional<std::size_t> Deck::find(const std::vector<std::string>& names) const {
  const auto among = [&](std::size_t from, std::size_t to, const std::string& wanted) -> std::optional<std::size_t> {
    for (std::size_t n = from; n < to; ++n) {
      const std::vector<std::string>& words = lines_[n].words;
      if (is_rule(n)) continue;
      // Behind the values and before the comment: the first word that is no number, apart from the first of the line.
      for (std::size_t w = 1; w < words.size(); ++w) {
        if (plain(words[w]) == wanted) return n;
        if (!number_in(words[w])) break;
      }
    }
    return std::nullopt;
  };
  const std::size_t titles = std::min<std::size_t>(2, lines_.size());  // any word may stand in them
  const auto is_title = [&](std::size_t n) {
    return lines_[n].words.size() > 2 && !number_in(lines_[n].words[0]) && lines_[n].words[2] != "-";
  };
  for (const std::string& name : names) {
    if (const auto line = among(titles, lines_.size(), plain(name))) return line;
    if (const auto line = among(0, titles, plain(name)); line && !is_title(*line)) return line;
  }
  return std::nullopt;
}

std::optional<std::size_t> Deck::mention(const std::string& word) const {
  for (std::size_t n = 0; n < lines_.size(); ++n)
    if (std::ranges::find(lines_[n].words, word) != lines_[n].words.end()) return n;
  return std::nullopt;
}

double Deck::to_number(const std::string& word, std::size_t line) const {
  const std::optional<double> value = number_in(word);
  if (!value) fail(line, fmt::format("'{}' is not a number", word));
  return *value;
}

double Deck::number(const std::vector<std::string>& names) const {
  const auto line = find(names);
  if (!line) fail(std::nullopt, fmt::format("has no line for {}", fmt::join(names, " or ")));
  return value_of(names, *line);
}

double Deck::number(const std::vector<std::string>& names, double otherwise) const {
  const auto line = find(names);
  if (!line || plain(lines_[*line].words[0]) == "default") return otherwise;
  return value_of(names, *line);
}

double Deck::value_of(const std::vector<std::string>& names, std::size_t line) const {
  const std::string& word = lines_[line].words[0];
  const std::optional<double> value = number_in(word);
  if (!value) fail(line, fmt::format("{}: '{}' is not a number", name_in(names, line), word));
  return *value;
}

std::string Deck::name_in(const std::vector<std::string>& names, std::size_t line) const {
  for (const std::string& name : names)
    for (const std::string& word : lines_[line].words)
      if (plain(word) == plain(name)) return word;
  return names[0];
}

int Deck::integer(const std::vector<std::string>& names, int otherwise) const {
  const auto line = find(names);
  if (!line || plain(lines_[*line].words[0]) == "default") return otherwise;
  const double value = value_of(names, *line);
  if (value != std::floor(value) || std::abs(value) > 1e9)
    fail(line, fmt::format("'{}' is not a whole number", lines_[*line].words[0]));
  return int(value);
}

void Deck::require(std::initializer_list<Range> ranges) const {
  for (const Range& r : ranges) {
    const auto line = find({r.name});
    if (!line || plain(lines_[*line].words[0]) == "default") continue;
    const double value = number({r.name});
    if (value <= r.high && (r.above ? value > r.low : value >= r.low)) continue;
    const std::string wanted = std::isfinite(r.high) ? fmt::format("{:g} to {:g}", r.low, r.high)
                                                     : fmt::format("{} {:g}", r.above ? "more than" : "at least", r.low);
    fail(line, fmt::format("{} is {:g}: {} is wanted", r.name, value, wanted));
  }
}

bool Deck::flag(const std::vector<std::string>& names, bool otherwise) const {
  const auto line = find(names);
  if (!line || plain(lines_[*line].words[0]) == "default") return otherwise;
  const char first = lines_[*line].words[0].empty() ? '?' : char(std::tolower(lines_[*line].words[0][0]));
  if (first != 't' && first != 'f') fail(line, fmt::format("'{}' is neither true nor false", lines_[*line].words[0]));
  return first == 't';
}

std::string Deck::text(const std::vector<std::string>& names) const {
  const auto line = find(names);
  if (!line) fail(std::nullopt, fmt::format("has no line for {}", fmt::join(names, " or ")));
  return lines_[*line].words[0];
}

std::filesystem::path Deck::beside(const std::string& name) const {
  std::string slashes = name;
  std::replace(slashes.begin(), slashes.end(), '\\', '/');
  return std::filesystem::path(slashes).is_absolute() ? std::filesystem::path(slashes) : file_.parent_path() / slashes;
}

std::filesystem::path Deck::path(const std::vector<std::string>& names) const { return beside(text(names)); }

const std::vector<std::string>& Deck::words(std::size_t line) const {
  if (line >= lines_.size()) fail(std::nullopt, "ends too early");
  return lines_[line].words;
}

bool Deck::is_rule(std::size_t line) const {
  const std::vector<std::string>& words = lines_[line].words;
  return !words.empty() && (words[0].find("---") != std::string::npos || words[0].find("===") != std::string::npos);
}

std::vector<std::vector<std::string>> Deck::rows(std::size_t first, std::size_t count, std::size_t least) const {
  std::vector<std::vector<std::string>> result;
  for (std::size_t n = first; n < first + count; ++n) {
    if (n >= lines_.size())
      fail(std::nullopt, fmt::format("ends within a table: {} rows are wanted, {} are there", count, n - first));
    if (lines_[n].words.size() < least) fail(n, fmt::format("has {} values, {} are wanted", lines_[n].words.size(), least));
    result.push_back(lines_[n].words);
  }
  return result;
}

std::vector<double> Deck::numbers(std::size_t line, std::size_t count) const {
  const std::vector<std::string> row = rows(line, 1, count)[0];
  std::vector<double> result;
  for (std::size_t w = 0; w < count; ++w) result.push_back(to_number(row[w], line));
  return result;
}

std::size_t Deck::column(std::size_t heading, const std::vector<std::string>& names) const {
  const std::vector<std::string>& row = words(heading);
  for (const std::string& name : names)
    for (std::size_t w = 0; w < row.size(); ++w)
      if (plain(row[w]) == plain(name)) return w;
  // Versions add the module: "MemberID_HydC".
  std::vector<std::size_t> longer;
  for (const std::string& name : names)
    for (std::size_t w = 0; w < row.size(); ++w)
      if (row[w].starts_with(name + "_")) longer.push_back(w);
  if (longer.size() == 1) return longer[0];
  fail(heading, fmt::format("has no column {}", fmt::join(names, " or ")));
}

Deck Deck::part(std::size_t first, std::size_t last) const {
  Deck lines;
  lines.file_ = file_;
  lines.lines_.assign(lines_.begin() + std::ptrdiff_t(first), lines_.begin() + std::ptrdiff_t(last));
  return lines;
}

void Deck::fail(std::optional<std::size_t> line, const std::string& what) const {
  throw scene::SceneError({{file_.string(), line ? lines_[*line].number : 0, "", "", what}});
}

}  // namespace spindrift::decks
