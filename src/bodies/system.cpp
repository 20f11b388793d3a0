// SPDX-License-Identifier: Apache-2.0
#include "src/bodies/system.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "src/bodies/mechanism.hpp"

namespace spindrift::bodies {

namespace {

constexpr double farthest = 6.371e6;            // m, mean radius of the earth (IUGG)
constexpr double fastest = 1.119e4;             // m/s, escape velocity at its surface
constexpr double consistency_tolerance = 1e-9;  // residual over L (or velocity) that a redundant row may show

/// Support of each body: what carries it in its first revolute or cylindrical joint with the earth or a heavier body; the body
/// itself where it has none.
std::vector<int> supports(std::span<const Body> bodies, std::span<const Joint> joints) {
  std::vector<int> support(bodies.size());
  for (int b = 0; b < int(bodies.size()); ++b) {
    support[std::size_t(b)] = b;
    for (const Joint& joint : joints) {
      if (!turns(joint.type) || (joint.i != b && joint.j != b)) continue;
      const int other = joint.i == b ? joint.j : joint.i;
      if (other != earth && bodies[std::size_t(other)].mass <= bodies[std::size_t(b)].mass) continue;
      support[std::size_t(b)] = other;
      break;
    }
  }
  return support;
}

/// Of the bodies alone [J], added mass not included.
double kinetic_energy_of(std::span<const Body> bodies, std::span<const Motion> motions) {
  double energy = 0.0;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Motion& m = motions[b];
    energy += 0.5 * (bodies[b].mass * m.velocity.squaredNorm() + m.omega.dot(bodies[b].inertia * m.omega));
  }
  return energy;
}

}  // namespace

struct System::Work {
  Work(std::vector<Body> b, std::vector<Joint> j, std::vector<LoadSource> l, Integrator i)
      : bodies(std::move(b)),
        joints(std::move(j)),
        loads(std::move(l)),
        integrator(i),
        mechanism(bodies, joints),
        support(supports(bodies, joints)),
        motions(bodies.size()),
        wrenches(bodies.size()),
        of_source(loads.size(), std::vector<Wrench>(bodies.size())),
        added(bodies.size()),
        mass(bodies.size()) {
    force.setZero(mechanism.coordinates());
    inertial.setZero(mechanism.coordinates());
    mass_tangent.resize(mechanism.coordinates(), 0);
    for (const LoadSource& source : loads) {
      has_added_mass |= bool(source.added_mass);
      if (source.memory) memory_size += source.memory->size;
      if (source.coupling) pairs.insert(pairs.end(), source.coupling->pairs.begin(), source.coupling->pairs.end());
    }
    between.resize(pairs.size());
    between_chart.resize(pairs.size());
    evaluation.acceleration.resize(bodies.size());
    evaluation.angular_acceleration.resize(bodies.size());
    source_power.assign(loads.size(), 0.0);
    step_work.assign(loads.size() + EnergyBalance::count, 0.0);
    evaluation.joint_reactions.resize(joints.size());
  }

  void recall(std::span<const double> memory);
  void remember(double t, double h, BodiesState& state);
  void gather_loads(double t);
  void gather_mass(double t);
  void add_blocks(const LoadSource& source, double t, std::size_t first);
  template <class In, class Out>
  void add_coupled(const In& in, Out& out) const;
  void gather_forces(bool at_rest);
  void condense();
  bool accelerations(double t, const Eigen::VectorXd& x, const Eigen::VectorXd& u);
  bool fail(StepReport::Trouble trouble, int body);
  bool positions(double t, const Eigen::VectorXd& x);
  void size_for_freedoms();
  StepReport open(BodiesState& state, double t, bool choose);
  bool close(double t, const Eigen::VectorXd& x, const Eigen::VectorXd& u);
  bool advance(double t, double t_end, double h, bool evaluated);
  bool knows(const BodiesState& state, double t) const;
  double kinetic_of_opened();
  bool within_bounds();
  double power(std::span<const Wrench> loads) const;
  void clear_step_work();
  void count_power(double weight);
  bool count_work(double h, double kinetic_before);

  std::vector<Body> bodies;
  std::vector<Joint> joints;
  std::vector<LoadSource> loads;
  Integrator integrator;
  Mechanism mechanism;
  std::vector<int> support;
  bool has_added_mass = false;
  std::size_t memory_size = 0;

