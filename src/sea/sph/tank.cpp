// SPDX-License-Identifier: Apache-2.0
#include "src/sea/sph/tank.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>

#include "kernels/base/random.hpp"
#include "runtime/mpi/stop_request.hpp"
#include "src/sea/sph/boundary.hpp"
#include "src/sea/sph/lattice.hpp"
#include "src/sea/sph/mesh_fill.hpp"
#include "src/sea/sph/packing.hpp"
#include "src/sea/sph/solids.hpp"
#include "src/sea/sph/tank_lattice.hpp"

namespace spindrift::sph {

double TankPlan::bed_at(double at) const {
  if (bed.empty()) return -depth;
  if (at <= bed.front()[0]) return bed.front()[1];
  for (std::size_t n = 1; n < bed.size(); ++n)
    if (at < bed[n][0]) {
      const double s = (at - bed[n - 1][0]) / (bed[n][0] - bed[n - 1][0]);
      return bed[n - 1][1] + s * (bed[n][1] - bed[n - 1][1]);
    }
  return bed.back()[1];
}

namespace {

/// What the places of the lattice inside a tank are by the surfaces of walls.
template <int dim>
class PlacesBySurfaces {
 public:
  enum class Of : std::uint8_t { water, wall, core };

  /// Walls are `deep` [m], behind them is core.
  PlacesBySurfaces(const TankPlan& plan, const TankLattice<dim>& lattice, double deep) : count_(lattice.count) {
    if (plan.walls.empty()) return;
    const std::array<int, 3> count{count_[0], dim == 2 ? 1 : count_[1], count_[dim - 1]};
    of_.assign(std::size_t(count[0]) * std::size_t(count[1]) * std::size_t(count[2]), Of::water);
    const Eigen::Vector3d origin = to_earth<dim>(lattice.at(std::array<int, dim>{})), edges = to_earth<dim>(lattice.edge);
    for (const TankPlan::Walls& walls : plan.walls) {
      auto of = of_.begin();
      for_distances(*walls.surface, origin, edges, count, -deep, deep, [&](const std::array<int, 3>&, double distance) {
        const double depth = walls.water_inside ? distance : -distance;
        if (depth > 0.0) *of = std::max(*of, depth > deep ? Of::core : Of::wall);
        ++of;
      });
    }
  }
  Of operator()(const std::array<int, dim>& index) const {
    if (of_.empty()) return Of::water;
    std::size_t n = 0;
    for (int k = 0; k < dim; ++k) {
      if (index[k] < 0) return Of::water;
      n = n * std::size_t(count_[k]) + std::size_t(std::min(index[k], count_[k] - 1));
    }
    return of_[n];
  }

 private:
  std::array<int, dim> count_;
  std::vector<Of> of_;  ///< z fastest; empty where no surface makes walls
};

/// A wave as water starts in it: what is the same at all places is found once, since a sea has hundreds of them.
class StartingWave {
 public:
  StartingWave(const waves::Component& c, double depth)
      : c_(c), along_(std::cos(c.direction), std::sin(c.direction), 0.0), depth_(depth), sinh_(std::sinh(c.wave_number * depth)) {
    of_surface_ = profiles(0.0);
  }

  /// C = cosh(k (z + h)) / sinh(k h) and S = sinh(k (z + h)) / sinh(k h), in deep water before these overflow; above still water
  /// by the straight line that continues them, as zones lead to waves (damping.hpp): by the formula short harmonics of a sea
  /// state would be several times too fast in its crests.
  std::array<double, 2> profiles(double z) const {
    constexpr double deep = 300.0;
    const double k = c_.wave_number, under = std::min(z, 0.0), over = k * std::max(z, 0.0), kz = k * (under + depth_);
    const bool is_deep = k * depth_ > deep;
    const double even = is_deep ? std::exp(k * under) : std::cosh(kz) / sinh_, odd = is_deep ? even : std::sinh(kz) / sinh_;
    return {even + over * odd, odd + over * even};
  }

  /// Profiles at a place, cosine and sine of the phase there, and the way that the wave goes.
  struct At {
    std::array<double, 2> of_z;
    double cosine, sine;
    const Eigen::Vector3d& along;
    /// (U/omega) (-C sin psi, S cos psi) for `amplitude` U/omega [m].
    Eigen::Vector3d displacement(double amplitude) const {
      return amplitude * (-of_z[0] * sine * along + of_z[1] * cosine * Eigen::Vector3d::UnitZ());
    }
    /// U (C cos psi, S sin psi) [m/s].
    Eigen::Vector3d velocity(double amplitude) const {
      return amplitude * (of_z[0] * cosine * along + of_z[1] * sine * Eigen::Vector3d::UnitZ());
    }
  };
  At at(const Eigen::Vector3d& x) const {
    const double psi = c_.wave_number * along_.dot(x) + c_.phase;
    return {profiles(x[2]), std::cos(psi), std::sin(psi), along_};
  }

