// How a graph fails. What a message says is for the person who reads the log at night: which task, which rank, what it threw.
// Thrown by runtime/graph and runtime/executor; tested in tests/runtime/failure_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace spindrift::runtime {

/// The graph was recorded wrongly; a programmer's error, found when it is recorded or made ready to run.
struct GraphError : std::logic_error {
  using std::logic_error::logic_error;
};
/// Tasks that wait for each other; the message names them: "a -> b -> a".
struct CycleError : GraphError {
  using GraphError::GraphError;
};
/// A task threw; the graph was cancelled on all ranks.
class TaskError : public std::runtime_error {
 public:
  TaskError(std::string label, int rank, const std::string& what)
      : std::runtime_error("task " + label + " on rank " + std::to_string(rank) + ": " + what),
        label_(std::move(label)),
        rank_(rank) {}
  const std::string& label() const { return label_; }
  int rank() const { return rank_; }

 private:
  std::string label_;
  int rank_;
};
/// Nothing completed for too long; the dump of the graph says what waited for what.
struct HangError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace spindrift::runtime
