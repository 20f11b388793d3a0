// Rules between the sections of the sea of a scene: declared in engineering_sea.hpp and
// wave_field.hpp. SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "kernels/base/constants.hpp"
#include "kernels/waves/stokes.hpp"
#include "src/scene/error.hpp"
#include "src/sea/engineering_sea.hpp"
#include "src/sea/wave_model.hpp"

namespace spindrift::sea {
namespace {

std::string text(const char* format, double a, double b) {
  char line[240];
  std::snprintf(line, sizeof line, format, a, b);
  return line;
}

std::string listed(const std::string& list, const std::string& name) { return list.empty() ? name : list + ", " + name; }

bool has_cylinder(const SeaBody& body, const std::string& name) {
  return std::any_of(body.cylinders.begin(), body.cylinders.end(), [&](const NamedCylinder& c) { return c.name == name; });
}

/// Height of the lowest point of an end disc [m].
double lowest(const Motion& motion, const Eigen::Vector3d& centre, const Cylinder& shape, double radius) {
  const double up = (motion.attitude * shape.axis()).z();
  return motion.point(centre).z() - radius * std::sqrt(std::max(0.0, 1.0 - up * up));
}

void check_shapes(const SeaBody& body, double depth, std::vector<OptionProblem>& problems) {
  for (std::size_t i = 0; i < body.cylinders.size(); ++i) {
    const Cylinder& shape = body.cylinders[i].shape;
    const std::string key = "bodies." + body.name + ".cylinders[" + std::to_string(i) + "]";
    if (!(shape.length() > 0.0)) {
      problems.push_back({key, "has no length: its start and end are the same point"});
      continue;
    }
    const double low = std::min(lowest(body.initial, shape.start, shape, shape.start_radius),
                                lowest(body.initial, shape.end, shape, shape.end_radius));
    if (low >= -depth - 1e-6 * std::max(1.0, depth)) continue;  // a pile ends on the bed but for round-off
    problems.push_back({key, text("reaches down to z = %.4g m, below the sea bed at z = %.4g m", low, -depth)});
  }
}

void check_potential(const PotentialOptions& o, const WavesOptions& waves, std::vector<OptionProblem>& problems) {
  const auto attempt = [&](const char* key, const std::string& path, auto read) {
    if (path.empty()) return;
    try {
      read(path, WamitScale{});
    } catch (const scene::SceneError& e) { problems.push_back({std::string("sea.potential.") + key, e.what()}); }
  };
  attempt("radiation_file", o.radiation_file, read_radiation);
  attempt("excitation_file", o.excitation_file, read_excitation);
  attempt("hydrostatics_file", o.hydrostatics_file, read_hydrostatics);
  if (o.drift == "full")
    attempt("drift_file", o.drift_file, [](const std::string& path, const WamitScale& scale) {
      return read_quadratic(path, scale, FrequencyPair::difference);
    });
  else
    attempt("drift_file", o.drift_file, read_drift);
  attempt("sum_frequency_file", o.sum_frequency_file,
          [](const std::string& path, const WamitScale& scale) { return read_quadratic(path, scale, FrequencyPair::sum); });
  if (waves.model == "none") {
    if (o.drift != "none") problems.push_back({"sea.potential.drift", "has no effect: there are no waves"});
    if (!o.sum_frequency_file.empty())
      problems.push_back({"sea.potential.sum_frequency_file", "has no effect: there are no waves"});
    return;
  }
  const bool pairs = o.drift == "full" || !o.sum_frequency_file.empty();
  if (pairs && waves.components > int(SecondOrderLoads::most_components))
    problems.push_back(
        {"waves.components", "must be at most " + std::to_string(SecondOrderLoads::most_components) +
                                 " with loads of pairs of frequencies (sea.potential.drift \"full\", sum_frequency_file)"});
  if (o.excitation_file.empty()) problems.push_back({"sea.potential.excitation_file", "must be given: there are waves"});
  if (waves.spreading_exponent && (pairs || o.drift == "newman"))
    problems.push_back({"waves.spreading_exponent",
                        "must not be given with loads of pairs of waves (sea.potential.drift "
                        "\"newman\" and \"full\", sum_frequency_file): they know one direction"});
  if (waves.second_order)
    problems.push_back(
        {"waves.second_order",
         "must not be given with sea.model 'potential', which is linear in the waves; its own loads of second order "
         "are sea.potential.drift and sum_frequency_file"});
  if (wave_models().named(waves.model).nonlinear)
    problems.push_back(
        {"waves.model", "must not be '" + waves.model + "': sea.model 'potential' is linear in the waves; use 'airy'"});
}

}  // namespace

std::vector<OptionProblem> sea_problems(const SeaOptions& options, const WavesOptions& waves,
                                        const std::vector<SeaBody>& bodies) {
  if (options.model == "none" || options.has_particles()) return {};  // particles: particle_problems
  std::vector<OptionProblem> problems;
  std::string cylinders, names;
  for (const SeaBody& body : bodies) {
    names = listed(names, body.name);
    for (const NamedCylinder& c : body.cylinders) cylinders = listed(cylinders, c.name);
  }
  const bool needs_cylinders =
      !(options.model == "potential" && options.potential && !options.potential->hydrostatics_file.empty());
  if (cylinders.empty() && needs_cylinders)
    problems.push_back(
        {"sea.model", "is '" + options.model + "', but no body has [[bodies.NAME.cylinders]] for the water to act on"});
  if (cylinders.empty() && !needs_cylinders) {
    const SeaOptions plain;
    for (const auto& [key, asked] :
         {std::pair{"drag_coefficient", options.drag_coefficient != plain.drag_coefficient},
          std::pair{"axial_drag_coefficient", options.axial_drag_coefficient != plain.axial_drag_coefficient},
          std::pair{"strip_length_m", options.strip_length_m != plain.strip_length_m}})
      if (asked) problems.push_back({std::string("sea.") + key, "has no effect: no body has [[bodies.NAME.cylinders]]"});
  }
  if (options.model == "hydrostatic" && waves.model != "none")
    problems.push_back(
        {"waves.model", "is '" + waves.model + "', but sea.model 'hydrostatic' knows still water only; use 'morison'"});
  for (std::size_t i = 0; i < options.coefficients.size(); ++i) {
    const std::string& name = options.coefficients[i].cylinder;
    if (std::none_of(bodies.begin(), bodies.end(), [&](const SeaBody& b) { return has_cylinder(b, name); }))
      problems.push_back({"sea.coefficients[" + std::to_string(i) + "].cylinder",
                          "names '" + name + "', which no body has; known: " + cylinders});
    for (std::size_t j = 0; j < i; ++j)
      if (options.coefficients[j].cylinder == name)
        problems.push_back({"sea.coefficients[" + std::to_string(i) + "].cylinder",
                            "names '" + name + "', which has its coefficients from sea.coefficients[" + std::to_string(j) + "]"});
    if (options.coefficients[i].diffraction == "none") continue;
    const std::string key = "sea.coefficients[" + std::to_string(i) + "].diffraction";
    if (options.model == "potential") problems.push_back({key, "has no effect: sea.model is \"potential\"", "sea.model"});
    constexpr double most_degrees = 10.0;
    for (const SeaBody& body : bodies)
      for (const NamedCylinder& c : body.cylinders) {
        const Eigen::Vector3d along = c.shape.axis();
        const double lean = std::acos(std::min(1.0, std::abs(along.z()))) / radians_per_degree;
        if (c.name == name && lean > most_degrees)
          problems.push_back(
              {key, fmt::format("is of upright columns, up to {:g} degrees; '{}' leans by {:.3g}", most_degrees, name, lean)});
      }
    if (waves.model == "none")
      problems.push_back({key, "has no effect: there are no waves"});
    else if (wave_models().named(waves.model).nonlinear)
      problems.push_back({key, "is linear in the waves: waves.model must not be '" + waves.model + "'"});
    else if (waves.second_order)
      problems.push_back({key, "is linear in the waves: waves.second_order must be false"});
  }
  const auto check_body = [&](const std::string& key, const std::string& name) {
    if (std::none_of(bodies.begin(), bodies.end(), [&](const SeaBody& b) { return b.name == name; }))
      problems.push_back({key, "names '" + name + "', which is not in [bodies]; known: " + names});
  };
  for (std::size_t i = 0; i < options.gauges.size(); ++i) {
    const std::string key = "sea.gauges[" + std::to_string(i) + "]";
    if (waves.model == "none") problems.push_back({key, "has no effect: there are no waves", "waves.model"});
    if (!options.gauges[i].body.empty()) check_body(key + ".body", options.gauges[i].body);
  }
  for (std::size_t i = 0; i < options.matrices.size(); ++i)
    check_body("sea.matrices[" + std::to_string(i) + "].body", options.matrices[i].body);
  if (options.model == "potential" && options.potential) {
    check_body("sea.potential.body", options.potential->body);
    check_potential(*options.potential, waves, problems);
  }
  for (std::size_t i = 0; i < options.damping.size(); ++i) {
    const std::string& name = options.damping[i].body;
    if (std::none_of(bodies.begin(), bodies.end(), [&](const SeaBody& b) { return b.name == name; }))
      problems.push_back(
          {"sea.damping[" + std::to_string(i) + "].body", "names '" + name + "', which is not in [bodies]; known: " + names});
  }
  return problems;
}

std::vector<OptionProblem> shape_problems(const SeaEnvironment& environment, const std::vector<SeaBody>& bodies) {
  std::vector<OptionProblem> problems;
  for (const SeaBody& body : bodies) check_shapes(body, environment.water_depth, problems);
  return problems;
}

std::vector<OptionProblem> wave_problems(const WavesOptions& options, const SeaEnvironment& environment) {
  if (options.model == "none") return {};
  if (!(environment.gravity > 0.0)) return {{"environment.gravity_m_s2", "must be > 0 with [waves], which are waves of gravity"}};
  std::vector<OptionProblem> problems;
  const WaveModel& model = wave_models().named(options.model);
  if (std::ranges::find(model.keys, "height_m") == model.keys.end()) {  // a record
    if (model.check) model.check(options, environment, problems);
    return problems;
  }
  if (options.height_m <= 0.0) problems.push_back({"waves.height_m", "must be given and positive"});
  if (options.period_s <= 0.0) problems.push_back({"waves.period_s", "must be given and positive"});
  if (!problems.empty()) return problems;
  const auto wave = waves::wave_properties(options.period_s, environment.water_depth, environment.gravity);
  // Highest wave before it breaks, after Miche (1944), for regular waves; half of it for the significant height of a sea.
  const double breaking = 0.142 * wave.length * std::tanh(wave.relative_depth), most = model.regular ? breaking : 0.5 * breaking;
  if (options.height_m > most)
    problems.push_back(
        {"waves.height_m",
         model.regular
             ? text("is %.4g m, but a wave of this period breaks above %.4g m in this depth (Miche 1944)", options.height_m, most)
             : text("is %.4g m, but a sea state goes up to %.4g m here: half the height at which a wave of "
                    "this period breaks (Miche 1944)",
                    options.height_m, most)});
  if (model.check) model.check(options, environment, problems);
  return problems;
}

}  // namespace spindrift::sea
