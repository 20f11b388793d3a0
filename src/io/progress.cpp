// SPDX-License-Identifier: Apache-2.0
#include "src/io/progress.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "src/io/console.hpp"

namespace spindrift::io {

namespace {

constexpr double redraw_s = 0.2;      // on a terminal
constexpr double line_min_s = 10.0;   // between plain lines
constexpr double line_max_s = 120.0;  // a job's output shows life at least this often
constexpr double line_fraction = 0.05;
constexpr double stretch_s = 5.0;  // over which the speed is taken

double steady_seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

}  // namespace

ProgressStyle progress_style(int rank, bool quiet) {
  if (quiet || rank != 0) return ProgressStyle::quiet;
  return console::is_terminal() ? ProgressStyle::line : ProgressStyle::lines;
}

Progress::Progress(double start_s, double end_s, ProgressStyle style, std::function<double()> clock, Words words)
    : start_s_(start_s),
      end_s_(end_s),
      style_(style),
      clock_(clock ? std::move(clock) : steady_seconds),
      words_(words),
      started_(clock_()),
      said_at_(started_),
      mark_wall_(started_),
      mark_time_(start_s) {}

Progress::~Progress() {
  if (style_ == ProgressStyle::line) console::set_status("");
}

void Progress::update(double time_s, const std::string& note) {
  if (style_ == ProgressStyle::quiet) return;
  const double now = clock_(), since = now - said_at_;
  const double fraction = end_s_ > start_s_ ? (time_s - start_s_) / (end_s_ - start_s_) : 1.0;
  const bool due = style_ == ProgressStyle::line
                       ? since >= redraw_s
                       : since >= line_max_s || (since >= line_min_s && fraction - said_fraction_ >= line_fraction);
  if (!due) return;
  if (now - mark_wall_ >= stretch_s || speed_ == 0.0) {
    // Half old, half new: steady enough to read, quick enough to follow a run that slows down.
    const double recent = (time_s - mark_time_) / std::max(now - mark_wall_, 1e-9);
    speed_ = speed_ == 0.0 ? recent : 0.5 * (speed_ + recent);
    mark_wall_ = now;
    mark_time_ = time_s;
  }
  const std::string text = words_(time_s, start_s_, end_s_, speed_) + (note.empty() ? "" : "   " + note);
  if (style_ == ProgressStyle::line)
    console::set_status(text.substr(0, static_cast<std::size_t>(std::max(console::width() - 1, 20))));
  else
    spdlog::info("{}", text);
  said_at_ = now;
  said_fraction_ = fraction;
}

std::string duration_text(double seconds) {
  if (!(seconds < 1e10)) return "?";
  const auto s = std::llround(std::max(seconds, 0.0));
  if (s >= 86400) return fmt::format("{} d {} h", s / 86400, s % 86400 / 3600);
  if (s >= 3600) return fmt::format("{}:{:02}:{:02}", s / 3600, s % 3600 / 60, s % 60);
  return fmt::format("{}:{:02}", s / 60, s % 60);
}

std::string progress_text(double time_s, double start_s, double end_s, double speed) {
  const double percent = end_s > start_s ? 100.0 * (time_s - start_s) / (end_s - start_s) : 100.0;
  // Enough decimals that the time moves at each window of a short or a long run.
  const int decimals = end_s - start_s < 10.0 ? 3 : end_s - start_s < 100.0 ? 2 : 1;
  std::string text = fmt::format("t = {:.{}f} of {:.{}f} s   {:3.0f} %", time_s, decimals, end_s, decimals, std::floor(percent));
  if (speed > 0.0) {
    text +=
        speed >= 1.0 ? fmt::format("   {:.3g} x real time", speed) : fmt::format("   {:.3g} wall s per simulated s", 1.0 / speed);
    text += fmt::format("   {} to go", duration_text((end_s - time_s) / speed));
  }
  return text;
}

std::string pseudo_steps_text(double step, double, double end, double speed) {
  return fmt::format("pseudo-step {:.0f} of at most {:.0f}", step, end) +
         (speed > 0.0 ? fmt::format("   {:.3g} per second   at most {} to go", speed, duration_text((end - step) / speed)) : "");
}

}  // namespace spindrift::io