  double speed() const { return c_.speed_amplitude; }                                ///< U [m/s]
  double displacement() const { return c_.speed_amplitude / c_.angular_frequency; }  ///< U/omega [m]
  /// rho (omega/k) U C cos psi [Pa]; of a particle that has risen less rho g (U/omega) S cos psi, both less their value at the
  /// surface.
  double pressure_at_place(const At& at, double density) const {
    return density * (phase_speed() * speed()) * at.of_z[0] * at.cosine;
  }
  double pressure_of_particle(const At& at, double density, double gravity) const {
    const double dynamic = phase_speed() * (at.of_z[0] - of_surface_[0]),
                 risen = gravity / c_.angular_frequency * (at.of_z[1] - of_surface_[1]);
    return density * speed() * (dynamic - risen) * at.cosine;
  }

 private:
  double phase_speed() const { return c_.angular_frequency / c_.wave_number; }
  waves::Component c_;
  Eigen::Vector3d along_;
  double depth_, sinh_;
  std::array<double, 2> of_surface_;
};

std::vector<StartingWave> starting_waves(const TankPlan& plan) {
  std::vector<StartingWave> all;
  for (const waves::Component& c : plan.waves) all.emplace_back(c, plan.depth);
  return all;
}

/// Where a particle of water at rest is in the motion of the waves at their t = 0, its velocity and its pressure. With
/// xi = sum of (U/omega) (-C sin psi, S cos psi), the displacement of linear theory, it goes to x + xi(x + xi(x) / 2): the
/// midpoint rule along a field without divergence, which keeps volume to second order and with it the mean level, for any number
/// of waves. Velocities are those of the place where it then is, so that a fixed point has no mean current. At rest above it is
/// the pressure rho [(omega/k) U C - g (U/omega) S] cos psi less its value at the surface. That is zero for a free wave; for the
/// bound harmonic of a Stokes wave it is what the first harmonic's pressure of second order takes away, at all depths.
template <int dim>
void set_in_motion(Seed<dim>& seed, std::span<const StartingWave> waves, const EosTait& eos, double gravity) {
  const Eigen::Vector3d x = to_earth<dim>(seed.position);
  Eigen::Vector3d way = Eigen::Vector3d::Zero();
  double pressure = eos.pressure(seed.deviation);
  for (const StartingWave& wave : waves) {
    const StartingWave::At at = wave.at(x);
    way += at.displacement(wave.displacement());
    pressure += wave.pressure_of_particle(at, eos.rho0, gravity);
  }
  const Eigen::Vector3d middle = x + 0.5 * way;
  way.setZero();
  for (const StartingWave& wave : waves) way += wave.at(middle).displacement(wave.displacement());
  const Eigen::Vector3d now = x + way;
  Eigen::Vector3d v = Eigen::Vector3d::Zero();
  for (const StartingWave& wave : waves) v += wave.at(now).velocity(wave.speed());
  seed.position = from_earth<dim>(now), seed.velocity = from_earth<dim>(v), seed.deviation = eos.deviation(pressure);
}

/// Of a wall that stands in the waves under still water, over that of rest there: what linear theory has at the place [Pa].
double wave_pressure(Eigen::Vector3d x, std::span<const StartingWave> waves, double depth, double density) {
  x[2] = std::max(x[2], -depth);
  double pressure = 0.0;
  for (const StartingWave& wave : waves) pressure += wave.pressure_at_place(wave.at(x), density);
  return pressure;
}

/// Lays out a tank. What needs neighbours (water that bodies displace or move aside) is found once and kept; all else is made
/// anew at each visit.
template <int dim>
class Layout {
 public:
  using Visit = typename SeedStream<dim>::Visit;
  using Of = typename PlacesBySurfaces<dim>::Of;

  Layout(const TankPlan& plan, const Parameters& p)
      : plan_(plan),
        p_(p),
        cut_(cut_of(dim == 2, plan.mirrored)),
        lattice_(plan, p.spacing),
        layers_(wall_layers(p)),
        waves_(starting_waves(plan)),
        by_surfaces_(plan, lattice_, layers_ * p.spacing),
        walls_(rows_of_walls()) {
    const double ratio = mean_density_ratio(plan, p);
    p_.mass_factor = lattice_.cell() / std::pow(p.spacing, dim) * ratio;
    row_mass_ = p.eos.rho0 * lattice_.edge[dim - 1] * ratio;
    cell_volume_ = lattice_.cell() / std::pow(p.spacing, dim);
    fill_bodies();
    make_pieces();
    find_displaced_water();
  }

