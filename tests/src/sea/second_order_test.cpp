// Wave loads of second order: their mean, Newman's approximation against the full matrix where both are the same and where they
// are near, and sums of frequencies. SPDX-License-Identifier: Apache-2.0
#include "src/sea/second_order.hpp"

#include <catch2/catch.hpp>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>

#include "kernels/base/constants.hpp"
#include "src/scene/error.hpp"

using namespace spindrift;
using namespace spindrift::sea;

namespace {

const WamitScale scale{2.0, 1000.0, 10.0};
// Mean drift over rho g L of surge [-].
double drift_of(double w) { return 0.2 + 0.5 * w; }

struct Files {
  std::filesystem::path folder = std::filesystem::temp_directory_path() / ("spindrift_second_order_" + std::to_string(getpid()));
  Files() { std::filesystem::create_directories(folder); }
  ~Files() { std::filesystem::remove_all(folder); }
  /// Frequencies .2, .3 ... 1.6 rad/s, one order of each pair.
  std::string pairs(const std::string& name, const std::function<std::complex<double>(double, double)>& transfer) const {
    std::ofstream file(folder / name);
    file.precision(15);
    for (int a = 2; a <= 16; ++a)
      for (int b = 2; b <= a; ++b) {
        const std::complex<double> t = transfer(0.1 * a, 0.1 * b);
        file << 2.0 * pi / (0.1 * a) << " " << 2.0 * pi / (0.1 * b) << " 0 0 1 " << std::abs(t) << " 0 " << t.real() << " "
             << t.imag() << "\n";
      }
    return folder / name;
  }
  std::string mean(const std::string& name) const {
    std::ofstream file(folder / name);
    file.precision(15);
    for (int a = 2; a <= 16; ++a)
      file << 2.0 * pi / (0.1 * a) << " 0 0 1 " << drift_of(0.1 * a) << " 0 " << drift_of(0.1 * a) << " 0\n";
    return folder / name;
  }
};

PotentialOptions with(const std::string& drift, const std::string& file) {
  PotentialOptions o;
  o.drift = drift, o.drift_file = file;
  return o;
}

/// Seven waves of frequencies that are none of the file's.
std::vector<waves::Component> seven_waves(double from, double step) {
  std::vector<waves::Component> waves;
  for (int n = 0; n < 7; ++n) {
    const double w = from + step * n;
    waves.push_back({.wave_number = 0.1 * w * w, .angular_frequency = w, .amplitude = 0.5 + 0.1 * (n % 3), .phase = 1.7 * n * n});
  }
  return waves;
}

}  // namespace

TEST_CASE("one wave drifts by its squared amplitude times the file's load, whatever is asked for", "[sea][fast]") {
  const Files files;
  const auto drift = GENERATE(as<std::string>(), "mean", "newman", "full");
  const std::string file = drift == "full"
                               ? files.pairs("b.12d", [](double a, double b) { return 0.5 * (drift_of(a) + drift_of(b)); })
                               : files.mean("b.8");
  const waves::Component wave{.wave_number = 0.05, .angular_frequency = 0.72, .amplitude = 1.5, .phase = 0.4};
  const SecondOrderLoads loads(with(drift, file), scale, {wave});
  for (double t : {0.0, 3.0, 11.0}) {
    CHECK(loads.at(t)[0] == Approx(1.5 * 1.5 * drift_of(0.72) * 1000.0 * 10.0 * 2.0));
    CHECK(loads.at(t).tail<5>().norm() == 0.0);
  }
}

TEST_CASE("of a sea the mean over time is the sum of its waves' own drift", "[sea][fast]") {
  const Files files;
  const std::vector<waves::Component> waves = seven_waves(0.5, 0.1);
  double mean = 0.0;
  for (const waves::Component& w : waves) mean += w.amplitude * w.amplitude * drift_of(w.angular_frequency) * 2e4;
  CHECK(SecondOrderLoads(with("mean", files.mean("b.9")), scale, waves).at(5.0)[0] == Approx(mean));
  const SecondOrderLoads newman(with("newman", files.mean("b.9")), scale, waves);
  double sum = 0.0, most = 0.0;
  constexpr int samples = 2000;  // whole periods of all differences: 2 pi / 0.1 each
  for (int n = 0; n < samples; ++n) {
    const double load = newman.at(20.0 * pi * n / samples)[0];
    sum += load / samples, most = std::max(most, load);
  }
  CHECK(sum == Approx(mean));
  CHECK(most > 2.0 * mean);
}

TEST_CASE("Newman's approximation is the full matrix where that is the mean of its diagonal, of any file", "[sea][fast]") {
  const Files files;
  const std::string full = files.pairs("b.12d", [](double a, double b) { return 0.5 * (drift_of(a) + drift_of(b)); });
  const std::vector<waves::Component> waves = seven_waves(0.43, 0.11);
  const SecondOrderLoads exact(with("full", full), scale, waves), newman(with("newman", files.mean("b.8")), scale, waves),
      from_pairs(with("newman", full), scale, waves);
  for (double t = 0.0; t < 100.0; t += 7.3) {
    CHECK(newman.at(t)[0] == Approx(exact.at(t)[0]).epsilon(1e-9));
    CHECK(from_pairs.at(t)[0] == Approx(exact.at(t)[0]).epsilon(1e-9));
  }
}

