// spindrift: the program. Parses the command line, starts MPI, calls a command, turns failures into exit codes
// (docs/developer/errors.md): 0 done, 2 bad input, 3 numerical failure, 4 machine failure, 5 stopped on request, 6 a target of a
// study is out of reach. SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <CLI/CLI.hpp>

#include "kernels/base/failure.hpp"
#include "runtime/mpi/environment.hpp"
#include "src/app/commands.hpp"
#include "src/io/build_info.hpp"
#include "src/io/log.hpp"
#include "src/io/machine_failure.hpp"
#include "src/scene/error.hpp"

namespace {

using namespace spindrift;

/// Runs a command; says what failed, to a person, and returns the exit code.
int guarded(const std::function<int()>& command) {
  try {
    return command();
  } catch (const scene::SceneError& e) {
    spdlog::error("{}", e.what());
    return app::bad_input;
  } catch (const io::InputError& e) {
    spdlog::error("{}", e.what());
    return app::bad_input;
  } catch (const NumericalFailure& e) {
    spdlog::error("{}", e.what());
    return app::numerical_failure;
  } catch (const std::exception& e) {
    spdlog::error("{}", e.what());
    return app::machine_failure;
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App cli{"Coupled simulation of floating offshore wind turbines.", "spindrift"};
  cli.set_version_flag("--version", [] {
    const io::BuildInfo& build = io::build_info();
    return fmt::format("spindrift {} ({}, {})", build.version, build.commit, build.compiler);
  });
  cli.require_subcommand(1);
  app::Command command;
  app::add_commands(cli, command);
  try {
    cli.parse(argc, argv);
  } catch (const CLI::ParseError& e) { return cli.exit(e) == 0 ? 0 : app::bad_input; }
  try {
    int code = app::done;
    {
      const runtime::MpiEnvironment mpi(argc, argv);
      io::start_log(mpi.rank(), false);
      code = guarded([&] { return command(mpi.world()); });
      if (code == app::machine_failure && mpi.size() > 1) mpi.abort(code);  // the other ranks may be waiting for this one
    }
    app::finish();
    return code;
  } catch (const std::exception& e) {
    fmt::print(stderr, "spindrift: {}\n", e.what());
    return app::machine_failure;
  }
}
