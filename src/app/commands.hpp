// The commands of the program; what each does is in its own file of this folder.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "runtime/mpi/environment.hpp"

namespace CLI {
class App;
}

namespace spindrift::app {

/// Exit codes, also written into summary.json since mpirun may change them.
enum ExitCode : int { done = 0, bad_input = 2, numerical_failure = 3, machine_failure = 4, stopped = 5, out_of_reach = 6 };

using Command = std::function<int(const runtime::World&)>;

/// Declares every command with its arguments; parsing sets `chosen`.
void add_commands(CLI::App& cli, Command& chosen);

/// Every command with its options as Markdown: docs/reference/commands.md.
std::string commands_markdown(const CLI::App& cli);
/// Leaves the rest of a command to be done once MPI is closed; a command that starts programs of its own must not hold it.
void hand_over(std::function<void()> rest);
/// What was left, done. For main.
void finish();

struct SceneArguments {
  std::string scene;
  std::vector<std::string> overrides;  ///< "a.b=c"
};

struct RunArguments : SceneArguments {
  std::string out;                   ///< empty: a name from scene and time
  std::string fluid;                 ///< "air", "sea": what this program section works on; empty: as the scene says
  double until_s = -1.0;             ///< < 0: the scene's end
  std::vector<std::string> allowed;  ///< keys and files that a restart may have changed
  bool restart = false, overwrite = false, trace = false, quiet = false, no_report = false;
  std::string record_graph;  ///< file; empty: none
  std::string windows;       ///< "3:12" or "3": those that trace and recording take down
};

struct CheckArguments : SceneArguments {
  std::vector<std::string> columns;  ///< of history.csv: what could be left out, by its effect on these
  double trial_s = 0.0;              ///< processor time of all runs that find out [s]; 0: as usual
  bool calibrate = false;            ///< rates of the air measured by a short march instead of stated
};

struct ReportArguments {
  std::vector<std::string> directories;
  std::string out;  ///< empty: report.html, comparison.html or study.html in the first directory
  std::string png;  ///< empty: no picture
};

/// Of `picture` and `film`: what src/report/spindrift_picture.py takes.
struct PictureArguments {
  std::string directory, out;
  std::string time = "last";     ///< of a picture: seconds, or "last"
  std::string camera = "scene";  ///< "scene", "side", "front", "top", "rotor"
  double seconds = 12.0;         ///< length of a film
  int frames_per_second = 12;
  bool film = false;
};

struct GridArguments : SceneArguments {
  std::vector<std::string> files;  ///< .cgns, .p3d or .xyz, .p3dfmt; none: the report alone
};

struct StudyArguments {
  std::string file;
  std::vector<std::string> overrides;  ///< of the study file
  std::string out;                     ///< empty: runs/STUDY
  bool dry_run = false;                ///< says what would run and at what cost; runs nothing
};

struct ProfileArguments : SceneArguments {
  std::string out;   ///< empty: runs/SCENE_profile
  int windows = 10;  ///< that are counted
};

/// A machine to predict for: its network as "latency_us,GB_per_s", between nodes and optionally within one.
struct ReplayArguments {
  std::string recording;
  std::vector<int> ranks = {1}, threads = {1};
  int nodes = 1;
  std::vector<double> network;  ///< us, GB/s; us, GB/s within a node
  double skew = 0.0;
  int copies = 1;          ///< of the recorded work
  std::vector<int> weak;   ///< so many times the copies, ranks and nodes; empty: as they are given
  bool exact = false;      ///< every copy is simulated
  bool typical = false;    ///< the median of the windows, execution by execution
  std::string json, plot;  ///< files; empty: none
};

struct ImportArguments {
  std::string file, out;
  bool overwrite = false, rigid_tower = false, rigid_blades = false, quasi_static_lines = false;
};

int run(const RunArguments& arguments, const runtime::World& world);
int grid(const GridArguments& arguments, const runtime::World& world);
int check(const CheckArguments& arguments, const runtime::World& world);
/// All of the reference, or what `topic` names (a section or a key); as Markdown for inputs/REFERENCE.md.
int reference(const std::string& topic, bool markdown, const runtime::World& world);
/// Every column of history.csv, as Markdown for docs/reference/columns.md.
int reference_columns(const std::string& topic, const runtime::World& world);
int study(const StudyArguments& arguments, const runtime::World& world);
/// One line; `verbose`: all that the speed of this program depends on.
std::string version(bool verbose);
int profile(const ProfileArguments& arguments, const runtime::World& world);
int replay(const ReplayArguments& arguments, const runtime::World& world);
int report(const ReportArguments& arguments, const runtime::World& world);
int picture(const PictureArguments& arguments, const runtime::World& world);
int import_deck(const ImportArguments& arguments, const runtime::World& world);

}  // namespace spindrift::app
