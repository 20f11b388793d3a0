// SPDX-License-Identifier: Apache-2.0
#include "src/bodies/state.hpp"

#include "kernels/base/assert.hpp"

namespace spindrift::bodies {

void BodiesState::pack(std::span<double> out) const {
  SPINDRIFT_ASSERT(out.size() == packed_size(), "a packed state has the wrong size");
  double* p = out.data();
  *p++ = double(tick);  // exact below 2^53
  for (const Motion& m : motions) {
    for (int k = 0; k < 3; ++k) *p++ = m.position[k];
    for (int k = 0; k < 4; ++k) *p++ = m.attitude.coeffs()[k];
    for (int k = 0; k < 3; ++k) *p++ = m.velocity[k];
    for (int k = 0; k < 3; ++k) *p++ = m.omega[k];
  }
  for (double angle : joint_angles) *p++ = angle;
  for (char flag : independent) *p++ = flag;
  for (char flag : active) *p++ = flag;
  for (double value : memory) *p++ = value;
  for (double value : work) *p++ = value;
}

void BodiesState::unpack(std::span<const double> in) {
  SPINDRIFT_ASSERT(in.size() == packed_size(), "a packed state has the wrong size");
  const double* p = in.data();
  tick = std::int64_t(*p++);
  for (Motion& m : motions) {
    for (int k = 0; k < 3; ++k) m.position[k] = *p++;
    for (int k = 0; k < 4; ++k) m.attitude.coeffs()[k] = *p++;
    for (int k = 0; k < 3; ++k) m.velocity[k] = *p++;
    for (int k = 0; k < 3; ++k) m.omega[k] = *p++;
  }
  for (double& angle : joint_angles) angle = *p++;
  for (char& flag : independent) flag = char(*p++);
  for (char& flag : active) flag = char(*p++);
  for (double& value : memory) value = *p++;
  for (double& value : work) value = *p++;
}

}  // namespace spindrift::bodies
