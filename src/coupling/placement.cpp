// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/placement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <sstream>

#include "src/coupling/sides.hpp"
#include "src/io/machine_failure.hpp"
#include "src/scene/error.hpp"

namespace spindrift::coupling {

namespace {

/// "rank 0", "ranks 1 to 3", "ranks 0, 2".
std::string named(const std::vector<int>& ranks) {
  if (ranks.size() == 1) return fmt::format("rank {}", ranks[0]);
  if (ranks.back() - ranks.front() + 1 == int(ranks.size())) return fmt::format("ranks {} to {}", ranks.front(), ranks.back());
  std::string all;
  for (const int r : ranks) all += fmt::format("{}{}", all.empty() ? "" : ", ", r);
  return "ranks " + all;
}

/// The first line in which two texts differ, as "a" and "b".
std::string difference(const std::string& a, const std::string& b) {
  std::istringstream first(a), second(b);
  std::string x, y;
  while (true) {
    const bool more_x = bool(std::getline(first, x)), more_y = bool(std::getline(second, y));
    if (!more_x && !more_y) return "";
    if (!more_x) x.clear();
    if (!more_y) y.clear();
    if (x != y) return fmt::format("\"{}\" and \"{}\"", x, y);
  }
}

/// Ranks whose text is not that of rank 0, with the difference to the first of them, are refused.
void require_same(const std::vector<std::string>& by_rank, const std::string& what) {
  std::vector<int> same, other;
  for (int r = 0; r < int(by_rank.size()); ++r) (by_rank[std::size_t(r)] == by_rank[0] ? same : other).push_back(r);
  if (other.empty()) return;
  throw io::InputError(fmt::format("{} and {} were started with different {}: {}", named(same), named(other), what,
                                   difference(by_rank[0], by_rank[std::size_t(other[0])])));
}

std::vector<std::string> from_all(const runtime::World& world, const std::string& mine) {
  runtime::Packer parcel;
  parcel.put(std::span<const char>(mine));
  std::vector<std::string> all;
  for (const runtime::Bytes& bytes : runtime::exchange_all(world.comm, parcel.take())) {
    const std::vector<char> text = runtime::Unpacker(bytes).many<char>();
    all.emplace_back(text.begin(), text.end());
  }
  return all;
}

}  // namespace

void agree(const runtime::World& world, const std::function<Started()>& read) {
  Started mine;
  std::exception_ptr failure;
  std::string why;
  try {
    mine = read();
  } catch (const std::exception& e) { failure = std::current_exception(), why = e.what(); }
  if (world.size == 1) {
    if (failure) std::rethrow_exception(failure);
    return;
  }
  const std::vector<std::string> failures = from_all(world, failure ? "!" + why : "");
  std::vector<int> failing;
  for (int r = 0; r < world.size; ++r)
    if (!failures[std::size_t(r)].empty()) failing.push_back(r);
  if (failure) std::rethrow_exception(failure);
  if (!failing.empty())
    throw io::InputError(
        fmt::format("{} cannot read what this one can: {}", named(failing), failures[std::size_t(failing[0])].substr(1)));
  std::vector<int> said, silent;
  const std::vector<std::string> fluids = from_all(world, mine.fluid);
  for (int r = 0; r < world.size; ++r) (fluids[std::size_t(r)].empty() ? silent : said).push_back(r);
  if (!said.empty() && !silent.empty())
    throw io::InputError(fmt::format("{} were started with --fluid, {} without: give it to all program sections or to none",
                                     named(said), named(silent)));
  require_same(from_all(world, mine.scene), "scenes");
  require_same(from_all(world, mine.rest), "options");
}

runtime::Parts place(const Scenario& s, const runtime::World& world, const std::string& fluid) {
  const auto refuse = [&](const char* key, const std::string& value, std::string message) {
    throw scene::SceneError({{s.source, 0, key, value, std::move(message)}});
  };
  const bool coupled = s.has_rotor() && s.coupling.scheme != SchemeKind::monolithic;
  if (!fluid.empty()) {
    if (!coupled) refuse("coupling.scheme", "", "leaves nothing to split: --fluid is for a rotor that is coupled by windows");
    const std::vector<std::string> fluids = from_all(world, fluid);
    const auto air = std::count(fluids.begin(), fluids.end(), "air");
    if (air == 0 || air == world.size)
      throw io::InputError(fmt::format("all {} ranks were started with --fluid {}: the other fluid needs a program section too",
                                       world.size, fluid));
    if (s.coupling.placement == Placing::split && s.coupling.air_ranks != air)
      refuse("coupling.air_ranks", std::to_string(s.coupling.air_ranks),
             fmt::format("is not what was started: {} ranks with --fluid air", air));
    return runtime::Parts(world, 2, fluid == "air" ? air_part : sea_part);
  }
  if (!coupled || s.coupling.placement == Placing::shared) return runtime::Parts(world);
  const int air = s.coupling.air_ranks;
  if (world.size < air + 1)
    refuse("coupling.air_ranks", std::to_string(air),
           fmt::format("leaves no rank for the sea: the run has {}; start it with mpirun -n {} or more, or set "
                       "coupling.placement = \"shared\"",
                       world.size == 1 ? "one rank" : fmt::format("{} ranks", world.size), air + 1));
  return runtime::Parts(world, 2, world.rank < world.size - air ? sea_part : air_part);
}

}  // namespace spindrift::coupling
