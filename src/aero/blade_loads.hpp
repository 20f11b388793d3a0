// Blades of sections in the wind: what the air does to them by blade element momentum, how they bend, and what they do to the hub
// and at their roots. Equations: docs/theory/rotor_engineering.md; bending: docs/theory/structure.md, "Blades". Used by
// rotor_loads.cpp; tested in tests/src/aero/blade_roots_test.cpp, flexible_blades_test.cpp there. SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "src/aero/bem.hpp"
#include "src/aero/blade_roots.hpp"
#include "src/aero/flexible_blades.hpp"
#include "src/aero/options.hpp"
#include "src/aero/turbine.hpp"

namespace spindrift::aero {

/// The blades at a time.
struct BladesAt {
  const Wind& wind;
  double t;
  DiscMotion rotor;
  HubField hub;
  std::span<const double> memory;  ///< as BladeLoads has it; none: steady
};

class BladeLoads {
 public:
  /// Throws scene::SceneError where a file of the turbine cannot be read.
  BladeLoads(const AeroOptions& aero, const RotorOptions& rotor, double air_density_kg_m3)
      : BladeLoads(read_turbine(rotor.turbine), aero, rotor, air_density_kg_m3) {}

  const BladeElementMomentum& elements() const { return elements_; }
  /// Null where blades are rigid.
  const FlexibleBlades* flexible() const { return flexible_ ? &*flexible_ : nullptr; }
  /// With masses known along them: as many as there are blades; else none.
  std::size_t roots() const { return roots_ ? roots_->blades() : 0; }

  /// Forces of the air on the modes of all blades.
  using OnModes = std::array<double, std::size_t(FlexibleBlades::modes) * most_blades>;
  /// What the air does.
  struct Load {
    DiscLoad disc;
    std::vector<Wrench> roots;  ///< about each root
    FlexibleBlades::Bending bending;
    OnModes on_modes{};
  };
  /// Bent as the memory has it, or `at_rest` in the turning rotor whatever the memory.
  void fill(const BladesAt& at, bool at_rest, Load& load) const;
  /// What blades that bend do to the hub beyond rigid ones, [force; moment], but for what goes with the hub's acceleration.
  Eigen::Matrix<double, 6, 1> reaction(const BladesAt& at, const Load& load) const;
  /// Of roots(), with weight and inertia; the air's part times `ramp`.
  std::vector<BladeRootLoad> root_loads(const BladesAt& at, const Load& load, const HubMotion& hub,
                                        const Eigen::Vector3d& gravity_m_s2, double ramp) const;
  /// Of each blade, downwind and ahead [m]. @pre flexible()
  std::vector<Eigen::Vector2d> tips(const BladesAt& at) const;

  // What is remembered from step to step: the flow round the blades, then their bending.
  std::size_t memory_size() const;
  /// Settled; `speed`: of the rotor [rad/s].
  void begin(const BladesAt& at, double speed, std::span<double> memory) const;
  /// After h, at whose end the blades are `at`, of the same memory.
  void remember(const BladesAt& at, double h, std::span<double> memory) const;

 private:
  BladeLoads(const Turbine& turbine, const AeroOptions& aero, const RotorOptions& rotor, double air_density_kg_m3);
  template <class T>
  std::span<T> of_flow(std::span<T> memory) const {
    return memory.empty() ? memory : memory.first(elements_.memory_size());
  }
  template <class T>
  std::span<T> of_bending(std::span<T> memory) const {
    return memory.empty() ? memory : memory.subspan(elements_.memory_size());
  }
  std::span<double> used(OnModes& on_modes) const;
  FlexibleBlades::Bending settled(const BladesAt& at, std::span<const double> flow) const;

  BladeElementMomentum elements_;
  std::optional<BladeRoots> roots_;
  std::optional<FlexibleBlades> flexible_;
};

}  // namespace spindrift::aero
