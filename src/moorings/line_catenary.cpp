// Chain and rope in slow motion: kernels/mooring/line_catenary.hpp. SPDX-License-Identifier: Apache-2.0
#include "kernels/mooring/line_catenary.hpp"

#include "src/moorings/model.hpp"

namespace spindrift::moorings {

extern const LineModel catenary{
    .name = "catenary",
    .help = "static elastic catenary, with or without contact on a flat bed",
    .keys = {"rest_length_m", "axial_stiffness_N", "weight_N_m", "bed_contact", "bed_friction"},
    .hangs = true,
    .make = [](const LineOptions& o, const LineEnvironment&) {
      return static_line(LineCatenary{o.rest_length_m, o.weight_N_m, *o.axial_stiffness_N, o.bed_friction, o.bed_contact},
                         taut_from_sag(o.rest_length_m, o.weight_N_m * o.rest_length_m, o.series_stiffness_N_m()));
    }};

}  // namespace spindrift::moorings
