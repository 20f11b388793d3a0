// [wind] of a scene from InflowWind.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <vector>

#include "kernels/base/constants.hpp"
#include "src/import/openfast_sections.hpp"

namespace spindrift::decks {

namespace {

/// Keys of [wind] for the mean wind of HAWC's boxes.
std::string mann_profile(DeckImport& run, const Deck& w, double hub_height) {
  const int law = w.integer({"WindProfile"}, 0);
  const double height = w.number({"RefHt_Hawc"}, hub_height);
  if (std::abs(height - hub_height) > 1e-3 * hub_height)
    run.leave_out(fmt::format("RefHt_Hawc {:g}: the middle of the Mann box is at the hub", height));
  if (law == 0) return "";
  if (const char* key = law == 1 ? "Z0" : "PLExp_Hawc"; !w.has(key)) {
    run.leave_out(fmt::format("WindProfile {}, without {}: the wind is the same at all heights", law, key));
    return "";
  }
  const std::string reference = fmt::format("reference_height_m = {:.9g}\n", height);
  if (law == 1) return "profile = \"logarithmic\"\n" + reference + fmt::format("roughness_m = {:.9g}\n", w.number({"Z0"}));
  return "profile = \"power_law\"\n" + reference + fmt::format("shear_exponent = {:.9g}\n", w.number({"PLExp_Hawc"}));
}

std::string mann_box(DeckImport& run, const Deck& w, double hub_height) {
  w.require({positive("URef"),
             {"WindProfile", 0, 2},
             {"PLExp_Hawc", -1, 1},
             positive("RefHt_Hawc"),
             {"nx", 2, 1e6},
             {"ny", 2, 1e6},
             {"nz", 2, 1e6},
             positive("dx"),
             positive("dy"),
             positive("dz"),
             {"ScaleMethod", 0, 2}});
  std::string files;
  for (const char* name : {"FileName_u", "FileName_v", "FileName_w"}) {
    const std::filesystem::path path = w.path({name});
    run.copy(path);
    files += fmt::format("{}\"{}\"", files.empty() ? "" : ", ", path.filename().string());
  }
  if (w.integer({"ScaleMethod"}, 0) != 0) run.leave_out("ScaleMethod: the Mann box is not scaled");
  const double length = w.number({"nx"}) * w.number({"dx"}), offset = w.number({"XOffset"}, 0.0);
  const double ahead = offset - length * std::floor(offset / length);
  run.carry("wind: Mann box");
  return fmt::format(
      "speed_m_s = {:.9g}\n{}[wind.turbulence]\nmodel = \"mann\"\nfiles = [{}]\npoints = [{}, {}, {}]\nspacing_m = [{:.9g}, "
      "{:.9g}, "
      "{:.9g}]\n{}",
      w.number({"URef"}), mann_profile(run, w, hub_height), files, w.integer({"nx"}, 0), w.integer({"ny"}, 0),
      w.integer({"nz"}, 0), w.number({"dx"}), w.number({"dy"}), w.number({"dz"}),
      ahead == 0.0 ? "" : fmt::format("start_s = {:.9g}\n", ahead / w.number({"URef"})));
}

/// Columns of a uniform wind file: InflowWind reads nine where the first row has them, otherwise the eight without upflow.
std::size_t columns_of(const Deck& file) {
  for (std::size_t n = 0; n < file.size(); ++n) {
    const std::vector<std::string>& row = file.words(n);
    if (!row.empty()) return row.size() > 8 && number_in(row[8]) ? 9 : 8;
  }
  return 8;
}

/// Uniform wind in time: time, speed, direction, vertical speed, shears, gust and, if any, the angle by which all is turned
/// upwards.
std::string uniform_wind(DeckImport& run, const Deck& w, double hub_height) {
  const double all_turned = w.number({"PropagationDir"}, 0.0);
  const Deck file(w.path({"FileName_Uni", "Filename"}), "!");
  std::ofstream out(run.folder / "wind.csv");
  out << "# From " << file.file().filename().string() << ".\ntime_s,speed_m_s,direction_deg,vertical_m_s\n";
  double shear = 0.0, before = -std::numeric_limits<double>::infinity();
  bool sheared = false, changes = false, gusts = false, rises = false;
  const std::size_t columns = columns_of(file);
  std::vector<std::array<double, 4>> rows;
  for (std::size_t n = 0; n < file.size(); ++n) {
    if (file.words(n).empty()) continue;
    const std::vector<double> row = file.numbers(n, columns);
    if (row[1] < 0.0) file.fail(n, fmt::format("has a wind of {:g} m/s: the second column is a speed, not negative", row[1]));
    if (row[0] <= before) file.fail(n, fmt::format("has a time of {:g} s, not later than the row before", row[0]));
    before = row[0];
    const double upflow = columns > 8 ? row[8] * radians_per_degree : 0.0, speed = row[1] + row[7];
    if (speed < 0.0)
      file.fail(n, fmt::format("has a gust of {:g} m/s in a wind of {:g}, which turns the wind round", row[7], row[1]));
    const double level = std::cos(upflow) * speed - std::sin(upflow) * row[3];
    if (level < 0.0) file.fail(n, fmt::format("has an upflow of {:g} degrees, which turns the wind round", row[8]));
    rows.push_back({row[0], level, -row[2] - all_turned, std::sin(upflow) * speed + std::cos(upflow) * row[3]});
    rises = rises || (upflow != 0.0 && row[5] != 0.0);
    gusts = gusts || (row[7] != 0.0 && row[5] != 0.0);
    if (n > 0 && row[5] != shear) changes = true;
    shear = row[5];
    sheared = sheared || row[4] != 0.0 || row[6] != 0.0;
  }
  if (rows.size() == 1) rows.push_back(rows[0]), rows[1][0] += 1.0;
  for (const auto& [time, speed, direction, upwards] : rows)
    out << fmt::format("{:.9g},{:.9g},{:.9g},{:.9g}\n", time, speed, direction, upwards);
  if (gusts)
    run.leave_out("the gust column of the uniform wind file is the same at all heights there: here the power law shears it");
  if (rises)
    run.leave_out("shear of what the upflow angle of the uniform wind file turns upwards: it is the same at all heights");
  if (sheared) run.leave_out("horizontal and linear vertical shear of the uniform wind file");
  if (changes) run.leave_out("changes of the power law's exponent in the uniform wind file: the last is used");
  run.carry("wind: " + file.file().filename().string());
  std::string text = "table = \"wind.csv\"\n";
  if (shear != 0.0)
    text += fmt::format("profile = \"power_law\"\nreference_height_m = {:.9g}\nshear_exponent = {:.9g}\n",
                        w.number({"RefHt_Uni", "RefHt"}, hub_height), shear);
  return text;
}

}  // namespace

std::string import_wind(DeckImport& run, const Deck& w, double hub_height) {
  w.require({{"WindType", 1, 7}, not_negative("HWindSpeed"), {"PLexp", -1, 1}, angle("PropagationDir"), {"VFlowAng", -90, 90}});
  const int type = w.integer({"WindType"}, 1);
  if (type == 1) w.require({positive("RefHt")});
  std::string text = "\n[wind]\n";
  const double speed = w.number({"HWindSpeed"}, 0.0), height = w.number({"RefHt"}, hub_height),
               exponent = w.number({"PLexp"}, 0.0);
  if (type == 1) {
    text += fmt::format("speed_m_s = {:.9g}\n", speed);
    if (exponent != 0.0)
      text += fmt::format("profile = \"power_law\"\nreference_height_m = {:.9g}\nshear_exponent = {:.9g}\n", height, exponent);
    run.carry(fmt::format("wind: steady {:.4g} m/s", speed));
  } else if (type == 3) {
    const std::filesystem::path box = w.path({"FileName_BTS", "Filename"});
    run.copy(box);
    text += fmt::format("[wind.turbulence]\nmodel = \"bts\"\nfile = \"{}\"\n", box.filename().string());
    run.carry("wind: " + box.filename().string());
  } else if (type == 5) {
    text += mann_box(run, w, hub_height);
  } else if (type == 2) {
    text += uniform_wind(run, w, hub_height);
  } else {
    run.leave_out_part(fmt::format("wind of WindType {}: there is none in the scene", type));
    text += "speed_m_s = 0.0\n";
  }
  // InflowWind counts clockwise seen from above, the scene from x towards y. Rows of uniform wind have it in them.
  if (const double to = w.number({"PropagationDir"}, 0.0); to != 0.0 && type != 2) {
    const std::size_t at = text.find("[wind]\n") + 7;
    text.insert(at, fmt::format("direction_deg = {:.9g}\n", -to));
  }
  if (w.number({"VFlowAng"}, 0.0) != 0.0) run.leave_out("VFlowAng: it turns no wind upwards");
  return text;
}

}  // namespace spindrift::decks
