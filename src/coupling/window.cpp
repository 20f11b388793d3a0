// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/window.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/trace/clock.hpp"
#include "runtime/trace/ledger.hpp"

namespace spindrift::coupling {

CoupledWindow::CoupledWindow(FloatingSystem& floating, Sides sides, MPI_Comm comm, std::size_t records)
    : floating_(floating),
      options_(floating.scenario().coupling),
      sides_(floating, std::move(sides), comm, records),
      loads_(options_.predictor_order),
      motions_(1),
      load_now_(RotorInterface::load_rows) {
  if (!sides_.interface) return;
  const CouplingScheme& scheme = of(options_.scheme);
  if (scheme.staggering != nullptr) loose_.emplace(scheme.staggering(options_));
  if (scheme.strong != nullptr) strong_ = scheme.strong(options_);
  const auto load_at = [this](double t) {
    rotor_signal_(t, load_now_);
    return sides_.interface->load(load_now_);
  };
  floating_.replace_rotor_loads(
      [this, load_at](double t, std::span<const Motion> bodies, std::span<Wrench> wrenches) {
        floating_.rotor()->add_air_load(t, bodies, wrenches, load_at(t), floating_.rotor_source().ramp_after_air(t));
      },
      sides_.air().written());
  floating_.rotor_source().turn_by([load_at](double t) { return load_at(t).moment; });
}

CoupledWindow::~CoupledWindow() {
  if (!sides_.interface) return;
  floating_.replace_rotor_loads({});
  floating_.rotor_source().turn_by({});
}

template <class Signal>
void CoupledWindow::use_signal(const Signal& signal) {
  rotor_signal_ = [&signal](double t, Vector& out) { signal.at(t, out); };
}

void CoupledWindow::begin(const bodies::BodiesState& state) {
  if (!sides_.interface) return;
  const double t = time(state.tick);
  const Vector motion = sides_.interface->motion(t, state, 0.0);
  const Vector load = sides_.interface->rows(sides_.air().begin(t, sides_.interface->state(t, motion)));
  if (loose_) {
    loose_->begin(t, motion, load);
    use_signal(loose_->load());
  } else {
    motions_.add(t, motion), loads_.add(t, load);
    signal_ = Waveform(options_.interpolation, {t}, {load});
    use_signal(signal_);
  }
}

WindowReport CoupledWindow::advance(bodies::BodiesState& state, int retry) {
  const std::int64_t begin = runtime::Clock::now_ns();
  const Timeline& timeline = floating_.timeline();
  sides_.balance(state.tick / timeline.steps_per_window(), timeline.windows());
  const std::int64_t balanced = runtime::Clock::now_ns();
  sides_.take_snapshot(AirSide::window);
  const std::int64_t end = runtime::Clock::now_ns();
  totals_.snapshot_ns += end - begin;
  if (runtime::Ledger* const ledger = runtime::Ledger::current()) ledger->on_all(end - balanced);
  sides_.begin_window(retry);
  // Before t = 0 the sea settles round bodies that are held; the air waits.
  const bool air_waits = !sides_.interface || state.tick < 0;
  last_ = air_waits ? advance_bodies(state) : loose_ ? advance_loose(state) : advance_strong(state);
  last_.stopped = sides_.stopped();
  last_.of_a_side = !last_.failure.empty() && sides_.mendable();
  if (!last_.ok())
    sides_.return_to(AirSide::window, Run::both);
  else if (!air_waits)
    sides_.air().end_window();
  ++totals_.windows;
  totals_.evaluations += last_.log.evaluations, totals_.probes += last_.log.probes;
  totals_.retries += last_.log.retries, totals_.cuts += last_.log.cuts;
  totals_.body_steps = sides_.bodies().steps(), totals_.rotor_calls = sides_.rotor_calls();
  return last_;
}

WindowReport CoupledWindow::advance_bodies(bodies::BodiesState& state) {
  WindowReport report;
  bodies::BodiesState end = state;
  if (sides_.move(end, state.tick + floating_.timeline().steps_per_window()))
    state = std::move(end);
  else
    report.failure = sides_.trouble();
  return report;
}

/// A window of a loose scheme, as Staggered asks for it: what each part does with what it is told of the other. Begins at
/// `state`, which goes along with the bodies.
class CoupledWindow::LooseParts {
 public:
  LooseParts(CoupledWindow& window, const bodies::BodiesState& start, std::int64_t end_tick)
      : w_(window), state_(start), end_tick_(end_tick), start_motion_(window.loose_->motion().last()) {}

