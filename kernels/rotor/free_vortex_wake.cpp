// SPDX-License-Identifier: Apache-2.0
#include "kernels/rotor/free_vortex_wake.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "kernels/linear/dense.hpp"
#include "kernels/rotor/vortex_filament.hpp"

namespace spindrift {

using Eigen::Vector3d;

namespace {

constexpr double near_turns = 0.25;  // with all filaments
constexpr double least_wind = 1.0;   // m/s; without wind and at rest a step of the wake would have no end
// Of tips and wind: turns of a wake that begins are then an eighth of the diameter apart.
constexpr double most_speed_ratio = 25.0;

/// Of a row of rings, the circulation that is farthest from zero.
double strongest(std::span<const double> row) {
  double most = 0.0;
  for (double c : row)
    if (std::abs(c) > std::abs(most)) most = c;
  return most;
}

}  // namespace

FreeVortexWake::FreeVortexWake(const Options& options, std::span<const double> chords, int blades, double radius)
    : options_(options),
      chords_(chords.begin(), chords.end()),
      blades_(std::size_t(blades)),
      near_rows_(std::size_t(std::lround(near_turns * 2.0 * pi / options.step))),
      far_rows_(std::size_t(std::lround(options.turns * 2.0 * pi / options.step)) - near_rows_),
      radius_(radius) {
  for (double chord : chords_) mean_chord_ += chord / double(chords_.size());
}

FreeVortexWake::State FreeVortexWake::sized() const {
  State s;
  s.age.resize(near_rows_ + far_rows_ + 1);
  s.near.resize(blades_ * (near_rows_ + 1) * (sections() + 1)), s.near_was.resize(s.near.size());
  s.far.resize(blades_ * (far_rows_ + 1) * 2), s.far_was.resize(s.far.size());
  s.rings.resize(blades_ * near_rows_ * sections()), s.pairs.resize(blades_ * far_rows_);
  return s;
}

/// Each as a span of numbers.
template <class Visit>
void FreeVortexWake::for_each_part(State& s, const Visit& visit) {
  for (auto* numbers : {&s.age, &s.rings, &s.pairs}) visit(std::span(*numbers));
  for (auto* vectors : {&s.near, &s.near_was, &s.far, &s.far_was})
    visit(std::span(vectors->front().data(), 3 * vectors->size()));  // Vector3d: three numbers without padding
}

std::size_t FreeVortexWake::memory_size() const {
  std::size_t size = header_size;
  State s = sized();
  for_each_part(s, [&](std::span<const double> part) { size += part.size(); });
  return size;
}

FreeVortexWake::State FreeVortexWake::load(std::span<const double> memory) const {
  State s = sized();
  s.last_step = memory[last_step];
  std::size_t at = header_size;
  for_each_part(s, [&](std::span<double> part) {
    std::ranges::copy(memory.subspan(at, part.size()), part.begin());
    at += part.size();
  });
  return s;
}

void FreeVortexWake::save(State& s, std::span<double> memory) const {
  memory[last_step] = s.last_step;
  std::size_t at = header_size;
  for_each_part(s, [&](std::span<const double> part) {
    std::ranges::copy(part, memory.begin() + std::ptrdiff_t(at));
    at += part.size();
  });
}

double FreeVortexWake::end_chord(std::size_t end) const {
  return 0.5 * (chords_[end > 0 ? end - 1 : 0] + chords_[std::min(end, sections() - 1)]);
}

double FreeVortexWake::core(double chord, double age, double circulation) const {
  return core_radius(options_.core_chords * chord, age, circulation, options_.viscosity);
}

template <class Value>
void FreeVortexWake::gather(std::span<const double> row, const Value* values, Value& at_root, Value& at_tip) const {
  const double sign = strongest(row) < 0.0 ? -1.0 : 1.0;
  const auto top =
      std::size_t(std::ranges::max_element(row, [&](double a, double b) { return sign * a < sign * b; }) - row.begin());
  Value sums[2] = {0.0 * values[0], 0.0 * values[0]};
  double weights[2] = {0.0, 0.0};
  for (std::size_t end = 0; end <= sections(); ++end) {
    const double in = end > 0 ? row[end - 1] : 0.0, out = end < sections() ? row[end] : 0.0;
    const Side side = end > top ? tip : root;
    const double weight = std::max(sign * (side == tip ? in - out : out - in), 0.0);
    sums[side] += weight * values[end], weights[side] += weight;
  }
  at_root = weights[root] > 0.0 ? Value(sums[root] / weights[root]) : values[0];
  at_tip = weights[tip] > 0.0 ? Value(sums[tip] / weights[tip]) : values[sections()];
}

/// The lattice's last line as a line of the two filaments.
void FreeVortexWake::gather_last_line(State& s, std::size_t blade, std::size_t far_line) const {
  const std::span<const double> row = std::span(s.rings).subspan(ring_at(blade, near_rows_ - 1, 0), sections());
  const std::size_t from = near_at(blade, near_rows_, 0);
  gather(row, &s.near[from], s.far[far_at(blade, far_line, root)], s.far[far_at(blade, far_line, tip)]);
  gather(row, &s.near_was[from], s.far_was[far_at(blade, far_line, root)], s.far_was[far_at(blade, far_line, tip)]);
}

VortexFilaments FreeVortexWake::filaments(const State& s, double sense) const {
  VortexFilaments all;
  const auto extend = [&](const Vector3d& to, double circulation, double radius) { all.extend(to, sense * circulation, radius); };
  for (std::size_t b = 0; b < blades_; ++b) {
    std::vector<double> most(near_rows_);
    for (std::size_t row = 0; row < near_rows_; ++row)
      most[row] = strongest(std::span(s.rings).subspan(ring_at(b, row, 0), sections()));
    // Trailed.
    for (std::size_t end = 0; end <= sections(); ++end) {
      all.begin(s.near[near_at(b, 0, end)]);
      for (std::size_t row = 0; row < near_rows_; ++row) {
        const double in = end > 0 ? s.rings[ring_at(b, row, end - 1)] : 0.0;
        const double out = end < sections() ? s.rings[ring_at(b, row, end)] : 0.0;
        extend(s.near[near_at(b, row + 1, end)], in - out, core(end_chord(end), s.age[row + 1], most[row]));
      }
    }
    // Bound, shed, and what closes the last rings.
    for (std::size_t line = 0; line <= near_rows_; ++line) {
      all.begin(s.near[near_at(b, line, 0)]);
      for (std::size_t j = 0; j < sections(); ++j) {
        const double newer = line > 0 ? s.rings[ring_at(b, line - 1, j)] : 0.0;
        const double older = line < near_rows_ ? s.rings[ring_at(b, line, j)] : 0.0;
        extend(s.near[near_at(b, line, j + 1)], older - newer,
               core(chords_[j], s.age[line], most[std::min(line, near_rows_ - 1)]));
      }
    }
    // The root's filament back to the lattice, across it, and the tip's.
    all.begin(s.far[far_at(b, far_rows_, root)]);
    const auto far_core = [&](std::size_t line, double circulation) {
      return core(mean_chord_, s.age[near_rows_ + line], circulation);
    };
    for (std::size_t row = far_rows_; row-- > 0;) {
      const double circulation = s.pairs[b * far_rows_ + row];
      extend(s.far[far_at(b, row, root)], circulation, far_core(row + 1, circulation));
    }
    const double first = s.pairs[b * far_rows_];
    extend(s.far[far_at(b, 0, tip)], first, far_core(0, first));
    for (std::size_t row = 0; row < far_rows_; ++row) {
      const double circulation = s.pairs[b * far_rows_ + row];
      extend(s.far[far_at(b, row + 1, tip)], circulation, far_core(row + 1, circulation));
    }
  }
  return all;
}

/// As the filaments would go on: with the vortex moment per length of their older half. (Of the last turn alone, where velocities
/// are least exact, it fed on itself.)
VortexTail FreeVortexWake::tail(const State& s, double sense) const {
  const std::size_t first = far_rows_ / 2;
  Vector3d from = Vector3d::Zero(), to = Vector3d::Zero(), moment = Vector3d::Zero();
  for (std::size_t b = 0; b < blades_; ++b)
    from += s.far[far_at(b, first, tip)] / double(blades_), to += s.far[far_at(b, far_rows_, tip)] / double(blades_);
  const Vector3d middle = 0.5 * (from + to);
  for (std::size_t b = 0; b < blades_; ++b)
    for (std::size_t row = first; row < far_rows_; ++row) {
      const auto swept = [&](Side side) {
        const Vector3d &a = s.far[far_at(b, row, side)], &e = s.far[far_at(b, row + 1, side)];
        return Vector3d(0.5 * (a - middle).cross(e - a));
      };
      moment += sense * s.pairs[b * far_rows_ + row] * (swept(tip) - swept(root));
    }
  const double length = (to - from).norm();
  const double flux = length > 0.0 ? moment.dot(to - from) / (length * length) : 0.0;
  return {to, radius_, flux};
}

void FreeVortexWake::add_velocities(const State& s, double sense, std::span<const Vector3d> points,
                                    std::span<Vector3d> velocities) const {
  filaments(s, sense).add_velocities(points, velocities);
  const VortexTail beyond = tail(s, sense);
  for (std::size_t i = 0; i < points.size(); ++i) velocities[i] += beyond.velocity(points[i]);
}

void FreeVortexWake::add_velocities(std::span<const double> memory, double sense, std::span<const Vector3d> points,
                                    std::span<Vector3d> velocities) const {
  add_velocities(load(memory), sense, points, velocities);
}

/// Of the filaments on themselves, at the inner ends of their segments; far: as `State::far`.
void FreeVortexWake::add_self_induction(const State& s, double sense, std::span<Vector3d> far) const {
  std::vector<Vector3d> ends(far_rows_ + 1);
  std::vector<double> circulations(far_rows_), cores(far_rows_);
  for (std::size_t b = 0; b < blades_; ++b)
    for (const Side side : {root, tip}) {
      for (std::size_t line = 0; line <= far_rows_; ++line) ends[line] = s.far[far_at(b, line, side)];
      for (std::size_t row = 0; row < far_rows_; ++row) {  // the tip's goes from the blade on, the root's comes back to it
        const double pair = s.pairs[b * far_rows_ + row];
        circulations[row] = (side == tip ? sense : -sense) * pair,
        cores[row] = core(mean_chord_, s.age[near_rows_ + row + 1], pair);
      }
      for (std::size_t line = 1; line < far_rows_; ++line)
        far[far_at(b, line, side)] += self_induction({ends, circulations, cores}, line);
    }
}

/// By the second-order step of Adams and Bashforth.
void FreeVortexWake::convect(State& s, double sense, const Air& air, double h) const {
  std::vector<Vector3d> points = s.near, velocities;
  points.insert(points.end(), s.far.begin(), s.far.end());
  for (const Vector3d& p : points) velocities.push_back(air(p));
  add_velocities(s, sense, points, velocities);
  add_self_induction(s, sense, std::span(velocities).subspan(s.near.size()));
  const double back = s.last_step > 0.0 ? 0.5 * h / s.last_step : 0.0;
  const std::size_t line_size = sections() + 1;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool is_near = i < s.near.size();
    const bool is_new = is_near && i / line_size % (near_rows_ + 1) == 0;  // on the blade until now
    Vector3d& at = is_near ? s.near[i] : s.far[i - s.near.size()];
    Vector3d& was = is_near ? s.near_was[i] : s.far_was[i - s.near.size()];
    at += h * (velocities[i] + (is_new ? 0.0 : back) * (velocities[i] - was));
    was = velocities[i];
  }
  s.last_step = h;
}

