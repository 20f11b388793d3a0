// SPDX-License-Identifier: Apache-2.0
#include "src/aero/hypre/multigrid.hpp"

#include <HYPRE.h>
#include <HYPRE_IJ_mv.h>
#include <HYPRE_parcsr_ls.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

#include "src/aero/flow/singular_matrix.hpp"

namespace spindrift::aero {

namespace multigrid_parts {

/// hypre collects errors in a flag; not having converged (HYPRE_ERROR_CONV) is for the caller to see.
void check(const char* what) {
  const HYPRE_Int error = HYPRE_GetError();
  if (error == 0) return;
  char text[512] = {};
  HYPRE_DescribeError(error, text);
  HYPRE_ClearAllErrors();
  if ((error & ~HYPRE_ERROR_CONV) != 0) throw SingularMatrix(std::string("hypre: ") + what + ": " + text);
}

void begin_library() {
  static const bool begun = [] {
    HYPRE_Init();
    return true;
  }();
  (void)begun;
}

/// One of hypre's handles with its destructor.
template <class Handle, HYPRE_Int (*destroy)(Handle)>
class Owner {
 public:
  Owner() = default;
  Owner(const Owner&) = delete;
  Owner& operator=(const Owner&) = delete;
  ~Owner() {
    if (handle_ != nullptr) destroy(handle_);
  }
  Handle* out() { return &handle_; }
  operator Handle() const { return handle_; }

 private:
  Handle handle_ = nullptr;
};
using Matrix = Owner<HYPRE_IJMatrix, HYPRE_IJMatrixDestroy>;
using Vector = Owner<HYPRE_IJVector, HYPRE_IJVectorDestroy>;
using Amg = Owner<HYPRE_Solver, HYPRE_BoomerAMGDestroy>;

}  // namespace multigrid_parts
using namespace multigrid_parts;

struct Multigrid::Hypre {
  Matrix matrix;
  Vector right, left;
  Amg amg;
  HYPRE_ParCSRMatrix rows = nullptr;
  HYPRE_ParVector b = nullptr, x = nullptr;
  std::vector<HYPRE_BigInt> numbers;
  HYPRE_Int count = 0;

  void make_vector(Vector& v, HYPRE_ParVector& par, MPI_Comm comm) {
    const HYPRE_BigInt first = numbers.empty() ? empty_first : numbers.front();
    HYPRE_IJVectorCreate(comm, first, first + count - 1, v.out());
    HYPRE_IJVectorSetObjectType(v, HYPRE_PARCSR);
    HYPRE_IJVectorInitialize(v);
    const std::vector<double> zero(numbers.size());
    HYPRE_IJVectorSetValues(v, count, numbers.data(), zero.data());
    HYPRE_IJVectorAssemble(v);
    HYPRE_IJVectorGetObject(v, reinterpret_cast<void**>(&par));
  }
  HYPRE_BigInt empty_first = 0;

