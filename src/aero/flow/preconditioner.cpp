// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/preconditioner.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "kernels/linear/block_ilu.hpp"
#include "kernels/linear/block_jacobi.hpp"
#include "src/aero/flow/coarse_correction.hpp"

namespace spindrift::aero {

namespace {

/// One of the two ways of kernels/linear, on the blocks of the mean flow and on those of the turbulence model.
struct Ilu {
  static constexpr std::string_view name = "block_ilu";
  template <class Matrix>
  static std::ptrdiff_t factor(const Matrix& a) {
    return linear::factor(a);
  }
  template <class Matrix>
  static void solve(const Matrix& a, const float* r, float* z) {
    linear::solve(a, r, z);
  }
};
struct Jacobi {
  static constexpr std::string_view name = "block_jacobi";
  template <class Matrix>
  static std::ptrdiff_t factor(const Matrix& a) {
    return linear::factor_diagonal(a);
  }
  template <class Matrix>
  static void solve(const Matrix& a, const float* r, float* z) {
    linear::solve_diagonal(a, r, z);
  }
};

template <class Method>
class ByBlocks final : public Preconditioner {
 public:
  std::ptrdiff_t refresh(FlowTile& tile) override {
    std::ptrdiff_t cell = Method::factor(tile.mean());
    if (cell < 0 && tile.turbulence == 1) cell = Method::factor(tile.model<1>());
    if (cell < 0 && tile.turbulence == 2) cell = Method::factor(tile.model<2>());
    return cell;
  }
  void apply(const Piece& piece) override {
    FlowTile& tile = *piece.tile;
    Method::solve(tile.mean(), piece.v, piece.z);
    const std::ptrdiff_t model = tile.box.count() * mean_unknowns;
    if (tile.turbulence == 1) Method::solve(tile.model<1>(), piece.v + model, piece.z + model);
    if (tile.turbulence == 2) Method::solve(tile.model<2>(), piece.v + model, piece.z + model);
  }
};

class Identity final : public Preconditioner {
 public:
  std::ptrdiff_t refresh(FlowTile&) override { return -1; }
  void apply(const Piece& p) override {
    if (p.z != p.v) std::copy_n(p.v, p.tile->vector_size(), p.z);
  }
};

}  // namespace

std::unique_ptr<Preconditioner> make_tile_preconditioner(std::string_view name) {
  if (name == Ilu::name) return std::make_unique<ByBlocks<Ilu>>();
  if (name == Jacobi::name) return std::make_unique<ByBlocks<Jacobi>>();
  if (name == "identity") return std::make_unique<Identity>();
  throw std::invalid_argument("flow: no preconditioner is called " + std::string(name));
}

std::unique_ptr<Preconditioner> make_preconditioner(std::string_view name, const PreconditionerOptions& options) {
  if (name == "coarse") return make_coarse_correction(options);
  return make_tile_preconditioner(name);
}

}  // namespace spindrift::aero