/// Every line becomes the next older one; a new one lies on the blades.
void FreeVortexWake::shift(State& s, const LiftingLines& blades, double h) const {
  for (std::size_t b = 0; b < blades_; ++b) {
    const auto move = [](auto& of, std::size_t begin, std::size_t end, std::size_t by) {
      std::copy_backward(of.begin() + std::ptrdiff_t(begin), of.begin() + std::ptrdiff_t(end - by),
                         of.begin() + std::ptrdiff_t(end));
    };
    for (auto* of : {&s.far, &s.far_was}) move(*of, far_at(b, 0, root), far_at(b + 1, 0, root), 2);
    gather_last_line(s, b, 1);
    move(s.pairs, b * far_rows_, (b + 1) * far_rows_, 1);
    s.pairs[b * far_rows_] = strongest(std::span(s.rings).subspan(ring_at(b, near_rows_ - 1, 0), sections()));
    for (auto* of : {&s.near, &s.near_was}) move(*of, near_at(b, 0, 0), near_at(b + 1, 0, 0), sections() + 1);
    move(s.rings, ring_at(b, 0, 0), ring_at(b + 1, 0, 0), sections());
    gather_last_line(s, b, 0);
    std::copy_n(blades.ends.begin() + std::ptrdiff_t(b * (sections() + 1)), sections() + 1,
                s.near.begin() + std::ptrdiff_t(near_at(b, 0, 0)));
  }
  std::copy_backward(s.age.begin(), s.age.end() - 1, s.age.end());
  for (double& age : s.age) age += h;
  s.age.front() = 0.0;
}

