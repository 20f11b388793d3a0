// SPDX-License-Identifier: Apache-2.0
#include "src/bodies/system.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "src/bodies/gathered_loads.hpp"
#include "src/bodies/mass_matrix.hpp"
#include "src/bodies/mechanism.hpp"

namespace spindrift::bodies {

namespace {

constexpr double farthest = 6.371e6;            // m, mean radius of the earth (IUGG)
constexpr double fastest = 1.119e4;             // m/s, escape velocity at its surface
constexpr double consistency_tolerance = 1e-9;  // residual over L (or velocity) that a redundant row may show

/// Radians by which the fastest motion turns in a piece of a step, where a load sets in or ends within it, and where it acts
/// throughout. Bouncing weights keep their height to .2 % (tests/src/bodies/onset_test.cpp).
struct Turning {
  double at_onset, throughout;
};
constexpr Turning turning_in_a_piece(Integrator integrator) {
  return integrator == Integrator::rk4 ? Turning{0.1, 0.5} : Turning{0.05, 0.05};
}

/// Of a step of so many seconds.
double pieces_of(double step, double rate, double turning) { return std::max(1.0, std::ceil(step * rate / turning)); }

/// Support of each body: what carries it in its first revolute or cylindrical joint with the earth or a body before it; the body
/// itself where it has none.
std::vector<int> supports(std::span<const Body> bodies, std::span<const Joint> joints) {
  const std::vector<int> places = carrying_places(bodies, joints);
  std::vector<int> support(bodies.size());
  for (int b = 0; b < int(bodies.size()); ++b) {
    support[std::size_t(b)] = b;
    for (const Joint& joint : joints) {
      if (!turns(joint.type) || (joint.i != b && joint.j != b)) continue;
      const int other = joint.i == b ? joint.j : joint.i;
      if (other != earth && places[std::size_t(other)] > places[std::size_t(b)]) continue;
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
        sources(std::move(l)),
        integrator(i),
        mechanism(bodies, joints),
        mass(bodies, sources),
        loads(sources, bodies.size()),
        memory(sources),
        step_work(sources.size()),
        support(supports(bodies, joints)),
        motions(bodies.size()),
        rates(bodies.size()) {
    force.setZero(mechanism.coordinates());
    inertial.setZero(mechanism.coordinates());
    evaluation.acceleration.resize(bodies.size());
    evaluation.angular_acceleration.resize(bodies.size());
    evaluation.joint_reactions.resize(joints.size());
  }

  void gather(double t);
  void gather_forces(bool at_rest);
  bool accelerations(double t, const Eigen::VectorXd& x, const Eigen::VectorXd& u);
  int body_without_mass();
  bool fail(StepReport::Trouble trouble, int body);
  bool positions(double t, const Eigen::VectorXd& x);
  StepReport open(BodiesState& state, double t, bool choose);
  bool close(double t, const Eigen::VectorXd& x, const Eigen::VectorXd& u);
  bool advance(double t, double t_end, double h, bool evaluated);
  bool remember(double t, double h);
  bool knows(const BodiesState& state, double t) const;
  double kinetic_of_opened();
  bool within_bounds();
  void count_power(double weight);
  bool count_work(double h, double kinetic_before);
  bool advance_pieces(const BodiesState& state, double begin, double end, double length, int pieces, bool known);
  void look_for_onsets(std::span<const Motion> at);
  struct Needed {
    double pieces = 1.0;
    int onset = -1;  // that asks for them
  };
  Needed pieces_met(double length) const;

  std::vector<Body> bodies;
  std::vector<Joint> joints;
  std::vector<LoadSource> sources;
  Integrator integrator;
  Mechanism mechanism;
  MassMatrix mass;
  GatheredLoads loads;
  LoadMemory memory;
  StepWork step_work;
  std::vector<int> support;

  StepReport report;
  std::vector<Motion> motions;
  std::vector<Vector6> rates;  // of velocity and spin of each body, earth axes
  Eigen::VectorXd force, inertial;
  Eigen::VectorXd condensed_force, acceleration, u;
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
  /// Whether it acted and did not act in evaluations of the step.
  struct Met {
    bool acting = false, idle = false;
  };
  std::vector<Onset> onsets;
  std::vector<Met> met;  // of each
};

bool System::Work::fail(StepReport::Trouble trouble, int body) {
  report.trouble = trouble;
  report.body = body;
  return false;
}

StepReport System::Work::open(BodiesState& state, double t, bool choose) {
  known.valid = false;
  report = mechanism.open(state, t, choose);
  if (u.size() != mechanism.freedoms()) {
    for (auto* v : {&condensed_force, &acceleration, &u}) v->resize(mechanism.freedoms());
    integration.resize(mechanism.freedoms());
  }
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

/// Adds the power of all that acts at the accelerations just found.
void System::Work::count_power(double weight) {
  double gain = 0.0;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const auto k = Eigen::Index(6 * b);
    Vector6 rate = mechanism.solved().bias.segment<6>(k);
    if (mechanism.freedoms() > 0) rate.noalias() += mechanism.solved().tangent.middleRows<6>(k) * acceleration;
    rate.head<3>() *= mechanism.length();
    gain += bodies[b].mass * rate.head<3>().dot(motions[b].velocity) + motions[b].omega.dot(bodies[b].inertia * rate.tail<3>());
    rates[b] << rate.head<3>(), mechanism.solved().poses[b].axes * rate.tail<3>();
  }
  step_work.add(weight, loads.power(), mass.added_mass_power(motions, rates), gain);
}

/// Adds the step's work to that of the run. False where a step by rk4 made or lost more energy than a thousandth of what the
/// loads have turned over: a load that sets in within the step; or where the steps together did more than half of it: no solution
/// of the equations does. Forward Euler, which gains energy by its nature, may make a tenth of what the loads have done on
/// balance.
bool System::Work::count_work(double h, double kinetic_before) {
  const auto after_sources = std::span(opened.work).subspan(sources.size());
  for (std::size_t s = 0; s < sources.size(); ++s) {
    opened.work[s] += h * step_work.work[s];
    after_sources[EnergyBalance::throughput] += h * std::abs(step_work.work[s]);
  }
  for (const auto slot : {EnergyBalance::added_mass, EnergyBalance::joints})
    after_sources[slot] += h * step_work.work[sources.size() + slot];
  double& error = after_sources[EnergyBalance::error];
  const double kinetic = kinetic_energy_of(bodies, motions);
  const double made = kinetic - kinetic_before - h * step_work.kinetic_gain;
  error += made;
  double& peak = after_sources[EnergyBalance::peak];
  peak = std::max({peak, kinetic_before, kinetic});
  constexpr double most = 0.5, most_of_a_step = 1e-3;
  constexpr double most_by_euler = 0.1, first_steps = 10.0;  // from rest the first steps make all motion there is
  constexpr double slow = 0.05;                              // m/s: of all mass together, so that rest is no division by 0
  double mass = 0.0;
  for (const Body& body : bodies) mass += body.mass;
  const double of_motion = std::abs(after_sources[EnergyBalance::joints]) + std::abs(after_sources[EnergyBalance::added_mass]) +
                           0.5 * mass * slow * slow;
  const double scale = after_sources[EnergyBalance::throughput] + of_motion + kinetic_before;
  if (integrator == Integrator::rk4 && std::abs(made) > most_of_a_step * scale) {
    report.value = 0.5 * h;
    return fail(StepReport::Trouble::stiff, -1);
  }
  bool bounded = std::abs(error) <= most * scale;
  if (integrator == Integrator::explicit_euler) {
    double balance = of_motion;
    for (std::size_t s = 0; s < sources.size(); ++s) balance += std::abs(opened.work[s]);
    bounded = std::abs(error) <= most_by_euler * std::max(balance, peak) + first_steps * std::abs(made);
  }
  if (bounded) return true;
  report.value = error;
  return fail(StepReport::Trouble::energy, -1);
}

/// Generalised forces on all coordinates, gyroscopic moments included.
void System::Work::gather_forces(bool at_rest) {
  const double l = mechanism.length();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Pose& pose = mechanism.solved().poses[b];
    auto f = force.segment<6>(Eigen::Index(6 * b));
    f.head<3>() = l * loads.total()[b].force;
    f.tail<3>() = pose.axes.transpose() * loads.total()[b].moment;
    if (at_rest) continue;
    const Eigen::Vector3d omega = motions[b].omega;
    if (bodies[b].gyroscopic) {
      f.tail<3>() -= omega.cross(bodies[b].inertia * omega);
    } else if (support[b] >= 0) {  // M = I (alpha - omega_support x omega): without gyroscopic moment of the spin
      const Eigen::Vector3d turning = pose.axes.transpose() * mechanism.solved().poses[std::size_t(support[b])].spin;
      f.tail<3>() += bodies[b].inertia * turning.cross(omega);
    }
  }
}

/// Loads and masses where the mechanism is.
void System::Work::gather(double t) {
  mechanism.motions(motions);
  look_for_onsets(motions);
  loads.gather(t, motions);
  mass.gather(t, motions, mechanism);
}

/// The body that moves most in the motion that has the least mass.
int System::Work::body_without_mass() {
  const Eigen::MatrixXd& tangent = mechanism.solved().tangent;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> masses(mass.condense(tangent));
  if (masses.info() != Eigen::Success) return -1;
  const Eigen::VectorXd motion = tangent * masses.eigenvectors().col(0);
  int most = 0;
  const auto share = [&](int b) { return motion.segment<6>(6 * Eigen::Index(b)).norm(); };
  for (int b = 1; b < int(bodies.size()); ++b)
    if (share(b) > share(most)) most = b;
  return most;
}

/// Accelerations of the independent coordinates: B^T M B a = B^T (F - M bias).
bool System::Work::accelerations(double t, const Eigen::VectorXd& x, const Eigen::VectorXd& u) {
  if (!positions(t, x)) return false;
  mechanism.solve_velocities(u);
  gather(t);
  gather_forces(false);
  mass.multiply(mechanism.solved().bias, inertial);
  force -= inertial;
  condensed_force.noalias() = mechanism.solved().tangent.transpose() * force;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (!force.segment<6>(Eigen::Index(6 * b)).allFinite()) return fail(StepReport::Trouble::not_finite, int(b));
  if (mechanism.freedoms() == 0) return true;
  cholesky.compute(mass.condense(mechanism.solved().tangent));
  if (cholesky.info() != Eigen::Success) return fail(StepReport::Trouble::mass, body_without_mass());
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

void System::Work::look_for_onsets(std::span<const Motion> at) {
  for (std::size_t k = 0; k < onsets.size(); ++k) (onsets[k].acts(at) ? met[k].acting : met[k].idle) = true;
}

/// That a step of this length needs, by what its evaluations met.
System::Work::Needed System::Work::pieces_met(double length) const {
  Needed most;
  const Turning turning = turning_in_a_piece(integrator);
  for (std::size_t k = 0; k < onsets.size(); ++k) {
    if (!met[k].acting || (onsets[k].from_start && !met[k].idle)) continue;
    const double pieces = pieces_of(length, onsets[k].rate, met[k].idle ? turning.at_onset : turning.throughout);
    if (pieces > most.pieces) most = {pieces, int(k)};
  }
  return most;
}

/// `opened` from `state` by so many equal steps, but for what is remembered at the end. `known`: as evaluate() left it.
bool System::Work::advance_pieces(const BodiesState& state, double begin, double end, double length, int pieces, bool known) {
  if (!known) opened = state;
  look_for_onsets(opened.motions);
  const double h = length / pieces;
  for (int piece = 0; piece < pieces; ++piece) {
    const double t = piece == 0 ? begin : begin + piece * h;
    const bool last = piece + 1 == pieces;
    const double t_end = last ? end : begin + (piece + 1) * h;
    if (!advance(t, t_end, h, known && piece == 0) || (!last && !remember(t_end, h))) return false;
  }
  look_for_onsets(opened.motions);
  return true;
}

/// `opened` from t to t_end, which is h later. `evaluated`: as evaluate() left it at t.
bool System::Work::advance(double t, double t_end, double h, bool evaluated) {
  memory.recall(opened.memory);
  if (!evaluated && !open(opened, t, false).ok()) return false;
  known.valid = false;
  u = mechanism.open_velocity();
  const bool counts = !opened.work.empty();
  const double kinetic_before = evaluated ? known.kinetic : kinetic_of_opened();
  step_work.clear();
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
  report.newton_iterations = mechanism.solved().newton_iterations;
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
  return true;
}

/// What sources remember at t, the end of a step of h that `opened` has made.
bool System::Work::remember(double t, double h) {
  memory.remember(t, h, opened);
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
std::span<const LoadSource> System::loads() const { return w_->sources; }
Integrator System::integrator() const { return w_->integrator; }
double System::reference_length() const { return w_->mechanism.length(); }

void System::watch(std::vector<Onset> onsets) {
  w_->onsets = std::move(onsets);
  w_->met.assign(w_->onsets.size(), {});
}
std::span<const Onset> System::watched() const { return w_->onsets; }
double System::pieces_at(const Onset& onset, double step_s) const {
  return pieces_of(step_s, onset.rate, turning_in_a_piece(w_->integrator).at_onset);
}

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
  start.active.assign(std::size_t(w_->mechanism.joints().count()), 0);
  return assemble_from(start, t_s);
}

Assembly System::assemble_from(const BodiesState& near, double t_s) {
  w_->memory.recall({});
  Assembly assembly;
  assembly.state = near;
  BodiesState& state = assembly.state;
  Mechanism& mechanism = w_->mechanism;
  const auto contradict = [&](const std::string& how, int joint, double value) {
    assembly.contradiction = how + " joint '" + w_->joints[std::size_t(joint)].name + "'";
    for (int row = 0; row < mechanism.joints().count(); ++row) {
      if (state.active[std::size_t(row)] || mechanism.joints().joint_of(row) != joint) continue;
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
  if (worst > consistency_tolerance * (1.0 + mechanism.solved().velocity.cwiseAbs().maxCoeff())) {
    contradict("these joints ask for velocities that contradict each other:", joint, worst);
    return assembly;
  }
  assembly.degrees_of_freedom = mechanism.freedoms();
  std::vector<int> repeated(w_->joints.size(), 0);
  std::vector<std::string> others(w_->joints.size());
  for (int row = 0; row < mechanism.joints().count(); ++row) {
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
  state.work.assign(w_->sources.size() + EnergyBalance::count, 0.0);
  w_->memory.begin(t_s, state);
}

void System::recall(const BodiesState& state) { w_->memory.recall(state.memory); }

StepReport System::advance(BodiesState& state, double tick_s, std::int64_t ticks, int pieces, Remember end_memory) {
  Work& w = *w_;
  const double begin = double(state.tick) * tick_s, length = double(ticks) * tick_s;
  const double end = double(state.tick + ticks) * tick_s;
  for (bool known = w.knows(state, begin);; known = false) {
    w.met.assign(w.onsets.size(), {});
    const bool done = w.advance_pieces(state, begin, end, length, pieces, known);
    const Work::Needed needed = w.pieces_met(length);  // a step that failed may have failed for this
    if (needed.pieces > most_pieces) {
      w.report.value = length * most_pieces / needed.pieces, w.report.onset = needed.onset;
      w.fail(StepReport::Trouble::onset, -1);
      return w.report;
    }
    if (needed.pieces > pieces)
      pieces = int(needed.pieces);
    else if (done && (end_memory == Remember::nothing || w.remember(end, length / pieces)))
      break;
    else
      return w.report;
  }
  w.opened.tick = state.tick + ticks;
  std::swap(state, w.opened);
  return w.report;
}

const Evaluation& System::evaluate(const BodiesState& state, double t_s) {
  Work& w = *w_;
  Evaluation& e = w.evaluation;
  w.opened = state;
  w.memory.recall(w.opened.memory);
  e.report = w.open(w.opened, t_s, false);
  if (!e.report.ok()) return e;
  w.known.kinetic = w.kinetic_of_opened();
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(w.mechanism.freedoms());
  w.accelerations(t_s, zero, w.mechanism.open_velocity());
  e.report = w.report;
  if (!e.report.ok()) return e;
  const Eigen::VectorXd all = w.mechanism.solved().tangent * w.acceleration + w.mechanism.solved().bias;
  for (std::size_t b = 0; b < w.bodies.size(); ++b) {
    const auto k = Eigen::Index(6 * b);
    e.acceleration[b] = w.mechanism.length() * all.segment<3>(k);
    e.angular_acceleration[b] = w.mechanism.solved().poses[b].axes * all.segment<3>(k + 3);
    w.rates[b] << e.acceleration[b], e.angular_acceleration[b];
  }
  // M bias was taken off the forces above: out of balance = M a - F over all coordinates
  w.mass.multiply(all - w.mechanism.solved().bias, w.inertial);
  w.mechanism.reactions(w.inertial - w.force, e.joint_reactions);
  e.by_source = w.loads.by_source();
  w.mass.add_reactions(t_s, w.motions, w.rates, e.by_source);
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
      return body + ": mass plus added mass is not positive definite: look at its mass, inertia and added mass";
    case Trouble::stiff:
      return fmt::format(
          "bodies: loads or turns change faster than the step follows, {:.3g} s or so would: try a smaller time.step_s", r.value);
    case Trouble::energy:
      if (integrator() == Integrator::explicit_euler)
        return "bodies: explicit_euler has made " + fmt::format("{:.3g}", r.value) +
               " J, more than a tenth of what the loads have done on balance; take rk4 or symplectic (time.integrator)";
      return "bodies: the steps themselves have made " + fmt::format("{:.3g}", r.value) +
             " J, more than half of all work of the loads; try a smaller time.step_s";
    case Trouble::onset: {
      const Onset& onset = w_->onsets[std::size_t(r.onset)];
      return fmt::format(
          "{}: it snaps taut within the step, and swings with {:.3g} 1/s then; {} pieces of the step do not follow it, steps of "
          "{:.3g} s would: try a smaller time.step_s",
          onset.name, onset.rate, System::most_pieces, r.value);
    }
    case Trouble::too_far:
      return body + ": it is " + fmt::format("{:.4g} m away, the limit is {:.4g} m (radius of the earth)", r.value, farthest);
    case Trouble::too_fast:
      return body + ": its speed is " + fmt::format("{:.4g} m/s, the limit is {:.5g} m/s (escape velocity)", r.value, fastest);
  }
  return "";
}

NumericalFailure System::failure(const StepReport& r, const BodiesState& state, double tick_s) const {
  const double t = double(state.tick) * tick_s;
  const std::string place = r.onset >= 0   ? w_->onsets[std::size_t(r.onset)].name
                            : r.joint >= 0 ? w_->joints[std::size_t(r.joint)].name
                            : r.body >= 0  ? w_->bodies[std::size_t(r.body)].name
                                           : "bodies";
  return NumericalFailure("t = " + fmt::format("{:.3g}", t) + " s, tick " + std::to_string(state.tick) + ": " + describe(r),
                          place, long(state.tick), t, r.value);
}

StepReport System::open_chart(const BodiesState& state, double t_s) {
  w_->opened = state;
  w_->memory.recall({});
  return w_->open(w_->opened, t_s, false);
}
int System::freedoms() const { return w_->mechanism.freedoms(); }
const Eigen::VectorXd& System::chart_velocity() const { return w_->mechanism.open_velocity(); }
const StepReport& System::chart_report() const { return w_->report; }

bool System::rates(double t_s, const Eigen::VectorXd& x, const Eigen::VectorXd& u, Eigen::VectorXd& u_rate) {
  if (!w_->accelerations(t_s, x, u)) return false;
  u_rate = w_->acceleration;
  w_->mechanism.add_turning(u_rate);
  return true;
}

bool System::forces_at_rest(double t_s, const Eigen::VectorXd& x, Eigen::VectorXd& force, Eigen::MatrixXd& mass,
                            double* all_loads) {
  if (!w_->positions(t_s, x)) return false;
  w_->mechanism.solve_velocities(Eigen::VectorXd::Zero(freedoms()));
  w_->gather(t_s);
  w_->gather_forces(true);
  force.noalias() = w_->mechanism.solved().tangent.transpose() * w_->force;
  mass = w_->mass.condense(w_->mechanism.solved().tangent);
  if (all_loads) {
    *all_loads = 0.0;
    std::vector<Wrench> one(w_->bodies.size());
    for (const LoadSource& source : w_->sources) {
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
  Eigen::MatrixXd motion = w_->mechanism.solved().tangent;
  for (Eigen::Index b = 0; b < motion.rows() / 6; ++b) motion.middleRows<3>(6 * b) *= w_->mechanism.length();
  return motion;
}

}  // namespace spindrift::bodies
