// SPDX-License-Identifier: Apache-2.0
#include "src/io/collective.hpp"

#include <algorithm>
#include <cstring>
#include <exception>

#include "runtime/mpi/stop_request.hpp"
#include "src/io/machine_failure.hpp"

namespace spindrift::io {

namespace {

enum class Failure : int { none, input, machine, stop, other };

/// What every rank learns of the first failure.
void throw_everywhere(MPI_Comm comm, Failure mine, std::string message) {
  const int size = size_of(comm);
  int failing = mine == Failure::none ? size : rank_of(comm);
  MPI_Allreduce(MPI_IN_PLACE, &failing, 1, MPI_INT, MPI_MIN, comm);
  if (failing == size) return;
  int kind = static_cast<int>(mine);
  int length = static_cast<int>(message.size());
  MPI_Bcast(&kind, 1, MPI_INT, failing, comm);
  MPI_Bcast(&length, 1, MPI_INT, failing, comm);
  message.resize(static_cast<std::size_t>(length));
  MPI_Bcast(message.data(), length, MPI_CHAR, failing, comm);
  switch (static_cast<Failure>(kind)) {
    case Failure::input:
      throw InputError(message);
    case Failure::machine:
      throw MachineFailure(message);
    case Failure::stop:
      throw runtime::StopAsked();
    case Failure::none:
    case Failure::other:
      break;
  }
  throw std::runtime_error(message);
}

void guarded(MPI_Comm comm, bool takes_part, const std::function<void()>& work) {
  Failure failure = Failure::none;
  std::string message;
  try {
    if (takes_part) work();
  } catch (const InputError& error) { failure = Failure::input, message = error.what(); } catch (const MachineFailure& error) {
    failure = Failure::machine, message = error.what();
  } catch (const runtime::StopAsked&) { failure = Failure::stop; } catch (const std::exception& error) {
    failure = Failure::other, message = error.what();
  }
  throw_everywhere(comm, failure, std::move(message));
}

}  // namespace

int rank_of(MPI_Comm comm) {
  int rank = 0;
  MPI_Comm_rank(comm, &rank);
  return rank;
}

int size_of(MPI_Comm comm) {
  int size = 1;
  MPI_Comm_size(comm, &size);
  return size;
}

void together(MPI_Comm comm, const std::function<void()>& work) { guarded(comm, true, work); }

void on_root(MPI_Comm comm, const std::function<void()>& work) { guarded(comm, rank_of(comm) == 0, work); }

std::string from_root(MPI_Comm comm, std::string text) {
  int length = static_cast<int>(text.size());
  MPI_Bcast(&length, 1, MPI_INT, 0, comm);
  text.resize(static_cast<std::size_t>(length));
  MPI_Bcast(text.data(), length, MPI_CHAR, 0, comm);
  return text;
}

void throw_errno(const std::string& what, const std::string& path, int error) {
  throw MachineFailure(what + " " + path + ": " + std::strerror(error));
}

}  // namespace spindrift::io