  double mass_factor() const { return p_.mass_factor; }
  /// Finds where the water beside bodies stands, and counts. To be called once.
  TankParticles<dim> settle() {
    TankParticles<dim> result;
    result.cell_volume = cell_volume_;
    std::uint16_t owner = wall_owner + 1;
    if (plan_.paddle) result.paddle = owner++;
    for (const Points& points : points_) result.bodies.push_back(owner++), result.body_points.push_back(points);
    // Of the water beside bodies: those that move and all that they stand between, air too, so that the surface stays.
    std::vector<std::array<double, dim>> points, fixed = std::move(air_);
    double lowest = 1e300, highest = plan_.top;
    std::vector<Moved> aside;
    const Visit look = [&](std::size_t id, const Seed<dim>& seed) {
      if (count_ % 65536 == 0) runtime::StopRequest::give_up_if_asked();
      const bool water = seed.owner == water_owner;
      ++count_, result.water += water, result.walls += seed.owner == wall_owner;
      if (seed.owner > wall_owner) highest = std::max(highest, seed.position[dim - 1]);
      if (!plan_.bodies.empty()) {
        const double distance = distance_to_bodies(to_earth<dim>(seed.position));
        if (water && distance < 0.5 * near_bodies * p_.spacing) {
          aside.push_back({id, seed.position, seed.deviation}), points.push_back(seed.position);
          return;
        }
        if (distance < near_bodies * p_.spacing) fixed.push_back(seed.position);
      }
      lowest = std::min(lowest, seed.position[dim - 1]);
    };
    Place at;
    for (Piece& piece : pieces_) {
      piece.begin = at, piece.seeds.first = at.id;
      visit(piece, at, look);
      piece.seeds.last = at.id;
    }
    ImageSides sides;
    if (plan_.mirrored) sides.plane = plan_.y[0];
    if (plan_.periodic[0]) sides.period[0] = plan_.x;
    if (plan_.periodic[1]) sides.period[1] = plan_.y;
    pack_evenly<dim>(points, fixed, spacing_of_cells(), sides);
    for (std::size_t n = 0; n < aside.size(); ++n) {
      Moved& moved = aside[n];
      const double risen = points[n][dim - 1] - moved.position[dim - 1];
      moved.position = points[n];
      lowest = std::min(lowest, moved.position[dim - 1]);
      if (p_.gravity > 0.0)
        moved.deviation = p_.eos.deviation(std::max(0.0, p_.eos.pressure(moved.deviation) - p_.eos.rho0 * p_.gravity * risen));
    }
    moved_ = std::move(aside);
    result.domain = domain(lowest - plan_.jitter * p_.spacing, highest);
    return result;
  }

  /// Of a settled layout, which it keeps.
  static SeedStream<dim> stream(std::shared_ptr<const Layout> layout) {
    std::vector<SeedPart<dim>> parts;
    for (const Piece& piece : layout->pieces_) parts.push_back(piece.seeds);
    return {std::move(parts), [layout](std::size_t part, const Visit& visit) {
              runtime::StopRequest::give_up_if_asked();
              const Piece& piece = layout->pieces_[part];
              Place at = piece.begin;
              if (layout->plan_.jitter == 0.0) return layout->visit(piece, at, visit);
              layout->visit(piece, at, [&](std::size_t id, const Seed<dim>& seed) {
                visit(id, seed.owner == water_owner ? layout->jittered(id, seed) : seed);
              });
            }};
  }

 private:
  /// Where a visit stands: identity, and place of the lattice among those of water.
  struct Place {
    std::size_t id = 0, of_lattice = 0;
  };
  /// What is visited in one go, one after the other in the order of identities. Of water and walls some columns of the lattice:
  /// a range along the last horizontal axis, of one place along x in 3-D.
  struct Piece {
    enum class Of : std::uint8_t { water, walls, paddle, body } of = Of::water;
    std::size_t number = 0;  ///< of the block of water, of the body
    std::array<int, dim> low{}, high{};
    std::uint16_t owner = water_owner;
    SeedPart<dim> seeds = {};
    Place begin = {};
  };

