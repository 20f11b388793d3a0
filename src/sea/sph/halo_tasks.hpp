// Planes of the groups at borders as messages between ranks, and those of images in a plane of symmetry, recorded as tasks. Used
// by tasks.cpp; tested in tests/src/sea/sph/tasks_test.cpp on several ranks and mirrored_test.cpp. SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "src/sea/sph/step_recording.hpp"

namespace spindrift::sph {

/// What the halo gets: planes, of all particles or of water and then of solids, where walls take theirs from the water; or the
/// sub-particle stress.
enum class HaloOf { planes, water, solids, stress };

template <int dim, class Real>
class HaloTasks {
 public:
  /// Messages take as many tags from `first_tag` on as there are exchanges.
  explicit HaloTasks(int first_tag) : next_tag_(first_tag) {}
  HaloTasks(const HaloTasks&) = delete;  // tasks refer to its messages
  HaloTasks& operator=(const HaloTasks&) = delete;

  /// Values of the groups at borders go to the ranks beside, as one message each; then images take those of their groups.
  void record(StepRecording<dim, Real>& recording, const std::string& label, HaloOf what);

 private:
  static void record_images(StepRecording<dim, Real>& recording, const std::string& label, HaloOf what);

  struct Message {
    std::vector<Real> out{}, in{};
  };
  std::deque<Message> messages_;
  int next_tag_;
};

}  // namespace spindrift::sph
