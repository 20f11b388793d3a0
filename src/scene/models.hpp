// A list of models of one kind, from which a key of a scene chooses by name. A model has `name` and `help` (what the reference
// says of it) and `keys` (those of the scene that it reads). Used for mooring lines, waves, turbulence closures, conditions of
// the air, viscosities of particles and coupling schemes (docs/developer/where.md); tested through tests/src/moorings and
// tests/src/sea. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "src/scene/section.hpp"

namespace spindrift::scene {

template <class Model>
class Models {
 public:
  /// In the order in which the reference names them. The pointers must live on.
  explicit Models(std::span<const Model* const> models) : models_(models) {}

  auto begin() const { return models_.begin(); }
  auto end() const { return models_.end(); }

  /// Throws std::invalid_argument where none has the name.
  const Model& named(std::string_view name) const {
    const auto found = std::ranges::find(models_, name, &Model::name);
    if (found == models_.end()) throw std::invalid_argument("no model has the name \"" + std::string(name) + "\"");
    return **found;
  }
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const Model* model : models_) names.emplace_back(model->name);
    return names;
  }
  /// Names of those that read the key.
  std::vector<std::string> with(std::string_view key) const {
    std::vector<std::string> names;
    for (const Model* model : models_)
      if (std::ranges::find(model->keys, key) != model->keys.end()) names.emplace_back(model->name);
    return names;
  }
  std::vector<Choice> choices() const {
    std::vector<Choice> choices;
    for (const Model* model : models_) choices.push_back({std::string(model->name), std::string(model->help)});
    return choices;
  }

 private:
  std::span<const Model* const> models_;
};

}  // namespace spindrift::scene
