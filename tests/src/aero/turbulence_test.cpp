// Turbulent boxes: files read back bit for bit and refused by byte, our own boxes against the spectra and coherence they are made
// from, the order of a Mann box.
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include <complex>
#include <filesystem>
#include <fstream>
#include <limits>

#include "kernels/base/constants.hpp"
#include "kernels/base/random.hpp"
#include "kernels/rotor/turbulence_kaimal.hpp"
#include "src/aero/turbulence_box.hpp"
#include "src/scene/error.hpp"

using namespace spindrift;
using namespace spindrift::aero;

namespace {

struct TemporaryFile {
  std::string path;
  explicit TemporaryFile(const std::string& name)
      : path((std::filesystem::temp_directory_path() / ("spindrift_" + std::to_string(getpid()) + "_" + name)).string()) {}
  ~TemporaryFile() { std::filesystem::remove(path); }
};

std::string bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

BtsFile small_file() {
  BtsFile f{.id = 8,
            .up = 3,
            .across = 4,
            .tower = 2,
            .steps = 5,
            .up_m = 10,
            .across_m = 12,
            .step_s = 0.5f,
            .wind = 9,
            .hub_height = 90,
            .bottom = 80,
            .slope = {1000, 2000, 3000},
            .offset = {-9000, 1, -2},
            .description = "made by a test"};
  Random random(3);
  f.grid.resize(3 * 3 * 4 * 5), f.towers.resize(3 * 2 * 5);
  for (auto* values : {&f.grid, &f.towers})
    for (std::int16_t& v : *values) v = std::int16_t(random.bits());
  return f;
}

}  // namespace

TEST_CASE("a .bts file is written back as it was read, bit for bit", "[aero][fast]") {
  const TemporaryFile first("first.bts"), second("second.bts");
  const BtsFile f = small_file();
  write_bts(f, first.path);
  const BtsFile g = read_bts(first.path);
  CHECK(g.grid == f.grid);
  CHECK(g.towers == f.towers);
  CHECK(g.description == f.description);
  write_bts(g, second.path);
  CHECK(bytes_of(first.path) == bytes_of(second.path));
  CHECK(bytes_of(first.path).size() == 2 + 16 + 24 + 24 + 4 + 14 + 2 * 3 * 5 * (12 + 2));
}

TEST_CASE("velocities of a .bts are (number - offset) / slope, columns from the right, rows from below", "[aero][fast]") {
  const BtsFile f = small_file();
  const TurbulenceBox box = box_of(f);
  const auto number = [&](int step, int row, int column, int c) {
    return (f.grid[std::size_t(((step * 3 + row) * 4 + column) * 3 + c)] - double(f.offset[std::size_t(c)])) /
           double(f.slope[std::size_t(c)]);
  };
  CHECK(box.at(1.0, -18.0, 90.0).x() == Approx(number(2, 1, 0, 0)));
  CHECK(box.at(0.5, 18.0, 100.0).z() == Approx(number(1, 2, 3, 2)));
  CHECK(box.at(0.25, -18.0, 80.0).y() == Approx(0.5 * (number(0, 0, 0, 1) + number(1, 0, 0, 1))));
  CHECK(box.at(2.75, -18.0, 80.0).y() == Approx(box.at(0.25, -18.0, 80.0).y()));  // it follows upon itself
}

