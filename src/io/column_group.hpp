// A column of history.csv as one declaration: name, unit, sentence, and how to get its value. Tables of such columns are filled
// from one source a row; history, summary.json, docs/reference/columns.md and `spindrift reference --columns` follow from them.
// Tables: src/coupling/columns.cpp, src/run/flow_columns.cpp. Tested in tests/src/coupling/columns_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "src/io/history.hpp"

namespace spindrift::io {

template <class Source>
struct ColumnOf {
  const char *name, *unit, *meaning;
  double (*value)(const Source&);
};

/// A table of columns in a history, behind a prefix such as "platform.".
template <class Source>
class ColumnGroup {
 public:
  ColumnGroup(History& history, const std::string& prefix, std::span<const ColumnOf<Source>> table) : table_(table) {
    for (const ColumnOf<Source>& column : table)
      columns_.push_back(history.add({prefix + column.name, column.unit, column.meaning}));
  }
  void fill(std::span<double> row, const Source& source) const {
    for (std::size_t n = 0; n < table_.size(); ++n) row[columns_[n]] = table_[n].value(source);
  }

 private:
  std::span<const ColumnOf<Source>> table_;
  std::vector<std::size_t> columns_;
};

/// A table as a page shows it: what stands before the names, and when a run has them.
struct ColumnSection {
  std::string prefix, when;
  std::vector<Column> columns;
};
template <class Source>
ColumnSection section_of(std::string prefix, std::string when, std::span<const ColumnOf<Source>> table) {
  ColumnSection section{std::move(prefix), std::move(when), {}};
  for (const ColumnOf<Source>& c : table) section.columns.push_back({c.name, c.unit, c.meaning});
  return section;
}

}  // namespace spindrift::io
