// Of a preconditioner that solves a coarse level of all tiles first and leaves the rest to block ILU tile by tile: when ILU and
// the coarse level are made anew, and how a coarse level goes on over physical steps, snapshots and restarts. What the coarse
// level is of, coarse_correction.cpp has; tested in tests/src/aero/flow/coarse_correction_test.cpp, kept_set_up_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "src/aero/flow/preconditioner.hpp"
#include "src/aero/flow/singular_matrix.hpp"

namespace spindrift::aero {

class IluAfterCoarse : public Preconditioner {
 public:
  explicit IluAfterCoarse(const PreconditionerOptions& options) : options_(options) {}
  std::ptrdiff_t refresh(FlowTile& tile) final {
    const std::ptrdiff_t own = ilu_->refresh(tile), filled = fill(tile, due());
    return own >= 0 ? own : filled;
  }
  bool has_coarse_level() const final { return true; }
  void begin(std::int64_t step) final { refreshes_ = 0, tick_ = step % options_.common_steps == 0; }
  void refresh_coarse_level(MPI_Comm comm) final {
    const bool anew = due();
    if (anew || outdated_) attempt([&] { set_up(comm); });
    if (anew) number_ = ++numbers_;
    have_ = true, outdated_ = false;
    ++refreshes_;
  }
  void solve_coarse_level(MPI_Comm comm) final {
    if (!singular_) attempt([&] { solve_coarse(comm); });
  }
  void apply(const Piece& piece) final {
    if (singular_)
      ilu_->apply(piece);
    else
      apply_coarse(piece);
  }
  bool singular() const final { return singular_; }

  std::size_t kept_size(const FlowTile& tile) const final { return options_.common_steps > 1 ? 1 + matrix_size(tile) : 0; }
  void save_kept(const FlowTile& tile, std::span<double> to) const final {
    to[0] = have_ ? 1.0 : 0.0;
    save_matrix(tile, to.subspan(1));
  }
  void load_kept(FlowTile& tile, std::span<const double> from) final {
    have_ = outdated_ = from[0] != 0.0;
    load_matrix(tile, from.subspan(1));
  }
  std::uint64_t kept_number() const final { return number_; }
  void set_kept_number(std::uint64_t number) final { number_ = number > 0 ? number : ++numbers_; }

 protected:
  /// What the coarse level needs of a tile's blocks; `anew`: also what the next set_up() is made of, which otherwise stays.
  /// Returns a cell whose diagonal block is singular, or -1.
  virtual std::ptrdiff_t fill(FlowTile& tile, bool anew) = 0;
  /// The coarse level's matrix and its solver, of all tiles. Collective.
  virtual void set_up(MPI_Comm comm) = 0;
  /// Its solution for what was gathered. Collective. Both may throw SingularMatrix.
  virtual void solve_coarse(MPI_Comm comm) = 0;
  /// z from that solution and ILU of what it leaves.
  virtual void apply_coarse(const Piece& piece) = 0;
  // A tile's part of that matrix.
  virtual std::size_t matrix_size(const FlowTile& tile) const = 0;
  virtual void save_matrix(const FlowTile& tile, std::span<double> to) const = 0;
  virtual void load_matrix(FlowTile& tile, std::span<const double> from) = 0;

  const PreconditionerOptions options_;
  const std::unique_ptr<Preconditioner> ilu_ = make_tile_preconditioner("block_ilu");

 private:
  template <class Work>
  void attempt(Work&& work) {
    singular_ = false;
    try {
      work();
    } catch (const SingularMatrix&) { singular_ = true; }
  }
  /// Whether the next set-up is made of the matrix as it is then. No task changes what this reads while tiles are refreshed.
  bool due() const { return !have_ || (refreshes_ % options_.common_every == 0 && (refreshes_ > 0 || tick_)); }

  int refreshes_ = 0;      ///< in this physical step
  bool tick_ = true;       ///< this step begins with a new set-up
  bool have_ = false;      ///< there is a set-up, or what it was made of
  bool outdated_ = false;  ///< only the latter
  bool singular_ = false;
  std::uint64_t number_ = 0, numbers_ = 0;
};

}  // namespace spindrift::aero
