// The processor time of posting a reduction: that of the thread alone, so that ranks which share a core do not count.
// perf/reductions/run starts it on 64 ranks and counts the messages. Makes 220 reductions (20 to warm up) of each kind: one
// component and eight, from one part and from 64. Beside them two others of one component from 64 parts: MPI's own
// sum of doubles, whose bits depend on the ranks, and a fixed tree over aligned ranges of parts, whose bits do not. With --own
// these two are left out.
// SPDX-License-Identifier: Apache-2.0
#include <mpi.h>

#include <cstdint>
#include <cstring>
#include <ctime>
#include <numeric>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "perf/harness.hpp"
#include "runtime/mpi/allreduce.hpp"
#include "runtime/mpi/environment.hpp"

namespace {

using namespace spindrift;

/// Of a thread, whoever else runs on its core.
double thread_microseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * double(now.tv_sec) + 1e-3 * double(now.tv_nsec);
}

/// Of asking for the time itself [us].
double clock_time() {
  std::vector<double> times;
  for (int n = 0; n < 1000; ++n) {
    const double begin = thread_microseconds();
    times.push_back(thread_microseconds() - begin);
  }
  return perf::spread(times).median;
}

constexpr int warm_ups = 20, reductions = 200;

/// The program's own.
class Binned {
 public:
  Binned(const runtime::World& world, std::span<const double> partials, std::span<double> sums)
      : reduction_("perf/reductions", {.partials = partials, .result = sums}, world.comm, world.size) {}
  void post(MPI_Request& request) { reduction_.post(request); }
  void finish() { reduction_.finish(); }
  void release() { reduction_.release(); }

 private:
  runtime::Allreduce reduction_;
};

/// Of a sum of n parts: the sums of aligned ranges of 2^k parts that no longer range holds, each of its two halves.
struct Tree {
  static constexpr std::size_t capacity = 26;  // two of each length up to 4096 parts
  struct Range {
    std::uint32_t first, parts;
    double sum;
  };
  std::uint64_t count = 0;
  Range ranges[capacity];

  void add(const Range& range) {  // behind all that are there
    if (count == capacity) throw std::length_error("perf/reductions: too many ranges; ranks have neighbouring parts");
    ranges[count++] = range;
    while (count > 1) {
      Range& left = ranges[count - 2];
      const Range& right = ranges[count - 1];
      const bool halves =
          left.parts == right.parts && left.first % (2 * left.parts) == 0 && right.first == left.first + left.parts;
      if (!halves) return;
      left.sum += right.sum, left.parts *= 2, --count;
    }
  }
  double value() const {
    double sum = 0.0;
    for (std::uint64_t n = 0; n < count; ++n) sum += ranges[n].sum;
    return sum;
  }
};
/// Joins neighbours: MPI keeps the order of ranks where an operation does not commute.
void join_trees(void* in, void* in_out, int* count, MPI_Datatype*) {
  char* to = static_cast<char*>(in_out);
  const char* from = static_cast<const char*>(in);
  for (int n = 0; n < *count; ++n, from += sizeof(Tree), to += sizeof(Tree)) {
    Tree left, right;
    std::memcpy(&left, from, sizeof(Tree)), std::memcpy(&right, to, sizeof(Tree));
    for (std::uint64_t r = 0; r < right.count; ++r) left.add(right.ranges[r]);
    std::memcpy(to, &left, sizeof(Tree));
  }
}

