// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/memory_limits.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "src/aero/flow_grid.hpp"
#include "src/aero/flow_options.hpp"
#include "src/aero/resolved_rotor_setup.hpp"
#include "src/coupling/flow_scene.hpp"
#include "src/scene/error.hpp"

namespace spindrift::coupling {

namespace {

// Least bytes of one: state, sums and place of a particle; state, matrix in float and metrics of a cell; a strip of a cylinder;
// a number of a matrix over all bodies.
constexpr double of_particle = 100.0, of_cell = 600.0, of_strip = 150.0, of_number = 8.0;
/// What check foretells at most, with all layers of walls and all variables of the air: for numbers that would fit.
constexpr double room_of_particle = 800.0, room_of_cell = 2500.0;
constexpr double most_particles = 4e9;  ///< identities have 32 bits, and the other layers of walls are not counted here

/// Water of the tank, or of its blocks, and one layer of its walls.
double particles(const Scenario& s, double spacing, double top) {
  const sea::TankOptions& t = *s.sea.tank;
  const bool planar = s.sea.particles->planar();
  const double depth = s.environment.water_depth_m, x = t.x_m[1] - t.x_m[0], y = planar ? spacing : t.y_m[1] - t.y_m[0];
  double water = x * y * depth, wall = x * y;
  if (!s.sea.water.empty()) water = 0.0;
  for (const sea::BoxOptions& b : s.sea.water) {
    const Eigen::Vector3d size = b.high_m - b.low_m;
    water += size.x() * (planar ? spacing : size.y()) * size.z();
  }
  if (t.sides_x != "periodic") wall += 2.0 * y * (depth + top);
  if (t.sides_y != "periodic" && !planar) wall += (t.symmetric() ? 1.0 : 2.0) * x * (depth + top);
  return std::max(0.0, water) / std::pow(spacing, 3) + std::max(0.0, wall) / (spacing * spacing);
}

Demand sea_demand(const Scenario& s, double memory) {
  const double d = s.sea.particles->spacing_m, top = s.sea.tank->top_m, count = particles(s, d, top);
  // High walls are mended by their height, the rest by the spacing.
  const bool walls =
      particles(s, d, std::min(top, 0.0)) < 0.5 * count && particles(s, d, std::min(top, 0.0)) * of_particle < memory;
  Demand demand{walls ? "sea.tank.top_m" : "sea.particles.spacing_m",
                fmt::format("{}", walls ? top : d),
                "particles",
                count,
                count * of_particle,
                {},
                most_particles};
  double fits = walls ? top : d, fails = fits;
  for (int step = 0; step < 200 && particles(s, walls ? d : fits, walls ? fits : top) * room_of_particle > memory; ++step)
    fails = fits, fits *= walls ? 0.5 : 2.0;
  for (int step = 0; step < 12; ++step) {
    const double middle = std::sqrt(fits * fails);
    (particles(s, walls ? d : middle, walls ? middle : top) * room_of_particle > memory ? fails : fits) = middle;
  }
  demand.that_fits = fmt::format("{} {:.2g}", walls ? "at most" : "at least", fits * (walls ? 0.95 : 1.05));
  return demand;
}

std::string bytes_text(double bytes) {
  return bytes < 1e12 ? fmt::format("{:.3g} GB", 1e-9 * bytes) : fmt::format("{:.3g} TB", 1e-12 * bytes);
}

}  // namespace

std::vector<Demand> demands_of(const Scenario& s, double memory) {
  std::vector<Demand> demands;
  const double bodies = double(s.bodies.size());
  if (bodies > 100.0)
    demands.push_back({"bodies", "", "bodies", bodies, 36.0 * bodies * bodies * of_number,
                       fmt::format("at most {:.0f} bodies", std::sqrt(memory / (36.0 * of_number)))});
  if (s.has_particles() && s.sea.particles && s.sea.tank) demands.push_back(sea_demand(s, memory));
  if (s.sea.model == "morison") {
    double length = 0.0;
    for (const auto& body : s.bodies)
      for (const bodies::CylinderOptions& c : body.options.cylinders) length += (c.end_m - c.start_m).norm();
    const double count = length / s.sea.strip_length_m;
    demands.push_back({"sea.strip_length_m", fmt::format("{}", s.sea.strip_length_m), "strips", count, count * of_strip,
                       fmt::format("at least {:.2g}", std::max(length * of_strip / memory, length / 1e6) * 1.05)});
    if (count > 1e6) demands.back().bytes = std::max(demands.back().bytes, 2.0 * memory);  // a step would take seconds
  }
  if (s.resolves_air() && s.aero.flow && s.aero.flow->generate) {
    const auto [count, key] = aero::generated_size(*s.aero.flow->generate);
    demands.push_back({key, "", "cells", count, count * of_cell, fmt::format("at most {:.3g} cells", memory / room_of_cell)});
  }
  if (s.resolves_air() && s.aero.grid) {
    aero::ResolvedRotorSetup setup = resolved_rotor_setup(s);
    const aero::ResolvedRotorSize size = aero::resolved_rotor_size(setup);
    demands.push_back({"aero.grid.resolution", fmt::format("{}", setup.grid.resolution), "cells", double(size.cells), size.bytes,
                       fmt::format("some {:.2g}", setup.grid.resolution * std::cbrt(memory / std::max(size.bytes, 1.0)))});
  }
  return demands;
}

void require_memory(const Scenario& s, double memory) {
  std::vector<scene::Problem> problems;
  for (const Demand& demand : demands_of(s, memory))
    if (demand.count > demand.most && demand.bytes <= memory)
      problems.push_back(
          {s.source, 0, demand.key, demand.value,
           fmt::format("makes {:.4g} {}: at most {:g} can be told apart", demand.count, demand.things, demand.most)});
    else if (!(demand.bytes <= memory))
      problems.push_back({s.source, 0, demand.key, demand.value,
                          fmt::format("makes {:.4g} {}, which take {} or more; there are {}; {} would fit", demand.count,
                                      demand.things, bytes_text(demand.bytes), bytes_text(memory), demand.that_fits)});
  if (!problems.empty()) throw scene::SceneError(problems);
}

double machine_memory() {
  double bytes = double(::sysconf(_SC_PHYS_PAGES)) * double(::sysconf(_SC_PAGE_SIZE));
  for (const char* file : {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"})
    if (double limit = 0.0; std::ifstream(file) >> limit && limit > 0.0) bytes = std::min(bytes, limit);
  return bytes;
}

}  // namespace spindrift::coupling
