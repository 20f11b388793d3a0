// Blade element momentum: the loads of a rotor given as section tables, element by element and blade by blade, with the motion of
// its body in every element's wind; the wake and the separation on the blades may lag behind. Equations:
// docs/theory/rotor_engineering.md; one element: kernels/rotor/blade_element.hpp.
// Used by blade_loads.cpp and actuator.cpp; tested in tests/src/aero/bem_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "kernels/base/constants.hpp"
#include "kernels/beam/blade.hpp"
#include "kernels/rigid/wrench.hpp"
#include "kernels/rotor/blade_element.hpp"
#include "kernels/rotor/dynamic_inflow_oye.hpp"
#include "kernels/rotor/dynamic_stall_beddoes_leishman.hpp"
#include "kernels/rotor/free_vortex_wake.hpp"
#include "src/aero/section_polars.hpp"
#include "src/aero/tower.hpp"
#include "src/aero/turbine.hpp"
#include "src/aero/wind.hpp"

namespace spindrift::aero {

/// Directions of the bent blade: along its coned axis outward, and those of its modes, which turn with its pitch; unit vectors,
/// earth frame.
struct BladeAxes {
  Eigen::Vector3d along, x, y;  ///< at a pitch of zero x is downwind and y ahead
};

/// Blades that are bent by their modes.
struct BentBlades {
  /// What modes of amplitude 1 do at the middle of an element.
  struct Section {
    beam::BladeModes::Shape value, slope;
    beam::BladeModes::Square shortening;  ///< as in beam::BladePoint
  };
  double precone = 0.0;                       ///< [rad]
  std::span<const Section> sections;          ///< of the elements of a blade
  std::span<const double> amplitudes, rates;  ///< of the modes of blade 1, of blade 2 and so on

  using Modal = Eigen::Map<const Eigen::Vector3d>;
  Modal amplitude(int blade) const { return Modal(amplitudes.data() + beam::BladeModes::count * blade); }
  Modal rate(int blade) const { return Modal(rates.data() + beam::BladeModes::count * blade); }
};

/// Motion of the rotor; earth frame.
struct DiscMotion {
  Eigen::Vector3d hub_velocity;                   ///< [m/s]
  Eigen::Vector3d omega;                          ///< of the blades, spin included [rad/s]
  Eigen::Vector3d axis, up;                       ///< unit, normal to each other; blade 1 points along `up` at azimuth zero
  double azimuth, blade_pitch;                    ///< [rad]
  Eigen::Vector3d hub = Eigen::Vector3d::Zero();  ///< [m], where the wind goes with height
  std::span<const double> pitches = {};           ///< of each blade [rad]; none: all have blade_pitch
  const Tower* tower = nullptr;                   ///< whose flow the blades meet
  TowerFrame tower_frame = {};
  const BentBlades* bent = nullptr;  ///< rigid without
  double sense = 1.0;                ///< blades turn about the axis; -1: mirrored ones turn the other way

