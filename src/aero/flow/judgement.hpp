// What is known of a state after each pseudo-step, and what follows from it: norms and loads of all tiles, the row of the march,
// whether it goes on, back, or ends, and where it failed. Owned by FlowSolver, called by tasks.cpp; tested in
// tests/src/aero/flow/solver_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "src/aero/flow/body_force.hpp"
#include "src/aero/flow/control.hpp"
#include "src/aero/flow/flow_residual.hpp"
#include "src/aero/flow/implicit_system.hpp"
#include "src/aero/flow/loads.hpp"
#include "src/aero/flow/tile_arrays.hpp"
#include "src/aero/flow/tile_sums.hpp"
#include "src/aero/flow/update_limits.hpp"

namespace spindrift::aero {

/// What a pseudo-step did.
struct PseudoRow {
  int step = 0, krylov = 0, rejections = 0, matrices = 0;  ///< matrices made so far
  double cfl = 0.0, density_residual = 0.0, mass_residual = 0.0, mean_residual = 0.0, model_residual = 0.0, balance_drop = 0.0,
         fraction = 1.0, limited = 0.0, clipped = 0.0;  ///< as PseudoStep has them
  bool matrix_free = false;
  MassBalance mass{};              ///< of the whole grid
  std::array<double, 3> force{};   ///< of all patches with loads [N]
  std::array<double, 3> moment{};  ///< likewise, about the origin [N m]
  std::vector<double> loads{};     ///< by patch, see patch_loads; then by band, see band_loads, where takes_bands() was so
  std::vector<double> bodies{};    ///< of the force inside the air, BodyForce::loads
};

/// The rows of a march, one for each state that was judged.
struct PseudoRows {
  std::vector<PseudoRow> all;                     ///< since they were last cleared
  std::function<void(const PseudoRow&)> watcher;  ///< called with each row as it is made: progress, clocks

  void add(PseudoRow row);
  /// Between two chunks of a steady march: its last row will be judged again.
  void keep_last();
};

class Judgement {
 public:
  /// `arrays` is to outlive it.
  Judgement(const FlowSetting& setting, std::vector<PatchCondition> conditions, TileArrays& arrays);

  /// Before the march is recorded.
  void gather_bands(LoadBands of);
  void set_body_force(std::shared_ptr<BodyForce> force);
  /// Null: none.
  BodyForce* body_force() const { return body_force_.get(); }

  /// A march begins, or goes on.
  void begin();
  /// A tile's part of `norms`, `loads` and `bands`. @pre its residual is that of its state
  void measure(std::size_t owned, const ImplicitSystem& system, const FlowResidual& residual);
  /// One place where the march goes on, back, or ends: after the sums over all tiles. Leaves a row.
  void judge();
  /// Whether the state that was judged last has its bands summed too, after which add_bands() makes them part of its row.
  bool takes_bands() const { return !bands.result.empty() && (bands_of_every_row || ends_march(march.state().verdict)); }
  void add_bands();
  /// The norms of all tiles together, once they have been summed.
  Norms sums() const;
  /// Whether a pseudo-step is to be made, with products free of a matrix, with a fresh matrix.
  bool solving() const { return solving_; }
  bool perturbs() const { return solving_ && matrix_free_; }
  bool matrix_free() const { return matrix_free_; }
  bool refreshes() const { return solving_ && march.state().refresh; }

  const std::vector<PatchCondition>& conditions() const { return conditions_; }
  /// Where a march failed on this rank: block, cell and the limit that bound there; empty where none did.
  const std::string& trouble() const { return trouble_; }
  /// As last judged, the same on every rank: the balance of mass of the whole grid, loads of a patch.
  MassBalance mass() const;
  PatchLoads patch(int patch) const { return patch_loads(loads.result, patch); }

  March march;
  PseudoRows rows;
  TileSums norms, loads, bands, force_samples;  ///< `loads` by patch, `bands` by band: of tiles that have any loads
  bool bands_of_every_row = false;              ///< not only of the state that a march ends with

 private:
  void name_trouble();
  std::size_t patch_sums() const;

  std::vector<PatchCondition> conditions_;
  TileArrays& arrays_;
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> loaded_;  ///< of each owned tile: its place in `loads`, or none
  std::size_t loaded_tiles_ = 0;
  LoadBands bands_;
  std::shared_ptr<BodyForce> body_force_;
  bool unsteady_;
  /// Whether a march that ends before its time goes on with the same bits: a physical step begins anew, and a steady march where
  /// nothing outlives a pseudo-step.
  bool stops_anywhere_;
  bool solving_ = false, matrix_free_ = false;
  int matrices_ = 0;  ///< made so far
  std::string trouble_;
};

/// Where updates were shortened most since the tiles were made, or in the last one alone: the cell that bound that of the mean
/// flow, and the one in which turbulence's was. Collective; of equally bad cells that of the first rank.
enum class Updates : std::uint8_t { all, last };
LimitPlaces limited_cells(const TileArrays& arrays, Updates which, MPI_Comm comm);

/// Where the flow is farthest from its balance, as last judged: cells of the mean flow and of turbulence, a sentence. Collective.
std::string worst_cells(const TileArrays& arrays, const ImplicitSystem& system, MPI_Comm comm);

}  // namespace spindrift::aero
