// Water loads on floating bodies by engineering models: `hydrostatic` (exact buoyancy in still water, linear damping) and
// `morison` (waves and current; Froude-Krylov, added mass and drag by strips), `potential` (a boundary-element code's
// coefficients, with drag by strips). Equations and what is left out: docs/theory/sea_engineering.md. Built by the coupling from
// checked options; called in every evaluation of the right-hand side, without allocation. Tested in tests/src/sea.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kernels/rigid/motion.hpp"
#include "kernels/rigid/shapes.hpp"
#include "kernels/rigid/wrench.hpp"
#include "src/sea/options.hpp"
#include "src/sea/potential.hpp"
#include "src/sea/strips.hpp"
#include "src/sea/wave_field.hpp"

namespace spindrift::sea {

/// Uniform, and a profile over z, linear between its rows [m/s].
struct SteadyCurrent {
  Eigen::Vector3d uniform = Eigen::Vector3d::Zero();
  std::vector<std::array<double, 3>> profile;  ///< z, along x, along y; from below
  Eigen::Vector3d at(double z) const;
};

struct NamedCylinder {
  std::string name;
  Cylinder shape;  ///< body axes from the centre of mass
};

/// A body with its shapes; in the order of the motions. A body without cylinders costs nothing.
struct SeaBody {
  std::string name;
  Motion initial;  ///< as the scene states it: turns initial earth coordinates into body axes
  std::vector<NamedCylinder> cylinders;
};

/// Loads on one body by physical part, each about its centre of mass, earth axes.
struct SeaLoads {
  Wrench buoyancy;   ///< rho g V, up to the local surface; beside [sea.potential] up to still water
  Wrench inertia;    ///< Froude-Krylov and wave part of the added mass
  Wrench drag;       ///< transverse and of the ends
  Wrench damping;    ///< [[sea.damping]], [[sea.matrices]]
  Wrench potential;  ///< waves, radiation and linear hydrostatics of [sea.potential]
};

class EngineeringSea {
 public:
  /// Options in which the checks below find nothing.
  /// `step_s`: of the bodies; potential flow samples its memory at it.
  EngineeringSea(const SeaOptions& options, const WavesOptions& waves, const SeaEnvironment& environment,
                 const std::vector<SeaBody>& bodies, double step_s = 0.0);

  /// Adds the sea's load to one wrench per body, each about its body's centre of mass.
  void add_loads(double t, std::span<const Motion> bodies, std::span<Wrench> wrenches) const;
  /// Adds the water's inertia, [force; moment] over [acceleration; angular acceleration] of the centre of mass, earth axes.
  void add_added_mass(double t, std::span<const Motion> bodies, std::span<Matrix6> masses) const;
  /// Both at once, which shares the wetted geometry.
  void add(double t, std::span<const Motion> bodies, std::span<Wrench> wrenches, std::span<Matrix6> masses) const;
  /// The same loads by part, for output; overwritten, not added.
  void loads_by_part(double t, std::span<const Motion> bodies, std::span<SeaLoads> loads) const;

  double elevation(double x, double y, double t) const { return waves_.still() ? 0.0 : waves_.elevation(t, x, y); }
  /// Motion of the water at an earth point under the surface, current included.
  waves::Kinematics water(double t, const Eigen::Vector3d& point) const;
  const WaveField& waves() const { return waves_; }
  bool has_added_mass() const { return strips_load_; }

  /// The body in potential flow; null without one.
  const PotentialBody* potential() const;

  // What the water remembers, as bodies::Memory has it.
  std::size_t memory_size() const;
  void begin(double t, std::span<const Motion> bodies, std::span<double> memory) const;
  void recall(std::span<const double> memory);
  void remember(double t, std::span<const Motion> bodies, std::span<double> memory) const;

 private:
  struct Damping {
    Eigen::Vector3d arm, force, moment;  ///< body axes
  };
  struct Matrices {
    Motion initial;
    Eigen::Vector3d point;  ///< body axes
    Matrix6 stiffness, damping, quadratic_damping;
  };
  /// Ends on the bed, which no water is under: sums over them of A n, and of R^4 n pi / 4, for the pressure's moment.
  struct Foot {
    Eigen::Vector3d arm, area, second_moment;  ///< body axes
  };
  struct BodyStrips {
    std::vector<Strip> strips;
    std::vector<Foot> feet;
    std::vector<Damping> damping;
    std::vector<Matrices> matrices;
    std::optional<PotentialBody> potential;
    bool loaded() const { return !strips.empty() || !damping.empty() || !matrices.empty() || potential; }
  };
  /// Waves scattered at the radius of each strip that diffracts; equal radii share them.
  void scatter(std::vector<Strip>& strips);
  BodyStrips strips_of(const SeaBody& body, const SeaOptions& options) const;
  /// Takes the water's pressure from the feet: of still water, with `waves` also theirs.
  void unload_feet(double t, const BodyStrips& own, const Motion& motion, bool waves, SeaLoads& loads) const;
  SeaLoads body_loads(double t, const BodyStrips& body, const Motion& motion, Matrix6* mass) const;

  SeaEnvironment environment_;
  SteadyCurrent current_;
  bool strips_load_;  ///< strips have drag and inertia, not buoyancy alone
  WaveField waves_;
  std::vector<double> scattering_radii_;
  std::vector<std::vector<waves::ComponentGroup>> scattered_;  ///< by those radii
  std::vector<BodyStrips> bodies_;
};

// Rules between the sections of a scene's sea that it breaks: one sentence each with its key; empty when nothing is.
// wave_problems (wave_field.hpp) is the third of these.
/// Names that do not exist, options without effect.
std::vector<OptionProblem> sea_problems(const SeaOptions& options, const WavesOptions& waves, const std::vector<SeaBody>& bodies);
/// Cylinders without length, or below the sea bed at the start. Only for a sea that is not `none`.
std::vector<OptionProblem> shape_problems(const SeaEnvironment& environment, const std::vector<SeaBody>& bodies);

}  // namespace spindrift::sea
