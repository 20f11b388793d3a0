// SPDX-License-Identifier: Apache-2.0
#include "src/aero/actuator.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "kernels/rotor/actuator_line.hpp"
#include "src/aero/largest_of_cells.hpp"

namespace spindrift::aero {

namespace {

/// Part of the disc's own wind below which its wake is not slowed for the correction.
constexpr double least_disc_wind = 0.25;
/// How far blades may be off the rotor's plane by cone and prebend, over the radius.
constexpr double blade_depth = 0.1;
constexpr int most_iterations = 300, wake_rounds = 3;
constexpr double wind_tolerance = 1e-10;  ///< change of an iteration over the section's speed

/// No element longer than this [m]: the kernels of neighbours must overlap.
Turbine with_elements_below(Turbine turbine, double longest) {
  const Planform old = turbine.planform;
  Planform& p = turbine.planform;
  p = {}, turbine.elements_at_stations = false;
  for (std::size_t i = 0; i + 1 < old.span.size(); ++i) {
    const int pieces = std::max(1, int(std::ceil((old.span[i + 1] - old.span[i]) / longest)));
    for (int n = 0; n < pieces + (i + 2 == old.span.size()); ++n) {
      const double s = double(n) / pieces;
      const auto add = [&](std::vector<double> Planform::*values) {
        if ((old.*values).empty()) return;
        (p.*values).push_back((1.0 - s) * (old.*values)[i] + s * (old.*values)[i + 1]);
      };
      for (auto values : {&Planform::span, &Planform::chord, &Planform::twist, &Planform::thickness, &Planform::prebend,
                          &Planform::sweep, &Planform::polar})
        add(values);
    }
  }
  return turbine;
}

double narrowest(const Turbine& turbine, const ActuatorOptions& o, double cell) {
  return std::max(o.width_cells * cell, o.width_chords * std::ranges::min(turbine.planform.chord));
}

/// Of the force's kernel, by element [m].
std::vector<double> widths(const BladeElementMomentum& sections, const ActuatorOptions& o, double cell) {
  std::vector<double> all;
  for (std::size_t e = 0; e < sections.elements(); ++e)
    all.push_back(std::max(o.width_cells * cell, o.width_chords * sections.section(e).chord));
  return all;
}

}  // namespace

double cell_at_rotor(const GridStore& store, const Eigen::Vector3d& hub, const Eigen::Vector3d& axis, double radius,
                     MPI_Comm comm) {
  const auto largest = [&](auto&& within) {
    return largest_of_cells(store, comm, [&](const TileGeometry& g, int k, int j, int i, const Eigen::Vector3d& centre) {
      const double size = std::cbrt(g.volume_data.data()[g.cell_box.at(k, j, i)]);
      return within(Eigen::Vector3d(centre - hub), size) ? size : 0.0;
    });
  };
  const double at_disc = largest([&](const Eigen::Vector3d& arm, double size) {
    const double along = arm.dot(axis);
    return std::abs(along) <= std::max(blade_depth * radius, 0.5 * size) && (arm - along * axis).norm() <= radius;
  });
  // Cells larger than the rotor may have no centre at it: those round the hub.
  return at_disc > 0.0 ? at_disc : largest([](const Eigen::Vector3d& arm, double size) { return arm.norm() <= size; });
}

double actuator_bytes(const AeroOptions& aero, const RotorOptions& rotor, const MultiBlockGrid& grid) {
  double nearest = std::numeric_limits<double>::infinity(), cell = 0.0;
  for (const Block& b : grid.blocks)
    for (int k = 0; k < b.nk; ++k)
      for (int j = 0; j < b.nj; ++j)
        for (int i = 0; i < b.ni; ++i) {
          const Eigen::Vector3d& x = b.nodes[b.node(k, j, i)];
          const double distance = (x - rotor.hub_m).squaredNorm();
          if (distance >= nearest) continue;
          nearest = distance;
          cell = std::cbrt((b.nodes[b.node(k, j, i + 1)] - x).norm() * (b.nodes[b.node(k, j + 1, i)] - x).norm() *
                           (b.nodes[b.node(k + 1, j, i)] - x).norm());
        }
  // Lines begin in the flow of a disc, which has more points than they.
  return Actuator(read_turbine(rotor.turbine), Actuator::Kind::disc, aero.actuator.value_or(ActuatorOptions()), 1.0, cell)
      .bytes();
}

double Actuator::bytes() const {
  double cells = 0.0;
  for (const Point& p : points_) cells += 4.0 / 3.0 * pi * std::pow(kernel_reach * width_[p.element] / cell_, 3);
  return cells * sizeof(Part::Cell);
}

Actuator::Actuator(const Turbine& turbine, Kind kind, const ActuatorOptions& options, double air_density, double cell,
                   double kinematic_viscosity)
    : kind_(kind),
      corrected_(options.correction == "filtered"),
      blades_(turbine.blades),
      air_density_(air_density),
      cell_(cell),
      sections_(with_elements_below(turbine, narrowest(turbine, options, cell)), "madsen", air_density, {}, kinematic_viscosity),
      width_(widths(sections_, options, cell)),
      wakes_(sections_, width_, turbine.blades) {
  const std::size_t n = sections_.elements();
  azimuths_ =
      kind == Kind::lines ? blades_ : std::max(3, int(std::ceil(2.0 * pi * sections_.tip_radius() / std::ranges::min(width_))));
  points_.resize(std::size_t(azimuths_) * n);
  for (std::size_t p = 0; p < points_.size(); ++p) {
    points_[p].element = p % n, points_[p].blade = int(p / n);
    points_[p].share = double(blades_) / azimuths_;
  }
  if (kind != Kind::disc || !corrected_) return;
  for (const bool turning : {false, true})
    for (std::size_t at = 0; at < n; ++at)
      for (std::size_t of = 0; of < n; ++of) {
        const BladeElementMomentum::BladeSection& s = sections_.section(of);
        const double half = 0.5 * s.length * s.normal_axial;
        (turning ? rings_.swirl : rings_.axial)
            .push_back(ring_mean(sections_.section(at).radius, s.radius - half, s.radius + half,
                                 joint_width(width_[at], width_[of]), turning));
      }
}

void Actuator::place(const DiscMotion& rotor) {
  const bool stands =
      kind_ == Kind::disc && placed_ > 0 && rotor.hub == rotor_.hub && rotor.axis == rotor_.axis && rotor.up == rotor_.up;
  rotor_ = rotor;
  pitches_.assign(rotor.pitches.begin(), rotor.pitches.end());
  rotor_.pitches = pitches_;
  if (stands) return;
  ++placed_;
  const Eigen::Vector3d side = rotor.axis.cross(rotor.up);
  const double first = kind_ == Kind::lines ? rotor.azimuth : 0.0;
  for (Point& p : points_) {
    const double azimuth = first + 2.0 * pi * p.blade / azimuths_;
    const Eigen::Vector3d out = std::cos(azimuth) * rotor.up + std::sin(azimuth) * side;
    const BladeElementMomentum::BladeSection& s = sections_.section(p.element);
    p.arm = s.axial * rotor.axis + s.radius * out;
    p.normal = s.normal_axial * rotor.axis + s.normal_radial * out;
    p.ahead = rotor.axis.cross(out);
  }
}

void Actuator::find_cells(Part& part, const FlowTile& tile) const {
  part.cells.clear(), part.reaches.clear();
  const TileGeometry& g = *tile.geometry;
  const std::ptrdiff_t c = g.cell_box.component;
  const auto centre = [&](int k, int j, int i) {
    const double* x = g.centre_data.data() + g.cell_box.at(k, j, i);
    return Eigen::Vector3d(x[0], x[c], x[2 * c]);
  };
  Eigen::Vector3d low = centre(0, 0, 0), high = low;
  for_rows(tile.box, [&](int k, int j) {
    for (int i = 0; i < tile.box.ni; ++i) {
      const Eigen::Vector3d x = centre(k, j, i);
      low = low.cwiseMin(x), high = high.cwiseMax(x);
    }
  });
  const auto for_reached = [&](std::size_t point, auto&& reached) {
    const Eigen::Vector3d x = rotor_.hub + points_[point].arm;
    const double width = width_[points_[point].element], reach2 = kernel_reach * width * kernel_reach * width;
    if ((x.cwiseMin(high).cwiseMax(low) - x).squaredNorm() > reach2) return;
    for_rows(tile.box, [&](int k, int j) {
      for (int i = 0; i < tile.box.ni; ++i)
        if (const double distance2 = (centre(k, j, i) - x).squaredNorm(); distance2 <= reach2) reached(k, j, i, distance2, width);
    });
  };
  if (part.cells.capacity() == 0) {  // those of a disc are many: as much memory as they take
    std::size_t count = 0;
    for (std::size_t n = 0; n < points_.size(); ++n) for_reached(n, [&](auto&&...) { ++count; });
    part.cells.reserve(count);
  }
  for (std::size_t n = 0; n < points_.size(); ++n) {
    const std::uint32_t first = std::uint32_t(part.cells.size());
    for_reached(n, [&](int k, int j, int i, double distance2, double width) {
      const double kernel = gaussian_kernel(distance2, width);
      part.cells.push_back({std::int32_t(tile.cells.at(k, j, i)), std::int32_t(tile.inner.at(k, j, i)), kernel,
                            kernel * g.volume_data.data()[g.cell_box.at(k, j, i)]});
    });
    if (part.cells.size() > first) part.reaches.push_back({std::uint32_t(n), first, std::uint32_t(part.cells.size())});
  }
  part.placed = placed_;
}

void Actuator::sample(std::size_t n, const FlowTile& tile, std::span<double> sums) {
  Part& part = parts_[n];
  if (part.placed != placed_) find_cells(part, tile);
  std::ranges::fill(sums, 0.0);
  const double* u = tile.state.data() + tile.cells.component;
  for (const Part::Reach& reach : part.reaches) {
    double* sum = sums.data() + 4 * std::size_t(reach.point);
    for (std::uint32_t m = reach.first; m < reach.last; ++m) {
      const Part::Cell& cell = part.cells[m];
      sum[0] += cell.weight;
      for (int d = 0; d < 3; ++d) sum[1 + d] += cell.weight * u[cell.state + d * tile.cells.component];
    }
  }
}

void Actuator::spread(std::size_t n, FlowTile& tile) const {
  const Part& part = parts_[n];
  if (part.reaches.empty() && tile.source.size() == 0) return;
  if (tile.source.size() == 0) tile.source = AlignedArray<double>(tile.inner.size(tile.unknowns()));
  std::fill_n(tile.source.data(), tile.source.size(), 0.0);
  const double* u = tile.state.data() + tile.cells.component;
  for (const Part::Reach& reach : part.reaches) {
    const Point& p = points_[reach.point];
    if (!(p.weight > 0.0)) continue;
    const Eigen::Vector3d on_air = -p.force / p.weight;
    for (std::uint32_t m = reach.first; m < reach.last; ++m) {
      const Part::Cell& cell = part.cells[m];
      double* to = tile.source.data() + cell.inner;
      double power = 0.0;
      for (int d = 0; d < 3; ++d) {
        const double force = cell.kernel * on_air[d];
        to[(1 + d) * tile.inner.component] += force;
        power += force * u[cell.state + d * tile.cells.component];
      }
      to[4 * tile.inner.component] += power;
    }
  }
}

/// Of the winds that it meets.
void Actuator::section_loads(Point& p) const {
  const BladeElementMomentum::BladeSection& s = sections_.section(p.element);
  const double pitch = kind_ == Kind::disc ? rotor_.blade_pitch : rotor_.pitch(p.blade);
  const SectionPolars::InUse polars = sections_.polars(p.element, std::hypot(p.normal_wind, p.tangential_wind));
  double lift = 0.0;
  const ElementState state =
      element_forces(sections_.annulus(p.element, pitch), p.normal_wind, p.tangential_wind, [&](double attack) {
        const SectionForce f = polars(attack);
        lift = f.lift;
        return f;
      });
  const double pressure = 0.5 * air_density_ * state.speed * state.speed * s.chord;
  p.normal_force = pressure * state.normal, p.tangential_force = pressure * state.tangential;
  p.circulation = 0.5 * state.speed * s.chord * lift;
  p.force = p.share * s.length * (p.normal_force * p.normal + p.tangential_force * p.ahead);
}

void Actuator::act(std::span<const double> sums) {
  for (std::size_t n = 0; n < points_.size(); ++n) {
    Point& p = points_[n];
    p.weight = sums[4 * n];
    if (p.weight > 0.0) p.sampled = Eigen::Vector3d(sums[4 * n + 1], sums[4 * n + 2], sums[4 * n + 3]) / p.weight;
    const Eigen::Vector3d met = p.sampled - rotor_.hub_velocity - rotor_.omega.cross(p.arm);
    p.normal_wind = met.dot(p.normal), p.tangential_wind = -met.dot(p.ahead);
    section_loads(p);
  }
  if (!corrected_) return;
  kind_ == Kind::lines ? act_lines() : act_disc();
}

/// The loads and the wake that they leave, in balance: the winds gain what the width has taken from the wake's velocity. The
/// helices have the pitch of the wind that the loaded part of the blades meets, found in a few rounds from that of the samples.
void Actuator::act_lines() {
  std::vector<double> normal, tangential, circulation;
  for (const Point& p : points_)
    normal.push_back(p.normal_wind), tangential.push_back(p.tangential_wind), circulation.push_back(p.circulation);
  for (int round = 0; round < wake_rounds; ++round) balance_lines(wake_angle(), normal, tangential, circulation);
}

/// Of the helix at the tip, by the winds that the blades meet, weighted with their thrust [rad].
double Actuator::wake_angle() const {
  double wind = 0.0, thrust = 0.0;
  for (const Point& p : points_) {
    const double share = std::abs(p.force.dot(rotor_.axis));
    wind += share * p.normal_wind, thrust += share;
  }
  const double around = rotor_.omega.dot(rotor_.axis) * sections_.tip_radius();
  return std::clamp(std::atan2(thrust > 0.0 ? wind / thrust : 0.0, around), LineWakes::least_angle,
                    pi - LineWakes::least_angle - LineWakes::step);
}

/// Winds as sampled; `circulation` is where the iteration begins, and ends.
void Actuator::balance_lines(double angle, std::span<const double> normal, std::span<const double> tangential,
                             std::span<double> circulation) {
  const std::size_t n = sections_.elements();
  const LineWakes::Matrix m = wakes_.at(angle);
  std::vector<double> relax(n);
  for (std::size_t e = 0; e < n; ++e)  // a section of slope 2 pi has a circulation of pi times its chord per wind
    relax[e] = 1.0 / (1.0 + pi * sections_.section(e).chord * std::abs(m.normal[e * n + e]));
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    double change = 0.0;
    for (int b = 0; b < blades_; ++b)
      for (std::size_t at = 0; at < n; ++at) {
        const std::size_t here = std::size_t(b) * n + at;
        double more_normal = 0.0, more_tangential = 0.0;
        for (int later = 0; later < blades_; ++later) {
          const double* from = circulation.data() + std::size_t((b + later) % blades_) * n;
          const std::size_t row = (std::size_t(later) * n + at) * n;
          for (std::size_t of = 0; of < n; ++of) {
            more_normal += m.normal[row + of] * from[of];
            more_tangential += m.tangential[row + of] * from[of];
          }
        }
        points_[here].normal_wind = normal[here] + more_normal;
        points_[here].tangential_wind = tangential[here] + more_tangential;
      }
    for (std::size_t p = 0; p < points_.size(); ++p) {
      Point& point = points_[p];
      section_loads(point);
      const double step = relax[point.element] * (point.circulation - circulation[p]),
                   chord = sections_.section(point.element).chord;
      circulation[p] += step;
      change = std::max(change, std::abs(step) / (chord * std::hypot(point.normal_wind, point.tangential_wind)));
    }
    if (change < wind_tolerance) return;
  }
}

