// Reads the values of one section into its options, by its declaration; keeps what is wrong with them.
// Called by src/scene/document.cpp; tested in tests/src/scene/document_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <vector>

#include "src/scene/document.hpp"

namespace spindrift::scene {

/// The parameter's sentence as an aside of a message: " (length of a coupling window)".
std::string aside(const Parameter& p);

/// What it does with sections and their rules is in read.cpp, with single values in read_values.cpp.
class Reader {
 public:
  explicit Reader(Findings& findings) : findings_(findings) {}

  /// `table` is null where the scene does not have the section; `name` is its full key. True without problems.
  bool section(const SectionBase& section, const Value* table, const std::string& name, void* options);

 private:
  using Names = std::set<std::string>;

  void parameter(const Parameter& p, const Value& value, const std::string& key, void* options);
  void leaf(const Parameter& p, const Value& value, const std::string& key, const Slot& slot);
  void list(const Parameter& p, const Value& value, const std::string& key, void* options);
  bool number(const Parameter& p, const Value& value, const std::string& key, double& out);
  void integer(const Parameter& p, const Value& value, const std::string& key, const Slot& slot);
  void choice(const Parameter& p, const Value& value, const std::string& key, void* options);
  void path(const Parameter& p, const Value& value, const std::string& key, std::string& out);
  void symmetric(const Parameter& p, const Value& value, const std::string& key, std::span<double> out);
  bool is_list(const Parameter& p, const Value& value, const std::string& key);

  void unknown_keys(const SectionBase& section, const Value& table, const std::string& name);
  void conditions(const SectionBase& section, const Value* table, const std::string& name, const void* options, const Names& bad);
  void alternatives(const SectionBase& section, const Value* table, const std::string& name, const void* options);
  void rules(const SectionBase& section, const Value* table, const std::string& name, const void* options);
  void wrong(const Value& at, const std::string& key, std::string message);
  void missing(const Value* table, const std::string& key, std::string message);

  Findings& findings_;
};

}  // namespace spindrift::scene
