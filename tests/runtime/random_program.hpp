// A random algorithm on a few numbers, with nested loops, that can be run in order or recorded as a graph: the graph must give
// the same numbers however it is scheduled. Each statement mixes what it reads into what it writes, so that any change of order
// shows. Used by tests/runtime/executor_test.cpp and tests/runtime/failure_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "runtime/graph/graph.hpp"

namespace spindrift::runtime::testing {

struct Statement {
  std::vector<std::size_t> read, written, updated;  ///< tasks
  std::uint64_t salt = 0;
  std::vector<Statement> body;  ///< loops
  Limits limits;
  std::uint64_t stop_one_in = 0;  ///< `until`: about one answer in so many is yes; 0: no `until`
};

class RandomProgram {
 public:
  RandomProgram(std::uint64_t seed, std::size_t n_data, int statements, int depth) : random_(seed), values(n_data) {
    for (std::size_t d = 0; d < n_data; ++d) values[d] = d + 1;
    body_ = make_body(statements, depth);
  }

  void run_in_order(int replays) {
    for (int n = 0; n < replays; ++n) run(body_);
  }

  void record(Graph& graph) {
    const auto data = graph.data(values.size());
    record(graph, data, body_, "random");
  }

 private:
  std::mt19937_64 random_;  // before values: see constructor

  std::uint64_t draw(std::uint64_t n) { return random_() % n; }

  std::vector<Statement> make_body(int statements, int depth) {
    std::vector<Statement> body;
    for (int n = 0; n < statements; ++n) {
      Statement s;
      s.salt = random_();
      if (depth > 0 && draw(4) == 0) {
        s.body = make_body(1 + int(draw(std::uint64_t(statements))), depth - 1);
        s.limits.min = 1 + std::uint32_t(draw(3));
        s.limits.max = s.limits.min + std::uint32_t(draw(4));
        if (s.limits.max > s.limits.min) {
          s.stop_one_in = 2 + draw(3);
          s.read = {draw(values.size())};
        }
      } else {
        for (std::uint64_t k = draw(4); k > 0; --k) s.read.push_back(draw(values.size()));
        if (draw(8) > 0) (draw(2) == 0 ? s.written : s.updated).push_back(draw(values.size()));
        if (draw(4) == 0) s.updated.push_back(draw(values.size()));
      }
      body.push_back(std::move(s));
    }
    return body;
  }

  void execute(const Statement& s) {
    std::uint64_t mix = s.salt;
    for (const auto d : s.read) mix = (mix ^ values[d]) * 0x9e3779b97f4a7c15u;
    for (const auto d : s.written) values[d] = mix = mix * 0xbf58476d1ce4e5b9u + 1;
    for (const auto d : s.updated) values[d] = (values[d] ^ mix) * 0x94d049bb133111ebu + 1;
  }
  bool stops(const Statement& s) const { return (values[s.read[0]] >> 20) % s.stop_one_in == 0; }

  void run(const std::vector<Statement>& body) {
    for (const Statement& s : body) {
      if (s.body.empty()) {
        execute(s);
        continue;
      }
      for (std::uint32_t k = 1;; ++k) {
        run(s.body);
        if (k >= s.limits.max || (k >= s.limits.min && s.stop_one_in > 0 && stops(s))) break;
      }
    }
  }

  void record(Graph& graph, const std::vector<Datum>& data, const std::vector<Statement>& body, const std::string& path) {
    for (std::size_t n = 0; n < body.size(); ++n) {
      const Statement& s = body[n];
      const std::string label = path + "/" + std::to_string(n);
      Uses uses;
      for (const auto d : s.read) uses.push_back(reads(data[d]));
      for (const auto d : s.written) uses.push_back(writes(data[d]));
      for (const auto d : s.updated) uses.push_back(updates(data[d]));
      if (s.body.empty()) {
        graph.task(label, uses, [this, &s] { execute(s); });
        continue;
      }
      graph.loop(label, s.limits, [&] {
        record(graph, data, s.body, label);
        if (s.stop_one_in > 0) graph.until(label + "/until", uses, [this, &s] { return stops(s); });
      });
    }
  }

 public:
  std::vector<std::uint64_t> values;

 private:
  std::vector<Statement> body_;
};

}  // namespace spindrift::runtime::testing