  void visit(const Piece& piece, Place& at, const Visit& visit) const {
    const auto next = [&](const Seed<dim>& seed) { visit(at.id++, seed); };
    switch (piece.of) {
      case Piece::Of::water: {
        auto taken = std::lower_bound(taken_.begin(), taken_.end(), at.of_lattice);
        auto moved =
            std::lower_bound(moved_.begin(), moved_.end(), at.id, [](const Moved& m, std::size_t id) { return m.id < id; });
        visit_water(piece, [&](const Seed<dim>& seed, double) {
          const std::size_t place = at.of_lattice++;
          if (taken != taken_.end() && *taken == place) return void(++taken);
          Seed<dim> placed = seed;
          if (moved != moved_.end() && moved->id == at.id)
            placed.position = moved->position, placed.deviation = moved->deviation, ++moved;
          next(placed);
        });
        return;
      }
      case Piece::Of::walls:
        return visit_walls(piece, next);
      case Piece::Of::paddle:
        return visit_paddle(piece.owner, next);
      case Piece::Of::body:
        return visit_body(piece.number, piece.owner, next);
    }
  }

  void make_pieces() {
    Piece water{.of = Piece::Of::water, .high = lattice_.count};
    for (int k = 0; k < dim - 1; ++k) {  // what waves bring in from beyond the ends, where as much goes out
      const int more = plan_.waves.empty() || plan_.periodic[k] ? 0 : int(std::ceil(farthest_off_lattice() / lattice_.edge[k]));
      const bool moves_or_mirrors = k == 0 ? plan_.paddle.has_value() : plan_.mirrored;
      water.low[k] -= moves_or_mirrors ? 0 : more, water.high[k] += more;
    }
    for (; water.number < std::max<std::size_t>(1, plan_.water.size()); ++water.number) add_pieces(water, farthest_off_lattice());
    add_pieces({.of = Piece::Of::walls, .low = walls_.low, .high = walls_.high, .owner = wall_owner}, 0.0);
    std::uint16_t owner = wall_owner + 1;
    if (plan_.paddle) pieces_.push_back({.of = Piece::Of::paddle, .owner = owner++});
    for (std::size_t b = 0; b < plan_.bodies.size(); ++b)
      pieces_.push_back({.of = Piece::Of::body, .number = b, .owner = owner++});
    for (Piece& piece : pieces_) {
      piece.seeds.largest_owner = piece.owner;
      piece.seeds.has_ghosts = plan_.modified_walls && piece.owner != water_owner;
    }
  }
  /// `off` [m]: that its seeds may be off their columns.
  void add_pieces(const Piece& all, double off) {
    constexpr int axis = dim - 2, columns = 32, most = 16;  // at most so many pieces along the axis
    const int edge = std::max(columns, (all.high[axis] - all.low[axis] + most - 1) / most);
    std::array<int, dim> low = all.low, high = all.high;
    const auto add = [&] {
      for (int from = all.low[axis]; from < all.high[axis]; from += edge) {
        low[axis] = from, high[axis] = std::min(from + edge, all.high[axis]);
        Piece& piece = pieces_.emplace_back(all);
        piece.low = low, piece.high = high;
        for (int k = 0; k < dim - 1; ++k)
          piece.seeds.low[k] = lattice_.at(k, low[k]) - off - 0.5 * lattice_.edge[k],
          piece.seeds.high[k] = lattice_.at(k, high[k] - 1) + off + 0.5 * lattice_.edge[k];
      }
    };
    if constexpr (dim == 2) {
      add();
    } else {
      for (int i = all.low[0]; i < all.high[0]; ++i) low[0] = i, high[0] = i + 1, add();
    }
  }
  /// How far water may be from its place of the lattice: moved by waves, aside by bodies, and by jitter [m].
  double farthest_off_lattice() const {
    double far = (1.0 + plan_.jitter) * p_.spacing;
    const auto sum = [&](double z) {
      double all = 0.0;
      for (const StartingWave& wave : waves_) all += std::abs(wave.displacement()) * wave.profiles(z)[0];
      return all;
    };
    if (!plan_.waves.empty()) far += sum(sum(0.0));  // at the highest that a particle may be
    return far;
  }

  /// By its identity: the same on any rank.
  Seed<dim> jittered(std::size_t id, Seed<dim> seed) const {
    Random random(Random(plan_.jitter_seed).bits() ^ id);
    for (double& x : seed.position) x += plan_.jitter * p_.spacing * (2.0 * random.uniform() - 1.0);
    return seed;
  }

  static constexpr double near_bodies = 6.0;  ///< spacings: half of it is packed anew, between the other half

