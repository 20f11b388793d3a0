// libFuzzer target over the scene reader, with the sections of the program and the rules between them, and with example sections
// of every kind: any bytes are either a scene or a SceneError, and the echo of a scene that reads well reads back to itself.
// Built with -DSPINDRIFT_FUZZ=ON (clang); run by ci/fuzz; seeds in tests/src/scene/seeds. SPDX-License-Identifier:
// Apache-2.0
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "src/coupling/scenario.hpp"
#include "src/scene/document.hpp"
#include "src/scene/reference.hpp"
#include "tests/src/scene/example_sections.hpp"

using namespace spindrift::scene;

namespace {

using Lines = std::vector<std::string>;

std::string read_example(std::string_view text, const Lines& overrides) {
  Document doc = parse(text, "fuzz.toml", "/nonexistent", overrides);
  for (const SectionBase* section : example::sections()) doc.read_any(*section);
  doc.finish();
  return doc.echo();
}

std::string read_program(std::string_view text, const Lines& overrides) {
  Document doc = parse(text, "fuzz.toml", "/nonexistent", overrides);
  (void)spindrift::coupling::read_scenario(doc);
  return doc.echo();
}

template <class Read>
void try_scene(Read read, std::string_view text, const Lines& overrides) {
  std::string echo;
  try {
    echo = read(text, overrides);
  } catch (const SceneError& error) {
    if (error.problems().empty() || std::string_view(error.what()).empty()) std::abort();
    return;
  }
  std::string again;
  try {
    again = read(echo, {});
  } catch (const SceneError& error) {
    std::fprintf(stderr, "the echo does not read back: %s\n%s\n", error.what(), echo.c_str());
    std::abort();
  }
  if (again != echo) {
    std::fprintf(stderr, "the echo echoes something else:\n%s\n---\n%s\n", echo.c_str(), again.c_str());
    std::abort();
  }
}

}  // namespace

/// The first line, where it begins with '!', is an override; a text of any kind is also looked up in the reference.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view text(reinterpret_cast<const char*>(data), size);
  Lines overrides;
  if (text.starts_with('!')) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    overrides.emplace_back(text.substr(1, end - 1));
    text.remove_prefix(end);
    try {
      (void)reference_text(spindrift::coupling::all_sections(), overrides.front());
    } catch (const SceneError&) {}
  }
  try_scene(read_example, text, overrides);
  try_scene(read_program, text, overrides);
  return 0;
}
