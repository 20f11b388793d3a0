// The mooring lines of a scene: who is tied to what, and the loads they put on the bodies.
// Built and called by src/coupling; line models are in kernels/mooring; tested in tests/src/moorings/moorings_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "kernels/mooring/line_catenary.hpp"
#include "kernels/mooring/line_spring_damper.hpp"
#include "kernels/mooring/line_table.hpp"
#include "kernels/rigid/motion.hpp"
#include "kernels/rigid/wrench.hpp"
#include "src/moorings/options.hpp"

namespace spindrift::moorings {

/// Tensions of one line [N]; negative where a two-way spring pushes.
struct LineTension {
  double fairlead, anchor;
};

class Moorings {
 public:
  /// `bodies` and `start`: names and initial motions of all bodies, in the order of every later call.
  Moorings(std::span<const std::string> bodies, std::span<const Motion> start);
  Moorings(Moorings&&) = default;  // tables are held by address: movable, not copyable
  Moorings& operator=(Moorings&&) = default;

  /// Ties one more line. Throws scene::SceneError where a table cannot be read; body names have been checked (check_lines).
  void add(const std::string& name, const LineOptions& options);

  std::size_t size() const { return lines_.size(); }
  const std::string& name(std::size_t line) const { return lines_[line].name; }

  /// Adds the pull of every line to the wrenches of the bodies it is tied to, in the order of the scene. Quasi-static: t has no
  /// effect.
  void add_loads(double t, std::span<const Motion> bodies, std::span<Wrench> wrenches) const;
  /// Whether a line can be slack and then pull at once: a tension-only spring.
  bool can_snap() const;
  /// Bit by bit of the lines that can snap, whether each pulls now; beyond the 63rd they share the last bit.
  std::uint64_t taut(std::span<const Motion> bodies) const;
  LineTension tension(std::size_t line, std::span<const Motion> bodies) const;

 private:
  struct End {
    int body;               ///< -1: the earth
    Eigen::Vector3d point;  ///< body axes from the centre of mass, or earth frame [m]
  };
  struct Line {
    std::string name;
    End fairlead, anchor;
    std::variant<LineSpringDamper, LineCatenary, LineTable> model;
  };
  struct Table {
    std::vector<double> distance, tension, slope;
  };
  End attach(const std::string& body, const Eigen::Vector3d& point) const;
  LineForces forces(const Line& line, std::span<const Motion> bodies) const;

  std::vector<std::string> bodies_;
  std::vector<Motion> start_;
  std::vector<Line> lines_;
  std::vector<Table> tables_;  ///< a LineTable looks into these; their heap does not move with the vector
};

}  // namespace spindrift::moorings
