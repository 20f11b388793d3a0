// SPDX-License-Identifier: Apache-2.0
#include "src/import/deck_import.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "src/scene/value.hpp"

namespace spindrift::decks {

void DeckImport::copy(const std::filesystem::path& file) const {
  if (!std::filesystem::exists(file))
    main.fail(std::nullopt, fmt::format("names {}, which is not there{}", file.string(), beside_but_for_case(file)));
  const std::filesystem::path copy = folder / file.filename();
  if (std::error_code absent; std::filesystem::equivalent(file, copy, absent)) return;  // a scene beside its deck
  std::filesystem::copy_file(file, copy, std::filesystem::copy_options::overwrite_existing);
}

void DeckImport::leave_out_unless(const Deck& file, std::initializer_list<Neutral> numbers) {
  for (const Neutral& n : numbers)
    if (const double value = file.number({n.key}, n.value); value != n.value)
      leave_out(fmt::format("{} {:g}: {}", n.key, value, n.what));
}

bool any_on(const Deck& elastodyn, std::initializer_list<const char*> freedoms) {
  return std::any_of(freedoms.begin(), freedoms.end(), [&](const char* f) { return elastodyn.flag({f}, false); });
}

std::string toml_remarks(const std::vector<std::string>& left_out, const std::vector<std::string>& caveats) {
  const auto list = [](const char* key, const std::vector<std::string>& all) {
    std::string text;
    for (const std::string& what : all) text += "  " + scene::toml_quoted(what) + ",\n";
    return text.empty() ? text : fmt::format("{} = [\n{}]\n", key, text);
  };
  std::vector<std::string> notes;
  std::ranges::copy_if(left_out, std::back_inserter(notes),
                       [&](const std::string& what) { return std::ranges::find(caveats, what) == caveats.end(); });
  return list("caveats", caveats) + list("notes", notes);
}

std::string toml_vector(const Eigen::Vector3d& v) {
  // Round-off of sines and cosines is nothing that a reader should see.
  const auto clean = [&](double x) { return std::abs(x) < 1e-9 * std::max(1.0, v.norm()) ? 0.0 : x; };
  return fmt::format("[{:.10g}, {:.10g}, {:.10g}]", clean(v.x()), clean(v.y()), clean(v.z()));
}

}  // namespace spindrift::decks