  bool walled(std::size_t axis) const { return !plan_.periodic[axis] && !plan_.open[axis]; }
  double deviation_at(double z, double surface) const {
    return p_.gravity > 0.0 ? p_.eos.hydrostatic_deviation(std::max(0.0, surface - z), p_.gravity) : 0.0;
  }
  double bed_of_column(int i) const { return plan_.bed_at(lattice_.at(0, i)); }
  bool is_obstacle(const std::array<double, dim>& x) const {
    return std::any_of(plan_.obstacles.begin(), plan_.obstacles.end(),
                       [&](const auto& block) { return inside<dim>(block, to_earth<dim>(x)); });
  }
  /// So deep in an obstacle that it is beyond the reach of water outside.
  bool is_core(const std::array<double, dim>& x) const {
    const Eigen::Vector3d at = to_earth<dim>(x);
    return std::any_of(plan_.obstacles.begin(), plan_.obstacles.end(), [&](const TankPlan::Block& block) {
      double depth = 1e300;
      for (int k = 0; k < 3; ++k)
        if (dim == 3 || k != 1) depth = std::min({depth, at[k] - block.low[k], block.high[k] - at[k]});
      return depth > layers_ * p_.spacing;
    });
  }
  /// From the nearest body's surface, also over sides that repeat, negative inside [m]; huge where none is near.
  double distance_to_bodies(const Eigen::Vector3d& x) const {
    const int along = plan_.periodic[0] ? 1 : 0, across = dim == 3 && plan_.periodic[1] ? 1 : 0;
    const Eigen::Vector3d period(plan_.x[1] - plan_.x[0], plan_.y[1] - plan_.y[0], 0.0);
    double nearest = 1e300;
    for (int i = -along; i <= along; ++i)
      for (int j = -across; j <= across; ++j)
        nearest = std::min(nearest, distance_beside(x + period.cwiseProduct(Eigen::Vector3d(i, j, 0.0))));
    return nearest;
  }
  double distance_beside(const Eigen::Vector3d& x) const {
    double nearest = 1e300;
    for (std::size_t b = 0; b < plan_.bodies.size(); ++b) {
      const TankPlan::Body& body = plan_.bodies[b];
      const Eigen::Vector3d local = body.motion.attitude.conjugate() * (x - body.motion.position);
      if (local.cwiseAbs().maxCoeff() < extent_[b]) nearest = std::min(nearest, signed_distance(body.shapes, local, cut_));
    }
    return nearest;
  }
  /// Share of the cell round x that bodies take.
  double share_of_bodies(const std::array<double, dim>& x, double distance) const {
    const double far = 0.5 * p_.spacing * std::sqrt(double(dim)) * 1.1;
    if (std::abs(distance) > far) return distance < 0.0 ? 1.0 : 0.0;
    constexpr int samples = 6;  // along each edge
    std::array<int, dim> low{}, high;
    high.fill(samples);
    int inside = 0, all = 0;
    for_lattice<dim>(low, high, [&](const std::array<int, dim>& index) {
      std::array<double, dim> at = x;
      for (int k = 0; k < dim; ++k) at[k] += lattice_.edge[k] * ((index[k] + 0.5) / samples - 0.5);
      inside += distance_to_bodies(to_earth<dim>(at)) < 0.0, ++all;
    });
    return double(inside) / all;
  }

  double spacing_of_cells() const { return p_.spacing * std::pow(cell_volume_, 1.0 / dim); }
  void fill_bodies() {
    for (const TankPlan::Body& body : plan_.bodies) {
      points_.push_back(fill_body(body.shapes, spacing_of_cells(), cut_));
      double far = 0.0;
      for (const Eigen::Vector3d& point : points_.back()) far = std::max(far, point.cwiseAbs().maxCoeff());
      extent_.push_back(far + 2.0 * near_bodies * p_.spacing);
    }
  }

  /// As many particles of the lattice as the bodies displace, those deepest inside; and the places of the air over the water,
  /// near bodies.
  void find_displaced_water() {
    if (plan_.bodies.empty()) return;
    std::size_t of_lattice = 0;
    double displaced = 0.0;  // in particles
    std::vector<std::pair<double, std::size_t>> inside;
    for (const Piece& piece : pieces_)
      if (piece.of == Piece::Of::water)
        visit_water(
            piece,
            [&](const Seed<dim>& seed, double distance) {
              displaced += share_of_bodies(seed.position, distance);
              if (distance < p_.spacing) inside.push_back({distance, of_lattice});
              ++of_lattice;
            },
            [&](const std::array<double, dim>& x) { air_.push_back(x); });
    if (displaced <= 0.0) return;
    std::sort(inside.begin(), inside.end());
    inside.resize(std::min(inside.size(), std::size_t(std::lround(displaced))));
    for (const auto& [distance, n] : inside) taken_.push_back(n);
    std::sort(taken_.begin(), taken_.end());
  }

