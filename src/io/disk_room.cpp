// SPDX-License-Identifier: Apache-2.0
#include "src/io/disk_room.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <system_error>

#include "src/io/machine_failure.hpp"

namespace spindrift::io {

void require_room(const std::filesystem::path& path, std::int64_t size, std::int64_t written) {
  const auto megabytes = [](std::uintmax_t bytes) { return fmt::format("{:.1f} MB", static_cast<double>(bytes) / 1e6); };
  rlimit limit{};
  if (::getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY && static_cast<rlim_t>(size) > limit.rlim_cur)
    throw MachineFailure("cannot write " + path.string() + ": it needs " + megabytes(static_cast<std::uintmax_t>(size)) +
                         ", files may have " + megabytes(limit.rlim_cur) + " here (ulimit -f)");
  std::error_code unknown;
  const auto space = std::filesystem::space(path.has_parent_path() ? path.parent_path() : ".", unknown);
  const auto more = static_cast<std::uintmax_t>(size - written);
  if (!unknown && more > space.available)
    throw MachineFailure("cannot write " + path.string() + ": it needs " + megabytes(more) + " more, its file system has " +
                         megabytes(space.available) + " left");
}

}  // namespace spindrift::io
