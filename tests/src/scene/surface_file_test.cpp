// STL files: both kinds read alike, what is malformed is refused with file and line or byte, and put where the scene says.
// SPDX-License-Identifier: Apache-2.0
#include "src/scene/surface_file.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <catch2/catch.hpp>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "src/scene/error.hpp"
#include "tests/kernels/rigid/surfaces.hpp"

using namespace spindrift;
using namespace spindrift::scene;
using namespace spindrift::testing;
using Catch::Matchers::Contains;

namespace {

/// A file of this process, gone at the end.
class TestFile {
 public:
  explicit TestFile(const std::string& bytes)
      : path_(std::filesystem::temp_directory_path() / fmt::format("spindrift_surface_{}_{}.stl", getpid(), ++number_)) {
    std::ofstream(path_, std::ios::binary) << bytes;
  }
  TestFile(const TestFile&) = delete;
  ~TestFile() { std::filesystem::remove(path_); }
  std::string path() const { return path_; }

 private:
  static inline int number_ = 0;
  std::filesystem::path path_;
};

std::string ascii(const std::vector<Facet>& facets) {
  std::string text = "solid a name of words\n";
  for (const Facet& f : facets) {
    text += "  facet normal 0 0 0\n    outer loop\n";
    for (const auto& x : f) text += fmt::format("      vertex {} {:e} {}\n", x[0], x[1], x[2]);
    text += "    endloop\n  endfacet\n";
  }
  return text + "endsolid a name of words\n";
}
std::string binary(const std::vector<Facet>& facets) {
  std::string bytes(80, 'x');
  const auto put = [&](auto value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
  put(std::uint32_t(facets.size()));
  for (const Facet& f : facets) {
    for (int k = 0; k < 3; ++k) put(0.0f);
    for (const auto& x : f)
      for (const double c : x) put(float(c));
    put(std::uint16_t(0));
  }
  return bytes;
}
std::string refused(const std::string& bytes) {
  const TestFile file(bytes);
  try {
    MeshOptions mesh{.name = "hull", .file = file.path()};
    load_surface(mesh);
  } catch (const SceneError& e) {
    const std::string what = e.what();
    CHECK_THAT(what, Contains(file.path()));
    return what.substr(what.find(file.path()) + file.path().size());
  }
  return "";
}
const std::vector<Facet> box = box_facets({2.0, 1.0, 0.5});

}  // namespace

TEST_CASE("ASCII and binary STL hold the same facets", "[scene][fast]") {
  const TestFile text(ascii(box)), bytes(binary(box)), upper([] {
    std::string s = ascii(box);
    for (char& c : s) c = char(std::toupper(c));
    return s;
  }()),
      two(ascii(box) + ascii(box_facets({0.1, 0.1, 0.1})));
  for (const TestFile* file : {&text, &bytes, &upper}) CHECK(read_stl(file->path()) == box);
  CHECK(read_stl(two.path()).size() == 24);
}

TEST_CASE("a surface stands where scale, rotation and position put it", "[scene][fast]") {
  const TestFile file(binary(box_facets({2000.0, 1000.0, 500.0})));
  MeshOptions mesh{.name = "hull", .file = file.path(), .scale = 1e-3, .position_m = {10.0, 0.0, -1.0}};
  mesh.rotation = {0.0, 0.0, 0.5 * pi};  // yaw: its length is along y
  load_surface(mesh);
  CHECK(mesh.surface->volume() == Approx(1.0));
  CHECK((mesh.surface->box().sizes() - Eigen::Vector3d(1.0, 2.0, 0.5)).norm() < 1e-12);
  CHECK((mesh.surface->centre() - Eigen::Vector3d(10.0, 0.0, -1.0)).norm() < 1e-12);
}

TEST_CASE("malformed STL files are refused with file, line or byte, and what is wrong", "[scene][fast]") {
  const std::string text = ascii(box);
  CHECK(refused(text).empty());
  CHECK_THAT(refused("solid nothing\nendsolid nothing\n"), Contains("has no facets"));
  CHECK_THAT(refused(binary({})), Contains("has no facets"));
  CHECK_THAT(refused(""), Contains("no STL file") && Contains("84 bytes"));
  CHECK_THAT(refused("time.end_s = 3\n"), Contains("no STL file"));
  CHECK_THAT(refused(binary(box).substr(0, 400)),
             Contains("12 facets (byte 80)") && Contains("684 bytes") && Contains("400") && Contains("cut off"));
  CHECK_THAT(refused(text.substr(0, text.find("endloop"))), Contains("ends where there must be 'endloop'"));
  // One more or less than there are, so many that no memory has them, and a header that begins like a text.
  std::string spoilt = binary(box);
  for (const std::uint32_t count : {11u, 13u, 4294967295u}) {
    std::memcpy(spoilt.data() + 80, &count, 4);
    CHECK_THAT(refused(spoilt), Contains(fmt::format("{} facets (byte 80)", count)) && Contains("it has 684"));
  }
  spoilt = "solid" + binary(box).substr(5, 600);
  CHECK_THAT(refused(spoilt), Contains("12 facets (byte 80)") && Contains("cut off"));
  spoilt = text;
  spoilt.replace(spoilt.find("vertex"), 6, "vertax");
  CHECK_THAT(refused(spoilt), Contains(":4:") && Contains("'vertax'") && Contains("must be 'vertex'"));
  spoilt = text;
  spoilt.replace(spoilt.find("-1 "), 2, "-x");
  CHECK_THAT(refused(spoilt), Contains(":4:") && Contains("'-x'") && Contains("finite number"));
  spoilt = text;
  spoilt.replace(spoilt.find("-1 "), 2, "nan");
  CHECK_THAT(refused(spoilt), Contains(":4:") && Contains("finite number"));
  spoilt = text;
  spoilt.replace(spoilt.find("-1 "), 2, "1e300");
  CHECK_THAT(refused(spoilt), Contains(":4:") && Contains("'1e300'") && Contains("finite number"));
  for (const float value : {INFINITY, NAN, 1e38f}) {
    spoilt = binary(box);
    std::memcpy(spoilt.data() + 84 + 50 + 12 + 4, &value, 4);
    CHECK_THAT(refused(spoilt), Contains("byte 150") && Contains("facet 2") && Contains("finite number"));
  }
  CHECK_THAT(refused(text + "more"), Contains("'more'") && Contains("end of the file"));
  std::vector<Facet> open = box;
  open.pop_back();
  CHECK_THAT(refused(binary(open)), Contains("3 open edges") && Contains("the file's own units"));
  std::vector<Facet> twice = box;
  for (const Facet& f : box_facets({1.0, 0.5, 0.25})) twice.push_back(f);
  CHECK_THAT(refused(binary(twice)), Contains("facet 13") && Contains("lies in another"));
  std::vector<Facet> flat = box_facets({2.0, 1.0, 0.0});
  CHECK_FALSE(refused(binary(flat)).empty());
  const TestFile whole(text);
  MeshOptions mesh{.name = "hull", .file = whole.path()};
  CHECK_THROWS_WITH(load_surface(mesh, 7.0), Contains(whole.path()) && Contains("does not reach the plane y = 7 m"));
  load_surface(mesh, 0.25);
  CHECK(mesh.prism->centre()[1] == Approx(0.25));
  CHECK_THROWS_WITH(read_stl("/nowhere/at.stl"), Contains("/nowhere/at.stl") && Contains("cannot be read"));
}
