// SPDX-License-Identifier: Apache-2.0
#include "runtime/executor/worker.hpp"

#include <sched.h>

#include <algorithm>
#include <type_traits>
#include <utility>

namespace spindrift::runtime {
namespace {

constexpr std::int64_t poll_interval_ns = 10'000;  // 5 to 20 us hide an 8 MB exchange completely
// A thread that makes progress is left its tasks for so long: else threads of a fine stencil steal each other's every second task
// (85-250 core-ns a task instead of 60-70). One that completes nothing (a long task, or no processor) is helped at once.
constexpr std::int64_t steal_after_ns = 1'000;
constexpr std::int64_t spin_ns = 30'000;  // about what a wake-up costs
constexpr std::int64_t spin_for_messages_ns = 1'000'000;

Activity activity_of(NodeKind kind) {
  switch (kind) {
    case NodeKind::send:
      return Activity::send;
    case NodeKind::receive:
      return Activity::receive;
    case NodeKind::reduce:
      return Activity::reduce;
    case NodeKind::task:
    case NodeKind::collective:
    case NodeKind::until:
    case NodeKind::loop:
      break;
  }
  return Activity::task;
}

void pause_briefly() {
#if defined(__x86_64__)
  for (int n = 0; n < 8; ++n) _mm_pause();
#endif
}

/// Denormal numbers as zero while this lives, if asked.
class FlushToZero {
 public:
  explicit FlushToZero([[maybe_unused]] bool asked) {
#if defined(__x86_64__)
    before_ = _mm_getcsr();
    if (asked) _mm_setcsr(before_ | 0x8040);  // results and operands
#endif
  }
  ~FlushToZero() {
#if defined(__x86_64__)
    _mm_setcsr(before_);
#endif
  }