/// A sum of one component by MPI itself: of doubles, or of trees.
template <class Value>
class OfMpi {
 public:
  OfMpi(const runtime::World& world, std::span<const double> partials, std::span<double> sums)
      : comm_(world.comm),
        partials_(partials),
        sum_(sums[0]),
        first_(std::uint32_t(world.rank) * std::uint32_t(partials.size())) {
    if constexpr (std::is_same_v<Value, Tree>) {
      MPI_Type_contiguous(int(sizeof(Tree)), MPI_BYTE, &type_), MPI_Type_commit(&type_);
      MPI_Op_create(join_trees, 0, &operation_);
    }
  }
  void post(MPI_Request& request) {
    value_ = {};
    for (std::uint32_t n = 0; n < partials_.size(); ++n) {
      if constexpr (std::is_same_v<Value, Tree>)
        value_.add({first_ + n, 1, partials_[n]});
      else
        value_ += partials_[n];
    }
    planned_.start(&value_, 1, type_, operation_, comm_, request);
  }
  void finish() {
    if constexpr (std::is_same_v<Value, Tree>)
      sum_ = value_.value();
    else
      sum_ = value_;
  }
  void release() {
    planned_.release();
    if constexpr (std::is_same_v<Value, Tree>) MPI_Type_free(&type_), MPI_Op_free(&operation_);
  }

 private:
  MPI_Comm comm_;
  std::span<const double> partials_;
  double& sum_;
  std::uint32_t first_;
  Value value_{};
  MPI_Datatype type_ = MPI_DOUBLE;
  MPI_Op operation_ = MPI_SUM;
  runtime::PlannedAllreduce planned_;
};

/// Median over reductions and ranks of the processor time of a post [us], on rank 0. Throws where the sum is wrong.
template <class Sum>
double post_time(const runtime::World& world, std::size_t components, std::size_t parts) {
  std::vector<double> partials(components * parts), sums(components);
  std::iota(partials.begin(), partials.end(), double(world.rank));  // small whole numbers, whose sums are exact
  Sum reduction(world, partials, sums);
  MPI_Request request;
  std::vector<double> posts;
  for (int n = -warm_ups; n < reductions; ++n) {
    const double begin = thread_microseconds();
    reduction.post(request);
    const double end = thread_microseconds();
    MPI_Wait(&request, MPI_STATUS_IGNORE);
    reduction.finish();
    if (n >= 0) posts.push_back(end - begin);
  }
  reduction.release();
  const double ranks = world.size, of_each = double(parts);
  const double wanted = of_each * ranks * (ranks - 1.0) / 2.0 + ranks * double(components) * of_each * (of_each - 1.0) / 2.0;
  if (sums[0] != wanted)
    throw std::logic_error("perf/reductions: the sum is " + std::to_string(sums[0]) + ", not " + std::to_string(wanted));
  std::vector<double> all(posts.size() * std::size_t(world.size));
  MPI_Gather(posts.data(), int(posts.size()), MPI_DOUBLE, all.data(), int(posts.size()), MPI_DOUBLE, 0, world.comm);
  return world.rank == 0 ? perf::spread(all).median : 0.0;
}

}  // namespace

int main(int argc, char** argv) {
  runtime::MpiEnvironment mpi(argc, argv);
  const runtime::World& world = mpi.world();
  const bool own = argc == 2 && std::string_view(argv[1]) == "--own";
  std::optional<perf::Group> group;
  if (world.rank == 0) group.emplace("reductions", own ? 1 : argc, argv);
  const double clock = clock_time();
  const std::string ranks = std::to_string(world.size) + " ranks";
  for (const std::size_t components : {1, 8}) {
    const double one = post_time<Binned>(world, components, 1), many = post_time<Binned>(world, components, 64);
    if (!group) continue;
    const std::string of = "sum_of_" + std::to_string(components);
    group->at_most(of + "/post", one - clock, "us", 3.0, perf::Ceiling::none, ranks + ", one part: processor time, median");
    group->figure(of + "/post_64_parts", many - clock, "us", ranks);
  }
  if (own) return 0;
  const double doubles = post_time<OfMpi<double>>(world, 1, 64), tree = post_time<OfMpi<Tree>>(world, 1, 64);
  if (!group) return 0;
  group->figure("sum_of_1/post_64_parts_of_mpi", doubles - clock, "us",
                ranks + ", MPI's sum of doubles: bits depend on the ranks");
  group->figure(
      "sum_of_1/post_64_parts_fixed_tree", tree - clock, "us",
      ranks + ", aligned ranges: " + std::to_string(sizeof(Tree)) + " bytes for 40, parts of a rank must be neighbours");
}
