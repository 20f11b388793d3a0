// A small turbine of windIO 1.x with all that the import reads: for its tests, and a seed of the readers' fuzz target.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace spindrift::testing {

inline const std::string small_turbine = R"(assembly: {number_of_blades: 3, hub_height: 90.0, rotor_orientation: Upwind}
components:
  hub: {diameter: 4.0, cone_angle: 0.1}
  nacelle: {drivetrain: {uptilt: 0.05, overhang: 5.0}}
  blade:
    outer_shape_bem:
      airfoil_position: {grid: [0.0, 0.2, 1.0], labels: [root, root, tip]}
      chord: {grid: [0.0, 1.0], values: [3.0, 1.0]}
      twist: {grid: [0.0, 1.0], values: [0.2, 0.0]}
      reference_axis:
        x: {grid: [0.0, 1.0], values: [0.0, -2.0]}
        y: {grid: [0.0, 1.0], values: [0.0, 0.5]}
        z: {grid: [0.0, 1.0], values: [0.0, 50.0]}
  tower:
    outer_shape_bem:
      reference_axis:
        x: {grid: [0.0, 1.0], values: [0.0, 0.0]}
        y: {grid: [0.0, 1.0], values: [0.0, 0.0]}
        z: {grid: [0.0, 1.0], values: [10.0, 85.0]}
      outer_diameter: {grid: [0.0, 0.4, 0.4, 1.0], values: [8.0, 8.0, 6.0, 5.0]}
      drag_coefficient: {grid: [0.0, 1.0], values: [0.5, 0.7]}
    internal_structure_2d_fem:
      outfitting_factor: 1.1
      layers:
        - {name: wall, material: steel, thickness: {grid: [0.0, 1.0], values: [0.05, 0.05]}}
        - {name: lining, material: wood, thickness: {grid: [0.0, 1.0], values: [0.1, 0.1]}}
materials:
  - {name: steel, rho: 7800, E: 2.0e11, G: 7.9e10}
  - {name: wood, rho: 500, E: 1.0e10, nu: 0.25}
airfoils:
  - name: root
    relative_thickness: 1.0
    polars: [{re: 1e6, c_l: {grid: [-3.141, 3.141], values: [0.0, 0.0]}, c_d: {grid: [-3.141, 3.141], values: [0.5, 0.5]}}]
  - name: tip
    relative_thickness: 0.2
    polars: [{re: 1e6, c_l: {grid: [-3.141, 0.0, 3.141], values: [0.0, 0.4, 0.0]}, c_d: {grid: [-3.141, 3.141], values: [0.01, 0.01]}}]
control:
  torque: {VS_minspd: 0.5, VS_maxspd: 1.2, tsr: 7.0}
  supervisory: {Vin: 3.0}
environment: {air_density: 1.225, air_dyn_viscosity: 1.8e-5}
)";

}  // namespace spindrift::testing
