// Face vectors, cell volumes and swept volumes of cells with bilinear faces, by exact polynomials of the node positions.
// Face vector: cross product of the mean edges. Volume: divergence theorem over bilinear faces, the volume of the trilinear
// cell (as Dukowicz 1988, LA-UR-88-3021; Grandy 1997, UCRL-ID-128886), arranged so that thin cells lose no digits.
// Called by src/aero/grid/store.cpp; tested in tests/kernels/grid/metrics_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace spindrift {

/// Corners of a face in order round it, a first; its vector points by the right-hand rule. The same bilinear surface for any a.
struct Quad {
  Eigen::Vector3d a, b, c, d;
};

/// Integral of the unit normal over the bilinear surface [m2]: exact, and zero in sum over a closed cell. Half the cross product
/// of the diagonals, written with the mean edges: the diagonals of a face 1e5 times longer than high are nearly parallel and
/// their product keeps 11 digits, that of the edges all 16.
inline Eigen::Vector3d face_vector(const Quad& f) { return 0.25 * ((f.b - f.a) + (f.c - f.d)).cross((f.d - f.a) + (f.c - f.b)); }

/// What the warp of two opposite faces of a cell adds to the integral of x . n over both [m3]; zero where they are plane.
/// One face of edges q, r and twist s = a - b + c - d adds -q . (r x s)/4. The difference is expanded in the edges that join the
/// faces: of thin cells the twist of each face is lost in the rounding of its long edges, the difference of both is not.
inline double warp_moment(const Quad& low, const Quad& high) {
  const Eigen::Vector3d ea = high.a - low.a, eb = high.b - low.b, ec = high.c - low.c, ed = high.d - low.d;
  const Eigen::Vector3d q0 = low.b - low.a, r0 = low.d - low.a;
  const Eigen::Vector3d r1 = high.d - high.a, s1 = (high.a - high.b) + (high.c - high.d);
  const Eigen::Vector3d dq = eb - ea, dr = ed - ea, ds = (ea - eb) + (ec - ed);
  return -0.25 * (dq.dot(r1.cross(s1)) + q0.dot(dr.cross(s1) + r0.cross(ds)));
}

/// Corners of a hexahedron: x[4k + 2j + i] at (i, j, k); right-handed where the volume is positive.
struct Hexahedron {
  Eigen::Vector3d x[8];
};

/// Volume of the trilinear cell [m3]. The origin is corner 0, so three faces contribute their warp only, and the others their
/// vector times the edge that leads to them: the error of a sheared cell of any aspect ratio is a few units in the last place.
inline double hexahedron_volume(const Hexahedron& h) {
  const auto& x = h.x;
  const Quad i0{x[0], x[2], x[6], x[4]}, i1{x[1], x[3], x[7], x[5]};
  const Quad j0{x[0], x[4], x[5], x[1]}, j1{x[2], x[6], x[7], x[3]};
  const Quad k0{x[0], x[1], x[3], x[2]}, k1{x[4], x[5], x[7], x[6]};
  const double plane =
      (x[1] - x[0]).dot(face_vector(i1)) + (x[2] - x[0]).dot(face_vector(j1)) + (x[4] - x[0]).dot(face_vector(k1));
  const double warp = warp_moment(i0, i1) + warp_moment(j0, j1) + warp_moment(k0, k1);
  return (plane + warp) / 3.0;
}

/// Volume swept by a bilinear face whose corners go from `before` to `after` on straight lines at constant speed [m3], positive
/// along its vector: exact, so that a cell's volume grows by the sum over its faces to round-off (discrete geometric conservation
/// law).
inline double swept_volume(const Quad& before, const Quad& after) {
  return hexahedron_volume({{before.a, before.b, before.d, before.c, after.a, after.b, after.d, after.c}});
}

/// Mean of the corners, relative to corner 0 to keep the digits of small cells far from the origin.
inline Eigen::Vector3d cell_centre(const Hexahedron& h) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int n = 1; n < 8; ++n) sum += h.x[n] - h.x[0];
  return h.x[0] + sum / 8.0;
}

/// Weights of volumes in d(V Q)/dt = (a0 V Q + a1 (V Q)_old + a2 (V Q)_older + a3 (V Q)_oldest) / dt with a sum of zero.
struct TimeWeights {
  double now = 1.0, old = -1.0, older = 0.0, oldest = 0.0;
};
inline constexpr TimeWeights bdf1{1.0, -1.0, 0.0};
/// Second-order backward difference; ratio = this step over the step before.
constexpr TimeWeights bdf2(double ratio = 1.0) {
  const double now = (1.0 + 2.0 * ratio) / (1.0 + ratio), older = ratio * ratio / (1.0 + ratio);
  return {now, -(now + older), older};
}
/// Third-order backward difference; ratios: this step over the step before, that one over the one before it. The derivative at
/// the new level of the cubic through four levels (Hairer, Norsett & Wanner, Solving ODE I, III.5). Not A-stable: rates within 4
/// degrees of the imaginary axis may grow (Hairer & Wanner II, V.2); steps that grow by more than 1.53 time after time are
/// unstable too (I, theorem III.5.5).
constexpr TimeWeights bdf3(double ratio = 1.0, double ratio_before = 1.0) {
  const double second = 1.0 + 1.0 / ratio, third = second + 1.0 / (ratio * ratio_before);  // levels 1, second, third steps ago
  const double older = third / (second * (second - 1.0) * (third - second)),
               oldest = -second / (third * (third - 1.0) * (third - second));
  const double now = 1.0 + 1.0 / second + 1.0 / third;
  return {now, -(now + older + oldest), older, oldest};
}

/// Of this order, 1 to 3.
constexpr TimeWeights backward_difference(int order, double ratio = 1.0, double ratio_before = 1.0) {
  return order > 2 ? bdf3(ratio, ratio_before) : order > 1 ? bdf2(ratio) : bdf1;
}

/// Volume per time that a face sweeps [m3/s], so that a uniform state stays uniform under these weights: `swept` in this step,
/// `swept_old` in the step before. Divided by the face's area it is the normal speed that fluxes use. Rates of
/// rigid motion (vectors) are made of what they came to in these steps likewise.
template <class T>
constexpr T swept_rate(TimeWeights w, const T& swept, const T& swept_old, double dt) {
  return (w.now * swept - w.older * swept_old) / dt;
}
/// The same of third order; `swept_older` two steps before.
template <class T>
constexpr T swept_rate(TimeWeights w, const T& swept, const T& swept_old, const T& swept_older, double dt) {
  return (w.now * swept - (w.older + w.oldest) * swept_old - w.oldest * swept_older) / dt;
}

}  // namespace spindrift