  /// water(seed, distance to bodies) for each place of water, also where bodies are; air(place) near bodies, where it is given.
  template <class Water, class Air = std::nullptr_t>
  void visit_water(const Piece& piece, Water&& water, Air&& air = {}) const {
    if (plan_.water.empty())
      visit_water_in(piece, {{-1e300, -1e300, -1e300}, {1e300, 1e300, 0.0}}, 0.0, water, air);
    else
      visit_water_in(piece, plan_.water[piece.number], plan_.water[piece.number].high[2], water, air);
  }
  /// Rows from the surface down, each with the weight of the rows above it.
  template <class Water, class Air>
  void visit_water_in(const Piece& piece, const TankPlan::Block& block, double surface, Water& water, Air& air) const {
    constexpr bool with_air = !std::is_same_v<std::remove_cvref_t<Air>, std::nullptr_t>;
    std::array<int, dim> low = piece.low, high = piece.high;
    if (with_air) high[dim - 1] += int(near_bodies);  // for bodies that pierce the surface
    for_lattice<dim>(low, high, [&](const std::array<int, dim>& index) {
      std::array<double, dim> x = lattice_.at(index), under = x;
      if (x[dim - 1] > surface && x[dim - 1] < surface + near_bodies * lattice_.edge[dim - 1] && with_air)
        under[dim - 1] = surface - 0.5 * lattice_.edge[dim - 1];
      if (!inside<dim>(block, to_earth<dim>(under)) || x[dim - 1] < bed_of_column(index[0]) || is_obstacle(x) ||
          by_surfaces_(index) != Of::water)
        return;
      Seed<dim> seed{.position = x};
      if (p_.gravity > 0.0) {
        const double rows_above = (surface - x[dim - 1]) / lattice_.edge[dim - 1];
        const double below = p_.eos.depth_of_mass(rows_above * row_mass_, p_.gravity);
        seed.position[dim - 1] = surface - below;
        seed.deviation = p_.eos.hydrostatic_deviation(below, p_.gravity);
      }
      if (!plan_.waves.empty()) set_in_motion<dim>(seed, waves_, p_.eos, p_.gravity);
      bool in_tank = plan_.periodic[0] || (seed.position[0] > plan_.x[0] - plan_.paddle_reach && seed.position[0] < plan_.x[1]);
      if constexpr (dim == 3)
        in_tank = in_tank && (plan_.periodic[1] || (seed.position[1] > plan_.y[0] && seed.position[1] < plan_.y[1]));
      if (!in_tank) return;
      if constexpr (with_air) {
        const double distance = distance_to_bodies(to_earth<dim>(seed.position));
        if (x[dim - 1] <= surface)  // at rest: a crest is water
          water(seed, distance);
        else if (distance > 0.0 && distance < near_bodies * p_.spacing)
          air(seed.position);
      } else {
        if (x[dim - 1] <= surface) water(seed, 0.0);
      }
    });
  }

  double surface_of_scene() const {
    if (plan_.water.empty()) return 0.0;
    double highest = -1e300;
    for (const auto& block : plan_.water) highest = std::max(highest, block.high[2]);
    return highest;
  }
  Seed<dim> wall_particle(const std::array<double, dim>& x, std::uint16_t owner) const {
    Seed<dim> seed{.position = x};
    // Beside boxes of water that do not fill the tank walls start without pressure: water will come to them.
    seed.deviation = plan_.water.empty() ? deviation_at(x[dim - 1], surface_of_scene()) : 0.0;
    if (!plan_.waves.empty() && x[dim - 1] < 0.0)
      seed.deviation = p_.eos.deviation(
          std::max(0.0, p_.eos.pressure(seed.deviation) + wave_pressure(to_earth<dim>(x), waves_, plan_.depth, p_.eos.rho0)));
    seed.owner = owner;
    if (plan_.modified_walls) seed.ghost = ghost_of_wall(x, owner);
    return seed;
  }

