// Water loads at engineering fidelity: see engineering_sea.hpp. The order of the terms follows docs/theory/sea_engineering.md.
// SPDX-License-Identifier: Apache-2.0
#include "src/sea/engineering_sea.hpp"

#include <algorithm>

#include "kernels/waves/morison.hpp"

namespace spindrift::sea {
namespace {

Coefficients coefficients_of(const std::string& cylinder, const SeaOptions& options) {
  const double end_drag = options.axial_drag_coefficient, end_mass = options.axial_added_mass_coefficient;
  Coefficients c{options.drag_coefficient, options.added_mass_coefficient, {end_drag, end_drag}, {end_mass, end_mass}, false};
  for (const CoefficientsOptions& own : options.coefficients) {
    if (own.cylinder != cylinder) continue;
    c.diffracts = own.diffraction == "maccamy_fuchs";
    c.drag = own.drag_coefficient.value_or(c.drag);
    c.added_mass = own.added_mass_coefficient.value_or(c.added_mass);
    c.axial_drag[0] = own.axial_drag_coefficient.value_or(c.axial_drag[0]);
    c.axial_drag[1] = own.end_axial_drag_coefficient.value_or(c.axial_drag[0]);
    c.axial_added_mass[0] = own.axial_added_mass_coefficient.value_or(c.axial_added_mass[0]);
    c.axial_added_mass[1] = own.end_axial_added_mass_coefficient.value_or(c.axial_added_mass[0]);
  }
  return c;
}

/// Ends of a body's cylinders, start and end of each in turn.
std::vector<EndDisc> discs_of(const SeaBody& body, const std::vector<Coefficients>& coefficients) {
  std::vector<EndDisc> discs;
  for (std::size_t i = 0; i < body.cylinders.size(); ++i) {
    const Cylinder& c = body.cylinders[i].shape;
    const Coefficients& k = coefficients[i];
    discs.push_back({c.start, -c.axis(), c.start_radius, k.axial_drag[0], k.axial_added_mass[0]});
    discs.push_back({c.end, c.axis(), c.end_radius, k.axial_drag[1], k.axial_added_mass[1]});
  }
  return discs;
}

/// Earth-frame state of the body that every strip needs.
struct Frame {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d position, velocity, omega;
  explicit Frame(const Motion& m)
      : rotation(m.attitude.toRotationMatrix()), position(m.position), velocity(m.velocity), omega(rotation * m.omega) {}
  Eigen::Vector3d velocity_at(const Eigen::Vector3d& arm) const { return velocity + omega.cross(arm); }
  /// Acceleration of a body point apart from the terms in the unknown accelerations.
  Eigen::Vector3d centripetal_at(const Eigen::Vector3d& arm) const { return omega.cross(omega.cross(arm)); }
};

void add_at(Wrench& w, const Eigen::Vector3d& force, const Eigen::Vector3d& arm) {
  w.force += force;
  w.moment += arm.cross(force);
}

/// The water at a point, current included; still water costs nothing.
struct Water {
  const WaveField& waves;
  const SteadyCurrent& current;
  const Frame& body;
  const waves::WaterPlane& surface;  ///< about the centre of mass
  double t;
  waves::Kinematics at(const Eigen::Vector3d& arm) const {
    const Eigen::Vector3d point = body.position + arm;
    if (waves.still()) return {current.at(point.z()), Eigen::Vector3d::Zero(), 0.0};
    waves::Kinematics k = waves.kinematics(t, point, level(point, arm));
    k.velocity += current.at(point.z());
    return k;
  }
  /// Acceleration times the inertia coefficients of MacCamy and Fuchs.
  Eigen::Vector3d scattered(const Eigen::Vector3d& arm, std::span<const waves::ComponentGroup> groups) const {
    const Eigen::Vector3d point = body.position + arm;
    return waves.kinematics(t, point, level(point, arm), groups).acceleration;
  }

