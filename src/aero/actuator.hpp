// Actuator disc and actuator lines: the blades of a turbine file as forces in the resolved air, by the sections of blade element
// momentum in the velocity that the air has there. Lines turn; the disc has the forces of all azimuths at once. Method:
// docs/theory/actuator.md; kernel and correction: kernels/rotor/actuator_line.hpp. Built by src/run/flow_case.cpp; tested in
// tests/src/aero/actuator_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "src/aero/actuator_options.hpp"
#include "src/aero/bem.hpp"
#include "src/aero/flow/body_force.hpp"
#include "src/aero/flow/flow_solver.hpp"
#include "src/aero/line_wakes.hpp"
#include "src/aero/options.hpp"
#include "src/aero/resolved_rotor.hpp"

namespace spindrift::aero {

/// Longest cell, by the cube root of its volume, among those at the disc of this hub, axis and radius, or round the hub where the
/// cells are larger than the disc [m]; zero where there are none. Collective.
double cell_at_rotor(const GridStore& store, const Eigen::Vector3d& hub, const Eigen::Vector3d& axis, double radius,
                     MPI_Comm comm);

/// What an actuator of this scene keeps of the cells that its points reach, by the size of the cells at the hub [bytes].
double actuator_bytes(const AeroOptions& aero, const RotorOptions& rotor, const MultiBlockGrid& grid);

class Actuator final : public BodyForce {
 public:
  enum class Kind { disc, lines };
  /// `cell`: at the rotor [m]; `air_density` [kg/m3]; `kinematic_viscosity` [m2/s]: for polars by Reynolds number.
  Actuator(const Turbine& turbine, Kind kind, const ActuatorOptions& options, double air_density, double cell,
           double kinematic_viscosity = air_kinematic_viscosity);

  /// Where the rotor is and how it moves; the velocities sampled next are those that its blades meet. The blades of a disc are
  /// alike: they have `blade_pitch`.
  void place(const DiscMotion& rotor);
  const DiscMotion& motion() const { return rotor_; }

  void attach(std::size_t owned) override { parts_.resize(owned); }
  std::size_t sums() const override { return 4 * points_.size(); }
  void sample(std::size_t n, const FlowTile& tile, std::span<double> part) override;
  void act(std::span<const double> sums) override;
  void spread(std::size_t n, FlowTile& tile) const override;
  /// Force and moment about the hub, six numbers by blade; of a disc for all blades together.
  std::vector<double> loads() const override;

  /// From a row of the march.
  RotorLoad load(const PseudoRow& row) const;
  /// Of one line (1, 2, ...).
  RotorLoad blade_load(int blade, const PseudoRow& row) const;
  /// Lines with columns of their own in history.csv; of a disc none.
  int history_blades() const { return kind_ == Kind::lines ? blades_ : 0; }
  /// Along the blades from root to tip: of each line, or the mean over the disc's azimuths.
  std::vector<SpanLoad> span_loads() const;
  double tip_radius() const { return sections_.tip_radius(); }
  double cell() const { return cell_; }
  /// Of places and weights of the cells that the points reach, where all have the size of those at the rotor.
  double bytes() const;
  /// Least sum of the kernel over the cells at any point: one inside the grid, less where it leaves it. After the last act().
  double least_weight() const;
  /// "actuator_line at 99 points, 10 cells of 8.9 m to the radius".
  std::string description() const;

  /// A point of a blade and what was found there last.
  struct Point {
    std::size_t element = 0;
    int blade = 0;                                      ///< or azimuth of the disc
    double share = 1.0;                                 ///< blades that it stands for
    Eigen::Vector3d arm, normal, ahead;                 ///< from the hub [m]; units
    Eigen::Vector3d sampled = Eigen::Vector3d::Zero();  ///< velocity of the air by the kernel [m/s]
    double weight = 0.0;                                ///< sum of the kernel over the cells
    double normal_wind = 0.0, tangential_wind = 0.0;    ///< that the section meets, corrected [m/s]
    double normal_force = 0.0, tangential_force = 0.0;  ///< on the blade per length [N/m]
    double circulation = 0.0;                           ///< [m2/s]
    Eigen::Vector3d force = Eigen::Vector3d::Zero();    ///< on the blades that it stands for [N]
  };
  std::span<const Point> points() const { return points_; }

 private:
  /// Cells of a tile that points reach.
  struct Part {
    std::int64_t placed = -1;  ///< of which placement
    struct Cell {
      std::int32_t state, inner;  ///< places in FlowTile::cells and ::inner
      double kernel, weight;      ///< [1/m3], times the cell's volume [-]
    };
    std::vector<Cell> cells;
    struct Reach {
      std::uint32_t point, first, last;  ///< among the cells
    };
    std::vector<Reach> reaches;
  };

  void find_cells(Part& part, const FlowTile& tile) const;
  void section_loads(Point& p) const;
  void act_lines();
  double wake_angle() const;
  void balance_lines(double angle, std::span<const double> normal, std::span<const double> tangential,
                     std::span<double> circulation);
  void act_disc();
  RotorLoad load_of(std::span<const double> loads) const;

  Kind kind_;
  bool corrected_;
  int blades_, azimuths_ = 0;  ///< azimuths: of lines the blades
  double air_density_, cell_;
  BladeElementMomentum sections_;
  std::vector<double> width_;  ///< of the kernel, by element [m]
  LineWakes wakes_;
  DiscMotion rotor_{};
  std::vector<double> pitches_;  ///< those of rotor_
  std::int64_t placed_ = 0;
  std::vector<Point> points_;  ///< [blade or azimuth][element]
  std::vector<Part> parts_;
  struct {
    std::vector<double> axial, swirl;  ///< [at][of]
  } rings_;                            ///< of the disc
};

/// Of a scene's turbine with the rotor where `rotor` says. Collective.
std::shared_ptr<Actuator> make_actuator(const AeroOptions& aero, const Turbine& turbine, double air_density,
                                        const GridStore& store, const DiscMotion& rotor, MPI_Comm comm);

}  // namespace spindrift::aero
