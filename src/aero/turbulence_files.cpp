// Files of turbulent boxes: TurbSim's .bts and the binaries of Mann boxes that HAWC2 reads. Little-endian, as both are.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "src/aero/turbulence_box.hpp"
#include "src/scene/error.hpp"

namespace spindrift::aero {

namespace {

static_assert(std::endian::native == std::endian::little);

[[noreturn]] void refuse(const std::string& path, std::size_t byte, const std::string& what) {
  throw scene::SceneError({{path, 0, fmt::format("byte {}", byte), "", what}});
}

/// A file read value by value.
class Bytes {
 public:
  explicit Bytes(const std::string& path) : path_(path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) refuse(path, 0, "cannot be read");
    data_.assign(std::istreambuf_iterator<char>(file), {});
  }
  template <class T>
  T next(const char* what) {
    T value;
    copy(&value, sizeof value, what);
    return value;
  }
  template <class T>
  void fill(std::vector<T>& values, const char* what) {
    copy(values.data(), values.size() * sizeof(T), what);
  }
  std::size_t at() const { return at_; }
  std::size_t left() const { return data_.size() - at_; }
  const std::string& path() const { return path_; }

 private:
  void copy(void* to, std::size_t size, const char* what) {
    if (size > left())
      refuse(path_, at_, fmt::format("the file ends within {}: {} bytes are wanted, {} are left", what, size, left()));
    if (size > 0) std::memcpy(to, data_.data() + at_, size);
    at_ += size;
  }
  std::string path_;
  std::vector<char> data_;
  std::size_t at_ = 0;
};

void refuse_storm(const std::string& path, std::size_t byte, float velocity) {
  constexpr float fastest = 1000.0f;  // [m/s]
  if (!(std::abs(velocity) <= fastest))
    refuse(path, byte, fmt::format("a velocity is {} m/s; at most {} makes sense", velocity, fastest));
}

}  // namespace

BtsFile read_bts(const std::string& path) {
  Bytes in(path);
  BtsFile f;
  f.id = in.next<std::int16_t>("the format's number");
  if (f.id != 7 && f.id != 8) refuse(path, 0, fmt::format("begins with {}: TurbSim's full-field files begin with 7 or 8", f.id));
  const auto count = [&](const char* what, std::int32_t least) {
    const std::size_t byte = in.at();
    const auto n = in.next<std::int32_t>(what);
    if (n < least || n > 10'000'000) refuse(path, byte, fmt::format("{} is {}; at least {} makes sense", what, n, least));
    return n;
  };
  f.up = count("the number of points up", 1), f.across = count("the number of points across", 1);
  f.tower = count("the number of tower points", 0), f.steps = count("the number of time steps", 1);
  const auto number = [&](const char* what, bool positive) {
    const std::size_t byte = in.at();
    const auto x = in.next<float>(what);
    if (!std::isfinite(x) || (positive && x <= 0.0f)) refuse(path, byte, fmt::format("{} is {}", what, x));
    return x;
  };
  f.up_m = number("the spacing up", true), f.across_m = number("the spacing across", true);
  f.step_s = number("the time step", true), f.wind = number("the mean wind", true);
  f.hub_height = number("the hub's height", true), f.bottom = number("the height of the lowest row", false);
  for (std::size_t c = 0; c < 3; ++c)
    f.slope[c] = number("a scaling slope", true), f.offset[c] = number("a scaling offset", false);
  const auto length = std::size_t(count("the length of the description", 0));
  if (length > in.left()) refuse(path, in.at(), "the file ends within its description");
  std::vector<char> text(length);
  in.fill(text, "the description");
  f.description.assign(text.begin(), text.end());
  const std::size_t points = std::size_t(f.up) * std::size_t(f.across) + std::size_t(f.tower), step_bytes = 6 * points;
  // The product of all counts may be larger than any number of bytes.
  if (in.left() % step_bytes != 0 || in.left() / step_bytes != std::size_t(f.steps))
    refuse(path, in.at(),
           fmt::format("{} bytes of wind follow, {} points and {} steps make {:.10g}", in.left(), points, f.steps,
                       double(step_bytes) * double(f.steps)));
  const std::size_t planes = std::size_t(f.up) * std::size_t(f.across) * 3, towers = std::size_t(f.tower) * 3;
  f.grid.resize(planes * std::size_t(f.steps)), f.towers.resize(towers * std::size_t(f.steps));
  std::vector<std::int16_t> step(planes + towers);
  for (std::size_t s = 0; s < std::size_t(f.steps); ++s) {
    const std::size_t byte = in.at();
    in.fill(step, "the wind");
    for (std::size_t n = 0; n < planes; ++n) refuse_storm(path, byte + 2 * n, f.velocity(step[n], n % 3));
    std::copy_n(step.begin(), planes, f.grid.begin() + std::ptrdiff_t(s * planes));
    std::copy_n(step.begin() + std::ptrdiff_t(planes), towers, f.towers.begin() + std::ptrdiff_t(s * towers));
  }
  return f;
}

