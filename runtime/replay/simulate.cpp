// The tokens, queues and rules of stealing follow runtime/executor/worker.cpp line by line, with time in place of threads. A push
// wakes an idle thread at once, an idle thread takes others' tasks 1 us after it ran out of its own, messages are noticed between
// tasks or by an idle thread. SPDX-License-Identifier: Apache-2.0
#include "runtime/replay/simulate.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <deque>
#include <functional>
#include <memory>
#include <queue>
#include <random>
#include <stdexcept>
#include <tuple>

#include "runtime/executor/priority.hpp"
#include "runtime/executor/program.hpp"
#include "runtime/executor/ready_queue.hpp"
#include "runtime/graph/recorded.hpp"
#include "runtime/replay/rebuild.hpp"
#include "runtime/trace/rank_trace.hpp"

namespace spindrift::runtime {

namespace {

constexpr double steal_after_s = 1e-6;

struct Thread {
  std::uint32_t pocket = no_node;
  std::array<std::deque<std::uint32_t>, max_levels> queue;
  bool busy = false;
  double idle_since = 0.0;
  int top() const {
    for (int l = max_levels - 1; l >= 0; --l)
      if (!queue[std::size_t(l)].empty()) return l;
    return -1;
  }
  std::uint32_t pop(int level) {
    const std::uint32_t slot = queue[std::size_t(level)].front();
    queue[std::size_t(level)].pop_front();
    return slot;
  }
};

/// What a token brings: when the longest chain behind it ends, and the last step of that chain.
struct Path {
  double s = 0.0;
  std::uint32_t last = no_node;
};
const Path& longer(const Path& a, const Path& b) { return a.s < b.s ? b : a; }

/// The steps of all chains, each of them after another one; families of labels by number.
class Chains {
 public:
  Path after(const Path& before, double s, std::uint32_t family) {
    if (s <= 0.0) return before;
    steps_.push_back({before.last, family, s});
    return {before.s + s, std::uint32_t(steps_.size() - 1)};
  }
  std::uint32_t family(const std::string& label) {
    const auto [found, is_new] = number_.emplace(label, std::uint32_t(labels_.size()));
    if (is_new) labels_.push_back(label);
    return found->second;
  }
  /// By family, longest first.
  std::vector<Link> links(const Path& path) const {
    std::vector<Link> all(labels_.size());
    for (std::uint32_t at = path.last; at != no_node; at = steps_[at].before) {
      Link& link = all[steps_[at].family];
      link.s += steps_[at].s, ++link.executions;
    }
    for (std::size_t n = 0; n < all.size(); ++n) all[n].label = labels_[n];
    std::erase_if(all, [](const Link& link) { return link.executions == 0; });
    std::ranges::stable_sort(all, std::greater(), &Link::s);
    return all;
  }

