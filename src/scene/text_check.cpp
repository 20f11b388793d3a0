// SPDX-License-Identifier: Apache-2.0
#include "src/scene/text_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace spindrift::scene {

namespace {

constexpr int deepest = 32;  // parts of a key, and brackets within brackets

/// Offset of the first byte that is not part of well-formed UTF-8 (Unicode 15, table 3-7), or npos.
std::size_t first_bad_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = [&](std::size_t k) { return i + k < text.size() ? static_cast<unsigned char>(text[i + k]) : 0u; };
    const auto tail = [&](std::size_t k, unsigned low = 0x80, unsigned high = 0xbf) { return byte(k) >= low && byte(k) <= high; };
    const unsigned b = byte(0);
    if (b < 0x80)
      i += 1;
    else if (b >= 0xc2 && b <= 0xdf && tail(1))
      i += 2;
    else if (b >= 0xe0 && b <= 0xef && tail(1, b == 0xe0 ? 0xa0 : 0x80, b == 0xed ? 0x9f : 0xbf) && tail(2))
      i += 3;
    else if (b >= 0xf0 && b <= 0xf4 && tail(1, b == 0xf0 ? 0x90 : 0x80, b == 0xf4 ? 0x8f : 0xbf) && tail(2) && tail(3))
      i += 4;
    else
      return i;
  }
  return std::string_view::npos;
}

bool is_ascii(char c) { return static_cast<unsigned char>(c) < 0x80; }

/// Walks over TOML's tokens just well enough to tell strings and comments from the rest.
class Scan {
 public:
  explicit Scan(std::string_view text) : text_(text) {}

  std::optional<Refusal> run() {
    if (text_.starts_with("\xef\xbb\xbf")) at_ = 3;  // the byte order mark
    while (at_ < text_.size() && !refusal_) {
      const char c = text_[at_];
      if (c == '"' || c == '\'')
        string(c);
      else if (c == '#')
        at_ = std::min(text_.find('\n', at_), text_.size()), dots_ = 0;
      else
        outside(c);
    }
    return refusal_;
  }

 private:
  void outside(char c) {
    if (!is_ascii(c))
      return refuse("has a character beyond ASCII outside quotes and comments; put texts and such keys into quotes");
    if (c == '.') {
      if (++dots_ > deepest) return refuse(fmt::format("has a key of more than {} parts", deepest));
    } else if (c == '[' || c == '{') {
      if (c == '[' && brackets_ == 0 && first_on_its_line() && !names_a_table())
        return refuse("has a table header without a name; write it as [section] or [section.NAME]");
      dots_ = 0;
      if (++brackets_ > deepest) return refuse(fmt::format("nests more than {} brackets", deepest));
    } else if (c == ']' || c == '}') {
      dots_ = 0, --brackets_;
    } else if (c == ',' || c == '=' || c == '\n') {
      dots_ = 0;
    }
    ++at_;
  }

  bool first_on_its_line() const {
    const std::size_t before = text_.substr(0, at_).find_last_not_of(" \t");
    return before == std::string_view::npos || text_[before] == '\n' || (before == 2 && text_.starts_with("\xef\xbb\xbf"));
  }

  /// toml++ takes for granted that a key begins after [ or [[ (an empty [] it sees).
  bool names_a_table() const {
    std::size_t next = text_.find_first_not_of(" \t", at_ + 1);
    if (next != std::string_view::npos && text_[next] == '[') next = text_.find_first_not_of(" \t", next + 1);
    return next == std::string_view::npos || std::isalnum(static_cast<unsigned char>(text_[next])) ||
           std::string_view("_-\"'[]").find(text_[next]) != std::string_view::npos;
  }

  void string(char quote) {
    const bool block = text_.substr(at_, 3) == std::string(3, quote);
    const std::string close(block ? 3 : 1, quote);
    for (at_ += close.size(); at_ < text_.size() && text_.substr(at_, close.size()) != close; ++at_) {
      if (!block && text_[at_] == '\n') return;  // unclosed: the parser's error
      if (quote != '"' || text_[at_] != '\\') continue;
      if (block && before_beyond_ascii())
        return refuse("has a character beyond ASCII right after a line-ending backslash; begin that line with another one");
      ++at_;
    }
    at_ += close.size();
  }

  /// A backslash whose next visible character is beyond ASCII: toml++ asks whether that is white space, and falls through.
  bool before_beyond_ascii() const {
    const std::size_t next = text_.find_first_not_of(" \t\r\n", at_ + 1);
    return next != std::string_view::npos && !is_ascii(text_[next]);
  }

  void refuse(std::string why) { refusal_ = Refusal{at_, std::move(why)}; }

  std::string_view text_;
  std::size_t at_ = 0;
  int dots_ = 0, brackets_ = 0;
  std::optional<Refusal> refusal_;
};

}  // namespace

std::optional<Refusal> refuse(std::string_view text) {
  if (const std::size_t bad = first_bad_utf8(text); bad != std::string_view::npos)
    return Refusal{bad, fmt::format("is not UTF-8 text (byte {:#04x} at offset {}); save the file as UTF-8",
                                    static_cast<unsigned char>(text[bad]), bad)};
  return Scan(text).run();
}

}  // namespace spindrift::scene
