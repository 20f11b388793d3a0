// Static elastic catenary between anchor and fairlead, with or without contact on a flat bed: the quasi-static line of MAP++ and
// FAST. Equations after Irvine (1981), ch. 1-2, and Jonkman (2007), NREL/TP-500-41958, eqs. 2-34 to 2-37, brought to one monotone
// equation in one unknown for each regime, so that the solution exists, is unique and is always found: derivation in
// docs/theory/moorings.md. Called through src/moorings; tested in tests/kernels/mooring/line_catenary_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/LU>
#include <cmath>

#include "kernels/base/root.hpp"
#include "kernels/mooring/line.hpp"

namespace spindrift {

enum class CatenaryRegime { suspended, grounded, slack };  ///< slack: hangs vertically, the rest lies unloaded on the bed

/// Solution in the vertical plane of the line, for the upper end at (x, z) from the lower one, x >= 0, z >= 0.
struct CatenaryState {
  double horizontal = 0.0;        ///< H [N], pull of the line on its upper end towards the lower one
  double vertical = 0.0;          ///< V [N], downward pull on the upper end
  double lower_horizontal = 0.0;  ///< [N], pull on the lower end towards the upper one; less than H by the friction of the bed
  double lower_vertical = 0.0;    ///< [N], upward pull on the lower end, negative when the line sags below it
  double on_bed = 0.0;            ///< unstretched length that rests on the bed [m]
  double sag = 0.0;  ///< eta of the suspended line (theory page, eq. 7) [-]; infinite when both halves hang vertically
  CatenaryRegime regime = CatenaryRegime::suspended;
  int evaluations = 0;  ///< of the scalar equation; 0 where the solution is closed
  bool converged = true;
};

/// Pull on an end of a line in its vertical plane [N]: towards the other end; of the upper end downwards, of the lower upwards.
struct PlanePull {
  double horizontal, vertical;
};
/// Forces on both ends of a line between them; whichever is higher is the upper one.
LineForces pulls_in_space(const Eigen::Vector3d& span, const PlanePull& upper, const PlanePull& lower);
/// The stiffness of the fairlead from that in the plane and the horizontal pull there.
Eigen::Matrix3d plane_in_space(const Eigen::Vector3d& span, const Eigen::Matrix2d& plane, double pull);

struct LineCatenary {
  static constexpr std::string_view name = "catenary";
  double length = 0.0;           ///< L, unstretched [m]
  double weight_per_m = 0.0;     ///< w, in water, per unstretched length [N/m], positive
  double axial_stiffness = 0.0;  ///< EA [N]
  double bed_friction = 0.0;     ///< C_B [-]
  bool bed_contact = true;       ///< the bed is flat and level with the lower end

  double elastic() const { return 0.5 * weight_per_m * length / axial_stiffness; }  ///< epsilon = w L / (2 EA) [-]

  CatenaryState solve(double x, double z) const;

  /// The bed, where there is one, is level with whichever end is lower, so that forces stay continuous when the fairlead passes
  /// the anchor.
  LineForces forces(const Eigen::Vector3d& span, const Eigen::Vector3d& /*rate: the line is quasi-static*/) const;

  /// d(H, V)/d(x, z) of the upper end: inverse of the compliance (theory page, eqs. 14-15).
  Eigen::Matrix2d plane_stiffness(const CatenaryState& s) const;

  Eigen::Matrix3d stiffness(const Eigen::Vector3d& span) const;

 private:
  /// Length in which friction works, and behind it the one without tension [m].
  struct BedParts {
    double gripped, free;
  };
  BedParts bed_parts(double h, double on_bed) const;

  /// Line free of the bed, a = z/L, b = x/L. Unknown eta: the squares of a / (1 + eps coth eta) and b sinh(eta) / (eta + eps)
  /// add to one (theory page, eq. 7).
  CatenaryState suspended(double x, double z) const;

  /// The inextensible sag where the line is slack, the straight elastic one where it is taut, their balance between.
  static double first_sag(double a, double b, double eps);

  /// Part of the line on the bed. Unknown H; the vertical equation is a quadratic for the fairlead tension.
  CatenaryState grounded(double x, double z) const;

  /// Jonkman (2007), eq. 2-38: the shallow catenary of the same span; stretched straight where that does not exist.
  double first_pull(double x, double z) const;
};
static_assert(MooringLine<LineCatenary>);

}  // namespace spindrift
