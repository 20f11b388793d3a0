// SPDX-License-Identifier: Apache-2.0
#include "src/report/report.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string_view>

extern char** environ;

namespace spindrift::report {

namespace fs = std::filesystem;

namespace {

/// The distribution's interpreter, which has the packages of ci/setup: another python3 may come first on the path.
std::string interpreter() {
  const char* chosen = std::getenv("SPINDRIFT_PYTHON");
  return chosen != nullptr && *chosen != '\0' ? chosen : "/usr/bin/python3";
}

/// The folder of the programs: beside an installed binary, else in the sources it was built from.
fs::path folder() {
  std::error_code none;
  const fs::path installed = fs::read_symlink("/proc/self/exe", none).parent_path() / SPINDRIFT_REPORT_FROM_BINARY;
  return fs::exists(installed / "spindrift_report.py", none) ? installed : fs::path(SPINDRIFT_REPORT_SOURCE_DIR);
}

/// Without the variables by which a child of an MPI program takes itself for one of its ranks.
std::vector<char*> environment() {
  std::vector<char*> kept;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view text = *entry;
    if ((!text.starts_with("OMPI_") || text.starts_with("OMPI_ALLOW_RUN_AS_ROOT")) && !text.starts_with("PMIX_") &&
        !text.starts_with("PMI_"))
      kept.push_back(*entry);
  }
  kept.push_back(nullptr);
  return kept;
}

std::string read_all(int descriptor) {
  std::string text;
  std::array<char, 4096> buffer;
  for (;;) {
    const ssize_t count = ::read(descriptor, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return text;
    text.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

/// Of a message or a Python traceback, the line that says what is wrong.
std::string last_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

}  // namespace

fs::path page_of(const Request& request) {
  if (request.out) return *request.out;
  const fs::path& first = request.directories.front();
  std::error_code none;
  if (fs::exists(first / "study.json", none)) return first / "study.html";
  return first / (request.directories.size() == 1 ? "report.html" : "comparison.html");
}

Outcome write(const Request& request) {
  std::vector<std::string> words = {"--out", page_of(request)};
  if (request.png) words.insert(words.end(), {"--png", *request.png});
  if (request.says_verdict) words.push_back("--verdict");
  words.push_back("--");
  words.insert(words.end(), request.directories.begin(), request.directories.end());
  return start("spindrift_report.py", std::move(words));
}

Outcome start(const std::string& program, std::vector<std::string> words) {
  // -B: leaves no __pycache__ behind; -E -s: a user's own Python set-up does not matter.
  words.insert(words.begin(), {interpreter(), "-B", "-E", "-s", folder() / program});
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);

  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return {4, std::strerror(errno)};
  std::fflush(stdout);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
  pid_t child = 0;
  std::vector<char*> variables = environment();
  const int error = ::posix_spawn(&child, words[0].c_str(), &actions, nullptr, arguments.data(), variables.data());
  posix_spawn_file_actions_destroy(&actions);
  ::close(ends[1]);
  const std::string said = error == 0 ? read_all(ends[0]) : "";
  ::close(ends[0]);
  if (error != 0)
    return {4, "cannot start " + words[0] + ": " + std::strerror(error) +
                   "; install python3 (ci/setup does) or set SPINDRIFT_PYTHON"};

  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {}
  if (WIFSIGNALED(status)) return {4, words[0] + " was ended by signal " + std::to_string(WTERMSIG(status))};
  const int code = WEXITSTATUS(status);
  if (code == 0) return {};
  return {code == 2 ? 2 : 4, said.empty() ? words[0] + " says nothing" : last_line(said)};
}

void become(const std::string& name, const std::vector<std::string>& given) {
  std::vector<std::string> words = {interpreter(), "-B", "-E", "-s", folder() / name};
  words.insert(words.end(), given.begin(), given.end());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  std::vector<char*> variables = environment();
  ::execve(words[0].c_str(), arguments.data(), variables.data());
  throw std::runtime_error("cannot start " + words[0] + ": " + std::strerror(errno) +
                           "; install python3 (ci/setup does) or set SPINDRIFT_PYTHON");
}

}  // namespace spindrift::report
