// The instruction sets that a translation unit is compiled for, as a word of bits: what the program needs of the processor.
// Included where the program's own flags hold (main.cpp) and where they must not (processor.cpp).
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

// Each as __builtin_cpu_supports of gcc and clang knows it.
#define SPINDRIFT_INSTRUCTION_SETS(one)                                                                                    \
  one(popcnt) one(sse4a) one(avx) one(avx2) one(fma) one(fma4) one(xop) one(bmi) one(bmi2) one(aes) one(pclmul) one(gfni)  \
      one(vpclmulqdq) one(avx512f) one(avx512cd) one(avx512bw) one(avx512dq) one(avx512vl) one(avx512ifma) one(avx512vbmi) \
          one(avx512vbmi2) one(avx512vnni) one(avx512bitalg) one(avx512vpopcntdq) one(avx512bf16) one(avx5124fmaps)

namespace spindrift::app {

enum class InstructionSet : int {
#define SPINDRIFT_ONE(name) name,
  SPINDRIFT_INSTRUCTION_SETS(SPINDRIFT_ONE)
#undef SPINDRIFT_ONE
};

/// Bit n: instruction set n is used by what includes this.
inline constexpr std::uint64_t bit(InstructionSet set) { return std::uint64_t(1) << int(set); }

/// Defined by the program, in a file compiled with its own flags; constant data, so that it may be read before anything runs.
extern const std::uint64_t built_for;

}  // namespace spindrift::app