void write_bts(const BtsFile& f, const std::string& path) {
  std::ofstream out(path, std::ios::binary);
  const auto put = [&](const auto& value) { out.write(reinterpret_cast<const char*>(&value), sizeof value); };
  put(f.id), put(f.up), put(f.across), put(f.tower), put(f.steps);
  put(f.up_m), put(f.across_m), put(f.step_s), put(f.wind), put(f.hub_height), put(f.bottom);
  for (std::size_t c = 0; c < 3; ++c) put(f.slope[c]), put(f.offset[c]);
  put(std::int32_t(f.description.size()));
  out.write(f.description.data(), std::streamsize(f.description.size()));
  const std::size_t planes = std::size_t(f.up) * std::size_t(f.across) * 3, towers = std::size_t(f.tower) * 3;
  for (std::size_t s = 0; s < std::size_t(f.steps); ++s) {
    out.write(reinterpret_cast<const char*>(f.grid.data() + s * planes), std::streamsize(2 * planes));
    out.write(reinterpret_cast<const char*>(f.towers.data() + s * towers), std::streamsize(2 * towers));
  }
  if (!out.flush()) throw std::runtime_error(path + ": cannot be written");
}

TurbulenceBox box_of(const BtsFile& f) {
  TurbulenceBox box{f.across, f.up, f.steps, f.across_m, f.up_m, f.step_s, f.hub_height, f.bottom, f.wind, f.id == 8, true, {}};
  box.values.resize(f.grid.size());
  for (std::size_t n = 0; n < f.grid.size(); ++n) box.values[n] = f.velocity(f.grid[n], n % 3);
  return box;
}

BtsFile bts_of(const TurbulenceBox& box, const std::string& description) {
  BtsFile f{.id = std::int16_t(box.periodic ? 8 : 7),
            .up = box.up,
            .across = box.across,
            .steps = box.steps,
            .up_m = float(box.up_m),
            .across_m = float(box.across_m),
            .step_s = float(box.step_s),
            .wind = float(box.wind),
            .hub_height = float(box.hub_height),
            .bottom = float(box.bottom),
            .description = description};
  f.grid.resize(box.values.size());
  for (std::size_t c = 0; c < 3; ++c) {
    const float mean = c == 0 && !box.has_mean ? float(box.wind) : 0.0f;
    float low = box.values[c], high = low;
    for (std::size_t n = c; n < box.values.size(); n += 3)
      low = std::min(low, box.values[n]), high = std::max(high, box.values[n]);
    f.slope[c] = high > low ? 65535.0f / (high - low) : 1.0f;
    f.offset[c] = -32768.0f - f.slope[c] * (low + mean);
    for (std::size_t n = c; n < box.values.size(); n += 3)
      f.grid[n] = std::int16_t(std::clamp(std::lround(f.slope[c] * (box.values[n] + mean) + f.offset[c]), -32768L, 32767L));
  }
  return f;
}

TurbulenceBox read_mann(const std::array<std::string, 3>& paths, const MannGrid& grid, double wind, double hub_height) {
  TurbulenceBox box{grid.points[1],
                    grid.points[2],
                    grid.points[0],
                    grid.spacing_m[1],
                    grid.spacing_m[2],
                    grid.spacing_m[0] / wind,
                    hub_height,
                    hub_height - 0.5 * (grid.points[2] - 1) * grid.spacing_m[2],
                    wind,
                    true,
                    false,
                    {}};
  const auto nx = std::size_t(grid.points[0]), ny = std::size_t(grid.points[1]), nz = std::size_t(grid.points[2]);
  for (std::size_t c = 0; c < 3; ++c) {
    Bytes in(paths[c]);
    if (in.left() != 4 * nx * ny * nz)
      refuse(paths[c], 0, fmt::format("has {} bytes; {} x {} x {} floats make {}", in.left(), nx, ny, nz, 4 * nx * ny * nz));
    box.values.resize(3 * nx * ny * nz);
    std::vector<float> field(nx * ny * nz);
    in.fill(field, "the wind");
    for (std::size_t x = 0; x < nx; ++x)
      for (std::size_t y = 0; y < ny; ++y)
        for (std::size_t z = 0; z < nz; ++z) {
          const float value = field[(x * ny + y) * nz + z];
          refuse_storm(paths[c], 4 * ((x * ny + y) * nz + z), value);
          box.values[((x * nz + z) * ny + (ny - 1 - y)) * 3 + c] = value;
        }
  }
  return box;
}

}  // namespace spindrift::aero
