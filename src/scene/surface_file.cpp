// SPDX-License-Identifier: Apache-2.0
#include "src/scene/surface_file.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string_view>
#include <system_error>

#include "kernels/rigid/closed_surface.hpp"
#include "kernels/rigid/rotation.hpp"
#include "src/scene/document.hpp"
#include "src/scene/error.hpp"
#include "src/scene/section.hpp"

namespace spindrift::scene {

namespace {

constexpr std::size_t header_bytes = 80, facet_bytes = 50;
constexpr double largest = 1e30;  ///< of a coordinate: its fifth power, in moments of volumes, is a number too

[[noreturn]] void refuse_surface(const std::string& file, int line, const std::string& message) {
  throw SceneError({Problem{.source = file, .line = line, .key = "", .value = "", .message = message}});
}

std::string bytes_of(const std::string& path) {
  constexpr std::uintmax_t most = 1u << 30;
  std::error_code none;
  std::ifstream file(path, std::ios::binary);
  if (!file || !std::filesystem::is_regular_file(path, none)) refuse_surface(path, 0, "cannot be read");
  if (const std::uintmax_t size = std::filesystem::file_size(path, none); size > most)
    refuse_surface(path, 0, fmt::format("has {:.2g} GB; a surface may have {:.2g}", 1e-9 * double(size), 1e-9 * double(most)));
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// Little-endian, as all STL files are.
template <class T>
T number_at(const std::string& bytes, std::size_t at) {
  static_assert(std::endian::native == std::endian::little);
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

std::vector<Facet> read_binary(const std::string& path, const std::string& bytes) {
  const std::size_t count = number_at<std::uint32_t>(bytes, header_bytes);
  std::vector<Facet> facets(count);
  for (std::size_t f = 0; f < count; ++f)
    for (std::size_t corner = 0; corner < 3; ++corner)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t at = header_bytes + 4 + f * facet_bytes + 12 * (corner + 1) + 4 * axis;  // a normal comes first
        const double x = double(number_at<float>(bytes, at));
        if (!(std::abs(x) < largest))
          refuse_surface(path, 0,
                         fmt::format("byte {}: a coordinate of facet {} is {:g}; it must be a finite number below {:g}", at,
                                     f + 1, x, largest));
        facets[f][corner][Eigen::Index(axis)] = x;
      }
  return facets;
}

/// Words of a text file with the lines they are in.
class Words {
 public:
  Words(const std::string& path, std::string_view text) : path_(path), text_(text) {}
  /// Empty at the end.
  std::string_view next() {
    while (at_ < text_.size() && is_blank(text_[at_])) line_ += text_[at_++] == '\n';
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_blank(text_[at_])) ++at_;
    return word_ = text_.substr(begin, at_ - begin);
  }
  void skip_line() { at_ = std::min(text_.find('\n', at_), text_.size()); }
  void want(std::string_view word, const char* where) {
    if (!is(next(), word)) wrong(fmt::format("must be '{}' {}", word, where));
  }
  double number() {
    std::string_view word = next();
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty() || error != std::errc() || end != word.data() + word.size() || !(std::abs(value) < largest))
      wrong(fmt::format("must be a finite number below {:g}, one of three after 'vertex'", largest));
    return value;
  }
  [[noreturn]] void wrong(const std::string& what) const {
    if (word_.empty()) refuse_surface(path_, line_, "ends where there " + what);
    refuse_surface(path_, line_, fmt::format("found '{}', which {}", word_.substr(0, 40), what));
  }
  static bool is(std::string_view word, std::string_view wanted) {
    return std::equal(word.begin(), word.end(), wanted.begin(), wanted.end(),
                      [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; });
  }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }
  const std::string& path_;
  std::string_view text_, word_;
  std::size_t at_ = 0;
  int line_ = 1;
};

std::vector<Facet> read_text(const std::string& path, const std::string& bytes) {
  Words words(path, bytes);
  std::vector<Facet> facets;
  words.want("solid", "at the beginning");
  words.skip_line();  // the solid's name
  for (;;) {
    const std::string_view word = words.next();
    if (Words::is(word, "endsolid")) {
      words.skip_line();
      const std::string_view another = words.next();
      if (another.empty()) return facets;
      if (!Words::is(another, "solid")) words.wrong("must be 'solid' or the end of the file");
      words.skip_line();
      continue;
    }
    if (!Words::is(word, "facet")) words.wrong("must be 'facet' or 'endsolid'");
    words.skip_line();  // the normal
    words.want("outer", "after the facet's normal");
    words.want("loop", "after 'outer'");
    Facet& facet = facets.emplace_back();
    for (Eigen::Vector3d& corner : facet) {
      words.want("vertex", "three times in a facet");
      for (int axis = 0; axis < 3; ++axis) corner[axis] = words.number();
    }
    words.want("endloop", "after three vertices");
    words.want("endfacet", "after 'endloop'");
  }
}

}  // namespace

