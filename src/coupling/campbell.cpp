// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/campbell.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "kernels/base/constants.hpp"
#include "kernels/coupling/loose_limits.hpp"
#include "kernels/linear/dense.hpp"
#include "src/aero/operation.hpp"
#include "src/aero/turbine.hpp"
#include "src/bodies/mode_names.hpp"
#include "src/scene/models.hpp"

namespace spindrift::coupling {

namespace {

bool near(double a, double b) { return a > 0.0 && b > 0.0 && std::abs(a - b) <= close * std::min(a, b); }

double waves_at(double wind) {
  const auto above = std::find_if(sea_states.begin(), sea_states.end(), [wind](const SeaState& s) { return s.wind_m_s >= wind; });
  if (above == sea_states.begin()) return 1.0 / above->period_s;
  if (above == sea_states.end()) return 1.0 / sea_states.back().period_s;
  const SeaState &b = *above, &a = *(above - 1);
  const double x = (wind - a.wind_m_s) / (b.wind_m_s - a.wind_m_s);
  return (1.0 - x) / a.period_s + x / b.period_s;
}

void find_pairs(CampbellRow& row, const Campbell& c) {
  const std::pair<std::string, double> rotor[2] = {{"1P", row.once}, {fmt::format("{}P", c.blades), row.passing}};
  for (const auto& [name, f] : rotor)
    if (near(f, row.wave)) row.together.push_back(fmt::format("{} and waves", name));
  for (const auto& [mode, natural] : c.platform) {
    for (const auto& [name, f] : rotor)
      if (near(f, natural)) row.together.push_back(fmt::format("{} and {}", name, mode));
    if (near(row.wave, natural)) row.together.push_back(fmt::format("waves and {}", mode));
  }
}

}  // namespace

int blades_of(const Scenario& s) { return s.rotor.turbine.empty() ? 3 : aero::read_turbine(s.rotor.turbine).blades; }

Campbell campbell(const Scenario& s, const bodies::Linearisation& linearisation, double speed) {
  Campbell c;
  c.blades = blades_of(s);
  for (const bodies::Mode& mode : linearisation.modes)
    if (std::abs(mode.eigenvalue.imag()) > 1e-6 && mode.damping_ratio() < 1.0)
      c.platform.emplace_back(mode.name, 1.0 / mode.period_s());
  aero::Operation operation;
  if (!s.rotor.operation.empty()) operation = aero::read_operation(s.rotor.operation);
  const auto once = [&](double wind) { return std::abs(operation.speed.empty() ? speed : operation.at(wind).speed) / (2 * pi); };
  for (const SeaState& sea : sea_states)
    c.rows.push_back({fmt::format("sea state {}", sea.number),
                      sea.wind_m_s,
                      sea.height_m,
                      1.0 / sea.period_s,
                      once(sea.wind_m_s),
                      c.blades * once(sea.wind_m_s),
                      {}});
  const double own = std::abs(speed) / (2 * pi);
  c.rows.push_back({"this scene",
                    s.wind.speed_m_s,
                    s.has_waves() ? s.waves.height_m : 0.0,
                    s.has_waves() && s.waves.period_s > 0.0 ? 1.0 / s.waves.period_s : 0.0,
                    own,
                    c.blades * own,
                    {}});
  for (CampbellRow& row : c.rows) find_pairs(row, c);
  double before = 0.0;
  constexpr double step = 0.05;
  for (double wind = sea_states.front().wind_m_s; wind <= sea_states.back().wind_m_s; wind += step) {
    const double ahead = once(wind) - waves_at(wind);
    if (before * ahead < 0.0) c.meets_waves_m_s.push_back(wind - step * ahead / (ahead - before));
    before = ahead;
  }
  return c;
}

namespace {

/// Of flat blades that move along the rotor's axis: pi/4 rho chord^2 per length across the chord, by strips (Theodorsen 1935).
double blades_added_mass(const Scenario& s) {
  if (s.rotor.turbine.empty()) return 0.0;
  const aero::Turbine turbine = aero::read_turbine(s.rotor.turbine);
  const aero::Planform& p = turbine.planform;
  const auto of_length = [&](std::size_t n) {
    const double across = p.chord[n] * std::cos(p.twist[n] + s.rotor.blade_pitch);
    return 0.25 * pi * s.environment.air_density_kg_m3 * across * across;
  };
  double mass = 0.0;
  for (std::size_t n = 1; n < p.span.size(); ++n) mass += 0.5 * (of_length(n - 1) + of_length(n)) * (p.span[n] - p.span[n - 1]);
  return turbine.blades * mass;
}

}  // namespace

double missed_part(const Staggering& scheme, double omega, double window) {
  using Phasor = std::complex<double>;
  const auto v = [&](double n) { return std::exp(Phasor(0.0, omega * window * n)); };  // at whole windows from now
  // Load at the end of the window that ends n windows from now, as the scheme has it from the motion it gives the rotor.
  const auto y = [&](double n) {
    if (scheme.holds_motion()) return v(n - 1);
    return scheme.extrapolates_motion() ? 2.0 * v(n - 1) - v(n - 2) : v(n);
  };
  const int load_order = scheme.load_order;
  double worst = 0.0;
  for (const double x : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    Phasor assumed = y(0);
    if (load_order == 1) assumed += x * (y(0) - y(-1));
    if (load_order == 2) assumed = 0.5 * (x + 1) * (x + 2) * y(0) - x * (x + 2) * y(-1) + 0.5 * x * (x + 1) * y(-2);
    worst = std::max(worst, std::abs(assumed - v(x)));
  }
  return worst;
}

namespace {

/// Windows that are tried: beyond the longest of them no scheme is of use.
constexpr double longest_window = 50.0;

/// The floating system about the state under a load of the rotor that stays as it is, in earth axes at the hub, and what the load
/// makes of the hub's motion, in accelerations of the chart: the difference of two linearisations.
LooseLoop loop_of(FloatingSystem& floating, const bodies::BodiesState& state, const bodies::Linearisation& linearisation) {
  const MeanLoads mean(floating);
  const aero::RotorLoads& rotor = *floating.rotor();
  std::vector<Wrench> loads(state.motions.size());
  rotor.add_mean_loads(0.0, state.motions, loads);
  Wrench load;
  const Eigen::Vector3d hub = rotor.state(0.0, state.motions).hub;
  for (const Wrench& w : loads) load += w;
  load = load.about(hub);
  floating.replace_rotor_loads([&](double, std::span<const Motion> bodies, std::span<Wrench> wrenches) {
    rotor.bearing().add_load(bodies, wrenches, load.force, load.moment);
  });
  LooseLoop loop{linearise(floating.multibody(), state, 0.0).matrix, {}, {}};
  floating.replace_rotor_loads({});
  const Eigen::Index n = linearisation.matrix.rows() / 2;
  if (loop.matrix.rows() != 2 * n) return {};
  const dense::SingularValues parts = dense::singular_values((linearisation.matrix - loop.matrix).bottomRows(n));
  constexpr double small = 1e-6;  // of the largest: round-off of the differences
  Eigen::Index rank = 0;
  while (rank < n && parts.values[rank] > small * parts.values[0]) ++rank;
  loop.input = Eigen::MatrixXd::Zero(2 * n, rank), loop.input.bottomRows(n) = parts.left.leftCols(rank);
  loop.output = parts.values.head(rank).asDiagonal() * parts.right.leftCols(rank).transpose();
  return loop;
}

/// Growth that is not the scheme's: of the system itself, of free directions by round-off, a hundredth of the rotor's damping.
double own_growth(const bodies::Linearisation& linearisation, double slope, double mobility) {
  double rate = 0.0, fastest = 0.0;
  for (const bodies::Mode& mode : linearisation.modes)
    rate = std::max(rate, mode.eigenvalue.real()), fastest = std::max(fastest, std::abs(mode.eigenvalue));
  return rate + std::max(0.01 * slope * mobility, 1e-4 * fastest);
}

}  // namespace

LooseVerdict loose_verdict(FloatingSystem& floating, const bodies::BodiesState& state, const Campbell& campbell,
                           const bodies::Linearisation& linearisation) {
  LooseVerdict verdict;
  const aero::RotorLoads& rotor = *floating.rotor();
  aero::RotorState hub = rotor.state(0.0, state.motions);
  bodies::System& system = floating.multibody();
  if (!system.open_chart(state, 0.0).ok() || system.freedoms() == 0) return verdict;
  const std::string& body = floating.scenario().rotor.body;
  double mobility = 0.0;
  for (std::size_t b = 0; b < system.bodies().size(); ++b) {
    if (system.bodies()[b].name != body) continue;
    const bodies::Pull thrust{b, hub.hub, hub.axis};
    mobility = bodies::mobility(system, state, std::span(&thrust, 1));
    verdict.hub_mass_kg = mobility > 0.0 ? 1.0 / mobility : std::numeric_limits<double>::infinity();
  }
  constexpr double change = 0.1;  // m/s either side
  double thrust[2];
  for (int side = 0; side < 2; ++side) {
    aero::RotorState moved = hub;
    moved.hub_velocity += (side ? change : -change) * hub.axis;
    moved.relative_wind = aero::relative_wind(rotor.wind(), 0.0, hub.hub, moved.hub_velocity, hub.axis);
    thrust[side] = rotor.load(0.0, moved).force.dot(hub.axis);
  }
  verdict.slope_N_s_m = (thrust[0] - thrust[1]) / (2 * change);
  for (const auto& [name, f] : campbell.platform)
    if (!bodies::stretches_or_twists(name)) verdict.fastest_Hz = std::max(verdict.fastest_Hz, f);
  verdict.fastest_Hz = std::max({verdict.fastest_Hz, campbell.rows.back().wave, campbell.rows.back().passing});

  const double window = floating.timeline().window_s(), omega = 2 * pi * verdict.fastest_Hz;
  const double slope = verdict.slope_N_s_m;
  const LooseLoop loop =
      slope > 0.0 && mobility > 0.0 && linearisation.report.ok() ? loop_of(floating, state, linearisation) : LooseLoop{};
  const bool damped = loop.input.cols() > 0;
  verdict.air_mass_kg = blades_added_mass(floating.scenario());
  for (const CouplingScheme* scheme : coupling_schemes()) {
    if (scheme->staggering == nullptr) continue;
    const bool chosen = scheme == &of(floating.scenario().coupling.scheme);  // others by the default options
    const CouplingOptions options = chosen ? floating.scenario().coupling : CouplingOptions();
    const double mass_limit = stability_ratio([&](double ratio) { return scheme->added_mass(options, ratio); });
    const double limit = damped ? window_limit(loop, scheme->staggering(options), own_growth(linearisation, slope, mobility),
                                               window / 20.0, longest_window)
                                : std::numeric_limits<double>::infinity();
    const double missed = missed_part(scheme->staggering(options), omega, window);
    const bool stable = window <= 0.5 * limit && verdict.mass_ratio() <= 0.5 * mass_limit;
    verdict.schemes.push_back({scheme->judged(options), limit, missed, mass_limit, stable && missed <= acceptable});
  }
  return verdict;
}

}  // namespace spindrift::coupling
