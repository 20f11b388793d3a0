// Ceilings of the machine: stream bandwidth and fused multiply-add peak, on one core and on all.
// Stream is McCalpin's triad a = b + s c, counted as he counts it (24 bytes per element, the write-allocate not counted); the
// peak is independent multiply-add chains in registers. perf/run runs this group first and scales absolute bars by what it
// measures. SPDX-License-Identifier: Apache-2.0
#include <omp.h>
#include <unistd.h>

#include <experimental/simd>
#include <memory>

#include "perf/harness.hpp"

using namespace spindrift::perf;

namespace {

/// Multiply-adds of 12 independent chains: more than latency x pipes of any current core (4 x 2), fewer than its registers.
template <class Real>
void multiply_add_chains(long rounds) {
  using Lanes = std::experimental::native_simd<Real>;
  constexpr int chains = 12;
  Lanes sum[chains];
  for (int n = 0; n < chains; ++n) sum[n] = Real(n);
  Lanes factor = Real(0.999), term = Real(1e-3);
  keep(factor), keep(term);
  for (long round = 0; round < rounds; ++round)
    for (int n = 0; n < chains; ++n) sum[n] = sum[n] * factor + term;
  for (int n = 0; n < chains; ++n) keep(sum[n]);
}

/// Floating-point operations per second of `threads` threads together.
template <class Real>
double multiply_add_peak(int threads) {
  constexpr long rounds = 5'000'000;
  const double lanes = std::experimental::native_simd<Real>::size();
  const auto all = [threads] {
#pragma omp parallel num_threads(threads)
    multiply_add_chains<Real>(rounds);
  };
  return 2.0 * lanes * 12 * rounds * threads / measure(all).median;
}

/// Bytes per second of the triad on `threads` threads, arrays four times the last-level cache (at least 64 MiB, at most 256 MiB
/// each).
double triad_bandwidth(int threads) {
  const long cache = std::max(sysconf(_SC_LEVEL3_CACHE_SIZE), 0L);
  const long count = std::clamp(4 * cache, 64L << 20, 256L << 20) / long(sizeof(double));
  const std::unique_ptr<double[]> a(new double[count]), b(new double[count]), c(new double[count]);
  const auto on_all = [&](auto&& body) {
#pragma omp parallel for num_threads(threads) schedule(static)
    for (long n = 0; n < count; ++n) body(n);
  };
  on_all([&](long n) { a[n] = 0.0, b[n] = 1.0, c[n] = 2.0; });  // pages belong to the thread that uses them
  const double time = measure([&] { on_all([&, s = 3.0](long n) { a[n] = b[n] + s * c[n]; }); }).median;
  keep(a[count / 2]);
  return 3.0 * sizeof(double) * double(count) / time;
}

}  // namespace

int main(int argc, char** argv) {
  Group group("machine", argc, argv);
  const int cores = omp_get_num_procs();
  const auto report = [&group](const std::string& place, int threads) {
    group.figure("fma_float/" + place, multiply_add_peak<float>(threads) * 1e-9, "GFLOP/s");
    group.figure("fma_double/" + place, multiply_add_peak<double>(threads) * 1e-9, "GFLOP/s");
    group.figure("stream/" + place, triad_bandwidth(threads) * 1e-9, "GB/s", "triad");
  };
  report("one_core", 1);
  report("all_cores", cores);
}
