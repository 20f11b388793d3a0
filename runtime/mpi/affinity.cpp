// SPDX-License-Identifier: Apache-2.0
#include "runtime/mpi/affinity.hpp"

#include <omp.h>
#include <sched.h>

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "runtime/mpi/exchange.hpp"

namespace spindrift::runtime {

namespace {

std::string counted(std::size_t n, const std::string& one) { return std::to_string(n) + " " + one + (n == 1 ? "" : "s"); }

std::string numbered(const std::vector<int>& processors) {
  std::string text = processors.size() == 1 ? "processor " : "processors ";
  return text += list_of(processors);
}

std::string ranks_of(std::span<const RankPlace* const> places) {
  std::vector<int> ranks;
  for (const RankPlace* p : places) ranks.push_back(p->rank);
  return (ranks.size() == 1 ? "rank " : "ranks ") + list_of(ranks);
}

/// Ranks with more threads than processors, those with the same numbers together.
void add_narrow(std::span<const RankPlace> node, std::vector<std::string>& found) {
  std::map<std::pair<int, std::size_t>, std::vector<const RankPlace*>> alike;
  for (const RankPlace& p : node)
    if (!p.processors.empty() && std::size_t(p.threads) > p.processors.size())
      alike[{p.threads, p.processors.size()}].push_back(&p);
  for (const auto& [numbers, places] : alike) {
    const auto& [threads, processors] = numbers;
    const std::string each = places.size() == 1 ? "" : " each";
    found.push_back(ranks_of(places) + (places.size() == 1 ? " has " : " have ") + std::to_string(threads) + " threads on " +
                    counted(processors, "processor") + each + ": they take turns. Let a rank use as many processors " +
                    "(mpirun --map-by slot:PE=" + std::to_string(threads) + ", srun --cpus-per-task=" + std::to_string(threads) +
                    "), or set OMP_NUM_THREADS=" + std::to_string(processors));
  }
}

/// Ranks on processors that get more than one thread, each rank's threads spread evenly over its own and at most one to each.
void add_shared(std::span<const RankPlace> node, std::vector<std::string>& found) {
  std::map<int, double> load;
  for (const RankPlace& p : node)
    for (const int processor : p.processors) load[processor] += std::min(1.0, p.threads / double(p.processors.size()));
  constexpr double rounding = 1e-9;
  std::vector<const RankPlace*> sharing;
  std::vector<int> shared;
  std::size_t threads = 0;
  for (const auto& [processor, n] : load)
    if (n > 1.0 + rounding) shared.push_back(processor);
  if (shared.empty()) return;
  for (const RankPlace& p : node)
    if (std::ranges::any_of(p.processors, [&](int n) { return load.at(n) > 1.0 + rounding; }))
      sharing.push_back(&p), threads += std::size_t(p.threads);
  found.push_back(ranks_of(sharing) + (shared.size() == 1 ? " share processor " : " share processors ") + list_of(shared) + ", " +
                  counted(threads, "thread") + " in all: they take turns. Start fewer ranks or threads, or give each rank " +
                  "processors of its own (mpirun --map-by slot:PE=N, srun --cpus-per-task=N)");
}

/// Places of the ranks of this rank's node, on the node's first rank.
std::vector<RankPlace> gathered(MPI_Comm node, const RankPlace& mine) {
  std::vector<int> words{mine.rank, mine.threads};
  words.insert(words.end(), mine.processors.begin(), mine.processors.end());
  const int ranks = ranks_in(node);
  std::vector<int> counts(std::size_t(ranks), 0), at(std::size_t(ranks) + 1, 0);
  const int count = int(words.size());
  MPI_Gather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, 0, node);
  for (std::size_t r = 0; r < counts.size(); ++r) at[r + 1] = at[r] + counts[r];
  std::vector<int> all(std::size_t(at.back()), 0);
  MPI_Gatherv(words.data(), count, MPI_INT, all.data(), counts.data(), at.data(), MPI_INT, 0, node);
  std::vector<RankPlace> places;
  if (rank_in(node) != 0) return places;
  for (std::size_t r = 0; r < counts.size(); ++r) {
    const auto first = all.begin() + at[r];
    places.push_back({first[0], first[1], std::vector<int>(first + 2, all.begin() + at[r + 1])});
  }
  return places;
}

std::string described(std::span<const RankPlace> node) {
  std::map<std::pair<std::vector<int>, int>, std::vector<const RankPlace*>> alike;
  for (const RankPlace& p : node) alike[{p.processors, p.threads}].push_back(&p);
  std::vector<std::pair<int, std::string>> lines;
  for (const auto& [place, ranks] : alike) {
    const auto& [processors, threads] = place;
    lines.emplace_back(ranks[0]->rank, ranks_of(ranks) + ": " + counted(std::size_t(threads), "thread") +
                                           (ranks.size() == 1 ? "" : " each") + " on " +
                                           (processors.empty() ? "unknown processors" : numbered(processors)));
  }
  std::ranges::sort(lines);
  constexpr std::size_t most = 8;
  std::string text;
  for (std::size_t n = 0; n < std::min(lines.size(), most); ++n) text += (n == 0 ? "" : "; ") + lines[n].second;
  if (lines.size() > most) text += "; and so on";
  return text;
}

}  // namespace

