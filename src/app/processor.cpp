// Ends the program with a word where the processor lacks instructions that it was compiled for, before any of them runs: a
// constructor ahead of all others, in a file compiled for every x86-64 processor (CMakeLists.txt) and without anything of the
// standard library, whose inline functions other files may have compiled for a newer one. Tested by
// tests/src/app/other_processor.cpp. SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include "src/app/built_for.hpp"

namespace spindrift::app {
namespace {

constexpr int machine_failure = 4;  // docs/developer/errors.md

void say(const char* text) {
  int length = 0;
  while (text[length] != 0) ++length;
  if (write(STDERR_FILENO, text, unsigned(length)) < 0) _exit(machine_failure);
}

__attribute__((constructor(101))) void require_processor() {
#if defined(__x86_64__)
  __builtin_cpu_init();
  bool lacks = false;
#define SPINDRIFT_ONE(name)                                                             \
  if ((built_for & bit(InstructionSet::name)) != 0 && !__builtin_cpu_supports(#name)) { \
    say(lacks ? ", " : "spindrift: compiled for another processor: this one lacks ");   \
    say(#name);                                                                         \
    lacks = true;                                                                       \
  }
  SPINDRIFT_INSTRUCTION_SETS(SPINDRIFT_ONE)
#undef SPINDRIFT_ONE
  if (!lacks) return;
  say("; build it here (cmake --preset release), or for all with AVX2 and FMA (cmake --preset portable)\n");
  _exit(machine_failure);
#endif
}

}  // namespace
}  // namespace spindrift::app
