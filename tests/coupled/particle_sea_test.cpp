// Scenes with a sea of particles as a user runs them: a dam breaks, a box floats, bodies are held and released, a run is
// interrupted and goes on bit for bit, fields are written, bad input is refused. SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "kernels/base/constants.hpp"
#include "runtime/replay/recording_file.hpp"
#include "src/coupling/sea_window.hpp"
#include "src/scene/error.hpp"
#include "tests/coupled/runs.hpp"

using namespace spindrift;
using namespace spindrift::coupling;
using Catch::Contains;

namespace {

std::string refusal(const std::string& file, const std::vector<std::string>& overrides) {
  try {
    scene::Document document = scene::load(test::input(file), overrides);
    FloatingSystem floating(read_scenario(document));
    require_stable(floating, stability(floating, make_start(floating).state));
  } catch (const scene::SceneError& e) { return e.what(); }
  return "";
}

const std::string dam = "validation/dam_break/koshizuka_oka.toml", box = "validation/floating_box/floating_box.toml";
/// A box small and coarse enough for a test, in seconds.
const std::vector<std::string> small_box{"sea.particles.spacing_m=0.08", "time.end_s=0.4", "time.window_s=0.04",
                                         "sea.initial.settle_s=0.2"};

}  // namespace

TEST_CASE("a dam breaks from a scene file: its front runs ahead of the measured one by less than a quarter of a metre",
          "[coupled][sea][fast]") {
  const test::Folder folder("dam");
  const io::Summary summary = test::run_scene(test::input(dam), {"sea.particles.spacing_m=0.1", "time.end_s=0.6"}, folder.path());
  CHECK(summary.exit_code == 0);
  const scene::Columns history = scene::read_columns((folder.path() / "history.csv").string());
  const scene::Columns measured = scene::read_columns(test::input("validation/dam_break/koshizuka_oka_front.csv"));
  int compared = 0;
  for (std::size_t n = 0; n < measured["time_s"].size(); ++n)
    for (std::size_t row = 0; row < history["time_s"].size(); ++row)
      if (std::abs(history["time_s"][row] - measured["time_s"][n]) < 0.01 && measured["time_s"][n] > 0.15) {
        // Six jittered starts: 0.14 ahead to 0.05 behind, each row within 0.04.
        CHECK(history["sea.x_max_m"][row] == Approx(measured["x_max_m"][n] + 0.1).margin(0.25));
        ++compared;
      }
  CHECK(compared >= 4);
  CHECK(history["sea.lost_particles"].back() == 0.0);
  CHECK(std::filesystem::exists(folder.path() / "fields" / "particles.xdmf"));
  CHECK(std::filesystem::exists(folder.path() / "fields" / "surface.xdmf"));
}

TEST_CASE("a body is held while the water settles, then released", "[coupled][sea][fast]") {
  const test::Folder folder("held");
  test::run_scene(test::input(box), small_box, folder.path());
  const scene::Columns history = scene::read_columns((folder.path() / "history.csv").string());
  const auto t = history["time_s"], z = history["box.z_m"];
  CHECK(t.front() == Approx(-0.2));
  for (std::size_t n = 0; n < t.size(); ++n)
    if (t[n] <= 0.0) CHECK(z[n] == z[0]);
  CHECK(z[0] == Approx(0.05));
  CHECK(z.back() < 0.04);
  // 50 mm too high it lacks 0.05 x 0.4 x 9810 N of its 785 N of buoyancy. Five jittered starts: 569 to 576 N.
  const auto force = history["box.sea.fz_N"];
  double held = 0.0;
  int rows = 0;
  for (std::size_t n = 0; n < t.size(); ++n)
    if (t[n] > -0.1 && t[n] <= 0.0) held += force[n], ++rows;
  CHECK(held / rows == Approx(785.0 - 196.0).margin(100.0));
}

