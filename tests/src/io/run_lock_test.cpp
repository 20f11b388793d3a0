// One run in a folder: run_lock.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "src/io/run_lock.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>

#include "runtime/mpi/stop_request.hpp"
#include "src/io/atomic_file.hpp"
#include "src/io/machine_failure.hpp"
#include "tests/src/io/scratch.hpp"

using namespace spindrift;
using Catch::Matchers::Contains;
using namespace std::chrono_literals;

namespace {

constexpr io::LockTimes quick{.beat = 50ms, .stale = 400ms};

/// A lock as another machine would have left it.
void write_foreign(const std::filesystem::path& file, int beat) {
  io::write_atomically(
      file, fmt::format("host = elsewhere\nprocess = 7\nstarted = 1\nprocesses = another\nheartbeat = {:012}\n", beat));
}

}  // namespace

TEST_CASE("the second run in a folder is refused with the name of the first", "[io][faults][fast]") {
  const test::Scratch folder("lock");
  {
    const io::RunLock first(folder.path(), quick);
    CHECK_THROWS_AS(io::RunLock(folder.path(), quick), io::InputError);
    CHECK_THROWS_WITH(io::RunLock(folder.path(), quick), Contains(fmt::format("process {} on", ::getpid())) && Contains("--out"));
  }
  CHECK_FALSE(std::filesystem::exists(folder / io::RunLock::file_name));
  const io::RunLock next(folder.path(), quick);
}

TEST_CASE("the lock of a process that is gone is taken over at once", "[io][faults][fast]") {
  const test::Scratch folder("lock");
  const pid_t child = ::fork();
  if (child == 0) {  // takes it, then dies without giving it back
    io::RunLock* held = new io::RunLock(folder.path());
    std::_Exit(held ? 0 : 1);
  }
  const auto begin = std::chrono::steady_clock::now();
  siginfo_t ended;
  REQUIRE(::waitid(P_PID, id_t(child), &ended, WEXITED | WNOWAIT) == 0);  // nobody has asked for its exit code yet
  REQUIRE(std::filesystem::exists(folder / io::RunLock::file_name));
  { const io::RunLock mine(folder.path()); }
  CHECK(std::chrono::steady_clock::now() - begin < 5s);
  REQUIRE(::waitpid(child, nullptr, 0) == child);
}

TEST_CASE("a lock of another machine is stale when its heartbeat stands still, and only then", "[io][faults][fast]") {
  const test::Scratch folder("lock");
  const std::filesystem::path file = folder / io::RunLock::file_name;
  write_foreign(file, 3);
  { const io::RunLock mine(folder.path(), quick); }
  write_foreign(file, 3);
  std::atomic<bool> done = false;
  std::thread other([&] {
    for (int beat = 4; !done; ++beat) std::this_thread::sleep_for(50ms), write_foreign(file, beat);
  });
  CHECK_THROWS_WITH(io::RunLock(folder.path(), quick), Contains("process 7 on elsewhere"));
  done = true;
  other.join();
  CHECK(std::filesystem::exists(file));
}

TEST_CASE("waiting for another machine's heartbeat ends with a request to stop, and leaves the lock", "[io][faults][fast]") {
  const test::Scratch folder("lock");
  const std::filesystem::path file = folder / io::RunLock::file_name;
  write_foreign(file, 3);
  const std::string before = io::read_file(file);
  const runtime::StopRequest stop;
  ::raise(SIGTERM);
  CHECK_THROWS_AS(io::RunLock(folder.path(), {.beat = 50ms, .stale = 600s}), runtime::StopAsked);
  CHECK(io::read_file(file) == before);
}

TEST_CASE("a lock that its process did not come to write is stale too", "[io][faults][fast]") {
  const test::Scratch folder("lock");
  std::ofstream(folder / io::RunLock::file_name).put('\n');
  const io::RunLock mine(folder.path(), quick);
  CHECK_THAT(io::read_file(folder / io::RunLock::file_name), Contains(fmt::format("process = {}", ::getpid())));
}
