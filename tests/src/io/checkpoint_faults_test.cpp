// Checkpoints that went wrong: cut short, changed, incomplete, interrupted, no room. None may be trusted, none may stop a restart
// from an older one. SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <hdf5.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <optional>
#include <random>

#include "src/io/atomic_file.hpp"
#include "src/io/checkpoint.hpp"
#include "src/io/collective.hpp"
#include "src/io/hdf5.hpp"
#include "src/io/log.hpp"
#include "src/io/machine_failure.hpp"
#include "tests/src/io/scratch.hpp"

using namespace spindrift;
using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

std::vector<double> state(std::int64_t tick) {
  std::vector<double> values(60);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(tick) + 1.0 / (static_cast<double>(i) + 1.0);
  return values;
}

void save(io::CheckpointSeries& series, std::int64_t tick) {
  series.save(tick, [&](io::CheckpointWriter& writer) {
    const auto values = state(tick);
    const std::vector<std::int64_t> ids(10, tick);
    writer.write<double>("bodies/motion", values);
    writer.write<std::int64_t>("sea/id", ids);
    writer.set("time_s", 0.5 * static_cast<double>(tick));
  });
}

/// After damage to the newest of 1, 2, 3 a restart goes on from 2, and says so once.
void check_falls_back(io::CheckpointSeries& series) {
  io::start_log(1, true);  // warnings are counted; rank 1 prints none
  const auto found = series.newest();
  REQUIRE(found);
  CHECK(found->integer("tick") == 2);
  CHECK(found->read<double>("bodies/motion") == state(2));
  CHECK(io::warnings_logged() == 1);
  CHECK(fs::exists(series.path(3).string() + ".damaged"));
  CHECK_FALSE(fs::exists(series.path(3)));
}

/// Limits the size of files, as a quota or a full disk would, for as long as it lives.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() { setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_{};
};

/// None where the file is refused as damaged, which a restart passes over; any other complaint would end it.
std::optional<io::CheckpointReader> open_sound(const fs::path& path) {
  try {
    return io::CheckpointReader(MPI_COMM_SELF, path);
  } catch (const io::DamagedFile&) { return std::nullopt; }
}

}  // namespace

TEST_CASE("a restart passes over a truncated newest checkpoint", "[io][faults][fast]") {
  const test::Scratch folder("faults");
  io::CheckpointSeries series(MPI_COMM_SELF, folder / "checkpoints", 3);
  for (const int tick : {1, 2, 3}) save(series, tick);
  const auto size = static_cast<std::int64_t>(fs::file_size(series.path(3)));
  const std::int64_t left = GENERATE_COPY(0, 1, 100, size / 2, size - 1);
  fs::resize_file(series.path(3), static_cast<std::uintmax_t>(left));
  check_falls_back(series);
}

TEST_CASE("whichever byte of a checkpoint is changed, it is refused or its content is untouched", "[io][faults][fast]") {
  const test::Scratch folder("faults");
  io::CheckpointSeries series(MPI_COMM_SELF, folder.path(), 3);
  save(series, 1);
  const std::string sound = io::read_file(series.path(1));
  const fs::path damaged = folder / "flipped.h5";
  int refused = 0, tried = 0;
  for (std::size_t at = 0; at < sound.size(); at += sound.size() / 3000 + 1, ++tried) {
    std::string content = sound;
    content[at] = static_cast<char>(content[at] ^ (1 << (at % 8)));
    io::write_atomically(damaged, content);
    const auto reader = open_sound(damaged);
    if (!reader) {
      ++refused;
      continue;
    }
    CHECK(reader->read<double>("bodies/motion") == state(1));
    CHECK(reader->read<std::int64_t>("sea/id") == std::vector<std::int64_t>(10, 1));
    CHECK(reader->number("time_s") == 0.5);
    CHECK(reader->integer("tick") == 1);
  }
  CHECK(refused > tried / 2);  // the rest of the bytes carry nothing
}

TEST_CASE("a changed value in an array is named and passed over at a restart", "[io][faults][fast]") {
  const test::Scratch folder("faults");
  io::CheckpointSeries series(MPI_COMM_SELF, folder / "checkpoints", 3);
  for (const int tick : {1, 2, 3}) save(series, tick);
  std::string content = io::read_file(series.path(3));
  const double value = state(3)[5];
  const std::size_t at = content.find(std::string(reinterpret_cast<const char*>(&value), sizeof value));
  REQUIRE(at != std::string::npos);
  content[at] = static_cast<char>(content[at] ^ 1);  // the last bit of a double
  io::write_atomically(series.path(3), content);
  CHECK_THROWS_WITH(io::CheckpointReader(MPI_COMM_SELF, series.path(3)), Contains("bodies/motion") && Contains("checksum"));
  check_falls_back(series);
}

