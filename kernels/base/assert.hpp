// SPINDRIFT_ASSERT(condition, "what went wrong"): a programmer's error ends the program; active in every build but Release.
// The user's errors, machine failures and numerical trouble have their own answers (docs/developer/errors.md).
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <cstdlib>

#ifdef SPINDRIFT_ASSERTIONS
#define SPINDRIFT_ASSERT(condition, what)                                                               \
  do {                                                                                                  \
    if (!(condition)) {                                                                                 \
      std::fprintf(stderr, "%s:%d: assertion failed: %s (%s)\n", __FILE__, __LINE__, what, #condition); \
      std::abort();                                                                                     \
    }                                                                                                   \
  } while (false)
#else
#define SPINDRIFT_ASSERT(condition, what) ((void)sizeof(!(condition)))
#endif
