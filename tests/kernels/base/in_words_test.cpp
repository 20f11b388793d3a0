// Numbers in messages. SPDX-License-Identifier: Apache-2.0
#include "kernels/base/in_words.hpp"

#include <catch2/catch.hpp>

using namespace spindrift;

TEST_CASE("a number in a message has as many digits as are asked for", "[base][fast]") {
  CHECK(in_words(1234.5678) == "1.23e+03");
  CHECK(in_words(-0.012345) == "-0.0123");
  CHECK(in_words(1234.5678, 6) == "1234.57");
  CHECK(in_words(-1.7976931348623157e308, 6) == "-1.79769e+308");
}
