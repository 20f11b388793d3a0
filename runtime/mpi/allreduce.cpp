// SPDX-License-Identifier: Apache-2.0
#include "runtime/mpi/allreduce.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "runtime/graph/errors.hpp"
#if defined(OPEN_MPI)
#include <mpi-ext.h>  // persistent collectives before MPI 4
#endif

namespace spindrift::runtime {
namespace {

#if MPI_VERSION >= 4 || defined(OMPI_HAVE_MPI_EXT_PCOLLREQ)
constexpr bool started_by_planning = false;
#else
constexpr bool started_by_planning = true;  // this MPI knows no persistent collectives
#endif

/// The smaller one (of larger ones: minus this of the opposites), the same whichever comes first: of zeros the negative one, and
/// not-a-number where either is none.
double smaller(double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return std::numeric_limits<double>::quiet_NaN();
  return a < b || (a == b && std::signbit(a)) ? a : b;
}
double larger(double a, double b) { return -smaller(-a, -b); }

/// MPI's operation over `count` values of T, whose memory need not be aligned for T.
template <class T, class Join>
void join_all(const void* in, void* in_out, int count, Join join) {
  const char* from = static_cast<const char*>(in);
  char* to = static_cast<char*>(in_out);
  for (int n = 0; n < count; ++n, from += sizeof(T), to += sizeof(T)) {
    T a, b;
    std::memcpy(&a, from, sizeof(T)), std::memcpy(&b, to, sizeof(T));
    join(b, a);
    std::memcpy(to, &b, sizeof(T));
  }
}
void add_sums(void* in, void* in_out, int* count, MPI_Datatype*) {
  join_all<BinnedSum>(in, in_out, *count, [](BinnedSum& to, const BinnedSum& with) { to.add(with); });
}
void take_smaller(void* in, void* in_out, int* count, MPI_Datatype*) {
  join_all<double>(in, in_out, *count, [](double& to, double with) { to = smaller(to, with); });
}
void take_larger(void* in, void* in_out, int* count, MPI_Datatype*) {
  join_all<double>(in, in_out, *count, [](double& to, double with) { to = larger(to, with); });
}

/// Made at the first use, of the whole program.
struct Operations {
  MPI_Datatype sum_type = MPI_DATATYPE_NULL;
  MPI_Op sum = MPI_OP_NULL, min = MPI_OP_NULL, max = MPI_OP_NULL;
  Operations() {
    MPI_Type_contiguous(int(sizeof(BinnedSum)), MPI_BYTE, &sum_type);
    MPI_Type_commit(&sum_type);
    constexpr int commutes = 1;
    MPI_Op_create(add_sums, commutes, &sum), MPI_Op_create(take_smaller, commutes, &min),
        MPI_Op_create(take_larger, commutes, &max);
  }
};
const Operations& operations() {
  static const Operations made;
  return made;
}

}  // namespace

void PlannedAllreduce::start(void* values, std::size_t count, MPI_Datatype type, MPI_Op operation, MPI_Comm comm,
                             MPI_Request& request) {
  if (planned_ == MPI_REQUEST_NULL) {
#if MPI_VERSION >= 4
    MPI_Allreduce_init(MPI_IN_PLACE, values, int(count), type, operation, comm, MPI_INFO_NULL, &planned_);
#elif defined(OMPI_HAVE_MPI_EXT_PCOLLREQ)
    MPIX_Allreduce_init(MPI_IN_PLACE, values, int(count), type, operation, comm, MPI_INFO_NULL, &planned_);
#else
    MPI_Iallreduce(MPI_IN_PLACE, values, int(count), type, operation, comm, &planned_);
#endif
  }
  if (started_by_planning) {
    request = std::exchange(planned_, MPI_REQUEST_NULL);
    return;
  }
  MPI_Start(&planned_);
  request = planned_;
}

void PlannedAllreduce::release() {
  if (planned_ != MPI_REQUEST_NULL) MPI_Request_free(&planned_);
}

Allreduce::Allreduce(std::string_view label, Reduction reduction, MPI_Comm comm, int ranks)
    : reduction_(std::move(reduction)), comm_(comm), ranks_(ranks) {
  const std::size_t components = reduction_.result.size();
  if (components == 0 || reduction_.partials.size() % components != 0)
    throw GraphError(std::string(label) + ": " + std::to_string(reduction_.partials.size()) + " partials for " +
                     std::to_string(components) + " components");
  if (reduction_.operation == Reduction::Operation::sum)
    sums_.resize(components);
  else
    extremes_.resize(components);
  if (needs_messages()) operations();  // ahead of the first post, which should be short
}

void Allreduce::take_in() {
  const std::size_t components = reduction_.result.size();
  const std::span<const double> partials = reduction_.partials;
  const auto extreme = [&](double none, auto&& join) {
    std::fill(extremes_.begin(), extremes_.end(), none);
    for (std::size_t n = 0; n < partials.size(); ++n) extremes_[n % components] = join(extremes_[n % components], partials[n]);
  };
  switch (reduction_.operation) {
    case Reduction::Operation::sum:
      for (std::size_t c = 0; c < components; ++c) {
        BinnedSum sum;
        for (std::size_t n = c; n < partials.size(); n += components) sum.add(partials[n]);
        sums_[c] = sum;
      }
      return;
    case Reduction::Operation::min:
      return extreme(std::numeric_limits<double>::infinity(), smaller);
    case Reduction::Operation::max:
      return extreme(-std::numeric_limits<double>::infinity(), larger);
  }
}

void Allreduce::post(MPI_Request& request) {
  take_in();
  const Operations& known = operations();
  // All ranks come here in the same order, as each module's reductions start in one order on its communicator.
  switch (reduction_.operation) {
    case Reduction::Operation::sum:
      return planned_.start(sums_.data(), sums_.size(), known.sum_type, known.sum, comm_, request);
    case Reduction::Operation::min:
      return planned_.start(extremes_.data(), extremes_.size(), MPI_DOUBLE, known.min, comm_, request);
    case Reduction::Operation::max:
      return planned_.start(extremes_.data(), extremes_.size(), MPI_DOUBLE, known.max, comm_, request);
  }
}

void Allreduce::finish() {
  if (!needs_messages()) take_in();
  if (reduction_.operation == Reduction::Operation::sum)
    for (std::size_t c = 0; c < sums_.size(); ++c) reduction_.result[c] = sums_[c].value();
  else
    std::copy(extremes_.begin(), extremes_.end(), reduction_.result.begin());
}

}  // namespace spindrift::runtime
