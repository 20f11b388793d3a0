// SPDX-License-Identifier: Apache-2.0
#include "src/aero/rotor_grid/sections.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/base/constants.hpp"

namespace spindrift::aero {

namespace {

/// Owns what a PlaneCurve looks at. Runs along the pressure side first.
struct OwnedCurve {
  explicit OwnedCurve(std::span<const Eigen::Vector2d> outline) : store(6, std::vector<double>(outline.size())) {
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Eigen::Vector2d& p = outline[outline.size() - 1 - i];
      store[1][i] = p.x(), store[2][i] = p.y();
    }
    curve = {store[0], store[1], store[2], store[3], store[4], store[5]};
    make_curve(curve);
  }
  std::vector<std::vector<double>> store;
  PlaneCurve curve;
};

/// Where a blend is this near to the root circle (as a share of the way from its neighbour), its nodes begin to slide.
constexpr double slide_begins = 0.55;

/// With a trailing edge of this thickness at least: what is missing grows with the cube of the way from the nose. Along the upper
/// side first, over the chord.
void open_edge(std::span<Eigen::Vector2d> outline, double least) {
  const Eigen::Vector2d gap = outline.front() - outline.back();
  const double thickness = gap.norm();
  if (thickness >= least) return;
  const Eigen::Vector2d up = thickness > 1e-9 ? Eigen::Vector2d(gap / thickness) : Eigen::Vector2d(Eigen::Vector2d::UnitY());
  const auto nose = std::ranges::min_element(outline, {}, [](const Eigen::Vector2d& p) { return p.x(); });
  for (auto p = outline.begin(); p != outline.end(); ++p)
    *p += (p < nose ? 0.5 : -0.5) * (least - thickness) * std::pow(p->x(), 3) * up;
}

/// Share of the cells beside a trailing edge that those on it have at least: sharp edges have no cells, and thin ones cells that
/// are too small for their neighbours. With finer cells the edge comes to be that of the outline.
constexpr double least_edge_cell = 0.1;

}  // namespace

bool is_round(std::span<const Eigen::Vector2d> outline) {
  const std::size_t n = outline.size();
  return (outline[n - 1] - outline[0]).norm() < 1e-9 && (outline[1] - outline[0]).dot(outline[n - 1] - outline[n - 2]) > 0.0;
}

std::vector<Eigen::Vector2d> resample_outline(const Aerofoil& aerofoil, const SectionSpacing& spacing, double slide) {
  std::vector<Eigen::Vector2d> outline = aerofoil.outline;
  if (!is_round(outline)) open_edge(outline, least_edge_cell * spacing.edge * spacing.trailing_edge);
  const OwnedCurve owned(outline);
  std::vector<Eigen::Vector2d> nodes(std::size_t(spacing.round));
  resample(owned.curve, spacing, slide, nodes);
  return nodes;
}

Sections::Sections(std::span<const Aerofoil> aerofoils, const SectionSpacing& spacing)
    : spacing_(spacing), root_(aerofoils.back()) {
  round_root_ = is_round(root_.outline);
  const std::size_t n = aerofoils.size(), round = std::size_t(spacing.round);
  for (const Aerofoil& a : aerofoils) {
    thickness_.push_back(a.thickness);
    nodes_.push_back(resample_outline(a, spacing));
  }
  slopes_.assign(n, std::vector<Eigen::Vector2d>(round, Eigen::Vector2d::Zero()));
  if (n < 2) return;
  std::vector<double> value(n), slope(n);
  for (std::size_t i = 0; i < round; ++i)
    for (int c = 0; c < 2; ++c) {
      for (std::size_t a = 0; a < n; ++a) value[a] = nodes_[a][i][c];
      monotone_slopes(thickness_, value, slope);
      for (std::size_t a = 0; a < n; ++a) slopes_[a][i][c] = slope[a];
    }
}

void Sections::blend(double thickness, double slide, std::span<Eigen::Vector2d> nodes) const {
  const std::size_t n = thickness_.size();
  if (n == 1 || thickness <= thickness_.front()) {
    std::copy(nodes_.front().begin(), nodes_.front().end(), nodes.begin());
    return;
  }
  const double at = std::min(thickness, thickness_.back());
  const std::size_t a = interval(thickness_, at);
  const double h = thickness_[a + 1] - thickness_[a], s = (at - thickness_[a]) / h, r = 1.0 - s;
  // Hermite weights of the two values and the two slopes.
  const double w1 = s * s * (3.0 - 2.0 * s), w0 = 1.0 - w1, d0 = h * s * r * r, d1 = -h * s * s * r;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    nodes[i] = w0 * nodes_[a][i] + w1 * nodes_[a + 1][i] + d0 * slopes_[a][i] + d1 * slopes_[a + 1][i];
  if (!round_root_ || a + 2 != n || slide == 0.0 || s <= slide_begins) return;
  const double u = (s - slide_begins) / (1.0 - slide_begins), turned = slide * u * u * (3.0 - 2.0 * u);
  const std::vector<Eigen::Vector2d> slid = resample_outline(root_, spacing_, turned / (2.0 * pi));
  for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i] += w1 * (slid[i] - nodes_[a + 1][i]);
}

}  // namespace spindrift::aero
