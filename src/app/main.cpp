// spindrift: the program. Parses the command line, starts MPI, calls a command, turns failures into exit codes
// (docs/developer/errors.md): 0 done, 2 bad input, 3 numerical failure, 4 system failure, 5 stopped on request, 6 a target of a
// study is out of reach. SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <malloc.h>
#include <spdlog/spdlog.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/base/failure.hpp"
#include "runtime/executor/watchdog.hpp"
#include "runtime/mpi/environment.hpp"
#include "runtime/mpi/stop_request.hpp"
#include "src/app/commands.hpp"
#include "src/io/log.hpp"
#include "src/io/machine_failure.hpp"
#include "src/scene/error.hpp"
#include "src/scene/value.hpp"

namespace {

using namespace spindrift;

/// The end of a command on all ranks; `refusal`: why this one refused its input, empty where it did not. Bad input is said once,
/// by the first rank that refused it; the others may be done, or refuse the same. A rank whose others go on says it by itself and
/// ends them: they may wait for it.
void end_together(const runtime::MpiEnvironment& mpi, const std::string& refusal) {
  constexpr double longest_s = 5.0, for_ever_s = 1e9;
  constexpr int content = std::numeric_limits<int>::max();
  const bool refuses = !refusal.empty();
  const int own = refuses ? io::log_rank() : content;
  const std::optional<int> first = mpi.smallest_of_all(own, refuses ? longest_s : for_ever_s);
  if (refuses && first.value_or(own) == own) spdlog::error("{}", refusal);
  if (!first) mpi.abort(app::bad_input);
  // Once more: a rank may have come long ago and stand still since. MPI's end waits for it when nobody watches any more.
  (void)mpi.smallest_of_all(own, for_ever_s);
}

/// Runs a command; says what failed, to a person, and returns the exit code. Why it refused its input is in `refusal`,
/// still to be said.
int guarded(const std::function<int()>& command, std::string& refusal) {
  struct Printed {
    ~Printed() { std::fflush(stdout); }  // what the command printed stands before what stopped it
  };
  try {
    const Printed printed;
    return command();
  } catch (const scene::SceneError& e) {
    refusal = e.what();
    return app::bad_input;
  } catch (const io::InputError& e) {
    refusal = e.what();
    return app::bad_input;
  } catch (const NumericalFailure& e) {
    spdlog::error("{}", e.what());
    return app::numerical_failure;
  } catch (const runtime::StopAsked& e) {  // before there was a folder to say so in; the same on all ranks
    spdlog::warn("{}, before the run began: nothing is written", e.what());
    return app::stopped;
  } catch (const std::exception& e) {
    spdlog::error("{}", e.what());
    return app::machine_failure;
  }
}

/// The first word of the command line, where it is no command: what was meant. Empty where it is one.
std::string unknown_command(const CLI::App& cli, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return {};
  std::vector<std::string> known;
  for (const CLI::App* command : cli.get_subcommands([](const CLI::App*) { return true; })) known.push_back(command->get_name());
  const std::string word = argv[1];
  if (std::find(known.begin(), known.end(), word) != known.end()) return {};
  if (word.ends_with(".toml")) return fmt::format("'{}' is a file: spindrift run {}", word, word);
  if (word == "version") return "there is no command 'version'; spindrift --version says it, with --verbose in full";
  const std::string near = scene::nearest(word, known);
  return fmt::format("there is no command '{}'; {}", word,
                     near.empty() ? fmt::format("known: {}", fmt::join(known, ", ")) : fmt::format("did you mean '{}'?", near));
}

/// The first option that its command does not have, and which was meant. Empty where there is none such.
std::string unknown_option(const CLI::App& cli, int argc, char** argv) {
  if (argc < 3) return {};
  const auto commands = cli.get_subcommands([&](const CLI::App* one) { return one->get_name() == argv[1]; });
  if (commands.empty()) return {};
  const CLI::App* command = commands.front();
  std::vector<std::string> known;
  for (const CLI::Option* option : command->get_options())
    for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  for (int i = 2; i < argc; ++i) {
    const std::string word = std::string(argv[i]).substr(0, std::string_view(argv[i]).find('='));
    if (word == "--") return {};
    if (!word.starts_with("--") || std::find(known.begin(), known.end(), word) != known.end()) continue;
    if (word == "--threads" || word == "--ranks")
      return fmt::format(
          "{}: there is no option '{}'; OMP_NUM_THREADS=4 spindrift {} ... has 4 threads, mpirun -n 2 spindrift {} ... 2 ranks",
          argv[1], word, argv[1], argv[1]);
    const std::string near = scene::nearest(word, known);
    return fmt::format(
        "{}: there is no option '{}'; {}", argv[1], word,
        near.empty() ? fmt::format("spindrift {} --help lists them", argv[1]) : fmt::format("did you mean '{}'?", near));
  }
  return {};
}

/// What is wrong with words that a command has no place for, beyond options that it does not have.
std::string words_too_many(int argc, char** argv, const std::vector<std::string>& left) {
  for (int i = 2; i + 2 < argc; ++i)
    if (std::string_view(argv[i]) == "--set" && std::string_view(argv[i + 1]).find('=') == std::string_view::npos)
      return fmt::format("{}: --set {} {}: write --set {}={}, in one word", argv[1], argv[i + 1], argv[i + 2], argv[i + 1],
                         argv[i + 2]);
  for (const std::string& word : left) {
    if (word.size() > 2 && word[0] == '-' && word[1] != '-')
      return fmt::format("{}: there is no option '{}'; long options begin with two dashes: '-{}'", argv[1], word, word);
    if (word.size() == 2 && word[0] == '-')
      return fmt::format("{}: there is no option '{}'; spindrift {} --help lists them", argv[1], word, argv[1]);
  }
  return fmt::format("{}: '{}' is one word too many; spindrift {} --help says what it takes", argv[1],
                     left.empty() ? "" : left.front(), argv[1]);
}

/// What is wrong with a list of values, "1,,2", from which the parser drops what is empty. Empty where nothing is.
std::string gap_in_list(const CLI::App& cli, int argc, char** argv) {
  const auto commands = cli.get_subcommands([&](const CLI::App* one) { return argc > 1 && one->get_name() == argv[1]; });
  if (commands.empty()) return {};
  for (int i = 2; i < argc; ++i) {
    const std::string word = argv[i], name = word.substr(0, word.find('='));
    const CLI::Option* option = name.starts_with("--") ? commands.front()->get_option_no_throw(name) : nullptr;
    if (!option || option->get_delimiter() == '\0') continue;
    const std::string list = name.size() < word.size() ? word.substr(name.size() + 1) : i + 1 < argc ? argv[i + 1] : "";
    const std::string between = "," + list + ",";
    if (between.find(",,") != std::string::npos)
      return fmt::format("{}: {} {}: a value is missing beside a comma; write values alone between commas, as A,B", argv[1], name,
                         list.empty() ? "\"\"" : list);
  }
  return {};
}

/// What is wrong with the command line; empty where nothing is. --help and --version leave by CLI::Success.
std::string misread(CLI::App& cli, int argc, char** argv) {
  if (const std::string unknown = unknown_command(cli, argc, argv); !unknown.empty()) return unknown;
  if (const std::string gap = gap_in_list(cli, argc, argv); !gap.empty()) return gap;
  try {
    cli.parse(argc, argv);
  } catch (const CLI::ExtrasError& e) {
    const std::string unknown = unknown_option(cli, argc, argv);
    return unknown.empty() ? words_too_many(argc, argv, cli.remaining(true)) : unknown;
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) throw;
    const std::string known = argv[1][0] != '-' ? argv[1] : "";
    return fmt::format("{}{}; spindrift {}--help says what it takes", known.empty() ? "" : known + ": ", e.what(),
                       known.empty() ? "" : known + " ");
  }
  return {};
}

