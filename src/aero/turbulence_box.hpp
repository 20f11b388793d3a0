// A plane of wind against time: what a turbulent box is once it blows past the rotor (Taylor's frozen turbulence). Held as the
// sixteen-bit numbers of TurbSim's files, so that a file that was read is written back bit for bit, or as floats.
// Made by turbulence_files.cpp and turbulence_kaimal.cpp; used by wind.cpp; tested in tests/src/aero/turbulence_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace spindrift::aero {

/// Components u along the wind, v across (to the left when facing along it), w up.
struct TurbulenceBox {
  int across = 0, up = 0, steps = 0;                ///< points across, up, in time
  double across_m = 0.0, up_m = 0.0, step_s = 0.0;  ///< between them
  double hub_height = 0.0, bottom = 0.0;            ///< of the reference, of the lowest row [m]
  double wind = 0.0;                                ///< mean at the hub [m/s], with which the box passes
  bool periodic = true;                             ///< it may follow upon itself
  bool has_mean = false;                            ///< u holds the mean wind and its shear too
  std::vector<float> values;                        ///< [((step * up + row) * across + column) * 3 + component] [m/s]

  double duration() const { return steps * step_s; }
  double width() const { return (across - 1) * across_m; }
  double top() const { return bottom + (up - 1) * up_m; }
  /// At time t in the box, y to the left of its middle, z above still water: trilinear; beyond its edges those hold.
  Eigen::Vector3d at(double t, double y, double z) const;
};

/// TurbSim's full-field format (.bts), as its own numbers. Jonkman (2016), TurbSim user's guide, appendix D.
struct BtsFile {
  std::int16_t id = 8;  ///< 7 or, periodic, 8
  std::int32_t up = 0, across = 0, tower = 0, steps = 0;
  float up_m = 0, across_m = 0, step_s = 0, wind = 0, hub_height = 0, bottom = 0;
  std::array<float, 3> slope{1, 1, 1}, offset{};  ///< velocity = (number - offset) / slope
  std::string description;
  std::vector<std::int16_t> grid, towers;  ///< [step][up][across][3]; [step][tower][3]

  float velocity(std::int16_t number, std::size_t component) const {
    return (float(number) - offset[component]) / slope[component];
  }
};

/// Throws scene::SceneError naming file and byte.
BtsFile read_bts(const std::string& path);
void write_bts(const BtsFile& file, const std::string& path);
TurbulenceBox box_of(const BtsFile& file);
/// Largest scale that sixteen bits bear; the mean wind and its shear are part of it.
BtsFile bts_of(const TurbulenceBox& box, const std::string& description);

/// Three files of floats, one per component, in the order of InflowWind: planes in the order in which they pass slowest, then
/// rows across from left to right facing along the wind, z from below fastest. Throws scene::SceneError naming file and byte.
struct MannGrid {
  std::array<int, 3> points{};  ///< x, y, z
  std::array<double, 3> spacing_m{};
};
TurbulenceBox read_mann(const std::array<std::string, 3>& paths, const MannGrid& grid, double wind, double hub_height);

/// A box by Veers' method (1988, SAND88-0152) from Kaimal's spectra and the exponential coherence of IEC 61400-1: the same for
/// the same seed on every computer.
struct KaimalOptions {
  int across = 15, up = 15;
  double width_m = 0.0, height_m = 0.0;
  double duration_s = 600.0, step_s = 0.2;
  double wind = 10.0, hub_height = 100.0;
  double sigma = 1.5;  ///< of u [m/s]
  std::uint64_t seed = 1;
};
TurbulenceBox kaimal_box(const KaimalOptions& options);

}  // namespace spindrift::aero