TEST_CASE("a malformed .bts is refused by its byte", "[aero][fast]") {
  const TemporaryFile file("bad.bts");
  write_bts(small_file(), file.path);
  const std::string good = bytes_of(file.path);
  const auto message = [&](std::string bytes) -> std::string {
    std::ofstream(file.path, std::ios::binary) << bytes;
    try {
      read_bts(file.path);
    } catch (const scene::SceneError& e) { return e.what(); }
    return "";
  };
  CHECK(message("").find("byte 0") != std::string::npos);
  for (const std::size_t length : {1u, 2u, 7u, 13u, 20u, 30u, 41u, 60u, 66u, 71u, 80u}) {
    CAPTURE(length);
    CHECK(message(good.substr(0, length)).find("byte") != std::string::npos);
  }
  CHECK(message(good.substr(0, good.size() - 1)).find("bytes of wind follow") != std::string::npos);
  CHECK(message(good + "x").find("bytes of wind follow") != std::string::npos);
  const auto with = [&](std::size_t at, const std::string& bytes) {
    std::string bad = good;
    return bad.replace(at, bytes.size(), bytes);
  };
  // Ten million points each way in ten million steps: more bytes than 64 bits can count.
  const std::string ten_million("\x80\x96\x98\0", 4), none(4, '\0');
  CHECK(message(with(2, ten_million + ten_million + none + ten_million)).find("make 6e+21") != std::string::npos);
  CHECK(message(with(0, {"\x04\x00", 2})).find("begins with 4") != std::string::npos);
  CHECK(message(with(2, {"\xff\xff\xff\xff", 4})).find("byte 2") != std::string::npos);
  CHECK(message(with(6, {"\x00\x00\x00\x00", 4})).find("byte 6") != std::string::npos);
  CHECK(message(with(14, {"\xff\xff\xff\x7f", 4})).find("byte 14") != std::string::npos);
  CHECK(message(with(18, {"\x00\x00\xc0\x7f", 4})).find("byte 18") != std::string::npos);  // not a number
  CHECK(message(with(26, {"\x00\x00\x00\x00", 4})).find("byte 26") != std::string::npos);  // no time step
  CHECK(message(with(66, {"\xff\xff\xff\x7f", 4})).find("byte 66") != std::string::npos);
  CHECK(message(with(42, {"\x00\x00\x80\x00", 4})).find("a velocity is") != std::string::npos);  // slope 1e-38
}

TEST_CASE("a box survives its .bts to the last of sixteen bits", "[aero][fast]") {
  const TurbulenceBox box =
      kaimal_box({.across = 3, .up = 3, .width_m = 100, .height_m = 100, .duration_s = 60, .step_s = 0.5, .wind = 10, .seed = 4});
  const BtsFile file = bts_of(box, "Kaimal");
  const TurbulenceBox again = box_of(file);
  for (std::size_t n = 0; n < box.values.size(); ++n)
    CHECK(double(again.values[n]) - (n % 3 == 0 ? 10.0 : 0.0) == Approx(box.values[n]).margin(1.0 / file.slope[n % 3]));
}

TEST_CASE("a Mann box has z fastest, its first plane first and each plane from left to right", "[aero][fast]") {
  const TemporaryFile u("u.bin"), v("v.bin"), w("w.bin");
  const int nx = 3, ny = 2, nz = 4;
  for (const TemporaryFile* file : {&u, &v, &w}) {
    std::vector<float> values;
    for (int n = 0; n < nx * ny * nz; ++n) values.push_back(float(n) + (file == &v ? 100.0f : file == &w ? 200.0f : 0.0f));
    std::ofstream(file->path, std::ios::binary).write(reinterpret_cast<const char*>(values.data()), 4 * nx * ny * nz);
  }
  const TurbulenceBox box = read_mann({u.path, v.path, w.path}, {{nx, ny, nz}, {20.0, 10.0, 10.0}}, 10.0, 90.0);
  CHECK(box.step_s == 2.0);
  CHECK(box.at(0.0, 5.0, 75.0) == Eigen::Vector3d(0.0, 100.0, 200.0));
  CHECK(box.at(0.0, -5.0, 75.0).x() == 4.0);
  CHECK(box.at(2.0, 5.0, 85.0).x() == 9.0);
  CHECK(box.at(4.0, 5.0, 75.0).x() == 16.0);
  CHECK_THROWS_AS(read_mann({u.path, v.path, w.path}, {{nx, ny, nz + 1}, {20.0, 10.0, 10.0}}, 10.0, 90.0), scene::SceneError);
  for (const float storm : {-3e38f, std::numeric_limits<float>::quiet_NaN()}) {
    CAPTURE(storm);
    std::fstream(v.path, std::ios::binary | std::ios::in | std::ios::out)
        .seekp(20)
        .write(reinterpret_cast<const char*>(&storm), 4);
    CHECK_THROWS_WITH(read_mann({u.path, v.path, w.path}, {{nx, ny, nz}, {20.0, 10.0, 10.0}}, 10.0, 90.0),
                      Catch::Contains("byte 20") && Catch::Contains("a velocity is"));
  }
}

