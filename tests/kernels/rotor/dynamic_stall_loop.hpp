// A measured loop of an aerofoil in dynamic stall and its steady polar, which the models of stall are held to.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "kernels/base/constants.hpp"
#include "kernels/base/interpolation.hpp"

namespace spindrift::test {

/// LS(1)-0417MOD, clean, Re 1e6, steady, and pitched as 14 - 10.5 cos(2 pi 1.1949 Hz t) degrees in 32.58 m/s, chord 0.457 m: Ohio
/// State University (Reuss Ramsay, Hoffmann & Gregorek 1995, NREL/TP-442-7819), case C10m100AM14 as in OpenFAST's CertTest
/// (Apache-2.0). Angle [deg], lift, drag; two turns.
struct Row {
  double attack, lift, drag;
};
inline const std::vector<Row> steady{
    {-20.1, -.43, .2726}, {-18, -.39, .2387},  {-16.2, -.37, .2158}, {-14.2, -.69, .0424}, {-12.1, -.73, .0493},
    {-10.3, -.66, .0298}, {-8.1, -.43, .0177}, {-6.3, -.27, .0137},  {-4.1, -.04, .0105},  {-2, .17, .0091},
    {-.1, .3633, .0098},  {2, .59, .0098},     {4.1, .80, .0108},    {6.3, 1.01, .0118},   {8.2, 1.2, .0138},
    {10.3, 1.37, .0175},  {11.4, 1.43, .0196}, {12.2, 1.48, .0215},  {13.2, 1.51, .0254},  {14.3, 1.53, .068},
    {15.3, 1.55, .097},   {16.3, 1.26, .0941}, {17.2, 1.21, .1069},  {18.2, 1.17, .1269},  {19.2, 1.14, .1462},
    {20.2, 1.15, .1678},  {22.3, 1.2, .2214},  {24.2, 1.37, .3034},  {26.2, 1.18, .3305},  {28.2, 1.16, .3973}};
inline const std::vector<Row> up{
    {3.9, .81, .0180},   {4.5, .90, .0212},   {5.6, 1.00, .0227},  {7.7, 1.18, .0441},  {9.3, 1.36, .0454},  {11.9, 1.58, .0770},
    {14.0, 1.75, .0889}, {16.1, 1.88, .0995}, {18.2, 1.96, .1269}, {19.9, 1.99, .2059}, {21.3, 1.71, .3692}, {22.9, 1.34, .3149},
    {23.9, 1.31, .2945}, {3.5, .81, .0103},   {4.8, .92, .0226},   {6.2, 1.07, .0308},  {8.2, 1.24, .0468},  {10.0, 1.43, .0580},
    {12.4, 1.61, .0737}, {14.5, 1.80, .0913}, {16.6, 1.92, .1041}, {18.7, 1.99, .1411}, {20.3, 1.97, .2332}, {21.8, 1.69, .3658},
    {23.4, 1.51, .3397}, {23.9, 1.43, .3187}};
inline const std::vector<Row> down{
    {23.9, 1.16, .2538}, {22.4, 1.16, .2010}, {20.8, 1.13, .1662}, {18.7, 1.11, .1313}, {16.6, 1.09, .0903}, {14.5, 1.10, .0522},
    {12.4, 1.12, .0247}, {10.3, 1.18, .0203}, {8.2, 1.17, .0121},  {6.7, 1.11, .0116},  {5.1, .98, .0078},   {4.1, .89, .0029},
    {23.4, 1.35, .3054}, {21.8, 1.23, .2225}, {20.3, 1.28, .2019}, {18.2, 1.31, .1539}, {16.0, 1.23, .1105}, {13.7, 1.28, .0844},
    {11.4, 1.20, .0518}, {9.3, 1.19, .0324},  {7.7, 1.10, .0266},  {6.1, 1.03, .0142},  {4.7, .94, .0090},   {4.1, .87, .0090}};

constexpr double loop_frequency_Hz = 1.1949, loop_chord_m = 0.457, loop_speed_m_s = 32.5831;

inline double loop_attack(double t) { return (14.0 - 10.5 * std::cos(2.0 * pi * loop_frequency_Hz * t)) * radians_per_degree; }
inline double normal_force(double attack, double lift, double drag) { return lift * std::cos(attack) + drag * std::sin(attack); }

/// Of one turn, computed at equal steps from the least angle on, against the measured ones: root mean square and highest value,
/// both over the highest measured.
struct LoopError {
  double rms, peak;
};
inline LoopError loop_error(const std::vector<double>& angle, const std::vector<double>& normal) {
  double squares = 0.0, peak = 0.0;
  const auto compare = [&](const std::vector<Row>& rows, std::vector<double> a, std::vector<double> c) {
    if (a.front() > a.back()) std::reverse(a.begin(), a.end()), std::reverse(c.begin(), c.end());
    for (const Row& row : rows) {
      const double at = row.attack * radians_per_degree, measured = normal_force(at, row.lift, row.drag);
      squares += std::pow(interpolate_linear(a, c, at) - measured, 2), peak = std::max(peak, measured);
    }
  };
  const auto half = std::ptrdiff_t(angle.size() / 2);
  compare(up, {angle.begin(), angle.begin() + half + 1}, {normal.begin(), normal.begin() + half + 1});
  compare(down, {angle.begin() + half, angle.end()}, {normal.begin() + half, normal.end()});
  return {std::sqrt(squares / double(up.size() + down.size())) / peak, *std::max_element(normal.begin(), normal.end()) / peak};
}

}  // namespace spindrift::test