  StepReport report;
  std::vector<Motion> motions;
  std::vector<Wrench> wrenches;                // of all sources
  std::vector<std::vector<Wrench>> of_source;  // [source][body], without what added mass takes
  std::vector<Matrix6> added;                  // earth axes, SI
  std::vector<Matrix6> mass;              // chart units: [m L2, I] + added mass turned into (earth translation, body rotation)
  std::vector<std::array<int, 2>> pairs;  // of all couplings, in the order of their sources
  std::vector<Matrix6> between, between_chart;  // of the pairs: as `added`, as `mass`
  Eigen::VectorXd force, inertial;
  Eigen::MatrixXd mass_tangent, condensed;
  Eigen::VectorXd condensed_force, acceleration, x, u;
  Eigen::LLT<Eigen::MatrixXd> cholesky;
  IntegratorWork integration;
  BodiesState opened;
  Evaluation evaluation;
  /// The state that evaluate() was last asked for and nothing else since: a step from there begins with its accelerations.
  struct Known {
    bool valid = false;
    double t = 0.0, kinetic = 0.0;
    BodiesState state;
  } known;
  bool loads_from_outside = false;
  std::vector<Matrix6> of_one_source;           // scratch of evaluate()
  std::vector<double> source_power, step_work;  ///< of the last evaluation [W]; over the step, divided by its length
  double step_gain = 0.0;                       ///< rate of the kinetic energy over the step [W]
};

bool System::Work::fail(StepReport::Trouble trouble, int body) {
  report.trouble = trouble;
  report.body = body;
  return false;
}

void System::Work::size_for_freedoms() {
  const int n = mechanism.freedoms();
  mass_tangent.resize(mechanism.coordinates(), n);
  condensed.resize(n, n);
  for (auto* v : {&condensed_force, &acceleration, &x, &u}) v->resize(n);
  integration.resize(n);
}

StepReport System::Work::open(BodiesState& state, double t, bool choose) {
  known.valid = false;
  report = mechanism.open(state, t, choose);
  if (mass_tangent.cols() != mechanism.freedoms()) size_for_freedoms();
  return report;
}

bool System::Work::positions(double t, const Eigen::VectorXd& x) {
  const StepReport r = mechanism.solve_positions(t, x);
  if (r.ok()) return true;
  report.trouble = r.trouble;
  report.joint = r.joint;
  report.value = r.value;
  return false;
}

/// Hands each source its part of the memory; to all of them nothing where there is none.
void System::Work::recall(std::span<const double> memory) {
  if (memory_size == 0) return;
  std::size_t first = 0;
  for (const LoadSource& source : loads) {
    if (!source.memory) continue;
    source.memory->recall(memory.empty() ? memory : memory.subspan(first, source.memory->size));
    first += source.memory->size;
  }
}

void System::Work::remember(double t, double h, BodiesState& state) {
  if (state.memory.empty()) return;
  std::size_t first = 0;
  for (const LoadSource& source : loads) {
    if (!source.memory) continue;
    source.memory->remember(t, h, state.motions, std::span(state.memory).subspan(first, source.memory->size));
    first += source.memory->size;
  }
}

void System::Work::gather_loads(double t) {
  const auto clear = [this](std::vector<Wrench>& on) {
    for (std::size_t b = 0; b < bodies.size(); ++b)
      on[b] = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), motions[b].position};
  };
  clear(wrenches);
  for (std::size_t s = 0; s < loads.size(); ++s) {
    clear(of_source[s]);
    if (!loads[s].loads) continue;
    loads[s].loads(t, motions, of_source[s]);
    source_power[s] = power(of_source[s]);
    for (std::size_t b = 0; b < bodies.size(); ++b)
      wrenches[b].force += of_source[s][b].force, wrenches[b].moment += of_source[s][b].moment;
  }
}

/// Of loads on all bodies, in W.
double System::Work::power(std::span<const Wrench> loads) const {
  double sum = 0.0;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    sum += loads[b].force.dot(motions[b].velocity) + loads[b].moment.dot(motions[b].omega_earth());
  return sum;
}

void System::Work::clear_step_work() {
  std::ranges::fill(step_work, 0.0);
  step_gain = 0.0;
}