  double pitch(int blade) const { return pitches.empty() ? blade_pitch : pitches[std::size_t(blade)]; }
  /// Which way a blade along `out` goes.
  Eigen::Vector3d ahead(const Eigen::Vector3d& out) const { return sense * axis.cross(out); }
};

/// Direction of blade b of so many from the hub, normal to the axis.
inline Eigen::Vector3d blade_direction(const DiscMotion& rotor, int b, int blades) {
  const double azimuth = rotor.azimuth + 2.0 * pi * b / blades;
  return std::cos(azimuth) * rotor.up + std::sin(azimuth) * rotor.ahead(rotor.up);
}

/// Of a blade that points along `out`.
inline BladeAxes blade_axes(const DiscMotion& rotor, const Eigen::Vector3d& out, double precone, double pitch) {
  const double c = std::cos(precone), s = std::sin(precone);
  const Eigen::Vector3d downwind = c * rotor.axis + s * out, ahead = rotor.ahead(out);
  return {c * out - s * rotor.axis, std::cos(pitch) * downwind + std::sin(pitch) * ahead,
          std::cos(pitch) * ahead - std::sin(pitch) * downwind};
}

struct DiscLoad {
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();  ///< [N], [N m] about the hub, earth frame
  int unbalanced = 0;  ///< elements that found no induction: they act as free aerofoils
};

/// Unsteady effects of the flow round the blades.
struct UnsteadyFlow {
  bool inflow = false;                  ///< the wake, by Oye's filters
  std::optional<double> inflow_time{};  ///< tau_1 [s]; absent: by wind and induction
  enum class Stall { none, oye, beddoes_leishman };
  Stall stall = Stall::none;
  double stall_lag = 4.0;                         ///< for Oye [chords]
  double speed_of_sound = 340.0;                  ///< for Beddoes & Leishman [m/s]
  std::optional<FreeVortexWake::Options> wake{};  ///< of filaments, in place of the balance with momentum; not with `inflow`
};

/// Reynolds numbers of the chord at the elements whose polars depend on it.
struct ReynoldsReach {
  double least = 0.0, greatest = 0.0;              ///< that the elements have
  double table_least = 0.0, table_greatest = 0.0;  ///< of the tables of those that are outside of theirs
  int elements = 0, outside = 0;                   ///< of all blades
};

class BladeElementMomentum {
 public:
  /// `induction`: "madsen" or "buhl". `kinematic_viscosity` [m2/s]: for polars by Reynolds number. `skew_momentum`: whether the
  /// momentum balance has the wind that blows across the disc in it.
  BladeElementMomentum(const Turbine& turbine, const std::string& induction, double air_density_kg_m3,
                       const UnsteadyFlow& unsteady = {}, double kinematic_viscosity = air_kinematic_viscosity,
                       bool skew_momentum = true);

  /// `memory`: what the flow remembers; without it the flow is steady. `roots`, where given, one to a blade: the same loads blade
  /// by blade are added; their points are from the hub.
  DiscLoad operator()(const Wind& wind, const DiscMotion& rotor, double t = 0.0, std::span<const double> memory = {},
                      std::span<Wrench> roots = {}) const;
  DiscLoad operator()(const Eigen::Vector3d& wind, const DiscMotion& rotor) const { return (*this)(Wind{wind}, rotor); }
  /// The same on bent blades, with its force on their modes: `modal` gets as many numbers as `rotor.bent` has amplitudes [N].
  DiscLoad on_modes(const Wind& wind, const DiscMotion& rotor, double t, std::span<const double> memory, std::span<double> modal,
                    std::span<Wrench> roots = {}) const;

  // What the flow remembers of its past, element by element, in plain numbers that the caller keeps.
  std::size_t memory_size() const;
  /// Settled in this flow.
  void begin(const Wind& wind, const DiscMotion& rotor, double t, std::span<double> memory) const;
  /// After h, at whose end t the rotor moves so.
  void remember(const Wind& wind, const DiscMotion& rotor, double t, double h, std::span<double> memory) const;

  /// Empty where no polar depends on it.
  std::optional<ReynoldsReach> reynolds(const Wind& wind, const DiscMotion& rotor, double t) const;

  double tip_radius() const { return tip_radius_; }
  /// Sections as other models need them, which find the wind at the blades by themselves.
  struct BladeSection {
    double radius, axial;                ///< of its middle, from the hub [m]; axial downwind
    double normal_radial, normal_axial;  ///< its normal
    double length, chord, twist;         ///< [m], [m], [rad]
  };
  std::size_t elements() const { return elements_.size(); }
  const BladeSection& section(std::size_t element) const { return elements_[element]; }
  /// Of an element at this speed relative to the air [m/s]; holds as long as the rotor does.
  SectionPolars::InUse polars(std::size_t element, double speed) const { return in_use(elements_[element], speed, 0.0); }
  Annulus annulus(std::size_t element, double blade_pitch) const { return annulus(elements_[element], blade_pitch); }
  /// Of one element by itself; the two winds as in solve_element.
  ElementState solve(std::size_t element, double normal_wind, double tangential_wind, double blade_pitch) const;

