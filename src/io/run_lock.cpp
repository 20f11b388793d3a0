// SPDX-License-Identifier: Apache-2.0
#include "src/io/run_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <climits>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <sstream>

#include "runtime/mpi/stop_request.hpp"
#include "src/io/machine_failure.hpp"

namespace spindrift::io {

namespace fs = std::filesystem;

namespace {

std::string first_line(const fs::path& path) {
  std::ifstream in(path);
  std::string line;
  std::getline(in, line);
  return line;
}

std::string host_name() {
  std::array<char, HOST_NAME_MAX + 1> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? std::string(name.data()) : std::string("unknown");
}

/// The same for processes that can see each other by number: this start of the machine, this set of process numbers.
std::string process_space() {
  std::error_code none;
  const fs::path numbers = fs::read_symlink("/proc/self/ns/pid", none);
  return first_line("/proc/sys/kernel/random/boot_id") + " " + numbers.string();
}

/// When a process began, in ticks since the machine's start; empty where there is none or only its exit code is left. A number
/// used again has another.
std::string started(long pid) {
  const std::string line = first_line(fmt::format("/proc/{}/stat", pid));
  const std::size_t name_end = line.rfind(')');  // of the program, which may have blanks
  if (name_end == std::string::npos) return "";
  std::istringstream words(line.substr(name_end + 1));
  std::string word;
  words >> word;  // field 3 of proc(5): the state
  if (word == "Z" || word == "X") return "";
  for (int n = 0; n < 19 && words >> word; ++n) {}  // field 22
  return word;
}

struct Holder {
  std::string all, host, space, started, beat;
  long pid = 0;
};

std::optional<Holder> read_holder(const fs::path& path) {
  std::ifstream in(path);
  if (!in) return std::nullopt;
  Holder holder;
  for (std::string line; std::getline(in, line);) {
    holder.all += line + "\n";
    const std::size_t equals = line.find(" = ");
    if (equals == std::string::npos) continue;
    const std::string key = line.substr(0, equals), value = line.substr(equals + 3);
    if (key == "host") holder.host = value;
    if (key == "processes") holder.space = value;
    if (key == "started") holder.started = value;
    if (key == "heartbeat") holder.beat = value;
    if (key == "process") holder.pid = std::atol(value.c_str());
  }
  return holder;
}

[[noreturn]] void refuse(const fs::path& path, const Holder& holder) {
  throw InputError(
      fmt::format("run directory {}: a run is at work in it (process {} on {}, {}); wait for it or end it, or choose another "
                  "folder with --out",
                  path.parent_path().string(), holder.pid, holder.host, path.filename().string()));
}

/// Whether the holder runs; looks on for a while where only its heartbeat can tell.
bool lives(const fs::path& path, const Holder& holder, const LockTimes& times) {
  if (holder.space == process_space() && holder.pid > 0) {
    const std::string since = started(holder.pid);
    return !since.empty() && since == holder.started;
  }
  spdlog::warn("{} is that of process {} on {}: looking for its heartbeat for {} s", path.string(), holder.pid, holder.host,
               std::chrono::duration<double>(times.stale).count());
  const auto end = std::chrono::steady_clock::now() + times.stale;
  while (std::chrono::steady_clock::now() < end) {
    runtime::StopRequest::give_up_if_asked();
    std::this_thread::sleep_for(std::min(times.beat / 5, times.stale / 5));
    const std::optional<Holder> now = read_holder(path);
    if (!now || now->all != holder.all) return now.has_value();
  }
  return false;
}

/// Removes the lock of a holder that is gone; false where another run was quicker.
bool remove_stale(const fs::path& path, const Holder& holder) {
  const fs::path aside = path.string() + fmt::format(".stale_{}_{}", host_name(), ::getpid());
  if (::rename(path.c_str(), aside.c_str()) != 0) return errno == ENOENT;
  const std::optional<Holder> moved = read_holder(aside);
  const bool same = moved && moved->all == holder.all;
  if (!same) ::link(aside.c_str(), path.c_str());  // a new run's, taken between reading and renaming: back with it
  ::unlink(aside.c_str());
  return same;
}

std::string heartbeat_line(std::uint64_t beat) { return fmt::format("heartbeat = {:012}\n", beat); }

}  // namespace

RunLock::RunLock(const fs::path& folder, LockTimes times) : path_(folder / file_name), times_(times) {
  const long pid = ::getpid();
  mine_ = fmt::format("host = {}\nprocess = {}\nstarted = {}\nprocesses = {}\n", host_name(), pid, started(pid), process_space());
  for (int attempt = 0; descriptor_ < 0; ++attempt) {
    descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ >= 0) break;
    if (errno != EEXIST) throw_errno("cannot create", path_, errno);
    const std::optional<Holder> holder = read_holder(path_);
    if (!holder) {  // given back meanwhile, or not ours to read
      if (attempt < 100) continue;
      throw_errno("cannot read", path_, errno);
    }
    if (lives(path_, *holder, times_)) refuse(path_, *holder);
    if (!remove_stale(path_, *holder)) refuse(path_, *holder);
    spdlog::warn("run directory {}: the run before (process {} on {}) ended without giving back its lock",
                 path_.parent_path().string(), holder->pid, holder->host);
  }
  const std::string text = mine_ + heartbeat_line(0);
  if (::pwrite(descriptor_, text.data(), text.size(), 0) != ssize_t(text.size())) {
    const int error = errno;
    ::unlink(path_.c_str());
    ::close(descriptor_);
    throw_errno("cannot write", path_, error);
  }
  ::fsync(descriptor_);
  heart_ = std::thread([this] { beat(); });
}

RunLock::~RunLock() {
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    done_ = true;
  }
  wake_.notify_all();
  heart_.join();
  ::unlink(path_.c_str());
  ::close(descriptor_);
}

void RunLock::beat() {
  sigset_t all;  // signals are for the threads that look at them
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, nullptr);
  std::unique_lock<std::mutex> guard(mutex_);
  for (std::uint64_t number = 1; !wake_.wait_for(guard, times_.beat, [this] { return done_; }); ++number) {
    // Stopped for so long that another run took the lock: what this one would write now would spoil that one's files.
    const std::optional<Holder> now = read_holder(path_);
    if (now && !now->all.starts_with(mine_)) {
      spdlog::critical("{} is now that of process {} on {}: this run ends, its files belong to that one", path_.string(),
                       now->pid, now->host);
      std::_Exit(4);
    }
    const std::string line = heartbeat_line(number);
    if (::pwrite(descriptor_, line.data(), line.size(), off_t(mine_.size())) == ssize_t(line.size())) ::fsync(descriptor_);
  }
}

}  // namespace spindrift::io