/// Adds the power of all that acts at the accelerations just found.
void System::Work::count_power(double weight) {
  const Eigen::VectorXd& bias = mechanism.bias();
  double gain = 0.0, of_sources = 0.0, of_added_mass = 0.0;
  const auto velocity_of = [&](int b) {
    Eigen::Matrix<double, 6, 1> velocity;
    velocity << motions[std::size_t(b)].velocity, motions[std::size_t(b)].omega_earth();
    return velocity;
  };
  const auto rate_of = [&](int b) {
    Eigen::Matrix<double, 6, 1> rate = bias.segment<6>(Eigen::Index(6 * b));
    if (mechanism.freedoms() > 0) rate.noalias() += mechanism.tangent().middleRows<6>(Eigen::Index(6 * b)) * acceleration;
    rate.head<3>() *= mechanism.length();
    rate.tail<3>() = (mechanism.poses()[std::size_t(b)].axes * rate.tail<3>()).eval();
    return rate;
  };
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const auto [i, j] = pairs[p];
    of_added_mass -= velocity_of(i).dot(between[p] * rate_of(j)) + velocity_of(j).dot(between[p].transpose() * rate_of(i));
  }
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const auto k = Eigen::Index(6 * b);
    Eigen::Matrix<double, 6, 1> rate = bias.segment<6>(k);
    if (mechanism.freedoms() > 0) rate.noalias() += mechanism.tangent().middleRows<6>(k) * acceleration;
    rate.head<3>() *= mechanism.length();
    gain += bodies[b].mass * rate.head<3>().dot(motions[b].velocity) + motions[b].omega.dot(bodies[b].inertia * rate.tail<3>());
    if (!has_added_mass) continue;
    Eigen::Matrix<double, 6, 1> earth_rate, velocity;
    earth_rate << rate.head<3>(), mechanism.poses()[b].axes * rate.tail<3>();
    velocity << motions[b].velocity, motions[b].omega_earth();
    of_added_mass -= velocity.dot(added[b] * earth_rate);
  }
  for (std::size_t s = 0; s < loads.size(); ++s) step_work[s] += weight * source_power[s], of_sources += source_power[s];
  const auto after_sources = std::span(step_work).subspan(loads.size());
  after_sources[EnergyBalance::added_mass] += weight * of_added_mass;
  after_sources[EnergyBalance::joints] += weight * (gain - of_sources - of_added_mass);
  step_gain += weight * gain;
}

/// Adds the step's work to that of the run. False where a step by rk4 made or lost more energy than a thousandth of what the
/// loads have turned over: a load that sets in within the step; or where the steps together did more than half of it: no solution
/// of the equations does. Forward Euler, which gains energy by its nature, is counted and not judged.
bool System::Work::count_work(double h, double kinetic_before) {
  const auto after_sources = std::span(opened.work).subspan(loads.size());
  for (std::size_t s = 0; s < loads.size(); ++s) {
    opened.work[s] += h * step_work[s];
    after_sources[EnergyBalance::throughput] += h * std::abs(step_work[s]);
  }
  for (const auto slot : {EnergyBalance::added_mass, EnergyBalance::joints})
    after_sources[slot] += h * step_work[loads.size() + slot];
  double& error = after_sources[EnergyBalance::error];
  const double made = kinetic_energy_of(bodies, motions) - kinetic_before - h * step_gain;
  error += made;
  constexpr double most = 0.5, most_of_a_step = 1e-3, slow = 0.05;  // m/s: of all mass together, so that rest is no division by 0
  double mass = 0.0;
  for (const Body& body : bodies) mass += body.mass;
  const double scale = after_sources[EnergyBalance::throughput] + std::abs(after_sources[EnergyBalance::joints]) +
                       std::abs(after_sources[EnergyBalance::added_mass]) + kinetic_before + 0.5 * mass * slow * slow;
  if (integrator == Integrator::rk4 && std::abs(made) > most_of_a_step * scale) {
    report.value = 0.5 * h;
    return fail(StepReport::Trouble::stiff, -1);
  }
  if (integrator == Integrator::explicit_euler || std::abs(error) <= most * scale) return true;
  report.value = error;
  return fail(StepReport::Trouble::energy, -1);
}

