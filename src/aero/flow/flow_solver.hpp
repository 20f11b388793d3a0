// The air: a compressible flow on the tiles of this rank, one implicit (pseudo-)time march as tasks. Owns all arrays of the
// solver and the decisions between tasks; the graph itself is tasks.cpp, the method docs/theory/air.md. Built by
// src/aero/resolved_rotor.cpp, src/run/flow_case.cpp and by tests; tested in tests/src/aero/flow and tests/verification/air.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/graph/graph.hpp"
#include "src/aero/flow/body_force.hpp"
#include "src/aero/flow/boundary.hpp"
#include "src/aero/flow/control.hpp"
#include "src/aero/flow/flow_tile.hpp"
#include "src/aero/flow/krylov_cycle.hpp"
#include "src/aero/flow/loads.hpp"
#include "src/aero/flow/preconditioner.hpp"
#include "src/aero/flow/sweep_convective.hpp"
#include "src/aero/flow/sweep_jacobian.hpp"
#include "src/aero/flow/sweep_model.hpp"
#include "src/aero/flow/sweep_viscous.hpp"
#include "src/aero/grid/store.hpp"

namespace spindrift::aero {

/// What acts on a patch of the grid.
struct PatchCondition {
  Condition condition = Condition::far_field;
  bool loads = false;                      ///< its force is summed and reported
  std::optional<double> temperature = {};  ///< that a no-slip wall is held at [K]; unset: adiabatic
};

/// All that a scene may choose, in SI units; from FlowOptions or written by a test.
struct FlowSetting {
  gas::IdealGas gas;                ///< with the references of the undisturbed flow
  gas::Primitive<double> stream{};  ///< undisturbed flow above those references; at the reference height of
  WindProfile profile{};            ///< its velocity over the height z
  double speed = 0.0;               ///< scale of velocity [m/s]: that of the stream, or of what moves
  std::string flux = "roe_low_mach", limiter = "none", turbulence = "none";
  bool first_order_model =
      false;  ///< turbulence is carried by first-order upwind differences, as in CFL3D and FUN3D; else second order, limited
  std::optional<double> wind_eddy_viscosity;  ///< of the undisturbed flow over its laminar one; unset: the closure's
  std::optional<double> wind_intensity;       ///< of its turbulence, of two equations: k = 3/2 (intensity times wind)^2
  double upwinding = 1.0;                     ///< share of the jump between reconstructed states that the flux sees
  bool viscous = false, thin_layer = false;
  double smooth = 0.0;  ///< cell size over flow length: differences below its limiter threshold are smooth; 0: all limited
  bool preconditioned = true;
  bool physical_far_field = false;  ///< its waves at their own speeds also where the pseudo-time is preconditioned
  /// Dissipation in the matrix where the flux is low-Mach Roe. Empty: that of the preconditioned equations, good at any Mach
  /// number; else Rieper's with at least this scaling, 1 being Roe's.
  std::optional<double> matrix_mach_floor;
  MarchOptions march;
  KrylovMethod krylov = KrylovMethod::gmres;
  std::string preconditioner = "block_ilu";
  PreconditionerOptions common;  ///< of preconditioners that have a common part
  int time_order = 0;            ///< 0 steady, 1 BDF1, 2 BDF2
  double dt = 0.0;               ///< physical step [s]
  double held_rate = 0.0;  ///< steady flow: added to the matrix as a physical step of this rate would [1/s]; trials (choice.hpp)
  /// Steady flow seen from a frame that turns about an axis through `centre` along the stream: velocities stay those in space,
  /// their components turn with the frame. Blades are at rest in the grid.
  Eigen::Vector3d frame_omega = Eigen::Vector3d::Zero(), frame_centre = Eigen::Vector3d::Zero();  ///< [rad/s], [m]
};

/// Where a block of the grid is at the end of a step: its nodes as made, changed by `shape` where there is one, then carried by
/// `map`.
struct BlockPose {
  RigidMap map;
  std::function<Eigen::Vector3d(const Eigen::Vector3d&)> shape;
  /// In place of `shape` where it goes by the node's index in its block: (index, node as made) -> node.
  std::function<Eigen::Vector3d(const Index&, const Eigen::Vector3d&)> shape_at = {};
};

/// What a pseudo-step did; one row for each since the last clear.
struct PseudoRow {
  int step = 0, krylov = 0, rejections = 0, matrices = 0;  ///< matrices made so far
  double cfl = 0.0, density_residual = 0.0, mass_residual = 0.0, mean_residual = 0.0, model_residual = 0.0, balance_drop = 0.0,
         fraction = 1.0;
  bool matrix_free = false;
  std::array<double, 3> force{};   ///< of all patches with loads [N]
  std::array<double, 3> moment{};  ///< likewise, about the origin [N m]
  std::vector<double> loads{};     ///< by patch, see patch_loads, then by band, see band_loads
  std::vector<double> bodies{};    ///< of the force inside the air, BodyForce::loads
};

class FlowSolver {
 public:
  /// `conditions` by patch of the grid's tiling. The grid must outlive the solver and have been built.
  FlowSolver(GridStore& grid, const FlowSetting& setting, std::vector<PatchCondition> conditions);
  FlowSolver(const FlowSolver&) = delete;
  FlowSolver& operator=(const FlowSolver&) = delete;

