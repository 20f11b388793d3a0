// SPDX-License-Identifier: Apache-2.0
#include "src/app/check_omissions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "src/app/leave_out.hpp"
#include "src/app/smaller_choices.hpp"

namespace spindrift::app {

namespace {

std::string changed_by(const std::optional<double>& change) { return change ? fmt::format("{:+.2g}", *change) : "unknown"; }

/// With quotes for a shell where it needs them.
std::string as_option(const std::string& override_text) {
  const char* quote = override_text.find_first_of("\"[") == std::string::npos ? "" : "'";
  return fmt::format(" --set {0}{1}{0}", quote, override_text);
}

/// As a section of a study may be called.
std::string as_name(std::string text) {
  std::ranges::replace_if(
      text, [](unsigned char c) { return std::isalnum(c) == 0 && c != '-'; }, '_');
  return text;
}

/// A study that tells what a trial cannot: its text, to be put into a file.
void print_study(const CheckArguments& arguments, const Trial& trial) {
  const auto listed = [](const std::vector<std::string>& overrides) {
    std::string text;
    for (const std::string& o : overrides) text += fmt::format("{}'{}'", text.empty() ? "" : ", ", o);
    return text;
  };
  fmt::print("\n[study]\nscene = \"{}\"\n", std::filesystem::absolute(arguments.scene).lexically_normal().string());
  if (!arguments.overrides.empty()) fmt::print("set = [{}]\n", listed(arguments.overrides));
  fmt::print("\n[variants.the_scene_itself]\n");
  for (const Omission& o : trial.omissions)
    fmt::print("[variants.{}]\nset = [{}]\n", as_name(o.choice.name), listed(o.choice.overrides));
  fmt::print("\n[reference]\nvariant = \"the_scene_itself\"\n");
  for (const std::string& column : arguments.columns)
    fmt::print("\n[metrics.{}]\ncolumn = \"{}\"\nmeasure = \"{}\"\n", as_name(column), column, trial.steady ? "last" : "mean");
}

}  // namespace

void print_omissions(const CheckArguments& arguments) {
  const std::vector<std::string>& columns = arguments.columns;
  if (columns.empty()) return;
  std::fflush(stdout);  // what has been said can be read meanwhile
  const double budget_s = arguments.trial_s > 0.0 ? arguments.trial_s : usual_trial_s;
  const Trial trial = try_omissions(arguments.scene, arguments.overrides, columns, budget_s);
  if (!trial.untried.empty()) {
    fmt::print("\nWhat could be left out: not tried, it would take {}\n", trial.untried);
    if (trial.forecast_s > budget_s)
      fmt::print("  a trial has {:g} s; --trial-s {:.0f} gives it as many\n", budget_s, std::ceil(trial.forecast_s));
    fmt::print("  or put this into a file for spindrift study, which can be stopped and goes on:\n");
    print_study(arguments, trial);
    return;
  }
  const std::string length = trial.whole() ? fmt::format("over the whole run, {:g} s", trial.end_s)
                                           : fmt::format("over {:g} of {:g} s, as far as {:g} s of processor time carry",
                                                         trial.length_s, trial.end_s, budget_s);
  const std::string steady = fmt::format("until the march ends, within {:g} s", trial.end_s);
  fmt::print("\nWhat could be left out (tried {}; change of {})\n", trial.steady ? steady : length,
             trial.steady ? "the value there" : "mean and deviation over their last two thirds");
  for (const std::string& why : trial.unlike) fmt::print("  effects unknown, the trial is not like the run: {}\n", why);
  if (!trial.whole() && trial.unlike.empty()) fmt::print("  unknown: no larger than its scatter between parts of the trial\n");
  for (std::size_t c = 0; c < columns.size(); ++c)
    fmt::print("  {:<30}{}: mean {:.4g}, deviation {:.4g}\n", c == 0 ? "the scene itself" : "", columns[c], *trial.own[c].mean,
               *trial.own[c].deviation);
  for (const Omission& o : trial.omissions) {
    if (!o.refused.empty()) {
      fmt::print("  {:<30}cannot be: {}\n", o.choice.name, o.refused);
      continue;
    }
    const double percent = 100.0 * o.saving.error;
    if (o.saving.shows())
      fmt::print("  {:<30}saves {:.0f} % (+- {:.1g}), by", o.choice.name, 100.0 * o.saving.share, percent);
    else
      fmt::print("  {:<30}saves nothing that shows (+- {:.1g} %), by", o.choice.name, percent);
    for (const std::string& text : o.choice.overrides) fmt::print("{}", as_option(text));
    fmt::print("\n");
    if (o.choice.in_plane && std::ranges::any_of(columns, is_out_of_plane))
      fmt::print("  {:<30}bodies stay in the plane: sway, roll and yaw are lost\n", "");
    for (std::size_t c = 0; c < columns.size(); ++c)
      fmt::print("  {:<30}{}: mean {}, deviation {}\n", "", columns[c], changed_by(o.effects[c].mean),
                 changed_by(o.effects[c].deviation));
  }
}

}  // namespace spindrift::app
