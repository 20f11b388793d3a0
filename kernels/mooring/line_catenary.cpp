// SPDX-License-Identifier: Apache-2.0
#include "kernels/mooring/line_catenary.hpp"

#include <Eigen/LU>
#include <cmath>

#include "kernels/base/root.hpp"

namespace spindrift {

CatenaryState LineCatenary::solve(double x, double z) const {
  if (!bed_contact || z >= length * (1.0 + elastic())) return suspended(x, z);
  // Lift-off: V = w L in the grounded equations gives H in closed form (theory page, eq. 13); never for d <= 0.
  const double weight = weight_per_m * length, d = weight_per_m * (z - length * elastic());
  if (d > 0.0) {
    const double h = 0.5 * (weight / d - d / weight) * weight;
    if (x >= h / weight_per_m * std::asinh(weight / h) + h * length / axial_stiffness) return suspended(x, z);
  }
  const double hanging = 2.0 * z / (1.0 + std::sqrt(1.0 + 2.0 * weight_per_m * z / axial_stiffness));
  if (x <= length - hanging)
    return {.vertical = weight_per_m * hanging, .on_bed = length - hanging, .regime = CatenaryRegime::slack};
  return grounded(x, z);
}

LineForces pulls_in_space(const Eigen::Vector3d& span, const PlanePull& up, const PlanePull& down) {
  const double x = std::hypot(span.x(), span.y());
  const Eigen::Vector3d out =
      x > 0.0 ? Eigen::Vector3d(span.x() / x, span.y() / x, 0.0) : Eigen::Vector3d::Zero();  // anchor to fairlead
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  const double upper = std::hypot(up.horizontal, up.vertical), lower = std::hypot(down.horizontal, down.vertical);
  if (span.z() >= 0.0) return {-up.horizontal * out - up.vertical * z, down.horizontal * out + down.vertical * z, upper, lower};
  return {-down.horizontal * out + down.vertical * z, up.horizontal * out - up.vertical * z, lower, upper};
}

Eigen::Matrix3d plane_in_space(const Eigen::Vector3d& span, const Eigen::Matrix2d& plane, double pull) {
  const double x = std::hypot(span.x(), span.y()), lateral = x > 0.0 ? pull / x : plane(0, 0);
  Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();  // columns: away from the anchor, sideways, up
  if (x > 0.0) frame.topLeftCorner<2, 2>() << span.x() / x, -span.y() / x, span.y() / x, span.x() / x;
  Eigen::Matrix3d local = Eigen::Matrix3d::Zero();
  local << plane(0, 0), 0.0, plane(0, 1), 0.0, lateral, 0.0, plane(1, 0), 0.0, plane(1, 1);
  return frame * local * frame.transpose();
}

LineForces LineCatenary::forces(const Eigen::Vector3d& span, const Eigen::Vector3d& /*rate: the line is quasi-static*/) const {
  const CatenaryState s = solve(std::hypot(span.x(), span.y()), std::abs(span.z()));
  return pulls_in_space(span, {s.horizontal, s.vertical}, {s.lower_horizontal, s.lower_vertical});
}

Eigen::Matrix2d LineCatenary::plane_stiffness(const CatenaryState& s) const {
  const double w = weight_per_m, ea = axial_stiffness, h = s.horizontal, v = s.vertical;
  if (s.regime == CatenaryRegime::slack) return Eigen::Vector2d(0.0, w / (1.0 + v / ea)).asDiagonal();
  if (std::isinf(s.sag)) return Eigen::Vector2d(0.0, 0.5 * w / (1.0 + elastic())).asDiagonal();
  const double upper = std::hypot(h, v), stretch = length / ea;
  Eigen::Matrix2d compliance;
  if (s.regime == CatenaryRegime::suspended) {
    const double lower = std::hypot(h, s.lower_vertical), turn = (v / upper - s.lower_vertical / lower) / w;
    const double cross = h / w * (1.0 / upper - 1.0 / lower);
    compliance << 2.0 * s.sag / w + stretch - turn, cross, cross, turn + stretch;
  } else {
    const auto [gripped, free] = bed_parts(h, s.on_bed);
    compliance << (std::asinh(v / h) - v / upper) / w + stretch - free / ea, (h / upper - 1.0) / w + bed_friction * gripped / ea,
        (h / upper - 1.0) / w, v / w * (1.0 / upper + 1.0 / ea);
  }
  if (compliance(1, 1) == 0.0) return Eigen::Vector2d(1.0 / compliance(0, 0), 0.0).asDiagonal();  // flat on the bed: V ~ sqrt(z)
  return compliance.inverse();
}

Eigen::Matrix3d LineCatenary::stiffness(const Eigen::Vector3d& span) const {
  const double x = std::hypot(span.x(), span.y());
  const CatenaryState s = solve(x, std::abs(span.z()));
  Eigen::Matrix2d plane = plane_stiffness(s);
  if (span.z() < 0.0) {  // the fairlead is the lower end: mirrored in z; on the bed only its pull H - C_B w on_bed is left
    if (s.regime != CatenaryRegime::suspended) {
      plane.row(0) =
          s.lower_horizontal > 0.0 ? Eigen::RowVector2d(plane.row(0) + bed_friction * plane.row(1)) : Eigen::RowVector2d::Zero();
      plane.row(1).setZero();
    }
    plane(0, 1) = -plane(0, 1), plane(1, 0) = -plane(1, 0);
  }
  return plane_in_space(span, plane, span.z() < 0.0 ? s.lower_horizontal : s.horizontal);
}

LineCatenary::BedParts LineCatenary::bed_parts(double h, double on_bed) const {
  const double reach = bed_friction > 0.0 ? h / (bed_friction * weight_per_m) : on_bed;
  return reach < on_bed ? BedParts{reach, on_bed - reach} : BedParts{on_bed, 0.0};
}

CatenaryState LineCatenary::suspended(double x, double z) const {
  const double eps = elastic(), a = z / length, b = x / length, half_weight = 0.5 * weight_per_m * length;
  CatenaryState s;
  if (b <= 1e-12) {  // vertical: taut, or both parts hanging straight down
    s.sag = a > 1.0 + eps ? std::atanh(eps / (a - 1.0)) : std::numeric_limits<double>::infinity();
  } else {
    const Root root = increasing_root(
        [=](double eta) {
          const double sinh = std::sinh(eta), coth = std::sqrt(1.0 + 1.0 / (sinh * sinh));
          const double p = a / (1.0 + eps * coth), q = b * sinh / (eta + eps), sum = p * p + q * q;
          const double dp = p * eps / (sinh * sinh * (1.0 + eps * coth)), dq = q * (coth - 1.0 / (eta + eps));
          return ValueAndSlope{std::log(sum), 2.0 * (p * dp + q * dq) / sum};
        },
        first_sag(a, b, eps));
    s.sag = root.x, s.evaluations = root.evaluations, s.converged = root.converged;
  }
  const double coth = 1.0 / std::tanh(s.sag);  // mean of the end tensions over half the weight
  s.horizontal = half_weight * b / (s.sag + eps);
  const double mid = half_weight * a * coth / (1.0 + eps * coth);
  s.vertical = mid + half_weight;
  s.lower_horizontal = s.horizontal;
  s.lower_vertical = mid - half_weight;
  return s;
}

double LineCatenary::first_sag(double a, double b, double eps) {
  const double chord = std::hypot(a, b), between = std::cbrt(6.0 * eps * chord * chord / (b * b));
  if (chord >= 1.0) return std::min(eps / (chord - 1.0), between);
  const double ratio = std::sqrt(1.0 - a * a) / b;  // sinh(eta) / eta
  const double loose = ratio < 3.0 ? std::sqrt(6.0 * (ratio - 1.0)) : std::log(2.0 * ratio * std::log(2.0 * ratio));
  return std::max(loose, std::min(between, 1.0));
}

CatenaryState LineCatenary::grounded(double x, double z) const {
  const double w = weight_per_m, ea = axial_stiffness;
  const auto vertical = [=](double h) {
    const double load = h * (1.0 + 0.5 * h / ea) + w * z;
    const double tension = 2.0 * load / (1.0 + std::sqrt(1.0 + 2.0 * load / ea));
    const double rise = w * z / (1.0 + 0.5 * (tension + h) / ea);  // tension - h without cancellation
    return std::pair{std::sqrt(rise * (tension + h)), tension};
  };
  const Root root = increasing_root(
      [&](double h) {
        const auto [v, tension] = vertical(h);
        const double on_bed = std::max(length - v / w, 0.0), dv = v > 0.0 ? (tension - h) / (v * (1.0 + tension / ea)) : 0.0;
        const auto [gripped, free] = bed_parts(h, on_bed);
        const double friction = bed_friction * w * gripped * (0.5 * gripped - on_bed) / ea;
        const double reach = length - v / w + h / w * std::asinh(v / h) + h * length / ea + friction;
        const double slope = (std::asinh(v / h) - v / tension + (h / tension - 1.0) * dv) / w + (length - free) / ea +
                             bed_friction * gripped * dv / ea;
        return ValueAndSlope{reach - x, slope};
      },
      first_pull(x, z));
  const auto [v, tension] = vertical(root.x);
  const double on_bed = length - v / w;
  return {.horizontal = root.x,
          .vertical = v,
          .lower_horizontal = std::max(root.x - bed_friction * w * on_bed, 0.0),
          .on_bed = on_bed,
          .regime = CatenaryRegime::grounded,
          .evaluations = root.evaluations,
          .converged = root.converged};
}

double LineCatenary::first_pull(double x, double z) const {
  const double taut = std::hypot(x, z) / length - 1.0;
  if (taut >= 0.0) return axial_stiffness * std::max(taut, elastic() * elastic());
  const double ratio2 = (length * length - z * z) / (x * x) - 1.0;
  return 0.5 * weight_per_m * x / std::sqrt(3.0 * std::max(ratio2, 1e-6));
}
}  // namespace spindrift
