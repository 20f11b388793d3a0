// A window shared by the rotor and the rest of the floating system (bodies, sea, moorings, advanced in their own steps): the
// rotor is evaluated once per window and sample, and the bodies take its loads as a signal in time, by a loose scheme or iterated
// until both agree. Where there is no such interface (no rotor, or coupling.scheme = "monolithic") a window is the bodies' steps
// alone. What iterates is a pure function of a snapshot in memory, so a window may be repeated, cut, or begun again after a
// restart. Schemes: kernels/coupling. Called by src/run; tested in tests/src/coupling/window_test.cpp and
// tests/coupled/schemes_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kernels/coupling/solve_window.hpp"
#include "kernels/coupling/staggered.hpp"
#include "src/coupling/columns.hpp"
#include "src/coupling/floating_system.hpp"
#include "src/coupling/strong_scheme.hpp"
#include "src/coupling/window_sides.hpp"
#include "src/io/history.hpp"

namespace spindrift::coupling {

/// How a window went.
struct WindowReport {
  WindowLog log;           ///< loose: one evaluation; the residual is what the scheme neglects, as is
  double mismatch = 0.0;   ///< residual over the loads
  std::string failure;     ///< not empty: the state is that of the window's start
  bool of_a_side = false;  ///< a side's own march failed, which smaller steps may mend
  bool stopped = false;    ///< given up since the run is to stop; likewise
  bool ok() const { return failure.empty() && !stopped; }
};

class CoupledWindow {
 public:
  /// The floating system outlives the window; where it has an interface its bodies take the rotor's loads from here on. `sides`:
  /// the engineering rotor, and the bodies, where none are given. `comm`: of the ranks that share its tasks.
  explicit CoupledWindow(FloatingSystem& floating, Sides sides = {}, MPI_Comm comm = MPI_COMM_SELF, std::size_t records = 0);
  ~CoupledWindow();

  /// Motion and loads of the run's first state, after the air has settled where it has to. Not before restore().
  void begin(const bodies::BodiesState& state);
  /// From a window's start to its end; `retry`: with smaller steps (retries.hpp).
  WindowReport advance(bodies::BodiesState& state, int retry = 0);

  /// Everything but the bodies' state that the next window depends on; bit for bit.
  std::vector<double> history();
  /// False where the values are not such a history.
  bool restore(std::span<const double> values);

  /// Totals since the object was made.
  struct Totals {
    std::int64_t windows = 0, evaluations = 0, probes = 0, retries = 0, cuts = 0, body_steps = 0, rotor_calls = 0;
    std::int64_t snapshot_ns = 0;  ///< saving the state at the start of each window
  };
  const Totals& totals() const { return totals_; }
  WindowSides& sides() { return sides_; }
  const WindowSides& sides() const { return sides_; }
  /// Whether a window is more than one evaluation.
  bool iterates() const { return strong_ != nullptr; }

  // Columns of history.csv: those of the air, and how the last window went.
  void declare(io::History& history);
  void put(std::span<double> row) const;

 private:
  class LooseParts;
  class Pieces;

  Eigen::Index motion_rows() const { return sides_.interface->motion_rows(); }
  double time(std::int64_t tick) const { return double(tick) * floating_.timeline().tick_s(); }
  WindowReport advance_bodies(bodies::BodiesState& state);
  template <class Signal>
  void use_signal(const Signal& signal);
  WindowReport advance_loose(bodies::BodiesState& state);
  WindowReport advance_strong(bodies::BodiesState& state);
  std::string describe(const WindowLog& log, const bodies::BodiesState& state) const;
  void visit(auto& v);

  FloatingSystem& floating_;
  const CouplingOptions options_;
  WindowSides sides_;
  std::optional<Staggered> loose_;        ///< the scheme of the scene, where it is one of these
  std::unique_ptr<StrongScheme> strong_;  ///< likewise
  Extrapolation loads_, motions_;         ///< strong: at the ends of the last pieces
  Waveform signal_;                       ///< strong: loads over the piece
  std::function<void(double, Vector&)> rotor_signal_;
  Vector load_now_;  ///< scratch of the right-hand side
  WindowReport last_;
  Totals totals_;
  std::size_t air_column_ = 0;
  std::optional<io::ColumnGroup<WindowReport>> columns_, strong_columns_;
};

}  // namespace spindrift::coupling