TEST_CASE("every scheme runs from a scene file", "[coupled][sea][fast]") {
  using Overrides = std::vector<std::string>;
  const Overrides schemes =
      GENERATE(Overrides{"sea.particles.walls='modified_no_slip'", "sea.particles.viscosity_model='laminar_sps'"},
               Overrides{"sea.particles.step='verlet'", "sea.particles.verlet_join_every=20"},
               Overrides{"sea.particles.precision='double'", "sea.particles.density_filter='mls'"},
               Overrides{"sea.particles.shifting=2.0", "sea.particles.kernel='cubic_spline'"});
  const test::Folder folder("scheme");
  Overrides overrides = small_box;
  overrides.insert(overrides.end(), schemes.begin(), schemes.end());
  overrides.push_back("time.end_s=0.12");
  CHECK(test::run_scene(test::input(box), overrides, folder.path()).exit_code == 0);
  const scene::Columns history = scene::read_columns((folder.path() / "history.csv").string());
  CHECK(history["box.z_m"].back() < 0.05);  // four jittered starts of each: 0.0410 to 0.0439
  CHECK(history["box.z_m"].back() > 0.03);
}

TEST_CASE("waves by Verlet's step keep their energy with its defaults", "[coupled][sea][fast]") {
  const test::Folder folder("verlet");
  test::run_scene(test::input("validation/standing_wave/standing_wave.toml"),
                  {"sea.particles.step='verlet'", "sea.particles.spacing_m=0.04", "time.end_s=2.0"}, folder.path());
  const scene::Columns history = scene::read_columns((folder.path() / "history.csv").string());
  const auto kinetic = history["sea.kinetic_energy_J"], potential = history["sea.potential_energy_J"],
             compression = history["sea.compression_energy_J"], dissipated = history["sea.dissipated_J"];
  CHECK(std::ranges::max(kinetic) > 0.1);
  CHECK(std::ranges::max(kinetic) < 0.25);  // rho g a^2 / 4 per area; with the chains tied every 40 steps 255 J
  for (std::size_t n = 0; n < kinetic.size(); ++n)
    CHECK(std::abs(kinetic[n] + potential[n] + compression[n] + dissipated[n] - kinetic[0] - potential[0] - compression[0]) <
          4e-3);
}

TEST_CASE("steps that make energy out of nothing stop the run", "[coupled][sea][fast]") {
  const test::Folder folder("blown_up");
  const auto [cfl, join] = GENERATE(std::pair{"0.2", "40"}, std::pair{"0.6", "10"});
  const io::Summary summary =
      test::run_scene(test::input("validation/standing_wave/standing_wave.toml"),
                      {"sea.particles.step='verlet'", "sea.particles.spacing_m=0.04", "time.end_s=2.0",
                       std::string("sea.particles.cfl=") + cfl, std::string("sea.particles.verlet_join_every=") + join},
                      folder.path());
  CHECK(summary.exit_code == 3);
  CHECK_THAT(summary.exit_reason, Contains("J out of nothing") && Contains("sea.particles.cfl"));
}

TEST_CASE("a body that comes to lie on the bed is carried by its contact, named in the output", "[coupled][sea][fast]") {
  // 400 kg in the room of 160 kg of water: at rest the bed carries at least the difference, more where no water is left
  // underneath.
  const test::Folder folder("sunk");
  test::run_scene(test::input(box),
                  {"sea.particles.spacing_m=0.08", "time.end_s=3.0", "time.window_s=0.04", "bodies.box.mass_kg=400.0",
                   "bodies.box.inertia_kg_m2=[10.7, 10.7, 10.7]", "bodies.box.displacement_m=[0.0, 0.0, -0.36]",
                   "sea.initial.settle_s=0.2", "sea.tank.top_m=0.6"},
                  folder.path());
  const scene::Columns history = scene::read_columns((folder.path() / "history.csv").string());
  CHECK(test::mean_of_last(history, "box.contact.fz_N", 1.0) > 0.9 * 240.0 * 9.81);
  // Over 12 replicas, the box up to 12 mm aside and 3 mm higher or lower, the mean is 3924.01 N with a standard deviation of
  // 0.04 N; 25 of these.
  CHECK(test::mean_of_last(history, "box.sea.fz_N", 1.0) + test::mean_of_last(history, "box.contact.fz_N", 1.0) ==
        Approx(400.0 * 9.81).margin(1.0));
}

