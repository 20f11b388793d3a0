// Air that settles, on disk: the newest state of this scene and of no other, and the state that failed.
// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/settling_file.hpp"

#include <unistd.h>

#include <catch2/catch.hpp>

using namespace spindrift;
using namespace spindrift::coupling;

namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

std::vector<SavedArray> settled_to(double value) { return {{"flow/tiles", 2, {{0, {value, -value}}}}}; }

}  // namespace

TEST_CASE("a state that settles is found again by the scene that left it", "[coupling][faults][fast]") {
  const fs::path path = fs::temp_directory_path() / ("spindrift_settling_" + std::to_string(getpid()));
  const runtime::World world{MPI_COMM_SELF, 0, 1};
  {
    io::RunDirectory directory(MPI_COMM_SELF, path, io::Existing::overwrite);
    directory.identify("this scene");
    SettlingFile file(directory, world, 1e-9);
    CHECK_FALSE(file.newest());
    file.offer(20, settled_to(3.0)), file.offer(40, settled_to(4.0));
    const std::optional<io::CheckpointReader> newest = SettlingFile(directory, world, 600.0).newest();
    REQUIRE(newest);
    CHECK(newest->integer("tick") == 20);  // saving takes a hundredth of the time: the second came too soon
    CHECK(newest->read<double>("flow/tiles") == std::vector<double>{3.0, -3.0});

    const std::string said = file.save_failed(50, settled_to(5.0));
    CHECK_THAT(said, Contains("failed.h5") && Contains("that after 20 pseudo-steps"));
    CHECK(io::CheckpointReader(MPI_COMM_SELF, directory.settling() / "failed.h5").read<double>("flow/tiles")[0] == 5.0);
    CHECK(SettlingFile(directory, world, 600.0).newest()->integer("tick") == 20);  // what failed is not gone on with

    directory.identify("another scene");
    CHECK_FALSE(SettlingFile(directory, world, 600.0).newest());
    directory.forget_settling(MPI_COMM_SELF);
    CHECK_FALSE(fs::exists(directory.settling()));
  }
  fs::remove_all(path);
}
