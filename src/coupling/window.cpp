// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/window.hpp"

#include <fmt/format.h>

#include <limits>

namespace spindrift::coupling {

namespace {

Staggering staggering(const CouplingOptions& o) {
  if (o.scheme == SchemeKind::cps) return Staggering::cps();
  return o.scheme == SchemeKind::cps2 ? Staggering::cps2() : Staggering::css(o.predictor_order);
}

Vector not_finite(Eigen::Index rows) { return Vector::Constant(rows, std::numeric_limits<double>::quiet_NaN()); }

}  // namespace

CoupledWindow::AnyScheme CoupledWindow::make_scheme(const CouplingOptions& o) {
  const LearningOptions learning{o.reuse_windows, o.filter};
  switch (o.scheme) {
    case SchemeKind::aitken: return RelaxationAitken(o.relaxation);
    case SchemeKind::steepest_descent: return RelaxationSteepestDescent(o.relaxation);
    case SchemeKind::iqn_ils: return IqnIls(o.relaxation, learning);
    case SchemeKind::ibqn_ls: return IbqnLs(o.relaxation, learning);
    case SchemeKind::interface_gmres: return InterfaceGmres(o.relaxation, learning);
    case SchemeKind::newton: return Newton(1e-9);
    default: return RelaxationConstant(o.relaxation);
  }
}

CoupledWindow::CoupledWindow(Machine& machine)
    : machine_(machine), options_(machine.scenario().coupling), interface_(machine), loads_(options_.predictor_order), motions_(1),
      load_now_(RotorInterface::load_rows) {
  if (is_loose(options_.scheme))
    loose_.emplace(staggering(options_));
  else
    strong_.emplace(make_scheme(options_));
  machine_.replace_rotor_loads([this](double t, std::span<const Motion> bodies, std::span<Wrench> wrenches) {
    felt_(t, load_now_);
    interface_.add_load(load_now_, bodies, wrenches);
  });
}

CoupledWindow::~CoupledWindow() { machine_.replace_rotor_loads({}); }

template <class Signal>
void CoupledWindow::feel(const Signal& signal) {
  felt_ = [&signal](double t, Vector& out) { signal.at(t, out); };
}

void CoupledWindow::begin(const bodies::BodiesState& state) {
  const double t = time(state.tick);
  const Vector motion = interface_.motion(t, state.motions, 0.0), load = interface_.load(t, motion);
  if (loose_) {
    loose_->begin(t, motion, load);
    feel(loose_->load());
  } else {
    motions_.add(t, motion), loads_.add(t, load);
    signal_ = Waveform(options_.interpolation, {t}, {load});
    feel(signal_);
  }
}

bool CoupledWindow::move(bodies::BodiesState& state, std::int64_t end) {
  while (state.tick < end) {
    trouble_ = machine_.system().advance(state, machine_.timeline().tick_s(), 1);
    ++totals_.body_steps;
    if (!trouble_.ok()) {
      trouble_state_ = state;
      return false;
    }
  }
  return true;
}

WindowReport CoupledWindow::advance(bodies::BodiesState& state) {
  trouble_ = {};
  last_ = loose_ ? advance_loose(state) : advance_strong(state);
  ++totals_.windows;
  totals_.evaluations += last_.log.evaluations, totals_.probes += last_.log.probes;
  totals_.retries += last_.log.retries, totals_.cuts += last_.log.cuts;
  return last_;
}

WindowReport CoupledWindow::advance_loose(bodies::BodiesState& state) {
  struct Parts {
    CoupledWindow& w;
    bodies::BodiesState state;
    std::int64_t end;
    Vector start;  // motion at the window's start
    Vector move(const Extrapolation& load, double begin, double end_s) {
      w.feel(load);
      if (!w.move(state, end)) return not_finite(RotorInterface::motion_rows);
      const double near = RotorInterface::azimuth(start) + (end_s - begin) * RotorInterface::rate(start);
      return w.interface_.motion(end_s, state.motions, near);
    }
    Vector load(const Waveform& motion, double begin, double end_s) {
      ++w.totals_.rotor_calls;
      const Vector given = motion.at(end_s);
      // Motion may be held, the rotor turns on.
      const bool held = w.options_.scheme == SchemeKind::cps;
      return w.interface_.load(end_s, held ? RotorInterface::turned(given, end_s - begin) : given);
    }
  };
  const std::int64_t end = state.tick + machine_.timeline().steps_per_window();
  Parts parts{*this, state, end, loose_->motion().last()};
  WindowReport report;
  report.log.evaluations = 1;
  if (!loose_->advance(parts, time(state.tick), time(end))) {
    report.log.bound = Bound::not_finite;
    report.failure = describe(report.log, state);
    return report;
  }
  state = std::move(parts.state);
  report.log.residual = report.log.first_residual = loose_->mismatch().norm();
  const double load = loose_->load().last().norm();
  report.mismatch = load > 0.0 ? report.log.residual / load : report.log.residual;
  return report;
}

/// The strong window, or the piece of it that is next. x holds the loads at the samples; composed in parallel, the motions as well.
class CoupledWindow::Pieces {
 public:
  Pieces(CoupledWindow& window, const bodies::BodiesState& start)
      : w_(window), start_(start), length_(window.machine_.timeline().steps_per_window()), end_(start.tick + length_) {}

