// SPDX-License-Identifier: Apache-2.0
#include "runtime/replay/recording_file.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <numeric>
#include <stdexcept>

namespace spindrift::runtime {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<const char*, 7> kinds{"task", "send", "receive", "reduce", "collective", "until", "loop"};  // by NodeKind
constexpr std::array<const char*, 3> accesses{"read", "write", "update"};                                        // by Access
constexpr const char* format = "spindrift recording";

Json or_null(float place) { return place < 0 ? Json(nullptr) : Json(place); }
Json or_null(std::uint32_t node) { return node == no_node ? Json(nullptr) : Json(node); }
float place_of(const Json& value) { return value.is_null() ? -1.0F : value.get<float>(); }

/// Executions of a node in all windows, what one took on average, and how far windows are apart in that (standard deviation).
struct Cost {
  std::uint64_t runs = 0;
  double mean_ns = 0, spread_ns = 0;
};
Cost cost_of(const RankRecording& rank, std::uint32_t graph, std::uint32_t node) {
  Cost cost;
  std::vector<double> means;
  double sum = 0;
  for (const RunRecord& run : rank.runs) {
    if (run.graph != graph || run.ns[node].empty()) continue;
    const double ns = std::accumulate(run.ns[node].begin(), run.ns[node].end(), 0.0);
    sum += ns, cost.runs += run.ns[node].size();
    means.push_back(ns / double(run.ns[node].size()));
  }
  if (cost.runs == 0) return cost;
  cost.mean_ns = sum / double(cost.runs);
  const double centre = std::accumulate(means.begin(), means.end(), 0.0) / double(means.size());
  double squares = 0;
  for (const double mean : means) squares += (mean - centre) * (mean - centre);
  cost.spread_ns = means.size() > 1 ? std::sqrt(squares / double(means.size() - 1)) : 0.0;
  return cost;
}

int urgency_of(const GraphRecord& graph, std::uint32_t node) {
  int most = 0;
  for (std::uint32_t at = node; at != no_node; at = graph.nodes[at].loop)
    if (graph.nodes[at].kind == NodeKind::loop) most = std::max(most, graph.nodes[at].limits.urgency);
  return most;
}

Json node_line(const RankRecording& rank, std::uint32_t g, std::uint32_t n, const std::vector<Edge>& before) {
  const GraphRecord& graph = rank.graphs[g];
  const NodeRecord& node = graph.nodes[n];
  const Cost cost = cost_of(rank, g, n);
  Json line{{"rank", rank.rank},
            {"graph", g},
            {"node", n},
            {"label", node.label},
            {"module", node.label.substr(0, node.label.find('/'))},
            {"kind", kinds[std::size_t(node.kind)]},
            {"loop", or_null(node.loop)},
            {"urgency", urgency_of(graph, n)},
            {"place", or_null(node.place)},
            {"runs", cost.runs},
            {"mean_ns", std::round(cost.mean_ns)},
            {"spread_ns", std::round(cost.spread_ns)}};
  if (node.kind == NodeKind::loop)
    line["min"] = node.limits.min, line["max"] = node.limits.max, line["own_urgency"] = node.limits.urgency;
  if (node.on_all) line["on_all"] = true;
  if (node.in_parts) line["in_parts"] = true;
  if (node.peer >= 0) line["peer"] = node.peer, line["tag"] = node.tag;
  if (node.peer >= 0 || node.kind == NodeKind::reduce) line["bytes"] = node.bytes;
  Json uses = Json::array(), after = Json::array();
  for (const UseRecord& use : node.uses) {
    uses.push_back({use.datum, accesses[std::size_t(use.how)]});
    if (use.bytes > 0) uses.back().push_back(use.bytes);
  }
  for (const Edge& edge : before) after.push_back({edge.from, edge.distance, graph.bytes(edge)});
  line["uses"] = std::move(uses), line["after"] = std::move(after);
  return line;
}

using Put = std::function<void(const std::string& text)>;

/// ,"name":[[1,2],[],...]
template <class T>
void put_lists(const char* name, const std::vector<std::vector<T>>& lists, const Put& put) {
  put(std::string(",\"") + name + "\":[");
  for (std::size_t n = 0; n < lists.size(); ++n) put((n > 0 ? "," : "") + Json(lists[n]).dump());
  put("]");
}

void put_run(const RankRecording& rank, std::size_t r, const Put& put) {
  const RunRecord& run = rank.runs[r];
  const Json line{{"rank", rank.rank},
                  {"run", r},
                  {"window", run.window},
                  {"graph", run.graph},
                  {"replays", run.replays},
                  {"begin_ns", run.begin_ns},
                  {"wall_ns", run.wall_ns},
                  {"task_ns", run.task_ns},
                  {"idle_ns", run.idle_ns},
                  {"poll_ns", run.poll_ns},
                  {"overhead_ns", run.overhead_ns}};
  std::string head = line.dump();
  head.pop_back();
  put(head);
  put_lists("iterations", run.iterations, put), put_lists("ns", run.ns, put);
  put(",\"skipped\":[");
  for (const auto& [node, executions] : run.skipped)
    put((node == run.skipped.begin()->first ? "" : ",") + Json{node, executions}.dump());
  put("]}\n");
}

/// The lines of a rank in small pieces: all together they may be larger than what they are of.
void put_lines(const RankRecording& rank, const Put& put) {
  for (std::uint32_t g = 0; g < rank.graphs.size(); ++g) {
    const GraphRecord& graph = rank.graphs[g];
    Json data = Json::array();
    for (const DatumRecord& datum : graph.data) data.push_back({or_null(datum.place), datum.bytes});
    put(Json{{"rank", rank.rank}, {"graph", g}, {"nodes", graph.nodes.size()}, {"data", std::move(data)}}.dump() + '\n');
    std::vector<std::vector<Edge>> before(graph.nodes.size());
    for (const Edge& edge : graph.edges) before[edge.to].push_back(edge);
    for (std::uint32_t n = 0; n < graph.nodes.size(); ++n) put(node_line(rank, g, n, before[n]).dump() + '\n');
  }
  for (std::size_t r = 0; r < rank.runs.size(); ++r) put_run(rank, r, put);
}

std::string header_of(const Recording& recording, int ranks) {
  Json windows = Json::array();
  for (const WindowRecord& window : recording.windows)
    windows.push_back({{"number", window.number}, {"wall_ns", window.wall_ns}, {"on_all_ns", window.on_all_ns}});
  return Json{{"format", format}, {"version", recording_version}, {"scene", recording.scene},     {"program", recording.program},
              {"ranks", ranks},   {"threads", recording.threads}, {"windows", std::move(windows)}}
             .dump() +
         '\n';
}

template <class Names>
std::size_t index_in(const Names& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw std::runtime_error("\"" + name + "\" is no kind of node or access");
  return std::size_t(found - names.begin());
}

/// Numbers with a fraction or an exponent must fit the integers that they may be read as. Costs are not read.
void require_sizes(const Json& value, int depth = 0) {
  constexpr int deepest = 16;
  constexpr double most = 2147483647.0;
  if (value.is_number_float() && !(value.get<double>() >= 0.0 && value.get<double>() <= most))
    throw std::runtime_error("has the number " + value.dump() + "; such are 0 to 2147483647");
  if (!value.is_structured()) return;
  if (depth == deepest) throw std::runtime_error("is nested more deeply than a recording");
  for (const auto& item : value.items())
    if (item.key() != "mean_ns" && item.key() != "spread_ns") require_sizes(item.value(), depth + 1);
}

/// No file holds more than a thing a byte.
std::size_t count_in(const Json& value, const char* what, std::size_t file_bytes) {
  const auto n = value.get<std::size_t>();
  if (n > file_bytes) throw std::runtime_error("has " + std::to_string(n) + " " + what + "; the file is too short for so many");
  return n;
}

void read_header(const Json& line, Recording& to, std::size_t file_bytes) {
  if (!line.is_object() || line.value("format", "") != format)
    throw std::runtime_error("is no recording: the first line lacks \"format\": \"spindrift recording\"");
  if (const int version = line.at("version"); version < oldest_recording_version || version > recording_version)
    throw std::runtime_error("has version " + std::to_string(version) + " of the format; this program reads versions " +
                             std::to_string(oldest_recording_version) + " to " + std::to_string(recording_version) +
                             ": record again");
  to.scene = line.at("scene"), to.program = line.at("program"), to.threads = line.at("threads");
  for (const Json& window : line.at("windows"))
    to.windows.push_back({window.at("number"), window.at("wall_ns"), window.value("on_all_ns", std::int64_t(0))});
  to.ranks.resize(count_in(line.at("ranks"), "ranks", file_bytes));
  for (std::size_t r = 0; r < to.ranks.size(); ++r) to.ranks[r].rank = int(r);
}

void read_node(const Json& line, GraphRecord& graph) {
  const std::uint32_t n = line.at("node");
  NodeRecord& node = graph.nodes.at(n);
  node.label = line.at("label"), node.kind = NodeKind(index_in(kinds, line.at("kind")));
  if (const Json& loop = line.at("loop"); !loop.is_null()) node.loop = loop;
  node.place = place_of(line.at("place"));
  if (node.kind == NodeKind::loop) node.limits = {line.at("min"), line.at("max"), line.at("own_urgency")};
  node.peer = line.value("peer", -1), node.tag = line.value("tag", -1);
  node.bytes = line.value("bytes", std::uint64_t(0));
  node.on_all = line.value("on_all", false), node.in_parts = line.value("in_parts", false);
  for (const Json& use : line.at("uses")) {
    const std::uint32_t datum = use.at(0);
    if (datum >= graph.data.size()) throw std::runtime_error("uses datum " + std::to_string(datum) + ", which the graph lacks");
    node.uses.push_back({datum, Access(index_in(accesses, use.at(1))), use.size() > 2 ? use.at(2).get<std::uint64_t>() : 0});
  }
  for (const Json& edge : line.at("after")) {
    const std::uint32_t from = edge.at(0);
    if (from >= graph.nodes.size())
      throw std::runtime_error("waits for node " + std::to_string(from) + ", which the graph lacks");
    graph.edges.push_back({from, n, edge.at(1)});
  }
}

/// Executions that were not needed. Without the list (version 1): collective calls that took no time.
void read_skipped(const Json& line, const GraphRecord& graph, RunRecord& run) {
  if (!line.contains("skipped")) {
    for (std::uint32_t n = 0; n < graph.nodes.size(); ++n)
      for (std::uint32_t e = 0; e < run.ns[n].size() && graph.nodes[n].kind == NodeKind::collective; ++e)
        if (run.ns[n][e] == 0) run.skipped[n].push_back(e);
    return;
  }
  for (const Json& of_node : line.at("skipped")) {
    const std::uint32_t n = of_node.at(0);
    if (n >= run.ns.size()) throw std::runtime_error("skips node " + std::to_string(n) + ", which the graph lacks");
    std::vector<std::uint32_t>& executions = run.skipped[n];
    of_node.at(1).get_to(executions);
    if (!std::ranges::is_sorted(executions) || (!executions.empty() && executions.back() >= run.ns[n].size()))
      throw std::runtime_error("skips executions of node " + std::to_string(n) + " that it lacks or that do not rise");
  }
}

void read_line(const Json& line, Recording& to, std::size_t file_bytes) {
  RankRecording& rank = to.ranks.at(line.at("rank").get<std::size_t>());
  const std::size_t g = count_in(line.at("graph"), "graphs", file_bytes);
  if (line.contains("data")) {
    rank.graphs.resize(std::max<std::size_t>(rank.graphs.size(), g + 1));
    rank.graphs[g].nodes.resize(count_in(line.at("nodes"), "nodes", file_bytes));
    for (const Json& datum : line.at("data")) rank.graphs[g].data.push_back({place_of(datum.at(0)), datum.at(1)});
  } else if (line.contains("node")) {
    read_node(line, rank.graphs.at(g));
  } else {
    RunRecord& run = rank.runs.emplace_back();
    run.graph = std::uint32_t(g), run.window = line.at("window"), run.replays = line.at("replays");
    run.begin_ns = line.at("begin_ns"), run.wall_ns = line.at("wall_ns"), run.task_ns = line.at("task_ns");
    run.idle_ns = line.at("idle_ns"), run.poll_ns = line.at("poll_ns"), run.overhead_ns = line.at("overhead_ns");
    line.at("iterations").get_to(run.iterations), line.at("ns").get_to(run.ns);
    const std::size_t nodes = rank.graphs.at(g).nodes.size();
    if (run.ns.size() != nodes || run.iterations.size() != nodes)
      throw std::runtime_error("has times of " + std::to_string(run.ns.size()) + " nodes; its graph has " +
                               std::to_string(nodes));
    read_skipped(line, rank.graphs[g], run);
  }
}

/// To rank 0, in messages of a few megabytes; an empty one is the last.
void send_lines(const RankRecording& rank, MPI_Comm comm) {
  constexpr std::size_t enough = std::size_t(1) << 22;
  std::string text;
  const auto send = [&] {
    const int bytes = int(text.size());
    MPI_Send(&bytes, 1, MPI_INT, 0, 0, comm);
    MPI_Send(text.data(), bytes, MPI_CHAR, 0, 1, comm);
    text.clear();
  };
  put_lines(rank, [&](const std::string& more) {
    text += more;
    if (text.size() >= enough) send();
  });
  if (!text.empty()) send();
  send();
}

}  // namespace