TEST_CASE("twenty seeds of our box have Kaimal's spectra and IEC's coherence within their scatter", "[aero][fast]") {
  const KaimalOptions options{.across = 3,
                              .up = 2,
                              .width_m = 40,
                              .height_m = 20,
                              .duration_s = 256,
                              .step_s = 0.5,
                              .wind = 12,
                              .hub_height = 119,
                              .sigma = 1.7};
  constexpr int seeds = 20, steps = 512;
  constexpr std::array<std::array<int, 2>, 4> bands{{{2, 6}, {6, 16}, {16, 48}, {48, 160}}};  // in steps of 1 / 256 Hz
  std::array<std::array<double, 4>, 3> power{};
  std::array<std::complex<double>, 4> cross{};
  std::array<double, 4> near{}, far{};
  for (int seed = 1; seed <= seeds; ++seed) {
    KaimalOptions of_seed = options;
    of_seed.seed = std::uint64_t(seed);
    const TurbulenceBox box = kaimal_box(of_seed);
    REQUIRE(box.steps == steps);
    const auto line = [&](int point, int component, int k) {
      std::complex<double> sum = 0.0;
      for (int s = 0; s < steps; ++s)
        sum += double(box.values[std::size_t((s * 6 + point) * 3 + component)]) *
               std::polar(1.0, -2.0 * pi * double((long(k) * s) % steps) / steps);
      return sum / double(steps);
    };
    for (std::size_t b = 0; b < bands.size(); ++b)
      for (int k = bands[b][0]; k < bands[b][1]; ++k) {
        const std::complex<double> u = line(0, 0, k), u2 = line(1, 0, k);
        power[0][b] += 2.0 * std::norm(u), power[1][b] += 2.0 * std::norm(line(0, 1, k)),
            power[2][b] += 2.0 * std::norm(line(0, 2, k));
        cross[b] += u * std::conj(u2), near[b] += std::norm(u), far[b] += std::norm(u2);
      }
  }
  const double scale = 42.0;
  for (std::size_t b = 0; b < bands.size(); ++b) {
    const int lines = bands[b][1] - bands[b][0];
    const double scatter = 4.0 / std::sqrt(double(seeds * lines));  // four standard deviations of a mean of exponentials
    double coherence = 0.0, weight = 0.0;
    for (int k = bands[b][0]; k < bands[b][1]; ++k) {
      const double s = kaimal::density(k / 256.0, 1.7, 8.1 * scale, 12.0);
      coherence += s * kaimal::coherence(k / 256.0, 20.0, 8.1 * scale, 12.0), weight += s;
    }
    for (std::size_t c = 0; c < 3; ++c) {
      double wanted = 0.0;
      for (int k = bands[b][0]; k < bands[b][1]; ++k)
        wanted += kaimal::density(k / 256.0, 1.7 * kaimal::sigma_ratio[c], kaimal::length_ratio[c] * scale, 12.0) / 256.0;
      // Point 0 is the first of the factor: its phases alone are random, its power is exact; the others scatter.
      CHECK(power[c][b] / seeds == Approx(wanted).epsilon(scatter));
    }
    CHECK(far[b] / near[b] == Approx(1.0).epsilon(scatter));
    CHECK(std::abs(cross[b]) / std::sqrt(near[b] * far[b]) == Approx(coherence / weight).margin(scatter));
  }
}

TEST_CASE("the same seed gives the same box, another seed another", "[aero][fast]") {
  const auto box = [](std::uint64_t seed) {
    return kaimal_box({.across = 2, .up = 2, .width_m = 50, .height_m = 50, .duration_s = 30, .step_s = 0.5, .seed = seed})
        .values;
  };
  CHECK(box(5) == box(5));
  CHECK(box(5) != box(6));
}