TEST_CASE("an interrupted sea of particles goes on bit for bit", "[coupled][sea][fast]") {
  const test::Folder whole("sea_whole"), parts("sea_parts");
  std::vector<std::string> watched = small_box;  // a mean over two and a half windows reaches over the interruption
  watched.push_back("sea.sensors=[{name='low', body='box', low_m=[-1.0, -1.0, -1.0], high_m=[1.0, 1.0, 0.0], mean_over_s=0.1}]");
  test::run_scene(test::input(box), watched, whole.path());
  run::RunSettings first{.until_s = 0.16, .quiet = true};
  test::run_scene(test::input(box), watched, parts.path(), first);
  test::run_scene(test::input(box), watched, parts.path(), {.restart = true, .quiet = true});
  CHECK(test::text_of(whole.path() / "history.csv") == test::text_of(parts.path() / "history.csv"));
}

TEST_CASE("what a run came to is told before its records are read, and too many of these are left alone", "[coupled][fast]") {
  const test::Folder folder("records"), recorded("recorded");
  std::optional<io::Summary> told;
  run::RunSettings settings{.trace = true, .quiet = true};
  settings.ended = [&](const io::Summary& summary) {
    told = summary;
    CHECK_FALSE(std::filesystem::exists(folder.path() / "trace.json.gz"));
  };
  const io::Summary traced = test::run_scene(test::input(box), small_box, folder.path(), settings);
  CHECK(std::filesystem::exists(folder.path() / "trace.json.gz"));
  REQUIRE(told);
  CHECK(told->counts == traced.counts);
  CHECK(told->statistics->rows == traced.statistics->rows);
  CHECK(told->parts.size() == traced.parts.size());
  CHECK(traced.efficiency.size() == 5);
  CHECK(told->efficiency.size() == 3);

  settings.trace = false, settings.most_in_table = 10, settings.windows = {1, 100};
  settings.record_graph = (folder.path() / "graph.jsonl").string();
  settings.ended = [&](const io::Summary&) { CHECK(std::filesystem::file_size(settings.record_graph) > 1000); };
  CHECK(test::run_scene(test::input(box), small_box, recorded.path(), settings).efficiency.size() == 3);
}

TEST_CASE("sensors of a scene: patches share out a body's load, a wall's pressure is that of its depth, run-up is over the body",
          "[coupled][sea][fast]") {
  const test::Folder folder("sensors");
  std::vector<std::string> watched = small_box;
  watched.insert(watched.end(),
                 {"sea.sensors=[{name='low', body='box', low_m=[-1.0, -1.0, -1.0], high_m=[1.0, 1.0, 0.0], mean_over_s=1e-9}, "
                  "{name='high', body='box', low_m=[-1.0, -1.0, 1e-9], high_m=[1.0, 1.0, 1.0], mean_over_s=1e-9}, "
                  "{name='wall', low_m=[1.0, 0.0, -0.5], high_m=[1.0, 0.0, -0.3]}]",
                  "sea.gauges=[{name='beside', point_m=[0.28, 0.0], body='box'}]"});
  CHECK(test::run_scene(test::input(box), watched, folder.path()).exit_code == 0);
  const scene::Columns history = scene::read_columns((folder.path() / "history.csv").string());
  const auto t = history["time_s"];
  for (std::size_t n = 1; n < t.size(); ++n) {  // the mean of the last step alone is the load of its middle
    CHECK(history["low.fz_N"][n] + history["high.fz_N"][n] == Approx(history["box.sea.fz_N"][n]).epsilon(1e-9));
    CHECK(history["low.fx_N"][n] + history["high.fx_N"][n] == Approx(history["box.sea.fx_N"][n]).margin(1e-6));
    // Five jittered starts: -2 to +4 % over all rows, their mean while the box is held 0 to +0.5 %.
    CHECK(history["wall.mean_pressure_Pa"][n] == Approx(0.4 * 9810.0).epsilon(0.06));
    const double waterline = history["box.z_m"][n] - 0.28 * std::sin(history["box.pitch_deg"][n] * radians_per_degree);
    CHECK(history["beside.run_up_m"][n] == Approx(history["beside.elevation_m"][n] - waterline).margin(1e-6));
  }
  double held = 0.0;  // while the box is held: once released it sinks, and the water rises
  for (std::size_t n = 0; n < t.size(); ++n)
    if (t[n] <= 0.0) held += history["wall.mean_pressure_Pa"][n];
  CHECK(held / double(std::count_if(t.begin(), t.end(), [](double x) { return x <= 0.0; })) ==
        Approx(0.4 * 9810.0).epsilon(0.02));
  CHECK_THAT(refusal(box, {"sea.sensors=[{name='a', low_m=[0.0, 0.0, -0.5], high_m=[0.1, 0.0, -0.3]}]"}),
             Contains("sea.sensors[0]") && Contains("flat along one axis"));
  CHECK_THAT(refusal(box, {"sea.sensors=[{name='a', body='bax', low_m=[-1.0, -1.0, -1.0], high_m=[1.0, 1.0, 1.0]}]"}),
             Contains("sea.sensors[0].body") && Contains("known: box"));
  CHECK_THAT(refusal(box, {"sea.sensors=[{name='a', body='box', low_m=[5.0, -1.0, -1.0], high_m=[6.0, 1.0, 1.0]}]"}),
             Contains("sea.sensors[0]") && Contains("nothing of the surface"));
}

