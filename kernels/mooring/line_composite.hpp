// Static line of several sections in a row, each an elastic catenary of its own weight and stiffness, with weights and floats at
// the joints between them: the multi-segment lines of MAP++ and MoorPy. Peyrot & Goulois (1979), Computers & Structures 10,
// 805-813, for the pieces; the sums over them, the bed under the whole line and the two monotone equations that are solved are in
// docs/theory/moorings.md. Called through src/moorings; tested in tests/kernels/mooring/line_composite_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "kernels/mooring/line.hpp"
#include "kernels/mooring/line_catenary.hpp"

namespace spindrift {

struct CatenarySection {
  double length = 0.0;           ///< unstretched [m]
  double weight_per_m = 0.0;     ///< in water, per unstretched length [N/m], positive
  double axial_stiffness = 0.0;  ///< EA [N]
};

/// In the vertical plane of the line, for its upper end at (x, z) from the lower one, x >= 0, z >= 0.
struct CompositeState {
  double horizontal = 0.0;        ///< H [N], pull of the line on its upper end towards the lower one
  double vertical = 0.0;          ///< V [N], downward pull on the upper end; negative where floats lift it
  double lower_horizontal = 0.0;  ///< [N], pull on the lower end towards the upper one; less than H by the friction of the bed
  double lower_vertical = 0.0;    ///< [N], upward pull on the lower end
  double on_bed = 0.0;            ///< unstretched length that rests on the bed, in all its pieces [m]
  CatenaryRegime regime = CatenaryRegime::suspended;
  Eigen::Matrix2d compliance = Eigen::Matrix2d::Zero();      ///< d(x, z)/d(H, V)
  Eigen::Matrix2d lower_by_upper = Eigen::Matrix2d::Zero();  ///< d(lower_horizontal, lower_vertical)/d(H, V)
  int evaluations = 0;
  bool converged = true;
};

/// The sections from the lower end up.
class CatenaryChain {
 public:
  /// `hung`: net weight in water at the upper end of each section but the last [N], negative where it lifts.
  CatenaryChain(std::vector<CatenarySection> from_below, const std::vector<double>& hung, double bed_friction, bool bed_contact);

  CompositeState solve(double x, double z) const;
  /// Heights of the upper ends of all sections over the lower end of the line [m].
  std::vector<double> heights(const CompositeState& state) const;

 private:
  /// A section with the weight of all above its two ends, which the vertical pull at the upper end of the line carries first [N].
  struct Part {
    CatenarySection of;
    double above_lower, above_upper;
  };
  /// Sums over the line for given H and V.
  struct Sums;
  /// A piece off the bed round floats, with both feet on it or an end of the line; `carried` is V as it would be at the top.
  struct Arch {
    std::size_t lowest, highest;  ///< joints of its floats; joint j is between sections j - 1 and j
    double carried, by_horizontal;
    bool to_the_top = false;  ///< its upper foot is the upper end of the line
  };
  /// Where a piece off the bed ends below: unstretched length of `part` below it, which lies; part < 0: the end of the line.
  struct Foot {
    int part;
    double lying;
  };

  /// Calls piece(part, length, vertical pull at its lower and upper end) for what hangs between the joints, and below and above
  /// them up to the bed.
  template <class Piece>
  Foot hang(std::size_t lowest, std::size_t highest, double carried, const Piece& piece) const;
  void sum(double h, std::size_t lowest, std::size_t highest, double carried, Sums& sums) const;
  Arch raise(double h, std::size_t lowest, std::size_t highest) const;
  std::vector<Arch> arches(double h) const;
  Sums sums(double h, double v, const std::vector<Arch>& arches) const;
  void rub(double h, double carried, const Foot& foot, double by_horizontal, bool top, Sums& sums) const;
  /// V for which the upper end is at height z; the sums there.
  Sums at_height(double h, double z, double guess) const;
  double first_pull(double x, double z) const;
  double weight() const { return parts_.front().above_lower; }

  std::vector<Part> parts_;
  std::vector<std::size_t> floats_;  ///< joints at which something lifts
  double length_ = 0.0, compliance_ = 0.0, least_above_ = 0.0;
  double friction_;
  bool bed_;
};

struct LineComposite {
  static constexpr std::string_view name = "composite_catenary";

  /// Sections from the anchor to the fairlead; `hung` as of CatenaryChain.
  LineComposite(const std::vector<CatenarySection>& from_anchor, const std::vector<double>& hung, double bed_friction,
                bool bed_contact);

  /// As of LineCatenary: the bed is level with whichever end is lower.
  LineForces forces(const Eigen::Vector3d& span, const Eigen::Vector3d& /*rate: the line is quasi-static*/) const;
  Eigen::Matrix3d stiffness(const Eigen::Vector3d& span) const;
  /// Heights of the joints over the anchor, from the anchor up [m].
  std::vector<double> joint_heights(const Eigen::Vector3d& span) const;

  CatenaryChain upright, upside_down;  ///< the fairlead is the upper end; the lower
};
static_assert(MooringLine<LineComposite>);

}  // namespace spindrift