RankPlace own_place(int rank, int threads) {
  RankPlace place{rank, threads, {}};
  // Where OpenMP binds threads (OMP_PROC_BIND), the system's answer is the place of this thread alone.
  const int bound = omp_get_proc_bind() == omp_proc_bind_false ? 0 : omp_get_num_places();
  for (int n = 0; n < bound; ++n) {
    std::vector<int> of_place(std::size_t(omp_get_place_num_procs(n)), 0);
    omp_get_place_proc_ids(n, of_place.data());
    place.processors.insert(place.processors.end(), of_place.begin(), of_place.end());
  }
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  if (place.processors.empty() && sched_getaffinity(0, sizeof allowed, &allowed) == 0)
    for (int n = 0; n < CPU_SETSIZE; ++n)
      if (CPU_ISSET(n, &allowed)) place.processors.push_back(n);
  std::ranges::sort(place.processors);
  place.processors.erase(std::unique(place.processors.begin(), place.processors.end()), place.processors.end());
  return place;
}

std::string list_of(std::span<const int> ascending) {
  std::string list;
  for (std::size_t first = 0; first < ascending.size();) {
    std::size_t last = first;
    while (last + 1 < ascending.size() && ascending[last + 1] == ascending[last] + 1) ++last;
    if (!list.empty()) list += ',';
    list += std::to_string(ascending[first]);
    if (last > first) list.append("-").append(std::to_string(ascending[last]));
    first = last + 1;
  }
  return list;
}

std::vector<std::string> crowding(std::span<const RankPlace> node) {
  std::vector<std::string> found;
  add_narrow(node, found);
  add_shared(node, found);
  return found;
}

Affinity affinity(const World& world, int threads) {
  MPI_Comm node;
  MPI_Comm_split_type(world.comm, MPI_COMM_TYPE_SHARED, world.rank, MPI_INFO_NULL, &node);
  const std::vector<RankPlace> places = gathered(node, own_place(world.rank, threads));
  MPI_Comm_free(&node);
  std::vector<std::string> mine = crowding(places);
  std::string text;
  for (const std::string& sentence : mine) text += sentence + '\n';

  // The first node that has something to say tells rank 0.
  int numbers[2] = {text.empty() ? std::numeric_limits<int>::max() : world.rank, 0};
  MPI_Allreduce(&numbers[0], &numbers[1], 1, MPI_INT, MPI_MIN, world.comm);
  Affinity all;
  if (world.rank == 0) all.places = described(places);
  if (numbers[1] == std::numeric_limits<int>::max()) return all;
  constexpr int tag = 0;
  if (numbers[1] != 0 && world.rank == numbers[1]) MPI_Send(text.data(), int(text.size()), MPI_CHAR, 0, tag, world.comm);
  if (world.rank != 0) return all;
  if (numbers[1] != 0) {
    MPI_Status status;
    int size = 0;
    MPI_Probe(numbers[1], tag, world.comm, &status);
    MPI_Get_count(&status, MPI_CHAR, &size);
    text.resize(std::size_t(size));
    MPI_Recv(text.data(), size, MPI_CHAR, numbers[1], tag, world.comm, MPI_STATUS_IGNORE);
  }
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    all.crowding.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return all;
}

}  // namespace spindrift::runtime
