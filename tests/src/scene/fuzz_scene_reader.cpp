// libFuzzer target over the scene reader: any bytes are either a scene or a SceneError, and the echo of a scene that reads
// well reads back to itself. Built with -DSPINDRIFT_FUZZ=ON (clang); run by ci/fuzz_scene; seeds in tests/src/scene/seeds.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "src/scene/document.hpp"
#include "src/scene/reference.hpp"
#include "tests/src/scene/example_sections.hpp"

using namespace spindrift::scene;

namespace {

std::string read(std::string_view text, const std::vector<std::string>& overrides) {
  Document doc = parse(text, "fuzz.toml", "/nonexistent", overrides);
  for (const SectionBase* section : example::sections()) doc.read_any(*section);
  doc.finish();
  return doc.echo();
}

}  // namespace

/// The first line, where it begins with '!', is an override; a text of any kind is also looked up in the reference.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view text(reinterpret_cast<const char*>(data), size);
  std::vector<std::string> overrides;
  if (text.starts_with('!')) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    overrides.emplace_back(text.substr(1, end - 1));
    text.remove_prefix(end);
    try {
      (void)reference_text(example::sections(), overrides.front());
    } catch (const SceneError&) {}
  }
  std::string echo;
  try {
    echo = read(text, overrides);
  } catch (const SceneError& error) {
    if (error.problems().empty() || std::string_view(error.what()).empty()) std::abort();
    return 0;
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
  return 0;
}