/// Azimuth by azimuth: the disc's own induced velocities v = f / (2 rho u) by momentum, u the wind through it. Of them the width
/// has taken the difference to their Gaussian mean, and blades meet v over Prandtl's factor.
void Actuator::act_disc() {
  const std::size_t n = sections_.elements();
  std::vector<double> axial(n), swirl(n), mean_axial(n), mean_swirl(n);
  for (int azimuth = 0; azimuth < azimuths_; ++azimuth) {
    const std::span<Point> row(points_.data() + std::size_t(azimuth) * n, n);
    std::vector<double> normal(n), tangential(n);
    for (std::size_t e = 0; e < n; ++e) normal[e] = row[e].normal_wind, tangential[e] = row[e].tangential_wind;
    std::ranges::fill(axial, 0.0), std::ranges::fill(swirl, 0.0);
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
      double change = 0.0;
      for (std::size_t at = 0; at < n; ++at) {
        mean_axial[at] = mean_swirl[at] = 0.0;
        for (std::size_t of = 0; of < n; ++of) {
          mean_axial[at] += rings_.axial[at * n + of] * axial[of];
          mean_swirl[at] += rings_.swirl[at * n + of] * swirl[of];
        }
      }
      for (std::size_t e = 0; e < n; ++e) {
        Point& p = row[e];
        const Annulus ring = sections_.annulus(e, rotor_.blade_pitch);
        const double sine = std::sin(std::atan2(p.normal_wind, p.tangential_wind)), loss = loss_factor(ring, sine);
        p.normal_wind = normal[e] + mean_axial[e] - axial[e] / loss;
        p.tangential_wind = tangential[e] - mean_swirl[e] + swirl[e] / loss;
        section_loads(p);
        const double undisturbed = normal[e] + mean_axial[e],
                     through = std::max(undisturbed - axial[e], least_disc_wind * std::abs(undisturbed)),
                     by_area = blades_ / (2.0 * pi * ring.radius), speed = std::hypot(p.normal_wind, p.tangential_wind);
        if (!(through > 0.0)) continue;
        const double unit = by_area / (2.0 * air_density_ * through);
        const double relax = 1.0 / (1.0 + 0.5 * by_area * pi * ring.chord * speed / (through * loss));
        const double step_axial = relax * (unit * p.normal_force - axial[e]),
                     step_swirl = relax * (unit * p.tangential_force - swirl[e]);
        axial[e] += step_axial, swirl[e] += step_swirl;
        change = std::max(change, (std::abs(step_axial) + std::abs(step_swirl)) / std::max(speed, 1e-300));
      }
      if (change < wind_tolerance) break;
    }
  }
}

