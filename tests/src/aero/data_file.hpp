// A small data file in the test's own temporary directory, for the tests of what scenes read. Called within a test case:
// before main() every process would write the same file.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

namespace spindrift::aero {

inline std::string data_file(const std::string& name, const std::string& text) {
  const std::string path = (std::filesystem::temp_directory_path() / ("spindrift_aero_" + name)).string();
  std::ofstream(path) << text;
  return path;
}

}  // namespace spindrift::aero
