// SPDX-License-Identifier: Apache-2.0
#include "src/sea/wamit.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "kernels/base/constants.hpp"
#include "kernels/base/interpolation.hpp"
#include "src/scene/error.hpp"

namespace spindrift::sea {

namespace {

[[noreturn]] void refuse(const std::string& path, int line, const std::string& what) {
  throw scene::SceneError({{path, line, "", "", what}});
}

struct Row {
  int line;
  std::vector<double> values;
};

/// Rows of numbers; a first line of words is skipped, as WAMIT may write one.
std::vector<Row> read_rows(const std::string& path, std::initializer_list<std::size_t> counts) {
  std::ifstream file(path);
  if (!file) refuse(path, 0, "cannot be read");
  std::vector<Row> rows;
  std::string text;
  for (int line = 1; std::getline(file, text); ++line) {
    std::istringstream words(text);
    Row row{line, {}};
    std::string word;
    bool numbers = true;
    while (words >> word) {
      std::replace(word.begin(), word.end(), 'D', 'E');
      std::size_t used = 0;
      double value = 0.0;
      try {
        value = std::stod(word, &used);
      } catch (const std::exception&) { used = 0; }
      if (used != word.size() || !std::isfinite(value)) {
        numbers = false;
        break;
      }
      row.values.push_back(value);
    }
    if (!numbers) {
      if (rows.empty() && line == 1) continue;
      refuse(path, line, "'" + word + "' is not a finite number");
    }
    if (row.values.empty()) continue;
    if (std::find(counts.begin(), counts.end(), row.values.size()) == counts.end())
      refuse(path, line,
             "has " + std::to_string(row.values.size()) + " numbers; WAMIT writes " + std::to_string(*counts.begin()) +
                 (counts.size() > 1 ? " or " + std::to_string(*(counts.end() - 1)) : ""));
    rows.push_back(std::move(row));
  }
  if (rows.empty()) refuse(path, 0, "has no rows of numbers");
  return rows;
}

int mode(const std::string& path, const Row& row, std::size_t column) {
  const double value = row.values[column];
  if (value != std::floor(value) || value < 1.0 || value > 6.0)
    refuse(path, row.line, "mode " + std::to_string(value) + ": one body has modes 1 to 6");
  return int(value) - 1;
}

double power(double length, int i, int j, int translations) {
  return std::pow(length, translations + (i > 2 ? 1 : 0) + (j > 2 ? 1 : 0));
}

}  // namespace

WamitRadiation read_radiation(const std::string& path, const WamitScale& s) {
  struct At {
    Matrix6 added = Matrix6::Zero(), damping = Matrix6::Zero();
  };
  std::map<double, At> by_frequency;
  WamitRadiation result;
  for (const Row& row : read_rows(path, {4, 5})) {
    const double period = row.values[0];
    const int i = mode(path, row, 1), j = mode(path, row, 2);
    const double mass = row.values[3] * s.density * power(s.length, i, j, 3);
    if (period <= 0.0) {
      auto& limit = period < 0.0 ? result.zero : result.infinite;
      if (!limit) limit = Matrix6::Zero();
      (*limit)(i, j) = mass;
      continue;
    }
    if (row.values.size() != 5) refuse(path, row.line, "needs added mass and damping");
    const double omega = 2.0 * pi / period;
    At& at = by_frequency[omega];
    at.added(i, j) = mass, at.damping(i, j) = row.values[4] * s.density * power(s.length, i, j, 3) * omega;
  }
  if (by_frequency.size() < 2) refuse(path, 0, "has fewer than two frequencies");
  for (const auto& [omega, at] : by_frequency)
    result.omega.push_back(omega), result.added_mass.push_back(at.added), result.damping.push_back(at.damping);
  return result;
}

WamitExcitation read_excitation(const std::string& path, const WamitScale& s) {
  std::map<double, std::map<double, Eigen::Matrix<std::complex<double>, 6, 1>>> all;
  for (const Row& row : read_rows(path, {7})) {
    if (row.values[0] <= 0.0) refuse(path, row.line, "the period must be positive");
    const int i = mode(path, row, 2);
    auto [at, fresh] = all[2.0 * pi / row.values[0]].try_emplace(row.values[1] * radians_per_degree);
    if (fresh) at->second.setZero();
    at->second[i] = std::complex<double>(row.values[5], row.values[6]) * s.density * s.gravity * power(s.length, i, 0, 2);
  }
  WamitExcitation result;
  for (const auto& [heading, force] : all.begin()->second) result.heading.push_back(heading);
  for (const auto& [omega, headings] : all) {
    result.omega.push_back(omega);
    if (headings.size() != result.heading.size())
      refuse(path, 0, "has other headings at period " + std::to_string(2.0 * pi / omega) + " s than at its longest");
    for (const auto& [heading, force] : headings) result.force.push_back(force);
  }
  return result;
}

Matrix6 read_hydrostatics(const std::string& path, const WamitScale& s) {
  Matrix6 stiffness = Matrix6::Zero();
  for (const Row& row : read_rows(path, {3})) {
    const int i = mode(path, row, 0), j = mode(path, row, 1);
    stiffness(i, j) = row.values[2] * s.density * s.gravity * power(s.length, i, j, 2);
  }
  return stiffness;
}

Eigen::Matrix<std::complex<double>, 6, 1> WamitExcitation::at(double w, double direction) const {
  if (w > omega.back()) return Eigen::Matrix<std::complex<double>, 6, 1>::Zero();
  const auto place = [](const std::vector<double>& nodes, double x) {
    if (nodes.size() == 1) return std::pair<std::size_t, double>(0, 0.0);
    const std::size_t i = interval(nodes, x);
    return std::pair<std::size_t, double>(i, std::clamp((x - nodes[i]) / (nodes[i + 1] - nodes[i]), 0.0, 1.0));
  };
  // The heading among the file's, whole turns aside.
  double h = direction;
  while (h > heading.back() + 1e-9) h -= 2.0 * pi;
  while (h < heading.front() - 1e-9) h += 2.0 * pi;
  const auto [f, fs] = place(omega, w);
  const auto [d, ds] = place(heading, h);
  const std::size_t n = heading.size(), f1 = std::min(f + 1, omega.size() - 1), d1 = std::min(d + 1, n - 1);
  return (1.0 - fs) * ((1.0 - ds) * force[f * n + d] + ds * force[f * n + d1]) +
         fs * ((1.0 - ds) * force[f1 * n + d] + ds * force[f1 * n + d1]);
}

}  // namespace spindrift::sea