void write_recording(const Recording& own, const std::string& path, MPI_Comm comm) {
  int rank = 0, size = 1;
  MPI_Comm_rank(comm, &rank), MPI_Comm_size(comm, &size);
  if (rank > 0) {
    send_lines(own.ranks.front(), comm);
    return;
  }
  errno = 0;
  std::ofstream out(path);
  out << header_of(own, size);
  put_lines(own.ranks.front(), [&](const std::string& text) { out << text; });
  std::string text;
  for (int other = 1; other < size; ++other)
    for (int bytes = -1; bytes != 0; out << text) {
      MPI_Recv(&bytes, 1, MPI_INT, other, 0, comm, MPI_STATUS_IGNORE);
      text.resize(std::size_t(bytes));
      MPI_Recv(text.data(), bytes, MPI_CHAR, other, 1, comm, MPI_STATUS_IGNORE);
    }
  out.flush();
  if (!out) throw std::runtime_error("cannot write the recording to " + path + ": " + std::strerror(errno));
}

Recording read_recording(const std::string& path) {
  errno = 0;
  std::ifstream in(path);
  if (!in) throw std::runtime_error(path + ": " + std::strerror(errno));
  const std::size_t bytes = std::filesystem::is_regular_file(path) ? std::filesystem::file_size(path) : 0;
  Recording recording;
  std::string text;
  std::size_t number = 0;
  try {
    while (std::getline(in, text)) {
      ++number;
      const Json line = Json::parse(text);
      require_sizes(line);
      if (number == 1)
        read_header(line, recording, bytes);
      else
        read_line(line, recording, bytes);
    }
    if (number == 0) throw std::runtime_error("is empty");
  } catch (const std::exception& e) {
    throw std::runtime_error(path + ": line " + std::to_string(std::max<std::size_t>(number, 1)) + ": " + e.what());
  }
  return recording;
}

}  // namespace spindrift::runtime