  Vector move(const Extrapolation& load, double begin, double end) {
    w_.use_signal(load);
    return w_.sides_.move(state_, end_tick_) ? new_motion(begin, end) : not_finite(w_.motion_rows());
  }
  Vector load(const Waveform& motion, double begin, double end) {
    return w_.sides_.air_load(end, w_.floating_.timeline().window_s(), motion_for_air(motion, begin, end));
  }
  std::pair<Vector, Vector> both(const Extrapolation& load, const Waveform& motion, double begin, double end) {
    w_.use_signal(load);
    auto [moved, new_load] = w_.sides_.move_beside_air(state_, end_tick_, end, w_.floating_.timeline().window_s(),
                                                       [&] { return motion_for_air(motion, begin, end); });
    return {moved ? new_motion(begin, end) : not_finite(w_.motion_rows()), std::move(new_load)};
  }
  bodies::BodiesState& state() { return state_; }

 private:
  /// Of the hub, now that the bodies have moved.
  Vector new_motion(double begin, double end) const {
    return w_.sides_.interface->motion(
        end, state_, RotorInterface::azimuth(start_motion_) + (end - begin) * RotorInterface::rate(start_motion_));
  }
  /// Of the hub at the end, which the scheme extrapolates or holds.
  Vector motion_for_air(const Waveform& motion, double begin, double end) const {
    const Staggering& scheme = w_.loose_->scheme();
    // One window is no line to extrapolate: a rotor that stood still for it would jump.
    if (w_.loose_->motion().windows() == 1 && scheme.extrapolates_motion())
      return RotorInterface::carried_on(start_motion_, end - begin);
    const Vector given = motion.at(end);
    // Motion may be held, the rotor turns on.
    return scheme.holds_motion() ? RotorInterface::turned(given, end - begin) : given;
  }

  CoupledWindow& w_;
  bodies::BodiesState state_;
  std::int64_t end_tick_;
  Vector start_motion_;  ///< of the hub
};

WindowReport CoupledWindow::advance_loose(bodies::BodiesState& state) {
  const std::int64_t end = state.tick + floating_.timeline().steps_per_window();
  LooseParts parts(*this, state, end);
  const std::vector<double> before = history();
  WindowReport report;
  report.log.evaluations = 1;
  if (!loose_->advance(parts, time(state.tick), time(end))) {
    report.log.bound = Bound::not_finite;
    report.failure = describe(report.log, state);
    return report;
  }
  report.log.residual = report.log.first_residual = loose_->mismatch().norm();
  const double load = loose_->load().last().norm();
  report.mismatch = load > 0.0 ? report.log.residual / load : report.log.residual;
  constexpr int most_apart = 3;
  if (loose_->apart() > most_apart) {
    report.failure = fmt::format(
        "t = {:g} s: coupling: the loads on the rotor came out apart from those assumed by {:.3g} of them, window after window "
        "({} in a row by more than {:g} of the larger, the limit is {}): the loose scheme is unstable at a window of {:g} s; "
        "iterate (coupling.scheme = \"iqn_ils\") or shorten time.window_s",
        time(state.tick), report.mismatch, loose_->apart(), Staggered::far_apart, most_apart, floating_.timeline().window_s());
    restore(before);
    return report;
  }
  state = std::move(parts.state());
  return report;
}

/// The strong window, or the piece of it that is next. x holds the loads at the samples; composed in parallel, the motions as
/// well.
class CoupledWindow::Pieces final : public WindowParts {
 public:
  Pieces(CoupledWindow& window, const bodies::BodiesState& start)
      : w_(window), start_(start), length_(window.floating_.timeline().steps_per_window()), end_(start.tick + length_) {
    save_start();
  }