 private:
  double level(const Eigen::Vector3d& point, const Eigen::Vector3d& arm) const {
    return point.z() - surface.height(arm) / surface.normal.z();
  }
};

Matrix6 matrix_of(const std::vector<std::array<double, 6>>& rows) {
  Matrix6 m = Matrix6::Zero();
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t j = 0; j < 6; ++j) m(Eigen::Index(i), Eigen::Index(j)) = rows[i][j];
  return m;
}

void add_end_drag(const ExposedEnd& end, const WettedEnd& wet, double density, const Frame& body, const waves::Kinematics& k,
                  SeaLoads& loads) {
  add_at(loads.drag,
         waves::drag_end(density, end.drag, end.area * wet.share, k.velocity - body.velocity_at(wet.arm),
                         body.rotation * end.area_normal),
         wet.arm);
}

/// Drag alone: the inertia of a body in potential flow is not that of its strips.
void add_drag(const Strip& strip, const WettedStrip& wet, double density, const Frame& body, const Water& water,
              SeaLoads& loads) {
  const Coefficients& c = strip.coefficients;
  for (const Station& s : std::span(wet.stations).first(wet.count)) {
    if (s.volume <= 0.0) continue;
    const Eigen::Vector3d relative = water.at(s.arm).velocity - body.velocity_at(s.arm);
    add_at(loads.drag, waves::drag_across(density, c.drag, 2.0 * s.volume / (pi * s.radius), relative, wet.axis), s.arm);
  }
  for (std::size_t i = 0; i < strip.ends.size(); ++i)
    if (const WettedEnd& e = wet.ends[i]; e.share > 0.0) add_end_drag(strip.ends[i], e, density, body, water.at(e.arm), loads);
}

void add_morison(const Strip& strip, const WettedStrip& wet, double density, const Frame& body, const Water& water,
                 std::span<const waves::ComponentGroup> scattered, SeaLoads& loads, Matrix6* mass) {
  const Coefficients& c = strip.coefficients;
  Eigen::Vector3d first_acceleration, first_arm, change = Eigen::Vector3d::Zero();  // of the water, a metre along the axis
  double second_moment = 0.0;                                                       // of the sections, summed along the axis
  const Eigen::Matrix3d along = wet.axis * wet.axis.transpose(), across = Eigen::Matrix3d::Identity() - along;
  for (const Station& s : std::span(wet.stations).first(wet.count)) {
    if (s.volume <= 0.0) continue;
    const waves::Kinematics k = water.at(s.arm);
    if (second_moment == 0.0) first_acceleration = k.acceleration, first_arm = s.arm;
    if (const double way = (s.arm - first_arm).dot(wet.axis); way > 0.0) change = (k.acceleration - first_acceleration) / way;
    second_moment += 0.25 * s.volume * s.radius * s.radius;
    const double projected = 2.0 * s.volume / (pi * s.radius), added = c.added_mass * density * s.volume;
    add_at(loads.drag, waves::drag_across(density, c.drag, projected, k.velocity - body.velocity_at(s.arm), wet.axis), s.arm);
    const Eigen::Vector3d wave =
        scattered.empty() ? k.acceleration : along * k.acceleration + across * water.scattered(s.arm, scattered);
    add_at(loads.inertia, density * s.volume * wave, s.water);
    // Waves that scatter have the inertia across in them.
    const Eigen::Vector3d relative = (scattered.empty() ? k.acceleration : Eigen::Vector3d::Zero()) - body.centripetal_at(s.arm);
    add_at(loads.inertia, added * waves::across(relative, wet.axis), s.arm);
    if (mass) waves::add_point_inertia(added * across, s.arm, *mass);
  }
  loads.inertia.moment -= density * second_moment * wet.axis.cross(change);
  for (std::size_t i = 0; i < strip.ends.size(); ++i) {
    const WettedEnd& e = wet.ends[i];
    const ExposedEnd& end = strip.ends[i];
    if (e.share <= 0.0) continue;
    const waves::Kinematics k = water.at(e.arm);
    add_end_drag(end, e, density, body, k, loads);
    const Eigen::Vector3d normal = body.rotation * end.cube_normal;
    const Eigen::Matrix3d added =
        waves::added_mass_end(density, end.added_mass, end.cube) * e.share * normal * normal.transpose();
    add_at(loads.inertia, added * (k.acceleration - body.centripetal_at(e.arm)), e.arm);
    if (mass) waves::add_point_inertia(added, e.arm, *mass);
  }
}

}  // namespace

