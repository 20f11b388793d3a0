// [aero], [rotor], [wind]: what is read, and what is refused with which words.
// SPDX-License-Identifier: Apache-2.0
#include "src/aero/options.hpp"

#include <catch2/catch.hpp>

#include "src/scene/document.hpp"
#include "tests/src/aero/data_file.hpp"

using namespace spindrift;
using namespace spindrift::aero;
using Catch::Matchers::Contains;

namespace {

struct Sections {
  AeroOptions aero;
  RotorOptions rotor;
  WindOptions wind;
};

Sections read_sections(const std::string& text) {
  const std::vector<std::string> bodies{"platform", "rotor"}, joints{"bearing"};
  scene::Document doc = scene::parse(text, "test.toml", std::filesystem::temp_directory_path());
  const Sections all{doc.read(aero_section()), doc.read(rotor_section()), doc.read(wind_section())};
  check_rotor(doc, all.aero, all.rotor, bodies, joints);
  doc.finish();
  return all;
}

const std::string rotor = "[rotor]\nbody = 'rotor'\njoint = 'bearing'\ndiameter_m = 178.33\n";

}  // namespace

TEST_CASE("the declarations of rotor, air and wind are sound in themselves", "[aero][fast]") {
  CHECK(aero_section().faults().empty());
  CHECK(rotor_section().faults().empty());
  CHECK(wind_section().faults().empty());
}

TEST_CASE("a scene without a rotor is legal, and so is each model with what it needs", "[aero][fast]") {
  CHECK(read_sections("").aero.model == "none");
  CHECK(read_sections(rotor + "[aero]\nmodel = 'prescribed'\nthrust_N = 1.5e6\n").aero.thrust_N == 1.5e6);
  CHECK(read_sections(rotor +
                      "[aero]\nmodel = 'thrust_curve'\nthrust_coefficient = 0.8\n[wind]\nspeed_m_s = 11\ndirection_deg = 90\n")
            .wind.direction == Approx(1.5707963));
  CHECK(read_sections("[rotor]\nbody = 'platform'\nhub_m = [0, 0, 119]\nspeed_rpm = 9.549296585513721\n").rotor.speed ==
        Approx(1.0));
}

TEST_CASE("a rotor that its model cannot use is refused with what is wrong", "[aero][fast]") {
  struct Case {
    std::string text, message;
  };
  const std::string table = data_file("options.csv", "time_s,thrust_N\n0,1\n1,1\n");
  const auto c = GENERATE_COPY(
      Case{"[aero]\nmodel = 'prescribed'\nthrust_N = 1\n", "must name the body"},
      Case{"[rotor]\nbody = 'rotr'\n", "names body \"rotr\", which is not in [bodies]; known: platform, rotor"},
      Case{"[rotor]\nbody = 'rotor'\njoint = 'hinge'\n", "names joint \"hinge\", which is not in [joints]; known: bearing"},
      Case{rotor + "speed_rpm = 8.8\n", "speed_rpm"}, Case{rotor + "[aero]\nmodel = 'prescribed'\n", "thrust_N"},
      Case{rotor + "[aero]\nmodel = 'prescribed'\nthrust_N = 1\ntable = '" + table + "'\n", "thrust_N"},
      Case{rotor + "[aero]\nmodel = 'prescribed'\ntorque_N_m = 1\ntable = '" + table + "'\n", "takes the place of torque_N_m"},
      Case{rotor + "[aero]\nmodel = 'prescribed'\nthrust_N = 1\nthrust_coefficient = 0.8\n", "thrust_coefficient"},
      Case{rotor + "[aero]\nmodel = 'thrust_curve'\n", "thrust_coefficient"}, Case{rotor + "[aero]\nthrust_N = 1\n", "thrust_N"},
      Case{rotor + "[aero]\nmodel = 'thrust_curve'\ncurve = '" + table + "'\n", "time_s"},
      Case{"[rotor]\nbody = 'rotor'\n[aero]\nmodel = 'thrust_curve'\nthrust_coefficient = 0.8\n", "needs the disc area"},
      Case{rotor + "[aero]\nmodel = 'prescribed'\nthrust_N = 1\ndynamic_inflow = 'free_vortex'\n", "dynamic_inflow"},
      Case{rotor + "[aero]\nmodel = 'actuator_line'\ndynamic_inflow = 'free_vortex'\n", "dynamic_inflow"},
      Case{rotor + "[aero]\nmodel = 'bem'\ndynamic_inflow = 'oye'\nwake_turns = 5\n", "wake_turns"},
      Case{rotor + "[aero]\nmodel = 'bem'\ndynamic_inflow = 'free_vortex'\nwake_turns = 1\n", ">= 2 and <= 50"},
      Case{rotor + "[aero]\nmodel = 'bem'\ndynamic_inflow = 'free_vortex'\nwake_step_deg = 40\n", ">= 2 and <= 30 deg"},
      Case{rotor + "[aero]\nmodel = 'bem'\ndynamic_inflow = 'free_vortex'\nwake_core_chords = 0\n", ">= 0.01 and <= 2"},
      Case{rotor + "[aero]\nmodel = 'bem'\ndynamic_inflow = 'free_vortex'\ndynamic_stall = 'beddoes_leishman'\n",
           "must be \"none\" or \"oye\""},
      Case{rotor + "[aero]\nmodel = 'bem'\n", "needs the blades"}, Case{rotor + "[aero]\ninduction = 'buhl'\n", "induction"},
      Case{rotor + "turbine = '" + table + "'\n[aero]\nmodel = 'bem'\n", "spindrift_aero_options.csv"},
      Case{"[rotor]\nbody = 'rotor'\naxis = [0, 0, 0]\n", "must not be zero"}, Case{"[wind]\nspeed_m_s = -1\n", "speed_m_s"},
      Case{rotor + "[aero]\nmodel = 'prescribed'\nthrust_N = 1\nharmonic_step = 0\n", "harmonic_step"},
      Case{"[wind]\nspeed_m_s = 11\n[wind.turbulence]\nmodel = 'mann'\nfiles = ['" + table + "', '" + table + "', '" + table +
               "']\npoints = [2, 2, 2]\nspacing_m = [0, 9, 9]\n",
           "spacing_m"},
      Case{"[wind]\nspeed_m_s = 11\nprofile = 'power'\n", "power_law"},
      Case{"[wind]\nspeed_m_s = 11\nprofile = 'power_law'\n", "reference_height_m"},
      Case{"[wind]\nspeed_m_s = 11\nreference_height_m = 119\n", "reference_height_m"},
      Case{"[wind]\nspeed_m_s = 11\nshear_exponent = 0.2\n", "shear_exponent"},
      Case{"[wind]\nspeed_m_s = 11\nprofile = 'power_law'\nreference_height_m = 119\nshear_exponent = 3\n", "shear_exponent"},
      Case{"[wind]\nspeed_m_s = 11\nprofile = 'power_law'\nreference_height_m = 119\nroughness_m = 0.1\n", "roughness_m"},
      Case{"[wind]\nspeed_m_s = 11\nprofile = 'power_law'\nreference_height_m = 8\n",
           "= 10 must not be above reference_height_m = 8"},
      Case{"[wind]\nspeed_m_s = 11\nprofile = 'logarithmic'\nreference_height_m = 119\nroughness_m = 10\n",
           "= 10 must be below least_height_m = 10"});
  CHECK_THROWS_WITH(read_sections(c.text), Contains(c.message));
}