 private:
  struct Step {
    std::uint32_t before, family;
    double s;
  };
  std::vector<Step> steps_;
  std::vector<std::string> labels_;
  std::map<std::string, std::uint32_t> number_;
};

struct Rank {
  Rank(const RankRun& from, int ranks_in_group, int threads, double factor_, Chains& chains)
      : of(from), graph(rebuilt(from.graph, ranks_in_group)), program(graph), factor(factor_), threads_of(std::size_t(threads)) {
    const std::size_t nodes = from.graph.nodes.size();
    measure(program, from.run);
    assign_levels(program, graph);
    for (std::size_t n = 0; n < nodes; ++n) {
      Slot& slot = program.slots[n];
      slot.cost_ns = 0, slot.step = 0;
      if (from.graph.nodes[n].place < 0) continue;
      slot.home = std::uint16_t(from.graph.nodes[n].place * float(threads)), slot.placed = true;
    }
    for (Loop& loop : program.loops) loop.entries = loop.iterations = 0;
    path.resize(program.slots.size());
    begin_path.resize(program.slots.size());
    asked.resize(nodes);
    for (const NodeRecord& node : from.graph.nodes) family.push_back(chains.family(family_of(node.label)));
  }
  const RankRun& of;
  Graph graph;
  Program program;
  double factor;
  std::vector<Thread> threads_of;
  std::vector<std::array<Path, 2>> path;  ///< by slot and parity of the step
  std::vector<Path> begin_path;
  std::vector<std::uint32_t> family;                   ///< by node
  std::vector<std::uint32_t> asked;                    ///< by until: executions so far
  std::deque<std::pair<std::uint32_t, Path>> noticed;  ///< messages that are there, no thread free to see it
  int current = 0;                                     ///< thread on whose behalf tokens are given
  double end_s = -1.0;
  Path end_path = {};
  std::map<std::string, std::uint32_t, std::less<>> reduced;      ///< by module
  std::map<std::string, std::uint32_t, std::less<>> ready_calls;  ///< by module
  std::uint32_t calls = 0;
  std::deque<std::pair<std::uint32_t, Path>> in_turn;  ///< collective calls that all ranks are ready for
  bool making = false;                                 ///< one of them
};

class Simulation {
 public:
  Simulation(std::span<const RankRun> runs, const Cluster& cluster)
      : cluster_(cluster), free_from_(std::size_t(cluster.nodes), 0.0) {
    for (const RankRun& run : runs) ++group_size_[run.group];
    for (std::size_t r = 0; r < runs.size(); ++r)
      ranks_.push_back(std::make_unique<Rank>(runs[r], group_size_[runs[r].group], cluster.threads,
                                              speed_factor(cluster, runs[r].number_at(int(r))), chains_));
  }

  Simulated run() {
    for (int r = 0; r < int(ranks_.size()); ++r) {
      enter(r, 0, ranks_[std::size_t(r)]->of.run.replays, {});
      settle(r);
      if (cluster_.threads > 1) add(steal_after_s, What::steal, r, 0, no_node, {});
    }
    while (!events_.empty()) {
      const Event event = events_.top();
      events_.pop();
      now_ = event.time;
      Rank& rank = *ranks_[std::size_t(event.rank)];
      switch (event.what) {
        case What::task_ends:
          end_task(event.rank, event.thread, event.slot, event.path);
          break;
        case What::message_ends:
          rank.noticed.emplace_back(event.slot, event.path);
          break;
        case What::steal:
          break;
      }
      notice(event.rank);
      settle(event.rank);
    }
    return result();
  }

 private:
  enum class What : std::uint8_t { task_ends, message_ends, steal };
  struct Event {
    double time;
    long number;
    What what;
    int rank, thread;
    std::uint32_t slot;
    Path path;
    bool operator<(const Event& other) const { return std::pair(time, number) > std::pair(other.time, other.number); }
  };
  void add(double time, What what, int rank, int thread, std::uint32_t slot, Path path) {
    events_.push({time, number_++, what, rank, thread, slot, path});
  }

  // ---- tokens, as in Worker

  void token(int r, std::uint32_t slot, std::uint32_t step, Path path) {
    Rank& rank = *ranks_[std::size_t(r)];
    Slot& s = rank.program.slots[slot];
    Path& longest = rank.path[slot][step & 1];
    longest = longer(longest, path);
    if (s.need != 1 && s.waiting[step & 1].fetch_sub(1, std::memory_order_relaxed) != 1) return;
    const Path begin = std::exchange(longest, Path{});
    if (s.action == Action::join) {
      s.waiting[step & 1].store(s.need, std::memory_order_relaxed);
      if (s.join != no_node) return token(r, s.join, step, begin);
      return close_iteration(r, rank.program.loops[s.loop], step, begin);
    }
    rank.begin_path[slot] = begin;
    if (s.action == Action::message || s.action == Action::collective) {
      rearm(rank, s);
      return post(r, slot, begin);
    }
    schedule(rank, slot);
  }

  static void rearm(Rank& rank, Slot& slot) {
    std::int32_t tokens = slot.need;
    if (slot.gated) {
      const Loop& loop = rank.program.loops[slot.loop];
      if (slot.step - loop.base + 2 < opened_in_advance(slot, loop.limit)) --tokens;
    }
    slot.waiting[slot.step & 1].store(tokens, std::memory_order_relaxed);
  }