EngineeringSea::EngineeringSea(const SeaOptions& options, const WavesOptions& waves, const SeaEnvironment& environment,
                               const std::vector<SeaBody>& bodies, double step_s)
    : environment_(environment),
      current_{options.current_m_s, options.current_profile},
      strips_load_(options.model == "morison" || options.model == "potential") {
  if (strips_load_) waves_ = WaveField(waves, environment);
  for (const SeaBody& body : bodies) {
    BodyStrips own = options.model == "none" ? BodyStrips{} : strips_of(body, options);
    scatter(own.strips);
    if (options.potential && options.potential->body == body.name)
      own.potential.emplace(*options.potential, environment, body.initial, waves_.components(), step_s);
    for (const MatricesOptions& m : options.matrices)
      if (m.body == body.name)
        own.matrices.push_back({body.initial, body.initial.attitude.conjugate() * (m.point_m - body.initial.position),
                                matrix_of(m.stiffness), matrix_of(m.damping), matrix_of(m.quadratic_damping)});
    for (const DampingOptions& damping : options.damping) {
      if (damping.body != body.name) continue;
      const Eigen::Vector3d point = damping.point_m.value_or(body.initial.position);
      own.damping.push_back(
          {body.initial.attitude.conjugate() * (point - body.initial.position), damping.force_N_s_m, damping.moment_N_m_s});
    }
    bodies_.push_back(std::move(own));
  }
}

