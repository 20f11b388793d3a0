// The wake of blades as vortex filaments that the wind and the filaments themselves carry: a lifting line for each blade, whose
// circulation is that of its sections' lift. Van Garrel (2003), ECN-C--03-079; Shaler, Branlard & Platt (2020), OLAF user's
// guide, NREL/TP-5000-75959. Behind each blade lies a lattice of rings for a part of a turn; then one filament of the tip and one
// of the root, where the lattice's vorticity has its middle; beyond them a vortex cylinder. Equations:
// docs/theory/rotor_engineering.md. Used by src/aero/bem.cpp; tested in tests/kernels/rotor/free_vortex_wake_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "kernels/base/constants.hpp"

namespace spindrift {

class VortexFilaments;
struct VortexTail;

/// Blades as lines, blade after blade, each from its root; earth frame [m].
struct LiftingLines {
  std::vector<Eigen::Vector3d> ends;     ///< of sections: one more to a blade than it has sections
  std::vector<Eigen::Vector3d> middles;  ///< of sections
  double sense = 1.0;                    ///< -1: blades turn against the axis; circulation is positive with positive lift
};

class FreeVortexWake {
 public:
  struct Options {
    double turns = 6.0;                       ///< length of the wake
    double step = 15.0 * radians_per_degree;  ///< way of the tip through the air in a step of the wake, over its radius [rad]
    double core_chords = 0.25;                ///< radius of new cores
    double viscosity = 1.46e-5;               ///< kinematic [m2/s]
  };
  /// `chords` of the sections of a blade [m]; `radius` of the tip [m].
  FreeVortexWake(const Options& options, std::span<const double> chords, int blades, double radius);

  /// All that the wake is, in plain numbers that the caller keeps.
  std::size_t memory_size() const;

  /// Of the undisturbed air at a point [m/s].
  using Air = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;
  /// Circulation of a section (of all blades) where the wake induces this velocity [m2/s].
  using Circulation = std::function<double(std::size_t, const Eigen::Vector3d&)>;

  /// How a wake begins: on helices that the rotor would have left, of constant circulation; of none where the wind hardly carries
  /// them, so that the rotor begins in air at rest.
  struct Start {
    Eigen::Vector3d hub, omega;           ///< [m], [rad/s]
    Eigen::Vector3d axis, wind;           ///< unit, downwind; relative to the hub [m/s]
    double induction = 0.0;               ///< mean axial one of the disc
    std::span<const double> circulation;  ///< of all sections [m2/s]
  };
  /// `induced` [m/s]: at all sections. Whether circulation and wake agree within a hundredth.
  bool begin(const LiftingLines& blades, const Start& start, const Circulation& circulation, std::span<double> memory,
             std::span<Eigen::Vector3d> induced) const;

  /// Counts h on, in which blades turn with `speed` [rad/s] in `wind` [m/s]. The time since the wake's last step, where its next
  /// one is due; else 0.
  double due(double h, double speed, double wind, std::span<double> memory) const;
  /// A step of h, at whose start the air was so and at whose end the blades are here. Whether the circulation agrees with the
  /// wake.
  bool advance(const LiftingLines& blades, const Air& air, double h, const Circulation& circulation, std::span<double> memory,
               std::span<Eigen::Vector3d> induced) const;

  /// Of the air by the whole wake and the blades' own vortices [m/s].
  void add_velocities(std::span<const double> memory, double sense, std::span<const Eigen::Vector3d> points,
                      std::span<Eigen::Vector3d> velocities) const;

 private:
  enum Side : std::size_t { root, tip };
  /// Lines 0 to near_rows_ of the lattice, line 0 on the blades; lines 0 to far_rows_ of the two filaments behind, line 0 in the
  /// lattice's last. A row lies between two lines.
  struct State {
    std::vector<double> age;                         ///< of all lines [s]
    std::vector<Eigen::Vector3d> near, far;          ///< [m]
    std::vector<Eigen::Vector3d> near_was, far_was;  ///< velocities of the last step [m/s]
    std::vector<double> rings, pairs;                ///< circulation of the lattice's rings, of the filaments [m2/s]
    double last_step;                                ///< [s]; 0: none
  };
  /// Header of the memory.
  enum Header : std::size_t { travelled, since, last_step, header_size };

  std::size_t near_at(std::size_t blade, std::size_t line, std::size_t end) const {
    return (blade * (near_rows_ + 1) + line) * (sections() + 1) + end;
  }
  std::size_t far_at(std::size_t blade, std::size_t line, Side side) const { return (blade * (far_rows_ + 1) + line) * 2 + side; }
  std::size_t ring_at(std::size_t blade, std::size_t row, std::size_t section) const {
    return (blade * near_rows_ + row) * sections() + section;
  }
  std::size_t sections() const { return chords_.size(); }
  State sized() const;
  template <class Visit>
  static void for_each_part(State& s, const Visit& visit);
  State load(std::span<const double> memory) const;
  void save(State& s, std::span<double> memory) const;
  double end_chord(std::size_t end) const;
  /// Core of a filament of this row between lines of this age [m].
  double core(double chord, double age, double circulation) const;
  /// Middles of the vorticity that a row trails, of values at the section ends: what goes to the root filament and to the tip's.
  template <class Value>
  void gather(std::span<const double> row, const Value* values, Value& at_root, Value& at_tip) const;
  void gather_last_line(State& s, std::size_t blade, std::size_t far_line) const;
  VortexFilaments filaments(const State& s, double sense) const;
  VortexTail tail(const State& s, double sense) const;
  void add_velocities(const State& s, double sense, std::span<const Eigen::Vector3d> points,
                      std::span<Eigen::Vector3d> velocities) const;
  void add_self_induction(const State& s, double sense, std::span<Eigen::Vector3d> far) const;
  void convect(State& s, double sense, const Air& air, double h) const;
  void shift(State& s, const LiftingLines& blades, double h) const;
  /// Circulation of the newest row by the sections' lift; whether it was found.
  bool solve(State& s, const LiftingLines& blades, const Circulation& circulation, std::span<Eigen::Vector3d> induced) const;

  Options options_;
  std::vector<double> chords_;
  std::size_t blades_, near_rows_, far_rows_;
  double radius_, mean_chord_ = 0.0;
};

}  // namespace spindrift
