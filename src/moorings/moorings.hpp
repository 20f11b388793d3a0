// The mooring lines of a scene: who is tied to what, and the loads they put on the bodies.
// Dynamic lines, and the junctions at which they meet, carry their nodes as memory from step to step (bodies::Memory). Built and
// called by src/coupling; line models: model.hpp; tested in tests/src/moorings/moorings_test.cpp. SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kernels/mooring/line_network.hpp"
#include "kernels/rigid/motion.hpp"
#include "kernels/rigid/wrench.hpp"
#include "src/moorings/model.hpp"

namespace spindrift::moorings {

/// Tensions of one line [N]; negative where a spring pushes (tension_only = false).
struct LineTension {
  double fairlead, anchor;
};

class Moorings {
 public:
  /// `bodies` and `start`: names and initial motions of all bodies, in the order of every later call.
  Moorings(std::span<const std::string> bodies, std::span<const Motion> start, LineEnvironment environment = {});

  /// A point at which lines end; before the lines.
  void add_junction(const std::string& name, const JunctionOptions& options);
  /// Ties one more line. Throws scene::SceneError where a table cannot be read; names of bodies and junctions have been checked
  /// (check_lines), ends are placed (place_at_junctions).
  void add(const std::string& name, const LineOptions& options);

  std::size_t size() const { return lines_.size(); }
  const std::string& name(std::size_t line) const { return lines_[line].name; }
  std::size_t junctions() const { return junctions_.size(); }
  const std::string& junction_name(std::size_t junction) const { return junctions_[junction].name; }

  /// Adds the pull of every line to the wrenches of the bodies it is tied to, in the order of the scene. A dynamic line pulls as
  /// it did at the end of the last step, and goes on as it changed in it; without memory as the catenary, or with clumps or
  /// junctions as it rests.
  void add_loads(double t, std::span<const Motion> bodies, std::span<Wrench> wrenches) const;
  /// Of all lines; of dynamic ones at the end of the last step.
  std::vector<LineTension> tensions(std::span<const Motion> bodies) const;
  bool is_dynamic(std::size_t line) const { return lines_[line].dynamic.has_value(); }
  /// Where it snaps taut; nothing for lines that do not, and for dynamic ones, which make steps of their own.
  std::optional<TautLine> taut(std::size_t line) const;
  /// A line between two bodies or a body and the earth.
  struct Chord {
    Eigen::Vector3d anchor, fairlead;              ///< earth frame [m]
    std::optional<std::size_t> anchor_body, body;  ///< nothing: the earth
  };
  Chord chord(std::size_t line, std::span<const Motion> bodies) const;
  /// Places and velocities of all junctions at the end of the last step; without memory where they rest.
  std::vector<LineEnd> junction_motions(std::span<const Motion> bodies) const;

  // What dynamic lines remember, as bodies::Memory has it.
  std::size_t memory_size() const { return memory_size_; }
  /// Every dynamic line in rest between its ends. Throws NumericalFailure where a line finds none.
  void begin(double t, std::span<const Motion> bodies, std::span<double> memory);
  void recall(std::span<const double> memory) { memory_.assign(memory.begin(), memory.end()); }
  void remember(double t, double h, std::span<const Motion> bodies, std::span<double> memory);
  /// Inertia of the half segments at the bodies.
  void add_added_mass(std::span<const Motion> bodies, std::span<Eigen::Matrix<double, 6, 6>> masses) const;

 private:
  static constexpr int none = -1;
  struct End {
    int body = none, junction = none;  ///< neither: the earth
    Eigen::Vector3d point;             ///< body axes from the centre of mass, or earth frame [m]; unused at a junction
  };
  struct Dynamic {
    LineLumpedMass line;
    std::size_t network = 0, member = 0;  ///< of it
    std::size_t header = 0;               ///< in the memory
  };
  struct Line {
    std::string name;
    End fairlead, anchor;
    std::unique_ptr<const StaticLine> model;
    std::optional<Dynamic> dynamic;  ///< `model` is then its statics
  };
  struct Junction {
    std::string name;
    LineJunction point;
    std::size_t network = 0, member = 0;
  };
  /// Dynamic lines that move together: one, or those that junctions tie to each other.
  struct Network {
    LineNetwork of;
    LineNetwork::Scratch scratch;
    std::vector<std::size_t> lines;  ///< of all, in the order of `of`
    std::string junction;            ///< name of the first; empty: one line alone
    std::size_t state = 0;           ///< first of its state in the memory
    bool hangs_free() const;         ///< no catenary is its statics
  };
  /// A dynamic line's end of the last step, in the memory.
  struct Recalled;

  End attach(const std::string& body, const std::optional<Eigen::Vector3d>& point) const;
  LineEnd moving(const End& end, std::span<const Motion> bodies) const;
  LineEnds ends(const Line& line, std::span<const Motion> bodies) const;
  std::vector<LineEnds> ends(const Network& network, std::span<const Motion> bodies) const;
  void connect();
  /// Forces on all lines that hang free, as they rest; empty where there are none.
  std::vector<LineForces> resting(std::span<const Motion> bodies) const;
  /// State of a network as it rests; velocities of the bodies move its junctions with them.
  std::vector<double> rest(const Network& network, double t, std::span<const Motion> bodies) const;
  void go_on(Network& network, double t, double h, std::span<const LineEnds> from, std::span<const LineEnds> to,
             std::span<double> state);
  LineForces forces(std::size_t line, double t, std::span<const Motion> bodies, std::span<const LineForces> resting) const;

  std::vector<std::string> bodies_;
  std::vector<Motion> start_;
  LineEnvironment environment_;
  std::vector<Line> lines_;
  std::vector<Junction> junctions_;
  std::vector<Network> networks_;
  std::size_t memory_size_ = 0;
  std::vector<double> memory_;  ///< recalled; empty: steady
  std::vector<double> kept_;    ///< state of a network before a step that may be repeated
};

}  // namespace spindrift::moorings