EngineeringSea::BodyStrips EngineeringSea::strips_of(const SeaBody& body, const SeaOptions& options) const {
  BodyStrips own;
  std::vector<Coefficients> coefficients;
  for (const NamedCylinder& c : body.cylinders) coefficients.push_back(coefficients_of(c.name, options));
  const std::vector<EndDisc> discs = discs_of(body, coefficients);
  std::vector<ExposedEnd> ends(discs.size());
  const auto length = [&](std::size_t disc) { return body.cylinders[disc / 2].shape.length(); };
  for (std::size_t n = 0; n < discs.size(); ++n) {
    std::vector<EndDisc> sharing;
    bool counts = true;  // the widest of those that share a point, and of these the first
    for (std::size_t m = 0; m < discs.size(); ++m) {
      if ((discs[m].centre - discs[n].centre).norm() > 1e-6 * std::max(length(m), length(n))) continue;
      sharing.push_back(discs[m]);
      counts = counts && (m < n ? discs[m].radius < discs[n].radius : discs[m].radius <= discs[n].radius);
    }
    if (!counts) continue;
    const double over_bed = body.initial.point(discs[n].centre).z() + environment_.water_depth;
    if (over_bed > 1e-6 * std::max(1.0, environment_.water_depth)) {
      ends[n] = exposed_end(sharing);
      continue;
    }
    Foot foot{discs[n].centre, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
    for (const EndDisc& d : sharing) {
      const double area = pi * d.radius * d.radius;
      foot.area += area * d.normal, foot.second_moment += 0.25 * area * d.radius * d.radius * d.normal;
    }
    own.feet.push_back(foot);
  }
  for (std::size_t i = 0; i < body.cylinders.size(); ++i) {
    const Cylinder& shape = body.cylinders[i].shape;
    // The hydrostatic model needs the exact volume only: one strip.
    const double longest = options.model != "hydrostatic" ? options.strip_length_m : shape.length();
    append_strips(shape, coefficients[i], {ends[2 * i], ends[2 * i + 1]}, longest, own.strips);
  }
  return own;
}

Eigen::Vector3d SteadyCurrent::at(double z) const {
  if (profile.empty()) return uniform;
  const auto above = std::ranges::find_if(profile, [&](const auto& row) { return row[0] >= z; });
  const auto velocity = [](const std::array<double, 3>& row) { return Eigen::Vector3d(row[1], row[2], 0.0); };
  if (above == profile.begin()) return uniform + velocity(profile.front());
  if (above == profile.end()) return uniform + velocity(profile.back());
  const auto& low = *(above - 1);
  const double share = (z - low[0]) / ((*above)[0] - low[0]);
  return uniform + (1.0 - share) * velocity(low) + share * velocity(*above);
}

void EngineeringSea::scatter(std::vector<Strip>& strips) {
  if (waves_.still()) return;
  for (Strip& strip : strips) {
    if (!strip.coefficients.diffracts) continue;
    const double radius = 0.5 * (strip.shape.start_radius + strip.shape.end_radius);
    const auto known = std::ranges::find(scattering_radii_, radius);
    strip.scattered = int(known - scattering_radii_.begin());
    if (known == scattering_radii_.end()) scattering_radii_.push_back(radius), scattered_.push_back(waves_.scattered(radius));
  }
}

void EngineeringSea::unload_feet(double t, const BodyStrips& own, const Motion& motion, bool waves, SeaLoads& loads) const {
  const double weight = environment_.water_density * environment_.gravity;
  for (const Foot& foot : own.feet) {
    const Eigen::Vector3d arm = motion.attitude * foot.arm, area = motion.attitude * foot.area, at = motion.position + arm;
    add_at(loads.buoyancy, weight * std::max(0.0, -at.z()) * area, arm);
    loads.buoyancy.moment -= weight * Eigen::Vector3d::UnitZ().cross(motion.attitude * foot.second_moment);
    if (!waves || waves_.still()) continue;
    const waves::Kinematics k = waves_.kinematics(t, at, elevation(at.x(), at.y(), t));
    add_at(loads.inertia, environment_.water_density * k.pressure_over_density * area, arm);
    loads.inertia.moment -= environment_.water_density * k.acceleration.cross(motion.attitude * foot.second_moment);
  }
}

SeaLoads EngineeringSea::body_loads(double t, const BodyStrips& own, const Motion& motion, Matrix6* mass) const {
  SeaLoads loads;
  for (Wrench* w : {&loads.buoyancy, &loads.inertia, &loads.drag, &loads.damping, &loads.potential}) w->point = motion.position;
  const Frame body(motion);
  waves::Wetted wet;
  const waves::WaterPlane still{Eigen::Vector3d::UnitZ(), -motion.position.z()};
  const auto carry = [&wet](const waves::Wetted& part) { wet.volume += part.volume, wet.first_moment += part.first_moment; };
  for (const Strip& strip : own.strips) {
    const Eigen::Vector3d start = body.rotation * strip.shape.start, end = body.rotation * strip.shape.end;
    waves::WaterPlane surface = still;
    if (!waves_.still()) {
      const Eigen::Vector3d middle = 0.5 * (start + end);
      const waves::Surface s = waves_.surface(t, motion.position.x() + middle.x(), motion.position.y() + middle.y());
      surface = waves::tangent_plane(middle.x(), middle.y(), s.elevation - motion.position.z(), s.slope_x, s.slope_y);
    }
    if (!strips_load_) {
      carry(wetted_part(strip.shape, start, end, surface));
      continue;
    }
    const WettedStrip part = wetted_strip(strip, start, end, surface);
    // What the wave adds to buoyancy is in the exciting force of potential flow.
    if (!own.potential)
      carry(part.wetted);
    else if (!own.potential->linear_hydrostatics())
      carry(wetted_part(strip.shape, start, end, still));
    if (part.wetted.volume <= 0.0) continue;
    const Water water{waves_, current_, body, surface, t};
    if (own.potential)
      add_drag(strip, part, environment_.water_density, body, water, loads);
    else
      add_morison(strip, part, environment_.water_density, body, water,
                  strip.scattered < 0 ? std::span<const waves::ComponentGroup>() : scattered_[std::size_t(strip.scattered)],
                  loads, mass);
  }
  if (own.potential) {
    loads.potential = own.potential->load(t, waves_.still() ? 0.0 : waves_.ramp(t), motion);
    if (mass) own.potential->add_added_mass(motion, *mass);
  }
  const double weight = environment_.water_density * environment_.gravity;
  loads.buoyancy.force.z() = weight * wet.volume;
  loads.buoyancy.moment = weight * wet.first_moment.cross(Eigen::Vector3d::UnitZ());
  if (!(own.potential && own.potential->linear_hydrostatics()))
    unload_feet(t, own, motion, strips_load_ && !own.potential, loads);
  for (const Damping& d : own.damping) {
    const Eigen::Vector3d velocity = body.rotation.transpose() * body.velocity_at(body.rotation * d.arm);
    add_at(loads.damping, body.rotation * -d.force.cwiseProduct(velocity), body.rotation * d.arm);
    loads.damping.moment -= body.rotation * d.moment.cwiseProduct(motion.omega);
  }
  for (const Matrices& m : own.matrices) {
    const PoseOfPoint pose = pose_of(motion, m.initial, m.point);
    const Vector6 force = -m.stiffness * pose.displacement - m.damping * pose.velocity -
                          m.quadratic_damping * pose.velocity.cwiseAbs().cwiseProduct(pose.velocity);
    loads.damping.add_force(force.head<3>(), pose.point);
    loads.damping.add_moment(force.tail<3>());
  }
  return loads;
}

waves::Kinematics EngineeringSea::water(double t, const Eigen::Vector3d& point) const {
  if (waves_.still()) return {current_.at(point.z()), Eigen::Vector3d::Zero(), 0.0};
  waves::Kinematics k = waves_.kinematics(t, point, elevation(point.x(), point.y(), t));
  k.velocity += current_.at(point.z());
  return k;
}

void EngineeringSea::add_loads(double t, std::span<const Motion> bodies, std::span<Wrench> wrenches) const {
  add(t, bodies, wrenches, {});
}

void EngineeringSea::add_added_mass(double t, std::span<const Motion> bodies, std::span<Matrix6> masses) const {
  if (strips_load_) add(t, bodies, {}, masses);
}

void EngineeringSea::add(double t, std::span<const Motion> bodies, std::span<Wrench> wrenches, std::span<Matrix6> masses) const {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!bodies_[i].loaded()) continue;
    const SeaLoads loads = body_loads(t, bodies_[i], bodies[i], masses.empty() ? nullptr : &masses[i]);
    if (wrenches.empty()) continue;
    for (const Wrench* w : {&loads.buoyancy, &loads.inertia, &loads.drag, &loads.damping, &loads.potential}) wrenches[i] += *w;
  }
}