/// Mass matrices in chart units; added mass joins the body's own, angular velocities being in body axes.
void System::Work::gather_mass(double t) {
  const double l = mechanism.length();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    mass[b].setZero();
    mass[b].topLeftCorner<3, 3>().diagonal().setConstant(bodies[b].mass * l * l);
    mass[b].bottomRightCorner<3, 3>() = bodies[b].inertia;
  }
  if (!has_added_mass) return;
  for (Matrix6& a : added) a.setZero();
  for (const LoadSource& source : loads)
    if (source.added_mass) source.added_mass(t, motions, added);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Eigen::Matrix3d& axes = mechanism.poses()[b].axes;
    mass[b].topLeftCorner<3, 3>() += l * l * added[b].topLeftCorner<3, 3>();
    mass[b].topRightCorner<3, 3>() += l * added[b].topRightCorner<3, 3>() * axes;
    mass[b].bottomLeftCorner<3, 3>() += l * axes.transpose() * added[b].bottomLeftCorner<3, 3>();
    mass[b].bottomRightCorner<3, 3>() += axes.transpose() * added[b].bottomRightCorner<3, 3>() * axes;
  }
  if (pairs.empty()) return;
  std::size_t first = 0;
  for (Matrix6& block : between) block.setZero();
  for (const LoadSource& source : loads) {
    if (!source.coupling) continue;
    add_blocks(source, t, first);
    first += source.coupling->pairs.size();
  }
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const Eigen::Matrix3d &i = mechanism.poses()[std::size_t(pairs[p][0])].axes,
                          &j = mechanism.poses()[std::size_t(pairs[p][1])].axes;
    between_chart[p].topLeftCorner<3, 3>() = l * l * between[p].topLeftCorner<3, 3>();
    between_chart[p].topRightCorner<3, 3>() = l * between[p].topRightCorner<3, 3>() * j;
    between_chart[p].bottomLeftCorner<3, 3>() = l * i.transpose() * between[p].bottomLeftCorner<3, 3>();
    between_chart[p].bottomRightCorner<3, 3>() = i.transpose() * between[p].bottomRightCorner<3, 3>() * j;
  }
}

/// Adds the blocks of a source to `between`, where its pairs begin at `first`.
void System::Work::add_blocks(const LoadSource& source, double t, std::size_t first) {
  source.coupling->blocks(t, motions, std::span(between).subspan(first, source.coupling->pairs.size()));
}

/// out += (couplings between bodies) in, over rows of all coordinates.
template <class In, class Out>
void System::Work::add_coupled(const In& in, Out& out) const {
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const Eigen::Index i = 6 * pairs[p][0], j = 6 * pairs[p][1];
    out.template middleRows<6>(i).noalias() += between_chart[p] * in.template middleRows<6>(j);
    out.template middleRows<6>(j).noalias() += between_chart[p].transpose() * in.template middleRows<6>(i);
  }
}

/// Generalised forces on all coordinates, gyroscopic moments included.
void System::Work::gather_forces(bool at_rest) {
  const double l = mechanism.length();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Pose& pose = mechanism.poses()[b];
    auto f = force.segment<6>(Eigen::Index(6 * b));
    f.head<3>() = l * wrenches[b].force;
    f.tail<3>() = pose.axes.transpose() * wrenches[b].moment;
    if (at_rest) continue;
    const Eigen::Vector3d omega = motions[b].omega;
    if (bodies[b].gyroscopic) {
      f.tail<3>() -= omega.cross(bodies[b].inertia * omega);
    } else if (support[b] >= 0) {  // M = I (alpha - omega_support x omega): the spin does not feel its axis turning
      const Eigen::Vector3d turning = pose.axes.transpose() * mechanism.poses()[std::size_t(support[b])].spin;
      f.tail<3>() += bodies[b].inertia * turning.cross(omega);
    }
  }
}

/// condensed = B^T M B with the tangent B of the mechanism.
void System::Work::condense() {
  const Eigen::MatrixXd& tangent = mechanism.tangent();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const auto k = Eigen::Index(6 * b);
    mass_tangent.middleRows<6>(k).noalias() = mass[b] * tangent.middleRows<6>(k);
  }
  add_coupled(tangent, mass_tangent);
  condensed.noalias() = tangent.transpose() * mass_tangent;
}

/// Accelerations of the independent coordinates: B^T M B a = B^T (F - M bias).
bool System::Work::accelerations(double t, const Eigen::VectorXd& x, const Eigen::VectorXd& u) {
  if (!positions(t, x)) return false;
  mechanism.solve_velocities(u);
  mechanism.motions(motions);
  gather_loads(t);
  gather_mass(t);
  gather_forces(false);
  condense();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const auto k = Eigen::Index(6 * b);
    inertial.segment<6>(k).noalias() = mass[b] * mechanism.bias().segment<6>(k);
  }
  add_coupled(mechanism.bias(), inertial);
  force -= inertial;
  condensed_force.noalias() = mechanism.tangent().transpose() * force;
  if (mechanism.freedoms() == 0) return true;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (!force.segment<6>(Eigen::Index(6 * b)).allFinite()) return fail(StepReport::Trouble::not_finite, int(b));
  cholesky.compute(condensed);
  if (cholesky.info() != Eigen::Success) return fail(StepReport::Trouble::mass, -1);
  acceleration = condensed_force;
  cholesky.solveInPlace(acceleration);
  if (!acceleration.allFinite()) return fail(StepReport::Trouble::not_finite, -1);
  return true;
}

