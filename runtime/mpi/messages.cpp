// SPDX-License-Identifier: Apache-2.0
#include "runtime/mpi/messages.hpp"

#include <algorithm>
#include <chrono>
#include <climits>
#include <memory>
#include <stdexcept>
#include <thread>

#include "runtime/trace/clock.hpp"

namespace spindrift::runtime {
namespace {

constexpr int control_tag = 32767;  // Graph allows no message this tag
constexpr std::size_t notice_size = 1024;

std::vector<char> packed(const Notice& notice) {
  std::string text = std::to_string(notice.rank) + (notice.hang ? " h" : " t") + notice.label.substr(0, 300) + '\n' + notice.what;
  text.resize(notice_size, '\0');
  return {text.begin(), text.end()};
}

Notice unpacked(const std::vector<char>& bytes) {
  const std::string text(bytes.data());
  const auto space = text.find(' '), line = text.find('\n');
  return {std::stoi(text), text[space + 1] == 'h', text.substr(space + 2, line - space - 2), text.substr(line + 1)};
}

int checked_int(std::size_t bytes) {
  if (bytes > std::size_t(INT_MAX)) throw std::length_error("a message of " + std::to_string(bytes) + " bytes; MPI takes 2 GiB");
  return int(bytes);
}

/// MPI can neither cancel nor free a collective operation under way, and goes on with it in any later call: its memory and its
/// communicator must be there until the program ends (Open MPI 4.1 reads them after they were freed).
void leave_behind(Graph::Recorded& graph) {
  static std::vector<std::shared_ptr<Allreduce>> left_behind;
  left_behind.insert(left_behind.end(), graph.reductions.begin(), graph.reductions.end());
  for (Graph::Recorded::OfModules* of : {&graph.reductions_of, &graph.collectives_of})
    for (auto& [module, in] : *of) in.comm.leave();
  graph.turns.leave();
}

}  // namespace

Messages::Messages(Graph::Recorded& graph) : graph_(graph), control_(graph.comm.size() > 1) {
  for (std::uint32_t n = 0; n < graph.nodes.size(); ++n) {
    const NodeKind kind = graph.nodes[n].kind;
    const bool reduces = kind == NodeKind::reduce && graph.reductions[graph.payload[n]]->needs_messages();
    const bool calls = kind == NodeKind::collective && graph.takes_turns;
    if (kind == NodeKind::send || kind == NodeKind::receive || reduces || calls) operation_nodes_.push_back(n);
  }
  if (graph.takes_turns) turns_.emplace(graph);
  const std::uint32_t capacity = std::uint32_t(count());
  posted_.reserve(std::span(&capacity, 1));
  requests_.resize(count());
  node_of_.resize(count()), bytes_of_.resize(count()), posted_ns_.resize(count());
  indices_.resize(count()), statuses_.resize(count());
  if (!control_) return;
  notice_bytes_.resize(notice_size + 1, '\0');
  MPI_Irecv(notice_bytes_.data(), int(notice_size), MPI_CHAR, MPI_ANY_SOURCE, control_tag, graph_.comm.get(), &control_request_);
}

Messages::~Messages() {
  int finalized = 0;
  MPI_Finalized(&finalized);
  if (finalized) return;
  if (!left_behind_)
    for (const auto& reduction : graph_.reductions) reduction->release();
  if (control_request_ == MPI_REQUEST_NULL) return;
  MPI_Cancel(&control_request_);
  MPI_Wait(&control_request_, MPI_STATUS_IGNORE);
}

void Messages::post(std::uint32_t node) {
  outstanding_.fetch_add(1, std::memory_order_relaxed);
  posted_.push(0, node);
}

bool Messages::active(std::uint32_t node) const {
  const std::uint32_t at = graph_.payload[node];
  if (graph_.nodes[node].kind == NodeKind::reduce) return graph_.reductions[at]->active();
  if (graph_.nodes[node].kind == NodeKind::collective) return graph_.collectives[at].needed();
  return !graph_.messages[at].active || graph_.messages[at].active();
}

void Messages::start(std::uint32_t node, std::int64_t now) {
  const Node& recorded = graph_.nodes[node];
  if (recorded.kind == NodeKind::collective) return turns_->come(graph_.payload[node]);
  const std::size_t at = std::size_t(active_);
  MPI_Request& request = requests_[at];
  if (recorded.kind == NodeKind::reduce) {
    Allreduce& reduction = *graph_.reductions[graph_.payload[node]];
    reduction.post(request);
    bytes_of_[at] = std::uint32_t(reduction.bytes());
  } else {
    const Message& message = graph_.messages[graph_.payload[node]];
    const auto memory = message.buffer();
    const int bytes = checked_int(memory.size());
    if (recorded.kind == NodeKind::send)
      MPI_Isend(memory.data(), bytes, MPI_BYTE, message.peer, message.tag, graph_.comm.get(), &request);
    else
      MPI_Irecv(memory.data(), bytes, MPI_BYTE, message.peer, message.tag, graph_.comm.get(), &request);
    bytes_of_[at] = std::uint32_t(bytes);
  }
  node_of_[at] = node;
  posted_ns_[at] = now;
  ++active_;
}

void Messages::retire(int request) {
  const auto gap = std::size_t(request), last = std::size_t(--active_);
  requests_[gap] = requests_[last];
  node_of_[gap] = node_of_[last], bytes_of_[gap] = bytes_of_[last], posted_ns_[gap] = posted_ns_[last];
}

Messages::Polled Messages::poll(std::vector<Completion>& done) {
  if (busy_.test_and_set(std::memory_order_acquire)) return {};
  struct Release {
    std::atomic_flag& flag;
    ~Release() { flag.clear(std::memory_order_release); }
  } release{busy_};

  Polled polled{.looked = true};
  if (posted_.top() >= 0) {
    const std::int64_t now = Clock::now_ns();
    for (std::uint32_t node; (node = posted_.pop(0)) != ReadyQueue::none;) {
      try {
        if (active(node)) {
          start(node, now);
        } else {
          done.push_back({node, 0, now, false});
          outstanding_.fetch_sub(1, std::memory_order_relaxed);
        }
      } catch (const std::exception& e) {  // the buffer's owner threw, or it is too large
        throw Failure{node, e.what()};
      } catch (...) { throw Failure{node, "an exception of unknown type"}; }
    }
    polled.until_ns = Clock::now_ns();
  }
  if (active_ > 0) {
    int n = 0;
    MPI_Testsome(active_, requests_.data(), &n, indices_.data(), statuses_.data());
    if (n > 0) {
      for (int i = 0; i < n; ++i) {
        const auto at = std::size_t(indices_[std::size_t(i)]);
        if (graph_.nodes[node_of_[at]].kind == NodeKind::receive) {
          int bytes = 0;
          MPI_Get_count(&statuses_[std::size_t(i)], MPI_BYTE, &bytes);
          bytes_of_[at] = std::uint32_t(bytes);
        }
        done.push_back({node_of_[at], bytes_of_[at], posted_ns_[at]});
      }
      std::sort(indices_.begin(), indices_.begin() + n, std::greater<>());  // from the back, so that no gap is moved
      for (int i = 0; i < n; ++i) retire(indices_[std::size_t(i)]);
      outstanding_.fetch_sub(n, std::memory_order_relaxed);
    }
  }
  if (turns_)
    if (const auto call = turns_->next()) {
      done.push_back({graph_.collectives[*call].node, 0, Clock::now_ns()});
      outstanding_.fetch_sub(1, std::memory_order_relaxed);
    }
  if (!done.empty()) polled.until_ns = Clock::now_ns();
  if (control_request_ != MPI_REQUEST_NULL) {
    int received = 0;
    MPI_Test(&control_request_, &received, MPI_STATUS_IGNORE);
    if (received) {
      notice_ = unpacked(notice_bytes_);
      has_notice_.store(true, std::memory_order_release);
    }
  }
  return polled;
}

std::optional<Notice> Messages::notice() {
  if (!has_notice_.load(std::memory_order_relaxed) || !has_notice_.exchange(false, std::memory_order_acquire)) return {};
  return notice_;
}

void Messages::abandon(const Notice* tell) {
  if (tell != nullptr && control_) {
    const auto bytes = packed(*tell);
    std::vector<MPI_Request> sends;
    for (int r = 0; r < graph_.comm.size(); ++r)
      if (r != graph_.comm.rank())
        MPI_Isend(bytes.data(), int(bytes.size()), MPI_CHAR, r, control_tag, graph_.comm.get(), &sends.emplace_back());
    // Short enough to be sent without the receiver's help; the wait is for a network that is not.
    const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(2);
    for (int sent = 0; !sent && std::chrono::steady_clock::now() < patience;
         std::this_thread::sleep_for(std::chrono::microseconds(100)))
      MPI_Testall(int(sends.size()), sends.data(), &sent, MPI_STATUSES_IGNORE);
  }
  if (turns_) turns_->abandon();
  if (control_) leave_behind(graph_), left_behind_ = true;
  for (int i = 0; i < active_; ++i) {
    const auto at = std::size_t(i);
    const NodeKind kind = graph_.nodes[node_of_[at]].kind;
    if (kind == NodeKind::reduce) continue;  // left behind
    if (kind == NodeKind::receive) MPI_Cancel(&requests_[at]);
    MPI_Request_free(&requests_[at]);
  }
  active_ = 0;
}

}  // namespace spindrift::runtime