  Vector evaluate(const Vector& x) {
    return w_.options_.composition == Composition::parallel ? parallel_answer(*this, x, load_rows()) : serial_answer(*this, x);
  }
  /// Bodies: loads at the samples to motions at the samples.
  Vector first(const Vector& loads) {
    state_ = start_;
    std::vector<double> times{w_.time(start_.tick)};
    std::vector<Vector> values{w_.loads_.last()};
    for (int s = 1; s <= samples(); ++s) times.push_back(w_.time(tick(s))), values.push_back(part(loads, s, RotorInterface::load_rows));
    w_.signal_ = Waveform(w_.options_.interpolation, std::move(times), std::move(values));
    w_.feel(w_.signal_);
    Vector motions(samples() * RotorInterface::motion_rows);
    for (int s = 1; s <= samples(); ++s) {
      if (!w_.move(state_, tick(s))) return not_finite(motions.size());
      const double t = w_.time(tick(s));
      const Vector turned = RotorInterface::turned(w_.motions_.last(), t - w_.time(start_.tick));
      motions.segment((s - 1) * RotorInterface::motion_rows, RotorInterface::motion_rows) =
          w_.interface_.motion(t, state_.motions, RotorInterface::azimuth(turned));
    }
    end_motion_ = part(motions, samples(), RotorInterface::motion_rows);
    return motions;
  }
  /// Rotor: motions to loads.
  Vector second(const Vector& motions) {
    Vector loads(load_rows());
    for (int s = 1; s <= samples(); ++s) {
      ++w_.totals_.rotor_calls;
      loads.segment((s - 1) * RotorInterface::load_rows, RotorInterface::load_rows) =
          w_.interface_.load(w_.time(tick(s)), part(motions, s, RotorInterface::motion_rows));
    }
    end_load_ = part(loads, samples(), RotorInterface::load_rows);
    return loads;
  }
  Vector guess() const {
    const bool both = w_.options_.composition == Composition::parallel;
    Vector x(load_rows() + (both ? samples() * RotorInterface::motion_rows : 0));
    for (int s = 1; s <= samples(); ++s) {
      x.segment((s - 1) * RotorInterface::load_rows, RotorInterface::load_rows) = w_.loads_.at(w_.time(tick(s)));
      if (both)
        x.segment(load_rows() + (s - 1) * RotorInterface::motion_rows, RotorInterface::motion_rows) = w_.motions_.at(w_.time(tick(s)));
    }
    return x;
  }
  void accept() {
    start_ = state_;
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

 private:
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
  limits.absolute = options_.tolerance * std::max(pieces.guess().head(RotorInterface::load_rows).norm(), loads_.last().norm());
  limits.max_evaluations = options_.max_evaluations, limits.max_cuts = options_.max_cuts;
  limits.fallback_relaxation = 0.1 * options_.relaxation;
  WindowReport report;
  report.log = std::visit([&](auto& scheme) { return solve_window(pieces, scheme, limits); }, *strong_);
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
  const double begin = time(state.tick), window = machine_.timeline().window_s();
  if (log.bound == Bound::not_finite && !trouble_.ok())
    return machine_.system().failure(trouble_, trouble_state_, machine_.timeline().tick_s()).what();
  if (log.bound == Bound::not_finite) return fmt::format("t = {:g} s: the rotor's load over the window of {:g} s is not a finite number", begin, window);
  return fmt::format(
      "t = {:g} s: rotor and bodies do not agree over the window of {:g} s: {} hit after {} evaluations, {} retries and {} cuts (residual {:.3g} of "
      "{:.3g} at first); try a smaller coupling.relaxation (now {:g}), another coupling.scheme or a shorter time.window_s",
      begin, window, bound_name(log.bound), log.evaluations, log.retries, log.cuts, log.residual, log.first_residual, options_.relaxation);
}

void CoupledWindow::visit(auto& v) {
  if (loose_)
    loose_->visit(v);
  else
    loads_.visit(v), motions_.visit(v), signal_.visit(v), std::visit([&v](auto& scheme) { scheme.visit(v); }, *strong_);
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
  if (loose_)
    feel(loose_->load());
  else
    feel(signal_);
  return loader.intact && loader.in.empty();
}

void CoupledWindow::declare(io::History& history) {
  column_ = history.add({"coupling.evaluations", "-", "of the window by the scheme, probes included"});
  history.add({"coupling.mismatch", "-", "loads that went in and came out, their difference over them"});
  if (loose_) return;
  history.add({"coupling.columns", "-", "differences the scheme keeps"});
  history.add({"coupling.cuts", "-", "halvings of the window"});
  history.add({"coupling.retries", "-", "attempts after clearing and relaxing"});
}

void CoupledWindow::put(std::span<double> row) const {
  row[column_] = last_.log.evaluations, row[column_ + 1] = last_.mismatch;
  if (loose_) return;
  row[column_ + 2] = last_.log.columns, row[column_ + 3] = last_.log.cuts, row[column_ + 4] = last_.log.retries;
}

}  // namespace spindrift::coupling
