// Laws of src/scene/identity.hpp: which scenes and files are those of the run before.
// SPDX-License-Identifier: Apache-2.0
#include "src/scene/identity.hpp"

#include <catch2/catch.hpp>

#include "src/scene/document.hpp"
#include "tests/src/scene/example_sections.hpp"
#include "tests/src/scene/temporary.hpp"

using namespace spindrift::scene;
using Catch::Matchers::Contains;

namespace {
std::vector<std::string> changed(const Identity& before, const Identity& now, std::vector<std::string> free = {}) {
  std::vector<std::string> keys;
  for (const Difference& d : differences(before, now, free)) keys.push_back(d.what);
  return keys;
}
const std::string echo_of_run =
    "[time]\nend_s = 1.0  # s; end\n\n[bodies.a]\nmass_kg = 2.0\n\n[[bodies.a.cylinders]]\ndiameter_m = 3.0\n"
    "\n[[bodies.a.cylinders]]\ndiameter_m = 4.0\nname = \"a  # b\"\n";
std::string with(const std::string& from, const std::string& to) {
  std::string text = echo_of_run;
  return text.replace(text.find(from), from.size(), to);
}
}  // namespace

TEST_CASE("every key that differs is named with both values, nested ones by their place", "[scene][fast]") {
  const Identity before{echo_of_run, {}};
  CHECK(changed(before, {echo_of_run, {}}).empty());
  CHECK(changed(before, Identity::parsed(before.text())).empty());
  CHECK(changed(before, {with("4.0", "4.5"), {}}) == std::vector<std::string>{"bodies.a.cylinders[1].diameter_m"});
  CHECK(changed(before, {with("a  # b", "a"), {}}) == std::vector<std::string>{"bodies.a.cylinders[1].name"});
  CHECK(changed(before, {with("# s; end", "# reworded"), {}}).empty());
  const std::vector<std::string> none;
  const std::vector<Difference> gone = differences(before, {with("mass_kg = 2.0\n", "colour = 1\n"), {}}, none);
  REQUIRE(gone.size() == 2);
  CHECK(gone[0].what == "bodies.a.mass_kg");
  CHECK(gone[0].before == "2.0");
  CHECK(gone[0].now == "absent");
  CHECK(gone[1].before == "absent");
}

TEST_CASE("what may change is given by key, by section, and not by part of a name", "[scene][fast]") {
  const Identity before{echo_of_run, {}}, now{with("end_s = 1.0", "end_s = 2.0"), {}};
  CHECK(changed(before, now, {"time.end_s"}).empty());
  CHECK(changed(before, now, {"time"}).empty());
  CHECK(changed(before, now, {"tim", "time.end"}).size() == 1);
  CHECK(changed(before, {with("4.0", "5.0"), {}}, {"bodies.a.cylinders"}).empty());
  CHECK((names_part_of(before, "time.end_s") && names_part_of(before, "time") && names_part_of(before, "bodies.a.cylinders")));
  CHECK_FALSE((names_part_of(before, "tim") || names_part_of(before, "time.end") || names_part_of(before, "time.end_s.x")));
}

TEST_CASE("bases of the files that a scene names are among its files, its own bases are not", "[scene][fast]") {
  const Temporary dir;
  const std::string turbine = dir.file("turbine.toml", "[time]\nend_s = 1.0\n"),
                    mine = dir.file("parts/mine.toml", "base = \"../turbine.toml\"\n");
  load(mine);
  const FileRecord read;
  CHECK(read.files().empty());
  load(mine);
  CHECK(read.files() == std::vector<std::string>{std::filesystem::canonical(turbine).string()});
}

TEST_CASE("files count by what is in them, wherever they are", "[scene][fast]") {
  const Temporary dir;
  const auto made = [&](const std::string& path) { return Identity::of("[rotor]\nturbine = \"" + path + "\"\n", {path}); };
  const std::string one = dir.file("one.toml", "blades = 3\n"), copy = dir.file("copy.toml", "blades = 3\n"),
                    other = dir.file("other.toml", "blades = 2\n");
  const Identity before = Identity::parsed(made(one).text());
  CHECK(changed(before, made(one)).empty());
  CHECK(changed(before, made(copy)).empty());
  CHECK(changed(before, made(other)) == std::vector<std::string>{"rotor.turbine"});
  dir.file("one.toml", "blades = 4\n");
  const std::vector<std::string> none;
  const std::vector<Difference> edited = differences(before, made(one), none);
  REQUIRE(edited.size() == 1);
  CHECK(edited[0].what == one);
  CHECK_THAT(edited[0].before, Contains("11 bytes, digest"));
  CHECK(edited[0].before != edited[0].now);
  CHECK(changed(before, made(one), {one}).empty());
  CHECK(names_part_of(before, one));
  CHECK_FALSE(names_part_of(before, other));
}
