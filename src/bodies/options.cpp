// SPDX-License-Identifier: Apache-2.0
#include "src/bodies/options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "kernels/rigid/rotation.hpp"
#include "src/scene/columns.hpp"
#include "src/scene/document.hpp"

namespace spindrift::bodies {

namespace {

using scene::between;
using scene::not_negative;
using scene::positive;
using scene::Section;

const Section<CylinderOptions>& cylinder_section() {
  static const auto section =
      Section<CylinderOptions>("cylinders", "A circular cylinder, or a cone frustum, of the body's wetted shape.")
          .text("name", &CylinderOptions::name, "Name, for coefficients and messages.")
          .required()
          .vector("start_m", &CylinderOptions::start_m, "m", "Centre of one end, initial earth coordinates.")
          .required()
          .vector("end_m", &CylinderOptions::end_m, "m", "Centre of the other end, initial earth coordinates.")
          .required()
          .number("diameter_m", &CylinderOptions::diameter_m, "m", "Diameter, of a frustum at its start.", positive())
          .required()
          .number("end_diameter_m", &CylinderOptions::end_diameter_m, "m", "Diameter at the end, where it differs.",
                  not_negative())
          .check([](const CylinderOptions& o, const scene::Report& report) {
            if (o.start_m == o.end_m) report("end_m", "is where start_m is: the cylinder has no length");
          });
  return section;
}

const Section<BoxOptions>& box_section() {
  static const auto section =
      Section<BoxOptions>("boxes",
                          "A box of the body's wetted shape, for a sea of particles; edges along the earth's axes at the start.")
          .text("name", &BoxOptions::name, "Name, for messages.")
          .required()
          .vector("centre_m", &BoxOptions::centre_m, "m", "Its centre, initial earth coordinates.")
          .required()
          .vector("size_m", &BoxOptions::size_m, "m", "Its edges.", positive())
          .required();
  return section;
}

const Section<SphereOptions>& sphere_section() {
  static const auto section = Section<SphereOptions>("spheres", "A sphere of the body's wetted shape, for a sea of particles.")
                                  .text("name", &SphereOptions::name, "Name, for messages.")
                                  .required()
                                  .vector("centre_m", &SphereOptions::centre_m, "m", "Its centre, initial earth coordinates.")
                                  .required()
                                  .number("diameter_m", &SphereOptions::diameter_m, "m", "Its diameter.", positive())
                                  .required();
  return section;
}

const Section<scene::MeshOptions>& mesh_section() {
  static const auto section = scene::mesh_section("A surface of triangles as the body's wetted shape, for a sea of particles.");
  return section;
}

const Section<ForceOptions>& force_section() {
  static const auto section = Section<ForceOptions>("forces", "A constant force and moment on the body.")
                                  .vector("point_m", &ForceOptions::point_m, "m",
                                          "Where the force acts, initial earth coordinates; it moves with the body.")
                                  .required()
                                  .vector("force_N", &ForceOptions::force_N, "N", "Force.")
                                  .vector("moment_N_m", &ForceOptions::moment_N_m, "N m", "Moment.")
                                  .flag("follows_body", &ForceOptions::follows_body,
                                        "Force and moment turn with the body instead of keeping earth axes.");
  return section;
}

void check_inertia(const BodyOptions& o, const scene::Report& report) {
  const Eigen::Vector3d d = o.inertia_kg_m2.diagonal();
  const Eigen::Matrix3d& i = o.inertia_kg_m2;
  if (d.minCoeff() <= 0.0 || i(0, 0) * i(1, 1) - i(0, 1) * i(0, 1) <= 0.0 || i.determinant() <= 0.0)
    return report("inertia_kg_m2", "must be positive definite");
  constexpr double rounding = 1e-3;  // of published figures
  if (d.maxCoeff() > (d.sum() - d.maxCoeff()) * (1.0 + rounding))
    report("inertia_kg_m2",
           fmt::format("no mass can have it: the largest diagonal term, {}, exceeds the sum of the other two", d.maxCoeff()));
}

template <class Rate, class Amplitude>
Section<DriverOptions> driver(const char* name, const char* help, Rate rate, Amplitude amplitude, const char* table_help) {
  Section<DriverOptions> section(name, help);
  rate(section);
  amplitude(section);
  section.number("period_s", &DriverOptions::period_s, "s", "Period of the harmonic part.", positive())
      .degrees("phase_deg", &DriverOptions::phase, "Phase of the harmonic part, amplitude x sin(2 pi t / period + phase).")
      .path("table", &DriverOptions::table, table_help)
      .check([](const DriverOptions& o, const scene::Report& report) {
        if (o.amplitude != 0.0 && !o.period_s) report("period_s", "is needed by the amplitude");
        if (o.amplitude == 0.0 && o.period_s) report("period_s", "has no effect without an amplitude");
      });
  return section;
}

const Section<DriverOptions>& rotation_section() {
  using S = Section<DriverOptions>;
  static const S section = driver(
      "rotation", "Prescribed angle of the second body about the axis: the sum of what is given.",
      [](S& s) { s.rpm("speed_rpm", &DriverOptions::rate, "Constant rate."); },
      [](S& s) { s.degrees("amplitude_deg", &DriverOptions::amplitude, "Amplitude of the harmonic part."); },
      "CSV file with columns time_s, angle_deg, joined by a natural cubic spline.");
  return section;
}

const Section<DriverOptions>& translation_section() {
  using S = Section<DriverOptions>;
  static const S section = driver(
      "translation", "Prescribed distance of the second body along the axis: the sum of what is given.",
      [](S& s) { s.number("speed_m_s", &DriverOptions::rate, "m/s", "Constant rate."); },
      [](S& s) { s.number("amplitude_m", &DriverOptions::amplitude, "m", "Amplitude of the harmonic part."); },
      "CSV file with columns time_s, distance_m, joined by a natural cubic spline.");
  return section;
}

void check_law(const JointLawOptions& o, const scene::Report& report) {
  if (o.stiffness == 0.0 && o.damping == 0.0 && o.quadratic_damping == 0.0 && o.friction == 0.0 && o.table.empty())
    report("table", "is not given, nor stiffness, damping or friction: the law has no effect");
}

const Section<JointLawOptions>& rotation_law_section() {
  static const auto section =
      Section<JointLawOptions>("rotation_law",
                               "Moment on the second body about the axis, and its opposite on the first, by the angle "
                               "(within half a turn) and its rate: the sum of what is given.")
          .number("stiffness_N_m_rad", &JointLawOptions::stiffness, "N m/rad",
                  "Spring, against the angle from rest_deg, the shorter way round.", not_negative())
          .degrees("rest_deg", &JointLawOptions::rest, "Angle at which the spring has no moment.", between(-180.0, 180.0))
          .number("damping_N_m_s_rad", &JointLawOptions::damping, "N m s/rad", "Damper, against the rate.", not_negative())
          .number("quadratic_damping_N_m_s2_rad2", &JointLawOptions::quadratic_damping, "N m s2/rad2",
                  "Damper, against the rate times its magnitude.", not_negative())
          .number("friction_N_m", &JointLawOptions::friction, "N m",
                  "Coulomb's friction; below 0.001 rad/s it falls to nothing linearly.", not_negative())
          .path("table", &JointLawOptions::table,
                "CSV file with columns angle_deg, moment_N_m on the second body, joined by straight lines; beyond its rows their "
                "values hold.")
          .check(check_law);
  return section;
}

const Section<JointLawOptions>& translation_law_section() {
  static const auto section =
      Section<JointLawOptions>("translation_law",
                               "Force on the second body along the axis, and its opposite on the first, by the "
                               "distance and its rate: the sum of what is given.")
          .number("stiffness_N_m", &JointLawOptions::stiffness, "N/m", "Spring, against the distance from rest_m.",
                  not_negative())
          .number("rest_m", &JointLawOptions::rest, "m", "Distance at which the spring has no force.")
          .number("damping_N_s_m", &JointLawOptions::damping, "N s/m", "Damper, against the rate.", not_negative())
          .number("quadratic_damping_N_s2_m2", &JointLawOptions::quadratic_damping, "N s2/m2",
                  "Damper, against the rate times its magnitude.", not_negative())
          .number("friction_N", &JointLawOptions::friction, "N",
                  "Coulomb's friction; below 0.001 m/s it falls to nothing linearly.", not_negative())
          .path("table", &JointLawOptions::table,
                "CSV file with columns distance_m, force_N on the second body, joined by straight lines; beyond its rows their "
                "values hold.")
          .check(check_law);
  return section;
}

void check_joint(const JointOptions& o, const scene::Report& report) {
  if (o.bodies.size() == 2 && o.bodies[0] == o.bodies[1]) report("bodies", "a joint ties two different bodies");
  if (o.type != JointType::fixed && !o.point_m)
    report("point_m", fmt::format("is needed by a {} joint", joint_type_names[std::size_t(o.type)]));
  if (o.type != JointType::spherical && o.type != JointType::fixed && o.axis.norm() == 0.0)
    report("axis", fmt::format("is needed by a {} joint, and not zero", joint_type_names[std::size_t(o.type)]));
  if (o.type == JointType::universal && o.axis.cross(o.second_axis).norm() <= 1e-9 * o.axis.norm() * o.second_axis.norm())
    report("second_axis", "must not be zero or parallel to axis");
}

PrescribedMotion make_driver(const DriverOptions& o, const char* column, double unit) {
  PrescribedMotion motion{.rate = o.rate, .amplitude = o.amplitude, .phase = o.phase};
  if (o.period_s) motion.omega = 2.0 * pi / *o.period_s;
  if (o.table.empty()) return motion;
  const scene::Columns table = scene::read_columns(o.table);
  table.allow_only({"time_s", column});
  table.require_rows(2);
  table.require_increasing("time_s", "time");
  std::vector<double> values(table[column].begin(), table[column].end());
  for (double& v : values) v *= unit;
  motion.table = CubicTable(table["time_s"], values);
  return motion;
}

PrescribedMotion make_rotation(const DriverOptions& o) { return make_driver(o, "angle_deg", radians_per_degree); }
PrescribedMotion make_translation(const DriverOptions& o) { return make_driver(o, "distance_m", 1.0); }

JointLaw make_law(const JointLawOptions& o, bool turns) {
  JointLaw law{.turns = turns,
               .stiffness = o.stiffness,
               .rest = o.rest,
               .damping = o.damping,
               .quadratic_damping = o.quadratic_damping,
               .friction = o.friction};
  if (o.table.empty()) return law;
  const char *place = turns ? "angle_deg" : "distance_m", *load = turns ? "moment_N_m" : "force_N";
  const scene::Columns table = scene::read_columns(o.table);
  table.allow_only({place, load});
  table.require_rows(2);
  table.require_increasing(place, turns ? "angle" : "distance");
  law.places.assign(table[place].begin(), table[place].end()), law.loads.assign(table[load].begin(), table[load].end());
  if (turns)
    for (double& angle : law.places) angle *= radians_per_degree;
  return law;
}

JointLaw make_rotation_law(const JointLawOptions& o) { return make_law(o, true); }
JointLaw make_translation_law(const JointLawOptions& o) { return make_law(o, false); }

}  // namespace

int index_of(const NamedBodies& bodies, const std::string& name) {
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (bodies[b].name == name) return int(b);
  return earth;
}

const Section<BodyOptions>& body_section() {
  static const auto section =
      Section<BodyOptions>("bodies", "A rigid body: mass, where it is, its shape and how it starts.")
          .named()
          .number("mass_kg", &BodyOptions::mass_kg, "kg", "Mass.", positive())
          .required()
          .symmetric(
              "inertia_kg_m2", &BodyOptions::inertia_kg_m2, "kg m2",
              "Inertia about the centre of mass, axes parallel to the earth's at the start: [Ixx, Iyy, Izz] or three rows.")
          .required()
          .vector("centre_m", &BodyOptions::centre_m, "m", "Centre of mass, initial earth coordinates.")
          .required()
          .vector("reference_m", &BodyOptions::reference_m, "m",
                  "Point of the body whose motion is written, initial earth coordinates; the centre of mass where absent.")
          .flag("gyroscopic", &BodyOptions::gyroscopic, "Gyroscopic moments of the body; without them its spin loads nothing.")
          .vector("displacement_m", &BodyOptions::displacement_m, "m",
                  "The body starts away from where the scene describes it by this much, as for a decay test.")
          .degrees("rotation_deg", &BodyOptions::rotation,
                   "The body starts turned by roll, pitch, yaw about its reference point (yaw first, then pitch, then roll).")
          .vector("velocity_m_s", &BodyOptions::velocity_m_s, "m/s", "Velocity of the centre of mass at the start.")
          .vector("omega_rad_s", &BodyOptions::omega_rad_s, "rad/s", "Angular velocity at the start, earth axes.")
          .tables("cylinders", &BodyOptions::cylinders, cylinder_section(), "Shape that meets the water.")
          .tables("boxes", &BodyOptions::boxes, box_section(), "Shape that meets a sea of particles.")
          .tables("spheres", &BodyOptions::spheres, sphere_section(), "Shape that meets a sea of particles.")
          .tables("meshes", &BodyOptions::meshes, mesh_section(),
                  "Shape that meets a sea of particles: a closed surface of triangles from an STL file.")
          .tables("forces", &BodyOptions::forces, force_section(), "Constant forces and moments.")
          .check(check_inertia);
  return section;
}

const Section<JointOptions>& joint_section() {
  static const auto section =
      Section<JointOptions>("joints", "An ideal joint between two bodies, or a body and the earth, with its drivers.")
          .named()
          .choice(
              "type", &JointOptions::type,
              {{"fixed", JointType::fixed, "no relative motion"},
               {"revolute", JointType::revolute, "turns about the axis"},
               {"spherical", JointType::spherical, "turns about the point"},
               {"universal", JointType::universal, "turns about the axis of the first body and the second axis of the second"},
               {"translational", JointType::translational, "slides along the axis"},
               {"cylindrical", JointType::cylindrical, "slides along the axis and turns about it"},
               {"planar", JointType::planar, "slides across the axis and turns about it"}},
              "Kind of the joint.")
          .texts("bodies", &JointOptions::bodies, "First and second body; \"earth\" is the fixed frame.")
          .required()
          .size(2, 2)
          .vector("point_m", &JointOptions::point_m, "m",
                  "Point of the joint, initial earth coordinates; without it the centre of mass of a fixed joint's second body.")
          .vector("axis", &JointOptions::axis, "-", "Direction of the axis; its length does not matter.",
                  scene::between(-1e6, 1e6))
          .only_if("type", {"revolute", "universal", "translational", "cylindrical", "planar"})
          .required()
          .vector("second_axis", &JointOptions::second_axis, "-", "Axis of the cross on the second body.",
                  scene::between(-1e6, 1e6))
          .only_if("type", {"universal"})
          .required()
          .table("rotation", &JointOptions::rotation, rotation_section(), "Driver in rotation.")
          .only_if("type", {"revolute", "cylindrical"})
          .table("translation", &JointOptions::translation, translation_section(), "Driver in translation.")
          .only_if("type", {"translational", "cylindrical"})
          .table("rotation_law", &JointOptions::rotation_law, rotation_law_section(), "Spring and damper in rotation.")
          .only_if("type", {"revolute", "cylindrical"})
          .table("translation_law", &JointOptions::translation_law, translation_law_section(),
                 "Spring and damper in translation.")
          .only_if("type", {"translational", "cylindrical"})
          .at_most_one_of({"rotation", "rotation_law"})
          .at_most_one_of({"translation", "translation_law"})
          .check(check_joint);
  return section;
}

void check_bodies(scene::Document& document, const NamedBodies& bodies, const NamedJoints& joints, bool water_alone) {
  if (bodies.empty() && !water_alone) document.problem("bodies", "the scene has no body: give at least one [bodies.NAME]");
  std::vector<std::string> names;
  std::set<std::string> cylinders;
  for (const auto& [name, body] : bodies) {
    names.push_back(name);
    if (name == "earth") document.problem("bodies.earth", "\"earth\" is the name of the fixed frame: choose another");
    for (std::size_t c = 0; c < body.cylinders.size(); ++c)
      if (!cylinders.insert(body.cylinders[c].name).second)
        document.problem(fmt::format("bodies.{}.cylinders[{}].name", name, c), "another cylinder of the scene has this name");
  }
  for (const auto& [name, joint] : joints) {
    for (const std::string& body : joint.bodies)
      if (body != "earth" && std::find(names.begin(), names.end(), body) == names.end())
        document.problem(
            "joints." + name + ".bodies",
            fmt::format("names body \"{}\", which is not in [bodies]; known: {}, earth", body, fmt::join(names, ", ")));
    const auto check_table = [&, &name = name](const auto& given, const char* which, auto make) {
      if (!given || given->table.empty()) return;
      try {
        make(*given);
      } catch (const scene::SceneError& e) { document.problem(fmt::format("joints.{}.{}.table", name, which), e.what()); }
    };
    check_table(joint.rotation, "rotation", make_rotation);
    check_table(joint.translation, "translation", make_translation);
    check_table(joint.rotation_law, "rotation_law", make_rotation_law);
    check_table(joint.translation_law, "translation_law", make_translation_law);
  }
}

Motion described_motion(const BodyOptions& body) { return {.position = body.centre_m}; }

Motion start_motion(const BodyOptions& body) {
  Motion m;
  m.attitude = attitude(body.rotation);
  m.position = body.reference() + body.displacement_m + m.attitude * (body.centre_m - body.reference());
  m.velocity = body.velocity_m_s;
  m.omega = m.attitude.conjugate() * body.omega_rad_s;
  return m;
}

std::vector<Body> make_bodies(const NamedBodies& bodies) {
  std::vector<Body> result;
  for (const auto& [name, o] : bodies)
    result.push_back({.name = name,
                      .mass = o.mass_kg,
                      .inertia = o.inertia_kg_m2,
                      .gyroscopic = o.gyroscopic,
                      .initial = described_motion(o)});
  return result;
}

Eigen::Vector3d point_of(const JointOptions& joint, const NamedBodies& bodies) {
  if (joint.point_m) return *joint.point_m;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  for (const std::string& name : joint.bodies)
    if (const int body = index_of(bodies, name); body != earth) point = bodies[std::size_t(body)].options.centre_m;
  return point;
}

std::vector<Joint> make_joints(const NamedJoints& joints, const NamedBodies& bodies) {
  std::vector<Joint> result;
  for (const auto& [name, o] : joints) {
    Joint joint{.name = name,
                .type = o.type,
                .i = index_of(bodies, o.bodies[0]),
                .j = index_of(bodies, o.bodies[1]),
                .point = point_of(o, bodies)};
    if (o.axis.norm() > 0.0) joint.axis = o.axis.normalized();
    if (o.second_axis.norm() > 0.0) joint.second_axis = o.second_axis.normalized();
    if (o.rotation) joint.rotation = make_rotation(*o.rotation);
    if (o.translation) joint.translation = make_translation(*o.translation);
    result.push_back(std::move(joint));
  }
  return result;
}

std::vector<PointLoad> make_point_loads(const NamedBodies& bodies) {
  std::vector<PointLoad> result;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    for (const ForceOptions& f : bodies[b].options.forces)
      result.push_back({.body = int(b),
                        .point = f.point_m - bodies[b].options.centre_m,
                        .force = f.force_N,
                        .moment = f.moment_N_m,
                        .follows_body = f.follows_body});
  return result;
}

std::vector<JointLaw> make_joint_laws(const NamedJoints& joints, const NamedBodies& bodies) {
  std::vector<JointLaw> laws;
  for (const auto& [name, o] : joints) {
    const auto add = [&, &o = o](JointLaw law) {
      const auto from_centre = [&](int body) -> Eigen::Vector3d {
        const Eigen::Vector3d point = point_of(o, bodies);
        return body == earth ? point : Eigen::Vector3d(point - bodies[std::size_t(body)].options.centre_m);
      };
      law.i = index_of(bodies, o.bodies[0]), law.j = index_of(bodies, o.bodies[1]), law.axis = o.axis.normalized();
      law.point_i = from_centre(law.i), law.point_j = from_centre(law.j);
      laws.push_back(std::move(law));
    };
    if (o.rotation_law) add(make_rotation_law(*o.rotation_law));
    if (o.translation_law) add(make_translation_law(*o.translation_law));
  }
  return laws;
}

Cylinder make_cylinder(const CylinderOptions& c, const BodyOptions& body) {
  return {.start = c.start_m - body.centre_m,
          .end = c.end_m - body.centre_m,
          .start_radius = 0.5 * c.diameter_m,
          .end_radius = 0.5 * c.end_diameter_m.value_or(c.diameter_m)};
}
Box make_box(const BoxOptions& b, const BodyOptions& body) { return {.centre = b.centre_m - body.centre_m, .size = b.size_m}; }
Mesh make_mesh(const scene::MeshOptions& m, const BodyOptions& body) {
  return {.surface = m.prism ? m.prism : m.surface, .origin = body.centre_m};
}
Sphere make_sphere(const SphereOptions& s, const BodyOptions& body) {
  return {.centre = s.centre_m - body.centre_m, .radius = 0.5 * s.diameter_m};
}

}  // namespace spindrift::bodies
