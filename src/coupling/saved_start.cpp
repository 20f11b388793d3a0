// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/saved_start.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include "src/io/machine_failure.hpp"
#include "src/scene/error.hpp"

namespace spindrift::coupling {

aero::BladedLibrary* library_of(const FloatingSystem& floating) {
  const aero::TurbineControl* control = floating.rotor() ? floating.rotor()->control() : nullptr;
  return control ? control->library() : nullptr;
}

void refuse_saved(const Scenario& scenario, const NamedState& named, const std::string& why) {
  throw scene::SceneError({{scenario.source, 0, named.key, "\"" + named.file + "\"", why}});
}

io::CheckpointReader open_saved(MPI_Comm comm, const Scenario& scenario, const NamedState& named) {
  const std::filesystem::path path(named.file);
  try {
    if (path.extension() == ".h5") return {comm, path};
    if (auto newest =
            io::CheckpointSeries(comm, path.parent_path() / "checkpoints", 1).newest(io::CheckpointSeries::Damaged::leave))
      return std::move(*newest);
  } catch (const io::InputError& e) { refuse_saved(scenario, named, e.what()); } catch (const io::DamagedFile& e) {
    refuse_saved(scenario, named, e.what());
  }
  refuse_saved(scenario, named, "there is no checkpoint of a run beside it, or none that is whole");
}

SavedStart open_start(MPI_Comm comm, const FloatingSystem& floating, const bodies::BodiesState& like) {
  const Scenario& s = floating.scenario();
  const NamedState named{"start.file", s.start.file};
  io::CheckpointReader file = open_saved(comm, s, named);
  const auto refuse = [&](const std::string& why) { refuse_saved(s, named, fmt::format("{}: {}", file.path().string(), why)); };
  if (!file.has(bodies_name)) refuse("holds no bodies: it is that of a run of the air alone");

  const Timeline& timeline = floating.timeline();
  const double t = file.number("time_s");
  const std::optional<std::int64_t> windows = t == 0.0 ? std::optional<std::int64_t>(0) : whole_ratio(t, timeline.window_s());
  if (!windows)
    refuse(fmt::format("its state is that of t = {:g} s, which is no whole number of windows of {:g} s", t, timeline.window_s()));
  if (*windows >= timeline.windows())
    refuse(fmt::format("its state is that of t = {:g} s, the run ends at {:g} s", t, timeline.window_end_s(timeline.windows())));

  bodies::BodiesState workless = like;  // work is counted anew, which may have other sources of load here
  workless.work.clear();
  if (file.size(bodies_name) != std::int64_t(workless.packed_size()) + file.integer("bodies/works"))
    refuse("its bodies and joints are not those of this scene");
  if (s.sea.potential && s.sea.potential->radiation == "convolution" && file.has(step_of_bodies)) {
    const double was = file.read<double>(step_of_bodies).at(0), is = timeline.tick_s();
    if (std::abs(was - is) > 1e-9 * is)
      refuse(
          fmt::format("its water remembers the bodies at steps of {:g} s (sea.potential.radiation \"convolution\"), here they "
                      "are of {:g} s",
                      was, is));
  }
  if (library_of(floating) && !file.has(library_log)) refuse("no controller library (control.library) had its rotor");
  if (s.resolves_air() && !file.has("flow/tiles")) refuse("its air is not resolved");
  if (floating.particle_plan() && !file.has(particles_name)) refuse("its sea has no particles");
  return {std::move(file), t, *windows};
}

io::CheckpointReader open_sea(MPI_Comm comm, const FloatingSystem& floating) {
  const Scenario& s = floating.scenario();
  const NamedState named{"sea.initial.file", s.sea.initial->file};
  io::CheckpointReader file = open_saved(comm, s, named);
  if (!file.has(particles_name)) refuse_saved(s, named, file.path().string() + ": its sea has no particles");
  return file;
}

std::string other_sea(const io::CheckpointReader& file, std::int64_t values) {
  const std::int64_t has = file.size(particles_name);
  return has == values ? ""
                       : fmt::format("{}: its sea has {} values of particles, this one {}", file.path().string(), has, values);
}

}  // namespace spindrift::coupling
