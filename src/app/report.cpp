// spindrift report, picture and film: start the Python programs of src/report on run directories and say what they wrote.
// SPDX-License-Identifier: Apache-2.0
#include "src/report/report.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "src/app/commands.hpp"

namespace spindrift::app {

namespace fs = std::filesystem;

int report(const ReportArguments& arguments, const runtime::World& world) {
  if (world.rank != 0) return done;
  report::Request request{.directories = {arguments.directories.begin(), arguments.directories.end()}, .says_verdict = true};
  if (!arguments.out.empty()) request.out = arguments.out;
  if (!arguments.png.empty()) request.png = arguments.png;
  const report::Outcome made = report::write(request);
  if (!made.ok()) {
    spdlog::error("no report: {}", made.trouble);
    return made.exit_code;
  }
  spdlog::info("report: {}", page_of(request).string());
  if (request.png) spdlog::info("picture: {}", request.png->string());
  return done;
}

int picture(const PictureArguments& arguments, const runtime::World& world) {
  if (world.rank != 0) return done;
  const std::string kind = arguments.film ? "film" : "picture";
  const fs::path out = arguments.out.empty() ? fs::path(arguments.directory) / (arguments.film ? "film.mp4" : "picture.png")
                                             : fs::path(arguments.out);
  std::vector<std::string> words = {kind, arguments.directory, "--out", out, "--camera", arguments.camera};
  if (arguments.film)
    words.insert(words.end(),
                 {"--seconds", fmt::format("{}", arguments.seconds), "--rate", fmt::format("{}", arguments.frames_per_second)});
  else
    words.insert(words.end(), {"--time", arguments.time});
  const report::Outcome made = report::start("spindrift_picture.py", std::move(words));
  if (!made.ok()) {
    spdlog::error("no {}: {}", kind, made.trouble);
    return made.exit_code;
  }
  spdlog::info("{}: {}", kind, out.string());
  return done;
}

}  // namespace spindrift::app
