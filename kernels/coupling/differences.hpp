// Pairs of differences (v, w), newest first, of this window and some before it, and the least-squares map v -> w that they span:
// what the quasi-Newton schemes learn from. Columns that add nothing new are dropped by a QR filter from the newest to the
// oldest: v is kept where its part across the newer ones exceeds `filter` |v| ("QR2" of Haelterman, Bogaers, Scheufele, Uekermann
// & Mehl 2016, Comput. Struct. 171). Used by iqn_ils.hpp, ibqn_ls.hpp, interface_gmres.hpp; tested in tests/kernels/coupling.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "kernels/coupling/scheme.hpp"

namespace spindrift::coupling {

struct LearningOptions {
  int reuse = 0;         ///< windows before this one whose columns stay
  double filter = 1e-6;  ///< least new part of a column over its size
};

class Differences {
 public:
  explicit Differences(LearningOptions options) : options_(options) {}

  int columns() const { return int(v_.cols()); }
  const Matrix& images() const { return w_; }

  /// A pair that is not finite or does not move teaches nothing and is left out.
  void add(const Vector& v, const Vector& w);
  void end_window();
  void clear();

  /// c with V c nearest to `target`.
  Vector fit(const Vector& target) const;
  /// The map from a change of v to a change of w: W fit(change).
  Vector map(const Vector& change) const;
  /// V c.
  Vector span(const Vector& c) const;

  /// Factors follow from the columns, and so are not saved.
  void visit(auto& visitor) {
    visitor(v_), visitor(w_), visitor(age_);
    factorise();
  }

 private:
  void remove(std::size_t i);
  /// Q R of the columns that pass the filter, by Gram-Schmidt applied twice; the others are dropped for good.
  void factorise();

  LearningOptions options_;
  Matrix v_, w_, q_, r_;
  std::vector<int> age_;  ///< windows since each column was learned
};

}  // namespace spindrift::coupling