  /// Every cell as the undisturbed flow there.
  void start_uniform();
  /// Any state: body(centre) gives the primitive values above the references, and those of the turbulence unknowns.
  template <class Body>
  void start(Body&& body) {
    for (FlowTile& tile : tiles_) start_tile(tile, body);
    forget();
  }
  /// A source of conserved amounts [per m3 and s], for manufactured solutions: rate(centre, values) fills one value per unknown.
  template <class Body>
  void set_source(Body&& rate) {
    for (FlowTile& tile : tiles_) {
      tile.source = AlignedArray<double>(tile.inner.size(tile.unknowns()));
      for_centres(tile, [&](int k, int j, int i, const Eigen::Vector3d& x) {
        std::array<double, mean_unknowns + 2> values{};
        rate(x, values);
        for (int n = 0; n < tile.unknowns(); ++n)
          tile.source.data()[tile.inner.at(k, j, i) + n * tile.inner.component] = values[std::size_t(n)];
      });
    }
  }
  /// The state of another solver on the same tiles, a steady one say; no past.
  void start_from(const FlowSolver& other);
  /// Adds body(centre) [m/s] to the velocity of every cell.
  template <class Body>
  void add_velocity(Body&& body) {
    for (FlowTile& tile : tiles_)
      for_centres(tile, [&](int k, int j, int i, const Eigen::Vector3d& x) {
        const Eigen::Vector3d more = body(x);
        for (int d = 0; d < 3; ++d) tile.state.data()[tile.cells.at(k, j, i) + (1 + d) * tile.cells.component] += more[d];
      });
  }
  /// No past: the physical step that follows is the first.
  void forget();

  /// Moving grids (built with `moving`; time_order 1 or 2): where the blocks are at the end of the next physical step, by block,
  /// or one pose for all. To be called before each step; a step without it leaves the grid where it is. Face speeds follow from
  /// positions, so that any motion keeps a uniform stream.
  void move_to(std::vector<BlockPose> poses);
  /// Puts the blocks where the last step left them and, one step before it, `before`: starts and restarts away from the nodes as
  /// made. What save_march() keeps of rigid poses is placed by load_march(); of shapes it keeps nothing, place them after it.
  void place(std::vector<BlockPose> before, std::vector<BlockPose> now);

  /// From here on waves run at their own speeds in the pseudo-time, as without low-Mach preconditioning; far field and flow stay.
  void use_physical_pseudo_time() { implicit_.preconditioned = implicit_.preconditioned_waves = false; }
  /// In place of the one the setting names; before record().
  void use(std::unique_ptr<Preconditioner> preconditioner) {
    preconditioner_ = std::move(preconditioner);
    preconditioner_->attach(grid_, tiles_);
  }
  /// A force inside the air; before record().
  void set_body_force(std::shared_ptr<BodyForce> force);
  /// Bands whose loads each judgement sums beside those of the patches; before record().
  void gather_bands(LoadBands bands);
  /// Records one march: the whole steady solution, or one physical step. See tasks.cpp.
  void record(runtime::Graph& graph);
  /// Records what fills ghost volumes and centres from other ranks; to be run once, and after each motion of the grid.
  void record_geometry(runtime::Graph& graph);
  /// What recorded graphs refer to is freed: their executors are gone.
  void forget_graphs() { pieces_.clear(), double_buffers_.clear(), float_buffers_.clear(); }

