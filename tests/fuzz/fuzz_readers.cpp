// libFuzzer target over the readers of files, one chosen by --reader=NAME: any bytes are either read or refused with an error
// that says why. --seeds=FOLDER writes a small valid file for it, where the repository has none, and ends. Built with
// -DSPINDRIFT_FUZZ=ON (clang); run by ci/fuzz. SPDX-License-Identifier: Apache-2.0
#include <mpi.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/replay/recording_file.hpp"
#include "src/aero/control_options.hpp"
#include "src/aero/grid/cgns.hpp"
#include "src/aero/grid/neutral_map.hpp"
#include "src/aero/grid/plot3d.hpp"
#include "src/aero/operation.hpp"
#include "src/aero/turbine.hpp"
#include "src/aero/turbulence_box.hpp"
#include "src/io/checkpoint.hpp"
#include "src/io/machine_failure.hpp"
#include "src/moorings/table_file.hpp"
#include "src/scene/columns.hpp"
#include "src/scene/error.hpp"
#include "src/sea/wamit.hpp"

using namespace spindrift;
namespace fs = std::filesystem;

namespace {

struct Reader {
  const char* name;
  std::function<void(const std::string& file)> read;
  std::function<void(const std::string& file)> write_seed = {};
};

/// Two blocks side by side, four and two cells.
aero::MultiBlockGrid small_grid() {
  aero::MultiBlockGrid grid;
  for (int b = 0; b < 2; ++b) {
    aero::Block& block = grid.blocks.emplace_back(aero::Block{.name = b == 0 ? "left" : "right", .ni = 2 - b, .nj = 2, .nk = 1});
    for (int k = 0; k <= block.nk; ++k)
      for (int j = 0; j <= block.nj; ++j)
        for (int i = 0; i <= block.ni; ++i) block.nodes.emplace_back(2.0 * b + i, j, k);
  }
  return grid;
}

void write_checkpoint(const std::string& file) {
  const std::vector<double> values{1.0, 2.0, 3.0};
  io::CheckpointWriter writer(MPI_COMM_SELF, file);
  writer.write("sea/position", std::span<const double>(values));
  writer.set("time_s", 2.5), writer.set("tick", std::int64_t(7)), writer.set("scene", std::string("a.toml"));
  writer.commit();
}
void read_checkpoint(const std::string& file) {
  const io::CheckpointReader reader(MPI_COMM_SELF, file);
  if (reader.has("sea/position")) (void)reader.read<double>("sea/position");
  if (reader.has("time_s")) (void)reader.number("time_s");
}

const std::vector<Reader>& readers() {
  const sea::WamitScale scale{10.0, 1025.0, 9.81};
  static const std::vector<Reader> all{
      {"columns", [](const std::string& file) { (void)scene::read_columns(file); }},
      {"blank_columns",
       [](const std::string& file) {
         (void)scene::read_blank_columns(file, {"a", "b"});
       }},
      {"line_table", [](const std::string& file) { (void)moorings::read_line_table(file); }},
      {"controller", [](const std::string& file) { (void)aero::read_controller(file); }},
      {"operation", [](const std::string& file) { (void)aero::read_operation(file); }},
      {"turbine", [](const std::string& file) { (void)aero::read_turbine(file); }},
      {"outline", [](const std::string& file) { (void)aero::read_outline(file); }},
      {"bts", [](const std::string& file) { (void)aero::box_of(aero::read_bts(file)); },
       [](const std::string& file) {
         aero::BtsFile box{.up = 2,
                           .across = 2,
                           .tower = 1,
                           .steps = 3,
                           .up_m = 5,
                           .across_m = 5,
                           .step_s = 0.1f,
                           .wind = 8,
                           .hub_height = 90,
                           .bottom = 80,
                           .description = "small"};
         box.grid.assign(3 * 2 * 2 * 3, 5), box.towers.assign(3 * 1 * 3, 4);
         aero::write_bts(box, file);
       }},
      {"mann",
       [](const std::string& file) {
         (void)aero::read_mann({file, file, file}, {{2, 2, 2}, {5.0, 5.0, 5.0}}, 8.0, 90.0);
       },
       [](const std::string& file) { std::ofstream(file) << std::string(32, '\1'); }},
      {"radiation", [scale](const std::string& file) { (void)sea::read_radiation(file, scale); }},
      {"excitation", [scale](const std::string& file) { (void)sea::read_excitation(file, scale); }},
      {"hydrostatics", [scale](const std::string& file) { (void)sea::read_hydrostatics(file, scale); }},
      {"drift", [scale](const std::string& file) { (void)sea::read_drift(file, scale); }},
      {"quadratic", [scale](const std::string& file) { (void)sea::read_quadratic(file, scale, sea::FrequencyPair::difference); }},
      {"plot3d", [](const std::string& file) { (void)aero::read_plot3d(file); },
       [](const std::string& file) { aero::write_plot3d(small_grid(), file); }},
      {"plot3d_binary", [](const std::string& file) { (void)aero::read_plot3d(file); },
       [](const std::string& file) { aero::write_plot3d(small_grid(), file, aero::Plot3dForm::binary); }},
      {"map",
       [](const std::string& file) {
         aero::MultiBlockGrid grid = small_grid();
         aero::read_neutral_map(grid, file);
       },
       [](const std::string& file) { aero::write_neutral_map(small_grid(), file); }},
      {"cgns", [](const std::string& file) { (void)aero::read_cgns(file); },
       [](const std::string& file) { aero::write_cgns(small_grid(), file); }},
      {"recording",
       [](const std::string& file) {
         try {
           (void)runtime::read_recording(file);
         } catch (const std::runtime_error& error) { throw io::InputError(error.what()); }
       }},
      {"checkpoint", read_checkpoint, write_checkpoint},
  };
  return all;
}

const Reader* chosen = nullptr;
std::string scratch;

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* count, char*** words) {
  MPI_Init(nullptr, nullptr);
  std::string seeds;
  for (int n = 1; n < *count; ++n) {
    const std::string_view word = (*words)[n];
    if (word == "--list") {
      for (const Reader& reader : readers()) std::puts(reader.name);
      std::exit(0);
    }
    if (word.starts_with("--seeds=")) seeds = word.substr(8);
    if (!word.starts_with("--reader=")) continue;
    for (const Reader& reader : readers())
      if (word.substr(9) == reader.name) chosen = &reader;
  }
  if (!chosen) {
    std::fputs("fuzz_readers: give --reader=NAME of those that --list prints\n", stderr);
    std::exit(2);
  }
  if (!seeds.empty()) {
    if (chosen->write_seed) chosen->write_seed((fs::path(seeds) / chosen->name).string());
    std::exit(0);
  }
  scratch = (fs::temp_directory_path() / ("spindrift_fuzz_" + std::to_string(getpid()))).string();
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  std::ofstream(scratch, std::ios::binary).write(reinterpret_cast<const char*>(bytes), std::streamsize(size));
  const auto says_why = [](const std::exception& error) {
    if (std::string_view(error.what()).empty()) std::abort();
  };
  // What readers promise; any other exception ends the target.
  try {
    chosen->read(scratch);
  } catch (const scene::SceneError& error) { says_why(error); } catch (const io::InputError& error) {
    says_why(error);
  } catch (const io::MachineFailure& error) { says_why(error); }
  return 0;
}
