// Turbulence with Kaimal's spectra by Veers' method: at each frequency the coherence between all points is factored, its columns
// get random phases, an inverse Fourier transform makes them time series (Veers 1988, SAND88-0152).
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Cholesky>
#include <cmath>
#include <complex>
#include <unsupported/Eigen/FFT>

#include "kernels/base/constants.hpp"
#include "kernels/base/random.hpp"
#include "kernels/rotor/gusts_iec.hpp"
#include "kernels/rotor/turbulence_kaimal.hpp"
#include "src/aero/turbulence_box.hpp"

namespace spindrift::aero {

TurbulenceBox kaimal_box(const KaimalOptions& o) {
  using Complex = std::complex<double>;
  const int points = o.across * o.up, steps = 2 * int(std::lround(0.5 * o.duration_s / o.step_s));
  TurbulenceBox box{o.across,
                    o.up,
                    steps,
                    o.across > 1 ? o.width_m / (o.across - 1) : 1.0,
                    o.up > 1 ? o.height_m / (o.up - 1) : 1.0,
                    o.step_s,
                    o.hub_height,
                    o.hub_height - 0.5 * o.height_m,
                    o.wind,
                    true,
                    false,
                    {}};
  const double scale = iec::scale_parameter(o.hub_height), apart = kaimal::length_ratio[0] * scale;
  Eigen::MatrixXd distance(points, points);
  for (int a = 0; a < points; ++a)
    for (int b = 0; b < points; ++b)
      distance(a, b) = std::hypot((a % o.across - b % o.across) * box.across_m, (a / o.across - b / o.across) * box.up_m);

  const double df = 1.0 / (steps * o.step_s);
  std::array<Eigen::MatrixXcd, 3> spectrum;  // [component](frequency, point)
  for (auto& s : spectrum) s.setZero(steps / 2 + 1, points);
  Random random(o.seed);
  Eigen::MatrixXd lower(points, points);
  Eigen::MatrixX2d phases(points, 2);  // cosine and sine
  for (int k = 1; k < steps / 2; ++k) {
    const double f = k * df;
    for (int a = 0; a < points; ++a)
      for (int b = 0; b < points; ++b) lower(a, b) = kaimal::coherence(f, distance(a, b), apart, o.wind);
    const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> llt(lower);
    for (std::size_t c = 0; c < 3; ++c) {
      for (int a = 0; a < points; ++a) {
        const double angle = 2.0 * pi * random.uniform();
        phases(a, 0) = std::cos(angle), phases(a, 1) = std::sin(angle);
      }
      const double power = df * kaimal::density(f, kaimal::sigma_ratio[c] * o.sigma, kaimal::length_ratio[c] * scale, o.wind);
      // Half the amplitude sqrt(2 S df) each at +f and -f, times the transform's length.
      const double amplitude = 0.5 * steps * std::sqrt(2.0 * power);
      const Eigen::MatrixX2d mixed = llt.matrixL() * phases;
      for (int a = 0; a < points; ++a) spectrum[c](k, a) = amplitude * Complex(mixed(a, 0), mixed(a, 1));
    }
  }
  Eigen::FFT<double> transform;
  transform.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  box.values.resize(std::size_t(steps) * std::size_t(points) * 3);
  std::vector<Complex> half(std::size_t(steps / 2 + 1));
  std::vector<double> series;
  for (std::size_t c = 0; c < 3; ++c) {
    for (int p = 0; p < points; ++p) {
      for (int k = 0; k <= steps / 2; ++k) half[std::size_t(k)] = spectrum[c](k, p);
      transform.inv(series, half, steps);
      for (int s = 0; s < steps; ++s)
        box.values[(std::size_t(s) * std::size_t(points) + std::size_t(p)) * 3 + c] = float(series[std::size_t(s)]);
    }
  }
  return box;
}

}  // namespace spindrift::aero