  int run(std::span<const double> from, std::span<double> to, double drop, int most) {
    HYPRE_IJVectorSetValues(right, count, numbers.data(), from.data());
    HYPRE_IJVectorSetValues(left, count, numbers.data(), to.data());
    HYPRE_BoomerAMGSetTol(amg, drop);
    HYPRE_BoomerAMGSetMaxIter(amg, most);
    HYPRE_BoomerAMGSolve(amg, rows, b, x);
    HYPRE_Int cycles = 0;
    HYPRE_BoomerAMGGetNumIterations(amg, &cycles);
    bool enough = true;
    if (drop > 0.0) {
      HYPRE_Real norm = 0.0;
      HYPRE_BoomerAMGGetFinalRelativeResidualNorm(amg, &norm);
      enough = norm <= drop;
    }
    check("a cycle of BoomerAMG");
    HYPRE_IJVectorGetValues(left, count, numbers.data(), to.data());
    return enough ? int(cycles) : -1;
  }
};

Multigrid::Multigrid(const SparseRows& rows, const MultigridOptions& o, MPI_Comm comm) : hypre_(std::make_unique<Hypre>()) {
  begin_library();
  Hypre& h = *hypre_;
  h.count = rows.count();
  h.empty_first = rows.first;
  h.numbers.resize(std::size_t(h.count));
  std::iota(h.numbers.begin(), h.numbers.end(), HYPRE_BigInt(rows.first));
  const int last = rows.first + rows.count() - 1;
  HYPRE_IJMatrixCreate(comm, rows.first, last, rows.first, last, h.matrix.out());
  HYPRE_IJMatrixSetObjectType(h.matrix, HYPRE_PARCSR);
  std::vector<HYPRE_Int> sizes(h.numbers.size());
  for (std::size_t n = 0; n < sizes.size(); ++n) sizes[n] = rows.begin[n + 1] - rows.begin[n];
  HYPRE_IJMatrixSetRowSizes(h.matrix, sizes.data());
  HYPRE_IJMatrixInitialize(h.matrix);
  HYPRE_IJMatrixSetValues(h.matrix, h.count, sizes.data(), h.numbers.data(), rows.columns.data(), rows.values.data());
  HYPRE_IJMatrixAssemble(h.matrix);
  HYPRE_IJMatrixGetObject(h.matrix, reinterpret_cast<void**>(&h.rows));
  h.make_vector(h.right, h.b, comm), h.make_vector(h.left, h.x, comm);
  check("making a matrix");

  HYPRE_BoomerAMGCreate(h.amg.out());
  HYPRE_BoomerAMGSetPrintLevel(h.amg, 0);
  HYPRE_BoomerAMGSetCoarsenType(h.amg, 10);  // HMIS
  HYPRE_BoomerAMGSetInterpType(h.amg, 6);    // extended+i: what HMIS needs
  HYPRE_BoomerAMGSetPMaxElmts(h.amg, 4);
  HYPRE_BoomerAMGSetStrongThreshold(h.amg, 0.25);
  HYPRE_BoomerAMGSetNumSweeps(h.amg, 1);
  HYPRE_BoomerAMGSetRelaxType(h.amg, 6);  // hybrid symmetric Gauss-Seidel; the coarsest level by elimination
  HYPRE_BoomerAMGSetCycleRelaxType(h.amg, 9, 3);
  HYPRE_BoomerAMGSetRelaxOrder(h.amg, 0);
  if (o.functions > 1) HYPRE_BoomerAMGSetNumFunctions(h.amg, o.functions);
  if (o.smoother == MultigridOptions::Smoother::ilu) {
    HYPRE_BoomerAMGSetSmoothType(h.amg, 5);
    HYPRE_BoomerAMGSetSmoothNumLevels(h.amg, 25);
    HYPRE_BoomerAMGSetSmoothNumSweeps(h.amg, 1);
    HYPRE_BoomerAMGSetILUType(h.amg, 0);  // of each process's own rows
    HYPRE_BoomerAMGSetILULevel(h.amg, 0);
    HYPRE_BoomerAMGSetILUMaxIter(h.amg, 1);
    HYPRE_BoomerAMGSetILULocalReordering(h.amg, 0);
  }
  HYPRE_BoomerAMGSetTol(h.amg, 0.0);
  HYPRE_BoomerAMGSetMaxIter(h.amg, 1);
  HYPRE_BoomerAMGSetup(h.amg, h.rows, h.b, h.x);
  check("the set-up of BoomerAMG");
}
Multigrid::Multigrid(Multigrid&&) noexcept = default;
Multigrid& Multigrid::operator=(Multigrid&&) noexcept = default;
Multigrid::~Multigrid() = default;

void Multigrid::cycle(std::span<const double> b, std::span<double> x) {
  std::fill(x.begin(), x.end(), 0.0);
  hypre_->run(b, x, 0.0, 1);
}
int Multigrid::solve(std::span<const double> b, std::span<double> x, double drop, int most) {
  return hypre_->run(b, x, drop, most);
}

}  // namespace spindrift::aero
