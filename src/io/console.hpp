// The terminal: lines of log, and below them, on a terminal, one line of progress that is rewritten in place.
// One per process, because there is one terminal. Used by log.cpp and progress.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace spindrift::io::console {

/// Prints a line to standard output (or standard error) above the status line.
void print(std::string_view line, bool to_standard_error = false);

/// Replaces the status line; an empty text removes it. Only for terminals.
void set_status(std::string_view text);

/// Whether standard output is a terminal that can rewrite a line.
bool is_terminal();

/// Columns of the terminal, 80 where unknown.
int width();

}  // namespace spindrift::io::console