 private:
  /// One of blade_pieces.
  struct Element : BladeSection {
    SectionPolars polars;
  };
  /// An element of one blade in the flow.
  struct Place {
    std::size_t index;  ///< among the elements of all blades
    const Element& element;
    Annulus ring;
    Eigen::Vector3d arm, normal, ahead;   ///< from the hub [m]; units
    double normal_wind, tangential_wind;  ///< undisturbed, as solve_element has them [m/s]
    double skew, across;                  ///< as `skewed` has them
    double cross_wind;                    ///< as solve_element has it [m/s]
    double turning;                       ///< share of the induction: none in a rotor that hardly turns
    SectionPolars::InUse polars;          ///< at the Reynolds number of those winds
  };
  /// Velocities that the wake induces along the normal and against the motion, before skew [m/s]; filaments have skew in them.
  struct Induced {
    double normal, tangential;
  };
  /// Of one element of one blade, in the memory.
  struct Past {
    DynamicInflowOye::Induced normal, tangential;  ///< [m/s]
    double separation, still_separation;           ///< f, and that of the polar
    DynamicStallBeddoesLeishman::State leishman;
  };
  /// Numbers for each element of each blade; the last part for Beddoes & Leishman only.
  static constexpr std::size_t short_past = 8, long_past = short_past + DynamicStallBeddoesLeishman::state_size;
  std::size_t past_size() const { return unsteady_.stall == UnsteadyFlow::Stall::beddoes_leishman ? long_past : short_past; }
  Past recalled(std::span<const double> memory, std::size_t index) const;
  void store(const Past& past, std::span<double> memory, std::size_t index) const;

  /// The element of a bent blade, from where it is on the rigid one.
  static void bend(const BentBlades& bent, const BladeAxes& axes, int blade, std::size_t element, Eigen::Vector3d& arm,
                   Eigen::Vector3d& normal, Eigen::Vector3d& velocity);
  /// Of these winds across the section [m/s].
  double reynolds(const Element& e, double normal_wind, double tangential_wind) const {
    return std::hypot(normal_wind, tangential_wind) * e.chord / kinematic_viscosity_;
  }
  SectionPolars::InUse in_use(const Element& e, double normal_wind, double tangential_wind) const {
    return e.polars.depend_on_reynolds() ? e.polars.at(reynolds(e, normal_wind, tangential_wind)) : e.polars.at_any();
  }
  template <class Visit>
  void for_each_place(const Wind& wind, const DiscMotion& rotor, double t, const Visit& visit) const;
  /// visit(place, force [N], whether the element found its induction).
  template <class Visit>
  void for_each_force(const Wind& wind, const DiscMotion& rotor, double t, std::span<const double> memory,
                      const Visit& visit) const;
  void add_root_load(const Place& at, const Eigen::Vector3d& force, std::span<Wrench> roots) const {
    if (!roots.empty()) roots[at.index / elements_.size()].add_force(force, at.arm);
  }
  /// In balance with the momentum of its annulus, the wind along the axis.
  ElementState balance(const Place& at) const;
  Induced steady(const Place& at) const;
  template <class Section>
  ElementState forces(const Place& at, const Induced& induced, const Section& section) const;
  /// The element's angle of attack and speed relative to the air [rad], [m/s].
  struct Flow {
    double attack, speed;
  };
  Flow flow(const Place& at, const Induced& induced) const;
  double prandtl_glauert(double speed) const;
  Annulus annulus(const Element& e, double blade_pitch) const;

  std::variant<InductionMadsen, InductionBuhl> induction_;
  UnsteadyFlow unsteady_;
  int blades_;
  bool skew_momentum_;
  double air_density_, kinematic_viscosity_, hub_radius_, tip_radius_;
  std::vector<Element> elements_;
  std::optional<FreeVortexWake> wake_;
};

}  // namespace spindrift::aero
