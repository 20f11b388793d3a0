// SPDX-License-Identifier: Apache-2.0
#include "src/scene/error.hpp"

#include <fmt/format.h>

#include <ranges>

namespace spindrift::scene {

namespace {
std::string list(const std::vector<Problem>& problems) {
  if (problems.size() == 1) return problems.front().text();
  std::string text = fmt::format("{} problems in the scene:", problems.size());
  constexpr std::size_t most = 50;
  for (const Problem& p : problems | std::views::take(most)) text += "\n  " + p.text();
  if (problems.size() > most) text += fmt::format("\n  and {} more", problems.size() - most);
  return text;
}
}  // namespace

std::string Problem::text() const {
  std::string text = source;
  if (line > 0) text += fmt::format(":{}", line);
  if (!key.empty()) text += (text.empty() ? "" : ": ") + key;
  if (!value.empty()) text += " = " + value;
  return text + ": " + message;
}

SceneError::SceneError(std::vector<Problem> problems) : std::runtime_error(list(problems)), problems_(std::move(problems)) {}

}  // namespace spindrift::scene