bool FreeVortexWake::solve(State& s, const LiftingLines& blades, const Circulation& circulation,
                           std::span<Vector3d> induced) const {
  const std::size_t n = sections(), all = blades_ * n;
  std::vector<double> newest(all);
  for (std::size_t b = 0; b < blades_; ++b)
    for (std::size_t j = 0; j < n; ++j) std::swap(newest[b * n + j], s.rings[ring_at(b, 0, j)]);
  std::vector<Vector3d> of_wake(all, Vector3d::Zero());
  add_velocities(s, blades.sense, blades.middles, of_wake);
  // Of each ring of the newest row, with circulation one.
  std::vector<Vector3d> influence(all * all, Vector3d::Zero());
  for (std::size_t b = 0; b < blades_; ++b)
    for (std::size_t j = 0; j < n; ++j) {
      const auto end = [&](std::size_t line, std::size_t at) { return s.near[near_at(b, line, j + at)]; };
      const double most = std::abs(newest[b * n + j]);
      VortexFilaments ring;
      ring.begin(end(0, 0));
      ring.extend(end(0, 1), blades.sense, core(chords_[j], 0.0, most));
      ring.extend(end(1, 1), blades.sense, core(end_chord(j + 1), s.age[1], most));
      ring.extend(end(1, 0), blades.sense, core(chords_[j], s.age[1], most));
      ring.extend(end(0, 0), blades.sense, core(end_chord(j), s.age[1], most));
      ring.add_velocities(blades.middles, std::span(influence).subspan((b * n + j) * all, all));
    }
  // Newton's method with the matrix of each blade by itself: the newest rows of other blades are far.
  constexpr int most_passes = 60, at_ease = 15;  // from there on steps are halved, which ends a stalled section's to and fro
  constexpr double enough = 1e-9, settled = 0.01, small = 1e-3;  // of the circulation; m/s
  bool has_settled = false;
  for (int pass = 0; pass < most_passes; ++pass) {
    std::ranges::copy(of_wake, induced.begin());
    for (std::size_t from = 0; from < all; ++from)
      for (std::size_t at = 0; at < all; ++at) induced[at] += newest[from] * influence[from * all + at];
    double change = 0.0, size = 0.0;
    std::vector<double> next = newest;
    for (std::size_t b = 0; b < blades_; ++b) {
      Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(Eigen::Index(n), Eigen::Index(n));
      Eigen::VectorXd missing(n);
      for (std::size_t j = 0; j < n; ++j) {
        const std::size_t at = b * n + j;
        const double now = circulation(at, induced[at]);
        Vector3d slope;
        for (int c = 0; c < 3; ++c) slope[c] = (circulation(at, induced[at] + small * Vector3d::Unit(c)) - now) / small;
        missing[Eigen::Index(j)] = now - newest[at];
        if (slope.dot(influence[at * all + at]) > 0.0) continue;  // stalled: more circulation would make more of it
        for (std::size_t k = 0; k < n; ++k)
          matrix(Eigen::Index(j), Eigen::Index(k)) -= slope.dot(influence[(b * n + k) * all + at]);
      }
      const Eigen::VectorXd step = dense::solve(matrix, missing);
      for (std::size_t j = 0; j < n; ++j) {
        next[b * n + j] += (pass < at_ease ? 1.0 : 0.5) * step[Eigen::Index(j)];
        change = std::max(change, std::abs(step[Eigen::Index(j)])), size = std::max(size, std::abs(next[b * n + j]));
      }
    }
    newest = next;
    has_settled = change <= settled * size;
    if (change <= enough * size) break;
  }
  for (std::size_t b = 0; b < blades_; ++b)
    for (std::size_t j = 0; j < n; ++j) s.rings[ring_at(b, 0, j)] = newest[b * n + j];
  return has_settled;
}

