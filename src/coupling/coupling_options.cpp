// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/coupling_options.hpp"

#include <fmt/format.h>

#include "src/coupling/options.hpp"
#include "src/scene/cases.hpp"
#include "src/scene/document.hpp"

namespace spindrift::coupling {

namespace {

auto scheme_cases() {
  auto cases = scene::cases<CouplingOptions, SchemeKind>(coupling_schemes(), 1);
  cases.insert(cases.begin(), {"automatic", SchemeKind::automatic, "cps2 for a resolved rotor, monolithic for others"});
  return cases;
}

std::vector<std::string> loose_or_automatic() {
  std::vector<std::string> names = coupling_schemes().with("accept_unstable");
  names.insert(names.begin(), "automatic");
  return names;
}

void check_section(const CouplingOptions& o, const scene::Report& report) {
  if (o.interpolation == Interpolation::cubic && is_strong(o.scheme) && o.samples < 3)
    report("interpolation", fmt::format("cubic needs samples of at least 3 (and the window's start); there {} {}",
                                        o.samples == 1 ? "is" : "are", o.samples));
}

}  // namespace

const scene::Section<CouplingOptions>& coupling_section() {
  using scene::above, scene::between;
  static const auto schemes = coupling_schemes();
  static const auto section =
      scene::Section<CouplingOptions>("coupling", "How the rotor and the rest of the floating system share a window.")
          .choice("scheme", &CouplingOptions::scheme, scheme_cases(),
                  "Monolithic, loose (cps, cps2, css: one evaluation of the rotor per window), or strong (iterated until both "
                  "agree).")
          .choice("composition", &CouplingOptions::composition,
                  {{"serial", Composition::serial, "bodies on the loads, then the rotor on their motion (Gauss-Seidel)"},
                   {"parallel", Composition::parallel,
                    "both at once on loads and motion (Jacobi): more evaluations, each of which overlaps"}},
                  "Order of the parts in an evaluation.")
          .only_if("scheme", schemes.with("composition"))
          .integer("predictor_order", &CouplingOptions::predictor_order, "-",
                   "Order of the polynomial in time that extrapolates loads: on the bodies with css, where strong schemes begin.",
                   between(0, 2))
          .only_if("scheme", schemes.with("predictor_order"))
          .number("relaxation", &CouplingOptions::relaxation, "-",
                  "Factor of the scheme, or of its first step. A fluid r times as heavy as the body needs less than 2 / (1 + r).",
                  above(0.0).up_to(1.0))
          .only_if("scheme", schemes.with("relaxation"))
          .number("tolerance", &CouplingOptions::tolerance, "-",
                  "The window is solved when the loads that went in and came out differ by less than this part of them.",
                  above(0.0).up_to(0.1))
          .only_if("scheme", schemes.with("tolerance"))
          .integer("max_evaluations", &CouplingOptions::max_evaluations, "-",
                   "Evaluations of a window before the fallback: clear what was learned, relax, retry, then cut the window.",
                   between(1, 100000))
          .only_if("scheme", schemes.with("max_evaluations"))
          .integer("max_cuts", &CouplingOptions::max_cuts, "-",
                   "How often what is left of a window may be halved; after that the run stops.", between(0, 20))
          .only_if("scheme", schemes.with("max_cuts"))
          .integer("reuse_windows", &CouplingOptions::reuse_windows, "-", "Windows before this one whose differences are kept.",
                   between(0, 1000))
          .only_if("scheme", schemes.with("reuse_windows"))
          .number("filter", &CouplingOptions::filter, "-", "Differences are dropped where less than this part of them is new.",
                  above(0.0).up_to(0.5))
          .only_if("scheme", schemes.with("filter"))
          .integer("samples", &CouplingOptions::samples, "-",
                   "Loads and motion exchanged at this many equal parts of the window.", between(1, 100))
          .only_if("scheme", schemes.with("samples"))
          .choice("interpolation", &CouplingOptions::interpolation,
                  {{"constant", Interpolation::constant, "the value at the end of each part: first order"},
                   {"linear", Interpolation::linear, "straight lines between samples: second order"},
                   {"cubic", Interpolation::cubic, "through the four nearest samples: fourth order"}},
                  "Loads between samples.")
          .only_if("scheme", schemes.with("interpolation"))
          .choice(
              "placement", &CouplingOptions::placement,
              {{"shared", Placing::shared, "air and sea share all ranks and threads: what one leaves idle the other fills"},
               {"split", Placing::split, "ranks of its own for each, as in Leble & Barakos (2016); same results"}},
              "Which ranks work on the rotor's air and which on the sea, bodies and moorings. Ranks started as `--fluid air` and "
              "`--fluid sea` are split whatever this says.")
          .integer("air_ranks", &CouplingOptions::air_ranks, "-",
                   "Ranks of the air, the last ones of the run; the others have the sea.", between(1, 1e6))
          .only_if("placement", {"split"})
          .flag("accept_unstable", &CouplingOptions::accept_unstable,
                "Run a loose scheme at a window beyond the limit that `spindrift check` prints, where it is refused otherwise.")
          .only_if("scheme", loose_or_automatic())
          .check(check_section);
  return section;
}

void check_coupling(scene::Document& document, const CouplingOptions& o, const TimeOptions& time) {
  const auto steps = whole_ratio(time.window_s, time.step());
  if (is_strong(o.scheme) && steps && *steps % o.samples != 0)
    document.problem("coupling.samples", fmt::format("must divide the window's {} steps", *steps));
  if (o.placement == Placing::split && o.scheme == SchemeKind::monolithic)
    document.problem("coupling.placement",
                     "has nothing to split: with coupling.scheme = \"monolithic\" the rotor is asked by the bodies; take "
                     "\"cps2\", say");
}

}  // namespace spindrift::coupling
