// spindrift replay: predicts the windows of a recording for other ranks, threads, networks and placements of air and sea.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <exception>
#include <map>
#include <optional>

#include "runtime/replay/predict.hpp"
#include "runtime/replay/recording_file.hpp"
#include "src/app/commands.hpp"
#include "src/app/timeline.hpp"
#include "src/io/machine_failure.hpp"

namespace spindrift::app {

namespace {

using Json = nlohmann::ordered_json;
using runtime::Cluster, runtime::Placement, runtime::Prediction, runtime::Recording;

constexpr int most_ranks = 1 << 16;

/// `times`: of weak scaling.
Cluster cluster_of(const ReplayArguments& arguments, int ranks, int threads, double overhead_s, int times = 1) {
  if (arguments.nodes > ranks)
    throw io::InputError(fmt::format("--nodes {}: more nodes than the {} rank{} to be spread over them", arguments.nodes, ranks,
                                     ranks == 1 ? "" : "s"));
  if (long(times) * ranks > most_ranks || long(times) * arguments.copies > most_ranks)
    throw io::InputError(fmt::format("--weak {}: {} ranks and {} copies; at most {} of each", times, long(times) * ranks,
                                     long(times) * arguments.copies, most_ranks));
  Cluster cluster{.nodes = times * arguments.nodes, .ranks = times * ranks, .threads = threads};
  cluster.copies = times * arguments.copies;
  const std::vector<double>& network = arguments.network;
  if (!network.empty() && network.size() != 2 && network.size() != 4)
    throw io::InputError(
        fmt::format("--network: {} numbers; give latency [us] and bandwidth [GB/s] between nodes, or these and "
                    "both within a node",
                    network.size()));
  for (std::size_t n = 1; n < network.size(); n += 2)
    if (!(network[n] > 0.0))
      throw io::InputError(fmt::format("--network: a bandwidth of {:g} GB/s carries nothing; give more than 0", network[n]));
  if (network.size() >= 2) cluster.between = {1e-6 * network[0], 1e9 * network[1]};
  if (network.size() == 4) cluster.within = {1e-6 * network[2], 1e9 * network[3]};
  cluster.skew = arguments.skew, cluster.task_overhead_s = overhead_s;
  return cluster;
}

double measured_s(const Recording& recording) {
  double sum = 0.0;
  for (const runtime::WindowRecord& window : recording.windows) sum += 1e-9 * double(window.wall_ns);
  return sum / double(std::max<std::size_t>(1, recording.windows.size()));
}

Json figures_of(const Prediction& p, const std::optional<double>& weak) {
  const Cluster& c = p.cluster;
  const double cores = double(c.ranks) * c.threads;
  Json parts = Json::object();
  for (const auto& [module, s] : p.tasks.busy_of) parts[module] = s;
  parts["waiting"] = p.tasks.waiting_s + cores * p.outside_s - p.outside_s;
  parts["between graphs"] = p.outside_s;
  parts["runtime"] = p.tasks.overhead_s;
  Json figures{{"placement", name_of(p.placement)},
               {"nodes", c.nodes},
               {"ranks", c.ranks},
               {"threads", c.threads},
               {"air_ranks", p.placement == Placement::split ? Json(p.second_side_ranks) : Json(nullptr)},
               {"copies", c.copies},
               {"simulated_copies", p.simulated_copies},
               {"wall_s", p.wall_s},
               {"efficiency", p.efficiency},
               {"weak_efficiency", weak ? Json(*weak) : Json(nullptr)},
               {"work_s", p.work_s},
               {"critical_path_s", p.placement == Placement::bulk_synchronous ? Json(nullptr) : Json(p.tasks.critical_path_s)},
               {"repeated_work", p.repeated},
               {"imbalance", p.imbalance},
               {"pieces", p.pieces},
               {"bytes", p.tasks.bytes},
               {"messages", p.tasks.messages},
               {"reductions", p.tasks.reductions},
               {"tasks", p.tasks.tasks},
               {"parts_core_s", std::move(parts)}};
  if (p.placement != Placement::bulk_synchronous) {
    Json& chain = figures["critical_path"] = Json::array();
    for (const runtime::Link& link : p.tasks.critical_path)
      chain.push_back({{"label", link.label}, {"s", link.s}, {"executions", link.executions}});
  }
  if (!p.tasks.slices.empty()) {
    double end = 0.0;
    for (const runtime::Slice& slice : p.tasks.slices) end = std::max(end, slice.end_s);
    figures["timeline"] = timeline(p.tasks.slices, end);
  }
  return figures;
}

void print_row(const Prediction& p, const std::optional<double>& weak) {
  const Cluster& c = p.cluster;
  const double all = double(c.ranks) * c.threads * p.wall_s;
  const auto part = [&](double core_s) { return 100.0 * core_s / all; };
  const bool bulk = p.placement == Placement::bulk_synchronous;
  fmt::print("{:>6} x {:<4}{:<17}{:>10.3f}{:>8.1f}{:>8.1f}{:>9.1f}{:>9.1f}{:>10} {:>12.0f}{:>11}{:>8}{}\n", c.ranks, c.threads,
             p.placement == Placement::split ? fmt::format("split {}+{}", c.ranks - p.second_side_ranks, p.second_side_ranks)
                                             : std::string(name_of(p.placement)),
             1e3 * p.wall_s, 100.0 * p.efficiency, part(p.tasks.busy_s), part(all - p.tasks.busy_s - p.tasks.overhead_s),
             part(p.tasks.overhead_s), bulk ? "-" : fmt::format("{:.3f}", 1e3 * p.tasks.critical_path_s), 1e-3 * p.tasks.bytes,
             p.tasks.messages, p.tasks.reductions, weak ? fmt::format("{:>8.1f}", 100.0 * *weak) : "");
}

/// What the longest chain of a placement is made of.
void print_chain(const Prediction& p) {
  constexpr std::size_t most = 12;
  fmt::print("longest chain, {} on {} x {}: {:.3f} ms\n", name_of(p.placement), p.cluster.ranks, p.cluster.threads,
             1e3 * p.tasks.critical_path_s);
  const auto& links = p.tasks.critical_path;
  for (std::size_t n = 0; n < links.size() && n < most; ++n)
    fmt::print("  {:<40.40}{:>12.3f} ms in{:>7} executions\n", links[n].label, 1e3 * links[n].s, links[n].executions);
  if (links.size() > most) fmt::print("  and {} more labels\n", links.size() - most);
}

/// Ranks for which a recording has too few pieces, by what it has: "sea: 27 pieces".
using Few = std::map<std::string, std::vector<int>>;

void note_few_pieces(Few& few, const Prediction& p) {
  constexpr int least = 4;  // a rank: with fewer one more or less is a quarter of its work
  const int ranks = p.cluster.ranks;
  const auto note = [&](const std::string& text) {
    std::vector<int>& of = few[text];
    if (ranks > 1 && (of.empty() || of.back() != ranks)) of.push_back(ranks);
  };
  if (p.pieces.empty()) note("no pieces");
  for (const auto& [module, pieces] : p.pieces)
    if (pieces < least * ranks) note(fmt::format("{}: {} piece{}", module, pieces, pieces == 1 ? "" : "s"));
}

void print_few_pieces(const Few& few) {
  for (const auto& [pieces, ranks] : few)
    if (!ranks.empty())
      fmt::print("{} for {} ranks: too few, some ranks wait for others; a scene with more cells or particles has more\n", pieces,
                 fmt::join(ranks, ", "));
}

Recording read(const std::string& file) {
  try {
    return runtime::read_recording(file);
  } catch (const std::exception& e) {
    const std::string what = e.what();
    const bool foreign = what.find("json.exception") != std::string::npos;
    throw io::InputError(foreign ? file + ": is no recording; spindrift run SCENE --record-graph FILE makes one (" + what + ")"
                                 : what);
  }
}

}  // namespace

int replay(const ReplayArguments& arguments, const runtime::World& world) {
  if (world.rank != 0) return done;
  std::vector<int> times{1};
  for (const int more : arguments.weak)
    if (more > 1) times.push_back(more);
  for (const int ranks : arguments.ranks)
    for (const int n : times) cluster_of(arguments, ranks, 1, 0.0, n);  // before any long work
  const bool weak = !arguments.weak.empty();
  if (arguments.exact && !weak && arguments.copies == 1)
    throw io::InputError("--exact: of one copy all is simulated; give --copies or --weak with it");
  Recording recording = read(arguments.recording);
  if (arguments.typical) try {
      recording = runtime::typical(recording);
    } catch (const std::invalid_argument& e) { throw io::InputError(fmt::format("{}: {}", arguments.recording, e.what())); }
  const double overhead_s = runtime::task_overhead_s(recording), measured = measured_s(recording);
  fmt::print("{}: {} window{} of {}, recorded on {} x {}; {:.3f} ms each, {:.0f} ns of the runtime per task\n",
             arguments.recording, recording.windows.size(), recording.windows.size() == 1 ? "" : "s", recording.scene,
             recording.ranks.size(), recording.threads, 1e3 * measured, 1e9 * overhead_s);
  fmt::print(
      " ranks x threads and placement        ms a window  eff. %  busy % waiting % runtime % crit. ms           kB   messages "
      "reduct.{}\n",
      weak ? "  weak %" : "");
  Json all = Json::array();
  std::optional<Prediction> chain;
  Few few;
  for (const int ranks : arguments.ranks)
    for (const int threads : arguments.threads) {
      std::map<Placement, double> alone;
      for (const int n : times) {
        const Cluster cluster = cluster_of(arguments, ranks, threads, overhead_s, n);
        for (const Placement placement : possible(recording, runtime::units_of(cluster).ranks, side_of)) {
          try {
            Prediction p = predict(recording, cluster, placement, side_of,
                                   arguments.exact ? runtime::units_of(cluster).count : runtime::simulated_units);
            std::optional<double> kept;
            if (weak) kept = alone.try_emplace(placement, p.wall_s).first->second / p.wall_s;
            print_row(p, kept);
            if (recording.ranks.size() == 1 && placement == Placement::shared) note_few_pieces(few, p);
            all.push_back(figures_of(p, kept));
            if (placement == Placement::shared) chain = std::move(p);
          } catch (const std::invalid_argument& e) { throw io::InputError(fmt::format("{}: {}", arguments.recording, e.what())); }
        }
      }
    }
  print_few_pieces(few);
  if (chain) print_chain(*chain);
  const Json json{{"kind", "replay"},
                  {"version", 1},
                  {"title", recording.scene},
                  {"recorded", {{"ranks", recording.ranks.size()}, {"threads", recording.threads}, {"wall_s", measured}}},
                  {"network",
                   {{"between_latency_s", cluster_of(arguments, arguments.ranks[0], 1, 0.0).between.latency_s},
                    {"between_bytes_per_s", cluster_of(arguments, arguments.ranks[0], 1, 0.0).between.bytes_per_s},
                    {"within_latency_s", cluster_of(arguments, arguments.ranks[0], 1, 0.0).within.latency_s},
                    {"within_bytes_per_s", cluster_of(arguments, arguments.ranks[0], 1, 0.0).within.bytes_per_s},
                    {"skew", arguments.skew}}},
                  {"predictions", std::move(all)}};
  if (!arguments.json.empty()) write(json, arguments.json), fmt::print("figures: {}\n", arguments.json);
  if (!arguments.plot.empty()) draw(json, arguments.plot), fmt::print("plot: {}\n", arguments.plot);
  return done;
}

}  // namespace spindrift::app
