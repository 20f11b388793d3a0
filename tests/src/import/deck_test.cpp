// Input files of OpenFAST: values by name whatever the version calls them, and refusals by file and line.
// SPDX-License-Identifier: Apache-2.0
#include "src/import/deck.hpp"

#include <catch2/catch.hpp>

#include <unistd.h>

#include <fstream>

#include "src/scene/error.hpp"

using spindrift::decks::Deck;

namespace {

struct TextFile {
  std::filesystem::path path = std::filesystem::temp_directory_path() / ("spindrift_deck_" + std::to_string(getpid()) + ".dat");
  explicit TextFile(const std::string& text) { std::ofstream(path) << text; }
  ~TextFile() { std::filesystem::remove(path); }
};

std::string refusal(const Deck& deck, auto ask) {
  try {
    ask(deck);
  } catch (const spindrift::scene::SceneError& e) { return e.what(); }
  return "";
}

}  // namespace

TEST_CASE("values are found by name, with case, underscores, indices and comments aside", "[import][fast]") {
  const TextFile file(
      "------- A HEADING ----\n 1.5D+01   BlPitch(1)  - Blade 1 pitch (deg)\n\"two words.dat\"  AeroFile - name\nTrue PtfmSgDOF\n"
      "DEFAULT  Wake_Mod\n1 2 3 4 5 6 AddCLin - Additional stiffness\n'single' Quoted\n");
  const Deck deck(file.path);
  CHECK(deck.number({"BlPitch1"}) == 15.0);
  CHECK(deck.text({"AeroFile"}) == "two words.dat");
  CHECK(deck.path({"AeroFile"}) == file.path.parent_path() / "two words.dat");
  CHECK(deck.flag({"PtfmSgDOF"}, false));
  CHECK(deck.integer({"WakeMod"}, 7) == 7);
  CHECK(deck.numbers(*deck.find({"AddCLin"}), 6)[5] == 6.0);
  CHECK(deck.text({"Quoted"}) == "single");
  CHECK_FALSE(deck.has("Blade"));  // a word of a comment is no name
  CHECK(deck.number({"NotThere"}, 3.0) == 3.0);
}

TEST_CASE("what is wrong is said with file and line", "[import][fast]") {
  const TextFile file("heading\nx  Gravity\n1.5  NBody\nmaybe  Echo\n1 2\na b c\n");
  const Deck deck(file.path);
  const std::string name = file.path.string();
  CHECK(refusal(deck, [](const Deck& d) { d.number({"Gravity"}); }).find(name + ":2") != std::string::npos);
  CHECK(refusal(deck, [](const Deck& d) { d.integer({"NBody"}, 1); }).find(name + ":3") != std::string::npos);
  CHECK(refusal(deck, [](const Deck& d) { d.flag({"Echo"}, true); }).find(name + ":4") != std::string::npos);
  CHECK(refusal(deck, [](const Deck& d) { d.numbers(4, 3); }).find(name + ":5") != std::string::npos);
  CHECK(refusal(deck, [](const Deck& d) { d.column(5, {"z"}); }).find(name + ":6") != std::string::npos);
  CHECK(refusal(deck, [](const Deck& d) { d.number({"TMax"}); }).find("TMax") != std::string::npos);
  CHECK(refusal(deck, [](const Deck& d) { d.rows(5, 3, 1); }).find("ends within a table") != std::string::npos);
  CHECK_THROWS_AS(Deck("/no/such/file.fst"), spindrift::scene::SceneError);
}
