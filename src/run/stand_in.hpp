// Sides of a window that take no time, so that the other can be measured alone: bodies that stay where they are, air without
// load. Used by system_simulation.cpp for `spindrift profile`; tested in
// tests/coupled/coupled_system_test.py. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "src/coupling/air_side.hpp"
#include "src/coupling/body_side.hpp"

namespace spindrift::run {

std::unique_ptr<coupling::BodySide> make_still_bodies();
std::unique_ptr<coupling::AirSide> make_silent_air();

}  // namespace spindrift::run