  static void schedule(Rank& rank, std::uint32_t slot) {
    const Slot& s = rank.program.slots[slot];
    const int home = s.home == no_home ? rank.current : int(s.home);
    int level = s.level;
    Thread& own = rank.threads_of[std::size_t(rank.current)];
    if (home == rank.current) {
      if (own.pocket == no_node && own.top() < 0) {
        own.pocket = slot;
        return;
      }
      if (own.pocket != no_node && rank.program.slots[own.pocket].level < level) {
        std::swap(own.pocket, slot);
        level = rank.program.slots[slot].level;
      }
    }
    rank.threads_of[std::size_t(home)].queue[std::size_t(level)].push_back(slot);
  }

  void complete(int r, std::uint32_t slot, Path path) {
    Rank& rank = *ranks_[std::size_t(r)];
    Slot& s = rank.program.slots[slot];
    const std::uint32_t step = s.step++;
    const Loop& loop = rank.program.loops[s.loop];
    const bool tells = s.join != no_node && step - loop.base >= loop.told_from;
    for (std::uint32_t n = s.first; n != s.last; ++n) {
      const std::uint32_t successor = rank.program.successors[n];
      token(r, successor >> 1, step + (successor & 1), path);
    }
    if (tells) token(r, s.join, step, path);
  }

  void enter(int r, std::uint32_t index, std::uint32_t limit, Path path) {
    Rank& rank = *ranks_[std::size_t(r)];
    Loop& loop = rank.program.loops[index];
    loop.limit = limit;
    loop.told_from = loop.until == no_node ? limit - 1 : std::max(limit, 2u) - 2;
    loop.stop = false;
    const std::uint32_t base = loop.base;
    for (std::uint32_t n = loop.first_gate; n < loop.last_gate; ++n) {
      const std::uint32_t slot = rank.program.gates[n];
      token(r, slot, base, path);
      if (opened_in_advance(rank.program.slots[slot], limit) > 1) token(r, slot, base + 1, path);
    }
  }

  void close_iteration(int r, Loop& loop, std::uint32_t step, Path path) {
    Rank& rank = *ranks_[std::size_t(r)];
    if (loop.until != no_node && !loop.stop) return token(r, loop.until, step + 1, path);
    ++loop.entries;
    loop.base = step + 1;
    if (loop.slot != no_node) return complete(r, loop.slot, path);
    rank.end_s = now_, rank.end_path = path;
  }

  /// Iterations that the entry of the loop round `until` had when it was recorded.
  static std::uint32_t iterations(const Rank& rank, const Loop& loop) {
    const auto& entries = rank.of.run.iterations[loop.slot];
    return loop.entries < entries.size() ? entries[loop.entries] : loop.min;
  }

  void answer(int r, std::uint32_t slot, Path path) {
    Rank& rank = *ranks_[std::size_t(r)];
    Slot& s = rank.program.slots[slot];
    Loop& loop = rank.program.loops[s.loop];
    const std::uint32_t step = s.step, done = step - loop.base + 1;
    if (done >= loop.limit) {
      loop.stop = done >= iterations(rank, loop) || done >= loop.max;
      if (!loop.stop)
        for (std::uint32_t n = loop.first_gate; n + 1 < loop.last_gate; ++n) token(r, rank.program.gates[n], step + 1, path);
    }
    complete(r, slot, path);
  }

  // ---- threads

  static double recorded_s(const Rank& rank, std::uint32_t node, std::size_t execution) {
    const auto& all = rank.of.run.ns[node];
    return execution < all.size() ? 1e-9 * double(all[execution]) * rank.factor : 0.0;
  }

  static std::uint32_t take(Rank& rank, Thread& thread) {
    const int top = thread.top();
    if (thread.pocket != no_node) {
      if (top > int(rank.program.slots[thread.pocket].level)) {
        const std::uint32_t better = thread.pop(top), put_back = std::exchange(thread.pocket, no_node);
        thread.queue[rank.program.slots[put_back].level].push_back(put_back);
        return better;
      }
      return std::exchange(thread.pocket, no_node);
    }
    return top < 0 ? no_node : thread.pop(top);
  }