TEST_CASE("Newman's approximation comes nearer the full matrix as the differences become small, at second order", "[sea][fast]") {
  // Off the diagonal the matrix leaves its mean with the square of the difference, and has a phase with its first power.
  const Files files;
  const std::string full = files.pairs("b.12d", [](double a, double b) {
    return std::complex<double>(0.5 * (drift_of(a) + drift_of(b)) + 0.8 * (a - b) * (a - b), 0.0);
  });
  std::vector<double> off;
  for (double step : {0.1, 0.05}) {
    const std::vector<waves::Component> waves = seven_waves(0.6, step);
    const SecondOrderLoads exact(with("full", full), scale, waves), newman(with("newman", full), scale, waves);
    double worst = 0.0, most = 0.0;
    for (double t = 0.0; t < 20.0 / step; t += 0.1 / step) {
      worst = std::max(worst, std::abs(newman.at(t)[0] - exact.at(t)[0]));
      most = std::max(most, std::abs(exact.at(t)[0]));
    }
    off.push_back(worst / most);
  }
  CHECK(off[0] < 0.2);
  CHECK(off[0] > 0.005);
  CHECK(off[1] < 0.6 * off[0]);
}

TEST_CASE("two waves make the load of their difference with the matrix's phase, and of their sum", "[sea][fast]") {
  const Files files;
  const std::complex<double> t(0.3, 0.2);
  const auto cross = [&](double a, double b) { return a == b ? std::complex<double>(0.0) : t; };
  const double w1 = 0.9, w2 = 0.5, a1 = 1.2, a2 = 0.7, p1 = 0.3, p2 = 1.1, k = 2e4;
  const std::vector<waves::Component> waves{{.wave_number = 0.1, .angular_frequency = w1, .amplitude = a1, .phase = p1},
                                            {.wave_number = 0.1, .angular_frequency = w2, .amplitude = a2, .phase = p2}};
  const SecondOrderLoads difference(with("full", files.pairs("b.12d", cross)), scale, waves);
  PotentialOptions sums;
  sums.sum_frequency_file = files.pairs("b.12s", cross);
  const SecondOrderLoads sum(sums, scale, waves);
  for (double time : {0.0, 2.0, 9.0}) {
    // A wave a cos(k x - w t + phase) is a exp(-i phase) exp(i w t).
    const auto eta = [&](double a, double p, double w) { return std::polar(a, w * time - p); };
    CHECK(difference.at(time)[0] == Approx(2.0 * k * (t * eta(a1, p1, w1) * std::conj(eta(a2, p2, w2))).real()));
    CHECK(sum.at(time)[0] == Approx(2.0 * k * (t * eta(a1, p1, w1) * eta(a2, p2, w2)).real()));
  }
}

TEST_CASE("moments have one more power of the length, waves that cross and other frequencies are left out of the mean",
          "[sea][fast]") {
  const Files files;
  const std::string path = files.folder / "m.12d";
  std::ofstream(path) << "10 10 0 0 6 1 0 0.5 0\n10 10 0 90 6 1 0 9 0\n10 5 0 0 6 1 0 7 0\n5 5 0 0 6 1 0 0.5 0\n";
  const WamitDrift drift = read_drift(path, scale);
  CHECK(drift.omega.size() == 2);
  CHECK(drift.at(0.8, 0.0)[5] == Approx(0.5 * 1000.0 * 10.0 * 4.0));
  CHECK(drift.at(0.5 * drift.omega[0], 0.0)[5] == Approx(0.5 * 0.5 * 4e4));
  CHECK(drift.at(2.0, 0.0)[5] == 0.0);
}

TEST_CASE("malformed files of second order are refused by file and line", "[sea][fast]") {
  const Files files;
  const auto refusal = [&](const std::string& text, bool pairs) -> std::string {
    const std::string path = files.folder / "bad.12d";
    std::ofstream(path) << text;
    try {
      pairs ? void(read_quadratic(path, scale, FrequencyPair::difference)) : void(read_drift(path, scale));
    } catch (const scene::SceneError& e) { return e.what(); }
    return "";
  };
  const std::string one = "6 6 0 0 1 1 0 1 0\n";
  CHECK(refusal(one, true).empty());
  const auto [text, said] = GENERATE(table<std::string, std::string>({
      {"5 5 0 0 1 1 0 1\n", "bad.12d:2: has 8 numbers"},
      {"5 5 0 0 7 1 0 1 0\n", "bad.12d:2: mode 7"},
      {"5 5 0 0 0 1 0 1 0\n", "bad.12d:2: mode 0"},
      {"5 -5 0 0 1 1 0 1 0\n", "bad.12d:2: the period must be positive"},
      {"0 5 0 0 1 1 0 1 0\n", "bad.12d:2: the period must be positive"},
      {"5 5 0 0 1 1 0 one 0\n", "bad.12d:2: 'one'"},
      {"5 5 0 0 1 1 0 nan 0\n", "bad.12d:2: 'nan'"},
      {"6 6 0 0 1 1 0 1 0\n", "bad.12d:2: repeats line 1"},
      {"5 5 0 0 1 1 0 1 0\n", "has no load of mode 1 for the periods"},
  }));
  CAPTURE(text);
  CHECK(refusal(one + text, true).find(said) != std::string::npos);
  CHECK(refusal("", true).find("has no rows") != std::string::npos);
  CHECK(refusal("6 6 0 90 1 1 0 1 0\n", true).find("in the same direction") != std::string::npos);
  CHECK(refusal("6 5 0 0 1 1 0 1 0\n", false).find("of the same period") != std::string::npos);
  CHECK(refusal("6 0 0 1 1 0 1 0\n5 0 0 2 1 0 1 0\n", false).find("has no load of mode 1") != std::string::npos);
  CHECK(refusal("6 0 0 1 1 0 1 0\n6 0 0 1 1 0 2 0\n", false).find("bad.12d:2: repeats line 1") != std::string::npos);
}
