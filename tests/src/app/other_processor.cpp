// A program compiled for instructions of two makers that no processor has together: must never come to main.
// SPDX-License-Identifier: Apache-2.0
#include "src/app/built_for.hpp"

namespace spindrift::app {

extern constexpr std::uint64_t built_for =
    bit(InstructionSet::popcnt) | bit(InstructionSet::xop) | bit(InstructionSet::avx5124fmaps);

}  // namespace spindrift::app

int main() { return 0; }
