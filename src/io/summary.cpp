// SPDX-License-Identifier: Apache-2.0
#include "src/io/summary.hpp"

#include <unistd.h>

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "src/io/atomic_file.hpp"
#include "src/io/build_info.hpp"
#include "src/io/machine_failure.hpp"

namespace spindrift::io {

namespace {

using Json = nlohmann::ordered_json;  // readers see the order written here

Json of_statistics(const HistoryStatistics& statistics) {
  Json columns = Json::object();
  for (const ColumnStatistics& column : statistics.columns) {
    Json entry = {{"final", column.final},
                  {"min", column.min},
                  {"min_time_s", column.min_time_s},
                  {"max", column.max},
                  {"max_time_s", column.max_time_s}};
    if (column.not_finite > 0) entry["not_finite"] = column.not_finite;
    Json means = Json::object();
    for (std::size_t r = 0; r < column.means.size(); ++r) means[statistics.ranges[r].name] = column.means[r];
    entry["mean"] = std::move(means);
    columns[column.name] = std::move(entry);
  }
  return columns;
}

Json of_ranges(const std::vector<TimeRange>& ranges) {
  Json out = Json::object();
  for (const TimeRange& range : ranges) out[range.name] = {{"from_s", range.from_s}, {"to_s", range.to_s}};
  return out;
}

Json of_columns(const std::vector<Column>& columns) {
  Json out = Json::array();
  for (const Column& column : columns) out.push_back({{"name", column.name}, {"unit", column.unit}, {"meaning", column.meaning}});
  return out;
}

Json of_build() {
  const BuildInfo& build = build_info();
  Json libraries = Json::object();
  for (const auto& [name, version] : build.libraries) libraries[name] = version;
  return {{"version", build.version}, {"commit", build.commit},   {"compiler", build.compiler},
          {"flags", build.flags},     {"type", build.build_type}, {"libraries", libraries}};
}

std::string processor() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("model name")) return line.substr(std::min(line.size(), line.find(':') + 2));
  return "unknown";
}

Json of_machine(const Summary& summary) {
  char host[256] = "unknown";
  ::gethostname(host, sizeof host - 1);
  return {{"host", host},
          {"processor", processor()},
          {"logical_processors", std::thread::hardware_concurrency()},
          {"ranks", summary.ranks},
          {"threads_per_rank", summary.threads}};
}

}  // namespace

double real_time_factor(const Summary& summary) {
  return summary.wall_seconds > 0.0 ? (summary.end_time_s - summary.start_time_s) / summary.wall_seconds : 0.0;
}

void write_summary_of_start(const std::filesystem::path& path, const Summary& summary) {
  const Json json = {{"format", "spindrift-summary-1"},
                     {"title", summary.title},
                     {"scene", summary.scene},
                     {"set", summary.overrides},
                     {"exit_code", nullptr},
                     {"exit_reason", "no end is recorded: the run is at work, or it was killed"},
                     {"machine", of_machine(summary)},
                     {"build", of_build()}};
  write_atomically(path, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

namespace {

std::string text_of(const std::filesystem::path& path) {
  try {
    return read_file(path);
  } catch (const MachineFailure&) { return ""; }
}

std::optional<int> exit_code_of(const std::string& text) {
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("exit_code") || !json["exit_code"].is_number()) return std::nullopt;
  return json["exit_code"].get<int>();
}

}  // namespace

std::optional<int> exit_code_in(const std::filesystem::path& path) { return exit_code_of(text_of(path)); }

SummaryOfOthers::SummaryOfOthers(std::filesystem::path path) : path_(std::move(path)), before_(text_of(path_)) {}

void SummaryOfOthers::write_instead(const Summary& summary, int rank) const try {
  std::this_thread::sleep_for(std::chrono::seconds(1));
  const std::string now = text_of(path_);
  // Without one the folder is that of another computer, unless rank 0 has begun to write in it.
  if (now.empty() ? !std::filesystem::exists(path_.parent_path() / "scene.toml") : now != before_ && exit_code_of(now)) return;
  std::filesystem::path own = path_;  // whoever comes last counts, and none writes into another's file
  own += ".rank_" + std::to_string(rank);
  write_summary(own, summary);
  std::filesystem::rename(own, path_);
} catch (const std::exception&) {}  // what failed is said all the same

void write_summary(const std::filesystem::path& path, const Summary& summary) {
  const HistoryStatistics statistics = summary.statistics.value_or(HistoryStatistics{});
  Json json = {{"format", "spindrift-summary-1"},
               {"title", summary.title},
               {"scene", summary.scene},
               {"set", summary.overrides},
               {"exit_code", summary.exit_code},
               {"exit_reason", summary.exit_reason},
               {"numerical_trouble", summary.numerical_trouble},
               {"warnings", summary.warnings},
               {"time", {{"start_s", summary.start_time_s}, {"end_s", summary.end_time_s}, {"window_s", summary.window_s}}},
               {"restarts", summary.restarts}};
  Json counts = Json::object();
  for (const auto& [name, count] : summary.counts) counts[name] = count;
  json["counts"] = std::move(counts);
  if (summary.sound_speed_m_s > 0.0) json["sound_speed_m_s"] = summary.sound_speed_m_s;
  json["wall_seconds"] = summary.wall_seconds;
  json["core_seconds"] = summary.wall_seconds * summary.ranks * summary.threads;
  json["processor_seconds"] = summary.processor_seconds;
  json["peak_memory_bytes"] = summary.peak_memory_bytes;
  json["real_time_factor"] = real_time_factor(summary);
  json["parts"] = Json::array();
  for (const PartTime& part : summary.parts)
    json["parts"].push_back(
        {{"name", part.name}, {"seconds", part.seconds}, {"core_seconds", part.core_seconds}, {"calls", part.calls}});
  json["modes"] = Json::array();
  for (const ModeLine& mode : summary.modes)
    json["modes"].push_back({{"name", mode.name}, {"frequency_Hz", mode.frequency_Hz}, {"damping", mode.damping}});
  json["efficiency"] = Json::array();
  for (const Efficiency& line : summary.efficiency)
    json["efficiency"].push_back({{"name", line.name}, {"value", line.value}, {"meaning", line.meaning}});
  json["machine"] = of_machine(summary);
  json["build"] = of_build();
  json["rows"] = statistics.rows;
  json["ranges"] = of_ranges(statistics.ranges);
  json["columns"] = of_columns(summary.columns);
  json["statistics"] = of_statistics(statistics);
  // A path may hold bytes that are not UTF-8: replace them rather than lose the summary.
  write_atomically(path, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace spindrift::io
