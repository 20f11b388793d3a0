// What the choices of a sea of particles trade: a standing wave in 2-D (length 1 m, depth 0.5 m, amplitude 1 cm, d = 1/40 m),
// each choice varied alone, its error in frequency against linear theory, its decay and its price in processor seconds per second
// of sea. Ratios to the first line, run in turn in one process, so that a busy machine matters little. Run by perf/run; read in
// docs/developer/notes/sea.md. SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>

#include "kernels/base/constants.hpp"
#include "perf/harness.hpp"
#include "src/sea/sph/lattice.hpp"
#include "src/sea/sph/sea_sph.hpp"

using namespace spindrift;
using namespace spindrift::sph;

namespace {

struct Outcome {
  double frequency_error, decay_per_period, seconds_per_second, microseconds_per_evaluation;
};

template <class Real>
Outcome standing_wave(const Parameters& given, double c0_over_wave_speed) {
  const double length = 1.0, depth = 0.5, amplitude = 0.01, k = 2.0 * pi / length;
  Parameters p = given;
  p.eos = {1000.0, c0_over_wave_speed * std::sqrt(p.gravity * depth)};
  const double d = p.spacing;
  const int columns = int(std::lround(length / d)), rows = int(std::lround(depth / d));
  p.mass_factor = p.eos.mean_density_ratio(rows * d, p.gravity);
  const double omega = std::sqrt(p.gravity * k * std::tanh(k * depth)), period = 2.0 * pi / omega;
  std::vector<Seed<2>> seeds;
  add_water_at_rest<2>(seeds, {0, 0}, p, {0, 0}, {columns, rows});
  for (Seed<2>& seed : seeds) {  // the moment when the surface is flat
    const double x = seed.position[0], z = seed.position[1] + 0.5 * d, scale = amplitude * omega / std::sinh(k * depth);
    seed.velocity = {-scale * std::cosh(k * z) * std::sin(k * x), scale * std::sinh(k * z) * std::cos(k * x)};
  }
  const int layers = int(std::ceil(p.reach() / d));
  for_lattice<2>({0, -layers}, {columns, 0}, [&](const std::array<int, 2>& at) {
    const auto x = lattice_point<2>({0, 0}, d, at);
    seeds.push_back({.position = x, .deviation = p.eos.hydrostatic_deviation((rows - 0.5) * d - x[1], p.gravity), .owner = 1});
  });
  SeaSph<2, Real> sea(p, {{0, -0.5}, {columns * d, 2}, {true, false}}, seeds, {.threads = 1});
  std::vector<double> crossings, peaks;
  double before = 0.0, peak = 0.0;
  const double dt = period / 100, start = perf::user_seconds();
  while (crossings.size() < 5) {
    sea.advance(dt);
    double mode = 0.0;
    for (std::size_t slot = 0; slot < sea.store().slots(); ++slot)
      if (sea.store().id[slot] != no_particle && sea.store().owner[slot / cluster_size] == 0)
        mode += sea.store().x[1][slot] * std::cos(k * sea.store().x[0][slot]);
    peak = std::max(peak, std::abs(mode));
    if (before * mode < 0.0)
      crossings.push_back(sea.time() - dt * mode / (mode - before)), peaks.push_back(std::exchange(peak, 0.0));
    before = mode;
  }
  const double seconds = perf::user_seconds() - start,
               halves = double(crossings.size()) - 2.0;  // the first half is starting noise
  return {0.5 * halves * period / (crossings.back() - crossings[1]) - 1.0, 1.0 - std::pow(peaks.back() / peaks[1], 2.0 / halves),
          seconds / sea.time(), 1e6 * seconds / (double(sea.state().work.evaluations) * double(seeds.size()))};
}

}  // namespace

int main(int argc, char** argv) {
  perf::Group group("sea_trade", argc, argv);
  Parameters base;
  base.spacing = 1.0 / 40, base.h_over_d = 1.5, base.alpha = 0.02, base.alpha_solid = 0.0,
  base.diffusion = DiffusionChoice::fourtakas;
  double base_price = 0.0;
  const auto report = [&](const std::string& name, const Outcome& o) {
    if (base_price == 0.0) base_price = o.seconds_per_second;
    group.figure(name + ".frequency_error", 100.0 * o.frequency_error, "%");
    group.figure(name + ".decay", 100.0 * o.decay_per_period, "% per period");
    group.figure(name + ".price", o.seconds_per_second / base_price, "of base");
    group.figure(name + ".evaluation", o.microseconds_per_evaluation, "us");
    group.point("sea_trade", name, o.seconds_per_second / base_price, "processor time / base",
                100.0 * std::abs(o.frequency_error), "error of frequency [%]");
  };
  const auto with = [&](auto&& change) {
    Parameters p = base;
    change(p);
    return p;
  };
  report("base", standing_wave<float>(base, 10.0));
  for (double c0 : {5.0, 20.0, 40.0}) report("c0_" + std::to_string(int(c0)), standing_wave<float>(base, c0));
  for (double h : {1.2, 1.732, 2.0})
    report("h_" + std::to_string(h).substr(0, 3), standing_wave<float>(with([&](Parameters& p) { p.h_over_d = h; }), 10.0));
  for (double skin : {0.1, 0.25, 1.0})
    report("skin_" + std::to_string(skin).substr(0, 4),
           standing_wave<float>(with([&](Parameters& p) { p.drift_over_d = skin; }), 10.0));
  report("double", standing_wave<double>(base, 10.0));
  report("no_diffusion", standing_wave<float>(with([](Parameters& p) { p.diffusion = DiffusionChoice::none; }), 10.0));
  report("molteni", standing_wave<float>(with([](Parameters& p) { p.diffusion = DiffusionChoice::molteni; }), 10.0));
  report("cubic", standing_wave<float>(with([](Parameters& p) { p.kernel = KernelChoice::cubic; }), 10.0));
  report("verlet", standing_wave<float>(with([](Parameters& p) { p.step = StepChoice::verlet, p.cfl = 0.1; }), 10.0));
  report("half_spacing", standing_wave<float>(with([](Parameters& p) { p.spacing *= 0.5; }), 10.0));
}