TEST_CASE("water leaves through open sides and over the edge, counted apart from what slips through walls",
          "[coupled][sea][fast]") {
  const test::Folder open("open_side"), edge("over_edge");
  const auto run = [&](const std::string& spacing, const std::string& tank, const std::string& sides,
                       const test::Folder& folder) {
    CHECK(test::run_scene(test::input(dam), {spacing, "time.end_s=1.0", "sea.probes=[]", "sea.gauges=[]", tank, sides},
                          folder.path())
              .exit_code == 0);
    return scene::read_columns((folder.path() / "history.csv").string());
  };
  const scene::Columns flowing = run("sea.particles.spacing_m=0.1", "sea.tank.x_m=[0.0, 3.0]", "sea.tank.sides_x='open'", open);
  CHECK(flowing["sea.left_particles"].back() > 100.0);  // five jittered starts: 144 to 145
  CHECK(flowing["sea.x_max_m"].back() < 3.06);
  CHECK(flowing["sea.lost_particles"].back() == 0.0);
  const auto change = [&](const char* name) { return flowing[name].back() - flowing[name].front(); };
  const double kept = change("sea.kinetic_energy_J") + change("sea.potential_energy_J") + change("sea.compression_energy_J");
  CHECK(change("sea.left_J") != 0.0);
  CHECK(std::abs(kept + change("sea.dissipated_J") + change("sea.left_J") - change("sea.work_of_solids_J")) <
        0.03 * std::abs(change("sea.potential_energy_J")));
  const scene::Columns splashed = run("sea.particles.spacing_m=0.05", "sea.tank.x_m=[0.0, 1.6]", "sea.tank.top_m=-1.0", edge);
  CHECK(splashed["sea.left_particles"].back() > 0.0);  // five jittered starts: 11 to 26
  CHECK(splashed["sea.lost_particles"].back() == 0.0);
}

TEST_CASE("a body that comes over a side without a wall stops the run by its name", "[coupled][sea][fast]") {
  const std::string sides = GENERATE("sea.tank.sides_x='periodic'", "sea.tank.sides_x='open'");
  const test::Folder folder("over_side");
  std::vector<std::string> drifting = small_box;
  for (const std::string& more :
       {sides, std::string("bodies.box.displacement_m=[0.78, 0.0, 0.0]"), std::string("bodies.box.velocity_m_s=[1.0, 0.0, 0.0]")})
    drifting.push_back(more);
  const io::Summary summary = test::run_scene(test::input(box), drifting, folder.path());
  CHECK(summary.exit_code == 3);
  CHECK_THAT(summary.exit_reason, Contains("body box reaches x = 1.0") && Contains("sea.tank.sides_x"));
}

TEST_CASE("a sea starts from the state of another run", "[coupled][sea][fast]") {
  const test::Folder first("sea_first"), second("sea_second");
  test::run_scene(test::input(dam), {"sea.particles.spacing_m=0.1", "time.end_s=0.2"}, first.path());
  const std::string file = (first.path() / "checkpoints").string();
  std::string checkpoint;
  for (const auto& entry : std::filesystem::directory_iterator(file)) checkpoint = entry.path().string();
  test::run_scene(
      test::input(dam),
      {"sea.particles.spacing_m=0.1", "time.end_s=0.04", "sea.initial.state='file'", "sea.initial.file='" + checkpoint + "'"},
      second.path());
  const scene::Columns before = scene::read_columns((first.path() / "history.csv").string());
  const scene::Columns after = scene::read_columns((second.path() / "history.csv").string());
  CHECK(after["sea.x_max_m"].front() == before["sea.x_max_m"].back());
}

