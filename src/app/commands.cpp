// SPDX-License-Identifier: Apache-2.0
#include "src/app/commands.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <utility>

#include "src/scene/text_check.hpp"
#include "src/scene/value.hpp"

namespace spindrift::app {

namespace {

void add_scene(CLI::App& command, SceneArguments& arguments) {
  command.add_option("scene", arguments.scene, "Scene file (TOML)")->required();
  command.add_option("--set", arguments.overrides, "Override a key of the scene: --set time.end_s=60")->allow_extra_args(false);
}

const CLI::Validator not_empty([](std::string& text) { return text.empty() ? "is empty; name a folder" : ""; }, "");

/// A folder that is there or can be made.
const CLI::Validator folder(
    [](std::string& text) {
      std::error_code none;
      if (text.empty()) return std::string("is empty; name a folder");
      return std::filesystem::exists(text, none) && !std::filesystem::is_directory(text, none)
                 ? fmt::format("'{}' is a file; name a folder", text)
                 : std::string();
    },
    "");

constexpr double longest_s = 1e6;  // as time.end_s has it

/// Simulated seconds, at least zero.
const CLI::Validator time_of_run(
    [](std::string& text) {
      double value = 0.0;
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
      if (error != std::errc() || end != text.data() + text.size() || std::isnan(value))
        return fmt::format("'{}' is no number of seconds", text);
      if (value > longest_s) return fmt::format("{} s is longer than any run; give at most {} s", text, longest_s);
      return value >= 0.0 ? std::string() : fmt::format("{} s lies before the start; give a time >= 0", text);
    },
    "");

/// As CLI::Range, which lets pass what is no number.
CLI::Validator in_range(double low, double high) {
  return CLI::Validator(
      [low, high](std::string& text) {
        double value = 0.0;
        const bool read = CLI::detail::lexical_cast(text, value);
        return read && value >= low && value <= high ? std::string()
                                                     : fmt::format("Value {} not in range {:g} to {:g}", text, low, high);
      },
      CLI::Range(low, high).get_description());
}

CLI::Validator ends_in(std::vector<std::string> endings) {
  return CLI::Validator(
      [endings](std::string& file) {
        const std::filesystem::path path(file);
        std::error_code none;
        if (std::find(endings.begin(), endings.end(), path.extension()) != endings.end())
          return path.has_parent_path() && !std::filesystem::is_directory(path.parent_path(), none)
                     ? fmt::format("'{}': there is no folder {}", file, std::filesystem::absolute(path.parent_path()).string())
                     : std::string();
        return fmt::format("'{}' has an ending that is not known; write one of {}", file, fmt::join(endings, ", "));
      },
      "");
}

/// "3:12", or one number.
const CLI::Validator range_of_windows(
    [](std::string& text) {
      long first = 0, last = 0;
      char rest = 0;
      const int read = std::sscanf(text.c_str(), "%ld:%ld%c", &first, &last, &rest);
      if (read == 1 && text.find_first_not_of("-0123456789") == std::string::npos) return std::string();
      if (read != 2) return fmt::format("'{}' is no range of windows; write FIRST:LAST, as 3:12", text);
      return first <= last ? std::string() : fmt::format("the windows {} end before they begin", text);
    },
    "");

void add_profile(CLI::App& cli, Command& chosen) {
  auto arguments = std::make_shared<ProfileArguments>();
  CLI::App* command = cli.add_subcommand(
      "profile", "Where the time of a coupled scene goes: air alone, sea alone, both in turns, shared and split");
  add_scene(*command, *arguments);
  command->add_option("-o,--out", arguments->out, "Folder of the runs and figures (default: runs/SCENE_profile)")->check(folder);
  command->add_option("--windows", arguments->windows, "Windows that are counted, after two that are not (default: 10)")
      ->check(CLI::Range(1, 100000));
  command->footer(
      "Examples:\n"
      "  spindrift profile inputs/leble_barakos/case3_demo.toml --out profile1\n"
      "  mpirun -n 2 spindrift profile scene.toml --windows 20\n"
      "Each is a run of its own in the folder; profile.html, profile.png and profile.json have the figures. Split needs two "
      "ranks.");
  command->callback([arguments, &chosen] { chosen = [arguments](const auto& world) { return profile(*arguments, world); }; });
}

void add_replay(CLI::App& cli, Command& chosen) {
  auto arguments = std::make_shared<ReplayArguments>();
  CLI::App* command = cli.add_subcommand(
      "replay", "Replay a recorded window on any number of ranks and threads: time, efficiency, waiting, messages");
  command->add_option("recording", arguments->recording, "Recording: spindrift run SCENE --record-graph FILE")->required();
  command->add_option("--ranks", arguments->ranks, "Ranks in all, one or more numbers: 1,2,4 (default: 1)")
      ->delimiter(',')
      ->check(CLI::Range(1, 1 << 16));
  command->add_option("--threads", arguments->threads, "Threads of each rank, one or more numbers (default: 1)")
      ->delimiter(',')
      ->check(CLI::Range(1, 1 << 12));
  command->add_option("--nodes", arguments->nodes, "Nodes that the ranks are spread over (default: 1)")
      ->check(CLI::Range(1, 1 << 16));
  command
      ->add_option("--network", arguments->network,
                   "Latency [us] and bandwidth [GB/s] between nodes, then within a node (default: 1.5,12,0.5,6)")
      ->delimiter(',')
      ->check(in_range(0.0, 1e9));
  command->add_option("--skew", arguments->skew, "Standard deviation of the ranks' speeds, 0 to 0.5 (default: 0)")
      ->check(in_range(0.0, 0.5));
  command
      ->add_option("--copies", arguments->copies,
                   "The recorded work so many times side by side, bordering each other, on all ranks together (default: 1)")
      ->check(CLI::Range(1, 1 << 16));
  command
      ->add_option("--weak", arguments->weak,
                   "Weak scaling: so many times the copies, ranks and nodes, one or more numbers beside 1: 4,64,1024")
      ->delimiter(',')
      ->check(CLI::Range(1, 1 << 16));
  command->add_flag("--exact", arguments->exact,
                    "Simulate every copy: without it four equal parts of the computer, the slowest among them, stand for all");
  command->add_flag("--typical", arguments->typical,
                    "One window in which every execution takes the median of the windows: for recordings from a busy machine");
  command->add_option("--json", arguments->json, "Also write every figure to this file")->check(ends_in({".json"}));
  command->add_option("--plot", arguments->plot, "Also draw where the time goes, as .png or .html")
      ->check(ends_in({".png", ".html"}));
  command->footer(
      "Examples:\n"
      "  spindrift run scene.toml --out run1 --until 1 --record-graph window.jsonl\n"
      "  spindrift replay window.jsonl --threads 1,2,4\n"
      "  spindrift replay window.jsonl --ranks 64,128,256 --nodes 16 --threads 8 --network 1.5,12 --skew 0.02\n"
      "  spindrift replay window.jsonl --ranks 8 --threads 8 --weak 4,64,1024 --skew 0.02\n"
      "  spindrift replay window.jsonl --copies 32 --ranks 128 --nodes 16 --threads 8\n"
      "  spindrift replay window.jsonl --ranks 2 --json window.json --plot window.png");
  command->callback([arguments, &chosen] { chosen = [arguments](const auto& world) { return replay(*arguments, world); }; });
}

void add_picture(CLI::App& cli, Command& chosen, bool film) {
  auto arguments = std::make_shared<PictureArguments>();
  arguments->film = film;
  CLI::App* command = film ? cli.add_subcommand("film", "Film of a run: the scene as a picture shows it, over its time")
                           : cli.add_subcommand("picture", "Picture of a run: floats, turbine, lines, sea and wake together");
  command->add_option("directory", arguments->directory, "Run directory")->required();
  command
      ->add_option("-o,--out,--output", arguments->out,
                   film ? "File: .mp4 or .webm (default: film.mp4 in the run directory)"
                        : "File: .png (default: picture.png in the run directory)")
      ->check(ends_in(film ? std::vector<std::string>{".mp4", ".webm"} : std::vector<std::string>{".png"}));
  command->add_option("--camera", arguments->camera, "From where: scene, side, front, top, rotor")
      ->check(CLI::IsMember({"scene", "side", "front", "top", "rotor"}));
  if (film) {
    command->add_option("--seconds", arguments->seconds, "Length of the film [s]")->check(in_range(0.5, 600.0));
    command->add_option("--rate", arguments->frames_per_second, "Frames per second")->check(CLI::Range(1, 60));
    command->footer(
        "Examples:\n  spindrift film runs/demo/coupled\n  spindrift film runs/demo/coupled --camera side -o demo.webm\n"
        "Needs python3-vtk9 and ffmpeg: ci/setup --pictures installs them.");
  } else {
    command->add_option("--time", arguments->time, "Simulated time [s] of the picture, or last");
    command->footer(
        "Examples:\n  spindrift picture runs/demo/coupled\n  spindrift picture runs/demo/coupled --time 6 --camera rotor -o "
        "rotor.png\n"
        "Needs python3-vtk9: ci/setup --pictures installs it.");
  }
  command->callback([arguments, &chosen] { chosen = [arguments](const auto& world) { return picture(*arguments, world); }; });
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
    command->add_option("-o,--out", arguments->out, "Run directory (default: runs/SCENE_DATE_TIME)")->check(not_empty);
    command->add_option("--until", arguments->until_s, "Stop at this simulated time [s], to be continued by --restart")
        ->check(time_of_run);
    command->add_option("--fluid", arguments->fluid, "Which fluid the ranks of this section of mpirun have; the others the other")
        ->check(CLI::IsMember({"air", "sea"}));
    command->add_flag("--restart", arguments->restart, "Go on from the newest checkpoint in the run directory")->needs("--out");
    command
        ->add_option("--allow-change", arguments->allowed,
                     "With --restart: a key (or section, or file) that may differ from the run's, given once for each")
        ->allow_extra_args(false)
        ->needs("--restart");
    command->add_flag("--overwrite", arguments->overwrite, "Replace the run in the run directory")->excludes("--restart");
    command->add_flag("--trace", arguments->trace, "Write trace.json.gz (open with Perfetto or chrome://tracing)");
    command->add_option("--record-graph", arguments->record_graph,
                        "Write the task graph of some windows with measured costs to this file: spindrift replay FILE");
    command
        ->add_option("--windows", arguments->windows,
                     "Windows FIRST:LAST for --trace (default: all) and --record-graph (default: 3:12)")
        ->check(range_of_windows);
    command->add_flag("--quiet", arguments->quiet, "Warnings and errors only");
    command->add_flag("--no-report", arguments->no_report, "Leave report.html for later: spindrift report DIR");
    command->footer(
        "Examples:\n"
        "  spindrift run inputs/leble_barakos/case1_engineering.toml --out run1\n"
        "  spindrift run scene.toml --set time.end_s=60 --set waves.height_m=2.5\n"
        "  spindrift run scene.toml --out run1 --until 30\n"
        "  spindrift run scene.toml --out run1 --restart\n"
        "  spindrift run scene.toml --out run1 --until 1 --trace --windows 5:6\n"
        "  mpirun -n 2 spindrift run scene.toml --out run1");
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
    command
        ->add_option("--trial-s", arguments->trial_s,
                     "With --columns: processor time that all runs it tries may take [s] (default: 120)")
        ->check(in_range(1.0, 1e9));
    command->add_flag("--calibrate", arguments->calibrate, "Measure what a resolved rotor costs on this machine (some seconds)");
    command->footer(
        "Examples:\n"
        "  spindrift check inputs/leble_barakos/case1_engineering.toml\n"
        "  spindrift check scene.toml --set time.step_s=0.02\n"
        "  spindrift check scene.toml --columns platform.pitch_deg,rotor.thrust_N\n"
        "  spindrift check inputs/validation/floating_box/floating_box.toml --columns box.z_m --trial-s 600");
    command->callback([arguments, &chosen] { chosen = [arguments](const auto& world) { return check(*arguments, world); }; });
  }
  {
    auto arguments = std::make_shared<GridArguments>();
    CLI::App* command =
        cli.add_subcommand("grid", "Make the grid of a rotor or of a flow, print its quality, write it as Plot3D or CGNS");
    add_scene(*command, *arguments);
    command
        ->add_option("-o,--out,--output", arguments->files,
                     "File: .cgns; .p3d or .xyz (binary Plot3D) or .p3dfmt, with a .nmf beside it")
        ->check(ends_in({".cgns", ".p3d", ".xyz", ".p3dfmt"}))
        ->allow_extra_args(false);
    command->footer(
        "Examples:\n"
        "  spindrift grid inputs/leble_barakos/rotor_demo.toml\n"
        "  spindrift grid inputs/leble_barakos/rotor_demo.toml -o rotor.cgns\n"
        "  spindrift grid inputs/validation/naca0012/family.toml -o wing.cgns");
    command->callback([arguments, &chosen] { chosen = [arguments](const auto& world) { return grid(*arguments, world); }; });
  }
  {
    auto arguments = std::make_shared<StudyArguments>();
    CLI::App* command =
        cli.add_subcommand("study", "Run the variants of a study; error against cost, the front, the cheapest that will do");
    command->add_option("study", arguments->file, "Study file (TOML)")->required();
    command->add_option("--set", arguments->overrides, "Override a key of the study file")->allow_extra_args(false);
    command->add_option("-o,--out", arguments->out, "Folder of the runs (default: runs/STUDY); finished runs in it are kept")
        ->check(folder);
    command->add_flag("--dry-run", arguments->dry_run, "Say what would run and the forecast of its cost; run nothing");
    command->footer(
        "Examples:\n"
        "  spindrift study inputs/tutorials/steps.toml --out runs/steps\n"
        "  spindrift study inputs/studies/case2_time_step.toml --dry-run");
    command->callback([arguments, &chosen] { chosen = [arguments](const auto& world) { return study(*arguments, world); }; });
  }
  {
    auto arguments = std::make_shared<ImportArguments>();
    CLI::App* command =
        cli.add_subcommand("import", "Make a scene from an OpenFAST deck (versions 3 to 5) or a windIO turbine (1.x)");
    command->add_option("main", arguments->file, "Main input file (.fst), or turbine (.yaml)")->required();
    command->add_option("-o,--out,--output", arguments->out, "Folder for scene.toml and its files")->required()->check(folder);
    command->add_flag("--overwrite", arguments->overwrite, "Replace the scene in the folder, and its files");
    command->add_flag(
        "--rigid-tower", arguments->rigid_tower,
        "A tower that bends in the deck stays rigid in the scene; of a windIO turbine no table of a beam is written");
    command->add_flag("--rigid-blades", arguments->rigid_blades, "Blades that bend in the deck stay rigid in the scene");
    command->add_flag("--quasi-static-lines", arguments->quasi_static_lines,
                      "MoorDyn's lines come over as catenaries, several in a row as one of sections");
    command->footer(
        "Examples:\n"
        "  spindrift import 5MW_OC3Spar.fst -o spar\n"
        "  spindrift import IEA-15-240-RWT.yaml -o iea15");
    command->callback(
        [arguments, &chosen] { chosen = [arguments](const auto& world) { return import_deck(*arguments, world); }; });
  }
  {
    auto topic = std::make_shared<std::string>();
    auto markdown = std::make_shared<bool>(false);
    CLI::App* command = cli.add_subcommand("reference", "Every scene key with type, unit, default, range and a sentence");
    command->add_option("topic", *topic, "A section or a key; with --columns what columns begin with, as sea, or a word");
    command->add_flag("--markdown", *markdown, "All of it, as inputs/REFERENCE.md")->excludes("topic");
    command->footer(
        "Examples:\n"
        "  spindrift reference waves\n"
        "  spindrift reference waves.height_m\n"
        "  spindrift reference precone_deg\n"
        "  spindrift reference --columns rotor");
    const auto columns = std::make_shared<bool>(false);
    command->add_flag("--columns", *columns, "Every column of history.csv instead, as in docs/reference/columns.md")
        ->excludes("--markdown");
    command->callback([=, &chosen] {
      chosen = [=](const auto& world) {
        return *columns ? reference_columns(*topic, world) : reference(*topic, *markdown, world);
      };
    });
  }
  {
    auto arguments = std::make_shared<ReportArguments>();
    CLI::App* command = cli.add_subcommand("report", "(Re)make report.html of a run directory; of several, compare them");
    command->add_option("directory", arguments->directories, "Run directory, or the folder of a study")->required();
    command
        ->add_option("-o,--out,--output", arguments->out, "The page (default: report.html, comparison.html or study.html in DIR)")
        ->check(ends_in({".html"}));
    command->add_option("--png", arguments->png, "Also a picture of the first run's plots")->check(ends_in({".png"}));
    command->footer(
        "Examples:\n"
        "  spindrift report run1\n"
        "  spindrift report run1 run2 -o compared.html\n"
        "  spindrift report runs/steps");
    command->callback([arguments, &chosen] { chosen = [arguments](const auto& world) { return report(*arguments, world); }; });
  }
  add_profile(cli, chosen);
  add_replay(cli, chosen);
  add_picture(cli, chosen, false);
  add_picture(cli, chosen, true);
  {
    auto topic = std::make_shared<std::string>();
    auto markdown = std::make_shared<bool>(false);
    CLI::App* command = cli.add_subcommand("help", "The same as --help; with a command, the help of that command");
    command->add_option("command", *topic, "A command");
    command->add_flag("--markdown", *markdown, "Every command, as docs/reference/commands.md")->excludes("command");
    command->footer("Examples:\n  spindrift help run");
    command->callback([=, &cli, &chosen] {
      if (*markdown) {
        fmt::print("{}", commands_markdown(cli));
      } else if (topic->empty()) {
        fmt::print("{}", cli.get_formatter()->make_help(&cli, cli.get_name(),
                                                        CLI::AppFormatMode::Normal));  // cli.help() is that of the command chosen
      } else {
        const auto named = [&](const CLI::App* app) { return app->get_name() == *topic; };
        const std::vector<const CLI::App*> found = std::as_const(cli).get_subcommands(named);
        if (found.empty()) {
          std::vector<std::string> known;
          for (const CLI::App* one : std::as_const(cli).get_subcommands([](const CLI::App*) { return true; }))
            known.push_back(one->get_name());
          const std::string near = scene::nearest(*topic, known);
          throw CLI::ValidationError(
              fmt::format("there is no command '{}'{}", *topic, near.empty() ? "" : fmt::format("; did you mean '{}'?", near)),
              CLI::ExitCodes::ValidationError);
        }
        fmt::print("{}", found.front()->help("spindrift"));
      }
      chosen = [](const auto&) { return done; };
    });
  }
  cli.footer(
      "Examples:\n"
      "  spindrift check inputs/leble_barakos/case1_engineering.toml\n"
      "  spindrift run inputs/leble_barakos/case1_engineering.toml --out run1\n"
      "  spindrift help run\n"
      "Exit codes: 0 done, 2 bad input, 3 numerical failure (state saved), 4 system failure, 5 stopped on request with a "
      "checkpoint, 6 study: no run within the targets.");
}

std::string commands_markdown(const CLI::App& cli) {
  std::string out =
      "# Commands\n\nWritten by `spindrift help --markdown`, not by hand. `mpirun -n N spindrift ...` runs the same on many "
      "ranks.\n";
  for (const CLI::App* command : cli.get_subcommands([](const CLI::App*) { return true; }))
    out += fmt::format("\n## spindrift {}\n\n```text\n{}```\n", command->get_name(), command->help("spindrift"));
  return out +
         "\n## Exit codes\n\n| code | meaning |\n|---|---|\n| 0 | done |\n| 2 | bad input: nothing ran |\n"
         "| 3 | numerical failure: the last good state is saved |\n| 4 | failure of the system: disk, memory, network, a "
         "missing "
         "package |\n| 5 | stopped on request, with a checkpoint: `--restart` goes on |\n| 6 | a study: no run is within the "
         "targets |\n\nThe code also stands in "
         "`summary.json`, since `mpirun` may change it.\n";
}

}  // namespace spindrift::app
