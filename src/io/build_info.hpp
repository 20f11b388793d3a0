// How this program was built: goes into log.txt, summary.json and `spindrift --version`.
// The values are filled in by CMake (src/io/build_info.cpp.in; the commit anew at each build by write_commit.cmake).
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace spindrift::io {

struct BuildInfo {
  std::string version;     ///< of Spindrift
  std::string commit;      ///< hash of the sources, "-modified" where they differ from it, "unknown" outside a repository
  std::string compiler;    ///< name and version
  std::string flags;       ///< as passed for this build type
  std::string build_type;  ///< Release, Debug, ...
  std::vector<std::pair<std::string, std::string>> libraries;  ///< name, version
};

const BuildInfo& build_info();

}  // namespace spindrift::io
