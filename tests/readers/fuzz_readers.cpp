// libFuzzer target over the readers of files, one chosen by --reader=NAME: any bytes are either read or refused with an error
// that says why. --seeds=FOLDER writes a small valid file for it, where the repository has none, and ends. Built with
// -DSPINDRIFT_FUZZ=ON (clang); run by ci/fuzz. SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "runtime/mpi/environment.hpp"
#include "src/io/machine_failure.hpp"
#include "src/scene/error.hpp"
#include "tests/readers/readers.hpp"

using namespace spindrift;
using spindrift::testing::Reader;
using spindrift::testing::readers;
namespace fs = std::filesystem;

namespace {

const Reader* chosen = nullptr;
std::string scratch;

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* count, char*** words) {
  static const runtime::MpiEnvironment environment(*count, *words);
  std::string seeds;
  for (int n = 1; n < *count; ++n) {
    const std::string_view word = (*words)[n];
    if (word == "--list") {
      for (const Reader& reader : readers()) std::puts(reader.name.c_str());
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
    chosen->write_seed((fs::path(seeds) / (chosen->name + chosen->ending)).string());
    std::exit(0);
  }
  scratch = (fs::temp_directory_path() / ("spindrift_fuzz_" + std::to_string(getpid()) + chosen->ending)).string();
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
