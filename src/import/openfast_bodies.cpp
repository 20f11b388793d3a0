// Bodies, tower and foundation of a scene from ElastoDyn.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <fstream>

#include "kernels/base/constants.hpp"
#include "src/import/openfast_sections.hpp"

namespace spindrift::decks {

namespace {

/// Mass, inertia and centre of a body, as a scene has them.
std::string mass_keys(const MassSum& sum) {
  Eigen::Matrix3d inertia = sum.inertia();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (std::abs(inertia(i, j)) < 1e-9 * inertia.trace()) inertia(i, j) = 0.0;
  std::string keys = fmt::format("mass_kg = {:.10g}\ninertia_kg_m2 = [\n", sum.mass());
  for (int i = 0; i < 3; ++i)
    keys += fmt::format("  [{:.10g}, {:.10g}, {:.10g}],\n", inertia(i, 0), inertia(i, 1), inertia(i, 2));
  return keys + "]\ncentre_m = " + toml_vector(sum.centre()) + "\n";
}

/// The platform away from its place at rest, about `reference`.
struct Displaced {
  Eigen::Vector3d reference, moved, turned;  ///< [m], [m], [deg]
};

/// Nacelle, hub and blades on the tower's top.
std::string flexible_tower(DeckImport& run, const Deck& elastodyn, const RotorFrame& rotor, const ImportedSystem& system,
                           const Displaced& platform) {
  const MassSum top = top_masses(elastodyn, rotor, system.controlled);
  const ImportedBeam beam = tower_beam(elastodyn, top.mass(), run.left_out);
  std::string text = "\n[bodies.nacelle]                        # nacelle, hub and blades\n" + mass_keys(top);
  const auto& [reference, moved, turned] = platform;
  if (system.floats && (moved.norm() > 0.0 || turned.norm() > 0.0)) {
    const Eigen::Vector3d angle = radians_per_degree * turned, arm = top.centre() - reference;
    const Eigen::Matrix3d turn =
        (Eigen::AngleAxisd(angle.z(), Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(angle.y(), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(angle.x(), Eigen::Vector3d::UnitX()))
            .toRotationMatrix();
    text += "displacement_m = " + toml_vector(moved + turn * arm - arm) + "\nrotation_deg = " + toml_vector(turned) + "\n";
  }
  std::ofstream(run.folder / "tower.csv") << beam.properties;
  text += "\n[beams.tower]\nbodies = [\"" + std::string(system.has_platform() ? "platform" : "earth") +
          "\", \"nacelle\"]\nstart_m = " + toml_vector({0.0, 0.0, beam.base}) + "\nend_m = " + toml_vector({0.0, 0.0, beam.top}) +
          "\nproperties = \"tower.csv\"\n" + fmt::format("damping = [{:.9g}, {:.9g}]\n", beam.damping[0], beam.damping[1]);
  run.carry(
      fmt::format("tower: flexible, {:.6g} m, two modes fore-aft and two side-side of its mass and stiffness, damping {:.3g} and "
                  "{:.3g} % of critical with what it carries",
                  beam.top - beam.base, 100.0 * beam.damping[0], 100.0 * beam.damping[1]));
  run.leave_out("the file's shapes of the tower's modes: they are computed; its extension and twist are those of a steel tube");
  return text;
}

}  // namespace

std::string import_bodies(DeckImport& run, const Deck& ed, const RotorFrame& rotor, const ImportedSystem& system,
                          const ImportedWater& water) {
  if (!system.has_platform()) {
    const Eigen::Vector3d none = Eigen::Vector3d::Zero();
    const std::string text = flexible_tower(run, ed, rotor, system, {none, none, none});
    run.carry(fmt::format("nacelle, hub and blades: {:.6g} kg", top_masses(ed, rotor, system.controlled).mass()));
    return text;
  }
  int free = 0;
  for (const char* freedom : {"PtfmSgDOF", "PtfmSwDOF", "PtfmHvDOF", "PtfmRDOF", "PtfmPDOF", "PtfmYDOF"})
    free += ed.flag({freedom}, false);
  const bool held = !system.floats || free == 0;
  MassSum sum = system.tower_bends ? platform_masses(ed) : all_masses(ed, rotor, system.controlled);
  if (water.ballast.mass() > 0.0) {
    sum.add(water.ballast);
    run.carry(fmt::format("ballast: {:.6g} kg in filled members", water.ballast.mass()));
  }
  if (held && sum.mass() == 0.0)  // as of a foundation of SubDyn: nothing that the scene needs
    sum.add(1.0, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity());
  for (const char* product : {"PtfmXYIner", "PtfmYZIner", "PtfmXZIner"})
    if (ed.number({product}, 0.0) != 0.0) run.leave_out(fmt::format("the platform's product of inertia {}", product));
  std::string text =
      (system.tower_bends
           ? "\n[bodies.platform]\n"
           : "\n[bodies.platform]                       # platform, tower, nacelle, hub and blades as one rigid body\n") +
      mass_keys(sum);
  const Eigen::Vector3d reference(ed.number({"PtfmRefxt"}, 0.0), ed.number({"PtfmRefyt"}, 0.0), ed.number({"PtfmRefzt"}, 0.0));
  text += "reference_m = " + toml_vector(reference) + "\n";
  const Eigen::Vector3d moved(ed.number({"PtfmSurge"}, 0.0), ed.number({"PtfmSway"}, 0.0), ed.number({"PtfmHeave"}, 0.0));
  const Eigen::Vector3d turned(ed.number({"PtfmRoll"}, 0.0), ed.number({"PtfmPitch"}, 0.0), ed.number({"PtfmYaw"}, 0.0));
  if (system.floats && moved.norm() > 0.0) text += "displacement_m = " + toml_vector(moved) + "\n";
  if (system.floats && turned.norm() > 0.0) text += "rotation_deg = " + toml_vector(turned) + "\n";
  text += water.platform;
  if (system.tower_bends) text += flexible_tower(run, ed, rotor, system, {reference, moved, turned});
  run.carry(fmt::format("body: {:.6g} kg, centre {}", sum.mass(), toml_vector(sum.centre())));
  if (system.floats && free > 0 && free < 6)
    run.leave_out(fmt::format("{} of the platform's six motions are held in the deck; here all are free", 6 - free));
  if (held) text += "\n[joints.foundation]\ntype = \"fixed\"\nbodies = [\"earth\", \"platform\"]\npoint_m = [0.0, 0.0, 0.0]\n";
  return text;
}

}  // namespace spindrift::decks