  Vector evaluate(const Vector& x) override {
    if (w_.sides_.stopped()) return not_finite(x.size());  // what the scheme tries next is of no use
    return w_.options_.composition == Composition::parallel ? evaluate_parallel(*this, x, load_rows())
                                                            : evaluate_serial(*this, x);
  }
  /// Bodies: loads at the samples to motions at the samples.
  Vector first(const Vector& loads) override {
    restore(Run::bodies);
    use_loads(loads);
    Vector motions(samples() * w_.motion_rows());
    for (int s = 1; s <= samples(); ++s)
      if (w_.sides_.move(state_, tick(s)))
        put_motion(s, motions);
      else
        return not_finite(motions.size());
    end_motion_ = part(motions, samples(), w_.motion_rows());
    return motions;
  }
  /// Rotor: motions to loads.
  Vector second(const Vector& motions) override {
    restore(Run::air);
    Vector loads(load_rows());
    for (int s = 1; s <= samples(); ++s)
      if (!put_load(s, w_.sides_.air_load(w_.time(tick(s)), dt(), part(motions, s, w_.motion_rows())), loads))
        return not_finite(loads.size());
    end_load_ = part(loads, samples(), RotorInterface::load_rows);
    return loads;
  }
  /// Both at once, sample by sample.
  std::pair<Vector, Vector> both(const Vector& given_loads, const Vector& given_motions) {
    restore(Run::both);
    use_loads(given_loads);
    Vector motions(samples() * w_.motion_rows()), loads(load_rows());
    for (int s = 1; s <= samples(); ++s) {
      const auto [moved, load] = w_.sides_.move_beside_air(state_, tick(s), w_.time(tick(s)), dt(),
                                                           [&] { return part(given_motions, s, w_.motion_rows()); });
      if (!put_load(s, load, loads) || !moved) return {not_finite(motions.size()), not_finite(loads.size())};
      put_motion(s, motions);
    }
    end_motion_ = part(motions, samples(), w_.motion_rows()), end_load_ = part(loads, samples(), RotorInterface::load_rows);
    return {motions, loads};
  }
  Vector guess() const {
    const bool both = w_.options_.composition == Composition::parallel;
    Vector x(load_rows() + (both ? samples() * w_.motion_rows() : 0));
    for (int s = 1; s <= samples(); ++s) {
      x.segment((s - 1) * RotorInterface::load_rows, RotorInterface::load_rows) = w_.loads_.at(w_.time(tick(s)));
      if (both) x.segment(load_rows() + (s - 1) * w_.motion_rows(), w_.motion_rows()) = w_.motions_.at(w_.time(tick(s)));
    }
    return x;
  }
  void accept() {
    start_ = state_;
    save_start();
    const double t = w_.time(start_.tick);
    w_.loads_.add(t, end_load_), w_.motions_.add(t, end_motion_);
  }
  bool done() const { return start_.tick == end_; }
  bool halve() {
    if (length_ % (2 * samples()) != 0) return false;
    length_ /= 2;
    return true;
  }
  const bodies::BodiesState& state() const { return start_; }
  double load_size() const { return end_load_.norm(); }
  /// Of the loads alone: of motions an azimuth grows with every turn.
  double size_of(const Vector& output) const { return output.head(load_rows()).norm(); }

 private:
  void save_start() { w_.sides_.take_snapshot(AirSide::piece); }
  void restore(Run sides) {
    w_.sides_.return_to(AirSide::piece, sides);
    if (has_bodies(sides)) state_ = start_;
  }
  /// The signal through the loads at the samples.
  void use_loads(const Vector& loads) {
    std::vector<double> times{w_.time(start_.tick)};
    std::vector<Vector> values{w_.loads_.last()};
    for (int s = 1; s <= samples(); ++s)
      times.push_back(w_.time(tick(s))), values.push_back(part(loads, s, RotorInterface::load_rows));
    w_.signal_ = Waveform(w_.options_.interpolation, std::move(times), std::move(values));
    w_.use_signal(w_.signal_);
  }
  void put_motion(int s, Vector& motions) {
    const double t = w_.time(tick(s));
    const Vector turned = RotorInterface::turned(w_.motions_.last(), t - w_.time(start_.tick));
    motions.segment((s - 1) * w_.motion_rows(), w_.motion_rows()) =
        w_.sides_.interface->motion(t, state_, RotorInterface::azimuth(turned));
  }
  bool put_load(int s, const Vector& load, Vector& loads) {
    loads.segment((s - 1) * RotorInterface::load_rows, RotorInterface::load_rows) = load;
    return load.allFinite();
  }
  double dt() const { return double(length_ / samples()) * w_.floating_.timeline().tick_s(); }
  int samples() const { return w_.options_.samples; }
  Eigen::Index load_rows() const { return samples() * RotorInterface::load_rows; }
  std::int64_t tick(int sample) const { return start_.tick + sample * (length_ / samples()); }
  static Vector part(const Vector& all, int sample, Eigen::Index rows) { return all.segment((sample - 1) * rows, rows); }

