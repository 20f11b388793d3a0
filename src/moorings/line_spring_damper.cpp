// The paper's lines, and tethers that go slack: kernels/mooring/line_spring_damper.hpp. SPDX-License-Identifier: Apache-2.0
#include "kernels/mooring/line_spring_damper.hpp"

#include "src/moorings/model.hpp"

namespace spindrift::moorings {

extern const LineModel spring_damper{
    .name = "spring_damper",
    .help = "linear spring and damper along the chord",
    .keys = {"rest_length_m", "axial_stiffness_N", "stiffness_N_m", "damping_N_s_m", "tension_only"},
    .make = [](const LineOptions& o, const LineEnvironment&) {
      const double stiffness = o.stiffness_N_m ? *o.stiffness_N_m : *o.axial_stiffness_N / o.rest_length_m;
      const std::optional<TautLine> taut =
          o.tension_only ? std::optional(TautLine{o.rest_length_m, stiffness, o.damping_N_s_m}) : std::nullopt;
      return static_line(LineSpringDamper{o.rest_length_m, stiffness, o.damping_N_s_m, o.tension_only}, taut);
    }};

}  // namespace spindrift::moorings
