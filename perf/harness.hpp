// What a benchmark group needs: timing by repetition, ratios of pairs taken in one run, and figures with unit and bar.
// Method: medians, not means (a shared machine only ever adds time); ratios of neighbours in time, in alternating order, because
// clock speed drifts over minutes. Figures go to the terminal and, as one JSON object a line, to the file that perf/run asks for.
// Used by every perf/GROUP/*.cpp (perf/README.md shows one); perf/run reads, scales and judges them; tested in tests/perf.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/resource.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace spindrift::perf {

/// Makes the compiler believe that `value` is read and changed here, so that a timed computation is neither dropped nor hoisted.
template <class T>
void keep(T& value) {
  asm volatile("" : "+m"(value) : : "memory");
}

/// Of a clock that others on the machine move too.
inline double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Processor seconds that this process has spent in its own code so far: others on the machine hardly change them.
inline double user_seconds() {
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_utime.tv_sec) + 1e-6 * double(usage.ru_utime.tv_usec);
}

/// Processor seconds of all threads of this process so far, the system's work for it among them.
inline double processor_seconds() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

/// Seconds of one call by a clock.
template <class Body>
double seconds(Body&& body, double (*clock)() = wall_seconds) {
  const double begin = clock();
  body();
  return clock() - begin;
}

/// Value below which the fraction q in [0, 1] of the samples lies, linear between neighbours. Not for empty sets.
inline double quantile(std::vector<double> samples, double q) {
  std::sort(samples.begin(), samples.end());
  const double at = q * double(samples.size() - 1);
  const auto below = std::size_t(at);
  const auto above = std::min(below + 1, samples.size() - 1);
  return samples[below] + (at - double(below)) * (samples[above] - samples[below]);
}

/// Order statistics of repeated measurements.
struct Spread {
  double median = 0, quartile_1 = 0, quartile_3 = 0, min = 0, max = 0;
  int samples = 0;
};
inline Spread spread(const std::vector<double>& samples) {
  return {quantile(samples, 0.5), quantile(samples, 0.25), quantile(samples, 0.75),
          quantile(samples, 0.0), quantile(samples, 1.0),  int(samples.size())};
}

struct Repeat {
  int samples = 9, warm_ups = 1;
  double sample_s = 0.01;  ///< a sample calls the body as often as takes at least this long
};

/// Seconds per call of `body`, over `repeat.samples` samples.
template <class Body>
Spread measure(Body&& body, Repeat repeat = {}) {
  for (int n = 0; n < repeat.warm_ups; ++n) body();
  const auto sample = [&body](long calls) {
    return seconds([&] {
      for (long n = 0; n < calls; ++n) {
        body();
        asm volatile("" : : : "memory");  // the loop runs, however little the body does
      }
    });
  };
  long calls = 1;
  while (sample(calls) < repeat.sample_s) calls *= 2;
  std::vector<double> times;
  for (int n = 0; n < repeat.samples; ++n) times.push_back(sample(calls) / double(calls));
  return spread(times);
}

/// time(numerator) / time(denominator), each pair measured back to back and in alternating order, by a clock [s].
template <class Numerator, class Denominator>
Spread paired_ratio(Numerator&& numerator, Denominator&& denominator, int pairs = 9, double (*clock)() = wall_seconds) {
  numerator(), denominator();  // warm caches, pages and pools of both before the first pair
  std::vector<double> ratios;
  for (int n = 0; n < pairs; ++n) {
    double above, below;
    if (n % 2 == 0)
      above = seconds(numerator, clock), below = seconds(denominator, clock);
    else
      below = seconds(denominator, clock), above = seconds(numerator, clock);
    ratios.push_back(above / below);
  }
  return spread(ratios);
}

/// Which one-core ceiling of the machine an absolute bar goes with; perf/run scales the bar by measured/reference of that
/// ceiling. Ratios, errors and latencies have none.
enum class Ceiling { none, fma_float, fma_double, stream };