bool System::Work::close(double t, const Eigen::VectorXd& x, const Eigen::VectorXd& u) {
  if (!x.allFinite() || !u.allFinite()) return fail(StepReport::Trouble::not_finite, -1);
  if (!positions(t, x)) return false;
  mechanism.solve_velocities(u);
  mechanism.motions(motions);
  int joint = -1;
  const double worst = mechanism.residual(&joint);
  if (!(worst <= consistency_tolerance)) {
    report.trouble = StepReport::Trouble::inconsistent;
    report.joint = joint;
    report.value = worst;
    return false;
  }
  return true;
}

/// `opened` from t to t_end, which is h later. `evaluated`: as evaluate() left it at t.
bool System::Work::advance(double t, double t_end, double h, bool evaluated) {
  recall(opened.memory);
  if (!evaluated && !open(opened, t, false).ok()) return false;
  known.valid = false;
  u = mechanism.open_velocity();
  const bool counts = !opened.work.empty();
  const double kinetic_before = evaluated ? known.kinetic : kinetic_of_opened();
  clear_step_work();
  const std::span<const double> weights = evaluation_weights(integrator);
  std::size_t evaluations = 0;
  const auto rates = [&, this](double time, const Eigen::VectorXd& x, const Eigen::VectorXd& u, Eigen::VectorXd& x_rate,
                               Eigen::VectorXd& u_rate) {
    const bool is_known = evaluated && evaluations == 0;  // every integrator begins at the start of the step
    if (!is_known && !accelerations(time, x, u)) return false;
    mechanism.chart_rate(x_rate);
    u_rate = acceleration;
    if (counts) count_power(weights[evaluations]);
    ++evaluations;
    return true;
  };
  const bool done = step(integrator, rates, t, h, u, integration) && close(t_end, integration.x, u);
  report.newton_iterations = mechanism.newton_iterations();
  if (!done) return false;
  constexpr double stiffest = 2.2;  // a twentieth beyond the limit of rk4
  constexpr double most_onset = 0.25;
  if (integration.stiffness > stiffest || integration.onset > most_onset) {
    report.value = h / std::sqrt(std::max(integration.stiffness / 2.0, integration.onset / most_onset));
    return fail(StepReport::Trouble::stiff, -1);
  }
  mechanism.motions(opened.motions);
  if (!within_bounds()) return false;
  if (counts && !count_work(h, kinetic_before)) return false;
  mechanism.turn_joints(opened.joint_angles);
  remember(t_end, h, opened);
  return std::ranges::all_of(opened.memory, [](double v) { return std::isfinite(v); }) ||
         fail(StepReport::Trouble::not_finite, -1);
}

/// [J], where open() has put the bodies.
double System::Work::kinetic_of_opened() {
  mechanism.motions(motions);
  return kinetic_energy_of(bodies, motions);
}

bool System::Work::knows(const BodiesState& state, double t) const {
  return known.valid && !loads_from_outside && known.t == t && known.state == state;
}

/// Loads are those of a flat earth.
bool System::Work::within_bounds() {
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const double distance = opened.motions[b].position.norm(), speed = opened.motions[b].velocity.norm();
    report.value = distance <= farthest ? speed : distance;
    if (!(distance <= farthest)) return fail(StepReport::Trouble::too_far, int(b));
    if (!(speed <= fastest)) return fail(StepReport::Trouble::too_fast, int(b));
  }
  report.value = 0.0;
  return true;
}

System::System(std::vector<Body> bodies, std::vector<Joint> joints, std::vector<LoadSource> loads, Integrator integrator)
    : w_(std::make_unique<Work>(std::move(bodies), std::move(joints), std::move(loads), integrator)) {}
System::~System() = default;
System::System(System&&) noexcept = default;

std::span<const Body> System::bodies() const { return w_->bodies; }
std::span<const Joint> System::joints() const { return w_->joints; }
std::span<const LoadSource> System::loads() const { return w_->loads; }
Integrator System::integrator() const { return w_->integrator; }
double System::reference_length() const { return w_->mechanism.length(); }
void System::set_loads_from_outside(bool outside) {
  w_->loads_from_outside = outside;
  w_->known.valid = false;
}