bool FreeVortexWake::begin(const LiftingLines& blades, const Start& start, const Circulation& circulation,
                           std::span<double> memory, std::span<Vector3d> induced) const {
  State s = sized();
  s.last_step = 0.0;
  const double speed = start.omega.norm();
  // Where the wind would leave the turns on top of each other, the rotor begins in air at rest: behind it lies what has no
  // circulation.
  const bool from_rest = speed * radius_ > most_speed_ratio * start.wind.norm() && speed > 0.0;
  const Vector3d wind = from_rest ? Vector3d(speed * radius_ / most_speed_ratio * start.axis) : start.wind;
  const double along = wind.dot(start.axis), induction = from_rest ? 0.0 : start.induction;
  const std::vector<double> none(from_rest ? sections() : 0, 0.0);
  const double h = options_.step / std::hypot(speed, std::max(wind.norm(), least_wind) / radius_);
  const Vector3d turning = speed > 0.0 ? Vector3d(start.omega / speed) : start.axis;
  Vector3d carried = Vector3d::Zero();
  double widened = 1.0;
  std::vector<Vector3d> line(sections() + 1);
  for (std::size_t k = 0; k < s.age.size(); ++k) {
    s.age[k] = double(k) * h;
    const Eigen::AngleAxisd back(-speed * s.age[k], turning);
    for (std::size_t b = 0; b < blades_; ++b) {
      const std::span<const double> bound = from_rest ? none : start.circulation.subspan(b * sections(), sections());
      for (std::size_t end = 0; end <= sections(); ++end)
        line[end] = start.hub + widened * (back * (blades.ends[b * (sections() + 1) + end] - start.hub)) + carried;
      if (k <= near_rows_) std::ranges::copy(line, s.near.begin() + std::ptrdiff_t(near_at(b, k, 0)));
      if (k < near_rows_) std::ranges::copy(bound, s.rings.begin() + std::ptrdiff_t(ring_at(b, k, 0)));
      if (k < near_rows_) continue;
      const std::size_t m = k - near_rows_;
      gather(bound, line.data(), s.far[far_at(b, m, root)], s.far[far_at(b, m, tip)]);
      if (m < far_rows_) s.pairs[b * far_rows_ + m] = strongest(bound);
    }
    // A vortex cylinder that begins at the disc slows the air in it by `share`, its own sheet by half of that, and is as wide as
    // the slowed air needs.
    const double behind = carried.dot(start.axis);
    const double share = induction * (1.0 + behind / std::hypot(behind, radius_));
    carried += h * (wind - 0.5 * share * along * start.axis);
    widened = std::sqrt((1.0 - induction) / (1.0 - share));
  }
  const bool settled = solve(s, blades, circulation, induced);
  memory[travelled] = memory[since] = 0.0;
  save(s, memory);
  return settled;
}

double FreeVortexWake::due(double h, double speed, double wind, std::span<double> memory) const {
  constexpr double round_off = 1e-9;
  memory[travelled] += h * std::hypot(speed, std::max(wind, least_wind) / radius_), memory[since] += h;
  if (memory[travelled] < (1.0 - round_off) * options_.step) return 0.0;
  memory[travelled] = std::min(memory[travelled] - options_.step, options_.step);
  const double time = memory[since];
  memory[since] = 0.0;
  return time;
}

bool FreeVortexWake::advance(const LiftingLines& blades, const Air& air, double h, const Circulation& circulation,
                             std::span<double> memory, std::span<Vector3d> induced) const {
  State s = load(memory);
  convect(s, blades.sense, air, h);
  shift(s, blades, h);
  const bool settled = solve(s, blades, circulation, induced);
  save(s, memory);
  return settled;
}

}  // namespace spindrift
