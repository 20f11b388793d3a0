// SPDX-License-Identifier: Apache-2.0
#include "src/app/timeline.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "src/io/machine_failure.hpp"
#include "src/report/report.hpp"

namespace spindrift::app {

using Json = nlohmann::ordered_json;

runtime::Side side_of(std::string_view module) {
  if (module == "exchange" || module == "output") return runtime::Side::either;
  return module == "aero" || module == "rotor" ? runtime::Side::second : runtime::Side::first;
}

Json timeline(std::span<const runtime::Slice> slices, double wall_s, int bins) {
  const double width = wall_s / bins;
  std::map<std::string, std::vector<double>> busy;
  for (const runtime::Slice& slice : slices) {
    std::vector<double>& of = busy.try_emplace(slice.module, std::size_t(bins), 0.0).first->second;
    for (int n = std::clamp(int(slice.begin_s / width), 0, bins - 1); n < bins && n * width < slice.end_s; ++n)
      of[std::size_t(n)] += std::max(0.0, std::min(slice.end_s, (n + 1) * width) - std::max(slice.begin_s, n * width)) / width;
  }
  return {{"bin_s", width}, {"busy", busy}};
}

void write(const Json& json, const std::string& file) {
  errno = 0;
  std::ofstream out(file);
  out << json.dump(1) << '\n';
  out.flush();
  if (!out) throw io::MachineFailure("cannot write " + file + ": " + std::strerror(errno));
}

void draw(const Json& json, const std::string& out) {
  const std::filesystem::path figures =
      std::filesystem::temp_directory_path() / ("spindrift_timeline_" + std::to_string(::getpid()) + ".json");
  write(json, figures);
  const report::Outcome made = report::start("spindrift_timeline.py", {figures, "--out", out});
  std::filesystem::remove(figures);
  if (!made.ok()) throw io::MachineFailure("no " + out + ": " + made.trouble);
}

}  // namespace spindrift::app
