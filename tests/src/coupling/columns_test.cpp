// Every column is declared once: its page, its history and its values come from one table.
// SPDX-License-Identifier: Apache-2.0
#include "src/coupling/columns.hpp"

#include <catch2/catch.hpp>
#include <set>

using namespace spindrift;
using namespace spindrift::coupling;

TEST_CASE("a table declares its columns behind a prefix and fills them from one source", "[coupling][fast]") {
  io::History history;
  const io::ColumnGroup<Wrench> group(history, "platform.sea.", wrench_columns());
  REQUIRE(history.columns().back().name == "platform.sea.mz_N_m");
  std::vector<double> row(history.columns().size());
  Wrench w;
  w.force = {1.0, 2.0, 3.0}, w.moment = {4.0, 5.0, 6.0};
  group.fill(row, w);
  CHECK(std::vector<double>(row.end() - 6, row.end()) == std::vector<double>{1.0, 2.0, 3.0, 4.0, 5.0, 6.0});
}

TEST_CASE("no two columns of a page have the same name, and each has a unit and a sentence", "[coupling][fast]") {
  std::set<std::string> names;
  for (const io::ColumnSection& section : column_sections())
    for (const io::Column& column : section.columns) {
      CHECK(names.insert(section.prefix + column.name).second);
      CHECK_FALSE((column.unit.empty() || column.meaning.empty()));
    }
}