std::vector<double> Actuator::loads() const {
  std::vector<double> all(6 * std::size_t(kind_ == Kind::lines ? blades_ : 1), 0.0);
  for (const Point& p : points_) {
    double* sum = all.data() + 6 * (kind_ == Kind::lines ? p.blade : 0);
    const Eigen::Vector3d moment = p.arm.cross(p.force);
    for (int d = 0; d < 3; ++d) sum[d] += p.force[d], sum[3 + d] += moment[d];
  }
  return all;
}

RotorLoad Actuator::load_of(std::span<const double> loads) const {
  RotorLoad load;
  for (std::size_t b = 0; 6 * b < loads.size(); ++b)
    for (int d = 0; d < 3; ++d)
      load.force[d] += loads[6 * b + std::size_t(d)], load.moment[d] += loads[6 * b + 3 + std::size_t(d)];
  load.thrust = load.force.dot(rotor_.axis), load.torque = load.moment.dot(rotor_.axis);
  load.power = load.torque * rotor_.omega.dot(rotor_.axis);
  return load;
}

RotorLoad Actuator::load(const PseudoRow& row) const { return load_of(row.bodies); }

RotorLoad Actuator::blade_load(int blade, const PseudoRow& row) const {
  return load_of(std::span(row.bodies).subspan(6 * std::size_t(blade - 1), 6));
}

