// history.csv once more in the two output formats of OpenFAST, for tools that read those: text (.out) and binary (.outb).
// Formats: OpenFAST's user documentation and its readers (ReadFASTtext, ReadFASTbinary); of the binary one the variant with names
// of any length and values packed in 16 bits. Called by src/app/run.cpp; tested in tests/src/io/openfast_file_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "src/io/history.hpp"

namespace spindrift::io {

enum class OpenFastFormat { none, text, binary };

/// Writes history.out or history.outb beside `history` and returns its path. `columns`: of the history, for the units. In the
/// binary format rows are equally spaced in time: a last one off the spacing is left out; throws MachineFailure where others are.
std::filesystem::path write_openfast(const std::filesystem::path& history, std::span<const Column> columns, OpenFastFormat format,
                                     const std::string& title);

}  // namespace spindrift::io
