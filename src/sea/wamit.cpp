// SPDX-License-Identifier: Apache-2.0
#include "src/sea/wamit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <ranges>
#include <set>
#include <sstream>
#include <stdexcept>

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

/// Rows of numbers; a first line mostly of words is skipped, as WAMIT may write one.
std::vector<Row> read_rows(const std::string& path, std::initializer_list<std::size_t> counts) {
  std::ifstream file(path);
  if (!file) refuse(path, 0, "cannot be read");
  std::vector<Row> rows;
  std::string text;
  for (int line = 1; std::getline(file, text); ++line) {
    std::istringstream words(text);
    Row row{line, {}};
    std::string word;
    std::string bad;  // the first word that is no number
    std::size_t words_in_line = 0;
    while (words >> word) {
      std::replace(word.begin(), word.end(), 'D', 'E');
      std::size_t used = 0;
      double value = 0.0;
      try {
        value = std::stod(word, &used);
      } catch (const std::exception&) { used = 0; }
      ++words_in_line;
      if (used == word.size() && std::isfinite(value))
        row.values.push_back(value);
      else if (bad.empty())
        bad = word;
    }
    if (!bad.empty()) {
      if (line == 1 && 2 * row.values.size() < words_in_line) continue;
      refuse(path, line, "'" + bad + "' is not a finite number");
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
  bool has[6][6] = {};
  for (const Row& row : read_rows(path, {4, 5})) {
    const double period = row.values[0];
    const int i = mode(path, row, 1), j = mode(path, row, 2);
    const double mass = row.values[3] * s.density * power(s.length, i, j, 3);
    has[i][j] = true;
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
  // Both matrices are symmetric: a file may have one triangle of them.
  const auto complete = [&has](Matrix6& m) {
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j)
        if (!has[i][j] && has[j][i]) m(i, j) = m(j, i);
  };
  for (auto& [omega, at] : by_frequency) complete(at.added), complete(at.damping);
  for (auto* limit : {&result.zero, &result.infinite})
    if (*limit) complete(**limit);
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
    if (!std::ranges::equal(std::views::keys(headings), result.heading))
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

namespace {

/// Where a value lies among nodes, clamped to their ends: the node below and the share of the next.
std::pair<std::size_t, double> place(const std::vector<double>& nodes, double x) {
  if (nodes.size() == 1) return {0, 0.0};
  const std::size_t i = interval(nodes, x);
  return {i, std::clamp((x - nodes[i]) / (nodes[i + 1] - nodes[i]), 0.0, 1.0)};
}

/// Of degrees in files and scenes [rad].
constexpr double heading_round_off = 1e-6;

/// Whether as many headings go on round the circle: the gap from the last to the first is no wider than those between others.
bool closes(const std::vector<double>& headings) {
  double widest = 0.0;
  for (std::size_t n = 1; n < headings.size(); ++n) widest = std::max(widest, headings[n] - headings[n - 1]);
  return headings.size() > 2 && headings.front() + 2.0 * pi - headings.back() <= widest + heading_round_off;
}

/// Headings on both sides of a direction and the share of the second, whole turns aside; none where the file's do not reach it.
struct Between {
  std::size_t low, high;
  double share;
};
std::optional<Between> between(const std::vector<double>& headings, double direction) {
  const double turn = 2.0 * pi, first = headings.front(), last = headings.back();
  const double h = direction - turn * std::floor((direction - first + heading_round_off) / turn);
  if (h <= last + heading_round_off) {
    const auto [low, share] = place(headings, h);
    return Between{low, std::min(low + 1, headings.size() - 1), share};
  }
  if (!closes(headings)) return std::nullopt;
  return Between{headings.size() - 1, 0, std::min((h - last) / (first + turn - last), 1.0)};
}

Between must_be_between(const std::vector<double>& headings, double direction) {
  if (const auto found = between(headings, direction)) return *found;
  throw std::invalid_argument("sea: no headings of the file reach the direction of a wave");
}

/// One row of a file of second order.
struct SecondOrderRow {
  int line, mode;
  double first, second;  ///< [rad/s]
  double heading;        ///< [rad]
  std::complex<double> transfer;
};

/// Periods (one or two), headings (two), mode, modulus, phase, real and imaginary part; waves that cross are left out.
std::vector<SecondOrderRow> second_order_rows(const std::string& path, const WamitScale& s,
                                              std::initializer_list<std::size_t> counts) {
  std::vector<SecondOrderRow> rows;
  for (const Row& row : read_rows(path, counts)) {
    const std::size_t periods = row.values.size() - 7;
    for (std::size_t p = 0; p < periods; ++p)
      if (row.values[p] <= 0.0) refuse(path, row.line, "the period must be positive");
    const int i = mode(path, row, periods + 2);
    if (row.values[periods] != row.values[periods + 1]) continue;
    rows.push_back({row.line, i, 2.0 * pi / row.values[0], 2.0 * pi / row.values[periods - 1],
                    row.values[periods] * radians_per_degree,
                    std::complex<double>(row.values[periods + 5], row.values[periods + 6]) * s.density * s.gravity *
                        power(s.length, i, 0, 1)});
  }
  if (rows.empty()) refuse(path, 0, "has no loads of two waves in the same direction");
  return rows;
}

std::vector<double> sorted(const std::set<double>& values) { return {values.begin(), values.end()}; }
std::size_t index_of(const std::vector<double>& values, double value) {
  return std::size_t(std::lower_bound(values.begin(), values.end(), value) - values.begin());
}

}  // namespace

bool covers(const std::vector<double>& headings, double direction) { return between(headings, direction).has_value(); }

void require_headings(const std::string& path, const std::vector<double>& headings, const std::vector<waves::Component>& waves) {
  if (waves.empty()) return;
  const bool spread = std::ranges::any_of(waves, [&](const auto& w) { return w.direction != waves.front().direction; });
  for (const waves::Component& wave : waves) {
    if (covers(headings, wave.direction)) continue;
    const auto degrees = [](double angle) { return fmt::format("{:.6g}", angle / radians_per_degree); };
    const std::string range = headings.size() == 1
                                  ? "has the heading " + degrees(headings.front()) + " alone"
                                  : "has headings from " + degrees(headings.front()) + " to " + degrees(headings.back());
    const std::string at = degrees(wave.direction);
    if (spread)
      throw scene::SceneError(
          {{"", 0, "waves.spreading_range_deg", "", "has waves towards " + at + " degrees, but " + path + " " + range}});
    throw scene::SceneError({{"", 0, "waves.direction_deg", at, path + " " + range}});
  }
}

WamitDrift read_drift(const std::string& path, const WamitScale& s) {
  std::set<double> omega, heading;
  std::vector<SecondOrderRow> rows = second_order_rows(path, s, {8, 9});
  std::erase_if(rows, [](const SecondOrderRow& r) { return r.first != r.second; });
  if (rows.empty()) refuse(path, 0, "has no loads of two waves of the same period");
  for (const SecondOrderRow& r : rows) omega.insert(r.first), heading.insert(r.heading);
  WamitDrift drift{sorted(omega), sorted(heading), {}};
  const std::size_t places = drift.omega.size() * drift.heading.size();
  drift.force.assign(places, Eigen::Matrix<double, 6, 1>::Zero());
  std::array<std::vector<int>, 6> line;  // by place: where it stands
  for (const SecondOrderRow& r : rows) {
    const std::size_t at = index_of(drift.omega, r.first) * drift.heading.size() + index_of(drift.heading, r.heading);
    std::vector<int>& lines = line[std::size_t(r.mode)];
    lines.resize(places);
    if (lines[at] > 0) refuse(path, r.line, "repeats line " + std::to_string(lines[at]));
    lines[at] = r.line, drift.force[at][r.mode] = r.transfer.real();
  }
  for (std::size_t m = 0; m < 6; ++m)
    if (const auto gap = std::find(line[m].begin(), line[m].end(), 0); gap != line[m].end())
      refuse(path, 0,
             "has no load of mode " + std::to_string(m + 1) + " at period " +
                 std::to_string(2.0 * pi / drift.omega[std::size_t(gap - line[m].begin()) / drift.heading.size()]) +
                 " s for one of its headings");
  return drift;
}

Eigen::Matrix<double, 6, 1> WamitDrift::at(double w, double direction) const {
  if (w > omega.back()) return Eigen::Matrix<double, 6, 1>::Zero();
  const auto [f, fs] = place(omega, w);
  const auto [d, d1, ds] = must_be_between(heading, direction);
  const std::size_t n = heading.size(), f1 = std::min(f + 1, omega.size() - 1);
  const double fades = std::min(w / omega.front(), 1.0);
  return fades * ((1.0 - fs) * ((1.0 - ds) * force[f * n + d] + ds * force[f * n + d1]) +
                  fs * ((1.0 - ds) * force[f1 * n + d] + ds * force[f1 * n + d1]));
}

WamitQuadratic read_quadratic(const std::string& path, const WamitScale& s, FrequencyPair kind) {
  const std::vector<SecondOrderRow> rows = second_order_rows(path, s, {9});
  std::set<double> omega, heading;
  for (const SecondOrderRow& r : rows) omega.insert(r.first), omega.insert(r.second), heading.insert(r.heading);
  WamitQuadratic q{sorted(omega), sorted(heading), {}, {}};
  const std::size_t n = q.omega.size(), headings = q.heading.size(), places = n * n * headings;
  std::array<std::vector<int>, 6> line;
  for (const SecondOrderRow& r : rows) {
    const std::size_t m = std::size_t(r.mode), h = index_of(q.heading, r.heading);
    if (!q.has_mode[m]) q.has_mode[m] = true, q.transfer[m].resize(places), line[m].resize(places);
    const std::size_t at = (index_of(q.omega, r.first) * n + index_of(q.omega, r.second)) * headings + h;
    if (line[m][at] > 0) refuse(path, r.line, "repeats line " + std::to_string(line[m][at]));
    line[m][at] = r.line, q.transfer[m][at] = r.transfer;
  }
  // The other order of each pair where the file leaves it out.
  for (std::size_t m = 0; m < 6; ++m)
    for (std::size_t at = 0; q.has_mode[m] && at < places; ++at) {
      if (line[m][at] > 0) continue;
      const std::size_t h = at % headings, first = at / headings / n, second = at / headings % n,
                        other = (second * n + first) * headings + h;
      if (line[m][other] <= 0)
        refuse(path, 0,
               "has no load of mode " + std::to_string(m + 1) + " for the periods " + std::to_string(2.0 * pi / q.omega[first]) +
                   " and " + std::to_string(2.0 * pi / q.omega[second]) + " s");
      q.transfer[m][at] = kind == FrequencyPair::difference ? std::conj(q.transfer[m][other]) : q.transfer[m][other];
    }
  return q;
}

std::complex<double> WamitQuadratic::at(int mode, double first, double second, double direction) const {
  if (first > omega.back() || second > omega.back()) return 0.0;
  const auto [a, as] = place(omega, first);
  const auto [b, bs] = place(omega, second);
  const auto [d, d1, ds] = must_be_between(heading, direction);
  const std::size_t n = omega.size(), headings = heading.size(), a1 = std::min(a + 1, n - 1), b1 = std::min(b + 1, n - 1);
  const auto of = [&, d = d, d1 = d1, ds = ds](std::size_t i, std::size_t j) {
    const auto& all = transfer[std::size_t(mode)];
    return (1.0 - ds) * all[(i * n + j) * headings + d] + ds * all[(i * n + j) * headings + d1];
  };
  return (1.0 - as) * ((1.0 - bs) * of(a, b) + bs * of(a, b1)) + as * ((1.0 - bs) * of(a1, b) + bs * of(a1, b1));
}

Eigen::Matrix<std::complex<double>, 6, 1> WamitExcitation::at(double w, double direction) const {
  if (w > omega.back()) return Eigen::Matrix<std::complex<double>, 6, 1>::Zero();
  const auto [f, fs] = place(omega, w);
  const auto [d, d1, ds] = must_be_between(heading, direction);
  const std::size_t n = heading.size(), f1 = std::min(f + 1, omega.size() - 1);
  return (1.0 - fs) * ((1.0 - ds) * force[f * n + d] + ds * force[f * n + d1]) +
         fs * ((1.0 - ds) * force[f1 * n + d] + ds * force[f1 * n + d1]);
}

}  // namespace spindrift::sea