 private:
  [[maybe_unused]] unsigned before_ = 0;
};

}  // namespace

void poll_messages() {
  if (Worker* worker = Worker::current()) worker->poll_if_due(Clock::now_ns(), true);
}

Team::Team(Graph g, ExecutorOptions o) : graph(std::move(g)), options(o), program(graph), messages(graph.recorded()) {}

void Team::fail(Notice notice) {
  {
    const std::lock_guard lock(failure_lock);
    if (!failure) failure = std::move(notice);
  }
  ended.store(true, std::memory_order_release);
  sleepers.wake_all();
}

Worker::Worker(Team& team, int id)
    : records(team.options.records),
      team_(team),
      program_(team.program),
      slots_(team.program.slots.data()),
      id_(id),
      keeps_next_(!team.options.random_schedule),
      victim_(id),
      random_state_((team.options.random_schedule.value_or(0) + 1) * 0x9e3779b97f4a7c15u +
                    std::uint64_t(id) * 0xbf58476d1ce4e5b9u) {
  completions_.reserve(team.messages.count());
  progress_.resize(std::size_t(team.options.threads));
}

// ---- tokens ----

inline void Worker::token(std::uint32_t slot, std::uint32_t step) {
  Slot& s = slots_[slot];
  if (s.need == 1 || s.waiting[step & 1].fetch_sub(1, std::memory_order_acq_rel) == 1) ready(slot, step);
}

/// Before step s runs, counts again for step s + 2. Its gate is open already if the step is certain to exist.
inline void Worker::rearm(Slot& slot) {
  std::int32_t tokens = slot.need;
  if (slot.gated) {
    const Loop& loop = program_.loops[slot.loop];
    if (slot.step - loop.base + 2 < opened_in_advance(slot, loop.limit)) --tokens;
  }
  slot.waiting[slot.step & 1].store(tokens, std::memory_order_relaxed);
}

void Worker::ready(std::uint32_t slot, std::uint32_t step) {
  Slot& s = slots_[slot];
  if (s.action == Action::join) {
    s.waiting[step & 1].store(s.need, std::memory_order_relaxed);
    if (s.join != no_node) return token(s.join, step);
    return close_iteration(program_.loops[s.loop], step);
  }
  if (s.action == Action::message || s.action == Action::collective) {
    rearm(s);
    return team_.messages.post(slot);
  }
  schedule(slot);
}

void Worker::schedule(std::uint32_t slot) {
  const Slot& s = slots_[slot];
  int home = s.home == no_home ? id_ : int(s.home), level = s.level;
  if (keeps_next_) {
    if (home == id_ && !nested_) {
      if (next_ == no_node && queue.top() < 0) {  // else it is not its turn: see docs/developer/runtime.md on depth first
        next_ = slot;
        return;
      }
      if (next_ != no_node && slots_[next_].level < level) {
        std::swap(next_, slot);
        level = slots_[slot].level;
      }
    }
  } else {
    home = int(random() % std::uint32_t(team_.workers.size()));
    level = int(random() % std::uint32_t(team_.levels));
  }
  team_.workers[std::size_t(home)]->queue.push(level, slot);
  team_.sleepers.wake_one();
}

/// Gives a token to all that wait for a node of the body. After the last one the loop may be over and entered again by others.
void Worker::complete(std::uint32_t slot) {
  Slot& s = slots_[slot];
  const std::uint32_t step = s.step;
  s.step = step + 1;
  bool tells = false;  // decided first: once its successors have their tokens, the loop may be at its end on other threads
  if (s.join != no_node) {
    const Loop& loop = program_.loops[s.loop];
    tells = step - loop.base >= loop.told_from;
  }
  beats.store(beats.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  const std::uint32_t* const successors = program_.successors.data();
  for (std::uint32_t n = s.first, last = s.last; n != last; ++n) token(successors[n] >> 1, step + (successors[n] & 1));
  if (tells) token(s.join, step);
}

// ---- loops ----

void Worker::enter(std::uint32_t index, std::uint32_t limit) {
  Loop& loop = program_.loops[index];
  loop.limit = limit;
  loop.told_from = loop.until == no_node ? limit - 1 : std::max(limit, 2u) - 2;
  loop.stop = false;
  const std::uint32_t base = loop.base;
  for (std::uint32_t n = loop.first_gate; n < loop.last_gate; ++n) {
    const std::uint32_t slot = program_.gates[n];
    token(slot, base);
    if (opened_in_advance(slots_[slot], limit) > 1) token(slot, base + 1);
  }
}

/// All nodes of the iteration are done, `until` among them.
void Worker::close_iteration(Loop& loop, std::uint32_t step) {
  if (loop.until != no_node && !loop.stop) return token(loop.until, step + 1);
  ++loop.entries;
  loop.iterations += step + 1 - loop.base;
  loop.base = step + 1;
  if (loop.slot != no_node) return complete(loop.slot);
  team_.ended.store(true, std::memory_order_release);
  team_.sleepers.wake_all();
}

void Worker::ask(std::uint32_t slot) {
  Slot& s = slots_[slot];
  Loop& loop = program_.loops[s.loop];
  const std::uint32_t step = s.step, done = step - loop.base + 1;
  if (done >= loop.limit) {
    bool stop = true;
    const bool good =
        run(slot, [&](const Context&) { stop = team_.graph.recorded().predicates[s.payload]() || done >= loop.max; });
    if (!good) return;
    loop.stop = stop;
    if (!stop)
      for (std::uint32_t n = loop.first_gate; n + 1 < loop.last_gate; ++n) token(program_.gates[n], step + 1);
  }
  complete(slot);
}

// ---- nodes ----

Context Worker::context(const Slot& slot) const {
  const Loop& loop = program_.loops[slot.loop];
  return {loop.outermost == no_node ? slot.step : slots_[loop.outermost].step, slot.step - loop.base, id_};
}

void Worker::record(std::uint32_t slot, const Context& where, Activity activity, std::int64_t begin, std::int64_t end,
                    std::uint32_t bytes, bool needed) {
  records.add({begin, end, slot, where.replay, where.iteration, bytes, std::uint16_t(id_), activity, needed});
}

/// Runs the work of a node with clock and record; false if it threw, which cancels the run. Work that returns false was not
/// needed.
template <class Body>
bool Worker::run(std::uint32_t slot, Body&& body) {
  Slot& s = slots_[slot];
  const Context where = context(s);
  bool needed = true;
  inside.store(slot, std::memory_order_relaxed);
  const std::int64_t begin = Clock::now_ns();
  try {
    if constexpr (std::is_same_v<std::invoke_result_t<Body&, const Context&>, bool>)
      needed = body(where);
    else
      body(where);
  } catch (const std::exception& e) {
    team_.fail({team_.graph.recorded().comm.rank(), false, team_.graph.nodes()[slot].label, e.what()});
    return false;
  } catch (...) {
    team_.fail({team_.graph.recorded().comm.rank(), false, team_.graph.nodes()[slot].label, "an exception of unknown type"});
    return false;
  }
  const std::int64_t end = Clock::now_ns();
  inside.store(no_node, std::memory_order_relaxed);
  s.cost_ns += end - begin;
  times.task_ns += end - begin;
  ++times.tasks;
  if (!s.placed) s.home = std::uint16_t(id_);
  if (team_.recording) record(slot, where, Activity::task, begin, end, 0, needed);
  poll_if_due(end, false);
  return true;
}

/// A collective call that is not needed this time takes no time.
void Worker::skip(std::uint32_t slot) {
  const std::int64_t now = Clock::now_ns();
  if (team_.recording) record(slot, context(slots_[slot]), Activity::task, now, now, 0, false);
  complete(slot);
}

void Worker::fire(std::uint32_t slot) {
  Slot& s = slots_[slot];
  if (s.action != Action::collective) rearm(s);  // that one was before it waited for its turn
  Graph::Recorded& graph = team_.graph.recorded();
  switch (s.action) {
    case Action::work:
      if (run(slot, graph.works[s.payload])) complete(slot);
      return;
    case Action::until:
      return ask(slot);
    case Action::loop:
      return enter(s.payload, program_.loops[s.payload].min);
    case Action::reduce_here:
      if (run(slot, [&](const Context&) {
            const bool needed = graph.reductions[s.payload]->active();
            if (needed) graph.reductions[s.payload]->finish();
            return needed;
          }))
        complete(slot);
      return;
    case Action::collective_here:
      if (!graph.collectives[s.payload].needed()) return skip(slot);
      if (run(slot, [&](const Context&) { graph.collectives[s.payload].make(); })) complete(slot);
      return;
    case Action::collective:
      if (run(slot, [&](const Context&) { graph.collectives[s.payload].make(); })) {
        team_.messages.made_call();
        complete(slot);
      }
      return;
    case Action::message:
    case Action::join:
      return;  // never scheduled: see ready
  }
}

// ---- messages ----

inline void Worker::poll_if_due(std::int64_t now, bool nested) {
  if (!team_.messages.need_polling() || now - team_.last_poll_ns.load(std::memory_order_relaxed) < poll_interval_ns) return;
  poll(nested);
}

void Worker::poll(bool nested) {
  const std::int64_t begin = Clock::now_ns();
  completions_.clear();
  Messages::Polled polled;
  try {
    polled = team_.messages.poll(completions_);
    if (!polled.looked) return;
  } catch (const Messages::Failure& failure) {
    return team_.fail({team_.graph.recorded().comm.rank(), false, team_.graph.nodes()[failure.node].label, failure.what});
  }
  const std::int64_t end = Clock::now_ns();
  team_.last_poll_ns.store(end, std::memory_order_relaxed);
  if (!nested && !waits_) times.idle_ns += end - (polled.until_ns == 0 ? begin : polled.until_ns);  // looked in vain
  nested_ = nested;
  for (const auto& completion : completions_) complete_message(completion);
  nested_ = false;
  if (auto notice = team_.messages.notice()) team_.fail(std::move(*notice));
  if (nested || polled.until_ns == 0) return;  // nested: its time is the task's
  times.poll_ns += polled.until_ns - begin;
  if (!completions_.empty() && team_.recording) record(no_task, {0, 0, id_}, Activity::poll, begin, polled.until_ns, 0);
}

void Worker::complete_message(const Messages::Completion& completion) {
  Graph::Recorded& graph = team_.graph.recorded();
  Slot& s = slots_[completion.node];
  const NodeKind kind = graph.nodes[completion.node].kind;
  if (kind == NodeKind::collective) return completion.active ? schedule(completion.node) : skip(completion.node);
  try {
    if (kind == NodeKind::reduce && completion.active) graph.reductions[s.payload]->finish();
    if (kind == NodeKind::receive && completion.active && graph.messages[s.payload].received)
      graph.messages[s.payload].received(completion.bytes);
  } catch (const std::exception& e) {
    return team_.fail({graph.comm.rank(), false, graph.nodes[completion.node].label, e.what()});
  } catch (...) {
    return team_.fail({graph.comm.rank(), false, graph.nodes[completion.node].label, "an exception of unknown type"});
  }
  const std::int64_t end = Clock::now_ns();
  s.cost_ns += end - completion.posted_ns;
  graph.message_bytes[completion.node] += completion.bytes;
  graph.messages_made[completion.node] += completion.active;
  if (team_.recording)
    record(completion.node, context(s), activity_of(kind), completion.posted_ns, end, completion.bytes, completion.active);
  complete(completion.node);
}

// ---- finding work ----

std::uint32_t Worker::random() {
  random_state_ ^= random_state_ << 13;
  random_state_ ^= random_state_ >> 7;
  random_state_ ^= random_state_ << 17;
  return std::uint32_t(random_state_ >> 32);
}

std::uint32_t Worker::take() {
  if (next_ != no_node) {
    if (team_.levels > 1)
      if (const int top = queue.top(); top > int(slots_[next_].level))
        if (const std::uint32_t better = queue.pop(top); better != ReadyQueue::none) {
          // What is in the pocket nobody can take from there; `better` may be long, and the other task what a whole module waits
          // for.
          const std::uint32_t put_back = std::exchange(next_, no_node);
          queue.push(slots_[put_back].level, put_back);
          team_.sleepers.wake_one();
          return better;
        }
    return std::exchange(next_, no_node);
  }
  const int top = queue.top();
  return top < 0 ? no_node : queue.pop(top);
}

std::uint32_t Worker::steal(std::int64_t now, bool from_anyone) {
  const int n = int(team_.workers.size());
  for (int tries = 1; tries < n; ++tries) {
    victim_ = victim_ + 1 == n ? 0 : victim_ + 1;
    if (victim_ == id_) victim_ = victim_ + 1 == n ? 0 : victim_ + 1;
    Worker& other = *team_.workers[std::size_t(victim_)];
    Progress& progress = progress_[std::size_t(victim_)];
    if (const auto its_beats = other.beats.load(std::memory_order_relaxed); its_beats != progress.beats)
      progress = {its_beats, now};
    if (!from_anyone && now - progress.since_ns < steal_after_ns) continue;
    if (const int top = other.queue.top(); top >= 0)
      if (const std::uint32_t slot = other.queue.pop(top); slot != ReadyQueue::none) {
        ++times.steals;
        return slot;
      }
  }
  return no_node;
}

/// Nothing of its own to do: messages first, then others' tasks, then rest. no_node when the run has ended.
std::uint32_t Worker::wait() {
  waits_ = true;
  const std::int64_t begin = Clock::now_ns(), polled_before = times.poll_ns;
  std::uint32_t found = no_node;
  std::int64_t now = begin;
  while (!team_.ended.load(std::memory_order_acquire)) {
    if (team_.messages.need_polling()) poll(false);
    if ((found = take()) != no_node) break;
    if ((found = steal(now, now - begin >= steal_after_ns)) != no_node) break;
    back_off(now - begin);
    now = Clock::now_ns();
  }
  now = Clock::now_ns();
  waits_ = false;
  times.idle_ns += now - begin - (times.poll_ns - polled_before);
  if (team_.recording) record(no_task, {0, 0, id_}, Activity::idle, begin, now, 0);
  return found;
}

void Worker::back_off(std::int64_t waited_ns) {
  const bool messages = team_.messages.need_polling();
  if (team_.spins) {
    if (waited_ns < (messages ? spin_for_messages_ns : spin_ns)) return pause_briefly();
  } else if (waited_ns < spin_ns) {
    sched_yield();
    return;
  }
  team_.sleepers.sleep(messages ? 50 : 500);
}

void Worker::work() {
  const FlushToZero rounding(team_.options.flush_to_zero);
  current() = this;
  const std::int64_t begin = Clock::now_ns();
  while (!team_.ended.load(std::memory_order_acquire)) {
    std::uint32_t slot = take();
    if (slot == no_node) slot = wait();
    if (slot == no_node) break;
    fire(slot);
  }
  next_ = no_node;
  inside.store(no_node, std::memory_order_relaxed);
  times.wall_ns += Clock::now_ns() - begin;
  current() = nullptr;
}

}  // namespace spindrift::runtime
