// SPDX-License-Identifier: Apache-2.0
#include "src/aero/flow/update_limits.hpp"

#include <fmt/format.h>

namespace spindrift::aero {

namespace {

std::string joined(const std::string& a, const char* between, const std::string& b) {
  return a.empty() || b.empty() ? a + b : a + between + b;
}

std::string share_of_cells(double count, long cells) {
  return fmt::format("{:.0f} cell{} ({:.2g} %)", count, count == 1.0 ? "" : "s", 100.0 * count / double(cells));
}

}  // namespace

std::string LimitPlaces::text() const { return joined(mean.text, " and ", model.text); }

void LimitPlaces::keep_worse(const LimitPlaces& others, const std::string& when) {
  for (const auto place : {&LimitPlaces::mean, &LimitPlaces::model})
    if (const LimitPlace& other = others.*place; other.fraction < (this->*place).fraction)
      this->*place = {other.fraction, fmt::format("{}, {}", other.text, when)};
}

std::string limited_update(double limited, double clipped, long cells) {
  return joined(limited > 0.0 ? share_of_cells(limited, cells) + " of the mean flow" : "", " and ",
                clipped > 0.0 ? share_of_cells(clipped, cells) + " of turbulence" : "");
}

std::string UpdateLimits::text(const std::string& updates, long cells, const LimitPlaces& worst) const {
  const std::string all = " of " + updates;
  const std::string mean = fmt::format("in {}{} the update was shortened, as up to {} would have changed too much", shortened_,
                                       all, share_of_cells(most_limited_, cells));
  const std::string model = fmt::format("in {}{} turbulence's update was kept above its bound, in up to {}", clipped_,
                                        shortened_ > 0 ? "" : all, share_of_cells(most_clipped_, cells));
  const std::string text = joined(shortened_ > 0 ? mean : "", "; ", clipped_ > 0 ? model : "");
  return text.empty() ? text : joined(text, "; most was ", worst.text());
}

}  // namespace spindrift::aero
