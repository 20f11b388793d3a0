// The mooring lines of a scene: who is tied to what, and the loads they put on the bodies.
// Dynamic lines carry their nodes as memory from step to step (bodies::Memory). Built and called by src/coupling; line models:
// model.hpp; tested in tests/src/moorings/moorings_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kernels/mooring/line_lumped_mass.hpp"
#include "kernels/rigid/motion.hpp"
#include "kernels/rigid/wrench.hpp"
#include "src/moorings/model.hpp"

namespace spindrift::moorings {

/// Tensions of one line [N]; negative where a two-way spring pushes.
struct LineTension {
  double fairlead, anchor;
};

class Moorings {
 public:
  /// `bodies` and `start`: names and initial motions of all bodies, in the order of every later call.
  Moorings(std::span<const std::string> bodies, std::span<const Motion> start, LineEnvironment environment = {});

  /// Ties one more line. Throws scene::SceneError where a table cannot be read; body names have been checked (check_lines).
  void add(const std::string& name, const LineOptions& options);

  std::size_t size() const { return lines_.size(); }
  const std::string& name(std::size_t line) const { return lines_[line].name; }

  /// Adds the pull of every line to the wrenches of the bodies it is tied to, in the order of the scene. A dynamic line pulls as
  /// it did at the end of the last step, and goes on as it changed in it; without memory as the catenary, or with clumps as it
  /// rests.
  void add_loads(double t, std::span<const Motion> bodies, std::span<Wrench> wrenches) const;
  /// Of a dynamic line: at the end of the last step.
  LineTension tension(std::size_t line, std::span<const Motion> bodies) const;
  bool is_dynamic(std::size_t line) const { return lines_[line].dynamic.has_value(); }

  // What dynamic lines remember, as bodies::Memory has it.
  std::size_t memory_size() const { return memory_size_; }
  /// Every dynamic line in rest between its ends. Throws NumericalFailure where a line finds none.
  void begin(double t, std::span<const Motion> bodies, std::span<double> memory);
  void recall(std::span<const double> memory) { memory_.assign(memory.begin(), memory.end()); }
  void remember(double t, double h, std::span<const Motion> bodies, std::span<double> memory);
  /// Inertia of the half segments at the bodies.
  void add_added_mass(std::span<const Motion> bodies, std::span<Eigen::Matrix<double, 6, 6>> masses) const;

 private:
  struct End {
    int body;               ///< -1: the earth
    Eigen::Vector3d point;  ///< body axes from the centre of mass, or earth frame [m]
  };
  struct Dynamic {
    LineLumpedMass line;
    LineLumpedMass::Scratch scratch;
    std::size_t first;  ///< of its memory
  };
  /// A dynamic line's part of the memory.
  struct Recalled;
  struct Line {
    std::string name;
    End fairlead, anchor;
    std::unique_ptr<const StaticLine> model;
    std::optional<Dynamic> dynamic;  ///< `model` is then its statics
  };
  End attach(const std::string& body, const Eigen::Vector3d& point) const;
  LineEnd moving(const End& end, std::span<const Motion> bodies) const;
  LineEnds ends(const Line& line, std::span<const Motion> bodies) const;
  static LineForces resting(const Dynamic& dynamic, LineEnds ends);
  LineForces go_on(Line& line, double t, double h, const LineEnds& from, const LineEnds& to, std::span<double> state);
  LineForces forces(const Line& line, double t, std::span<const Motion> bodies) const;

  std::vector<std::string> bodies_;
  std::vector<Motion> start_;
  LineEnvironment environment_;
  std::vector<Line> lines_;
  std::size_t memory_size_ = 0;
  std::vector<double> memory_;  ///< recalled; empty: steady
  std::vector<double> kept_;    ///< state of a line before a step that may be repeated
};

}  // namespace spindrift::moorings
