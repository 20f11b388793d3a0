// Prints a digest of every bit of what the kernels compute from fixed numbers, one line each. The same source is compiled for
// processors of different vector widths and by the flags of this build (CMakeLists.txt); all must print expected.txt.
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <cstring>
#include <vector>

#include "kernels/base/lane_math.hpp"
#include "kernels/base/random.hpp"
#include "kernels/gas/jacobians.hpp"
#include "kernels/gas/muscl.hpp"
#include "kernels/linear/block_ilu.hpp"
#include "kernels/rotor/vortex_filament.hpp"
#include "kernels/sph/density_diffusion_fourtakas.hpp"
#include "kernels/sph/density_diffusion_molteni.hpp"
#include "kernels/sph/kernel_cubic.hpp"
#include "kernels/sph/kernel_wendland.hpp"
#include "kernels/sph/viscosity_artificial.hpp"
#include "kernels/turbulence/model_sa.hpp"
#include "kernels/turbulence/model_sst.hpp"
#include "kernels/waves/components.hpp"
#include "src/aero/flow/krylov_vectors.hpp"
#include "src/sea/sph/sweep_pairs.hpp"

using namespace spindrift;

namespace {

/// FNV-1a over the bytes of numbers.
class Digest {
 public:
  template <class T>
  void add(const T* from, std::size_t count) {
    unsigned char bytes[sizeof(T)];
    for (std::size_t n = 0; n < count; ++n) {
      std::memcpy(bytes, from + n, sizeof(T));
      for (const unsigned char byte : bytes) hash_ = (hash_ ^ byte) * 0x100000001b3u;
    }
  }
  template <class T, int n>
  void add(const Wide<T, n>& wide) {
    T all[n];
    wide.store(all);
    add(all, n);
  }
  void add(double x) { add(&x, 1); }
  void print(const char* name) const { std::printf("%-28s %016llx\n", name, static_cast<unsigned long long>(hash_)); }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

Random random_bits(2024);
double between(double low, double high) { return low + (high - low) * random_bits.uniform(); }
template <class W>
W wide_between(double low, double high) {
  typename W::Scalar all[W::size];
  for (auto& x : all) x = typename W::Scalar(between(low, high));
  return W::load(all);
}

template <class W>
void arithmetic(const char* name) {
  Digest d;
  for (int n = 0; n < 200; ++n) {
    const W a = wide_between<W>(-3.0, 3.0), b = wide_between<W>(0.1, 9.0), c = wide_between<W>(-1e-3, 1e-3);
    d.add(a * b + c), d.add(c - a * b), d.add(a * b - b * c), d.add(a / b), d.add(sqrt(b)), d.add(max(a, c)), d.add(min(a, c));
    d.add(abs(a)), d.add(select(a < c, b, a)), d.add(double(sum(a))), d.add(double(sum(W(a * b))));
  }
  d.print(name);
}

void transcendental() {
  using W = Wide<double, 8>;
  Digest d;
  for (int n = 0; n < 200; ++n) {
    const W x = wide_between<W>(1e-3, 30.0), y = wide_between<W>(-8.0, 8.0);
    d.add(log(x)), d.add(log1p(x)), d.add(exp(y)), d.add(expm1(y)), d.add(tanh(y)), d.add(power(x, 1.4)),
        d.add(power_minus_one(x, 3.5));
    W sine, cosine;
    lane_sincos(y * 1e3, sine, cosine);
    d.add(sine), d.add(cosine);
    d.add(spindrift::log(x[1])), d.add(spindrift::expm1(y[1])), d.add(spindrift::tanh(y[2]));
  }
  d.print("transcendental");
}

template <class Real, class Law>
void pairs(const char* name, const Law& law) {
  using namespace sph;
  constexpr int dim = Law::dim, planes = pack_planes<dim>, clusters = 5;
  using V = LineWide<Real>;
  alignas(64) static Real pack[clusters * planes * cluster_size], sums[clusters * Law::sum_planes * cluster_size];
  for (int c = 0; c < clusters; ++c)
    for (int p = 0; p < planes; ++p)
      for (int lane = 0; lane < cluster_size; ++lane)
        pack[(c * planes + p) * cluster_size + lane] = Real(p < dim        ? between(-0.02, 0.02)
                                                            : p < 2 * dim  ? between(-1.0, 1.0)
                                                            : p == 2 * dim ? between(-5.0, 9.0)
                                                                           : between(-0.1, 0.5));
  std::fill(std::begin(sums), std::end(sums), Real(0));
  Digest d;
  for (int lane = 0; lane < cluster_size; ++lane) {
    const PairState<V, dim> i = spread_state<dim, V>(pack, lane);
    Vec<V, Law::sum_planes> to{};
    for (int c = 0; c < clusters; ++c)
      particle_against_cluster<true, Heavy::neither>(to, i, NoStress{}, pack + c * planes * cluster_size,
                                                     static_cast<const Real*>(nullptr), sums + c * Law::sum_planes * cluster_size,
                                                     law);
    for (int n = 0; n < Law::sum_planes; ++n) d.add(double(sum(to[n])));
  }
  d.add(sums, std::size(sums));
  d.print(name);
}

template <class Scalar>
void sea(const char* (&names)[4]) {
  using namespace sph;
  const double h = 0.0104;
  const EosTait eos{1000.0, 34.0};
  const ViscosityArtificial<Scalar> viscosity{Scalar(0.1), Scalar(34.0), Scalar(h)};
  pairs<Scalar>(
      names[0],
      LawMotion<KernelWendland<3, Scalar>, ViscosityArtificial<Scalar>, DensityDiffusionFourtakas<Scalar>, Scalar>{
          KernelWendland<3, Scalar>(h), viscosity, DensityDiffusionFourtakas<Scalar>(0.1, h, eos, 9.81), Scalar(1000.0)});
  pairs<Scalar>(names[1], LawMotion<KernelCubic<3, Scalar>, ViscosityArtificial<Scalar>, DensityDiffusionMolteni<Scalar>, Scalar>{
                              KernelCubic<3, Scalar>(h), viscosity, {Scalar(0.1), Scalar(34.0), Scalar(h)}, Scalar(1000.0)});
  pairs<Scalar>(names[2], LawDrag<KernelWendland<2, Scalar>, ViscosityLaminar<Scalar>, DensityDiffusionNone, Scalar, false>{
                              KernelWendland<2, Scalar>(h), {Scalar(1e-3)}, {}, Scalar(1000.0)});
  pairs<Scalar>(names[3], LawStrain<KernelWendland<3, Scalar>, Scalar>{KernelWendland<3, Scalar>(h), Scalar(1000.0)});
}

using Row = Wide<double, 8>;
gas::Primitive<Row> some_state() {
  return {wide_between<Row>(-200.0, 200.0), wide_between<Row>(30.0, 90.0), wide_between<Row>(-9.0, 9.0),
          wide_between<Row>(-9.0, 9.0), wide_between<Row>(-3.0, 3.0)};
}
gas::Face<Row> some_face() { return {Row(0.6), Row(0.0), Row(0.8), wide_between<Row>(1e-3, 2.0), wide_between<Row>(-2.0, 2.0)}; }
void add(Digest& d, const gas::Conserved<Row>& c) { d.add(c.rho), d.add(c.mx), d.add(c.my), d.add(c.mz), d.add(c.E); }

void air() {
  gas::IdealGas gas;
  gas.pressure_reference = 101325.0, gas.temperature_reference = 288.15;
  const auto flux = [&](const char* name, const auto& scheme) {
    Digest d;
    for (int n = 0; n < 100; ++n) {
      const gas::Primitive<Row> far_left = some_state(), left = some_state(), right = some_state(), far_right = some_state();
      add(d, scheme(gas, left, right, some_face()));
      const auto s = gas::muscl(gas, gas::VanAlbada{}, far_left, left, right, far_right);
      add(d, scheme(gas, s.l, s.r, some_face()));
    }
    d.print(name);
  };
  flux("flux_osher_p", gas::OsherP{}), flux("flux_osher_o", gas::OsherO{}), flux("flux_roe", gas::Roe{});
  flux("flux_roe_low_mach", gas::RoeLowMach{}), flux("flux_rusanov", gas::Rusanov{});
  Digest jacobian, turbulence;
  for (int n = 0; n < 50; ++n) {
    const auto J = gas::flux_jacobian(gas::RoeLowMach{}, gas, some_state(), some_state(), some_face());
    for (const auto* block : {&J.left, &J.right})
      for (const auto& row : block->m)
        for (const Row& x : row) jacobian.add(x);
    const auto vector = [] {
      return gas::Vector<Row>{wide_between<Row>(-9.0, 9.0), wide_between<Row>(-9.0, 9.0), wide_between<Row>(-9.0, 9.0)};
    };
    const turbulence::Flow<Row> flow{Row(1.2), Row(1.8e-5), wide_between<Row>(1e-4, 1.0), vector(), vector(), vector(), vector()};
    turbulence::Turbulence<Row, 1> one;
    one.q[0] = wide_between<Row>(0.0, 1e-2), one.gradient[0] = vector();
    turbulence.add(turbulence::Sa{}.source(flow, one).rate[0]),
        turbulence.add(turbulence::Sa{}.closure(flow, one).eddy_viscosity);
    turbulence::Turbulence<Row, 2> two;
    two.q[0] = wide_between<Row>(1e-3, 1.0), two.q[1] = wide_between<Row>(1.0, 100.0), two.gradient[0] = vector(),
    two.gradient[1] = vector();
    turbulence.add(turbulence::Sst{}.source(flow, two).rate[1]),
        turbulence.add(turbulence::Sst{}.closure(flow, two).eddy_viscosity);
  }
  jacobian.print("jacobian_roe_low_mach"), turbulence.print("turbulence");
}

template <int n, class SideNumber = float>
void elimination(const char* name) {
  using namespace linear;
  using Matrix = StencilMatrix<n, SideNumber>;
  const CellBox box{7, 5, 4};
  std::vector<float> numbers(Matrix::size(box, 3)), r(std::size_t(box.count()) * n + 16), z(r.size());
  for (float& x : numbers) x = float(between(-0.1, 0.1));
  const Matrix a{numbers.data(), box, 3};
  for (std::ptrdiff_t cell = 0; cell < box.count(); ++cell) {
    if constexpr (!std::same_as<SideNumber, float>)
      for (int side = 0; side < 6; ++side)
        for (int e = 0; e < n * n; ++e) a.put_side(cell, side, e, float(between(-0.1, 0.1)));
    for (int c = 0; c < n; ++c) a.block(cell, a.diagonal)[c * n + c] += 2.0f;
  }
  for (float& x : r) x = float(between(-1.0, 1.0));
  Digest d;
  d.add(double(factor(a)));
  solve(a, r.data(), z.data());
  d.add(numbers.data(), numbers.size() - block_overrun), d.add(z.data(), std::size_t(box.count()) * n);
  d.print(name);
}

void krylov() {
  constexpr std::size_t size = 4096 + 48;
  std::vector<aero::AlignedArray<float>> v;
  for (int k = 0; k < 3; ++k) {
    v.emplace_back(size);
    for (std::size_t n = 0; n < size; ++n) v.back().data()[n] = float(between(-1.0, 1.0));
  }
  const std::array<const float*, 3> all{v[0].data(), v[1].data(), v[2].data()};
  std::array<double, 3> dots;
  Digest d;
  aero::dot_products(v[2].data(), all, size, dots);
  d.add(dots.data(), 3);
  aero::orthogonalise(v[2].data(), std::span(v).first(2), std::span(dots).first(2), 0.7, size);
  aero::add_scaled(v[1].data(), 0.3, v[2].data(), size);
  d.add(v[1].data(), size), d.add(v[2].data(), size);
  d.print("krylov_vectors");
}

void sea_state() {
  std::vector<waves::ComponentGroup> sea(2);
  for (int n = 0; n < 16; ++n)
    waves::set_lane(sea[std::size_t(n / 8)], n % 8,
                    {between(0.01, 2.0), between(0.2, 3.0), between(0.0, 1.0), between(0.0, 1.0), between(0.0, 6.0), 0.0}, 200.0);
  Digest d;
  for (int n = 0; n < 100; ++n) {
    const auto k = waves::kinematics(sea, 0.37 * n, 1.5 * n, -n, -0.2 * n);
    const auto s = waves::surface(sea, 0.37 * n, 1.5 * n, -n);
    d.add(k.velocity.data(), 3), d.add(k.acceleration.data(), 3), d.add(k.pressure_over_density), d.add(s.elevation),
        d.add(s.slope_x);
  }
  d.print("waves");
}

void filaments() {
  VortexFilaments all;
  std::vector<Eigen::Vector3d> points, velocities(37, Eigen::Vector3d::Zero());
  const auto anywhere = [] {
    const double x = between(-9.0, 9.0), y = between(-9.0, 9.0), z = between(-9.0, 9.0);
    return Eigen::Vector3d(x, y, z);
  };
  all.begin(anywhere());
  for (int n = 0; n < 50; ++n) {
    const Eigen::Vector3d to = anywhere();
    const double circulation = between(-5.0, 5.0);
    all.extend(to, circulation, between(0.0, 0.5));
  }
  for (std::size_t n = 0; n < velocities.size(); ++n) points.push_back(anywhere());
  all.add_velocities(points, velocities);
  Digest d;
  d.add(velocities.front().data(), 3 * velocities.size());
  d.print("vortex_filaments");
}

}  // namespace

int main() {
  arithmetic<Wide<float, 16>>("float_16"), arithmetic<Wide<float, 8>>("float_8");
  arithmetic<Wide<double, 8>>("double_8"), arithmetic<Wide<double, 16>>("double_16");
  transcendental();
  const char* in_float[] = {"pairs_wendland_float", "pairs_cubic_float", "pairs_laminar_float", "pairs_strain_float"};
  const char* in_double[] = {"pairs_wendland_double", "pairs_cubic_double", "pairs_laminar_double", "pairs_strain_double"};
  sea<float>(in_float), sea<double>(in_double);
  air();
  elimination<5>("block_ilu_5"), elimination<2>("block_ilu_2"), elimination<1>("block_ilu_1");
  krylov();
  sea_state();
  filaments();
  elimination<5, linear::ShortFloat>("block_ilu_5_short");
}
