// What preconditioners share that solve something common to all tiles first and leave the rest to block ILU tile by tile: when
// ILU and the common part are made anew. Base of coarse_correction.cpp and pressure_amg.cpp; tested in
// tests/src/aero/flow/coarse_correction_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "src/aero/flow/preconditioner.hpp"

namespace spindrift::aero {

class IluAfterCommon : public Preconditioner {
 public:
  explicit IluAfterCommon(const PreconditionerOptions& options) : options_(options) {}
  void refresh(FlowTile& tile) final {
    ilu_->refresh(tile);
    fill(tile);
  }
  bool has_common() const final { return true; }
  void begin() final { refreshes_ = 0; }
  void refresh_common(MPI_Comm comm) final {
    if (refreshes_++ % options_.common_every == 0) set_up(comm);
  }

 protected:
  /// What the common part needs of a tile's blocks.
  virtual void fill(FlowTile& tile) = 0;
  /// The common part's matrix and its solver, of all tiles. Collective.
  virtual void set_up(MPI_Comm comm) = 0;

  const PreconditionerOptions options_;
  const std::unique_ptr<Preconditioner> ilu_ = make_tile_preconditioner("block_ilu");

 private:
  int refreshes_ = 0;
};

}  // namespace spindrift::aero
