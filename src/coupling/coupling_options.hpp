// [coupling]: how the rotor and the rest of the floating system share a window. Declared in coupling_options.cpp, read by
// scenario.cpp, acted on by window.cpp; schemes in kernels/coupling. Tested in tests/src/coupling/window_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/coupling/waveform.hpp"
#include "src/coupling/scheme.hpp"
#include "src/coupling/timeline.hpp"

namespace spindrift::scene {
template <class Options>
class Section;
class Document;
}  // namespace spindrift::scene

namespace spindrift::coupling {

struct TimeOptions;

enum class Composition { serial, parallel };
enum class Placing { shared, split };

struct CouplingOptions {
  SchemeKind scheme = SchemeKind::automatic;  ///< read_scenario puts the one it stands for
  Composition composition = Composition::serial;
  int predictor_order = 1;
  double relaxation = 0.5;
  double tolerance = 1e-6;
  int max_evaluations = 50;
  int max_cuts = 3;
  int reuse_windows = 5;
  double filter = 1e-6;
  int samples = 1;
  Interpolation interpolation = Interpolation::linear;
  Placing placement = Placing::shared;
  int air_ranks = 1;             ///< of a split run; the others are the sea's
  bool accept_unstable = false;  ///< a loose scheme beyond its limit (limits.hpp)
};

const scene::Section<CouplingOptions>& coupling_section();

/// Rules with [time]: samples divide the window's steps.
void check_coupling(scene::Document& document, const CouplingOptions& coupling, const TimeOptions& time);

}  // namespace spindrift::coupling