TEST_CASE("a checkpoint that lost an array is passed over", "[io][faults][fast]") {
  const test::Scratch folder("faults");
  io::CheckpointSeries series(MPI_COMM_SELF, folder / "checkpoints", 3);
  for (const int tick : {1, 2, 3}) save(series, tick);
  const std::string gone = GENERATE("sea/id", "manifest");
  const hid_t file = H5Fopen(series.path(3).c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  REQUIRE(H5Ldelete(file, gone.c_str(), H5P_DEFAULT) >= 0);
  H5Fclose(file);
  CHECK_THROWS_WITH(io::CheckpointReader(MPI_COMM_SELF, series.path(3)), Contains(gone));
  check_falls_back(series);
}

TEST_CASE("a list of arrays that lost a name is noticed", "[io][faults][fast]") {
  const test::Scratch folder("faults");
  io::CheckpointSeries series(MPI_COMM_SELF, folder.path(), 3);
  save(series, 1);
  std::string content = io::read_file(series.path(1));
  const std::size_t at = content.find("bodies/motion\nsea/id\n");
  REQUIRE(at != std::string::npos);
  content[at + std::string("bodies/motion\nsea/id").size()] = ' ';  // the last name does not end any more
  io::write_atomically(series.path(1), content);
  CHECK_THROWS_WITH(io::CheckpointReader(MPI_COMM_SELF, series.path(1)), Contains("manifest"));
}

TEST_CASE("a file that is no checkpoint, or of a later format, is refused by name", "[io][faults][fast]") {
  const test::Scratch folder("faults");
  io::write_atomically(folder / "text.h5", "not HDF5 at all");
  CHECK_THROWS_WITH(io::CheckpointReader(MPI_COMM_SELF, folder / "text.h5"), Contains("text.h5"));
  CHECK_THROWS_WITH(io::CheckpointReader(MPI_COMM_SELF, folder / "absent.h5"), Contains("absent.h5"));
  { io::CheckpointWriter(MPI_COMM_SELF, folder / "later.h5").commit(); }
  const hid_t file = H5Fopen((folder / "later.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t version = H5Aopen(file, "format_version", H5P_DEFAULT);
  const std::int64_t later = 3;
  H5Awrite(version, H5T_NATIVE_INT64, &later);
  H5Aclose(version);
  H5Fclose(file);
  CHECK_THROWS_WITH(io::CheckpointReader(MPI_COMM_SELF, folder / "later.h5"),
                    Contains("format version 3") && Contains("reads 2"));
}

TEST_CASE("a run killed while it writes, or just before the rename, restarts from the checkpoint before", "[io][faults][fast]") {
  const test::Scratch folder("faults");
  io::CheckpointSeries series(MPI_COMM_SELF, folder / "checkpoints", 3);
  for (const int tick : {1, 2}) save(series, tick);
  const pid_t child = fork();
  if (child == 0) {
    series.save(3, [](io::CheckpointWriter& writer) {
      const auto values = state(3);
      writer.write<double>("bodies/motion", values);
      std::raise(SIGKILL);
    });
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  REQUIRE(WIFSIGNALED(status));
  CHECK(fs::exists(series.path(3).string() + ".tmp"));
  CHECK(series.newest()->integer("tick") == 2);
  fs::copy_file(series.path(2), series.path(4).string() + ".tmp");  // whole, but not renamed
  CHECK(series.newest()->integer("tick") == 2);
  save(series, 3);  // the next attempt writes over what was left
  CHECK(series.newest()->integer("tick") == 3);
}

TEST_CASE("without room a checkpoint fails with the system's words and the ones before stay", "[io][faults][fast]") {
  const test::Scratch folder("faults");
  io::CheckpointSeries series(MPI_COMM_SELF, folder / "checkpoints", 3);
  save(series, 1);
  const rlim_t room = GENERATE(0, 100, 1100000);
  std::string message;
  {
    const FullDisk full(room);
    try {
      series.save(2, [&](io::CheckpointWriter& writer) {
        const std::vector<double> large(100000, 1.5);
        writer.write<double>("sea/position", large);
        writer.write<double>("sea/velocity", large);
      });
    } catch (const io::MachineFailure& failure) { message = failure.what(); }
  }
  CHECK_THAT(message, Contains("ulimit") && Contains("checkpoint_000000000000000002.h5.tmp"));
  CHECK_FALSE(fs::exists(series.path(2)));
  CHECK_FALSE(fs::exists(series.path(2).string() + ".tmp"));
  CHECK(series.newest()->integer("tick") == 1);
  save(series, 3);  // room again
  CHECK(series.newest()->read<double>("bodies/motion") == state(3));
}

TEST_CASE("on a file system that fills up a checkpoint fails and the program can go on", "[io][faults][fast]") {
  const test::Scratch folder("faults");
  const fs::path disk = folder / "disk";
  fs::create_directories(disk);
  if (mount("none", disk.c_str(), "tmpfs", 0, "size=2m") != 0) {
    WARN("not run: no right to mount a small file system");
    return;
  }
  io::CheckpointSeries series(MPI_COMM_SELF, disk, 3);
  save(series, 1);
  const auto fill = [&](std::size_t count) {
    series.save(2, [&](io::CheckpointWriter& writer) {
      const std::vector<double> large(count, 1.5);
      io::write_atomically(disk / "other", std::string(1 << 20, 'x'));  // somebody else's file, after we asked for room
      writer.write<double>("sea/position", large);
    });
  };
  CHECK_THROWS_WITH(fill(1000000), Contains("left"));
  CHECK_THROWS_AS(fill(200), io::MachineFailure);
  fs::remove(disk / "other");
  CHECK(series.newest()->integer("tick") == 1);
  save(series, 3);
  CHECK(series.newest()->integer("tick") == 3);
  umount(disk.c_str());
}

TEST_CASE("an HDF5 file that cannot be flushed is closed without harm to the end of the program", "[io][faults][fast]") {
  const test::Scratch folder("faults");
  auto file = io::hdf5::create(folder / "a.h5");
  void* descriptor = nullptr;
  REQUIRE(H5Fget_vfd_handle(file.get(), H5P_DEFAULT, &descriptor) >= 0);
  const int full = open("/dev/full", O_RDWR);  // takes nothing: "No space left on device"
  dup2(full, *static_cast<int*>(descriptor));
  close(full);
  CHECK_THROWS_WITH(io::hdf5::finish(std::move(file), folder / "a.h5"), Contains("cannot write") && Contains("a.h5"));
  CHECK(H5Fget_obj_count(static_cast<hid_t>(H5F_OBJ_ALL), H5F_OBJ_ALL) == 0);  // else MPI_Finalize ends in a segmentation fault
}

TEST_CASE("with no sound checkpoint left there is none, and each was named", "[io][faults][fast]") {
  const test::Scratch folder("faults");
  io::CheckpointSeries series(MPI_COMM_SELF, folder / "checkpoints", 3);
  for (const int tick : {1, 2}) {
    save(series, tick);
    fs::resize_file(series.path(tick), 50);
  }
  io::start_log(1, true);
  CHECK_FALSE(series.newest());
  CHECK(io::warnings_logged() == 2);
}

TEST_CASE("without room on one rank all ranks get the failure and go on", "[io][faults][mpi2]") {
  const test::Scratch folder("faults_mpi2", MPI_COMM_WORLD);
  io::CheckpointSeries series(MPI_COMM_WORLD, folder / "checkpoints", 2);
  save(series, 1);
  {
    const FullDisk full(io::rank_of(MPI_COMM_WORLD) == 1 ? 1200000 : RLIM_INFINITY);
    CHECK_THROWS_AS(series.save(2,
                                [&](io::CheckpointWriter& writer) {
                                  const int rank = io::rank_of(MPI_COMM_WORLD);
                                  const std::vector<double> half(100000, 1.5);
                                  const io::Slice<const double> slice{100000 * rank, half};
                                  writer.write<double>("sea/position", 200000, std::span(&slice, 1));
                                }),
                    io::MachineFailure);
  }
  MPI_Barrier(MPI_COMM_WORLD);
  CHECK_FALSE(fs::exists(series.path(2)));
  CHECK(series.newest()->integer("tick") == 1);
  save(series, 3);
  CHECK(series.newest()->integer("tick") == 3);
}
