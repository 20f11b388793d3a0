// Compiled with the flags of all other files: tells what they need of the processor.
// SPDX-License-Identifier: Apache-2.0
#include "src/app/built_for.hpp"

namespace spindrift::app {

extern constexpr std::uint64_t built_for = 0
#ifdef __POPCNT__
                                           | bit(InstructionSet::popcnt)
#endif
#ifdef __SSE4A__
                                           | bit(InstructionSet::sse4a)
#endif
#ifdef __AVX__
                                           | bit(InstructionSet::avx)
#endif
#ifdef __AVX2__
                                           | bit(InstructionSet::avx2)
#endif
#ifdef __FMA__
                                           | bit(InstructionSet::fma)
#endif
#ifdef __FMA4__
                                           | bit(InstructionSet::fma4)
#endif
#ifdef __XOP__
                                           | bit(InstructionSet::xop)
#endif
#ifdef __BMI__
                                           | bit(InstructionSet::bmi)
#endif
#ifdef __BMI2__
                                           | bit(InstructionSet::bmi2)
#endif
#ifdef __AES__
                                           | bit(InstructionSet::aes)
#endif
#ifdef __PCLMUL__
                                           | bit(InstructionSet::pclmul)
#endif
#ifdef __GFNI__
                                           | bit(InstructionSet::gfni)
#endif
#ifdef __VPCLMULQDQ__
                                           | bit(InstructionSet::vpclmulqdq)
#endif
#ifdef __AVX512F__
                                           | bit(InstructionSet::avx512f)
#endif
#ifdef __AVX512CD__
                                           | bit(InstructionSet::avx512cd)
#endif
#ifdef __AVX512BW__
                                           | bit(InstructionSet::avx512bw)
#endif
#ifdef __AVX512DQ__
                                           | bit(InstructionSet::avx512dq)
#endif
#ifdef __AVX512VL__
                                           | bit(InstructionSet::avx512vl)
#endif
#ifdef __AVX512IFMA__
                                           | bit(InstructionSet::avx512ifma)
#endif
#ifdef __AVX512VBMI__
                                           | bit(InstructionSet::avx512vbmi)
#endif
#ifdef __AVX512VBMI2__
                                           | bit(InstructionSet::avx512vbmi2)
#endif
#ifdef __AVX512VNNI__
                                           | bit(InstructionSet::avx512vnni)
#endif
#ifdef __AVX512BITALG__
                                           | bit(InstructionSet::avx512bitalg)
#endif
#ifdef __AVX512VPOPCNTDQ__
                                           | bit(InstructionSet::avx512vpopcntdq)
#endif
#ifdef __AVX512BF16__
                                           | bit(InstructionSet::avx512bf16)
#endif
#ifdef __AVX5124FMAPS__
                                           | bit(InstructionSet::avx5124fmaps)
#endif
    ;

}  // namespace spindrift::app