std::vector<SpanLoad> Actuator::span_loads() const {
  const std::size_t n = sections_.elements(), told = kind_ == Kind::lines ? std::size_t(blades_) : 1;
  std::vector<SpanLoad> all(told * n);
  for (const Point& p : points_) {
    const BladeElementMomentum::BladeSection& s = sections_.section(p.element);
    SpanLoad& to = all[(kind_ == Kind::lines ? std::size_t(p.blade) : 0) * n + p.element];
    to.blade = kind_ == Kind::lines ? p.blade + 1 : 1;
    to.radius = s.radius, to.length = s.length * s.normal_axial, to.chord = s.chord;
    const double share = 1.0 / (p.share * to.length * (kind_ == Kind::lines ? 1.0 : double(azimuths_)));
    to.load.normal += share * p.force.dot(rotor_.axis), to.load.tangential += share * p.force.dot(p.ahead);
  }
  return all;
}

double Actuator::least_weight() const { return std::ranges::min(points_, {}, &Point::weight).weight; }

std::string Actuator::description() const {
  return fmt::format("{} at {} points, {:.3g} cells of {:.4g} m to the radius",
                     kind_ == Kind::lines ? "actuator_line" : "actuator_disc", points_.size(), tip_radius() / cell_, cell_);
}

std::shared_ptr<Actuator> make_actuator(const AeroOptions& aero, const Turbine& turbine, double air_density,
                                        const GridStore& store, const DiscMotion& rotor, MPI_Comm comm) {
  const double cell = cell_at_rotor(store, rotor.hub, rotor.axis, turbine.planform.span.back(), comm);
  const auto kind = aero.model == "actuator_line" ? Actuator::Kind::lines : Actuator::Kind::disc;
  auto actuator = std::make_shared<Actuator>(turbine, kind, aero.actuator.value_or(ActuatorOptions()), air_density, cell,
                                             aero.kinematic_viscosity(air_density));
  actuator->place(rotor);
  return actuator;
}

}  // namespace spindrift::aero
