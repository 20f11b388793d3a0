// A scene file, its base files and the overrides of the command line, read against the declarations of the modules.
//   scene::Document doc = scene::load("case1.toml", {"time.end_s=60"});
//   const TimeOptions time = doc.read(time_section());                  // defaults where the scene says nothing
//   for (auto& [name, body] : doc.read_named(body_section())) ...       // [bodies.NAME], in file order
//   if (!known(body)) doc.problem("joints.bearing.bodies", "...");      // rules between sections
//   doc.finish();                                                       // throws SceneError with every problem of the scene
//   out << doc.echo();                                                  // the scene as run, every default spelled out
// How files compose: docs/user/scenes.md. Called by src/app; tested in tests/src/scene/document_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "src/scene/error.hpp"
#include "src/scene/section.hpp"
#include "src/scene/value.hpp"

namespace spindrift::scene {

template <class Options>
struct Named {
  std::string name;
  Options options;
};

/// Where values come from: a file, or the command line.
struct Source {
  std::string name;       ///< as shown in messages
  std::string directory;  ///< absolute; relative paths in this source start here
};

/// What is wrong with a scene, and what its values come from.
struct Findings {
  std::vector<Source> sources;
  std::vector<Problem> problems;
  std::vector<std::pair<std::size_t, std::string>> strays;  ///< problems about unknown keys, to be told where they belong

  void add(const Value* at, std::string key, std::string value, std::string message);
};

class Document {
 public:
  Document(Value root, std::vector<Source> sources, std::vector<Problem> problems);

  /// The options of a section, defaults where the scene gives nothing. Problems are kept for finish().
  template <class Options>
  Options read(const Section<Options>& section) {
    Options options;
    read_into(section, &options);
    return options;
  }
  /// The same for a section that means something by being there: nothing where the scene does not name it.
  template <class Options>
  std::optional<Options> read_if_given(const Section<Options>& section) {
    if (!announce(section)) return std::nullopt;
    return read(section);
  }
  /// The same for a section that some scenes have no use for: elsewhere giving it is a problem (`why`: "aero.model is none"),
  /// and the echo leaves it out.
  /// `follows_from`: as in problem().
  template <class Options>
  Options read_where(bool has_effect, const Section<Options>& section, const std::string& why, const std::string& follows_from) {
    if (has_effect || !is_section(section)) return read(section);
    if (announce(section)) problem(section.name(), "has no effect: " + why, follows_from);
    return Options();
  }
  /// All [section.NAME], in file order.
  template <class Options>
  std::vector<Named<Options>> read_named(const Section<Options>& section) {
    std::vector<Named<Options>> all;
    for (const std::string& name : names(section)) {
      all.push_back({name, Options()});
      read_named_into(section, name, &all.back().options);
    }
    return all;
  }
  /// Reads a section of either shape and keeps only its problems and its echo (`check` of a part, fuzzing).
  void read_any(const SectionBase& section);

  /// Values "a.b=c" of keys that the scene leaves out: defaults that follow from the rest of it. To be given before those keys
  /// are read; nothing where a key is given, or what stands around it is no section.
  void add_defaults(const std::vector<std::string>& values);

  /// Is this key or section in the scene? "sea", "bodies.platform.cylinders[1].diameter_m"
  bool given(std::string_view key) const { return locate(key).second; }
  /// A problem found by a rule between sections, shown at the key's line, or that of the nearest table around it. Dropped where
  /// that key, or something in it or around it, has a problem already, or the key that it follows from has one in the end.
  void problem(std::string_view key, std::string message, std::string follows_from = {});
  /// Problems of keys of this scene that were found after it was read and name no line: with that of the key, or of the nearest
  /// table around it. All others as they are.
  SceneError located(const SceneError& late) const;
  /// Throws SceneError with every problem so far, sections that nobody read among them. Call after the last read.
  void finish();

  /// The scene as run: TOML with every default spelled out, unit and sentence as comments; reads back to the same options.
  std::string echo() const;
  /// Name of the scene file, as given.
  const std::string& source() const { return findings_.sources.front().name; }
  /// Absolute directory of the scene file.
  const std::string& directory() const { return findings_.sources.front().directory; }

 private:
  void read_into(const SectionBase& section, void* options);
  void read_named_into(const SectionBase& section, const std::string& name, void* options);
  bool is_section(const SectionBase& section) const;  ///< false where the scene gives its name something else
  bool announce(const SectionBase& section);          ///< notes the section as known; true where the scene names it
  std::vector<std::string> names(const SectionBase& section);
  std::pair<const Value*, bool> locate(std::string_view key) const;  ///< the deepest value on the way; is it the key itself?
  std::string home_of(std::string_view key) const;                   ///< " (a key of [time])" where a section read so far has it

  Value root_;
  Findings findings_;
  std::size_t given_sources_;              ///< of findings_.sources; behind them stands what the program adds
  std::vector<const SectionBase*> known_;  ///< sections read, in order
  std::string echo_;                       ///< of the sections read, in order
};

Source command_line();  ///< paths start at the working directory

/// Reads a scene file, the files it is based on, and `overrides` ("a.b=c"). Throws SceneError where the text cannot be
/// read at all (no such file, not TOML, a cycle of bases); everything else waits for Document::finish.
Document load(const std::string& path, const std::vector<std::string>& overrides = {}, const Source& overrider = command_line());
/// The same from memory: `name` is shown in messages, relative paths and bases start at `directory`.
Document parse(std::string_view text, const std::string& name, const std::string& directory,
               const std::vector<std::string>& overrides = {}, const Source& overrider = command_line());

}  // namespace spindrift::scene