/// Whether a launcher may have started others beside this process.
bool may_have_others() {
  for (const char* size : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "SLURM_STEP_NUM_TASKS"})
    if (const char* value = std::getenv(size); value && std::atoi(value) > 1) return true;
  return false;
}

/// A library that hypre brings (SuperLU_DIST) tells the allocator, as it is loaded, to keep all memory that is ever freed. Now
/// arrays of a megabyte and more go back to the system, as they do without it; smaller ones are used again.
void give_memory_back() {
  mallopt(M_MMAP_MAX, 1 << 16);
  mallopt(M_MMAP_THRESHOLD, 1 << 20);
  mallopt(M_TRIM_THRESHOLD, 1 << 23);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && std::string_view(argv[1]) == "run") runtime::StopRequest::catch_signals();  // MPI takes its time to start
  give_memory_back();
  CLI::App cli{"Coupled simulation of floating offshore wind turbines.", "spindrift"};
  bool verbose = false;  // parsed before --version is answered
  cli.add_flag("--verbose", verbose, "With --version: compiler, flags, vector width, libraries, processors of this process");
  cli.set_version_flag("--version", [&verbose] { return app::version(verbose); });
  cli.require_subcommand(1);
  app::Command command;
  app::add_commands(cli, command);
  if (argc < 2) {
    fmt::print(stderr, "{}", cli.help());
    return app::bad_input;
  }
  std::string refusal;
  try {
    refusal = misread(cli, argc, argv);
  } catch (const CLI::ParseError& asked) { return cli.exit(asked); }
  if (!refusal.empty() && !may_have_others()) {
    fmt::print(stderr, "error: {}\n", refusal);
    return app::bad_input;
  }
  try {
    int code = app::bad_input;
    {
      const runtime::MpiEnvironment mpi(argc, argv);
      const runtime::Watchdog watchdog(runtime::Watchdog::Of::process);  // until the last rank has come to the end
      io::start_log(mpi.rank(), false);
      if (refusal.empty()) code = guarded([&] { return command(mpi.world()); }, refusal);
      if (code == app::machine_failure && mpi.size() > 1) mpi.abort(code);  // the other ranks may be waiting for this one
      end_together(mpi, refusal);
    }
    app::finish();
    return code;
  } catch (const std::exception& e) {
    fmt::print(stderr, "spindrift: {}\n", e.what());
    return app::machine_failure;
  }
}