Assembly System::assemble(double t_s) {
  BodiesState start;
  for (const Body& body : w_->bodies) {
    start.motions.push_back(body.initial);
    start.motions.back().attitude.normalize();
  }
  start.joint_angles.assign(w_->joints.size(), 0.0);
  start.independent.assign(std::size_t(w_->mechanism.coordinates()), 1);
  start.active.assign(std::size_t(w_->mechanism.rows()), 0);
  return assemble_from(start, t_s);
}

Assembly System::assemble_from(const BodiesState& near, double t_s) {
  w_->recall({});
  Assembly assembly;
  assembly.state = near;
  BodiesState& state = assembly.state;
  Mechanism& mechanism = w_->mechanism;
  const auto contradict = [&](const std::string& how, int joint, double value) {
    assembly.contradiction = how + " joint '" + w_->joints[std::size_t(joint)].name + "'";
    for (int row = 0; row < mechanism.rows(); ++row) {
      if (state.active[std::size_t(row)] || mechanism.joint_of_row(row) != joint) continue;
      for (int other : mechanism.joints_behind(row))
        if (other != joint && assembly.contradiction.find("'" + w_->joints[std::size_t(other)].name + "'") == std::string::npos)
          assembly.contradiction += ", '" + w_->joints[std::size_t(other)].name + "'";
    }
    assembly.contradiction += " (residual " + fmt::format("{:.3g}", value) + ")";
  };
  // A driver may ask for a place away from the initial one: solve, centre the chart there, choose the partition again.
  for (int pass = 0; pass < 2; ++pass) {
    w_->open(state, t_s, true);
    const Eigen::VectorXd u = mechanism.open_velocity(), x = Eigen::VectorXd::Zero(mechanism.freedoms());
    const StepReport solved = mechanism.solve_positions(t_s, x);
    if (!solved.ok()) {
      contradict("the position equations have no solution near the initial one;", std::max(solved.joint, 0), solved.value);
      return assembly;
    }
    mechanism.solve_velocities(u);
    mechanism.motions(state.motions);
    mechanism.turn_joints(state.joint_angles);
  }
  int joint = -1;
  double worst = mechanism.residual(&joint);
  if (worst > consistency_tolerance) {
    contradict("these joints ask for positions that contradict each other:", joint, worst);
    return assembly;
  }
  worst = mechanism.velocity_residual(&joint);
  if (worst > consistency_tolerance * (1.0 + mechanism.velocity().cwiseAbs().maxCoeff())) {
    contradict("these joints ask for velocities that contradict each other:", joint, worst);
    return assembly;
  }
  assembly.degrees_of_freedom = mechanism.freedoms();
  std::vector<int> repeated(w_->joints.size(), 0);
  std::vector<std::string> others(w_->joints.size());
  for (int row = 0; row < mechanism.rows(); ++row) {
    if (state.active[std::size_t(row)]) continue;
    const std::vector<int> behind = mechanism.joints_behind(row);
    ++repeated[std::size_t(behind[0])];
    std::string& list = others[std::size_t(behind[0])];
    for (std::size_t k = 1; k < behind.size(); ++k) {
      const std::string quoted = "'" + w_->joints[std::size_t(behind[k])].name + "'";
      if (list.find(quoted) == std::string::npos) list += (list.empty() ? "" : ", ") + quoted;
    }
  }
  for (std::size_t k = 0; k < repeated.size(); ++k)
    if (repeated[k])
      assembly.redundant.push_back("joint '" + w_->joints[k].name + "' repeats " + std::to_string(repeated[k]) +
                                   (repeated[k] == 1 ? " condition" : " conditions") + " that follow from " +
                                   (others[k].empty() ? "its own" : others[k]));
  return assembly;
}

void System::begin(BodiesState& state, double t_s) {
  state.work.assign(w_->loads.size() + EnergyBalance::count, 0.0);
  state.memory.assign(w_->memory_size, 0.0);
  std::size_t first = 0;
  for (const LoadSource& source : w_->loads) {
    if (!source.memory) continue;
    source.memory->begin(t_s, state.motions, std::span(state.memory).subspan(first, source.memory->size));
    first += source.memory->size;
  }
}

