// SPDX-License-Identifier: Apache-2.0
#include "src/app/commands.hpp"

#include <CLI/CLI.hpp>
#include <memory>

namespace spindrift::app {

namespace {

void add_scene(CLI::App& command, SceneArguments& arguments) {
  command.add_option("scene", arguments.scene, "Scene file (TOML)")->required();
  command.add_option("--set", arguments.overrides, "Override a key of the scene: --set time.end_s=60")->allow_extra_args(false);
}

std::function<void()>& left_over() {
  static std::function<void()> rest;
  return rest;
}

}  // namespace

void hand_over(std::function<void()> rest) { left_over() = std::move(rest); }

void finish() {
  if (left_over()) left_over()();
}

void add_commands(CLI::App& cli, Command& chosen) {
  {
    auto arguments = std::make_shared<RunArguments>();
    CLI::App* command = cli.add_subcommand("run", "Run a scene into a run directory, with a report");
    add_scene(*command, *arguments);
    command->add_option("--out", arguments->out, "Run directory (default: runs/SCENE_DATE_TIME)");
    command->add_option("--until", arguments->until_s, "Stop at this simulated time [s], to be continued by --restart")
        ->check(CLI::NonNegativeNumber);
    command->add_option("--fluid", arguments->fluid, "Which fluid the ranks of this section of mpirun have; the others the other")
        ->check(CLI::IsMember({"air", "sea"}));
    command->add_flag("--restart", arguments->restart, "Go on from the newest checkpoint in the run directory")->needs("--out");
    command
        ->add_option("--allow-change", arguments->allowed,
                     "With --restart: a key (or section, or file) that may differ from the run's, given once for each")
        ->allow_extra_args(false)
        ->needs("--restart");
    command->add_flag("--overwrite", arguments->overwrite, "Replace the run in the run directory");
    command->add_flag("--trace", arguments->trace, "Write trace.json (open with Perfetto or chrome://tracing)");
    command->add_flag("--quiet", arguments->quiet, "Warnings and errors only");
    command->add_flag("--no-report", arguments->no_report, "Leave report.html for later: spindrift report DIR");
    command->callback([arguments, &chosen] { chosen = [arguments](const auto& world) { return run(*arguments, world); }; });
  }
  {
    auto arguments = std::make_shared<CheckArguments>();
    CLI::App* command = cli.add_subcommand(
        "check", "Validate a scene, say what will be modelled, at what cost and at which limits; runs nothing");
    add_scene(*command, *arguments);
    command
        ->add_option("--columns", arguments->columns,
                     "Columns of history.csv: also try what could be left out, by its effect on them")
        ->delimiter(',');
    command->add_flag("--calibrate", arguments->calibrate, "Measure what a resolved rotor costs on this machine (some seconds)");
    command->callback([arguments, &chosen] { chosen = [arguments](const auto& world) { return check(*arguments, world); }; });
  }
  {
    auto arguments = std::make_shared<GridArguments>();
    CLI::App* command = cli.add_subcommand("grid", "Make the rotor's grid, print its quality, write it as Plot3D or CGNS");
    add_scene(*command, *arguments);
    command
        ->add_option("-o,--output", arguments->files,
                     "File: .cgns; .p3d or .xyz (binary Plot3D) or .p3dfmt, with a .nmf beside it")
        ->allow_extra_args(false);
    command->callback([arguments, &chosen] { chosen = [arguments](const auto& world) { return grid(*arguments, world); }; });
  }
  {
    auto arguments = std::make_shared<StudyArguments>();
    CLI::App* command =
        cli.add_subcommand("study", "Run the variants of a study; error against cost, the front, the cheapest that will do");
    command->add_option("study", arguments->file, "Study file (TOML)")->required();
    command->add_option("--set", arguments->overrides, "Override a key of the study file")->allow_extra_args(false);
    command->add_option("--out", arguments->out, "Folder of the runs (default: runs/STUDY); finished runs in it are kept");
    command->add_flag("--dry-run", arguments->dry_run, "Say what would run and the forecast of its cost; run nothing");
    command->callback([arguments, &chosen] { chosen = [arguments](const auto& world) { return study(*arguments, world); }; });
  }
  {
    auto topic = std::make_shared<std::string>();
    auto markdown = std::make_shared<bool>(false);
    CLI::App* command = cli.add_subcommand("reference", "Every scene key with type, unit, default, range and a sentence");
    command->add_option("topic", *topic, "A section or a key");
    command->add_flag("--markdown", *markdown, "As inputs/REFERENCE.md");
    command->callback([=, &chosen] { chosen = [=](const auto& world) { return reference(*topic, *markdown, world); }; });
  }
  {
    auto arguments = std::make_shared<ReportArguments>();
    CLI::App* command = cli.add_subcommand("report", "(Re)make report.html of a run directory; of several, compare them");
    command->add_option("directory", arguments->directories, "Run directory")->required();
    command->add_option("--png", arguments->png, "Also a picture of the first run");
    command->callback([arguments, &chosen] { chosen = [arguments](const auto& world) { return report(*arguments, world); }; });
  }
}

}  // namespace spindrift::app
