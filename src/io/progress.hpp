// Progress of a run: simulated time, fraction, speed against real time, time to go. On a terminal one line that is rewritten,
// elsewhere (a job's output file) a line now and then through the log. Called by the coupling, on rank 0. Tested in
// tests/src/io/run_files_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

namespace spindrift::io {

enum class ProgressStyle {
  quiet,
  lines,  ///< through the log: at each further 5 % but not within 10 s of the last, and at least every 2 minutes
  line    ///< one line on the terminal, rewritten five times a second
};

/// quiet where asked for or on ranks other than 0; else what standard output can do.
ProgressStyle progress_style(int rank, bool quiet);

/// "t = 75.0 of 150.0 s   50 %   210 x real time   0:12 to go". `speed` in simulated per wall seconds; 0: not known yet.
std::string progress_text(double time_s, double start_s, double end_s, double speed);

/// Of a march to a steady state, which may end before its last: "pseudo-step 75 of at most 300   2.1 per second".
std::string pseudo_steps_text(double step, double start, double end, double speed);

class Progress {
 public:
  using Words = std::string (*)(double time_s, double start_s, double end_s, double speed);
  /// Simulated time runs from `start_s` to `end_s`. `clock` gives wall seconds (tests bring their own).
  /// `words`: progress_text or another that takes its arguments.
  Progress(double start_s, double end_s, ProgressStyle style, std::function<double()> clock = {}, Words words = progress_text);
  ~Progress();  ///< Removes the status line.
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// After each window; costs one look at the clock unless something is due. `note` goes behind, such as "12 iterations".
  void update(double time_s, const std::string& note = {});

 private:
  double start_s_, end_s_;
  ProgressStyle style_;
  std::function<double()> clock_;
  Words words_;
  double started_, said_at_, said_fraction_ = 0.0;
  double mark_wall_, mark_time_, speed_ = 0.0;  // speed over the last stretch, for the time to go
};

/// "0:07", "12:34", "3:05:09", "4 d 3 h" from seconds.
std::string duration_text(double seconds);

}  // namespace spindrift::io
