// SPDX-License-Identifier: Apache-2.0
#include "src/io/console.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <string>

namespace spindrift::io::console {

namespace {

std::mutex guard;
std::string status;

constexpr const char* clear_line = "\r\033[K";

void write(std::FILE* to, std::string_view text) { std::fwrite(text.data(), 1, text.size(), to); }

}  // namespace

void print(std::string_view line, bool to_standard_error) {
  const std::scoped_lock lock(guard);
  if (!status.empty()) write(stdout, clear_line), std::fflush(stdout);
  std::FILE* to = to_standard_error ? stderr : stdout;
  write(to, line);
  write(to, "\n");
  std::fflush(to);
  if (!status.empty()) write(stdout, status), std::fflush(stdout);
}

void set_status(std::string_view text) {
  const std::scoped_lock lock(guard);
  if (text.empty() && status.empty()) return;
  write(stdout, clear_line);
  status = text;
  write(stdout, status);
  std::fflush(stdout);
}

bool is_terminal() {
  // A launcher hands its ranks a terminal of its own even where its output goes to a file.
  for (const char* launcher : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK", "SLURM_STEP_ID"})
    if (std::getenv(launcher) != nullptr) return false;
  const char* kind = std::getenv("TERM");
  return ::isatty(STDOUT_FILENO) != 0 && kind != nullptr && std::string_view(kind) != "dumb";
}

int width() {
  winsize size{};
  return ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace spindrift::io::console