TEST_CASE("substeps share out what is left of a window and never exceed the limit", "[coupled][sea][fast]") {
  for (double limit : {7.9, 1000.0, 123456.7, 1e12}) {
    const std::int64_t window = limit < 10.0 ? 1000 : 16777216;
    std::int64_t left = window, steps = 0;
    while (left > 0) {
      const std::int64_t ticks = substep_ticks(left, limit);
      if (ticks < 2 || ticks % 2 != 0 || double(ticks) > limit) FAIL("a substep of " << ticks << " ticks, limit " << limit);
      left -= ticks, ++steps;
    }
    CHECK(left == 0);
    CHECK(steps == std::int64_t(std::ceil(0.5 * double(window) / std::floor(0.5 * limit))));
  }
  CHECK(substep_ticks(100, 1.9) == 0);
  CHECK(substep_ticks(2, 2.0) == 2);
}

TEST_CASE("substeps checked some at a time share out what is left of a window, the last as long as what is left",
          "[coupled][sea][fast]") {
  for (const int most : {1, 4, 7})
    for (double limit : {7.9, 1000.0, 123456.7}) {
      const std::int64_t window = limit < 10.0 ? 1000 : 16777216;
      std::int64_t left = window, steps = 0, checks = 0;
      for (; left > 0; ++checks) {
        const Substeps next = next_substeps(left, substep_ticks(left, limit), most);
        std::int64_t ticks = 0;
        for (int n = 0; n < next.count; ++n) {
          if (next.of(n) < 2 || next.of(n) % 2 != 0 || double(next.of(n)) > limit)
            FAIL("a substep of " << next.of(n) << " ticks");
          ticks += next.of(n);
        }
        CHECK(ticks == next.ticks());
        left -= ticks, steps += next.count;
      }
      CHECK(left == 0);
      CHECK(steps == std::int64_t(std::ceil(0.5 * double(window) / std::floor(0.5 * limit))));
      CHECK(checks == (steps + most - 1) / most);
    }
  const Substeps fixed = next_substeps(10, 2, 4);
  CHECK((fixed.count == 4 && fixed.each == 2 && fixed.last == 2));
}

TEST_CASE("limits checked every four substeps take a quarter of the reductions, and the box falls as it did",
          "[coupled][sea][fast]") {
  struct Run {
    double z_m;
    long substeps = 0, checks = 0, loads = 0;
  };
  const auto run_with = [](int every) {
    const test::Folder folder("limits");
    std::vector<std::string> overrides = small_box;
    overrides.insert(overrides.end(), {"time.end_s=0.12", "sea.particles.limits_every=" + std::to_string(every)});
    run::RunSettings settings{.quiet = true, .record_graph = (folder.path() / "graph.jsonl").string()};
    settings.windows = {{1, 3}};  // once released
    CHECK(test::run_scene(test::input(box), overrides, folder.path(), settings).exit_code == 0);
    Run run{scene::read_columns((folder.path() / "history.csv").string())["box.z_m"].back()};
    const runtime::Recording recording = runtime::read_recording(settings.record_graph);
    const runtime::RankRecording& rank = recording.ranks.at(0);
    CHECK(rank.runs.size() == 3);
    for (const runtime::RunRecord& window : rank.runs) {
      const auto& nodes = rank.graphs.at(window.graph).nodes;
      for (std::uint32_t n = 0; n < nodes.size(); ++n) {
        const auto skipped = window.skipped.find(n);
        const long made = long(window.ns[n].size()) - (skipped == window.skipped.end() ? 0 : long(skipped->second.size()));
        if (nodes[n].kind != runtime::NodeKind::reduce) continue;
        if (nodes[n].label == "sea/limits") run.checks += made;
        if (nodes[n].label == "sea/loads/begin") run.substeps += made;
        if (nodes[n].label.starts_with("sea/loads/")) run.loads += made;
      }
    }
    return run;
  };
  const Run one = run_with(1), four = run_with(4);
  CHECK(one.checks == one.substeps);
  CHECK(one.loads == 2 * one.substeps);
  CHECK(four.loads == 2 * four.substeps);  // none in steps that are not made
  CHECK(four.checks <= (four.substeps + 3 * 3) / 4);
  CHECK(four.checks >= four.substeps / 4);
  CHECK(four.substeps >= one.substeps);
  CHECK(double(four.substeps) <= 1.15 * double(one.substeps) + 3.0);
  CHECK(four.z_m == Approx(one.z_m).margin(0.004));  // jittered starts of "every scheme runs": 0.0410 to 0.0439
}

