// The largest of a number over the cells of a grid that is spread over ranks. Used by actuator.cpp and changing_wind.cpp; tested
// in tests/src/aero/actuator_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "runtime/mpi/exchange.hpp"
#include "src/aero/grid/store.hpp"

namespace spindrift::aero {

/// Of number(geometry, k, j, i, centre), at least zero. Collective.
template <class Number>
double largest_of_cells(const GridStore& store, MPI_Comm comm, Number&& number) {
  double largest = 0.0;
  for (const int tile : store.owned()) {
    const TileGeometry& g = store[tile];
    const Tile& cells = store.tiling().tiles[std::size_t(tile)];
    const std::ptrdiff_t c = g.cell_box.component;
    for (int k = 0; k < cells.nk; ++k)
      for (int j = 0; j < cells.nj; ++j)
        for (int i = 0; i < cells.ni; ++i) {
          const double* x = g.centre_data.data() + g.cell_box.at(k, j, i);
          largest = std::max(largest, number(g, k, j, i, Eigen::Vector3d(x[0], x[c], x[2 * c])));
        }
  }
  runtime::Packer mine;
  mine.put_one(largest);
  for (const runtime::Bytes& bytes : runtime::exchange_all(comm, mine.take()))
    largest = std::max(largest, runtime::Unpacker(bytes).one<double>());
  return largest;
}

}  // namespace spindrift::aero
