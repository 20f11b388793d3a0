// What all parts of an import from OpenFAST share: the main file, the scene's folder, and the list of what was taken and what
// was left. Used by openfast.cpp and the sections (openfast_sections.hpp); tested in tests/src/import.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

#include "src/import/deck.hpp"

namespace spindrift::decks {

struct DeckImport {
  Deck main;
  std::filesystem::path folder;                    ///< of the scene
  std::vector<std::string> left_out{}, carried{};  ///< one sentence each, as in Imported
  std::vector<std::string> caveats{};              ///< of left_out, what changes answers; in the scene as output.caveats

  void leave_out(std::string what) { left_out.push_back(std::move(what)); }
  /// A part of the model, whose lack the report tells beside its verdict.
  void leave_out_part(const std::string& what) { left_out.push_back(what), caveats.push_back(what); }
  void carry(std::string what) { carried.push_back(std::move(what)); }
  /// A number that no scene has, and the value at which it does nothing.
  struct Neutral {
    const char *key, *what;
    double value = 0.0;
  };
  void leave_out_unless(const Deck& file, std::initializer_list<Neutral> numbers);
  /// A file that the scene takes as it is. Throws where it is not there.
  void copy(const std::filesystem::path& file) const;
};

inline constexpr double window = 0.1;  ///< time.window_s of every scene [s]

/// Degrees of freedom of ElastoDyn's tower.
inline constexpr std::initializer_list<const char*> tower_freedoms = {"TwFADOF1", "TwFADOF2", "TwSSDOF1", "TwSSDOF2"};
/// Whether one of these flags is on.
bool any_on(const Deck& elastodyn, std::initializer_list<const char*> freedoms);

/// caveats and notes of [output], a line each where there are some.
std::string toml_remarks(const std::vector<std::string>& left_out, const std::vector<std::string>& caveats);

/// As a scene has a vector; components of round-off are 0.
std::string toml_vector(const Eigen::Vector3d& v);

}  // namespace spindrift::decks
