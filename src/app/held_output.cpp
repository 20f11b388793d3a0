// SPDX-License-Identifier: Apache-2.0
#include "src/app/held_output.hpp"

#include <cerrno>
#include <cstdlib>
#include <system_error>
#include <utility>

namespace spindrift::app {

// In the GNU C library stdout is a variable.
HeldOutput::HeldOutput() : real_(stdout) {
  std::FILE* const memory = open_memstream(&text_, &size_);
  if (!memory) throw std::system_error(errno, std::generic_category(), "cannot hold output back");
  stdout = memory;
}

bool HeldOutput::empty() const {
  std::fflush(stdout);
  return size_ == 0;
}

void HeldOutput::release(const std::string& first) {
  if (!real_) return;
  std::fclose(std::exchange(stdout, std::exchange(real_, nullptr)));
  std::fwrite(first.data(), 1, first.size(), stdout);
  std::fwrite(text_, 1, size_, stdout);
  std::free(text_);
}

}  // namespace spindrift::app
