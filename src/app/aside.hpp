// A short run beside what the program was asked for: a folder that goes away again, nothing in the log, one thread (as many idle
// ones would be counted). Used by forecast.cpp and leave_out.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>
#include <omp.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <filesystem>
#include <system_error>

namespace spindrift::app {

class Aside {
 public:
  Aside() : level_(spdlog::get_level()), threads_(omp_get_max_threads()) {
    spdlog::set_level(spdlog::level::off);
    omp_set_num_threads(1);
  }
  Aside(const Aside&) = delete;
  Aside& operator=(const Aside&) = delete;
  ~Aside() {
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
    omp_set_num_threads(threads_);
    spdlog::set_level(level_);
  }
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / fmt::format("spindrift_trial_{}", ::getpid());

 private:
  spdlog::level::level_enum level_;
  int threads_;
};

}  // namespace spindrift::app
