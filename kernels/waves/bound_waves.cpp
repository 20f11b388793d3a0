// Sums over the pairs of a sea: see bound_waves.hpp. SPDX-License-Identifier: Apache-2.0
#include "kernels/waves/bound_waves.hpp"

#include <algorithm>

namespace spindrift::waves {

namespace {

/// exp(-18), what is left out for good; exp(-36), what depth may leave out from place to place; exp(600) is the most.
constexpr double small = 18.0, nothing = 36.0, largest = 600.0;

}  // namespace

BoundWaves::BoundWaves(std::span<const Component> sea, double depth, double gravity) : count_(sea.size()), depth_(depth) {
  if (sea.empty()) return;
  std::vector<Component> all(sea.begin(), sea.end());
  std::ranges::stable_sort(all, {}, &Component::angular_frequency);
  cos_b_ = std::cos(all[0].direction), sin_b_ = std::sin(all[0].direction);
  const std::size_t groups = (count_ + lanes - 1) / lanes;
  k_.assign(groups, Lanes{}), omega_.assign(groups, Lanes{}), phase_.assign(groups, Lanes{});
  for (std::size_t i = 0; i < count_; ++i) {
    k_[i / lanes].v[int(i % lanes)] = all[i].wave_number;
    omega_[i / lanes].v[int(i % lanes)] = all[i].angular_frequency;
    phase_[i / lanes].v[int(i % lanes)] = all[i].phase;
    numbers_.push_back(all[i].wave_number), rates_.push_back(all[i].angular_frequency);
  }
  for (std::size_t g = 0; g < groups; ++g) {
    start_.push_back(heights_.size());
    const double lowest = all[g * lanes].wave_number;
    const auto until = [&](double limit) {  // columns whose wave number is below it
      return std::min(columns(g), std::size_t(std::ranges::lower_bound(numbers_, limit) - numbers_.begin()));
    };
    none_.push_back(0), all_.push_back(columns(g));
    near_.push_back(until(lowest - small / depth));
    // The potential at the sum is that of the longer wave's shallowness, 1/tanh kh - 1.
    sum_up_.push_back(until(0.5 * small / depth));
    sum_down_.push_back(std::min(sum_up_.back(), until(small / depth - lowest)));
    for (std::size_t n = 0; n < columns(g); ++n) {
      Height height{};
      Flow fast{}, slow{};
      for (std::size_t lane = 0; lane < lanes && g * lanes + lane < count_; ++lane) {
        const std::size_t m = g * lanes + lane;
        if (n > m) continue;
        const double amplitudes = (n < m ? 2.0 : 1.0) * all[m].amplitude * all[n].amplitude;
        const auto flow = [&](BoundAt at, Flow& to, double sign) {
          const BoundPair pair = bound_pair(all[m], all[n], at, depth, gravity);
          const double k = all[m].wave_number + sign * all[n].wave_number, omega = rates_[m] + sign * rates_[n];
          const double potential = amplitudes * pair.potential / (1.0 + std::exp(-2.0 * k * depth));
          to.speed.v[int(lane)] = potential * k, to.pressure.v[int(lane)] = potential * omega;
          return amplitudes * pair.elevation;
        };
        const double at_sum = flow(BoundAt::sum, fast, 1.0), at_difference = flow(BoundAt::difference, slow, -1.0);
        height.cosines.v[int(lane)] = at_difference + at_sum, height.sines.v[int(lane)] = at_difference - at_sum;
      }
      heights_.push_back(height), sums_.push_back(fast), differences_.push_back(slow);
    }
  }
}

void BoundWaves::phases(double t, double x, double y, Row& sine, Row& cosine) const {
  const double along = cos_b_ * x + sin_b_ * y;
  for (std::size_t g = 0; g < k_.size(); ++g) lane_sincos(Lanes(k_[g] * along - omega_[g] * t + phase_[g]), sine[g], cosine[g]);
}

// cos(a + b) and cos(a - b) are cos a cos b -+ sin a sin b: both sums at once by the sum and the difference of their weights.
Surface BoundWaves::surface(double t, double x, double y) const {
  Row sine, cosine;
  phases(t, x, y, sine, cosine);
  std::array<std::array<double, 4>, most> column;
  for (std::size_t n = 0; n < count_; ++n) {
    const double c = cosine[n / lanes][int(n % lanes)], s = sine[n / lanes][int(n % lanes)];
    column[n] = {c, s, numbers_[n] * c, numbers_[n] * s};
  }
  Lanes eta{}, slope{};
  for (std::size_t g = 0; g < k_.size(); ++g) {
    Lanes c{}, s{}, kc{}, ks{};
    const Height* row = &heights_[start_[g]];
    for (std::size_t n = 0; n < columns(g); ++n) {
      c += row[n].cosines * column[n][0], s += row[n].sines * column[n][1];
      kc += row[n].sines * column[n][2], ks += row[n].cosines * column[n][3];
    }
    eta += cosine[g] * c + sine[g] * s;
    slope += k_[g] * Lanes(cosine[g] * s - sine[g] * c) + Lanes(sine[g] * kc - cosine[g] * ks);
  }
  const double along = sum(slope);
  return {sum(eta), along * cos_b_, along * sin_b_};
}

/// With X = e^(i psi - k reach) of the rows and Y = e^(i psi -+ k reach) of the columns (of differences its conjugate).
void BoundWaves::add(Part& part, double vertical, const Row& sine, const Row& cosine, std::span<const Flow> flows, BoundAt at,
                     double reach, std::span<const std::size_t> first, std::span<const std::size_t> last) const {
  std::array<std::array<double, 4>, most> column;
  const auto decay = [&](const Lanes& k, double by) {
    return select(Lanes(k * std::abs(by)) < Lanes(largest), exp(Lanes(k * by)), Lanes(0.0));
  };
  const double sign = at == BoundAt::sum ? 1.0 : -1.0;
  for (std::size_t g = 0; g < k_.size(); ++g) {
    const Lanes size = decay(k_[g], -sign * reach), re = cosine[g] * size, im = sine[g] * Lanes(size * sign);
    const Lanes rate = omega_[g] * sign, re_rate = re * rate, im_rate = im * rate;
    for (int lane = 0; lane < lanes; ++lane)
      column[g * lanes + std::size_t(lane)] = {re[lane], im[lane], re_rate[lane], im_rate[lane]};
  }
  for (std::size_t g = 0; g < k_.size(); ++g) {
    const double lowest = k_[g][0];
    if (lowest * reach > largest) break;
    std::size_t n = first[g];
    if (at == BoundAt::difference)
      while (n < last[g] && (lowest - numbers_[n]) * reach > nothing) ++n;
    Lanes re{}, im{}, re_rate{}, im_rate{}, p_re{}, p_im{};
    const Flow* row = &flows[start_[g]];
    for (; n < last[g]; ++n) {
      const auto& [c, s, dc, ds] = column[n];
      re += row[n].speed * c, im += row[n].speed * s;
      re_rate += row[n].speed * dc, im_rate += row[n].speed * ds;
      p_re += row[n].pressure * c, p_im += row[n].pressure * s;
    }
    re_rate += omega_[g] * re, im_rate += omega_[g] * im;
    const Lanes size = decay(k_[g], -reach), x = cosine[g] * size, y = sine[g] * size;
    part.u += x * re - y * im, part.w += Lanes(x * im + y * re) * vertical;
    part.ax += x * im_rate + y * re_rate, part.az += Lanes(y * im_rate - x * re_rate) * vertical;
    part.p += x * p_re - y * p_im;
  }
}

Kinematics BoundWaves::kinematics(double t, double x, double y, double z) const {
  Row sine, cosine;
  phases(t, x, y, sine, cosine);
  Part part;
  const double over_bed = z + 2.0 * depth_;  // of the images below the bed
  add(part, 1.0, sine, cosine, differences_, BoundAt::difference, -z, none_, all_);
  add(part, -1.0, sine, cosine, differences_, BoundAt::difference, over_bed, near_, all_);
  add(part, 1.0, sine, cosine, sums_, BoundAt::sum, -z, none_, sum_up_);
  add(part, -1.0, sine, cosine, sums_, BoundAt::sum, over_bed, none_, sum_down_);
  const double u = sum(part.u), a = sum(part.ax);
  return {{u * cos_b_, u * sin_b_, sum(part.w)}, {a * cos_b_, a * sin_b_, sum(part.az)}, sum(part.p)};
}

}  // namespace spindrift::waves
