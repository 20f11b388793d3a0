// Members of a HydroDyn file: cylinders of the floater with drag and added mass of their own, and the ballast within them.
// Called by openfast_water.cpp; tested in tests/src/import. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "src/import/deck.hpp"
#include "src/import/elastodyn.hpp"

namespace spindrift::decks {

struct MemberEnd {
  Eigen::Vector3d at;                               ///< [m]
  double diameter, thickness;                       ///< [m]
  double drag, added_mass;                          ///< across, as in a scene [-]
  double axial_drag = 0.0, axial_added_mass = 0.0;  ///< of the disc, as in a scene [-]
};
struct Member {
  std::string name;
  MemberEnd start, end;
  double strip_length;     ///< [m]
  bool potential = true;   ///< its inertia and buoyancy are those of the potential flow
  bool diffracts = false;  ///< MacCamy and Fuchs (MCF)
};

/// Members down to the bed at -depth. An end's drag in HydroDyn is half of a scene's for the same coefficient (a quarter of
/// density times area, since both ends of a member count), so AxCd is halved.
std::vector<Member> read_members(const Deck& hydrodyn, double depth, bool potential, std::vector<std::string>& left_out);

/// Water or ballast in the filled members, up to its level along their axes, as rigid masses.
MassSum read_ballast(const Deck& hydrodyn, const std::vector<Member>& members, double water_density);

}  // namespace spindrift::decks