  const FlowSetting& setting() const { return setting_; }
  GridStore& grid() { return grid_; }
  const GridStore& grid() const { return grid_; }
  std::span<FlowTile> tiles() { return tiles_; }
  std::span<const FlowTile> tiles() const { return tiles_; }
  const March& march() const { return march_; }
  March& march() { return march_; }
  const std::vector<PseudoRow>& rows() const { return rows_; }
  /// Called with each row as it is made: progress, clocks.
  void watch(std::function<void(const PseudoRow&)> watcher) { watcher_ = std::move(watcher); }
  void clear_rows() { rows_.clear(); }
  /// Between two chunks of a steady march: its last row will be judged again.
  void keep_last_row() {
    if (rows_.size() > 1) rows_.erase(rows_.begin(), rows_.end() - 1);
  }
  /// Where a march failed on this rank: block, cell and the limit that bound there; empty where none did.
  const std::string& trouble() const { return trouble_; }
  /// Where the flow is farthest from its balance, as last judged: cells of the mean flow and of turbulence, a sentence.
  /// Collective.
  std::string worst_cells(MPI_Comm comm) const;
  /// Loads by patch and by band as last judged, the same on every rank.
  std::span<const double> load_sums() const { return loads_; }
  PatchLoads loads(int patch) const { return patch_loads(loads_, patch); }
  const std::vector<PatchCondition>& conditions() const { return conditions_; }
  /// What is seen on the walls of a tile of this rank.
  std::vector<WallPoint> wall_points(const FlowTile& tile) const {
    std::vector<WallPoint> points;
    gather_wall(tile, tile.state.data(), viscous_, boundary_, points);
    return points;
  }
  /// Physical steps since the start.
  std::int64_t time_steps() const { return time_steps_; }
  void set_time_step(double dt, double dt_before);
  /// Length of the next physical step; that of the last one is kept.
  void next_time_step(double dt) { setting_.dt = boundary_.dt = dt; }

  /// What a restart needs of a tile, besides its geometry: state and past, then the march.
  std::size_t saved_size(int owned) const;
  void save(int owned, std::span<double> to) const;
  void load(int owned, std::span<const double> from);
  std::vector<double> save_march() const;
  void load_march(std::span<const double> from);
  /// Where a set-up of the preconditioner outlives a physical step (PreconditionerOptions::common_steps), what it was made of, by
  /// owned tile.
  bool keeps_set_up() const { return setting_.common.common_steps > 1 && preconditioner_->has_common(); }
  struct SetUpNote {
    std::uint64_t number = 0;  ///< of this solver's set-ups; 0: of another solver
    std::vector<std::vector<double>> tiles;
  };
  SetUpNote save_set_up() const;
  std::size_t set_up_size(int owned) const { return preconditioner_->kept_size(tiles_[std::size_t(owned)]); }
  void load_set_up(const SetUpNote& from);

  std::size_t bytes() const;
  long cells() const;  ///< of all ranks
  int unknowns() const { return mean_unknowns + model_->equations; }

 private:
  friend class StepGraph;
  /// body(k, j, i, centre) for every cell of a tile.
  template <class Body>
  static void for_centres(const FlowTile& tile, Body&& body) {
    const TileGeometry& g = *tile.geometry;
    const std::ptrdiff_t c = g.cell_box.component;
    for (int k = 0; k < tile.box.nk; ++k)
      for (int j = 0; j < tile.box.nj; ++j)
        for (int i = 0; i < tile.box.ni; ++i) {
          const double* x = g.centre_data.data() + g.cell_box.at(k, j, i);
          body(k, j, i, Eigen::Vector3d(x[0], x[c], x[2 * c]));
        }
  }
  template <class Body>
  void start_tile(FlowTile& tile, Body& body) {
    for_centres(tile, [&](int k, int j, int i, const Eigen::Vector3d& x) {
      const gas::Primitive<double> q = body(x);
      const std::ptrdiff_t at = tile.cells.at(k, j, i);
      gas::store_primitive(tile.state.data() + at, std::size_t(tile.cells.component), q);
      for (int t = 0; t < tile.turbulence; ++t)
        tile.state.data()[at + (mean_unknowns + t) * tile.cells.component] = boundary_.carried[std::size_t(t)];
    });
  }

