// SPDX-License-Identifier: Apache-2.0
#include "kernels/mooring/line_lumped_mass.hpp"

namespace spindrift {

void LineLumpedMass::lay_as_catenary(const LineEnds& ends, std::span<double> state) const {
  const Eigen::Vector3d span = ends.fairlead.position - ends.anchor.position;
  const bool rises = span.z() >= 0.0;
  const Eigen::Vector3d& low = rises ? ends.anchor.position : ends.fairlead.position;
  const double x = std::hypot(span.x(), span.y());
  Eigen::Vector3d out = Eigen::Vector3d::Zero();
  if (x > 0.0) out = Eigen::Vector3d(span.x() / x, span.y() / x, 0.0) * (rises ? 1.0 : -1.0);
  const CatenaryState s = catenary().solve(x, std::abs(span.z()));
  const double w = weight_per_m(), h = std::max(s.horizontal, 1e-6 * w * length), lower = s.lower_vertical;
  const auto place = [&](double from_low) {
    const double hanging = std::max(from_low - s.on_bed, 0.0), up = lower + w * hanging;
    const double along =
        std::min(from_low, s.on_bed) + h / w * (std::asinh(up / h) - std::asinh(lower / h)) + h * from_low / axial_stiffness;
    const double rise = (std::hypot(h, up) - std::hypot(h, lower)) / w + (lower + 0.5 * w * hanging) * hanging / axial_stiffness;
    return Eigen::Vector3d(along, 0.0, rise);
  };
  const double reach = place(length).x();  // differs from x where the line is slack
  for (int i = 1; i < segments; ++i) {
    const Eigen::Vector3d p = place(segment() * (rises ? i : segments - i));
    Eigen::Map<Eigen::Vector3d> node(state.data() + 3 * std::size_t(i - 1));
    node = low + (reach > 0.0 ? p.x() / reach * x : 0.0) * out + p.z() * Eigen::Vector3d::UnitZ();
    if (bed.shape && bed.contact) node.z() = std::max(node.z(), bed.shape->level(node.x(), node.y()));
  }
  std::fill(state.begin() + std::ptrdiff_t(3 * inner()), state.end(), 0.0);
}

}  // namespace spindrift
