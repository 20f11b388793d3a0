// Laws of kernels/base/binned_sum.hpp: no order, no grouping changes a bit; the value is the exact sum rounded where bins
// suffice. SPDX-License-Identifier: Apache-2.0
#include "kernels/base/binned_sum.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <random>
#include <vector>

using namespace spindrift;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double in_order(const std::vector<double>& terms) {
  BinnedSum sum;
  for (const double x : terms) sum.add(x);
  return sum.value();
}
std::uint64_t bits(double x) { return std::bit_cast<std::uint64_t>(x); }

/// Terms that lose digits in any plain sum, of each kind.
std::vector<std::vector<double>> adversaries() {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<std::vector<double>> all(5);
  for (int n = 0; n < 3000; ++n) {
    all[0].push_back(uniform(random));
    all[1].push_back(std::ldexp(uniform(random), int(random() % 200) - 100));         // a huge range
    all[2].push_back(std::ldexp(uniform(random), int(random() % 2090) - 1070));       // all of it, subnormals too
    all[3].push_back(n % 2 == 0 ? std::ldexp(uniform(random), 60) : -all[3].back());  // cancels but for what follows
    all[4].push_back(std::ldexp(double(random() >> 11), -1074 - int(random() % 2)));  // subnormals
  }
  for (int n = 0; n < 100; ++n) all[3].push_back(uniform(random));
  return all;
}

}  // namespace

TEST_CASE("a binned sum has the same bits in any order and any grouping", "[base][fast]") {
  std::mt19937_64 random(11);
  for (std::vector<double>& terms : adversaries()) {
    const std::uint64_t expected = bits(in_order(terms));
    for (int trial = 0; trial < 20; ++trial) {
      std::shuffle(terms.begin(), terms.end(), random);
      CHECK(bits(in_order(terms)) == expected);
      // By parts that are joined in any order, some empty.
      std::vector<BinnedSum> parts(1 + random() % 40);
      for (const double x : terms) parts[random() % parts.size()].add(x);
      while (parts.size() > 1) {
        const std::size_t to = random() % (parts.size() - 1);
        parts[to].add(parts.back());
        parts.pop_back();
      }
      CHECK(bits(parts[0].value()) == expected);
    }
    for (double& x : terms) x = -x;
    CHECK(bits(-in_order(terms)) == expected);
  }
  // Rising and falling sizes, so that the highest bin is met last and first.
  std::vector<double> rising;
  for (int e = -1000; e < 1000; e += 7) rising.push_back(std::ldexp(1.37, e));
  const double up = in_order(rising);
  std::reverse(rising.begin(), rising.end());
  CHECK(bits(in_order(rising)) == bits(up));
}

TEST_CASE("a binned sum is the exact sum rounded once where its bins reach", "[base][fast]") {
  CHECK(in_order({}) == 0.0);
  for (const double x : {1.0, -1.0, 0.1, 1e300, -1e-300, 5e-324, 1.7976931348623157e308, 2.2250738585072014e-308, 3.5e-310})
    CHECK(in_order({x}) == x);
  CHECK(in_order({1e16, 1.0, -1e16}) == 1.0);
  CHECK(in_order({1.0, 1e20, -1e20, 1e-5}) == Approx(1.0 + 1e-5).epsilon(1e-15));
  CHECK(in_order({1e308, 1e308, -1e308}) == 1e308);  // no overflow on the way
  CHECK(in_order({1e308, 1e308}) == infinity);
  CHECK(in_order({0.1, -0.1}) == 0.0);
  // Ties to even, and a hair above a tie.
  const double unit = std::ldexp(1.0, -53);
  CHECK(in_order({1.0, unit}) == 1.0);
  CHECK(in_order({1.0, unit, std::ldexp(1.0, -90)}) == 1.0 + 2 * unit);
  CHECK(in_order({1.0, 3 * unit}) == 1.0 + 4 * unit);
  CHECK(in_order({-1.0, -unit, -std::ldexp(1.0, -90)}) == -1.0 - 2 * unit);
  // Integers of 100 bits against exact arithmetic.
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 200; ++trial) {
    __int128 exact = 0;
    BinnedSum sum;
    for (int n = 0; n < 500; ++n) {
      const int shift = int(random() % 40);
      const std::int64_t digits = std::int64_t(random()) >> 11;
      exact += static_cast<__int128>(digits) << shift;
      sum.add(std::ldexp(double(digits), shift));
    }
    CHECK(sum.value() == double(exact));
  }
  // The stated bound, where bins do not reach: n 2^-96 of the largest.
  std::vector<double> small(1000, std::ldexp(1.9, -100));
  small.push_back(1.0), small.push_back(-1.0);
  CHECK(std::abs(in_order(small) - 1000 * std::ldexp(1.9, -100)) <= 1002 * std::ldexp(1.0, -96));
}

TEST_CASE("many terms of one size do not overflow a bin", "[base][fast]") {
  BinnedSum sum, twice;
  const double most = std::ldexp(1.0, 40) - std::ldexp(1.0, -13);
  for (int n = 0; n < 1000; ++n) sum.add(most);
  for (int level = 0; level < 20; ++level) {  // 1000 x 2^20 terms by doubling
    twice = sum;
    sum.add(twice);
  }
  CHECK(sum.value() == 1000.0 * 1048576.0 * most);
}

TEST_CASE("what is not finite shows in a binned sum, in any order", "[base][fast]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (std::vector<double> terms : {std::vector{1.0, infinity, -3.0}, std::vector{1e300, 2.0, infinity, infinity}}) {
    CHECK(in_order(terms) == infinity);
    std::reverse(terms.begin(), terms.end());
    CHECK(in_order(terms) == infinity);
  }
  CHECK(in_order({-infinity, 4.0}) == -infinity);
  CHECK(std::isnan(in_order({infinity, 1.0, -infinity})));
  CHECK(std::isnan(in_order({-infinity, infinity})));
  CHECK(std::isnan(in_order({1.0, nan, infinity})));
  BinnedSum a, b;
  a.add(1.0), b.add(nan);
  a.add(b);
  CHECK(std::isnan(a.value()));
}