  // Work of single tasks.
  void begin_time_step(FlowTile& tile);
  bool moves() const { return setting_.time_order > 0 && !tiles_.empty() && tiles_[0].geometry->moving(); }
  const Tile& tiling_tile(const FlowTile& tile) const;
  const BlockPose& pose(const std::vector<BlockPose>& poses, const FlowTile& tile) const;
  void check_poses(const std::vector<BlockPose>& poses) const;
  void move_tile(FlowTile& tile);
  void record_centres(runtime::Graph& graph, const std::vector<runtime::Datum>& nodes, const std::vector<runtime::Datum>& ghosts,
                      const std::vector<runtime::Use>& control);
  void slopes(FlowTile& tile, const double* state);
  void evaluate(FlowTile& tile, double* state, double* residual);
  void measure(FlowTile& tile, std::span<double> partial, std::span<double> loads);
  void judge();
  void name_trouble();
  void resume() {
    march_.resume(setting_.march.max_steps);
    if (!rows_.empty()) rows_.pop_back();
  }
  void build_matrix(FlowTile& tile);
  /// Whether a march that ends before its time goes on with the same bits: a physical step begins anew, and a steady march where
  /// nothing outlives a pseudo-step.
  bool stops_anywhere() const {
    return setting_.time_order > 0 || (march_.options().refresh_every == 1 && setting_.common.common_every == 1);
  }
  bool refreshes() const { return solving_ && march_.refresh(); }
  void first_vector(FlowTile& tile);
  void make_vector(FlowTile& tile, int iteration);
  void precondition_vector(FlowTile& tile, int iteration);
  double spread_direction(FlowTile& tile, int iteration);
  void combine(FlowTile& tile);
  void precondition_solution(FlowTile& tile);
  void perturb(FlowTile& tile);
  void product(FlowTile& tile, int iteration, std::span<double> dots);
  double find_update(FlowTile& tile);
  void apply_update(FlowTile& tile);

  GridStore& grid_;
  FlowSetting setting_;
  std::vector<PatchCondition> conditions_;
  std::vector<FlowTile> tiles_;  ///< owned, in the order of the tiling
  std::vector<int> local_;       ///< by tile of the tiling: index in tiles_, -1 elsewhere
  ConvectiveSetting convective_;
  ViscousSetting viscous_;
  const ModelSweeps* model_ = nullptr;
  BoundarySetting boundary_;
  ImplicitSetting implicit_;

  March march_;
  KrylovCycle cycle_;
  std::unique_ptr<Preconditioner> preconditioner_;
  int matrices_ = 0;
  Norms norms_;
  std::vector<double> norm_partials_, load_partials_, dot_partials_, size_partials_, fraction_partials_;
  std::vector<double> norm_sums_, loads_, dots_;
  std::array<double, 2> model_unit_{1.0, 1.0};  ///< of the turbulence model's residuals where they are judged
  double linear_norm_ = 0.0;                    ///< of the right-hand side, in the units of the linear solver
  double direction_size_ = 0.0, fraction_ = 1.0;
  bool solving_ = false, matrix_free_ = false;
  std::vector<PseudoRow> rows_;
  LoadBands bands_;
  std::shared_ptr<BodyForce> body_force_;  ///< null: none
  std::vector<double> body_partials_, body_sums_;
  std::function<void(const PseudoRow&)> watcher_;
  /// The cell of each tile that limits its update most, and by what.
  struct Limit {
    double fraction = 1.0;
    Index cell{};
    const char* what = "";
  };
  std::vector<Limit> limits_;
  std::vector<double> noise_;  ///< by tile: squared norm of what round-off leaves of its balances
  std::string trouble_;
  std::vector<BlockPose> poses_before_{1}, poses_{1}, poses_next_{1};  ///< one step ago, now, at the end of the next step
  std::vector<RigidMap> periodic_;                                     ///< of the grid where it is
  std::int64_t time_steps_ = 0;
  double dt_before_ = 0.0;
  TimeWeights weights_{};
  std::vector<std::shared_ptr<void>> pieces_;  ///< what the tasks of recorded graphs refer to
  std::deque<std::vector<double>> double_buffers_;
  std::deque<std::vector<float>> float_buffers_;
};

}  // namespace spindrift::aero