  /// Mirror image in the faces that a wall particle lies beyond; of an obstacle's particle in its nearest face, as far in as
  /// water sees. Behind a paddle the bed is mirrored upwards only: water comes there as the paddle retreats.
  std::array<double, dim> ghost_of_wall(const std::array<double, dim>& x, std::uint16_t owner) const {
    std::array<double, dim> low, high;
    low.fill(-1e300), high.fill(1e300);
    if (walled(0)) low[0] = plan_.paddle && owner == wall_owner ? -1e300 : plan_.x[0], high[0] = plan_.x[1];
    if constexpr (dim == 3)
      if (walled(1)) low[1] = plan_.y[0], high[1] = plan_.y[1];
    low[dim - 1] = -plan_.depth;
    for (const TankPlan::Block& block : plan_.obstacles) {
      if (!inside<dim>(block, to_earth<dim>(x))) continue;
      std::array<double, dim> offset{};
      double nearest = layers_ * p_.spacing;
      for (int k = 0; k < dim; ++k) {
        const int axis = dim == 2 && k == 1 ? 2 : k;
        for (const double face : {block.low[axis], block.high[axis]}) {
          const bool wet = face > low[k] + 0.5 * p_.spacing && face < high[k] - 0.5 * p_.spacing;
          if (!wet || std::abs(face - x[k]) >= nearest) continue;
          nearest = std::abs(face - x[k]), offset = {}, offset[k] = 2.0 * (face - x[k]);
        }
      }
      return offset;
    }
    return mirror_in_box<dim>(x, low, high);
  }
  /// Mirror image of a body's particle in its surface, as far in as the support reaches.
  std::array<double, dim> ghost_of_body(const TankPlan::Body& body, const Eigen::Vector3d& local) const {
    const double depth = -signed_distance(body.shapes, local, cut_);
    if (depth <= 0.0 || depth > layers_ * p_.spacing) return {};
    const double step = 1e-3 * p_.spacing;
    Eigen::Vector3d out = Eigen::Vector3d::Zero();
    for (const int axis : {0, 1, 2}) {
      if (dim == 2 && axis == 1) continue;
      const Eigen::Vector3d along = step * Eigen::Vector3d::Unit(axis);
      out[axis] = signed_distance(body.shapes, local + along, cut_) - signed_distance(body.shapes, local - along, cut_);
    }
    if (out.norm() < step) return {};  // on a ridge: as far from one face as from another
    return from_earth<dim>(body.motion.attitude * (2.0 * depth * out.normalized()));
  }

  /// What of the lattice may be walls.
  struct WallRows {
    std::array<int, dim> low, high;
    std::vector<double> bed, lowest_near;  ///< by place along x: the bed, and its lowest within the layers [m]
  };
  WallRows rows_of_walls() const {
    const int behind = plan_.paddle ? layers_ + int(std::ceil(plan_.paddle_reach / lattice_.edge[0])) + 1 : layers_;
    std::array<int, dim> low{}, high = lattice_.count;
    low[0] = walled(0) ? -behind : 0;
    if (walled(0)) high[0] += layers_;
    if constexpr (dim == 3)
      if (walled(1)) low[1] = plan_.mirrored ? 0 : -layers_, high[1] += layers_;
    double lowest = -plan_.depth;
    for (const auto& point : plan_.bed) lowest = std::min(lowest, point[1]);
    low[dim - 1] = int(std::floor((lowest + plan_.depth) / lattice_.edge[dim - 1])) - layers_;
    WallRows rows{low, high, {}, {}};
    for (int i = low[0]; i < high[0]; ++i) {
      rows.bed.push_back(bed_of_column(i)), rows.lowest_near.push_back(rows.bed.back());
      for (int near = i - layers_; near <= i + layers_; ++near)
        rows.lowest_near.back() = std::min(rows.lowest_near.back(), bed_of_column(near));
    }
    return rows;
  }
  /// Layers of the lattice under the bed and behind the sides, and obstacles. Behind a paddle the bed and the long sides go on.
  template <class Next>
  void visit_walls(const Piece& piece, Next&& next) const {
    for_lattice<dim>(piece.low, piece.high, [&](const std::array<int, dim>& index) {
      const std::array<double, dim> x = lattice_.at(index);
      const auto column = std::size_t(index[0] - walls_.low[0]);
      const double depth_of_layers = walls_.lowest_near[column] - layers_ * lattice_.edge[dim - 1];
      if (x[dim - 1] < depth_of_layers) return;
      bool wall = x[dim - 1] < walls_.bed[column];
      if (walled(0)) wall = wall || index[0] >= lattice_.count[0] || (index[0] < 0 && !plan_.paddle);
      if constexpr (dim == 3) wall = wall || (walled(1) && (index[1] < 0 || index[1] >= lattice_.count[1]));
      bool in_tank = index[0] >= 0 && index[0] < lattice_.count[0];
      if constexpr (dim == 3) in_tank = in_tank && index[1] >= 0 && index[1] < lattice_.count[1];
      const Of of = in_tank ? by_surfaces_(index) : Of::water;
      if ((wall || of == Of::wall || (in_tank && is_obstacle(x))) && !is_core(x) && of != Of::core)
        next(wall_particle(x, wall_owner));
    });
  }

  template <class Next>
  void visit_paddle(std::uint16_t owner, Next&& next) const {
    std::array<int, dim> low{}, high = lattice_.count;
    low[0] = -layers_, high[0] = 0;
    // Under the hinge of a flap there is a fixed wall; it comes first, because a body's particles are added in one run.
    for (const bool moving : {false, true})
      for_lattice<dim>(low, high, [&](const std::array<int, dim>& index) {
        const std::array<double, dim> x = lattice_.at(index);
        const bool fixed = plan_.paddle->flap && x[dim - 1] < plan_.paddle->hinge;
        if (x[dim - 1] > plan_.bed_at(plan_.x[0]) && fixed != moving) next(wall_particle(x, moving ? owner : wall_owner));
      });
  }

