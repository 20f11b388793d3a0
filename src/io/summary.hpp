// summary.json: what a run did in figures that programs read (report, perf, users' scripts): state at the end, statistics of
// every column, steps, iterations, seconds and core-seconds by part, efficiencies, build and machine. Schema:
// docs/user/outputs.md. Written by src/app as a run begins and at its end, also of one that failed. Tested in
// tests/src/io/run_files_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "src/io/history.hpp"
#include "src/io/history_statistics.hpp"

namespace spindrift::io {

/// Time spent in one part of the program: `bodies`, `moorings`, `io` ...; what a scene lacks has no entry.
struct PartTime {
  std::string name;
  double seconds;       ///< wall time of the longest rank
  double core_seconds;  ///< summed over all threads of all ranks
  std::int64_t calls;
};

/// A line of the efficiency table, as the executor measured it (definitions of the POP project): load balance, transfer, ...
struct Efficiency {
  std::string name;
  double value;  ///< 0 ... 1
  std::string meaning;
};

/// A mode of the bodies about the start, as `spindrift check` prints it.
struct ModeLine {
  std::string name;
  double frequency_Hz;  ///< damped; 0 where it does not oscillate
  double damping;       ///< of critical; of those that do not oscillate the rate [1/s]
};

struct Summary {
  std::string title, scene;            ///< scene: the path given on the command line
  std::vector<std::string> overrides;  ///< of its keys, from there too
  int exit_code = 0;                   ///< 0 done, 2 bad input, 3 numerical failure, 4 system failure, 5 stopped on request
  std::string exit_reason;             ///< one sentence
  std::vector<std::string> numerical_trouble;  ///< one sentence each: what, where, when
  std::int64_t warnings = 0;

  double start_time_s = 0, end_time_s = 0, window_s = 0;  ///< simulated; start: of this process, after a restart
  bool pseudo_steps = false;                              ///< a march to a steady state: its times count them
  int restarts = 0;
  std::vector<std::pair<std::string, std::int64_t>> counts;  ///< windows, steps, coupling_iterations, ... in the order shown
  double sound_speed_m_s = 0;                                ///< of a sea of particles; 0: there is none
  double wall_seconds = 0;
  double processor_seconds = 0;  ///< of all threads of all ranks, from reading the scene to the end, whatever else ran beside it
  double peak_memory_bytes = 0;  ///< of all ranks together, each at its largest
  std::vector<PartTime> parts;
  std::vector<Efficiency> efficiency;
  std::vector<ModeLine> modes;  ///< of bodies that have any

  int ranks = 1, threads = 1;  ///< threads per rank
  std::vector<Column> columns;
  std::optional<HistoryStatistics> statistics;  ///< on the rank that writes history.csv
};

/// Simulated seconds per wall second.
double real_time_factor(const Summary& summary);

/// Rank 0. Of a run that begins: what it is of, and no exit code. It stays where the run is killed.
void write_summary_of_start(const std::filesystem::path& path, const Summary& summary);

/// summary.json as a rank other than 0 finds it, for a failure that rank 0, which will be ended, does not know of.
class SummaryOfOthers {
 public:
  explicit SummaryOfOthers(std::filesystem::path path);
  /// This one, where rank 0 has not written how the run ended, nor does within a second; and where this rank's computer has the
  /// file. Never throws.
  void write_instead(const Summary& summary, int rank) const;

 private:
  std::filesystem::path path_;
  std::string before_;
};

/// How the run of a summary.json ended; nothing where it has not, or there is none.
std::optional<int> exit_code_in(const std::filesystem::path& path);

/// Rank 0. With build_info(), the host's name and processor; numbers that are not finite become null.
void write_summary(const std::filesystem::path& path, const Summary& summary);

}  // namespace spindrift::io