/// Collects and prints the figures of one group.
class Group {
 public:
  /// Arguments: [--figures FILE], as perf/run passes it.
  Group(std::string_view name, int argc, char** argv) : name_(name) {
    for (int n = 1; n < argc; ++n) {
      if (std::string_view(argv[n]) != "--figures" || n + 1 == argc)
        throw std::invalid_argument("perf_" + name_ + ": usage: perf_" + name_ + " [--figures FILE]");
      file_ = std::fopen(argv[++n], "w");
      if (file_ == nullptr) throw std::runtime_error("perf_" + name_ + ": cannot write " + argv[n]);
    }
  }
  ~Group() {
    if (file_ != nullptr) std::fclose(file_);
  }
  Group(const Group&) = delete;
  Group& operator=(const Group&) = delete;

  /// A figure without a bar. `note` says under what conditions it was measured.
  void figure(std::string_view name, double value, std::string_view unit, std::string_view note = "") {
    add(name, value, unit, "none", nan, Ceiling::none, note);
  }
  /// A figure that must not exceed `bar` (a time, an error). A bar with a ceiling is for the reference core.
  void at_most(std::string_view name, double value, std::string_view unit, double bar, Ceiling ceiling = Ceiling::none,
               std::string_view note = "") {
    add(name, value, unit, "at most", bar, ceiling, note);
  }
  /// A figure that must reach `bar` (a rate, an efficiency). A bar with a ceiling is for the reference core.
  void at_least(std::string_view name, double value, std::string_view unit, double bar, Ceiling ceiling = Ceiling::none,
                std::string_view note = "") {
    add(name, value, unit, "at least", bar, ceiling, note);
  }
  /// A point of a curve that `perf/run --plot` draws: all points of one `plot` share axes, of one `series` a line.
  void point(std::string_view plot, std::string_view series, double x, std::string_view x_label, double y,
             std::string_view y_label) {
    if (file_ == nullptr) return;
    std::fprintf(file_,
                 R"({"plot": %s, "series": %s, "x": %.9g, "x_label": %s, "y": %.9g, "y_label": %s})"
                 "\n",
                 quoted(plot).c_str(), quoted(series).c_str(), x, quoted(x_label).c_str(), y, quoted(y_label).c_str());
  }

 private:
  static constexpr double nan = std::numeric_limits<double>::quiet_NaN();

  static std::string quoted(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
      if (c == '"' || c == '\\') out += '\\';
      out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
    return out + '"';
  }
  static std::string number(double value) {  // JSON has no word for a number that is not finite
    if (!std::isfinite(value)) return "null";
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", value);
    return text;
  }

  void add(std::string_view name, double value, std::string_view unit, const char* sense, double bar, Ceiling ceiling,
           std::string_view note) {
    static constexpr const char* ceilings[] = {"none", "fma_float", "fma_double", "stream"};
    std::printf("%s/%-40.*s %12.5g %-14.*s", name_.c_str(), int(name.size()), name.data(), value, int(unit.size()), unit.data());
    if (!std::isnan(bar)) std::printf(" %s %.5g", sense, bar);
    if (ceiling != Ceiling::none) std::printf(" on the reference core (%s)", ceilings[int(ceiling)]);
    std::printf("%s%.*s\n", note.empty() ? "" : "  # ", int(note.size()), note.data());
    std::fflush(stdout);
    if (file_ == nullptr) return;
    std::fprintf(file_,
                 R"({"name": %s, "value": %s, "unit": %s, "sense": "%s", "bar": %s, "ceiling": "%s", "note": %s})"
                 "\n",
                 quoted(name).c_str(), number(value).c_str(), quoted(unit).c_str(), sense, number(bar).c_str(),
                 ceilings[int(ceiling)], quoted(note).c_str());
    std::fflush(file_);  // a group that dies later still leaves what it measured
  }

  std::string name_;
  std::FILE* file_ = nullptr;
};

}  // namespace spindrift::perf
