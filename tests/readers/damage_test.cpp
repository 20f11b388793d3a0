// Damaged files of every kind: whatever word or byte is wrong, the message says in which file and where. SPDX-License-Identifier:
// Apache-2.0
#include <catch2/catch.hpp>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>

#include "src/io/atomic_file.hpp"
#include "src/io/machine_failure.hpp"
#include "src/scene/error.hpp"
#include "tests/readers/readers.hpp"

using namespace spindrift;
using spindrift::testing::Reader;
using spindrift::testing::readers;
namespace fs = std::filesystem;

namespace {

/// What the reader says of these bytes; empty where it takes them.
std::optional<std::string> refusal(const Reader& reader, const fs::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
  try {
    reader.read(file.string());
  } catch (const scene::SceneError& error) { return error.what(); } catch (const io::InputError& error) {
    return error.what();
  } catch (const io::MachineFailure& error) { return error.what(); }
  return {};
}

struct Seed {
  explicit Seed(const Reader& reader) : file(fs::temp_directory_path() / (reader.name + reader.ending)) {
    reader.write_seed(file.string());
    bytes = io::read_file(file);
  }
  fs::path file;
  std::string bytes;
};

/// First character and length of each word that is a number and no part of a comment or a name, with its line from 1.
struct Number {
  std::size_t at, size;
  int line;
};
std::vector<Number> numbers(const std::string& text) {
  std::vector<Number> found;
  int line = 1;
  bool comment = false, word = false;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (c == '\n') ++line, comment = false;
    if (c == '#' || c == '!' || c == '"' || c == '\'') comment = true;  // to the end of the line
    const bool begins = !word && !comment && (std::isdigit(static_cast<unsigned char>(c)) || c == '-' || c == '.');
    word = std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.' || c == '-' || c == '+';
    if (!begins) continue;
    std::size_t size = 0;
    while (at + size < text.size() && std::string("0123456789.-+eE").find(text[at + size]) != std::string::npos) ++size;
    const char after = at + size < text.size() ? text[at + size] : '\n';
    if (std::isalnum(static_cast<unsigned char>(after)) || after == '_') continue;
    found.push_back({at, size, line});
    at += size - 1;
  }
  return found;
}

}  // namespace

TEST_CASE("every reader takes its own small file", "[readers][fast]") {
  for (const Reader& reader : readers()) {
    CAPTURE(reader.name);
    const Seed seed(reader);
    CHECK(refusal(reader, seed.file, seed.bytes).value_or("") == "");
  }
}

TEST_CASE("a word in place of any number is refused with file and line", "[readers][fast]") {
  for (const Reader& reader : readers()) {
    if (!reader.text || reader.name == "recording") continue;  // JSON has its numbers behind quotes
    const Seed seed(reader);
    const std::vector<Number> all = numbers(seed.bytes);
    CHECK(all.size() >= 6);
    for (const char* word : {"x1y", "1.5.2", "nan", "1e999"})
      for (std::size_t n = 0; n < all.size() && n < 60; ++n) {
        if (all[n].line == 1 && reader.titled) continue;
        std::string damaged = seed.bytes;
        damaged.replace(all[n].at, all[n].size, word);
        const std::string where = seed.file.filename().string() + ":" + std::to_string(all[n].line);
        CAPTURE(reader.name, word, where, damaged.substr(all[n].at > 30 ? all[n].at - 30 : 0, 60));
        const auto said = refusal(reader, seed.file, damaged);
        CHECK(said);
        if (said) CHECK_THAT(*said, Catch::Contains(where));
      }
  }
}

TEST_CASE("a file cut short anywhere is read as far as it means something, or refused by its name", "[readers][fast]") {
  for (const Reader& reader : readers()) {
    const Seed seed(reader);
    const std::size_t step = std::max<std::size_t>(1, seed.bytes.size() / 60);
    for (std::size_t size = 0; size < seed.bytes.size(); size += step) {
      CAPTURE(reader.name, size, seed.bytes.size());
      const auto said = refusal(reader, seed.file, seed.bytes.substr(0, size));
      if (said)
        CHECK_THAT(*said, Catch::Contains(seed.file.filename().string()));
      else
        CHECK(reader.text);  // whole rows are a shorter table
    }
  }
}

TEST_CASE("bytes of wind and grids that make no sense are refused with where they are", "[readers][fast]") {
  for (const Reader& reader : readers()) {
    if (reader.name != "bts" && reader.name != "plot3d_binary") continue;
    const Seed seed(reader);
    int refused = 0;
    for (std::size_t at = 0; at < std::min<std::size_t>(seed.bytes.size(), 64); ++at) {
      std::string damaged = seed.bytes;
      damaged[at] = char(~damaged[at]);
      const auto said = refusal(reader, seed.file, damaged);
      if (!said) continue;  // another description, another velocity
      ++refused;
      CAPTURE(reader.name, at, *said);
      CHECK_THAT(*said, Catch::Contains(seed.file.filename().string()) && Catch::Contains("byte"));
    }
    CHECK(refused >= 10);
  }
}

TEST_CASE("a number of a binary surface or of a Mann box that is none is refused with its byte", "[readers][fast]") {
  for (const Reader& reader : readers()) {
    if (reader.name != "stl_binary" && reader.name != "mann") continue;
    const Seed seed(reader);
    const bool surface = reader.name == "stl_binary";
    int refused = 0;
    for (const float wrong : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                              -std::numeric_limits<float>::infinity()})
      for (std::size_t at = surface ? 84 : 0; at + 4 <= seed.bytes.size(); at += 4) {
        // Of a facet's 50 bytes the normal, 12, and the attribute, 2, are not read.
        if (surface) at += (at - 84) % 50 == 0 ? 12 : (at - 84) % 50 == 48 ? 14 : 0;
        if (at + 4 > seed.bytes.size()) break;
        std::string damaged = seed.bytes;
        std::memcpy(damaged.data() + at, &wrong, sizeof wrong);
        const auto said = refusal(reader, seed.file, damaged);
        CAPTURE(reader.name, at, wrong);
        CHECK(said);
        if (!said) continue;
        ++refused;
        CHECK_THAT(*said, Catch::Contains(seed.file.filename().string()) && Catch::Contains("byte " + std::to_string(at)));
      }
    CHECK(refused >= 20);
  }
}
