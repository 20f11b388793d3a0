// What a run writes down at the end of each window: columns of history.csv for the bodies, their loads by source, the joints, the
// rotor, the moorings and the waves that a scene has. Names and signs: docs/user/outputs.md and conventions.md.
// Used by src/run; tested in tests/src/coupling/recorder_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "src/bodies/system.hpp"
#include "src/coupling/columns.hpp"
#include "src/coupling/floating_system.hpp"
#include "src/io/history.hpp"

namespace spindrift::coupling {

/// `point`: the reference point in body axes from the centre of mass; accelerations as System::evaluate gives them.
ReferenceMotion reference_motion(const Motion& now, const Motion& initial, const Eigen::Vector3d& point,
                                 const Eigen::Vector3d& acceleration, const Eigen::Vector3d& omega_rate);
/// Of a body by its number, from where the scene describes it; accelerations are left at zero.
ReferenceMotion reference_motion(const FloatingSystem& floating, std::size_t body, const Motion& now);

class Recorder {
 public:
  /// Declares the columns in `history`. The floating system outlives the recorder.
  Recorder(FloatingSystem& floating, io::History& history);

  /// Fills the row of time t [s].
  void fill(std::span<double> row, const bodies::BodiesState& state, double t);

 private:
  template <class Source>
  using Group = io::ColumnGroup<Source>;
  struct Load {
    std::size_t source, body;
    Group<Wrench> columns;
  };
  struct Rotor {
    Group<RotorRow> load;
    Group<aero::RotorState> hub;
    Group<Eigen::Vector3d> wind;
    std::optional<Group<aero::RotorLoads::Drive>> drive, shaft;
    std::vector<Group<double>> pitches;
    std::vector<Group<aero::BladeRootLoad>> roots;
    std::vector<Group<Eigen::Vector2d>> tips;
  };
  void declare_rotor(io::History& history, const RotorSource& rotor);
  void fill_rotor(std::span<double> row, const Rotor& columns, const RotorSource& source, const bodies::BodiesState& state,
                  const bodies::Evaluation& now, double t) const;
  void declare_gauges(io::History& history);
  /// Of the water's surface at x and y.
  template <class Surface>
  void fill_gauges(std::span<double> row, std::span<const Motion> motions, const Surface& surface) const;
  void declare_particles(io::History& history);
  void fill_particles(std::span<double> row, std::span<const Motion> motions, double t) const;

  FloatingSystem& floating_;
  std::vector<Group<ReferenceMotion>> bodies_;
  std::vector<Load> loads_;
  std::vector<Group<Wrench>> joints_;
  std::vector<Group<bodies::BeamReading>> beams_;
  std::optional<Group<double>> constraints_;
  std::optional<Group<EnergyRow>> energy_;
  std::vector<Group<double>> works_;  ///< by source of load
  std::vector<Rotor> rotors_;
  std::optional<Group<YawDrive::Reading>> yaw_;
  std::vector<Group<moorings::LineTension>> moorings_;
  std::vector<std::optional<Group<moorings::LineTension>>> anchors_;  ///< of dynamic lines
  std::vector<Group<LineEnd>> junctions_;
  std::optional<Group<double>> waves_;
  std::optional<Group<WaterRow>> water_;
  std::optional<Group<sph::Wavemaker::Stroke>> paddle_;
  std::vector<Group<double>> gauges_;
  std::vector<std::optional<Group<double>>> run_ups_;  ///< of gauges that go with bodies
  std::vector<Group<sph::PatchReading>> sensors_;
  std::vector<Group<sea::ParticleSea::Reading>> probes_;
};

}  // namespace spindrift::coupling
