// Requests to stop: runtime/mpi/stop_request.hpp.
// SPDX-License-Identifier: Apache-2.0
#include "runtime/mpi/stop_request.hpp"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <thread>

using Catch::Matchers::Contains;
using spindrift::runtime::give_up_together, spindrift::runtime::StopAsked, spindrift::runtime::StopRequest;
using namespace std::chrono_literals;

namespace {

/// The signal that ends a process which does this.
template <class Body>
int ended_by(Body&& body) {
  const pid_t child = ::fork();
  if (child == 0) {
    body();
    std::_Exit(0);
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  REQUIRE(WIFSIGNALED(status));
  return WTERMSIG(status);
}

}  // namespace

TEST_CASE("every signal that queues and terminals send is a request, with its name", "[runtime][faults][fast]") {
  for (const auto& [number, name] : {std::pair{SIGTERM, "SIGTERM"}, std::pair{SIGINT, "SIGINT"}, std::pair{SIGUSR1, "SIGUSR1"},
                                     std::pair{SIGUSR2, "SIGUSR2"}, std::pair{SIGHUP, "SIGHUP"}, std::pair{SIGXCPU, "SIGXCPU"}}) {
    const StopRequest stop;
    CHECK_FALSE(StopRequest::asked());
    CHECK(stop.agreed(MPI_COMM_SELF).empty());
    ::raise(number);
    ::raise(number);  // by another way, at once
    CHECK(StopRequest::asked());
    CHECK_THAT(stop.agreed(MPI_COMM_SELF), Contains(name));
  }
  CHECK_FALSE(StopRequest::asked());
}

TEST_CASE("a signal that comes before there is anything to stop is not lost", "[runtime][faults][fast]") {
  StopRequest::catch_signals();
  ::raise(SIGTERM);
  {
    const StopRequest stop;
    CHECK(StopRequest::asked());
    CHECK_THAT(stop.agreed(MPI_COMM_SELF), Contains("SIGTERM"));
  }
  const StopRequest next;
  CHECK_FALSE(StopRequest::asked());
}

TEST_CASE("the limit on wall time leaves room for saving", "[runtime][faults][fast]") {
  StopRequest stop(3600.0);
  CHECK_FALSE(StopRequest::asked());
  stop.keep_margin(3601.0);
  CHECK(StopRequest::asked());
  CHECK_THAT(stop.agreed(MPI_COMM_SELF), Contains("runtime.wall_limit_s"));
}

TEST_CASE("a file is a request when it appears, not one left by the run before", "[runtime][faults][fast]") {
  const std::filesystem::path file = std::filesystem::temp_directory_path() / ("spindrift_stop_" + std::to_string(::getpid()));
  std::ofstream(file).put('\n');
  const StopRequest stop(0.0, file);
  CHECK_FALSE(StopRequest::asked());
  std::ofstream(file).put('\n');
  std::this_thread::sleep_for(1100ms);
  CHECK(StopRequest::asked());
  CHECK_THAT(stop.agreed(MPI_COMM_SELF), Contains("file"));
  CHECK_FALSE(std::filesystem::exists(file));
}

TEST_CASE("what is over cannot be stopped, until the signals are given back", "[runtime][faults][fast]") {
  CHECK(ended_by([] {
          {
            StopRequest stop;
            stop.over();
          }
          ::raise(SIGTERM), ::raise(SIGUSR2);
          StopRequest::give_signals_back();
          ::raise(SIGHUP);
        }) == SIGHUP);
}

TEST_CASE("a request that is gone gives the signals back", "[runtime][faults][fast]") {
  CHECK(ended_by([] {
          { const StopRequest stop; }
          ::raise(SIGTERM);
        }) == SIGTERM);
}

TEST_CASE("a signal to one rank is known to all, which give up work that each does alone",
          "[runtime][faults][fast][mpi2][mpi4]") {
  int rank = 0, size = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  const StopRequest stop;
  CHECK_NOTHROW(give_up_together(MPI_COMM_WORLD, [] { StopRequest::give_up_if_asked(); }));
  MPI_Barrier(MPI_COMM_WORLD);
  if (rank == size - 1) ::raise(SIGTERM);
  const auto latest = std::chrono::steady_clock::now() + 60s;
  const auto work = [&] {
    while (std::chrono::steady_clock::now() < latest) {
      StopRequest::give_up_if_asked();
      std::this_thread::sleep_for(1ms);
    }
  };
  CHECK_THROWS_AS(give_up_together(MPI_COMM_WORLD, work), StopAsked);
  CHECK(StopRequest::signal_caught() == SIGTERM);
  if (rank != size - 1) ::raise(SIGTERM);  // its own is no second one
  MPI_Barrier(MPI_COMM_WORLD);
  std::this_thread::sleep_for(1100ms);  // the heartbeat has seen that it was passed on
}

TEST_CASE("a rank of which all have heard that it is to stop gives up without a signal of its own", "[runtime][faults][mpi4]") {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  CHECK_THROWS_AS(give_up_together(MPI_COMM_WORLD,
                                   [&] {
                                     if (rank == 2) throw StopAsked();
                                   }),
                  StopAsked);
}

TEST_CASE("a second signal ends the program also where the limit on wall time asked before", "[runtime][faults][fast]") {
  CHECK(ended_by([] {
          StopRequest stop(3600.0);
          stop.keep_margin(3601.0);
          if (!StopRequest::asked()) std::_Exit(1);
          ::raise(SIGTERM);
          std::this_thread::sleep_for(1100ms);
          ::raise(SIGTERM);
        }) == SIGTERM);
}

TEST_CASE("a second signal ends the program at once", "[runtime][faults][fast]") {
  CHECK(ended_by([] {
          const StopRequest stop;
          ::raise(SIGTERM);
          std::this_thread::sleep_for(1100ms);
          ::raise(SIGUSR1);
        }) == SIGUSR1);
}
