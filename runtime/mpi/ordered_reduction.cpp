// SPDX-License-Identifier: Apache-2.0
#include "runtime/mpi/ordered_reduction.hpp"

#include <algorithm>
#include <numeric>

#include "runtime/graph/errors.hpp"

namespace spindrift::runtime {

OrderedReduction::OrderedReduction(std::string_view label, Reduction reduction, MPI_Comm comm)
    : reduction_(std::move(reduction)), comm_(comm), counts_(std::size_t(comm_.size())), offsets_(counts_.size()) {
  const std::size_t components = reduction_.result.size();
  if (reduction_.partials.size() != reduction_.parts.size() * components)
    throw GraphError(std::string(label) + ": reduces " + std::to_string(reduction_.parts.size()) + " parts x " +
                     std::to_string(components) + " components, but there are " + std::to_string(reduction_.partials.size()) +
                     " partials");
  std::vector<std::int64_t> parts = reduction_.parts;
  if (needs_messages()) {
    const int mine = int(reduction_.parts.size());
    MPI_Allgather(&mine, 1, MPI_INT, counts_.data(), 1, MPI_INT, comm_.get());
    std::exclusive_scan(counts_.begin(), counts_.end(), offsets_.begin(), 0);
    parts.resize(std::size_t(offsets_.back() + counts_.back()));
    MPI_Allgatherv(reduction_.parts.data(), mine, MPI_INT64_T, parts.data(), counts_.data(), offsets_.data(), MPI_INT64_T,
                   comm_.get());
    for (std::size_t r = 0; r < counts_.size(); ++r) counts_[r] *= int(components), offsets_[r] *= int(components);
  }
  std::vector<std::size_t> order(parts.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return parts[a] < parts[b]; });
  for (std::size_t n = 1; n < order.size(); ++n)
    if (parts[order[n]] == parts[order[n - 1]])
      throw GraphError(std::string(label) + ": part " + std::to_string(parts[order[n]]) + " is given twice");
  for (const std::size_t part : order) first_of_.push_back(part * components);
  gathered_.resize(parts.size() * components);
}

void OrderedReduction::post(MPI_Request& request) {
  MPI_Iallgatherv(reduction_.partials.data(), int(reduction_.partials.size()), MPI_DOUBLE, gathered_.data(), counts_.data(),
                  offsets_.data(), MPI_DOUBLE, comm_.get(), &request);
}

void OrderedReduction::finish() {
  const double* values = needs_messages() ? gathered_.data() : reduction_.partials.data();
  const auto fold = [&](auto&& combine) {
    for (std::size_t c = 0; c < reduction_.result.size(); ++c) {
      double total = first_of_.empty() ? 0.0 : values[first_of_[0] + c];
      for (std::size_t n = 1; n < first_of_.size(); ++n) total = combine(total, values[first_of_[n] + c]);
      reduction_.result[c] = total;
    }
  };
  switch (reduction_.operation) {
    case Reduction::Operation::sum:
      return fold([](double a, double b) { return a + b; });
    case Reduction::Operation::min:
      return fold([](double a, double b) { return std::min(a, b); });
    case Reduction::Operation::max:
      return fold([](double a, double b) { return std::max(a, b); });
  }
}

}  // namespace spindrift::runtime