  /// Gives every idle thread what it may take now.
  void settle(int r) {
    Rank& rank = *ranks_[std::size_t(r)];
    const int threads = int(rank.threads_of.size());
    for (bool steals = false, changed = true; changed || !steals;) {
      steals = !changed;  // what is a thread's own it takes before others do
      changed = false;
      for (int t = 0; t < threads && !(steals && changed); ++t) {
        Thread& thread = rank.threads_of[std::size_t(t)];
        if (thread.busy) continue;
        std::uint32_t slot = take(rank, thread);
        if (slot == no_node && steals && now_ - thread.idle_since >= steal_after_s * (1 - 1e-9)) slot = steal(rank, t);
        if (slot == no_node) continue;
        fire(r, t, slot);
        changed = true;
      }
    }
  }

  static std::uint32_t steal(Rank& rank, int thief) {
    const int n = int(rank.threads_of.size());
    for (int k = 1; k < n; ++k) {
      Thread& victim = rank.threads_of[std::size_t((thief + k) % n)];
      if (const int top = victim.top(); top >= 0) return victim.pop(top);
    }
    return no_node;
  }

  void fire(int r, int t, std::uint32_t slot) {
    Rank& rank = *ranks_[std::size_t(r)];
    Slot& s = rank.program.slots[slot];
    if (s.action != Action::collective) rearm(rank, s);
    rank.current = t;
    const Path before = rank.begin_path[slot];
    if (s.action == Action::loop) return enter(r, s.payload, rank.program.loops[s.payload].min, before);
    double cost = 0.0;
    if (s.action == Action::until) {
      const Loop& loop = rank.program.loops[s.loop];
      if (s.step - loop.base + 1 < loop.limit) return answer(r, slot, before);
      cost = recorded_s(rank, slot, rank.asked[slot]++);
    } else {
      cost = recorded_s(rank, slot, s.step);
    }
    rank.threads_of[std::size_t(t)].busy = true;
    if (!s.placed) s.home = std::uint16_t(t);
    ++out_.tasks;
    if (s.action == Action::collective) {
      meet({rank.of.group, "", rank.calls++}, r, t, slot, before, cost, 0.0);
      return;
    }
    occupy(r, t, slot, now_, cost, chains_.after(before, cost, rank.family[slot]));
  }

  /// The thread is in the node's work for so long.
  void occupy(int r, int t, std::uint32_t slot, double begin, double cost, Path path) {
    const double end = begin + cost;
    const std::string module(module_of(ranks_[std::size_t(r)]->of.graph.nodes[slot].label));
    out_.busy_s += end - begin, out_.overhead_s += cluster_.task_overhead_s;
    out_.busy_of[module] += end - begin;
    if (end > begin) out_.slices.push_back({r, t, begin, end, module});
    add(end + cluster_.task_overhead_s, What::task_ends, r, t, slot, path);
  }

  void end_task(int r, int t, std::uint32_t slot, Path path) {
    Rank& rank = *ranks_[std::size_t(r)];
    Thread& thread = rank.threads_of[std::size_t(t)];
    thread.busy = false, thread.idle_since = now_;
    rank.current = t;
    const Action action = rank.program.slots[slot].action;
    if (action == Action::until)
      answer(r, slot, path);
    else
      complete(r, slot, path);
    if (action == Action::collective) {
      rank.making = false;
      next_call(rank);
    }
    if (rank.threads_of.size() > 1) add(now_ + steal_after_s, What::steal, r, t, no_node, {});
  }

  /// Messages that are there, as soon as a thread is between tasks.
  void notice(int r) {
    Rank& rank = *ranks_[std::size_t(r)];
    const auto idle = std::ranges::find_if(rank.threads_of, [](const Thread& thread) { return !thread.busy; });
    if (idle == rank.threads_of.end()) return;
    rank.current = int(idle - rank.threads_of.begin());
    while (!rank.noticed.empty()) {
      const auto [slot, path] = rank.noticed.front();
      rank.noticed.pop_front();
      if (rank.program.slots[slot].action != Action::collective) {
        complete(r, slot, path);
        continue;
      }
      rank.in_turn.emplace_back(slot, path);
      next_call(rank);
    }
  }

