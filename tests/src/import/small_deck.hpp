// A small deck of our own for tests of the import: a spar of two members with a three-bladed rotor, WAMIT files and two lines,
// written here in the layouts of OpenFAST. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "src/coupling/scenario.hpp"
#include "src/import/openfast.hpp"

namespace spindrift {

/// The deck in a folder of this process; files can be changed before it is imported.
struct SmallDeck {
  std::filesystem::path folder;
  std::map<std::string, std::string> files;

  SmallDeck();
  ~SmallDeck() { std::filesystem::remove_all(folder); }

  /// The first of these words, which must be there.
  void replace(const std::string& file, const std::string& from, const std::string& to);
  /// Pitch and torque are those of a library.
  void turn_by_library();
  decks::Imported import(decks::ImportedTower tower = decks::ImportedTower::as_in_deck,
                         decks::ImportedLines lines = decks::ImportedLines::as_in_deck) const;
  coupling::Scenario scenario(decks::ImportedTower tower = decks::ImportedTower::as_in_deck,
                              decks::ImportedLines lines = decks::ImportedLines::as_in_deck) const;
  /// What is said of the deck; empty where it is imported.
  std::string refusal() const;
};

/// The small deck with a tower that bends.
SmallDeck deck_that_bends();

bool has_word(const std::vector<std::string>& sentences, const std::string& word);

}  // namespace spindrift
