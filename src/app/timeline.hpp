// What replay and profile say of one placement, for their files and for the program that draws them
// (src/report/spindrift_timeline.py). SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/replay/predict.hpp"

namespace spindrift::app {

/// Air: what resolves it and the rotor; everything else goes with the sea and the bodies.
runtime::Side side_of(std::string_view module);

/// Busy cores by module in equal parts of the time from 0 to `wall_s`: {"bin_s": ..., "busy": {module: [...]}}.
nlohmann::ordered_json timeline(std::span<const runtime::Slice> slices, double wall_s, int bins = 400);

/// Draws `json` as the ending of `out` says (.png, .html); throws io::MachineFailure where that cannot be done.
void draw(const nlohmann::ordered_json& json, const std::string& out);

/// Throws io::MachineFailure where the file cannot be written.
void write(const nlohmann::ordered_json& json, const std::string& file);

}  // namespace spindrift::app
