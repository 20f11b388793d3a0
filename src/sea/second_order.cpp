// SPDX-License-Identifier: Apache-2.0
#include "src/sea/second_order.hpp"

#include <cmath>

namespace spindrift::sea {

SecondOrderLoads::SecondOrderLoads(const PotentialOptions& o, const WamitScale& scale,
                                   const std::vector<waves::Component>& waves) {
  amplitude_.resize(Eigen::Index(waves.size()));
  for (std::size_t n = 0; n < waves.size(); ++n) {
    const waves::Component& w = waves[n];
    const double along = std::cos(w.direction) * o.point_m.x() + std::sin(w.direction) * o.point_m.y();
    omega_.push_back(w.angular_frequency);
    amplitude_[Eigen::Index(n)] = std::polar(w.amplitude, -(w.phase + w.wave_number * along));
  }
  eta_.resize(amplitude_.size());
  const auto covering = [&](auto file, const std::string& path) {
    require_headings(path, file.heading, waves);
    return file;
  };
  if (o.drift == "full")
    difference_ = transfers(covering(read_quadratic(o.drift_file, scale, FrequencyPair::difference), o.drift_file), true, waves);
  else if (o.drift != "none")
    take_mean(covering(read_drift(o.drift_file, scale), o.drift_file), o.drift == "newman", waves);
  if (!o.sum_frequency_file.empty())
    sum_ =
        transfers(covering(read_quadratic(o.sum_frequency_file, scale, FrequencyPair::sum), o.sum_frequency_file), false, waves);
}

void SecondOrderLoads::take_mean(const WamitDrift& drift, bool newman, const std::vector<waves::Component>& waves) {
  Eigen::Matrix<double, 6, Eigen::Dynamic> by_component(6, Eigen::Index(waves.size()));
  for (Eigen::Index n = 0; n < by_component.cols(); ++n) {
    const waves::Component& w = waves[std::size_t(n)];
    by_component.col(n) = drift.at(w.angular_frequency, w.direction);
    if (!newman) mean_ += std::norm(amplitude_[n]) * by_component.col(n);
  }
  if (newman) drift_ = by_component;
}

std::vector<SecondOrderLoads::Full> SecondOrderLoads::transfers(const WamitQuadratic& file, bool difference,
                                                                const std::vector<waves::Component>& waves) const {
  std::vector<Full> result;
  const Eigen::Index n = Eigen::Index(waves.size());
  for (int mode = 0; mode < 6; ++mode) {
    if (!file.has_mode[std::size_t(mode)]) continue;
    Full full{mode, Matrix(n, n)};
    for (Eigen::Index a = 0; a < n; ++a)
      for (Eigen::Index b = 0; b <= a; ++b) {
        const waves::Component &first = waves[std::size_t(a)], &second = waves[std::size_t(b)];
        // Half of both orders of the pair: the file's matrix is Hermitian (differences) or symmetric (sums) up to its digits.
        const std::complex<double> one = file.at(mode, first.angular_frequency, second.angular_frequency, first.direction),
                                   other = file.at(mode, second.angular_frequency, first.angular_frequency, first.direction);
        full.transfer(a, b) = 0.5 * (one + (difference ? std::conj(other) : other));
      }
    result.push_back(std::move(full));
  }
  return result;
}

Vector6 SecondOrderLoads::at(double t) const {
  if (time_ && *time_ == t) return load_;
  const Eigen::Index count = amplitude_.size();
  Eigen::VectorXcd& eta = eta_;
  for (Eigen::Index n = 0; n < count; ++n) eta[n] = amplitude_[n] * std::polar(1.0, omega_[std::size_t(n)] * t);
  Vector6 load = mean_;
  if (drift_.size() > 0) {
    // (T_m + T_n) / 2 over all pairs is Re{ conj(sum a) sum a T }.
    const std::complex<double> all = std::conj(eta.sum());
    for (int mode = 0; mode < 6; ++mode) {
      std::complex<double> weighed = 0.0;
      for (Eigen::Index n = 0; n < count; ++n) weighed += eta[n] * drift_(mode, n);
      load[mode] += (all * weighed).real();
    }
  }
  const auto add = [&](const std::vector<Full>& fulls, bool difference) {
    for (const Full& full : fulls)
      for (Eigen::Index a = 0; a < count; ++a) {
        std::complex<double> below = 0.5 * full.transfer(a, a) * (difference ? std::conj(eta[a]) : eta[a]);
        for (Eigen::Index b = 0; b < a; ++b) below += full.transfer(a, b) * (difference ? std::conj(eta[b]) : eta[b]);
        load[full.mode] += 2.0 * (eta[a] * below).real();
      }
  };
  add(difference_, true), add(sum_, false);
  time_ = t, load_ = load;
  return load;
}

}  // namespace spindrift::sea