  CoupledWindow& w_;
  bodies::BodiesState start_, state_;  ///< snapshot; of the last evaluation
  std::int64_t length_, end_;          ///< ticks of a piece; last tick of the window
  Vector end_load_, end_motion_;
};

WindowReport CoupledWindow::advance_strong(bodies::BodiesState& state) {
  const std::vector<double> before = history();
  Pieces pieces(*this, state);
  IterationLimits limits;
  limits.relative = 0.0;
  limits.of_output = options_.tolerance;  // loads may begin from nothing
  limits.absolute = options_.tolerance * std::max(pieces.guess().head(RotorInterface::load_rows).norm(), loads_.last().norm());
  limits.max_evaluations = options_.max_evaluations, limits.max_cuts = options_.max_cuts;
  limits.fallback_relaxation = 0.1 * options_.relaxation;
  WindowReport report;
  report.log = solve_window(pieces, *strong_, limits);
  const double load = pieces.load_size();
  report.mismatch = load > 0.0 ? report.log.residual / load : report.log.residual;
  if (report.log.ok()) {
    state = pieces.state();
  } else {
    report.failure = describe(report.log, state);
    restore(before);
  }
  return report;
}

std::string CoupledWindow::describe(const WindowLog& log, const bodies::BodiesState& state) const {
  const double begin = time(state.tick), window = floating_.timeline().window_s();
  if (log.bound == Bound::not_finite && !sides_.trouble().empty()) return sides_.trouble();
  if (log.bound == Bound::not_finite)
    return fmt::format("t = {:g} s: the rotor's load over the window of {:g} s is not a finite number", begin, window);
  return fmt::format(
      "t = {:g} s: rotor and bodies do not agree over the window of {:g} s: {} hit after {} evaluations, {} retries and {} cuts "
      "(residual {:.3g} of "
      "{:.3g} at first); try a smaller coupling.relaxation (now {:g}), another coupling.scheme or a shorter time.window_s",
      begin, window, bound_name(log.bound), log.evaluations, log.retries, log.cuts, log.residual, log.first_residual,
      options_.relaxation);
}

void CoupledWindow::visit(auto& v) {
  if (loose_) loose_->visit(v);
  if (strong_) loads_.visit(v), motions_.visit(v), signal_.visit(v), strong_->visit(v);
}

std::vector<double> CoupledWindow::history() {
  std::vector<double> values;
  Saver saver{values};
  visit(saver);
  return values;
}

bool CoupledWindow::restore(std::span<const double> values) {
  Loader loader{values};
  visit(loader);
  if (loose_) use_signal(loose_->load());
  if (strong_) use_signal(signal_);
  return loader.intact && loader.in.empty();
}

void CoupledWindow::declare(io::History& history) {
  air_column_ = history.columns().size();
  for (const io::Column& column : sides_.air().columns()) history.add(column);
  if (!sides_.interface) return;
  columns_.emplace(history, "coupling.", window_columns());
  if (strong_) strong_columns_.emplace(history, "coupling.", strong_columns());
}

void CoupledWindow::put(std::span<double> row) const {
  const std::vector<double> air = sides_.air().values();
  std::copy(air.begin(), air.end(), row.begin() + std::ptrdiff_t(air_column_));
  if (columns_) columns_->fill(row, last_);
  if (strong_columns_) strong_columns_->fill(row, last_);
}

}  // namespace spindrift::coupling