std::vector<Facet> read_stl(const std::string& path) {
  const std::string bytes = bytes_of(path);
  std::vector<Facet> facets;
  const std::size_t body = header_bytes + 4;
  const std::optional<std::size_t> count =
      bytes.size() >= body ? std::optional<std::size_t>(number_at<std::uint32_t>(bytes, header_bytes)) : std::nullopt;
  if (count && bytes.size() == body + *count * facet_bytes) {
    facets = read_binary(path, bytes);
  } else if (Words::is(Words(path, bytes).next(), "solid") && bytes.find('\0') == std::string::npos) {  // binary ones have zeros
    facets = read_text(path, bytes);
  } else if (count) {
    refuse_surface(
        path, 0,
        fmt::format("is no STL file: it is no text that begins with 'solid', and as a binary one of {} facets (byte {}) it "
                    "would have {} bytes where it has {}: is it cut off?",
                    *count, header_bytes, body + *count * facet_bytes, bytes.size()));
  } else {
    refuse_surface(
        path, 0,
        fmt::format("is no STL file: it does not begin with 'solid', and a binary one has {} bytes at least; it has {}", body,
                    bytes.size()));
  }
  if (facets.empty()) refuse_surface(path, 0, "has no facets");
  return facets;
}

void load_surface(MeshOptions& mesh, std::optional<double> plane_y) {
  Triangulation found = weld(read_stl(mesh.file));
  if (const std::optional<std::string> why = why_not_closed(found))
    refuse_surface(mesh.file, 0, *why + " (in the file's own units)");
  const Eigen::Matrix3d turn = attitude(mesh.rotation).toRotationMatrix();
  for (Eigen::Vector3d& x : found.points) x = turn * (mesh.scale * x) + mesh.position_m;
  auto surface = std::make_shared<const ClosedSurface>(std::move(found));
  if (!(surface->volume() > 1e-9 * std::pow(surface->box().diagonal().norm(), 3)))
    refuse_surface(mesh.file, 0, "encloses no volume");
  if (const auto part = surface->misplaced_part())
    refuse_surface(
        mesh.file, 0,
        fmt::format("has a part, that of facet {}, {}", surface->facet(part->triangle),
                    part->inside ? "that lies in another: what both enclose would count twice; a hollow's facets turn the "
                                   "other way"
                                 : "that is inside out beside others"));
  if (plane_y) {
    const Outline outline = outline_of(*surface, *plane_y);
    if (outline.segments.empty())
      refuse_surface(mesh.file, 0,
                     fmt::format("does not reach the plane y = {:g} m of a 2-D scene: it is from y = {:.6g} to {:.6g} m",
                                 *plane_y, surface->box().min()[1], surface->box().max()[1]));
    mesh.prism = std::make_shared<const ClosedSurface>(prism_of(outline));
  }
  mesh.surface = std::move(surface);
}

void load_surfaces(Document& document, const std::string& key, std::vector<MeshOptions>& meshes, std::optional<double> plane_y) {
  for (std::size_t n = 0; n < meshes.size(); ++n) try {
      load_surface(meshes[n], plane_y);
    } catch (const SceneError& e) { document.problem(fmt::format("{}[{}].file", key, n), e.what()); }
}

Section<MeshOptions> mesh_section(const std::string& help) {
  return Section<MeshOptions>("meshes", help)
      .text("name", &MeshOptions::name, "Name, for messages.")
      .required()
      .path("file", &MeshOptions::file,
            "STL file, ASCII or binary: a closed surface; corners run counter-clockwise seen from outside, or all of them "
            "the other way.")
      .required()
      .number("scale", &MeshOptions::scale, "-", "Metres to a unit of the file: 0.001 for millimetres.", above(0.0).up_to(1e6))
      .vector("position_m", &MeshOptions::position_m, "m", "Where the file's origin is, initial earth coordinates.")
      .degrees("rotation_deg", &MeshOptions::rotation,
               "The file turned by roll, pitch, yaw about its origin (yaw first, then pitch, then roll).");
}

}  // namespace spindrift::scene