TEST_CASE("a body of half the water's weight whose particles have its own mass is lifted by half the force at first",
          "[coupled][sea][fast]") {
  const auto first_lift = [](const std::string& whose) {
    const test::Folder folder("own_mass");
    std::vector<std::string> overrides = small_box;
    overrides.insert(overrides.end(), {"time.end_s=0.04", "sea.particles.body_particles='" + whose + "'"});
    CHECK(test::run_scene(test::input(box), overrides, folder.path()).exit_code == 0);
    return scene::read_columns((folder.path() / "history.csv").string())["box.sea.fz_N"].front();
  };
  CHECK(first_lift("own") == Approx(0.5 * first_lift("water")).epsilon(0.1));  // of a few hundred particles
}

TEST_CASE("a paddle starts over two periods of its waves where the scene does not say", "[coupled][sea][fast]") {
  const auto growth = [](const std::string& tank, const std::vector<std::string>& overrides) {
    scene::Document document = scene::load(test::input(tank), overrides);
    return FloatingSystem(read_scenario(document)).particle_plan()->wavemaker->ramp_s;
  };
  const std::string tank = "validation/wave_tank/small_tank.toml";
  CHECK(growth(tank, {"waves.period_s=1.5", "without=['sea.wavemaker.ramp_s']"}) == 3.0);
  CHECK(growth(tank, {"waves.period_s=1.5", "sea.wavemaker.ramp_s=0.0"}) == 0.0);
  // Water that moves already has the waves whole.
  CHECK(growth(tank, {"sea.initial.state='waves'", "without=['sea.wavemaker.ramp_s']"}) == 0.0);
}

TEST_CASE("a paddle on a bed of its own makes waves by the depth there", "[coupled][sea][fast]") {
  const auto harmonics = [](const std::vector<std::string>& overrides) {
    scene::Document document = scene::load(test::input("validation/wave_tank/small_tank.toml"), overrides);
    const FloatingSystem floating(read_scenario(document));
    const auto all = floating.particle_plan()->paddle->harmonics();
    return std::vector<sph::Wavemaker::Harmonic>(all.begin(), all.end());
  };
  const auto shallow = harmonics({"environment.water_depth_m=0.3"}),
             on_shelf = harmonics({"environment.water_depth_m=0.6", "sea.tank.bed_m=[[0.0, -0.3], [6.0, -0.3], [9.0, -0.6]]"}),
             deep = harmonics({"environment.water_depth_m=0.6"});
  REQUIRE(shallow.size() == on_shelf.size());
  for (std::size_t n = 0; n < shallow.size(); ++n) {
    CHECK(on_shelf[n].amplitude == Approx(shallow[n].amplitude).epsilon(1e-9));
    CHECK(on_shelf[n].omega == shallow[n].omega);
    CHECK(on_shelf[n].phase == Approx(shallow[n].phase).margin(1e-9));
  }
  CHECK(std::abs(deep[0].amplitude / shallow[0].amplitude - 1.0) > 0.1);
}

TEST_CASE("a sea that begins in waves before t = 0 begins in those of then", "[coupled][sea][fast]") {
  const std::string state = GENERATE("waves", "standing");
  const double settle_s = 0.6, period = 2.0, amplitude = 0.05, omega = 2.0 * pi / period, spacing = 0.05;
  FloatingSystem floating(test::scenario_of(R"(
[time]
end_s = 1.0
window_s = 0.1
[environment]
gravity_m_s2 = 9.81
water_density_kg_m3 = 1000.0
water_depth_m = 1.0
[waves]
model = "airy"
height_m = 0.1
period_s = 2.0
phase_deg = 20.0
[sea]
model = "sph"
[sea.particles]
dimensions = "2"
spacing_m = 0.05
[sea.tank]
x_m = [0.0, 5.2152]
top_m = 0.5
sides_x = "periodic"
[sea.initial]
settle_s = 0.6
state = ")" + state + "\"\n"));
  const waves::Component wave = floating.particle_plan()->waves.front();
  floating.fill_sea({}, runtime::World{MPI_COMM_SELF, 0, 1});
  std::vector<std::array<double, 2>> places;
  for (double x = 0.5; x < 5.0; x += 0.5) places.push_back({x, 0.0});
  const std::vector<double> read = floating.particles()->surface(places);
  for (std::size_t n = 0; n < places.size(); ++n) {
    const double at = wave.wave_number * places[n][0] + wave.phase, turned = omega * settle_s;
    const double expected = state == "waves" ? amplitude * std::cos(at + turned) : amplitude * std::cos(at) * std::cos(turned);
    CHECK(read[n] == Approx(expected).margin(0.3 * spacing));
  }
}

