// The viscosities that a scene may choose for the sea of particles. Each is a file, viscosity_NAME.cpp, and a line in
// viscosities.inc. The file has its name, what the reference says of it, the keys that it reads, its limit of the time step and
// its pair sweep, compiled for each dimension and precision; the line names its enumerator and its functions. The term of a pair
// is a type of kernels/sph. Used by schemes.cpp, state.hpp and src/sea/particle_options.cpp; tested in
// tests/src/sea/sph/viscosity_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace spindrift::sph {

struct Parameters;

enum class ViscosityChoice {
#define VISCOSITY(name) name,
#include "src/sea/sph/viscosities.inc"
#undef VISCOSITY
};

struct ViscosityModel {
  std::string_view name, help;
  std::vector<std::string> keys;  ///< of [sea.particles] that it reads
  bool sub_particle = false;      ///< with the stress of unresolved turbulence, from rates of strain by a sweep of their own
  double (*kinematic)(const Parameters&) = nullptr;  ///< largest [m2/s] that limits the time step; null: no limit
};

std::span<const ViscosityModel* const> viscosities();
const ViscosityModel& of(ViscosityChoice viscosity);

}  // namespace spindrift::sph