  static void next_call(Rank& rank) {
    if (rank.making || rank.in_turn.empty()) return;
    rank.making = true;
    const auto [slot, path] = rank.in_turn.front();
    rank.in_turn.pop_front();
    rank.begin_path[slot] = path;
    schedule(rank, slot);
  }

  // ---- network

  /// Of the cluster.
  int node_of(int r) const { return cluster_.node_of(ranks_[std::size_t(r)]->of.number_at(r)); }
  const Wire& wire(int from, int to) const { return node_of(from) == node_of(to) ? cluster_.within : cluster_.between; }

  void post(int r, std::uint32_t slot, Path path) {
    Rank& rank = *ranks_[std::size_t(r)];
    const NodeRecord& node = rank.of.graph.nodes[slot];
    if (rank.of.run.skips(slot, rank.program.slots[slot].step)) return complete(r, slot, path);  // on all ranks alike
    if (node.kind == NodeKind::reduce) {
      const std::string module(module_of(node.label));
      if (meet({rank.of.group, module, rank.reduced[module]++}, r, -1, slot, path, 0.0, double(node.bytes))) ++out_.reductions;
      return;
    }
    if (node.kind == NodeKind::collective) {
      const std::string ready = std::string(module_of(node.label)) + " is ready";
      // Waits for the last rank, then for the announcement.
      const double announcement_s = all_to_all_s(cluster_, ranks_in_all(cluster_, group_size_.at(rank.of.group)), 0.0);
      meet({rank.of.group, ready, rank.ready_calls[ready]++}, r, -1, slot, path, announcement_s, 0.0);
      return;
    }
    const bool sends = node.kind == NodeKind::send;
    auto& ends = under_way_[sends ? std::tuple(r, node.peer, node.tag) : std::tuple(node.peer, r, node.tag)];
    if (sends) {
      const Wire& line = wire(r, node.peer);
      const double duration = double(node.bytes) / line.bytes_per_s;
      double leaves = now_;
      if (&line == &cluster_.between) {  // one wire of the node carries one message after the other
        double& free = free_from_[std::size_t(node_of(r))];
        leaves = std::max(leaves, free);
        free = leaves + duration;
      }
      out_.bytes += double(node.bytes), ++out_.messages;
      ends.sent.push_back(
          {leaves + line.latency_s + duration, chains_.after(path, line.latency_s + duration, rank.family[slot])});
      add(now_, What::message_ends, r, -1, slot, path);
    } else {
      ends.awaited.push_back({slot, path});
    }
    while (!ends.sent.empty() && !ends.awaited.empty()) {
      const auto [arrives, sent_path] = ends.sent.front();
      const auto [receive, awaited_path] = ends.awaited.front();
      ends.sent.pop_front(), ends.awaited.pop_front();
      add(std::max(arrives, now_), What::message_ends, sends ? node.peer : r, -1, receive, longer(sent_path, awaited_path));
    }
  }

  /// A reduction or collective call: it goes on when the last rank of the group has come. True if this was the last.
  bool meet(std::tuple<int, std::string, std::uint32_t> key, int r, int t, std::uint32_t slot, Path path, double cost,
            double bytes) {
    Meeting& meeting = meetings_[key];
    meeting.come.push_back({r, t, slot});
    meeting.path = longer(meeting.path, path);
    // Recorded on several ranks, the call contains the wait for the others: the last to come waits least.
    meeting.cost = meeting.come.size() == 1 ? cost : std::min(meeting.cost, cost);
    const int size = group_size_.at(std::get<0>(key));
    if (int(meeting.come.size()) < size) return false;
    const double s = meeting.cost + all_to_all_s(cluster_, ranks_in_all(cluster_, size), bytes);
    const Path after = chains_.after(meeting.path, s, ranks_[std::size_t(r)]->family[slot]);
    for (const auto& [rank, thread, at] : meeting.come)
      if (thread >= 0)
        occupy(rank, thread, at, now_, s, after);
      else
        add(now_ + s, What::message_ends, rank, -1, at, after);
    meetings_.erase(key);
    return true;
  }

