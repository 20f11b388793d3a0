// SPDX-License-Identifier: Apache-2.0
#include "runtime/executor/recording_file.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>

#include "runtime/graph/recorded.hpp"

namespace spindrift::runtime {
namespace {

const char* name_of(NodeKind kind) {
  switch (kind) {
    case NodeKind::task:
      return "task";
    case NodeKind::send:
      return "send";
    case NodeKind::receive:
      return "receive";
    case NodeKind::reduce:
      return "reduce";
    case NodeKind::collective:
      return "collective";
    case NodeKind::until:
      return "until";
    case NodeKind::loop:
      return "loop";
  }
  return "";
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out + '"';
}

void write_node(std::ostream& out, const Executor& executor, std::uint32_t n) {
  const Graph::Recorded& g = executor.graph().recorded();
  const Node& node = g.nodes[n];
  const TaskCost cost = executor.cost(n);
  out << R"({"id": )" << n << R"(, "label": )" << quoted(node.label) << R"(, "kind": ")" << name_of(node.kind)
      << R"(", "loop": )";
  if (node.loop == no_node)
    out << "null";
  else
    out << node.loop;
  out << R"(, "runs": )" << cost.count;
  if (node.kind == NodeKind::loop) {
    const Limits& limits = g.limits[g.payload[n]];
    out << R"(, "min": )" << limits.min << R"(, "max": )" << limits.max << R"(, "mean_iterations": )"
        << executor.mean_iterations(n);
  } else {
    out << R"(, "mean_ns": )" << cost.mean_ns();
  }
  if (node.kind == NodeKind::send || node.kind == NodeKind::receive)
    out << R"(, "peer": )" << g.messages[g.payload[n]].peer << R"(, "tag": )" << g.messages[g.payload[n]].tag;
  if (node.kind == NodeKind::send || node.kind == NodeKind::receive || node.kind == NodeKind::reduce)
    out << R"(, "mean_bytes": )" << (cost.count == 0 ? 0.0 : double(executor.bytes(n)) / double(cost.count));
  out << "}";
}

}  // namespace

void write_recording(const Executor& executor, const std::string& path) {
  std::ofstream out(path);
  if (!out) throw std::runtime_error("cannot write the graph to " + path + ": " + std::strerror(errno));
  const Graph& graph = executor.graph();
  const Communicator& comm = graph.recorded().comm;
  out << R"({"rank": )" << comm.rank() << R"(, "ranks": )" << comm.size() << R"(, "threads": )" << executor.threads()
      << ",\n\"nodes\": [";
  for (std::uint32_t n = 0; n < graph.nodes().size(); ++n) {
    out << (n == 0 ? "\n" : ",\n");
    write_node(out, executor, n);
  }
  out << "],\n\"edges\": [";
  const char* separator = "\n";
  for (const Edge& e : graph.edges()) {
    out << separator << '[' << e.from << ", " << e.to << ", " << int(e.distance) << ']';
    separator = ",\n";
  }
  out << "]}\n";
  out.flush();
  if (!out) throw std::runtime_error("cannot write the graph to " + path + ": " + std::strerror(errno));
}

}  // namespace spindrift::runtime
