// SPDX-License-Identifier: Apache-2.0
#include "src/sea/radiation.hpp"

#include <algorithm>

namespace spindrift::sea {

namespace {

// Places in the memory of a convolution, and in that of a state space.
constexpr std::size_t time_at = 0, head_at = 1, history_at = 2;
constexpr std::size_t velocity_at = 1, states_at = 7;

}  // namespace

ConvolutionMemory::ConvolutionMemory(std::vector<RetardationSeries> series, std::size_t steps, double step_s)
    : count_(steps + 1), step_(step_s) {
  for (RetardationSeries& s : series) {
    first_(s.i, s.j) = s.values[0], second_(s.i, s.j) = s.values[1];
    Pair pair{s.i, s.j, {}};
    for (double k : s.values) pair.weight.push_back(k * step_s);
    pairs_.push_back(std::move(pair));
  }
}

void ConvolutionMemory::begin(double t, const Vector6& velocity, std::span<double> memory) const {
  std::ranges::fill(memory, 0.0);  // at rest until now
  memory[time_at] = t;
  std::copy(velocity.data(), velocity.data() + 6, memory.begin() + history_at);
}

void ConvolutionMemory::recall(std::span<const double> memory) {
  time_ = memory[time_at];
  const std::size_t head = std::size_t(memory[head_at]);
  const double* history = memory.data() + history_at;
  const auto velocity = [&](std::size_t age, int mode) {
    std::size_t place = head + age;
    if (place >= count_) place -= count_;
    return history[6 * place + std::size_t(mode)];
  };
  now_.setZero(), later_.setZero();
  for (int mode = 0; mode < 6; ++mode) newest_[mode] = velocity(0, mode);
  for (const Pair& pair : pairs_) {
    // At t: trapezoidal over ages 0 ... count - 1. A step later, but for the newest interval: over ages 1 ... count - 1.
    double now = 0.5 * pair.weight[0] * velocity(0, pair.j), later = 0.0;
    for (std::size_t age = 1; age < count_; ++age) now += pair.weight[age] * velocity(age, pair.j);
    for (std::size_t age = 1; age < count_; ++age) later += pair.weight[age] * velocity(age - 1, pair.j);
    later -= 0.5 * pair.weight[1] * velocity(0, pair.j);
    now_[pair.i] += now, later_[pair.i] += later;
  }
}

void ConvolutionMemory::remember(double t, const Vector6& velocity, std::span<double> memory) const {
  // Samples are a step apart: pieces of a step are not remembered, force() bridges them.
  if (t - memory[time_at] < step_ * (1.0 - 1e-6)) return;
  const std::size_t head = memory[head_at] == 0.0 ? count_ - 1 : std::size_t(memory[head_at]) - 1;
  std::copy(velocity.data(), velocity.data() + 6, memory.begin() + std::ptrdiff_t(history_at + 6 * head));
  memory[time_at] = t, memory[head_at] = double(head);
}

Vector6 ConvolutionMemory::force(double t, const Vector6& velocity) const {
  // Between the two times of the sums in a straight line; the newest interval by the trapezoidal rule.
  const double since = std::clamp(t - time_, 0.0, step_), share = since / step_;
  Vector6 force = (1.0 - share) * now_ + share * later_;
  force += 0.5 * since * (first_ * velocity + ((1.0 - share) * first_ + share * second_) * newest_);
  return -force;
}

StateSpaceMemory::StateSpaceMemory(std::vector<Fit> fits) : fits_(std::move(fits)) {
  for (const Fit& fit : fits_) states_ += fit.poles.pole.size();
}

void StateSpaceMemory::begin(double t, const Vector6& velocity, std::span<double> memory) const {
  std::ranges::fill(memory, 0.0);  // at rest until now
  memory[time_at] = t;
  std::copy(velocity.data(), velocity.data() + 6, memory.begin() + velocity_at);
}

/// visit(fit, number of its pole, number of the state, z) with z' = p z + v at time t, where the velocity now is this.
template <class Visit>
void StateSpaceMemory::for_each_state(double t, const Vector6& velocity, const Visit& visit) const {
  const double since = std::max(t - recalled_[time_at], 0.0);
  std::size_t state = 0;
  for (const Fit& fit : fits_) {
    const double before = recalled_[velocity_at + std::size_t(fit.j)];
    for (std::size_t k = 0; k < fit.poles.pole.size(); ++k, ++state) {
      const std::complex<double> p = fit.poles.pole[k], z(recalled_[states_at + 2 * state], recalled_[states_at + 2 * state + 1]);
      visit(fit, k, state, since > 0.0 ? std::exp(p * since) * z + waves::pole_response(p, since, before, velocity[fit.j]) : z);
    }
  }
}

void StateSpaceMemory::remember(double t, const Vector6& velocity, std::span<double> memory) const {
  for_each_state(t, velocity, [&](const Fit&, std::size_t, std::size_t state, std::complex<double> z) {
    memory[states_at + 2 * state] = z.real(), memory[states_at + 2 * state + 1] = z.imag();
  });
  memory[time_at] = t;
  std::copy(velocity.data(), velocity.data() + 6, memory.begin() + velocity_at);
}

Vector6 StateSpaceMemory::force(double t, const Vector6& velocity) const {
  Vector6 force = Vector6::Zero();
  for_each_state(t, velocity, [&](const Fit& fit, std::size_t k, std::size_t, std::complex<double> z) {
    force[fit.i] -= (fit.poles.weight[k] * z).real();
  });
  return force;
}

}  // namespace spindrift::sea