StepReport System::advance(BodiesState& state, double tick_s, std::int64_t ticks, int pieces) {
  Work& w = *w_;
  const double begin = double(state.tick) * tick_s, length = double(ticks) * tick_s, h = length / pieces;
  const double end = double(state.tick + ticks) * tick_s;
  const bool known = w.knows(state, begin);
  if (!known) w.opened = state;
  for (int piece = 0; piece < pieces; ++piece) {
    const double t = piece == 0 ? begin : begin + piece * h;
    if (!w.advance(t, piece + 1 == pieces ? end : begin + (piece + 1) * h, h, known && piece == 0)) return w.report;
  }
  w.opened.tick = state.tick + ticks;
  std::swap(state, w.opened);
  return w.report;
}

const Evaluation& System::evaluate(const BodiesState& state, double t_s) {
  Work& w = *w_;
  Evaluation& e = w.evaluation;
  w.opened = state;
  w.recall(w.opened.memory);
  e.report = w.open(w.opened, t_s, false);
  if (!e.report.ok()) return e;
  w.known.kinetic = w.kinetic_of_opened();
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(w.mechanism.freedoms());
  w.accelerations(t_s, zero, w.mechanism.open_velocity());
  e.report = w.report;
  if (!e.report.ok()) return e;
  const Eigen::VectorXd all = w.mechanism.tangent() * w.acceleration + w.mechanism.bias();
  for (std::size_t b = 0; b < w.bodies.size(); ++b) {
    const auto k = Eigen::Index(6 * b);
    e.acceleration[b] = w.mechanism.length() * all.segment<3>(k);
    e.angular_acceleration[b] = w.mechanism.poses()[b].axes * all.segment<3>(k + 3);
    // M bias was taken off the forces above: out of balance = M a - F over all coordinates
    w.inertial.segment<6>(k).noalias() = w.mass[b] * (all.segment<6>(k) - w.mechanism.bias().segment<6>(k));
  }
  w.add_coupled(Eigen::VectorXd(all - w.mechanism.bias()), w.inertial);
  w.mechanism.reactions(w.inertial - w.force, e.joint_reactions);
  e.by_source = w.of_source;
  for (std::size_t s = 0; s < w.loads.size(); ++s) {
    std::vector<Wrench>& of = e.by_source[s];
    const auto react = [&](int on, const Matrix6& block, int by) {
      Eigen::Matrix<double, 6, 1> motion;
      motion << e.acceleration[std::size_t(by)], e.angular_acceleration[std::size_t(by)];
      const Eigen::Matrix<double, 6, 1> reaction = block * motion;
      of[std::size_t(on)].force -= reaction.head<3>();
      of[std::size_t(on)].moment -= reaction.tail<3>();
    };
    if (const auto& coupling = w.loads[s].coupling) {
      w.of_one_source.assign(coupling->pairs.size(), Matrix6::Zero());
      coupling->blocks(t_s, w.motions, w.of_one_source);
      for (std::size_t p = 0; p < coupling->pairs.size(); ++p) {
        const auto [i, j] = coupling->pairs[p];
        react(i, w.of_one_source[p], j);
        react(j, w.of_one_source[p].transpose(), i);
      }
    }
    if (!w.loads[s].added_mass) continue;
    w.of_one_source.assign(w.bodies.size(), Matrix6::Zero());
    w.loads[s].added_mass(t_s, w.motions, w.of_one_source);
    for (std::size_t b = 0; b < of.size(); ++b) react(int(b), w.of_one_source[b], int(b));
  }
  w.known.valid = true, w.known.t = t_s, w.known.state = state;
  return e;
}

double System::constraint_residual(const BodiesState& state, double t_s) {
  w_->opened = state;
  w_->open(w_->opened, t_s, false);
  return w_->mechanism.residual();
}

double System::constraint_residual_now() { return w_->mechanism.residual(); }

double System::kinetic_energy(const BodiesState& state) const { return kinetic_energy_of(w_->bodies, state.motions); }

