// Boxes for verification: Cartesian, smoothly perturbed, sheared with thin cells, or mapped by any function; each side a patch
// or, in pairs, periodic. Every size of a family samples the same mapping. Called by tests, benchmarks and src/aero/flow's
// verification scenes; tested in tests/src/aero/grid/generators_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "src/aero/grid/multi_block.hpp"

namespace spindrift::aero {

/// Position [m] at (u, v, w) in the unit cube, running along i, j, k.
using Mapping = std::function<Eigen::Vector3d(double, double, double)>;

Block mapped_block(std::string name, int ni, int nj, int nk, const Mapping& position);

struct BoxOptions {
  int ni = 8, nj = 8, nk = 8;
  Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = Eigen::Vector3d::Ones();  ///< [m]
  std::array<bool, 3> periodic{};                                                 ///< in i, j, k
  std::array<std::string, 6> patches{"i_min", "i_max", "j_min", "j_max", "k_min", "k_max"};
};

/// i along x, j along y, k along z.
MultiBlockGrid cartesian_box(const BoxOptions& options);

/// Nodes along an axis [m]: cells of `cell` between core_low and core_high (or a little off, so that they fill it), beyond it
/// cells that grow from one to the next by at most `growth`. Their number is a multiple of four, for two coarser grids of every
/// second node. The core reaches a side or stays four cells from it.
std::vector<double> stretched_nodes(double low, double core_low, double core_high, double high, double cell, double growth);

/// i along x, j along y, k along z, with the nodes given along each; `options` for sides.
MultiBlockGrid cartesian_box(const std::array<std::vector<double>, 3>& nodes, BoxOptions options);

/// One cell thick: i along x, j along z, k along -y over `options.high.y - options.low.y`; options.nk is not used.
MultiBlockGrid planar_box(const BoxOptions& options);

/// The interior of a box (planar or not) displaced by waves of `amplitude` (of the box's size; up to 0.06 keeps cells positive);
/// the sides move too where they are periodic.
MultiBlockGrid perturbed(MultiBlockGrid box, const BoxOptions& options, double amplitude);

/// Cells of edges 1 x 1 x thin [m] leaning by `shear` (tangent) in both directions and turned about a skew axis; not periodic.
MultiBlockGrid thin_sheared_box(int n, double thin = 1e-5, double shear = 1.0);

/// Positions of all nodes replaced by their images; periodic translations must be carried along by the caller's function.
void deform(MultiBlockGrid& grid, const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& position);

}  // namespace spindrift::aero