const PotentialBody* EngineeringSea::potential() const {
  for (const BodyStrips& body : bodies_)
    if (body.potential) return &*body.potential;
  return nullptr;
}

std::size_t EngineeringSea::memory_size() const {
  std::size_t size = 0;
  for (const BodyStrips& body : bodies_)
    if (body.potential) size += body.potential->memory_size();
  return size;
}

void EngineeringSea::begin(double t, std::span<const Motion> bodies, std::span<double> memory) const {
  for (std::size_t i = 0; i < bodies_.size(); ++i)  // one body at most
    if (bodies_[i].potential) bodies_[i].potential->begin(t, bodies[i], memory);
}

void EngineeringSea::recall(std::span<const double> memory) {
  for (BodyStrips& body : bodies_)
    if (body.potential && body.potential->memory_size() > 0) body.potential->recall(memory);
}

void EngineeringSea::remember(double t, std::span<const Motion> bodies, std::span<double> memory) const {
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    if (bodies_[i].potential) bodies_[i].potential->remember(t, bodies[i], memory);
}

void EngineeringSea::loads_by_part(double t, std::span<const Motion> bodies, std::span<SeaLoads> loads) const {
  for (std::size_t i = 0; i < bodies_.size(); ++i) loads[i] = body_loads(t, bodies_[i], bodies[i], nullptr);
}

}  // namespace spindrift::sea
