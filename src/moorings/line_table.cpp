// Fibre ropes, and results of another program: kernels/mooring/line_table.hpp over the rows of a file.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/mooring/line_table.hpp"

#include <algorithm>

#include "src/moorings/model.hpp"
#include "src/moorings/table_file.hpp"

namespace spindrift::moorings {

namespace {

class Tabulated final : public StaticLine {
 public:
  explicit Tabulated(TableFile rows) : rows_(std::move(rows)), slope_(rows_.distance.size()) {
    monotone_slopes(rows_.distance, rows_.tension, slope_);
    slope_.back() = std::max(slope_.back(), steepness(slope_.size() - 2));  // of a line that softens it may be nothing
  }
  LineForces forces(const Eigen::Vector3d& span, const Eigen::Vector3d& rate) const override {
    return LineTable{rows_.distance, rows_.tension, slope_}.forces(span, rate);
  }
  /// From where it is a hundredth as stiff as where it is stiffest.
  std::optional<TautLine> taut() const override {
    double most = 0.0;
    for (std::size_t n = 0; n + 1 < slope_.size(); ++n) most = std::max({most, steepness(n), slope_[n], slope_[n + 1]});
    if (most == 0.0) return std::nullopt;
    std::size_t first = 0;
    while (steepness(first) < 0.01 * most) ++first;
    return TautLine{rows_.distance[first], most, 0.0};
  }

 private:
  /// Between row n and the next [N/m].
  double steepness(std::size_t n) const {
    return (rows_.tension[n + 1] - rows_.tension[n]) / (rows_.distance[n + 1] - rows_.distance[n]);
  }

  TableFile rows_;
  std::vector<double> slope_;
};

}  // namespace

extern const LineModel tabulated{.name = "table",
                                 .help = "tension from a table of the distance between the ends",
                                 .keys = {"table"},
                                 .make = [](const LineOptions& o, const LineEnvironment&) -> std::unique_ptr<const StaticLine> {
                                   return std::make_unique<Tabulated>(read_line_table(o.table));
                                 }};

}  // namespace spindrift::moorings