std::string System::describe(const StepReport& r) const {
  using Trouble = StepReport::Trouble;
  const std::string joint = r.joint >= 0 ? "joint '" + w_->joints[std::size_t(r.joint)].name + "'" : "the bodies";
  const std::string body = r.body >= 0 ? "body '" + w_->bodies[std::size_t(r.body)].name + "'" : "the bodies";
  switch (r.trouble) {
    case Trouble::none:
      return "no trouble";
    case Trouble::newton:
      return joint + ": the position equations did not converge (residual " + fmt::format("{:.3g}", r.value) +
             " of the reference length); try a smaller step";
    case Trouble::singular:
      return joint + ": the mechanism is in a singular position (pivot ratio " + fmt::format("{:.3g}", r.value) +
             "), where its motion is not determined; a different step or initial position avoids it";
    case Trouble::inconsistent:
      return joint + ": a condition that followed from the other joints at the start no longer does (residual " +
             fmt::format("{:.3g}", r.value) +
             " of the reference length); the start was a singular position or the joints contradict each other";
    case Trouble::not_finite:
      return body + ": a load or motion is not a finite number; the step is probably beyond its stability limit";
    case Trouble::mass:
      return "mass plus added mass is not positive definite";
    case Trouble::stiff:
      return "bodies: the step is beyond the " + fmt::format("{:.3g}", r.value) +
             " s or so that the stiffest load allows now (a line that snapped taut, water met at speed); try a smaller "
             "time.step_s";
    case Trouble::energy:
      return "bodies: the steps themselves have made " + fmt::format("{:.3g}", r.value) +
             " J, more than half of all work of the loads; try a smaller time.step_s";
    case Trouble::too_far:
      return body + ": it is " + fmt::format("{:.4g} m away, the limit is {:.4g} m (radius of the earth)", r.value, farthest);
    case Trouble::too_fast:
      return body + ": its speed is " + fmt::format("{:.4g} m/s, the limit is {:.5g} m/s (escape velocity)", r.value, fastest);
  }
  return "";
}

NumericalFailure System::failure(const StepReport& r, const BodiesState& state, double tick_s) const {
  const double t = double(state.tick) * tick_s;
  const std::string place = r.joint >= 0  ? w_->joints[std::size_t(r.joint)].name
                            : r.body >= 0 ? w_->bodies[std::size_t(r.body)].name
                                          : "bodies";
  return NumericalFailure("t = " + fmt::format("{:.3g}", t) + " s, tick " + std::to_string(state.tick) + ": " + describe(r),
                          place, long(state.tick), t, r.value);
}

StepReport System::open_chart(const BodiesState& state, double t_s) {
  w_->opened = state;
  w_->recall({});
  return w_->open(w_->opened, t_s, false);
}
int System::freedoms() const { return w_->mechanism.freedoms(); }
const Eigen::VectorXd& System::chart_velocity() const { return w_->mechanism.open_velocity(); }
const StepReport& System::chart_report() const { return w_->report; }

bool System::rates(double t_s, const Eigen::VectorXd& x, const Eigen::VectorXd& u, Eigen::VectorXd& x_rate,
                   Eigen::VectorXd& u_rate) {
  if (!w_->accelerations(t_s, x, u)) return false;
  w_->mechanism.chart_rate(x_rate);
  u_rate = w_->acceleration;
  return true;
}

bool System::forces_at_rest(double t_s, const Eigen::VectorXd& x, Eigen::VectorXd& force, Eigen::MatrixXd& mass,
                            double* all_loads) {
  if (!w_->positions(t_s, x)) return false;
  w_->mechanism.solve_velocities(Eigen::VectorXd::Zero(freedoms()));
  w_->mechanism.motions(w_->motions);
  w_->gather_loads(t_s);
  w_->gather_mass(t_s);
  w_->gather_forces(true);
  w_->condense();
  force.noalias() = w_->mechanism.tangent().transpose() * w_->force;
  mass = w_->condensed;
  if (all_loads) {
    *all_loads = 0.0;
    std::vector<Wrench> one(w_->bodies.size());
    for (const LoadSource& source : w_->loads) {
      for (std::size_t b = 0; b < one.size(); ++b)
        one[b] = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), w_->motions[b].position};
      if (source.loads) source.loads(t_s, w_->motions, one);
      for (std::size_t b = 0; b < one.size(); ++b) *all_loads += one[b].force.norm() / std::sqrt(w_->bodies[b].mass);
    }
  }
  return force.allFinite() || w_->fail(StepReport::Trouble::not_finite, -1);
}

bool System::close_chart(double t_s, const Eigen::VectorXd& x, const Eigen::VectorXd& u, BodiesState& state) {
  if (!w_->close(t_s, x, u)) return false;
  state = w_->opened;
  w_->mechanism.motions(state.motions);
  w_->mechanism.turn_joints(state.joint_angles);
  return true;
}

Eigen::MatrixXd System::motion_of_freedoms() const {
  Eigen::MatrixXd motion = w_->mechanism.tangent();
  for (Eigen::Index b = 0; b < motion.rows() / 6; ++b) motion.middleRows<3>(6 * b) *= w_->mechanism.length();
  return motion;
}

}  // namespace spindrift::bodies
