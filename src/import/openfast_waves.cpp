// Waves and current of a scene from SeaState, or from HydroDyn in decks that have them there.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "kernels/base/constants.hpp"
#include "src/import/openfast_sections.hpp"

namespace spindrift::decks {

namespace {

std::string spreading(DeckImport& run, const Deck& waves, int model) {
  if (waves.integer({"WaveDirMod"}, 0) == 0) return "";
  if (model != 2 && model != 5) {
    run.leave_out("directional spreading of a regular wave");
    return "";
  }
  run.carry("directional spreading");
  return fmt::format("spreading_exponent = {:.9g}\nspreading_range_deg = {:.9g}\n", waves.number({"WaveDirSpread"}),
                     waves.number({"WaveDirRange"}));
}

/// How linear waves reach their surface; waves of second order have one way.
std::string stretching(DeckImport& run, const Deck& waves, bool second_order) {
  if (!waves.has("WaveStMod")) return "";
  constexpr const char* ways[] = {"vertical", "vertical", "extrapolated", "wheeler"};
  const int kind = waves.integer({"WaveStMod"}, 0);
  if (kind == 0)
    run.leave_out(fmt::format("waves that end at still water (WaveStMod 0): here they load members up to the surface{}",
                              second_order ? "" : ", with the motion of still water's level above it"));
  else if (second_order && kind != 2)
    run.leave_out(fmt::format("stretching of waves of second order (WaveStMod {}): here they are extrapolated", kind));
  return second_order ? "" : fmt::format("stretching = \"{}\"\n", ways[kind]);
}

/// WaveMod 5: an elevation in time, in two columns after lines of heading.
std::string waves_of_file(DeckImport& run, const Deck& waves) {
  const Deck file(waves.beside(waves.text({"WvKinFile"}) + ".Elev"), "!");
  std::ofstream out(run.folder / "elevation.csv");
  out << "# From " << file.file().filename().string() << ".\ntime_s,elevation_m\n";
  std::size_t rows = 0;
  for (std::size_t n = 0; n < file.size(); ++n) {
    if (file.words(n).empty()) continue;
    const std::string& first = file.words(n)[0];
    const bool number = first.find_first_not_of("0123456789+-.eEdD") == std::string::npos;
    if (rows == 0 && !number) continue;
    const std::vector<double> row = file.numbers(n, 2);
    out << fmt::format("{:.9g},{:.9g}\n", row[0], row[1]), ++rows;
  }
  if (rows == 0) file.fail(std::nullopt, "has no row of time and elevation");
  run.carry(fmt::format("waves: {} elevations of {}", rows, file.file().filename().string()));
  std::string text = fmt::format("\n[waves]\nmodel = \"elevation\"\nfile = \"elevation.csv\"\ndirection_deg = {:.9g}\n",
                                 waves.number({"WaveDir"}, 0.0));
  if (const double highest = waves.number({"WvHiCOff"}, 0.0); highest > 0.0)
    text += fmt::format("highest_Hz = {:.9g}\n", highest / (2.0 * pi));
  return text + stretching(run, waves, false) + spreading(run, waves, 5);
}

/// SeaState has waves at differences and at sums of frequencies by a switch each, and of them a band; a scene has all or none.
std::string second_order(DeckImport& run, const Deck& waves, int model, const std::string& linear) {
  const bool differences = waves.flag({"WvDiffQTF"}, false), sums = waves.flag({"WvSumQTF"}, false);
  if (!differences && !sums) return "";
  std::string why = linear;
  if (model != 2) why = fmt::format("waves of WaveMod {} have none in the scene", model);
  if (waves.integer({"WaveDirMod"}, 0) != 0 && why.empty()) why = "the sea is short-crested";
  if (differences != sums && why.empty()) why = "a scene has those at sums and differences together";
  // The band must hold the pairs of the spectrum's peak; the scene's harmonics reach up to sqrt(2 g/Hs).
  const double peak = 2.0 * pi / waves.number({"WaveTp"}, 1.0);
  const double limit = std::sqrt(2.0 * standard_gravity / std::max(waves.number({"WaveHs"}, 0.0), 1e-6));
  const double low_d = waves.number({"WvLowCOffD"}, 0.0), high_d = waves.number({"WvHiCOffD"}, 2.0 * limit),
               low_s = waves.number({"WvLowCOffS"}, 0.0), high_s = waves.number({"WvHiCOffS"}, 2.0 * limit);
  if (why.empty() && (low_s > 2.0 * peak || high_s < 2.0 * peak || low_d > 0.5 * peak || high_d < 0.5 * peak))
    why = "its cut-offs leave out pairs of the spectrum's peak";
  if (!why.empty()) {
    run.leave_out_part(fmt::format("waves of second order ({}): {}",
                                   differences && sums ? "WvDiffQTF, WvSumQTF"
                                   : sums              ? "WvSumQTF"
                                                       : "WvDiffQTF",
                                   why));
    return "";
  }
  if (low_d > 0.0 || high_d < limit)
    run.leave_out(
        fmt::format("cut-offs of the differences of frequencies, {:g} and {:g} rad/s (WvLowCOffD, WvHiCOffD): the scene "
                    "has all",
                    low_d, high_d));
  if (low_s > peak || high_s < 2.0 * limit)
    run.leave_out(
        fmt::format("cut-offs of the sums of frequencies, {:g} and {:g} rad/s (WvLowCOffS, WvHiCOffS): the scene has all "
                    "up to {:.3g}",
                    low_s, high_s, 2.0 * limit));
  run.carry("waves of second order at sums and differences of frequencies");
  return "second_order = true\n";
}

}  // namespace

int wave_model(const Deck& waves) {
  const auto line = waves.find({"WaveMod"});
  if (line && waves.words(*line)[0].rfind("1P", 0) == 0) return 10;
  return waves.integer({"WaveMod"}, 0);
}

std::string import_waves(DeckImport& run, const Deck& waves, const std::string& linear) {
  const int model = wave_model(waves);
  if (model == 0) return "";
  const double height = waves.number({"WaveHs"}, 0.0), period = waves.number({"WaveTp"}, 0.0);
  const std::string bound = second_order(run, waves, model, linear);
  if (model == 5) return waves_of_file(run, waves);
  if (model != 1 && model != 2 && model != 10) {
    run.leave_out_part(fmt::format("waves of WaveMod {}", model));
    return "";
  }
  // The deck's waves have their whole height from its first step on.
  std::string text = fmt::format(
      "\n[waves]\nmodel = \"{}\"\nheight_m = {:.9g}\nperiod_s = {:.9g}\nramp_s = 0.0\n"
      "direction_deg = {:.9g}\n",
      model == 2 ? "jonswap" : "airy", height, period, waves.number({"WaveDir"}, 0.0));
  if (model == 10) {
    const std::size_t line = *waves.find({"WaveMod"});
    // HydroDyn's phase runs with time, the scene's with x.
    text += fmt::format("phase_deg = {:.9g}\n", 0.0 - waves.to_number(waves.words(line)[0].substr(2), line));
  }
  if (model == 1) run.leave_out("the phase of the regular wave: a crest is at the origin at the start");
  if (model == 2) {
    text += fmt::format("seed = {}\n", std::abs(waves.integer({"WaveSeed(1)", "WaveSeed1"}, 1)));
    if (const double peak = waves.number({"WavePkShp"}, 0.0); peak > 0.0)
      text += fmt::format("peak_enhancement = {:.9g}\n", peak);
    run.leave_out("the phases of the irregular waves: those of the seed are others than HydroDyn's");
  }
  text += bound + stretching(run, waves, !bound.empty()) + spreading(run, waves, model);
  if (const int kind = waves.integer({"ConstWaveMod"}, 0); kind != 0 && model == 2) {
    if (kind != 1) run.leave_out("the trough of the constrained wave (ConstWaveMod 2): half of CrestHmax is its crest");
    text += fmt::format("crest_height_m = {:.9g}\ncrest_time_s = {:.9g}\ncrest_place_m = [{:.9g}, {:.9g}]\n",
                        0.5 * waves.number({"CrestHmax"}), waves.number({"CrestTime"}), waves.number({"CrestXi"}, 0.0),
                        waves.number({"CrestYi"}, 0.0));
    run.carry(fmt::format("constrained crest of {:.4g} m", 0.5 * waves.number({"CrestHmax"})));
  }
  run.carry(fmt::format("waves: {} {:.4g} m, {:.4g} s", model == 2 ? "JONSWAP" : "regular", height, period));
  return text;
}

std::string import_current(DeckImport& run, const Deck& waves, double depth) {
  if (waves.integer({"CurrMod"}, 0) == 0) return "";
  if (waves.integer({"CurrMod"}, 0) != 1) {
    run.leave_out_part("the current of a routine (CurrMod 2)");
    return "";
  }
  const auto part = [&](const char* speed, const char* direction, double otherwise) {
    const double v = waves.number({speed}, 0.0), towards = waves.number({direction}, otherwise) * radians_per_degree;
    return Eigen::Vector2d(v * std::cos(towards), v * std::sin(towards));
  };
  const Eigen::Vector2d below = part("CurrSSV0", "CurrSSDir", waves.number({"WaveDir"}, 0.0)),
                        near_surface = part("CurrNSV0", "CurrNSDir", 0.0), uniform = part("CurrDIV", "CurrDIDir", 0.0);
  std::string text;
  if (uniform.norm() > 0.0) text += "current_m_s = " + toml_vector({uniform.x(), uniform.y(), 0.0}) + "\n";
  if (below.norm() + near_surface.norm() > 0.0) {
    const double reach = near_surface.norm() > 0.0 ? waves.number({"CurrNSRef"}) : 0.0;
    text += "current_profile = [\n";
    std::vector<double> levels;
    constexpr int rows = 24;  // denser towards the bed, where the power law is steep
    for (int i = 0; i <= rows; ++i) levels.push_back(depth * (std::pow(double(i) / rows, 3.0) - 1.0));
    if (reach > 0.0 && reach < depth) levels.push_back(-reach);
    std::ranges::sort(levels);
    levels.erase(std::ranges::unique(levels).begin(), levels.end());
    for (const double z : levels) {
      const Eigen::Vector2d v = below * std::pow(std::max(0.0, (z + depth) / depth), 1.0 / 7.0) +
                                near_surface * (reach > 0.0 ? std::max(0.0, (z + reach) / reach) : 0.0);
      text += fmt::format("  [{:.9g}, {:.9g}, {:.9g}],\n", z, v.x(), v.y());
    }
    text += "]\n";
  }
  if (!text.empty()) run.carry(fmt::format("current: {:.4g} m/s at the surface", (below + near_surface + uniform).norm()));
  return text;
}

}  // namespace spindrift::decks