  Simulated result() {
    Path longest;
    for (std::size_t r = 0; r < ranks_.size(); ++r) {
      if (ranks_[r]->end_s < 0.0)
        throw std::runtime_error("the recorded graphs do not end: rank " + std::to_string(r) + " waits for ever");
      out_.wall_s = std::max(out_.wall_s, ranks_[r]->end_s);
      longest = longer(longest, ranks_[r]->end_path);
    }
    out_.critical_path_s = longest.s, out_.critical_path = chains_.links(longest);
    out_.waiting_s = out_.wall_s * double(ranks_.size()) * cluster_.threads - out_.busy_s - out_.overhead_s;
    return std::move(out_);
  }

  struct Ends {
    struct Sent {
      double arrives;
      Path path;
    };
    struct Awaited {
      std::uint32_t slot;
      Path path;
    };
    std::deque<Sent> sent;
    std::deque<Awaited> awaited;
  };
  struct Meeting {
    struct Come {
      int rank, thread;
      std::uint32_t slot;
    };
    std::vector<Come> come;
    Path path;
    double cost = 0.0;
  };

  const Cluster& cluster_;
  Chains chains_;
  std::vector<std::unique_ptr<Rank>> ranks_;
  std::map<int, int> group_size_;
  std::priority_queue<Event> events_;
  long number_ = 0;
  double now_ = 0.0;
  std::vector<double> free_from_;                        ///< by node: its wire
  std::map<std::tuple<int, int, int>, Ends> under_way_;  ///< by sender, receiver, tag
  std::map<std::tuple<int, std::string, std::uint32_t>, Meeting> meetings_;
  Simulated out_;
};

}  // namespace

Simulated& Simulated::operator+=(const Simulated& next) {
  for (Slice slice : next.slices) {
    slice.begin_s += wall_s, slice.end_s += wall_s;
    slices.push_back(std::move(slice));
  }
  wall_s += next.wall_s, busy_s += next.busy_s, overhead_s += next.overhead_s, waiting_s += next.waiting_s;
  critical_path_s += next.critical_path_s;
  for (const Link& link : next.critical_path) {
    const auto known = std::ranges::find(critical_path, link.label, &Link::label);
    if (known == critical_path.end())
      critical_path.push_back(link);
    else
      known->s += link.s, known->executions += link.executions;
  }
  std::ranges::stable_sort(critical_path, std::greater(), &Link::s);
  bytes += next.bytes, messages += next.messages, reductions += next.reductions, tasks += next.tasks;
  for (const auto& [module, s] : next.busy_of) busy_of[module] += s;
  return *this;
}

int ranks_in_all(const Cluster& cluster, int ranks) { return int(std::lround(cluster.times * ranks)); }

double speed_factor(const Cluster& cluster, int rank) {
  if (cluster.skew == 0.0) return 1.0;
  std::minstd_rand draw(unsigned(rank) * 2654435761u + 12345u);
  draw.discard(3);
  double sum = -6.0;  // of twelve uniform numbers: near enough to a normal one
  for (int n = 0; n < 12; ++n)
    sum += double(draw() - std::minstd_rand::min()) / double(std::minstd_rand::max() - std::minstd_rand::min());
  return std::max(0.2, 1.0 + cluster.skew * sum);
}

double all_to_all_s(const Cluster& cluster, int ranks, double bytes) {
  if (ranks < 2) return 0.0;
  const int on_node = std::max(1, cluster.ranks / cluster.nodes);
  const int inside = std::bit_width(unsigned(std::min(ranks, on_node) - 1)), all = std::bit_width(unsigned(ranks - 1));
  return inside * (cluster.within.latency_s + bytes / cluster.within.bytes_per_s) +
         (all - inside) * (cluster.between.latency_s + bytes / cluster.between.bytes_per_s);
}

Simulated simulate(std::span<const RankRun> ranks, const Cluster& cluster) { return Simulation(ranks, cluster).run(); }

}  // namespace spindrift::runtime