  template <class Next>
  void visit_body(std::size_t b, std::uint16_t owner, Next&& next) const {
    const TankPlan::Body& body = plan_.bodies[b];
    for (const Eigen::Vector3d& point : points_[b]) {
      const Eigen::Vector3d x = body.motion.point(point);
      Seed<dim> seed{.position = from_earth<dim>(x), .velocity = from_earth<dim>(body.motion.point_velocity(point))};
      seed.deviation = plan_.water.empty() ? deviation_at(x[2], 0.0) : 0.0;
      seed.owner = owner;
      if (plan_.modified_walls) seed.ghost = ghost_of_body(body, point);
      next(seed);
    }
  }

  /// Room for walls, the paddle's stroke, splashes and bodies; sides that repeat or are open have exactly their length.
  Domain<dim> domain(double lowest, double highest) const {
    Domain<dim> domain;
    const double margin = (layers_ + 2) * p_.spacing;
    domain.low[0] = plan_.x[0] - margin - (plan_.paddle ? plan_.paddle_reach + margin : 0.0),
    domain.high[0] = plan_.x[1] + margin;
    if constexpr (dim == 3) domain.low[1] = plan_.y[0] - margin, domain.high[1] = plan_.y[1] + margin;
    for (int k = 0; k < dim - 1; ++k)
      if ((domain.periodic[k] = plan_.periodic[std::size_t(k)]))
        domain.low[k] = (k == 0 ? plan_.x : plan_.y)[0], domain.high[k] = (k == 0 ? plan_.x : plan_.y)[1];
    for (int k = 0; k < dim - 1; ++k) {
      const auto& side = k == 0 ? plan_.x : plan_.y;
      if ((domain.open[k] = plan_.open[std::size_t(k)])) domain.low[k] = side[0], domain.high[k] = side[1];
      if (!walled(std::size_t(k))) continue;
      if (!(k == 0 && plan_.paddle)) domain.wall_low[k] = side[0] - p_.spacing;
      domain.wall_high[k] = side[1] + p_.spacing;
    }
    if constexpr (dim == 3)
      if ((domain.mirrored = plan_.mirrored)) domain.low[1] = plan_.y[0], domain.wall_low[1] = domain.everywhere(-1.0)[1];
    domain.wall_low[dim - 1] = plan_.bed_at(plan_.x[0]);
    for (const auto& point : plan_.bed) domain.wall_low[dim - 1] = std::min(domain.wall_low[dim - 1], point[1]);
    domain.wall_low[dim - 1] -= p_.spacing;
    domain.edge = plan_.top - p_.spacing, domain.beside_open = p_.reach();
    domain.low[dim - 1] = lowest - margin;
    domain.high[dim - 1] = highest + 2.0 * (highest + plan_.depth) + margin;
    return domain;
  }

  /// Water that was moved aside.
  struct Moved {
    std::size_t id;
    std::array<double, dim> position;
    double deviation;
  };
  TankPlan plan_;
  Parameters p_;
  Cut cut_;
  TankLattice<dim> lattice_;
  int layers_;
  std::vector<StartingWave> waves_;
  PlacesBySurfaces<dim> by_surfaces_;
  WallRows walls_;
  std::vector<Piece> pieces_;  ///< in the order of identities
  double row_mass_ = 0.0;      ///< mass per area of a row of water [kg/m2]
  double cell_volume_ = 0.0;   ///< of the lattice over spacing^dim
  std::vector<Points> points_;
  std::vector<double> extent_;
  std::vector<std::array<double, dim>> air_;  ///< places of the lattice over the water, near bodies
  std::vector<std::size_t> taken_;            ///< places of the lattice that bodies displace, rising
  std::vector<Moved> moved_;                  ///< rising identities
  std::size_t count_ = 0;
};

}  // namespace

template <int dim>
TankParticles<dim> lay_out(const TankPlan& plan, Parameters& p) {
  const auto layout = std::make_shared<Layout<dim>>(plan, p);
  p.mass_factor = layout->mass_factor();
  TankParticles<dim> tank = layout->settle();
  tank.seeds = Layout<dim>::stream(layout);
  return tank;
}
template TankParticles<2> lay_out<2>(const TankPlan&, Parameters&);
template TankParticles<3> lay_out<3>(const TankPlan&, Parameters&);

}  // namespace spindrift::sph
