// SPDX-License-Identifier: Apache-2.0
#include "src/aero/coarse_start.hpp"

#include <algorithm>

#include "src/aero/flow/transfer.hpp"

namespace spindrift::aero {

namespace {

int halved(int n, int step, int least) { return std::max(least, (n / 2 + step - 1) / step * step); }

}  // namespace

ResolvedRotorSetup coarser(const ResolvedRotorSetup& setup) {
  ResolvedRotorSetup s = setup;
  s.ranks_may_idle = true;
  RotorGridOptions& g = s.grid;
  g.resolution *= 0.5;
  const auto half = [](std::optional<int>& n, int step, int least) {
    if (n) n = halved(*n, step, least);
  };
  half(g.cells_round, 4, 24), half(g.cells_trailing_edge, 2, 2), half(g.cells_layers, 1, 4), half(g.cells_span, 1, 4);
  half(g.cells_outboard, 1, 3), half(g.cells_beside, 1, 2), half(g.cells_upstream, 1, 2), half(g.cells_downstream, 1, 2);
  for (std::optional<double>* h : {&g.first_cell_chords, &g.first_cell_m, &g.y_plus})
    if (*h) **h *= 2.0;
  return s;
}

void interpolate(const ResolvedRotor& from, ResolvedRotor& to, MPI_Comm comm) {
  // Blocks from the hub on have the tip at the same share of their own cells only; those of the plug begin there.
  const auto place = [&](int block, int direction, int cell) {
    const Index coarse = from.solver().grid().tiling().block_cells[std::size_t(block)],
                fine = to.solver().grid().tiling().block_cells[std::size_t(block)];
    const std::size_t d = std::size_t(direction);
    const int tip = d == 2 && fine[2] == to.made().radial_cells() ? to.made().span_cells() : 0,
              coarse_tip = tip > 0 ? from.made().span_cells() : 0;
    return cell < tip ? (cell + 0.5) * coarse_tip / tip
                      : coarse_tip + (cell - tip + 0.5) * (coarse[d] - coarse_tip) / (fine[d] - tip);
  };
  begin_with(from.solver(), to.solver(), place, comm);
}

RotorLoad start_from_coarser(const ResolvedRotorSetup& setup, int steps, ResolvedRotor& fine, const runtime::World& world) {
  ResolvedRotorSetup first = coarser(setup);
  first.flow.max_pseudo_steps = steps, first.flow.coarse_steps = 0, first.flow.drop = setup.flow.coarse_drop;
  const std::unique_ptr<ResolvedRotor> coarse = ResolvedRotor::on(world, first, 0, made_rotor_grid(first, world.comm));
  coarse->solver().judgement().bands_of_every_row = false;
  coarse->solver().start_uniform();
  coarse->prepare(world.comm);
  coarse->run();
  interpolate(*coarse, fine, world.comm);
  return coarse->load();
}

}  // namespace spindrift::aero