TEST_CASE("bad seas of particles are refused by key before anything is made", "[coupled][sea][fast]") {
  CHECK_THAT(refusal(dam, {"sea.particles.spacing_m=1.0"}), Contains("sea.particles.spacing_m") && Contains("fewer than 4"));
  CHECK_THAT(refusal(dam, {"sea.tank.x_m=[4.0, 0.0]"}), Contains("sea.tank.x_m"));
  for (const std::string every : {"0", "21", "1.5"})
    CHECK_THAT(refusal(dam, {"sea.particles.limits_every=" + every}), Contains("sea.particles.limits_every"));
  CHECK_THAT(refusal(dam, {"sea.probes[0].point_m=[9.0, 0.0, 0.0]"}),
             Contains("sea.probes[0].point_m") && Contains("outside the tank"));
  CHECK_THAT(
      refusal(
          dam,
          {"sea.water=[{low_m=[0.0, -9.0, -9.0], high_m=[1.0, 9.0, 0.0]}, {low_m=[0.9, -9.0, -9.0], high_m=[1.5, 9.0, -0.5]}]"}),
      Contains("sea.water[1]") && Contains("overlaps sea.water[0]"));
  CHECK_THAT(refusal(dam, {"time.step_s=0.01"}), Contains("time.step_s") && Contains("speed of sound"));
  CHECK_THAT(refusal(dam, {"waves.model='airy'", "waves.height_m=0.1", "waves.period_s=2.0"}),
             Contains("waves.model") && Contains("wavemaker"));
  const std::string standing = "validation/standing_wave/standing_wave.toml", tank = "validation/wave_tank/small_tank.toml";
  CHECK_THAT(refusal(standing, {"waves.model='stokes2'"}), Contains("sea.initial.state") && Contains("stokes2"));
  CHECK_THAT(refusal(tank, {"sea.tank.bed_m=[[0.0, 0.0], [6.0, -0.3]]"}),
             Contains("sea.tank.bed_m") && Contains("below still water at the paddle"));
  CHECK_THAT(refusal(dam, {"sea.wavemaker.ramp_s=1.0"}), Contains("sea.wavemaker") && Contains("no wave"));
  CHECK_THAT(refusal(box, {"sea.particles.dimensions='3'"}), Contains("sea.tank.y_m"));
  CHECK_THAT(refusal(dam, {"sea.particles.walls='modified'", "sea.tank.bed_m=[[0.0, -2.0], [4.0, -1.5]]"}),
             Contains("sea.particles.walls") && Contains("slopes"));
  CHECK_THAT(refusal(dam, {"sea.particles.kinematic_viscosity_m2_s=1e-5"}), Contains("kinematic_viscosity_m2_s"));
  CHECK_THAT(refusal(box, {"bodies.box.boxes[0].centre_m=[0.0, 0.0, -0.5]"}),
             Contains("bodies.box") && Contains("below the bed"));
  CHECK_THAT(refusal(box, {"bodies.box.boxes[0].centre_m=[0.9, 0.0, 0.0]"}), Contains("in a wall"));
  CHECK_THAT(refusal(box, {"bodies.box.boxes[0].centre_m=[0.9, 0.0, 0.0]", "sea.tank.sides_x='periodic'"}),
             Contains("bodies.box") && Contains("a side of the tank that repeats (sea.tank.sides_x)"));
  CHECK_THAT(refusal(box, {"sea.model='hydrostatic'"}), Contains("has no effect"));
  CHECK_THAT(refusal(box, {"sea.initial.settle_s=1.01"}), Contains("settle_s") && Contains("windows"));
}
